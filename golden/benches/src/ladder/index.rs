//! Instructions driven by rungs of `index`: tables of words and of long words that index registers address. An index
//! is a register's lower bits, or a pointer that counts around a table; so none leaves its table.

use super::driven::{Driven, Form, WORDS, words, words_and_pairs};
use crate::random::Random;
use rungc_syntax::DeviceClass::M;

/// Pointers, and their number.
const POINTERS: u32 = 200;
const POINTER_COUNT: u32 = 8;
/// Sums of tables, and their number.
const SUMS: u32 = 220;
const SUM_COUNT: u32 = 20;
/// Tables of words, their number, and words of each.
const TABLES: u32 = 300;
const TABLE_COUNT: u32 = 16;
const TABLE: u32 = 16;
/// Tables of long words, their number, and words of each.
const LONG_TABLES: u32 = 600;
const LONG_TABLE_COUNT: u32 = 8;
const LONG_TABLE: u32 = 32;
/// Long words, and their number.
const LONGS: u32 = 900;
const LONG_COUNT: u32 = 20;
/// Words altogether.
pub const REGISTERS: u32 = LONGS + 2 * LONG_COUNT;
/// Relays that comparisons drive.
const RELAYS: u32 = 7000;
/// Number of index registers that are used.
const INDEXES: u32 = 8;

/// Instructions of a rung.
pub fn random(random: &mut Random) -> Driven {
    let which = random.below(16);
    let mut table = |from, count, words| from + words * random.below(count);
    let words_at = table(TABLES, TABLE_COUNT, TABLE);
    let longs_at = table(LONG_TABLES, LONG_TABLE_COUNT, LONG_TABLE);
    let [long, other] = [0; 2].map(|_| table(LONGS, LONG_COUNT, 2));
    let z = random.below(INDEXES);
    let [a, b, c] = [0; 3].map(|_| random.below(WORDS));
    let pointer = POINTERS + random.below(POINTER_COUNT);
    let relay = RELAYS + random.below(500);
    let limit = random.below(10_000);
    let sum = SUMS + random.below(SUM_COUNT);
    // A pointer, or the lower bits of a word.
    let index = match which % 2 {
        0 => (
            pointer,
            format!("MOV D{pointer} Z{z}"),
            format!("p->D[{pointer}]"),
        ),
        _ => (
            a,
            format!("WAND D{a} K15 Z{z}"),
            format!("(p->D[{a}] & 15)"),
        ),
    };
    let of_table = |steps: u32, list: &str, hand: String, others: &[u32]| {
        let table = words_at..words_at + TABLE;
        let all = table.chain([index.0]).chain(others.iter().copied());
        let list = format!(
            "{};{}",
            index.1,
            list.replace('@', &format!("D{words_at}Z{z}"))
        );
        let hand = hand.replace('@', &format!("p->D[{words_at} + {}]", index.2));
        Driven::new(5 + steps, list, hand, words(all))
    };
    let of_longs = |steps: u32, list: &str, hand: String, others: &[u32]| {
        let longs = others.iter().flat_map(|&n| [n, n + 1]);
        let all = (longs_at..longs_at + LONG_TABLE).chain([a]).chain(longs);
        let list = list.replace('@', &format!("D{longs_at}Z{z}"));
        let hand = hand.replace('@', &format!("&p->D[{longs_at} + (p->D[{a}] & 30)]"));
        Driven::new(
            7 + steps,
            format!("WAND D{a} K30 Z{z};{list}"),
            hand,
            words(all),
        )
    };
    match which {
        0..=2 => of_table(5, &format!("MOV @ D{b}"), format!("p->D[{b}] = @;"), &[b]),
        3..=5 => of_table(5, &format!("MOV D{b} @"), format!("@ = p->D[{b}];"), &[b]),
        6 => of_table(
            7,
            &format!("ADD @ D{b} D{c}"),
            format!("p->D[{c}] = (int16_t)(@ + p->D[{b}]);"),
            &[b, c],
        ),
        7 => of_table(3, "INC @", "@ = (int16_t)(@ + 1);".to_string(), &[]),
        8 => {
            let hand = format!(
                "const int16_t entry = @; p->M[{relay}] = entry > {limit}; p->M[{}] = entry == {limit}; \
                 p->M[{}] = entry < {limit};",
                relay + 1,
                relay + 2
            );
            let mut driven = of_table(7, &format!("CMP @ K{limit} M{relay}"), hand, &[]);
            driven.devices.extend([0, 1, 2].map(|n| (M, relay + n)));
            driven
        }
        9..=10 => of_longs(
            9,
            &format!("DMOV @ D{long}"),
            format!("put_long(&p->D[{long}], get_long(@));"),
            &[long],
        ),
        11 => of_longs(
            9,
            &format!("DMOV D{long} @"),
            format!("put_long(@, get_long(&p->D[{long}]));"),
            &[long],
        ),
        12 => of_longs(
            13,
            &format!("DADD @ D{long} D{other}"),
            format!("put_long(&p->D[{other}], get_long(@) + get_long(&p->D[{long}]));"),
            &[long, other],
        ),
        13 => table_sum(words_at, sum, z),
        14 => count_around(pointer),
        _ => match random.chance(0.5) {
            true => Driven::constant(random),
            false => Driven::new(
                9,
                format!("DMOV K{} D{long}", limit * 1000),
                format!("put_long(&p->D[{long}], {});", limit * 1000),
                words_and_pairs([], [long]),
            ),
        },
    }
}

/// A pointer that counts around a table.
fn count_around(pointer: u32) -> Driven {
    Driven::new(
        14,
        format!("INC D{pointer};LD>= D{pointer} K{TABLE};MOV K0 D{pointer}"),
        format!("if (++p->D[{pointer}] >= {TABLE}) p->D[{pointer}] = 0;"),
        words([pointer]),
    )
}

/// The sum of a table, by a loop.
fn table_sum(table: u32, sum: u32, z: u32) -> Driven {
    let list = format!(
        "MOV K0 Z{z};MOV K0 D{sum};FOR K{TABLE};LD M8000;ADD D{sum} D{table}Z{z} D{sum};INC Z{z};NEXT"
    );
    let hand = format!(
        "int16_t sum = 0; for (int i = 0; i < {TABLE}; i++) sum = (int16_t)(sum + p->D[{table} + i]); \
         p->D[{sum}] = sum;"
    );
    let all = words((table..table + TABLE).chain([sum]));
    Driven::new(25, list, hand, all).with(Form::Always)
}
