//! The terminals of digital modules.

use super::{Module, Quantity};

/// Millionths in a terminal that is on.
const ON: i32 = 1_000_000;

impl Module {
    /// Switches an input terminal; `None` if the module does not have it.
    pub(super) fn switch(&mut self, number: u8, on: bool) -> Option<()> {
        let [inputs, _] = self.kind().points;
        (number < inputs).then(|| {
            let bit = 1 << number;
            let now = self.points[0];
            self.points[0] = if on { now | bit } else { now & !bit };
        })
    }

    /// A terminal, in millionths; `None` if the module does not have it.
    pub(super) fn point(&self, number: u8, quantity: Quantity) -> Option<i32> {
        let which = usize::from(quantity == Quantity::OutputTerminal);
        let count = *self.kind().points.get(which)?;
        let points = *self.points.get(which)?;
        (number < count).then(|| i32::from(points >> number & 1) * ON)
    }

    /// Returns true if an input terminal is on.
    pub(super) fn is_on(&self, number: usize) -> bool {
        self.points[0] >> number & 1 == 1
    }
}
