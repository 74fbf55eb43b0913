//! `xref`: who uses which device.

use super::{Answer, Call, OFFSET, PROGRAM, Tool, anything, list, object, paged, string};
use crate::arguments::{Kind, Parameter};
use crate::page::{self, ENTRIES};
use rungc_syntax::DeviceClass;
use serde_json::{Value, json};

const PARAMETERS: &[Parameter] = &[
    Parameter::optional(
        "devices",
        Kind::Texts,
        "devices, ranges or comments, such as [\"Y000\", \"D100..D199\", \"start button\"]; default: all",
    ),
    Parameter::optional(
        "unused",
        Kind::Flag,
        "list the general devices that no instruction names, instead",
    ),
    OFFSET,
];

pub(super) const TOOL: Tool = Tool {
    name: "xref",
    title: "Who uses a device",
    text: "Lists where devices are read and written: network, step, kind of use and instruction, and areas \
    that overlap. With `unused`, devices that are free. Ask for few devices; long lists come in parts: pass \
    `offset`.",
    parameters: &[PROGRAM, PARAMETERS],
    output,
    writes: false,
    call,
};

fn output() -> Value {
    let mut all = vec![
        ("file", string()),
        ("model", string()),
        ("devices", list(anything())),
        ("overlaps", list(anything())),
        ("unused", list(anything())),
    ];
    all.extend(paged());
    object(&all)
}

/// The ranges of the argument `devices`.
pub(super) fn ranges(
    call: &Call,
    project: &rungc::Project,
) -> Result<Vec<(DeviceClass, u32, u32)>, String> {
    let names = project.names();
    let texts = call.arguments.texts("devices");
    texts.iter().map(|text| names.range(text.trim())).collect()
}

fn call(call: &mut Call) -> Result<Answer, String> {
    let project = call.whole()?;
    let ranges = ranges(call, &project)?;
    let mut table = project.xref(&ranges);
    if table.devices.is_empty() && !ranges.is_empty() {
        return Err("no instruction names these devices".to_owned());
    }
    let wants_unused = call.arguments.flag("unused");
    let offset = call.offset();
    let (total, next);
    if wants_unused {
        table.devices.clear();
        table.overlaps.clear();
        (table.unused, total, next) = page::entries(table.unused, offset, 4 * ENTRIES);
    } else {
        table.unused.clear();
        (table.devices, total, next) = page::entries(table.devices, offset, ENTRIES);
        if offset > 0 || !ranges.is_empty() {
            table.overlaps.clear();
        }
        table.overlaps.truncate(ENTRIES);
    }
    let mut data = serde_json::to_value(&table).map_err(|error| error.to_string())?;
    data["file"] = json!(call.name(&project));
    data["total"] = json!(total);
    data["offset"] = json!(offset);
    if let Some(next) = next {
        data["next_offset"] = json!(next);
    }
    let text = table.text(wants_unused) + &page::remark(next, total, "entries");
    Ok(Answer { text, data })
}
