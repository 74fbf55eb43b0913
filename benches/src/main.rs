//! `cargo run --release -p rungc-benches`: prints tables, and writes JSON.

use clap::{Parser, ValueEnum};
use rungc_benches::host::{self, Effort};
use rungc_benches::ladder::Kind;
use rungc_benches::problem::Result;
use rungc_benches::table::Table;
use std::path::PathBuf;
use std::process::ExitCode;

/// Measures what rungc emits beside C written by hand, and rungc itself.
#[derive(Parser, Debug)]
struct Args {
    /// Short programs only, and fewer rounds: half a minute instead of many.
    #[arg(long)]
    quick: bool,
    /// Also write the tables as JSON.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// What to measure; by default everything.
    #[arg(long, value_enum, value_delimiter = ',', value_name = "LIST")]
    only: Vec<Section>,
}

/// What is measured.
#[derive(Clone, Copy, PartialEq, Eq, Debug, ValueEnum)]
enum Section {
    /// Time of a scan of contacts and coils.
    Contacts,
    /// Time of a scan of equal stations.
    Stations,
    /// Time of a scan with timers, counters and arithmetic.
    Mixed,
}

impl Section {
    fn tables(self, quick: bool) -> Result<Vec<Table>> {
        match self {
            Section::Contacts => time(Kind::Contacts, quick),
            Section::Stations => time(Kind::Stations, quick),
            Section::Mixed => time(Kind::Mixed, quick),
        }
    }
}

fn time(kind: Kind, quick: bool) -> Result<Vec<Table>> {
    let effort = Effort {
        rounds: if quick { 21 } else { 51 },
        turn_us: 2000,
    };
    let sizes: &[u32] = match (quick, kind) {
        (true, _) => &[1000],
        (false, Kind::Stations) => &[1000, 5000, 100_000],
        (false, _) => &[1000, 10_000, 100_000],
    };
    Ok(vec![host::table(kind, sizes, effort)?])
}

fn main() -> ExitCode {
    let args = Args::parse();
    let mut all = Vec::new();
    let mut failed = false;
    for &section in Section::value_variants() {
        if !args.only.is_empty() && !args.only.contains(&section) {
            continue;
        }
        match section.tables(args.quick) {
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
    if let Some(path) = args.json
        && let Err(problem) = write_json(&path, &all)
    {
        eprintln!("{}: {problem}", path.display());
        failed = true;
    }
    ExitCode::from(u8::from(failed))
}

fn write_json(path: &std::path::Path, tables: &[Table]) -> std::io::Result<()> {
    let text = serde_json::to_string_pretty(tables)?;
    std::fs::write(path, text + "\n")
}
