//! Properties as logic: the same meaning as [`rungc_sim::property`] gives them on values.

use crate::aig::Lit;
use crate::bits::{Bits, constant, signed, unsigned};
use crate::model::{Encoder, Key, World};
use crate::sat::{Answer, Solver};
use rungc_ir::Module;
use rungc_ir::node::AccessKind;
use rungc_rt::special::M_OUTPUTS_OFF;
use rungc_sim::Target;
use rungc_sim::property::{Condition, Number, Property, access};
use rungc_syntax::DeviceClass;
use std::collections::BTreeSet;
use std::time::Duration;
use web_time::Instant;

/// A condition's value after the scan.
pub fn condition(condition: &Condition, encoder: &mut Encoder) -> Lit {
    let mut of = |a: &Condition| self::condition(a, encoder);
    match condition {
        Condition::Constant(on) => (*on).into(),
        Condition::On(target) => value(encoder, *target)[0],
        Condition::Not(a) => !of(a),
        Condition::And(a, b) => {
            let (a, b) = (of(a), of(b));
            encoder.aig.and(a, b)
        }
        Condition::Or(a, b) => {
            let (a, b) = (of(a), of(b));
            encoder.aig.or(a, b)
        }
        Condition::Same(a, b) => {
            let (a, b) = (of(a), of(b));
            !encoder.aig.xor(a, b)
        }
        Condition::Compare(op, a, b) => {
            let [a, b] = [a, b].map(|number| match *number {
                Number::Constant(value) => constant(value.into(), 32),
                Number::Of(target) => signed(&value(encoder, target), 32),
            });
            encoder.compare_bits(*op, &a, &b)
        }
    }
}

fn value(encoder: &mut Encoder, target: Target) -> Bits {
    match access(target) {
        Some((AccessKind::Bit, DeviceClass::Y, number)) => vec![terminal(encoder, number)],
        Some((AccessKind::Nibbles { digits, wide }, DeviceClass::Y, number)) => {
            let outputs = (number..).take(4 * usize::from(digits));
            let bits: Bits = outputs.map(|number| terminal(encoder, number)).collect();
            unsigned(&bits, if wide { 32 } else { 16 })
        }
        Some((kind, class, number)) => encoder.read_at(kind, class, number),
        None => constant(0, 32),
    }
}

/// Returns true if devices can have values with which a condition holds. `module` is a program that writes nothing.
pub fn is_possible(of: &Condition, module: &Module) -> bool {
    let devices: BTreeSet<_> = of.devices().into_iter().collect();
    let world = World {
        free: devices.clone(),
        observed: devices,
        ..World::default()
    };
    let mut encoder = Encoder::scan(module, world);
    let holds = condition(of, &mut encoder);
    let system = encoder.system(holds);
    let mut solver = Solver::new(Instant::now() + LIMIT);
    let all: Vec<_> = system.constraints.iter().chain([&system.bad]).collect();
    let all: Vec<_> = all
        .into_iter()
        .map(|&lit| solver.lit(&system.aig, lit))
        .collect();
    solver.solve(&all) != Answer::Unsat
}

/// Time limit for the question whether a condition is possible, which has no program in it.
const LIMIT: Duration = Duration::from_secs(5);

/// Relay that switches the output terminals off.
pub(crate) const OUTPUTS_OFF: Key = Key::Bit(DeviceClass::M, M_OUTPUTS_OFF.number());

/// An output at its terminal: pulses show there, and M8034 switches it off.
fn terminal(encoder: &mut Encoder, number: u32) -> Lit {
    // A program that does not know the relay leaves it off.
    let off = encoder
        .after(OUTPUTS_OFF)
        .map_or(Lit::FALSE, |bits| bits[0]);
    let image = encoder.read_at(AccessKind::Bit, DeviceClass::Y, number)[0];
    let pulse = encoder.pulse(number);
    let on = encoder.aig.or(image, pulse);
    encoder.aig.and(on, !off)
}

