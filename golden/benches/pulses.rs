//! How fast pulse outputs are simulated: `cargo bench -p rungc-golden --bench pulses`. Prints seconds; judges nothing.

use rungc_ir::ModelId;
use rungc_ir::compile::{CompileOptions, compile};
use rungc_rt::{Class, Hal, NoHal, Plc, Program};
use rungc_sim::Machine;
use std::time::Instant;

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
const SECONDS: u32 = 10;

/// Hardware that counts what its pins do.
struct Pins(u64);

impl Hal for Pins {
    fn set_output(&mut self, _: u16, value: bool) {
        self.0 += u64::from(value);
    }
}

/// The machine after its time, and how long that took.
fn time(what: &str, mut scan: impl FnMut(&mut Machine, u32)) {
    let read = rungc_frontend::read_text("pulses.il", PROGRAM);
    let options = CompileOptions {
        model: Some(ModelId::L01s),
        ..CompileOptions::default()
    };
    let Some(module) = compile(&read.program, &options).module else {
        return println!("the program does not compile");
    };
    let mut machine = Machine::new(&module);
    let _ = machine.set_bit(Class::X, 0, true);
    let start = Instant::now();
    for now_ms in (0..1000 * SECONDS).step_by(10) {
        scan(&mut machine, now_ms);
    }
    let seconds = start.elapsed().as_secs_f64();
    let pulses: i64 = (0..4)
        .map(|n| i64::from(machine.pulses_sent(n)).abs())
        .sum();
    let times = f64::from(SECONDS) / seconds;
    println!(
        "{what:<34} {seconds:7.3} s for {SECONDS} s, {times:.0} times as fast ({pulses} pulses)"
    );
}

fn main() {
    time("ticks of 1 ms, scans of 10 ms", |machine, now_ms| {
        machine.scan(&mut NoHal, now_ms, 10_000);
        (1..=10).for_each(|ms| machine.tick(now_ms + ms));
    });
    time("each edge, scans of 10 ms", |machine, now_ms| {
        let mut pins = Pins(0);
        machine.scan(&mut pins, now_ms, 10_000);
        let (mut now_us, end_us) = (now_ms * 1000, (now_ms + 10) * 1000);
        while let Some(wait) = machine.pulse_timer(&mut pins, now_us) {
            now_us += wait;
            if now_us >= end_us {
                break;
            }
        }
    });
}
