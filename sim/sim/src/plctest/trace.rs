//! Traces: what devices hold after each scan of a case, compared with a run that was accepted.

use super::format::Reader;
use super::runner::Running;
use super::{Failure, Setting, Value};
use crate::target::Target;
use rungc_ir::fnv1a;
use rungc_syntax::inputs;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use toml::Spanned;

/// The folder of traces, beside the test file.
const FOLDER: &str = "traces";

/// Lines of context around the first line in which two traces differ.
const CONTEXT: usize = 3;

/// Comparison of a case with an accepted run.
#[derive(Clone, PartialEq, Debug)]
pub struct Trace {
    /// The devices, with the PLC of each.
    pub devices: Vec<(usize, Target)>,
    /// Path of the accepted run.
    pub path: PathBuf,
    /// The accepted run; `None` if there is none.
    pub accepted: Option<String>,
}

impl Trace {
    /// Path of a run that differs from the accepted one.
    pub fn pending(&self) -> PathBuf {
        self.path.with_extension("trace.new")
    }
}

/// Largest part of a case's or a test file's name in the name of its trace, in bytes; systems take 255 in all.
const LONGEST: usize = 80;

/// A name for a file, of the characters that every system takes. A name with other characters, or a longer one, ends in
/// its hash, so that names do not share a file.
fn file_name(name: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_');
    let mut end = name.len().min(LONGEST);
    while !name.is_char_boundary(end) {
        end -= 1;
    }
    let file = name[..end].replace(|c| !plain(c), "_");
    if end == name.len() && name.chars().all(plain) {
        return file;
    }
    format!("{file}-{:08x}", fnv1a(name))
}

impl Reader<'_> {
    /// Trace of a case.
    pub(super) fn trace(&mut self, case: &str, names: &[Spanned<String>]) -> Option<Trace> {
        let mut devices = Vec::new();
        for name in names {
            match self.target(name) {
                Some((_, Target::Text(..))) => {
                    let message = "a text cannot be traced; name its words".to_string();
                    self.report(name.span().start, message);
                }
                found => devices.extend(found),
            }
        }
        if devices.is_empty() {
            return None;
        }
        let file = Path::new(self.file_name());
        let stem = file.file_name().unwrap_or_default().to_string_lossy();
        let stem = stem.strip_suffix(".plctest.toml").unwrap_or(&stem);
        let name = format!("{}.{}.trace", file_name(stem), file_name(case));
        let path = file.with_file_name(FOLDER).join(name);
        self.inputs.insert(path.clone());
        Some(Trace {
            devices,
            accepted: inputs::admit(&path)
                .and_then(|()| std::fs::read_to_string(&path))
                .ok(),
            path,
        })
    }
}

/// A trace while it grows.
pub(super) struct Tracer<'c> {
    trace: &'c Trace,
    text: String,
    last: Vec<Option<Value>>,
}

impl<'c> Tracer<'c> {
    pub(super) fn new(trace: &'c Trace) -> Self {
        Tracer {
            text: String::new(),
            last: vec![None; trace.devices.len()],
            trace,
        }
    }

    /// A step begins.
    pub(super) fn begin(&mut self, step: usize) {
        let _ = writeln!(self.text, "step {step}");
    }

    /// A scan is over: what has changed is a line.
    pub(super) fn scanned(&mut self, running: &mut Running) -> Result<(), Failure> {
        let mut line = String::new();
        for (i, &(plc, target)) in self.trace.devices.iter().enumerate() {
            let setting = Setting {
                plc,
                target,
                value: Value::Int(0),
                tolerance: None,
            };
            let value = running.current(&setting)?;
            if self.last[i].as_ref() != Some(&value) {
                let _ = write!(line, "  {} {value}", running.name_of(plc, target));
                self.last[i] = Some(value);
            }
        }
        if !line.is_empty() {
            let _ = writeln!(self.text, "{:>8} ms{line}", running.now_ms());
        }
        Ok(())
    }

    /// The case is over.
    pub(super) fn end(self) -> Result<(), Failure> {
        let Some(accepted) = &self.trace.accepted else {
            return Err(Failure::Trace {
                message: "this run has no accepted trace; review it with `rungc test --review`"
                    .to_string(),
                actual: self.text,
            });
        };
        // Git may have changed the ends of lines.
        let same = accepted.lines().eq(self.text.lines());
        match same {
            true => Ok(()),
            false => Err(Failure::Trace {
                message: format!(
                    "the trace differs from the accepted one\n{}",
                    difference(accepted, &self.text)
                ),
                actual: self.text,
            }),
        }
    }
}

/// First difference between two traces, with a few lines before it.
pub(super) fn difference(accepted: &str, actual: &str) -> String {
    let (old, new): (Vec<&str>, Vec<&str>) = (accepted.lines().collect(), actual.lines().collect());
    let same = old.iter().zip(&new).take_while(|(a, b)| a == b).count();
    let mut text = String::new();
    for line in &old[same.saturating_sub(CONTEXT)..same] {
        let _ = writeln!(text, "      {line}");
    }
    for (sign, lines) in [('-', &old), ('+', &new)] {
        for line in lines[same..].iter().take(CONTEXT) {
            let _ = writeln!(text, "    {sign} {line}");
        }
    }
    text.trim_end().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_do_not_share_a_file() {
        assert_eq!(file_name("stops_at_the_limit"), "stops_at_the_limit");
        let long = "电".repeat(300);
        let longer = format!("{long}!");
        let names = ["a b", "a_b", "a.b", "a/b", &long, &longer];
        let files = names.map(file_name);
        let distinct: std::collections::BTreeSet<_> = files.iter().collect();
        assert_eq!(distinct.len(), names.len(), "{files:?}");
        assert!(files.iter().all(|file| file.len() < 100), "{files:?}");
    }
}
