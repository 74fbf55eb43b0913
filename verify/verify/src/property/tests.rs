//! Conditions and properties mean the same on bits, on values, and in the words of the book: the second monitor here
//! is written from the page `prove.md` alone, and looks at whole histories.

use super::is_possible;
use crate::model::{Encoder, World};
use crate::prove::{Options, Verdict, decide};
use crate::random::{Lanes, Random};
use crate::replay::Run;
use crate::tests::module;
use rungc_interp::Machine;
use rungc_ir::Module;
use rungc_rt::{Class, Plc};
use rungc_sim::property::{Condition, Property, Watcher, parse};
use std::collections::BTreeMap;

/// Writes what conditions look at: values that are often alike, and any.
const PROGRAM: &str = "LD M8000\nWAND K4X000 H8003 D0\nMOV K4X010 D1\nMOV K4X000 K4Y000\nMOV D0 K4M0\nMOV D1 K3M16\n\
                       MOV D0 D2\nWAND K4X010 H8001 D3\nMOV K4X010 D4\nWAND K4X000 HBF80 D5\nWAND D1 H8001 D6\nWOR K4X000 H7F80 D7\n\
                       LD X000\nOUT T0 K3\nLD X001\nOUT C0 K2\nLD X002\nOUT M8200\n\
                       LD X003\nOUT C200 K-2\nLD X017\nAND X016\nOUT M8034\nEND\n";

/// The devices after a scan.
struct Seen {
    /// When the scan began, in milliseconds.
    at: u32,
    bits: BTreeMap<(Class, u32), bool>,
    words: BTreeMap<(Class, u32), i16>,
    counter: i32,
}

impl Seen {
    fn of(machine: &Machine, at: u32) -> Self {
        let bit = |class, n| machine.bit(class, n) == Some(true);
        let is_off = bit(Class::M, 8034);
        let classes = [
            (Class::X, 16),
            (Class::Y, 32),
            (Class::M, 36),
            (Class::T, 1),
            (Class::C, 1),
        ];
        let bits = classes.into_iter().flat_map(|(class, last)| {
            (0..last).map(move |n| ((class, n), bit(class, n) && !(class == Class::Y && is_off)))
        });
        let words = (0..8)
            .map(|n| (Class::D, n))
            .chain([(Class::T, 0), (Class::C, 0)]);
        Seen {
            at,
            bits: bits.collect(),
            words: words
                .map(|(class, n)| ((class, n), machine.word(class, n).unwrap_or(0)))
                .collect(),
            counter: machine.counter32(200).unwrap_or(0),
        }
    }

    fn double(&self, low: u32) -> i32 {
        let [low, high] = [low, low + 1].map(|n| self.words[&(Class::D, n)]);
        i32::from(high) << 16 | i32::from(low as u16)
    }
}

/// The devices after each scan so far.
type History = [Seen];

/// What something is after the scan of a number.
type InScan<T> = Box<dyn Fn(&History, usize) -> T>;

/// A condition as it is written, and its meaning by the page of the book on properties: after the scan of this number.
pub(crate) struct Written {
    pub text: String,
    holds: InScan<bool>,
}

/// A number as it is written, its value after a scan, and the bits of its constants; more than 32 for a signed value
/// of 32 bits.
struct Quantity {
    text: String,
    value: InScan<i64>,
    /// 16 and 32 are signed.
    bits: u32,
}

pub(crate) fn pick<T: Copy>(of: &[T], random: &mut Random) -> T {
    of[random.below(of.len() as u64) as usize]
}

fn bit(random: &mut Random) -> Written {
    if random.below(6) == 0 {
        let (word, bit) = (random.below(4) as u32, random.below(16));
        return Written {
            text: format!("D{word}.{bit:X}"),
            holds: Box::new(move |all, n| all[n].words[&(Class::D, word)] >> bit & 1 == 1),
        };
    }
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
        holds: Box::new(move |all, n| all[n].bits[&(class, number)]),
    }
}

