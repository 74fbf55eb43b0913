//! What can be written at a place: mnemonics, devices, and the operands of an instruction.

use super::Index;
use rungc_analysis::xref::UseKind;
use rungc_catalogue::{Form, Forms, Inst, Param, all, find, meaning};
use rungc_syntax::{Classes, Device, DeviceClass, OperandKind};
use std::collections::BTreeSet;

/// Proposals at most.
const MOST: usize = 300;

/// Proposals for a place.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Proposals {
    /// Length of the text before the place that a proposal replaces, in bytes.
    pub replaced: usize,
    /// The proposals.
    pub list: Vec<Proposed>,
    /// True if there are more.
    pub is_cut: bool,
}

/// A proposal.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Proposed {
    /// Its kind.
    pub kind: ProposedKind,
    /// The text.
    pub text: String,
    /// The operands of a mnemonic; the comment of a device.
    pub detail: String,
    /// What the instruction is; empty for a device.
    pub title: String,
}

/// Kinds of proposals.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ProposedKind {
    /// A mnemonic.
    Mnemonic,
    /// A device.
    Device(DeviceClass),
}

/// An instruction with its operands.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Signature {
    /// The mnemonic and the names of its operands.
    pub label: String,
    /// What it is.
    pub title: String,
    /// Name of each operand, and what it accepts and means.
    pub params: Vec<(String, String)>,
    /// The operand at the end of the line.
    pub active: usize,
}

/// The words of a line, up to a place.
struct Words<'l> {
    /// Mnemonic and operands before the last word, without step number and label.
    before: Vec<&'l str>,
    /// The last word, perhaps empty.
    last: &'l str,
}

impl<'l> Words<'l> {
    /// `None` in a comment.
    fn of(line: &'l str) -> Option<Self> {
        let separates = |c: char| c.is_whitespace() || c == ',' || c == '，';
        if line.contains([';', '；', '"']) || line.contains("//") {
            return None;
        }
        let start = line.rfind(separates);
        let start = start.map_or(0, |at| {
            at + line[at..].chars().next().map_or(0, char::len_utf8)
        });
        let words = line[..start]
            .split(separates)
            .filter(|word| !word.is_empty());
        let is_step = |word: &str| word.bytes().all(|byte| byte.is_ascii_digit());
        let is_label = |word: &str| {
            let pointer = word.strip_prefix(['P', 'I', 'p', 'i']).unwrap_or("");
            !pointer.is_empty() && is_step(pointer.trim_end_matches(':'))
        };
        let mut before: Vec<_> = words.collect();
        let heads = before
            .iter()
            .take_while(|word| is_step(word) || is_label(word));
        before.drain(..heads.count());
        Some(Words {
            before,
            last: &line[start..],
        })
    }

    fn mnemonic(&self) -> Option<String> {
        self.before.first().map(|word| word.to_uppercase())
    }
}

impl Index {
    /// What can continue a line.
    pub fn proposals(&self, line: &str) -> Proposals {
        let Some(words) = Words::of(line) else {
            return Proposals::default();
        };
        let written = words.last.to_uppercase();
        let mut list = match words.mnemonic() {
            None => self.mnemonics(&written),
            Some(mnemonic) => {
                let found = find(&mnemonic);
                let params = found.map(|found| self.params(found.inst, &words));
                let param = params.map(|params| params.get(words.before.len() - 1));
                match param {
                    // After the last operand.
                    Some(None) => Vec::new(),
                    Some(param) => self.devices(&written, param),
                    None => self.devices(&written, None),
                }
            }
        };
        let is_cut = list.len() > MOST;
        list.truncate(MOST);
        Proposals {
            replaced: words.last.len(),
            list,
            is_cut,
        }
    }

    /// The operands of an instruction, as far as those that are written decide.
    fn params(&self, inst: &'static Inst, words: &Words) -> &'static [Param] {
        let read = rungc_frontend::read_text("", &words.before.join(" "));
        let instr = read.program.instrs.last();
        let operands = instr.map_or(&[][..], |instr| &instr.operands);
        inst.params_of(operands, self.model())
    }

    fn mnemonics(&self, written: &str) -> Vec<Proposed> {
        let model = self.model();
        let has = |inst: &Inst, form: Form| {
            let forms = inst.forms_on(model.id);
            let width = if form.wide { Forms::W32 } else { Forms::W16 };
            forms.has(width) && (!form.pulse || forms.has(Forms::PULSE))
        };
        let known = all().filter(|inst| inst.models.has(model.id));
        let spelled = known.flat_map(|inst| {
            let spellings = inst.spellings().into_iter();
            spellings.map(move |(spelling, form)| (inst, spelling, form))
        });
        let mut list: Vec<_> = spelled
            .filter(|(inst, spelling, form)| spelling.starts_with(written) && has(inst, *form))
            .map(|(inst, text, _)| Proposed {
                kind: ProposedKind::Mnemonic,
                text,
                detail: names(inst.params_of(&[], model)),
                title: inst.title.to_owned(),
            })
            .collect();
        list.sort_by(|a, b| a.text.cmp(&b.text));
        list.dedup_by(|a, b| a.text == b.text);
        list
    }

    /// Devices with comments, and those that the program uses, which a parameter accepts.
    fn devices(&self, written: &str, param: Option<&Param>) -> Vec<Proposed> {
        let accepts = |device: &Device| {
            let Some(param) = param else { return true };
            let class = Classes::of(&OperandKind::Device(*device, None));
            param.classes_on(self.model()).meets(class)
        };
        let is_label = |kind: UseKind| kind == UseKind::Label;
        let used = self.uses.iter().filter(|one| match one.first.class {
            DeviceClass::P | DeviceClass::I => is_label(one.kind),
            _ => true,
        });
        let commented = self.program().comments.keys().copied();
        let devices: BTreeSet<Device> = used.map(|one| one.first).chain(commented).collect();
        let matches = |device: &Device| {
            let number = match device.class.is_octal() {
                true => format!("{:o}", device.number),
                false => device.number.to_string(),
            };
            let short = format!("{}{number}", device.class.prefix());
            let comment = || self.comment(*device).unwrap_or_default().to_uppercase();
            device.to_string().starts_with(written)
                || short.starts_with(written)
                || comment().contains(written)
        };
        devices
            .into_iter()
            .filter(|device| accepts(device) && matches(device))
            .map(|device| Proposed {
                kind: ProposedKind::Device(device.class),
                text: device.to_string(),
                detail: self.comment(device).unwrap_or_default(),
                title: String::new(),
            })
            .collect()
    }

    /// The instruction of a line, and its operand at the end of the line.
    pub fn signature(&self, line: &str) -> Option<Signature> {
        let words = Words::of(line)?;
        let mnemonic = words.mnemonic()?;
        let inst = find(&mnemonic)?.inst;
        let params = self.params(inst, &words);
        let model = self.model();
        let described = params.iter().map(|param| {
            let classes: Vec<_> = param.classes_on(model).names().collect();
            let text = format!(
                "{}: {}",
                classes.join(" "),
                meaning(param, params, Some(model))
            );
            (param.name.to_owned(), text)
        });
        Some(Signature {
            label: format!("{mnemonic} {}", names(params))
                .trim_end()
                .to_owned(),
            title: inst.title.to_owned(),
            params: described.collect(),
            active: words.before.len() - 1,
        })
    }
}

/// Names of operands.
fn names(params: &[Param]) -> String {
    let names = params.iter().map(|param| match param.optional {
        true => format!("[{}]", param.name),
        false => param.name.to_owned(),
    });
    names.collect::<Vec<_>>().join(" ")
}
