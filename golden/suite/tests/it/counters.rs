//! High-speed counters, checked against separate models: random paths of an encoder, random tables.

use rungc_golden::module;
use rungc_golden::rng::Rng;
use rungc_interp::Machine;
use rungc_ir::Module;
use rungc_models::ModelId;
use rungc_rt::{Class, NoHal, Plc, Program};

/// Inputs, and the machine that they belong to.
struct Bench<'m> {
    machine: Machine<'m>,
    now_ms: u32,
}

impl Bench<'_> {
    fn new(module: &Module) -> Bench<'_> {
        let mut bench = Bench {
            machine: Machine::new(module),
            now_ms: 0,
        };
        bench.scan();
        bench
    }

    fn scan(&mut self) {
        self.machine.scan(&mut NoHal, self.now_ms, 10_000);
        self.now_ms += 10;
    }

    fn input(&mut self, number: u32, on: bool) {
        if self.machine.bit(Class::X, number) != Some(on) {
            self.machine.set_bit(Class::X, number, on);
            self.machine.input_edge(&mut NoHal, number, on);
        }
    }

    /// The phases of an encoder at a quarter of a cycle.
    fn turn(&mut self, [a, b]: [u32; 2], quarter: i32) {
        let part = quarter.rem_euclid(4);
        self.input(a, (1..=2).contains(&part));
        self.input(b, (2..=3).contains(&part));
    }

    fn count(&self, counter: u32) -> Option<i32> {
        self.machine.counter32(counter)
    }
}

#[test]
fn an_encoder_is_counted_to_the_edge() {
    let module = module(
        "LD M8000\nOUT M8195\nOUT C251 K1000000\nOUT C253 K1000000\nLD X010\nOUT M8197\nEND\n",
        ModelId::H2u,
    );
    for seed in 0..20 {
        let mut rng = Rng::new(seed);
        let mut bench = Bench::new(&module);
        let mut quarter = 0;
        for _ in 0..2000 {
            // It trembles around a place, or turns on.
            let likely = if rng.percent(50) { 50 } else { 80 };
            quarter += if rng.percent(likely) { 1 } else { -1 };
            bench.turn([0, 1], quarter);
            bench.turn([3, 4], quarter);
            if rng.percent(5) {
                bench.scan();
            }
            assert_eq!(bench.count(251), Some(quarter), "seed {seed}");
            // Counted once, a cycle counts where B changes while A is on.
            let cycles = (quarter + 2).div_euclid(4);
            assert_eq!(bench.count(253), Some(cycles), "seed {seed}");
        }
    }
}

#[test]
fn a_hundred_thousand_cycles_there_and_back_end_where_they_began() {
    let module = module(
        "LD M8000\nOUT M8195\nOUT C251 K1000000\nEND\n",
        ModelId::H2u,
    );
    let mut bench = Bench::new(&module);
    for quarter in (1..=400_000).chain((0..400_000).rev()) {
        bench.turn([0, 1], quarter);
        if quarter == 400_000 {
            assert_eq!(bench.count(251), Some(400_000));
        }
    }
    assert_eq!(bench.count(251), Some(0));
}

#[test]
fn rows_switch_at_their_counts_and_nowhere_else() {
    const ROWS: usize = 8;
    let module = module(
        &format!(
            "LD M8000\nOUT C235 K1000000\nLD X010\nOUT M8235\nLD M0\nDHSZ D0 K{ROWS} C235 M8130\nMOV D8130 D100\nEND\n"
        ),
        ModelId::H2u,
    );
    for seed in 0..20 {
        let mut rng = Rng::new(seed);
        let mut bench = Bench::new(&module);
        // Counts, outputs and states.
        let rows: [(i32, u32, bool); ROWS] = std::array::from_fn(|_| {
            let count = rng.below(20) as i32 - 5;
            (count, rng.below(16), rng.percent(50))
        });
        for (n, &(count, output, on)) in (0..).zip(&rows) {
            let name = output / 8 * 16 + output % 8;
            let words = [count as i16, (count >> 16) as i16, name as i16, on.into()];
            for (word, value) in (0..).zip(words) {
                bench.machine.set_word(Class::D, 4 * n + word, value);
            }
        }
        bench.machine.set_bit(Class::M, 0, true);
        bench.scan();
        let (mut count, mut row, mut outputs) = (0, 0, [false; 16]);
        for _ in 0..500 {
            if rng.percent(10) {
                let down = rng.percent(50);
                bench.input(0o10, down);
                bench.scan();
            }
            let down = bench.machine.bit(Class::M, 8235) == Some(true);
            count += if down { -1 } else { 1 };
            bench.input(0, true);
            bench.input(0, false);
            let (wanted, output, on) = rows[row];
            if count == wanted {
                outputs[output as usize] = on;
                row = (row + 1) % ROWS;
            }
            assert_eq!(bench.count(235), Some(count), "seed {seed}");
            assert_eq!(bench.machine.word(Class::D, 8130), Some(row as i16));
            let states = std::array::from_fn(|i| bench.machine.output(i as u32));
            assert_eq!(outputs, states, "seed {seed}, count {count}");
        }
    }
}
