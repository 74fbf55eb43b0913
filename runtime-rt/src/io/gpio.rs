//! The pins of this machine, by the second interface of the character device of Linux (5.10 or newer; linux/gpio.h).

use super::cycle::{Driver, Trouble};
use super::settings::{Connection, End, Row};
use super::sys::{Passed, Request, own};
use std::boxed::Box;
use std::format;
use std::fs::File;
use std::io;
use std::os::fd::OwnedFd;
use std::string::{String, ToString};
use std::vec::Vec;

/// Lines of a request at most.
const LINES: usize = 64;

/// Attributes of a request at most.
const ATTRIBUTES: usize = 10;

/// `struct gpio_v2_line_config_attribute` with flags.
#[repr(C)]
#[derive(Clone, Copy, Default)]
struct Attribute {
    id: u32,
    padding: u32,
    flags: u64,
    /// The lines that it is for, by their places in the request.
    mask: u64,
}

/// `struct gpio_v2_line_request`, with its `struct gpio_v2_line_config`.
#[repr(C)]
struct Lines {
    offsets: [u32; LINES],
    consumer: [u8; 32],
    flags: u64,
    attribute_count: u32,
    padding: [u32; 5],
    attributes: [Attribute; ATTRIBUTES],
    count: u32,
    event_buffer: u32,
    padding_too: [u32; 5],
    file: i32,
}

/// `struct gpio_v2_line_values`.
#[repr(C)]
struct Values {
    bits: u64,
    mask: u64,
}

// SAFETY: as linux/gpio.h has it; a test holds the sizes to it.
#[allow(unsafe_code, reason = "the promise of the trait")]
unsafe impl Passed for Lines {}
// SAFETY: likewise.
#[allow(unsafe_code, reason = "the promise of the trait")]
unsafe impl Passed for Values {}

const GET_LINES: Request = Request::exchange(0xb4, 0x07);
const GET_VALUES: Request = Request::exchange(0xb4, 0x0e);
const SET_VALUES: Request = Request::exchange(0xb4, 0x0f);

const ACTIVE_LOW: u64 = 1 << 1;
const INPUT: u64 = 1 << 2;
const OUTPUT: u64 = 1 << 3;
const OPEN_DRAIN: u64 = 1 << 6;
const PULL_UP: u64 = 1 << 8;
const PULL_DOWN: u64 = 1 << 9;

/// The attribute that holds flags.
const FLAGS: u32 = 1;

/// The lines of a connection: those that are read and those that are driven.
struct Pins {
    inputs: Option<OwnedFd>,
    outputs: Option<OwnedFd>,
}

/// Takes the lines of a chip: `/dev/gpiochip0`.
pub(super) fn open(connection: &Connection) -> Result<Box<dyn Driver>, String> {
    let chip = File::open(&connection.end).map_err(|error| error.to_string())?;
    Ok(Box::new(Pins {
        inputs: lines(&chip, connection, true)?,
        outputs: lines(&chip, connection, false)?,
    }))
}

/// The line of a row, and its flags.
fn line(row: &Row) -> (u32, u64) {
    let End::Line { offset, flags } = &row.end else {
        return (0, 0);
    };
    let direction = if row.reads { INPUT } else { OUTPUT };
    let flags = flags.iter().map(|flag| match flag.as_str() {
        "active-low" => ACTIVE_LOW,
        "pull-up" => PULL_UP,
        "pull-down" => PULL_DOWN,
        "open-drain" => OPEN_DRAIN,
        _ => 0,
    });
    (*offset, flags.fold(direction, |all, flag| all | flag))
}

