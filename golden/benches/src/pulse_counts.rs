//! Instructions that pulse outputs take on a Cortex-M4, and the resulting limit of their speed.

use crate::embedded::{INSTRUCTIONS_PER_TICK, board_folder, linker};
use crate::problem::{Problem, Result};
use crate::pulses;
use crate::table::{Cell, Table};
use crate::tools;
use rungc_firmware::target::CORTEX_M4F;
use std::process::Command;

/// The program that counts.
const PULSES_C: &str = include_str!("../templates/pulses.c");

/// Milliseconds that it simulates: ramps, and what follows them.
const MILLISECONDS: u32 = 300;

/// The core's clock on the simulated board, in Hz.
const CLOCK: f64 = 168e6;

/// Instructions of a function.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Count {
    /// Of its longest call.
    pub most: f64,
    /// Of a call on average.
    pub mean: f64,
}

/// Instructions of a tick, and of a call of the timer at an edge, with four outputs at 100 kHz.
pub fn measure() -> Result<[Count; 2]> {
    tools::need(&["make", CORTEX_M4F.cc, tools::QEMU])?;
    let runtime = tools::runtime(Some(&CORTEX_M4F))?;
    let folder = board_folder()?;
    let folder = folder.path();
    let options = rungc_codegen_c::Options::default();
    for file in rungc_codegen_c::emit(&pulses::module()?, &options) {
        tools::write(&folder.join(&file.path), &file.contents)?;
    }
    tools::write(&folder.join("main.c"), PULSES_C)?;
    let flags = format!(
        "CFLAGS=-std=c99 -Os -ffunction-sections {}",
        CORTEX_M4F.flags
    );
    tools::run(
        Command::new("make")
            .arg(format!("CC={}", CORTEX_M4F.cc))
            .arg(format!("RUNGC_RT={}", runtime.display()))
            .arg(flags)
            .current_dir(folder),
    )?;
    let image = folder.join("counted.elf");
    let parts = ["main.c", "startup.c", "board.c", "libpulses.a"];
    tools::run(
        linker(folder, &image)
            .arg(format!("-DMILLISECONDS={MILLISECONDS}"))
            .args(parts.map(|part| folder.join(part)))
            .arg(runtime)
            .arg("-Wl,--gc-sections,-z,noexecstack"),
    )?;
    read(&tools::qemu(&image)?)
}

/// Parses the output of `pulses.c`.
fn read(printed: &str) -> Result<[Count; 2]> {
    let row = |line: &str| {
        let numbers = line.split(' ').skip(1).map(|word| word.parse::<f64>().ok());
        match numbers.collect::<Option<Vec<_>>>()?[..] {
            [most, all, calls] => Some(Count {
                most: most * INSTRUCTIONS_PER_TICK,
                mean: all * INSTRUCTIONS_PER_TICK / calls,
            }),
            _ => None,
        }
    };
    match printed.lines().filter_map(row).collect::<Vec<_>>()[..] {
        [tick, edge] => Ok([tick, edge]),
        _ => Err(Problem::Wrong(format!("not all was counted:\n{printed}"))),
    }
}

/// The table.
pub fn table() -> Result<Table> {
    let mut table = Table::new(
        "Instructions of four pulse outputs on a Cortex-M4 (QEMU, `-icount shift=0`), `-Os`",
        &["what", "instructions on average", "at most"],
    );
    let [tick, edge] = match measure() {
        Err(problem) if problem.is_missing() => {
            table.row(vec![problem.to_string().into()]);
            return Ok(table);
        }
        counts => counts?,
    };
    for (what, count) in [
        ("a tick, each millisecond", tick),
        ("a call of the timer", edge),
    ] {
        table.row([
            what.into(),
            Cell::number(count.mean, 0),
            Cell::number(count.most, 0),
        ]);
    }
    // Two edges a pulse; the timer comes for each edge of four outputs separately, or for all of them together.
    for (what, calls, count) in [
        ("pulses/s of four outputs, one speed", 2.0, edge.most),
        ("pulses/s of each of four outputs", 8.0, edge.mean),
    ] {
        let rate = CLOCK / (calls * count);
        table.row([what.into(), Cell::number(rate, 0), "".into()]);
    }
    Ok(table)
}
