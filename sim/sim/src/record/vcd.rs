//! Value change dumps (IEEE 1364-2005 §18), as GTKWave and other viewers of waveforms read them.

use super::Reading;
use crate::target::Target;
use rungc_syntax::DeviceClass;
use std::io::{self, Write};
use vcd::{IdCode, SimulationCommand, TimescaleUnit, Value, VarType, Writer};

/// A signal of a recording.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Signal {
    /// The group that viewers show it in: `inputs`, `timers`, …
    pub scope: &'static str,
    /// Its name there: a device's name without dots, which viewers take for the borders of scopes.
    pub name: String,
}

impl Signal {
    /// The signal of a device. A timer's or counter's current value has the name of the device.
    pub fn of(target: Target) -> Signal {
        let (class, number, _) = target.devices(0);
        let scope = match class {
            DeviceClass::X => "inputs",
            DeviceClass::Y => "outputs",
            DeviceClass::M | DeviceClass::S => "relays",
            DeviceClass::T => "timers",
            DeviceClass::C => "counters",
            _ => "registers",
        };
        let name = match target {
            Target::Current(..) => class.number(number).to_string(),
            target => target.to_string().replace(['.', ':'], "_"),
        };
        let scope = match target {
            Target::Channel(_) => "channels",
            _ => scope,
        };
        Signal { scope, name }
    }

    /// The value of a process of the machine around the PLC.
    pub fn of_process(name: &str) -> Signal {
        Signal {
            scope: "machine",
            name: format!("{name}_value"),
        }
    }

    /// The position of an axis of the machine around the PLC.
    pub fn of_axis(name: &str) -> Signal {
        Signal {
            scope: "machine",
            name: format!("{name}_position"),
        }
    }
}

/// A recording that is being written. Times are in microseconds, and do not go back.
pub struct Vcd<W: Write> {
    writer: Writer<W>,
    codes: Vec<IdCode>,
    last: Vec<Reading>,
    /// The last time written; `None` before the values of time 0 are.
    now_us: Option<u64>,
}

impl<W: Write> Vcd<W> {
    /// Begins a recording of a program's signals, each with what it holds at time 0 unless a change at that time is
    /// still to come.
    pub fn begin(out: W, program: &str, signals: Vec<(Signal, Reading)>) -> io::Result<Self> {
        let mut writer = Writer::new(out);
        writer.version(concat!("rungc ", env!("CARGO_PKG_VERSION")))?;
        writer.timescale(1, TimescaleUnit::US)?;
        writer.add_module(&identifier(program))?;
        let mut codes = Vec::new();
        for group in signals.chunk_by(|(a, _), (b, _)| a.scope == b.scope) {
            for (i, (signal, reading)) in group.iter().enumerate() {
                if i == 0 {
                    writer.add_module(signal.scope)?;
                }
                let (kind, width) = variable(reading);
                codes.push(writer.add_var(kind, width, &identifier(&signal.name), None)?);
            }
            writer.upscope()?;
        }
        writer.upscope()?;
        writer.enddefinitions()?;
        Ok(Vcd {
            writer,
            codes,
            last: signals.into_iter().map(|(_, reading)| reading).collect(),
            now_us: None,
        })
    }

    /// Signal number `i` holds this now.
    pub fn change(&mut self, at_us: u64, i: usize, reading: Reading) -> io::Result<()> {
        if same(&self.last[i], &reading) {
            return Ok(());
        }
        if at_us > 0 {
            self.go_to(at_us)?;
        }
        self.last[i] = reading;
        if self.now_us.is_some() {
            self.put(i)?;
        }
        Ok(())
    }

    /// Ends the recording at this time.
    pub fn end(mut self, at_us: u64) -> io::Result<()> {
        self.go_to(at_us)?;
        self.writer.flush()
    }

    fn go_to(&mut self, at_us: u64) -> io::Result<()> {
        let now_us = match self.now_us {
            Some(now_us) => now_us,
            None => self.dump()?,
        };
        if at_us > now_us {
            self.writer.timestamp(at_us)?;
            self.now_us = Some(at_us);
        }
        Ok(())
    }

    /// Writes what all signals hold at time 0.
    fn dump(&mut self) -> io::Result<u64> {
        self.now_us = Some(0);
        self.writer.timestamp(0)?;
        self.writer.begin(SimulationCommand::Dumpvars)?;
        for i in 0..self.last.len() {
            self.put(i)?;
        }
        self.writer.end()?;
        Ok(0)
    }

    fn put(&mut self, i: usize) -> io::Result<()> {
        let code = self.codes[i];
        match &self.last[i] {
            Reading::Bit(on) => self.writer.change_scalar(code, *on),
            Reading::Integer(value, width) => {
                let bits = (0..*width)
                    .rev()
                    .map(|bit| Value::from(value >> bit & 1 == 1));
                self.writer.change_vector(code, bits)
            }
            Reading::Float(value) => self.writer.change_real(code, *value),
            Reading::Text(text) => self.writer.change_string(code, &escaped(text)),
        }
    }
}

/// Returns true if both are written alike; a float that is not a number equals itself.
fn same(a: &Reading, b: &Reading) -> bool {
    match (a, b) {
        (Reading::Float(a), Reading::Float(b)) => a.to_bits() == b.to_bits(),
        (a, b) => a == b,
    }
}

/// Declaration of a signal with such values.
fn variable(reading: &Reading) -> (VarType, u32) {
    match reading {
        Reading::Bit(_) => (VarType::Wire, 1),
        Reading::Integer(_, width) => (VarType::Wire, *width),
        Reading::Float(_) => (VarType::Real, 64),
        // As GTKWave has it: IEEE 1364 knows no texts.
        Reading::Text(_) => (VarType::String, 1),
    }
}

/// A name without characters that end it or that viewers take for something else.
fn identifier(name: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    match name.chars().map(plain).collect::<String>() {
        empty if empty.is_empty() => "program".to_string(),
        name => name,
    }
}

/// A text without blanks, which would end it.
fn escaped(text: &str) -> String {
    text.bytes().map(escape).collect()
}

fn escape(byte: u8) -> String {
    match byte {
        b'\\' => r"\\".to_string(),
        b'!'..=b'~' => char::from(byte).to_string(),
        _ => format!("\\x{byte:02x}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_recording() {
        let target = |name| Target::parse(name).unwrap();
        let signals = vec![
            (Signal::of(target("X010")), Reading::Bit(false)),
            (Signal::of(target("Y000")), Reading::Bit(true)),
            (Signal::of(target("D0")), Reading::Integer(-2, 16)),
            (Signal::of(target("D2.f32")), Reading::Float(0.5)),
            (
                Signal::of(target("D4.str")),
                Reading::Text("a b".to_string()),
            ),
        ];
        let mut out = Vec::new();
        let mut vcd = Vcd::begin(&mut out, "my program", signals).unwrap();
        vcd.change(0, 1, Reading::Bit(true)).unwrap();
        vcd.change(125, 0, Reading::Bit(true)).unwrap();
        vcd.change(125, 2, Reading::Integer(5, 16)).unwrap();
        vcd.change(2000, 3, Reading::Float(-1.25)).unwrap();
        vcd.end(3000).unwrap();
        let mut parser = vcd::Parser::new(&out[..]);
        let header = parser.parse_header().unwrap();
        assert!(header.find_var(&["my_program", "inputs", "X010"]).is_some());
        assert!(parser.all(|command| command.is_ok()));
        insta::assert_snapshot!(String::from_utf8(out).unwrap());
    }
}
