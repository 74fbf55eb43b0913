//! Places at which a program can stop, and where they are in its source.

use rungc::{Location, Program};
use rungc_analysis::resolve::resolve;
use rungc_ladder::build;
use rungc_lower::marks::Mark;
use rungc_syntax::SourceKind;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Number of the listing of a program that is not a text.
pub const LISTING: i64 = 1;

/// The source of a program.
pub struct Places {
    /// Name of the listing, if the program is not a text.
    listing: Option<String>,
    /// The files of its text.
    files: Vec<PathBuf>,
    /// By instruction.
    instrs: Vec<Place>,
    /// Instructions at which a scan can stop, as the observed program numbers its networks.
    marks: Vec<usize>,
    /// The same, in the order of the program.
    stops: BTreeSet<usize>,
}

/// An instruction.
struct Place {
    file: usize,
    line: u32,
    step: u32,
    /// Number of the network, from 1.
    network: usize,
    text: String,
}

impl Places {
    /// The places of a program.
    pub fn of(program: &Program) -> Self {
        let project = program.project();
        let source = project.source();
        let (resolved, _) = resolve(source, project.model());
        let steps: Vec<u32> = resolved.instrs.iter().map(|instr| instr.step).collect();
        let ladder = build::ladder(&resolved);
        let mut networks = vec![0; source.instrs.len()];
        for (number, network) in (1..).zip(&ladder.networks) {
            for instr in network.instrs.clone() {
                networks[instr] = number;
            }
        }
        let is_text = source.kind.is_text() || source.kind == SourceKind::Csv;
        let mut files: Vec<PathBuf> = vec![absolute(project.file())];
        let mut instrs = Vec::with_capacity(source.instrs.len());
        for (i, instr) in source.instrs.iter().enumerate() {
            let location = Location::of(source, &steps, instr.span);
            let path = location.file.map(|file| absolute(Path::new(&file)));
            let file = path.map_or(0, |path| {
                let known = files.iter().position(|file| *file == path);
                known.unwrap_or_else(|| {
                    files.push(path);
                    files.len() - 1
                })
            });
            instrs.push(Place {
                file,
                line: source.source.line(instr.span.start),
                step: instr.step.unwrap_or(steps[i]),
                network: networks[i],
                text: instr.to_string(),
            });
        }
        let marks = program.marks().places.iter().map(|mark| match mark {
            Mark::Network(instr) | Mark::Output { instr, .. } => *instr as usize,
        });
        let marks: Vec<usize> = marks.collect();
        Places {
            listing: (!is_text).then(|| source.source.text.clone()),
            files,
            instrs,
            stops: marks.iter().copied().collect(),
            marks,
        }
    }

    /// Instructions by the numbers of observed networks.
    pub fn marks(&self) -> &[usize] {
        &self.marks
    }

    /// The listing of a program that is not a text.
    pub fn listing(&self) -> Option<&str> {
        self.listing.as_deref()
    }

    /// The 1-based line of an instruction; 1 if there is none.
    pub fn line(&self, instr: usize) -> u32 {
        self.instrs.get(instr).map_or(1, |place| place.line)
    }

    /// Source of an instruction, as the protocol describes it.
    pub fn source(&self, instr: usize) -> Value {
        let place = self.instrs.get(instr);
        let path = &self.files[place.map_or(0, |place| place.file)];
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        match &self.listing {
            None => json!({ "name": name, "path": path.to_string_lossy() }),
            Some(_) => json!({
                "name": format!("{name} (instruction list)"),
                "sourceReference": LISTING,
            }),
        }
    }

    /// An instruction with its place, as the name of a frame.
    pub fn title(&self, instr: usize) -> String {
        match self.instrs.get(instr) {
            Some(Place {
                text,
                step,
                network,
                ..
            }) => {
                format!("{text} · network {network} · step {step}")
            }
            None => "the program has no instructions".to_owned(),
        }
    }

    /// The instruction at a step.
    pub fn at_step(&self, step: u32) -> Option<usize> {
        self.instrs.iter().position(|place| place.step == step)
    }

    /// The instruction at which the scan stops for a line: the first on it, or after it in the same file.
    ///
    /// # Errors
    /// The reason why there is none.
    pub fn stop(&self, source: &Source, line: i64) -> Result<usize, String> {
        let file = self.file(source)?;
        let mut stops = self.stops.iter().copied();
        let is_there = |&instr: &usize| {
            let place = &self.instrs[instr];
            place.file == file && i64::from(place.line) >= line
        };
        // Instructions of a file are in the order of its lines.
        stops
            .find(is_there)
            .ok_or_else(|| "no instruction is executed on this line or after it".to_owned())
    }

    /// Lines of a source, from one to another, at which the scan can stop.
    ///
    /// # Errors
    /// A source that is not that of the program.
    pub fn lines(&self, source: &Source, first: i64, last: i64) -> Result<BTreeSet<u32>, String> {
        let file = self.file(source)?;
        let stops = self.stops.iter().map(|&instr| &self.instrs[instr]);
        let stops = stops
            .filter(|place| place.file == file)
            .map(|place| place.line);
        Ok(stops
            .filter(|&line| (first..=last).contains(&line.into()))
            .collect())
    }

    fn file(&self, source: &Source) -> Result<usize, String> {
        let other = || "this file is not part of the program that runs".to_owned();
        match (source, &self.listing) {
            (Source::Listing, Some(_)) => Ok(0),
            (Source::Listing, None) => Err("there is no such listing".to_owned()),
            (Source::File(path), None) => {
                let found = self.files.iter().position(|file| same(file, path));
                found.ok_or_else(other)
            }
            (Source::File(path), Some(_)) if same(&self.files[0], path) => {
                Err("this file is not a text: set breakpoints in its instruction list, which opens when the \
                     program stops"
                    .to_owned())
            }
            (Source::File(_), Some(_)) => Err(other()),
        }
    }
}

/// A source of breakpoints.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Source {
    /// A file.
    File(PathBuf),
    /// The listing.
    Listing,
}

fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

/// Returns true for two paths of one file.
fn same(one: &Path, other: &Path) -> bool {
    let real = |path: &Path| path.canonicalize().unwrap_or_else(|_| absolute(path));
    one == other || real(one) == real(other)
}
