//! Suggestions for a mnemonic that no model has.
//!
//! The nearest spelling alone misleads: what the operands fit and what the program waits for at this place count as
//! much. A suggestion never turns a contact into its opposite.

use super::operands::takes;
use rungc_catalogue::{Basic, Found, Inst};
use rungc_models::{Model, ModelSet};
use rungc_syntax::diag::distance;
use rungc_syntax::{Device, DeviceClass, Instr, Operand, OperandKind, Phrase, phrase};
use std::sync::OnceLock;

/// Suggestion for an unknown mnemonic.
pub(super) struct Meant {
    /// Reports it to the author.
    pub(super) help: Phrase,
    /// The instruction, where only one comes into question.
    pub(super) found: Option<Found>,
    /// The label, where a label was meant.
    pub(super) label: Option<Device>,
    /// Replacement of the mnemonic, and whether that is certain.
    pub(super) instead: Option<(String, bool)>,
}

/// Numbers of open structures of each kind at an instruction.
#[derive(Clone, Copy, Default)]
pub(super) struct Open {
    branches: u32,
    loops: u32,
    zones: u32,
    states: bool,
    subroutine: bool,
    interrupt: bool,
    after_fend: bool,
}

impl Open {
    /// Goes past an instruction.
    pub(super) fn pass(&mut self, inst: &Inst, label: Option<Device>) {
        let Some(basic) = inst.basic() else {
            return;
        };
        match basic {
            Basic::Mps => self.branches += 1,
            Basic::Mpp => self.branches = self.branches.saturating_sub(1),
            Basic::For => self.loops += 1,
            Basic::Next => self.loops = self.loops.saturating_sub(1),
            Basic::Mc => self.zones += 1,
            Basic::Mcr => self.zones = self.zones.saturating_sub(1),
            Basic::Stl => self.states = true,
            Basic::Ret => self.states = false,
            Basic::Sret => self.subroutine = false,
            Basic::Iret => self.interrupt = false,
            Basic::Fend => self.after_fend = true,
            Basic::Label => {
                let class = label.map(|label| label.class);
                self.interrupt |= class == Some(DeviceClass::I);
                self.subroutine |= class == Some(DeviceClass::P) && self.after_fend;
            }
            _ => {}
        }
    }

    /// Returns true if an instruction ends an open structure; `None` for one that ends nothing.
    fn is_ended_by(self, inst: &Inst, last: bool) -> Option<bool> {
        let basic = inst.basic()?;
        match basic {
            Basic::Mrd | Basic::Mpp => Some(self.branches > 0),
            Basic::Next => Some(self.loops > 0),
            Basic::Mcr => Some(self.zones > 0),
            Basic::Ret => Some(self.states),
            Basic::Sret => Some(self.subroutine),
            Basic::Iret | Basic::Pret => Some(self.interrupt),
            Basic::End => Some(last),
            _ => None,
        }
    }
}

/// Mnemonics of other PLCs and of IEC 61131-3, with what does the same here: the instruction, and how to write it.
const HABITS: &[(&[&str], &str, &str)] = &[
    (
        &["LDN", "LDNOT", "LD_NOT"],
        "LDI",
        "the negated contact is `LDI` here",
    ),
    (
        &["ANDN", "ANDNOT", "ANDI", "AN"],
        "ANI",
        "the negated contact is `ANI` here",
    ),
    (
        &["ORN", "ORNOT", "ON"],
        "ORI",
        "the negated contact is `ORI` here",
    ),
    (
        &["OUTN", "OUTNOT", "OUTI", "STN"],
        "OUT",
        "there is no negated coil: write `INV` before `OUT`",
    ),
    (
        &["NOT"],
        "INV",
        "`INV` inverts the result of the contacts before it",
    ),
    (&["ST"], "OUT", "the coil is `OUT` here"),
    (&["STR"], "LD", "the first contact of a rung is `LD` here"),
    (&["A"], "AND", "write `AND`"),
    (&["O"], "OR", "write `OR`"),
    (&["S"], "SET", "write `SET`"),
    (&["R"], "RST", "write `RST`"),
    (
        &["ANDLD", "ANDB", "ALD"],
        "ANB",
        "blocks are joined with `ANB` here",
    ),
    (&["ORLD", "OLD"], "ORB", "blocks are joined with `ORB` here"),
    (
        &["JMP", "JMPC", "JP", "JC"],
        "CJ",
        "a jump is `CJ`, driven by contacts: `LD M8000`, `CJ P0`",
    ),
    (
        &["CAL", "CALC", "JSR"],
        "CALL",
        "a subroutine is called with `CALL P0`",
    ),
    (&["RTS", "SBRT"], "SRET", "a subroutine ends with `SRET`"),
    (
        &["DIFU"],
        "PLS",
        "the coil that is on for one scan is `PLS`, the contact `LDP`",
    ),
    (
        &["DIFD"],
        "PLF",
        "the coil that is on for one scan is `PLF`, the contact `LDF`",
    ),
    (
        &["TON", "TIM", "TMR"],
        "OUT",
        "a timer is a coil with its preset: `OUT T0 K30`",
    ),
    (
        &["CTU", "CNT"],
        "OUT",
        "a counter is a coil with its preset: `OUT C0 K10`",
    ),
    (
        &[
            "IF",
            "ELSIF",
            "ELSE",
            "END_IF",
            "ENDIF",
            "CASE",
            "END_CASE",
            "WHILE",
            "END_WHILE",
        ],
        "CJ",
        "a list has no statements: a condition is contacts before what they drive (`LD M0`, `OUT Y000`) or before a jump",
    ),
];

