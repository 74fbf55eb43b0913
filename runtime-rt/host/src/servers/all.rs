//! The servers of a program.

use super::Server;
use rungc_rt::Plc;
use rungc_rt::comm::Served;
use rungc_rt::comm::service::{Service, TABLE_HEADING};
use std::collections::BTreeMap;
use std::io;
use std::net::{IpAddr, SocketAddr};

/// The servers of a program, and what has gone over their connections.
#[derive(Debug, Default)]
pub struct Servers {
    servers: Vec<Open>,
    /// By the server's place in `servers`, and by client.
    clients: BTreeMap<(usize, IpAddr), Counts>,
}

/// A server, and where it listens.
#[derive(Debug)]
struct Open {
    server: Server,
    address: SocketAddr,
}

/// Traffic counters of a client's connections.
#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    requests: u64,
    answers: u64,
    rejected: u64,
}

impl Servers {
    /// None.
    pub fn new() -> Self {
        Self::default()
    }

    /// Opens one more; returns where it listens: port 0 has become a free one.
    ///
    /// # Errors
    /// What the system says: the address is taken, or not to be had.
    pub fn open(&mut self, service: Service, address: SocketAddr) -> io::Result<SocketAddr> {
        let server = Server::bind(address, service)?;
        let address = server.address()?;
        self.servers.push(Open { server, address });
        Ok(address)
    }

    /// Carries out and answers the requests of clients since the last call; returns RUN or STOP if one has requested
    /// it.
    pub fn poll(&mut self, plc: &mut dyn Plc) -> Option<bool> {
        let mut request = None;
        for (n, Open { server, .. }) in self.servers.iter_mut().enumerate() {
            let mut map = Served::new(plc, server.service().type_code);
            for (client, exchange) in server.poll(&mut map) {
                let counts = self.clients.entry((n, client.ip())).or_default();
                counts.requests += 1;
                counts.answers += u64::from(!exchange.reply.is_empty());
                counts.rejected += u64::from(exchange.rejected);
            }
            request = map.take_request().or(request);
        }
        request
    }

    /// A table of what has gone over the connections, a line for each row; empty if there is no server.
    pub fn table(&self) -> Vec<String> {
        let mut rows = Vec::new();
        for (n, Open { server, address }) in self.servers.iter().enumerate() {
            let protocol = server.service().protocol.name();
            let mut row = |client: &str, counts: &Counts| {
                let counts = [counts.requests, counts.answers, counts.rejected];
                rows.push(self::row(&address.to_string(), client, protocol, counts));
            };
            let mut clients = self.clients.range((n, IpAddr::from([0; 4]))..).peekable();
            if clients.peek().is_none_or(|((at, _), _)| *at != n) {
                row("-", &Counts::default());
            }
            for ((_, client), counts) in clients.take_while(|((at, _), _)| *at == n) {
                row(&client.to_string(), counts);
            }
        }
        if !rows.is_empty() {
            rows.insert(0, TABLE_HEADING.to_string());
        }
        rows
    }
}

/// A row of the table: a server, its client, the protocol, and how many requests, answers and rejections.
pub(super) fn row(server: &str, client: &str, protocol: &str, counts: [u64; 3]) -> String {
    let [requests, answers, rejected] = counts;
    format!(
        "{server:<21}  {client:<15}  {protocol:<16}  {requests:>8}  {answers:>8}  {rejected:>8}"
    )
}
