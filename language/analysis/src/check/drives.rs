//! Drives of instructions: the contacts before each, and those of the master controls around it, as far as they are
//! known independently of their devices' values.

use super::{Code, Part};
use rungc_catalogue::{Basic, Join, Lower};
use rungc_syntax::{Device, DeviceClass};
use rustc_hash::{FxHashSet, FxHasher};
use std::hash::{Hash, Hasher};

/// The result of some contacts.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Drive {
    /// Equal for equal contacts, joined in the same way.
    pub(super) signature: u64,
    /// Duration of its result.
    pub(super) lasts: Lasts,
    /// The same without the master controls around it.
    pub(super) in_zone: Lasts,
    /// The device of the contact, if it is only one, and true if it is normally open.
    pub(super) contact: Option<(Device, bool)>,
}

/// Duration of a result once it is on.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Lasts {
    /// As long as the program runs.
    Always,
    /// For many scans: it depends on inputs and slow clocks alone.
    Long,
    /// For one scan, or less: an edge is in series with the rest.
    Once,
    /// That depends on what the program does.
    Unknown,
}

/// Follows the contact logic through a program.
#[derive(Default)]
pub(super) struct Drives {
    stack: Vec<Drive>,
    branches: Vec<Drive>,
    /// Relays that are known to be on for one scan.
    pulses: FxHashSet<Device>,
    /// Open master controls: the level of each, and the drive of its zone.
    zones: Vec<(u32, Drive)>,
}

/// The left bus bar.
const BUS: Drive = Drive {
    signature: 0,
    lasts: Lasts::Always,
    in_zone: Lasts::Always,
    contact: None,
};

impl Drives {
    /// With relays that are on for one scan each time.
    pub(super) fn with_pulses(pulses: FxHashSet<Device>) -> Self {
        Drives {
            pulses,
            ..Drives::default()
        }
    }

    /// Takes instruction `i`, the next of the program; what drives it, if it is one that contacts drive.
    pub(super) fn next(&mut self, code: &Code, i: usize) -> Option<Drive> {
        match code.part(i) {
            Part::Start => self.stack.push(self.contact(code, i)),
            Part::Continue => {
                let result = self.stack.pop().unwrap_or(BUS);
                self.stack.push(self.joined(result, code, i));
            }
            part @ (Part::JoinSeries | Part::JoinParallel) => {
                let right = self.stack.pop().unwrap_or(BUS);
                let left = self.stack.pop().unwrap_or(BUS);
                self.stack.push(left.with(right, part == Part::JoinSeries));
            }
            Part::Push => self.branches.push(self.top()),
            Part::Read => self.replace(self.branches.last().copied()),
            Part::Pop => {
                let branch = self.branches.pop();
                self.replace(branch);
            }
            Part::Output => {
                let drive = self.in_zone(self.top());
                if code.basic(i) == Some(Basic::Mc) {
                    self.zones.push((level(code, i), drive));
                }
                return Some(drive);
            }
            Part::Alone | Part::Unknown => {
                self.stack.clear();
                self.branches.clear();
                self.end_zones(code, i);
            }
            Part::Nothing => {}
        }
        None
    }

    /// A drive together with that of the zone that it is in.
    fn in_zone(&self, drive: Drive) -> Drive {
        match self.zones.last() {
            Some((_, zone)) => Drive {
                in_zone: drive.lasts,
                ..zone.with(drive, true)
            },
            None => drive,
        }
    }

    /// Leaves the zones that instruction `i` ends.
    fn end_zones(&mut self, code: &Code, i: usize) {
        match code.basic(i) {
            Some(Basic::Mcr) => {
                let ended = level(code, i);
                self.zones.retain(|&(level, _)| level < ended);
            }
            Some(Basic::Fend | Basic::End | Basic::Sret | Basic::Iret | Basic::Pret) => {
                self.zones.clear();
            }
            _ => {}
        }
    }

    fn top(&self) -> Drive {
        self.stack.last().copied().unwrap_or(BUS)
    }

    fn replace(&mut self, drive: Option<Drive>) {
        self.stack.pop();
        self.stack.push(drive.unwrap_or(BUS));
    }

    /// A result with the contact, or the change of the result, of instruction `i`.
    fn joined(&self, result: Drive, code: &Code, i: usize) -> Drive {
        let series = match code.basic(i) {
            Some(Basic::And | Basic::Ani) => true,
            Some(Basic::Or | Basic::Ori) => false,
            // An edge, a comparison or a change of the result.
            _ => {
                let lasts = changed(result.lasts, code, i);
                return Drive {
                    signature: hashed(&(result.signature, signature(code, i))),
                    lasts,
                    in_zone: lasts,
                    contact: None,
                };
            }
        };
        result.with(self.contact(code, i), series)
    }