/// Event of a property that must not happen, or is searched for.
pub fn event(property: &Property, encoder: &mut Encoder) -> Lit {
    let mut of = |a: &Condition| condition(a, encoder);
    let bad = match property {
        Property::Never(a) | Property::Reachable(a) => of(a),
        Property::Always(a) => !of(a),
        Property::Whenever {
            when,
            then,
            within_ms,
        } => {
            let (when, then) = (of(when), of(then));
            late(encoder, when, then, *within_ms)
        }
        Property::Stays { holds, until } => {
            let (holds, until) = (of(holds), of(until));
            let (memory, before) = encoder.monitor(1, 0);
            let kept = encoder.aig.and(holds, !until);
            encoder.remember(memory, vec![kept]);
            encoder.aig.all([before[0], !holds, !until])
        }
    };
    let running = encoder.running();
    encoder.aig.and(bad, running)
}

/// Bit that is on if the required condition is late, as [`rungc_sim::property::Deadline`] has it.
fn late(encoder: &mut Encoder, when: Lit, then: Lit, within_ms: u32) -> Lit {
    let (was_on, before) = encoder.monitor(1, 0);
    encoder.remember(was_on, vec![when]);
    let begins = encoder.aig.and(when, !before[0]);
    if within_ms == 0 {
        return encoder.aig.and(begins, !then);
    }
    let elapsed = encoder.elapsed();
    let limit = (u32::BITS - within_ms.leading_zeros()) as usize;
    let width = elapsed.len().max(limit) + 1;
    let elapsed = unsigned(&elapsed, width);
    let (waits, waiting) = encoder.monitor(1, 0);
    let (clock, passed) = encoder.monitor(width, 0);
    let aig = &mut encoder.aig;
    let begins = aig.and(begins, !waiting[0]);
    let passed = aig.add(&passed, &elapsed);
    let most = constant(within_ms.into(), width);
    let is_over = aig.below(&most, &passed);
    let is_before = aig.below(&passed, &most);
    let is_missed = aig.and(!is_before, !then);
    let is_late = aig.or(is_over, is_missed);
    let late = aig.and(waiting[0], is_late);
    let still = aig.or(waiting[0], begins);
    let still = aig.and(still, !then);
    // The clock stands where it is too late anyway.
    let held = aig.select(is_over, &most, &passed);
    let zero = constant(0, width);
    let next = aig.select(waiting[0], &held, &zero);
    encoder.remember(waits, vec![still]);
    encoder.remember(clock, next);
    late
}

#[cfg(test)]
mod tests {
    use super::is_possible;
    use crate::model::{Encoder, World};
    use crate::random::{Lanes, Random};
    use crate::replay::Run;
    use crate::tests::module;
    use rungc_interp::Machine;
    use rungc_ir::Module;
    use rungc_rt::{Class, Plc};
    use rungc_sim::property::{Condition, Property, Watcher, parse};

    /// Writes what conditions look at: values that are often alike, and any.
    const PROGRAM: &str = "LD M8000\nWAND K4X000 H8003 D0\nMOV K4X010 D1\nMOV K4X000 K4Y000\nMOV D0 K4M0\nMOV D1 K3M16\n\
                           MOV D0 D2\nWAND K4X010 H8001 D3\nLD X000\nOUT T0 K3\nLD X001\nOUT C0 K2\nLD X002\nOUT M8200\n\
                           LD X003\nOUT C200 K-2\nLD X017\nAND X016\nOUT M8034\nEND\n";

    /// A condition as it is written, and its meaning by the page of the book on properties.
    struct Written {
        text: String,
        holds: Box<dyn Fn(&Machine) -> bool>,
    }

    type Value = Box<dyn Fn(&Machine) -> i64>;

    fn pick<T: Copy>(of: &[T], random: &mut Random) -> T {
        of[random.below(of.len() as u64) as usize]
    }

    /// A bit; outputs are terminals, which M8034 switches off.
    fn is_on(machine: &Machine, class: Class, number: u32) -> bool {
        let off = class == Class::Y && machine.bit(Class::M, 8034) == Some(true);
        machine.bit(class, number) == Some(true) && !off
    }

    fn bit(random: &mut Random) -> Written {
        let (class, name, last) = pick(
            &[
                (Class::X, "X", 8),
                (Class::Y, "Y", 8),
                (Class::M, "M", 10),
                (Class::T, "T", 1),
                (Class::C, "C", 1),
            ],
            random,
        );
        let number = random.below(last) as u32;
        Written {
            text: format!("{name}{number}"),
            holds: Box::new(move |machine| is_on(machine, class, number)),
        }
    }

