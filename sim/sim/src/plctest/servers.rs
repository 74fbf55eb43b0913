//! The servers of a case over TCP: what clients send on their connections and what comes back.

use super::runner::Running;
use super::serial::{Item, PortId, Protocol, Sent};
use super::{Failure, Port, Step, Value};
use crate::engines::{Engine, EngineError};
use crate::protocol::{Answer, Request};
use rungc_host::servers::Dialogue;
use rungc_ir::Module;
use rungc_rt::Class;
use rungc_rt::comm::Map;
use rungc_rt::comm::service::{ServerProtocol, Service};
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;

/// The servers of a case, and the connections to them.
#[derive(Default)]
pub(super) struct Servers {
    /// Service of each TCP port.
    services: BTreeMap<u16, Service>,
    /// By port and name.
    connections: BTreeMap<(u16, String), Connection>,
    type_code: u16,
}

/// A connection of a client.
struct Connection {
    /// `None` after the client has closed it.
    dialogue: Option<Dialogue>,
    /// Data in transit: its time of arrival and content; empty if the client closes the connection.
    pending: Vec<(u32, Vec<u8>)>,
    /// Answers in this step.
    sent: Sent,
}

impl Servers {
    /// The servers of a case whose PLC runs this program.
    pub(super) fn new(serve: &[(u16, Protocol)], module: &Module) -> Self {
        let (family, type_code) = (module.model.ports, module.model.type_code());
        let of_server = |protocol: Protocol| match protocol {
            Protocol::Modbus => ServerProtocol::ModbusTcp,
            Protocol::Mc => ServerProtocol::Mc,
            Protocol::Fx => ServerProtocol::ProgrammingPort,
        };
        let services = serve.iter();
        Servers {
            services: services
                .map(|&(port, protocol)| {
                    (port, Service::new(of_server(protocol), family, type_code))
                })
                .collect(),
            connections: BTreeMap::new(),
            type_code,
        }
    }

    /// The connection of a name, opened if it is new; `None` if the port is not served.
    fn connection(&mut self, port: u16, name: &str) -> Option<&mut Connection> {
        let service = *self.services.get(&port)?;
        let connection = self.connections.entry((port, name.to_string()));
        Some(connection.or_insert_with(|| Connection {
            dialogue: Some(Dialogue::new(service)),
            pending: Vec::new(),
            sent: Sent::default(),
        }))
    }
}

impl Running<'_> {
    /// A step begins: clients send. What is between two pauses arrives together.
    pub(super) fn begin_servers(&mut self, step: &Step) -> Result<(), Failure> {
        let now_us = self.now_us();
        for connection in self.servers.connections.values_mut() {
            connection.sent = Sent::default();
        }
        for (port, items) in &step.rx {
            let PortId::Tcp(number, name) = &port.id else {
                continue;
            };
            let Some(connection) = self.servers.connection(*number, name) else {
                let message = format!("the case serves no {}", port.id);
                return Err(self.failed(&EngineError::Unserved(message)));
            };
            let mut at_us = now_us;
            let mut bytes = Vec::new();
            for item in items {
                match *item {
                    Item::Byte(byte, _) => bytes.push(byte),
                    Item::Pause(us) => {
                        if !bytes.is_empty() {
                            let bytes = std::mem::take(&mut bytes);
                            connection.pending.push((at_us, bytes));
                        }
                        at_us = at_us.wrapping_add(us as u32);
                    }
                    Item::Close => {}
                }
            }
            if !bytes.is_empty() {
                connection.pending.push((at_us, bytes));
            }
            if items.last() == Some(&Item::Close) {
                connection.pending.push((at_us, Vec::new()));
            }
        }
        Ok(())
    }

    /// Answers what has come by now, between two scans.
    pub(super) fn serve(&mut self) -> Result<(), Failure> {
        let now_us = self.now_us();
        let running = self.is_running(0);
        let mut mode = None;
        for connection in self.servers.connections.values_mut() {
            let due = |at_us: u32| now_us.wrapping_sub(at_us) as i32 >= 0;
            while let Some((_, bytes)) = connection.pending.pop_if_first(|&(at_us, _)| due(at_us)) {
                let Some(dialogue) = connection.dialogue.as_mut().filter(|_| !bytes.is_empty())
                else {
                    connection.dialogue = None;
                    continue;
                };
                let mut map = Devices {
                    engine: RefCell::new(&mut *self.engine),
                    failed: RefCell::new(None),
                    running: Cell::new(running),
                    mode: None,
                    type_code: self.servers.type_code,
                };
                let reaction = dialogue.receive(&bytes, &mut map);
                mode = map.mode.or(mode);
                if let Some(error) = map.failed.into_inner() {
                    return Err(Failure::Engine {
                        step: self.step,
                        message: error.to_string(),
                    });
                }
                connection.sent.bytes.extend(reaction.reply);
                if reaction.closes {
                    connection.sent.closed = true;
                    connection.dialogue = None;
                }
            }
        }
        match mode {
            Some(running) => self.switch(0, running),
            None => Ok(()),
        }
    }

    /// Outputs to connections that differ from the expectation.
    pub(super) fn end_servers(&self, step: &Step) -> Vec<(String, Value, Value)> {
        let nothing = Sent::default();
        let expected = step.expect_tx.iter();
        let wrong = expected.filter_map(|(port, texts)| {
            let PortId::Tcp(number, name) = &port.id else {
                return None;
            };
            let connection = self.servers.connections.get(&(*number, name.clone()));
            let sent = connection.map_or(&nothing, |connection| &connection.sent);
            (!texts.contains(sent)).then(|| self.unlike(port, texts, sent))
        });
        wrong.collect()
    }

    /// Output of a port that differs from the expectation.
    pub(super) fn unlike(
        &self,
        port: &Port,
        expected: &[Sent],
        sent: &Sent,
    ) -> (String, Value, Value) {
        let expected = expected.iter().map(|sent| port.id.shown(sent));
        let expected: Vec<_> = expected.collect();
        let name = format!("what {} sent", self.port_name(port));
        (
            name,
            Value::Text(expected.join(" | ")),
            Value::Text(port.id.shown(sent)),
        )
    }
}

