//! Properties as logic: the same meaning as [`rungc_sim::property`] gives them on values.

use crate::aig::{Aig, Lit};
use crate::bits::{Bits, constant, signed, unsigned};
use crate::effort::Limit;
use crate::model::{Encoder, Key, World};
use crate::sat::{Answer, Solver};
use rungc_ir::Module;
use rungc_ir::node::AccessKind;
use rungc_rt::CmpOp;
use rungc_rt::special::M_OUTPUTS_OFF;
use rungc_sim::Target;
use rungc_sim::property::{CalcOp, Condition, Number, NumberKind, Property, access};
use rungc_syntax::DeviceClass;
use std::collections::BTreeSet;

/// A condition's value after the scan.
pub fn condition(condition: &Condition, encoder: &mut Encoder) -> Lit {
    let mut of = |a: &Condition| self::condition(a, encoder);
    match condition {
        Condition::Constant(on) => (*on).into(),
        Condition::On(target) => value(encoder, *target)[0],
        Condition::WordBit(word, bit) => value(encoder, *word)[usize::from(*bit)],
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
        Condition::Compare(op, a, b) => comparison(encoder, *op, a, b),
        Condition::Count {
            least,
            most,
            of: all,
        } => {
            let held: Bits = all.iter().map(of).collect();
            let width = (usize::BITS - held.len().leading_zeros()) as usize + 1;
            let held = encoder.aig.ones(&held, width);
            let [least, most] = [least, most].map(|limit| constant((*limit).into(), width));
            let few = encoder.aig.below(&held, &least);
            let many = encoder.aig.below(&most, &held);
            encoder.aig.and(!few, !many)
        }
        Condition::Was(a) => {
            let now = of(a);
            last(encoder, now)
        }
        Condition::Rises(a) => {
            let now = of(a);
            let before = last(encoder, now);
            encoder.aig.and(now, !before)
        }
        Condition::Falls(a) => {
            let now = of(a);
            let before = last(encoder, now);
            encoder.aig.and(!now, before)
        }
        Condition::For(a, ms) => {
            let holds = of(a);
            lasts(encoder, holds, *ms)
        }
        Condition::Before(a, b) => {
            let (first, second) = (of(a), of(b));
            let (seen, was_seen) = encoder.monitor(1, 0);
            let was_on = last(encoder, second);
            let is_seen = encoder.aig.or(was_seen[0], first);
            let stays = encoder.aig.and(is_seen, !second);
            encoder.remember(seen, vec![stays]);
            encoder.aig.any([!second, was_on, is_seen])
        }
    }
}

/// What a bit was after the scan before; off before the first scan.
fn last(encoder: &mut Encoder, now: Lit) -> Lit {
    let (memory, before) = encoder.monitor(1, 0);
    encoder.remember(memory, vec![now]);
    before[0]
}

/// Bit that is on if another has been on for this time.
fn lasts(encoder: &mut Encoder, holds: Lit, ms: u32) -> Lit {
    if ms == 0 {
        return holds;
    }
    let (held, was_held) = encoder.monitor(1, 0);
    encoder.remember(held, vec![holds]);
    let clock = Clock::new(encoder, ms, (held, was_held[0]));
    clock.store(encoder, holds)
}

/// A clock that counts to a limit as timers do: in the longest unit of theirs that the limit is a whole number of, and
/// milliseconds beyond. Where a timer of the program runs at the same times, both have the same bits.
struct Clock {
    /// Its memory: units, milliseconds beyond, and whether it has reached the limit.
    memory: [usize; 3],
    /// Values after the scan.
    units: Bits,
    part: Bits,
    /// Values before the scan.
    before: [Bits; 3],
    /// Limit in units.
    limit: Bits,
}

