//! `rungc test --coverage` and `--mutants`.

use super::super::{
    Context, Failure, Outcome, Result, check_name, counted, eprint_line, interruption, print_text,
    put,
};
use super::Chosen;
use super::files::is_in;
use super::report::{Results, human};
use crate::args::{CoverageFormat, EngineChoice, Shard, TestArgs};
use crate::{output, progress};
use rungc_coverage::mutants::{self, Fate, Mutant};
use rungc_coverage::{Covered, cover, html, lcov, text};
use rungc_ir::Module;
use rungc_ir::passes::simplify;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_sim::plctest::{Suite, TestFile};
use rungc_sim::threads::Threads;
use rungc_syntax::Program;
use rungc_verify::prove::Options;
use rungc_verify::same::compare;
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::time::Instant;

/// Runs the cases while what they execute is noted, and reports that, or what became of mutants.
pub(super) fn run(args: &TestArgs, chosen: &Chosen, files: Vec<TestFile>, cx: Context) -> Result {
    let start = Instant::now();
    let option = if args.mutants {
        "--mutants"
    } else {
        "--coverage"
    };
    if matches!(
        args.engine,
        Some(EngineChoice::C | EngineChoice::Rust | EngineChoice::All)
    ) {
        let why = format!("{option}: the interpreter runs the cases; leave out --engine");
        return Err(Failure::Because(why));
    }
    if args.coverage == Some(CoverageFormat::Html) && output::file(&args.output).is_none() {
        let why = "--coverage html: name the page to write with -o";
        return Err(Failure::Because(why.to_string()));
    }
    let suite = progress::spin("compiling the cases", || {
        Suite::compile_marked(files, chosen.warn())
    });
    let cases = counted(suite.len(), "case");
    cx.note(&format!("     Running {cases} on interp"));
    let (programs, report) = cover(&suite, &mut |_| match interruption::is_requested() {
        true => ControlFlow::Break(()),
        false => ControlFlow::Continue(()),
    });
    let results = Results {
        suite: &suite,
        report: &report,
        elapsed: start.elapsed(),
        untested: None,
    };
    print_text(&human(&results))?;
    if interruption::is_requested() {
        return Ok(Outcome::Interrupted);
    }
    if args.mutants {
        if !report.is_success() {
            let why = "--mutants: all cases must pass before the program is changed";
            return Err(Failure::Because(why.to_string()));
        }
        return judge(args, &suite, &programs, cx);
    }
    let shown = match args.coverage {
        Some(CoverageFormat::Html) => html::page(&programs),
        Some(CoverageFormat::Lcov) => {
            check_lines(&programs)?;
            lcov::lcov(&programs)
        }
        Some(CoverageFormat::Text) | None => text::text(&programs),
    };
    let reached = programs.iter().map(Covered::reached).sum();
    let all = programs.iter().map(|program| program.goals.len()).sum();
    put(
        (output::file(&args.output), args.force),
        &shown,
        &text::share(reached, all),
        cx,
    )?;
    Ok(match report.is_success() {
        true => Outcome::Success,
        false => Outcome::Failed,
    })
}

/// Says which programs have no lines that a tracefile could name.
///
/// # Errors
/// A program whose file it cannot name.
fn check_lines(programs: &[Covered]) -> std::result::Result<(), Failure> {
    for program in programs.iter().filter(|program| !lcov::has_lines(program)) {
        eprint_line(&format!(
            "rungc: {} is left out: lcov needs a program whose file is a list; use --coverage html or text",
            program.name
        ));
    }
    let named = programs.iter().filter(|program| lcov::has_lines(program));
    let mut paths = named.filter_map(|program| program.path.as_deref());
    paths.try_for_each(|path| check_name(path, "a tracefile"))
}

/// Keeps one part of the mutants. Which one a mutant is in depends on what it changes, not on where it is: most stay
/// there when the program grows.
fn keep(mutants: &mut Vec<Mutant>, program: &Covered, shard: Shard) {
    let mut known: BTreeMap<String, usize> = BTreeMap::new();
    mutants.retain(|mutant| {
        let text = mutant.describe(&program.program);
        let number = known.entry(text.clone()).or_default();
        *number += 1;
        is_in(shard, &format!("{text} {number}"))
    });
}

/// Limits of the effort for proofs that mutants are equivalent: for all of a program, and for one.
const EFFORT: [u64; 2] = [10_000, 300];

/// Finds the mutants among those that no case has noticed of which no run changes an output.
pub fn tell_equivalent(program: &Covered, mutants: &[Mutant], fates: &mut [Fate]) {
    let survived = fates.iter().filter(|fate| **fate == Fate::Survived).count();
    let Some(old) = module(program, &program.program).filter(|_| survived > 0) else {
        return;
    };
    let [all, one] = EFFORT;
    let options = Options {
        effort: one.min(all / survived as u64),
        ..Options::default()
    };
    let survivors = mutants.iter().zip(fates);
    let survivors = survivors.filter(|(_, fate)| **fate == Fate::Survived);
    let (survivors, fates): (Vec<&Mutant>, Vec<&mut Fate>) = survivors.unzip();
    let equivalent = Threads::usual().map(&survivors, |mutant| {
        let new = module(program, &mutant.applied(&program.program));
        let is_same = |new| compare(&old, &new, &options).is_proved();
        !interruption::is_requested() && new.is_some_and(is_same)
    });
    for (fate, _) in fates.into_iter().zip(equivalent).filter(|(_, same)| *same) {
        *fate = Fate::Equivalent;
    }
}

fn module(covered: &Covered, program: &Program) -> Option<Module> {
    let options = CompileOptions {
        model: Some(covered.model.id),
        optimise: false,
        ..CompileOptions::default()
    };
    let mut module = compile(program, &options).module?;
    simplify(&mut module);
    Some(module)
}

/// Runs the mutants of all programs.
fn judge(args: &TestArgs, suite: &Suite, programs: &[Covered], cx: Context) -> Result {
    let (mut shown, mut gaps, mut noticed) = (String::new(), 0, 0);
    for program in programs {
        let mut all = mutants::mutants(program);
        if let Some(shard) = args.shard {
            keep(&mut all, program, shard);
        }
        let bar = progress::bar(all.len() as u64).with_message("mutants");
        let fates = mutants::run(suite, program, &all, &|| {
            bar.inc(1);
            !interruption::is_requested()
        });
        bar.finish_and_clear();
        let mut fates = fates;
        tell_equivalent(program, &all, &mut fates);
        if interruption::is_requested() {
            return Ok(Outcome::Interrupted);
        }
        let count = |fate| fates.iter().filter(|f| **f == fate).count();
        gaps += count(Fate::Survived) + count(Fate::NotExecuted);
        noticed += count(Fate::Noticed);
        shown += &mutants::text(program, &all, &fates);
    }
    let summary = format!("{noticed} of {} mutants noticed", noticed + gaps);
    put(
        (output::file(&args.output), args.force),
        &shown,
        &summary,
        cx,
    )?;
    Ok(match gaps {
        0 => Outcome::Success,
        _ => Outcome::Failed,
    })
}
