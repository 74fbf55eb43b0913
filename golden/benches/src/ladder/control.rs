//! Instructions driven by rungs of `control`: PID loops and their surroundings, all of them instructions for which
//! emitted C calls the runtime. They are driven in each scan, so a scan has a known number of calls.
//!
//! Targets and measured values are limited to a range, and so is the output of each loop: no value in a loop ever
//! leaves the range that the PLC would report.

use super::{Action, Chain, Contact, Device, Kind, Ladder, Rung};
use crate::random::Random;
use rungc_syntax::DeviceClass::{D, M, X};
use std::fmt::Write;

/// Words that values go to.
const WORDS: u32 = 200;
/// Targets and measured values.
const LIMITED: u32 = 200;
/// Number of these values.
const LIMITED_COUNT: u32 = 40;
/// Outputs of loops.
const OUTPUTS: u32 = 300;
/// Maximum number of loops that a program has.
pub const LOOPS: u32 = 200;
/// Words of the other instructions.
pub const REGISTERS: u32 = OUTPUTS + LOOPS;
/// Settings and work areas of loops.
pub const AREAS: u32 = 1000;
/// Words of each area.
pub const AREA: u32 = 25;

/// Always on; on in the first scan.
const ALWAYS: u32 = 8000;
const FIRST_SCAN: u32 = 8002;

/// The contact that is always on.
pub const ALWAYS_ON: Contact = Contact {
    device: (M, ALWAYS),
    negated: false,
};

/// Instruction driven by a rung of `control`. Numbers are those of devices D.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Control {
    /// Settings of a loop, in the first scan.
    Settings(u32),
    /// PID.
    Pid {
        /// Number of the loop.
        number: u32,
        /// Target.
        target: u32,
        /// Measured value.
        measured: u32,
    },
    /// LIMIT to 0–1000.
    Limit(u32, u32),
    /// BAND: how far a value is from −50–50.
    Band(u32, u32),
    /// ZONE: 100 added to a positive value, taken from a negative one.
    Zone(u32, u32),
}

use Control::*;

/// An instruction that calls the runtime.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Called {
    /// PID.
    Pid,
    /// LIMIT.
    Limit,
    /// BAND.
    Band,
    /// ZONE.
    Zone,
}

impl Called {
    /// All of them.
    pub const ALL: [Called; 4] = [Called::Pid, Called::Limit, Called::Band, Called::Zone];

    /// Its mnemonic.
    pub fn name(self) -> &'static str {
        match self {
            Called::Pid => "PID",
            Called::Limit => "LIMIT",
            Called::Band => "BAND",
            Called::Zone => "ZONE",
        }
    }
}

/// Number of settings of a loop.
const SETTINGS: usize = 9;

/// The settings of a loop: words of its area, and what they are.
fn settings(number: u32) -> [(u32, u32); SETTINGS] {
    [
        (0, 20 + 10 * (number % 4)), // sampling time, ms
        (1, 0x20 | (number & 1)),    // limits of the output; every second loop acts in reverse
        (2, 10 + 5 * (number % 5)),  // filter, %
        (3, 50 + 10 * (number % 9)), // proportional gain, %
        (4, 10 + number % 7),        // integral time, 100 ms
        (5, 30),                     // derivative gain, %
        (6, 10 * (1 + number % 2)),  // derivative time, 10 ms
        (22, 4000),                  // upper limit
        (23, 0),                     // lower limit
    ]
}

/// A target or measured value.
pub fn limited(random: &mut Random) -> u32 {
    LIMITED + random.below(LIMITED_COUNT)
}

/// First word of a loop's area.
fn area(number: u32) -> u32 {
    AREAS + AREA * number
}

impl Control {
    /// A random one; `loops` counts the loops. About how many steps it takes comes with it.
    pub fn random(random: &mut Random, loops: &mut u32) -> (u32, Control) {
        let which = random.below(6);
        let [a, b] = [0; 2].map(|_| random.below(WORDS));
        let [x, y] = [0; 2].map(|_| limited(random));
        let output = OUTPUTS + random.below((*loops).max(1));
        let control = match which {
            0 | 1 if *loops < LOOPS => {
                *loops += 1;
                Pid {
                    number: *loops - 1,
                    target: x,
                    measured: y,
                }
            }
            0 | 3 => Limit(a, x),
            1 | 2 => Limit(output, y),
            4 => Band(x, b),
            _ => Zone(output, b),
        };
        (10, control)
    }

    /// One of many that a program consists of.
    fn called(what: Called, number: u32) -> Control {
        let (word, limited) = (number % WORDS, LIMITED + number % LIMITED_COUNT);
        match what {
            Called::Pid => Pid {
                number: number % LOOPS,
                target: LIMITED,
                measured: limited,
            },
            Called::Limit => Limit(word, limited),
            Called::Band => Band(limited, word),
            Called::Zone => Zone(limited, word),
        }
    }

