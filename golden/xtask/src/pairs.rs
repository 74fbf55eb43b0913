//! `cargo xtask pairs`: the prover's precision on real programs. Of every program in some folders, each two outputs
//! that
//! it drives exclude each other, or a run shows that they do not; the rest is counted by its reason.

use crate::Problem;
use rungc_ir::Module;
use rungc_ir::passes::simplify;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_sim::property::{Property, parse};
use rungc_syntax::DeviceClass;
use rungc_verify::model::{Encoder, Key, World};
use rungc_verify::prove::{Decision, EFFORT, Options, Verdict, Why, decide};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Options of the chore.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// Programs, or folders with programs.
    #[arg(required = true)]
    paths: Vec<PathBuf>,
    /// Effort for each pair.
    #[arg(long, default_value_t = EFFORT)]
    effort: u64,
    /// Pairs of a program: of more, every second, third and so forth.
    #[arg(long, default_value_t = 40)]
    pairs: usize,
    /// Programs at a time.
    #[arg(long, default_value_t = 1)]
    jobs: usize,
}

/// Endings of the names of programs.
const ENDINGS: [&str; 5] = ["wpg", "gxw", "csv", "il", "st"];

/// Processor time of a pair above which it is shown, too long for somebody who waits.
const SLOW: Duration = Duration::from_secs(10);

/// Verdicts on the pairs of a program.
#[derive(Default)]
struct Tally {
    proved: usize,
    together: usize,
    /// Undecided pairs: names, and the reason.
    open: Vec<(String, String)>,
    /// Decided pairs that took long.
    slow: Vec<String>,
    time: Duration,
}

/// Decides the pairs of all programs and prints the verdicts.
///
/// # Errors
///
/// A folder cannot be read.
pub fn run(args: &Args) -> Result<(), Problem> {
    let mut files = Vec::new();
    for path in &args.paths {
        programs(path, &mut files)?;
    }
    files.sort();
    let (next, tallies) = (AtomicUsize::new(0), Mutex::new(BTreeMap::new()));
    let work = || {
        while let Some(path) = files.get(next.fetch_add(1, Ordering::Relaxed)) {
            let tally = examined(path, args);
            let mut tallies = tallies.lock().unwrap_or_else(PoisonError::into_inner);
            if let Some(tally) = tally {
                println!("{}", line(path, &tally));
                tallies.insert(path, tally);
            }
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..args.jobs.max(1) {
            scope.spawn(work);
        }
    });
    let tallies = tallies.into_inner().unwrap_or_else(PoisonError::into_inner);
    println!("{}", summary(tallies.values()));
    Ok(())
}

/// Adds the programs of a folder.
fn programs(path: &Path, found: &mut Vec<PathBuf>) -> Result<(), Problem> {
    if path.is_dir() {
        for entry in std::fs::read_dir(path)? {
            programs(&entry?.path(), found)?;
        }
        return Ok(());
    }
    let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
    if ENDINGS.iter().any(|one| ending == *one) {
        found.push(path.to_owned());
    }
    Ok(())
}

/// The verdicts on a program; `None` if it is none, does not compile, or drives fewer than two outputs.
fn examined(path: &Path, args: &Args) -> Option<Tally> {
    let mut read = rungc_frontend::read(path).ok()?;
    rungc::structured::compile(&mut read, None);
    let program = read.program;
    let options = CompileOptions {
        optimise: false,
        ..CompileOptions::default()
    };
    let mut module = compile(&program, &options).module?;
    simplify(&mut module);
    let pairs = pairs(&driven(&module), args.pairs);
    if pairs.is_empty() {
        return None;
    }
    let mut tally = Tally::default();
    for (first, second) in pairs {
        let [a, b] = [first, second].map(|number| DeviceClass::Y.number(number));
        let pair = format!("{a} & {b}");
        let property = Property::Never(parse(&pair, &|_| Vec::new()).ok()?);
        let options = Options {
            effort: args.effort,
            ..Options::default()
        };
        let (begin, since) = (processor_time(), Instant::now());
        let decision = decide(&module, &property, &options);
        let took = match (begin, processor_time()) {
            (Some(begin), Some(end)) => end.saturating_sub(begin),
            _ => since.elapsed(),
        };
        tally.time += took;
        match &decision.verdict {
            Verdict::Proved => tally.proved += 1,
            Verdict::Found(_) => tally.together += 1,
            Verdict::Undecided(why) => {
                let reason = format!("{}: {}", cause(why), gaps(&decision));
                tally.open.push((pair.clone(), reason));
            }
        }
        if took > SLOW {
            tally.slow.push(format!("{pair} took {took:.1?}"));
        }
    }
    Some(tally)
}

/// Processor time of this thread, if the system reports it.
fn processor_time() -> Option<Duration> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds = text.split(' ').next()?.parse().ok()?;
    Some(Duration::from_nanos(nanoseconds))
}

