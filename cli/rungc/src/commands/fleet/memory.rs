//! System resources of a fleet: memory, and open files.

use rungc_fleet::Fleet;

/// Files that are open beside the ports of PLCs.
#[cfg(unix)]
const OTHERS: u64 = 256;

/// Lets this process open as many files as the ports of the fleet and their clients take, as far as the system allows.
#[cfg(unix)]
pub fn allow_files(fleet: &Fleet) {
    use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
    let served = fleet.plcs.iter().filter(|plcs| plcs.modbus_tcp.is_some());
    let ports: u64 = served
        .map(|plcs| u64::from(plcs.count.div_ceil(plcs.units.unwrap_or(1).max(1))))
        .sum();
    let wanted = 2 * ports + OTHERS;
    let limit = getrlimit(Resource::Nofile);
    if limit.current.is_some_and(|current| current < wanted) {
        let current = Some(limit.maximum.map_or(wanted, |most| most.min(wanted)));
        // If that is not enough, the port that cannot be opened is reported.
        let _ = setrlimit(Resource::Nofile, Rlimit { current, ..limit });
    }
}

/// Other systems have no such limit that a process could change.
#[cfg(not(unix))]
pub fn allow_files(_: &Fleet) {}

/// The most memory that processes have taken so far, in bytes: this one and the others; `None` where the system does
/// not say (others than Linux).
pub fn peak(others: &[u32]) -> Option<u64> {
    let own = std::process::id();
    let each = std::iter::once(&own).chain(others);
    each.map(|id| {
        let status = std::fs::read_to_string(format!("/proc/{id}/status")).ok()?;
        let line = status
            .lines()
            .find_map(|line| line.strip_prefix("VmHWM:"))?;
        let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
        Some(1024 * kilobytes)
    })
    .sum()
}
