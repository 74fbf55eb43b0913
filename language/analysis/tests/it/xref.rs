//! Cross references.

use rungc_analysis::resolve::resolve;
use rungc_analysis::xref::CrossReference;
use rungc_frontend::read_text;
use rungc_models::{Model, ModelId};

/// The rows of a program, each with the words of its uses.
fn rows(model: ModelId, text: &str) -> Vec<String> {
    let read = read_text("test", text);
    let (resolved, diagnostics) = resolve(&read.program, Model::get(model));
    assert!(!diagnostics.has_errors(), "{diagnostics:?}");
    let xref = CrossReference::new(&resolved);
    let rows = xref.rows.iter().map(|row| {
        let words: Vec<_> = row.uses.iter().map(|&i| xref.uses[i].kind.word()).collect();
        let (class, first, last) = (row.first.class, row.first.number, row.last.number);
        let (first, last) = (class.number(first), class.number(last));
        format!("{first}-{last} {}", words.join(" "))
    });
    rows.collect()
}

#[test]
fn the_index_of_a_32_bit_instruction_is_a_pair() {
    let wide = "LD X0\nDMOV D20Z1 R100\nEND\n";
    let found = rows(ModelId::Fx3u, wide);
    assert!(found.contains(&"V1-V1 read".to_owned()), "{found:?}");
    assert!(found.contains(&"Z1-Z1 read".to_owned()), "{found:?}");
    let narrow = rows(ModelId::Fx3u, "LD X0\nMOV D20Z1 R100\nEND\n");
    assert!(narrow.iter().all(|row| !row.starts_with('V')), "{narrow:?}");
    // HM's addresses have 16 bits.
    let hm = rows(ModelId::Hm, "LD X0\nDMOV D1020Z1 D1100\nEND\n");
    assert!(hm.iter().all(|row| !row.starts_with('V')), "{hm:?}");
}

#[test]
fn the_end_of_a_range_is_part_of_it() {
    let found = rows(ModelId::Fx3u, "LD X0\nZRST D500 D599\nMOV D599 D1\nEND\n");
    let expected = [
        "X000-X000 contact",
        "D1-D1 write",
        "D500-D598 write",
        "D599-D599 write read",
    ];
    assert_eq!(found, expected);
}
