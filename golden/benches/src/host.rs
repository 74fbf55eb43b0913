//! Time on this machine: all implementations of a program in one executable, timed in turns.

use crate::ladder::{Called, Kind, Ladder};
use crate::problem::{Problem, Result};
use crate::subject::{self, CSubject, Code, RustSubject};
use crate::table::{Cell, Table};
use crate::tools;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The program that times.
const HOST_C: &str = include_str!("../templates/host.c");

/// Scans after each of which all devices are compared.
pub const CHECKED_SCANS: u32 = 3000;

/// C compilers, in the order of the table.
const COMPILERS: [&str; 2] = ["gcc", "clang"];

/// The longest programs that are timed as many instances: clang takes more than ten minutes for 100,000 steps.
const LANES_STEPS: u32 = 20_000;

/// Effort of timing.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Number of turns of each implementation.
    pub rounds: u32,
    /// About how long a turn is.
    pub turn_us: u32,
    /// Emitted C for many instances is built as well.
    pub lanes: bool,
    /// Emitted Rust is built as well, which takes longest.
    pub rust: bool,
}

/// One implementation, and what came out.
#[derive(Clone, Debug)]
pub struct Timed {
    /// Implementation.
    pub code: Code,
    /// Its compiler.
    pub compiler: String,
    /// Outcome, or the reason why there is none.
    pub result: std::result::Result<Outcome, String>,
}

/// Outcome of timing.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// Checksum of the states of all devices after each of [`CHECKED_SCANS`] scans.
    pub sum: u32,
    /// Nanoseconds that a scan took, in each round.
    pub times: Vec<f64>,
}

impl Timed {
    /// The fastest round, in nanoseconds a scan of one instance.
    pub fn fastest(&self) -> Option<f64> {
        let outcome = self.result.as_ref().ok()?;
        let fastest = outcome.times.iter().copied().reduce(f64::min)?;
        Some(fastest / f64::from(self.code.instances()))
    }

    /// Time relative to `other`: the median of all rounds, since both had their turns in each.
    pub fn ratio(&self, other: &Timed) -> Option<f64> {
        self.compared(other, |mine, others| mine / others)
    }

    /// Nanoseconds by which a scan takes longer than `other`: the median of all rounds.
    pub fn longer(&self, other: &Timed) -> Option<f64> {
        self.compared(other, |mine, others| mine - others)
    }

    fn compared(&self, other: &Timed, by: impl Fn(f64, f64) -> f64) -> Option<f64> {
        let (mine, others) = (self.result.as_ref().ok()?, other.result.as_ref().ok()?);
        let pairs = mine.times.iter().zip(&others.times);
        let [mine, others] = [self, other].map(|timed| f64::from(timed.code.instances()));
        median(pairs.map(|(a, b)| by(a / mine, b / others)).collect())
    }

    /// The hand-written C that it is to be compared with: compiled by the same compiler, else by the first.
    fn hand<'a>(&self, all: &'a [Timed]) -> Option<&'a Timed> {
        let mut hands = all.iter().filter(|t| t.code == Code::Hand);
        let first = hands.clone().next();
        hands.find(|hand| hand.compiler == self.compiler).or(first)
    }
}

/// The middle one; `None` of nothing.
pub fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

/// Sources and settings of one implementation's build.
struct Build {
    code: Code,
    compiler: String,
    prefix: String,
    objects: Result<Vec<PathBuf>>,
}

