//! Learning codes: a project beside the list that the editor exports of it.
//!
//! Both hold the same instructions in the same order, so that they are lined up one by one. Each pair is compared,
//! operands and step numbers too, before anything is learned: a list of another state of the program teaches nothing.

use crate::Read;
use crate::gx::hex;
use crate::learned::{Reading, Unproven};
use rungc_syntax::{Instr, OperandKind, codes};
use smol_str::SmolStr;
use std::collections::BTreeMap;

/// A code and its instruction, as a list shows it.
#[derive(Clone, PartialEq, Debug)]
pub struct Lesson {
    /// The code: the body of its tokens.
    pub code: Vec<u8>,
    /// The instruction as the list spells it.
    pub mnemonic: SmolStr,
    /// Previous reading of the code.
    pub reading: Reading,
    /// Its positions in the list, in order: at least one.
    pub uses: Vec<Instr>,
}

impl Lesson {
    /// The code as people read it: `63 09 20`.
    pub fn shown(&self) -> String {
        hex(&self.code)
    }

    /// Number of steps that the code states.
    pub fn steps(&self) -> u32 {
        crate::gx::steps(&self.code)
    }
}

/// Reason why nothing can be learned from a project and a list.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
pub enum Mismatch {
    /// The project is not one of GX Developer or GX Works2.
    #[error("the first file is not a project of GX Developer or GX Works2")]
    NotAProject,
    /// The list is not a list.
    #[error("the second file is not a list: export it from the editor as CSV")]
    NotAList,
    /// Not all of a file can be read.
    #[error("the {file} cannot be read completely: {why}")]
    Unreadable {
        /// `project` or `export`.
        file: &'static str,
        /// The first error.
        why: String,
    },
    /// An instruction of the project is another one in the list.
    #[error(
        "at {place} the project has `{project}`, the export `{export}`: it is from another state of the program; export it again"
    )]
    Different {
        /// Step or number of the instruction.
        place: String,
        /// The project's instruction; its code, if that is not known.
        project: String,
        /// That of the list.
        export: String,
    },
    /// The instruction of a code that is not known has another length in the list.
    #[error(
        "at {place} the code {code} states {stated} steps, but the export counts {counted} for `{export}`: export it again"
    )]
    Length {
        /// Step or number of the instruction.
        place: String,
        /// The code.
        code: String,
        /// Its length.
        stated: u32,
        /// That of the list.
        counted: u32,
        /// The instruction of the list.
        export: String,
    },
    /// One of them ends before the other.
    #[error(
        "the {shorter} ends before {place}, where the other has `{next}`: the export is from another state of the program; export it again"
    )]
    Shorter {
        /// `project` or `export`.
        shorter: &'static str,
        /// Step or number of the instruction.
        place: String,
        /// The instruction at this place in the other.
        next: String,
    },
    /// One code stands for two instructions.
    #[error(
        "the code {code} would be `{first}` at {first_place} and `{second}` at {second_place}: nothing is learned"
    )]
    Ambiguous {
        /// The code.
        code: String,
        /// First meaning.
        first: SmolStr,
        /// Its place.
        first_place: String,
        /// Later meaning.
        second: SmolStr,
        /// Its place.
        second_place: String,
    },
}

/// Learns the codes of a project that nothing proves from the list that was exported of it, in the order of the codes.
/// `same` says whether two mnemonics are spellings of one instruction.
///
/// # Errors
/// If they do not line up, or do not agree about a code.
pub fn learn(
    project: &Read,
    export: &Read,
    same: impl Fn(&str, &str) -> bool,
) -> Result<Vec<Lesson>, Mismatch> {
    readable(project, export)?;
    let mut lessons = BTreeMap::new();
    let mut listed = export.program.instrs.iter().enumerate().peekable();
    for item in items(project) {
        let place = place(item.step());
        // An editor may leave empty steps out of the list.
        if item.is_nop()
            && listed
                .peek()
                .is_none_or(|(_, instr)| instr.mnemonic != "NOP")
        {
            continue;
        }
        while !item.is_nop()
            && listed
                .next_if(|(_, instr)| instr.mnemonic == "NOP")
                .is_some()
        {}
        let Some((at, instr)) = listed.next() else {
            return Err(Mismatch::Shorter {
                shorter: "export",
                place,
                next: item.to_string(),
            });
        };
        if !item.is(instr, &same) {
            let numbered = instr.step.map_or(String::new(), |step| format!("{step} "));
            return Err(Mismatch::Different {
                place,
                project: item.to_string(),
                export: format!("{numbered}{instr}"),
            });
        }
        if let Some(unproven) = item.unproven {
            let after = export.program.instrs.get(at + 1);
            length(unproven, instr, after, &place)?;
            add(&mut lessons, unproven, instr)?;
        }
    }
    match listed.find(|(_, instr)| instr.mnemonic != "NOP") {
        Some((_, next)) => Err(Mismatch::Shorter {
            shorter: "project",
            place: place(next.step),
            next: next.to_string(),
        }),
        None => Ok(lessons.into_values().collect()),
    }
}

