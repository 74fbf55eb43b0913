//! Arguments of `watch`.

use super::{Input, PlcArgs};
use clap::{Args, ValueEnum};

/// Arguments of `watch`.
#[derive(Args, Clone, Debug)]
#[command(after_help = "\
Examples:
  rungc watch press.il --port /dev/ttyUSB0              the inputs and outputs of the program
  rungc watch press.il X000 D10 \"press valve\" --port COM3
  rungc watch press.il --port COM3 --once --compare     all at once, and whether the PLC has this program
  rungc watch press.il --port COM3 --all --to csv > machine.csv
                                                        a recording, for `rungc why --trace`")]
pub struct WatchArgs {
    #[command(flatten)]
    pub input: Input,
    /// Devices to show: `X000`, `T0`, `D10`, or a comment. Default: the inputs and outputs that the program names.
    #[arg(value_name = "DEVICE")]
    pub devices: Vec<String>,
    /// Show all devices that the program names, and whether the PLC is in RUN (M8000).
    #[arg(long, conflicts_with = "devices")]
    pub all: bool,
    #[command(flatten)]
    pub plc: PlcArgs,
    /// Time between the beginnings of two looks; a slow line takes longer.
    #[arg(long, default_value = "500ms", value_parser = crate::time::parse, value_name = "TIME")]
    pub every: u64,
    /// Stop after this time. Default: Ctrl-C.
    #[arg(long = "for", value_parser = crate::time::parse, value_name = "TIME")]
    pub duration: Option<u64>,
    /// Look once.
    #[arg(long, conflicts_with = "duration")]
    pub once: bool,
    /// Compare the program in the PLC with the file first, which takes as long as `rungc read`.
    #[arg(long, requires = "port", conflicts_with_all = ["mc", "modbus"])]
    pub compare: bool,
    /// Output format.
    #[arg(long, value_enum, default_value_t = WatchTo::Text)]
    pub to: WatchTo,
}

impl WatchArgs {
    /// The program and the devices. A first argument that is not a file is a device, of the program that rungc.toml
    /// names.
    pub fn subject(&self) -> (Input, Vec<&str>) {
        let mut input = self.input.clone();
        let mut devices: Vec<&str> = self.devices.iter().map(String::as_str).collect();
        let only = self.input.file.as_ref().filter(|only| !only.exists());
        if let Some(first) = only.and_then(|only| only.to_str())
            && !first.contains(['/', '\\', '.'])
        {
            input.file = None;
            devices.insert(0, first);
        }
        (input, devices)
    }
}

/// Output formats of `watch`.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub enum WatchTo {
    /// A table at first, then a line for each change.
    Text,
    /// `ms,device,value`: a row for each value at first, then for each change.
    Csv,
}