/// Builds all implementations, checks that they do the same, and times them. With no rounds it only checks.
pub fn time(ladder: &Ladder, compilers: &[&str], effort: Effort) -> Result<Vec<Timed>> {
    let folder = tools::folder()?;
    let mut builds = Vec::new();
    let fits = effort.lanes && ladder.steps <= LANES_STEPS && subject::runs_in_lanes(ladder)?;
    for compiler in compilers {
        let lanes = fits.then_some(Code::Lanes);
        for code in [Code::Hand, Code::C].into_iter().chain(lanes) {
            builds.push(build_c(ladder, code, compiler, folder.path()));
        }
    }
    if effort.rust {
        builds.push(build_rust(ladder, folder.path()));
    }
    let missing = |b: &&Build| matches!(&b.objects, Err(problem) if !problem.is_missing());
    if let Some(i) = builds.iter().position(|b| missing(&b)) {
        return builds.swap_remove(i).objects.map(|_| Vec::new());
    }
    let runtime = match subject::calls_runtime(ladder)? {
        true => Some(tools::runtime_object(folder.path())?),
        false => None,
    };
    let lines = run(&builds, runtime, folder.path(), effort)?;
    let mut lines = lines.into_iter();
    Ok(builds
        .into_iter()
        .map(|build| Timed {
            code: build.code,
            compiler: build.compiler,
            result: match build.objects {
                Ok(_) => Ok(lines.next().unwrap_or_default()),
                Err(problem) => Err(problem.to_string()),
            },
        })
        .collect())
}

fn build_c(ladder: &Ladder, code: Code, compiler: &str, folder: &Path) -> Build {
    let prefix = match code {
        Code::Hand => format!("hand_{compiler}"),
        Code::Lanes => format!("lanes_{compiler}"),
        _ => format!("c_{compiler}"),
    };
    let objects = tools::need(&[compiler]).and_then(|()| {
        let subject = CSubject::new(code, ladder, &prefix, folder)?;
        let mut objects = subject.compile(compiler, &["-O2"])?;
        objects.program.push(objects.adaptor);
        Ok(objects.program)
    });
    Build {
        code,
        compiler: format!("{compiler} -O2"),
        prefix,
        objects,
    }
}

fn build_rust(ladder: &Ladder, folder: &Path) -> Build {
    let prefix = "rust".to_string();
    let library = RustSubject::new(ladder, &prefix, folder)
        .and_then(|subject| subject.build(tools::cargo(), None, "3"));
    Build {
        code: Code::Rust,
        compiler: "rustc -O3".to_string(),
        prefix,
        objects: library.map(|library| vec![library]),
    }
}

/// Links what could be built, and the runtime that it calls, runs it; what each prints.
fn run(
    builds: &[Build],
    runtime: Option<PathBuf>,
    folder: &Path,
    effort: Effort,
) -> Result<Vec<Outcome>> {
    let built: Vec<&Build> = builds.iter().filter(|b| b.objects.is_ok()).collect();
    let Some(linker) = COMPILERS.iter().find(|compiler| tools::is_there(compiler)) else {
        return Err(Problem::Missing(COMPILERS.join(" or ")));
    };
    let prefixes: Vec<&str> = built.iter().map(|b| b.prefix.as_str()).collect();
    subject::write_list(folder, &prefixes)?;
    tools::write(&folder.join("host.c"), HOST_C)?;
    let program = folder.join("host");
    let objects = built
        .iter()
        .filter_map(|b| b.objects.as_ref().ok())
        .flatten();
    tools::run(
        Command::new(linker)
            .args(["-std=c99", "-O2", "-o"])
            .args([&program, &folder.join("host.c")])
            .args(objects)
            .args(runtime)
            .args(["-lpthread", "-ldl", "-lm"]),
    )?;
    let mut command = Command::new(&program);
    command.args([CHECKED_SCANS, effort.rounds, effort.turn_us].map(|n| n.to_string()));
    let output = tools::run(&mut command)?;
    same_checksums(&output)?;
    Ok(output.lines().map(outcome).collect())
}

/// A line of what `host.c` prints.
fn outcome(line: &str) -> Outcome {
    let mut words = line.split(' ').skip(1);
    let sum = words
        .next()
        .and_then(|sum| u32::from_str_radix(sum, 16).ok());
    Outcome {
        sum: sum.unwrap_or_default(),
        times: words.skip(1).filter_map(|n| n.parse().ok()).collect(),
    }
}

