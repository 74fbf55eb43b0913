//! Bounds of operands with an index: whether they fit the model and the program, and what an operand without one costs.

use super::Lowerer;
use super::operand::indexed;
use rungc_analysis::resolve::Resolved;
use rungc_ir::node::{ExprId, Module, Place};
use rungc_ir::ranges::Bound;
use rungc_ir::reach::Footprint;
use rungc_models::Model;
use rungc_models::runs::is_counter32;
use rungc_syntax::{Device, DeviceClass, Diagnostic, Diagnostics, Index, Span, codes, phrase};
use std::collections::BTreeMap;

/// From how many bytes on it is worth knowing what an operand makes a program store.
const MUCH: u64 = 1024;

/// An operand with an index, where it leads to a device.
pub(super) struct IndexUse {
    /// The index in the module ([`rungc_ir::node::Expr::Within`]).
    within: ExprId,
    /// The place that the operand names.
    place: Place,
    /// The operand as the program writes it.
    device: Device,
    index: Index,
    span: Span,
}

impl Lowerer<'_> {
    /// Takes note of an operand's index.
    pub(super) fn note_index(&mut self, within: ExprId, place: Place, index: Index) {
        if let Some((device, span)) = self.indexed_operand(place, index) {
            self.indexes.push(IndexUse {
                within,
                place,
                device,
                index,
                span,
            });
        }
    }
}

/// Holds bounds to the program and its model.
pub(super) fn check(resolved: &Resolved, bounds: &[Bound], diagnostics: &mut Diagnostics) {
    for bound in bounds {
        let operands = resolved.program.instrs.iter().flat_map(|i| &i.operands);
        let mut named = operands.filter(|o| indexed(&o.kind) == Some((bound.device, bound.index)));
        let operand = format!(
            "{device}{index}",
            device = bound.device,
            index = bound.index
        );
        let Some(first) = named.next() else {
            diagnostics.push(unused(resolved, bound, &operand));
            continue;
        };
        let class = bound.device.class;
        let runs = resolved.model.runs(class);
        let exists = |&(from, to): &(u32, u32)| from <= bound.first && bound.last <= to;
        if bound.first > bound.last || !runs.iter().any(exists) {
            let (from, to) = (class.number(bound.first), class.number(bound.last));
            let title = resolved.model.title;
            let message = phrase!(
                "`{operand}` is bounded to {from} to {to}, which {title} does not have",
                operand,
                from,
                to,
                title
            );
            let runs: Vec<_> = runs
                .iter()
                .map(|&(first, last)| format!("{}–{}", class.number(first), class.number(last)))
                .collect();
            let diagnostic = codes::BOUND_OUTSIDE.at(first.span, message);
            diagnostics
                .push(diagnostic.help(phrase!("there are {ranges}", ranges = runs.join(", "))));
        }
    }
}

/// The warning about a bound for an operand that no instruction has, at the operand that is most like it: with the same
/// index register rather than another, then the one with the closest number.
fn unused(resolved: &Resolved, bound: &Bound, operand: &str) -> Diagnostic {
    let operands = resolved.program.instrs.iter().flat_map(|i| &i.operands);
    let alike = operands
        .filter_map(|o| Some((o.span, indexed(&o.kind)?)))
        .filter(|(_, (device, _))| device.class == bound.device.class)
        .min_by_key(|(_, (device, index))| {
            let distance = device.number.abs_diff(bound.device.number);
            (*index != bound.index, distance)
        });
    let message = phrase!(
        "`{operand}` has a bound, but no instruction has this operand",
        operand
    );
    let (span, label) = match alike {
        Some((span, (device, index))) => (
            span,
            phrase!("this operand is `{device}{index}`", device, index),
        ),
        None => {
            let label = phrase!(
                "no device {prefix} has an index here",
                prefix = bound.device.class.prefix()
            );
            (Span::default(), label)
        }
    };
    codes::BOUND_UNUSED
        .at(span, message)
        .label(label)
        .help("a bound is for the operand exactly as the program writes it")
}

/// Reports operands that make a program store many devices because little is known about their index.
pub(super) fn costs(module: &Module, uses: &[IndexUse], diagnostics: &mut Diagnostics) {
    let mut reported: BTreeMap<(DeviceClass, u32, DeviceClass, u32), ()> = BTreeMap::new();
    for used in uses {
        let footprint = Footprint {
            place: Place {
                index: Some(used.within),
                ..used.place
            },
            count: Some(1),
            in_array: true,
            writes: false,
        };
        let class = used.place.class;
        let runs = footprint.reach(module.model, &module.exprs);
        let bytes: u64 = runs.iter().map(|run| size(module.model, class, *run)).sum();
        let index = used.index;
        let key = (class, used.device.number, index.class, index.number);
        if bytes <= MUCH || reported.insert(key, ()).is_some() {
            continue;
        }
        let devices: u32 = runs.iter().map(|run| run.1 - run.0 + 1).sum();
        let operand = format!("{device}{index}", device = used.device);
        let message = phrase!(
            "`{operand}` can reach {devices} devices, which take {bytes} bytes of memory",
            operand,
            devices,
            bytes
        );
        let (first, last) = (used.device, class.number(used.device.number + 63));
        diagnostics.push(
            codes::INDEX_REACHES_MUCH
                .at(used.span, message)
                .label(phrase!("little is known of {index} here", index))
                .help(phrase!("compare {index} before, or bound the operand in rungc.toml: `[index]`, `{operand} = \"{first}-{last}\"`", index, operand, first, last)),
        );
    }
}

/// Size of devices in bytes.
fn size(model: &Model, class: DeviceClass, (first, last): (u32, u32)) -> u64 {
    use DeviceClass::{C, D, ER, I, M, N, P, R, S, T, V, X, Y, Z};
    let each = match class {
        X | Y | M | S => 1,
        T => 8,
        C if is_counter32(class, first) => 8,
        C => 4,
        D | R | ER | V | Z | P | I | N => 2,
    };
    let aliases = model.aliases_within(class, first, last);
    (u64::from(last - first + 1) - aliases.count() as u64) * each
}
