//! The documentation of a machine, for whoever inherits it: what a program has at its terminals, what drives each
//! output, its timers, special devices and instructions, and what is open.

mod page;

use crate::language::Language;
use crate::lists::{Terminal, terminals};
use crate::xref::{Entry, Table};
use crate::{Diagnostic, Program, Project};
use rungc_analysis::resolve::{Resolved, resolve};
use rungc_analysis::xref::CrossReference;
use rungc_catalogue::families;
use rungc_ladder::{Ladder, build};
use rungc_syntax::text::one_line;
use rungc_syntax::{Device, DeviceClass, OperandKind, Severity};
use rungc_verify::request::stated;
use rungc_why::Why;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// What is known of a machine from its program.
#[derive(Debug, Serialize)]
pub struct Document {
    /// Title of the program, else the name of its file.
    pub title: String,
    /// The PLC: `Mitsubishi FX3U`.
    pub plc: &'static str,
    /// Length in steps.
    pub steps: u32,
    /// Number of networks.
    pub networks: usize,
    /// Its terminals, without free ones.
    pub terminals: Vec<Terminal>,
    /// Outputs that the program drives, with what does.
    pub outputs: Vec<Output>,
    /// Timers and counters, in their order.
    pub timers: Vec<Timer>,
    /// Special devices that it uses, with their meaning.
    pub specials: Vec<Entry>,
    /// Kinds of instructions, beside contacts and coils.
    pub instructions: Vec<Instruction>,
    /// Properties of the settings: `never Y000 & Y001`.
    pub properties: Vec<String>,
    /// What a check finds, without notes.
    pub findings: Vec<Diagnostic>,
    /// Terminals that the program uses and that have no comment.
    pub nameless: Vec<String>,
    /// All devices with their uses.
    pub devices: Vec<Entry>,
}

/// An output.
#[derive(Debug, Serialize)]
pub struct Output {
    /// Its name: `Y000`.
    pub name: String,
    /// Its comment.
    pub comment: String,
    /// Numbers of the networks that write it, from 1.
    pub networks: Vec<usize>,
    /// What can switch it, and where that is a single relay, what can switch that, and so forth. Nothing for a program
    /// with errors.
    pub why: Vec<Why>,
}

/// A timer or counter.
#[derive(Debug, Serialize)]
pub struct Timer {
    /// Its name: `T0`.
    pub name: String,
    /// Its comment.
    pub comment: String,
    /// Its presets as the program has them: `K30`, `D100`.
    pub presets: Vec<String>,
    /// The time of a constant preset, in milliseconds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ms: Option<u64>,
    /// Numbers of the networks that drive it, from 1.
    pub networks: Vec<usize>,
}

/// A kind of instruction.
#[derive(Debug, Serialize)]
pub struct Instruction {
    /// Family, as the manuals group them: `Positioning`.
    pub family: &'static str,
    /// Mnemonic: `DRVI`.
    pub mnemonic: &'static str,
    /// Meaning.
    pub title: &'static str,
    /// Numbers of the networks that have it, from 1.
    pub networks: Vec<usize>,
}

impl Project {
    /// What is known of the machine.
    pub fn document(&self) -> Document {
        let (resolved, _) = resolve(self.source(), self.model());
        Document::new(self, &resolved, &build::ladder(&resolved))
    }

    /// The documentation of the machine as a page in HTML: one file that needs nothing else, with the whole ladder.
    pub fn documentation(&self, language: Language) -> String {
        let (resolved, _) = resolve(self.source(), self.model());
        let ladder = build::ladder(&resolved);
        let document = Document::new(self, &resolved, &ladder);
        page::page(&document, &resolved, &ladder, language)
    }
}

impl Document {
    fn new(project: &Project, resolved: &Resolved, ladder: &Ladder) -> Self {
        let is_used = |one: &Terminal| !one.uses.is_empty();
        let all = terminals(resolved, ladder, project.plc().variant, &[]);
        let nameless = all
            .iter()
            .filter(|one| is_used(one) && one.comment.is_empty());
        let nameless = nameless.map(|one| one.terminal.clone()).collect();
        let named = |one: &Terminal| is_used(one) || !one.comment.is_empty();
        let special = [DeviceClass::M, DeviceClass::D].map(|class| (class, SPECIAL, u32::MAX));
        let checked = project.check();
        let program = checked.compile().ok();
        let found = checked.diagnostics.into_iter();
        Document {
            title: title(project, resolved),
            plc: resolved.model.title,
            steps: resolved.steps,
            networks: ladder.networks.len(),
            nameless,
            terminals: all.into_iter().filter(named).collect(),
            outputs: outputs(program.as_ref(), resolved, ladder),
            timers: timers(resolved, ladder),
            specials: Table::new(resolved, ladder, &special).devices,
            instructions: instructions(resolved, ladder),
            properties: properties(project),
            findings: found
                .filter(|found| found.severity != Severity::Note)
                .collect(),
            devices: Table::new(resolved, ladder, &[]).devices,
        }
    }
}

