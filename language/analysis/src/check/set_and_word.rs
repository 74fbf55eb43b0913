//! Coils that SET or RST write, and that an instruction then writes as part of a word in every scan.

use super::Code;
use super::coils::{Coil, Place, Places, Reads, Where, add_words};
use super::overlaps::clears;
use super::structure::Routine;
use rungc_catalogue::Basic;
use rungc_syntax::{Device, DeviceClass, Diagnostic, Diagnostics, codes, phrase};
use std::collections::{BTreeMap, BTreeSet};

/// Warns of SET and RST that such an instruction undoes before anything sees what they did.
pub(super) fn check(code: &Code, places: Where, out: &mut Diagnostics) {
    let mut driven: BTreeMap<Coil, Vec<Place>> = BTreeMap::new();
    let mut others = BTreeSet::new();
    for i in 0..code.len {
        let device = code.device(i, 0);
        let runs = places.nesting.of(i).routine != Routine::Nothing;
        let Some(device) = device.filter(|device| runs && is_coil(*device)) else {
            continue;
        };
        match code.basic(i) {
            Some(Basic::Set | Basic::Rst) => {
                let mut place = Place::new(code, places, i);
                place.decides = false;
                driven.entry((device, None)).or_default().push(place);
            }
            Some(Basic::Out | Basic::Pls | Basic::Plf) => {
                others.insert(device);
            }
            _ => {}
        }
    }
    // What coils write too has separate warnings.
    driven.retain(|(device, _), _| !others.contains(device));
    if driven.is_empty() {
        return;
    }
    add_words(code, places, &mut driven);
    driven.retain(|_, places| places.iter().any(|place| place.is_word && place.decides));
    let reads = Reads::of(code, places.nesting, &driven);
    let found = driven.into_iter();
    let found = found.filter_map(|((device, _), places)| in_vain(code, device, places, &reads));
    let mut found: Vec<_> = found.collect();
    found.sort_by_key(|diagnostic| diagnostic.span);
    out.extend(found);
}

fn is_coil(device: Device) -> bool {
    matches!(device.class, DeviceClass::Y | DeviceClass::M)
}

fn in_vain(
    code: &Code,
    device: Device,
    mut places: Vec<Place>,
    reads: &Reads,
) -> Option<Diagnostic> {
    // What only clears undoes no RST, and words that undo each other have a separate warning.
    let is_reset = |place: &Place| code.basic(place.at) == Some(Basic::Rst);
    let first_word = places.iter().find(|place| place.is_word && place.decides)?;
    let word_clears = clears(code, first_word.at);
    for place in &mut places {
        let stays = word_clears && is_reset(place);
        place.is_lost = !place.is_word && !stays;
    }
    let places = Places::new(places);
    let (lost, last) = places.lost(device, reads)?;
    let (first, rest) = lost.split_first()?;
    let mnemonic = &code.instr(first.at).mnemonic;
    let writer = code.instr(last.at);
    let message = phrase!(
        "`{mnemonic} {device}` does not last: `{writer}` writes the coil in every scan",
        mnemonic,
        device,
        writer
    );
    let mut diagnostic = codes::OUT_AND_SET
        .at(code.span(first.at), message)
        .label("what this writes …")
        .other(code.span(last.at), "… is lost here");
    for place in rest {
        diagnostic = diagnostic.other(code.span(place.at), "written here too");
    }
    Some(diagnostic.help("write it in one place, or use another device"))
}
