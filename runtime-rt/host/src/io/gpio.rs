//! The pins of this machine, by the second interface of the character device of Linux (5.10 or newer; linux/gpio.h).

use super::cycle::{Driver, ExchangeError};
use super::settings::{Connection, End, Row};
use super::sys::{Passed, Request, own};
use std::fs::{File, read_dir};
use std::io::{self, ErrorKind};
use std::os::fd::OwnedFd;
use std::path::{Path, PathBuf};

/// Lines of a request at most.
const LINES: usize = 64;

/// Attributes of a request at most.
const ATTRIBUTES: usize = 10;

/// Directory of the chip devices.
const DEVICES: &str = "/dev";

/// `struct gpiochip_info`.
#[repr(C)]
#[derive(Clone, Copy, Default)]
struct Chip {
    name: [u8; 32],
    label: [u8; 32],
    lines: u32,
}

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
// SAFETY: likewise.
#[allow(unsafe_code, reason = "the promise of the trait")]
unsafe impl Passed for Chip {}

const GET_CHIP: Request = Request::answer(0xb4, 0x01);
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

/// Takes the lines of a chip: `/dev/gpiochip0`, or the one with a label.
pub(super) fn open(connection: &Connection) -> Result<Box<dyn Driver>, String> {
    let end = connection.end.as_str();
    let chip = match end.contains('/') {
        true => File::open(end).map_err(|error| error.to_string())?,
        false => labelled(end, Path::new(DEVICES), &label)?,
    };
    Ok(Box::new(Pins {
        inputs: lines(&chip, connection, true)?,
        outputs: lines(&chip, connection, false)?,
    }))
}

/// Label of a chip, which does not depend on its number.
fn label(chip: &File) -> io::Result<String> {
    let mut known = Chip::default();
    GET_CHIP.pass(chip, &mut known)?;
    let end = known.label.iter().position(|&byte| byte == 0);
    let text = &known.label[..end.unwrap_or(known.label.len())];
    Ok(String::from_utf8_lossy(text).into_owned())
}

/// The chip with a label, among those of a folder: a chip that goes away may come back with another number.
fn labelled(
    wanted: &str,
    folder: &Path,
    label: &dyn Fn(&File) -> io::Result<String>,
) -> Result<File, String> {
    let wrong = |error: io::Error| error.to_string();
    let mut paths: Vec<PathBuf> = Vec::new();
    for entry in read_dir(folder).map_err(wrong)? {
        let entry = entry.map_err(wrong)?;
        if entry
            .file_name()
            .as_encoded_bytes()
            .starts_with(b"gpiochip")
        {
            paths.push(entry.path());
        }
    }
    paths.sort();
    let (mut found, mut others, mut refused) = (None, Vec::new(), None);
    for path in paths {
        let chip = match File::open(&path) {
            Ok(chip) => chip,
            Err(error) => {
                // A chip that has just gone away does not count; another may be the one, if it may be opened.
                if error.kind() != ErrorKind::NotFound {
                    refused = Some(format!("{}: {error}", path.display()));
                }
                continue;
            }
        };
        match label(&chip) {
            Ok(label) if label == wanted => {
                if found.replace(chip).is_some() {
                    return Err("several chips have this label: name one by its path".to_string());
                }
            }
            Ok(label) => others.push(label),
            Err(_) => {}
        }
    }
    found.ok_or_else(|| match (refused, others.is_empty()) {
        (Some(refused), _) => refused,
        (None, true) => "there is no chip".to_string(),
        (None, false) => format!("no chip has this label; there are {}", others.join(", ")),
    })
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

/// Request of a connection for lines of a chip in one direction.
fn line_request(connection: &Connection, reads: bool) -> Result<Lines, String> {
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
    let mut lines = line_request(connection, reads)?;
    GET_LINES.pass(chip, &mut lines).map_err(refusal)?;
    // SAFETY: the kernel has opened it for this request.
    #[allow(unsafe_code, reason = "the kernel opens a file")]
    let file = unsafe { own(lines.file) };
    Ok(Some(file))
}

/// Message for lines that cannot be requested.
fn refusal(error: io::Error) -> String {
    /// `ENOTTY`: the file knows no such request.
    const NO_CHIP: i32 = 25;
    match (error.raw_os_error(), error.kind()) {
        (Some(NO_CHIP), _) => {
            "this is not a chip of pins, or the kernel is older than 5.10".to_string()
        }
        (_, ErrorKind::ResourceBusy) => format!("a line is taken by another program: {error}"),
        _ => error.to_string(),
    }
}

impl Driver for Pins {
    fn exchange(
        &mut self,
        connection: &Connection,
        inputs: &mut [i16],
        outputs: &[i16],
    ) -> Result<(), ExchangeError> {
        let lost = |error: io::Error| ExchangeError::Lost(error.to_string());
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
    use std::fs;
    use std::io::Read;

    #[test]
    fn what_is_no_chip_is_not_opened() {
        for chip in ["/dev/gpiochip-none", "/dev/null", "/etc/hostname", "/dev"] {
            let pairs = [
                ("gpio", chip),
                ("X000", "read 17 pull-up"),
                ("Y000", "write 22"),
            ];
            let connection = Connection::read("pins", &pairs).unwrap();
            let why = open(&connection).err().unwrap();
            let exists = chip != "/dev/gpiochip-none";
            assert_eq!(why.contains("not a chip of pins"), exists, "{chip}: {why}");
        }
    }

    /// Text files stand for chips, with their labels in them.
    #[test]
    fn chips_are_found_by_label_whatever_their_number() {
        let folder = std::env::temp_dir().join(format!("rungc-chips-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let label = |mut file: &File| {
            let mut text = String::new();
            file.read_to_string(&mut text).map(|_| text)
        };
        let find = |wanted| labelled(wanted, &folder, &label).map(drop);
        let plug = |name: &str, text: &str| fs::write(folder.join(name), text).unwrap();
        assert_eq!(find("plant"), Err("there is no chip".to_string()));
        plug("gpiochip0", "soc");
        plug("gpio", "plant");
        let without = find("plant").unwrap_err();
        assert_eq!(without, "no chip has this label; there are soc");
        plug("gpiochip1", "plant");
        assert_eq!(find("plant"), Ok(()));
        fs::rename(folder.join("gpiochip1"), folder.join("gpiochip7")).unwrap();
        assert!(find("plant").is_ok());
        plug("gpiochip1", "plant");
        let several = find("plant").unwrap_err();
        assert!(several.starts_with("several chips"), "{several}");
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn sizes_are_those_of_the_kernel() {
        assert_eq!((size_of::<Lines>(), size_of::<Values>()), (592, 16));
        assert_eq!(std::mem::offset_of!(Lines, count), 560);
        assert_eq!(size_of::<Chip>(), 68);
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
        let inputs = line_request(&connection, true).unwrap();
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
        let outputs = line_request(&connection, false).unwrap();
        assert_eq!(outputs.attributes[0].flags, OUTPUT | OPEN_DRAIN);
    }
}