/// A list of which one is meant.
pub(crate) fn any_of(names: &[String]) -> Phrase {
    match names {
        [] => Phrase::default(),
        [only] => only.into(),
        [before @ .., last] => phrase!("{before} or {last}", before = before.join(", "), last),
    }
}

/// No mnemonic is longer than this by more than a typing error.
const LONGEST: usize = 14;

/// Suggestion for the mnemonic of an instruction, the `last` one of the program or not.
pub(super) fn meant(instr: &Instr, open: Open, last: bool, model: &Model) -> Option<Meant> {
    let name = instr.mnemonic.as_str();
    habit(name)
        .or_else(|| comparison(name))
        .or_else(|| mistyped_label(instr))
        .or_else(|| glued(instr, model))
        .or_else(|| moved_affix(instr, model))
        .or_else(|| operand(name))
        .or_else(|| similar(instr, open, last, model).filter(|_| name.len() <= LONGEST))
}

/// `K50`, where a line of `OUT T0` has been divided, as editors copy lists.
fn operand(name: &str) -> Option<Meant> {
    glued_operands(name).filter(|all| all.len() == 1)?;
    Some(Meant {
        help: phrase!(
            "`{name}` is an operand: write it on the line of its instruction",
            name
        ),
        found: None,
        label: None,
        instead: None,
    })
}

fn habit(name: &str) -> Option<Meant> {
    let mut habits = HABITS.iter();
    let (_, row, help) = habits.find(|(names, ..)| names.contains(&name))?;
    // Others take other operands, or a contact before them.
    let same = !matches!(*row, "OUT" | "CJ" | "CALL" | "PLS" | "PLF");
    Some(Meant {
        help: (*help).into(),
        found: rungc_catalogue::find(row),
        label: None,
        instead: same.then(|| ((*row).to_owned(), true)),
    })
}

/// Joins of comparisons, with the letters that negate a contact: the right one, and whether it is negated.
const JOINS: &[(&str, &str, bool)] = &[
    ("LD", "LD", false),
    ("LDD", "LDD", false),
    ("AND", "AND", false),
    ("ANDD", "ANDD", false),
    ("OR", "OR", false),
    ("ORD", "ORD", false),
    ("LDI", "LD", true),
    ("LDN", "LD", true),
    ("LDDI", "LDD", true),
    ("LDID", "LDD", true),
    ("ANI", "AND", true),
    ("ANDI", "AND", true),
    ("ANDN", "AND", true),
    ("ANDDI", "ANDD", true),
    ("ANID", "ANDD", true),
    ("ORI", "OR", true),
    ("ORN", "OR", true),
    ("ORDI", "ORD", true),
    ("ORID", "ORD", true),
];

/// Operators of comparisons as other languages write them, too: the right one, and its opposite.
const OPERATORS: &[(&[&str], &str, &str)] = &[
    (&["=", "=="], "=", "<>"),
    (&["<>", "!=", "><"], "<>", "="),
    (&[">"], ">", "<="),
    (&["<"], "<", ">="),
    (&[">=", "=>"], ">=", "<"),
    (&["<=", "=<"], "<=", ">"),
];

