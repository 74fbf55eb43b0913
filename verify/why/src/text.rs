//! Answers as text: the answer first, then the way to it.

use crate::answer::{Action, Cause, How, Link, Place, Reason, Since, Why, Writer};
use crate::words::{is, list, on_off};
use rungc_syntax::{Phrase, phrase};
use std::borrow::Cow;
use std::fmt;

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

/// A text in the language of the reader.
pub(crate) type Said<'a> = dyn Fn(&Phrase) -> Cow<'_, str> + 'a;

/// A text of lines in one language.
struct Lines<'a> {
    said: &'a Said<'a>,
    text: String,
}

impl Lines<'_> {
    fn line(&mut self, phrase: &Phrase) {
        self.text.push_str(&(self.said)(phrase));
        self.text.push('\n');
    }

    /// An indented line.
    fn inner(&mut self, phrase: &Phrase) {
        self.text.push_str("  ");
        self.line(phrase);
    }

    fn empty(&mut self) {
        self.text.push('\n');
    }
}

impl Why {
    /// The answer as text, in English.
    pub fn text(&self) -> String {
        self.text_in(&|phrase| Cow::Borrowed(phrase.as_str()))
    }

    /// The answer as text, each sentence as this gives it.
    pub fn text_in(&self, said: &dyn Fn(&Phrase) -> Cow<'_, str>) -> String {
        let mut out = Lines {
            said,
            text: String::new(),
        };
        self.headline(&mut out);
        for note in &self.notes {
            out.line(note);
        }
        let (asked, others) = self.causes.split_at(self.causes.len().min(1));
        let has_more = |cause: &&Cause| !cause.sets.is_empty() || !cause.notes.is_empty();
        for cause in asked.iter().chain(others.iter().filter(has_more)) {
            out.empty();
            cause.write(&mut out);
        }
        let is_followed = |cause: &Cause| !cause.sets.is_empty() || cause.reason == Reason::Written;
        if !asked.first().is_some_and(is_followed) && !self.writers.is_empty() {
            out.empty();
            for writer in &self.writers {
                writer.write(&mut out);
            }
        }
        if let Some(how) = &self.how {
            let name = named(&self.device, self.comment.as_deref());
            out.empty();
            how.write(&name, &mut out);
        }
        out.text
    }

    fn headline(&self, out: &mut Lines) {
        let name = named(&self.device, self.comment.as_deref());
        let Some(moment) = &self.moment else {
            match self.writers.len() {
                0 => {}
                1 => out.line(&phrase!("{name} is written by one instruction.", name)),
                count => out.line(&phrase!(
                    "{name} is written by {count} instructions.",
                    name,
                    count
                )),
            }
            return;
        };
        // What the PLC drives has no reason but itself.
        let itself = is(&name, moment.value.clone());
        let mut because: Vec<Phrase> = Vec::new();
        for link in &self.because {
            if link.now != *itself && !because.contains(&link.now) {
                because.push(link.now.clone());
            }
        }
        let mut state = match moment.ms {
            Some(ms) => phrase!("{state} at {time}", state = itself, time = time(ms)),
            None => phrase!("{state} in the PLC", state = itself),
        };
        if let Some(since) = self.causes.first().and_then(|cause| cause.since.as_ref()) {
            state = since.of(state);
        }
        if because.is_empty() {
            out.line(&phrase!("{state}.", state));
        } else {
            out.line(&phrase!("{state},", state));
            out.line(&phrase!("because {reasons}.", reasons = list(&because)));
        }
        if let Some(next) = &moment.next {
            out.line(&phrase!("The next scan switches it {state}.", state = next));
        }
        if !moment.running {
            out.line(&phrase!("The PLC is in STOP: no instruction is executed."));
        }
    }
}

impl Since {
    /// A state, with the time from which on it has been so.
    fn of(&self, state: Phrase) -> Phrase {
        let (time, scan) = (time(self.ms), self.scan);
        let state = phrase!("{state}, since {time} (scan {scan})", state, time, scan);
        match self.with.is_empty() {
            true => state,
            false => phrase!("{state}, when {changes}", state, changes = list(&self.with)),
        }
    }
}

impl How {
    fn write(&self, name: &str, out: &mut Lines) {
        let (wanted, comes) = match (self.on, self.pulses) {
            (true, false) => (phrase!("come on"), phrase!("Then {name} comes on.", name)),
            (false, false) => (phrase!("go off"), phrase!("Then {name} goes off.", name)),
            (true, true) => (
                phrase!("send pulses or come on"),
                phrase!("Then {name} does.", name),
            ),
            (false, true) => (
                phrase!("send no pulses and go off"),
                phrase!("Then {name} does.", name),
            ),
        };
        if self.found {
            out.line(&phrase!("For it to {change}:", change = wanted));
            for (n, action) in self.actions.iter().enumerate() {
                out.inner(&phrase!(
                    "{number}. {action}",
                    number = n + 1,
                    action = action.phrase()
                ));
            }
            out.line(&comes);
            return;
        }
        if let Some(reason) = &self.not_searched {
            out.line(&phrase!(
                "For it to {change}, no way was searched for: {reason}.",
                change = wanted,
                reason
            ));
            return;
        }
        let levers: Vec<Phrase> = self.levers.iter().map(Phrase::from).collect();
        out.line(&phrase!(
            "No way for it to {change} was found, in {count} states that these lead to, with waits of up to {time}: {devices}.",
            change = wanted,
            count = self.moments,
            time = time(self.longest_wait_ms),
            devices = list(&levers)
        ));
        if self.left_out > 0 {
            let count = self.left_out;
            out.line(&phrase!(
                "Not tried: {count} devices that are farther away.",
                count
            ));
        } else if !self.is_whole {
            out.line(&phrase!("There are more states: the search has a limit."));
        }
    }
}

