//! A program as the windows of AutoShop (h1u-h2u-programming §4.3.1): the main program, subroutines and interrupt
//! routines under headings, with jumps to labels `L` and calls by name.

use super::{closing, il_written, properties_without, spelled, statements};
use crate::il::{device, windows};
use rungc_syntax::{Device, DeviceClass, Diagnostic, Instr, Program, codes};
use std::collections::{BTreeMap, BTreeSet};

/// The pointer that is the end of the program.
const END: u32 = 63;

/// The program as the list of each window after its heading. What the windows cannot hold is an error.
pub fn to_autoshop(program: &Program) -> Result<String, Box<Diagnostic>> {
    let Divided { windows, below } = divide(program)?;
    let labels = windows.iter().filter_map(|window| window.label);
    let names = names(program, &labels.collect::<Vec<_>>());
    let mut out = properties_without(program, |device| names.get(device));
    for window in &windows {
        if !out.is_empty() {
            out.push('\n');
        }
        window.before.iter().for_each(|nop| remarks(&mut out, nop));
        heading(&mut out, window, &names);
        for instr in window.instrs {
            write(&mut out, instr, &names)?;
        }
        if let Some(end) = window.end {
            remarks(&mut out, end);
        }
    }
    below.iter().for_each(|instr| remarks(&mut out, instr));
    Ok(out + &closing(program))
}

/// The remarks of an instruction that the text leaves out.
fn remarks(out: &mut String, instr: &Instr) {
    statements(out, instr);
    out.extend(instr.note().map(|note| format!("; {note}\n")));
}

/// A program as windows.
struct Divided<'p> {
    windows: Vec<Window<'p>>,
    /// Instructions below the last window that the text leaves out.
    below: Vec<&'p Instr>,
}

/// A window's instructions, without what its end implies.
struct Window<'p> {
    /// The pointer of a routine.
    label: Option<Device>,
    /// Instructions without effect above it, for their remarks.
    before: &'p [Instr],
    /// Its label as written, with remarks.
    head: Option<&'p Instr>,
    instrs: &'p [Instr],
    /// The instruction that ends it, which the text leaves out.
    end: Option<&'p Instr>,
}

/// A label, as the pointer that it is.
fn label(instr: &Instr) -> Option<Device> {
    crate::il::is_label(&instr.mnemonic)
        .then(|| device(&instr.mnemonic))
        .flatten()
}

/// Returns true for an instruction that does nothing.
fn is_nop(instr: &Instr) -> bool {
    instr.mnemonic == "NOP"
}

/// Divides a program at FEND, SRET and IRET.
fn divide(program: &Program) -> Result<Divided<'_>, Box<Diagnostic>> {
    let instrs = program.instrs.as_slice();
    let is = |mnemonic: &'static str| move |instr: &Instr| instr.mnemonic == mnemonic;
    let end = instrs.iter().position(is("END")).unwrap_or(instrs.len());
    let mut after = instrs.iter().skip(end + 1);
    if let Some(after) = after.find(|instr| !is_nop(instr)) {
        return Err(refused(
            after,
            format!("`{after}` stands after END"),
            "never executed",
        ));
    }
    let (instrs, below) = instrs.split_at(end);
    let main = instrs.iter().position(is("FEND")).unwrap_or(end);
    // END ends the main window of a program without routines.
    let (last, below) = match main == end {
        true => (below.first(), below.get(1..).unwrap_or_default()),
        false => (None, below),
    };
    let mut windows = vec![Window {
        label: None,
        before: &[],
        head: None,
        instrs: &instrs[..main],
        end: instrs.get(main).or(last),
    }];
    let mut rest = instrs.get(main + 1..).unwrap_or_default();
    loop {
        // Between windows, NOP does nothing and has no place.
        let between = rest.iter().take_while(|instr| is_nop(instr)).count();
        let (skipped, routines) = rest.split_at(between);
        let Some((first, body)) = routines.split_first() else {
            let below = skipped.iter().chain(below).collect();
            return Ok(Divided { windows, below });
        };
        let pointer = label(first).ok_or_else(|| {
            let what = format!("`{first}` is in no subroutine and no interrupt routine");
            refused(first, what, "a routine begins with its label")
        })?;
        let (ending, class) = match pointer.class {
            DeviceClass::I => ("IRET", "interrupt routine"),
            _ => ("SRET", "subroutine"),
        };
        // A routine may return earlier; the last return before the next routine ends it.
        let ends = |at: usize| {
            let mut after = body[at + 1..].iter().filter(|instr| !is_nop(instr));
            let follows = |next: &Instr| label(next).is_some() || next.mnemonic == "FEND";
            body[at].mnemonic == ending && after.next().is_none_or(follows)
        };
        let next = (0..body.len()).find(|&at| ends(at));
        let length = next.map_or(body.len(), |at| at + 1);
        let Some((end, inside)) = body[..length]
            .split_last()
            .filter(|(last, _)| last.mnemonic == ending)
        else {
            let what = format!("the {class} `{first}` does not end with {ending}");
            return Err(refused(first, what, "its window ends there"));
        };
        if let Some(second) = inside.first().filter(|instr| label(instr).is_some()) {
            let what = format!("the {class} `{first}` has another label, `{second}`");
            return Err(refused(second, what, "a window has one name"));
        }
        windows.push(Window {
            label: Some(pointer),
            before: skipped,
            head: Some(first),
            instrs: inside,
            end: Some(end),
        });
        rest = &body[length..];
    }
}

