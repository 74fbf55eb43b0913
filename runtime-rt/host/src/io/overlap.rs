//! Rows that contradict each other: a device, or a place at another end, with two sources.

use super::settings::{Connection, End, Kind, Row, Table, device_name};
use super::topics::topics;
use rungc_rt::Class;
use std::collections::BTreeMap;
use std::ops::Range;

/// A device or a place at another end that takes its value from two rows.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Overlap {
    /// Description of the error.
    pub message: String,
    /// Suggested remedy.
    pub help: &'static str,
    /// Index of the connection with the later of both.
    pub connection: usize,
    /// Which of its settings it is.
    pub part: Part,
}

/// A setting that gives a device or a place its value.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Part {
    /// A row, by its index.
    Row(usize),
    /// The fault device.
    Fault,
    /// The topic that shows whether the PLC is there.
    Status,
}

/// The first overlap: a device that two rows read, or that a row reads and a connection shows a fault with; or a
/// place that two rows write. `retain_fault` is the device that shows that latched devices cannot be saved, if there
/// is one: it takes its value from there.
pub fn overlap(connections: &[Connection], retain_fault: Option<(Class, u32)>) -> Option<Overlap> {
    of_devices(connections, retain_fault).or_else(|| of_places(connections))
}

fn of_devices(connections: &[Connection], retain_fault: Option<(Class, u32)>) -> Option<Overlap> {
    let retain_fault = retain_fault.map(|(class, number)| (class, number..number + 1));
    let mut taken: Vec<(Class, Range<u32>)> = retain_fault.into_iter().collect();
    for (n, connection) in connections.iter().enumerate() {
        let rows = connection
            .rows
            .iter()
            .enumerate()
            .filter(|(_, row)| row.reads);
        let rows =
            rows.map(|(at, row)| (row.class, row.first..row.first + row.count, Part::Row(at)));
        let fault = connection
            .fault
            .map(|(class, number)| (class, number..number + 1, Part::Fault));
        for (class, range, part) in rows.chain(fault) {
            let other = taken
                .iter()
                .find(|other| other.0 == class && meet(&other.1, &range));
            if let Some((_, other)) = other {
                let device = device_name(class, other.start.max(range.start));
                return Some(Overlap {
                    message: format!("`{device}` takes its value from two places"),
                    help: "a device takes its value from one place",
                    connection: n,
                    part,
                });
            }
            taken.push((class, range));
        }
    }
    None
}

fn meet(a: &Range<u32>, b: &Range<u32>) -> bool {
    a.start < b.end && b.start < a.end
}

/// Another end: how it is reached, where it is, and its unit.
type Other<'a> = (&'static str, &'a str, Option<&'a String>);

/// Devices whose values are written together: class, first number, count.
type Source = (Class, u32, u32);

/// The parts of tables, topics and files that rows have written so far, with what they write there.
type Taken<'a> = BTreeMap<(Other<'a>, String), Vec<(Range<u32>, Source)>>;

/// A table, topic or file; the part of it that a row writes, and what it writes there.
type Written = (String, Range<u32>, Source);

fn of_places(connections: &[Connection]) -> Option<Overlap> {
    let mut taken = Taken::new();
    for (n, connection) in connections.iter().enumerate() {
        let unit = connection.options.get("unit");
        let other = (connection.kind.key(), connection.end.as_str(), unit);
        let status = connection.options.get("status").into_iter();
        let status = status.map(|topic| {
            let of_itself = (Class::X, u32::MAX, n as u32);
            (Part::Status, topic.clone(), 0..1, of_itself)
        });
        let rows = connection.rows.iter().enumerate().flat_map(|(at, row)| {
            let written = written(connection.kind, row).into_iter();
            written.map(move |(name, range, source)| (Part::Row(at), name, range, source))
        });
        let all: Vec<_> = status.chain(rows).collect();
        for (part, name, range, source) in all {
            let taken = taken.entry((other, name.clone())).or_default();
            let earlier = taken
                .iter()
                .find(|(earlier, from)| meet(earlier, &range) && *from != source);
            if let Some((earlier, _)) = earlier {
                let place = match connection.kind {
                    Kind::Mqtt | Kind::Files => name,
                    _ => format!("{name} {}", earlier.start.max(range.start)),
                };
                return Some(Overlap {
                    message: format!("`{place}` takes its value from two rows"),
                    help: "each coil, register, line, topic or file is written by one row, or is `status`",
                    connection: n,
                    part,
                });
            }
            taken.push((range, source));
        }
    }
    None
}

/// Places that a row writes.
fn written(kind: Kind, row: &Row) -> Vec<Written> {
    let all = (row.class, row.first, row.count);
    let part = |name: &str, first: u32, count: u32| {
        Vec::from([(name.to_owned(), first..first + count, all)])
    };
    match &row.end {
        _ if row.reads => Vec::new(),
        End::Modbus { table, address } => {
            let (name, count) = match table {
                Table::Registers if row.is_bits() => ("registers", row.count.div_ceil(16)),
                Table::Registers => ("registers", row.count),
                _ => ("coils", row.count),
            };
            part(name, u32::from(*address), count)
        }
        End::Line { offset, .. } => part("line", *offset, 1),
        End::Name(name) if kind == Kind::Files => part(name, 0, 1),
        End::Name(name) => {
            let topics = topics(row);
            match topics.len() == row.count as usize {
                true => (row.first..)
                    .zip(topics)
                    .map(|(number, topic)| (topic.name, 0..1, (row.class, number, 1)))
                    .collect(),
                false => part(name, 0, 1),
            }
        }
        End::Text => Vec::new(),
    }
}
