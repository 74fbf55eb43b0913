//! Runs that were found as a test file.

use super::{Searched, Shown, What, relative_to};
use rungc_explore::trains::{At, hertz};
use rungc_syntax::DeviceClass;
use rungc_verify::replay::Change;
use rungc_verify::written::{Names, quoted, step, table};
use std::fmt::Write;
use std::path::Path;

impl Searched<'_> {
    /// The test file of these runs, as it stands at this path. Its cases fail; that of what `--reachable` has found
    /// passes.
    pub fn test_file(&self, path: &Path, shown: &[Shown]) -> String {
        let mut text = String::new();
        let named = |to: &Path| quoted(&relative_to(path, to).to_string_lossy());
        let program = named(&self.subject.file);
        let _ = writeln!(text, "topic = \"runs that rungc explore has found\"");
        let _ = writeln!(text, "model = {}", quoted(self.module.model.name));
        let _ = writeln!(text, "program = {{ file = {program} }}");
        if let Some(machine) = &self.args.machine {
            let _ = writeln!(text, "machine = {}", named(machine));
        }
        let mut names = Names::default();
        for shown in shown {
            let name = names.name(&self.title(&shown.found.what));
            self.case(&mut text, &name, shown);
        }
        text
    }

    fn case(&self, text: &mut String, name: &str, shown: &Shown) {
        let expected = self.expected(shown);
        let _ = writeln!(text, "\n[[case]]\nname = {}", quoted(name));
        for rule in &expected.rules {
            let _ = writeln!(text, "{rule}");
        }
        let mut story = shown.story.clone();
        let scan_ms = story.last().map_or(10, |last| last.scan_ms);
        if expected.one_more {
            story.push(Change {
                start: Vec::new(),
                first: 0,
                scans: 1,
                at_ms: 0,
                restart: false,
                scan_ms,
                set: Vec::new(),
                buffers: Vec::new(),
                after: Vec::new(),
            });
        }
        let last = story.len().saturating_sub(1);
        for (i, change) in story.iter().enumerate() {
            step(text, change);
            if i == last && !expected.at_end.is_empty() {
                let _ = writeln!(text, "expect = {}", table(&expected.at_end));
            }
            let trains = shown.pulses.get(i).map_or(&[][..], Vec::as_slice);
            pulses(text, trains, change.scan_ms);
            if shown.power.get(i) == Some(&true) {
                text.push_str("power_cycle = true\n");
            }
        }
    }

    /// Short description of a finding: a name for its test.
    pub fn title(&self, what: &What) -> String {
        let output = |n: u32| DeviceClass::Y.number(n);
        match what {
            What::Property(number) => self.requested[*number].text.clone(),
            What::Error { code, step } => format!("operation error {code} at step {step}"),
            What::Watchdog { step } => format!("watchdog at step {step}"),
            What::Doubled(n) => format!("{} driven by two coils", output(*n)),
            What::Oscillation(n) => format!("{} comes to rest", output(*n)),
            What::Collision(axis) => format!("{axis} at the end of its travel"),
        }
    }
}

/// The pulses of a step.
fn pulses(text: &mut String, trains: &[(At, i32)], scan_ms: u32) {
    let x = |n: u32| DeviceClass::X.number(n);
    let mut inputs = Vec::new();
    for &(at, count) in trains {
        let hz = hertz(count, scan_ms);
        match at {
            At::Input(n) => inputs.push(format!("{} = {{ count = {count}, hz = {hz} }}", x(n))),
            At::Encoder(a, b) => {
                let (a, b) = (x(a), x(b));
                let _ = writeln!(
                    text,
                    "encoder = {{ a = \"{a}\", b = \"{b}\", count = {count}, hz = {hz} }}"
                );
            }
        }
    }
    if !inputs.is_empty() {
        let _ = writeln!(text, "pulses = {{ {} }}", inputs.join(", "));
    }
}
