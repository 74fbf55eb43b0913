//! The kinds of structures, and which of them may hold which.

use rungc_syntax::{Phrase, phrase};

/// Kinds of structures.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Kind {
    Mc,
    For,
    Stl,
    Sub,
    Interrupt,
}

/// Verdict on a structure that lies wholly inside another, or crosses its end.
pub(super) enum Verdict {
    Fine,
    /// An error, with the PLC's number.
    Error(u16),
}

/// The nesting table (h1u-h2u-programming §8.8). Its left half is lost in the manual; the remarks below it and the list
/// of errors (§8.7) state its contents.
pub(super) fn inside(outer: Kind, inner: Kind) -> Verdict {
    use Kind::{For, Interrupt, Mc, Stl, Sub};
    match (outer, inner) {
        (Mc, Mc | For | Stl) | (For, For) | (Stl, For | Stl) | (Sub | Interrupt, For) => {
            Verdict::Fine
        }
        (Mc, Sub | Interrupt) => Verdict::Error(6608),
        (For, Mc | Stl) => Verdict::Error(6619),
        (For, Sub | Interrupt) => Verdict::Error(6607),
        (Stl, Mc | Sub | Interrupt) => Verdict::Error(6605),
        (Sub | Interrupt, Mc | Stl | Sub | Interrupt) => Verdict::Error(6606),
    }
}

/// The same for a structure that starts inside another and ends after it.
pub(super) fn crossing(outer: Kind, inner: Kind) -> u16 {
    use Kind::{For, Interrupt, Mc, Stl, Sub};
    match (outer, inner) {
        (Mc, Mc | Stl) => 6608,
        (Mc, For) | (For, Mc | Stl) | (Stl, For) => 6619,
        (For, Sub) => 6701,
        (For, For | Interrupt) | (Sub | Interrupt, For) => 6607,
        (Stl, Mc | Stl) => 6605,
        (Mc | Stl | Sub | Interrupt, Sub | Interrupt) | (Sub | Interrupt, Mc | Stl) => 6606,
    }
}

impl Kind {
    /// Name in messages.
    pub(super) fn name(self) -> Phrase {
        match self {
            Kind::Mc => phrase!("master control zone"),
            Kind::For => phrase!("loop"),
            Kind::Stl => phrase!("step ladder"),
            Kind::Sub => phrase!("subroutine"),
            Kind::Interrupt => phrase!("interrupt routine"),
        }
    }

    /// One of them, in messages.
    pub(super) fn one(self) -> Phrase {
        match self {
            Kind::Mc => phrase!("a master control zone"),
            Kind::For => phrase!("a loop"),
            Kind::Stl => phrase!("a step ladder"),
            Kind::Sub => phrase!("a subroutine"),
            Kind::Interrupt => phrase!("an interrupt routine"),
        }
    }

    /// Mnemonic of its end.
    pub(super) fn end(self) -> &'static str {
        match self {
            Kind::Mc => "MCR",
            Kind::For => "NEXT",
            Kind::Stl => "RET",
            Kind::Sub => "SRET",
            Kind::Interrupt => "IRET",
        }
    }
}
