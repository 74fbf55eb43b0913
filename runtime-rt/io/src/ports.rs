//! The serial ports of this machine, and advice about those that cannot be opened.

use serial2::SerialPort;
use std::io::{self, ErrorKind};
use std::path::PathBuf;

/// Ports that a message lists at most: some machines have dozens without a connector.
const LISTED: usize = 8;

/// `ENOTTY` of Linux and macOS: the file is not a serial port.
const NOT_A_TERMINAL: i32 = 25;

/// Advice for users of Linux who may not open a port.
pub const GROUPS: &str = "serial ports belong to a group, `dialout` on Debian, Ubuntu and Fedora, `uucp` on Arch: \
                      `sudo usermod -aG dialout $USER`, then log in again";

/// Message for a serial port that cannot be opened: the reason and the next step.
pub fn cannot_open(error: &io::Error) -> String {
    let ports = SerialPort::available_ports().unwrap_or_default();
    format!("{error}; {}", advice(error, &ports))
}

/// The serial ports of this machine, adapters first: what people connect is rarely built in.
pub fn available() -> Vec<PathBuf> {
    adapters_first(&SerialPort::available_ports().unwrap_or_default())
}

fn adapters_first(ports: &[PathBuf]) -> Vec<PathBuf> {
    let mut ports = ports.to_vec();
    ports.sort_by_key(|port| {
        let name = port.display().to_string();
        (name.contains("ttyS"), name.len(), name)
    });
    ports
}

fn advice(error: &io::Error, ports: &[PathBuf]) -> String {
    match error.kind() {
        ErrorKind::PermissionDenied if cfg!(unix) => GROUPS.to_string(),
        ErrorKind::PermissionDenied | ErrorKind::ResourceBusy => {
            "close the other program that uses the port".to_string()
        }
        _ if cfg!(unix) && error.raw_os_error() == Some(NOT_A_TERMINAL) => {
            format!("this file is not a serial port; {}", list(ports))
        }
        _ => list(ports),
    }
}

/// The serial ports of this machine.
fn list(ports: &[PathBuf]) -> String {
    let ports = adapters_first(ports);
    let names = ports.iter().map(|port| port.display().to_string());
    let mut names: Vec<_> = names.collect();
    let more = match names.len() > LISTED {
        true => ", …",
        false => "",
    };
    names.truncate(LISTED);
    match names.is_empty() {
        true => "this machine has no serial port: is the adapter connected?".to_string(),
        false => format!("serial ports of this machine: {}{more}", names.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_error_has_a_next_step() {
        let ports = ["/dev/ttyS0", "/dev/ttyUSB10", "/dev/ttyUSB2"].map(PathBuf::from);
        let of = |kind: ErrorKind, ports: &[PathBuf]| advice(&io::Error::from(kind), ports);
        assert_eq!(
            of(ErrorKind::NotFound, &ports),
            "serial ports of this machine: /dev/ttyUSB2, /dev/ttyUSB10, /dev/ttyS0"
        );
        assert_eq!(
            of(ErrorKind::NotFound, &[]),
            "this machine has no serial port: is the adapter connected?"
        );
        let many: Vec<_> = (0..32)
            .map(|n| PathBuf::from(format!("/dev/ttyS{n}")))
            .collect();
        assert!(of(ErrorKind::NotFound, &many).ends_with("/dev/ttyS7, …"));
        assert!(of(ErrorKind::ResourceBusy, &ports).contains("other program"));
        if cfg!(unix) {
            assert!(of(ErrorKind::PermissionDenied, &ports).contains("usermod -aG dialout"));
            let file = io::Error::from_raw_os_error(NOT_A_TERMINAL);
            assert!(advice(&file, &ports).contains("not a serial port"));
        }
    }
}
