//! Time and memory of compiling: from a list to C and Rust, and to a program that runs.

use crate::clock::{self, Clock};
use crate::ladder::{Kind, Ladder};
use crate::problem::{Problem, Result};
use crate::table::{Cell, Table};
use crate::{subject, tools};
use rungc_lower::compile::{CompileOptions, check, compile};
use rungc_models::ModelId;
use std::process::Command;
use std::time::{Duration, Instant};

/// Processing of a list.
#[derive(Clone, Copy, PartialEq, Eq, Debug, clap::ValueEnum)]
pub enum Work {
    /// Read and checked.
    Check,
    /// Compiled to C.
    C,
    /// Compiled to Rust.
    Rust,
}

impl Work {
    fn title(self) -> &'static str {
        match self {
            Work::Check => "read and check",
            Work::C => "list to C",
            Work::Rust => "list to Rust",
        }
    }

    fn name(self) -> &'static str {
        match self {
            Work::Check => "check",
            Work::C => "c",
            Work::Rust => "rust",
        }
    }

    /// Does it; how many bytes came out.
    fn run(self, list: &str) -> Result<usize> {
        let options = CompileOptions {
            model: Some(ModelId::Fx3u),
            optimise: true,
            ..CompileOptions::default()
        };
        let read = rungc_frontend::read_text("ladder.il", list);
        if self == Work::Check {
            return Ok(check(&read.program, &options).steps as usize);
        }
        let Some(module) = compile(&read.program, &options).module else {
            return Err(Problem::Wrong("the program does not compile".to_string()));
        };
        Ok(match self {
            Work::C => {
                let files = rungc_codegen_c::emit(&module, &rungc_codegen_c::Options::default());
                files.iter().map(|file| file.contents.len()).sum()
            }
            _ => {
                let files = rungc_codegen_rust::emit(&module, &Default::default());
                files.iter().map(|file| file.contents.len()).sum()
            }
        })
    }
}

/// Does some work once, in a separate process (which is this one), and prints how long it took in seconds and how many
/// KiB of memory the process had in use at most: 0 where the system does not report it.
pub fn work_once(work: Work, steps: u32) -> Result<()> {
    let list = Ladder::new(Kind::Contacts, steps).list();
    let clock = Clock::start();
    let bytes = work.run(&list)?;
    let taken = clock.taken().as_secs_f64();
    println!("{taken} {} {bytes}", peak_memory_kib().unwrap_or(0));
    Ok(())
}

/// As Linux counts it.
fn peak_memory_kib() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().trim_end_matches(" kB").parse().ok()
}

/// The table of time and memory. The fastest run counts: of five, of long programs fewer.
pub fn table(sizes: &[u32]) -> Result<Table> {
    let mut table = Table::new(
        "Compiling `contacts`",
        &[
            "work",
            "steps",
            "seconds",
            "steps/s",
            "peak MiB",
            "peak bytes/step",
        ],
    );
    for work in [Work::Check, Work::C, Work::Rust] {
        for &steps in sizes {
            eprintln!("{}, {steps} steps ...", work.title());
            let mut fastest = (f64::INFINITY, 0.0);
            for _ in 0..(1_000_000 / steps.max(1)).clamp(1, 5) {
                let (seconds, kib) = in_process(work, steps)?;
                if seconds < fastest.0 {
                    fastest = (seconds, kib);
                }
            }
            let (seconds, kib) = fastest;
            let memory = |value: f64, digits| match kib > 0.0 {
                true => Cell::number(value, digits),
                false => "not known".into(),
            };
            table.row([
                work.title().into(),
                Cell::count(steps.into()),
                Cell::number(seconds, 3),
                Cell::number(f64::from(steps) / seconds, 0),
                memory(kib / 1024.0, 1),
                memory(kib * 1024.0 / f64::from(steps), 0),
            ]);
        }
    }
    Ok(table)
}

/// Seconds and KiB of one run.
fn in_process(work: Work, steps: u32) -> Result<(f64, f64)> {
    let this = std::env::current_exe().map_err(|error| Problem::File {
        path: "rungc-benches".into(),
        error,
    })?;
    let mut command = Command::new(this);
    command.args(["--work", work.name(), "--steps", &steps.to_string()]);
    let output = tools::run(&mut command)?;
    let mut numbers = output.split_whitespace().map_while(|n| n.parse().ok());
    match (numbers.next(), numbers.next()) {
        (Some(seconds), Some(kib)) => Ok((seconds, kib)),
        _ => Err(Problem::Wrong(format!("{command:?} printed {output}"))),
    }
}

/// The table of programs that run on this machine: as `rungc build --emit bin` makes them.
pub fn native_table(steps: u32) -> Result<Table> {
    let mut table = Table::new(
        "From a list to a native program (`rungc build --emit bin`)",
        &[
            "program",
            "steps",
            "to C, s",
            "C compiler, s",
            "in all, s",
            "libraries",
        ],
    );
    for kind in Kind::ALL {
        let ladder = Ladder::new(kind, steps);
        let mut row = vec![kind.name().into(), Cell::count(ladder.steps.into())];
        match native(&ladder) {
            Ok((emitting, making, library)) => {
                row.push(Cell::number(emitting.as_secs_f64(), 2));
                row.push(Cell::number(making.as_secs_f64(), 2));
                row.push(Cell::number((emitting + making).as_secs_f64(), 2));
                row.push(if library { "rungc-rt" } else { "none" }.into());
            }
            Err(problem) if problem.is_missing() => row.push(problem.to_string().into()),
            Err(problem) => return Err(problem),
        }
        table.row(row);
    }
    Ok(table)
}

/// Time to emit C and to build a program from it, and whether that needs the runtime library.
fn native(ladder: &Ladder) -> Result<(Duration, Duration, bool)> {
    tools::need(&["make", "cc"])?;
    let folder = tools::folder()?;
    let list = ladder.list();
    let clock = Clock::start();
    let module = subject::module_of(&list, "ladder")?;
    let files = rungc_codegen_c::emit(
        &module,
        &rungc_codegen_c::Options {
            main: true,
            ..Default::default()
        },
    );
    for file in &files {
        tools::write(&folder.path().join(&file.path), &file.contents)?;
    }
    let emitting = clock.taken();
    let (start, before) = (Instant::now(), clock::of_others());
    tools::run(Command::new("make").arg("-C").arg(folder.path()))?;
    let making = match (before, clock::of_others()) {
        (Some(before), Some(now)) => now.saturating_sub(before),
        _ => start.elapsed(),
    };
    let library = files.iter().any(|file| file.path.starts_with("rungc-rt/"));
    Ok((emitting, making, library))
}
