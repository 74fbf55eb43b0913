//! Remote I/O over Modbus, as its master: one request for each row, in turn, in every cycle. Writing in each cycle
//! keeps the watchdog of a remote station content.

use super::cycle::{Driver, ExchangeError, each_row};
use super::settings::{Connection, End, Row, Table};
use rungc_rt::Class;
use rungc_rt::comm::modbus::{
    Buffer, Framing, Job, LONGEST_RTU, Limits, accept, crc16, refusal, request, tcp,
};
use rungc_rt::comm::{Cut, Frame, LineFault, Map};
use std::io::{self, ErrorKind, Read, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::time::{Duration, Instant};

/// The port of Modbus TCP.
const PORT: u16 = 502;

/// A line to slaves.
pub trait Wire: Send {
    /// Sends a request as an RTU frame, and returns the answer as one.
    ///
    /// # Errors
    /// No answer in time, or the line is lost.
    fn request(&mut self, request: &[u8]) -> io::Result<Vec<u8>>;
}

/// The slave of a connection.
pub struct Remote<W> {
    wire: W,
    unit: u8,
}

impl<W: Wire> Remote<W> {
    /// A slave at the end of a line.
    ///
    /// # Errors
    /// A unit that does not exist.
    pub fn new(wire: W, connection: &Connection) -> Result<Self, String> {
        let unit = connection.unit()?;
        Ok(Remote { wire, unit })
    }

    /// Asks for what a row is about; `values` are those of its devices.
    fn row(&mut self, row: &Row, values: &mut [i16]) -> Result<(), ExchangeError> {
        let End::Modbus { table, address } = row.end else {
            return Ok(());
        };
        let packs = row.is_bits() && matches!(table, Table::Registers | Table::InputRegisters);
        let mut own = Values(match packs {
            true => pack(values),
            false => values.to_vec(),
        });
        let buffer = match table {
            Table::Coils | Table::Inputs => Buffer::bits(Class::M, 0),
            Table::Registers | Table::InputRegisters => Buffer::words(Class::D, 0),
        };
        let job = Job {
            station: self.unit,
            function: function(table, row.reads),
            address,
            count: own.0.len() as u16,
            buffer,
        };
        let mut bytes = [0; LONGEST_RTU];
        let mut frame = Frame::new(&mut bytes);
        let made = request(Framing::Rtu, &Limits::STANDARD, &job, &own, &mut frame);
        made.map_err(|_| ExchangeError::Refused(format!("{}: no such request", row.devices())))?;
        let received = self.wire.request(frame.as_slice());
        let reply = received.map_err(|error| ExchangeError::Lost(error.to_string()))?;
        if let Some([_, code]) = refusal(Framing::Rtu, &job, &reply) {
            let devices = row.devices();
            let why = format!("{devices}: the station rejects the request with exception {code}");
            return Err(ExchangeError::Refused(why));
        }
        accept(Framing::Rtu, &job, &reply, &mut own).map_err(|fault| {
            let (devices, what) = (row.devices(), misfit(fault));
            ExchangeError::Refused(format!("{devices}: the answer does not fit: {what}"))
        })?;
        if packs {
            unpack(&own.0, values);
        } else {
            values.copy_from_slice(&own.0);
        }
        Ok(())
    }
}

impl<W: Wire> Driver for Remote<W> {
    fn exchange(
        &mut self,
        connection: &Connection,
        inputs: &mut [i16],
        outputs: &[i16],
    ) -> Result<(), ExchangeError> {
        each_row(connection, |row| {
            let place = row.place.clone();
            match row.reads {
                true => self.row(row, &mut inputs[place]),
                false => self.row(row, &mut outputs[place].to_vec()),
            }
        })
    }
}

/// The part of an answer that does not fit its request.
fn misfit(fault: LineFault) -> &'static str {
    match fault {
        LineFault::Station | LineFault::Address => "it is from another station or address",
        LineFault::Length | LineFault::Overflow => "its length",
        LineFault::Sum => "its sum",
        LineFault::Command => "its function",
        _ => "its content",
    }
}

/// The function of a request.
fn function(table: Table, reads: bool) -> u8 {
    match (table, reads) {
        (Table::Coils, true) => 0x01,
        (Table::Inputs, _) => 0x02,
        (Table::Registers, true) => 0x03,
        (Table::InputRegisters, _) => 0x04,
        (Table::Coils, false) => 0x0f,
        (Table::Registers, false) => 0x10,
    }
}

/// Sixteen bits to a register, the first in the lowest.
fn pack(bits: &[i16]) -> Vec<i16> {
    let words = bits.chunks(16);
    let word = |bits: &[i16]| {
        bits.iter()
            .rev()
            .fold(0u16, |word, &bit| word << 1 | u16::from(bit != 0))
    };
    words.map(|bits| word(bits) as i16).collect()
}