impl Clock {
    /// A clock that runs if it ran before, which has a memory, too.
    fn new(encoder: &mut Encoder, limit_ms: u32, (running, ran): (usize, Lit)) -> Self {
        let unit: u16 = match limit_ms {
            ms if ms.is_multiple_of(100) => 100,
            ms if ms.is_multiple_of(10) => 10,
            _ => 1,
        };
        let limit = limit_ms / u32::from(unit);
        let mut step = encoder.elapsed_in(unit);
        for bit in step.units.iter_mut().chain(&mut step.rest) {
            *bit = encoder.aig.and(*bit, ran);
        }
        let bits = (u32::BITS - limit.leading_zeros()) as usize;
        let width = step.units.len().max(bits) + 2;
        let (units_memory, units_before) = encoder.monitor(bits, 0);
        let (part_memory, part_before) = encoder.monitor(step.rest.len(), 0);
        let (done_memory, done_before) = encoder.monitor(1, 0);
        encoder.note_clock([units_memory, part_memory, running], unit);
        let aig = &mut encoder.aig;
        let part_width = step.rest.len() + 1;
        let sum = aig.add(
            &unsigned(&part_before, part_width),
            &unsigned(&step.rest, part_width),
        );
        let whole = constant(unit.into(), part_width);
        let carry = match step.rest.is_empty() {
            true => Lit::FALSE,
            false => !aig.below(&sum, &whole),
        };
        let less = aig.sub(&sum, &whole);
        let part = aig.select(carry, &less, &sum)[..step.rest.len()].to_vec();
        let units = aig.add(
            &unsigned(&units_before, width),
            &unsigned(&step.units, width),
        );
        let units = aig.add(&units, &unsigned(&[carry], width));
        Clock {
            memory: [units_memory, part_memory, done_memory],
            units,
            part,
            before: [units_before, part_before, done_before],
            limit: constant(limit.into(), width),
        }
    }

    /// Stores its values, or 0 if it does not run on. Returns true if it has reached its limit.
    fn store(self, encoder: &mut Encoder, runs: Lit) -> Lit {
        let aig = &mut encoder.aig;
        let [units_before, part_before, done_before] = self.before;
        let bits = units_before.len();
        // It stands where it is enough, as a timer does.
        let is_open = aig.below(&unsigned(&units_before, self.limit.len()), &self.limit);
        let most = aig.least(&self.units, &self.limit);
        let units = aig.select(is_open, &most[..bits], &units_before);
        let units = aig.select(done_before[0], &units_before, &units);
        let part = aig.select(done_before[0], &part_before, &self.part);
        let is_short = aig.below(&unsigned(&units, self.limit.len()), &self.limit);
        let done = aig.or(done_before[0], !is_short);
        let mut stored =
            |bits: &[Lit]| -> Bits { bits.iter().map(|&bit| aig.and(bit, runs)).collect() };
        let next = [stored(&units), stored(&part), stored(&[done])];
        let done = next[2][0];
        for (memory, next) in self.memory.into_iter().zip(next) {
            encoder.remember(memory, next);
        }
        done
    }
}

fn comparison(encoder: &mut Encoder, op: CmpOp, a: &Number, b: &Number) -> Lit {
    let is_float = [a, b].map(Number::kind).contains(&NumberKind::Float);
    let (a, b) = (number(encoder, a), number(encoder, b));
    match is_float {
        true => compare_floats(&mut encoder.aig, op, &a, &b),
        false => encoder.compare_bits(op, &a, &b),
    }
}

/// A comparison of two floats of 32 bits: those without a number fail all but `!=`.
fn compare_floats(aig: &mut Aig, op: CmpOp, a: &[Lit], b: &[Lit]) -> Lit {
    let mut is_number = |bits: &[Lit]| {
        let is_special = aig.all(bits[23..31].iter().copied());
        let has_fraction = aig.nonzero(&bits[..23]);
        !aig.and(is_special, has_fraction)
    };
    let (a_is, b_is) = (is_number(a), is_number(b));
    let ordered = aig.and(a_is, b_is);
    // Both zeros are 0; the other negative floats are the larger the smaller their bits are.
    let mut rank = |bits: &[Lit]| {
        let size = unsigned(&bits[..31], 32);
        let negative = aig.neg(&size);
        aig.select(bits[31], &negative, &size)
    };
    let (a, b) = (rank(a), rank(b));
    let mut holds = |op| match op {
        CmpOp::Eq => aig.equal(&a, &b),
        CmpOp::Ne => !aig.equal(&a, &b),
        CmpOp::Lt => aig.less(&a, &b),
        CmpOp::Le => !aig.less(&b, &a),
        CmpOp::Gt => aig.less(&b, &a),
        CmpOp::Ge => !aig.less(&a, &b),
    };
    match op {
        CmpOp::Ne => {
            let equal = holds(CmpOp::Eq);
            !aig.and(ordered, equal)
        }
        op => {
            let holds = holds(op);
            aig.and(ordered, holds)
        }
    }
}

