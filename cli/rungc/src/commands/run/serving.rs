//! `rungc run --modbus-tcp` and similar options: what clients over TCP read and write.

use super::watch::{Watch, Way};
use crate::args::ServeArgs;
use crate::commands::{Failure, eprint_line};
use rungc_host::servers::{Clients, Limits, Server, ServerEvent, cannot_serve, full, switched};
use rungc_interp::Machine;
use rungc_ir::Module;
use rungc_models::Model;
use rungc_models::runs::rt_class;
use rungc_project::serve::FxEnd;
use rungc_rt::Program;
use rungc_rt::comm::Served;
use rungc_rt::comm::modbus::client::ClientRow;
use rungc_rt::comm::service::{ServerProtocol, Service};
use rungc_sim::serve::{Direction, LinkProtocol, Place, Seen};
use rungc_syntax::NetworkRequest;
use std::net::SocketAddr;

/// The servers of a run.
pub struct Servers {
    servers: Vec<Open>,
    limits: Limits,
    type_code: u16,
}

/// Requests of a run to servers over TCP.
pub struct NetworkRequests(Clients);

impl NetworkRequests {
    /// The table of a program; nothing is asked unless the run keeps step with the clock.
    pub fn new(module: &Module, in_real_time: bool, watch: &mut Watch) -> Self {
        let requests = module.requests.iter().filter(|_| in_real_time);
        let clients = Clients::new(module.model.ports, requests.filter_map(row));
        for server in clients.servers() {
            watch.open(&place(server), LinkProtocol::Client);
        }
        NetworkRequests(clients)
    }

    /// Takes the answers that have come since the last scan, and asks what is next; `at_us` as for [`Servers::poll`].
    pub fn poll(&mut self, machine: &mut Machine, watch: &mut Watch, at_us: u64) {
        self.0.poll(machine, |frame| {
            // Seen from the connection, this end is the one that frames go out of.
            let way = Way::Tcp {
                client: frame.server,
                server: frame.client,
            };
            let seen = Seen {
                place: &place(frame.server),
                link: LinkProtocol::Client,
                direction: match frame.request {
                    true => Direction::Out,
                    false => Direction::In,
                },
                bytes: frame.bytes,
            };
            watch.frame(at_us, way, seen);
        });
    }
}

/// The row of a server that is asked in the table of connections.
fn place(server: SocketAddr) -> Place {
    Place {
        port: "Modbus client".to_string(),
        peer: server.to_string(),
    }
}

/// A request as the runtime knows it.
fn row(request: &NetworkRequest) -> Option<(SocketAddr, ClientRow)> {
    let row = ClientRow {
        trigger: rt_class(request.trigger.class)?,
        number: request.trigger.number,
        unit: request.unit,
        function: request.function,
        address: request.address,
        count: request.count,
        buffer: request.buffer,
    };
    Some((request.server, row))
}

/// A server, and where it listens.
struct Open {
    server: Server,
    address: SocketAddr,
}

impl Servers {
    /// Listens at all addresses, and reports them.
    ///
    /// # Errors
    /// An address that cannot be had.
    pub fn open(args: &ServeArgs, model: &Model, watch: &mut Watch) -> Result<Self, Failure> {
        let type_code = model.type_code();
        let of_fx = args.fx.iter().filter_map(|end| match end {
            FxEnd::Address(address) => Some(*address),
            FxEnd::Line(_) => None,
        });
        let of_fx: Vec<_> = of_fx.collect();
        let addresses = |protocol| match protocol {
            ServerProtocol::ModbusTcp => &args.modbus_tcp,
            ServerProtocol::Mc => &args.mc,
            ServerProtocol::ProgrammingPort => &of_fx,
        };
        let limits = args.clients.map_or_else(Limits::default, |clients| Limits {
            clients: clients.into(),
            ..Limits::default()
        });
        let mut servers = Vec::new();
        for protocol in ServerProtocol::all() {
            let service = Service::new(protocol, model.ports, type_code);
            for &address in addresses(protocol) {
                let place = args.settings.place(protocol.option());
                let open = open(service, address, limits, &place)?;
                watch.open(&open.place(None), LinkProtocol::Tcp(protocol));
                servers.push(open);
            }
        }
        Ok(Servers {
            servers,
            limits,
            type_code,
        })
    }

    /// Carries out and answers the requests of clients since the last scan; `at_us` is the time since the run began, in
    /// microseconds. Whether there was anything.
    pub fn poll(&mut self, machine: &mut Machine, watch: &mut Watch, at_us: u64) -> bool {
        if self.servers.is_empty() {
            return false;
        }
        let mut any = false;
        let mut map = Served::new(machine, self.type_code);
        for open in &mut self.servers {
            for (client, event) in open.server.poll(&mut map) {
                let server = open.address;
                let ServerEvent::Exchange(exchange) = event else {
                    eprint_line(&format!("rungc: {}", full(server, client, self.limits)));
                    continue;
                };
                any = true;
                if let Some(running) = exchange.running {
                    let message = switched(running, client, open.server.service());
                    eprint_line(&format!("rungc: {message}"));
                }
                let frames = [
                    (Direction::In, &exchange.request),
                    (Direction::Out, &exchange.reply),
                ];
                let place = open.place(Some(client));
                for (direction, bytes) in frames.into_iter().filter(|frame| !frame.1.is_empty()) {
                    let seen = Seen {
                        place: &place,
                        link: LinkProtocol::Tcp(open.server.service().protocol),
                        direction,
                        bytes,
                    };
                    watch.frame(at_us, Way::Tcp { client, server }, seen);
                }
            }
        }
        if let Some(running) = map.take_request() {
            machine.set_running(running);
        }
        any
    }
}

impl Open {
    /// The row of a client in the table of connections; a client that connects again has the same one.
    fn place(&self, client: Option<SocketAddr>) -> Place {
        Place {
            port: self.address.to_string(),
            peer: client.map_or_else(String::new, |client| client.ip().to_string()),
        }
    }
}

/// Opens a server, which `place` names in messages.
fn open(
    service: Service,
    address: SocketAddr,
    limits: Limits,
    place: &str,
) -> Result<Open, Failure> {
    let name = service.protocol.name();
    let server = Server::bind(address, service, limits)
        .and_then(|server| Ok((server.address()?, server)))
        .map_err(|error| {
            let why = cannot_serve(service.protocol, address, &error);
            Failure::Because(format!("{place}: {why}"))
        });
    let (address, server) = server?;
    eprint_line(&format!("rungc: {name} at {address}"));
    if !address.ip().is_loopback() {
        eprint_line(
            "rungc: whoever reaches this address reads and writes every device: there is no password",
        );
    }
    Ok(Open { server, address })
}
