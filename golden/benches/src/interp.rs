//! Speed of the interpreter, which `rungc run` and `rungc test` use.

use crate::clock::Clock;
use crate::host::{self, Effort};
use crate::ladder::{Kind, Ladder};
use crate::problem::Result;
use crate::subject::{self, INPUT_STRIDE};
use crate::table::{Cell, Table};
use rungc_interp::{Machine, rt_class};
use rungc_rt::{NoHal, Plc, Program};
use rungc_syntax::DeviceClass;
use std::time::Duration;

/// A machine whose inputs change as those of all other implementations do (`templates/subject.h`).
struct Run<'m> {
    machine: Machine<'m>,
    inputs: Vec<(DeviceClass, u32)>,
    next: usize,
    now_ms: u32,
}

impl<'m> Run<'m> {
    fn new(module: &'m rungc_ir::Module) -> Self {
        Run {
            machine: Machine::new(module),
            inputs: subject::inputs().collect(),
            next: 0,
            now_ms: 0,
        }
    }

    fn scan(&mut self) {
        let (class, number) = self.inputs[self.next];
        if let Some(class) = rt_class(class) {
            let on = self.machine.bit(class, number).unwrap_or(false);
            let _ = self.machine.set_bit(class, number, !on);
        }
        self.next = (self.next + INPUT_STRIDE) % self.inputs.len();
        self.now_ms = self.now_ms.wrapping_add(10);
        self.machine.scan(&mut NoHal, self.now_ms, 0);
    }

    /// The state of a device, as parts that checksums are made of.
    fn parts(&self, (class, number): (DeviceClass, u32)) -> [Option<u32>; 2] {
        let Some(class_at) = rt_class(class) else {
            return [None, None];
        };
        let bit = || self.machine.bit(class_at, number).map(u32::from);
        let word = || {
            self.machine
                .word(class_at, number)
                .map(|w| u32::from(w as u16))
        };
        match class {
            DeviceClass::C => [bit(), word()],
            DeviceClass::D => [word(), None],
            _ => [bit(), None],
        }
    }
}

/// The checksum over this many scans that all other implementations have.
pub fn checksum(ladder: &Ladder, scans: u32) -> Result<u32> {
    let module = subject::module(ladder, "interpreted")?;
    let mut run = Run::new(&module);
    let devices = ladder.devices();
    let mut sum = 2_166_136_261u32;
    for _ in 0..scans {
        run.scan();
        let values = devices
            .iter()
            .flat_map(|&device| run.parts(device))
            .flatten();
        sum = values.fold(sum, |sum, value| (sum ^ value).wrapping_mul(16_777_619));
    }
    Ok(sum)
}

/// Steps a second, in each of some rounds.
fn steps_per_second(ladder: &Ladder, effort: Effort) -> Result<Vec<f64>> {
    let module = subject::module(ladder, "interpreted")?;
    let mut run = Run::new(&module);
    let turn = Duration::from_micros(effort.turn_us.into());
    let round = |_| {
        let (clock, mut scans) = (Clock::start(), 0u32);
        while clock.taken() < turn {
            run.scan();
            scans += 1;
        }
        f64::from(scans) * f64::from(ladder.steps) / clock.taken().as_secs_f64()
    };
    Ok((0..effort.rounds).map(round).collect())
}

/// The table.
pub fn table(steps: u32, effort: Effort) -> Result<Table> {
    let mut table = Table::new(
        "The interpreter",
        &["program", "steps", "million steps/s", "fastest"],
    );
    for kind in Kind::ALL {
        let ladder = Ladder::new(kind, steps);
        let rates = steps_per_second(&ladder, effort)?;
        let fastest = rates.iter().copied().fold(0.0, f64::max);
        let median = host::median(rates).unwrap_or_default();
        table.row([
            kind.name().into(),
            Cell::count(ladder.steps.into()),
            Cell::number(median / 1e6, 1),
            Cell::number(fastest / 1e6, 1),
        ]);
    }
    Ok(table)
}
