use crate::modules::{Kind, Module, Quantity, Signal};

/// H2U-4PT-XP with the first channel set up: start, mode, set temperature, further words.
fn module(mode: i16, setpoint: i16, words: &[(u16, i16)]) -> Module {
    let mut module = Module::new(Kind::find("H2U-4PT-XP").unwrap());
    let usual = [(1, 1), (91, setpoint), (100, mode), (110, 100), (113, 1000)];
    for &(number, value) in usual.iter().chain([(121, 2)].iter()).chain(words) {
        module.write(number, value).unwrap();
    }
    module
}

fn at(module: &mut Module, tenths: i32, milliseconds: u32) {
    let signal = Signal {
        quantity: Quantity::Celsius,
        millionths: tenths * 100_000,
    };
    module.connect(0, signal).unwrap();
    module.pass(milliseconds * 1000);
}

fn read(module: &Module, number: u16) -> i16 {
    module.read(number).unwrap()
}

#[test]
fn a_relay_has_the_duty_of_its_output() {
    // The manual's example: a period of 2 s, output 50: on for 1 s, off for 1 s; 80: 1.6 s, 0.4 s.
    for (missing, on_ms) in [(50, 1000), (80, 1600), (0, 0), (200, 2000)] {
        let mut module = module(8, 1000, &[]);
        at(&mut module, 1000 - missing, 100);
        module.write(51, 1).unwrap();
        let mut on = 0;
        for _ in 0..2000 {
            module.pass(1000);
            on += i32::from(read(&module, 75));
        }
        assert_eq!(on, on_ms, "{missing}");
        assert_eq!(i32::from(read(&module, 71)), missing.min(100));
        assert_eq!((read(&module, 156), read(&module, 157)), (3, 0));
    }
}

#[test]
fn on_and_off_have_a_hysteresis() {
    // Mode: on and off, heating and cooling, main output heats.
    let mut module = module(2 | 4 | 8, 1000, &[(122, 2), (124, 20), (125, 30)]);
    at(&mut module, 990, 100);
    module.write(51, 1).unwrap();
    for (tenths, heats, cools) in [
        (990, 0, 0),
        (979, 1, 0),
        (999, 1, 0),
        (1000, 0, 0),
        (1030, 0, 0),
        (1031, 0, 1),
        (1001, 0, 1),
        (1000, 0, 0),
    ] {
        at(&mut module, tenths, 2100);
        assert_eq!(
            (read(&module, 75), read(&module, 85)),
            (heats, cools),
            "{tenths}"
        );
    }
    assert_eq!(read(&module, 156), 1);
}

#[test]
fn integral_derivative_and_limits() {
    // Ti = 10 s, digital output held from 30 to 70 (the manual's example of limits).
    let words = [(101, 4), (111, 100), (143, 70), (144, 30)];
    let mut module = module(1 | 8, 1000, &words);
    at(&mut module, 990, 100);
    module.write(51, 1).unwrap();
    at(&mut module, 990, 1);
    assert_eq!((read(&module, 71), read(&module, 158)), (30, 4));
    // A limit below does not keep the integral part from rising: 10, and 1 in each of 41 samples.
    at(&mut module, 990, 40_000);
    assert_eq!((read(&module, 71), read(&module, 158)), (51, 0));
    at(&mut module, 990, 60_000);
    assert_eq!((read(&module, 71), read(&module, 158)), (70, 4));
    // Held up, the output is that of BFM 118; so it is with a broken sensor.
    module.write(118, 44).unwrap();
    module.write(55, 1).unwrap();
    at(&mut module, 990, 1000);
    assert_eq!(read(&module, 71), 44);
    module.write(51, 0).unwrap();
    module.pass(1000);
    assert_eq!((read(&module, 71), read(&module, 156)), (0, 0));
}

#[test]
fn a_ramp_raises_the_target() {
    // The manual's example: BFM 130 = 0, BFM 131 = 10 are 1 °C in a minute.
    let mut module = module(1 | 8 | 32, 250, &[(130, 0), (131, 10)]);
    at(&mut module, 200, 100);
    module.write(51, 1).unwrap();
    for (minutes, target) in [(1, 210), (2, 230), (4, 250)] {
        at(&mut module, 200, minutes * 60_000);
        assert_eq!(read(&module, 117), target);
    }
}

