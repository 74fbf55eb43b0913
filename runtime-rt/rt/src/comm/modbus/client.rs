//! A client of Modbus TCP: what a table asks of one server, as the card H2U-ENET-BD does it (h1u-h2u-programming
//! §6.7.2). It knows no network: whoever has one asks [`Client::next`] what to do between two scans, and hands over the
//! characters that come.
//!
//! Rows whose trigger is on take turns; each has one request in a round. What goes wrong is in D8063, with M8063: the
//! server rejects 81xx the function, 82xx the number or 83xx the address of registers; 84xx it cannot be reached or
//! does not answer. xx is the last part of its IP address.

use super::adu::Body;
use super::master::{Buffer, Job, accept_body, request_body};
use super::{Limits, tcp};
use crate::comm::{Cut, Frame, LineFault, Map, Ports};
use crate::plc::Class;

/// Time-out of an answer, in microseconds; the manual does not specify one.
const ANSWER_US: u32 = 1_000_000;

/// Time-out of opening a connection, and the pause before the next attempt, in microseconds.
const OPEN_US: u32 = 3_000_000;
const PAUSE_US: u32 = 1_000_000;

/// Maximum number of characters of an answer.
pub const LONGEST_ANSWER: usize = 260;

const _: () = assert!(LONGEST_ANSWER == tcp::LONGEST);

/// A row of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct ClientRow {
    /// M, S, T or C: the row works while this device is on.
    pub trigger: Class,
    /// The number of that device.
    pub number: u32,
    /// The addressed unit, 1 for most servers.
    pub unit: u8,
    /// The function: 01 to 06, 0F, 10.
    pub function: u8,
    /// The first address in the server.
    pub address: u16,
    /// Number of coils or registers.
    pub count: u16,
    /// Number of the first register D that is sent or filled; coils are sixteen to a register.
    pub buffer: u32,
}

impl ClientRow {
    const fn job(&self) -> Job {
        Job {
            station: self.unit,
            function: self.function,
            address: self.address,
            count: self.count,
            buffer: Buffer::words(Class::D, self.buffer),
        }
    }
}

/// The state of a connection, as its host knows it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(u8)]
pub enum Link {
    /// There is none.
    Closed = 0,
    /// It is being opened.
    Opening = 1,
    /// Characters go over it.
    Open = 2,
}

/// Next action of a host on a connection.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(u8)]
pub enum ClientAction {
    /// Nothing.
    Nothing = 0,
    /// It opens the connection.
    Open = 1,
    /// It sends the request.
    Send = 2,
    /// It closes the connection.
    Close = 3,
}

/// Counters of a client's requests.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct Tally {
    /// Requests.
    pub requests: u32,
    /// Answers to them.
    pub answers: u32,
    /// Answers that reject a request, or do not fit it.
    pub rejected: u32,
}

/// The client of one server.
#[derive(Clone, Debug)]
#[repr(C)]
pub struct Client {
    family: Ports,
    /// The last part of the server's IP address.
    part: u8,
    /// The request of `row` is not answered yet.
    waits: bool,
    /// The row in work, or the next one.
    row: u16,
    transaction: u16,
    /// Start of the wait: for an answer, for the connection, or for the next attempt to open it.
    since_us: u32,
    /// Number of characters in `received`.
    length: u16,
    received: [u8; LONGEST_ANSWER],
    /// Counters of its requests.
    pub tally: Tally,
}

impl Client {
    /// The client of a server whose IP address ends in `part`, in a model of this family.
    pub const fn new(family: Ports, part: u8) -> Self {
        Client {
            family,
            part,
            waits: false,
            row: 0,
            transaction: 0,
            since_us: 0u32.wrapping_sub(PAUSE_US),
            length: 0,
            received: [0; LONGEST_ANSWER],
            tally: Tally {
                requests: 0,
                answers: 0,
                rejected: 0,
            },
        }
    }

