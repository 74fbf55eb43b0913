//! Brokers: a topic for each device, or one JSON object for the devices of a row.

use rumqttc::{Client, Event, LastWill, MqttOptions, Packet, Publish, QoS};
use rungc_rt::io::{Connection, Driver, End, Row, Trouble};
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::fs;
use std::sync::mpsc::{self, Receiver, TryRecvError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// The port of MQTT.
const PORT: u16 = 1883;

/// The shortest time without a word after which the broker and this end look for each other.
const KEEP_ALIVE: Duration = Duration::from_secs(5);

/// Requests that wait for the broker, beside a subscription for each topic; what does not fit is published later, with
/// the value of then.
const WAITING: usize = 256;

/// Stands for the name of the device in the topic of a row.
const DEVICE: &str = "{}";

/// Payloads of the topic that shows whether the PLC is there.
const ONLINE: &str = "online";
const OFFLINE: &str = "offline";

/// What the thread of the connection reports.
enum News {
    /// The broker has accepted the connection.
    Connected,
    /// A topic has a value.
    Value(Publish),
    /// The connection is over.
    Lost(String),
}

/// A connection to a broker.
struct Broker {
    client: Client,
    news: Receiver<News>,
    thread: Option<JoinHandle<()>>,
    /// The topic that shows whether the PLC is there.
    status: Option<String>,
    /// What was published last, by topic.
    published: BTreeMap<String, String>,
}

/// Connects to the broker of a connection, and subscribes to the topics that are read.
pub fn open(connection: &Connection) -> Result<Box<dyn Driver>, String> {
    let (host, port) = match connection.end.rsplit_once(':') {
        Some((host, port)) => (
            host,
            port.parse()
                .map_err(|_| format!("`{port}` is not a port"))?,
        ),
        None => (&*connection.end, PORT),
    };
    let option = |key: &str| connection.options.get(key);
    let usual = || format!("rungc-{}-{}", connection.name, std::process::id());
    let id = option("client").cloned().unwrap_or_else(usual);
    let mut options = MqttOptions::new(id, host, port);
    options.set_keep_alive(KEEP_ALIVE);
    let status = option("status").cloned();
    if let Some(topic) = &status {
        options.set_last_will(LastWill::new(topic, OFFLINE, QoS::AtLeastOnce, true));
    }
    if let Some(user) = option("user") {
        let password = match option("password-file") {
            Some(file) => fs::read_to_string(file).map_err(|error| format!("{file}: {error}"))?,
            None => String::new(),
        };
        options.set_credentials(user, password.trim_end_matches(['\r', '\n']));
    }
    let subscribed = connection
        .directed(true)
        .flat_map(topics)
        .collect::<Vec<_>>();
    let (client, mut events) = Client::new(options, WAITING + subscribed.len());
    let timeout = Duration::from_millis(connection.timeout_ms);
    events
        .eventloop
        .network_options
        .set_connection_timeout(timeout.as_secs().max(1));
    let (sender, news) = mpsc::channel();
    let listen = move || {
        for event in events.iter() {
            let news = match event {
                Ok(Event::Incoming(Packet::ConnAck(_))) => News::Connected,
                Ok(Event::Incoming(Packet::Publish(publish))) => News::Value(publish),
                Ok(_) => continue,
                Err(error) => News::Lost(error.to_string()),
            };
            let is_over = matches!(news, News::Lost(_));
            if sender.send(news).is_err() || is_over {
                break;
            }
        }
    };
    let thread = thread::Builder::new()
        .name("mqtt".to_string())
        .spawn(listen);
    let mut broker = Broker {
        client,
        news,
        thread: Some(thread.map_err(|error| error.to_string())?),
        status,
        published: BTreeMap::new(),
    };
    // The system may take longer to find out that no one answers.
    match broker
        .news
        .recv_timeout(timeout.max(Duration::from_secs(1)))
    {
        Ok(News::Connected) => {}
        Ok(News::Lost(why)) => return Err(why),
        _ => return Err("no answer in time".to_string()),
    }
    for (topic, _) in subscribed {
        let subscribed = broker.client.try_subscribe(topic, QoS::AtLeastOnce);
        subscribed.map_err(|error| error.to_string())?;
    }
    if let Some(topic) = broker.status.clone() {
        broker.publish(topic, ONLINE.to_string());
    }
    Ok(Box::new(broker))
}

/// The topics of a row, with the device of each; one for the row if its topic does not name the device.
fn topics(row: &Row) -> Vec<(String, Option<u32>)> {
    let End::Name(topic) = &row.end else {
        return Vec::new();
    };
    match topic.contains(DEVICE) {
        true => {
            let devices = 0..row.count;
            devices
                .map(|n| (topic.replace(DEVICE, &row.name(n)), Some(n)))
                .collect()
        }
        false if row.count == 1 => vec![(topic.clone(), Some(0))],
        false => vec![(topic.clone(), None)],
    }
}

impl Broker {
    /// Publishes a value that is not what the topic shows already.
    fn publish(&mut self, topic: String, payload: String) {
        if self.published.get(&topic) == Some(&payload) {
            return;
        }
        let sent = self
            .client
            .try_publish(&topic, QoS::AtLeastOnce, true, payload.clone());
        if sent.is_ok() {
            self.published.insert(topic, payload);
        }
    }
}

impl Driver for Broker {
    fn exchange(
        &mut self,
        connection: &Connection,
        inputs: &mut [i16],
        outputs: &[i16],
    ) -> Result<(), Trouble> {
        for row in connection.directed(false) {
            let values = &outputs[row.place.clone()];
            for (topic, device) in topics(row) {
                let payload = match device {
                    Some(n) => values[n as usize].to_string(),
                    None => object(row, values),
                };
                self.publish(topic, payload);
            }
        }
        loop {
            match self.news.try_recv() {
                Ok(News::Value(publish)) => take(connection, &publish, inputs),
                Ok(News::Connected) => {}
                Ok(News::Lost(why)) => return Err(Trouble::Lost(why)),
                Err(TryRecvError::Empty) => return Ok(()),
                Err(TryRecvError::Disconnected) => {
                    return Err(Trouble::Lost("the connection has ended".to_string()));
                }
            }
        }
    }

    fn end(&mut self) {
        if let Some(topic) = self.status.clone() {
            self.publish(topic, OFFLINE.to_string());
        }
        let _ = self.client.try_disconnect();
        // All that was published before has been sent then.
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// The values of a row by the names of its devices.
fn object(row: &Row, values: &[i16]) -> String {
    let values = (0..).zip(values);
    let object: Map<String, Value> = values
        .map(|(n, &value)| (row.name(n), value.into()))
        .collect();
    Value::Object(object).to_string()
}

/// Takes the value of a topic; what does not fit a device is left out.
fn take(connection: &Connection, publish: &Publish, inputs: &mut [i16]) {
    for row in connection.directed(true) {
        let own = topics(row)
            .into_iter()
            .filter(|(topic, _)| *topic == publish.topic);
        for (_, device) in own {
            let values = &mut inputs[row.place.clone()];
            let payload = serde_json::from_slice(&publish.payload);
            let payload = payload.unwrap_or_else(|_| word(&publish.payload));
            match (device, payload) {
                (Some(n), payload) => set(row, &mut values[n as usize], &payload),
                (None, Value::Object(object)) => {
                    for (n, value) in (0..).zip(values) {
                        if let Some(payload) = object.get(&row.name(n)) {
                            set(row, value, payload);
                        }
                    }
                }
                (None, Value::Array(list)) => {
                    for (value, payload) in values.iter_mut().zip(&list) {
                        set(row, value, payload);
                    }
                }
                (None, _) => {}
            }
        }
    }
}

/// `on` and `off`, as many switches say.
fn word(payload: &[u8]) -> Value {
    match payload.trim_ascii().to_ascii_lowercase().as_slice() {
        b"on" => Value::Bool(true),
        b"off" => Value::Bool(false),
        _ => Value::Null,
    }
}

/// Gives a device a value that fits it.
fn set(row: &Row, device: &mut i16, payload: &Value) {
    let number = match payload {
        Value::Bool(on) => Some(i64::from(*on)),
        payload => payload.as_i64(),
    };
    let range = if row.is_bits() {
        0..=1
    } else {
        -0x8000..=0xffff
    };
    if let Some(number) = number.filter(|number| range.contains(number)) {
        *device = number as i16;
    }
}
