//! Verdicts as text.

use crate::commands::properties::ExternalWrites;
use crate::commands::{Outcome, counted};
use crate::report::junit::{self, Case, Problem, Properties};
use rungc_ir::Module;
use rungc_sim::property::Property;
use rungc_syntax::{DeviceClass, codes};
use rungc_verify::model::{Gap, Key, World, device_of};
use rungc_verify::prove::{Decision, FOREVER_MS, Options, Verdict, Why};
use rungc_verify::replay::{Change, Setting, story};
use rungc_verify::vacuous::{Broken, DeadEnd};
use std::collections::BTreeSet;
use std::fmt::Write;
use std::time::Duration;

/// A property and what was found of it.
pub struct Result<'a> {
    /// The property as requested.
    pub requested: &'a str,
    pub property: &'a Property,
    pub decision: &'a Decision,
    /// Devices that may be written from outside the program.
    pub external: &'a ExternalWrites,
    /// Duration.
    pub time: Duration,
}

impl Result<'_> {
    /// Outcome for the exit code.
    pub fn outcome(&self) -> Outcome {
        match (&self.decision.verdict, self.property.is_wanted()) {
            (Verdict::Undecided(_), _) => Outcome::Undecided,
            (Verdict::Proved, false) | (Verdict::Found(_), true) => Outcome::Success,
            (Verdict::Proved, true) | (Verdict::Found(_), false) => Outcome::Failed,
        }
    }

    /// The verdict in a word.
    pub fn word(&self) -> &'static str {
        match (&self.decision.verdict, self.property.is_wanted()) {
            (Verdict::Undecided(Why::Vacuous { .. }), _) => "vacuous",
            (Verdict::Undecided(_), _) => "not decided",
            (Verdict::Proved, false) => "proved",
            (Verdict::Found(_), false) => "violated",
            (Verdict::Found(_), true) => "reached",
            (Verdict::Proved, true) => "not reachable",
        }
    }

    /// The verdict as a case of a test report.
    pub fn case(&self, file: &str, module: &Module) -> Case {
        let outcome = self.outcome();
        let problem = (outcome != Outcome::Success).then(|| {
            let mut text = self.sentence();
            text.push('\n');
            self.describe(&mut text, module);
            Problem {
                result: match outcome {
                    Outcome::Undecided => junit::Result::Error,
                    _ => junit::Result::Failed,
                },
                kind: match outcome {
                    Outcome::Undecided => codes::PROPERTY_UNDECIDED.name,
                    _ => codes::PROPERTY_VIOLATED.name,
                },
                message: self.sentence(),
                text: text.trim_end().to_string(),
            }
        });
        Case {
            name: self.requested.to_string(),
            class: file.to_string(),
            time: self.time,
            properties: Properties::new(),
            problem,
        }
    }

    /// Describes the grounds of the verdict, and its dependencies.
    fn describe(&self, text: &mut String, module: &Module) {
        if let Verdict::Found(trace) = &self.decision.verdict {
            let story = story(module, self.property, trace);
            write_story(text, module, &story);
            if story.iter().any(|change| !change.start.is_empty()) {
                text.push_str(
                    "            latched devices start at any value here; with `--cleared`, at 0\n",
                );
            }
        }
        gaps(text, &self.decision.gaps);
        let unwritten = &self.decision.unwritten;
        if !unwritten.is_empty() {
            let names = list(unwritten);
            let _ = writeln!(
                text,
                "            nothing in the program writes {names}: taken as inputs"
            );
        }
        for (by, keys) in self.outside(module) {
            let names = list(&keys);
            let _ = writeln!(
                text,
                "            written from outside (`{by}`): {names}: taken as inputs"
            );
        }
    }

    /// Devices that something other than the program writes and that the property depends on, by what names them.
    pub fn outside(&self, module: &Module) -> Vec<(&'static str, Vec<Key>)> {
        let sources = self.external.sources().into_iter();
        let named = sources.map(|by| {
            let named_by = |key: &&Key| {
                let device = device_of(**key);
                device.and_then(|device| self.external.source(module.model, device)) == Some(by)
            };
            let free = self.decision.free.iter().filter(named_by).copied();
            (by, free.collect::<Vec<_>>())
        });
        named.filter(|(_, keys)| !names(keys).is_empty()).collect()
    }

    /// The verdict as a diagnostic says it.
    pub fn sentence(&self) -> String {
        let requested = self.requested;
        match (&self.decision.verdict, self.property.is_wanted()) {
            (Verdict::Undecided(why), _) => {
                format!("`{requested}` is not decided: {}", reason(why))
            }
            (Verdict::Proved, _) => format!("`{requested}`: no run reaches this"),
            (Verdict::Found(trace), _) => format!(
                "`{requested}` is violated after {}",
                counted(trace.scans.len(), "scan")
            ),
        }
    }
}

