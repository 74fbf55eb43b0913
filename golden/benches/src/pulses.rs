//! Speed of simulated pulse outputs.

use crate::clock::Clock;
use crate::problem::{Problem, Result};
use crate::table::{Cell, Table};
use rungc_interp::Machine;
use rungc_ir::Module;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;
use rungc_rt::{Class, Hal, NoHal, Plc, Program};

/// Four outputs at 100 kHz: steady, with ramps, modulated, to a position.
const PROGRAM: &str = "\
LD X0
DPLSY K100000 K0 Y0
LD X0
DPLSR K100000 K100000000 K200 Y1
LD X0
DPLSV K-100000 Y2 Y5
LD X0
DDRVI K100000000 K100000 Y3 Y6
END
";

/// Time from scan to scan.
const SCAN_MS: u32 = 10;

/// Hardware that counts what its pins do.
struct Pins(u64);

impl Hal for Pins {
    fn set_output(&mut self, _: u16, value: bool) {
        self.0 += u64::from(value);
    }
}

/// The program, compiled.
pub(crate) fn module() -> Result<Module> {
    let read = rungc_frontend::read_text("pulses.il", PROGRAM);
    let options = CompileOptions {
        model: Some(ModelId::L01s),
        ..CompileOptions::default()
    };
    let module = compile(&read.program, &options).module;
    module.ok_or_else(|| Problem::Wrong("the program does not compile".to_string()))
}

/// One row: how long this many seconds of machine time take.
fn measure(what: &str, seconds: u32, mut scan: impl FnMut(&mut Machine, u32)) -> Result<Vec<Cell>> {
    let module = module()?;
    let mut machine = Machine::new(&module);
    let _ = machine.set_bit(Class::X, 0, true);
    let clock = Clock::start();
    for now_ms in (0..1000 * seconds).step_by(SCAN_MS as usize) {
        scan(&mut machine, now_ms);
    }
    let taken = clock.taken().as_secs_f64();
    let sent = |n| i64::from(machine.pulses_sent(n)).unsigned_abs();
    let pulses: u64 = (0..4).map(sent).sum();
    Ok(vec![
        what.into(),
        Cell::number(f64::from(seconds), 0),
        Cell::count(pulses),
        Cell::number(taken, 3),
        Cell::number(f64::from(seconds) / taken, 0),
    ])
}

/// The table, for this many seconds of machine time.
pub fn table(seconds: u32) -> Result<Table> {
    let mut table = Table::new(
        "Four pulse outputs at 100 kHz, simulated, scans of 10 ms",
        &["observed", "seconds", "pulses", "took, s", "times as fast"],
    );
    table.row(measure("each millisecond", seconds, |machine, now_ms| {
        machine.scan(&mut NoHal, now_ms, SCAN_MS * 1000);
        (1..=SCAN_MS).for_each(|ms| machine.tick(&mut NoHal, now_ms + ms));
    })?);
    table.row(measure("each edge", seconds, |machine, now_ms| {
        let mut pins = Pins(0);
        machine.scan(&mut pins, now_ms, SCAN_MS * 1000);
        let (mut now_us, end_us) = (now_ms * 1000, (now_ms + SCAN_MS) * 1000);
        while let Some(wait) = machine.pulse_timer(&mut pins, now_us) {
            now_us += wait;
            if now_us >= end_us {
                break;
            }
        }
    })?);
    Ok(table)
}
