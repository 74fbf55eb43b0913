//! Brokers, by a small client: MQTT 3.1.1, QoS 0, without encryption. A value that gets lost with its connection is
//! published again with the next one.

use super::cycle::{Driver, ExchangeError};
use super::left_out::LeftOut;
use super::modbus::connect;
use super::settings::Connection;
use super::topics::{LONGEST_PACKET, TOO_LONG, address, password, take, topics};
use std::collections::BTreeMap;
use std::io::{self, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

/// The port of MQTT.
const PORT: u16 = 1883;

/// After this time without a word this end looks for the broker; after twice the time the broker gives this end up.
const KEEP_ALIVE: Duration = Duration::from_secs(5);

/// Payloads of the topic that shows whether the PLC is there.
const ONLINE: &str = "online";
const OFFLINE: &str = "offline";

/// Types of packets, with the flags that they have (MQTT 3.1.1 §2.2).
const CONNECT: u8 = 0x10;
const CONNACK: u8 = 0x20;
const PUBLISH: u8 = 0x30;
const RETAINED: u8 = 0x01;
const SUBSCRIBE: u8 = 0x82;
const SUBACK: u8 = 0x90;
const PINGREQ: u8 = 0xc0;
const DISCONNECT: u8 = 0xe0;

/// A connection to a broker.
struct Broker {
    stream: TcpStream,
    timeout: Duration,
    /// Received bytes that do not form a whole packet yet.
    came: Vec<u8>,
    last_received: Instant,
    last_sent: Instant,
    /// The topic that shows whether the PLC is there.
    status: Option<String>,
    /// Values last published, by topic.
    published: BTreeMap<String, String>,
    left_out: LeftOut,
}

/// A packet of a type, by the parts that follow its length.
fn packet(head: u8, parts: &[&[u8]]) -> Vec<u8> {
    let mut bytes = Vec::from([head]);
    let mut left = parts.iter().map(|part| part.len()).sum::<usize>();
    loop {
        let more = if left > 0x7f { 0x80 } else { 0 };
        bytes.push((left & 0x7f) as u8 | more);
        left >>= 7;
        if left == 0 {
            break;
        }
    }
    parts.iter().for_each(|part| bytes.extend_from_slice(part));
    bytes
}

/// A text with its length before it.
fn text(text: &str) -> Vec<u8> {
    let length = text.len().min(usize::from(u16::MAX));
    let mut bytes = (length as u16).to_be_bytes().to_vec();
    bytes.extend_from_slice(&text.as_bytes()[..length]);
    bytes
}

/// The packet at the start of what has come: its first byte, where its content is, and where it ends; `None` while it
/// is not whole.
fn cut(came: &[u8]) -> io::Result<Option<(u8, usize, usize)>> {
    let Some((&head, rest)) = came.split_first() else {
        return Ok(None);
    };
    let mut length = 0;
    for (n, &byte) in rest.iter().take(4).enumerate() {
        length |= usize::from(byte & 0x7f) << (7 * n);
        if byte & 0x80 == 0 {
            if length > LONGEST_PACKET {
                break;
            }
            let (from, to) = (n + 2, n + 2 + length);
            return Ok((came.len() >= to).then_some((head, from, to)));
        }
        if n == 3 {
            break;
        }
    }
    match rest.len() < 4 && length <= LONGEST_PACKET {
        true => Ok(None),
        false => Err(io::Error::new(ErrorKind::InvalidData, TOO_LONG)),
    }
}

/// Connects to the broker of a connection, and subscribes to the topics that are read.
pub(super) fn open(connection: &Connection) -> Result<Box<dyn Driver>, String> {
    let (host, port) = address(&connection.end, PORT)?;
    let host = if host.contains(':') {
        format!("[{host}]")
    } else {
        host
    };
    let timeout = Duration::from_millis(connection.timeout_ms);
    let now = Instant::now();
    let mut broker = Broker {
        stream: connect(&format!("{host}:{port}"), port, timeout)?,
        timeout,
        came: Vec::new(),
        last_received: now,
        last_sent: now,
        status: connection.options.get("status").cloned(),
        published: BTreeMap::new(),
        left_out: LeftOut::default(),
    };
    broker.greet(connection)?;
    Ok(Box::new(broker))
}

impl Broker {
    /// Introduces itself, and waits until the broker accepts it and has taken the subscriptions.
    fn greet(&mut self, connection: &Connection) -> Result<(), String> {
        let option = |key: &str| connection.options.get(key);
        let usual = || format!("rungc-{}-{}", connection.name, std::process::id());
        let id = option("client").cloned().unwrap_or_else(usual);
        let mut flags = 0x02;
        let mut payload = text(&id);
        if let Some(topic) = &self.status {
            // At least once, retained.
            flags |= 0x04 | 0x08 | 0x20;
            payload.extend(text(topic));
            payload.extend(text(OFFLINE));
        }
        if let Some((user, password)) = password(connection)? {
            flags |= 0x80 | 0x40;
            payload.extend(text(&user));
            payload.extend(text(&password));
        }
        let alive = (KEEP_ALIVE.as_secs() as u16).to_be_bytes();
        let name = text("MQTT");
        let hello = packet(CONNECT, &[&name, &[4, flags], &alive, &payload]);
        let lost = |error: io::Error| error.to_string();
        self.send(&hello).map_err(lost)?;
        let until = Instant::now() + self.timeout.max(Duration::from_secs(1));
        match self.wait(CONNACK, until).map_err(lost)?.as_slice() {
            [_, 0] => {}
            [_, 4 | 5] => return Err("the broker rejects the user or the password".to_string()),
            [_, code] => {
                return Err(format!(
                    "the broker rejects the connection with code {code}"
                ));
            }
            _ => return Err("the answer is not MQTT".to_string()),
        }
        let read = connection.directed(true).flat_map(topics);
        let filters = read.flat_map(|topic| [text(&topic.name), Vec::from([0])].concat());
        let filters: Vec<u8> = filters.collect();
        if !filters.is_empty() {
            self.send(&packet(SUBSCRIBE, &[&[0, 1], &filters]))
                .map_err(lost)?;
        }
        if let Some(topic) = self.status.clone() {
            self.publish(topic, ONLINE.to_string()).map_err(lost)?;
        }
        Ok(())
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.last_sent = Instant::now();
        self.stream.set_nonblocking(false)?;
        self.stream.set_write_timeout(Some(self.timeout))?;
        self.stream.write_all(bytes)
    }

    /// Takes what has come.
    fn receive(&mut self) -> io::Result<()> {
        let mut bytes = [0; 4096];
        loop {
            match self.stream.read(&mut bytes) {
                Ok(0) => {
                    let why = "closed by the broker";
                    return Err(io::Error::new(ErrorKind::UnexpectedEof, why));
                }
                Ok(count) => {
                    self.last_received = Instant::now();
                    self.came.extend_from_slice(&bytes[..count]);
                    if count < bytes.len() {
                        return Ok(());
                    }
                }
                Err(error) => match error.kind() {
                    ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted => {
                        return Ok(());
                    }
                    _ => return Err(error),
                },
            }
        }
    }

    /// The next whole packet.
    fn next(&mut self) -> io::Result<Option<(u8, Vec<u8>)>> {
        let Some((head, from, to)) = cut(&self.came)? else {
            return Ok(None);
        };
        let content = self.came[from..to].to_vec();
        self.came.drain(..to);
        Ok(Some((head, content)))
    }

    /// Waits for a packet of a type.
    fn wait(&mut self, wanted: u8, until: Instant) -> io::Result<Vec<u8>> {
        loop {
            if let Some((head, content)) = self.next()? {
                match head & 0xf0 == wanted {
                    true => return Ok(content),
                    false => continue,
                }
            }
            let left = until.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return Err(io::Error::new(ErrorKind::TimedOut, "no answer in time"));
            }
            self.stream.set_read_timeout(Some(left))?;
            self.receive()?;
        }
    }

    /// Publishes a value that is not what the topic shows already.
    fn publish(&mut self, topic: String, payload: String) -> io::Result<()> {
        if self.published.get(&topic) == Some(&payload) {
            return Ok(());
        }
        let parts = [&*text(&topic), payload.as_bytes()];
        self.send(&packet(PUBLISH | RETAINED, &parts))?;
        self.published.insert(topic, payload);
        Ok(())
    }

    /// One exchange.
    fn turn(
        &mut self,
        connection: &Connection,
        inputs: &mut [i16],
        outputs: &[i16],
    ) -> io::Result<()> {
        for row in connection.directed(false) {
            let values = &outputs[row.place.clone()];
            for topic in topics(row) {
                let payload = topic.payload(row, values);
                self.publish(topic.name, payload)?;
            }
        }
        self.stream.set_nonblocking(true)?;
        self.receive()?;
        while let Some((head, content)) = self.next()? {
            match head & 0xf0 {
                PUBLISH => {
                    if let Some((topic, payload)) = published(head, &content) {
                        take(connection, topic, payload, inputs, &mut self.left_out);
                    }
                }
                // A topic that this end may not read.
                SUBACK if content[content.len().min(2)..].contains(&0x80) => {
                    let why = "the broker rejects a subscription";
                    return Err(io::Error::new(ErrorKind::PermissionDenied, why));
                }
                _ => {}
            }
        }
        if self.last_received.elapsed() > KEEP_ALIVE * 2 {
            return Err(io::Error::new(ErrorKind::TimedOut, "the broker is silent"));
        }
        if self.last_sent.elapsed().min(self.last_received.elapsed()) > KEEP_ALIVE / 2
            || self.last_sent.elapsed() > KEEP_ALIVE / 2
        {
            self.send(&packet(PINGREQ, &[]))?;
        }
        Ok(())
    }
}

