//! Devices that GX Works2 reserves for labels without a device, for temporaries and for jumps, as it sets them for a
//! new project of each CPU.

use rungc_models::{Model, ModelId};
use rungc_syntax::DeviceClass;

/// First and last number of the devices of one class.
pub(crate) type Range = (u32, u32);

/// The reserved devices of a CPU.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ranges {
    pub d: Range,
    pub t: Range,
    pub c: Range,
    pub m: Range,
    pub p: Range,
    /// Timers of 10 ms.
    pub ticks: Option<Range>,
}

const fn ranges(d: Range, t: Range, c: Range, m: Range, p: Range) -> Ranges {
    Ranges {
        d,
        t,
        c,
        m,
        p,
        ticks: Some((220, 245)),
    }
}

/// The ranges of a CPU without timers of 10 ms for programs.
const fn without_ticks(of: Ranges) -> Ranges {
    Ranges { ticks: None, ..of }
}

static FX3U: Ranges = ranges(
    (512, 999),
    (100, 199),
    (100, 199),
    (3840, 7679),
    (2048, 4095),
);
static FX3G: Ranges = ranges(
    (512, 999),
    (100, 199),
    (100, 199),
    (512, 1535),
    (1024, 2047),
);
static FX3S: Ranges = without_ticks(ranges(
    (512, 999),
    (16, 31),
    (16, 31),
    (512, 1535),
    (30, 255),
));
static FX2N: Ranges = ranges((512, 999), (100, 199), (100, 199), (512, 1535), (30, 127));
static FX1N: Ranges = ranges((400, 999), (100, 199), (100, 199), (512, 1535), (30, 127));
static FX1S: Ranges = without_ticks(ranges((128, 255), (16, 31), (16, 31), (256, 511), (30, 62)));

/// The reserved devices for a model. Models of other makers have those of the Mitsubishi model whose projects they
/// take.
pub(crate) fn of(model: &Model) -> &'static Ranges {
    match model.id {
        ModelId::Fx3u | ModelId::Fx3uCompatible => &FX3U,
        ModelId::Fx3g | ModelId::L01s => &FX3G,
        ModelId::Fx3s => &FX3S,
        ModelId::Fx2n | ModelId::Fx2nCompatible | ModelId::H2u | ModelId::Hm => &FX2N,
        ModelId::Fx1n | ModelId::H1u => &FX1N,
        ModelId::Fx1s => &FX1S,
    }
}

/// Numbers of one class that are not taken yet.
#[derive(Clone, Debug)]
pub(crate) struct Free {
    pub class: DeviceClass,
    first: u32,
    /// One past the last.
    end: u32,
    /// One past the last of the range.
    limit: u32,
    /// Lowest value of `end`.
    lowest: u32,
}

impl Free {
    pub(crate) fn new(class: DeviceClass, (first, last): Range) -> Free {
        Free {
            class,
            first,
            end: last + 1,
            limit: last + 1,
            lowest: last + 1,
        }
    }

    /// The first of `count` numbers from the top.
    pub(crate) fn take_top(&mut self, count: u32) -> Option<u32> {
        let first = self
            .end
            .checked_sub(count)
            .filter(|first| *first >= self.first)?;
        self.end = first;
        self.lowest = self.lowest.min(first);
        Some(first)
    }

    /// Number of those that are left.
    pub(crate) fn left(&self) -> u32 {
        self.end.saturating_sub(self.first)
    }

    /// Number of all, taken or not.
    pub(crate) fn total(&self) -> u32 {
        self.limit - self.first
    }

    /// Returns to an earlier state: what was taken since is free again.
    pub(crate) fn release(&mut self, earlier: &Free) {
        self.end = earlier.end;
    }

    /// Leaves this many numbers at the end of the range.
    pub(crate) fn leave(&mut self, count: u32) {
        self.end = self
            .end
            .min(self.limit.saturating_sub(count))
            .max(self.first);
    }

    /// Leaves out all numbers that were ever taken.
    pub(crate) fn settle(&mut self) {
        self.end = self.end.min(self.lowest);
    }

    /// Leaves out a number that is taken already, and those above it.
    pub(crate) fn avoid(&mut self, number: u32) {
        if (self.first..self.end).contains(&number) {
            self.end = number;
        }
    }

    /// The lowest number.
    pub(crate) fn take_bottom(&mut self) -> Option<u32> {
        let number = self.first;
        (number < self.end).then(|| self.first += 1)?;
        Some(number)
    }
}
