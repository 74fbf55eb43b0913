//! Resources of emitted C on a Cortex-M4 beside C written by hand, as recorded in `figures.toml`.

use crate::embedded::{self, Level, Measured};
use crate::ladder::{Kind, Ladder};
use crate::problem::{Problem, Result};
use crate::subject::Code;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Length of the programs, in steps.
pub const STEPS: u32 = 1000;

/// The first lines of `figures.toml`.
const HEAD: &str =
    "# Cortex-M4, -Os, programs of 1000 steps. Regenerate with `cargo xtask generate figures`.\n\n";

/// Resources of one implementation.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Record {
    /// Bytes of flash.
    pub flash: u64,
    /// Bytes of RAM.
    pub ram: u64,
    /// Instructions of a scan.
    pub instructions: u64,
}

/// Resources of one program's implementations.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Program {
    /// C written by hand.
    pub hand: Record,
    /// Emitted C.
    pub c: Record,
}

/// The programs by the names of their kinds.
pub type Figures = BTreeMap<String, Program>;

impl Record {
    fn of(figures: &embedded::Figures) -> Self {
        Record {
            flash: figures.flash,
            ram: figures.ram,
            instructions: figures.instructions.unwrap_or_default().round() as u64,
        }
    }
}

/// Measures programs of all kinds.
///
/// # Errors
/// The Arm compiler or QEMU is missing or fails, or the implementations differ.
pub fn measure() -> Result<Figures> {
    Kind::ALL
        .into_iter()
        .map(|kind| Ok((kind.name().to_string(), program(&Ladder::new(kind, STEPS))?)))
        .collect()
}

fn program(ladder: &Ladder) -> Result<Program> {
    let codes = [Code::Hand, Code::C];
    let all = embedded::measure(ladder, &codes, Level::Size, true)?;
    let mut records = Vec::new();
    for Measured { figures, .. } in all {
        records.push(Record::of(&figures?));
    }
    Ok(Program {
        hand: records[0],
        c: records[1],
    })
}

/// The text of `figures.toml`.
///
/// # Errors
/// The figures cannot be written as TOML.
pub fn record(figures: &Figures) -> Result<String> {
    let text = toml::to_string(figures);
    let text = text.map_err(|error| Problem::Wrong(error.to_string()))?;
    Ok(format!("{HEAD}{text}"))
}
