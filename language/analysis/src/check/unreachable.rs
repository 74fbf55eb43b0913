//! Instructions that never run.

use super::structure::{Nesting, Routine};
use super::{Code, Part};
use rungc_catalogue::Basic;
use rungc_syntax::{Diagnostics, codes};

/// Warns about runs of instructions after FEND, SRET and IRET that no label leads to.
pub(super) fn check(code: &Code, nesting: &Nesting, out: &mut Diagnostics) {
    let mut in_run = false;
    for i in 0..code.len {
        let dead = nesting.of(i).routine == Routine::Nothing && code.part(i) != Part::Nothing;
        let frame = matches!(
            code.basic(i),
            Some(Basic::End | Basic::Fend | Basic::Sret | Basic::Iret | Basic::Pret)
        );
        if dead && !frame && !in_run {
            let diagnostic = codes::UNREACHABLE
                .at(code.span(i), "this never runs")
                .label("no label leads here, and the code before it has ended")
                .help("put a label before it, or move it before FEND");
            out.push(diagnostic);
        }
        in_run = dead && !frame;
    }
}