    /// Next action, `now_us` microseconds after an arbitrary origin; a request to be sent is in `request`. `rows` are
    /// those of the server, the same in each call.
    pub fn next(
        &mut self,
        rows: &[ClientRow],
        link: Link,
        now_us: u32,
        map: &mut dyn Map,
        request: &mut Frame,
    ) -> ClientAction {
        let waited_us = now_us.wrapping_sub(self.since_us);
        match link {
            Link::Closed => {
                self.waits = false;
                if waited_us < PAUSE_US || self.driven(rows, map).is_none() {
                    return ClientAction::Nothing;
                }
                self.since_us = now_us;
                self.length = 0;
                ClientAction::Open
            }
            Link::Opening if waited_us > OPEN_US => self.give_up(now_us, map),
            Link::Opening => ClientAction::Nothing,
            Link::Open if self.waits && waited_us > ANSWER_US => self.give_up(now_us, map),
            Link::Open if self.waits => ClientAction::Nothing,
            Link::Open => self.send_request(rows, now_us, map, request),
        }
    }

    /// Takes a character that has come; [`ClientAction::Close`] if nothing that follows can be an answer.
    pub fn feed(
        &mut self,
        rows: &[ClientRow],
        byte: u8,
        now_us: u32,
        map: &mut dyn Map,
    ) -> ClientAction {
        if let Some(place) = self.received.get_mut(usize::from(self.length)) {
            *place = byte;
            self.length += 1;
        }
        let length = usize::from(self.length);
        let received = self.received.get(..length).unwrap_or_default();
        match (tcp::cut(received), received) {
            (Cut::More | Cut::Restart, _) => return ClientAction::Nothing,
            (Cut::Whole, &[high, low, _, _, _, _, ref body @ ..]) => {
                let transaction = u16::from_be_bytes([high, low]);
                let row = rows.get(usize::from(self.row)).filter(|_| self.waits);
                // A late answer does not belong to the next request.
                if let Some(row) = row.filter(|_| transaction == self.transaction) {
                    let done = accept_body(&row.job(), Body(body), map);
                    self.finish(done, map);
                }
                self.length = 0;
                return ClientAction::Nothing;
            }
            _ => {}
        }
        self.give_up(now_us, map)
    }

    /// The connection could not be opened, or has been closed by the server.
    pub fn lost(&mut self, now_us: u32, map: &mut dyn Map) {
        let _ = self.give_up(now_us, map);
    }

    fn give_up(&mut self, now_us: u32, map: &mut dyn Map) -> ClientAction {
        if self.waits {
            self.pass_on();
        }
        self.since_us = now_us;
        self.note(LineFault::TimeOut, map);
        ClientAction::Close
    }

    /// The next row whose trigger is on.
    fn driven(&self, rows: &[ClientRow], map: &dyn Map) -> Option<usize> {
        let first = usize::from(self.row);
        let turns = (first..rows.len()).chain(0..first.min(rows.len()));
        let mut turns = turns.filter_map(|at| Some((at, rows.get(at)?)));
        let found = turns.find(|(_, row)| map.bit(row.trigger, row.number) == Some(true));
        found.map(|(at, _)| at)
    }

    /// Makes the request of the next row.
    fn send_request(
        &mut self,
        rows: &[ClientRow],
        now_us: u32,
        map: &mut dyn Map,
        request: &mut Frame,
    ) -> ClientAction {
        let at = self.driven(rows, map);
        let Some((at, row)) = at.and_then(|at| Some((at, rows.get(at)?))) else {
            return ClientAction::Nothing;
        };
        self.row = at as u16;
        self.transaction = self.transaction.wrapping_add(1);
        tcp::begin(self.transaction.to_be_bytes(), request);
        let made = request_body(&Limits::H2U, &row.job(), map, request);
        if let Err(fault) = made.and_then(|()| tcp::close(request)) {
            self.pass_on();
            self.note(fault, map);
            return ClientAction::Nothing;
        }
        self.tally.requests = self.tally.requests.wrapping_add(1);
        self.waits = true;
        self.since_us = now_us;
        ClientAction::Send
    }

