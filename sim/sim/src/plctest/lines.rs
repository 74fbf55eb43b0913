//! The serial lines of a case: what comes to its ports and what they send, with exact times.

use super::runner::Running;
use super::serial::{Item, Port, Sent};
use super::{Failure, Step, Value};
use crate::protocol::{Answer, Request};
use rungc_rt::comm::{CAN_PORT, CharFault, LineFormat, Parity, Received};
use std::collections::BTreeMap;

/// A port as engines number them: its PLC and its number.
type SerialPort = (usize, u8);

/// The lines of a case.
#[derive(Default)]
pub(super) struct Lines {
    /// The ports on each line.
    wires: Vec<Vec<SerialPort>>,
    /// The ports that are off their lines.
    cut: Vec<SerialPort>,
    /// Data in transit to ports, in the order of its times.
    pending: Vec<(SerialPort, Received)>,
    /// Data sent by ports in this step.
    sent: BTreeMap<SerialPort, Sent>,
    /// Incomplete frames sent by CAN cards.
    part: BTreeMap<SerialPort, Vec<u8>>,
}

/// Returns true if a character has come by a time. Both are counted in 32 bits, which takes 71 minutes, and are less
/// than half of that apart.
fn is_due(character: &Received, now_us: u32) -> bool {
    now_us.wrapping_sub(character.at_us) as i32 >= 0
}

fn serial(port: &Port) -> Option<SerialPort> {
    port.id.number().map(|number| (port.plc, number))
}

impl Lines {
    /// The lines that join these ports.
    pub(super) fn new(wires: &[Vec<Port>]) -> Self {
        let wires = wires.iter();
        Lines {
            wires: wires
                .map(|line| line.iter().filter_map(serial).collect())
                .collect(),
            ..Lines::default()
        }
    }

    /// After power-on nothing is on its way.
    pub(super) fn power_cycle(&mut self) {
        self.pending.clear();
        self.part.clear();
    }

    fn on_line(&self, port: SerialPort) -> bool {
        !self.cut.contains(&port)
    }

    /// The ports that receive the output of a port: itself, or all on its line.
    fn hearers(&self, port: SerialPort) -> Vec<SerialPort> {
        let line = self.wires.iter().find(|line| line.contains(&port));
        match line {
            Some(line) if self.on_line(port) => {
                let on_line = line.iter().copied().filter(|&port| self.on_line(port));
                on_line.collect()
            }
            _ => vec![port],
        }
    }

    fn is_wired(&self, port: SerialPort) -> bool {
        self.wires.iter().any(|line| line.contains(&port))
    }

    fn push(&mut self, port: SerialPort, character: Received) {
        let at = self
            .pending
            .partition_point(|(_, other)| is_due(other, character.at_us));
        self.pending.insert(at, (port, character));
    }
}