/// A number of a device.
fn device(random: &mut Random) -> Quantity {
    match random.below(7) {
        0 | 1 => {
            let number = random.below(4) as u32;
            Quantity {
                text: format!("D{number}"),
                value: Box::new(move |all, n| all[n].words[&(Class::D, number)].into()),
                bits: 16,
            }
        }
        2 => Quantity {
            text: "D2.i32".into(),
            value: Box::new(|all, n| all[n].double(2).into()),
            bits: 32,
        },
        3 => {
            let (class, text) = pick(&[(Class::T, "T0.value"), (Class::C, "C0.value")], random);
            Quantity {
                text: text.into(),
                value: Box::new(move |all, n| all[n].words[&(class, 0)].into()),
                bits: 16,
            }
        }
        4 => Quantity {
            text: "C200.value".into(),
            value: Box::new(|all, n| all[n].counter.into()),
            bits: 32,
        },
        _ => {
            let (class, name) = pick(&[(Class::Y, "Y000"), (Class::M, "M0")], random);
            let digits = 1 + random.below(5) as u32;
            let value = move |all: &History, n: usize| {
                let bits = (0..4 * digits).map(|i| i64::from(all[n].bits[&(class, i)]) << i);
                let value: i64 = bits.sum();
                match digits {
                    4 => value << 48 >> 48,
                    _ => value,
                }
            };
            Quantity {
                text: format!("K{digits}{name}"),
                value: Box::new(value),
                bits: 4 * digits,
            }
        }
    }
}

/// A result has 16 bits, or 32 if an operand or a product has.
fn calculation(depth: u32, random: &mut Random) -> Quantity {
    let a = number(depth - 1, random);
    let wide = |bits: u32| bits > 16;
    let (b_text, b, b_is_wide): (String, InScan<i64>, bool) = match random.below(3) {
        0 => {
            let constant = pick(&[0, 1, -1, 2, 7, -100, 32767, -32768], random);
            (constant.to_string(), Box::new(move |_, _| constant), false)
        }
        _ => {
            let b = number(depth - 1, random);
            let text = format!("({})", b.text);
            (text, b.value, wide(b.bits))
        }
    };
    let sign = pick(&["+", "-", "*", "/", "%"], random);
    let bits = if wide(a.bits) || b_is_wide || sign == "*" {
        32
    } else {
        16
    };
    let value = move |all: &History, n: usize| {
        let (a, b) = ((a.value)(all, n), b(all, n));
        let result = match sign {
            "+" => a + b,
            "-" => a - b,
            "*" => a * b,
            _ if b == 0 => 0,
            "/" => a / b,
            _ => a % b,
        };
        result << (64 - bits) >> (64 - bits)
    };
    Quantity {
        text: format!("({}) {sign} {b_text}", a.text),
        value: Box::new(value),
        bits,
    }
}

fn number(depth: u32, random: &mut Random) -> Quantity {
    match random.below(6) {
        0 | 1 if depth > 0 => calculation(depth, random),
        2 => {
            let of = number(depth.saturating_sub(1), random);
            let value = of.value;
            Quantity {
                text: format!("was({})", of.text),
                value: Box::new(move |all, n| value(all, n.saturating_sub(1))),
                bits: of.bits,
            }
        }
        _ => device(random),
    }
}

const SIGNS: [&str; 6] = ["=", "!=", "<", "<=", ">", ">="];

fn compares<T: PartialOrd>(sign: &str, a: T, b: T) -> bool {
    match sign {
        "=" => a == b,
        "!=" => a != b,
        "<" => a < b,
        "<=" => a <= b,
        ">" => a > b,
        _ => a >= b,
    }
}

fn comparison(random: &mut Random) -> Written {
    let sign = pick(&SIGNS, random);
    let Quantity { text, value, bits } = number(1, random);
    if random.below(3) == 0 {
        let other = number(1, random);
        return Written {
            text: format!("{text} {sign} {}", other.text),
            holds: Box::new(move |all, n| compares(sign, value(all, n), (other.value)(all, n))),
        };
    }
    let any = random.bits() as i64 & ((1 << bits) - 1);
    let constant = pick(
        &[any & 3, any & 3, any, (1 << bits) - 1 - (any & 3)],
        random,
    );
    let signed = match bits {
        16 | 32 => constant << (64 - bits) >> (64 - bits),
        _ => constant,
    };
    let is_equality = matches!(sign, "=" | "!=");
    let written = match random.below(3) {
        0 => format!("H{constant:X}"),
        1 if is_equality => constant.to_string(),
        _ => signed.to_string(),
    };
    Written {
        text: format!("{text} {sign} {written}"),
        holds: Box::new(move |all, n| compares(sign, value(all, n), signed)),
    }
}

