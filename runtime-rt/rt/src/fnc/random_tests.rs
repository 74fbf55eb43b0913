//! Every function with random operands on random devices: none panics, whatever a program's data.

use crate::double::Double;
use crate::{Class, Operand, Plc, RtFn};
use proptest::prelude::*;

fn class() -> impl Strategy<Value = Class> {
    use Class::{C, D, ER, M, R, S, T, V, X, Y, Z};
    prop::sample::select(&[X, Y, M, S, T, C, D, R, V, Z, ER])
}

fn number() -> impl Strategy<Value = i32> {
    prop_oneof![4 => 0..300i32, 1 => 8000..8520i32, 1 => any::<i32>()]
}

fn value() -> impl Strategy<Value = i32> {
    prop_oneof![
        4 => -3..40i32,
        1 => any::<i16>().prop_map(i32::from),
        1 => any::<i32>(),
        1 => prop::sample::select(&[i32::MIN, i32::MAX, i16::MIN as i32, i16::MAX as i32]),
    ]
}

fn operand() -> impl Strategy<Value = Operand> {
    prop_oneof![
        3 => value().prop_map(Operand::constant),
        1 => any::<f32>().prop_map(Operand::float),
        6 => (class(), number()).prop_map(|(class, n)| Operand::device(class, n)),
        1 => (0..=9u8, class(), number()).prop_map(|(digits, class, n)| Operand::nibbles(digits, class, n)),
        1 => (class(), number(), 0..16u8).prop_map(|(class, n, bit)| Operand::word_bit(class, n, bit)),
        1 => (0..3i32).prop_map(Operand::text),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1024))]
    #[test]
    fn nothing_panics(
        ops in prop::collection::vec(operand(), 0..7),
        words in prop::collection::vec(value(), 64),
        bits in prop::collection::vec(any::<bool>(), 64),
        flags in any::<u64>(),
        wide: bool,
        drives in prop::collection::vec(prop::bool::weighted(0.8), 6),
        signals in prop::collection::vec(prop::bool::weighted(0.3), 6),
        dt in prop_oneof![0..200u32, any::<u32>()],
        function in prop::sample::select(RtFn::ALL),
    ) {
        let mut plc = if wide { Double::wide() } else { Double::new() };
        plc.set_d(0, &words);
        plc.set_d(200, &words);
        plc.texts.push(b"12.5E3".to_vec());
        plc.hal.set_bfm(0, 0, 7).unwrap();
        for (n, &bit) in (0..).zip(&bits) {
            for class in [Class::X, Class::Y, Class::M, Class::S] {
                plc.set_bit(class, n, bit);
            }
        }
        for (n, &word) in (0..).zip(&words) {
            for class in [Class::T, Class::C, Class::R, Class::V] {
                plc.set_word(class, n, word as i16);
            }
        }
        let modes = [8015, 8017, 8024, 8026, 8027, 8029, 8049, 8090, 8160, 8161, 8164, 8165, 8167, 8168, 8490];
        for (n, relay) in modes.into_iter().enumerate() {
            plc.set_bit(Class::M, relay, flags >> n & 1 == 1);
        }
        for (drive, signal) in drives.into_iter().zip(signals) {
            plc.site.signal = signal;
            let _ = plc.scan(dt, drive, function, &ops);
        }
    }
}
