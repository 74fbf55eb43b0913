//! Structured text of a GX Works2 project, compared with the compiled program beside it: rungc compiles the text as the
//! editor does, and looks for the same instructions.

use rungc_frontend::Read;
use rungc_frontend::sources::{Body, PouKind, Sources};
use rungc_models::Model;
use rungc_models::runs::is_special;
use rungc_structured::{Known, Trial, trial};
use rungc_syntax::{Device, DeviceClass, Diagnostic, Diagnostics, Instr, OperandKind, Span, codes};
use similar::{Algorithm, DiffOp, capture_diff_slices};
use std::collections::{BTreeSet, HashSet};

/// Larger products of the numbers of instructions are not compared: it would take seconds.
const MOST: usize = 100_000_000;

/// Reasons for other instructions.
const WHY: &str =
    "changed after the last compilation, or compiled in a way that rungc does not know";

/// Statements that a note names.
const NAMED: usize = 3;

/// Structured text that tasks run, compared with the compiled program.
#[derive(Clone, PartialEq, Eq, Default, Debug)]
pub struct Comparison {
    /// Statements, those of expanded blocks once for each instance.
    pub statements: usize,
    /// Statements of which the compiled program has the instructions, up to the numbers of temporaries and jumps.
    pub equal: usize,
    /// The others, in the order of the text.
    pub others: Vec<Other>,
    /// True if the compiled program consists of the instructions of these statements.
    pub is_whole: bool,
}

/// A statement of which the compiled program does not have the instructions.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Other {
    /// File of those that `rungc convert --to st` writes.
    pub file: String,
    /// Line in it, from 1.
    pub line: usize,
    /// First line of the statement.
    pub text: String,
    /// True if rungc compiles it, to other instructions.
    pub is_compiled: bool,
}

impl Comparison {
    /// Compares the programs in structured text of a project; `None` if there are none, or no instructions.
    pub fn new(read: &Read, model: &'static Model) -> Option<Self> {
        let sources = read.sources.as_deref()?;
        let run: Vec<_> = sources.tasks.iter().flat_map(|task| &task.pous).collect();
        let texts = texts(sources);
        let stated = stated(sources);
        let compiled = Lines::new(&read.program.instrs, &stated);
        let mut found = Comparison::default();
        let mut all = Vec::new();
        let mut are_all = true;
        for name in run {
            let Some(text) = texts.program(name) else {
                are_all = false;
                continue;
            };
            let tried = trial(&text.whole(), model, &known(sources, name));
            let own = Lines::new(&tried.instrs, &stated);
            found.add(&tried, &own, &compiled, &text);
            all.extend(own.0);
        }
        found.is_whole = are_all && found.others.is_empty() && all == compiled.0;
        (found.statements > 0 && !compiled.0.is_empty()).then_some(found)
    }

    /// Adds the statements of a program.
    fn add(&mut self, tried: &Trial, own: &Lines, compiled: &Lines, text: &Whole<'_>) {
        let Some(matched) = own.found_in(compiled) else {
            return;
        };
        let mut missing = HashSet::new();
        for (instr, is_matched) in tried.instrs.iter().zip(matched) {
            if !is_matched {
                missing.insert(instr.span);
            }
        }
        for statement in &tried.statements {
            let span = statement.span;
            self.statements += 1;
            match statement.is_compiled && !missing.contains(&span) {
                true => self.equal += 1,
                false => self.others.push(text.other(span, statement.is_compiled)),
            }
        }
    }

    /// What a check says of it.
    pub fn note(&self) -> Diagnostic {
        let Comparison {
            statements,
            equal,
            others,
            is_whole,
        } = self;
        let counted = match statements {
            1 => "1 statement".to_owned(),
            many => format!("{many} statements"),
        };
        let message = match (is_whole, others.is_empty()) {
            (true, _) => format!(
                "the compiled program is what its source says: {counted} of structured text"
            ),
            (false, true) => format!(
                "the compiled program has all instructions of its structured text ({counted}), and others"
            ),
            (false, false) => format!(
                "the compiled program has the instructions of {equal} of its {counted} of structured text"
            ),
        };
        let note = codes::COMPARED
            .at(Span::default(), message)
            .label("the compiled program starts here");
        if others.is_empty() {
            return note;
        }
        let (differing, unknown): (Vec<_>, Vec<_>) =
            others.iter().partition(|other| other.is_compiled);
        let mut help = Vec::new();
        if !differing.is_empty() {
            help.push(format!(
                "it has other instructions for {}",
                named(&differing)
            ));
            help.push(WHY.to_owned());
        }
        if !unknown.is_empty() {
            help.push(format!("rungc does not compile {}", named(&unknown)));
        }
        note.help(help.join("; "))
    }

