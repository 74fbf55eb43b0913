//! Topics and payloads of brokers, by any client: a topic for each device, or one JSON object for the devices of a row.

use super::json::{self, Value};
use super::settings::{Connection, End, Row};
use std::fs;

/// Stands for the name of the device in the topic of a row.
const DEVICE: &str = "{}";

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

/// Takes the payload of a topic; what does not fit a device is left out.
pub fn take(connection: &Connection, topic: &str, payload: &[u8], inputs: &mut [i16]) {
    let payload = str::from_utf8(payload).unwrap_or_default().trim();
    for row in connection.directed(true) {
        for Topic { device, .. } in topics(row).into_iter().filter(|own| own.name == topic) {
            let values = &mut inputs[row.place.clone()];
            match device {
                Some(n) => set(row, values.get_mut(n as usize), word(payload)),
                None => all(row, values, payload),
            }
        }
    }
}

/// Takes an object by names of devices, or an array.
fn all(row: &Row, values: &mut [i16], payload: &str) {
    for (at, (name, value)) in json::items(payload).into_iter().enumerate() {
        let place = match &name {
            Some(name) => (0..row.count).position(|n| row.name(n) == *name),
            None => Some(at),
        };
        if let Some(place) = place {
            set(row, values.get_mut(place), Some(value));
        }
    }
}

/// A value alone; `on` and `off`, as many switches say.
fn word(payload: &str) -> Option<Value> {
    match payload.to_ascii_lowercase().as_str() {
        "on" => Some(Value::Bool(true)),
        "off" => Some(Value::Bool(false)),
        _ => json::value(payload),
    }
}

/// Gives a device a value that fits it.
fn set(row: &Row, device: Option<&mut i16>, payload: Option<Value>) {
    let number = match payload {
        Some(Value::Bool(on)) => i64::from(on),
        Some(Value::Number(number)) => number,
        Some(Value::Other) | None => return,
    };
    let range = if row.is_bits() {
        0..=1
    } else {
        -0x8000..=0xffff
    };
    if let Some(device) = device.filter(|_| range.contains(&number)) {
        *device = number as i16;
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
