//! The cross reference of a program: who uses which device, as `rungc xref` lists it.

use crate::Project;
use rungc_analysis::resolve::{Resolved, resolve};
use rungc_analysis::xref::{CrossReference, Reach, Row, Use};
use rungc_ladder::{Ladder, build};
use rungc_syntax::text::one_line;
use rungc_syntax::{Device, DeviceClass};
use serde::Serialize;
use std::fmt::{self, Write};

/// The cross reference of a program.
#[derive(Debug, Serialize)]
pub struct Table {
    /// The PLC model.
    pub model: &'static str,
    /// The devices, by class and number.
    pub devices: Vec<Entry>,
    /// Areas that share some of their devices, neither within the other.
    pub overlaps: Vec<Overlap>,
    /// General devices that no instruction names: first and last.
    pub unused: Vec<Area>,
}

/// Devices next to each other that the same instructions use.
#[derive(Debug, Serialize)]
pub struct Entry {
    /// First and last.
    #[serde(flatten)]
    pub area: Area,
    /// The comment of the first, or the meaning of a special device.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub comment: String,
    /// Uses, in the order of the program.
    pub uses: Vec<Line>,
}

/// A run of devices.
#[derive(Debug, Serialize)]
pub struct Area {
    /// The first.
    pub first: String,
    /// The last.
    pub last: String,
}

impl Area {
    fn new(first: Device, last: Device) -> Area {
        Area {
            first: first.to_string(),
            last: last.to_string(),
        }
    }
}

impl fmt::Display for Area {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.first)?;
        match self.first == self.last {
            true => Ok(()),
            false => write!(f, "–{}", self.last),
        }
    }
}

/// One use.
#[derive(Clone, Debug, Serialize)]
pub struct Line {
    /// Number of the network, from 1.
    pub network: usize,
    /// Step number of the instruction.
    pub step: u32,
    /// Kind of use.
    #[serde(rename = "use")]
    pub kind: &'static str,
    /// The instruction.
    pub instruction: String,
    /// Range of a use that is known only at run time: `indexed` or `open`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reach: Option<&'static str>,
}

/// Two instructions whose areas overlap.
#[derive(Debug, Serialize)]
pub struct Overlap {
    /// The area that begins first.
    pub first: Line,
    /// The other one.
    pub second: Line,
    /// Devices that they share.
    pub shared: Area,
}

impl Project {
    /// The cross reference: of the devices in these ranges, or of all if there are none.
    pub fn xref(&self, ranges: &[(DeviceClass, u32, u32)]) -> Table {
        let (resolved, _) = resolve(self.source(), self.model());
        Table::new(&resolved, &build::ladder(&resolved), ranges)
    }
}

impl Table {
    /// The cross reference of a program: of the devices in these ranges, or of all if there are none.
    pub fn new(resolved: &Resolved, ladder: &Ladder, ranges: &[(DeviceClass, u32, u32)]) -> Table {
        let xref = CrossReference::new(resolved);
        let line = |i: usize| Line::new(resolved, ladder, &xref.uses[i]);
        let requested = |row: &&Row| {
            ranges.is_empty()
                || ranges.iter().any(|(class, first, last)| {
                    row.first.class == *class
                        && row.first.number <= *last
                        && row.last.number >= *first
                })
        };
        let devices = xref.rows.iter().filter(requested).map(|row| Entry {
            area: Area::new(row.first, row.last),
            comment: comment(resolved, row),
            uses: row.uses.iter().copied().map(line).collect(),
        });
        let overlaps = xref.overlaps().into_iter().map(|(first, second)| Overlap {
            first: line(first),
            second: line(second),
            shared: shared(&xref.uses[first], &xref.uses[second]),
        });
        let unused = xref.unused(resolved.model).into_iter();
        Table {
            model: resolved.model.name,
            devices: devices.collect(),
            overlaps: overlaps.collect(),
            unused: unused.map(|(first, last)| Area::new(first, last)).collect(),
        }
    }

    /// Human-readable: a block for each row, a line for each use.
    pub fn text(&self, unused: bool) -> String {
        let mut out = String::new();
        // Writing to a string does not fail.
        let _ = self.write_text(&mut out, unused);
        out
    }

    fn write_text(&self, out: &mut String, unused: bool) -> fmt::Result {
        for Entry {
            area,
            comment,
            uses,
        } in &self.devices
        {
            writeln!(out, "{}", format!("{area}  {comment}").trim_end())?;
            for line in uses {
                writeln!(out, "    {line}")?;
            }
        }
        if !self.overlaps.is_empty() {
            writeln!(out, "\nAreas that overlap")?;
        }
        for overlap in &self.overlaps {
            writeln!(out, "{}", overlap.shared)?;
            writeln!(out, "    {}\n    {}", overlap.first, overlap.second)?;
        }
        if unused {
            let areas: Vec<_> = self.unused.iter().map(Area::to_string).collect();
            writeln!(out, "\nUnused\n    {}", areas.join(", "))?;
        }
        Ok(())
    }
}

impl Line {
    fn new(resolved: &Resolved, ladder: &Ladder, one: &Use) -> Line {
        Line {
            network: ladder.position(one.instr) + 1,
            step: resolved.instrs[one.instr].step,
            kind: one.kind.word(),
            instruction: resolved.program.instrs[one.instr].to_string(),
            reach: match one.reach {
                Reach::Count(_) => None,
                Reach::Open => Some("open"),
                Reach::Indexed => Some("indexed"),
            },
        }
    }
}

impl fmt::Display for Line {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Line {
            network,
            step,
            kind,
            instruction,
            reach,
        } = self;
        write!(
            f,
            "network {network:<4} step {step:<6} {kind:<8} {instruction}"
        )?;
        match *reach {
            Some("open") => f.write_str("  (as many as the register says)"),
            Some(reach) => write!(f, "  ({reach})"),
            None => Ok(()),
        }
    }
}

/// The comment of a row's first device; of a special device without one, its meaning.
fn comment(resolved: &Resolved, row: &Row) -> String {
    let Device { class, number } = row.first;
    let written = resolved.program.comments.get(&row.first);
    let meaning = || {
        let special = resolved.model.special(class, number)?;
        Some(special.meaning(number))
    };
    let text = written.cloned().or_else(meaning);
    text.map(|text| one_line(&text).into()).unwrap_or_default()
}

/// The devices that two overlapping areas share.
fn shared(first: &Use, second: &Use) -> Area {
    let last = Device {
        number: first.end().min(second.end()) - 1,
        ..second.first
    };
    Area::new(second.first, last)
}