    /// Adds the note to what was found in a project, and takes back that the compiled program may be older if it is
    /// what its source says.
    pub(crate) fn report(&self, diagnostics: &mut Diagnostics) {
        let mut found = Diagnostics::new();
        let kept = diagnostics
            .iter()
            .filter(|one| !(self.is_whole && one.code == codes::AGE_UNKNOWN.id));
        found.extend(kept.cloned());
        found.push(self.note());
        *diagnostics = found;
    }
}

/// The first statements, and how many more there are.
fn named(others: &[&Other]) -> String {
    let first = others.iter().take(NAMED);
    let mut named: Vec<_> = first
        .map(|other| format!("`{}` line {}, `{}`", other.file, other.line, other.text))
        .collect();
    match others.len().saturating_sub(NAMED) {
        0 => {}
        more => named.push(format!("{more} more")),
    }
    named.join("; ")
}

/// Files in structured text.
struct Texts {
    /// Programs, by their names.
    programs: Vec<(String, String, String)>,
    /// What programs use, with its files.
    parts: Vec<(String, String)>,
}

/// A program with what it uses, as one text.
struct Whole<'t> {
    parts: &'t [(String, String)],
    file: &'t str,
    program: &'t str,
}

fn texts(sources: &Sources) -> Texts {
    let mut texts = Texts {
        programs: Vec::new(),
        parts: Vec::new(),
    };
    let is_program = |path: &str| {
        let name = path.trim_end_matches(".st");
        let programs = sources
            .pous
            .iter()
            .filter(|pou| pou.kind == PouKind::Program);
        let mut texts = programs.filter(|pou| matches!(pou.body, Body::Text(_)));
        texts
            .find(|pou| pou.name.eq_ignore_ascii_case(name))
            .map(|pou| pou.name.clone())
    };
    for file in sources.to_st() {
        let text = String::from_utf8_lossy(&file.contents).into_owned();
        let is_tasks = text.starts_with("CONFIGURATION");
        match is_program(&file.path) {
            _ if !file.path.ends_with(".st") || is_tasks => {}
            Some(name) => texts.programs.push((name, file.path, text)),
            None => texts.parts.push((file.path, text)),
        }
    }
    texts
}

impl Texts {
    fn program(&self, name: &str) -> Option<Whole<'_>> {
        let mut programs = self.programs.iter();
        let (_, file, program) = programs.find(|one| one.0.eq_ignore_ascii_case(name))?;
        Some(Whole {
            parts: &self.parts,
            file,
            program,
        })
    }
}

impl Whole<'_> {
    fn whole(&self) -> String {
        let parts = self.parts.iter().map(|(_, text)| text.as_str());
        parts.chain([self.program]).collect()
    }

    /// A statement at a place of the whole text.
    fn other(&self, span: Span, is_compiled: bool) -> Other {
        let mut start = span.start as usize;
        let (mut file, mut text) = (self.file, self.program);
        for (path, part) in self.parts {
            if start < part.len() {
                (file, text) = (path, part);
                break;
            }
            start -= part.len();
        }
        let before = text.get(..start).unwrap_or_default();
        let rest = text.get(start..).unwrap_or_default();
        Other {
            file: file.to_owned(),
            line: before.matches('\n').count() + 1,
            text: rest
                .lines()
                .next()
                .unwrap_or_default()
                .trim_end()
                .to_owned(),
            is_compiled,
        }
    }
}

