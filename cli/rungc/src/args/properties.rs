//! Arguments of all commands that search the runs of a program.

use clap::Args;

/// Properties of a program, and assumptions about its environment.
#[derive(Args, Debug, Default)]
pub struct Properties {
    /// A condition that must not hold after any scan: `"Y000 & Y001"`. Devices are named as in test files
    /// (`rungc book prove`) or by their comments; `!`, `&`, `|` and comparisons (`D0 > 100`) combine them. May be
    /// repeated, as can the options below.
    #[arg(long, value_name = "CONDITION")]
    pub never: Vec<String>,
    /// A condition that must hold after every scan.
    #[arg(long, value_name = "CONDITION")]
    pub always: Vec<String>,
    /// A condition that must be reachable: some run ends with it.
    #[arg(long, value_name = "CONDITION")]
    pub reachable: Vec<String>,
    /// A condition that the machine guarantees after every scan: `"!(X000 & X001)"`.
    #[arg(long, value_name = "CONDITION")]
    pub assume: Vec<String>,
    /// Devices that something other than the program may write at any time, such as an operator panel: `M100..M115`;
    /// may be separated by commas.
    #[arg(long, value_name = "RANGE")]
    pub free: Vec<String>,
    /// Maximum time between scans. Default: that of rungc.toml, or 200ms.
    #[arg(long, value_parser = crate::time::parse, value_name = "TIME")]
    pub scan: Option<u64>,
}
