//! `cargo xtask campaign`: random programs on every way to run them, for hours.
//!
//! Each batch of programs is compared on the interpreter, unoptimised, and on one way: the optimised interpreter,
//! emitted Rust, emitted C by a compiler with an optimisation level or a sanitizer, or a simulated microcontroller.
//! First each way has one small batch, so that a short campaign reaches all of them; then the way is next that has
//! taken the least time so far.

use crate::{Problem, root};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

/// How long, and with what.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// How many hours of the processor to use, or by the clock where the system does not say; each way gets at least
    /// one batch.
    #[arg(long, default_value_t = 1.0)]
    hours: f64,
    /// Stop earlier, once this many executions of instructions have been compared.
    #[arg(long)]
    instructions: Option<u64>,
    /// Random programs in a batch; the first batches are smaller.
    #[arg(long, default_value_t = 40)]
    programs: u64,
    /// Scans of each program after each of which all is compared.
    #[arg(long, default_value_t = 200)]
    scans: u64,
    /// Scans that follow, whose results are compared now and then.
    #[arg(long, default_value_t = 2_000)]
    more: u64,
    /// The number of the first program; each number is another program.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Only ways whose name contains this.
    #[arg(long)]
    way: Option<String>,
}

/// The ways, as the differential test reads them.
const WAYS: [&str; 15] = [
    "gcc -O0",
    "clang -O3",
    "rust",
    "gcc -O2",
    "clang -O1 -fsanitize=address,undefined -fno-sanitize-recover=all",
    "interp",
    "gcc -O3",
    "clang -O2",
    "cortex-m4 c",
    "gcc -O1 -fsanitize=undefined -fno-sanitize-recover=all",
    "clang -O0",
    "gcc -O1",
    "clang -O1",
    "gcc -O1 -fsanitize=address",
    "cortex-m3 c",
];

/// What became of the batches of a way.
#[derive(Default)]
struct Tally {
    batches: u64,
    instructions: u64,
    seconds: f64,
    failed: Vec<PathBuf>,
}

/// Runs a campaign; fails if anything differs.
pub fn run(args: &Args) -> Result<(), Problem> {
    let executable = build()?;
    let folder = root().join("target/campaign");
    fs::create_dir_all(&folder)?;
    let ways: Vec<&str> = WAYS
        .into_iter()
        .filter(|way| args.way.as_deref().is_none_or(|part| way.contains(part)))
        .filter(|way| is_available(way))
        .collect();
    if ways.is_empty() {
        return Err("no way to run programs is available".into());
    }
    let clock = Clock::new();
    let mut tallies: BTreeMap<&str, Tally> =
        ways.iter().map(|way| (*way, Tally::default())).collect();
    let mut seed = args.seed;
    for number in 0.. {
        let compared: u64 = tallies.values().map(|tally| tally.instructions).sum();
        let enough = args.instructions.is_some_and(|most| compared >= most);
        let is_first = number < ways.len();
        if enough || clock.seconds() >= args.hours * 3600.0 && !is_first {
            break;
        }
        let way = match is_first {
            true => ways[number],
            false => neediest(&tallies),
        };
        let programs = match is_first {
            true => args.programs.min(FIRST_PROGRAMS),
            false => args.programs,
        };
        let started = clock.seconds();
        let batch = Batch {
            programs,
            way,
            seed,
        };
        let found = compare(&executable, args, &batch)?;
        let tally = tallies.entry(way).or_default();
        match found {
            Ok(instructions) => tally.instructions += instructions,
            Err(output) => tally.failed.push(keep(&folder, args, &batch, &output)?),
        }
        tally.batches += 1;
        tally.seconds += clock.seconds() - started;
        println!("{way}: programs {seed} to {}", seed + programs - 1);
        seed += programs;
    }
    summarise(&tallies, clock.seconds())
}

/// Programs in the first batch of each way.
const FIRST_PROGRAMS: u64 = 10;

/// The way that has taken the least time.
fn neediest<'w>(tallies: &BTreeMap<&'w str, Tally>) -> &'w str {
    let seconds = |(_, tally): &(&&str, &Tally)| tally.seconds;
    let least = tallies
        .iter()
        .min_by(|a, b| seconds(a).total_cmp(&seconds(b)));
    least.map_or("", |(way, _)| way)
}

/// Programs that are compared together.
struct Batch<'w> {
    programs: u64,
    way: &'w str,
    seed: u64,
}

/// The time that programs take which this one starts.
struct Clock {
    begin: Instant,
    /// What they had taken before.
    before: f64,
}

impl Clock {
    fn new() -> Self {
        let begin = Instant::now();
        let mut clock = Clock { begin, before: 0.0 };
        clock.before = clock.seconds();
        clock
    }

