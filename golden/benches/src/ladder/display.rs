//! Instructions driven by rungs of `display`: digits for lamps and from thumbwheels, selections of one lamp of eight,
//! blocks of bits from words and back.

use super::Device;
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
    let (group, pair) = (
        OUTPUTS + 8 * random.below(8),
        OUTPUTS + 16 * random.below(4),
    );
    let wheel = 16 * random.below(8);
    let relay = RELAYS + random.below(500);
    let lamps: Vec<Device> = (relay..relay + LAMPS).map(|n| (M, n)).collect();
    let new = |steps, list: String, hand: String, words_used: &[u32], bits: Vec<Device>| {
        let mut driven = Driven::new(steps, list, hand, words(words_used.iter().copied()));
        driven.devices.extend(bits);
        driven
    };
    let outputs = |first: u32, count: u32| (first..first + count).map(|n| (Y, n)).collect();
    match which {
        0..=1 => new(
            5,
            format!("SEGD D{a} K2Y{group:03o}"),
            format!("put_bits(&p->Y[{group}], 8, segments[p->D[{a}] & 15]);"),
            &[a],
            outputs(group, 8),
        ),
        2 => new(
            12,
            format!("DIV D{a} K10 D{b};SEGD D{} K2Y{group:03o}", b + 1),
            format!(
                "const int16_t value = p->D[{a}]; p->D[{b}] = value / 10; p->D[{}] = value % 10; \
                 put_bits(&p->Y[{group}], 8, segments[p->D[{}] & 15]);",
                b + 1,
                b + 1
            ),
            &[a, b, b + 1],
            outputs(group, 8),
        ),
        3..=4 => new(
            5,
            format!("BCD D{a} K4Y{pair:03o}"),
            format!("if (is_decimal(p->D[{a}])) put_bits(&p->Y[{pair}], 16, digits(p->D[{a}]));"),
            &[a],
            outputs(pair, 16),
        ),
        5 => new(
            5,
            format!("BCD D{a} D{b}"),
            format!("if (is_decimal(p->D[{a}])) p->D[{b}] = (int16_t)digits(p->D[{a}]);"),
            &[a, b],
            Vec::new(),
        ),
        6 => new(
            5,
            format!("BIN K4X{wheel:03o} D{b}"),
            format!("from_wheels(&p->D[{b}], get_bits(&p->X[{wheel}], 16));"),
            &[b],
            (wheel..wheel + 16).map(|n| (X, n)).collect(),
        ),
        7 => new(
            7,
            format!("DECO D{a} M{relay} K3"),
            format!("select_lamp(&p->M[{relay}], {LAMPS}, p->D[{a}] & 7);"),
            &[a],
            lamps,
        ),
        8 => new(
            7,
            format!("ENCO M{relay} D{b} K3"),
            format!("selected_lamp(&p->D[{b}], &p->M[{relay}], {LAMPS});"),
            &[b],
            lamps,
        ),
        9 => new(
            5,
            format!("MOV D{a} K2M{relay}"),
            format!("put_bits(&p->M[{relay}], 8, (uint16_t)p->D[{a}]);"),
            &[a],
            lamps,
        ),
        10 => new(
            5,
            format!("MOV K2M{relay} D{b}"),
            format!("p->D[{b}] = (int16_t)get_bits(&p->M[{relay}], 8);"),
            &[b],
            lamps,
        ),
        _ => Driven::constant(random),
    }
}
