//! Dialogue over one connection: received requests and their answers.

use rungc_rt::Class;
use rungc_rt::comm::service::{Connection, FeedResult, LONGEST_REPLY, Service};
use rungc_rt::comm::{Frame, Map};

/// Relay that switches the PLC to STOP.
const FORCED_STOP: u32 = 8037;

/// One connection to a PLC.
#[derive(Debug)]
pub struct Dialogue(Connection);

/// Reaction of a connection to received bytes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Reaction {
    /// Bytes to send.
    pub reply: Vec<u8>,
    /// True if the connection closes, because the input was not a request.
    pub closes: bool,
    /// The requests that were carried out or rejected.
    pub exchanges: Vec<Exchange>,
}

/// A request and its answer.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Exchange {
    /// The request.
    pub request: Vec<u8>,
    /// The answer; empty if there is none.
    pub reply: Vec<u8>,
    /// True if the request was rejected.
    pub rejected: bool,
    /// RUN or STOP, if the request switches to it.
    pub running: Option<bool>,
}

impl Dialogue {
    /// A new connection.
    pub fn new(service: Service) -> Self {
        Dialogue(Connection::new(service))
    }

    /// Takes what has come, and carries out and answers each request in it.
    pub fn receive(&mut self, bytes: &[u8], map: &mut dyn Map) -> Reaction {
        let mut reaction = Reaction::default();
        let mut buffer = [0; LONGEST_REPLY];
        let mut current = mode(map);
        for &byte in bytes {
            let mut frame = Frame::new(&mut buffer);
            let result = self.0.feed(byte, map, &mut frame);
            if result == FeedResult::More {
                continue;
            }
            let before = std::mem::replace(&mut current, mode(map));
            let reply = frame.as_slice().to_vec();
            reaction.reply.extend_from_slice(&reply);
            reaction.exchanges.push(Exchange {
                request: self.0.request().to_vec(),
                reply,
                rejected: result != FeedResult::Request,
                running: current.filter(|_| current != before),
            });
            if result == FeedResult::Lost {
                reaction.closes = true;
                break;
            }
        }
        reaction
    }
}

/// RUN or STOP, to which the PLC switches before its next scan.
fn mode(map: &dyn Map) -> Option<bool> {
    let is_stopped = map.bit(Class::M, FORCED_STOP) == Some(true);
    map.requested_running().or(is_stopped.then_some(false))
}
