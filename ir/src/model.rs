//! The PLC models: which devices each has, which of them are latched, what its timers and counters are.

use rungc_rt::TimerKind;
use rungc_syntax::DeviceClass;

/// A PLC model.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, Hash)]
#[repr(u8)]
pub enum ModelId {
    /// Inovance H1U.
    H1u,
    /// Inovance H2U.
    H2u,
    /// Coolmay L01S.
    L01s,
    /// Kewei HM motion controller.
    Hm,
    /// Mitsubishi FX2N/FX2NC (and what is older: FX0, FX1, FX1N, FX1S read as FX2N).
    Fx2n,
    /// Mitsubishi FX3G/FX3S.
    Fx3g,
    /// Mitsubishi FX3U/FX3UC.
    Fx3u,
}

/// A set of models.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct ModelSet(u8);

impl ModelSet {
    /// Every model.
    pub const ALL: ModelSet = ModelSet(0x7f);
    /// No model.
    pub const NONE: ModelSet = ModelSet(0);

    /// These models.
    pub const fn of(models: &[ModelId]) -> Self {
        let mut bits = 0;
        let mut i = 0;
        while i < models.len() {
            bits |= 1 << models[i] as u8;
            i += 1;
        }
        ModelSet(bits)
    }

    /// All of these but `models`.
    #[must_use]
    pub const fn except(self, models: &[ModelId]) -> Self {
        ModelSet(self.0 & !Self::of(models).0)
    }

    /// These and `models`.
    #[must_use]
    pub const fn and(self, models: &[ModelId]) -> Self {
        ModelSet(self.0 | Self::of(models).0)
    }

    /// Whether `model` is one of them.
    pub const fn has(self, model: ModelId) -> bool {
        self.0 >> model as u8 & 1 == 1
    }
}

/// A run of devices of one class.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Range {
    /// The class.
    pub class: DeviceClass,
    /// First number (a value: X010 is 8).
    pub first: u32,
    /// Last number, inclusive.
    pub last: u32,
    /// Whether it keeps its value over RUN/STOP and power-off.
    pub latched: bool,
}

/// A run of timers of one kind.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Timers {
    /// First number.
    pub first: u32,
    /// Last number, inclusive.
    pub last: u32,
    /// How they behave.
    pub kind: TimerKind,
}

/// All that is known of a model.
#[derive(Debug)]
pub struct Model {
    /// Which.
    pub id: ModelId,
    /// Name on the command line: `h2u`.
    pub name: &'static str,
    /// Name for people: `Inovance H2U`.
    pub title: &'static str,
    /// Its devices: general and special ranges of every class, P, I and N included. Sorted by class and first number, disjoint.
    pub ranges: &'static [Range],
    /// Its timers, sorted, disjoint; they cover the ranges of class T.
    pub timers: &'static [Timers],
    /// Program capacity in steps.
    pub max_steps: u32,
    /// Whether a 32-bit access to Zn takes Vn as its high word; HM takes Zn+1.
    pub z_pairs_with_v: bool,
    /// How deep FOR may nest.
    pub max_for: u32,
    /// How deep CALL may nest.
    pub max_call: u32,
    /// Special registers that start with a value other than 0: (number, value), e.g. D8000 = 200.
    pub special_words: &'static [(u32, i16)],
    /// Special data registers that are other names of index registers: (number, class, index number), e.g. D8028 is Z0.
    pub index_aliases: &'static [(u32, DeviceClass, u32)],
}

impl Model {
    /// The range that holds a device.
    pub fn range(&self, class: DeviceClass, number: u32) -> Option<&'static Range> {
        self.ranges
            .iter()
            .find(|r| r.class == class && (r.first..=r.last).contains(&number))
    }

    /// Whether the model has a device.
    pub fn has(&self, class: DeviceClass, number: u32) -> bool {
        self.range(class, number).is_some()
    }

    /// The ranges of a class, in order.
    pub fn ranges_of(&self, class: DeviceClass) -> impl Iterator<Item = &'static Range> + use<> {
        self.ranges.iter().filter(move |r| r.class == class)
    }

    /// Kind of a timer.
    pub fn timer(&self, number: u32) -> Option<TimerKind> {
        self.timers
            .iter()
            .find(|t| (t.first..=t.last).contains(&number))
            .map(|t| t.kind)
    }
}