impl Running<'_> {
    /// A step begins: bytes set out for ports, and ports leave their lines.
    pub(super) fn begin_lines(&mut self, step: &Step) -> Result<(), Failure> {
        self.lines.sent.clear();
        if let Some(cut) = &step.cut {
            self.lines.cut = cut.iter().filter_map(serial).collect();
        }
        for (port, items) in &step.rx {
            let Some(port) = serial(port) else {
                continue;
            };
            let format = self.format(port)?;
            let mut at_ns = u64::from(self.now_us()) * 1000;
            for item in items {
                let (byte, fault) = match *item {
                    Item::Pause(us) => {
                        at_ns += us * 1000;
                        continue;
                    }
                    Item::Byte(byte, fault) => (byte, fault),
                    Item::Close => continue,
                };
                at_ns += format.nanoseconds(2);
                let character = Received {
                    at_us: (at_ns / 1000) as u32,
                    byte,
                    fault,
                };
                for hearer in self.lines.hearers(port) {
                    self.lines.push(hearer, character);
                }
            }
        }
        Ok(())
    }

    /// Hands to ports what has reached them.
    pub(super) fn deliver(&mut self) -> Result<(), Failure> {
        let now_us = self.now_us();
        let due = self.lines.pending.iter();
        let due = due.take_while(|(_, character)| is_due(character, now_us));
        let due = due.count();
        let due: Vec<_> = self.lines.pending.drain(..due).collect();
        for ((plc, port), character) in due {
            self.select(plc)?;
            self.execute(Request::Receive(port, character))?;
        }
        Ok(())
    }

    /// Takes what ports on lines have sent to the others there.
    pub(super) fn carry(&mut self) -> Result<(), Failure> {
        let ports: Vec<_> = self.lines.wires.iter().flatten().copied().collect();
        ports.into_iter().try_for_each(|port| self.listen(port))
    }

    /// Takes what a port has sent.
    fn listen(&mut self, port: SerialPort) -> Result<(), Failure> {
        let (plc, number) = port;
        self.select(plc)?;
        while let Answer::Value(sent) = self.execute(Request::Sent(number, self.now_us()))? {
            let character = Received {
                at_us: (sent >> 8) as u32,
                byte: sent as u8,
                fault: CharFault::None,
            };
            let sent = self.lines.sent.entry(port).or_default();
            sent.bytes.push(character.byte);
            if !self.lines.is_wired(port) {
                continue;
            }
            if number == CAN_PORT {
                self.carry_can(port, character);
                continue;
            }
            let format = self.format(port)?;
            for hearer in self.lines.hearers(port) {
                if hearer == port {
                    continue;
                }
                let understood = self.format(hearer)? == format;
                let fault = if understood {
                    CharFault::None
                } else {
                    CharFault::Framing
                };
                self.lines.push(hearer, Received { fault, ..character });
            }
            self.select(plc)?;
        }
        Ok(())
    }

    /// Frames of CAN come to the others whole, since one at a time is on the bus.
    fn carry_can(&mut self, port: SerialPort, character: Received) {
        let part = self.lines.part.entry(port).or_default();
        part.push(character.byte);
        if character.byte != b'\r' {
            return;
        }
        let frame = std::mem::take(part);
        for hearer in self.lines.hearers(port) {
            for &byte in frame.iter().filter(|_| hearer != port) {
                self.lines.push(hearer, Received { byte, ..character });
            }
        }
    }

    /// The format of characters on the line of a port.
    fn format(&mut self, (plc, number): SerialPort) -> Result<LineFormat, Failure> {
        self.select(plc)?;
        let packed = match self.execute(Request::Line(number))? {
            Answer::Value(packed) => packed,
            Answer::Ok | Answer::Missing => 0,
        };
        Ok(LineFormat {
            bits_per_second: (packed >> 16) as u32,
            data_bits: (packed >> 8) as u8 & 15,
            parity: match packed >> 4 & 15 {
                1 => Parity::Odd,
                2 => Parity::Even,
                _ => Parity::None,
            },
            stop_bits: packed as u8 & 15,
            half_duplex: false,
        })
    }

    /// A step ends: all ports are listened to. Returns what ports sent that was to be otherwise.
    pub(super) fn end_lines(
        &mut self,
        step: &Step,
    ) -> Result<Vec<(String, Value, Value)>, Failure> {
        let plcs = self.plcs.iter().enumerate();
        let ports = plcs.flat_map(|(plc, info)| info.ports.iter().map(move |&n| (plc, n)));
        let ports: Vec<_> = ports.collect();
        ports.into_iter().try_for_each(|port| self.listen(port))?;
        let nothing = Sent::default();
        let mut wrong = Vec::new();
        for (port, texts) in &step.expect_tx {
            let Some(number) = serial(port) else {
                continue;
            };
            let sent = self.lines.sent.get(&number).unwrap_or(&nothing);
            if !texts.contains(sent) {
                wrong.push(self.unlike(port, texts, sent));
            }
        }
        Ok(wrong)
    }
}
