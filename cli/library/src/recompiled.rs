//! The source of a GX Works2 project in structured text, compiled again.

use crate::sources::{known, lines, stated_devices};
use rungc_frontend::sources::Sources;
use rungc_models::Model;
use rungc_structured::{Known, compile_with};
use rungc_syntax::{Device, Diagnostics, Program, Source, SourceKind};
use std::collections::BTreeSet;

/// Compiles the files in structured text that `rungc convert --to st` writes of a project, with the devices that the
/// editor chose for labels.
pub fn recompiled(sources: &Sources, model: &'static Model) -> (Program, Diagnostics) {
    compiled(sources, model, &known(sources, ""))
}

/// Compiles them with devices that rungc chooses, as a check of that folder does.
pub fn compiled_anew(sources: &Sources, model: &'static Model) -> (Program, Diagnostics) {
    compiled(sources, model, &Known::new())
}

fn compiled(sources: &Sources, model: &'static Model, known: &Known) -> (Program, Diagnostics) {
    let files = sources.to_st().into_iter();
    let files = files.filter(|file| file.path.ends_with(".st"));
    let files = files.map(|file| {
        let text = String::from_utf8_lossy(&file.contents).into_owned();
        (file.path, text)
    });
    let mut program = Program {
        source: Source::joined("sources", files),
        kind: SourceKind::StructuredText,
        unread: vec![0],
        ..Program::default()
    };
    let found = compile_with(&mut program, model, known);
    (program, found)
}

/// Devices whose values a comparison of a project with its source may expect to be equal: those of labels, and those
/// that the text names.
pub fn declared(sources: &Sources) -> BTreeSet<Device> {
    stated_devices(sources, true)
}

/// Returns true if two programs have the same instructions, up to the numbers of temporaries and jumps and, of relays
/// and registers, of labels for which the compiler chose the device.
pub fn has_same_list(sources: &Sources, one: &Program, other: &Program) -> bool {
    let stated = stated_devices(sources, false);
    lines(&one.instrs, &stated) == lines(&other.instrs, &stated)
}
