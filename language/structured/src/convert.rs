//! Functions that convert types.

use crate::types::Ty;

/// Instructions of a conversion.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Steps {
    /// The value stays as it is.
    Same,
    /// 16 to 32 bits with the sign: a multiplication by 1.
    Sign,
    /// 16 to 32 bits, the upper word 0.
    Zero,
    /// The lower word.
    Low,
    /// 1 or 0, from a condition.
    FromBit,
    /// A comparison with 0.
    ToBit,
    /// An instruction of a REAL, with M8023 off or not used.
    Float(&'static str),
    /// The same from an integer, for which M8023 has to be off.
    ToFloat(&'static str),
}

/// A conversion: from, into, and its steps.
pub(crate) type Conversion = (Ty, Ty, Steps);

static CONVERSIONS: [(&str, Conversion); 33] = [
    ("INT_TO_DINT", (Ty::Int, Ty::Dint, Steps::Sign)),
    ("INT_TO_WORD", (Ty::Int, Ty::Word, Steps::Same)),
    ("WORD_TO_INT", (Ty::Word, Ty::Int, Steps::Same)),
    ("WORD_TO_DINT", (Ty::Word, Ty::Dint, Steps::Zero)),
    ("WORD_TO_DWORD", (Ty::Word, Ty::Dword, Steps::Zero)),
    ("DINT_TO_INT", (Ty::Dint, Ty::Int, Steps::Low)),
    ("DINT_TO_WORD", (Ty::Dint, Ty::Word, Steps::Low)),
    ("DWORD_TO_INT", (Ty::Dword, Ty::Int, Steps::Low)),
    ("DWORD_TO_WORD", (Ty::Dword, Ty::Word, Steps::Low)),
    ("DINT_TO_DWORD", (Ty::Dint, Ty::Dword, Steps::Same)),
    ("DWORD_TO_DINT", (Ty::Dword, Ty::Dint, Steps::Same)),
    ("DINT_TO_TIME", (Ty::Dint, Ty::Time, Steps::Same)),
    ("TIME_TO_DINT", (Ty::Time, Ty::Dint, Steps::Same)),
    ("DWORD_TO_TIME", (Ty::Dword, Ty::Time, Steps::Same)),
    ("TIME_TO_DWORD", (Ty::Time, Ty::Dword, Steps::Same)),
    ("INT_TO_TIME", (Ty::Int, Ty::Time, Steps::Sign)),
    ("WORD_TO_TIME", (Ty::Word, Ty::Time, Steps::Zero)),
    ("TIME_TO_INT", (Ty::Time, Ty::Int, Steps::Low)),
    ("TIME_TO_WORD", (Ty::Time, Ty::Word, Steps::Low)),
    ("BOOL_TO_INT", (Ty::Bool, Ty::Int, Steps::FromBit)),
    ("BOOL_TO_WORD", (Ty::Bool, Ty::Word, Steps::FromBit)),
    ("BOOL_TO_DINT", (Ty::Bool, Ty::Dint, Steps::FromBit)),
    ("BOOL_TO_DWORD", (Ty::Bool, Ty::Dword, Steps::FromBit)),
    ("BOOL_TO_TIME", (Ty::Bool, Ty::Time, Steps::FromBit)),
    ("INT_TO_BOOL", (Ty::Int, Ty::Bool, Steps::ToBit)),
    ("WORD_TO_BOOL", (Ty::Word, Ty::Bool, Steps::ToBit)),
    ("DINT_TO_BOOL", (Ty::Dint, Ty::Bool, Steps::ToBit)),
    ("DWORD_TO_BOOL", (Ty::Dword, Ty::Bool, Steps::ToBit)),
    ("TIME_TO_BOOL", (Ty::Time, Ty::Bool, Steps::ToBit)),
    ("INT_TO_REAL", (Ty::Int, Ty::Real, Steps::ToFloat("FLT"))),
    ("DINT_TO_REAL", (Ty::Dint, Ty::Real, Steps::ToFloat("DFLT"))),
    ("REAL_TO_INT", (Ty::Real, Ty::Int, Steps::Float("INT"))),
    ("REAL_TO_DINT", (Ty::Real, Ty::Dint, Steps::Float("DINT"))),
];

/// Names of all conversions.
pub(crate) fn names() -> impl Iterator<Item = &'static str> {
    CONVERSIONS.iter().map(|(name, _)| *name)
}

/// The conversion of this name.
pub(crate) fn find(name: &str) -> Option<Conversion> {
    let mut all = CONVERSIONS.iter();
    let found = all.find(|(known, _)| known.eq_ignore_ascii_case(name));
    found.map(|(_, conversion)| *conversion)
}