/// Outputs that a scan can change, and those at which pulses leave.
fn driven(module: &Module) -> Vec<u32> {
    let encoder = Encoder::scan(module, World::default());
    let outputs = encoder
        .memory()
        .filter_map(|(key, before, after)| match key {
            Key::Bit(DeviceClass::Y, number) => {
                let sends = module.pulse_outputs.contains(&number);
                (sends || before != after).then_some(number)
            }
            _ => None,
        });
    outputs.collect()
}

/// Pairs of outputs, not many more than `most`: in their order, with equal gaps.
fn pairs(outputs: &[u32], most: usize) -> Vec<(u32, u32)> {
    let firsts = outputs.iter().enumerate();
    let all = firsts.flat_map(|(i, &first)| outputs[i + 1..].iter().map(move |&b| (first, b)));
    let all: Vec<_> = all.collect();
    let gap = all.len().div_ceil(most.max(1)).max(1);
    all.into_iter().step_by(gap).collect()
}

/// Reason of a verdict, in a word or two.
fn cause(why: &Why) -> &'static str {
    match why {
        Why::Time { .. } => "time",
        Why::Effort { .. } => "effort",
        Why::Spurious { .. } => "not confirmed",
        Why::Contradiction { .. } => "contradiction",
        Why::Vacuous { .. } => "vacuous",
        Why::Engines { .. } => "engines",
    }
}

/// What a question leaves open, as a list.
fn gaps(decision: &Decision) -> String {
    let gaps = decision.gaps.iter().map(|gap| match gap.step {
        Some(step) => format!("{} (step {step})", gap.what),
        None => gap.what.clone(),
    });
    let gaps: Vec<String> = gaps.collect();
    match gaps.is_empty() {
        true => format!("no gap, {} bits", decision.latches),
        false => gaps.join(", "),
    }
}

/// A program in a line, and one for each pair that is open or took long.
fn line(path: &Path, tally: &Tally) -> String {
    let open = tally.open.iter();
    let open = open.map(|(pair, reason)| format!("\n    open: {pair}: {reason}"));
    let slow = tally.slow.iter().map(|slow| format!("\n    slow: {slow}"));
    format!(
        "{}: {} exclude each other, {} do not, {} open, {:.1?}{}",
        path.display(),
        tally.proved,
        tally.together,
        tally.open.len(),
        tally.time,
        open.chain(slow).collect::<String>(),
    )
}

/// The share of pairs that are open, and their reasons by count.
fn summary<'t>(tallies: impl Iterator<Item = &'t Tally> + Clone) -> String {
    let decided = tallies.clone().map(|tally| tally.proved + tally.together);
    let decided: usize = decided.sum();
    let mut reasons: BTreeMap<&str, usize> = BTreeMap::new();
    let (mut open, mut time) = (0, Duration::ZERO);
    for tally in tallies.clone() {
        time += tally.time;
        open += tally.open.len();
        for (_, reason) in &tally.open {
            *reasons.entry(reason).or_default() += 1;
        }
    }
    let mut reasons: Vec<_> = reasons.into_iter().collect();
    reasons.sort_by_key(|&(reason, count)| (std::cmp::Reverse(count), reason));
    let reasons = reasons
        .iter()
        .map(|(reason, count)| format!("\n{count:>5} {reason}"));
    let all = decided + open;
    format!(
        "{} programs, {all} pairs: {decided} decided, {open} open ({:.1} %), {time:.1?} of processor time{}",
        tallies.count(),
        100.0 * open as f64 / all.max(1) as f64,
        reasons.collect::<String>(),
    )
}

#[cfg(test)]
mod tests {
    use super::{Args, examined, pairs};
    use std::path::PathBuf;

    #[test]
    fn pairs_are_taken_with_equal_gaps() {
        assert_eq!(pairs(&[0, 1, 4], 40), [(0, 1), (0, 4), (1, 4)]);
        let outputs: Vec<u32> = (0..20).collect();
        let some = pairs(&outputs, 40);
        assert_eq!((some.len(), some[0], some[1]), (38, (0, 1), (0, 6)));
        assert_eq!(pairs(&[3], 40), []);
    }

    #[test]
    fn pairs_are_proved_found_and_open() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.il");
        let list = "LD X000\nOUT Y000\nLDI X000\nOUT Y001\nLD X001\nOUT Y002\nLD M8000\nMOV K2X010 D0\nSQR D0 D1\n\
                    LD= D1 K16\nOUT Y004\nEND\n";
        std::fs::write(&path, list).unwrap();
        let args = Args {
            paths: vec![PathBuf::new()],
            effort: 500,
            pairs: 40,
            jobs: 1,
        };
        let tally = examined(&path, &args).unwrap();
        // The root of eight bits is never 16, but the model does not know it.
        assert_eq!((tally.proved, tally.together, tally.open.len()), (1, 2, 3));
        assert!(
            tally
                .open
                .iter()
                .all(|(_, why)| why.contains("square roots and floats"))
        );
    }
}
