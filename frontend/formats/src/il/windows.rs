//! Lists of AutoShop, which keeps the main program, subroutines and interrupt routines in separate windows
//! (h1u-h2u-programming §4.3.1, CALL and IRET). Copied into one text, each window begins with a heading: `MAIN`,
//! `SBR name`, `INT name I001`. Names become pointers, and FEND, SRET, IRET and END come where a window ends without.

use super::Reader;
use super::fault::{Faults, Kind};
use super::fold::Folded;
use super::grammar;
use super::jumps::{instruction, words};
use crate::text::clean;
use rungc_syntax::diag::did_you_mean;
use rungc_syntax::{
    Device, DeviceClass, Diagnostic, Instr, OperandKind, Operands, Source, Span, codes, phrase,
};
use smol_str::ToSmolStr;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// Kind of a window.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Routine {
    Main,
    Subroutine,
    Interrupt,
}

impl Routine {
    /// The instruction that ends it.
    fn end(self) -> &'static str {
        match self {
            Routine::Main => "FEND",
            Routine::Subroutine => "SRET",
            Routine::Interrupt => "IRET",
        }
    }
}

/// The line that begins a window.
#[derive(Debug)]
struct Heading {
    routine: Routine,
    /// Name of the window.
    name: Option<String>,
    /// The pointer that the heading states, or that it was given.
    pointer: Option<Device>,
    /// Position in its line.
    place: Range<usize>,
    /// Error in the heading.
    fault: Option<&'static str>,
}

/// The windows of a text.
#[derive(Default)]
pub(super) struct Windows {
    /// By the start of their lines.
    headings: BTreeMap<u32, Heading>,
    /// The pointers of subroutines by name.
    names: BTreeMap<String, Device>,
    /// The window at hand; before the first heading it is the main program.
    current: Option<Routine>,
}

impl Windows {
    /// Finds the headings of a text and gives each subroutine a pointer: the one that its heading states, or that its
    /// name is; 1 to `SBR_01` if that is free; else the first free one.
    pub fn of(source: &Source) -> Self {
        let mut windows = Windows::default();
        let lines = source.lines();
        let headings = lines.filter_map(|(start, line)| Some((start, heading(line)?)));
        windows.headings.extend(headings);
        if windows.headings.is_empty() {
            return windows;
        }
        let mut used: BTreeSet<u32> = source
            .lines()
            .flat_map(|(_, line)| pointers(line))
            .collect();
        // The end of the program.
        used.insert(63);
        let mut seen = BTreeSet::new();
        for (i, heading) in windows.headings.values_mut().enumerate() {
            let twice = heading
                .name
                .as_ref()
                .is_some_and(|name| !seen.insert(name.clone()));
            let fault = match heading.routine {
                Routine::Main if i > 0 => Some("the main program comes first, and once"),
                _ if twice => Some("another window has this name"),
                _ => None,
            };
            heading.fault = heading.fault.or(fault);
            if heading.routine != Routine::Subroutine || heading.pointer.is_some() {
                continue;
            }
            let numbered = heading.name.as_deref().and_then(numbered);
            let number = numbered.filter(|number| !used.contains(number));
            let number = number.or_else(|| (0..).find(|number| !used.contains(number)));
            used.extend(number);
            heading.pointer = number.map(pointer);
        }
        let subroutines = windows.headings.values().filter_map(|heading| {
            let of_calls = heading.routine == Routine::Subroutine;
            Some((heading.name.clone()?, heading.pointer.filter(|_| of_calls)?))
        });
        windows.names = subroutines.collect();
        windows
    }

    /// Returns true if the text has any.
    pub fn any(&self) -> bool {
        !self.headings.is_empty()
    }
}

fn pointer(number: u32) -> Device {
    Device {
        class: DeviceClass::P,
        number,
    }
}

/// The editor's own name for the window of a pointer.
pub(crate) fn usual_name(pointer: Device) -> String {
    match pointer.class {
        DeviceClass::I => format!("INT_{:03}", pointer.number),
        _ => format!("SBR_{:02}", pointer.number),
    }
}

/// The number at the end of the editor's own names: 1 of `SBR_01`.
fn numbered(name: &str) -> Option<u32> {
    let (prefix, number) = name.split_at_checked(4)?;
    let digits = number.bytes().all(|b| b.is_ascii_digit());
    (digits && prefix.eq_ignore_ascii_case("SBR_")).then(|| number.parse().ok())?
}

/// The numbers of pointers P and labels L that a line mentions.
fn pointers(line: &str) -> impl Iterator<Item = u32> {
    words(instruction(line)).filter_map(|place| {
        let number = line[place].strip_prefix(['P', 'p', 'L', 'l'])?;
        let digits = number.trim_start_matches(|c: char| c.is_ascii_digit());
        number[..number.len() - digits.len()].parse().ok()
    })
}

