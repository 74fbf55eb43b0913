//! Answers as text: the answer first, then the way to it.

use crate::answer::{Action, Cause, How, Link, Place, Reason, Why, Writer};
use std::fmt::{self, Write as _};

/// Number of sets that the text lists of one cause.
const MOST_SETS: usize = 4;

impl fmt::Display for Why {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text())
    }
}

/// A name with its comment.
fn named(device: &str, comment: Option<&str>) -> String {
    match comment {
        Some(comment) => format!("{device} \"{comment}\""),
        None => device.to_string(),
    }
}

/// `500 ms`, `1.2 s`.
fn time(ms: u64) -> String {
    match ms < 1000 {
        true => format!("{ms} ms"),
        false => format!("{} s", ms as f64 / 1000.0),
    }
}

fn list(texts: &[String]) -> String {
    match texts {
        [] => String::new(),
        [one] => one.clone(),
        [others @ .., last] => format!("{} and {last}", others.join(", ")),
    }
}

impl Why {
    /// The answer as text.
    pub fn text(&self) -> String {
        let mut out = String::new();
        self.headline(&mut out);
        for note in &self.notes {
            let _ = writeln!(out, "{note}");
        }
        let (asked, others) = self.causes.split_at(self.causes.len().min(1));
        let has_more = |cause: &&Cause| !cause.sets.is_empty() || !cause.notes.is_empty();
        for cause in asked.iter().chain(others.iter().filter(has_more)) {
            out.push('\n');
            cause.write(&mut out);
        }
        let is_followed = |cause: &Cause| !cause.sets.is_empty() || cause.reason == Reason::Written;
        if !asked.first().is_some_and(is_followed) && !self.writers.is_empty() {
            out.push('\n');
            for writer in &self.writers {
                writer.write(&mut out);
            }
        }
        if let Some(how) = &self.how {
            let name = named(&self.device, self.comment.as_deref());
            out.push('\n');
            how.write(&name, &mut out);
        }
        out
    }

    fn headline(&self, out: &mut String) {
        let name = named(&self.device, self.comment.as_deref());
        let Some(moment) = &self.moment else {
            let _ = match self.writers.len() {
                0 => Ok(()),
                1 => writeln!(out, "{name} is written by one instruction."),
                count => writeln!(out, "{name} is written by {count} instructions."),
            };
            return;
        };
        let _ = write!(out, "{name} is {}", moment.value);
        let _ = match moment.ms {
            Some(ms) => write!(out, " at {}", time(ms)),
            None => write!(out, " in the PLC"),
        };
        if let Some(since) = self.causes.first().and_then(|cause| cause.since.as_ref()) {
            let _ = write!(out, ", since {} (scan {})", time(since.ms), since.scan);
            if !since.with.is_empty() {
                let _ = write!(out, ", when {}", list(&since.with));
            }
        }
        // What the PLC drives has no reason but itself.
        let itself = format!("{name} is {}", moment.value);
        let mut because: Vec<String> = Vec::new();
        for link in &self.because {
            if link.now != itself && !because.contains(&link.now) {
                because.push(link.now.clone());
            }
        }
        let _ = match because.is_empty() {
            true => writeln!(out, "."),
            false => writeln!(out, ",\nbecause {}.", list(&because)),
        };
        if let Some(next) = &moment.next {
            let _ = writeln!(out, "The next scan switches it {next}.");
        }
        if !moment.running {
            let _ = writeln!(out, "The PLC is in STOP: no instruction is executed.");
        }
    }
}

impl How {
    fn write(&self, name: &str, out: &mut String) {
        let (wanted, comes) = match (self.on, self.pulses) {
            (true, false) => ("come on", "comes on"),
            (false, false) => ("go off", "goes off"),
            (true, true) => ("send pulses or come on", "does"),
            (false, true) => ("send no pulses and go off", "does"),
        };
        if self.found {
            let _ = writeln!(out, "For it to {wanted}:");
            for (n, action) in self.actions.iter().enumerate() {
                let _ = write!(out, "  {}. ", n + 1);
                action.write(out);
            }
            let _ = writeln!(out, "Then {name} {comes}.");
            return;
        }
        if let Some(reason) = self.not_searched {
            let _ = writeln!(
                out,
                "For it to {wanted}, no way was searched for: {reason}."
            );
            return;
        }
        let _ = writeln!(
            out,
            "No way for it to {wanted} was found, in {} states that these lead to, with waits of up to {}: {}.",
            self.moments,
            time(self.longest_wait_ms),
            list(&self.levers)
        );
        if self.left_out > 0 {
            let _ = writeln!(
                out,
                "Not tried: {} devices that are farther away.",
                self.left_out
            );
        } else if !self.is_whole {
            let _ = writeln!(out, "There are more states: the search has a limit.");
        }
    }
}

