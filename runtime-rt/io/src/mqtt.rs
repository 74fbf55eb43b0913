//! Brokers, by rumqttc: values are published at least once.

#[cfg(feature = "tls")]
use crate::tls::explained;
use rumqttc::{Client, Event, LastWill, MqttOptions, Packet, Publish, QoS, StateError};
use rumqttc::{ConnectionError, Error};
use rungc_host::io::{
    Connection, Driver, ExchangeError, LONGEST_PACKET, LeftOut, Opener, TOO_LONG, address,
    password, take, topics,
};
use std::collections::BTreeMap;
use std::sync::mpsc::{self, Receiver, TryRecvError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// The port of MQTT.
const PORT: u16 = 1883;

/// The port of MQTT over TLS.
const TLS_PORT: u16 = 8883;

/// The shortest time without a word after which the broker and this end look for each other.
const KEEP_ALIVE: Duration = Duration::from_secs(5);

/// Requests that wait for the broker, beside a subscription for each topic; what does not fit is published later, with
/// the value of then.
const WAITING: usize = 256;

/// Payloads of the topic that shows whether the PLC is there.
const ONLINE: &str = "online";
const OFFLINE: &str = "offline";

/// News from the thread of the connection.
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
    /// Values last published, by topic.
    published: BTreeMap<String, String>,
    left_out: LeftOut,
}

/// Returns the opener of a broker.
///
/// # Errors
///
/// The connection is by TLS, which this build lacks.
pub fn opener(connection: &Connection) -> Result<Opener, String> {
    match connection.is_encrypted() && cfg!(not(feature = "tls")) {
        true => Err(String::from(
            "this rungc is built without TLS; install it with `--features tls` (`rungc book linux`)",
        )),
        false => Ok(open),
    }
}

/// Options of the client for a connection.
fn options(connection: &Connection) -> Result<MqttOptions, String> {
    let port = if connection.is_encrypted() {
        TLS_PORT
    } else {
        PORT
    };
    let (host, port) = address(&connection.end, port)?;
    let option = |key: &str| connection.options.get(key);
    let usual = || format!("rungc-{}-{}", connection.name, std::process::id());
    let id = option("client").cloned().unwrap_or_else(usual);
    let mut options = MqttOptions::new(id, host, port);
    options.set_keep_alive(KEEP_ALIVE);
    options.set_max_packet_size(LONGEST_PACKET, LONGEST_PACKET);
    if let Some(topic) = option("status") {
        options.set_last_will(LastWill::new(topic, OFFLINE, QoS::AtLeastOnce, true));
    }
    if let Some((user, password)) = password(connection)? {
        options.set_credentials(user, password);
    }
    #[cfg(feature = "tls")]
    if let Some(transport) = crate::tls::transport(connection)? {
        options.set_transport(transport);
    }
    Ok(options)
}

/// Connects to the broker of a connection, and subscribes to the topics that are read.
fn open(connection: &Connection) -> Result<Box<dyn Driver>, String> {
    let options = options(connection)?;
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
    let described = connection.clone();
    let listen = move || listen(events, &sender, &described);
    let thread = thread::Builder::new()
        .name("mqtt".to_string())
        .spawn(listen);
    let mut broker = Broker {
        client,
        news,
        thread: Some(thread.map_err(|error| error.to_string())?),
        status: connection.options.get("status").cloned(),
        published: BTreeMap::new(),
        left_out: LeftOut::default(),
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
    for topic in subscribed {
        let subscribed = broker.client.try_subscribe(topic.name, QoS::AtLeastOnce);
        subscribed.map_err(|error| error.to_string())?;
    }
    if let Some(topic) = broker.status.clone() {
        broker.publish(topic, ONLINE.to_string());
    }
    Ok(Box::new(broker))
}

/// Passes what a broker sends on, until the connection is lost.
fn listen(mut events: rumqttc::Connection, sender: &mpsc::Sender<News>, connection: &Connection) {
    let mut accepted = false;
    for event in events.iter() {
        let news = match event {
            Ok(Event::Incoming(Packet::ConnAck(_))) => News::Connected,
            Ok(Event::Incoming(Packet::Publish(publish))) => News::Value(publish),
            Ok(_) => continue,
            Err(error) if is_too_long(&error) => News::Lost(TOO_LONG.to_string()),
            Err(error) => News::Lost(explained(&error, connection, accepted)),
        };
        accepted = true;
        let is_over = matches!(news, News::Lost(_));
        if sender.send(news).is_err() || is_over {
            break;
        }
    }
}

/// Returns true if the broker has sent a packet that is too long.
fn is_too_long(error: &ConnectionError) -> bool {
    matches!(
        error,
        ConnectionError::MqttState(StateError::Deserialization(
            Error::PayloadSizeLimitExceeded(_)
        ))
    )
}

/// Reason why there is no connection; `accepted`: whether there was one.
#[cfg(not(feature = "tls"))]
fn explained(error: &ConnectionError, _: &Connection, _accepted: bool) -> String {
    error.to_string()
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
    ) -> Result<(), ExchangeError> {
        for row in connection.directed(false) {
            let values = &outputs[row.place.clone()];
            for topic in topics(row) {
                let payload = topic.payload(row, values);
                self.publish(topic.name, payload);
            }
        }
        loop {
            match self.news.try_recv() {
                Ok(News::Value(publish)) => {
                    let (topic, payload) = (&publish.topic, &publish.payload);
                    take(connection, topic, payload, inputs, &mut self.left_out);
                }
                Ok(News::Connected) => {}
                Ok(News::Lost(why)) => return Err(ExchangeError::Lost(why)),
                Err(TryRecvError::Empty) => return Ok(()),
                Err(TryRecvError::Disconnected) => {
                    return Err(ExchangeError::Lost("the connection has ended".to_string()));
                }
            }
        }
    }

    fn reports(&mut self) -> Vec<String> {
        self.left_out.reports()
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