/// Returns true if a line begins a window.
pub(crate) fn is_heading(line: &str) -> bool {
    heading(line).is_some()
}

/// The heading that a line is.
fn heading(line: &str) -> Option<Heading> {
    let code = instruction(line);
    let mut places = words(code);
    let first = places.next()?;
    // Most lines begin with none of these letters.
    if !code[first.start..].starts_with(['M', 'm', 'S', 's', 'I', 'i', 'Ｍ', 'Ｓ', 'Ｉ']) {
        return None;
    }
    let rest: Vec<_> = places.collect();
    let end = rest.last().map_or(first.end, |last| last.end);
    let words: Vec<_> = std::iter::once(&first)
        .chain(&rest)
        .map(|place| Folded::of(&code[place.clone()]).text)
        .map(|word| word.trim_end_matches(':').to_owned())
        .filter(|word| !word.is_empty())
        .collect();
    let kind = words.first()?.to_ascii_uppercase();
    let (routine, titled) = match kind.as_str() {
        "MAIN" if words.len() == 1 => (Routine::Main, false),
        "SBR" => (Routine::Subroutine, true),
        "INT" => (Routine::Interrupt, true),
        _ if kind.starts_with("SBR_") => (Routine::Subroutine, false),
        _ if kind.starts_with("INT_") => (Routine::Interrupt, false),
        _ => return None,
    };
    let mut rest = &words[usize::from(titled || routine == Routine::Main)..];
    let class = match routine {
        Routine::Interrupt => DeviceClass::I,
        Routine::Main | Routine::Subroutine => DeviceClass::P,
    };
    let mut pointer = None;
    if let Some((last, before)) = rest.split_last()
        && let Some(device) = super::device(last).filter(|device| device.class == class)
    {
        pointer = Some(device);
        rest = before;
    }
    let name = rest.first().cloned();
    let whole = rest.len() <= 1;
    let fault = match routine {
        // INT is an instruction, too, whose first operand can be read.
        Routine::Interrupt if titled && (!whole || pointer.is_none()) => {
            name.as_deref().filter(|name| whole && is_name(name))?;
            Some("add the interrupt pointer: `INT name I001`")
        }
        Routine::Interrupt if pointer.is_none() => Some("add the interrupt pointer: `INT_01 I001`"),
        _ if !whole => Some("a name is one word, which a pointer may follow: `SBR name P1`"),
        Routine::Subroutine if name.is_none() && pointer.is_none() => {
            Some("add the name of the subroutine: `SBR name`")
        }
        Routine::Main | Routine::Subroutine | Routine::Interrupt => None,
    };
    Some(Heading {
        routine,
        name,
        pointer,
        place: first.start..end,
        fault,
    })
}

/// Returns true if a comment can be the name of a window.
pub(crate) fn is_window_name(comment: &str) -> bool {
    is_name(comment) && Folded::of(comment).text == comment
}

/// Returns true if a word can only be a name.
fn is_name(word: &str) -> bool {
    let mut faults = Faults::default();
    grammar::parse(&grammar::operand_field(), word, &mut faults);
    !faults.is_empty() && word.chars().all(|c| c.is_alphanumeric() || c == '_')
}

/// Position of the word after `CALL`, if the line ends with it.
fn called(line: &str) -> Option<Range<usize>> {
    let mut places = words(instruction(line)).peekable();
    places.next_if(|place| line[place.clone()].bytes().all(|b| b.is_ascii_digit()));
    let mnemonic = Folded::of(&line[places.next()?]).text;
    let calls = mnemonic.eq_ignore_ascii_case("CALL") || mnemonic.eq_ignore_ascii_case("CALLP");
    let to = places.next().filter(|_| calls)?;
    places.next().is_none().then_some(to)
}

/// Returns true if a line may contain a call; most lines do not.
fn may_call(line: &str) -> bool {
    let letter = |c: char| matches!(c, 'C' | 'c' | 'Ｃ' | 'ｃ');
    let code = line.trim_start_matches(|c: char| c.is_ascii_digit() || c.is_whitespace());
    code.starts_with(letter)
}

impl Reader {
    /// Takes a line that begins a window, or calls one by name. Returns whether it is such a line.
    pub(super) fn window_line(&mut self, windows: &mut Windows, line: &str, start: u32) -> bool {
        if let Some(heading) = windows.headings.get(&start) {
            let begins = windows.current.is_none() && heading.routine == Routine::Main;
            if !begins || !self.program.instrs.is_empty() {
                self.end_window(windows.current, start);
            }
            windows.current = Some(heading.routine);
            self.begin_window(heading, line, start);
            return true;
        }
        let Some(place) = may_call(line).then(|| called(line)).flatten() else {
            return false;
        };
        let name = Folded::of(&line[place.clone()]).text;
        if let Some(pointer) = windows.names.get(&name) {
            let folded = Folded::replaced(line, place, &pointer.to_string());
            self.folded_line(line, &folded, start);
            return true;
        }
        self.call(windows, &name, line, start)
    }