/// Floats as IEEE 754 compares them.
fn float_comparison(random: &mut Random) -> Written {
    let sign = pick(&SIGNS, random);
    let low = pick(&[4, 6], random);
    let float = move |all: &History, n: usize| f32::from_bits(all[n].double(low) as u32);
    let text = format!("D{low}.f32 {sign}");
    match random.below(3) {
        0 => Written {
            text: format!("{text} D2.f32"),
            holds: Box::new(move |all, n| {
                compares(sign, float(all, n), f32::from_bits(all[n].double(2) as u32))
            }),
        },
        1 => Written {
            text: format!("{text} was(D{low}.f32)"),
            holds: Box::new(move |all, n| {
                compares(sign, float(all, n), float(all, n.saturating_sub(1)))
            }),
        },
        _ => {
            let constant = pick(&[0.0, -0.0, 1.5, -2.0, 1e-39, 3.0e38, 1e20], random);
            Written {
                text: format!("{text} {constant:?}"),
                holds: Box::new(move |all, n| compares(sign, float(all, n), constant)),
            }
        }
    }
}

/// A condition of several, or of several scans.
fn count(a: Written, depth: u32, random: &mut Random) -> Written {
    let mut of = vec![a];
    of.extend((0..random.below(3)).map(|_| any(depth - 1, random)));
    let texts: Vec<&str> = of.iter().map(|a| a.text.as_str()).collect();
    let wanted = 1 + random.below(of.len() as u64) as usize;
    let (kind, holds) = pick(
        &[
            ("exactly", usize::eq as fn(&usize, &usize) -> bool),
            ("at most", usize::le),
            ("at least", usize::ge),
        ],
        random,
    );
    Written {
        text: format!("{kind} {wanted} of ({})", texts.join(", ")),
        holds: Box::new(move |all, n| {
            holds(&of.iter().filter(|a| (a.holds)(all, n)).count(), &wanted)
        }),
    }
}

fn compound(depth: u32, random: &mut Random) -> Written {
    let a = any(depth - 1, random);
    match random.below(9) {
        0 => Written {
            text: format!("!({})", a.text),
            holds: Box::new(move |all, n| !(a.holds)(all, n)),
        },
        1 => Written {
            text: format!("was({})", a.text),
            holds: Box::new(move |all, n| n > 0 && (a.holds)(all, n - 1)),
        },
        edge @ (2 | 3) => Written {
            text: format!("{}({})", if edge == 2 { "rises" } else { "falls" }, a.text),
            holds: Box::new(move |all, n| {
                let before = n > 0 && (a.holds)(all, n - 1);
                let now = (a.holds)(all, n);
                now != before && now == (edge == 2)
            }),
        },
        4 => {
            let ms = pick(&[0, 1, 7, 10, 20, 33], random);
            Written {
                text: format!("({}) for {ms}ms", a.text),
                holds: Box::new(move |all, n| {
                    let since = |m: &usize| all[n].at - all[*m].at >= ms;
                    (0..=n)
                        .filter(since)
                        .any(|m| (m..=n).all(|k| (a.holds)(all, k)))
                }),
            }
        }
        5 => {
            let b = any(depth - 1, random);
            Written {
                text: format!("({}) before ({})", a.text, b.text),
                holds: Box::new(move |all, n| {
                    let b_at = |k: usize| (b.holds)(all, k);
                    let begins = b_at(n) && (n == 0 || !b_at(n - 1));
                    let since = (0..n).rev().find(|&k| b_at(k)).map_or(0, |last| last + 1);
                    !begins || (since..=n).any(|m| (a.holds)(all, m))
                }),
            }
        }
        6 => count(a, depth, random),
        join => {
            let b = any(depth - 1, random);
            let sign = pick(&["&", "|", "="], random);
            let sign = if join == 8 { sign } else { "&" };
            Written {
                text: format!("({}) {sign} ({})", a.text, b.text),
                holds: Box::new(move |all, n| {
                    let (a, b) = ((a.holds)(all, n), (b.holds)(all, n));
                    match sign {
                        "&" => a && b,
                        "|" => a || b,
                        _ => a == b,
                    }
                }),
            }
        }
    }
}

pub(crate) fn any(depth: u32, random: &mut Random) -> Written {
    if depth > 0 && random.below(4) != 0 {
        return compound(depth, random);
    }
    match random.below(7) {
        0..=2 => bit(random),
        3 => {
            let (a, b) = (bit(random), bit(random));
            Written {
                text: format!("{} = {}", a.text, b.text),
                holds: Box::new(move |all, n| (a.holds)(all, n) == (b.holds)(all, n)),
            }
        }
        4 => float_comparison(random),
        _ => comparison(random),
    }
}

