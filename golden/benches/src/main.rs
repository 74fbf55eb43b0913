//! `cargo run --release -p rungc-benches`: prints tables, and writes JSON. `docs/src/benchmarks.md` describes the
//! method.

use clap::{Parser, ValueEnum};
use rungc_benches::compile::{self, Work};
use rungc_benches::embedded::CODES;
use rungc_benches::host::{self, Effort};
use rungc_benches::ladder::Kind;
use rungc_benches::problem::Result;
use rungc_benches::subject::Code;
use rungc_benches::table::Table;
use rungc_benches::{checks, embedded, interp, page, pulse_counts, pulses, real, suites, tools};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Measures what rungc emits beside C written by hand, and rungc itself.
#[derive(Parser, Debug)]
struct Args {
    /// Short programs only, and fewer rounds: one minute instead of many.
    #[arg(long)]
    quick: bool,
    /// Also write the tables as JSON.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Also put the tables into a page, between the lines `<!-- tables -->` and `<!-- end of the tables -->`; with
    /// --only, the others stay.
    #[arg(long, value_name = "FILE")]
    update: Option<PathBuf>,
    /// Sections to measure; by default all.
    #[arg(long, value_enum, value_delimiter = ',', value_name = "LIST")]
    only: Vec<Section>,
    /// Kinds of program for `size` and `icount`; by default all.
    #[arg(long, value_enum, value_delimiter = ',', value_name = "LIST")]
    kinds: Vec<Kind>,
    /// Folders of projects, for `real`, which measures the largest programs in them.
    #[arg(long, value_delimiter = ',', value_name = "LIST")]
    projects: Vec<PathBuf>,
    /// Leave out code whose build takes long: `lanes` is emitted C for many instances.
    #[arg(long, value_enum, value_delimiter = ',', value_name = "LIST")]
    without: Vec<Slow>,
    /// Do one piece of work, which another process measures.
    #[arg(long, hide = true, requires = "steps")]
    work: Option<Work>,
    /// Length of the program for --work.
    #[arg(long, hide = true)]
    steps: Option<u32>,
}

/// Code whose build takes long.
#[derive(Clone, Copy, PartialEq, Eq, Debug, ValueEnum)]
enum Slow {
    /// Emitted C for many instances.
    Lanes,
    /// Emitted Rust.
    Rust,
}

/// Section of the measurements.
#[derive(Clone, Copy, PartialEq, Eq, Debug, ValueEnum)]
enum Section {
    /// Time of a scan of contacts and coils.
    Contacts,
    /// Time of a scan of equal stations.
    Stations,
    /// Time of a scan with timers, counters and arithmetic.
    Mixed,
    /// Time of a scan with blocks, queues, conversions and floats.
    Process,
    /// Time of a scan with PID loops and limits, and of a call of the runtime.
    Control,
    /// Time of a scan of step ladders.
    Sequence,
    /// Time of a scan with tables with index registers.
    Index,
    /// Time of a scan with blocks of words.
    Recipe,
    /// Time of a scan with digits and lamps.
    Display,
    /// Time of a scan with comparisons.
    Compare,
    /// Time of a scan with floats and limits.
    Float,
    /// Bytes on a microcontroller.
    Size,
    /// Instructions of a scan on a microcontroller.
    Icount,
    /// Instructions of a scan of real programs on a microcontroller.
    Real,
    /// Time and memory of compiling.
    Compile,
    /// Growth of checking with programs that are hard to check.
    Checks,
    /// Speed of the interpreter.
    Interp,
    /// Speed of simulated pulse outputs.
    Pulses,
    /// Time of test suites, and of mutants.
    Tests,
}

