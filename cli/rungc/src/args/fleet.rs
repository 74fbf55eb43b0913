//! Arguments of `fleet`.

use super::Reading;
use clap::Args;
use std::path::PathBuf;

/// Arguments of `fleet`.
#[derive(Args, Debug)]
pub struct FleetArgs {
    /// Description of the fleet: programs, number of PLCs of each, and connections (`rungc book fleet`).
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    #[command(flatten)]
    pub reading: Reading,
    /// Duration of the run: `200ms`, `5s`, `2min`, `1h`; a bare number is milliseconds. Default: until Ctrl-C.
    #[arg(long = "for", value_parser = crate::time::parse, value_name = "TIME")]
    pub duration: Option<u64>,
    /// Run in virtual time, as fast as the machine can.
    #[arg(long = "virtual", requires = "duration")]
    pub in_virtual_time: bool,
    /// Scan with this real-time priority (Linux: SCHED_FIFO, 1 to 99), with all memory locked. If the system does not
    /// permit this, a warning is printed and the fleet runs without.
    #[arg(long, value_parser = clap::value_parser!(u8).range(1..=99), value_name = "N")]
    pub priority: Option<u8>,
}