/// `LDI=` or `LD!=`: a comparison that is negated or has the operator of another language.
fn comparison(name: &str) -> Option<Meant> {
    let (join, operator) = name.split_at_checked(name.find(['=', '<', '>', '!'])?)?;
    let (_, join, negated) = JOINS.iter().find(|(written, ..)| *written == join)?;
    let mut operators = OPERATORS.iter();
    let (_, same, opposite) = operators.find(|(written, ..)| written.contains(&operator))?;
    let right = format!("{join}{}", if *negated { opposite } else { same });
    let help = match negated {
        true => phrase!(
            "comparisons are not negated: the opposite is `{right}`",
            right
        ),
        false => phrase!("the comparison is `{right}`", right),
    };
    Some(Meant {
        help,
        found: rungc_catalogue::find(&right),
        label: None,
        instead: Some((right, true)),
    })
}

/// `PO` or `Il01`, alone on a line.
fn mistyped_label(instr: &Instr) -> Option<Meant> {
    let (letter, digits) = instr.mnemonic.split_at_checked(1)?;
    let class = DeviceClass::from_prefix(letter)
        .filter(|class| matches!(class, DeviceClass::P | DeviceClass::I))?;
    let number = digits.replace('O', "0").replace(['I', 'L'], "1");
    let number = number.parse().ok().filter(|_| instr.operands.is_empty())?;
    let label = Device { class, number };
    Some(Meant {
        help: phrase!("did you mean the label `{label}`?", label),
        found: rungc_catalogue::find(letter),
        label: Some(label),
        instead: Some((label.to_string(), false)),
    })
}

/// `OUTY0`, `MOVK1D0`: a mnemonic and its operands without a space between them.
fn glued(instr: &Instr, model: &Model) -> Option<Meant> {
    let name = instr.mnemonic.as_str();
    let split = |at: usize| {
        let (name, rest) = name.split_at_checked(at)?;
        let found = rungc_catalogue::find(name).filter(|found| found.inst.models.has(model.id))?;
        let mut operands = glued_operands(rest)?;
        let words: Vec<_> = operands
            .iter()
            .map(|operand| operand.kind.to_string())
            .collect();
        operands.extend(instr.operands.iter().cloned());
        takes(found, &operands, model).then(|| Meant {
            help: phrase!(
                "a space is missing: `{name} {words}`",
                name,
                words = words.join(" ")
            ),
            found: Some(found),
            label: None,
            instead: Some((format!("{name} {words}", words = words.join(" ")), true)),
        })
    };
    (1..name.len().min(LONGEST + 1)).rev().find_map(split)
}

/// The operands that a text holds one after the other.
fn glued_operands(text: &str) -> Option<Vec<Operand>> {
    let mut operands: Vec<Operand> = Vec::new();
    let mut rest = text;
    while !rest.is_empty() {
        let letters = rest.bytes().take_while(u8::is_ascii_uppercase).count();
        let (prefix, behind) = rest.split_at_checked(letters)?;
        let digits = behind.bytes().take_while(u8::is_ascii_digit).count();
        let (number, behind) = behind.split_at_checked(digits)?;
        rest = behind;
        let kind = match (prefix, DeviceClass::from_prefix(prefix)) {
            ("K", _) => OperandKind::Decimal(number.parse().ok()?, None),
            ("H", _) => OperandKind::Hex(u64::from_str_radix(number, 16).ok()?, None),
            (_, class) => {
                let class = class?;
                let radix = if class.is_octal() { 8 } else { 10 };
                let number = u32::from_str_radix(number, radix).ok()?;
                OperandKind::Device(Device { class, number }, None)
            }
        };
        // A constant in front of a relay is the number of digits of a group.
        let digits = operands.last().and_then(|last| last.kind.constant());
        let kind = match (digits, kind) {
            (Some(digits @ 1..=8), OperandKind::Device(device, None))
                if matches!(
                    device.class,
                    DeviceClass::X | DeviceClass::Y | DeviceClass::M | DeviceClass::S
                ) =>
            {
                operands.pop();
                OperandKind::Nibbles(digits as u8, device, None)
            }
            (_, kind) => kind,
        };
        let span = rungc_syntax::Span::default();
        operands.push(Operand { span, kind });
    }
    Some(operands)
}

/// `PMOV`, `MOVD`: the P of a pulse form as a prefix, the D of a 32-bit form as a suffix.
fn moved_affix(instr: &Instr, model: &Model) -> Option<Meant> {
    let name = instr.mnemonic.as_str();
    let stems = [
        (name.strip_prefix('P'), "", "P"),
        (name.strip_suffix('D'), "D", ""),
        (name.strip_prefix("DP"), "D", "P"),
        (name.strip_prefix("PD"), "D", "P"),
        (name.strip_suffix("PD"), "D", "P"),
        (name.strip_suffix("DP"), "D", "P"),
    ];
    let mut right = stems
        .into_iter()
        .filter_map(|(stem, wide, pulse)| Some(format!("{wide}{stem}{pulse}", stem = stem?)));
    right.find_map(|name| {
        let found = rungc_catalogue::find(&name)?;
        let fits = found.inst.models.has(model.id) && takes(found, &instr.operands, model);
        fits.then(|| Meant {
            help: phrase!("did you mean `{name}`?", name),
            found: Some(found),
            label: None,
            instead: Some((name, false)),
        })
    })
}

