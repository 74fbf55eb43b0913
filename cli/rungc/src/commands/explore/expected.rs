//! Expectations of a test for a run, which fail as long as the program shows the finding.

use super::{Searched, Shown};
use rungc_explore::{Found, What};
use rungc_rt::special::{M_OPERATION_ERROR, M_WATCHDOG, Relay};
use rungc_rt::{Class, Plc};
use rungc_sim::property::Reading;
use rungc_syntax::DeviceClass;
use rungc_verify::replay::Setting;
use rungc_verify::written::rule;

/// Parts of a case in a test file beside its steps.
#[derive(Default)]
pub struct Expected {
    /// Lines of the case: rules over time.
    pub rules: Vec<String>,
    /// Values after the last step.
    pub at_end: Vec<(String, Reading)>,
    /// One more scan at the end, after which that still holds.
    pub one_more: bool,
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
                values.push((name, (DeviceClass::Y, n), i64::from(on).into()));
            }
            after = Some(values);
            Ok(())
        });
        after
    }

    /// Expectations of a test for the run.
    pub fn expected(&self, shown: &Shown) -> Expected {
        let mut expected = Expected::default();
        let relay = |relay: Relay| {
            let name = DeviceClass::M.number(relay.number()).to_string();
            vec![(name, Reading::Integer(0))]
        };
        match &shown.found.what {
            What::Property(number) => {
                expected.rules.push(rule(&self.requested[*number].property));
            }
            What::Error { .. } => expected.at_end = relay(self.module.model.error_relay),
            What::Watchdog { .. } => {
                let own = self.module.model.error_relay;
                let has_own = own.number() != M_OPERATION_ERROR.number();
                expected.at_end = relay(if has_own { own } else { M_WATCHDOG });
            }
            What::Doubled(n) => {
                let name = DeviceClass::Y.number(*n).to_string();
                expected.at_end = vec![(name, Reading::Integer(1))];
            }
            What::Oscillation(_) => {
                let after = shown.story.last().map_or(&[][..], |last| &last.after);
                let after = after.iter().map(|(name, _, value)| (name.clone(), *value));
                expected.at_end = after.collect();
                expected.one_more = true;
            }
            What::Collision(_) => {}
        }
        expected
    }
}
