//! How long a program of a million steps takes: `cargo bench -p rungc-golden`. Prints seconds; judges nothing.

use rungc_ir::ModelId;
use rungc_ir::compile::{CompileOptions, check, compile};
use std::fmt::Write;
use std::time::{Duration, Instant};

const STEPS: u32 = 1_000_000;
const RUNS: usize = 5;

/// A ladder of about so many steps: series and parallel contacts of inputs, mode flags and recent relays, a coil each.
fn ladder(steps: u32) -> String {
    let mut seed = 1u32;
    let mut random = |below: u32| {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) % below
    };
    let (mut text, mut written, mut coil) = (String::new(), 0, 16);
    while written + 7 < steps {
        for contact in 0..2 + random(4) {
            let mnemonic = match (contact, random(4)) {
                (0, 0) => "LDI",
                (0, _) => "LD",
                (_, 0) => "ANI",
                (_, 1) => "OR",
                _ => "AND",
            };
            let _ = match random(3) {
                0 => writeln!(text, "{mnemonic} X{:03o}", random(128)),
                1 => writeln!(text, "{mnemonic} M{}", random(16)),
                _ => writeln!(text, "{mnemonic} M{}", coil - 1 - random(coil.min(16))),
            };
            written += 1;
        }
        let _ = writeln!(text, "OUT M{coil}");
        coil = if coil == 7000 { 16 } else { coil + 1 };
        written += 1;
    }
    text.push_str("END\n");
    text
}

fn median(mut times: Vec<Duration>) -> f64 {
    times.sort();
    times[times.len() / 2].as_secs_f64()
}

fn time(what: &str, mut work: impl FnMut() -> usize) {
    let mut result = 0;
    let times = (0..RUNS)
        .map(|_| {
            let start = Instant::now();
            result = work();
            start.elapsed()
        })
        .collect();
    println!("{what:<28} {:7.3} s  ({result})", median(times));
}

fn main() {
    let text = ladder(STEPS);
    let options = CompileOptions {
        model: Some(ModelId::Fx3u),
        optimise: true,
        ..CompileOptions::default()
    };
    println!("{STEPS} steps, median of {RUNS} runs");
    time("read and check", || {
        let read = rungc_frontend::read_text("ladder.il", &text);
        check(&read.program, &options).steps as usize
    });
    time("read, compile and emit C", || {
        let read = rungc_frontend::read_text("ladder.il", &text);
        let module = compile(&read.program, &options)
            .module
            .expect("the ladder is correct");
        let files = rungc_codegen_c::emit(&module, &rungc_codegen_c::Options::default());
        files.iter().map(|file| file.text.len()).sum()
    });
}