/// What a connection asks of a chip in a direction.
fn asked(connection: &Connection, reads: bool) -> Result<Lines, String> {
    let mut lines = Lines {
        offsets: [0; LINES],
        consumer: [0; 32],
        flags: if reads { INPUT } else { OUTPUT },
        attribute_count: 0,
        padding: [0; 5],
        attributes: [Attribute::default(); ATTRIBUTES],
        count: 0,
        event_buffer: 0,
        padding_too: [0; 5],
        file: -1,
    };
    lines.consumer[..5].copy_from_slice(b"rungc");
    let mut kinds: Vec<Attribute> = Vec::new();
    for (at, row) in connection.directed(reads).enumerate() {
        let (offset, flags) = line(row);
        let place = lines.offsets.get_mut(at);
        *place.ok_or_else(|| format!("a connection has at most {LINES} lines of a direction"))? =
            offset;
        lines.count += 1;
        if flags == lines.flags {
            continue;
        }
        match kinds.iter_mut().find(|kind| kind.flags == flags) {
            Some(kind) => kind.mask |= 1 << at,
            None => kinds.push(Attribute {
                id: FLAGS,
                flags,
                mask: 1 << at,
                ..Attribute::default()
            }),
        }
    }
    let places = lines.attributes.get_mut(..kinds.len());
    places
        .ok_or_else(|| format!("lines of at most {ATTRIBUTES} kinds"))?
        .copy_from_slice(&kinds);
    lines.attribute_count = kinds.len() as u32;
    Ok(lines)
}

/// Takes the lines of a direction; nothing if there are none.
fn lines(chip: &File, connection: &Connection, reads: bool) -> Result<Option<OwnedFd>, String> {
    if connection.values(reads) == 0 {
        return Ok(None);
    }
    let mut lines = asked(connection, reads)?;
    GET_LINES
        .pass(chip, &mut lines)
        .map_err(|error| error.to_string())?;
    // SAFETY: the kernel has opened it for this request.
    #[allow(unsafe_code, reason = "the kernel opens a file")]
    let file = unsafe { own(lines.file) };
    Ok(Some(file))
}

impl Driver for Pins {
    fn exchange(
        &mut self,
        connection: &Connection,
        inputs: &mut [i16],
        outputs: &[i16],
    ) -> Result<(), Trouble> {
        let lost = |error: io::Error| Trouble::Lost(error.to_string());
        let mask = |reads| u64::MAX >> (LINES - connection.values(reads).clamp(1, LINES));
        if let Some(file) = &self.inputs {
            let mask = mask(true);
            let mut values = Values { bits: 0, mask };
            GET_VALUES.pass(file, &mut values).map_err(lost)?;
            for (at, row) in connection.directed(true).enumerate() {
                inputs[row.place.start] = i16::from(values.bits >> at & 1 != 0);
            }
        }
        if let Some(file) = &self.outputs {
            let mask = mask(false);
            let mut values = Values { bits: 0, mask };
            for (at, row) in connection.directed(false).enumerate() {
                values.bits |= u64::from(outputs[row.place.start] != 0) << at;
            }
            SET_VALUES.pass(file, &mut values).map_err(lost)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_chip_is_not_opened() {
        for chip in ["/dev/gpiochip-none", "/dev/null", "/etc/hostname", "/dev"] {
            let pairs = [
                ("gpio", chip),
                ("X000", "read 17 pull-up"),
                ("Y000", "write 22"),
            ];
            let connection = Connection::read("pins", &pairs).unwrap();
            assert!(open(&connection).is_err(), "{chip}");
        }
    }

    #[test]
    fn sizes_are_those_of_the_kernel() {
        assert_eq!((size_of::<Lines>(), size_of::<Values>()), (592, 16));
        assert_eq!(core::mem::offset_of!(Lines, count), 560);
    }

    #[test]
    fn lines_of_equal_kinds_share_an_attribute() {
        let pairs = [
            ("gpio", "/dev/gpiochip0"),
            ("X000", "read 17 pull-up active-low"),
            ("X001", "read 4"),
            ("X002", "read 27 active-low pull-up"),
            ("Y000", "write 22 open-drain"),
        ];
        let connection = Connection::read("pins", &pairs).unwrap();
        let inputs = asked(&connection, true).unwrap();
        assert_eq!(
            (inputs.offsets[..3].to_vec(), inputs.count),
            ([17, 4, 27].to_vec(), 3)
        );
        assert_eq!((inputs.flags, inputs.attribute_count), (INPUT, 1));
        let kind = inputs.attributes[0];
        assert_eq!(
            (kind.id, kind.flags, kind.mask),
            (1, INPUT | PULL_UP | ACTIVE_LOW, 0b101)
        );
        let outputs = asked(&connection, false).unwrap();
        assert_eq!(outputs.attributes[0].flags, OUTPUT | OPEN_DRAIN);
    }
}