/// All implementations must have done the same.
fn same_checksums(output: &str) -> Result<()> {
    let sums = |line: &str| {
        line.split(' ')
            .skip(1)
            .take(2)
            .map(str::to_string)
            .collect::<Vec<_>>()
    };
    let mut all = output.lines().map(sums);
    let first = all.next();
    match all.all(|sums| Some(&sums) == first.as_ref()) {
        true => Ok(()),
        false => Err(Problem::Wrong(format!("implementations differ:\n{output}"))),
    }
}

/// The table for programs of several sizes.
pub fn table(kind: Kind, sizes: &[u32], effort: Effort) -> Result<Table> {
    let mut table = Table::new(
        format!("Time of a scan on this machine: `{}`", kind.name()),
        &[
            "steps",
            "code",
            "compiler",
            "ns/scan",
            "ns/step",
            "× hand, gcc",
            "× hand, clang",
        ],
    );
    if kind == Kind::Control {
        table.columns.push("beyond hand, ns/call".to_string());
    }
    for &size in sizes {
        let ladder = Ladder::new(kind, size);
        eprintln!("{}, {} steps ...", kind.name(), ladder.steps);
        let all = match time(&ladder, &COMPILERS, effort) {
            Err(problem) if problem.is_missing() => {
                let steps = Cell::count(ladder.steps.into());
                table.row([steps, "all".into(), problem.to_string().into()]);
                continue;
            }
            all => all?,
        };
        for timed in &all {
            let mut row = vec![
                Cell::count(ladder.steps.into()),
                timed.code.title().into(),
                timed.compiler.as_str().into(),
            ];
            match (&timed.result, timed.fastest()) {
                (Err(why), _) => row.push(why.as_str().into()),
                (Ok(_), None) => row.push("not timed".into()),
                (Ok(_), Some(fastest)) => {
                    row.push(Cell::number(fastest, 1));
                    row.push(Cell::number(fastest / f64::from(ladder.steps), 4));
                    let hands = all.iter().filter(|t| t.code == Code::Hand);
                    row.extend(hands.map(|hand| match timed.ratio(hand) {
                        Some(ratio) if ratio < 0.1 => Cell::number(ratio, 4),
                        Some(ratio) => Cell::number(ratio, 2),
                        None => "–".into(),
                    }));
                    if kind == Kind::Control {
                        let calls = ladder.calls() as f64;
                        let hand = timed.hand(&all).filter(|_| timed.code != Code::Hand);
                        let longer = hand.and_then(|hand| timed.longer(hand));
                        row.push(longer.map_or("–".into(), |ns| Cell::number(ns / calls, 1)));
                    }
                }
            }
            table.row(row);
        }
    }
    Ok(table)
}

/// Times each instruction that emitted C calls the runtime for by itself: programs of `count` times the same.
pub fn calls_table(count: u32, effort: Effort) -> Result<Table> {
    let mut table = Table::new(
        format!("Time of a call of the runtime, in programs of {count}"),
        &[
            "instruction",
            "code",
            "compiler",
            "ns",
            "by hand, ns",
            "beyond, ns",
        ],
    );
    // A turn is as long as that of the hand-written C, which takes a fraction of the time.
    let effort = Effort {
        turn_us: effort.turn_us / 20,
        ..effort
    };
    for what in Called::ALL {
        eprintln!("{} ...", what.name());
        let ladder = Ladder::of_calls(what, count);
        let all = time(&ladder, &COMPILERS, effort)?;
        for timed in all.iter().filter(|timed| timed.code != Code::Hand) {
            let mut row: Vec<Cell> = vec![
                what.name().into(),
                timed.code.title().into(),
                timed.compiler.as_str().into(),
            ];
            let hand = timed.hand(&all);
            let per_call = |ns: Option<f64>| match ns {
                Some(ns) => Cell::number(ns / f64::from(count), 1),
                None => "–".into(),
            };
            match &timed.result {
                Err(why) => row.push(why.as_str().into()),
                Ok(_) => row.extend([
                    per_call(timed.fastest()),
                    per_call(hand.and_then(Timed::fastest)),
                    per_call(hand.and_then(|hand| timed.longer(hand))),
                ]),
            }
            table.row(row);
        }
    }
    Ok(table)
}