    /// Takes a call of something that no window is called; a pointer is the usual case.
    fn call(&mut self, windows: &Windows, name: &str, line: &str, start: u32) -> bool {
        let named = windows.any() || !name.is_ascii() || name.starts_with("SBR");
        if !named {
            return false;
        }
        let mut folded = Folded::default();
        folded.fold_line(line, &mut self.faults);
        let found = grammar::parse(&grammar::line(), &folded.text, &mut self.faults);
        let operand = found
            .as_ref()
            .and_then(|line| line.instr.as_ref()?.operands.first());
        let unreadable = operand.filter(|operand| operand.kind == OperandKind::Unreadable(None));
        if let (Some(operand), true) = (unreadable, self.faults.are_all(Kind::Operand)) {
            let (first, last) = folded.original(operand.span.start, operand.span.end);
            self.faults.drain().for_each(drop);
            let place = Span::new(first + start, last + start);
            self.diagnostics.push(windows.missing(name, place));
        }
        self.take(line, &folded.text, found, |span| {
            let (first, last) = folded.original(span.start, span.end);
            Span::new(first + start, last + start)
        });
        true
    }

    /// Takes the line that begins a window.
    fn begin_window(&mut self, heading: &Heading, line: &str, start: u32) {
        let span = Span::new(
            start + heading.place.start as u32,
            start + heading.place.end as u32,
        );
        if let Some(why) = heading.fault {
            let written = &line[heading.place.clone()];
            let error = codes::WINDOW_HEADING
                .at(span, phrase!("`{written}` does not begin a window", written))
                .label(why)
                .help("windows begin with `MAIN`, `SBR name` and `INT name I001`, the main program first");
            self.diagnostics.push(error);
        }
        let note = line[heading.place.end..]
            .split_once(';')
            .map(|(_, comment)| comment)
            .or_else(|| Some(line[heading.place.end..].split_once("//")?.1))
            .and_then(clean);
        let Some(pointer) = heading.pointer else {
            // A comment about the main program stays with its first instruction.
            if let Some(note) = note {
                self.statement.push(&note);
            }
            return;
        };
        self.push(pointer.to_smolstr(), span, Operands::new(), None);
        if let (Some(label), Some(_)) = (self.program.instrs.last_mut(), &note) {
            label.remarks_mut().note = note;
        }
        // A comment that the text states stays, and the editor's own name is none.
        let name = heading.name.as_ref();
        if let Some(name) = name.filter(|name| **name != usual_name(pointer)) {
            let comments = &mut self.program.comments;
            comments.entry(pointer).or_insert_with(|| name.clone());
        }
    }

    /// Ends a window: where the next one begins or, after the last one, at the end of the text.
    fn end_window(&mut self, current: Option<Routine>, at: u32) {
        let instrs = &mut self.program.instrs;
        let routine = current.unwrap_or(Routine::Main);
        // END of a window is the end of the program only after the last one.
        let end = instrs.pop_if(|instr| instr.mnemonic == "END");
        if instrs
            .last()
            .is_some_and(|instr| instr.mnemonic == routine.end())
        {
            return;
        }
        match end {
            Some(mut end) if routine == Routine::Main => {
                end.mnemonic = routine.end().into();
                instrs.push(end);
            }
            _ => instrs.push(implied(routine.end(), at)),
        }
    }

    /// Ends the last window and the program.
    pub(super) fn end_windows(&mut self, windows: &Windows, at: u32) {
        if !windows.any() {
            return;
        }
        let end = self.program.instrs.pop_if(|instr| instr.mnemonic == "END");
        if windows.current != Some(Routine::Main) {
            self.end_window(windows.current, at);
        }
        let end = end.unwrap_or_else(|| implied("END", at));
        self.program.instrs.push(end);
    }
}

/// An instruction that the text leaves out.
fn implied(mnemonic: &str, at: u32) -> Instr {
    let span = Span::new(at, at);
    Instr {
        mnemonic: mnemonic.into(),
        mnemonic_span: span,
        operands: Operands::new(),
        span,
        step: None,
        remarks: None,
    }
}

impl Windows {
    /// A call of a window that is not there.
    fn missing(&self, name: &str, span: Span) -> Diagnostic {
        let error = codes::UNKNOWN_WINDOW.at(span, phrase!("no window is called `{name}`", name));
        // Of a single character, any other would be near.
        let names = self.names.keys().map(String::as_str);
        let near = did_you_mean(name, names).filter(|_| name.chars().count() > 1);
        match near {
            Some(near) => error
                .label("no subroutine has this name")
                .help(phrase!("did you mean `{near}`?", near)),
            None => error.label("no subroutine has this name").help(phrase!("put the heading `SBR {name}` above the list of this subroutine, or write the pointer that is called", name)),
        }
    }
}
