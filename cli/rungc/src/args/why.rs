//! Arguments of `why`.

use super::{Input, PlcArgs};
use clap::Args;
use std::path::PathBuf;

/// Arguments of `why`.
#[derive(Args, Clone, Debug)]
#[command(after_help = "\
Examples:
  rungc why press.il Y000                               what can switch Y000
  rungc why press.il Y000 --set X000=1,X001=1 --for 2s  why it is on or off after 2 s
  rungc why press.il \"press valve\" --for 1s             a device by its comment
  rungc why press.il Y000 --how                         what a person can do so that it changes
  rungc why press.il Y000 --port /dev/ttyUSB0           why it is on or off in the PLC itself
  rungc why press.il Y000 --trace monday.csv --moment 35s
                                                        why it was on or off in a recording of the PLC
  rungc why press.il Y000 --for 1s --format json        the answer as an object")]
pub struct WhyArgs {
    #[command(flatten)]
    pub input: Input,
    /// Device to explain: `Y000`, `T0`, `D10`, or a comment.
    #[arg(value_name = "DEVICE")]
    pub device: Option<String>,
    /// Explain the moment after this virtual time: `200ms`, `5s`, `2min`; a bare number is milliseconds. Default: 1s if
    /// a device is set, there is a machine, or `--how` asks; else the program alone is explained.
    #[arg(long = "for", conflicts_with = "plc", value_parser = crate::time::parse, value_name = "TIME")]
    pub duration: Option<u64>,
    /// Scan time, in virtual time; a longer constant scan time of the program takes precedence. Default: the program's
    /// constant scan time, or 10ms.
    #[arg(long, value_parser = crate::time::parse, value_name = "TIME")]
    pub scan: Option<u64>,
    /// Set a device at a time, as for `rungc run`: `X000=1@200ms`; may be repeated or separated by commas.
    #[arg(long, conflicts_with = "plc", value_name = "DEVICE=VALUE[@TIME]")]
    pub set: Vec<String>,
    /// Simulated machine, whose axes, cylinders and delays follow the outputs and drive inputs (`rungc book machines`).
    #[arg(long, conflicts_with = "plc", value_name = "FILE")]
    pub machine: Option<PathBuf>,
    /// Compare the program in the PLC with the file first, which takes as long as `rungc read`.
    #[arg(long, requires = "port", conflicts_with_all = ["mc", "modbus", "trace"])]
    pub compare: bool,
    #[command(flatten)]
    pub plc: PlcArgs,
    /// Explain a moment of this recording, which `rungc watch --all --to csv` prints.
    #[arg(long, group = "plc", value_name = "FILE")]
    pub trace: Option<PathBuf>,
    /// Time of the moment in the recording. Default: its end.
    #[arg(long, requires = "trace", value_parser = crate::time::parse, value_name = "TIME")]
    pub moment: Option<u64>,
    /// Search for what a person can do from that moment on so that the device changes.
    #[arg(long)]
    pub how: bool,
}

impl WhyArgs {
    /// The program and the device. With one argument, which is not a file, it is the device, of the program that
    /// rungc.toml names. `None` if there is no device.
    pub fn subject(&self) -> Option<(Input, &str)> {
        let mut input = self.input.clone();
        match &self.device {
            Some(device) => Some((input, device)),
            None => {
                input.file = None;
                let only = self.input.file.as_ref();
                let name = only.filter(|only| !only.exists())?.to_str()?;
                Some((input, name))
            }
        }
    }

    /// Time of the moment in milliseconds; `None` if the program alone is explained.
    pub fn end_ms(&self) -> Option<u64> {
        const USUAL_MS: u64 = 1000;
        let runs =
            self.how || !self.set.is_empty() || self.machine.is_some() || self.scan.is_some();
        self.duration.or(runs.then_some(USUAL_MS))
    }
}
