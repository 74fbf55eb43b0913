//! The connections of one address.

use super::{Dialogue, Exchange};
use rungc_rt::comm::Map;
use rungc_rt::comm::service::Service;
use std::io::{self, ErrorKind, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::time::Instant;

/// Connections at once. When one more comes, the one that has been silent longest gives way.
const CONNECTIONS: usize = 16;

/// Bytes that one connection may have carried out between two scans.
const AT_ONCE: usize = 4096;

/// Bytes that wait for a client that does not read; then its connection is closed.
const UNREAD: usize = 1 << 16;

/// A server that is polled between scans, and never waits.
#[derive(Debug)]
pub struct Server {
    listener: TcpListener,
    service: Service,
    connections: Vec<Connection>,
}

#[derive(Debug)]
struct Connection {
    stream: TcpStream,
    peer: SocketAddr,
    dialogue: Dialogue,
    to_send: Vec<u8>,
    /// True if the connection closes after the pending output.
    closes: bool,
    /// Time of the last input.
    last_received: Instant,
}

impl Server {
    /// Listens at an address.
    ///
    /// # Errors
    /// What the system says: the address is taken, or not to be had.
    pub fn bind(address: SocketAddr, service: Service) -> io::Result<Self> {
        let listener = TcpListener::bind(address)?;
        listener.set_nonblocking(true)?;
        Ok(Server {
            listener,
            service,
            connections: Vec::new(),
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
    pub fn poll(&mut self, map: &mut dyn Map) -> Vec<(SocketAddr, Exchange)> {
        // A listener that fails (too many open files) is polled again after the next scan.
        while let Ok((stream, peer)) = self.listener.accept() {
            self.accept(stream, peer);
        }
        let mut exchanges = Vec::new();
        self.connections
            .retain_mut(|connection| connection.poll(map, &mut exchanges));
        exchanges
    }

    fn accept(&mut self, stream: TcpStream, peer: SocketAddr) {
        if stream.set_nonblocking(true).is_err() {
            return;
        }
        // An answer is one small packet: waiting for more only delays it.
        let _ = stream.set_nodelay(true);
        if self.connections.len() == CONNECTIONS {
            let silent = self.connections.iter().enumerate();
            let longest = silent.min_by_key(|(_, connection)| connection.last_received);
            if let Some(n) = longest.map(|(n, _)| n) {
                self.connections.swap_remove(n);
            }
        }
        self.connections.push(Connection {
            stream,
            peer,
            dialogue: Dialogue::new(self.service),
            to_send: Vec::new(),
            closes: false,
            last_received: Instant::now(),
        });
    }
}

impl Connection {
    /// Does what there is to do; false when the connection is over.
    fn poll(&mut self, map: &mut dyn Map, exchanges: &mut Vec<(SocketAddr, Exchange)>) -> bool {
        let mut left = AT_ONCE;
        while left > 0 && !self.closes && self.to_send.len() < UNREAD {
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
                    exchanges.extend(of_peer.map(|exchange| (self.peer, exchange)));
                    self.closes |= reaction.closes;
                }
                Err(error) if error.kind() == ErrorKind::WouldBlock => break,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(_) => return false,
            }
        }
        self.send()
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
