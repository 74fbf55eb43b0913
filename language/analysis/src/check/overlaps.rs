//! Registers that belong to the result of one instruction and are written by another.
//!
//! Two 32-bit values that begin at neighbouring registers are the business of [`super::pairs`].

use super::drives::{Drives, Lasts};
use super::{Code, Part as Place};
use crate::accesses::Access;
use rungc_catalogue::{ArithOp, Basic, Lower, Role};
use rungc_models::runs::is_special;
use rungc_syntax::{Device, DeviceClass, Diagnostic, Diagnostics, Span, codes, phrase};
use rustc_hash::FxHashMap;

/// A result of several words: 32 bits, a double result, a quotient with its remainder.
struct Result {
    at: usize,
    span: Span,
    /// Number of words.
    words: u32,
    /// Number of words in one value.
    each: u32,
}

/// A write to a register that may be part of a result.
#[derive(Clone, Copy)]
struct Part {
    at: usize,
    span: Span,
    /// True if the register is a source of the instruction, too.
    uses: bool,
}

/// Collects the registers that instructions write.
#[derive(Default)]
pub(super) struct Overlaps {
    /// Results of several words by their first register; the longest, where several begin there.
    results: FxHashMap<Device, Result>,
    /// By its first register, the first thing written there that is shorter than a result and not 0; one that does not
    /// take the register as a source, if there is any.
    parts: FxHashMap<Device, Part>,
    /// Blocks that are written as a whole, with their lengths.
    blocks: Vec<(Device, u32, usize, Span)>,
}

/// A longer result than this is a block.
const MAX_RESULT: u32 = 4;

impl Overlaps {
    /// Takes an access of instruction `i`.
    pub(super) fn note(&mut self, code: &Code, i: usize, access: &Access) {
        let first = access.first;
        let register = matches!(first.class, DeviceClass::D | DeviceClass::R);
        let Some(count) = access.count.filter(|_| register && access.writes()) else {
            return;
        };
        if is_special(first.class, first.number) || clears(code, i) {
            return;
        }
        let span = access.span;
        match count {
            2..=MAX_RESULT if access.each == 2 || divides_or_multiplies(code, i) => {
                let result = Result {
                    at: i,
                    span,
                    words: count,
                    each: access.each,
                };
                let known = self
                    .results
                    .entry(first)
                    .or_insert(Result { words: 0, ..result });
                if known.words < count {
                    *known = result;
                }
                if count == 2 {
                    self.note_part(code, i, access);
                }
            }
            0 | 1 => self.note_part(code, i, access),
            2..=MAX_RESULT => {}
            _ => self.blocks.push((first, count, i, span)),
        }
    }

    fn note_part(&mut self, code: &Code, i: usize, access: &Access) {
        let mut sources = code.accesses(i).filter(|source| source.role == Role::Read);
        let part = Part {
            at: i,
            span: access.span,
            uses: sources.any(|source| source.devices().contains(&access.first)),
        };
        let known = self.parts.entry(access.first).or_insert(part);
        if known.uses && !part.uses {
            *known = part;
        }
    }

    /// Warns of results of which another instruction overwrites a part.
    pub(super) fn report(self, code: &Code, out: &mut Diagnostics) {
        let mut found = Vec::new();
        for (&first, result) in &self.results {
            let inside = (1..result.words).find_map(|offset| {
                let number = first.number.checked_add(offset)?;
                let device = Device { number, ..first };
                let &Part { at, span, uses } = self.parts.get(&device)?;
                // A remainder that is dropped, or replaced by what is made of it, as the digits of a number are.
                let unneeded = || uses || is_dropped(code, (first, result), at);
                if is_remainder(code, result, offset) && unneeded() {
                    return None;
                }
                // Two pairs, which have a separate warning.
                let pairs = self
                    .results
                    .get(&device)
                    .is_some_and(|other| other.at == at && other.each == 2);
                (!(pairs && result.words == 2 && result.each == 2)).then_some((device, at, span))
            });
            // A program that also writes the low word by itself composes the value from its words.
            let composed = self
                .parts
                .get(&first)
                .is_some_and(|part| part.at != result.at);
            if let Some((device, at, span)) = inside.filter(|_| !composed) {
                found.push(overwritten(code, (first, result), device, at, span));
            }
        }
        for &(first, count, at, span) in &self.blocks {
            for edge in [first.number, first.number.saturating_add(count)] {
                found.extend(self.cut(
                    code,
                    Device {
                        number: edge,
                        ..first
                    },
                    at,
                    span,
                ));
            }
        }
        found.sort_by_key(|diagnostic| diagnostic.span);
        out.extend(found);
    }