fn unpack(words: &[i16], bits: &mut [i16]) {
    for (bits, &word) in bits.chunks_mut(16).zip(words) {
        for (n, bit) in bits.iter_mut().enumerate() {
            *bit = word >> n & 1;
        }
    }
}

/// The values of a row as the devices of a master: M and D from 0 on.
struct Values(Vec<i16>);

impl Values {
    fn at(&mut self, number: u32) -> Option<&mut i16> {
        self.0.get_mut(number as usize)
    }
}

impl Map for Values {
    fn bit(&self, _: Class, number: u32) -> Option<bool> {
        self.0.get(number as usize).map(|&value| value != 0)
    }

    fn set_bit(&mut self, _: Class, number: u32, value: bool) -> Option<()> {
        *self.at(number)? = i16::from(value);
        Some(())
    }

    fn word(&self, _: Class, number: u32) -> Option<i16> {
        self.0.get(number as usize).copied()
    }

    fn set_word(&mut self, _: Class, number: u32, value: i16) -> Option<()> {
        *self.at(number)? = value;
        Some(())
    }

    fn counter32(&self, _: u32) -> Option<i32> {
        None
    }

    fn set_counter32(&mut self, _: u32, _: i32) -> Option<()> {
        None
    }

    fn reset(&mut self, _: Class, _: u32) -> Option<()> {
        None
    }

    fn running(&self) -> bool {
        true
    }

    fn request_running(&mut self, _: bool) {}

    fn type_code(&self) -> u16 {
        0
    }
}

/// A connection by Modbus TCP.
struct Tcp {
    stream: TcpStream,
    timeout: Duration,
    /// The number of the last request.
    transaction: u16,
}

/// Connects to a slave.
pub(super) fn open_tcp(connection: &Connection) -> Result<Box<dyn Driver>, String> {
    let timeout = Duration::from_millis(connection.timeout_ms);
    let wire = Tcp {
        stream: connect(&connection.end, PORT, timeout)?,
        timeout,
        transaction: 0,
    };
    Ok(Box::new(Remote::new(wire, connection)?))
}

/// Connects to a host with or without a port.
pub(super) fn connect(end: &str, port: u16, timeout: Duration) -> Result<TcpStream, String> {
    let found = match end.parse::<std::net::IpAddr>() {
        Ok(address) => Ok(vec![(address, port).into()]),
        Err(_) if end.contains(':') => end.to_socket_addrs().map(Iterator::collect::<Vec<_>>),
        Err(_) => (end, port).to_socket_addrs().map(Iterator::collect),
    };
    let mut why = "no such host".to_string();
    for address in found.map_err(|error| error.to_string())? {
        let connected = TcpStream::connect_timeout(&address, timeout).and_then(|stream| {
            // A request is one small packet: waiting for more only delays it.
            stream.set_nodelay(true)?;
            stream.set_write_timeout(Some(timeout))?;
            Ok(stream)
        });
        match connected {
            Ok(stream) => return Ok(stream),
            Err(error) => why = error.to_string(),
        }
    }
    Err(why)
}

impl Wire for Tcp {
    fn request(&mut self, request: &[u8]) -> io::Result<Vec<u8>> {
        let body = request
            .get(..request.len().saturating_sub(2))
            .unwrap_or_default();
        self.transaction = self.transaction.wrapping_add(1);
        let transaction = self.transaction.to_be_bytes();
        let length = (body.len() as u16).to_be_bytes();
        let frame = [&transaction, &[0; 2][..], &length, body].concat();
        self.stream.write_all(&frame)?;
        let until = Instant::now() + self.timeout;
        let mut reply = Vec::new();
        loop {
            match tcp::cut(&reply) {
                Cut::Whole => break,
                Cut::More => {}
                Cut::Drop | Cut::Restart => return Err(invalid("what comes is not Modbus TCP")),
            }
            let left = until.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return Err(io::Error::new(ErrorKind::TimedOut, "no answer in time"));
            }
            self.stream.set_read_timeout(Some(left))?;
            let mut bytes = [0; tcp::LONGEST];
            match self.stream.read(&mut bytes) {
                Ok(0) => {
                    return Err(io::Error::new(
                        ErrorKind::UnexpectedEof,
                        "closed by the other end",
                    ));
                }
                Ok(count) => reply.extend_from_slice(&bytes[..count]),
                Err(error) => match error.kind() {
                    // Looked at again with the time that is left.
                    ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted => {}
                    _ => return Err(error),
                },
            }
        }
        if reply[..2] != transaction {
            return Err(invalid("the answer is to another request"));
        }
        let mut reply = reply.split_off(6);
        reply.extend(crc16(&reply).to_le_bytes());
        Ok(reply)
    }
}

fn invalid(what: &str) -> io::Error {
    io::Error::new(ErrorKind::InvalidData, what)
}
