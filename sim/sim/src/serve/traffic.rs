//! Traffic of a run's connections, for the table at its end.

use super::decode::{Decoded, Decoder, Direction, LinkProtocol};
use super::probe::{Devices, ranges};
use std::collections::BTreeMap;

/// Place where a frame was seen.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub struct Place {
    /// The server or port: `Modbus TCP 127.0.0.1:5020`, `COM1`.
    pub port: String,
    /// The other end: the address of a client, the path of a serial port.
    pub peer: String,
}

/// A frame on its way.
#[derive(Clone, Copy, Debug)]
pub struct Seen<'a> {
    /// The place.
    pub place: &'a Place,
    /// Protocol there.
    pub link: LinkProtocol,
    /// Direction of the frame.
    pub direction: Direction,
    /// The frame.
    pub bytes: &'a [u8],
}

/// One row of the table.
#[derive(Clone, Debug)]
struct Connection {
    link: LinkProtocol,
    received: u64,
    sent: u64,
    errors: u64,
    last_error: Option<String>,
    /// The last request is among the errors: its answer is not a second one.
    is_counted: bool,
    written: Devices,
    /// The last frame, and which way it went.
    last: Option<(Direction, Vec<u8>)>,
    /// Devices that the unanswered request writes.
    pending: Devices,
}

/// The connections of a run.
#[derive(Debug)]
pub struct Traffic {
    decoder: Decoder,
    connections: BTreeMap<Place, Connection>,
    /// Devices of this PLC that others have written.
    written: Devices,
}

impl Traffic {
    /// Nothing seen yet.
    pub fn new(decoder: Decoder) -> Self {
        Traffic {
            decoder,
            connections: BTreeMap::new(),
            written: Devices::new(),
        }
    }

    /// A server or port that is open: it has a row, whether or not frames come.
    pub fn open(&mut self, place: &Place, link: LinkProtocol) {
        self.connection(place, link);
    }

    fn connection(&mut self, place: &Place, link: LinkProtocol) -> &mut Connection {
        let connection = self.connections.entry(place.clone()).or_insert(Connection {
            link,
            received: 0,
            sent: 0,
            errors: 0,
            last_error: None,
            is_counted: false,
            written: Devices::new(),
            last: None,
            pending: Devices::new(),
        });
        connection.link = link;
        connection
    }

    /// Counts a frame; returns what it says.
    pub fn frame(&mut self, seen: Seen) -> Decoded {
        let decoder = self.decoder;
        let mut written = Devices::new();
        let connection = self.connection(seen.place, seen.link);
        let last = connection.last.take();
        let before = last
            .as_ref()
            .filter(|(direction, _)| *direction != seen.direction);
        let before = before.map(|(_, bytes)| bytes.as_slice());
        let decoded = decoder.decode(seen.link, seen.direction, seen.bytes, before);
        let is_request = (seen.direction == Direction::Out) == seen.link.is_request();
        match seen.direction {
            Direction::In => connection.received += 1,
            Direction::Out => connection.sent += 1,
        }
        let unanswered = is_request && seen.link.is_request() && last.is_some() && before.is_none();
        if unanswered {
            connection.errors += 1;
            connection.last_error = Some("no answer".to_string());
        }
        let is_counted = std::mem::take(&mut connection.is_counted) && !is_request;
        if let Some(error) = &decoded.error {
            connection.errors += u64::from(!is_counted);
            connection.last_error = Some(error.clone());
            connection.is_counted = is_request;
        }
        if is_request {
            connection.pending = decoded.written.clone();
        }
        // A request is carried out if it is answered, and not by an error.
        let done = decoded.error.is_none() && (!is_request || decoded.broadcast);
        let pending = std::mem::take(&mut connection.pending);
        match (done, is_request) {
            (true, _) => {
                if !seen.link.is_request() {
                    written.extend(&pending);
                }
                connection.written.extend(pending);
            }
            (false, true) => connection.pending = pending,
            (false, false) => {}
        }
        connection.last = Some((seen.direction, seen.bytes.to_vec()));
        self.written.extend(written);
        decoded
    }

    /// Devices of this PLC that requests have written since the last call.
    pub fn take_written(&mut self) -> Devices {
        std::mem::take(&mut self.written)
    }

    /// Returns true if a row is informative: a server that has had clients has a row for each of them.
    fn is_shown(&self, place: &Place) -> bool {
        let mut others = self.connections.keys();
        !place.peer.is_empty() || !others.any(|other| other.port == place.port && other != place)
    }

    /// The table, a line for each row; empty if nothing was open.
    pub fn table(&self) -> Vec<String> {
        const HEADING: [&str; 8] = [
            "port",
            "peer",
            "protocol",
            "in",
            "out",
            "errors",
            "last error",
            "devices written",
        ];
        /// Columns of numbers are at the right.
        const NUMBERS: std::ops::Range<usize> = 3..6;
        let or_none = |text: String| {
            if text.is_empty() {
                "–".to_string()
            } else {
                text
            }
        };
        let row = |(place, connection): (&Place, &Connection)| {
            [
                place.port.clone(),
                or_none(place.peer.clone()),
                connection.link.name().to_string(),
                connection.received.to_string(),
                connection.sent.to_string(),
                connection.errors.to_string(),
                or_none(connection.last_error.clone().unwrap_or_default()),
                or_none(ranges(&connection.written)),
            ]
        };
        if self.connections.is_empty() {
            return Vec::new();
        }
        let shown = self.connections.iter();
        let shown = shown.filter(|(place, _)| self.is_shown(place));
        let rows: Vec<_> = std::iter::once(HEADING.map(str::to_string))
            .chain(shown.map(row))
            .collect();
        let width = |column: usize| {
            let widths = rows.iter().map(|row| row[column].chars().count());
            widths.max().unwrap_or(0)
        };
        let line = |row: &[String; 8]| {
            let cells = row.iter().enumerate().map(|(column, text)| {
                let width = width(column);
                match NUMBERS.contains(&column) {
                    true => format!("{text:>width$}"),
                    false => format!("{text:width$}"),
                }
            });
            let line = cells.collect::<Vec<_>>().join("  ");
            line.trim_end().to_string()
        };
        rows.iter().map(line).collect()
    }
}
