//! Instructions driven by rungs of `compare`: comparison contacts of words and long words in front of coils, CMP and
//! ZCP, limits with hysteresis, the largest value, choices by a number.

use super::driven::{Driven, Form, WORDS, three_relays, words, words_and_pairs};
use crate::random::Random;
use rungc_syntax::DeviceClass::M;

/// Long words, and their number.
const LONGS: u32 = 200;
const LONG_COUNT: u32 = 20;
/// Words altogether.
pub const REGISTERS: u32 = LONGS + 2 * LONG_COUNT;
/// Relays that are set and that CMP and ZCP drive.
const RELAYS: u32 = 7000;
/// Comparisons of PLCs and of C.
const COMPARISONS: [(&str, &str); 6] = [
    ("=", "=="),
    ("<>", "!="),
    (">", ">"),
    ("<", "<"),
    (">=", ">="),
    ("<=", "<="),
];

/// Numbers that were drawn.
struct Drawn {
    /// A comparison, of the PLC and of C.
    comparison: (&'static str, &'static str),
    a: u32,
    b: u32,
    long: u32,
    other: u32,
    low: u32,
    high: u32,
    relay: u32,
}

/// Instructions of a rung.
pub fn random(random: &mut Random) -> Driven {
    let which = random.below(14);
    let comparison = random.choice(&COMPARISONS);
    let [a, b] = [0; 2].map(|_| random.below(WORDS));
    let [long, other] = [0; 2].map(|_| LONGS + 2 * random.below(LONG_COUNT));
    let low = random.below(5000);
    let high = low + random.below(5000);
    let relay = RELAYS + random.below(500);
    let drawn = Drawn {
        comparison,
        a,
        b,
        long,
        other,
        low,
        high,
        relay,
    };
    match which {
        0..=5 => contacts(which, &drawn),
        6..=11 => instructions(which, &drawn),
        _ => match random.chance(0.3) {
            true => Driven::long_constant(high * 1000, long),
            false => Driven::constant(random),
        },
    }
}

/// Comparison contacts in front of a coil.
fn contacts(which: u32, drawn: &Drawn) -> Driven {
    let Drawn {
        comparison: (plc, c),
        a,
        b,
        long,
        other,
        low,
        high,
        ..
    } = *drawn;
    let get = |long: u32| format!("(int32_t)get_long(&p->D[{long}])");
    let constant = low * 1000;
    let (steps, list, hand, registers) = match which {
        0 => (
            5,
            format!("AND{plc} D{a} K{low}"),
            format!("p->D[{a}] {c} {low}"),
            words([a]),
        ),
        1 => (
            5,
            format!("AND{plc} D{a} D{b}"),
            format!("p->D[{a}] {c} p->D[{b}]"),
            words([a, b]),
        ),
        2..=3 => (
            10,
            format!("AND>= D{a} K{low};AND<= D{a} K{high}"),
            format!("p->D[{a}] >= {low} && p->D[{a}] <= {high}"),
            words([a]),
        ),
        4 => (
            9,
            format!("ANDD{plc} D{long} K{constant}"),
            format!("{} {c} {constant}", get(long)),
            words_and_pairs([], [long]),
        ),
        _ => (
            9,
            format!("ANDD{plc} D{long} D{other}"),
            format!("{} {c} {}", get(long), get(other)),
            words_and_pairs([], [long, other]),
        ),
    };
    Driven::new(steps, list, hand, registers).with(Form::Contacts)
}

/// Instructions that compare, and those with comparison contacts.
fn instructions(which: u32, drawn: &Drawn) -> Driven {
    let Drawn {
        a,
        b,
        low,
        high,
        relay,
        ..
    } = *drawn;
    match which {
        6 => {
            let relays = [">", "==", "<"].map(|c| format!("p->D[{a}] {c} p->D[{b}]"));
            let list = format!("CMP D{a} D{b} M{relay}");
            Driven::new(7, list, three_relays(relay, relays), words([a, b])).and_bits(M, relay, 3)
        }
        7 => {
            let relays = [
                format!("p->D[{a}] < {low}"),
                format!("p->D[{a}] >= {low} && p->D[{a}] <= {high}"),
                format!("p->D[{a}] > {high}"),
            ];
            let list = format!("ZCP K{low} K{high} D{a} M{relay}");
            Driven::new(9, list, three_relays(relay, relays), words([a])).and_bits(M, relay, 3)
        }
        8..=9 => Driven::new(
            15,
            format!("AND> D{a} K{high};SET M{relay};LD< D{a} K{low};RST M{relay}"),
            format!("if (p->D[{a}] > {high}) p->M[{relay}] = true;"),
            words([a]),
        )
        .then(format!("if (p->D[{a}] < {low}) p->M[{relay}] = false;"))
        .and_bits(M, relay, 1),
        10 => Driven::new(
            10,
            format!("AND> D{a} D{b};MOV D{a} D{b}"),
            format!("if (p->D[{a}] > p->D[{b}]) p->D[{b}] = p->D[{a}];"),
            words([a, b]),
        ),
        _ => Driven::new(
            10,
            format!("AND= D{a} K{};MOV K{high} D{b}", low % 8),
            format!("if (p->D[{a}] == {}) p->D[{b}] = {high};", low % 8),
            words([a, b]),
        ),
    }
}