/// Devices that the editor chose for labels of a program and for global ones, and those of members of structures, which
/// no text states. The names of other programs stand before theirs.
pub(crate) fn known(sources: &Sources, program: &str) -> Known {
    let local = format!("{program}.");
    let mut known = Known::new();
    for one in sources.devices() {
        if one.is_chosen || one.name.contains('.') {
            let name = one.name.strip_prefix(&local).unwrap_or(&one.name);
            let name = name.split('[').next().unwrap_or(name);
            known.entry(name.to_uppercase()).or_insert(one.device);
        }
    }
    known
}

/// Instructions without the numbers of temporaries and jumps, and without the end of the program.
struct Lines(Vec<String>);

impl Lines {
    /// `stated` are devices that are not temporaries.
    fn new(instrs: &[Instr], stated: &BTreeSet<Device>) -> Self {
        let end = |instr: &Instr| ["FEND", "NOP", "END"].contains(&instr.mnemonic.as_str());
        let length = instrs
            .iter()
            .rposition(|instr| !end(instr))
            .map_or(0, |last| last + 1);
        let lines = instrs[..length].iter();
        Lines(lines.map(|instr| line(instr, stated)).collect())
    }

    /// For each of these, true if the others have it at its place; `None` for too many.
    fn found_in(&self, others: &Lines) -> Option<Vec<bool>> {
        let (own, others) = (&self.0, &others.0);
        let is_part = !own.is_empty() && others.windows(own.len()).any(|window| window == own);
        let mut found = vec![is_part; own.len()];
        if is_part {
            return Some(found);
        }
        if own.len().saturating_mul(others.len()) > MOST {
            return None;
        }
        for op in capture_diff_slices(Algorithm::Myers, own, others) {
            if let DiffOp::Equal { old_index, len, .. } = op {
                found[old_index..old_index + len].fill(true);
            }
        }
        Some(found)
    }
}

/// Devices of labels, and those that a text names. All other relays and registers of compiled text are temporaries.
fn stated(sources: &Sources) -> BTreeSet<Device> {
    stated_devices(sources, true)
}

/// As [`stated`], with or without devices that the editor chose.
pub(crate) fn stated_devices(sources: &Sources, with_chosen: bool) -> BTreeSet<Device> {
    let labels = sources.devices().into_iter();
    let labels = labels.filter(|one| with_chosen || !one.is_chosen);
    let mut stated: BTreeSet<_> = labels.map(|one| one.device).collect();
    for pou in &sources.pous {
        if let Body::Text(text) = &pou.body {
            let words = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
            stated.extend(words.filter_map(named_device));
        }
    }
    stated
}

/// Instructions without the numbers of temporaries and jumps.
pub(crate) fn lines(instrs: &[Instr], stated: &BTreeSet<Device>) -> Vec<String> {
    Lines::new(instrs, stated).0
}

/// The relay or register that a word names: `M10`, `D10Z0`, `K4M0`.
fn named_device(word: &str) -> Option<Device> {
    let word = word.to_ascii_uppercase();
    let group = word.strip_prefix('K').and_then(|rest| rest.get(1..));
    let word = group.unwrap_or(&word);
    let class = [DeviceClass::M, DeviceClass::D]
        .into_iter()
        .find(|class| word.starts_with(class.prefix()))?;
    let digits = word[1..].split(|c: char| !c.is_ascii_digit()).next()?;
    let number = digits.parse().ok()?;
    Some(Device { class, number })
}

/// An instruction without the numbers of temporaries and jumps.
fn line(instr: &Instr, stated: &BTreeSet<Device>) -> String {
    let is_temporary = |device: &Device| {
        [DeviceClass::M, DeviceClass::D].contains(&device.class)
            && !is_special(device.class, device.number)
            && !stated.contains(device)
    };
    let digits = instr.mnemonic.strip_prefix('P').unwrap_or_default();
    let is_label = instr.operands.is_empty() && digits.parse::<u32>().is_ok();
    let mut line = match is_label {
        true => "P".to_owned(),
        false => instr.mnemonic.to_string(),
    };
    for operand in &instr.operands {
        line.push(' ');
        match &operand.kind {
            OperandKind::Device(device, _) if device.class == DeviceClass::P => line.push('P'),
            OperandKind::Device(device, None) if is_temporary(device) => {
                line.push_str(device.class.prefix());
                line.push('#');
            }
            kind => line.push_str(&kind.to_string()),
        }
    }
    line
}