/// The 32 bits of a number after the scan.
fn number(encoder: &mut Encoder, of: &Number) -> Bits {
    match of {
        Number::Constant(value) => constant((*value).into(), 32),
        Number::Float(value) => constant(value.to_bits().into(), 32),
        Number::Of(target) => signed(&value(encoder, *target), 32),
        Number::Was(of) => {
            let width = of.kind().width() as usize;
            let now = number(encoder, of)[..width].to_vec();
            let (begun, was_begun) = encoder.monitor(1, 0);
            encoder.remember(begun, vec![Lit::TRUE]);
            let (memory, before) = encoder.monitor(width, 0);
            let before = encoder.aig.select(was_begun[0], &before, &now);
            encoder.remember(memory, now);
            signed(&before, 32)
        }
        Number::Calc(calc) => {
            let (a, b) = (number(encoder, &calc.a), number(encoder, &calc.b));
            match calc.kind {
                NumberKind::Float => encoder.fresh(32, FLOATS),
                kind => {
                    let width = kind.width() as usize;
                    signed(&calculated(&mut encoder.aig, calc.op, &a, &b)[..width], 32)
                }
            }
        }
    }
}

/// Calculations that are not modelled.
const FLOATS: &str = "arithmetic of floats in a condition";

/// The result of an operation on integers of 32 bits, whose low bits are those of narrower integers, too.
fn calculated(aig: &mut Aig, op: CalcOp, a: &[Lit], b: &[Lit]) -> Bits {
    let divided = |aig: &mut Aig, which: fn((Bits, Bits)) -> Bits| {
        let result = which(aig.divide_signed(a, b));
        let divides = aig.nonzero(b);
        aig.select(divides, &result, &constant(0, result.len()))
    };
    match op {
        CalcOp::Add => aig.add(a, b),
        CalcOp::Sub => aig.sub(a, b),
        CalcOp::Mul => aig.mul(a, b),
        CalcOp::Div => divided(aig, |(quotient, _)| quotient),
        CalcOp::Rem => divided(aig, |(_, rest)| rest),
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
    let mut solver = Solver::new(&Limit::new(LIMIT, None));
    let all: Vec<_> = system.constraints.iter().chain([&system.bad]).collect();
    let all: Vec<_> = all
        .into_iter()
        .map(|&lit| solver.lit(&system.aig, lit))
        .collect();
    solver.solve(&all) != Answer::Unsat
}

/// Limit of the effort for the question whether a condition is possible, which has no program in it.
const LIMIT: u64 = 5000;

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
        Property::Stays {
            after,
            holds,
            until,
        } => {
            let begins = after.as_ref().map(&mut of);
            let (holds, until) = (of(holds), of(until));
            let begins = begins.unwrap_or(holds);
            let (memory, before) = encoder.monitor(1, 0);
            let either = encoder.aig.or(before[0], begins);
            let must_hold = encoder.aig.and(either, !until);
            encoder.remember(memory, vec![must_hold]);
            encoder.aig.and(must_hold, !holds)
        }
    };
    let running = encoder.running();
    encoder.aig.and(bad, running)
}

/// Bit that is on if the required condition is late, as [`rungc_sim::property::Deadline`] has it.
fn late(encoder: &mut Encoder, when: Lit, then: Lit, within_ms: u32) -> Lit {
    let was_on = last(encoder, when);
    let begins = encoder.aig.and(when, !was_on);
    if within_ms == 0 {
        return encoder.aig.and(begins, !then);
    }
    let (waits, waiting) = encoder.monitor(1, 0);
    let clock = Clock::new(encoder, within_ms, (waits, waiting[0]));
    let aig = &mut encoder.aig;
    let begins = aig.and(begins, !waiting[0]);
    let is_beyond = aig.nonzero(&clock.part);
    let is_above = aig.below(&clock.limit, &clock.units);
    let is_before = aig.below(&clock.units, &clock.limit);
    let is_reached = aig.and(!is_before, is_beyond);
    let is_over = aig.or(is_above, is_reached);
    let is_missed = aig.and(!is_before, !then);
    let is_late = aig.or(is_over, is_missed);
    let late = aig.and(waiting[0], is_late);
    let still = aig.or(waiting[0], begins);
    let still = aig.and(still, !then);
    encoder.remember(waits, vec![still]);
    clock.store(encoder, still);
    late
}

#[cfg(test)]
pub(crate) mod tests;
