//! 32-bit values in registers that overlap by one word.

use crate::accesses::Access;
use rungc_models::runs::is_special;
use rungc_syntax::{Device, DeviceClass, Diagnostics, Span, codes, phrase};
use rustc_hash::FxHashMap;

/// The 32-bit values of a program, by their first registers.
#[derive(Default)]
pub(super) struct Pairs(FxHashMap<Device, Pair>);

struct Pair {
    /// Position of its first use.
    span: Span,
    /// True if anything writes it.
    written: bool,
}

impl Pairs {
    /// Takes an access.
    pub(super) fn note(&mut self, access: &Access) {
        let class = access.first.class;
        let register = matches!(class, DeviceClass::D | DeviceClass::R);
        let special = is_special(class, access.first.number);
        if !register || special || access.each != 2 || access.count != Some(2) {
            return;
        }
        let pair = self.0.entry(access.first).or_insert(Pair {
            span: access.span,
            written: false,
        });
        pair.written |= access.writes();
    }

    /// Warns of pairs that begin at neighbouring registers, if one of them is written.
    pub(super) fn report(self, out: &mut Diagnostics) {
        let mut found = Vec::new();
        for (&device, pair) in &self.0 {
            let next = Device {
                number: device.number.saturating_add(1),
                ..device
            };
            let Some(other) = self
                .0
                .get(&next)
                .filter(|other| pair.written || other.written)
            else {
                continue;
            };
            let message = phrase!(
                "the 32-bit values at `{device}` and `{next}` share `{next}`",
                device,
                next
            );
            let diagnostic = codes::PAIRS_OVERLAP
                .at(other.span, message)
                .label(phrase!("this is `{next}` and the next register", next))
                .other(
                    pair.span,
                    phrase!("this is `{device}` and `{next}`", device, next),
                )
                .help("leave one register between the two values");
            found.push(diagnostic);
        }
        found.sort_by_key(|diagnostic| diagnostic.span);
        out.extend(found);
    }
}
