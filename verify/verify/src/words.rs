//! Verdicts in words: what was decided, on what grounds and under which assumptions.

use crate::model::{Gap, Key, World, device_of};
use crate::prove::{Decision, FOREVER_MS, Options, Verdict, Why};
use crate::replay::{Change, Setting, story};
use crate::request::ExternalWrites;
use crate::vacuous::{Broken, DeadEnd, dead_end};
use rungc_ir::Module;
use rungc_sim::property::Property;
use rungc_syntax::DeviceClass;
use rungc_syntax::diag::counted;
use std::collections::BTreeSet;
use std::fmt::Write;

/// A verdict in a word.
pub fn word(decision: &Decision, property: &Property) -> &'static str {
    match (&decision.verdict, property.is_wanted()) {
        (Verdict::Undecided(Why::Vacuous { .. }), _) => "vacuous",
        (Verdict::Undecided(_), _) => "not decided",
        (Verdict::Proved, false) => "proved",
        (Verdict::Found(_), false) => "violated",
        (Verdict::Found(_), true) => "reached",
        (Verdict::Proved, true) => "not reachable",
    }
}

/// A verdict as a diagnostic states it.
pub fn sentence(requested: &str, decision: &Decision, property: &Property) -> String {
    match (&decision.verdict, property.is_wanted()) {
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

/// Describes the grounds of a verdict, and its dependencies.
pub fn describe(
    text: &mut String,
    module: &Module,
    (property, decision): (&Property, &Decision),
    external: &ExternalWrites,
) {
    if let Verdict::Found(trace) = &decision.verdict {
        let story = story(module, property, trace);
        write_story(text, module, &story);
        if story.iter().any(|change| !change.start.is_empty()) {
            text.push_str(
                "            latched devices start at any value here; with `--cleared`, at 0\n",
            );
        }
    }
    gaps(text, &decision.gaps);
    let unwritten = &decision.unwritten;
    if !unwritten.is_empty() {
        let names = list(unwritten);
        let _ = writeln!(
            text,
            "            nothing in the program writes {names}: taken as inputs"
        );
    }
    for (by, keys) in outside(decision, external, module) {
        let names = list(&keys);
        let _ = writeln!(
            text,
            "            written from outside (`{by}`): {names}: taken as inputs"
        );
    }
}

/// Devices that something other than the program writes and that the property depends on, by what names them.
pub fn outside(
    decision: &Decision,
    external: &ExternalWrites,
    module: &Module,
) -> Vec<(&'static str, Vec<Key>)> {
    let sources = external.sources().into_iter();
    let named = sources.map(|by| {
        let named_by = |key: &&Key| {
            let device = device_of(**key);
            device.and_then(|device| external.source(module.model, device)) == Some(by)
        };
        let free = decision.free.iter().filter(named_by).copied();
        (by, free.collect::<Vec<_>>())
    });
    named.filter(|(_, keys)| !names(keys).is_empty()).collect()
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

/// Reason to take proofs back: one of the programs contradicts an assumption.
pub fn vacuous<'m>(
    modules: impl IntoIterator<Item = &'m Module>,
    options: &Options,
    assumed: &[String],
) -> Option<Why> {
    let mut modules = modules.into_iter();
    let end = modules.find_map(|module| dead_end(module, options))?;
    let contradiction = contradiction(&end, assumed, options.world.scan_ms);
    Some(Why::Vacuous { contradiction })
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
