//! The table of diagnostic codes: what each means, with a program that is wrong and one that is right.
//!
//! | codes | about |
//! |---|---|
//! | E00xx | reading files and text, instructions that are not known, settings of a project (E004x) |
//! | E01xx | devices and operands |
//! | E02xx, W024x | structured text |
//! | E03xx | operand counts |
//! | E04xx | contact logic, structure and flow |
//! | W02xx | legal, but causes trouble in practice |
//! | W03xx | where compiled programs differ from the PLC |
//! | W05xx | what the source says of itself does not fit |
//! | W06xx, N06xx, W07xx | how serial ports and the CAN card are set up |
//! | E080x, W080x, E0821, W0821 | properties that are verified |
//! | E082x | connections of a running program |
//! | E083x | what a search of runs finds |
//! | E085x, W085x | boards, and writing images into them |
//! | E087x | fleets of PLCs |
//! | E088x | test files, machines, boards |
//! | W090x | what can never happen in a program (`check --deep`) |
//! | N00xx | worth knowing: how the source was read |
//!
//! A code never changes its meaning and is never reused.

use crate::Span;
use crate::diag::{Diagnostic, Severity};

mod boards;
mod explore;
mod files;
mod fleets;
mod labels;
mod logic;
mod modules;
mod operands;
mod ports;
mod practice;
mod project;
mod properties;
mod reading;
mod structure;
mod structured;
mod vendor;

pub use boards::*;
pub use explore::*;
pub use files::*;
pub use fleets::*;
pub use labels::*;
pub use logic::*;
pub use modules::*;
pub use operands::*;
pub use ports::*;
pub use practice::*;
pub use project::*;
pub use properties::*;
pub use reading::*;
pub use structure::*;
pub use structured::*;
pub use vendor::*;

/// One row of the table.
#[derive(Debug)]
pub struct Code {
    /// Stable identifier, e.g. `E0106`.
    pub id: &'static str,
    /// Name for messages and options, e.g. `double-coil`.
    pub name: &'static str,
    /// Severity.
    pub severity: Severity,
    /// The FX family's error number for it, where there is one.
    pub plc_error: Option<u16>,
    /// Title, in half a line.
    pub title: &'static str,
    /// Explanation for `rungc explain`.
    pub text: &'static str,
    /// Model that the examples are for, if it matters.
    pub model: Option<&'static str>,
    /// Instruction list that is wrong in this way; empty if a list cannot show it.
    pub wrong: &'static str,
    /// The same put right; empty if a list cannot show it.
    pub right: &'static str,
}

impl Code {
    /// A diagnostic with this code, its severity and its PLC error number.
    pub fn at(&self, span: Span, message: impl Into<crate::Phrase>) -> Diagnostic {
        let mut diagnostic = Diagnostic::new(self.severity, self.id, span, message);
        diagnostic.plc_error = self.plc_error;
        diagnostic
    }
}

/// Errors that are limits of the PLC which a compiled program does not share: it can be compiled nevertheless.
static EASED: [&Code; 5] = [
    &LIMITS,
    &TOO_MANY_BLOCKS,
    &TOO_MANY_BRANCHES,
    &DEEP_FOR,
    &STL_ROW,
];

/// Errors that seem to be such limits, and why nothing can be compiled.
static NOT_EASED: [(&Code, &str); 6] = [
    (
        &NOT_ON_MODEL,
        "its operands are known only for the models that have it; choose one with --model",
    ),
    (&NO_SUCH_FORM, "what this form would do is not defined"),
    (
        &NO_DEVICE,
        "there is no storage for a device that the model does not have; choose a model that has it with --model",
    ),
    (
        &PAST_THE_END,
        "there is no storage past the end of a range; choose a model with more devices with --model",
    ),
    (
        &NOT_THIS_NUMBER,
        "the model's hardware does not serve this device; choose a model that does with --model",
    ),
    (
        &TOO_OFTEN,
        "the effect of using more of these instructions is not known",
    ),
];

