//! Lists for those who wire and connect a PLC: its terminals, and its devices as tags of a SCADA system.

use rungc_analysis::resolve::Resolved;
use rungc_analysis::xref::{CrossReference, Use, UseKind};
use rungc_catalogue::Shape;
use rungc_ladder::Ladder;
use rungc_models::Variant;
use rungc_models::runs::{is_counter32, is_special, rt_class};
use rungc_rt::comm::modbus::Profile;
use rungc_syntax::text::one_line;
use rungc_syntax::{Device, DeviceClass, OperandKind};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet, HashSet};

/// Terminals come in groups of this many.
const GROUP: u32 = 8;

/// An input or output of the PLC.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
pub struct Terminal {
    /// Its device.
    pub terminal: String,
    /// Its comment.
    pub comment: String,
    /// What the program does with it: `contact, coil`; empty for a free one.
    #[serde(rename = "use")]
    pub uses: String,
    /// Numbers of the networks that use it, from 1.
    pub networks: String,
}

/// The terminals of a program in these ranges, or all if there are none: those of a variant that has a fixed number,
/// else those up to the last one that the program uses or comments, in whole groups of eight.
pub fn terminals(
    resolved: &Resolved,
    ladder: &Ladder,
    variant: Option<&Variant>,
    ranges: &[(DeviceClass, u32, u32)],
) -> Vec<Terminal> {
    let uses = CrossReference::new(resolved).uses;
    let comments = &resolved.program.comments;
    let mut terminals = Vec::new();
    for class in [DeviceClass::X, DeviceClass::Y] {
        let named = uses
            .iter()
            .filter(|one| one.first.class == class)
            .map(Use::end);
        let commented = comments.keys().filter(|device| device.class == class);
        let named = named.chain(commented.map(|device| device.number + 1)).max();
        let fixed = variant.and_then(|variant| match class {
            DeviceClass::X => variant.inputs,
            _ => variant.outputs,
        });
        let count = named
            .unwrap_or(0)
            .next_multiple_of(GROUP)
            .max(fixed.unwrap_or(0));
        for number in 0..count {
            let device = Device { class, number };
            if !is_asked(device, ranges) {
                continue;
            }
            let of_it: Vec<_> = uses.iter().filter(|one| one.may_concern(device)).collect();
            let kinds: BTreeSet<_> = of_it.iter().map(|one| one.kind).collect();
            let kinds: Vec<_> = kinds.into_iter().map(UseKind::word).collect();
            let networks: BTreeSet<_> = of_it
                .iter()
                .map(|one| ladder.position(one.instr) + 1)
                .collect();
            let networks: Vec<_> = networks.iter().map(usize::to_string).collect();
            terminals.push(Terminal {
                terminal: device.to_string(),
                comment: comment(resolved, device),
                uses: kinds.join(", "),
                networks: networks.join(", "),
            });
        }
    }
    terminals
}

/// Returns true if a device is in one of the ranges, or there are none.
fn is_asked(device: Device, ranges: &[(DeviceClass, u32, u32)]) -> bool {
    let is_in = |&(class, first, last): &(DeviceClass, u32, u32)| {
        class == device.class && (first..=last).contains(&device.number)
    };
    ranges.is_empty() || ranges.iter().any(is_in)
}

/// A device, or the value of a timer or counter, as a tag.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
pub struct Tag {
    /// Name of letters, digits and `_`, different from all others: from the comment, else the device.
    pub name: String,
    /// Device: `X000`, `T5` for its contact, `T5.value`.
    pub device: String,
    /// Type: `BOOL`, `INT`, `DINT` or `REAL`, by the widest use in the program.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// Table of Modbus that holds it: `coil`, `discrete input`, `holding register` or `input register`; empty if none
    /// does.
    pub modbus_table: &'static str,
    /// Address in frames, from 0; of 32 bits the first of two, the low word.
    pub modbus_address: Option<u16>,
    /// Number of the device in frames of the MC protocol.
    pub mc_number: u32,
    /// `read` if clients cannot write it, else `read and write`.
    pub access: &'static str,
    /// Its comment.
    pub comment: String,
}

