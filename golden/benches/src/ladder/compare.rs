//! Instructions driven by rungs of `compare`: comparison contacts of words and long words in front of coils, CMP and
//! ZCP, limits with hysteresis, the largest value, choices by a number.

use super::driven::{Driven, Form, WORDS, words, words_and_pairs};
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

/// Instructions of a rung.
pub fn random(random: &mut Random) -> Driven {
    let which = random.below(14);
    let (plc, c) = random.choice(&COMPARISONS);
    let [a, b] = [0; 2].map(|_| random.below(WORDS));
    let [long, other] = [0; 2].map(|_| LONGS + 2 * random.below(LONG_COUNT));
    let low = random.below(5000);
    let high = low + random.below(5000);
    let relay = RELAYS + random.below(500);
    let get = |long: u32| format!("(int32_t)get_long(&p->D[{long}])");
    match which {
        0 => contacts(
            5,
            format!("AND{plc} D{a} K{low}"),
            format!("p->D[{a}] {c} {low}"),
            [a],
            [],
        ),
        1 => contacts(
            5,
            format!("AND{plc} D{a} D{b}"),
            format!("p->D[{a}] {c} p->D[{b}]"),
            [a, b],
            [],
        ),
        2..=3 => contacts(
            10,
            format!("AND>= D{a} K{low};AND<= D{a} K{high}"),
            format!("p->D[{a}] >= {low} && p->D[{a}] <= {high}"),
            [a],
            [],
        ),
        4 => contacts(
            9,
            format!("ANDD{plc} D{long} K{}", low * 1000),
            format!("{} {c} {}", get(long), low * 1000),
            [],
            [long],
        ),
        5 => contacts(
            9,
            format!("ANDD{plc} D{long} D{other}"),
            format!("{} {c} {}", get(long), get(other)),
            [],
            [long, other],
        ),
        6 => with_relays(
            Driven::new(
                7,
                format!("CMP D{a} D{b} M{relay}"),
                three(
                    relay,
                    [">", "==", "<"].map(|c| format!("p->D[{a}] {c} p->D[{b}]")),
                ),
                words([a, b]),
            ),
            relay,
            3,
        ),
        7 => with_relays(
            Driven::new(
                9,
                format!("ZCP K{low} K{high} D{a} M{relay}"),
                three(
                    relay,
                    [
                        format!("p->D[{a}] < {low}"),
                        format!("p->D[{a}] >= {low} && p->D[{a}] <= {high}"),
                        format!("p->D[{a}] > {high}"),
                    ],
                ),
                words([a]),
            ),
            relay,
            3,
        ),
        8..=9 => with_relays(
            Driven::new(
                15,
                format!("AND> D{a} K{high};SET M{relay};LD< D{a} K{low};RST M{relay}"),
                format!("if (p->D[{a}] > {high}) p->M[{relay}] = true;"),
                words([a]),
            )
            .then(format!("if (p->D[{a}] < {low}) p->M[{relay}] = false;")),
            relay,
            1,
        ),
        10 => Driven::new(
            10,
            format!("AND> D{a} D{b};MOV D{a} D{b}"),
            format!("if (p->D[{a}] > p->D[{b}]) p->D[{b}] = p->D[{a}];"),
            words([a, b]),
        ),
        11 => Driven::new(
            10,
            format!("AND= D{a} K{};MOV K{high} D{b}", low % 8),
            format!("if (p->D[{a}] == {}) p->D[{b}] = {high};", low % 8),
            words([a, b]),
        ),
        _ => match random.chance(0.3) {
            true => Driven::new(
                9,
                format!("DMOV K{} D{long}", high * 1000),
                format!("put_long(&p->D[{long}], {});", high * 1000),
                words_and_pairs([], [long]),
            ),
            false => Driven::constant(random),
        },
    }
}

/// Comparison contacts in front of a coil.
fn contacts<const N: usize, const P: usize>(
    steps: u32,
    list: String,
    hand: String,
    singles: [u32; N],
    pairs: [u32; P],
) -> Driven {
    Driven::new(steps, list, hand, words_and_pairs(singles, pairs)).with(Form::Contacts)
}

/// Assignments to three relays.
fn three(relay: u32, values: [String; 3]) -> String {
    let values = values.iter().zip(relay..);
    let all = values.map(|(value, relay)| format!("p->M[{relay}] = {value};"));
    all.collect::<Vec<_>>().join(" ")
}

fn with_relays(mut driven: Driven, first: u32, count: u32) -> Driven {
    driven
        .devices
        .extend((first..first + count).map(|number| (M, number)));
    driven
}
