//! Operations on values do what the manuals say of them, on random operands of both widths: the oracle is written here
//! with the machine's own operators.

use rungc_golden::rng::Rng;
use rungc_interp::Machine;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;
use rungc_rt::{Class, NoHal, Plc, Program};
use rungc_syntax::DeviceClass;

/// The results of an operation.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Outcome {
    /// D20 or its pair, or M0; `None` if it stays.
    result: Option<i64>,
    /// M8020, M8021 and M8022; `None` for one that stays.
    flags: [Option<bool>; 3],
    /// True if the instruction reports an error.
    fails: bool,
}

const FAILURE: Outcome = Outcome {
    result: None,
    flags: [None; 3],
    fails: true,
};

fn value(result: i64) -> Outcome {
    Outcome {
        result: Some(result),
        flags: [None; 3],
        fails: false,
    }
}

/// Where the result is.
#[derive(Clone, Copy, PartialEq)]
enum Shown {
    /// In D20, or the pair.
    Number,
    /// In M0.
    Bit,
}

/// An instruction: the operands are D0, D2, D4, the result is D20 or M0. The oracle gets the operands, the result's
/// former value, and the number of bits.
struct Case {
    model: ModelId,
    text: &'static str,
    shown: Shown,
    oracle: fn([i64; 3], i64, u32) -> Outcome,
}

const fn case(text: &'static str, oracle: fn([i64; 3], i64, u32) -> Outcome) -> Case {
    let (model, shown) = (ModelId::Fx3u, Shown::Number);
    Case {
        model,
        text,
        shown,
        oracle,
    }
}

const fn of_hm(text: &'static str, oracle: fn([i64; 3], i64, u32) -> Outcome) -> Case {
    Case {
        model: ModelId::Hm,
        ..case(text, oracle)
    }
}

/// The number that the low `width` bits are.
fn wrapped(number: i64, width: u32) -> i64 {
    number << (64 - width) >> (64 - width)
}

/// The low `width` bits.
fn bits(number: i64, width: u32) -> u64 {
    number as u64 & (u64::MAX >> (64 - width))
}

fn rotated_left(number: i64, places: u32, width: u32) -> i64 {
    let (ring, places) = (bits(number, width), places % width);
    wrapped((ring << places | ring >> (width - places)) as i64, width)
}

fn with_carry(result: i64, carry: bool) -> Outcome {
    Outcome {
        flags: [None, None, Some(carry)],
        ..value(result)
    }
}

/// ROL by n places; ROR is the same by the places that are left.
fn rotation(d: i64, n: i64, right: bool, width: u32) -> Outcome {
    if !(0..=i64::from(width)).contains(&n) {
        return FAILURE;
    }
    if n == 0 {
        return value(d);
    }
    let places = if right { width - n as u32 } else { n as u32 };
    let result = rotated_left(d, places, width);
    let last = if right { result < 0 } else { result & 1 == 1 };
    with_carry(result, last)
}

fn root(number: i64) -> Outcome {
    let root = number.isqrt();
    Outcome {
        flags: [Some(root == 0), Some(root * root != number), None],
        ..value(root)
    }
}

/// The largest number whose digits fit.
fn shown(width: u32) -> i64 {
    if width == 32 { 99_999_999 } else { 9999 }
}

fn bcd(number: i64, width: u32) -> i64 {
    let digits = i64::from_str_radix(&number.to_string(), 16).unwrap();
    wrapped(digits, width)
}

/// The number of packed digits, each of which counts as what it is.
fn unpacked(digits: i64, width: u32) -> i64 {
    let mut number = 0;
    for place in (0..width / 4).rev() {
        number = number * 10 + (bits(digits, width) >> (4 * place) & 15) as i64;
    }
    wrapped(number, width)
}

fn is_decimal(digits: i64, width: u32) -> bool {
    format!("{:x}", bits(digits, width))
        .chars()
        .all(|digit| digit.is_ascii_digit())
}

fn gray(number: i64) -> i64 {
    number ^ number >> 1
}

fn from_gray(mut code: i64) -> i64 {
    let mut number = 0;
    while code != 0 {
        number ^= code;
        code >>= 1;
    }
    number
}

/// What of a digit is on, by the letters of its segments.
const SEGMENTS: [&str; 16] = [
    "abcdef", "bc", "abdeg", "abcdg", "bcfg", "acdfg", "acdefg", "abcf", "abcdefg", "abcdfg",
    "abcefg", "cdefg", "adef", "bcdeg", "adefg", "aefg",
];

fn segments(digit: i64) -> i64 {
    let letters = SEGMENTS[(digit & 15) as usize].bytes();
    letters.map(|letter| 1 << (letter - b'a')).sum()
}