/// Contradiction between a program and what is assumed, in words.
pub fn contradiction(end: &DeadEnd, assumed: &[String], scan_ms: u32) -> String {
    let what = match end.broken {
        Broken::Condition(n) => format!("the assumption `{}`", assumed[n]),
        Broken::ScanTime => {
            format!("scans of at most {scan_ms} ms: it asks for longer ones (constant scan, M8039)")
        }
        Broken::Together => "the assumptions together".to_string(),
    };
    let run = counted(end.scans, "scan");
    format!(
        "the program contradicts {what}; after a run of {run} ({} ms), nothing keeps it, and a proof would say nothing of \
         what follows",
        end.ms
    )
}

/// Reason why a property is not decided, in words.
pub fn reason(why: &Why) -> String {
    match why {
        Why::Time { scans } => format!(
            "the time was up (`--timeout`), on this machine; no run of {} does it",
            counted(*scans, "scan")
        ),
        Why::Effort { scans, effort } => format!(
            "an effort of {effort} was not enough (`--effort`); no run of {} does it",
            counted(*scans, "scan")
        ),
        Why::Spurious { scans } => format!(
            "a run of {} does it in the model, but not on the interpreter",
            counted(*scans, "scan")
        ),
        Why::Contradiction { scans } => format!(
            "no run of {} keeps the assumptions",
            counted(*scans, "scan")
        ),
        Why::Vacuous { contradiction } => contradiction.clone(),
        Why::Engines { difference } => format!(
            "the engines of rungc disagree, so no verdict can be trusted: {difference}; please report this with the \
             program"
        ),
    }
}

/// Number of properties that hold, or are reached: `2 of 3 hold`.
pub fn summary(results: &[Result]) -> String {
    let good = results.iter().map(Result::outcome);
    let good = good.filter(|outcome| *outcome == Outcome::Success).count();
    format!("{good} of {} hold", results.len())
}

/// All verdicts as readable text.
pub fn human(
    results: &[Result],
    module: &Module,
    options: &Options,
    (assumed, external): (&[String], &ExternalWrites),
) -> String {
    let mut text = String::new();
    for result in results {
        let seconds = result.time.as_secs_f64();
        let _ = writeln!(
            text,
            "{:<11} {} ({seconds:.2} s)",
            result.word(),
            result.requested
        );
        if let Verdict::Undecided(why) = &result.decision.verdict {
            let _ = writeln!(text, "            {}", reason(why));
        }
        result.describe(&mut text, module);
    }
    if results
        .iter()
        .any(|result| result.word() == "proved" || result.word() == "not reachable")
    {
        let _ = writeln!(text, "Proved for this model under these assumptions:");
        for line in assumptions(&options.world, assumed, external) {
            let _ = writeln!(text, "  - {line}");
        }
    }
    text
}

/// Lists the parts that are not modelled, a line each.
pub fn gaps(text: &mut String, gaps: &[Gap]) {
    for gap in gaps {
        let step = gap
            .step
            .map_or_else(String::new, |step| match gap.is_instruction {
                true => format!(" (step {step})"),
                false => format!(" (network at step {step})"),
            });
        let what = &gap.what;
        let _ = writeln!(
            text,
            "            not modelled, any value possible: {what}{step}"
        );
    }
}

/// Assumptions of every proof.
pub fn assumptions(world: &World, assumed: &[String], external: &ExternalWrites) -> Vec<String> {
    let scan = match world.scan_ms {
        FOREVER_MS => "a scan begins any time after the one before".to_string(),
        ms => format!("a scan begins at most {ms} ms after the one before"),
    };
    let mut lines = vec![
        "the program runs as rungc's IR says, from power-on, also after STOP; while the PLC is in STOP, nothing is asked"
            .to_string(),
        format!("{scan}; inputs change only between scans"),
        match world.fresh {
            true => "latched devices begin with 0, and the PLC is not switched off and on again".to_string(),
            false => "latched devices begin with any value, all others as at power-on, whenever the PLC is switched on"
                .to_string(),
        },
        untouched(external),
    ];
    if !world.unset.is_empty() {
        lines.push("nothing but the program switches steps on".to_string());
    }
    lines.extend(
        assumed
            .iter()
            .map(|text| format!("after every scan: {text}")),
    );
    lines
}

