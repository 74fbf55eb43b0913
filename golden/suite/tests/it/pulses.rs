//! Pulse outputs: random moves, changes and stops end with exactly the pulses that were requested, and no faster than
//! their ramps allow.

use rungc_golden::module;
use rungc_golden::rng::Rng;
use rungc_interp::Machine;
use rungc_ir::Module;
use rungc_models::ModelId;
use rungc_rt::{Class, NoHal, Plc, Program};

/// A machine and its time.
struct Bench<'m> {
    machine: Machine<'m>,
    now_ms: u32,
}

impl Bench<'_> {
    fn new(module: &Module) -> Bench<'_> {
        Bench {
            machine: Machine::new(module),
            now_ms: 0,
        }
    }

    /// A scan, and this many milliseconds with ticks.
    fn run(&mut self, ms: u32) {
        self.machine.scan(&mut NoHal, self.now_ms, 1000 * ms);
        for _ in 0..ms {
            self.now_ms += 1;
            self.machine.tick(&mut NoHal, self.now_ms);
        }
    }

    fn set(&mut self, relay: u32, on: bool) {
        self.machine
            .set_bit(Class::M, relay, on)
            .expect("it exists");
    }

    fn set_long(&mut self, register: u32, value: i32) {
        for (n, word) in (register..).zip(rungc_rt::word::words(value)) {
            self.machine.set_word(Class::D, n, word).expect("it exists");
        }
    }

    fn long(&self, register: u32) -> i32 {
        let [low, high] = [0, 1].map(|n| {
            self.machine
                .word(Class::D, register + n)
                .expect("it exists")
        });
        rungc_rt::word::pair(low, high)
    }

    fn hz(&mut self) -> f64 {
        f64::from(self.machine.pulse_millihertz(0)) / 1000.0
    }
}

/// A random speed, more often a small one.
fn speed(rng: &mut Rng) -> i32 {
    let most = [500, 5000, 100_000][rng.below(3) as usize];
    10 + rng.below(most - 9) as i32
}

#[test]
fn moves_end_where_they_should_and_keep_to_their_ramps() {
    let module = module(
        "LD M0\nDDRVI D0 D2 Y0 Y4\nLD M8029\nOUT M1\nEND\n",
        ModelId::H2u,
    );
    for seed in 0..150 {
        let mut rng = Rng::new(seed);
        let mut bench = Bench::new(&module);
        let (highest, ramp_ms) = (speed(&mut rng).max(100), 50 + rng.below(3000) as i32);
        let wanted = speed(&mut rng);
        // Five seconds, if it gets so fast.
        let distance = rng.below(5 * wanted.min(highest) as u32 + 1) as i32;
        let distance = if rng.percent(50) { distance } else { -distance };
        bench.set_long(8146, highest);
        bench
            .machine
            .set_word(Class::D, 8148, ramp_ms as i16)
            .expect("it exists");
        bench
            .machine
            .set_word(Class::D, 8145, rng.below(1000) as i16)
            .expect("it exists");
        bench.set_long(0, distance);
        bench.set_long(2, wanted);
        bench.set(0, true);
        // Twice the acceleration: what a pulse may add to the square of the speed.
        let slope = 2.0 * f64::from(highest) * 1000.0 / f64::from(ramp_ms);
        let (mut before, mut sent) = (0.0, 0);
        for _ in 0..400_000 {
            bench.run(1);
            let (hz, now) = (bench.hz(), bench.machine.pulses_sent(0));
            let pulses = f64::from((now - sent).abs()) + 1.0;
            let change = (hz * hz - before * before).abs();
            assert!(
                before == 0.0 || hz == 0.0 || change <= slope * pulses * 1.001 + 1.0,
                "seed {seed}: from {before} to {hz} Hz in {pulses} pulses"
            );
            assert!(hz <= f64::from(highest), "seed {seed}: {hz} Hz");
            (before, sent) = (hz, now);
            if bench.machine.bit(Class::M, 1) == Some(true) {
                break;
            }
        }
        assert_eq!(bench.long(8140), distance, "seed {seed}");
        assert_eq!(bench.machine.pulses_sent(0), distance, "seed {seed}");
    }
}

#[test]
fn a_move_that_is_stopped_again_and_again_arrives() {
    let module = module(
        "LD M0\nDDRVA D0 D2 Y0 Y4\nLD M8029\nOUT M1\nLD M2\nOUT M8145\nEND\n",
        ModelId::H2u,
    );
    for seed in 0..40 {
        let mut rng = Rng::new(seed);
        let mut bench = Bench::new(&module);
        let target = rng.below(20_000) as i32 - 10_000;
        bench.set_long(0, target);
        bench.set_long(2, 1000 + rng.below(20_000) as i32);
        for _ in 0..2000 {
            bench.set(0, rng.percent(90));
            bench.set(2, rng.percent(2));
            bench.run(1 + rng.below(40));
            assert_eq!(
                bench.long(8140),
                bench.machine.pulses_sent(0),
                "seed {seed}"
            );
        }
        bench.set(2, false);
        for on in [false, true] {
            bench.set(0, on);
            (0..200).for_each(|_| bench.run(100));
        }
        assert_eq!(bench.long(8140), target, "seed {seed}");
        assert_eq!(bench.machine.bit(Class::M, 1), Some(true));
    }
}

