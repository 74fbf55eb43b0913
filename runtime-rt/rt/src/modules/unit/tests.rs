use super::super::KINDS;
use super::*;
use std::vec::Vec;

fn module(name: &str) -> Module {
    Module::new(Kind::find(name).unwrap())
}

fn volts(volts: f64) -> Signal {
    Signal {
        quantity: Quantity::Volts,
        millionths: (volts * 1e6) as i32,
    }
}

fn milliamperes(milliamperes: f64) -> Signal {
    Signal {
        quantity: Quantity::Milliamperes,
        millionths: (milliamperes * 1e6) as i32,
    }
}

fn celsius(degrees: f64) -> Signal {
    Signal {
        quantity: Quantity::Celsius,
        millionths: (degrees * 1e6) as i32,
    }
}

/// Present value of the first input once everything has been converted.
fn measured(module: &mut Module, signal: Signal) -> i16 {
    module.connect(0, signal).unwrap();
    module.pass(7_000_000);
    let present = module.kind().with(Role::Present);
    let at = present.or(module.kind().with(Role::Mean)).unwrap().first;
    module.read(at).unwrap()
}

#[test]
fn every_kind_fits_a_module_and_its_rows_do_not_overlap() {
    for kind in &KINDS {
        assert!(usize::from(kind.inputs) <= CHANNELS, "{}", kind.name);
        assert!(usize::from(kind.outputs) <= CHANNELS, "{}", kind.name);
        let words: usize = kind.bfms.iter().map(|bfm| usize::from(bfm.count)).sum();
        assert!(words <= WORDS, "{}", kind.name);
        for pair in kind.bfms.windows(2) {
            assert!(
                pair[0].first < pair[1].first,
                "{}: {:?}",
                kind.name,
                pair[1]
            );
        }
        let mut numbers: Vec<_> = kind.bfms.iter().flat_map(Bfm::numbers).collect();
        numbers.sort_unstable();
        let all = numbers.len();
        numbers.dedup();
        assert_eq!(numbers.len(), all, "{}: words of two rows", kind.name);
        assert!(
            numbers.last().is_none_or(|&last| last <= kind.last),
            "{}",
            kind.name
        );
        assert_eq!(Kind::find(&kind.name.to_lowercase()), Some(kind));
        assert_eq!(&KINDS[kind.index()], kind);
        assert!(!kind.source.is_empty());
        for bfm in kind.bfms {
            assert!(!bfm.role.meaning().is_empty());
        }
    }
}

#[test]
fn ranges_of_h2u_4ad() {
    // h1u-h2u-programming §6.3: 0 ±10 V = ±2000, 1 4–20 mA = 0–1000, 2 ±20 mA = ±1000; 4 to 6 the same, finer.
    let mut module = module("H2U-4AD");
    for (digit, signal, value) in [
        (0, volts(10.0), 2000),
        (0, volts(-7.5), -1500),
        (0, volts(12.0), 2047),
        (1, milliamperes(4.0), 0),
        (1, milliamperes(12.0), 500),
        (2, milliamperes(-20.0), -1000),
        (4, volts(10.0), 10_000),
        (5, milliamperes(20.0), 10_000),
        (6, milliamperes(-10.0), -5000),
        (3, volts(5.0), -5000),
    ] {
        module.write(0, digit).unwrap();
        assert_eq!(measured(&mut module, signal), value, "{digit} {signal:?}");
    }
    assert_eq!(module.read(30), Some(2010));
    assert_eq!((module.read(31), module.write(31, 0)), (None, None));
    // A current input that gets 5 V draws 20 mA; a voltage input that gets a current measures too much.
    module.write(0, 1).unwrap();
    assert_eq!(measured(&mut module, volts(5.0)), 1000);
    module.write(0, 0).unwrap();
    assert_eq!(measured(&mut module, milliamperes(4.0)), 2047);
    assert_eq!(module.read(29), Some(RANGE_ERROR));
}

#[test]
fn means_take_as_long_as_the_manual_says() {
    // Conversion time × open channels × samples: here 6 ms × 2 × 4 = 48 ms.
    let mut module = module("H2U-4AD");
    module.write(0, 0x3300).unwrap();
    module.write(15, 1).unwrap();
    assert_eq!(module.read(1), Some(8));
    module.write(1, 4).unwrap();
    module.connect(0, volts(5.0)).unwrap();
    module.pass(47_999);
    assert_eq!((module.read(5), module.read(9)), (Some(0), Some(1000)));
    module.pass(1);
    assert_eq!((module.read(5), module.read(6)), (Some(1000), Some(0)));
    module.connect(0, volts(1.0)).unwrap();
    module.pass(24_000);
    module.connect(0, volts(2.0)).unwrap();
    module.pass(24_000);
    assert_eq!(module.read(5), Some(300));
    // Writing the rate sets the samples to 8, and a number out of range counts as 8.
    module.write(15, 1000).unwrap();
    assert_eq!(module.read(1), Some(8));
    module.write(2, 5000).unwrap();
    assert_eq!(module.read(29), Some(SAMPLES_ERROR));
}

