//! `rungc run --modbus-tcp` and similar options: what clients over TCP read and write.

use crate::args::ServeArgs;
use crate::commands::{Failure, tell};
use rungc_interp::Machine;
use rungc_models::Model;
use rungc_rt::Program;
use rungc_rt::comm::Served;
use rungc_sim::serve::{Server, Service};
use std::net::SocketAddr;

/// The servers of a run.
pub struct Servers {
    servers: Vec<Server>,
    type_code: u16,
}

impl Servers {
    /// Listens at all addresses, and reports them.
    ///
    /// # Errors
    /// An address that cannot be had.
    pub fn open(args: &ServeArgs, model: &Model) -> Result<Self, Failure> {
        let type_code = model.type_code();
        let services = [
            (
                "Modbus TCP",
                Service::modbus(model.ports, type_code),
                &args.modbus_tcp,
            ),
            ("MC protocol", Service::Mc, &args.mc),
            (
                "programming port",
                Service::programming_port(model.ports),
                &args.fx,
            ),
        ];
        let mut servers = Vec::new();
        for (name, service, addresses) in services {
            for &address in addresses {
                servers.push(open(name, service, address)?);
            }
        }
        Ok(Servers { servers, type_code })
    }

    /// Carries out and answers what clients have asked since the last scan.
    pub fn poll(&mut self, machine: &mut Machine) {
        if self.servers.is_empty() {
            return;
        }
        let mut map = Served::new(machine, self.type_code);
        for server in &mut self.servers {
            server.poll(&mut map);
        }
        if let Some(running) = map.take_request() {
            machine.set_running(running);
        }
    }
}

fn open(name: &str, service: Service, address: SocketAddr) -> Result<Server, Failure> {
    let server = Server::bind(address, service)
        .and_then(|server| Ok((server.address()?, server)))
        .map_err(|error| Failure::Because(format!("cannot serve {name} at {address}: {error}")));
    let (address, server) = server?;
    tell(&format!("rungc: {name} at {address}"));
    if !address.ip().is_loopback() {
        tell(
            "rungc: whoever reaches this address reads and writes every device: there is no password",
        );
    }
    Ok(server)
}
