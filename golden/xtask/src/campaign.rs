//! `cargo xtask campaign`: random programs on every way to run them, for hours.
//!
//! Each batch of programs is compared on the interpreter, unoptimised, and on one way: the optimised interpreter,
//! emitted Rust, emitted C by a compiler with an optimisation level or a sanitizer, or a simulated microcontroller.
//! First each way has one small batch, so that a short campaign reaches all of them; then the way is next that has
//! taken the least time so far. With `--proofs`, the prover is attacked instead ([`proofs`]).

mod proofs;

use crate::{Problem, root};
use rungc_sim::engines::cortex_m::{CORTEX_M3, CORTEX_M4, missing};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

/// Options of a campaign.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// Attack the prover: random properties of random programs.
    #[arg(long)]
    proofs: bool,
    /// With --proofs: programs at a time.
    #[arg(long, default_value_t = 1, requires = "proofs")]
    jobs: usize,
    /// With --proofs: begin no program after this many minutes.
    #[arg(long, requires = "proofs")]
    minutes: Option<u64>,
    /// Processor time to use in hours, or time by the clock where the system does not report it; each way gets at least
    /// one batch.
    #[arg(long, default_value_t = 1.0)]
    hours: f64,
    /// Stop earlier, after this many hours of the clock.
    #[arg(long)]
    clock: Option<f64>,
    /// Stop earlier, once this many executions of instructions have been compared.
    #[arg(long)]
    instructions: Option<u64>,
    /// Random programs, 1000 of them with --proofs; else those in a batch, 40, of which the first ones are smaller.
    #[arg(long)]
    programs: Option<u64>,
    /// Scans of each program after each of which all is compared.
    #[arg(long, default_value_t = 200)]
    scans: u64,
    /// Scans that follow, whose results are compared now and then.
    #[arg(long, default_value_t = 10_000)]
    more: u64,
    /// The number of the first program; each number is another program.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Only ways whose name contains this.
    #[arg(long)]
    way: Option<String>,
}

/// The ways, as the differential test reads them.
const WAYS: [&str; 16] = [
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
    "cortex-m4 rust",
];

/// Extent of comparisons, as the test reports it.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
struct Extent {
    programs: u64,
    scans: u64,
    instructions: u64,
}

/// Results of a way's batches.
#[derive(Debug, Default)]
struct Tally {
    way: &'static str,
    /// Tool missing on this computer, so that the way is left out.
    lacks: Option<String>,
    batches: u64,
    compared: Extent,
    /// Programs that differ.
    differing: u64,
    /// Batches that did not come to compare anything.
    broken: u64,
    seconds: f64,
    /// Outputs of the failed batches.
    kept: Vec<PathBuf>,
}

/// Runs a campaign; fails if anything differs, or if a way whose tools are there has compared nothing.
pub fn run(args: &Args) -> Result<(), Problem> {
    if args.proofs {
        return proofs::run(proofs::Extent {
            seed: args.seed,
            programs: args.programs.unwrap_or(1000),
            jobs: args.jobs,
            time: args
                .minutes
                .map(|minutes| Duration::from_secs(60 * minutes)),
            others: true,
        });
    }
    let folder = root().join("target/campaign");
    fs::create_dir_all(&folder)?;
    let mut tallies: Vec<Tally> = WAYS
        .into_iter()
        .filter(|way| args.way.as_deref().is_none_or(|part| way.contains(part)))
        .map(|way| Tally {
            way,
            lacks: lacking(way),
            ..Tally::default()
        })
        .collect();
    for Tally { way, lacks, .. } in &tallies {
        if let Some(lacks) = lacks {
            println!("left out, there is no {lacks}: {way}");
        }
    }
    if tallies.iter().all(|tally| tally.lacks.is_some()) {
        return Err("no way to run programs is available".into());
    }
    let executable = build()?;
    let clock = Clock::new();
    let mut seed = args.seed;
    while let Some(next) = next(&tallies, args, &clock) {
        let tally = &mut tallies[next];
        let programs = args.programs.unwrap_or(BATCH);
        let programs = match tally.batches {
            0 => programs.min(FIRST_PROGRAMS),
            _ => programs,
        };
        let batch = Batch {
            programs,
            way: tally.way,
            seed,
        };
        let started = clock.seconds();
        let outcome = compare(&executable, args, &batch)?;
        tally.seconds += clock.seconds() - started;
        let extent = outcome.extent.unwrap_or_default();
        println!(
            "{}: programs {seed} to {}: {} instructions",
            tally.way,
            seed + programs - 1,
            extent.instructions
        );
        if let Some(output) = &outcome.failure {
            tally.kept.push(keep(&folder, args, &batch, output)?);
        }
        tally.add(&outcome);
        seed += programs;
    }
    println!("\n{}", table(&tallies, clock.seconds()));
    judge(&tallies)
}