impl Action {
    fn write(&self, out: &mut String) {
        let name = self
            .device
            .as_deref()
            .map(|device| named(device, self.comment.as_deref()));
        let takes = time(self.takes_ms);
        let text = match (name, self.value.as_deref(), self.times) {
            (None, ..) => format!("wait {takes}"),
            (Some(name), Some(state @ ("on" | "off")), _) => format!("{name} {state}"),
            (Some(name), Some(value), _) => format!("{name} = {value}"),
            (Some(name), None, None | Some(1)) => format!("{name} on, and off again"),
            (Some(name), None, Some(times)) => format!("{name} on, and off again: {times} times"),
        };
        let _ = match self.then.is_empty() {
            true => writeln!(out, "{text}"),
            false => writeln!(out, "{text}: {}", list(&self.then)),
        };
    }
}

impl Writer {
    fn write(&self, out: &mut String) {
        let _ = writeln!(out, "{}", at(&self.place));
        let _ = writeln!(out, "  driven: {}", self.condition);
        if let Some(path) = &self.executed_if {
            let _ = writeln!(out, "  executed: {path}");
        }
        for note in &self.notes {
            let _ = writeln!(out, "  {note}");
        }
    }
}

fn at(place: &Place) -> String {
    let Place {
        step,
        network,
        instruction,
    } = place;
    format!("{instruction}  (network {network}, step {step})")
}

impl Cause {
    fn write(&self, out: &mut String) {
        let name = named(&self.device, self.comment.as_deref());
        let state = match (self.reason, self.on) {
            (Reason::Drive, true) => "driven",
            (Reason::Drive, false) => "not driven",
            (_, true) => "on",
            (_, false) => "off",
        };
        let _ = match (self.reason, &self.at) {
            (Reason::Drive, Some(place)) => writeln!(out, "{} is {state}.", at(place)),
            (Reason::Written, Some(place)) => {
                writeln!(out, "{name} is {state}: {}.", at(place))
            }
            (Reason::Input, _) => writeln!(out, "{name} is {state}: an input."),
            (Reason::Special, _) => writeln!(out, "{name} is {state}: the PLC drives it."),
            (Reason::Unwritten, _) => {
                writeln!(out, "{name} is {state}: no instruction writes it.")
            }
            (Reason::Forced, _) => writeln!(out, "{name} is {state}: it is forced."),
            (Reason::NotDriven, Some(place)) => {
                writeln!(out, "{name} stays {state}: {} is not driven.", at(place))
            }
            (Reason::NotExecuted, Some(place)) => {
                writeln!(out, "{name} stays {state}: {} is not executed.", at(place))
            }
            _ => writeln!(
                out,
                "{name} stays {state}: no instruction writes it in this scan."
            ),
        };
        if let Some(progress) = &self.progress {
            let _ = writeln!(out, "  {}", progress.text());
        }
        if self.holds_itself {
            let _ = writeln!(out, "  It holds itself.");
        }
        for note in &self.notes {
            let _ = writeln!(out, "  {note}");
        }
        self.sets(out);
    }

    fn sets(&self, out: &mut String) {
        let needed = |set: &Vec<Link>| {
            let texts: Vec<String> = set.iter().map(|link| link.needed.clone()).collect();
            list(&texts)
        };
        let wanted = match (self.reason, self.on) {
            (Reason::Drive, true) => "not to be driven",
            (Reason::Drive, false) => "to be driven",
            (_, true) => "to go off",
            (_, false) => "to come on",
        };
        match &self.sets[..] {
            [] => {}
            [set] if !self.more => {
                let _ = writeln!(out, "  {wanted}, it needs {}", needed(set));
            }
            sets => {
                let _ = writeln!(out, "  {wanted}, it needs one of");
                for set in sets.iter().take(MOST_SETS) {
                    let _ = writeln!(out, "    {}", needed(set));
                }
                let left = sets.len().saturating_sub(MOST_SETS);
                let _ = match (left, self.more) {
                    (0, false) => Ok(()),
                    (_, true) => writeln!(out, "    or others"),
                    (1, false) => writeln!(out, "    or one more"),
                    (left, false) => writeln!(out, "    or {left} more"),
                };
            }
        }
    }
}
