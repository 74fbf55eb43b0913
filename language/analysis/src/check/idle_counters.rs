//! High-speed counters whose value a program takes, although nothing lets them count.

use super::Code;
use super::overlaps::clears;
use crate::accesses::Access;
use rungc_catalogue::Lower;
use rungc_syntax::{DeviceClass, Diagnostics, Span, codes, phrase};
use std::collections::{BTreeMap, BTreeSet};

/// High-speed counters in a program.
#[derive(Default)]
pub(super) struct IdleCounters {
    /// Those with a coil, or into which something else writes a value.
    written: BTreeSet<u32>,
    /// True if something may write any of them.
    any_written: bool,
    /// Those whose value is taken, each with its first use, and whether a comparison acts at its count.
    read: BTreeMap<u32, (Span, bool)>,
}

impl IdleCounters {
    /// Takes an access of instruction `i`.
    pub(super) fn note(&mut self, code: &Code, i: usize, access: &Access) {
        if access.first.class != DeviceClass::C {
            return;
        }
        if access.writes() && !clears(code, i) {
            match access.count {
                Some(count) => {
                    let first = access.first.number;
                    self.written.extend(first..first.saturating_add(count));
                }
                None => self.any_written = true,
            }
        }
        let number = access.first.number;
        let is_fast = code.model().high_speed.counter(number).is_some();
        // Contacts are among those that nothing drives; longer runs are copied as a whole.
        let takes = access.reads() && access.count == Some(1) && code.basic(i).is_none();
        if is_fast && takes {
            let acts = matches!(code.lower(i), Some(Lower::HighSpeed(_)));
            self.read.entry(number).or_insert((access.span, acts));
        }
    }

    /// Warns of those that never count.
    pub(super) fn report(self, code: &Code, out: &mut Diagnostics) {
        let parameters = code.resolved.program.parameters.as_ref();
        let outside = parameters.map_or(&[][..], |known| &known.written_externally);
        if self.any_written
            || !code.is_understood()
            || outside.iter().any(|run| run.class == DeviceClass::C)
        {
            return;
        }
        for (number, (span, acts)) in self.read {
            if self.written.contains(&number) {
                continue;
            }
            let counter = DeviceClass::C.number(number);
            let message = phrase!("nothing drives `{counter}`, so it never counts", counter);
            let label = match acts {
                true => "never acts",
                false => "its value never changes",
            };
            let diagnostic = codes::NEVER_COUNTS
                .at(span, message)
                .label(label)
                .help(phrase!(
                    "a high-speed counter counts while its coil is driven: `OUT {counter} K…`",
                    counter
                ));
            out.push(diagnostic);
        }
    }
}