/// Takes the first element if it is as asked.
trait PopIfFirst<T> {
    fn pop_if_first(&mut self, is: impl Fn(&T) -> bool) -> Option<T>;
}

impl<T> PopIfFirst<T> for Vec<T> {
    fn pop_if_first(&mut self, is: impl Fn(&T) -> bool) -> Option<T> {
        self.first().is_some_and(is).then(|| self.remove(0))
    }
}

/// The devices of an engine as a server sees them.
struct Devices<'e> {
    engine: RefCell<&'e mut dyn Engine>,
    /// Error of the engine.
    failed: RefCell<Option<EngineError>>,
    running: Cell<bool>,
    mode: Option<bool>,
    type_code: u16,
}

impl Devices<'_> {
    fn execute(&self, request: Request) -> Option<i64> {
        match self.engine.borrow_mut().execute(request) {
            Ok(Answer::Value(value)) => Some(value),
            Ok(Answer::Ok | Answer::Missing) => None,
            Err(error) => {
                *self.failed.borrow_mut() = Some(error);
                None
            }
        }
    }
}

impl Map for Devices<'_> {
    fn bit(&self, class: Class, number: u32) -> Option<bool> {
        self.execute(Request::Bit(class, number))
            .map(|bit| bit != 0)
    }

    fn set_bit(&mut self, class: Class, number: u32, value: bool) -> Option<()> {
        self.bit(class, number)?;
        self.execute(Request::SetBit(class, number, value));
        Some(())
    }

    fn word(&self, class: Class, number: u32) -> Option<i16> {
        self.execute(Request::Word(class, number))
            .map(|word| word as i16)
    }

    fn set_word(&mut self, class: Class, number: u32, value: i16) -> Option<()> {
        self.word(class, number)?;
        self.execute(Request::SetWord(class, number, value));
        Some(())
    }

    fn counter32(&self, number: u32) -> Option<i32> {
        self.execute(Request::Double(Class::C, number))
            .map(|value| value as i32)
    }

    fn set_counter32(&mut self, number: u32, value: i32) -> Option<()> {
        self.counter32(number)?;
        self.execute(Request::SetDouble(Class::C, number, value));
        Some(())
    }

    fn reset(&mut self, class: Class, number: u32) -> Option<()> {
        self.set_bit(class, number, false)?;
        let word = self.set_word(class, number, 0);
        word.or_else(|| self.set_counter32(number, 0))
    }

    fn running(&self) -> bool {
        self.running.get()
    }

    fn request_running(&mut self, running: bool) {
        self.running.set(running);
        self.mode = Some(running);
    }

    fn type_code(&self) -> u16 {
        self.type_code
    }
}
