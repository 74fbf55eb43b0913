//! The connections of one address.

use super::{Dialogue, Exchange};
use rungc_rt::comm::Map;
use rungc_rt::comm::service::{IDLE_S, REQUEST_S, Service, USUAL_CLIENTS};
use std::io::{self, ErrorKind, Read, Write};
use std::net::{Shutdown, SocketAddr, TcpListener, TcpStream};
use std::time::{Duration, Instant};

/// Limits of a server's connections.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Connections at once. One more is rejected, unless another one is idle.
    pub clients: usize,
    /// Time after which a silent connection is idle, so that it gives way to a new one.
    pub idle: Duration,
    /// Time of silence after which an incomplete request ends its connection.
    pub request: Duration,
}

impl Default for Limits {
    fn default() -> Self {
        Limits {
            clients: USUAL_CLIENTS,
            idle: Duration::from_secs(IDLE_S.into()),
            request: Duration::from_secs(REQUEST_S.into()),
        }
    }
}

/// Bytes that one connection may have carried out between two scans.
const AT_ONCE: usize = 4096;

/// Bytes that wait for a client that does not read; then its connection is closed.
const UNREAD: usize = 1 << 16;

/// Time for which input of a lost connection is dropped: closed with unread input, it would be reset, and its last
/// answer lost.
const LINGER: Duration = Duration::from_secs(1);

/// A server that is polled between scans, and never waits.
#[derive(Debug)]
pub struct Server {
    listener: TcpListener,
    service: Service,
    limits: Limits,
    connections: Vec<Connection>,
    /// True from a refusal until there is room again.
    is_full: bool,
}

/// Event of a server.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ServerEvent {
    /// A request and its answer.
    Exchange(Exchange),
    /// A connection is rejected, the first one since there was room.
    Full,
}

#[derive(Debug)]
struct Connection {
    stream: TcpStream,
    peer: SocketAddr,
    dialogue: Dialogue,
    to_send: Vec<u8>,
    /// True if the connection closes after the pending output.
    closes: bool,
    /// Where the next request begins is unknown: the connection ends with the pending output.
    is_lost: bool,
    /// Nothing more is sent.
    is_shut: bool,
    /// Time of the last input.
    last_received: Instant,
}

impl Server {
    /// Listens at an address.
    ///
    /// # Errors
    /// What the system says: the address is taken, or not to be had.
    pub fn bind(address: SocketAddr, service: Service, limits: Limits) -> io::Result<Self> {
        let listener = TcpListener::bind(address)?;
        listener.set_nonblocking(true)?;
        Ok(Server {
            listener,
            service,
            limits,
            connections: Vec::new(),
            is_full: false,
        })
    }

    /// Address it listens on, with the port chosen for port 0.
    ///
    /// # Errors
    /// What the system says.
    pub fn address(&self) -> io::Result<SocketAddr> {
        self.listener.local_addr()
    }

    /// Returns true if a client is connected.
    pub fn is_connected(&self) -> bool {
        !self.connections.is_empty()
    }

    /// Protocol that it speaks.
    pub fn service(&self) -> Service {
        self.service
    }

    /// Takes new connections, and carries out and answers what has come over all of them. Returns that, with the
    /// address of each client.
    pub fn poll(&mut self, map: &mut dyn Map) -> Vec<(SocketAddr, ServerEvent)> {
        let mut events = Vec::new();
        self.connections
            .retain_mut(|connection| connection.poll(self.limits.request, map, &mut events));
        // A listener that fails (too many open files) is polled again after the next scan.
        while let Ok((stream, peer)) = self.listener.accept() {
            if self.has_room() {
                self.is_full = false;
                self.accept(stream, peer);
            } else if !std::mem::replace(&mut self.is_full, true) {
                events.push((peer, ServerEvent::Full));
            }
        }
        events
    }

    /// Returns true if there is room for one more connection. If all are taken, an idle one is closed.
    fn has_room(&mut self) -> bool {
        if self.connections.len() < self.limits.clients {
            return true;
        }
        let connections = self.connections.iter().enumerate();
        let idle = connections
            .filter(|(_, connection)| connection.is_idle(self.limits.idle))
            .min_by_key(|(_, connection)| connection.last_received);
        match idle {
            Some((index, _)) => {
                self.connections.swap_remove(index);
                true
            }
            None => false,
        }
    }

    fn accept(&mut self, stream: TcpStream, peer: SocketAddr) {
        if stream.set_nonblocking(true).is_err() {
            return;
        }
        // An answer is one small packet: waiting for more only delays it.
        let _ = stream.set_nodelay(true);
        self.connections.push(Connection {
            stream,
            peer,
            dialogue: Dialogue::new(self.service),
            to_send: Vec::new(),
            closes: false,
            is_lost: false,
            is_shut: false,
            last_received: Instant::now(),
        });
    }
}

impl Connection {
    /// Does what there is to do; false when the connection is over. An incomplete request ends it after a time of
    /// silence.
    fn poll(
        &mut self,
        request: Duration,
        map: &mut dyn Map,
        events: &mut Vec<(SocketAddr, ServerEvent)>,
    ) -> bool {
        let mut left = AT_ONCE;
        while left > 0 && !self.closes && !self.is_lost && self.to_send.len() < UNREAD {
            let mut bytes = [0; 512];
            let most = bytes.len().min(left);
            match self.stream.read(&mut bytes[..most]) {
                Ok(0) => self.closes = true,
                Ok(count) => {
                    left -= count;
                    self.last_received = Instant::now();
                    let reaction = self.dialogue.receive(&bytes[..count], map);
                    self.to_send.extend(reaction.reply);
                    let of_peer = reaction.exchanges.into_iter();
                    events.extend(of_peer.map(|it| (self.peer, ServerEvent::Exchange(it))));
                    self.is_lost = reaction.closes;
                }
                Err(error) if error.kind() == ErrorKind::WouldBlock => break,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(_) => return false,
            }
        }
        if !self.is_lost
            && self.last_received.elapsed() >= request
            && let Some(rejected) = self.dialogue.unfinished()
        {
            events.push((self.peer, ServerEvent::Exchange(rejected)));
            self.is_lost = true;
        }
        self.send() && (!self.is_lost || self.drain())
    }

    /// Drops what still comes over a lost connection until its client closes it; false when it is over.
    fn drain(&mut self) -> bool {
        if self.to_send.is_empty() && !self.is_shut {
            self.is_shut = self.stream.shutdown(Shutdown::Write).is_ok();
        }
        let goes_on = match self.stream.read(&mut [0; AT_ONCE]) {
            Ok(count) => count > 0,
            Err(error) => [ErrorKind::WouldBlock, ErrorKind::Interrupted].contains(&error.kind()),
        };
        goes_on && self.last_received.elapsed() < LINGER
    }

    /// Returns true if it gives way to a new connection.
    fn is_idle(&self, idle: Duration) -> bool {
        self.is_lost || self.last_received.elapsed() >= idle
    }

    /// Sends what the client takes; false when the connection is over.
    fn send(&mut self) -> bool {
        while !self.to_send.is_empty() {
            match self.stream.write(&self.to_send) {
                Ok(0) => return false,
                Ok(count) => {
                    self.to_send.drain(..count);
                }
                Err(error) if error.kind() == ErrorKind::WouldBlock => {
                    return !self.closes && self.to_send.len() < UNREAD;
                }
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(_) => return false,
            }
        }
        !self.closes
    }
}