    /// The contact of an instruction by itself.
    fn contact(&self, code: &Code, i: usize) -> Drive {
        let drive = contact(code, i);
        let is_pulse =
            matches!(drive.contact, Some((device, true)) if self.pulses.contains(&device));
        match is_pulse {
            true => Drive {
                lasts: Lasts::Once,
                in_zone: Lasts::Once,
                ..drive
            },
            false => drive,
        }
    }
}

/// Duration of a result after an edge, a comparison or a change of it that instruction `i` adds.
fn changed(result: Lasts, code: &Code, i: usize) -> Lasts {
    let (edge, series) = match (code.basic(i), code.lower(i)) {
        (Some(Basic::Andp | Basic::Andf | Basic::Mep | Basic::Mef), _) => (true, true),
        (Some(Basic::Orp | Basic::Orf), _) => (true, false),
        (_, Some(Lower::Compare(Join::And, _))) => (false, true),
        _ => return Lasts::Unknown,
    };
    let both = edge && result == Lasts::Once;
    let either = series && (edge || result == Lasts::Once);
    if both || either {
        Lasts::Once
    } else {
        Lasts::Unknown
    }
}

impl Drive {
    fn with(self, other: Drive, series: bool) -> Drive {
        use Lasts::{Always, Long, Once, Unknown};
        let lasts = match (self.lasts, other.lasts) {
            (Once, Once) => Once,
            (Once, _) | (_, Once) if series => Once,
            (Unknown | Once, _) | (_, Unknown | Once) => Unknown,
            (Always, one) | (one, Always) if series => one,
            (Always, _) | (_, Always) => Always,
            (Long, Long) => Long,
        };
        let signature = hashed(&(self.signature, other.signature, series));
        let contact = None;
        Drive {
            signature,
            lasts,
            in_zone: lasts,
            contact,
        }
    }
}

/// The level of a master control, or of its end.
pub(super) fn level(code: &Code, i: usize) -> u32 {
    code.device(i, 0).map_or(0, |level| level.number)
}

/// The contact of an instruction by itself.
fn contact(code: &Code, i: usize) -> Drive {
    /// M8000, on while the program runs, and its inverse.
    const RUNS: [u32; 2] = [8000, 8001];
    /// M8002, on in the first scan, and its inverse.
    const BEGINS: [u32; 2] = [8002, 8003];
    /// The clocks of a second and of a minute, which are on for many scans.
    const CLOCKS: [u32; 2] = [8013, 8014];
    let normally_open = match code.basic(i) {
        Some(Basic::Ld | Basic::And | Basic::Or) => Some(true),
        Some(Basic::Ldi | Basic::Ani | Basic::Ori) => Some(false),
        _ => None,
    };
    let lasts = match (code.device(i, 0), normally_open) {
        _ if matches!(code.basic(i), Some(Basic::Ldp | Basic::Ldf)) => Lasts::Once,
        (
            Some(Device {
                class: DeviceClass::X,
                ..
            }),
            Some(_),
        ) => Lasts::Long,
        (
            Some(Device {
                class: DeviceClass::M,
                number,
            }),
            Some(open),
        ) => {
            if number == RUNS[usize::from(!open)] {
                Lasts::Always
            } else if number == BEGINS[usize::from(!open)] {
                Lasts::Once
            } else if CLOCKS.contains(&number) {
                Lasts::Long
            } else {
                Lasts::Unknown
            }
        }
        _ => Lasts::Unknown,
    };
    let signature = hashed(&(signature(code, i), normally_open));
    Drive {
        signature,
        lasts,
        in_zone: lasts,
        contact: code.device(i, 0).zip(normally_open),
    }
}

/// Signature of an instruction's devices, whichever way it joins the logic.
fn signature(code: &Code, i: usize) -> u64 {
    if let (Some(basic), Some(device)) = (code.basic(i), code.device(i, 0)) {
        return match basic {
            Basic::Ld | Basic::Ldi | Basic::And | Basic::Ani | Basic::Or | Basic::Ori => {
                hashed(&device)
            }
            edge => hashed(&(edge as u32, device)),
        };
    }
    hashed(&code.instr(i).to_string())
}

fn hashed(what: &impl Hash) -> u64 {
    let mut hasher = FxHasher::default();
    what.hash(&mut hasher);
    hasher.finish()
}
