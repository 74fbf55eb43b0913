//! FROM, TO and operands `U0\G5`, held to the special modules that the settings fit.

use super::Code;
use crate::accesses;
use rungc_catalogue::{Lower, Role};
use rungc_rt::modules::{self, Access, Kind, Place};
use rungc_rt::{RtFn, Transfer};
use rungc_syntax::{Diagnostics, OperandKind, Span, codes, phrase};
use std::ops::Range;

/// The modules of a PLC.
pub(super) struct Modules(Vec<(u16, &'static Kind)>);

/// Words of buffer memory that an instruction names.
struct Words {
    unit: i64,
    /// Position of the module's number.
    unit_span: Span,
    /// Their numbers and where these are; `None` if they are known at run time only.
    run: Option<(Range<i64>, Span)>,
    written: bool,
}

impl Modules {
    pub(super) fn new(code: &Code) -> Self {
        let parameters = code.resolved.program.parameters.as_ref();
        let fitted = parameters.map_or(&[][..], |parameters| &parameters.modules);
        let fitted = fitted.iter();
        Modules(
            fitted
                .filter_map(|module| Some((module.unit, Kind::find(module.kind)?)))
                .collect(),
        )
    }

    /// Numbers and places of the modules.
    pub(super) fn places(&self) -> impl Iterator<Item = (u16, Place)> {
        self.0.iter().map(|(unit, kind)| (*unit, kind.place))
    }

    /// Checks instruction `i`; nothing if the settings fit no modules.
    pub(super) fn check(&self, code: &Code, i: usize, out: &mut Diagnostics) {
        if self.0.is_empty() || code.is_meant(i) {
            return;
        }
        if let Some(words) = transferred(code, i) {
            self.hold(&words, out);
        }
        let operands = code.instr(i).operands.iter().zip(code.params(i));
        for (n, (operand, param)) in operands.enumerate() {
            if let OperandKind::Buffer {
                module,
                address,
                index,
            } = operand.kind
            {
                // Where only a run decides how many words they are, the first is certain.
                let count = accesses::buffer_words(code.resolved, i, n).unwrap_or(1);
                let first = i64::from(address);
                let end = first.saturating_add(count.into());
                self.hold(
                    &Words {
                        unit: module.into(),
                        unit_span: operand.span,
                        run: index.is_none().then_some((first..end, operand.span)),
                        written: code.role(i, operand.span, param.role) != Role::Read,
                    },
                    out,
                );
            }
        }
    }

    /// Holds words to the module that has them.
    fn hold(&self, words: &Words, out: &mut Diagnostics) {
        let fitted = self
            .0
            .iter()
            .find(|(unit, _)| words.unit == i64::from(*unit));
        let Some((unit, kind)) = fitted else {
            let message = phrase!("no module has the number {unit}", unit = words.unit);
            let listed = self.0.iter();
            let listed = listed.map(|(unit, kind)| match modules::name(*unit) {
                Some(name) => format!("{name} ({})", kind.name),
                None => format!("{unit} ({})", kind.name),
            });
            let listed: Vec<_> = listed.collect();
            let help = phrase!(
                "`[[module]]` in rungc.toml lists {listed}",
                listed = listed.join(", ")
            );
            out.push(codes::NO_MODULE.at(words.unit_span, message).help(help));
            return;
        };
        let Some((run, span)) = words.run.clone() else {
            return;
        };
        let found = run
            .clone()
            .map(|number| (number, u16::try_from(number).ok().and_then(|n| kind.bfm(n))));
        let (name, last) = (kind.name, kind.last);
        for (number, bfm) in found {
            match bfm {
                Some(bfm) if words.written && bfm.access == Access::Read => {
                    let what = bfm.role.meaning();
                    let message = phrase!(
                        "BFM {number} of {name} (module {unit}) can only be read: {what}",
                        number,
                        name,
                        unit,
                        what
                    );
                    out.push(
                        codes::READ_ONLY_WORD
                            .at(span, message)
                            .label("the module ignores it"),
                    );
                    return;
                }
                None if number > i64::from(last) => {
                    let message = phrase!(
                        "{name} (module {unit}) has no BFM {number}",
                        name,
                        unit,
                        number
                    );
                    let help = phrase!("its last one is {last}", last);
                    out.push(codes::NO_BUFFER_WORD.at(span, message).help(help));
                    return;
                }
                // Reserved words among others of a longer transfer do no harm.
                None if run.end - run.start == 1 => {
                    let message = phrase!(
                        "BFM {number} of {name} (module {unit}) is reserved",
                        number,
                        name,
                        unit
                    );
                    out.push(codes::NO_BUFFER_WORD.at(span, message).label("reads as 0"));
                    return;
                }
                _ => {}
            }
        }
    }
}

/// Words that FROM, TO and similar instructions transfer, if the module's number is constant.
fn transferred(code: &Code, i: usize) -> Option<Words> {
    let Some(Lower::Call(function)) = code.lower(i) else {
        return None;
    };
    let operands = &code.instr(i).operands;
    let constant = |n: usize| operands.get(n)?.kind.constant();
    let (written, counted) = match (function, function.transfer()) {
        (_, Some(transfer)) => (transfer == Transfer::ToModule, true),
        (RtFn::Rd3a | RtFn::Wr3a, _) => (false, false),
        _ => return None,
    };
    let unit = operands.first()?;
    let run = match (constant(1), constant(3)) {
        (Some(first), Some(count)) if counted => {
            let words = if code.wide(i) { 2 * count } else { count };
            let span = operands.get(1).map_or(unit.span, |operand| operand.span);
            (words > 0).then_some((first..first.saturating_add(words), span))
        }
        _ => None,
    };
    // On L01S, the host itself is number 0 where no module is.
    let host = matches!(function, RtFn::FromHost | RtFn::ToHost);
    let number = unit.kind.constant()?;
    (!host || number != 0).then_some(Words {
        unit: number,
        unit_span: unit.span,
        run,
        written,
    })
}
