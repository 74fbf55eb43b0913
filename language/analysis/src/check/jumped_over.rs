//! Jumps that are always taken.

use super::drives::{Drive, Lasts};
use super::pointers::{Pointer, Pointers};
use super::structure::{Nesting, Routine};
use super::{Code, Part};
use rungc_catalogue::Basic;
use rungc_syntax::{Diagnostics, SourceKind, codes, phrase};

/// Collects what jumps without a condition make useless.
#[derive(Default)]
pub(super) struct JumpedOver {
    /// Up to where instructions are known never to run.
    until: usize,
}

impl JumpedOver {
    /// Takes instruction `i` and what drives it.
    pub(super) fn note(
        &mut self,
        code: &Code,
        i: usize,
        drive: Drive,
        (pointers, nesting): (&Pointers, &Nesting),
        out: &mut Diagnostics,
    ) {
        let jump = code.basic(i) == Some(Basic::Cj) && !code.resolved.instrs[i].form.pulse;
        let runs = i >= self.until && nesting.of(i).routine != Routine::Nothing;
        let Some(device) = code
            .device(i, 0)
            .filter(|_| jump && runs && drive.in_zone == Lasts::Always)
        else {
            return;
        };
        let label = pointers
            .get(device)
            .and_then(|pointer| pointer.labels.first());
        let zones = |i: usize| matches!(code.basic(i), Some(Basic::Mc | Basic::Mcr));
        match label {
            // Nothing ends a loop inside one zone once the zone runs.
            Some(&label) if label < i && !(label..i).any(zones) => backward(code, label, i, out),
            _ if drive.lasts != Lasts::Always => {}
            Some(&label) if label < i => backward(code, label, i, out),
            Some(&label) => self.forward(code, (i, label), pointers, out),
            None if code.model().end_pointer == Some(device.number) => {
                self.forward(code, (i, code.len), pointers, out);
            }
            None => {}
        }
    }

    /// The code after the jump, up to the next label that something leads to, never runs.
    fn forward(
        &mut self,
        code: &Code,
        (jump, label): (usize, usize),
        pointers: &Pointers,
        out: &mut Diagnostics,
    ) {
        let reached = |&i: &usize| {
            let named = |label| pointers.get(label).is_some_and(Pointer::is_named);
            let label = code.label(i);
            let ends = matches!(
                code.basic(i),
                Some(Basic::Fend | Basic::End | Basic::Sret | Basic::Iret | Basic::Pret)
            );
            ends || label.is_some_and(|label| pointers.any_may_be_meant() || named(label))
        };
        let end = (jump + 1..label).find(reached).unwrap_or(label);
        self.until = end;
        // The compiler of structured text reports statements that never run.
        if code.resolved.program.kind == SourceKind::StructuredText {
            return;
        }
        let mut skipped = (jump + 1..end).filter(|&i| code.part(i) != Part::Nothing);
        let Some(first) = skipped.next() else {
            return;
        };
        let last = skipped.next_back().unwrap_or(first);
        let diagnostic = codes::JUMPED_OVER
            .at(code.span(first), "these instructions never run")
            .label(phrase!("not run, up to `{last}`", last = code.instr(last)))
            .other(
                code.span(jump),
                "this jump has no condition that could be off",
            )
            .help("give the jump a condition, or remove the instructions it skips");
        out.push(diagnostic);
    }
}

/// The scan cannot leave the loop that the jump makes.
fn backward(code: &Code, label: usize, jump: usize, out: &mut Diagnostics) {
    let leaves = |i: usize| {
        matches!(
            code.basic(i),
            Some(
                Basic::Cj
                    | Basic::Fend
                    | Basic::End
                    | Basic::Sret
                    | Basic::Iret
                    | Basic::Pret
                    | Basic::Pend
            )
        )
    };
    if (label..jump).rev().any(leaves) {
        return;
    }
    let diagnostic = codes::ENDLESS_JUMP
        .at(
            code.span(jump),
            "nothing ends the loop that this jump forms",
        )
        .label("always jumps back …")
        .other(code.span(label), "… to here")
        .help("give the jump a condition that ends the loop");
    out.push(diagnostic);
}