    /// Returns true if it sets a loop up.
    pub fn is_settings(self) -> bool {
        matches!(self, Settings(_))
    }

    /// The rung that drives it.
    pub fn rung(self) -> Rung {
        let relay = match self {
            Settings(_) => FIRST_SCAN,
            Pid { .. } | Limit(..) | Band(..) | Zone(..) => ALWAYS,
        };
        let first = Contact {
            device: (M, relay),
            negated: false,
        };
        Rung {
            chain: Chain {
                first,
                rest: Vec::new(),
            },
            block: None,
            action: Action::Control(self),
        }
    }

    /// The devices that it reads and writes.
    pub fn devices(self) -> Vec<Device> {
        match self {
            Settings(number) => (0..AREA).map(|word| (D, area(number) + word)).collect(),
            Pid {
                number,
                target,
                measured,
            } => vec![(D, target), (D, measured), (D, OUTPUTS + number)],
            Limit(a, b) | Band(a, b) | Zone(a, b) => vec![(D, a), (D, b)],
        }
    }

    /// The instructions.
    pub fn list(self, out: &mut String) {
        // Writing to a String does not fail.
        let _ = match self {
            Settings(number) => settings(number).iter().try_for_each(|(word, value)| {
                writeln!(out, "MOV K{value} D{}", area(number) + word)
            }),
            Pid {
                number,
                target,
                measured,
            } => {
                let (area, output) = (area(number), OUTPUTS + number);
                writeln!(out, "PID D{target} D{measured} D{area} D{output}")
            }
            Limit(a, b) => writeln!(out, "LIMIT K0 K1000 D{a} D{b}"),
            Band(a, b) => writeln!(out, "BAND K-50 K50 D{a} D{b}"),
            Zone(a, b) => writeln!(out, "ZONE K-100 K100 D{a} D{b}"),
        };
    }

    /// The statement that an engineer would write; for the settings, in the function that makes a controller ready.
    pub fn hand(self) -> String {
        match self {
            Settings(number) => settings(number)
                .iter()
                .map(|(word, value)| format!("p->loop[{number}].word[{word}] = {value};"))
                .collect::<Vec<_>>()
                .join(" "),
            Pid {
                number,
                target,
                measured,
            } => {
                let output = OUTPUTS + number;
                format!(
                    "pid_run(&p->loop[{number}].pid, p->D[{target}], p->D[{measured}], &p->D[{output}], dt);"
                )
            }
            Limit(a, b) => format!("p->D[{b}] = limit(0, 1000, p->D[{a}]);"),
            Band(a, b) => format!("p->D[{b}] = band(-50, 50, p->D[{a}]);"),
            Zone(a, b) => format!("p->D[{b}] = zone(-100, 100, p->D[{a}]);"),
        }
    }
}

/// The rungs that set loops up.
pub fn settings_of(loops: u32) -> impl Iterator<Item = Rung> {
    (0..loops).map(|number| Settings(number).rung())
}

/// Steps that the settings of a loop take.
pub const SETTINGS_STEPS: u32 = 1 + 5 * SETTINGS as u32;

impl Ladder {
    /// A program of nothing but `count` times the same instruction, and of moves to the words that it reads.
    pub fn of_calls(what: Called, count: u32) -> Self {
        let calls: Vec<Control> = (0..count)
            .map(|number| Control::called(what, number))
            .collect();
        let is_pid = what == Called::Pid;
        let mut rungs: Vec<Rung> = settings_of(if is_pid { count.min(LOOPS) } else { 0 }).collect();
        rungs.extend((0..LIMITED_COUNT).map(changed));
        rungs.extend(calls.iter().map(|call| call.rung()));
        Ladder {
            kind: Kind::Control,
            steps: 10 * count,
            rungs,
            sequences: Vec::new(),
        }
    }
}

/// A rung that moves one of two values to words which others read, by an input that changes.
fn changed(number: u32) -> Rung {
    let first = Contact {
        device: (X, number),
        negated: false,
    };
    Rung {
        chain: Chain {
            first,
            rest: Vec::new(),
        },
        block: None,
        action: Action::Constant(25 * number, LIMITED + number),
    }
}

/// Returns true if a device has no counterpart in the hand-written C.
pub fn is_special((class, number): Device) -> bool {
    class == M && number >= ALWAYS
}

/// Location of a register in the hand-written C: in a loop's area, or among the others.
pub fn place(number: u32) -> String {
    match number.checked_sub(AREAS) {
        Some(word) => format!("loop[{}].word[{}]", word / AREA, word % AREA),
        None => format!("D[{number}]"),
    }
}