/// Names of the routines: the comments of their pointers, where those can be names.
fn names(program: &Program, labels: &[Device]) -> BTreeMap<Device, String> {
    let mut used = BTreeSet::new();
    let mut names = BTreeMap::new();
    for &label in labels {
        let comment = program.comments.get(&label).map(String::as_str);
        let name = comment.filter(|name| windows::is_window_name(name) && !used.contains(*name));
        let name = name.map_or_else(|| windows::usual_name(label), str::to_owned);
        used.insert(name.clone());
        names.insert(label, name);
    }
    names
}

fn heading(out: &mut String, window: &Window, names: &BTreeMap<Device, String>) {
    let Some((pointer, head)) = window.label.zip(window.head) else {
        out.push_str("MAIN\n");
        return;
    };
    let kind = match pointer.class {
        DeviceClass::I => "INT",
        _ => "SBR",
    };
    let name = names.get(&pointer).map_or("", String::as_str);
    let pointer = pointer.to_string();
    let words = [kind, name, &pointer];
    // The editor's own names say what they are.
    let usual = name
        .strip_prefix(kind)
        .is_some_and(|rest| rest.starts_with('_'));
    write_words(out, head, &words[usize::from(usual)..]);
}

/// An instruction in AutoShop's terms.
fn write(
    out: &mut String,
    instr: &Instr,
    names: &BTreeMap<Device, String>,
) -> Result<(), Box<Diagnostic>> {
    let mut line = |words: &[&str]| write_words(out, instr, words);
    if let Some(pointer) = label(instr) {
        if pointer.class != DeviceClass::P {
            let what = format!("`{instr}` is within another routine");
            return Err(refused(
                instr,
                what,
                "a routine begins after the end of another",
            ));
        }
        line(&[&format!("L{}", pointer.number)]);
        return Ok(());
    }
    let target = instr
        .operands
        .first()
        .and_then(|operand| operand.kind.device());
    let target = target.filter(|target| target.class == DeviceClass::P);
    match (instr.mnemonic.as_str(), target) {
        ("CJ", Some(Device { number: END, .. })) => line(&["CJEND"]),
        ("CJP", Some(Device { number: END, .. })) => line(&["CJP", "END"]),
        ("CJ" | "CJP", Some(pointer)) if names.contains_key(&pointer) => {
            let what = format!("`{instr}` jumps into a subroutine");
            return Err(refused(instr, what, "only CALL can name a window"));
        }
        (jump @ ("CJ" | "CJP"), Some(pointer)) => {
            line(&[jump, &format!("L{}", pointer.number)]);
        }
        (call @ ("CALL" | "CALLP"), target) => {
            let name = target
                .and_then(|target| names.get(&target))
                .ok_or_else(|| {
                    let what = format!("no window can be named for `{instr}`");
                    refused(instr, what, "calls no label that begins a subroutine")
                })?;
            line(&[call, name]);
        }
        _ => {
            let operands = instr.operands.iter().map(|operand| spelled(&operand.kind));
            let operands: Vec<_> = operands.collect();
            let mut words = vec![instr.mnemonic.as_str()];
            words.extend(operands.iter().map(String::as_str));
            line(&words);
        }
    }
    Ok(())
}

/// A line of these words, with the remarks of an instruction.
fn write_words(out: &mut String, instr: &Instr, words: &[&str]) {
    statements(out, instr);
    let note = instr.note().map(|note| format!("; {note}"));
    il_written(out, words, note.as_deref());
    out.push('\n');
}

fn refused(instr: &Instr, what: String, label: &'static str) -> Box<Diagnostic> {
    let refused = codes::NO_WINDOWS.at(instr.span, what).label(label);
    Box::new(refused.help("`--to il` and `--to csv` write such programs"))
}
