//! Codes of instructions that nothing proves yet, and those that a user has learned from an export.

use crate::gx::{hex, table};
use rungc_syntax::{Diagnostic, Operands, Span, codes};
use smol_str::SmolStr;
use std::collections::BTreeMap;

/// Codes of instructions that an export of the editor has shown (`rungc learn`): the table `[tokens]` of `rungc.toml`.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct LearnedCodes(BTreeMap<Vec<u8>, SmolStr>);

/// Reason why a code cannot be learned.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
pub enum LearnError {
    /// It is not the code of an instruction.
    #[error("`{0}` is not the code of an instruction, which starts with a byte below 80")]
    NotACode(String),
    /// It is known to be another instruction.
    #[error("the code {code} is known to be `{known}`, not `{mnemonic}`")]
    Known {
        /// The code.
        code: String,
        /// Known meaning.
        known: &'static str,
        /// Meaning to be learned.
        mnemonic: String,
    },
}

impl LearnedCodes {
    /// Adds a code, the body of its tokens, with its instruction, in upper case.
    ///
    /// # Errors
    /// If that is not the code of an instruction, or that of one which is known to be another.
    pub fn insert(&mut self, code: &[u8], mnemonic: &str) -> Result<(), LearnError> {
        if !matches!(code, [0x00..=0x7F, ..]) {
            return Err(LearnError::NotACode(hex(code)));
        }
        match table::proven(code) {
            Some(known) if known != mnemonic => Err(LearnError::Known {
                code: hex(code),
                known,
                mnemonic: mnemonic.to_owned(),
            }),
            _ => {
                self.0.insert(code.to_vec(), mnemonic.into());
                Ok(())
            }
        }
    }

    /// The instruction that was learned for a code.
    pub fn get(&self, code: &[u8]) -> Option<&SmolStr> {
        self.0.get(code)
    }
}

/// An instruction of a project whose code nothing proves.
#[derive(Clone, PartialEq, Debug)]
pub struct Unproven {
    /// Its code: the bytes between the lengths of its token, operands not included.
    pub code: Vec<u8>,
    /// Reading of the code.
    pub reading: Reading,
    /// Its place in the program's instructions; if it was not read, of the one that follows it.
    pub at: usize,
    /// Its step number, as far as that is known.
    pub step: Option<u32>,
    /// The offset of its token in the file or stream, in bytes.
    pub offset: usize,
    /// Its operands, as far as they can be read.
    pub operands: Operands,
    /// Its place in the source's text.
    pub span: Span,
}

/// Reading of an instruction whose code nothing proves.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Reading {
    /// As this, which follows from the codes around it.
    Derived(SmolStr),
    /// Not at all, although it may be this.
    Guess(SmolStr),
    /// Not at all.
    Unknown,
}

impl Unproven {
    /// Returns true if it is one of the program's instructions.
    pub fn is_read(&self) -> bool {
        matches!(self.reading, Reading::Derived(_))
    }

    /// Its code as people read it: `63 09 20`.
    pub fn shown(&self) -> String {
        hex(&self.code)
    }

    /// Number of steps that its code states.
    pub fn steps(&self) -> u32 {
        crate::gx::steps(&self.code)
    }

    /// The error that it is not read.
    pub(crate) fn error(&self) -> Diagnostic {
        let code = self.shown();
        let what = match &self.reading {
            Reading::Guess(name) => format!("instruction code {code}, possibly `{name}`,"),
            _ => format!("unknown instruction code {code}"),
        };
        let step = self.step.map(|step| format!("step {step}, "));
        let operands: Vec<_> = self.operands.iter().map(|o| o.kind.to_string()).collect();
        let operands = match operands.as_slice() {
            [] => "no operands".to_owned(),
            operands => format!("operands `{}`", operands.join(" ")),
        };
        let message = format!(
            "{what} at {}offset 0x{:04X}: {} steps, {operands}",
            step.unwrap_or_default(),
            self.offset,
            self.steps()
        );
        codes::UNKNOWN_BYTES
            .at(self.span, message)
            .label("no project or published table shows this code")
            .help("export the list from the editor: `rungc learn PROJECT EXPORT` learns the code from it")
    }
}

/// The note that names all codes that were derived, if any.
pub(crate) fn note(unproven: &[Unproven]) -> Option<Diagnostic> {
    let mut uses: Vec<(&[u8], &SmolStr, usize)> = Vec::new();
    let read = unproven
        .iter()
        .filter_map(|unproven| match &unproven.reading {
            Reading::Derived(name) => Some((unproven, name)),
            _ => None,
        });
    let (first, _) = read.clone().next()?;
    for (unproven, name) in read {
        match uses.iter_mut().find(|(code, ..)| *code == unproven.code) {
            Some((.., count)) => *count += 1,
            None => uses.push((&unproven.code, name, 1)),
        }
    }
    let list: Vec<_> = uses
        .iter()
        .map(|(code, name, count)| match count {
            1 => format!("`{name}` ({})", hex(code)),
            _ => format!("`{name}` ({}, {count} times)", hex(code)),
        })
        .collect();
    Some(
        codes::DERIVED_CODES
            .at(
                first.span,
                format!("read by codes that no project has shown yet: {}", list.join(", ")),
            )
            .label("the first of them")
            .help("compare with the editor; `rungc learn PROJECT EXPORT` confirms the codes from a list that it exports"),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_codes_of_instructions_are_learned() {
        let mut learned = LearnedCodes::default();
        for code in [&[][..], &[0xA8, 0], &[0x80]] {
            let refused = learned.insert(code, "DSZR");
            assert!(matches!(refused, Err(LearnError::NotACode(_))), "{code:?}");
        }
        learned.insert(&[0x63, 9, 0x77], "DSZR").unwrap();
        assert_eq!(learned.get(&[0x63, 9, 0x77]).unwrap(), "DSZR");
    }

    #[test]
    fn known_codes_stay_what_they_are() {
        let mut learned = LearnedCodes::default();
        let refused = learned.insert(&[0x56, 9, 2], "FROM").unwrap_err();
        assert_eq!(
            refused.to_string(),
            "the code 56 09 02 is known to be `TO`, not `FROM`"
        );
        assert_eq!(learned.insert(&[0x56, 9, 2], "TO"), Ok(()));
        let derived = learned.insert(&[0x53, 1, 0x21], "ANR");
        assert_eq!(derived, Ok(()));
    }
}