impl Action {
    fn phrase(&self) -> Phrase {
        let name = self
            .device
            .as_deref()
            .map(|device| named(device, self.comment.as_deref()));
        let action = match (name, &self.value, self.times) {
            (None, ..) => phrase!("wait {time}", time = time(self.takes_ms)),
            (Some(name), Some(state), _) if state == "on" || state == "off" => {
                phrase!("{name} {state}", name, state)
            }
            (Some(name), Some(value), _) => phrase!("{name} = {value}", name, value),
            (Some(name), None, None | Some(1)) => phrase!("{name} on, and off again", name),
            (Some(name), None, Some(times)) => {
                phrase!("{name} on, and off again: {times} times", name, times)
            }
        };
        match self.then.is_empty() {
            true => action,
            false => phrase!("{action}: {changes}", action, changes = list(&self.then)),
        }
    }
}

impl Writer {
    fn write(&self, out: &mut Lines) {
        out.line(&at(&self.place));
        out.inner(&phrase!("driven: {condition}", condition = self.condition));
        if let Some(path) = &self.executed_if {
            out.inner(&phrase!("executed: {condition}", condition = path));
        }
        for note in &self.notes {
            out.inner(note);
        }
    }
}

fn at(place: &Place) -> Phrase {
    let Place {
        step,
        network,
        instruction,
    } = place;
    phrase!(
        "{instruction}  (network {network}, step {step})",
        instruction,
        network,
        step
    )
}

impl Cause {
    fn write(&self, out: &mut Lines) {
        out.line(&self.headline());
        if let Some(progress) = &self.progress {
            out.inner(&progress.text());
        }
        if self.holds_itself {
            out.inner(&phrase!("It holds itself."));
        }
        for note in &self.notes {
            out.inner(note);
        }
        self.sets(out);
    }

    fn headline(&self) -> Phrase {
        let name = named(&self.device, self.comment.as_deref());
        let place = self.at.as_ref().map(at);
        let state = on_off(self.on);
        match (self.reason, place) {
            (Reason::Drive, Some(place)) => match self.on {
                true => phrase!("{place} is driven.", place),
                false => phrase!("{place} is not driven.", place),
            },
            (Reason::Written, Some(place)) => {
                phrase!("{name} is {state}: {place}.", name, state, place)
            }
            (Reason::Input, _) => phrase!("{name} is {state}: an input.", name, state),
            (Reason::Special, _) => phrase!("{name} is {state}: the PLC drives it.", name, state),
            (Reason::Unwritten, _) => {
                phrase!("{name} is {state}: no instruction writes it.", name, state)
            }
            (Reason::Forced, _) => phrase!("{name} is {state}: it is forced.", name, state),
            (Reason::NotDriven, Some(place)) => {
                phrase!(
                    "{name} stays {state}: {place} is not driven.",
                    name,
                    state,
                    place
                )
            }
            (Reason::NotExecuted, Some(place)) => {
                phrase!(
                    "{name} stays {state}: {place} is not executed.",
                    name,
                    state,
                    place
                )
            }
            _ => phrase!(
                "{name} stays {state}: no instruction writes it in this scan.",
                name,
                state
            ),
        }
    }

    fn sets(&self, out: &mut Lines) {
        let needed = |set: &Vec<Link>| {
            let texts: Vec<Phrase> = set.iter().map(|link| link.needed.clone()).collect();
            list(&texts)
        };
        let change = match (self.reason, self.on) {
            (Reason::Drive, true) => phrase!("not to be driven"),
            (Reason::Drive, false) => phrase!("to be driven"),
            (_, true) => phrase!("to go off"),
            (_, false) => phrase!("to come on"),
        };
        match &self.sets[..] {
            [] => {}
            [set] if !self.more => {
                out.inner(&phrase!(
                    "{change}, it needs {needed}",
                    change,
                    needed = needed(set)
                ));
            }
            sets => {
                out.inner(&phrase!("{change}, it needs one of", change));
                for set in sets.iter().take(MOST_SETS) {
                    out.text.push_str("  ");
                    out.inner(&needed(set));
                }
                let left = sets.len().saturating_sub(MOST_SETS);
                let others = match (left, self.more) {
                    (0, false) => return,
                    (_, true) => phrase!("or others"),
                    (1, false) => phrase!("or one more"),
                    (left, false) => phrase!("or {count} more", count = left),
                };
                out.text.push_str("  ");
                out.inner(&others);
            }
        }
    }
}
