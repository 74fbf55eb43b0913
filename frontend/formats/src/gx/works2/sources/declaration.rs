//! Declarations of labels, structures and tasks in the notation of IEC 61131-3.

use super::networks::comment;
use super::{Class, Label, LabelDevice, Pou, PouKind, Sources, Structure, Task};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Devices that the compiler chose, by the lower-case names of labels.
pub(super) type Chosen = BTreeMap<String, String>;

/// The sections of a declaration, in the order in which they are written.
const SECTIONS: [Class; 7] = [
    Class::Input,
    Class::Output,
    Class::InOut,
    Class::Var,
    Class::Constant,
    Class::Global,
    Class::GlobalConstant,
];

/// The devices that the compiler chose for whole labels.
pub(super) fn chosen(devices: &[LabelDevice]) -> Chosen {
    let chosen = devices.iter().filter(|one| one.is_chosen);
    chosen
        .map(|one| (one.name.to_lowercase(), one.device.to_string()))
        .collect()
}

/// Sections of labels. Names in `chosen` begin with `path`.
pub(super) fn sections(labels: &[Label], sources: &Sources, path: &str, chosen: &Chosen) -> String {
    let mut out = String::new();
    for class in SECTIONS {
        let of_class = labels.iter().filter(|label| label.class == class);
        let lines: String = of_class
            .map(|label| line(label, sources, path, chosen))
            .collect();
        if !lines.is_empty() {
            let _ = write!(out, "{}\n{lines}END_VAR\n", class.section());
        }
    }
    out
}

fn line(label: &Label, sources: &Sources, path: &str, chosen: &Chosen) -> String {
    let mut line = format!("    {}", label.name);
    if !label.device.is_empty() {
        let _ = write!(line, " AT {}", label.device);
    }
    let members = members(label, sources);
    let stated: Option<Vec<_>> = members
        .iter()
        .map(|(name, device)| Some(format!("{} := {device}", (*name)?)))
        .collect();
    let stated = stated.filter(|all| label.device.is_empty() && !all.is_empty());
    if let Some(all) = &stated {
        let _ = write!(line, " AT ({})", all.join(", "));
    }
    let _ = write!(line, " : {}", label.data_type);
    if !label.initial.is_empty() {
        let _ = write!(line, " := {}", label.initial);
    }
    line.push(';');
    // Structures in an array have no separate names.
    let unnamed = members.iter().filter(|_| stated.is_none());
    let mut remarks: Vec<_> = unnamed
        .map(|(name, device)| format!(".{} AT {device}", name.unwrap_or_default()))
        .collect();
    let name = format!("{path}{}", label.name).to_lowercase();
    if let Some(device) = chosen.get(&name) {
        remarks.push(format!("{device}, chosen by the compiler"));
    }
    if !label.comment.is_empty() {
        remarks.push(label.comment.clone());
    }
    if !remarks.is_empty() {
        let _ = write!(line, " {}", comment(&remarks.join("; ")));
    }
    line.push('\n');
    line
}

/// Devices of a structure's members, with their names where these are known.
fn members<'s>(label: &'s Label, sources: &'s Sources) -> Vec<(Option<&'s str>, &'s str)> {
    let structure = sources.structure(&label.type_name);
    let members = structure.map(Structure::numbered).unwrap_or_default();
    let names = members.iter().map(|member| member.name.as_str());
    let is_known = members.len() == label.members.len() && !label.is_array;
    let names = names.map(|name| Some(name).filter(|_| is_known));
    let names = names.chain(std::iter::repeat(None));
    let places = label.members.iter().zip(names);
    let places = places.filter(|(place, _)| !place.device.is_empty());
    places
        .map(|(place, name)| (name, place.device.as_str()))
        .collect()
}

/// The first lines of a POU, up to its source.
pub(super) fn head(pou: &Pou, sources: &Sources, chosen: &Chosen) -> String {
    let mut out = format!("{} {}", pou.kind.keyword(), pou.name);
    if !pou.return_type.is_empty() {
        let _ = write!(out, " : {}", pou.return_type);
    }
    out.push('\n');
    if let PouKind::Block {
        is_expanded,
        has_enable,
    } = pou.kind
    {
        let call = match is_expanded {
            true => "expanded at each call",
            false => "a subroutine of each instance",
        };
        let enable = if has_enable { ", with EN and ENO" } else { "" };
        let _ = writeln!(out, "{}", comment(&format!("{call}{enable}")));
    }
    out + &sections(&pou.labels, sources, &format!("{}.", pou.name), chosen)
}

/// A structure as a data type.
pub(super) fn structure(structure: &Structure) -> String {
    let mut out = format!("TYPE {} :\nSTRUCT\n", structure.name);
    for member in &structure.members {
        let _ = write!(out, "    {} : {}", member.name, member.data_type);
        if !member.initial.is_empty() {
            let _ = write!(out, " := {}", member.initial);
        }
        out.push(';');
        if !member.comment.is_empty() {
            let _ = write!(out, " {}", comment(&member.comment));
        }
        out.push('\n');
    }
    out + "END_STRUCT\nEND_TYPE\n"
}

/// Tasks, and the programs that they run.
pub(super) fn tasks(tasks: &[Task]) -> String {
    let mut out = "CONFIGURATION Project\n".to_owned();
    for task in tasks {
        let when = match (task.event.as_str(), task.interval.as_str()) {
            ("TRUE", _) => String::new(),
            ("FALSE", interval) => format!("INTERVAL := {interval}, "),
            (event, _) => format!("SINGLE := {event}, "),
        };
        let _ = writeln!(
            out,
            "    TASK {}({when}PRIORITY := {});",
            task.name, task.priority
        );
        for pou in &task.pous {
            let _ = writeln!(out, "    PROGRAM {pou} WITH {} : {pou};", task.name);
        }
    }
    out + "END_CONFIGURATION\n"
}