/// The spellings that are close to a misspelt one and fit best.
fn similar(instr: &Instr, open: Open, last: bool, model: &Model) -> Option<Meant> {
    static SPELLINGS: OnceLock<Vec<(String, ModelSet)>> = OnceLock::new();
    /// With more than this, nothing is suggested.
    const MAX_NAMES: usize = 3;
    let spellings = SPELLINGS.get_or_init(|| {
        let spelt = |inst: &'static Inst| {
            let spellings = inst.spellings().into_iter();
            spellings.map(|(name, _)| (name, inst.models))
        };
        rungc_catalogue::all().flat_map(spelt).collect()
    });
    let name = instr.mnemonic.as_str();
    let mut fitting: Vec<(i32, &str, Found)> = spellings
        .iter()
        .filter(|(near, models)| models.has(model.id) && near.len().abs_diff(name.len()) <= 2)
        .filter_map(|(near, _)| {
            let found = rungc_catalogue::find(near)?;
            let misfit = misfit(instr, near, found, (open, last), model)?;
            Some((misfit, near.as_str(), found))
        })
        .collect();
    fitting.sort_by_key(|&(misfit, name, _)| (misfit, name));
    fitting.dedup_by_key(|&mut (_, name, _)| name);
    let best = fitting.first()?.0;
    fitting.retain(|&(misfit, ..)| misfit == best);
    // Rather no opposite than one that was not meant.
    let opposite = |name: &str| matches!(name, "LDI" | "ANI" | "ORI" | "INV");
    if !name.ends_with(['I', 'N']) && !fitting.iter().all(|&(_, name, _)| opposite(name)) {
        fitting.retain(|&(_, name, _)| !opposite(name));
    }
    // Of a pulse form and the usual one the usual.
    let names: Vec<_> = fitting.iter().map(|&(_, name, _)| name).collect();
    fitting.retain(|(_, name, found)| {
        let usual = name.strip_suffix('P').filter(|_| found.form.pulse);
        !usual.is_some_and(|usual| names.contains(&usual))
    });
    fitting.truncate(MAX_NAMES);
    let names: Vec<_> = fitting
        .iter()
        .map(|(_, name, _)| format!("`{name}`"))
        .collect();
    if names.is_empty() {
        return None;
    }
    let names = any_of(&names);
    let comparison = format!("{name}=");
    let compared = match rungc_catalogue::find(&comparison).filter(|_| !names.contains(&comparison))
    {
        Some(_) => phrase!(" (a comparison is `{comparison}`)", comparison),
        None => Phrase::default(),
    };
    let only = match fitting.as_slice() {
        &[(_, name, found)] => Some((name, found)),
        _ => None,
    };
    Some(Meant {
        help: phrase!("did you mean {names}?{compared}", names, compared),
        found: only.map(|(_, found)| found),
        label: None,
        instead: only
            .filter(|_| compared.is_empty())
            .map(|(name, _)| (name.to_owned(), false)),
    })
}

/// Distance of a spelling from the instruction: `None` if it is out of the question.
fn misfit(
    instr: &Instr,
    near: &str,
    found: Found,
    (open, last): (Open, bool),
    model: &Model,
) -> Option<i32> {
    let name = instr.mnemonic.as_str();
    if found.inst.basic() == Some(Basic::Label) {
        return None;
    }
    let fits = takes(found, &instr.operands, model);
    let ends = open.is_ended_by(found.inst, last);
    let limit = match (name.len(), fits, ends) {
        (_, true, Some(true)) => 2,
        (0..=3, ..) | (_, false, _) => 1,
        _ => 2,
    };
    let distance = distance(name, near, limit)? as i32;
    let likely = letters(name) == letters(near) || near.starts_with(name);
    let of_structure = match ends {
        Some(true) => -1,
        Some(false) => 3,
        None => 0,
    };
    let of_operands = if fits { 0 } else { 3 };
    Some(2 * distance - i32::from(likely) + of_operands + of_structure)
}

/// The letters of a name in alphabetical order.
fn letters(name: &str) -> Vec<u8> {
    let mut letters = name.as_bytes().to_vec();
    letters.sort();
    letters
}