/// Programs in a batch.
const BATCH: u64 = 40;

/// Programs in the first batch of each way.
const FIRST_PROGRAMS: u64 = 10;

/// Index of the next way: one that has had no batch, then the one that has taken the least time; `None` at the end.
fn next(tallies: &[Tally], args: &Args, clock: &Clock) -> Option<usize> {
    let ways = || (0..tallies.len()).filter(|&way| tallies[way].lacks.is_none());
    let compared: u64 = tallies
        .iter()
        .map(|tally| tally.compared.instructions)
        .sum();
    if args.instructions.is_some_and(|most| compared >= most) {
        return None;
    }
    let first = ways().find(|&way| tallies[way].batches == 0);
    let is_over = clock.seconds() >= args.hours * 3600.0
        || args
            .clock
            .is_some_and(|hours| clock.elapsed() >= hours * 3600.0);
    first.or_else(|| {
        let seconds = |way: usize| tallies[way].seconds;
        ways()
            .filter(|_| !is_over)
            .min_by(|&a, &b| seconds(a).total_cmp(&seconds(b)))
    })
}

/// Programs that are compared together.
struct Batch {
    programs: u64,
    way: &'static str,
    seed: u64,
}

/// Result of a batch.
#[derive(Debug, Default)]
struct Outcome {
    /// `None` if the test did not come to that.
    extent: Option<Extent>,
    differing: u64,
    /// Message of the test, if it fails.
    failure: Option<String>,
}

impl Tally {
    fn add(&mut self, outcome: &Outcome) {
        self.batches += 1;
        self.differing += outcome.differing;
        let Some(extent) = outcome.extent else {
            self.broken += 1;
            return;
        };
        self.compared.programs += extent.programs;
        self.compared.scans += extent.scans;
        self.compared.instructions += extent.instructions;
    }
}

/// The time that programs take which this one starts.
struct Clock {
    begin: Instant,
    /// Time that they had taken before.
    before: f64,
}

impl Clock {
    fn new() -> Self {
        let begin = Instant::now();
        let mut clock = Clock { begin, before: 0.0 };
        clock.before = clock.seconds();
        clock
    }

    /// Seconds of the clock.
    fn elapsed(&self) -> f64 {
        self.begin.elapsed().as_secs_f64()
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
            _ => self.elapsed(),
        }
    }
}

/// The executable with the differential test, optimised.
fn build() -> Result<PathBuf, Problem> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(cargo)
        .args(["test", "-p", "rungc-golden", "--test", "it"])
        .args(["--profile", "thorough"])
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
        let is_it = line["target"]["name"] == "it";
        line["executable"]
            .as_str()
            .filter(|_| is_it)
            .map(PathBuf::from)
    });
    let path = paths.next_back();
    path.ok_or_else(|| "cargo names no executable of the differential test".into())
}

/// Tool of a way that is missing on this computer, if any.
fn lacking(way: &str) -> Option<String> {
    let (first, flags) = way.split_once(' ').unwrap_or((way, ""));
    match first {
        "cortex-m3" => missing(&CORTEX_M3).into_iter().next(),
        "cortex-m4" => missing(&CORTEX_M4).into_iter().next(),
        "gcc" | "clang" => {
            let is_there = |tool: &&str| Command::new(tool).arg("--version").output().is_ok();
            let tool = [first, "make"].into_iter().find(|tool| !is_there(tool));
            let links = || links(first, flags).unwrap_or(false);
            tool.map(str::to_string)
                .or_else(|| (!links()).then(|| format!("library that {first} needs for {flags}")))
        }
        _ => None,
    }
}