    /// A number with the first and the last value that it can have, and the bits of its constants.
    fn number(random: &mut Random) -> (String, Value, u32) {
        let word = |number: u32| move |m: &Machine| m.word(Class::D, number).unwrap_or(0);
        match random.below(6) {
            0 => {
                let number = random.below(4) as u32;
                let value = word(number);
                (format!("D{number}"), Box::new(move |m| value(m).into()), 16)
            }
            1 => {
                let (low, high) = (word(2), word(3));
                let value = move |m: &Machine| i64::from(high(m)) << 16 | i64::from(low(m) as u16);
                ("D2.i32".into(), Box::new(value), 32)
            }
            2 => {
                let value = |m: &Machine| m.word(Class::T, 0).unwrap_or(0).into();
                ("T0.value".into(), Box::new(value), 16)
            }
            3 => {
                let value = |m: &Machine| m.counter32(200).unwrap_or(0).into();
                ("C200.value".into(), Box::new(value), 32)
            }
            _ => {
                let (class, name) = pick(&[(Class::Y, "Y000"), (Class::M, "M0")], random);
                let digits = 1 + random.below(5) as u32;
                let value = move |m: &Machine| {
                    let bits = (0..4 * digits).map(|i| i64::from(is_on(m, class, i)) << i);
                    let value: i64 = bits.sum();
                    if digits == 4 {
                        value << 48 >> 48
                    } else {
                        value
                    }
                };
                (format!("K{digits}{name}"), Box::new(value), 4 * digits)
            }
        }
    }

    fn comparison(random: &mut Random) -> Written {
        type Compare = fn(i64, i64) -> bool;
        const OPERATORS: [(&str, Compare); 6] = [
            ("=", |a, b| a == b),
            ("!=", |a, b| a != b),
            ("<", |a, b| a < b),
            ("<=", |a, b| a <= b),
            (">", |a, b| a > b),
            (">=", |a, b| a >= b),
        ];
        let (sign, compare) = pick(&OPERATORS, random);
        let (text, value, width) = number(random);
        if random.below(3) == 0 {
            let (other_text, other, _) = number(random);
            return Written {
                text: format!("{text} {sign} {other_text}"),
                holds: Box::new(move |m| compare(value(m), other(m))),
            };
        }
        let any = random.bits() as i64 & ((1 << width) - 1);
        let bits = pick(
            &[any & 3, any & 3, any, (1 << width) - 1 - (any & 3)],
            random,
        );
        let constant = match width {
            16 | 32 => bits << (64 - width) >> (64 - width),
            _ => bits,
        };
        let is_equality = matches!(sign, "=" | "!=");
        let written = match random.below(3) {
            0 => format!("H{bits:X}"),
            1 if is_equality => bits.to_string(),
            _ => constant.to_string(),
        };
        Written {
            text: format!("{text} {sign} {written}"),
            holds: Box::new(move |m| compare(value(m), constant)),
        }
    }

    fn any(depth: u32, random: &mut Random) -> Written {
        if depth == 0 || random.below(4) == 0 {
            return match random.below(3) {
                0 => bit(random),
                1 => {
                    let (a, b) = (bit(random), bit(random));
                    Written {
                        text: format!("{} = {}", a.text, b.text),
                        holds: Box::new(move |m| (a.holds)(m) == (b.holds)(m)),
                    }
                }
                _ => comparison(random),
            };
        }
        let a = any(depth - 1, random);
        match random.below(3) {
            0 => Written {
                text: format!("!({})", a.text),
                holds: Box::new(move |m| !(a.holds)(m)),
            },
            join => {
                let b = any(depth - 1, random);
                let sign = if join == 1 { "&" } else { "|" };
                Written {
                    text: format!("({}) {sign} ({})", a.text, b.text),
                    holds: Box::new(move |m| match join {
                        1 => (a.holds)(m) && (b.holds)(m),
                        _ => (a.holds)(m) || (b.holds)(m),
                    }),
                }
            }
        }
    }

    /// States of two conditions after the scans so far, with the time of each scan.
    type History = [(u32, bool, bool)];

