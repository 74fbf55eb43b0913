//! The page of the buffer memory of special modules.

use rungc_rt::modules::{Bfm, EXCHANGE, KINDS, Kind, Quantity, REGISTERS, Range, Start};
use std::fmt::Write;

/// The page: a table of ranges and a table of buffer memory for each kind, as the runtime holds them.
pub fn modules() -> String {
    let mut page = "# Buffer memory of modules\n\nThe special modules that rungc simulates and checks, and what FROM and TO find in \
                    them. \
                    [Special modules](../modules.md) says how to fit them. A word that is *kept* outlasts power-off. Analog \
                    adapters and boards of FX have relays and registers instead: M+1 is the second relay, D+0 the first \
                    register.\n"
        .to_owned();
    for kind in &KINDS {
        // Writing to a String cannot fail.
        let _ = write!(page, "\n## {}\n\n", kind.name);
        if !kind.aliases.is_empty() {
            let _ = write!(page, "Also {}. ", kind.aliases.join(", "));
        }
        let _ = write!(page, "Described in {}.", kind.source);
        ranges(&mut page, "inputs", kind.input_ranges, 1..=kind.inputs);
        let outputs = kind.inputs + 1..=kind.inputs + kind.outputs;
        ranges(&mut page, "outputs", kind.output_ranges, outputs);
        points(&mut page, kind);
        if kind.bfms.is_empty() {
            page.push('\n');
            continue;
        }
        let (words, head) = match kind.start {
            Start::Exchange => (EXCHANGE, "device"),
            _ => (u16::MAX, "BFM"),
        };
        let _ = write!(
            page,
            "\n\n| {head} | channel | meaning | default | access |\n|--:|---|---|--:|---|\n"
        );
        for bfm in kind.bfms.iter().filter(|bfm| bfm.first < words) {
            row(&mut page, kind, bfm);
        }
    }
    page
}

/// The terminals.
fn points(page: &mut String, kind: &Kind) {
    let [inputs, outputs] = kind.points;
    let named = [(inputs, 'X'), (outputs, 'Y')];
    let named = named.into_iter().filter(|(count, _)| *count > 0);
    let named: Vec<_> = named
        .map(|(count, letter)| format!("{letter}0 to {letter}{:o}", count - 1))
        .collect();
    if !named.is_empty() {
        let _ = write!(page, "\n\nTerminals: {}.", named.join(", "));
    }
}

/// The ranges of the channels.
fn ranges(
    page: &mut String,
    what: &str,
    ranges: &[Option<Range>],
    channels: std::ops::RangeInclusive<u8>,
) {
    if channels.is_empty() {
        return;
    }
    let (first, last) = (channels.start(), channels.end());
    let channels = match first == last {
        true => format!("CH{first}"),
        false => format!("CH{first} to CH{last}"),
    };
    let _ = write!(
        page,
        "\n\n{channels} are {what}:\n\n| digit | 0 stands for | gain | held in |\n|--:|--:|--:|--:|\n"
    );
    // If each channel has its own word, its types need not follow each other.
    let sparse = ranges.len() > 8 || ranges.iter().take(5).all(Option::is_none);
    let shown = ranges.iter().enumerate();
    let shown = shown.filter(|(_, range)| range.is_some() || !sparse);
    let rows = shown.map(|(digit, range)| match range {
        None => format!("| {digit} | off | | |"),
        Some(range) => {
            // The second terminal of an input has the same types as the first.
            let digit = digit % 16;
            let analog = |thousandths: i32| {
                let unit = range.quantity.unit();
                format!("{} {unit}", f64::from(thousandths) / 1000.0)
            };
            let gain = match range.quantity {
                Quantity::Celsius => format!("0.1 {} = 1", range.quantity.unit()),
                _ => format!("{} = {}", analog(range.gain), range.span),
            };
            format!(
                "| {digit} | {} | {gain} | {} to {} |",
                analog(range.offset),
                range.low,
                range.high
            )
        }
    });
    *page += &rows.collect::<Vec<_>>().join("\n");
}

/// A row of buffer memory.
fn row(page: &mut String, kind: &Kind, bfm: &Bfm) {
    let last = bfm.first + u16::from(bfm.count) - 1;
    let number = |word: u16| match (kind.start, word.checked_sub(REGISTERS)) {
        (Start::Exchange, None) => format!("M+{word}"),
        (Start::Exchange, Some(register)) => format!("D+{register}"),
        _ => word.to_string(),
    };
    let numbers = match (bfm.stride, last == bfm.first) {
        (_, true) => number(bfm.first),
        (1, false) => format!("{} – {}", number(bfm.first), number(last)),
        _ => {
            let all: Vec<_> = bfm.numbers().map(|number| number.to_string()).collect();
            all.join(", ")
        }
    };
    let channels = kind.channels(bfm).map_or(String::new(), |(first, each)| {
        let last = first + bfm.count / each;
        match last == first + 1 {
            true => format!("CH{last}"),
            false => format!("CH{} – CH{last}", first + 1),
        }
    });
    let _ = writeln!(
        page,
        "| {numbers} | {channels} | {} | {} | {} |",
        bfm.role.meaning(),
        bfm.default,
        bfm.access.name()
    );
}
