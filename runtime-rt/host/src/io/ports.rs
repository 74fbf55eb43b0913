//! Serial ports that cannot be opened: what to do.

use std::fs;
use std::io::{self, ErrorKind};

/// Beginnings of the names of serial ports in `/dev`, adapters first.
const PORTS: [&str; 5] = ["ttyUSB", "ttyACM", "ttyAMA", "cu.", "ttyS"];

/// Ports that a message lists at most: some machines have dozens without a connector.
const LISTED: usize = 8;

/// Ends of a line that `rungc run` has and executables in Rust have not.
const OTHERS: [&str; 3] = ["tcp:", "tcp-listen:", "pty"];

/// Message for a serial port at a path that cannot be opened; of one that is missing, it lists those that are there.
pub fn cannot_open(path: &str, error: &io::Error) -> String {
    if error.kind() != ErrorKind::NotFound {
        return error.to_string();
    }
    if OTHERS.iter().any(|other| path.starts_with(other)) {
        return "this program has no pseudo-terminals and no serial lines over TCP, `rungc run` has; \
                socat joins one to a terminal"
            .to_owned();
    }
    let files = fs::read_dir("/dev").into_iter().flatten().flatten();
    let names = files.filter_map(|file| file.file_name().into_string().ok());
    let kind = |name: &str| PORTS.iter().position(|begin| name.starts_with(begin));
    let mut ports: Vec<_> = names
        .filter_map(|name| Some((kind(&name)?, name.len(), format!("/dev/{name}"))))
        .collect();
    ports.sort();
    ports.truncate(LISTED);
    let ports: Vec<_> = ports.into_iter().map(|(_, _, path)| path).collect();
    match ports.is_empty() {
        true => format!("{error}; this machine has no serial port: is the adapter connected?"),
        false => format!(
            "{error}; serial ports of this machine: {}",
            ports.join(", ")
        ),
    }
}