impl Code {
    /// Checks whether the error is a limit of the PLC that a compiled program does not share, so that it can be made a
    /// warning.
    ///
    /// # Errors
    ///
    /// The reason for which it cannot, as the end of a sentence.
    pub fn can_be_eased(&self) -> Result<(), &'static str> {
        if EASED.iter().any(|code| code.id == self.id) {
            return Ok(());
        }
        let known = NOT_EASED.iter().find(|(code, _)| code.id == self.id);
        Err(known.map_or("nothing can be compiled with it", |(_, why)| why))
    }
}

/// The codes of errors that can be made warnings, in order.
pub fn eased() -> impl Iterator<Item = &'static Code> {
    EASED.iter().copied()
}

/// All codes, in order of their identifiers.
pub fn all() -> Vec<&'static Code> {
    let families = [
        reading::TABLE,
        project::TABLE,
        operands::TABLE,
        ports::TABLE,
        logic::TABLE,
        structure::TABLE,
        structured::TABLE,
        labels::TABLE,
        practice::TABLE,
        modules::TABLE,
        vendor::TABLE,
        properties::TABLE,
        explore::TABLE,
        boards::TABLE,
        files::TABLE,
        fleets::TABLE,
    ];
    let mut all: Vec<_> = families.into_iter().flatten().copied().collect();
    all.sort_by_key(|code| code.id);
    all
}

/// The code with this identifier (`E0106`, in either case) or name (`double-coil`).
pub fn find(name: &str) -> Option<&'static Code> {
    all()
        .into_iter()
        .find(|code| code.id.eq_ignore_ascii_case(name) || code.name == name)
}

/// Rows of the table as constants, and a `TABLE` of them.
macro_rules! codes {
    ($(
        $constant:ident = $id:literal $name:literal $severity:ident $plc:expr,
        $title:literal,
        $text:literal,
        $(model: $model:literal,)?
        wrong: $wrong:expr,
        right: $right:expr;
    )*) => {
        $(
            #[doc = concat!($id, ": ", $title, ".")]
            pub static $constant: $crate::codes::Code = $crate::codes::Code {
                id: $id,
                name: $name,
                severity: $crate::diag::Severity::$severity,
                plc_error: $plc,
                title: $title,
                text: $text,
                model: $crate::codes::codes!(@model $($model)?),
                wrong: $wrong,
                right: $right,
            };
        )*
        pub(super) static TABLE: &[&$crate::codes::Code] = &[$(&$constant),*];
    };
    (@model) => { None };
    (@model $model:literal) => { Some($model) };
}
use codes;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identifiers_and_names_are_unique() {
        let mut ids: Vec<_> = all().iter().map(|code| code.id).collect();
        let mut names: Vec<_> = all().iter().map(|code| code.name).collect();
        let count = ids.len();
        ids.dedup();
        names.sort_unstable();
        names.dedup();
        assert_eq!((ids.len(), names.len()), (count, count));
    }

    #[test]
    fn the_letter_tells_the_severity() {
        for code in all() {
            assert!(code.id.starts_with(code.severity.letter()), "{}", code.id);
        }
    }

    #[test]
    fn every_code_is_explained() {
        for code in all() {
            assert!(
                !code.title.ends_with('.') && code.text.ends_with('.'),
                "{}",
                code.id
            );
            assert_eq!(code.wrong.is_empty(), code.right.is_empty(), "{}", code.id);
        }
    }

    #[test]
    fn limits_are_errors_that_can_be_eased() {
        assert!(eased().all(|code| code.severity == Severity::Error));
        assert_eq!(LIMITS.can_be_eased(), Ok(()));
        let storage = NO_DEVICE.can_be_eased();
        assert!(storage.is_err_and(|why| why.contains("storage")));
        assert!(OPEN_FOR.can_be_eased().is_err());
    }

    #[test]
    fn codes_are_found_by_identifier_and_name() {
        assert_eq!(find("e0106").map(|code| code.id), Some("E0106"));
        assert_eq!(find("double-coil").map(|code| code.id), Some("W0203"));
        assert!(find("E9999").is_none());
    }
}
