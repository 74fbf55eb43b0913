//! What is known of a device, as Markdown.

use super::{Index, Occurrence, class_title};
use rungc_analysis::latches;
use rungc_models::runs::{is_counter32, is_special};
use rungc_models::special::{self, Special};
use rungc_syntax::{Device, DeviceClass};
use std::fmt::Write;

/// Lines of uses that are listed.
const MOST_USES: usize = 12;

/// Access, status and value at power-on of a special device, and its meaning.
pub fn describe(special: &Special, number: u32) -> String {
    let access = match special.access {
        special::Access::Read => "written by the PLC, read-only for programs".to_string(),
        special::Access::ReadWrite => "programs may write it".to_string(),
        special::Access::ReadUnless(role) => format!(
            "written by the PLC; by programs only while COM{} is {}",
            role.port, role.title
        ),
    };
    let status = match special.status {
        special::Status::Scan => "updated by the scan".to_string(),
        special::Status::Instructions(names) => format!("used by {names}"),
        special::Status::Modules(_) | special::Status::Module(_) => {
            "exchanged with the special modules that `[[module]]` in rungc.toml lists".to_string()
        }
        special::Status::Inert(reason) => format!("not simulated: {}", reason.text),
    };
    let default = if special.default == 0 {
        String::new()
    } else {
        format!("; starts at {}", special.default)
    };
    format!(
        "{}\n    {access}; {status}{default}",
        special.meaning(number)
    )
}

impl Index {
    /// A device for a reader: its comment, its kind on the program's PLC, its meaning if it is special, and its uses.
    pub fn facts(&self, device: Device) -> String {
        let mut text = format!("**{device}**");
        if let Some(comment) = self.comment(device) {
            let _ = write!(text, " {comment}");
        }
        let _ = writeln!(text, "\n\n{}", self.kind(device));
        if let Some(special) = self.model().special(device.class, device.number) {
            let described = describe(special, device.number);
            let lines = described.lines().map(str::trim);
            let _ = writeln!(text, "\n{}", lines.collect::<Vec<_>>().join("  \n"));
        }
        let all = self.occurrences(device);
        let titles = match device.class {
            DeviceClass::P | DeviceClass::I => [("label", true), ("jumps and calls", false)],
            _ => [("written", true), ("read", false)],
        };
        for (title, is_write) in titles {
            let uses = all
                .iter()
                .filter(|one| one.kind.is_some() && one.is_write() == is_write);
            let uses: Vec<_> = uses.collect();
            self.list(&mut text, title, &uses);
        }
        text
    }

    /// Kind of a device on the program's PLC, in a line.
    fn kind(&self, device: Device) -> String {
        let Device { class, number } = device;
        let (model, plc) = (self.model(), self.project().plc());
        let special = match is_special(class, number) {
            true => "special ",
            false => "",
        };
        let mut text = format!("{special}{}", class_title(class));
        if let (DeviceClass::T, Some(timer)) = (class, model.timer(number)) {
            let _ = write!(text, " of {} ms", timer.unit_ms);
            if timer.accumulating {
                text += ", accumulating";
            }
        }
        if class == DeviceClass::C {
            text += match is_counter32(class, number) {
                true => " of 32 bits",
                false => " of 16 bits",
            };
        }
        let ranges = latches::ranges(self.program(), model);
        let range = ranges
            .iter()
            .find(|range| range.class == class && (range.first..=range.last).contains(&number));
        let Some(range) = range else {
            return format!("{text}; {} does not have it", plc.title());
        };
        if range.latched {
            text += ", latched";
        }
        let (first, last) = (class.number(range.first), class.number(range.last));
        format!("{text}; {} has {first} to {last} of this kind", plc.title())
    }

    /// Lists uses by their lines.
    fn list(&self, text: &mut String, title: &str, uses: &[&Occurrence]) {
        if uses.is_empty() {
            return;
        }
        let _ = writeln!(text, "\n{title}:\n");
        let program = self.program();
        for one in uses.iter().take(MOST_USES) {
            let line = program.source.line(one.span.start);
            let instr = one.instr.and_then(|i| program.instrs.get(i));
            let instr = instr.map(ToString::to_string).unwrap_or_default();
            let _ = writeln!(text, "- line {line}: `{instr}`");
        }
        if uses.len() > MOST_USES {
            let _ = writeln!(text, "- and {} more", uses.len() - MOST_USES);
        }
    }
}
