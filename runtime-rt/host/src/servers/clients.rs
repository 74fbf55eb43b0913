//! Requests of a program to servers over TCP.

use rungc_rt::Plc;
use rungc_rt::comm::modbus::client::{Client, ClientAction, ClientRow, Link};
use rungc_rt::comm::service::ServerProtocol;
use rungc_rt::comm::{Frame, Ports, Served};
use std::io::{self, ErrorKind, Read, Write};
use std::net::{IpAddr, SocketAddr, TcpStream};
use std::sync::mpsc::{self, Receiver, TryRecvError};
use std::thread;
use std::time::{Duration, Instant};

/// Timeout of an attempt to connect.
const CONNECT_WAIT: Duration = Duration::from_secs(3);

/// Characters that one connection may bring between two scans.
const AT_ONCE: usize = 1024;

/// The longest frame.
const LONGEST: usize = rungc_rt::comm::modbus::tcp::LONGEST;

/// The clients of a program: its table of requests, by servers.
#[derive(Debug)]
pub struct Clients {
    begin: Instant,
    clients: Vec<Peer>,
}

/// A server that receives requests.
#[derive(Debug)]
struct Peer {
    address: SocketAddr,
    rows: Vec<ClientRow>,
    client: Client,
    connection: Connection,
}

#[derive(Debug)]
enum Connection {
    Closed,
    /// A thread tries, because the system may take long.
    Opening(Receiver<io::Result<TcpStream>>),
    Open(TcpStream),
}

/// A frame that has gone over a connection.
#[derive(Clone, Copy, Debug)]
pub struct ClientFrame<'a> {
    /// This end.
    pub client: SocketAddr,
    /// The server.
    pub server: SocketAddr,
    /// True for a request, false for an answer or its outcome.
    pub request: bool,
    /// The frame.
    pub bytes: &'a [u8],
}

impl Clients {
    /// The clients of a table; rows of one server share a connection.
    pub fn new(family: Ports, table: impl IntoIterator<Item = (SocketAddr, ClientRow)>) -> Self {
        let mut clients: Vec<Peer> = Vec::new();
        for (address, row) in table {
            match clients.iter_mut().find(|peer| peer.address == address) {
                Some(peer) => peer.rows.push(row),
                None => clients.push(Peer {
                    address,
                    rows: Vec::from([row]),
                    client: Client::new(family, last_part(address.ip())),
                    connection: Connection::Closed,
                }),
            }
        }
        Clients {
            begin: Instant::now(),
            clients,
        }
    }

    /// The servers that receive requests.
    pub fn servers(&self) -> impl Iterator<Item = SocketAddr> {
        self.clients.iter().map(|peer| peer.address)
    }

    /// Takes what has come, and asks what is next; call it between two scans. `seen` is shown each frame.
    pub fn poll(&mut self, plc: &mut dyn Plc, mut seen: impl FnMut(ClientFrame)) {
        let now_us = self.begin.elapsed().as_micros() as u32;
        for peer in &mut self.clients {
            peer.poll(plc, now_us, &mut seen);
        }
    }

    /// Traffic of the connections, a row for each as in [`Servers::table`](super::Servers::table).
    pub fn table(&self) -> Vec<String> {
        let rows = self.clients.iter().map(|peer| {
            let tally = peer.client.tally;
            let counts = [tally.requests, tally.answers, tally.rejected, 0].map(u64::from);
            super::all::row(
                &peer.address.to_string(),
                "by PLC",
                ServerProtocol::ModbusTcp.name(),
                counts,
            )
        });
        rows.collect()
    }
}

/// The last part of an IP address, which error codes show.
fn last_part(address: IpAddr) -> u8 {
    let last = match address {
        IpAddr::V4(address) => address.octets().last().copied(),
        IpAddr::V6(address) => address.octets().last().copied(),
    };
    last.unwrap_or_default()
}