/// The tags of a program: devices that it names or comments, without special ones, in these ranges or all if there are
/// none.
pub fn tags(resolved: &Resolved, ranges: &[(DeviceClass, u32, u32)]) -> Vec<Tag> {
    use DeviceClass::{C, D, M, R, S, T, X, Y};
    let profile = resolved.model.ports.modbus(resolved.model.type_code());
    let kinds = kinds(resolved);
    let uses = CrossReference::new(resolved).uses;
    let named = uses.iter().map(|one| one.first);
    let named = named.chain(resolved.program.comments.keys().copied());
    let devices: BTreeSet<_> = named
        .filter(|device| [X, Y, M, S, T, C, D, R].contains(&device.class))
        .filter(|device| !is_special(device.class, device.number) && is_asked(*device, ranges))
        .collect();
    let mut names = HashSet::new();
    let mut tags = Vec::new();
    for device in devices {
        let is_word = [D, R].contains(&device.class);
        let has_value = [T, C].contains(&device.class);
        if !is_word {
            tags.push(tag(resolved, device, "", "BOOL", profile, &mut names));
        }
        if is_word || has_value {
            let is_wide = device.class == C && is_counter32(C, device.number);
            let kind = match kinds.get(&device) {
                _ if is_wide => "DINT",
                Some(kind) if is_word => kind.name(),
                _ => "INT",
            };
            let view = if has_value { ".value" } else { "" };
            tags.push(tag(resolved, device, view, kind, profile, &mut names));
        }
    }
    tags
}

/// Type of a word, the wider one the greater.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
enum Kind {
    Int,
    Dint,
    Real,
}

impl Kind {
    fn name(self) -> &'static str {
        match self {
            Kind::Int => "INT",
            Kind::Dint => "DINT",
            Kind::Real => "REAL",
        }
    }
}

/// The widest type of each word device that an operand names.
fn kinds(resolved: &Resolved) -> BTreeMap<Device, Kind> {
    let mut kinds = BTreeMap::new();
    for (instr, resolution) in resolved.program.instrs.iter().zip(&resolved.instrs) {
        for (operand, param) in instr.operands.iter().zip(resolution.params) {
            let OperandKind::Device(device, _) = operand.kind else {
                continue;
            };
            let kind = match param.shape {
                Shape::Float => Kind::Real,
                Shape::Pair => Kind::Dint,
                Shape::Value if resolution.form.wide => Kind::Dint,
                _ => Kind::Int,
            };
            let widest = kinds.entry(device).or_insert(kind);
            *widest = kind.max(*widest);
        }
    }
    kinds
}

fn tag(
    resolved: &Resolved,
    device: Device,
    view: &str,
    kind: &'static str,
    profile: &Profile,
    names: &mut HashSet<String>,
) -> Tag {
    let comment = comment(resolved, device);
    let (modbus_table, modbus_address, writable) = match modbus(profile, device, kind == "BOOL") {
        Some((table, address, writable)) => (table, Some(address), writable),
        None => ("", None, true),
    };
    let suffix = if view.is_empty() { "" } else { "_value" };
    Tag {
        name: unique(&identifier(&comment), device, suffix, names),
        device: format!("{device}{view}"),
        kind,
        modbus_table,
        modbus_address,
        mc_number: device.number,
        access: if writable { "read and write" } else { "read" },
        comment,
    }
}

/// A name of a device that no other tag has.
pub(crate) fn unique(
    comment: &str,
    device: Device,
    suffix: &str,
    names: &mut HashSet<String>,
) -> String {
    let mut name = match comment {
        "" => format!("{device}{suffix}"),
        comment => format!("{comment}{suffix}"),
    };
    if names.contains(&name.to_lowercase()) {
        name = format!("{comment}_{device}{suffix}");
    }
    while !names.insert(name.to_lowercase()) {
        name.push('_');
    }
    name
}

/// Table and address of a device, and whether masters may write it.
fn modbus(profile: &Profile, device: Device, is_bit: bool) -> Option<(&'static str, u16, bool)> {
    let class = rt_class(device.class)?;
    let tables = match is_bit {
        true => [
            ("coil", profile.coils, true),
            ("discrete input", profile.inputs, false),
        ],
        false => [
            ("holding register", profile.registers, true),
            ("input register", profile.input_registers, false),
        ],
    };
    tables.into_iter().find_map(|(table, areas, can_write)| {
        let area = areas
            .iter()
            .find_map(|area| Some((area, area.address_of(class, device.number)?)));
        area.map(|(area, address)| (table, address, can_write && area.writable))
    })
}

/// A comment in letters, digits and `_`.
pub(crate) fn identifier(comment: &str) -> String {
    let words = comment
        .split(|c: char| !c.is_alphanumeric())
        .filter(|word| !word.is_empty());
    let name = words.collect::<Vec<_>>().join("_");
    match name.starts_with(|c: char| c.is_numeric()) {
        true => format!("_{name}"),
        false => name,
    }
}

fn comment(resolved: &Resolved, device: Device) -> String {
    let comment = resolved.program.comments.get(&device);
    comment
        .map(|text| one_line(text).into())
        .unwrap_or_default()
}