/// Returns true if a compiler makes executables with these flags: the libraries of sanitizers are a separate package.
fn links(compiler: &str, flags: &str) -> std::io::Result<bool> {
    let folder = tempfile::tempdir()?;
    fs::write(
        folder.path().join("none.c"),
        "int main(void)\n{\n    return 0;\n}\n",
    )?;
    let output = Command::new(compiler)
        .args(flags.split_whitespace())
        .args(["none.c", "-o", "none"])
        .current_dir(folder.path())
        .output()?;
    Ok(output.status.success())
}

/// Environment variables that repeat a batch.
fn variables(args: &Args, batch: &Batch) -> [(&'static str, String); 5] {
    [
        ("RUNGC_RANDOM_WAY", batch.way.to_string()),
        ("RUNGC_RANDOM_SEED", batch.seed.to_string()),
        ("RUNGC_RANDOM_PROGRAMS", batch.programs.to_string()),
        ("RUNGC_RANDOM_SCANS", args.scans.to_string()),
        ("RUNGC_RANDOM_MORE", args.more.to_string()),
    ]
}

/// Compares a batch.
fn compare(executable: &Path, args: &Args, batch: &Batch) -> Result<Outcome, Problem> {
    let output = Command::new(executable)
        .args([
            "differential::all_engines_agree_on_random_programs",
            "--exact",
            "--nocapture",
        ])
        .envs(variables(args, batch))
        .current_dir(root().join("golden"))
        .output()?;
    let stdout = String::from_utf8_lossy(&output.stdout);
    let why = String::from_utf8_lossy(&output.stderr);
    let extent = extent(&stdout);
    let failed = !output.status.success() || extent.is_none();
    Ok(Outcome {
        extent,
        differing: differing(&why),
        failure: failed.then(|| format!("{stdout}\n{why}")),
    })
}

/// Extent of comparisons, from the test's report: `compared with 1 engines: 7 programs, 70 scans, 900 instructions`.
fn extent(stdout: &str) -> Option<Extent> {
    let (_, after) = stdout.split_once("compared with ")?;
    let (_, counts) = after.lines().next()?.split_once(": ")?;
    let count = |name: &str| {
        let mut counts = counts.split(", ");
        counts.find_map(|count| count.strip_suffix(name)?.trim().parse().ok())
    };
    Some(Extent {
        programs: count("programs")?,
        scans: count("scans")?,
        instructions: count("instructions")?,
    })
}

/// Number of programs that differ, from the test's failure message.
fn differing(why: &str) -> u64 {
    let before = why.split_once(" programs differ").map(|(before, _)| before);
    let number = before.and_then(|before| before.split_whitespace().next_back()?.parse().ok());
    number.unwrap_or(0)
}

/// Keeps what a batch says that fails, with the command that makes it again.
fn keep(folder: &Path, args: &Args, batch: &Batch, output: &str) -> Result<PathBuf, Problem> {
    let name = batch.way.replace(|c: char| !c.is_ascii_alphanumeric(), "-");
    let path = folder.join(format!("{name}-{}.txt", batch.seed));
    let variables = variables(args, batch);
    let variables = variables.map(|(name, value)| format!("{name}='{value}'"));
    let command = "cargo test -p rungc-golden --test it differential::all_engines_agree";
    fs::write(
        &path,
        format!("{} {command}\n\n{output}\n", variables.join(" ")),
    )?;
    println!("fails: {}", path.display());
    Ok(path)
}

/// Extent of comparisons on each way, as a table in Markdown.
fn table(tallies: &[Tally], seconds: f64) -> String {
    let widest = tallies.iter().map(|tally| tally.way.len()).max();
    let width = widest.unwrap_or(0) + 2;
    let mut lines = vec![
        format!(
            "| {:width$} | batches | programs | {:>10} | {:>13} | differ | seconds |",
            "way", "scans", "instructions"
        ),
        format!(
            "|{}|--------:|---------:|-----------:|--------------:|-------:|--------:|",
            "-".repeat(width + 2)
        ),
    ];
    let row = |way: &str, (batches, differing): (u64, u64), extent: Extent, seconds: f64| {
        format!(
            "| {way:width$} | {batches:>7} | {:>8} | {:>10} | {:>13} | {differing:>6} | {seconds:>7.0} |",
            extent.programs, extent.scans, extent.instructions,
        )
    };
    let mut all = Tally::default();
    for tally in tallies {
        let way = format!("`{}`", tally.way);
        lines.push(match &tally.lacks {
            Some(lacks) => format!("| {way:width$} | left out: there is no {lacks} |"),
            None => row(
                &way,
                (tally.batches, tally.differing),
                tally.compared,
                tally.seconds,
            ),
        });
        all.batches += tally.batches;
        all.differing += tally.differing;
        all.compared.programs += tally.compared.programs;
        all.compared.scans += tally.compared.scans;
        all.compared.instructions += tally.compared.instructions;
    }
    lines.push(row(
        "all",
        (all.batches, all.differing),
        all.compared,
        seconds,
    ));
    lines.join("\n")
}

/// Fails if programs differ, if batches did not come to compare anything, or if a way has compared nothing.
fn judge(tallies: &[Tally]) -> Result<(), Problem> {
    let mut problems = Vec::new();
    for tally in tallies.iter().filter(|tally| tally.lacks.is_none()) {
        let way = tally.way;
        if tally.compared.instructions == 0 {
            problems.push(format!("{way}: nothing was compared"));
        }
        if tally.differing > 0 {
            problems.push(format!("{way}: {} programs differ", tally.differing));
        }
        if tally.broken > 0 {
            problems.push(format!("{way}: {} batches compared nothing", tally.broken));
        }
        let kept = tally.kept.iter();
        problems.extend(kept.map(|path| format!("    {}", path.display())));
    }
    match problems.is_empty() {
        true => Ok(()),
        false => Err(problems.join("\n").into()),
    }
}

#[cfg(test)]
mod tests {
    use super::{Extent, Outcome, Tally, WAYS, differing, extent, judge, table};

    const SOME: Extent = Extent {
        programs: 7,
        scans: 70,
        instructions: 900,
    };

    fn tally(outcome: &Outcome) -> Tally {
        let mut tally = Tally {
            way: "gcc -O0",
            ..Tally::default()
        };
        tally.add(outcome);
        tally
    }

    #[test]
    fn what_the_test_says_is_read() {
        let stdout = "running 1 test\ntest a ... hostile operands: 9 compile, 3 do not\n\
            compared with 1 engines: 7 programs, 70 scans, 900 instructions\nok\n";
        assert_eq!(extent(stdout), Some(SOME));
        assert_eq!(extent("error: no compiler"), None);
        assert_eq!(
            differing("panicked at differential.rs:\n3 programs differ:\nseed 1"),
            3
        );
        assert_eq!(differing(""), 0);
    }

    #[test]
    fn a_way_that_compares_nothing_is_an_error() {
        let fine = Outcome {
            extent: Some(SOME),
            ..Outcome::default()
        };
        assert!(judge(&[tally(&fine)]).is_ok());
        let differs = Outcome {
            differing: 2,
            ..fine
        };
        let nothing = Outcome::default();
        let empty = Outcome {
            extent: Some(Extent::default()),
            ..Outcome::default()
        };
        for (outcome, expected) in [
            (differs, "2 programs differ"),
            (nothing, "nothing was compared"),
            (empty, "nothing was compared"),
        ] {
            let problem = judge(&[tally(&outcome)]).unwrap_err().to_string();
            assert!(problem.contains(expected), "{problem}");
        }
        let left_out = Tally {
            lacks: Some("gcc".to_string()),
            ..Tally::default()
        };
        assert!(judge(&[left_out]).is_ok());
    }

    #[test]
    fn the_table_has_a_row_for_each_way() {
        let tallies = WAYS.map(|way| Tally {
            way,
            lacks: (way == "rust").then(|| "rustc".to_string()),
            compared: SOME,
            ..Tally::default()
        });
        let table = table(&tallies, 1.0);
        assert_eq!(table.lines().count(), WAYS.len() + 3);
        assert!(table.contains("| left out: there is no rustc |"), "{table}");
    }
}