const CASES: &[Case] = &[
    case("LIMIT D0 D2 D4 D20", |[low, high, x], _, _| {
        match low <= high {
            true => value(x.clamp(low, high)),
            false => FAILURE,
        }
    }),
    case("LIMIT K-100 K200 D4 D20", |[_, _, x], _, _| {
        value(x.clamp(-100, 200))
    }),
    case("LIMIT K5 D2 D4 D20", |[_, high, x], _, _| match 5 <= high {
        true => value(x.clamp(5, high)),
        false => FAILURE,
    }),
    case("BAND D0 D2 D4 D20", |[low, high, x], _, width| {
        match low <= high {
            true => value(wrapped(x - x.clamp(low, high), width)),
            false => FAILURE,
        }
    }),
    case("ZONE D0 D2 D4 D20", |[below, above, x], _, width| {
        let by = [below, 0, above][(x.signum() + 1) as usize];
        value(wrapped(x + by, width))
    }),
    case("SEGD D0 D20", |[digit, ..], old, _| {
        value(wrapped(old & !255 | segments(digit), 16))
    }),
    case("SWAP D20", |_, old, width| {
        let low = bits(old, width) & 0x00ff_00ff;
        let high = bits(old, width) >> 8 & 0x00ff_00ff;
        value(wrapped((low << 8 | high) as i64, width))
    }),
    case("SUM D0 D20", |[x, ..], _, width| {
        let ones = i64::from(bits(x, width).count_ones());
        Outcome {
            flags: [Some(ones == 0), None, None],
            ..value(ones)
        }
    }),
    case("BCD D0 D20", |[x, ..], _, width| match x {
        _ if (0..=shown(width)).contains(&x) => value(bcd(x, width)),
        _ => FAILURE,
    }),
    case("BIN D0 D20", |[x, ..], _, width| {
        match is_decimal(x, width) {
            true => value(unpacked(x, width)),
            false => FAILURE,
        }
    }),
    case(
        "SQR D0 D20",
        |[x, ..], _, _| if x < 0 { FAILURE } else { root(x) },
    ),
    case("ROR D20 D0", |[n, ..], d, width| {
        rotation(d, n, true, width)
    }),
    case("ROL D20 D0", |[n, ..], d, width| {
        rotation(d, n, false, width)
    }),
    case("ROR D20 K3", |_, d, width| rotation(d, 3, true, width)),
    case("ROL D20 K16", |_, d, width| rotation(d, 16, false, width)),
    case(
        "GRY D0 D20",
        |[x, ..], _, _| if x < 0 { FAILURE } else { value(gray(x)) },
    ),
    case("GBIN D0 D20", |[x, ..], _, _| match x {
        ..0 => FAILURE,
        _ => value(from_gray(x)),
    }),
    Case {
        shown: Shown::Bit,
        ..case("BON D0 M0 D2", |[x, n, _], _, width| match n {
            _ if (0..i64::from(width)).contains(&n) => value(x >> n & 1),
            _ => FAILURE,
        })
    },
    Case {
        shown: Shown::Bit,
        ..case("BON D0 M0 K15", |[x, ..], _, _| value(x >> 15 & 1))
    },
    of_hm("BCD D0 D20", |[x, ..], _, width| {
        value(bcd(x.clamp(0, shown(width)), width))
    }),
    of_hm("BIN D0 D20", |[x, ..], _, width| value(unpacked(x, width))),
    of_hm("SQR D0 D20", |[x, ..], _, _| root(x.max(0))),
];

/// The flags of arithmetic.
const FLAGS: [u32; 3] = [8020, 8021, 8022];

fn compiled(case: &Case, wide: bool) -> Option<rungc_ir::Module> {
    let d = if wide { "D" } else { "" };
    let text = format!("LD X000\n{d}{}\nEND\n", case.text);
    let read = rungc_frontend::read_text("test.il", &text);
    let registers = (0..6).chain(20..22).chain([8067]);
    let mut observe: Vec<_> = registers.map(|number| (DeviceClass::D, number)).collect();
    let relays = FLAGS.into_iter().chain([0, 8067]);
    observe.extend(relays.map(|number| (DeviceClass::M, number)));
    let options = CompileOptions {
        model: Some(case.model),
        observe,
        optimise: true,
        ..CompileOptions::default()
    };
    compile(&read.program, &options).module
}

fn set(machine: &mut Machine, register: u32, number: i64) {
    machine.set_word(Class::D, register, number as i16);
    machine.set_word(Class::D, register + 1, (number >> 16) as i16);
}

fn shown_of(machine: &Machine, case: &Case, width: u32) -> i64 {
    if case.shown == Shown::Bit {
        return machine.bit(Class::M, 0).unwrap().into();
    }
    let [low, high] = [20, 21].map(|n| i64::from(machine.word(Class::D, n).unwrap() as u16));
    wrapped(if width == 32 { high << 16 | low } else { low }, width)
}

#[test]
fn operations_on_values() {
    let mut rng = Rng::new(1);
    for case in CASES {
        let mut forms = 0;
        for width in [16, 32] {
            let Some(module) = compiled(case, width == 32) else {
                continue;
            };
            forms += 1;
            let mut machine = Machine::new(&module);
            for round in 0..2000 {
                let operands = [0; 3].map(|_| rng.value(width));
                for (register, operand) in [0, 2, 4].into_iter().zip(operands) {
                    set(&mut machine, register, operand);
                }
                set(&mut machine, 20, rng.value(width));
                machine.set_bit(Class::M, 0, rng.percent(50));
                let flags = FLAGS.map(|relay| {
                    let on = rng.percent(50);
                    machine.set_bit(Class::M, relay, on);
                    on
                });
                machine.set_bit(Class::X, 0, true);
                let old = shown_of(&machine, case, width);
                machine.scan(&mut NoHal, 10 * round, 0);
                let expected = (case.oracle)(operands, old, width);
                let what = format!("{} of {operands:?}, {old}, {width} bits", case.text);
                assert_eq!(
                    shown_of(&machine, case, width),
                    expected.result.unwrap_or(old),
                    "{what}"
                );
                let now = FLAGS.map(|relay| machine.bit(Class::M, relay).unwrap());
                for ((now, before), expected) in now.into_iter().zip(flags).zip(expected.flags) {
                    assert_eq!(now, expected.unwrap_or(before), "flags of {what}");
                }
                // Of HM, none of the cases fails.
                let failed = match case.model {
                    ModelId::Fx3u => machine.bit(Class::M, 8067).unwrap(),
                    _ => machine.last_error().code != 0,
                };
                assert_eq!(failed, expected.fails, "errors of {what}");
            }
        }
        assert!(forms > 0, "{} is not compiled", case.text);
    }
}