/// Checks that both are of the right kind, and readable apart from codes.
fn readable(project: &Read, export: &Read) -> Result<(), Mismatch> {
    let is_list = |read: &Read| !read.program.kind.is_project();
    if is_list(project) {
        return Err(Mismatch::NotAProject);
    }
    if !is_list(export) {
        return Err(Mismatch::NotAList);
    }
    let codes = |code: &str| code == codes::UNKNOWN_BYTES.id || code == codes::LABEL_OPERAND.id;
    let unknown = project
        .unproven
        .iter()
        .filter(|unproven| !unproven.is_read());
    let whole = unknown.count() == project.program.unread.len();
    let files = [
        ("project", project, whole),
        ("export", export, export.program.is_complete()),
    ];
    for (file, read, whole) in files {
        let mut diagnostics = read.diagnostics.iter();
        let error =
            diagnostics.find(|d| d.severity == rungc_syntax::Severity::Error && !codes(d.code));
        let why = error.map(|d| d.message.to_string());
        if let Some(why) = why.or_else(|| (!whole).then(|| "bytes are damaged".to_owned())) {
            return Err(Mismatch::Unreadable { file, why });
        }
    }
    Ok(())
}

/// An instruction of the project.
struct Item<'r> {
    /// As it was read; nothing if it was not.
    instr: Option<&'r Instr>,
    /// If nothing proves its code.
    unproven: Option<&'r Unproven>,
}

/// The instructions of the project in order, those that were not read among them.
fn items(project: &Read) -> impl Iterator<Item = Item<'_>> {
    let mut unproven = project.unproven.iter().peekable();
    let mut instrs = project.program.instrs.iter().enumerate().peekable();
    std::iter::from_fn(move || {
        let at = instrs.peek().map_or(usize::MAX, |(at, _)| *at);
        let unread = unproven.next_if(|unproven| !unproven.is_read() && unproven.at <= at);
        if unread.is_some() {
            return Some(Item {
                instr: None,
                unproven: unread,
            });
        }
        let (at, instr) = instrs.next()?;
        Some(Item {
            instr: Some(instr),
            unproven: unproven.next_if(|unproven| unproven.at == at),
        })
    })
}

impl Item<'_> {
    fn step(&self) -> Option<u32> {
        match (self.instr, self.unproven) {
            (Some(instr), _) => instr.step,
            (None, unproven) => unproven?.step,
        }
    }

    fn is_nop(&self) -> bool {
        self.instr.is_some_and(|instr| instr.mnemonic == "NOP")
    }

    /// Returns true if this is the instruction of the list, as far as it is known.
    fn is(&self, listed: &Instr, same: impl Fn(&str, &str) -> bool) -> bool {
        let operands = match (self.unproven, self.instr) {
            (Some(unproven), _) => &unproven.operands,
            (None, Some(instr)) => &instr.operands,
            (None, None) => return false,
        };
        let named = self.unproven.is_some()
            || self
                .instr
                .is_some_and(|instr| same(&instr.mnemonic, &listed.mnemonic));
        let counted = match (self.step(), listed.step) {
            (Some(step), Some(listed)) => step == listed,
            _ => true,
        };
        let pairs = || operands.iter().zip(&listed.operands);
        named
            && counted
            && operands.len() == listed.operands.len()
            && pairs().all(|(a, b)| equal(&a.kind, &b.kind))
    }
}

impl std::fmt::Display for Item<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match (self.instr, self.unproven) {
            (Some(instr), _) => instr.fmt(f),
            (None, Some(unproven)) => {
                f.write_str(&unproven.shown())?;
                let mut operands = unproven.operands.iter();
                operands.try_for_each(|operand| write!(f, " {}", operand.kind))
            }
            (None, None) => Ok(()),
        }
    }
}

/// Returns true if operands are equal. A list shows a float with the digits that fit its column; an operand that could
/// not be read may be anything.
fn equal(project: &OperandKind, listed: &OperandKind) -> bool {
    match (project, listed) {
        (OperandKind::Unreadable(_), _) => true,
        (OperandKind::Float(a), OperandKind::Float(b)) => (a - b).abs() <= a.abs() * 1e-4,
        _ => project == listed,
    }
}

/// Holds the length that a code states to the one that the list counts.
fn length(
    unproven: &Unproven,
    instr: &Instr,
    after: Option<&Instr>,
    place: &str,
) -> Result<(), Mismatch> {
    let counted = after.and_then(|after| after.step?.checked_sub(instr.step?));
    match counted {
        Some(counted) if counted != unproven.steps() => Err(Mismatch::Length {
            place: place.to_owned(),
            code: unproven.shown(),
            stated: unproven.steps(),
            counted,
            export: instr.to_string(),
        }),
        _ => Ok(()),
    }
}

fn add(
    lessons: &mut BTreeMap<Vec<u8>, Lesson>,
    unproven: &Unproven,
    instr: &Instr,
) -> Result<(), Mismatch> {
    let lesson = lessons
        .entry(unproven.code.clone())
        .or_insert_with(|| Lesson {
            code: unproven.code.clone(),
            mnemonic: instr.mnemonic.clone(),
            reading: unproven.reading.clone(),
            uses: Vec::new(),
        });
    if lesson.mnemonic != instr.mnemonic {
        return Err(Mismatch::Ambiguous {
            code: lesson.shown(),
            first: lesson.mnemonic.clone(),
            first_place: place(lesson.uses.first().and_then(|first| first.step)),
            second: instr.mnemonic.clone(),
            second_place: place(instr.step),
        });
    }
    lesson.uses.push(instr.clone());
    Ok(())
}

fn place(step: Option<u32>) -> String {
    step.map_or_else(|| "one place".to_owned(), |step| format!("step {step}"))
}