/// Returns true if the last scan shows that a property is violated. States of three conditions after the scans so far,
/// with the time of each scan.
fn is_violated(property: &Property, history: &[(u32, bool, bool, bool)]) -> bool {
    let &(now, a, b, c) = history.last().unwrap();
    match *property {
        Property::Never(_) | Property::Reachable(_) => a,
        Property::Always(_) => !a,
        Property::Whenever { within_ms, .. } => {
            let begins = |n: usize| history[n].1 && (n == 0 || !history[n - 1].1);
            (0..history.len()).filter(|&n| begins(n)).any(|n| {
                let limit = history[n].0 + within_ms;
                let mut until = history[n..].iter().take_while(|(at, ..)| *at <= limit);
                now >= limit && !until.any(|(_, _, then, _)| *then)
            })
        }
        Property::Stays { after: None, .. } => {
            let before = history.len().checked_sub(2).map(|n| history[n]);
            before.is_some_and(|(_, held, ended, _)| held && !ended) && !a && !b
        }
        Property::Stays { .. } => {
            let mut since_end = history.iter().rev().take_while(|(.., ended)| !ended);
            !b && !c && since_end.any(|(_, begins, ..)| *begins)
        }
    }
}

fn property(form: u64, [a, b, c]: [Condition; 3], random: &mut Random) -> Property {
    match form {
        0 => Property::Never(a),
        1 => Property::Always(a),
        2 => Property::Stays {
            after: None,
            holds: a,
            until: b,
        },
        3 => Property::Stays {
            after: Some(a),
            holds: b,
            until: c,
        },
        _ => Property::Whenever {
            when: a,
            then: b,
            within_ms: pick(&[0, 1, 5, 10, 20, 30, 33], random),
        },
    }
}

/// The model, the run on values, and the words of the book agree after each scan, up to the first violation.
fn agree(module: &Module, random: &mut Random) -> usize {
    let written = [any(2, random), any(2, random), any(1, random)];
    let read = |of: &Written| {
        let text = &of.text;
        let condition = parse(text, &|_| Vec::new());
        let condition = condition.unwrap_or_else(|mistake| panic!("{text}: {mistake:?}"));
        let shown = condition.to_string();
        let again = parse(&shown, &|_| Vec::new());
        assert_eq!(again.as_ref(), Ok(&condition), "{text}\n{shown}");
        condition
    };
    let form = random.below(7);
    let property = property(form, written.each_ref().map(read), random);
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
        let ms = match scan {
            0 => 0,
            _ => pick(&[1, 5, 10, 10, 25], random),
        };
        lanes.scan(ms, true, random);
        violated.push(lanes.value(system.bad));
    }
    let mut found = 0;
    for lane in (0..64).step_by(9) {
        let trace = lanes.trace(lane);
        let mut run = Run::new(module, &trace);
        let mut watcher = Watcher::new(&property);
        let (mut seen, mut history) = (Vec::new(), Vec::new());
        let mut now = 0;
        for (n, scan) in trace.scans.iter().enumerate() {
            let elapsed = run.scan(scan).unwrap();
            now += elapsed;
            seen.push(Seen::of(run.machine(), now));
            let [a, b, c] = written.each_ref().map(|of| (of.holds)(&seen, n));
            history.push((now, a, b, c));
            let on_bits = violated[n] >> lane & 1 == 1;
            let on_values = watcher.happened(run.machine(), elapsed);
            let by_words = is_violated(&property, &history);
            let context = format!(
                "{property:?}\n{:?}\nscan {n}: {history:?}",
                written.each_ref().map(|of| &of.text)
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
    let violated: usize = (0..100).map(|_| agree(&module, &mut random)).sum();
    assert!((200..700).contains(&violated), "{violated} of 800 runs");
}

#[test]
fn what_the_model_cannot_do_is_not_decided_for_this_reason() {
    let module = module("LD X000\nMOV K1 D0\nLD M8000\nMOV K0 D1\nEND\n");
    let options = Options {
        effort: 5_000,
        ..Options::default()
    };
    let decided = |text: &str| {
        let never = Property::Never(parse(text, &|_| Vec::new()).unwrap());
        let decision = decide(&module, &never, &options);
        let gaps: Vec<String> = decision.gaps.into_iter().map(|gap| gap.what).collect();
        (decision.verdict, gaps)
    };
    let (verdict, gaps) = decided("D0.f32 * 2 > 1e9 & D0 = 0 & D1 = 0");
    assert!(matches!(verdict, Verdict::Undecided(_)), "{verdict:?}");
    assert_eq!(gaps, ["arithmetic of floats in a condition"]);
    let (verdict, gaps) = decided("D0.f32 > 1e9 & D0 = 0 & D1 = 0");
    assert_eq!(verdict, Verdict::Proved);
    assert!(gaps.is_empty());
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
