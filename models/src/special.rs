//! Special relays M8000… and special registers D8000…: what each means on each model, and whether it works.
//!
//! A number that a table does not hold has no meaning on the model (the manual calls it reserved, or says nothing).

mod hm;
mod inovance;
mod l01s;
mod mitsubishi;

use crate::ModelId;
use rungc_syntax::DeviceClass;
use std::ops::RangeInclusive;

/// Whether a program may write it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Access {
    /// The PLC writes it; a program should only read it.
    Read,
    /// A program may write it.
    ReadWrite,
}

/// Whether it does what it means.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Status {
    /// The scan driver keeps it.
    Scan,
    /// These instructions read or write it.
    Instructions(&'static str),
    /// It is a plain relay or register here, for this reason.
    Inert(Reason),
}

/// Why a special device is inert, and what a program that relies on it misses.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Reason {
    /// The reason, as the end of a sentence.
    pub text: &'static str,
    /// Who misses it.
    pub missed: Missed,
}

/// Which programs behave differently because a special device is inert.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Missed {
    /// None: it serves people and their tools, or reports faults that cannot happen here.
    Never,
    /// Those that write it.
    ByWriters,
    /// Those that write it, and those that read it and wait for it to change.
    ByAll,
}

/// Special devices `first` to `last` of one class.
#[derive(Clone, Copy, Debug)]
pub struct Special {
    /// M or D.
    pub class: DeviceClass,
    /// First number.
    pub first: u32,
    /// Last number, inclusive.
    pub last: u32,
    /// Whether a program may write it.
    pub access: Access,
    /// Value at power-on.
    pub default: i16,
    /// Whether it works.
    pub status: Status,
    /// What it means.
    pub meaning: &'static str,
}

impl Special {
    /// Whether it does what it means.
    pub fn works(&self) -> bool {
        !matches!(self.status, Status::Inert(_))
    }

    /// Whether the scan driver keeps it.
    pub fn is_kept_by_scan(&self) -> bool {
        matches!(self.status, Status::Scan)
    }
}

/// What a special device means on a model.
pub fn find(model: ModelId, class: DeviceClass, number: u32) -> Option<&'static Special> {
    tables(model).iter().find_map(|table| {
        let after = table.partition_point(|row| (row.class, row.first) <= (class, number));
        let row = table.get(after.checked_sub(1)?)?;
        (row.class == class && number <= row.last).then_some(row)
    })
}

/// All special devices of a model, table by table.
pub fn all(model: ModelId) -> impl Iterator<Item = &'static Special> {
    tables(model).iter().copied().flatten()
}

/// The tables of a model: each sorted by class and number, none holding what another holds.
const fn tables(model: ModelId) -> &'static [&'static [Special]] {
    match model {
        ModelId::H1u => &[inovance::BOTH, inovance::H1U],
        ModelId::H2u => &[inovance::BOTH, inovance::H2U],
        ModelId::L01s => &[l01s::L01S],
        ModelId::Hm => &[hm::HM],
        ModelId::Fx1s => &[
            mitsubishi::ALL,
            mitsubishi::FAST_TIMERS,
            mitsubishi::D8145,
            mitsubishi::FX1,
            mitsubishi::FX1S,
        ],
        ModelId::Fx1n => &[
            mitsubishi::ALL,
            mitsubishi::FROM_FX1N,
            mitsubishi::D8145,
            mitsubishi::FX1,
            mitsubishi::FX1N,
        ],
        ModelId::Fx2n | ModelId::Fx2nCompatible => &[
            mitsubishi::ALL,
            mitsubishi::FROM_FX1N,
            mitsubishi::FROM_FX2N,
            mitsubishi::NOT_FX3S,
            mitsubishi::D8145,
            mitsubishi::FX2N,
        ],
        ModelId::Fx3s => &[
            mitsubishi::ALL,
            mitsubishi::FROM_FX1N,
            mitsubishi::FROM_FX2N,
            mitsubishi::FAST_TIMERS,
            mitsubishi::FX3,
            mitsubishi::FX3SG,
            mitsubishi::FX3S,
        ],
        ModelId::Fx3g => &[
            mitsubishi::ALL,
            mitsubishi::FROM_FX1N,
            mitsubishi::FROM_FX2N,
            mitsubishi::NOT_FX3S,
            mitsubishi::FX3,
            mitsubishi::FX3GU,
            mitsubishi::FX3SG,
            mitsubishi::FX3G,
        ],
        ModelId::Fx3u | ModelId::Fx3uCompatible => &[
            mitsubishi::ALL,
            mitsubishi::FROM_FX1N,
            mitsubishi::FROM_FX2N,
            mitsubishi::NOT_FX3S,
            mitsubishi::FX3,
            mitsubishi::FX3GU,
            mitsubishi::FX3U,
        ],
    }
}