    /// The request of the row in work is over: it is the next one's turn.
    fn pass_on(&mut self) {
        self.waits = false;
        self.row = self.row.saturating_add(1);
    }

    /// The request of the row in work is answered.
    fn finish(&mut self, done: Result<(), LineFault>, map: &mut dyn Map) {
        self.pass_on();
        self.tally.answers = self.tally.answers.wrapping_add(1);
        if let Err(fault) = done {
            self.tally.rejected = self.tally.rejected.wrapping_add(1);
            self.note(fault, map);
        }
    }

    /// Shows a fault in the program's special devices. HM's relay of that number is something else.
    fn note(&self, fault: LineFault, map: &mut dyn Map) {
        let kind = match fault {
            LineFault::Command => 0x81,
            LineFault::Data => 0x82,
            LineFault::Address => 0x83,
            _ => 0x84,
        };
        if self.family != Ports::Hm {
            map.show_port_error(u16::from_be_bytes([kind, self.part]));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Plc;
    use crate::comm::Served;
    use crate::double::Double;
    use std::vec;
    use std::vec::Vec;

    /// Reads a register into D10 while M0 is on.
    fn read(address: u16) -> ClientRow {
        ClientRow {
            trigger: Class::M,
            number: 0,
            unit: 1,
            function: 3,
            address,
            count: 1,
            buffer: 10,
        }
    }

    /// A client and its PLC.
    struct Bench {
        plc: Double,
        client: Client,
        rows: Vec<ClientRow>,
        now_us: u32,
    }

    impl Bench {
        fn new(rows: &[ClientRow]) -> Self {
            let mut plc = Double::new();
            plc.set_m(0, "1");
            Bench {
                plc,
                client: Client::new(Ports::Inovance, 12),
                rows: rows.to_vec(),
                now_us: 0,
            }
        }

        fn next(&mut self, link: Link) -> (ClientAction, Vec<u8>) {
            let mut bytes = [0; tcp::LONGEST];
            let mut request = Frame::new(&mut bytes);
            let mut map = Served::new(&mut self.plc, 0);
            let rows = &self.rows;
            let action = self
                .client
                .next(rows, link, self.now_us, &mut map, &mut request);
            (action, request.as_slice().to_vec())
        }

        fn feed(&mut self, bytes: &[u8]) -> ClientAction {
            let mut map = Served::new(&mut self.plc, 0);
            let result = bytes
                .iter()
                .map(|&byte| self.client.feed(&self.rows, byte, self.now_us, &mut map));
            result.last().unwrap_or(ClientAction::Nothing)
        }

        fn error(&self) -> u16 {
            self.plc.d(8063, 1)[0] as u16
        }
    }

    #[test]
    fn rows_take_turns_while_their_triggers_are_on() {
        let other = ClientRow {
            number: 1,
            ..read(0x20)
        };
        let mut bench = Bench::new(&[read(0x1f4), other, read(0x30)]);
        assert_eq!(bench.next(Link::Closed).0, ClientAction::Open);
        assert_eq!(bench.next(Link::Opening).0, ClientAction::Nothing);
        let (action, request) = bench.next(Link::Open);
        assert_eq!(action, ClientAction::Send);
        assert_eq!(request, [0, 1, 0, 0, 0, 6, 1, 3, 1, 0xf4, 0, 1]);
        assert_eq!(bench.next(Link::Open).0, ClientAction::Nothing);
        // An answer to another request is not that of this one.
        bench.feed(&[0, 9, 0, 0, 0, 5, 1, 3, 2, 0, 9]);
        bench.feed(&[0, 1, 0, 0, 0, 5, 1, 3, 2, 0x12, 0x34]);
        assert_eq!(bench.plc.d(10, 1), [0x1234]);
        let (_, request) = bench.next(Link::Open);
        assert_eq!(request, [0, 2, 0, 0, 0, 6, 1, 3, 0, 0x30, 0, 1]);
        bench.feed(&[0, 2, 0, 0, 0, 5, 1, 3, 2, 0, 7]);
        bench.plc.set_m(0, "01");
        let (_, request) = bench.next(Link::Open);
        assert_eq!(request[8..10], [0, 0x20]);
        bench.feed(&[0, 3, 0, 0, 0, 5, 1, 3, 2, 0, 7]);
        bench.plc.set_m(0, "00");
        assert_eq!(bench.next(Link::Open).0, ClientAction::Nothing);
        assert_eq!(bench.next(Link::Closed).0, ClientAction::Nothing);
        assert_eq!((bench.error(), bench.client.tally.rejected), (0, 0));
    }

    #[test]
    fn what_goes_wrong_is_shown_with_the_address() {
        for (exception, code) in [(1, 0x810c), (2, 0x830c), (3, 0x820c), (4, 0x840c)] {
            let mut bench = Bench::new(&[read(0)]);
            bench.next(Link::Open);
            bench.feed(&[0, 1, 0, 0, 0, 3, 1, 0x83, exception]);
            assert_eq!(bench.error(), code);
            assert_eq!(bench.plc.bit(Class::M, 8063), Some(true));
            // The connection is as good as before.
            assert_eq!(bench.next(Link::Open).0, ClientAction::Send);
        }
        let mut bench = Bench::new(&[read(0)]);
        bench.next(Link::Open);
        assert_eq!(bench.feed(b"HTTP/1.1"), ClientAction::Close);
        assert_eq!(bench.error(), 0x840c);
        // More registers than a request may be about, and a buffer that there is not.
        let many = |count, buffer| ClientRow {
            count,
            buffer,
            ..read(0)
        };
        for (row, code) in [(many(126, 10), 0x820c), (many(2, 8511), 0x830c)] {
            let mut bench = Bench::new(&[row]);
            assert_eq!(bench.next(Link::Open).0, ClientAction::Nothing);
            assert_eq!(bench.error(), code);
        }
        let mut bench = Bench::new(&[read(0)]);
        bench.client = Client::new(Ports::Hm, 12);
        bench.client.lost(0, &mut Served::new(&mut bench.plc, 0));
        assert_eq!(bench.error(), 0);
    }

    #[test]
    fn a_server_that_is_silent_or_away_is_tried_again() {
        let mut bench = Bench::new(&[read(0)]);
        assert_eq!(bench.next(Link::Closed).0, ClientAction::Open);
        bench.client.lost(0, &mut Served::new(&mut bench.plc, 0));
        assert_eq!(bench.error(), 0x840c);
        assert_eq!(bench.next(Link::Closed).0, ClientAction::Nothing);
        bench.now_us += PAUSE_US;
        assert_eq!(bench.next(Link::Closed).0, ClientAction::Open);
        bench.now_us += OPEN_US + 1;
        assert_eq!(bench.next(Link::Opening).0, ClientAction::Close);
        bench.now_us += PAUSE_US;
        assert_eq!(bench.next(Link::Closed).0, ClientAction::Open);
        assert_eq!(bench.next(Link::Open).0, ClientAction::Send);
        bench.now_us += ANSWER_US + 1;
        assert_eq!(bench.next(Link::Open).0, ClientAction::Close);
        bench.now_us += PAUSE_US;
        assert_eq!(bench.next(Link::Closed).0, ClientAction::Open);
        // Half an answer of the last connection is forgotten.
        assert_eq!(bench.next(Link::Open).0, ClientAction::Send);
        bench.feed(&[0, 2, 0, 0, 0, 5, 1, 3, 2, 0, 7]);
        assert_eq!(bench.plc.d(10, 1), [7]);
    }

    #[test]
    fn any_bytes_write_nothing_but_the_buffer() {
        let mut bench = Bench::new(&[read(0)]);
        let mut bytes = vec![0u8; 4000];
        let mut state = 1u32;
        for byte in &mut bytes {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            *byte = (state >> 24) as u8 & 7;
        }
        for part in bytes.chunks(40) {
            bench.next(Link::Open);
            bench.feed(part);
        }
        assert_eq!(bench.plc.d(0, 10), [0; 10]);
        assert_eq!(bench.plc.d(11, 100), [0; 100]);
    }
}