#[test]
fn wrong_settings_stop_with_their_alarm() {
    for (mode, words, alarm) in [
        (9, &[(101, 1), (140, 1), (141, 2)][..], 1),
        (9, &[(101, 2), (142, -1)][..], 2),
        (9, &[(101, 4), (143, 1), (144, 2)][..], 3),
        (9, &[(101, 8), (148, 1), (149, 2)][..], 4),
        (9, &[(101, 16), (150, 1), (152, 2)][..], 5),
        (9, &[(101, 32), (153, 1), (154, 2)][..], 6),
        (9, &[(101, 64), (145, 1), (146, 2)][..], 7),
        (9 | 32, &[][..], 8),
        (8, &[(121, 0)][..], 9),
        (8 | 4, &[][..], 10),
        (9, &[(113, 0)][..], 30),
        (9, &[(114, 100)][..], 31),
        (9, &[(110, 0)][..], 32),
        (9, &[(126, -1)][..], 33),
        (9, &[(111, -1)][..], 34),
        (9, &[(112, -1)][..], 35),
        (9 | 16, &[(116, 100)][..], 50),
    ] {
        let mut module = module(mode, 1000, words);
        at(&mut module, 900, 100);
        module.write(51, 1).unwrap();
        module.pass(2_000_000);
        assert_eq!((read(&module, 157), read(&module, 156)), (alarm, 0));
        // Once it is right, the next start clears the alarm.
        module.write(51, 0).unwrap();
        module.pass(1000);
        assert_eq!(read(&module, 157), alarm);
    }
}

#[test]
fn tuning_sets_the_gains_and_goes_on() {
    // 1 °C a second after a dead time of 10 s, with full output.
    let mut module = module(1 | 8 | 16, 1000, &[(116, 100)]);
    at(&mut module, 200, 100);
    module.write(51, 1).unwrap();
    at(&mut module, 200, 1);
    assert_eq!((read(&module, 156), read(&module, 71)), (2, 100));
    for second in 0..60 {
        at(&mut module, 200 + (second - 10).max(0) * 10, 1000);
    }
    assert_eq!((read(&module, 156), read(&module, 100)), (3, 9));
    // R = 0.01 per ms, L = 12 s, when a sample is warmer for the first time: Kp = 1.2 / 120 × 100 = 100 %, Ti = 24 s,
    // Td = 6 s.
    let [kp, ti, td] = [110, 111, 112].map(|n| read(&module, n));
    assert!((95..=110).contains(&kp), "{kp}");
    assert!((220..=245).contains(&ti), "{ti}");
    assert!((55..=62).contains(&td), "{td}");
    // A value that goes the wrong way ends it.
    let mut wrong = self::module(1 | 8 | 16, 1000, &[(116, 100)]);
    at(&mut wrong, 200, 100);
    wrong.write(51, 1).unwrap();
    at(&mut wrong, 200, 1500);
    at(&mut wrong, 140, 2000);
    assert_eq!((read(&wrong, 156), read(&wrong, 157)), (0, 51));
}

#[test]
fn control_waits_for_the_first_sample() {
    let mut module = module(1 | 8 | 16, 1000, &[(116, 100)]);
    module.write(51, 1).unwrap();
    at(&mut module, 200, 30);
    assert_eq!(read(&module, 156), 0);
    at(&mut module, 200, 5000);
    // A start at 0 would have mistaken the first sample for a jump to 20 °C.
    assert_eq!((read(&module, 156), read(&module, 110)), (2, 100));
}

#[test]
fn thermocouples_have_a_duty_in_hundredths_of_a_percent_and_a_dead_time() {
    let mut module = Module::new(Kind::find("H2U-4TC-XP").unwrap());
    for (number, value) in [(33, 1000), (39, 1000), (56, 8), (64, 0), (68, 1000)] {
        module.write(number, value).unwrap();
    }
    let signal = Signal {
        quantity: Quantity::Celsius,
        millionths: 50_000_000,
    };
    module.connect(1, signal).unwrap();
    module.pass(8_000_000);
    module.write(52, 1).unwrap();
    let mut on = 0;
    for _ in 0..1000 {
        module.pass(1000);
        on += i32::from(module.read(76).unwrap());
    }
    // 10 × 50 °C = 5000: half of the sampling time.
    assert_eq!((module.read(72), on), (Some(5000), 500));
    // The output stops when the temperature is 2 °C too high.
    module.write(96, 20).unwrap();
    let hot = Signal {
        quantity: Quantity::Celsius,
        millionths: 103_000_000,
    };
    module.connect(1, hot).unwrap();
    module.pass(8_000_000);
    assert_eq!(module.read(72), Some(0));
}