/// Relays that forbid interrupts (l01s-programming §6.4).
const MASKS: &[RangeInclusive<u32>] = &[8050..=8059];
/// Relays with which a program steers DSZR and clear signals (h1u-h2u-programming §4.3.11).
const HOME_H2U: &[RangeInclusive<u32>] = &[
    8441..=8442,
    8445..=8446,
    8449..=8449,
    8451..=8452,
    8455..=8456,
    8459..=8459,
    8461..=8462,
    8465..=8466,
    8469..=8469,
    8484..=8486,
];

/// Relays with which a program of FX3G and FX3U steers positioning.
const HOME_FX3: &[RangeInclusive<u32>] = &[
    8338..=8338,
    8341..=8342,
    8345..=8346,
    8349..=8349,
    8351..=8352,
    8355..=8356,
    8359..=8359,
    8361..=8362,
    8365..=8366,
    8369..=8369,
    8371..=8372,
    8375..=8376,
    8379..=8379,
    8464..=8467,
];

/// Relays with which a program of FX3U steers DVIT.
const DVIT: &[RangeInclusive<u32>] = &[
    8336..=8336,
    8347..=8347,
    8357..=8357,
    8367..=8367,
    8377..=8377,
    8460..=8463,
];

/// Relays that go off when the model goes from RUN to STOP.
pub fn cleared_in_stop(model: ModelId) -> impl Iterator<Item = u32> {
    let relays: &'static [&'static [RangeInclusive<u32>]] = match model {
        ModelId::H1u | ModelId::H2u => &[HOME_H2U],
        ModelId::L01s | ModelId::Fx1s | ModelId::Fx1n | ModelId::Fx2n | ModelId::Fx2nCompatible => {
            &[MASKS]
        }
        ModelId::Fx3s | ModelId::Fx3g => &[MASKS, HOME_FX3],
        ModelId::Fx3u | ModelId::Fx3uCompatible => &[MASKS, HOME_FX3, DVIT],
        ModelId::Hm => &[],
    };
    relays.iter().copied().flatten().cloned().flatten()
}

const fn because(missed: Missed, text: &'static str) -> Reason {
    Reason { text, missed }
}

// Why a device is inert.
const POWER: Reason = because(Missed::Never, "power supply and battery are not watched");
const HARDWARE: Reason = because(
    Missed::Never,
    "there is no hardware here that could fail so",
);
const CHECKED: Reason = because(
    Missed::Never,
    "errors of this kind are found before the program runs",
);
const HOST: Reason = because(
    Missed::ByWriters,
    "the host decides when scans begin and whether the PLC is in RUN",
);
const FAST: Reason = because(
    Missed::ByWriters,
    "this use of high-speed inputs is not implemented yet",
);
const UNCLEAR: Reason = because(
    Missed::ByWriters,
    "the manual calls it a position in Hz, and that of Y0 reserved; positions are counted in D8140 and its like",
);
const LATER: Reason = because(
    Missed::ByWriters,
    "the model does not do this yet, says its manual",
);
const SERIAL: Reason = because(Missed::ByAll, "serial communication is not implemented yet");
const PORTS: Reason = because(Missed::Never, SERIAL.text);
const CAN: Reason = because(Missed::ByAll, "CAN communication is not implemented yet");
const CARDS: Reason = because(Missed::ByAll, "extension cards are not implemented yet");
const AXES: Reason = because(Missed::Never, "input axes do not show this yet");
const LINK: Reason = because(Missed::ByAll, "links between PLCs are not implemented yet");
const TRACE: Reason = because(Missed::Never, "sampling traces are a matter of the editor");
const INTERRUPTS: Reason = because(
    Missed::Never,
    "interrupts of this kind are not implemented yet",
);
const NETWORK: Reason = because(Missed::ByAll, "network cards are not implemented");
const RAW: Reason = because(
    Missed::ByWriters,
    "analog channels show the raw values of the host, each scan",
);
const LATCHES: Reason = because(
    Missed::ByWriters,
    "the latched ranges are the manual's and do not change",
);
const MODULES: Reason = because(
    Missed::Never,
    "which modules are there is the host's affair",
);
const MODES: Reason = because(
    Missed::Never,
    "an output does what the program uses it for, whatever its mode",
);
const MAKER: Reason = because(Missed::Never, "it serves the maker's tools only");

