//! The PLCs of all groups, and the topics of a broker.

use crate::engine::At;
use crate::group::Group;
use rungc_host::io::{Connection, End, Io, Row};
use rungc_rt::Class;
use std::collections::hash_map::RandomState;
use std::hash::{BuildHasher, Hasher};

/// Maximum number of PLCs that share a connection.
const SHARE: usize = 100;

/// Devices that a connection reads at most, if a PLC has fewer: a broker keeps a limited number of messages for each
/// client (mosquitto 1,000), and as many come at once when a client subscribes to retained topics.
const READ: u32 = 500;

/// Stands for the number of a PLC in a topic.
pub(crate) const NUMBER: &str = "{n}";

/// The connections of a fleet to its broker.
pub struct Broker {
    io: Io,
    /// The rows of each connection, in their order: their group and the PLC's place in it.
    rows: Vec<Vec<(usize, u32)>>,
    /// Values last set for devices that are read, by connection and place.
    taken: Vec<Vec<Option<i16>>>,
    every_ms: u64,
    next_ms: u64,
}

/// The rows of a group as one PLC has them, the number of its first PLC, and how many there are.
pub(crate) struct Rows<'a> {
    pub rows: &'a [Row],
    pub first: u32,
    pub count: u32,
}

impl Broker {
    /// Connects all PLCs whose groups have rows. `usual` is the connection without rows.
    pub(crate) fn start(usual: &Connection, groups: &[Rows<'_>]) -> Result<Self, String> {
        let plcs = groups
            .iter()
            .enumerate()
            .filter(|(_, rows)| !rows.rows.is_empty());
        let plcs: Vec<(usize, u32)> = plcs
            .flat_map(|(group, rows)| (0..rows.count).map(move |plc| (group, plc)))
            .collect();
        let read = groups.iter().map(|rows| {
            let rows = rows.rows.iter().filter(|row| row.reads);
            rows.map(|row| row.count).sum::<u32>()
        });
        let share = READ / read.max().unwrap_or(0).max(1);
        let parts = plcs.chunks((share as usize).clamp(1, SHARE));
        let many = parts.len() > 1;
        let (mut connections, mut rows, mut taken) = (Vec::new(), Vec::new(), Vec::new());
        // Processes in containers have the same number, but clients of a broker are distinguished by their names.
        let own = RandomState::new().build_hasher().finish();
        for (part, plcs) in parts.enumerate() {
            let mut connection = usual.clone();
            let mut places = Vec::new();
            if many {
                connection.name = format!("{} {}", connection.name, part + 1);
                for key in ["client", "status"] {
                    if let Some(value) = connection.options.get_mut(key) {
                        *value = format!("{value}-{}", part + 1);
                    }
                }
            }
            connection
                .options
                .entry("client".to_string())
                .or_insert_with(|| format!("rungc-{own:x}-{part}"));
            let mut next = [0; 2];
            for &(group, plc) in plcs {
                let number = (groups[group].first + plc).to_string();
                for row in groups[group].rows {
                    let next = &mut next[usize::from(row.reads)];
                    let end = match &row.end {
                        End::Name(topic) => End::Name(topic.replace(NUMBER, &number)),
                        end => end.clone(),
                    };
                    connection.rows.push(Row {
                        end,
                        place: *next..*next + row.count as usize,
                        ..row.clone()
                    });
                    *next += row.count as usize;
                    places.push((group, plc));
                }
            }
            taken.push(vec![None; next[1]]);
            connections.push(connection);
            rows.push(places);
        }
        Ok(Broker {
            io: Io::start(connections, rungc_io::opener)?,
            rows,
            taken,
            every_ms: usual.every_ms,
            next_ms: 0,
        })
    }

    /// Before a scan: devices take the values that topics have got since the last one. Returns what there is to report.
    pub fn take(&mut self, groups: &mut [Group<'_>]) -> Vec<String> {
        let (rows, taken) = (&self.rows, &mut self.taken);
        self.io.take_rows(&mut |connection, place, row, values| {
            let (group, plc) = rows[connection][place];
            let known = &mut taken[connection][row.place.clone()];
            for ((known, value), number) in known.iter_mut().zip(values).zip(row.first..) {
                if value.is_some() && *known != value {
                    *known = value;
                    let value = value.unwrap_or_default();
                    let engine = groups[group].engine();
                    let _ = engine.write(plc, at(row.class, number), value.into());
                }
            }
        })
    }

    /// After a scan: topics get the values of devices, as often as the broker is to get some.
    pub fn give(&mut self, groups: &mut [Group<'_>], now_ms: u64) {
        if now_ms < self.next_ms {
            return;
        }
        self.next_ms = now_ms + self.every_ms;
        for (group, own) in groups.iter_mut().enumerate() {
            let rows = self.io.written().filter_map(|(connection, place, row)| {
                let (of, plc) = self.rows[connection][place];
                (of == group).then_some((plc, row))
            });
            let mut wanted = rows.flat_map(|(plc, row)| {
                let numbers = row.first..row.first + row.count;
                numbers.map(move |number| (plc, at(row.class, number)))
            });
            own.engine().fetch(&mut wanted);
        }
        let rows = &self.rows;
        self.io.give_rows(&mut |connection, place, row, values| {
            let (group, plc) = rows[connection][place];
            let engine = groups[group].engine();
            for (value, number) in values.iter_mut().zip(row.first..) {
                *value = engine.read(plc, at(row.class, number)).unwrap_or(0) as i16;
            }
        });
    }

    /// The run is over: all bits that are written are turned off. Returns what there is to report.
    pub fn end(self) -> Vec<String> {
        self.io.end()
    }
}

fn at(class: Class, number: u32) -> At {
    match class {
        Class::X | Class::Y | Class::M | Class::S => At::bit(class, number),
        class => At::word(class, number),
    }
}