impl Peer {
    fn poll(&mut self, plc: &mut dyn Plc, now_us: u32, seen: &mut dyn FnMut(ClientFrame)) {
        self.connect(plc, now_us);
        self.receive(plc, now_us, seen);
        let link = match self.connection {
            Connection::Closed => Link::Closed,
            Connection::Opening(_) => Link::Opening,
            Connection::Open(_) => Link::Open,
        };
        let mut bytes = [0; LONGEST];
        let mut request = Frame::new(&mut bytes);
        let mut map = Served::new(plc, 0);
        let action = self
            .client
            .next(&self.rows, link, now_us, &mut map, &mut request);
        match action {
            ClientAction::Nothing => {}
            ClientAction::Close => self.connection = Connection::Closed,
            ClientAction::Open => self.connection = open(self.address),
            ClientAction::Send => self.send(request.as_slice(), plc, now_us, seen),
        }
    }

    /// Takes the connection that a thread has opened.
    fn connect(&mut self, plc: &mut dyn Plc, now_us: u32) {
        let Connection::Opening(opened) = &self.connection else {
            return;
        };
        match opened.try_recv() {
            Ok(Ok(stream)) => self.connection = Connection::Open(stream),
            Err(TryRecvError::Empty) => {}
            Ok(Err(_)) | Err(TryRecvError::Disconnected) => self.lose(plc, now_us),
        }
    }

    /// Takes what has come.
    fn receive(&mut self, plc: &mut dyn Plc, now_us: u32, seen: &mut dyn FnMut(ClientFrame)) {
        let Connection::Open(stream) = &mut self.connection else {
            return;
        };
        let mut bytes = [0; AT_ONCE];
        match stream.read(&mut bytes) {
            Err(error) if is_later(&error) => {}
            Ok(count @ 1..) => {
                let bytes = bytes.get(..count).unwrap_or_default();
                report(stream, self.address, false, bytes, seen);
                let mut map = Served::new(plc, 0);
                let closes = bytes.iter().any(|&byte| {
                    self.client.feed(&self.rows, byte, now_us, &mut map) == ClientAction::Close
                });
                if closes {
                    self.connection = Connection::Closed;
                }
            }
            Ok(0) | Err(_) => self.lose(plc, now_us),
        }
    }

    /// Sends a request. It is shorter than any buffer of the system, so one that does not fit is the end.
    fn send(
        &mut self,
        request: &[u8],
        plc: &mut dyn Plc,
        now_us: u32,
        seen: &mut dyn FnMut(ClientFrame),
    ) {
        if let Connection::Open(stream) = &mut self.connection {
            match stream.write(request) {
                Ok(count) if count == request.len() => {
                    report(stream, self.address, true, request, seen);
                }
                _ => self.lose(plc, now_us),
            }
        }
    }

    fn lose(&mut self, plc: &mut dyn Plc, now_us: u32) {
        self.connection = Connection::Closed;
        self.client.lost(now_us, &mut Served::new(plc, 0));
    }
}

/// Returns true if there is nothing to read yet.
fn is_later(error: &io::Error) -> bool {
    [ErrorKind::WouldBlock, ErrorKind::Interrupted].contains(&error.kind())
}

fn report(
    stream: &TcpStream,
    server: SocketAddr,
    request: bool,
    bytes: &[u8],
    seen: &mut dyn FnMut(ClientFrame),
) {
    if let Ok(client) = stream.local_addr() {
        seen(ClientFrame {
            client,
            server,
            request,
            bytes,
        });
    }
}

fn open(address: SocketAddr) -> Connection {
    let (sender, opened) = mpsc::channel();
    thread::spawn(move || {
        let stream = TcpStream::connect_timeout(&address, CONNECT_WAIT).and_then(|stream| {
            stream.set_nonblocking(true)?;
            // A request is one small packet: waiting for more only delays it.
            stream.set_nodelay(true)?;
            Ok(stream)
        });
        // The program may have given up.
        let _ = sender.send(stream);
    });
    Connection::Opening(opened)
}
