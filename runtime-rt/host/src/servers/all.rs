//! The servers of a program.

use super::{Limits, Server, ServerEvent};
use rungc_rt::Plc;
use rungc_rt::comm::Served;
use rungc_rt::comm::mode::is_answering;
use rungc_rt::comm::service::{ServerProtocol, Service, TABLE_HEADING};
use std::collections::BTreeMap;
use std::io;
use std::net::{IpAddr, SocketAddr};

/// The servers of a program, and what has gone over their connections.
#[derive(Debug, Default)]
pub struct Servers {
    limits: Limits,
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
    stops: u64,
}

/// How partners switch a PLC.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Switch {
    /// RUN or STOP, if one has requested it: the host carries it out.
    pub requested: Option<bool>,
    /// RUN or STOP, if one switches the PLC to it, by a request or by special relays: this has been reported.
    pub reported: Option<bool>,
}

impl Servers {
    /// None.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets the maximum number of connections of each server opened from now on.
    pub fn set_clients(&mut self, clients: usize) {
        self.limits.clients = clients;
    }

    /// Opens one more; returns where it listens: port 0 has become a free one.
    ///
    /// # Errors
    /// What the system says: the address is taken, or not to be had.
    pub fn open(&mut self, service: Service, address: SocketAddr) -> io::Result<SocketAddr> {
        let server = Server::bind(address, service, self.limits)?;
        let address = server.address()?;
        self.servers.push(Open { server, address });
        Ok(address)
    }

    /// Carries out and answers the requests of clients since the last call; returns how they switch the PLC. Reports
    /// who stops or starts it, and that a connection is rejected.
    pub fn poll(&mut self, plc: &mut dyn Plc, mut report: impl FnMut(&str)) -> Switch {
        let mut switch = Switch::default();
        let Some(first) = self.servers.first() else {
            return switch;
        };
        // All servers are those of one PLC.
        let mut map = Served::new(plc, first.server.service().type_code);
        for (n, Open { server, address }) in self.servers.iter_mut().enumerate() {
            for (client, event) in server.poll(&mut map) {
                let ServerEvent::Exchange(exchange) = event else {
                    report(&full(*address, client, self.limits));
                    continue;
                };
                let counts = self.clients.entry((n, client.ip())).or_default();
                counts.requests += 1;
                counts.answers += u64::from(!exchange.reply.is_empty());
                counts.rejected += u64::from(exchange.rejected);
                if let Some(running) = exchange.running {
                    counts.stops += u64::from(!running);
                    switch.reported = Some(running);
                    report(&switched(running, client, server.service()));
                }
            }
        }
        switch.requested = map.take_request();
        switch
    }

    /// A table of what has gone over the connections, a line for each row; empty if there is no server.
    pub fn table(&self) -> Vec<String> {
        let mut rows = Vec::new();
        for (n, Open { server, address }) in self.servers.iter().enumerate() {
            let protocol = server.service().protocol.name();
            let mut row = |client: &str, counts: &Counts| {
                let counts = [
                    counts.requests,
                    counts.answers,
                    counts.rejected,
                    counts.stops,
                ];
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

/// Message that an address cannot be served: the reason and the next step.
pub fn cannot_serve(protocol: ServerProtocol, address: SocketAddr, error: &io::Error) -> String {
    let (name, next) = (protocol.name(), after(error));
    format!("cannot serve {name} at {address}: {error}{next}")
}

/// The next step after an error of an address, to follow it.
pub fn after(error: &io::Error) -> &'static str {
    match error.kind() {
        io::ErrorKind::AddrInUse => "; the port is in use: choose another, or 0 for a free one",
        io::ErrorKind::AddrNotAvailable => "; this machine has no such address",
        io::ErrorKind::PermissionDenied => "; choose a port from 1024",
        _ => "",
    }
}

/// Message that a server rejects a client.
pub fn full(server: SocketAddr, client: SocketAddr, limits: Limits) -> String {
    format!(
        "{server} rejects {}: all {} connections are in use (--clients allows more)",
        client.ip(),
        limits.clients
    )
}

/// Message that a client switches the PLC to RUN or STOP.
pub fn switched(running: bool, client: SocketAddr, service: Service) -> String {
    let state = if running { "RUN" } else { "STOP" };
    format!(
        "{} switches to {state} ({})",
        client.ip(),
        service.protocol.name()
    )
}

/// Message that a partner on one of these serial ports switches the PLC to RUN or STOP: on one that is being answered,
/// if that is known.
pub fn switched_by_line(running: bool, plc: &mut dyn Plc, ports: &[u8]) -> String {
    let name = |port: &u8| format!("COM{port}");
    let mut partners: Vec<_> = ports.to_vec();
    partners.retain(|&port| is_answering(plc, port));
    if partners.is_empty() {
        partners = ports.to_vec();
    }
    let partners: Vec<_> = partners.iter().map(name).collect();
    let state = if running { "RUN" } else { "STOP" };
    format!("{} switches to {state}", partners.join(" or "))
}

/// A row of the table: a server, its client, the protocol, and how many requests, answers, rejections and stops.
pub(super) fn row(server: &str, client: &str, protocol: &str, counts: [u64; 4]) -> String {
    let [requests, answers, rejected, stops] = counts;
    format!(
        "{server:<21}  {client:<15}  {protocol:<16}  {requests:>8}  {answers:>8}  {rejected:>8}  {stops:>8}"
    )
}
