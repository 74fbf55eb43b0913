//! Dialogue over one connection: received requests and their answers.

use rungc_rt::comm::service::{Connection, FeedResult, LONGEST_REPLY, Service};
use rungc_rt::comm::{Frame, Map};

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
    /// RUN or STOP, if the request switches the PLC to it, by a command or by special relays.
    pub running: Option<bool>,
}

impl Dialogue {
    /// A new connection.
    pub fn new(service: Service) -> Self {
        Dialogue(Connection::new(service))
    }

    /// A request that has begun and is not whole, as one that is rejected without an answer.
    pub fn unfinished(&self) -> Option<Exchange> {
        self.0.is_receiving().then(|| Exchange {
            request: self.0.request().to_vec(),
            rejected: true,
            ..Exchange::default()
        })
    }

    /// Takes what has come, and carries out and answers each request in it.
    pub fn receive(&mut self, bytes: &[u8], map: &mut dyn Map) -> Reaction {
        let mut reaction = Reaction::default();
        let mut buffer = [0; LONGEST_REPLY];
        for &byte in bytes {
            let mut frame = Frame::new(&mut buffer);
            let result = self.0.feed(byte, map, &mut frame);
            if result == FeedResult::More {
                continue;
            }
            let reply = frame.as_slice().to_vec();
            reaction.reply.extend_from_slice(&reply);
            reaction.exchanges.push(Exchange {
                request: self.0.request().to_vec(),
                reply,
                rejected: result != FeedResult::Request,
                running: self.0.switched(),
            });
            if result == FeedResult::Lost {
                reaction.closes = true;
                break;
            }
        }
        reaction
    }
}