/// Writes a table of special devices, a row a line:
/// `class first[-last] access default status "meaning";` with the access `r` or `rw` and the status `scan`, `by("…")` or
/// `inert(…)`.
macro_rules! specials {
    ($($class:ident $first:literal $(- $last:literal)? $access:ident $default:literal $status:ident $(($why:expr))? $meaning:literal;)*) => {
        &[$($crate::special::Special {
            class: ::rungc_syntax::DeviceClass::$class,
            first: $first,
            last: $crate::special::specials!(@last $first $($last)?),
            access: $crate::special::specials!(@access $access),
            default: $default,
            status: $crate::special::specials!(@status $status $($why)?),
            meaning: $meaning,
        }),*]
    };
    (@last $first:literal) => { $first };
    (@last $first:literal $last:literal) => { $last };
    (@access r) => { $crate::special::Access::Read };
    (@access rw) => { $crate::special::Access::ReadWrite };
    (@status scan) => { $crate::special::Status::Scan };
    (@status by $instructions:expr) => { $crate::special::Status::Instructions($instructions) };
    (@status inert $why:expr) => { $crate::special::Status::Inert($why) };
}
use specials;

#[cfg(test)]
mod tests {
    use super::{Access, CAN, CARDS, MODULES, POWER, SERIAL, Status, all, find, tables};
    use crate::{Model, ModelId};
    use rungc_syntax::DeviceClass::{D, M};
    use std::collections::BTreeSet;

    #[test]
    fn tables_are_sorted_and_say_each_number_once() {
        for id in ModelId::ALL {
            let mut seen = BTreeSet::new();
            for table in tables(id) {
                for pair in table.windows(2) {
                    let (a, b) = (&pair[0], &pair[1]);
                    assert!((a.class, a.last) < (b.class, b.first), "{id:?} {a:?} {b:?}");
                }
            }
            for row in all(id) {
                for number in row.first..=row.last {
                    assert!(seen.insert((row.class, number)), "{id:?} {row:?}");
                }
            }
        }
    }

    #[test]
    fn every_special_device_exists_on_its_model() {
        for id in ModelId::ALL {
            for row in all(id) {
                let model = Model::get(id);
                // HM's axes and modules have registers among the general ones.
                let placed = row.first >= 8000 || id == ModelId::Hm && row.class == D;
                assert!(placed && !row.meaning.is_empty(), "{row:?}");
                assert!(model.has(row.class, row.first), "{id:?} {row:?}");
                assert!(model.has(row.class, row.last), "{id:?} {row:?}");
            }
        }
    }

    #[test]
    fn rows_are_found_by_model() {
        let of = |id, class, number| {
            find(id, class, number).map(|row| (row.access, row.is_kept_by_scan()))
        };
        assert_eq!(of(ModelId::H2u, M, 8000), Some((Access::Read, true)));
        assert_eq!(of(ModelId::H2u, M, 8210), Some((Access::ReadWrite, false)));
        assert_eq!(of(ModelId::H2u, M, 8010), None);
        assert_eq!(of(ModelId::Hm, M, 8034), Some((Access::ReadWrite, false)));
        assert_eq!(of(ModelId::Fx3u, M, 8034), Some((Access::ReadWrite, true)));
        let flag = find(ModelId::H1u, M, 8024).map(|row| row.status);
        assert_eq!(flag, Some(Status::Instructions("BMOV")));
        assert_eq!(
            find(ModelId::L01s, D, 8020).map(|row| row.default),
            Some(10)
        );
    }

    #[test]
    fn tables_hold_what_manuals_tell_elsewhere() {
        let of = |id, class, number| find(id, class, number).map(|row| row.status);
        // DSZR (h1u-h2u-programming §4.3.11), computer link (§5.6), CANlink 3.0 (§5.9.5), analog cards (§6.7).
        assert_eq!(
            of(ModelId::H2u, M, 8486),
            Some(Status::Instructions("DSZR"))
        );
        assert_eq!(of(ModelId::H1u, M, 8128), Some(Status::Inert(SERIAL)));
        for number in [8282, 8307, 8308] {
            assert_eq!(of(ModelId::H2u, D, number), Some(Status::Inert(CAN)));
        }
        for number in [8199, 8220, 8239] {
            assert_eq!(of(ModelId::H1u, D, number), Some(Status::Inert(CARDS)));
        }
        assert_eq!(of(ModelId::H2u, D, 8005), Some(Status::Inert(POWER)));
        // Axes and modules of HM (hm-motion-controller §7, §8.2).
        let axis = Some(Status::Instructions("axis motion"));
        assert_eq!([300, 599, 97].map(|n| of(ModelId::Hm, D, n)), [axis; 3]);
        assert_eq!(of(ModelId::Hm, D, 7142), Some(Status::Inert(MODULES)));
        assert_eq!(of(ModelId::Hm, D, 1000), None);
    }

    #[test]
    fn registers_start_with_their_defaults() {
        let words: Vec<_> = Model::get(ModelId::H2u).special_words().collect();
        assert!(words.contains(&(8000, 200)));
        assert!(words.contains(&(8002, 24)));
        // 100000 in the pair D8147, D8146.
        assert!(words.contains(&(8146, -31072)) && words.contains(&(8147, 1)));
    }
}