impl Section {
    fn tables(self, args: &Args) -> Result<Vec<Table>> {
        let quick = args.quick;
        match self {
            Section::Contacts => time(Kind::Contacts, args),
            Section::Stations => time(Kind::Stations, args),
            Section::Mixed => time(Kind::Mixed, args),
            Section::Process => time(Kind::Process, args),
            Section::Control => {
                let mut tables = time(Kind::Control, args)?;
                tables.push(host::calls_table(100, effort(args))?);
                Ok(tables)
            }
            Section::Sequence => time(Kind::Sequence, args),
            Section::Index => time(Kind::Index, args),
            Section::Recipe => time(Kind::Recipe, args),
            Section::Display => time(Kind::Display, args),
            Section::Compare => time(Kind::Compare, args),
            Section::Float => time(Kind::Float, args),
            Section::Size => Ok(vec![
                embedded::size_table(args.kinds(), embedded_sizes(quick), args.codes())?,
                embedded::image_table()?,
            ]),
            Section::Icount => Ok(vec![
                embedded::count_table(args.kinds(), embedded_sizes(quick), args.codes())?,
                pulse_counts::table()?,
            ]),
            Section::Real if args.projects.is_empty() => {
                eprintln!("real programs are not measured: --projects names none");
                Ok(Vec::new())
            }
            Section::Real => {
                let codes: Vec<Code> = args
                    .codes()
                    .iter()
                    .copied()
                    .filter(|code| *code != Code::Hand)
                    .collect();
                Ok(vec![real::table(&args.projects, &codes)?])
            }
            Section::Compile => Ok(vec![
                compile::table(compiled_sizes(quick))?,
                compile::native_table(16_000)?,
            ]),
            Section::Checks => Ok(vec![checks::table(if quick { 500 } else { 20_000 })]),
            Section::Interp => Ok(vec![interp::table(10_000, effort(args))?]),
            Section::Pulses => Ok(vec![pulses::table(if quick { 2 } else { 10 })?]),
            Section::Tests => Ok(vec![match quick {
                true => suites::table(1000, 100, 1000)?,
                false => suites::table(1000, 1000, 10_000)?,
            }]),
        }
    }
}

impl Args {
    fn kinds(&self) -> &[Kind] {
        if self.kinds.is_empty() {
            &Kind::ALL
        } else {
            &self.kinds
        }
    }

    fn codes(&self) -> &[Code] {
        if self.without.contains(&Slow::Rust) {
            &CODES[..2]
        } else {
            &CODES
        }
    }
}

fn effort(args: &Args) -> Effort {
    Effort {
        rounds: if args.quick { 21 } else { 51 },
        turn_us: 2000,
        lanes: !args.without.contains(&Slow::Lanes),
        rust: !args.without.contains(&Slow::Rust),
    }
}

fn time(kind: Kind, args: &Args) -> Result<Vec<Table>> {
    let sizes: &[u32] = match (args.quick, kind) {
        (true, _) => &[1000],
        (false, Kind::Stations) => &[1000, 5000, 100_000],
        (false, Kind::Sequence) => &[1000, 5000, 10_000],
        (false, _) => &[1000, 10_000, 100_000],
    };
    Ok(vec![host::table(kind, sizes, effort(args))?])
}

/// Lengths of programs that fit into a microcontroller.
fn embedded_sizes(quick: bool) -> &'static [u32] {
    if quick { &[1000] } else { &[1000, 5000] }
}

/// Lengths of programs that are compiled.
fn compiled_sizes(quick: bool) -> &'static [u32] {
    if quick {
        &[10_000, 100_000]
    } else {
        &[10_000, 100_000, 1_000_000]
    }
}

fn main() -> ExitCode {
    let args = Args::parse();
    if let (Some(work), Some(steps)) = (args.work, args.steps) {
        return match compile::work_once(work, steps) {
            Ok(()) => ExitCode::SUCCESS,
            Err(problem) => {
                eprintln!("{problem}");
                ExitCode::FAILURE
            }
        };
    }
    let mut all = vec![tools::table()];
    println!("{}", all[0]);
    let mut failed = false;
    for &section in Section::value_variants() {
        if !args.only.is_empty() && !args.only.contains(&section) {
            continue;
        }
        match section.tables(&args) {
            Ok(tables) => {
                tables.iter().for_each(|table| println!("{table}"));
                all.extend(tables);
            }
            Err(problem) => {
                eprintln!("{section:?}: {problem}");
                failed = true;
            }
        }
    }
    let written = [
        args.json.map(|path| (write_json(&path, &all), path)),
        args.update.map(|path| {
            let whole = args.only.is_empty();
            (update(&path, &all, whole), path)
        }),
    ];
    for (result, path) in written.into_iter().flatten() {
        if let Err(problem) = result {
            eprintln!("{}: {problem}", path.display());
            failed = true;
        }
    }
    ExitCode::from(u8::from(failed))
}

fn write_json(path: &Path, tables: &[Table]) -> std::io::Result<()> {
    let text = serde_json::to_string_pretty(tables)?;
    std::fs::write(path, text + "\n")
}

/// Replaces tables of a page: all of them, or those that have the same titles.
fn update(path: &Path, tables: &[Table], whole: bool) -> std::io::Result<()> {
    let page = std::fs::read_to_string(path)?;
    let updated = page::updated(&page, tables, whole).map_err(std::io::Error::other)?;
    std::fs::write(path, updated)
}