#[test]
fn offset_and_gain_are_taken_over_and_locked() {
    // The manual's example: CH1 and CH2 from 0.5 V to 6 V.
    let mut module = module("H2U-4AD");
    module.write(23, 500).unwrap();
    module.write(24, 6000).unwrap();
    assert_eq!(measured(&mut module, volts(0.5)), 100);
    module.write(22, 0x000f).unwrap();
    module.write(21, 2).unwrap();
    assert_eq!(measured(&mut module, volts(0.5)), 0);
    assert_eq!(measured(&mut module, volts(6.0)), 1000);
    module.write(0, 0x3333).unwrap();
    module.write(20, 1).unwrap();
    assert_eq!((module.read(0), module.read(29)), (Some(0), Some(LOCKED)));
    // They outlast power-off, samples do not.
    module.write(1, 1).unwrap();
    module.power_cycle();
    assert_eq!((module.read(1), module.read(23)), (Some(8), Some(500)));
    assert_eq!(measured(&mut module, volts(6.0)), 1000);
    module.write(21, 1).unwrap();
    module.write(20, 1).unwrap();
    assert_eq!((module.read(20), module.read(24)), (Some(0), Some(5000)));
    assert_eq!(measured(&mut module, volts(6.0)), 1200);
}

#[test]
fn outputs_of_h2u_4da() {
    let mut module = module("H2U-4DA");
    module.write(0, 0x3210).unwrap();
    for channel in 1..=4 {
        module.write(channel, 500).unwrap();
    }
    let at = |module: &Module, channel| {
        let of = |quantity| module.signal(channel, quantity).unwrap();
        (of(Quantity::Volts), of(Quantity::Milliamperes))
    };
    assert_eq!(at(&module, 0), (2_500_000, 0));
    assert_eq!(at(&module, 1), (0, 12_000_000));
    assert_eq!(at(&module, 2), (0, 10_000_000));
    assert_eq!(at(&module, 3), (0, 0));
    assert_eq!(module.signal(4, Quantity::Volts), None);
    module.write(1, 2400).unwrap();
    assert_eq!(at(&module, 0), (11_750_000, 0));
    assert_eq!(module.read(29), Some(RANGE_ERROR));
    // The words show the curves in force: 4 to 20 mA for the second channel.
    assert_eq!(
        (module.read(12), module.read(13)),
        (Some(4000), Some(20_000))
    );
    // The manual's example: CH1 0.2 V to 5.5 V.
    module.write(10, 200).unwrap();
    module.write(11, 5500).unwrap();
    module.write(1, 1000).unwrap();
    assert_eq!(at(&module, 0), (5_000_000, 0));
    module.write(8, 0x0011).unwrap();
    assert_eq!(at(&module, 0), (5_500_000, 0));
    // STOP: CH1 goes to its offset, CH2 holds.
    module.write(5, 0x0101).unwrap();
    module.set_running(false);
    assert_eq!(
        (at(&module, 0), at(&module, 1)),
        ((200_000, 0), (0, 12_000_000))
    );
    module.set_running(true);
    module.write(20, 1).unwrap();
    assert_eq!((module.read(1), at(&module, 0)), (Some(0), (0, 0)));
}

#[test]
fn the_halves_of_a_mixed_module_are_reset_apart() {
    let mut module = module("H2U-4AM");
    module.write(32, 0x44).unwrap();
    module.write(33, 5000).unwrap();
    module.write(0, 0x33).unwrap();
    assert_eq!(module.signal(2, Quantity::Volts), Some(5_000_000));
    module.write(20, 1).unwrap();
    assert_eq!((module.read(0), module.read(32)), (Some(0), Some(0x44)));
    module.write(0, 0x11).unwrap();
    module.write(52, 1).unwrap();
    assert_eq!((module.read(0), module.read(32)), (Some(0x11), Some(0)));
    assert_eq!(measured(&mut module, milliamperes(20.0)), 1000);
}