    /// Returns true if the last scan shows that a property is violated.
    fn is_violated(property: &Property, history: &History) -> bool {
        let &(now, a, b) = history.last().unwrap();
        match *property {
            Property::Never(_) | Property::Reachable(_) => a,
            Property::Always(_) => !a,
            Property::Whenever { within_ms, .. } => {
                let begins = |n: usize| history[n].1 && (n == 0 || !history[n - 1].1);
                (0..history.len()).filter(|&n| begins(n)).any(|n| {
                    let limit = history[n].0 + within_ms;
                    let mut until = history[n..].iter().take_while(|(at, ..)| *at <= limit);
                    now >= limit && !until.any(|(.., then)| *then)
                })
            }
            Property::Stays { .. } => {
                let before = history.len().checked_sub(2).map(|n| history[n]);
                before.is_some_and(|(_, held, ended)| held && !ended) && !a && !b
            }
        }
    }

    fn property(form: u64, a: Condition, b: Condition, random: &mut Random) -> Property {
        match form {
            0 => Property::Never(a),
            1 => Property::Always(a),
            2 => Property::Stays { holds: a, until: b },
            _ => Property::Whenever {
                when: a,
                then: b,
                within_ms: pick(&[0, 1, 5, 10, 20, 30, 33], random),
            },
        }
    }

    /// The model, the run on values, and the words of the book agree after each scan, up to the first violation.
    fn agree(module: &Module, random: &mut Random) -> usize {
        let (a, b) = (any(2, random), any(2, random));
        let read = |text: &str| parse(text, &|_| Vec::new()).unwrap();
        let form = random.below(6);
        let property = property(form, read(&a.text), read(&b.text), random);
        let conditions = property.conditions().into_iter();
        let world = World {
            observed: conditions.flat_map(Condition::devices).collect(),
            ..World::default()
        };
        let mut encoder = Encoder::scan(module, world);
        let bad = super::event(&property, &mut encoder);
        let system = encoder.system(bad);
        let mut lanes = Lanes::new(&system, random);
        let mut violated = Vec::new();
        for scan in 0..24 {
            let ms = if scan == 0 {
                0
            } else {
                pick(&[1, 5, 10, 10, 25], random)
            };
            lanes.scan(ms, true, random);
            violated.push(lanes.value(system.bad));
        }
        let mut found = 0;
        for lane in (0..64).step_by(9) {
            let trace = lanes.trace(lane);
            let mut run = Run::new(module, &trace);
            let mut watcher = Watcher::new(&property);
            let mut history = Vec::new();
            let mut now = 0;
            for (n, scan) in trace.scans.iter().enumerate() {
                let elapsed = run.scan(scan).unwrap();
                now += elapsed;
                history.push((now, (a.holds)(&run.machine), (b.holds)(&run.machine)));
                let on_bits = violated[n] >> lane & 1 == 1;
                let on_values = watcher.happened(&run.machine, elapsed);
                let by_words = is_violated(&property, &history);
                let context = format!(
                    "{property:?}\n{}\n{}\nscan {n}: {history:?}",
                    a.text, b.text
                );
                assert_eq!((on_bits, on_values), (by_words, by_words), "{context}");
                if by_words {
                    found += 1;
                    break;
                }
            }
        }
        found
    }

    #[test]
    fn a_property_means_the_same_on_bits_on_values_and_in_the_book() {
        let module = module(PROGRAM);
        let mut random = Random::new();
        let violated: usize = (0..400).map(|_| agree(&module, &mut random)).sum();
        assert!((800..2800).contains(&violated), "{violated} of 3200 runs");
    }

    #[test]
    fn conditions_that_nothing_can_meet() {
        let module = module("END\n");
        let possible = |text: &str| is_possible(&parse(text, &|_| Vec::new()).unwrap(), &module);
        for text in [
            "X0 & !X0",
            "D0 > 5 & D0 < 3",
            "K1Y0 = 3 & !Y1",
            "K4M0 < 0 & !M15",
            "D0.i32 = 65536 & D1 != 1",
            "Y0 != Y0",
            "0",
        ] {
            assert!(!possible(text), "{text}");
        }
        for text in [
            "X0 & !X1",
            "D0 > 5 & D0 < 7",
            "T0 & T0.value = 7 & C200.value < -5 & C200",
            "D0 = D1 & S5",
            "D8000 = 1",
            "M8013",
            "M8000 | X0",
        ] {
            assert!(possible(text), "{text}");
        }
    }
}