#[cfg(test)]
mod tests {
    use super::Comparison;
    use rungc_frontend::Read;
    use rungc_frontend::sources::{Body, Pou, PouKind, Sources, Task};
    use rungc_models::{Model, ModelId};

    /// A project whose task runs these programs, and its compiled program.
    fn project(programs: &[(&str, Body)], list: &str) -> Read {
        let pou = |(name, body): &(&str, Body)| Pou {
            name: (*name).to_owned(),
            library: None,
            kind: PouKind::Program,
            return_type: String::new(),
            labels: Vec::new(),
            body: body.clone(),
        };
        let task = Task {
            name: "MELSEC_MAIN".to_owned(),
            event: "TRUE".to_owned(),
            interval: "0".to_owned(),
            priority: 31,
            pous: programs.iter().map(|one| one.0.to_owned()).collect(),
        };
        let mut read = rungc_frontend::read_text("press.il", list);
        read.sources = Some(Box::new(Sources {
            pous: programs.iter().map(pou).collect(),
            tasks: vec![task],
            ..Sources::default()
        }));
        read
    }

    fn compared(programs: &[(&str, Body)], list: &str) -> Option<Comparison> {
        Comparison::new(&project(programs, list), Model::get(ModelId::Fx3u))
    }

    fn text(text: &str) -> Body {
        Body::Text(text.to_owned())
    }

    const MAIN: &str = "Y0 := X0 AND X1;\nIF X2 THEN\n  Y1 := X3;\nEND_IF;\n";

    /// What the editor makes of it.
    const LIST: &str =
        "LD X000\nAND X001\nOUT Y000\nLDI X002\nCJ P0\nLD X003\nOUT Y001\nP0\nFEND\nNOP\nEND\n";

    #[test]
    fn a_compiled_copy_is_what_its_source_says() {
        let found = compared(&[("Main", text(MAIN))], LIST).unwrap();
        assert!(found.is_whole && found.others.is_empty(), "{found:?}");
        // Numbers of jumps do not matter; order does.
        let other = compared(&[("Main", text(MAIN))], &LIST.replace("P0", "P7")).unwrap();
        assert!(other.is_whole);
        let two = [("Second", text("Y2 := X4;")), ("Main", text(MAIN))];
        let list = format!("LD X004\nOUT Y002\n{LIST}");
        assert!(compared(&two, &list).unwrap().is_whole);
        let two = [two[1].clone(), two[0].clone()];
        let found = compared(&two, &list).unwrap();
        assert!(!found.is_whole && found.others.is_empty(), "{found:?}");
    }

    #[test]
    fn statements_with_other_instructions_are_named() {
        let older = LIST.replace("AND X001", "ANI X001");
        let found = compared(&[("Main", text(MAIN))], &older).unwrap();
        insta::assert_snapshot!(described(&found));
        // A statement was added since.
        let newer = format!("{MAIN}Y5 := X5;\nY6 := TON(X6);\n");
        let found = compared(&[("Main", text(&newer))], LIST).unwrap();
        insta::assert_snapshot!(described(&found));
        // One was removed: all statements are there, and more.
        let found = compared(&[("Main", text("Y0 := X0 AND X1;\n"))], LIST).unwrap();
        insta::assert_snapshot!(described(&found));
    }

    #[test]
    fn what_is_not_structured_text_is_not_compared() {
        assert_eq!(compared(&[("Main", Body::Chart)], LIST), None);
        let mixed = [("Main", text(MAIN)), ("Chart", Body::Chart)];
        let found = compared(&mixed, LIST).unwrap();
        assert!(!found.is_whole && found.others.is_empty(), "{found:?}");
        let mut read = project(&[("Main", text(MAIN))], LIST);
        read.program.instrs.clear();
        assert_eq!(Comparison::new(&read, Model::get(ModelId::Fx3u)), None);
    }

    fn described(found: &Comparison) -> String {
        let note = found.note();
        let help = note.help.as_deref().unwrap_or("none");
        format!("{}\nhelp: {help}", note.message)
    }
}
