//! Instructions driven by rungs of `process`: moves of blocks, shifts, queues, conversions and floats, as in process
//! control.
//!
//! Floats come from words, are added and multiplied once, and become words again, so that none ever leaves the range of
//! a float.

use super::Device;
use crate::random::Random;
use rungc_syntax::DeviceClass::{D, M};
use std::fmt::Write;

/// Words that are calculated with.
const WORDS: u32 = 200;
/// Floats that words become, and those that these become.
const SOURCES: u32 = 200;
const RESULTS: u32 = 240;
/// Numbers of registers of each use: floats.
const FLOATS: u32 = 20;
/// Words that are moved in blocks.
const BLOCKS: u32 = 300;
/// Queues.
const QUEUES: u32 = 560;
/// Words of each, with the one that counts its entries.
const QUEUE: u32 = 16;
/// Words altogether.
pub const REGISTERS: u32 = 600;
/// Relays that are shifted.
const SHIFTED: u32 = 7000;

/// Instruction driven by a rung of `process`. Numbers are those of devices D, or M where bits are shifted.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Process {
    /// BMOV.
    Copy {
        /// First source.
        from: u32,
        /// First target.
        to: u32,
        /// Number of devices.
        count: u32,
    },
    /// FMOV.
    Fill {
        /// The value's register.
        from: u32,
        /// First target.
        to: u32,
        /// Number of devices.
        count: u32,
    },
    /// SFTL of relays by one.
    Shift {
        /// Bit that is shifted in.
        from: u32,
        /// First of them.
        to: u32,
        /// Number of devices.
        count: u32,
    },
    /// SFWR: a register's word to a queue.
    Append(u32, u32),
    /// SFRD: the oldest word of a queue to a register.
    Take(u32, u32),
    /// BCD.
    Pack(u32, u32),
    /// ROL by some places.
    Rotate(u32, u32),
    /// MOV K, which gives the others something to work on.
    Constant(u32, u32),
    /// FLT of a word.
    ToFloat(u32, u32),
    /// DEADD.
    AddFloats([u32; 3]),
    /// DEMUL.
    MultiplyFloats([u32; 3]),
    /// INT to a word.
    ToWord(u32, u32),
}

use Process::*;

impl Process {
    /// A random one, and about how many steps it takes.
    pub fn random(random: &mut Random) -> (u32, Process) {
        let which = random.below(13);
        let [a, b] = [0; 2].map(|_| random.below(WORDS));
        let [x, y, z] = [0; 3].map(|_| 2 * random.below(FLOATS));
        let count = random.between(10, 50);
        let block = BLOCKS + random.below(200);
        let relay = SHIFTED + random.below(200);
        let value = random.below(10_000);
        let queue = QUEUES + QUEUE * random.below(2);
        match which {
            0 => (
                7,
                Copy {
                    from: a,
                    to: block,
                    count,
                },
            ),
            1 => (
                7,
                Copy {
                    from: block,
                    to: block + 3,
                    count,
                },
            ),
            2 => (
                7,
                Fill {
                    from: a,
                    to: block,
                    count,
                },
            ),
            3 => (
                9,
                Shift {
                    from: b,
                    to: relay,
                    count,
                },
            ),
            4 => (5, Pack(a, b)),
            5 => (5, Rotate(a, 1 + x % 15)),
            6 => (5, ToFloat(a, SOURCES + x)),
            7 => (13, AddFloats([SOURCES + x, SOURCES + y, RESULTS + z])),
            8 => (13, MultiplyFloats([SOURCES + x, SOURCES + y, RESULTS + z])),
            9 => (5, ToWord(RESULTS + x, a)),
            10 => (7, Append(a, queue)),
            11 => (7, Take(queue, b)),
            _ => (5, Constant(value, a)),
        }
    }

    /// The devices that it reads and writes.
    pub fn devices(self) -> Vec<Device> {
        let words = |first: u32, count: u32| (first..first + count).map(|n| (D, n));
        let bits = |first: u32, count: u32| (first..first + count).map(|n| (M, n));
        match self {
            Copy { from, to, count } => words(from, count).chain(words(to, count)).collect(),
            Fill { from, to, count } => words(from, 1).chain(words(to, count)).collect(),
            Shift { from, to, count } => bits(from, 1).chain(bits(to, count)).collect(),
            Append(a, queue) | Take(queue, a) => words(a, 1).chain(words(queue, QUEUE)).collect(),
            Pack(a, b) => vec![(D, a), (D, b)],
            Rotate(a, _) | Constant(_, a) => vec![(D, a)],
            ToFloat(a, x) | ToWord(x, a) => words(a, 1).chain(words(x, 2)).collect(),
            AddFloats(all) | MultiplyFloats(all) => {
                all.into_iter().flat_map(|n| words(n, 2)).collect()
            }
        }
    }

    /// The instruction.
    pub fn list(self, out: &mut String) {
        // Writing to a String does not fail.
        let _ = match self {
            Copy { from, to, count } => writeln!(out, "BMOV D{from} D{to} K{count}"),
            Fill { from, to, count } => writeln!(out, "FMOV D{from} D{to} K{count}"),
            Shift { from, to, count } => writeln!(out, "SFTL M{from} M{to} K{count} K1"),
            Append(a, queue) => writeln!(out, "SFWR D{a} D{queue} K{QUEUE}"),
            Take(queue, a) => writeln!(out, "SFRD D{queue} D{a} K{QUEUE}"),
            Pack(a, b) => writeln!(out, "BCD D{a} D{b}"),
            Rotate(a, places) => writeln!(out, "ROL D{a} K{places}"),
            Constant(value, a) => writeln!(out, "MOV K{value} D{a}"),
            ToFloat(a, x) => writeln!(out, "FLT D{a} D{x}"),
            AddFloats([x, y, z]) => writeln!(out, "DEADD D{x} D{y} D{z}"),
            MultiplyFloats([x, y, z]) => writeln!(out, "DEMUL D{x} D{y} D{z}"),
            ToWord(x, a) => writeln!(out, "INT D{x} D{a}"),
        };
    }

    /// The statement that an engineer would write where `on` holds.
    pub fn hand(self, on: &str) -> String {
        let what = match self {
            Copy { from, to, count } => format!("copy(&p->D[{to}], &p->D[{from}], {count});"),
            Fill { from, to, count } => format!("fill(&p->D[{to}], {count}, p->D[{from}]);"),
            Shift { from, to, count } => {
                format!("shift(&p->M[{to}], {count}, p->M[{from}]);")
            }
            Append(a, queue) => format!("append(&p->D[{queue}], {QUEUE}, p->D[{a}]);"),
            Take(queue, a) => format!("take(&p->D[{queue}], {QUEUE}, &p->D[{a}]);"),
            Pack(a, b) => format!("pack(&p->D[{b}], p->D[{a}]);"),
            Rotate(a, places) => format!("p->D[{a}] = rotate(p->D[{a}], {places});"),
            Constant(value, a) => format!("p->D[{a}] = {value};"),
            ToFloat(a, x) => format!("put_float(&p->D[{x}], (float)p->D[{a}]);"),
            AddFloats([x, y, z]) => {
                format!("put_float(&p->D[{z}], get_float(&p->D[{x}]) + get_float(&p->D[{y}]));")
            }
            MultiplyFloats([x, y, z]) => {
                format!("put_float(&p->D[{z}], get_float(&p->D[{x}]) * get_float(&p->D[{y}]));")
            }
            ToWord(x, a) => format!("p->D[{a}] = (int16_t)(int32_t)get_float(&p->D[{x}]);"),
        };
        format!("if ({on}) {what}")
    }
}
