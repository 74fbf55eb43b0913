//! Distance of a state from one that violates a property, as a guide for a search.

use rungc_rt::CmpOp;
use rungc_sim::property::{Condition, Devices, Number, Property, read};

/// Distance from the event of a property: 0 is there, larger is farther.
pub fn distance(property: &Property, devices: &impl Devices) -> f64 {
    let of = |condition: &Condition, wanted: bool| far(condition, devices, wanted);
    match property {
        Property::Never(a) | Property::Reachable(a) => of(a, true),
        Property::Always(a) => of(a, false),
        Property::Whenever { when, then, .. } => of(when, true) + of(then, false),
        Property::Stays {
            after,
            holds,
            until,
        } => {
            let began = match after {
                Some(after) => of(after, true) + of(holds, false),
                None => of(holds, true).min(of(holds, false) + 0.5),
            };
            began + of(until, false)
        }
    }
}

/// Distance from a state in which a condition has a value: 1 for each bit, at most 1 for a comparison.
fn far(condition: &Condition, devices: &impl Devices, wanted: bool) -> f64 {
    match condition {
        Condition::Not(a) => far(a, devices, !wanted),
        Condition::And(a, b) | Condition::Or(a, b) => {
            let (a, b) = (far(a, devices, wanted), far(b, devices, wanted));
            match matches!(condition, Condition::And(..)) == wanted {
                true => a + b,
                false => a.min(b),
            }
        }
        Condition::Compare(op, a, b) if condition.holds(devices) != wanted => {
            let [Some(a), Some(b)] = [a, b].map(|number| match *number {
                Number::Constant(value) => Some(value),
                Number::Of(target) => Some(read(devices, target)),
                Number::Float(_) | Number::Was(_) | Number::Calc(_) => None,
            }) else {
                return 1.0;
            };
            let apart = f64::from(a.abs_diff(b));
            let apart = match op {
                CmpOp::Ne if wanted => 1.0,
                _ => apart + 1.0,
            };
            (apart.ln_1p() / 24.0).min(1.0)
        }
        _ => match condition.holds(devices) == wanted {
            true => 0.0,
            false => 1.0,
        },
    }
}
