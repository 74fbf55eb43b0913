//! Arguments of all commands that look for runs of a program.

use super::values::devices;
use clap::Args;
use rungc_syntax::DeviceClass;

/// What is asked of a program, and what is supposed of the world around it.
#[derive(Args, Debug)]
pub struct Properties {
    /// A condition that must hold after no scan: `"Y000 & Y001"`. Devices are named as in test files
    /// (docs/src/prove.md) or by their comments; `!`, `&`, `|` and comparisons (`D0 > 100`) join them. Repeat it for
    /// more, as the options below.
    #[arg(long, value_name = "CONDITION")]
    pub never: Vec<String>,
    /// A condition that must hold after every scan.
    #[arg(long, value_name = "CONDITION")]
    pub always: Vec<String>,
    /// A condition that must be able to hold: is there a run after which it does?
    #[arg(long, value_name = "CONDITION")]
    pub reachable: Vec<String>,
    /// A condition that holds after every scan, because the machine sees to it: `"!(X000 & X001)"`.
    #[arg(long, value_name = "CONDITION")]
    pub assume: Vec<String>,
    /// Devices that something other than the program may write at any time, such as an operator panel: `M100..M115`.
    #[arg(long, value_parser = devices, value_name = "RANGE")]
    pub free: Vec<(DeviceClass, u32, u32)>,
    /// The longest time from one scan to the next. Default: that of rungc.toml, or 200ms.
    #[arg(long, value_parser = crate::time::parse, value_name = "TIME")]
    pub scan: Option<u64>,
}