    /// Seconds of the processor, of programs that have ended; where the system does not say, of the clock.
    fn seconds(&self) -> f64 {
        let stat = fs::read_to_string("/proc/self/stat").unwrap_or_default();
        // The name, which may contain anything, ends with the last parenthesis; two fields that count hundredths of
        // seconds are the 14th and 15th after it (proc(5): cutime and cstime).
        let fields = stat.rsplit_once(')').map_or("", |(_, fields)| fields);
        let hundredths: Vec<u64> = fields
            .split_whitespace()
            .skip(13)
            .take(2)
            .filter_map(|field| field.parse().ok())
            .collect();
        match hundredths.as_slice() {
            [user, system] => (user + system) as f64 / 100.0 - self.before,
            _ => self.begin.elapsed().as_secs_f64(),
        }
    }
}

/// The executable of the differential test.
fn build() -> Result<PathBuf, Problem> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(cargo)
        .args(["test", "-p", "rungc-golden", "--test", "differential"])
        .args(["--no-run", "--message-format", "json"])
        .current_dir(root())
        .output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into());
    }
    let text = String::from_utf8_lossy(&output.stdout);
    let lines = text
        .lines()
        .filter_map(|line| serde_json::from_str(line).ok());
    let mut paths = lines.filter_map(|line: Value| {
        let is_it = line["target"]["name"] == "differential";
        line["executable"]
            .as_str()
            .filter(|_| is_it)
            .map(PathBuf::from)
    });
    let path = paths.next_back();
    path.ok_or_else(|| "cargo names no executable of the differential test".into())
}

/// Whether the tools of a way are installed; says which are not.
fn is_available(way: &str) -> bool {
    let tools: &[&str] = match way.split(' ').next() {
        Some("gcc") => &["gcc", "make"],
        Some("clang") => &["clang", "make"],
        Some("cortex-m3" | "cortex-m4") => &["arm-none-eabi-gcc", "qemu-system-arm"],
        _ => &[],
    };
    tools.iter().all(|tool| {
        let found = Command::new(tool).arg("--version").output().is_ok();
        if !found {
            println!("left out, there is no {tool}: {way}");
        }
        found
    })
}

/// What makes a batch again, as variables of the environment.
fn variables(args: &Args, batch: &Batch) -> [(&'static str, String); 5] {
    [
        ("RUNGC_RANDOM_WAY", batch.way.to_string()),
        ("RUNGC_RANDOM_SEED", batch.seed.to_string()),
        ("RUNGC_RANDOM_PROGRAMS", batch.programs.to_string()),
        ("RUNGC_RANDOM_SCANS", args.scans.to_string()),
        ("RUNGC_RANDOM_MORE", args.more.to_string()),
    ]
}

/// Compares a batch: how many instructions were executed on the way, or what the test says.
fn compare(executable: &Path, args: &Args, batch: &Batch) -> Result<Result<u64, String>, Problem> {
    let output = Command::new(executable)
        .args([
            "all_engines_agree_on_random_programs",
            "--exact",
            "--nocapture",
        ])
        .envs(variables(args, batch))
        .current_dir(root().join("golden"))
        .output()?;
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    if !output.status.success() {
        let why = String::from_utf8_lossy(&output.stderr);
        return Ok(Err(format!("{said}\n{why}")));
    }
    let count = said.lines().find_map(|line| {
        let (before, _) = line.split_once(" instructions each")?;
        before.rsplit(' ').next()?.parse().ok()
    });
    Ok(count.ok_or_else(|| format!("the test does not say what it has run:\n{said}")))
}

/// Keeps what a batch says that differs, with the command that makes it again.
fn keep(folder: &Path, args: &Args, batch: &Batch, output: &str) -> Result<PathBuf, Problem> {
    let name = batch.way.replace(|c: char| !c.is_ascii_alphanumeric(), "-");
    let path = folder.join(format!("{name}-{}.txt", batch.seed));
    let variables = variables(args, batch);
    let variables = variables.map(|(name, value)| format!("{name}='{value}'"));
    let command = "cargo test -p rungc-golden --test differential all_engines_agree";
    fs::write(
        &path,
        format!("{} {command}\n\n{output}\n", variables.join(" ")),
    )?;
    println!("differs: {}", path.display());
    Ok(path)
}

/// Prints what was compared; fails if anything differs.
fn summarise(tallies: &BTreeMap<&str, Tally>, seconds: f64) -> Result<(), Problem> {
    println!(
        "\n{:>8} {:>14} {:>8}  way",
        "batches", "instructions", "seconds"
    );
    for (way, tally) in tallies {
        let Tally {
            batches,
            instructions,
            seconds,
            failed,
        } = tally;
        let differ = match failed.len() {
            0 => String::new(),
            n => format!(": {n} differ"),
        };
        println!("{batches:>8} {instructions:>14} {seconds:>8.0}  {way}{differ}");
    }
    let all: u64 = tallies.values().map(|tally| tally.instructions).sum();
    println!("{all} executions of instructions in {seconds:.0} s");
    let failed: Vec<String> = tallies
        .values()
        .flat_map(|tally| &tally.failed)
        .map(|path| path.display().to_string())
        .collect();
    match failed.is_empty() {
        true => Ok(()),
        false => Err(format!("engines differ:\n{}", failed.join("\n")).into()),
    }
}