/// The first special relay and register.
const SPECIAL: u32 = 8000;

fn title(project: &Project, resolved: &Resolved) -> String {
    let written = resolved.program.title.as_deref();
    match written.map(str::trim).filter(|title| !title.is_empty()) {
        Some(title) => title.to_owned(),
        None => {
            let name = project.file().file_name().unwrap_or_default();
            name.to_string_lossy().into_owned()
        }
    }
}

/// The comment of a device in one line; empty if it has none.
fn comment(resolved: &Resolved, device: Device) -> String {
    let written = resolved.program.comments.get(&device);
    written.map_or_else(String::new, |text| one_line(text).into())
}

fn outputs(program: Option<&Program>, resolved: &Resolved, ladder: &Ladder) -> Vec<Output> {
    let uses = CrossReference::new(resolved).uses;
    let mut written: BTreeMap<Device, BTreeSet<usize>> = BTreeMap::new();
    for one in uses.iter().filter(|one| one.first.class == DeviceClass::Y) {
        let network = ladder.position(one.instr) + 1;
        let all = (one.first.number..one.end()).map(|number| Device {
            class: DeviceClass::Y,
            number,
        });
        for device in all.filter(|device| one.may_write(*device)) {
            written.entry(device).or_default().insert(network);
        }
    }
    let output = |(device, networks): (Device, BTreeSet<usize>)| Output {
        name: device.to_string(),
        comment: comment(resolved, device),
        networks: networks.into_iter().collect(),
        why: program
            .as_ref()
            .map_or_else(Vec::new, |program| causes(program, resolved, device)),
    };
    written.into_iter().map(output).collect()
}

/// What can switch a device, then what can switch the relay that alone does.
fn causes(program: &Program, resolved: &Resolved, device: Device) -> Vec<Why> {
    /// Relays in a row.
    const MOST: usize = 4;
    let mut all: Vec<Why> = Vec::new();
    let mut next = Some(device.to_string());
    while let Some(name) = next.take()
        && all.len() < MOST
        && all.iter().all(|why| why.device != name)
        && let Ok(why) = program.why(&name)
    {
        if let [only] = &why.writers[..] {
            next = relay(&only.condition, resolved).map(|device| device.to_string());
        }
        all.push(why);
    }
    all
}

/// The relay that is all of a condition: `M38 "down"`.
fn relay(condition: &str, resolved: &Resolved) -> Option<Device> {
    let name = condition.split(' ').next()?;
    let device = Device {
        class: DeviceClass::M,
        number: name.strip_prefix('M')?.parse().ok()?,
    };
    let with_comment = format!("{device} \"{}\"", comment(resolved, device));
    let is_all = condition == name || condition == with_comment;
    (is_all && device.number < SPECIAL).then_some(device)
}

fn timers(resolved: &Resolved, ladder: &Ladder) -> Vec<Timer> {
    let mut timers: BTreeMap<Device, Timer> = BTreeMap::new();
    for (i, instr) in resolved.program.instrs.iter().enumerate() {
        let [first, preset] = &instr.operands[..] else {
            continue;
        };
        let OperandKind::Device(device, None) = first.kind else {
            continue;
        };
        let counts = matches!(device.class, DeviceClass::T | DeviceClass::C);
        if instr.mnemonic != "OUT" || !counts {
            continue;
        }
        let timer = timers.entry(device).or_insert_with(|| Timer {
            name: device.to_string(),
            comment: comment(resolved, device),
            presets: Vec::new(),
            ms: None,
            networks: Vec::new(),
        });
        let written = preset.kind.to_string();
        if !timer.presets.contains(&written) {
            timer.presets.push(written);
        }
        let unit = resolved.model.timer(device.number);
        timer.ms = match (&preset.kind, unit, device.class, timer.presets.len()) {
            (OperandKind::Decimal(value, None), Some(kind), DeviceClass::T, 1) => {
                u64::try_from(*value)
                    .ok()
                    .map(|value| value * u64::from(kind.unit_ms))
            }
            _ => None,
        };
        timer.networks.push(ladder.position(i) + 1);
        timer.networks.dedup();
    }
    timers.into_values().collect()
}

