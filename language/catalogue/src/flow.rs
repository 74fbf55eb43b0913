//! Program flow.

use super::row::*;
use super::{Basic, Classes, Drive, Inst, Lower, Param};
use rungc_syntax::DeviceClass;

/// Pointers take index registers on HM (hm-motion-controller §5.1.8), and so on FX, see choices.md;
/// h1u-h2u-programming gives them none.
const LABEL: &[Param] = &[Param {
    indexable: true,
    ..pointer("P", Classes::P)
}];
const PLAIN_LABEL: &[Param] = &[pointer("P", Classes::P)];
/// P128 to P131 are encrypted subroutines, which can only be called.
const JUMP_LABEL: &[Param] = &[pointer("P", Classes::P).numbers(&[(DeviceClass::P, 0, 127)])];

const fn flow(name: &'static str, fnc: u16, title: &'static str, basic: Basic) -> Inst {
    row(name, title, "h1u-h2u-programming §4.3.1")
        .fnc(fnc)
        .lower(Lower::Basic(basic))
}

pub(super) const ROWS: &[Inst] = &[
    flow("CJ", 0, "Conditional jump", Basic::Cj)
        .forms(W16_P)
        .steps(3, 3)
        .takes(LABEL)
        .variants(&[on(INOVANCE).takes(JUMP_LABEL)])
        .errors(&[6701])
        .example("LD X000\nCJ P0\nLD X001\nOUT Y000\nP0\nLD X002\nOUT Y001")
        .text(
            "Continues at the label while driven; the instructions between are not executed and keep their state. P63 is the end of the scan.",
        ),
    flow("CALL", 1, "Subroutine call", Basic::Call)
        .forms(W16_P)
        .steps(3, 3)
        .takes(LABEL)
        .variants(&[on(INOVANCE).takes(PLAIN_LABEL)])
        .errors(&[6701, 6702])
        .example("LD X000\nCALL P0\nFEND\nP0\nLD X001\nOUT Y000\nSRET")
        .text("Runs the subroutine at the label up to SRET while driven, then continues after the CALL."),
    flow("SRET", 2, "Subroutine return", Basic::Sret)
        .drive(Drive::Alone)
        .example("LD X000\nCALL P0\nFEND\nP0\nLD X001\nOUT Y000\nSRET")
        .text("Ends a subroutine."),
    flow("IRET", 3, "Interrupt return", Basic::Iret)
        .drive(Drive::Alone)
        .example("EI\nLD X001\nOUT Y001\nFEND\nI001\nLD M8000\nINC D0\nIRET")
        .text("Ends an interrupt routine."),
    flow("EI", 4, "Enable interrupts", Basic::Ei)
        .drive(Drive::Alone)
        .example("EI\nLD X001\nOUT Y001\nFEND\nI001\nLD M8000\nINC D0\nIRET")
        .text("Interrupt routines may run from here on. They may not after the start of RUN."),
    flow("DI", 5, "Disable interrupts", Basic::Di)
        .drive(Drive::Alone)
        .example("EI\nLD X001\nOUT Y001\nDI\nLD X002\nOUT Y002\nEI\nFEND\nI001\nLD M8000\nINC D0\nIRET")
        .text("Interrupt requests are kept from here on until the next EI."),
    flow("FEND", 6, "End of the main program", Basic::Fend)
        .drive(Drive::Alone)
        .example("LD X000\nCALL P0\nFEND\nP0\nLD X001\nOUT Y000\nSRET")
        .text("Ends the main program; subroutines and interrupt routines follow."),
    flow("WDT", 7, "Watchdog refresh", Basic::Wdt)
        .forms(W16_P)
        .flags(&["D8000"])
        .text("Restarts the watchdog of the running scan."),
    flow("FOR", 8, "Loop", Basic::For)
        .steps(3, 3)
        .takes(&[src("S", VALUES)])
        .variants(&[on(HM).takes(&[src("S", CONSTANTS.or(GROUPS).or(DATA))])])
        .drive(Drive::Alone)
        .errors(&[6607])
        .example("FOR K4\nLD M8000\nADD D0 K1 D0\nNEXT")
        .text("Runs the instructions up to the matching NEXT S times in the same scan; S below 1 counts as 1."),
    flow("NEXT", 9, "End of a loop", Basic::Next)
        .drive(Drive::Alone)
        .example("FOR K4\nLD M8000\nADD D0 K1 D0\nNEXT")
        .text("Ends the loop that the last FOR began."),
    row("P", "Label", "h1u-h2u-programming §4.2")
        .variants(&[first_in(LIKE_FX3, Classes::P, 256, u32::MAX).steps(2, 2)])
        .drive(Drive::Alone)
        .lower(Lower::Basic(Basic::Label))
        .example("LD X000\nCJ P0\nLD X001\nOUT Y000\nP0\nLD X002\nOUT Y001")
        .text("Where CJ or CALL goes to, written as the pointer itself: P0."),
    row("I", "Interrupt routine", "h1u-h2u-programming §4.2")
        .drive(Drive::Alone)
        .lower(Lower::Basic(Basic::Label))
        .example("EI\nLD X001\nOUT Y001\nFEND\nI001\nLD M8000\nINC D0\nIRET")
        .text("The start of an interrupt routine, written as the pointer itself: I001. It ends with IRET."),
];
