//! Forced devices.

use crate::target::Target;

/// Devices that keep a value whatever the program does, in the order in which they were forced.
#[derive(Clone, Debug, Default)]
pub struct Forced(Vec<(Target, f64)>);

impl Forced {
    /// Each with its value.
    pub fn iter(&self) -> impl Iterator<Item = (Target, f64)> + '_ {
        self.0.iter().copied()
    }

    /// Returns true if no device is forced.
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Checks that no other name of the same devices is forced.
    pub(super) fn check(&self, target: Target) -> Result<(), String> {
        match self.iter().find(|(other, _)| overlap(*other, target)) {
            Some((other, _)) => Err(format!("release {other} first, which is forced")),
            None => Ok(()),
        }
    }

    pub(super) fn insert(&mut self, target: Target, value: f64) {
        self.0.retain(|(other, _)| *other != target);
        self.0.push((target, value));
    }

    pub(super) fn remove(&mut self, target: Target) -> Result<(), String> {
        let at = self.0.iter().position(|(other, _)| *other == target);
        self.0
            .remove(at.ok_or_else(|| format!("{target} is not forced"))?);
        Ok(())
    }
}

/// Returns true if two names, which are not the same, have a device in common.
fn overlap(one: Target, other: Target) -> bool {
    let [
        (class, first, count),
        (other_class, other_first, other_count),
    ] = [one, other].map(|target| target.devices(0));
    one != other
        && class == other_class
        && first < other_first + other_count
        && other_first < first + count
}