/// Kinds of instructions by family, without contacts, coils and the end.
fn instructions(resolved: &Resolved, ladder: &Ladder) -> Vec<Instruction> {
    const PLAIN: &str = "basic";
    let mut all = Vec::new();
    for family in families().iter().filter(|family| family.name != PLAIN) {
        for row in family.rows {
            let is_it = |i: &usize| {
                let inst = resolved.instrs[*i].inst;
                inst.is_some_and(|inst| std::ptr::eq(inst, row))
            };
            let places = (0..resolved.instrs.len()).filter(is_it);
            let networks: BTreeSet<usize> = places.map(|i| ladder.position(i) + 1).collect();
            if !networks.is_empty() {
                all.push(Instruction {
                    family: family.title,
                    mnemonic: row.name,
                    title: row.title,
                    networks: networks.into_iter().collect(),
                });
            }
        }
    }
    all
}

/// The properties of the settings, if they are about this program and can be read.
fn properties(project: &Project) -> Vec<String> {
    let settings = project.settings();
    let settings = settings.filter(|settings| settings.is_about(project.file()));
    let rows = settings.and_then(|settings| rungc_functions::properties(settings).ok());
    let rows = rows.unwrap_or_default();
    rows.iter().map(|expanded| stated(&expanded.row)).collect()
}

#[cfg(test)]
mod tests {
    use super::relay;
    use crate::language::Language;
    use crate::{Options, Project};
    use rungc_analysis::resolve::resolve;

    /// A hoist: a relay between the buttons and the output, a timer, a counter by a register, positioning.
    const HOIST: &str = ";! X000 = up <button>\n;! Y000 = motor\n;! M0 = \"run\"\nLD X000\nOR M0\nANI X001\nOUT M0\n\
                         LD M0\nOUT Y000\nLD Y000\nOUT T0 K25\nLD T0\nOUT C0 D10\nLD X002\nDRVI K100 K500 Y001 Y002\n\
                         LD M8002\nRST C0\nEND\n";

    fn project(list: &str) -> Project {
        Project::from_list("hoist.il", list, &Options::default()).unwrap()
    }

    #[test]
    fn a_machine_is_documented() {
        let document = serde_json::to_string_pretty(&project(HOIST).document()).unwrap();
        insta::assert_snapshot!(document);
    }

    #[test]
    fn the_page_is_in_the_language_of_its_reader() {
        let project = project(HOIST);
        let english = project.documentation(Language::English);
        let (_, body) = english.split_once("</style>").unwrap();
        insta::assert_snapshot!(body);
        let chinese = project.documentation(Language::Chinese);
        assert!(chinese.contains("<html lang=\"zh-CN\">") && chinese.contains("各输出的驱动条件"));
        let left: Vec<&str> = chinese
            .lines()
            .filter(|line| line.contains("doc-"))
            .collect();
        assert_eq!(left, Vec::<&str>::new());
    }

    #[test]
    fn a_program_with_errors_has_documentation_without_conditions() {
        let page = project("LD X000\nOUT Y000\nOTU Y001\nEND\n").documentation(Language::English);
        assert!(
            page.contains("conditions are not known") && page.contains("OTU"),
            "{page}"
        );
        let empty = project("END\n").documentation(Language::English);
        assert!(empty.contains("drives no output"), "{empty}");
    }

    #[test]
    fn relays_are_conditions_of_one_device() {
        let project = project(HOIST);
        let (resolved, _) = resolve(project.source(), project.model());
        for (condition, expected) in [
            ("M38", Some("M38")),
            ("M0 \"\"run\"\"", Some("M0")),
            ("M0 \"stop\"", None),
            ("M38 and M39", None),
            ("not M38", None),
            ("M8000", None),
            ("X000", None),
        ] {
            let found = relay(condition, &resolved).map(|device| device.to_string());
            assert_eq!(found.as_deref(), expected, "{condition}");
        }
    }
}