/// The topic and the payload of a PUBLISH; one of a higher QoS, which was not requested, has a number between them.
fn published(head: u8, content: &[u8]) -> Option<(&str, &[u8])> {
    let (length, rest) = content.split_first_chunk::<2>()?;
    let (topic, rest) = rest.split_at_checked(u16::from_be_bytes(*length).into())?;
    let payload = match head & 0x06 {
        0 => rest,
        _ => rest.get(2..)?,
    };
    Some((str::from_utf8(topic).ok()?, payload))
}

impl Driver for Broker {
    fn exchange(
        &mut self,
        connection: &Connection,
        inputs: &mut [i16],
        outputs: &[i16],
    ) -> Result<(), ExchangeError> {
        let done = self.turn(connection, inputs, outputs);
        done.map_err(|error| ExchangeError::Lost(error.to_string()))
    }

    fn reports(&mut self) -> Vec<String> {
        self.left_out.reports()
    }

    fn end(&mut self) {
        if let Some(topic) = self.status.clone() {
            // The broker receives it, or has gone.
            let _ = self.publish(topic, OFFLINE.to_string());
        }
        let _ = self.send(&packet(DISCONNECT, &[]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packets_are_cut() {
        let long = packet(PUBLISH, &[&[0; 321]]);
        assert_eq!(long[..3], [PUBLISH, 0xc1, 0x02]);
        assert_eq!(cut(&long).unwrap(), Some((PUBLISH, 3, 324)));
        for length in 0..long.len() {
            assert_eq!(cut(&long[..length]).unwrap(), None, "{length}");
        }
        assert!(cut(&[PUBLISH, 0xff, 0xff, 0xff, 0xff]).is_err());
        assert!(cut(&[PUBLISH, 0xff, 0xff, 0xff, 0x7f]).is_err());
        assert_eq!(
            published(PUBLISH, &[0, 1, b'a', b'1']),
            Some(("a", &b"1"[..]))
        );
        assert_eq!(
            published(PUBLISH | 2, &[0, 1, b'a', 0, 9, b'1']),
            Some(("a", &b"1"[..]))
        );
        for wrong in [vec![], vec![0], vec![0, 2, b'a'], vec![0, 1, 0xff]] {
            assert_eq!(published(PUBLISH, &wrong), None);
        }
    }
}