/// Assumption about writers of devices that the program writes.
fn untouched(external: &ExternalWrites) -> String {
    let named = match external.sources()[..] {
        [] if external.has_option => "what `--free` and `[hmi]` name".to_string(),
        [] => "what `[hmi]` names".to_string(),
        [only] => format!("what `{only}` names"),
        [ref several @ .., last] => format!("what `{}` and `{last}` name", several.join("`, `")),
    };
    let client = match external.has_clients {
        true => ", no client of `[serve]`",
        false => "",
    };
    format!(
        "nothing but the program writes the devices that it writes, except inputs and {named}: no panel, no other PLC{client}"
    )
}

/// Names of the devices of memory, each once.
pub fn names(keys: &[Key]) -> Vec<String> {
    let found = keys.iter().filter_map(|&key| device_of(key));
    // A timer is a value and a contact.
    let found = BTreeSet::from_iter(found).into_iter();
    found
        .map(|(class, n)| class.number(n).to_string())
        .collect()
}

/// Names of the devices of memory, or of some and the number of others.
fn list(keys: &[Key]) -> String {
    shortened(&names(keys))
}

/// Names of devices, or of some and the number of others.
pub fn devices(of: &[(DeviceClass, u32)]) -> String {
    let names = of.iter().map(|(class, n)| class.number(*n).to_string());
    shortened(&names.collect::<Vec<_>>())
}

fn shortened(names: &[String]) -> String {
    const SHOWN: usize = 8;
    match names.len() > SHOWN {
        true => format!(
            "{} and {} more",
            names[..SHOWN].join(", "),
            names.len() - SHOWN
        ),
        false => names.join(", "),
    }
}

/// A run, a line for each scan in which something changes.
pub fn write_story(text: &mut String, module: &Module, story: &[Change]) {
    let settings = |settings: &[Setting]| -> String {
        let settings = settings.iter();
        let settings = settings.map(|set| setting(module, set));
        settings.collect::<Vec<_>>().join(", ")
    };
    for change in story {
        if !change.start.is_empty() {
            let _ = writeln!(
                text,
                "            at power-on                 {}",
                settings(&change.start)
            );
        }
        let scans = match change.scans {
            1 => format!("scan {}", change.first + 1),
            n => format!("scans {} to {}", change.first + 1, change.first + n),
        };
        let mut set: Vec<String> = change.set.iter().map(|set| setting(module, set)).collect();
        set.extend(change.buffers.iter().map(buffer));
        if change.restart {
            set.insert(0, "STOP, then RUN".to_string());
        }
        let set = match set.is_empty() {
            true => "no change".to_string(),
            false => set.join(", "),
        };
        let _ = writeln!(
            text,
            "            {scans:<14} {:>8} ms  {set}",
            change.at_ms
        );
        if !change.after.is_empty() {
            let _ = writeln!(
                text,
                "            {:<26}  then: {}",
                "",
                settings(&change.after)
            );
        }
    }
}

/// `U0\G10 = 5`.
fn buffer((module, address, value): &(u8, u32, i64)) -> String {
    format!("U{module}\\G{address} = {value}")
}

/// `X000 = 1 (start button)`.
fn setting(module: &Module, (name, device, value): &Setting) -> String {
    let mut comments = module.comments.iter();
    let comment = comments.find(|(class, number, _)| (*class, *number) == *device);
    match comment {
        Some((_, _, comment)) => format!("{name} = {value} ({})", comment.trim()),
        None => format!("{name} = {value}"),
    }
}

/// A run in one line: what is set when.
pub fn changes(module: &Module, story: &[Change]) -> String {
    let mut parts = Vec::new();
    for change in story {
        let all = change.start.iter().chain(&change.set);
        let set = all.map(|set| setting(module, set));
        let restart = change.restart.then(|| "STOP and RUN".to_string());
        let set = set.chain(change.buffers.iter().map(buffer));
        let set: Vec<String> = restart.into_iter().chain(set).collect();
        if !set.is_empty() {
            parts.push(format!(
                "from scan {} on {}",
                change.first + 1,
                set.join(", ")
            ));
        }
    }
    match parts.is_empty() {
        true => "with all inputs off".to_string(),
        false => parts.join("; "),
    }
}
