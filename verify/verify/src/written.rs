//! Runs as cases of test files: a case states the property, so that it fails as long as the program violates it.

use crate::replay::{Change, STOP_MS, Setting, story};
use crate::search::Trace;
use rungc_ir::Module;
use rungc_sim::engines::Interpreter;
use rungc_sim::plctest::{self, Suite};
use rungc_sim::property::{Condition, Property};
use rungc_syntax::text::acts;
use std::collections::BTreeSet;
use std::fmt::{Display, Write};
use std::ops::ControlFlow;

/// A property as a line of a case in a test file.
pub fn rule(property: &Property) -> String {
    let quoted = |condition: &Condition| quoted(&condition.to_string());
    match property {
        Property::Never(a) => format!("never = {}", quoted(a)),
        Property::Always(a) => format!("always = {}", quoted(a)),
        Property::Reachable(a) => format!("reachable = {}", quoted(a)),
        Property::Whenever {
            when,
            then,
            within_ms,
        } => {
            let within = match within_ms {
                0 => String::new(),
                ms => format!(", within_ms = {ms}"),
            };
            let (when, then) = (quoted(when), quoted(then));
            format!("whenever = [{{ when = {when}, then = {then}{within} }}]")
        }
        Property::Stays {
            after,
            holds,
            until,
        } => {
            let after = match after {
                None => String::new(),
                Some(after) => format!("after = {}, ", quoted(after)),
            };
            let until = match until {
                Condition::Constant(false) => String::new(),
                until => format!(", until = {}", quoted(until)),
            };
            format!("stays = [{{ {after}holds = {}{until} }}]", quoted(holds))
        }
    }
}

/// Names of cases: each is one line, and none is there twice.
#[derive(Default)]
pub struct Names(BTreeSet<String>);

impl Names {
    /// A name for this.
    pub fn name(&mut self, wanted: &str) -> String {
        let words: Vec<&str> = wanted.split_whitespace().collect();
        let plain = words.join(" ").replace(acts, "");
        let mut name = plain.clone();
        let mut number = 1;
        while !self.0.insert(name.clone()) {
            number += 1;
            name = format!("{plain} ({number})");
        }
        name
    }
}

/// The case of a run that violates a property, or shows what is wanted.
pub fn case(name: &str, module: &Module, property: &Property, trace: &Trace) -> String {
    let story = story(module, property, trace);
    let mut text = format!("\n[[case]]\nname = {}\n{}\n", quoted(name), rule(property));
    if let Some(first) = story.first().filter(|first| !first.start.is_empty()) {
        let _ = writeln!(text, "init = {}", settings(&first.start));
    }
    for change in &story {
        step(&mut text, change);
        if !change.after.is_empty() {
            let after = change.after.iter();
            let after = after.map(|(name, _, value)| format!("{name} = {value}"));
            let _ = writeln!(text, "# then: {}", after.collect::<Vec<_>>().join(", "));
        }
    }
    text
}

/// A step of a case, without what comes after it.
pub fn step(text: &mut String, change: &Change) {
    if change.restart {
        let _ = writeln!(text, "[[case.step]]\nmode = \"stop\"\nscan_ms = {STOP_MS}");
    }
    let _ = writeln!(text, "[[case.step]]");
    if change.restart {
        let _ = writeln!(text, "mode = \"run\"");
    }
    if !change.set.is_empty() {
        let _ = writeln!(text, "set = {}", settings(&change.set));
    }
    if !change.buffers.is_empty() {
        let words = change.buffers.iter();
        let words =
            words.map(|(module, address, value)| format!("\"{module}:{address}\" = {value}"));
        let words: Vec<String> = words.collect();
        let _ = writeln!(text, "bfm = {{ {} }}", words.join(", "));
    }
    let _ = writeln!(text, "scans = {}", change.scans);
    let _ = writeln!(text, "scan_ms = {}", change.scan_ms);
}

fn settings(values: &[Setting]) -> String {
    let values = values.iter();
    let values: Vec<_> = values
        .map(|(name, _, value)| (name.clone(), value))
        .collect();
    table(&values)
}

/// Devices and their values, as a table of TOML.
pub fn table(values: &[(String, impl Display)]) -> String {
    let values = values.iter();
    let values: Vec<String> = values
        .map(|(name, value)| match name.contains('.') {
            true => format!("{} = {value}", quoted(name)),
            false => format!("{name} = {value}"),
        })
        .collect();
    format!("{{ {} }}", values.join(", "))
}

/// A text as TOML has it.
pub fn quoted(text: &str) -> String {
    toml::Value::from(text).to_string()
}

/// Runs a test file, which is to stand at this path, on the interpreter: of each case, why it fails, if it does.
///
/// # Errors
///
/// The file cannot be read.
pub fn outcomes(path: &str, text: &str) -> Result<Vec<Option<String>>, String> {
    let file = plctest::parse(path, text).map_err(|error| error.to_string())?;
    let suite = Suite::compile(vec![file], &[]);
    let mut engine = Interpreter::new(suite.modules());
    let report = plctest::run(&suite, &mut engine, &mut |_| ControlFlow::Continue(()));
    let outcomes = report.outcomes.iter();
    Ok(outcomes
        .map(|outcome| {
            let failure = outcome.failure.as_ref()?;
            Some(failure.to_string())
        })
        .collect())
}

#[cfg(test)]
mod tests;
