//! Instructions driven by rungs of `index`: tables of words and of long words that index registers address. An index
//! is a register's lower bits, or a pointer that counts around a table; so none leaves its table.

use super::driven::{Driven, Form, WORDS, three_relays, words};
use crate::random::Random;
use rungc_syntax::DeviceClass::M;
use std::ops::Range;

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
    let entry = Table::of_words(words_at, which.is_multiple_of(2), pointer, a, z);
    let long_entry = Table::of_longs(longs_at, a, z);
    let of_table = |steps: u32, list: &str, hand: String, others: &[u32]| {
        entry.driven(steps, list, &hand, others.iter().copied())
    };
    let of_longs = |steps: u32, list: &str, hand: String, others: &[u32]| {
        long_entry.driven(steps, list, &hand, others.iter().flat_map(|&n| [n, n + 1]))
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
            let compared = [">", "==", "<"].map(|operator| format!("entry {operator} {limit}"));
            let hand = format!("const int16_t entry = @; {}", three_relays(relay, compared));
            of_table(7, &format!("CMP @ K{limit} M{relay}"), hand, &[]).and_bits(M, relay, 3)
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
            false => Driven::long_constant(limit * 1000, long),
        },
    }
}

/// A table, and the entry that an index leads to.
struct Table {
    words: Range<u32>,
    /// The register that the index comes from.
    register: u32,
    /// The instruction that puts it into the index register, and its steps.
    index: (String, u32),
    /// The entry, in the list and in C.
    entry: (String, String),
}

impl Table {
    /// A table of words, whose index is a pointer or the lower bits of a word.
    fn of_words(first: u32, by_pointer: bool, pointer: u32, a: u32, z: u32) -> Self {
        let (register, index, offset) = match by_pointer {
            true => (
                pointer,
                format!("MOV D{pointer} Z{z}"),
                format!("p->D[{pointer}]"),
            ),
            false => (
                a,
                format!("WAND D{a} K15 Z{z}"),
                format!("(p->D[{a}] & 15)"),
            ),
        };
        Table {
            words: first..first + TABLE,
            register,
            index: (index, 5),
            entry: (format!("D{first}Z{z}"), format!("p->D[{first} + {offset}]")),
        }
    }

    /// A table of long words, whose index is the lower bits of a word without the last one.
    fn of_longs(first: u32, a: u32, z: u32) -> Self {
        Table {
            words: first..first + LONG_TABLE,
            register: a,
            index: (format!("WAND D{a} K30 Z{z}"), 7),
            entry: (
                format!("D{first}Z{z}"),
                format!("&p->D[{first} + (p->D[{a}] & 30)]"),
            ),
        }
    }

    /// An instruction with the entry, which is `@` in it, and with other registers.
    fn driven(
        &self,
        steps: u32,
        list: &str,
        hand: &str,
        others: impl Iterator<Item = u32>,
    ) -> Driven {
        let all = self.words.clone().chain([self.register]).chain(others);
        Driven::new(
            self.index.1 + steps,
            format!("{};{}", self.index.0, list.replace('@', &self.entry.0)),
            hand.replace('@', &self.entry.1),
            words(all),
        )
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
