//! Topics and payloads of brokers, by any client: a topic for each device, or one JSON object for the devices of a row.

use super::json::{self, Value};
use super::left_out::{LeftOut, shown};
use super::settings::{Connection, End, Row};
use std::fs;

/// Stands for the name of the device in the topic of a row.
const DEVICE: &str = "{}";

/// The longest packet that is taken from a broker, in bytes: a longer one ends the connection.
pub const LONGEST_PACKET: usize = 1 << 20;

/// Reason why a connection ended with a longer packet.
pub const TOO_LONG: &str =
    "a message has more than 1048576 bytes: publish shorter ones on the topics that are read";

/// A topic of a row, and what it shows.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Topic {
    /// Its name.
    pub name: String,
    /// The device of the row that it shows; `None`: all of them.
    device: Option<u32>,
}

/// The topics of a row; one for the row if its topic does not name the device.
pub fn topics(row: &Row) -> Vec<Topic> {
    let End::Name(topic) = &row.end else {
        return Vec::new();
    };
    let named = |n| Topic {
        name: topic.replace(DEVICE, &row.name(n)),
        device: Some(n),
    };
    match topic.contains(DEVICE) {
        true => (0..row.count).map(named).collect(),
        false => Vec::from([Topic {
            name: topic.clone(),
            device: (row.count == 1).then_some(0),
        }]),
    }
}

impl Topic {
    /// Payload for the values of its row.
    pub fn payload(&self, row: &Row, values: &[i16]) -> String {
        if let Some(n) = self.device {
            return values
                .get(n as usize)
                .map_or_else(String::new, i16::to_string);
        }
        let pairs: Vec<_> = (0..)
            .zip(values)
            .map(|(n, value)| format!("\"{}\":{value}", row.name(n)))
            .collect();
        format!("{{{}}}", pairs.join(","))
    }
}

/// Takes the payload of a topic. One with a value that does not fit is left out; an empty payload, by which brokers say that a
/// retained one is deleted, changes nothing.
pub fn take(
    connection: &Connection,
    topic: &str,
    payload: &[u8],
    inputs: &mut [i16],
    left_out: &mut LeftOut,
) {
    let payload = String::from_utf8_lossy(payload);
    let payload = payload.trim();
    if payload.is_empty() {
        return;
    }
    for row in connection.directed(true) {
        for Topic { device, .. } in topics(row).into_iter().filter(|own| own.name == topic) {
            let values = &mut inputs[row.place.clone()];
            let taken = match device {
                Some(n) => set(row, n, values, word(payload)),
                None => all(row, values, payload),
            };
            if let Err(why) = taken {
                let (payload, topic) = (shown(payload), shown(topic));
                left_out.add(format!("{topic}: `{payload}` is left out: {why}"));
            }
        }
    }
}

/// Takes an object by names of devices, or an array: all of it, or nothing if a value does not fit.
///
/// # Errors
/// Reason why it is left out.
fn all(row: &Row, values: &mut [i16], payload: &str) -> Result<(), String> {
    let example = row.name(0);
    let items = json::items(payload)
        .ok_or_else(|| format!("several values are written `{{\"{example}\": 1}}` or `[1, 0]`"))?;
    let mut taken = values.to_vec();
    let (mut named, is_empty) = (false, items.is_empty());
    for (n, (name, value)) in (0..).zip(items) {
        let n = match &name {
            Some(name) => (0..row.count).find(|&n| row.name(n) == *name),
            None if n < row.count => Some(n),
            None => return Err(format!("the row has {} values", row.count)),
        };
        if let Some(n) = n {
            set(row, n, &mut taken, Some(value))?;
            named = true;
        }
    }
    if !named && !is_empty {
        return Err(format!("it names no device of the row, such as {example}"));
    }
    values.copy_from_slice(&taken);
    Ok(())
}

/// A value alone; `on` and `off`, as many switches say.
fn word(payload: &str) -> Option<Value> {
    match payload.to_ascii_lowercase().as_str() {
        "on" => Some(Value::Bool(true)),
        "off" => Some(Value::Bool(false)),
        _ => json::value(payload),
    }
}

/// Gives a device of a row a value.
///
/// # Errors
/// The values that fit the device.
fn set(row: &Row, n: u32, values: &mut [i16], payload: Option<Value>) -> Result<(), String> {
    let (range, meaning) = match row.is_bits() {
        true => (0..=1, "0, 1, true, false, on or off"),
        false => (-0x8000..=0xffff, "a whole number from -32768 to 65535"),
    };
    let number = match payload {
        Some(Value::Bool(on)) => Some(i64::from(on)),
        Some(Value::Number(number)) => Some(number),
        Some(Value::Other) | None => None,
    };
    let number = number.filter(|number| range.contains(number));
    match number.zip(values.get_mut(n as usize)) {
        Some((number, device)) => {
            *device = number as i16;
            Ok(())
        }
        None => Err(format!("{} takes {meaning}", row.name(n))),
    }
}

/// The host and the port of a broker, as `host:port`, `[::1]:port`, an address or a name alone.
///
/// # Errors
/// What is not a port.
pub fn address(end: &str, usual: u16) -> Result<(String, u16), String> {
    let bare = |host: &str| host.trim_matches(['[', ']']).to_owned();
    match end.rsplit_once(':') {
        // An address of IPv6 without brackets.
        Some((host, _)) if host.contains(':') && !host.ends_with(']') => {
            Ok((end.to_owned(), usual))
        }
        Some((host, port)) => match port.parse() {
            Ok(port) => Ok((bare(host), port)),
            Err(_) => Err(format!("`{port}` is not a port")),
        },
        None => Ok((end.to_owned(), usual)),
    }
}

/// The user of a broker, and the password in the file that a connection names.
///
/// # Errors
/// Why the file cannot be read.
pub fn password(connection: &Connection) -> Result<Option<(String, String)>, String> {
    let option = |key: &str| connection.options.get(key);
    let Some(user) = option("user") else {
        return Ok(None);
    };
    let password = match option("password-file") {
        Some(file) => fs::read_to_string(file).map_err(|error| format!("{file}: {error}"))?,
        None => String::new(),
    };
    let password = password.trim_end_matches(['\r', '\n']);
    Ok(Some((user.clone(), password.to_owned())))
}
