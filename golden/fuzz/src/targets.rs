//! The fuzz targets.

mod decoders;
mod lines;
mod memories;
mod readers;
mod servers;
mod texts;

use crate::partner;

/// Reads an input, and panics if something is wrong.
type Run = dyn Fn(&[u8]);

/// A function on bytes that panics if something is wrong.
pub struct Target {
    /// Its name, which is also that of its folder in `corpus/`.
    pub name: &'static str,
    /// The function.
    pub run: Box<Run>,
    /// Inputs to begin with, beside its corpus.
    pub seeds: Vec<Vec<u8>>,
}

/// All targets.
pub fn all() -> Vec<Target> {
    let lines = partner::all().map(lines::target);
    lines
        .chain(servers::targets())
        .chain(decoders::targets())
        .chain(readers::targets())
        .chain(texts::targets())
        .chain(memories::targets())
        .collect()
}

/// The target of this name.
pub fn find(name: &str) -> Option<Target> {
    all().into_iter().find(|target| target.name == name)
}
