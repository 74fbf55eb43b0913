//! Types of values, and which of them go together.

use rungc_syntax::{Argument, Say, phrase};

/// Type of a label, device or expression.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Ty {
    Bool,
    Int,
    Word,
    Dint,
    Dword,
    Real,
    Time,
    /// Characters: the most that there can be.
    Text(u16),
    /// Timer or counter of 16 bits: its contact, or its current value.
    Timer,
    /// Counter of 32 bits: its contact, or its current value.
    WideCounter,
    /// Register or group of 16 bits without a declared type.
    Raw16,
    /// Group of bits of more than four digits.
    Raw32,
    /// Integer constant without a type.
    Integer,
    /// Number with a fraction, without a type.
    Fraction,
}

/// Relation of a value to a place.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Fit {
    Fits,
    /// It does not, but a function converts it without loss.
    Converts,
    /// A conversion may lose a part of it.
    Loses,
    Unlike,
}

impl Ty {
    /// The elementary type of this name.
    pub(crate) fn named(name: &str) -> Option<Ty> {
        Some(match name.to_ascii_uppercase().as_str() {
            "BOOL" => Ty::Bool,
            "INT" => Ty::Int,
            "WORD" => Ty::Word,
            "DINT" => Ty::Dint,
            "DWORD" => Ty::Dword,
            "REAL" => Ty::Real,
            "TIME" => Ty::Time,
            "TIMER" => Ty::Timer,
            "COUNTER" => Ty::Timer,
            _ => return None,
        })
    }

    /// Returns true for the name of a type that needs no declaration.
    pub(crate) fn is_name(name: &str) -> bool {
        Ty::named(name).is_some() || name.eq_ignore_ascii_case("STRING")
    }

    /// Number of words that a value takes; 0 for a bit.
    pub(crate) const fn words(self) -> u32 {
        match self {
            Ty::Bool => 0,
            Ty::Int | Ty::Word | Ty::Timer | Ty::Raw16 | Ty::Integer => 1,
            // A byte 0 follows.
            Ty::Text(length) => length as u32 / 2 + 1,
            _ => 2,
        }
    }

    /// Returns true for values of 32 bits.
    pub(crate) const fn is_wide(self) -> bool {
        self.words() == 2 && !self.is_text()
    }

    /// Returns true for a text.
    pub(crate) const fn is_text(self) -> bool {
        matches!(self, Ty::Text(_))
    }

    /// Returns true for what has a contact.
    pub(crate) const fn is_bit(self) -> bool {
        matches!(self, Ty::Bool | Ty::Timer | Ty::WideCounter)
    }

    /// Returns true for whole numbers.
    pub(crate) const fn is_whole(self) -> bool {
        !matches!(self, Ty::Bool | Ty::Real | Ty::Fraction | Ty::Text(_))
    }

    /// Returns true for values without a sign.
    pub(crate) const fn is_unsigned(self) -> bool {
        matches!(self, Ty::Word | Ty::Dword)
    }

    /// Returns true for a constant without a type.
    pub(crate) const fn is_untyped(self) -> bool {
        matches!(self, Ty::Integer | Ty::Fraction)
    }

    /// Relation of a value of this type to a place of another.
    pub(crate) fn fit(self, place: Ty) -> Fit {
        use Ty::*;
        match (self, place) {
            (from, to) if from == to => Fit::Fits,
            (Text(from), Text(to)) if from < to => Fit::Fits,
            (Text(_), Text(_)) => Fit::Loses,
            (Text(_), _) | (_, Text(_)) => Fit::Unlike,
            (Integer, Bool) | (Fraction, Real) | (Integer, Real) => Fit::Fits,
            (Integer, _) => Fit::Fits,
            (Timer | WideCounter, Bool) => Fit::Fits,
            (Int | Word | Timer | Raw16, Timer | Raw16) => Fit::Fits,
            (Timer | Raw16, Int | Word) => Fit::Fits,
            (Dint | Dword | Time | WideCounter | Raw32, WideCounter | Raw32) => Fit::Fits,
            (WideCounter | Raw32, Dint | Dword | Time) => Fit::Fits,
            (Bool, _) | (_, Bool) => Fit::Unlike,
            (Real, _) => Fit::Loses,
            (Fraction, _) => Fit::Loses,
            (_, Real) => Fit::Converts,
            (from, to) if from.is_wide() && !to.is_wide() => Fit::Loses,
            _ => Fit::Converts,
        }
    }

    /// The common type of the operands of an operator; `None` if there is none.
    pub(crate) fn common(self, other: Ty) -> Option<Ty> {
        let (a, b) = (self, other);
        if a == b {
            return Some(a);
        }
        if let (Ty::Text(a), Ty::Text(b)) = (a, b) {
            return Some(Ty::Text(a.max(b)));
        }
        // Of a device and a declared type, the declared one says how the value is meant.
        let rank = |ty: Ty| match ty {
            Ty::Integer => 0,
            Ty::Fraction => 1,
            Ty::Timer | Ty::WideCounter => 2,
            Ty::Raw16 | Ty::Raw32 => 3,
            _ => 4,
        };
        let (low, high) = if rank(a) <= rank(b) { (a, b) } else { (b, a) };
        (high != Ty::Bool && low.fit(high) == Fit::Fits).then_some(high)
    }

    /// Name of the function that converts into another type, where there is one.
    pub(crate) fn conversion(self, to: Ty) -> Option<String> {
        let name = |ty: Ty| match ty {
            Ty::Raw16 | Ty::Timer => Some("INT"),
            Ty::Raw32 | Ty::WideCounter => Some("DINT"),
            Ty::Integer | Ty::Fraction => None,
            Ty::Bool => Some("BOOL"),
            Ty::Int => Some("INT"),
            Ty::Word => Some("WORD"),
            Ty::Dint => Some("DINT"),
            Ty::Dword => Some("DWORD"),
            Ty::Real => Some("REAL"),
            Ty::Time => Some("TIME"),
            Ty::Text(_) => Some("STRING"),
        };
        let function = format!("{}_TO_{}", name(self)?, name(to)?);
        let is_known = crate::convert::find(&function).is_some();
        (is_known || crate::texts::find(&function).is_some()).then_some(function)
    }
}

impl Say for Ty {
    fn said(&self) -> Argument {
        let name = match self {
            Ty::Text(length) => phrase!("a STRING({length})", length),
            Ty::Bool => phrase!("a BOOL"),
            Ty::Int => phrase!("an INT"),
            Ty::Word => phrase!("a WORD"),
            Ty::Dint => phrase!("a DINT"),
            Ty::Dword => phrase!("a DWORD"),
            Ty::Real => phrase!("a REAL"),
            Ty::Time => phrase!("a TIME"),
            Ty::Timer => phrase!("a timer or counter"),
            Ty::WideCounter => phrase!("a counter of 32 bits"),
            Ty::Raw16 => phrase!("a register of 16 bits"),
            Ty::Raw32 => phrase!("a group of 32 bits"),
            Ty::Integer => phrase!("a whole number"),
            Ty::Fraction => phrase!("a number with a fraction"),
        };
        name.said()
    }
}
