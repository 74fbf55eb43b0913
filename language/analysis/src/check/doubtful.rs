//! Devices that some of the PLCs for which a model stands do not have.

use super::Code;
use crate::accesses::Access;
use rungc_syntax::{Device, Diagnostics, Span, codes, phrase};
use std::collections::BTreeMap;

/// Maximum number of devices that a message names.
const MAX_NAMED: usize = 6;

/// The doubtful devices that a program names, with their first places.
#[derive(Default)]
pub(super) struct Doubtful(BTreeMap<Device, Span>);

impl Doubtful {
    /// Takes an access.
    pub(super) fn note(&mut self, code: &Code, access: &Access) {
        let Device { class, number } = access.first;
        let end = number.saturating_add(access.count.unwrap_or(1));
        for &(of, first, last) in code.model().doubtful {
            if of == class && number.max(first) < end.min(last + 1) {
                let number = number.max(first);
                self.0
                    .entry(Device { class, number })
                    .or_insert(access.span);
            }
        }
    }

    /// Reports them, if there are any.
    pub(super) fn report(self, code: &Code, out: &mut Diagnostics) {
        let Some(&span) = self.0.values().next() else {
            return;
        };
        let named = self
            .0
            .keys()
            .take(MAX_NAMED)
            .map(|device| format!("`{device}`"));
        let mut names = named.collect::<Vec<_>>().join(", ");
        if let Some(more) = self.0.len().checked_sub(MAX_NAMED).filter(|more| *more > 0) {
            names += &format!(" and {more} more");
        }
        let title = code.model().title;
        let areas = code.model().doubtful.iter();
        let areas = areas.map(|&(class, first, last)| {
            let [first, last] = [first, last].map(|number| class.number(number));
            format!("{first}–{last}")
        });
        let areas = areas.collect::<Vec<_>>().join(", ");
        out.push(
            codes::DOUBTFUL_DEVICE
                .at(
                    span,
                    phrase!("{names}: not every {title} has such devices", names, title),
                )
                .label("the first of them")
                .help(phrase!(
                    "some stop at programs with {areas}; use lower numbers, or try it on the board",
                    areas
                )),
        );
    }
}
