//! Instructions driven by rungs of `recipe`: blocks of words that are loaded from tables and stored there, cleared,
//! filled and shifted. A table has eight recipes; the offset of one in use is a register's bits, or a pointer that
//! counts from recipe to recipe.

use super::Device;
use super::driven::{Driven, WORDS, words};
use crate::random::Random;
use rungc_syntax::DeviceClass::M;

/// Pointers, and their number.
const POINTERS: u32 = 200;
const POINTER_COUNT: u32 = 4;
/// Blocks of words, and from how many places they begin.
const BLOCKS: u32 = 300;
const BLOCK_COUNT: u32 = 200;
/// Queues, and words of each, with the one that counts its entries.
const QUEUES: u32 = 560;
const QUEUE: u32 = 16;
/// Tables, their number, and words of each.
const TABLES: u32 = 600;
const TABLE_COUNT: u32 = 3;
const TABLE: u32 = 8 * RECIPE;
/// Words of a recipe.
const RECIPE: u32 = 16;
/// Words altogether.
pub const REGISTERS: u32 = TABLES + TABLE_COUNT * TABLE;
/// Relays that are shifted and reset.
const RELAYS: u32 = 7000;

/// Instructions of a rung.
pub fn random(random: &mut Random) -> Driven {
    let which = random.below(16);
    let [a, b] = [0; 2].map(|_| random.below(WORDS));
    let count = random.between(10, 50);
    let block = BLOCKS + random.below(BLOCK_COUNT);
    let table = TABLES + TABLE * random.below(TABLE_COUNT);
    let relay = RELAYS + random.below(200);
    let queue = QUEUES + QUEUE * random.below(2);
    let pointer = POINTERS + random.below(POINTER_COUNT);
    let value = random.below(10_000);
    let z = random.below(8);
    let of_blocks = |steps, list: String, hand: String, blocks: &[(u32, u32)]| {
        let all = blocks
            .iter()
            .flat_map(|&(first, count)| first..first + count);
        Driven::new(steps, list, hand, words(all))
    };
    let of_recipe = |list: &str, hand: &str| {
        let (register, index, offset) = match which % 2 {
            0 => (
                pointer,
                format!("MOV D{pointer} Z{z}"),
                format!("p->D[{pointer}]"),
            ),
            _ => (
                a,
                format!("WAND D{a} K112 Z{z}"),
                format!("(p->D[{a}] & 112)"),
            ),
        };
        of_blocks(
            12,
            format!("{index};{}", list.replace('@', &format!("D{table}Z{z}"))),
            hand.replace('@', &format!("&p->D[{table} + {offset}]")),
            &[(table, TABLE), (register, 1), (block, RECIPE)],
        )
    };
    let bits = |driven: Driven, first: u32, count: u32| with_bits(driven, first, count);
    match which {
        0..=2 => of_recipe(
            &format!("BMOV @ D{block} K{RECIPE}"),
            &format!("memcpy(&p->D[{block}], @, {RECIPE} * sizeof *p->D);"),
        ),
        3..=4 => of_recipe(
            &format!("BMOV D{block} @ K{RECIPE}"),
            &format!("memcpy(@, &p->D[{block}], {RECIPE} * sizeof *p->D);"),
        ),
        5 => of_recipe(
            &format!("FMOV K{value} @ K{RECIPE}"),
            &format!("fill(@, {RECIPE}, {value});"),
        ),
        6 => of_blocks(
            7,
            format!("BMOV D{a} D{block} K{count}"),
            format!("copy(&p->D[{block}], &p->D[{a}], {count});"),
            &[(a, count), (block, count)],
        ),
        7 => of_blocks(
            7,
            format!("BMOV D{block} D{} K{count}", block + 3),
            format!("copy(&p->D[{}], &p->D[{block}], {count});", block + 3),
            &[(block, count + 3)],
        ),
        8 => of_blocks(
            7,
            format!("FMOV D{a} D{block} K{count}"),
            format!("fill(&p->D[{block}], {count}, p->D[{a}]);"),
            &[(a, 1), (block, count)],
        ),
        9 => of_blocks(
            5,
            format!("ZRST D{block} D{}", block + count - 1),
            format!("memset(&p->D[{block}], 0, {count} * sizeof *p->D);"),
            &[(block, count)],
        ),
        10 => bits(
            of_blocks(
                5,
                format!("ZRST M{relay} M{}", relay + count - 1),
                format!("memset(&p->M[{relay}], 0, {count});"),
                &[],
            ),
            relay,
            count,
        ),
        11 => bits(
            bits(
                of_blocks(
                    9,
                    format!("SFTL M{b} M{relay} K{count} K1"),
                    format!("shift(&p->M[{relay}], {count}, p->M[{b}]);"),
                    &[],
                ),
                relay,
                count,
            ),
            b,
            1,
        ),
        12 => of_blocks(
            9,
            format!("WSFL D{a} D{block} K{RECIPE} K1"),
            format!(
                "copy(&p->D[{}], &p->D[{block}], {}); p->D[{block}] = p->D[{a}];",
                block + 1,
                RECIPE - 1
            ),
            &[(a, 1), (block, RECIPE)],
        ),
        13 => of_blocks(
            7,
            format!("SFWR D{a} D{queue} K{QUEUE}"),
            format!("append(&p->D[{queue}], {QUEUE}, p->D[{a}]);"),
            &[(a, 1), (queue, QUEUE)],
        ),
        14 => of_blocks(
            7,
            format!("SFRD D{queue} D{b} K{QUEUE}"),
            format!("take(&p->D[{queue}], {QUEUE}, &p->D[{b}]);"),
            &[(queue, QUEUE), (b, 1)],
        ),
        _ => match random.chance(0.4) {
            true => next_recipe(pointer),
            false => Driven::constant(random),
        },
    }
}

fn with_bits(mut driven: Driven, first: u32, count: u32) -> Driven {
    let bits = (first..first + count).map(|number| -> Device { (M, number) });
    driven.devices.extend(bits);
    driven
}

/// A pointer that counts from recipe to recipe.
fn next_recipe(pointer: u32) -> Driven {
    Driven::new(
        18,
        format!("ADD D{pointer} K{RECIPE} D{pointer};LD>= D{pointer} K{TABLE};MOV K0 D{pointer}"),
        format!(
            "p->D[{pointer}] = (int16_t)(p->D[{pointer}] + {RECIPE}); \
             if (p->D[{pointer}] >= {TABLE}) p->D[{pointer}] = 0;"
        ),
        words([pointer]),
    )
}