#[test]
fn changes_of_speed_and_number_in_flight_keep_the_number() {
    let module = module(
        "LD M8000\nOUT M8135\nLD M0\nDPLSY D0 D2 Y0\nLD M8029\nOUT M1\nEND\n",
        ModelId::H2u,
    );
    for seed in 0..80 {
        let mut rng = Rng::new(seed);
        let mut bench = Bench::new(&module);
        let mut number = 1 + rng.below(5000) as i32;
        bench.set_long(0, speed(&mut rng));
        bench.set_long(2, number);
        bench.set(0, true);
        for _ in 0..200 {
            if rng.percent(20) {
                bench.set_long(0, speed(&mut rng));
            }
            let sent = bench.machine.pulses_sent(0);
            let running = sent < number;
            // At most this many are sent before the instruction sees the change.
            if running && rng.percent(10) {
                number = sent + 2 + rng.below(3000) as i32;
                bench.set_long(2, number);
            }
            bench.run(1);
        }
        bench.set_long(0, 100_000);
        (0..100).for_each(|_| bench.run(100));
        assert_eq!(bench.long(8140), number, "seed {seed}");
        assert_eq!(bench.machine.bit(Class::M, 1), Some(true), "seed {seed}");
    }
}

#[test]
fn an_interrupt_input_is_followed_by_exactly_its_pulses() {
    let module = module(
        "LD M0\nDDVIT D0 D2 Y0 Y4\nLD M8029\nOUT M1\nEND\n",
        ModelId::Fx3u,
    );
    for seed in 0..100 {
        let mut rng = Rng::new(seed);
        let mut bench = Bench::new(&module);
        let (highest, wanted) = (speed(&mut rng).max(100), speed(&mut rng));
        // Three seconds, or much less.
        let most = 3 * wanted.min(highest) as u32;
        let most = if rng.percent(50) { most } else { 10 };
        let distance = 1 + rng.below(most) as i32;
        let distance = if rng.percent(50) { distance } else { -distance };
        bench.set_long(0, distance);
        bench.set_long(2, wanted);
        bench.set_long(8343, highest);
        for ramp in [8348, 8349] {
            let ms = 50 + rng.below(3000) as i16;
            bench.machine.set_word(Class::D, ramp, ms).expect("a ramp");
        }
        bench.set(0, true);
        for _ in 0..=rng.below(20) {
            bench.run(1 + rng.below(200));
        }
        bench.machine.input_edge(&mut NoHal, 0, true);
        let from = bench.machine.pulses_sent(0);
        // Shorter than a scan.
        bench.machine.input_edge(&mut NoHal, 0, false);
        bench.run(1);
        for _ in 0..1000 {
            bench.run(100);
            if bench.machine.bit(Class::M, 1) == Some(true) {
                break;
            }
        }
        let sent = bench.machine.pulses_sent(0);
        assert_eq!(sent, from + distance, "seed {seed}");
        assert_eq!(bench.long(8340), sent, "seed {seed}");
    }
}

/// Its timer has sent pulses that no scan has counted when the end of the near point stops them.
#[test]
fn the_origin_is_0_however_pulses_are_driven() {
    let module = module("LD M0\nZRN K5000 K1000 X3 Y0\nEND\n", ModelId::H2u);
    for seed in 0..50 {
        let mut rng = Rng::new(seed);
        let mut machine = Machine::new(&module);
        machine.set_bit(Class::M, 0, true).expect("it exists");
        let mut now_us = 0;
        let mut edges = [100_000, 150_000]
            .map(|us| us + rng.below(50_000))
            .into_iter();
        let mut next = edges.next();
        let mut level = false;
        while now_us < 300_000 {
            if now_us % 10_000 == 0 {
                machine.scan(&mut NoHal, now_us / 1000, 0);
            }
            machine.pulse_timer(&mut NoHal, now_us);
            if next.is_some_and(|edge| edge <= now_us) {
                level = !level;
                machine.input_edge(&mut NoHal, 3, level);
                next = edges.next();
            }
            now_us += 20;
        }
        let sent = machine.pulses_sent(0);
        assert!(sent < -400, "seed {seed}: {sent}");
        let position = [8140, 8141].map(|n| machine.word(Class::D, n));
        assert_eq!(position, [Some(0), Some(0)], "seed {seed}");
    }
}
