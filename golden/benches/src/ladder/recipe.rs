//! Instructions driven by rungs of `recipe`: blocks of words that are loaded from tables and stored there, cleared,
//! filled and shifted. A table has eight recipes; the offset of one in use is a register's bits, or a pointer that
//! counts from recipe to recipe.

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

/// Numbers that were drawn.
struct Drawn {
    a: u32,
    b: u32,
    count: u32,
    block: u32,
    table: u32,
    relay: u32,
    queue: u32,
    pointer: u32,
    value: u32,
    z: u32,
}

/// Instructions of a rung.
pub fn random(random: &mut Random) -> Driven {
    let which = random.below(16);
    let [a, b] = [0; 2].map(|_| random.below(WORDS));
    let drawn = Drawn {
        a,
        b,
        count: random.between(10, 50),
        block: BLOCKS + random.below(BLOCK_COUNT),
        table: TABLES + TABLE * random.below(TABLE_COUNT),
        relay: RELAYS + random.below(200),
        queue: QUEUES + QUEUE * random.below(2),
        pointer: POINTERS + random.below(POINTER_COUNT),
        value: random.below(10_000),
        z: random.below(8),
    };
    match which {
        0..=5 => recipe(which, &drawn),
        6..=14 => blocks(which, &drawn),
        _ => match random.chance(0.4) {
            true => next_recipe(drawn.pointer),
            false => Driven::constant(random),
        },
    }
}

fn of_blocks(steps: u32, list: String, hand: String, blocks: &[(u32, u32)]) -> Driven {
    let all = blocks
        .iter()
        .flat_map(|&(first, count)| first..first + count);
    Driven::new(steps, list, hand, words(all))
}

/// A recipe that is loaded, stored or filled.
fn recipe(which: u32, drawn: &Drawn) -> Driven {
    let Drawn {
        a,
        block,
        table,
        pointer,
        value,
        z,
        ..
    } = *drawn;
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
    let (first, at) = (
        format!("D{table}Z{z}"),
        format!("&p->D[{table} + {offset}]"),
    );
    let (list, hand) = match which {
        0..=2 => (
            format!("BMOV {first} D{block} K{RECIPE}"),
            format!("memcpy(&p->D[{block}], {at}, {RECIPE} * sizeof *p->D);"),
        ),
        3..=4 => (
            format!("BMOV D{block} {first} K{RECIPE}"),
            format!("memcpy({at}, &p->D[{block}], {RECIPE} * sizeof *p->D);"),
        ),
        _ => (
            format!("FMOV K{value} {first} K{RECIPE}"),
            format!("fill({at}, {RECIPE}, {value});"),
        ),
    };
    let registers = [(table, TABLE), (register, 1), (block, RECIPE)];
    of_blocks(12, format!("{index};{list}"), hand, &registers)
}

/// Blocks, shifts and queues.
fn blocks(which: u32, drawn: &Drawn) -> Driven {
    let Drawn {
        a,
        b,
        count,
        block,
        relay,
        queue,
        ..
    } = *drawn;
    match which {
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
        10 => of_blocks(
            5,
            format!("ZRST M{relay} M{}", relay + count - 1),
            format!("memset(&p->M[{relay}], 0, {count});"),
            &[],
        )
        .and_bits(M, relay, count),
        11 => of_blocks(
            9,
            format!("SFTL M{b} M{relay} K{count} K1"),
            format!("shift(&p->M[{relay}], {count}, p->M[{b}]);"),
            &[],
        )
        .and_bits(M, relay, count)
        .and_bits(M, b, 1),
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
        _ => of_blocks(
            7,
            format!("SFRD D{queue} D{b} K{QUEUE}"),
            format!("take(&p->D[{queue}], {QUEUE}, &p->D[{b}]);"),
            &[(queue, QUEUE), (b, 1)],
        ),
    }
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
