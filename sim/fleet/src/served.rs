//! Modbus TCP: a port for each PLC of a group, or units of a port.

use crate::engine::{At, Engine};
use rungc_host::servers::{Limits, Server, ServerEvent};
use rungc_rt::comm::Map;
use rungc_rt::comm::modbus::tcp::UNIT;
use rungc_rt::comm::service::Service;
use rungc_rt::{Class, FIRST_COUNTER32};
use std::cell::{Cell, RefCell};
use std::io;
use std::net::{IpAddr, SocketAddr};
use std::ops::Range;

/// Number of ports without a connection that are polled for new ones before each scan. With more, they take turns.
const ASKED_AT_ONCE: usize = 128;

/// The servers of a group.
pub struct Served {
    doors: Vec<Door>,
    /// Index of the port to poll next.
    next: usize,
    type_code: u16,
    /// Numbers of requests, and of those that were rejected.
    pub requests: [u64; 2],
}

/// A port, and the PLCs that it reaches.
struct Door {
    server: Server,
    plcs: Range<u32>,
}

/// The devices of the PLC that a frame is for.
struct Reached<'a> {
    engine: RefCell<&'a mut dyn Engine>,
    plc: Cell<u32>,
    /// Those of the port.
    plcs: Range<u32>,
    type_code: u16,
    /// RUN or STOP was requested: of which PLC.
    request: Option<(u32, bool)>,
}

/// A client that has switched a PLC to RUN or STOP.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Switched {
    /// Number of the PLC, from 0.
    pub plc: u32,
    /// RUN.
    pub running: bool,
    /// The client.
    pub client: IpAddr,
}

impl Served {
    /// Opens the ports of `count` PLCs from an address on: a port for each, or for each `units` of them; the first PLC
    /// of a port is unit 1. Port 0 stands for free ports.
    ///
    /// # Errors
    /// The address that is not to be had, and what the system says.
    pub fn open(
        count: u32,
        first: SocketAddr,
        units: Option<u32>,
        service: Service,
    ) -> Result<Self, (SocketAddr, io::Error)> {
        let share = units.unwrap_or(1).max(1);
        let mut doors = Vec::new();
        for (n, plc) in (0..count).step_by(share as usize).enumerate() {
            let mut address = first;
            if first.port() != 0 {
                let port = usize::from(first.port()) + n;
                let port = u16::try_from(port).map_err(|_| {
                    let error = io::Error::other("there is no port above 65535");
                    (first, error)
                })?;
                address.set_port(port);
            }
            let server = Server::bind(address, service, Limits::default())
                .map_err(|error| (address, error))?;
            doors.push(Door {
                server,
                plcs: plc..count.min(plc + share),
            });
        }
        Ok(Served {
            doors,
            next: 0,
            type_code: service.type_code,
            requests: [0; 2],
        })
    }

    /// Addresses of the ports.
    pub fn addresses(&self) -> impl Iterator<Item = io::Result<SocketAddr>> {
        self.doors.iter().map(|door| door.server.address())
    }

    /// Carries out and answers the requests since the last scan. Calls `switch` for PLCs that are requested to change
    /// between RUN and STOP. Returns which PLCs clients switch so, or by special relays.
    pub fn poll(
        &mut self,
        engine: &mut dyn Engine,
        switch: &mut dyn FnMut(u32, bool),
    ) -> Vec<Switched> {
        let mut all = Vec::new();
        let (count, next) = (self.doors.len(), self.next);
        let turn = |n: usize| (n + count - next) % count < ASKED_AT_ONCE;
        self.next = (next + ASKED_AT_ONCE) % count.max(1);
        for (n, door) in self.doors.iter_mut().enumerate() {
            if !turn(n) && !door.server.is_connected() {
                continue;
            }
            let mut map = Reached {
                engine: RefCell::new(engine),
                plc: Cell::new(door.plcs.start),
                plcs: door.plcs.clone(),
                type_code: self.type_code,
                request: None,
            };
            for (client, event) in door.server.poll(&mut map) {
                if let ServerEvent::Exchange(exchange) = event {
                    self.requests[0] += 1;
                    self.requests[1] += u64::from(exchange.rejected);
                    let unit = exchange.request.get(UNIT).copied();
                    let plc = unit.and_then(|unit| of_unit(&door.plcs, unit));
                    all.extend(plc.zip(exchange.running).map(|(plc, running)| Switched {
                        plc,
                        running,
                        client: client.ip(),
                    }));
                }
            }
            if let Some((plc, running)) = map.request {
                switch(plc, running);
            }
        }
        all
    }
}

/// The PLC of a unit among those of a port. A port of one PLC is the PLC itself, whichever unit that is called.
fn of_unit(plcs: &Range<u32>, unit: u8) -> Option<u32> {
    if plcs.len() == 1 {
        return matches!(unit, 0 | 1 | 255).then_some(plcs.start);
    }
    let plc = plcs.start + u32::from(unit).checked_sub(1)?;
    plcs.contains(&plc).then_some(plc)
}

impl Reached<'_> {
    fn read(&self, at: At) -> Option<i32> {
        self.engine.borrow_mut().read(self.plc.get(), at)
    }

    fn write(&mut self, at: At, value: i32) -> Option<()> {
        // A request for devices that the program does not store is rejected as a whole.
        self.read(at)?;
        self.engine.get_mut().write(self.plc.get(), at, value)
    }

    fn is_counter32(class: Class, number: u32) -> bool {
        class == Class::C && number >= FIRST_COUNTER32
    }
}

impl Map for Reached<'_> {
    fn takes_unit(&mut self, unit: u8) -> bool {
        let plc = of_unit(&self.plcs, unit);
        plc.map(|plc| self.plc.set(plc)).is_some()
    }

    fn bit(&self, class: Class, number: u32) -> Option<bool> {
        match class {
            Class::X | Class::Y | Class::M | Class::S | Class::T | Class::C => {
                self.read(At::bit(class, number)).map(|bit| bit != 0)
            }
            _ => None,
        }
    }

    fn set_bit(&mut self, class: Class, number: u32, value: bool) -> Option<()> {
        self.bit(class, number)?;
        self.write(At::bit(class, number), value.into())
    }

    fn word(&self, class: Class, number: u32) -> Option<i16> {
        if matches!(class, Class::X | Class::Y | Class::M | Class::S)
            || Self::is_counter32(class, number)
        {
            return None;
        }
        self.read(At::word(class, number)).map(|word| word as i16)
    }

    fn set_word(&mut self, class: Class, number: u32, value: i16) -> Option<()> {
        self.word(class, number)?;
        self.write(At::word(class, number), value.into())
    }

    fn counter32(&self, number: u32) -> Option<i32> {
        let known = Self::is_counter32(Class::C, number);
        known
            .then(|| self.read(At::word(Class::C, number)))
            .flatten()
    }

    fn set_counter32(&mut self, number: u32, value: i32) -> Option<()> {
        self.counter32(number)?;
        self.write(At::word(Class::C, number), value)
    }

    fn reset(&mut self, class: Class, number: u32) -> Option<()> {
        self.write(At::word(class, number), 0)?;
        self.write(At::bit(class, number), 0)
    }

    fn running(&self) -> bool {
        self.engine.borrow_mut().is_running(self.plc.get())
    }

    fn request_running(&mut self, running: bool) {
        self.request = Some((self.plc.get(), running));
    }

    fn type_code(&self) -> u16 {
        self.type_code
    }
}
