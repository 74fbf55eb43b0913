//! An input that follows an output after a time.

use super::{Look, Moment};

/// An input that turns on when an output has been on for a time, and off when it has been off for a time.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Delay {
    output: u32,
    input: u32,
    on_ms: u32,
    off_ms: u32,
    on: bool,
    /// For how long the output has not been what the input is.
    waited_ms: u32,
}

impl Delay {
    pub(super) fn new(output: u32, input: u32, on_ms: u32, off_ms: u32) -> Self {
        Delay {
            output,
            input,
            on_ms,
            off_ms,
            on: false,
            waited_ms: 0,
        }
    }

    pub(super) fn input(&self) -> (u32, bool) {
        (self.input, self.on)
    }

    pub(super) fn looks_at(&self) -> Look {
        Look::Output(self.output)
    }

    pub(super) fn step(&mut self, see: &dyn Fn(Look) -> i32, moments: &mut Vec<Moment>) {
        let wanted = see(self.looks_at()) != 0;
        if wanted == self.on {
            self.waited_ms = 0;
            return;
        }
        self.waited_ms += 1;
        let needed = if wanted { self.on_ms } else { self.off_ms };
        if self.waited_ms >= needed {
            self.on = wanted;
            self.waited_ms = 0;
            moments.push((1.0, self.input, wanted));
        }
    }
}
