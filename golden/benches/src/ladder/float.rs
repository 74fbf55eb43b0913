//! Instructions driven by rungs of `float`: scaled analogue values, sums and products, filters, limits.
//!
//! Floats that come from words are calculated with once or enter a filter, so that none ever leaves the range of a
//! float; those that become words again have few digits.

use super::driven::{Driven, WORDS, three_relays, words_and_pairs};
use crate::random::Random;
use rungc_syntax::DeviceClass::M;

/// Floats: from words, scaled, filtered, results. There are as many of each.
const SOURCES: u32 = 200;
const SCALED: u32 = 240;
const FILTERED: u32 = 280;
const RESULTS: u32 = 320;
const COUNT: u32 = 20;
/// Words altogether.
pub const REGISTERS: u32 = RESULTS + 2 * COUNT;
/// Relays that comparisons drive.
const RELAYS: u32 = 7000;
/// Factors of scales.
const FACTORS: [&str; 4] = ["0.025", "0.0625", "0.1", "0.005"];

fn get(float: u32) -> String {
    format!("get_float(&p->D[{float}])")
}

fn put(float: u32, value: &str) -> String {
    format!("put_float(&p->D[{float}], {value});")
}

/// Numbers that were drawn.
struct Drawn {
    a: u32,
    b: u32,
    source: u32,
    other: u32,
    scaled: u32,
    filtered: u32,
    result: u32,
    factor: &'static str,
    offset: u32,
    relay: u32,
}

/// Instructions of a rung.
pub fn random(random: &mut Random) -> Driven {
    let which = random.below(14);
    let [a, b] = [0; 2].map(|_| random.below(WORDS));
    let mut of = |first: u32| first + 2 * random.below(COUNT);
    let [source, other] = [0; 2].map(|_| of(SOURCES));
    let (scaled, filtered, result) = (of(SCALED), of(FILTERED), of(RESULTS));
    let drawn = Drawn {
        a,
        b,
        source,
        other,
        scaled,
        filtered,
        result,
        factor: random.choice(&FACTORS),
        offset: random.below(100),
        relay: RELAYS + random.below(500),
    };
    match which {
        5..=8 => arithmetic(which, &drawn),
        0..=12 => analogue(which, &drawn),
        _ => Driven::constant(random),
    }
}

/// An operation of two floats.
fn arithmetic(which: u32, drawn: &Drawn) -> Driven {
    let Drawn {
        source,
        other,
        result,
        offset,
        ..
    } = *drawn;
    let operation = |plc: &str, c: &str| {
        Driven::new(
            13,
            format!("{plc} D{source} D{other} D{result}"),
            put(result, &format!("{} {c} {}", get(source), get(other))),
            words_and_pairs([], [source, other, result]),
        )
    };
    match which {
        5 => operation("DEADD", "+"),
        6 => operation("DESUB", "-"),
        7 => operation("DEMUL", "*"),
        _ => Driven::new(
            13,
            format!("DEDIV D{source} E{}.5 D{result}", offset + 1),
            put(result, &format!("{} / {}.5f", get(source), offset + 1)),
            words_and_pairs([], [source, result]),
        ),
    }
}

/// Scales, filters, comparisons and limits.
fn analogue(which: u32, drawn: &Drawn) -> Driven {
    let Drawn {
        a,
        b,
        source,
        scaled,
        filtered,
        result,
        factor,
        offset,
        relay,
        ..
    } = *drawn;
    match which {
        0..=2 => Driven::new(
            31,
            format!(
                "FLT D{a} D{source};DEMUL D{source} E{factor} D{scaled};DEADD D{scaled} E-{offset} D{scaled}"
            ),
            format!(
                "const float raw = (float)p->D[{a}]; {} {}",
                put(source, "raw"),
                put(scaled, &format!("raw * {factor}f - {offset}.0f"))
            ),
            words_and_pairs([a], [source, scaled]),
        ),
        3..=4 => Driven::new(
            14,
            format!("INT D{scaled} D{a};LIMIT K0 K{} D{a} D{b}", 100 + offset),
            format!(
                "p->D[{a}] = (int16_t){}; p->D[{b}] = limit(0, {}, p->D[{a}]);",
                get(scaled),
                100 + offset
            ),
            words_and_pairs([a, b], [scaled]),
        ),
        9..=10 => Driven::new(
            39,
            format!(
                "DESUB D{scaled} D{filtered} D{result};DEMUL D{result} E{factor} D{result};\
                 DEADD D{filtered} D{result} D{filtered}"
            ),
            format!(
                "const float change = ({} - {}) * {factor}f; {} {}",
                get(scaled),
                get(filtered),
                put(result, "change"),
                put(filtered, &format!("{} + change", get(filtered)))
            ),
            words_and_pairs([], [scaled, filtered, result]),
        ),
        11 => {
            let limit = format!("{offset}.0f");
            let relays = [">", "==", "<"].map(|operator| format!("value {operator} {limit}"));
            let relays = three_relays(relay, relays);
            Driven::new(
                13,
                format!("DECMP D{filtered} E{offset} M{relay}"),
                format!("const float value = {}; {relays}", get(filtered)),
                words_and_pairs([], [filtered]),
            )
            .and_bits(M, relay, 3)
        }
        _ => Driven::new(
            9,
            format!("LIMIT K{offset} K{} D{a} D{b}", 5000 + offset),
            format!("p->D[{b}] = limit({offset}, {}, p->D[{a}]);", 5000 + offset),
            words_and_pairs([a, b], []),
        ),
    }
}