#[test]
fn temperatures_in_both_units_and_broken_wires() {
    let mut module = module("H2U-4PT");
    assert_eq!(measured(&mut module, celsius(25.04)), 250);
    assert_eq!((module.read(13), module.read(17)), (Some(770), Some(770)));
    // Nothing is connected to the other three.
    assert_eq!(
        (module.read(28), module.read(6)),
        (Some(0b1010_1000), Some(6000))
    );
    for channel in 1..4 {
        module.connect(channel, celsius(0.0)).unwrap();
    }
    assert_eq!(measured(&mut module, celsius(-120.0)), -1000);
    assert_eq!(module.read(28), Some(0b1010_1001));
    assert_eq!(measured(&mut module, celsius(20.0)), 200);
    module.write(28, 0).unwrap();
    module.pass(1_000_000);
    assert_eq!((module.read(28), module.read(29)), (Some(0), Some(0)));
}

#[test]
fn conversions_that_the_program_starts() {
    let mut ad = module("FX2N-2AD");
    ad.connect(1, volts(10.0)).unwrap();
    ad.pass(1_000_000);
    assert_eq!(ad.read(0), Some(0));
    ad.write(17, 1).unwrap();
    ad.write(17, 3).unwrap();
    assert_eq!(
        (ad.read(0), ad.read(1)),
        (Some(4000 & 0xff), Some(4000 >> 8))
    );
    ad.connect(0, milliamperes(12.0)).unwrap();
    ad.write(17, 0).unwrap();
    ad.write(17, 2).unwrap();
    assert_eq!(
        (ad.read(0), ad.read(1)),
        (Some(2000 & 0xff), Some(2000 >> 8))
    );

    let mut da = module("FX2N-2DA");
    for (word, value) in [(16, 0xa0), (17, 4), (17, 0), (16, 0x0f), (17, 1), (17, 0)] {
        da.write(word, value).unwrap();
    }
    assert_eq!(da.signal(1, Quantity::Volts), Some(10_000_000));
    assert_eq!(da.signal(1, Quantity::Milliamperes), Some(20_000_000));
    assert_eq!(da.signal(0, Quantity::Volts), Some(0));

    let mut both = module("FX0N-3A");
    both.connect(0, volts(5.0)).unwrap();
    for (word, value) in [(17, 0), (17, 2), (16, 250), (17, 4), (17, 0)] {
        both.write(word, value).unwrap();
    }
    assert_eq!(both.read(0), Some(125));
    assert_eq!(both.signal(2, Quantity::Volts), Some(10_000_000));
}

#[test]
fn fx3u_modules() {
    let mut ad = module("FX3U-4AD");
    for (digit, signal, value) in [
        (0, volts(10.0), 32_000),
        (1, volts(10.0), 4000),
        (2, volts(-10.0), -10_000),
        (3, milliamperes(20.0), 16_000),
        (4, milliamperes(12.0), 2000),
        (5, milliamperes(12.0), 12_000),
        (6, milliamperes(-20.0), -16_000),
        (8, milliamperes(-20.0), -20_000),
    ] {
        ad.write(0, digit).unwrap();
        assert_eq!(measured(&mut ad, signal), value, "{digit} {signal:?}");
    }
    ad.write(0, 0).unwrap();
    ad.write(61, 100).unwrap();
    assert_eq!(measured(&mut ad, volts(1.0)), 3300);
    ad.write(109, 1).unwrap();
    assert_eq!(measured(&mut ad, volts(-1.0)), -3100);
    assert_eq!((ad.read(101), ad.read(111)), (Some(-3100), Some(3300)));
    // Settings of one kind do not disturb one another.
    ad.write(22, 7).unwrap();
    assert_eq!((ad.read(6), ad.read(22)), (Some(0), Some(7)));
    ad.write(41, 1000).unwrap();
    ad.write(51, 3000).unwrap();
    ad.write(61, 0).unwrap();
    ad.write(21, 1).unwrap();
    assert_eq!(measured(&mut ad, volts(3.0)), 16_000);

    let mut da = module("FX3U-4DA");
    da.write(0, 0x4320).unwrap();
    for channel in 1..=4 {
        da.write(channel, 16_000).unwrap();
    }
    assert_eq!(da.signal(0, Quantity::Volts), Some(5_000_000));
    assert_eq!(da.signal(1, Quantity::Milliamperes), Some(10_000_000));
    assert_eq!(da.signal(2, Quantity::Milliamperes), Some(12_000_000));
    assert_eq!(da.signal(3, Quantity::Milliamperes), Some(16_000_000));
}

/// The points of a module, input and output terminals.
fn terminal(quantity: Quantity, on: bool) -> Signal {
    Signal {
        quantity,
        millionths: if on { 1_000_000 } else { 0 },
    }
}