    /// A block that begins or ends before `edge`, inside a 32-bit value.
    fn cut(&self, code: &Code, edge: Device, at: usize, span: Span) -> Option<Diagnostic> {
        let number = edge.number.checked_sub(1)?;
        let first = Device { number, ..edge };
        let result = self.results.get(&first).filter(|result| result.each == 2)?;
        Some(overwritten(code, (first, result), first, at, span))
    }
}

/// Returns true if the result of an instruction has twice as many words as its operands.
fn divides_or_multiplies(code: &Code, i: usize) -> bool {
    let op = match code.lower(i) {
        Some(Lower::Arith(op) | Lower::ArithSaturating(op)) => op,
        _ => return false,
    };
    matches!(op, ArithOp::Mul | ArithOp::Div)
}

/// Returns true if a word of a result belongs to the remainder of a division.
fn is_remainder(code: &Code, result: &Result, offset: u32) -> bool {
    let divides = matches!(
        code.lower(result.at),
        Some(Lower::Arith(ArithOp::Div) | Lower::ArithSaturating(ArithOp::Div))
    );
    divides && offset >= result.words / 2
}

/// Returns true if instruction `at` replaces a remainder whenever there is one, before anything reads it: both have the
/// same drive, which does not change between them.
fn is_dropped(code: &Code, (first, result): (Device, &Result), at: usize) -> bool {
    let mut drives = Drives::default();
    let mut drives = (0..=at).map(|i| drives.next(code, i));
    let before = drives.nth(result.at).flatten();
    let Some((before, then)) = before.zip(drives.last().flatten()) else {
        return false;
    };
    let between = result.at + 1..at;
    let in_turn = |i| {
        let leaves = matches!(code.basic(i), Some(Basic::Cj | Basic::Call));
        !leaves && !matches!(code.part(i), Place::Alone | Place::Unknown)
    };
    let lasts =
        then.lasts == Lasts::Always || between.clone().all(|i| code.part(i) != Place::Start);
    let numbers = first.number + result.words / 2..first.number + result.words;
    let reads = |access: Access| {
        let meets =
            access.first.number < numbers.end && access.devices().end().number >= numbers.start;
        access.reads() && access.first.class == first.class && (access.indexed || meets)
    };
    let is_pulse = |i: usize| code.resolved.instrs[i].form.pulse;
    before.signature == then.signature
        && lasts
        && (is_pulse(result.at) || !is_pulse(at))
        && between.clone().all(in_turn)
        && !between.flat_map(|i| code.accesses(i)).any(reads)
}

/// Returns true if an instruction sets its target to 0, as is done before a value is put together.
pub(super) fn clears(code: &Code, i: usize) -> bool {
    let Some(inst) = code.inst(i) else {
        return false;
    };
    let zero = || {
        let source = code.instr(i).operands.first();
        source.and_then(|source| source.kind.constant()) == Some(0)
    };
    match code.lower(i) {
        Some(Lower::Basic(Basic::Rst)) => true,
        Some(Lower::Move) => zero(),
        _ => inst.name == "ZRST" || inst.name == "FMOV" && zero(),
    }
}

fn overwritten(
    code: &Code,
    (first, result): (Device, &Result),
    part: Device,
    at: usize,
    span: Span,
) -> Diagnostic {
    let mnemonic = &code.instr(at).mnemonic;
    let last = Device {
        number: first.number + result.words - 1,
        ..first
    };
    let writer = &code.instr(result.at).mnemonic;
    let message = match part == first {
        true => {
            phrase!(
                "`{mnemonic}` writes one half of the 32-bit value in `{first}` and `{last}`",
                mnemonic,
                first,
                last
            )
        }
        false => phrase!(
            "`{mnemonic}` writes `{part}`, which is part of the result of `{writer}` at `{first}`",
            mnemonic,
            part,
            writer,
            first
        ),
    };
    codes::PARTS_OVERLAP
        .at(span, message)
        .label(phrase!(
            "overwrites part of `{first}` to `{last}`",
            first,
            last
        ))
        .other(
            result.span,
            phrase!(
                "`{writer}` writes `{first}` to `{last}`",
                writer,
                first,
                last
            ),
        )
        .help("use separate registers for each value")
}
