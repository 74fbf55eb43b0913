//! Instructions driven by rungs of `display`: digits for lamps and from thumbwheels, selections of one lamp of eight,
//! blocks of bits from words and back.

use super::driven::{Driven, WORDS, words};
use crate::random::Random;
use rungc_syntax::DeviceClass::{M, X, Y};

/// Words altogether; a quotient has a remainder beside it.
pub const REGISTERS: u32 = WORDS + 1;
/// Outputs that show digits, in groups of eight; coils drive those below.
const OUTPUTS: u32 = 64;
/// Relays of selections and blocks.
const RELAYS: u32 = 7000;
/// Lamps of a selection.
const LAMPS: u32 = 8;

/// Instructions of a rung.
pub fn random(random: &mut Random) -> Driven {
    let which = random.below(13);
    let [a, b] = [0; 2].map(|_| random.below(WORDS));
    let group = OUTPUTS + 8 * random.below(8);
    let pair = OUTPUTS + 16 * random.below(4);
    let wheel = 16 * random.below(8);
    let relay = RELAYS + random.below(500);
    match which {
        0..=6 => digits(which, [a, b], [group, pair, wheel]),
        7..=10 => lamps(which, [a, b], relay),
        _ => Driven::constant(random),
    }
}

/// Digits for lamps and from thumbwheels.
fn digits(which: u32, [a, b]: [u32; 2], [group, pair, wheel]: [u32; 3]) -> Driven {
    let rest = b + 1;
    match which {
        0..=1 => Driven::new(
            5,
            format!("SEGD D{a} K2Y{group:03o}"),
            format!("put_bits(&p->Y[{group}], 8, segments[p->D[{a}] & 15]);"),
            words([a]),
        )
        .and_bits(Y, group, 8),
        2 => Driven::new(
            12,
            format!("DIV D{a} K10 D{b};SEGD D{rest} K2Y{group:03o}"),
            format!(
                "const int16_t value = p->D[{a}]; p->D[{b}] = value / 10; p->D[{rest}] = value % 10; \
                 put_bits(&p->Y[{group}], 8, segments[p->D[{rest}] & 15]);"
            ),
            words([a, b, rest]),
        )
        .and_bits(Y, group, 8),
        3..=4 => Driven::new(
            5,
            format!("BCD D{a} K4Y{pair:03o}"),
            format!("if (is_decimal(p->D[{a}])) put_bits(&p->Y[{pair}], 16, digits(p->D[{a}]));"),
            words([a]),
        )
        .and_bits(Y, pair, 16),
        5 => Driven::new(
            5,
            format!("BCD D{a} D{b}"),
            format!("if (is_decimal(p->D[{a}])) p->D[{b}] = (int16_t)digits(p->D[{a}]);"),
            words([a, b]),
        ),
        _ => Driven::new(
            5,
            format!("BIN K4X{wheel:03o} D{b}"),
            format!("from_wheels(&p->D[{b}], get_bits(&p->X[{wheel}], 16));"),
            words([b]),
        )
        .and_bits(X, wheel, 16),
    }
}

/// Selections of lamps, and blocks of bits.
fn lamps(which: u32, [a, b]: [u32; 2], relay: u32) -> Driven {
    let driven = match which {
        7 => Driven::new(
            7,
            format!("DECO D{a} M{relay} K3"),
            format!("select_lamp(&p->M[{relay}], {LAMPS}, p->D[{a}] & 7);"),
            words([a]),
        ),
        8 => Driven::new(
            7,
            format!("ENCO M{relay} D{b} K3"),
            format!("selected_lamp(&p->D[{b}], &p->M[{relay}], {LAMPS});"),
            words([b]),
        ),
        9 => Driven::new(
            5,
            format!("MOV D{a} K2M{relay}"),
            format!("put_bits(&p->M[{relay}], 8, (uint16_t)p->D[{a}]);"),
            words([a]),
        ),
        _ => Driven::new(
            5,
            format!("MOV K2M{relay} D{b}"),
            format!("p->D[{b}] = (int16_t)get_bits(&p->M[{relay}], 8);"),
            words([b]),
        ),
    };
    driven.and_bits(M, relay, LAMPS)
}
