//! Serial ports that cannot be opened: what to do.

use std::fs;
use std::io::{self, ErrorKind};

/// Beginnings of the names of serial ports in `/dev`, of adapters and boards.
const PORTS: [&str; 4] = ["ttyUSB", "ttyACM", "ttyAMA", "cu."];

/// Message for a serial port that cannot be opened; of one that is missing, it lists those that are there.
pub fn cannot_open(error: &io::Error) -> String {
    if error.kind() != ErrorKind::NotFound {
        return error.to_string();
    }
    let files = fs::read_dir("/dev").into_iter().flatten().flatten();
    let names = files.filter_map(|file| file.file_name().into_string().ok());
    let mut ports: Vec<_> = names
        .filter(|name| PORTS.iter().any(|begin| name.starts_with(begin)))
        .map(|name| format!("/dev/{name}"))
        .collect();
    ports.sort();
    match ports.is_empty() {
        true => format!("{error}; this machine has no serial port: is the adapter connected?"),
        false => format!(
            "{error}; serial ports of this machine: {}",
            ports.join(", ")
        ),
    }
}
