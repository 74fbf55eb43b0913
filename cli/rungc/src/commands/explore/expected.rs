//! Expectations of a test for a run, which fail as long as the program shows the finding.

use super::{Searched, Shown};
use crate::commands::verify::test_file::table;
use rungc_explore::{Found, What};
use rungc_rt::special::{M_OPERATION_ERROR, M_WATCHDOG, Relay};
use rungc_rt::{Class, CmpOp, Plc};
use rungc_sim::property::{Condition, Number, Property};
use rungc_syntax::DeviceClass;
use rungc_verify::replay::Setting;

/// Parts of a case in a test file beside its steps.
#[derive(Default)]
pub struct Expected {
    /// Lines of the case: rules over time.
    pub rules: Vec<String>,
    /// Values after the last step.
    pub at_end: Vec<(String, i64)>,
    /// One more scan at the end, after which that still holds.
    pub one_more: bool,
}

/// Values that devices have together.
type Values = Vec<(String, i64)>;

/// More ways are not listed.
const MOST: usize = 16;

/// The values with which a condition is as wanted: any one of these; `None` if they cannot be listed.
fn ways(condition: &Condition, wanted: bool) -> Option<Vec<Values>> {
    let both = |a: &Condition, b: &Condition| {
        let (a, b) = (ways(a, wanted)?, ways(b, wanted)?);
        let joined = a
            .iter()
            .flat_map(|a| b.iter().filter_map(move |b| joined(a, b)));
        Some(joined.collect())
    };
    let either = |a: &Condition, b: &Condition| {
        let (a, b) = (ways(a, wanted)?, ways(b, wanted)?);
        Some([a, b].concat())
    };
    let found: Vec<Values> = match condition {
        Condition::Constant(on) if *on == wanted => vec![Vec::new()],
        Condition::Constant(_) => Vec::new(),
        Condition::On(target) => vec![vec![(target.to_string(), wanted.into())]],
        Condition::Not(a) => ways(a, !wanted)?,
        Condition::And(a, b) if wanted => both(a, b)?,
        Condition::And(a, b) => either(a, b)?,
        Condition::Or(a, b) if wanted => either(a, b)?,
        Condition::Or(a, b) => both(a, b)?,
        Condition::Same(a, b) => {
            let mut all = Vec::new();
            for on in [true, false] {
                let (a, b) = (ways(a, on)?, ways(b, on == wanted)?);
                all.extend(a.iter().flat_map(|a| b.iter().filter_map(|b| joined(a, b))));
            }
            all
        }
        Condition::Compare(op, Number::Of(target), Number::Constant(value))
            if *op == if wanted { CmpOp::Eq } else { CmpOp::Ne } =>
        {
            vec![vec![(target.to_string(), i64::from(*value))]]
        }
        Condition::Compare(..) => return None,
    };
    (found.len() <= MOST).then_some(found)
}

/// Both together, unless they contradict each other.
fn joined(a: &Values, b: &Values) -> Option<Values> {
    let mut all = a.clone();
    for (name, value) in b {
        match all.iter().find(|(other, _)| other == name) {
            Some((_, other)) if other != value => return None,
            Some(_) => {}
            None => all.push((name.clone(), *value)),
        }
    }
    Some(all)
}

/// The only way.
fn only(condition: &Condition) -> Option<Values> {
    let [only] = <[Values; 1]>::try_from(ways(condition, true)?).ok()?;
    Some(only)
}

impl Searched<'_> {
    /// Values of the devices in question at the end of a run; `None` if there are none.
    pub fn after(&self, found: &Found) -> Option<Vec<Setting>> {
        let mut after = None;
        let property = match found.what {
            What::Property(number) => Some(&self.requested[number].property),
            What::Doubled(_) | What::Oscillation(_) => None,
            What::Error { .. } | What::Watchdog { .. } | What::Collision(_) => return None,
        };
        // A run that was found can be followed.
        let _ = self.follow(found, &mut |_, runner| {
            let machine = runner.machine();
            let mut values = property.map_or_else(Vec::new, |property| property.values(machine));
            if let What::Doubled(n) | What::Oscillation(n) = found.what {
                let on = machine.bit(Class::Y, n) == Some(true);
                let name = DeviceClass::Y.number(n).to_string();
                values.push((name, (DeviceClass::Y, n), on.into()));
            }
            after = Some(values);
            Ok(())
        });
        after
    }

    /// Expectations of a test for the run.
    pub fn expected(&self, shown: &Shown) -> Expected {
        let mut expected = Expected::default();
        let last = shown.story.last();
        let after = last.map_or(&[][..], |last| &last.after);
        let after: Values = after.iter().map(|(n, _, v)| (n.clone(), *v)).collect();
        let relay = |relay: Relay| vec![(DeviceClass::M.number(relay.number()).to_string(), 0)];
        match &shown.found.what {
            What::Property(number) => {
                let property = &self.requested[*number].property;
                match rules(property) {
                    Some(Rule::OverTime(rule)) => expected.rules.push(rule),
                    Some(Rule::AtEnd(values)) => expected.at_end = values,
                    None if property.is_wanted() => expected.at_end = after,
                    None => expected.rules.push(never(&[after])),
                }
            }
            What::Error { .. } => expected.at_end = relay(self.module.model.error_relay),
            What::Watchdog { .. } => {
                let own = self.module.model.error_relay;
                let has_own = own.number() != M_OPERATION_ERROR.number();
                expected.at_end = relay(if has_own { own } else { M_WATCHDOG });
            }
            What::Doubled(n) => {
                expected.at_end = vec![(DeviceClass::Y.number(*n).to_string(), 1)];
            }
            What::Oscillation(_) => {
                expected.at_end = after;
                expected.one_more = true;
            }
            What::Collision(_) => {}
        }
        expected
    }
}

enum Rule {
    OverTime(String),
    AtEnd(Values),
}

fn never(ways: &[Values]) -> String {
    let ways: Vec<String> = ways.iter().map(|values| table(values)).collect();
    format!("never = [{}]", ways.join(", "))
}

/// A property as a rule of test files, if it can be one.
fn rules(property: &Property) -> Option<Rule> {
    let over_time = |ways: Vec<Values>| {
        let some = !ways.is_empty() && ways.iter().all(|values| !values.is_empty());
        some.then(|| Rule::OverTime(never(&ways)))
    };
    match property {
        Property::Never(a) => over_time(ways(a, true)?),
        Property::Always(a) => over_time(ways(a, false)?),
        Property::Reachable(_) => None,
        Property::Whenever {
            when,
            then,
            within_ms,
        } => {
            let (when, then) = (table(&only(when)?), table(&only(then)?));
            let within = match within_ms {
                0 => String::new(),
                ms => format!(", within_ms = {ms}"),
            };
            let rule = format!("whenever = [{{ when = {when}, then = {then}{within} }}]");
            Some(Rule::OverTime(rule))
        }
        Property::Stays { holds, .. } => only(holds).map(Rule::AtEnd),
    }
}
