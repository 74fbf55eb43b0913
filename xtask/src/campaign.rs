//! `cargo xtask campaign`: random programs on every way to run them, for hours.
//!
//! Each batch of programs is compared on the interpreter, unoptimised, and on one way: the optimised interpreter,
//! emitted Rust, emitted C by a compiler with an optimisation level or a sanitizer, or a simulated microcontroller. The
//! ways take turns, so that a short campaign reaches each of them too.

use crate::{Problem, root};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

/// How long, and with what.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// How many hours to continue; each way gets at least one batch.
    #[arg(long, default_value_t = 1.0)]
    hours: f64,
    /// Stop earlier, once this many executions of instructions have been compared.
    #[arg(long)]
    instructions: Option<u64>,
    /// Programs in a batch.
    #[arg(long, default_value_t = 40)]
    programs: u64,
    /// Scans of each program.
    #[arg(long, default_value_t = 1_000)]
    scans: u64,
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
    let (begin, time) = (Instant::now(), Duration::from_secs_f64(args.hours * 3600.0));
    let mut tallies: BTreeMap<&str, Tally> = BTreeMap::new();
    let mut seed = args.seed;
    for batch in 0.. {
        let compared: u64 = tallies.values().map(|tally| tally.instructions).sum();
        let enough = args.instructions.is_some_and(|most| compared >= most);
        if enough || begin.elapsed() >= time && batch >= ways.len() {
            break;
        }
        let way = ways[batch % ways.len()];
        let started = Instant::now();
        let tally = tallies.entry(way).or_default();
        match compare(&executable, args, way, seed)? {
            Ok(instructions) => tally.instructions += instructions,
            Err(output) => tally.failed.push(keep(&folder, args, way, seed, &output)?),
        }
        tally.batches += 1;
        tally.seconds += started.elapsed().as_secs_f64();
        println!("{way}: programs {seed} to {}", seed + args.programs - 1);
        seed += args.programs;
    }
    summarise(&tallies, begin.elapsed())
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
fn variables(args: &Args, way: &str, seed: u64) -> [(&'static str, String); 4] {
    [
        ("RUNGC_RANDOM_WAY", way.to_string()),
        ("RUNGC_RANDOM_SEED", seed.to_string()),
        ("RUNGC_RANDOM_PROGRAMS", args.programs.to_string()),
        ("RUNGC_RANDOM_SCANS", args.scans.to_string()),
    ]
}

/// Compares a batch: how many instructions were executed on the way, or what the test says.
fn compare(
    executable: &Path,
    args: &Args,
    way: &str,
    seed: u64,
) -> Result<Result<u64, String>, Problem> {
    let output = Command::new(executable)
        .args([
            "all_engines_agree_on_random_programs",
            "--exact",
            "--nocapture",
        ])
        .envs(variables(args, way, seed))
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
fn keep(
    folder: &Path,
    args: &Args,
    way: &str,
    seed: u64,
    output: &str,
) -> Result<PathBuf, Problem> {
    let name = way.replace(|c: char| !c.is_ascii_alphanumeric(), "-");
    let path = folder.join(format!("{name}-{seed}.txt"));
    let variables = variables(args, way, seed);
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
fn summarise(tallies: &BTreeMap<&str, Tally>, elapsed: Duration) -> Result<(), Problem> {
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
    println!(
        "{all} executions of instructions in {} s",
        elapsed.as_secs()
    );
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
