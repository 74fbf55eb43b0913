//! Devices that some of the PLCs for which a model stands do not have.

use super::Code;
use crate::accesses::Access;
use rungc_syntax::{Device, Diagnostics, Span, codes};
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
            format!("{} to {}", class.number(first), class.number(last))
        });
        let areas = areas.collect::<Vec<_>>().join(", ");
        out.push(
            codes::DOUBTFUL_DEVICE
                .at(span, format!("{names}: not every {title} has such devices"))
                .label("the first of them")
                .help(format!(
                    "some stop at programs with {areas}; use lower numbers, or try it on the board"
                )),
        );
    }
}
