//! Report of the findings, as text.

use super::{Searched, Shown, What};
use crate::commands::counted;
use crate::commands::verify::report::write_story;
use rungc_explore::Report;
use rungc_explore::trains::At;
use rungc_syntax::DeviceClass;
use rungc_verify::replay::Setting;
use std::fmt::Write;

impl Searched<'_> {
    /// Description of a finding, as a sentence.
    pub fn sentence(&self, what: &What) -> String {
        let instruction = |step: u32| match self.module.origin(step) {
            Some(origin) => format!("`{}` (step {step})", origin.text),
            None => format!("the instruction at step {step}"),
        };
        let output = |n: u32| DeviceClass::Y.number(n);
        match what {
            What::Property(number) => format!("`{}` is violated", self.requested[*number].text),
            What::Error { code, step } => {
                format!("{} meets operation error {code}", instruction(*step))
            }
            What::Watchdog { step } => {
                format!("a scan does not end; the watchdog stops it at step {step}")
            }
            What::Doubled(n) => {
                format!("one coil of `{}` is on, and a later one is off", output(*n))
            }
            What::Oscillation(n) => {
                format!("`{}` changes in every scan while no input does", output(*n))
            }
            What::Collision(axis) => format!("the axis {axis} runs into the end of its travel"),
        }
    }

    /// A word for it.
    fn word(&self, what: &What) -> &'static str {
        match what {
            What::Property(number) if self.requested[*number].property.is_wanted() => "reached",
            What::Property(_) => "violated",
            What::Error { .. } => "error",
            What::Watchdog { .. } => "watchdog",
            What::Doubled(_) => "two coils",
            What::Oscillation(_) => "restless",
            What::Collision(_) => "collision",
        }
    }

    /// All of it, with the runs, and how far the search went.
    pub fn human(&self, shown: &[Shown], report: &Report) -> String {
        let mut text = String::new();
        for shown in shown {
            let what = &shown.found.what;
            let title = match what {
                What::Property(number) => self.requested[*number].text.clone(),
                what => self.sentence(what),
            };
            let _ = writeln!(text, "{:<11} {title}", self.word(what));
            let steps = shown.story.iter().zip(&shown.power).zip(&shown.pulses);
            for ((change, cycles), pulses) in steps {
                if *cycles {
                    text.push_str("            power off and on\n");
                }
                let mut change = change.clone();
                change.set.extend(pulses.iter().map(named));
                write_story(&mut text, self.module, &[change]);
            }
        }
        for (number, requested) in self.requested.iter().enumerate() {
            let is_it = |shown: &Shown| shown.found.what == What::Property(number);
            if !shown.iter().any(is_it) {
                let _ = writeln!(text, "{:<11} {}", "not found", requested.text);
            }
        }
        let (taken, all) = report.branches;
        let scans = counted(report.scans as usize, "scan");
        let moments = counted(report.moments, "new moment");
        let _ = writeln!(
            text,
            "Searched {scans} (seed {}): {moments}, {taken} of {all} branches taken.",
            self.args.seed
        );
        match shown.is_empty() {
            true => {
                let _ = writeln!(
                    text,
                    "Nothing was found. That proves nothing: `rungc verify` proves properties."
                );
            }
            false => {
                let _ = writeln!(text, "Each run was replayed on {}.", self.replayed());
            }
        }
        text
    }
}

/// Pulses as reports have them, beside what is set: `pulses at X000 = 100`.
fn named(&(at, count): &(At, i32)) -> Setting {
    let x = |n: u32| DeviceClass::X.number(n);
    let (name, first) = match at {
        At::Input(n) => (format!("pulses at {}", x(n)), n),
        At::Encoder(a, b) => (format!("cycles of {} and {}", x(a), x(b)), a),
    };
    (name, (DeviceClass::X, first), i64::from(count).into())
}