#[test]
fn remote_terminals_are_bits_of_words() {
    // h1u-h2u-programming §6.2.3: inputs in BFM 0, outputs in BFM 1.
    let mut module = module("H2U-0808ERNR");
    for (number, on) in [(0, true), (7, true), (3, true), (3, false)] {
        let signal = terminal(Quantity::InputTerminal, on);
        module.connect(number, signal).unwrap();
    }
    assert_eq!(module.read(0), Some(0x81));
    module.write(1, 0x12).unwrap();
    let lit = |number| module.signal(number, Quantity::OutputTerminal);
    assert_eq!(
        (lit(1), lit(2), lit(4)),
        (Some(1_000_000), Some(0), Some(1_000_000))
    );
    assert_eq!(lit(8), None);
    let none = terminal(Quantity::InputTerminal, true);
    assert_eq!(module.connect(8, none), None);
    assert_eq!(
        module.connect(0, terminal(Quantity::OutputTerminal, true)),
        None
    );
    assert_eq!(module.read(5), Some(500));
}

#[test]
fn types_of_single_channels() {
    // hm-motion-controller §7.2.2: 5 is voltage, 6 current; l01s-programming §9.3.2.
    for (name, kind, first, signal, value) in [
        ("EX1-4AD", 5, 4, volts(5.0), 10_000),
        ("EX1-4AD", 6, 4, milliamperes(20.0), 20_000),
        ("EX1-4AD", 0, 4, volts(5.0), 0),
        ("EX1-4TC", 2, 4, celsius(1234.5), 12_345),
        ("EX1-4TC", 3, 4, celsius(0.0), 600),
        ("L02S-4AD", 0, 19, volts(-10.0), -32_000),
        ("L02S-4AD", 0, 19, milliamperes(10.0), 16_000),
        ("L02S-4AD", 1, 19, milliamperes(12.0), 16_000),
        ("L02S-4AD", 1, 19, volts(6.0), 16_000),
        ("L02S-4TC", 11, 19, celsius(-50.0), -500),
    ] {
        let mut module = module(name);
        module.write(first, kind).unwrap();
        assert_eq!(measured(&mut module, signal), value, "{name} {kind}");
    }
    let mut module = module("EX1-4DA");
    module.write(1, 6).unwrap();
    module.write(5, 1000).unwrap();
    assert_eq!(module.signal(1, Quantity::Milliamperes), Some(5_000_000));
    assert_eq!(module.signal(0, Quantity::Volts), Some(0));
}

#[test]
fn adapters_convert_when_words_are_exchanged() {
    for kind in KINDS.iter().filter(|kind| kind.start == Start::Exchange) {
        let mut module = Module::new(kind);
        let quantity = kind.input_ranges.iter().flatten().next();
        for (channel, range) in (0..kind.inputs).zip(quantity.into_iter().cycle()) {
            let signal = Signal {
                quantity: range.quantity,
                millionths: i32::MAX,
            };
            module.connect(channel, signal).unwrap();
        }
        module.pass(1_000_000);
        for bfm in kind.bfms.iter().filter(|bfm| bfm.role == Role::Mean) {
            assert_eq!(module.read(bfm.first), Some(0), "{}", kind.name);
            module.write(kind.last, 1).unwrap();
            let most = kind.input_ranges[0].unwrap().high;
            assert_eq!(module.read(bfm.first), Some(most as i16), "{}", kind.name);
        }
        // Words do not share numbers, and FROM and TO never reach the module.
        let mut words: Vec<_> = kind.bfms.iter().flat_map(Bfm::numbers).collect();
        words.sort_unstable();
        assert!(words.windows(2).all(|pair| pair[0] < pair[1]), "{words:?}");
        assert!(!kind.place.named().is_empty(), "{}", kind.name);
    }
}

#[test]
fn errors_of_adapters_name_their_channels() {
    const ERROR: u16 = 18;
    let mut module = module("FX3U-3A-ADP");
    module.write(12, 4001).unwrap();
    module.connect(0, volts(10.3)).unwrap();
    module.connect(1, volts(-1.0)).unwrap();
    module.write(20, 1).unwrap();
    assert_eq!(module.read(ERROR), Some(0b101));
    module.write(14, 0).unwrap();
    assert_eq!(module.read(ERROR), Some(0b10_0101));
    module.write(7, 1).unwrap();
    module.write(12, 4000).unwrap();
    assert_eq!(module.read(ERROR), Some(0b10_0000));
    let mut open = Module::new(Kind::find("FX3U-4AD-PTW-ADP").unwrap());
    open.connect(3, celsius(20.0)).unwrap();
    open.write(20, 1).unwrap();
    assert_eq!(open.read(ERROR), Some(0b111));
}
