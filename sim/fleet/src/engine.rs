//! Engines that run the PLCs of a group.

use rungc_models::runs::{is_counter32, rt_class};
use rungc_rt::Class;
use rungc_sim::Target;
use rungc_syntax::DeviceClass;

/// A device, as engines address it.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct At {
    /// Its class.
    pub class: Class,
    /// The contact of a timer or counter, not its current value.
    pub contact: bool,
    /// Its number.
    pub number: u32,
}

impl At {
    /// A bit: of a timer or counter its contact.
    pub fn bit(class: Class, number: u32) -> At {
        At {
            class,
            contact: matches!(class, Class::T | Class::C),
            number,
        }
    }

    /// A word: of a timer or counter its current value.
    pub fn word(class: Class, number: u32) -> At {
        At {
            class,
            contact: false,
            number,
        }
    }

    /// The devices that a target consists of, with the part of the value for each; `None` of what is not a device of
    /// the PLC itself: channels of modules, pulses, texts.
    pub fn parts(target: Target, value: f64) -> Option<Vec<(At, i32)>> {
        let integer = value as i64;
        let pair = |class: DeviceClass, number: u32, bits: i32| {
            let class = rt_class(class)?;
            let (low, high) = (bits as i16, (bits >> 16) as i16);
            Some(vec![
                (At::word(class, number), low.into()),
                (At::word(class, number + 1), high.into()),
            ])
        };
        Some(match target {
            Target::Bit(class, n) => vec![(At::bit(rt_class(class)?, n), i32::from(value != 0.0))],
            Target::Current(class, n) if is_counter32(class, n) => {
                vec![(At::word(rt_class(class)?, n), integer as i32)]
            }
            Target::Word(class, n) | Target::Current(class, n) => {
                vec![(At::word(rt_class(class)?, n), (integer as i16).into())]
            }
            Target::Pair(class, n) => pair(class, n, integer as i32)?,
            Target::Float(class, n) => pair(class, n, (value as f32).to_bits() as i32)?,
            Target::Nibbles(digits, class, n) => {
                let class = rt_class(class)?;
                let bits = 0..4 * u32::from(digits);
                bits.map(|i| (At::bit(class, n + i), (integer >> i & 1) as i32))
                    .collect()
            }
            Target::Channel(_) | Target::Text(..) | Target::Pulses(_) | Target::Frequency(_) => {
                return None;
            }
        })
    }
}

/// Reason why PLCs do not run, or no longer.
#[derive(Debug, thiserror::Error)]
pub enum FleetError {
    /// A file could not be written, or a process not be started.
    #[error("{what}: {error}")]
    Io {
        /// The file, or the command.
        what: String,
        /// The underlying I/O error.
        error: std::io::Error,
    },
    /// The C compiler rejected what was emitted.
    #[error("{command} failed:\n{output}")]
    Compiler {
        /// The command.
        command: String,
        /// The first lines of what it says.
        output: String,
    },
    /// A child ended before its time.
    #[error("the process that runs {0} ended: {1}")]
    Ended(String, String),
}

/// Error of a PLC at an instruction.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Failed {
    /// Number of the PLC, from 0.
    pub plc: u32,
    /// The PLC's code: 6706, or that of the watchdog.
    pub code: u16,
    /// Step of the instruction.
    pub step: u32,
    /// Number of occurrences.
    pub times: u64,
    /// Time of the first occurrence, in milliseconds since power-on; `None` for the error that stopped the PLC.
    pub first_ms: Option<u32>,
}

/// The PLCs of a group, from 0. All scan at the same time.
pub trait Engine {
    /// Begins a scan of all PLCs. `now_ms`: milliseconds since power-on, wrapping; `scan_us`: how long the last scan
    /// took.
    fn begin_scan(&mut self, now_ms: u32, scan_us: u32);

    /// Waits for the end of the scan.
    ///
    /// # Errors
    /// What has gone wrong since the last time: the PLCs do not run any more.
    fn end_scan(&mut self) -> Result<(), FleetError>;

    /// Announces devices to be read. An engine for which reading one by one is slow reads them together.
    fn fetch(&mut self, wanted: &mut dyn Iterator<Item = (u32, At)>) {
        let _ = wanted;
    }

    /// The value of a device between two scans: 0 or 1 of a bit; `None` if the program does not store it.
    fn read(&mut self, plc: u32, at: At) -> Option<i32>;

    /// Sets a device; `None`, and nothing is set, if the program does not store it or its 16 bits do not hold the
    /// value.
    fn write(&mut self, plc: u32, at: At, value: i32) -> Option<()>;

    /// Returns true if a PLC is in RUN.
    fn is_running(&mut self, plc: u32) -> bool;

    /// Number of PLCs in STOP, of `count`.
    fn stopped(&mut self, count: u32) -> u32 {
        (0..count).filter(|&plc| !self.is_running(plc)).count() as u32
    }

    /// Changes between RUN and STOP; false if this engine has no STOP.
    fn set_running(&mut self, plc: u32, running: bool) -> bool;

    /// The operation errors since power-on, and what stopped PLCs: one for each PLC, instruction and code.
    fn failures(&mut self) -> Vec<Failed>;

    /// Description for the summary: `64 at once in 2 processes, 607 bytes a PLC`.
    fn what(&self) -> String;

    /// The processes that it consists of beside this one.
    fn children(&self) -> Vec<u32> {
        Vec::new()
    }
}
