//! Profiles of moves beside the equations of a trapezoid, as open planners publish them (grbl's `planner.c`, LinuxCNC's
//! `simple_tp.c`): how many pulses and milliseconds they differ. The table is in `docs/src/motion.md`.

mod following;
mod homing;

use rungc_golden::module;
use rungc_interp::Machine;
use rungc_models::ModelId;
use rungc_rt::{Class, NoHal, Plc, Program};
use std::fmt::Write;
use std::path::Path;

/// A move from rest to rest, in pulses and seconds.
struct Trapezoid {
    /// Speed that it begins and ends with.
    first: f64,
    /// Highest speed.
    speed: f64,
    /// Acceleration; infinite: it has its speed at once.
    acceleration: f64,
    distance: f64,
}

impl Trapezoid {
    /// Distance of a ramp from the first speed to another: (v² - v₀²) / 2a.
    fn ramp(&self, speed: f64) -> f64 {
        (speed * speed - self.first * self.first) / (2.0 * self.acceleration)
    }

    /// The highest speed that the distance allows.
    fn peak(&self) -> f64 {
        let half = self.first * self.first + self.acceleration * self.distance;
        self.speed.min(half.sqrt())
    }

    /// Duration of its ramp up, of the time at the peak, and of the whole.
    fn times(&self) -> [f64; 3] {
        let peak = self.peak();
        let ramp = (peak - self.first) / self.acceleration;
        let level = (self.distance - 2.0 * self.ramp(peak)).max(0.0) / peak;
        [ramp, level, 2.0 * ramp + level]
    }

    /// Position at a time.
    fn position(&self, at: f64) -> f64 {
        let [ramp, level, whole] = self.times();
        let peak = self.peak();
        let rising = |t: f64| match self.acceleration.is_finite() {
            true => self.first * t + self.acceleration * t * t / 2.0,
            false => 0.0,
        };
        if at >= whole {
            self.distance
        } else if at < ramp {
            rising(at)
        } else if at < ramp + level {
            self.ramp(peak) + peak * (at - ramp)
        } else {
            self.distance - rising(whole - at)
        }
    }
}

/// A move and what the manual says of it.
struct Move {
    name: &'static str,
    model: ModelId,
    program: &'static str,
    /// Devices before the first scan.
    words: &'static [(u32, i16)],
    /// Source of the formula.
    source: &'static str,
    expected: Trapezoid,
}

/// Ramps from 0 to 100 kHz in 100 ms, as H2U has them at power-on; units of 10 ms on HM.
const fn trapezoid(first: f64, speed: f64, acceleration: f64, distance: f64) -> Trapezoid {
    Trapezoid {
        first,
        speed,
        acceleration,
        distance,
    }
}

const AT_ONCE: f64 = f64::INFINITY;

const MOVES: &[Move] = &[
    Move {
        name: "PLSY",
        model: ModelId::H2u,
        program: "LD M0\nDPLSY K20000 K30000 Y0\nEND\n",
        words: &[],
        source: "h1u-h2u-programming §4.3.6",
        expected: trapezoid(0.0, 20_000.0, AT_ONCE, 30_000.0),
    },
    Move {
        name: "PLSR",
        model: ModelId::H2u,
        program: "LD M0\nDPLSR K20000 K30000 K200 Y0\nEND\n",
        words: &[],
        source: "h1u-h2u-programming §4.3.6",
        expected: trapezoid(0.0, 20_000.0, 100_000.0, 30_000.0),
    },
    Move {
        name: "DRVI",
        model: ModelId::H2u,
        program: "LD M0\nDDRVI K60000 K50000 Y0 Y4\nEND\n",
        words: &[(8148, 500)],
        source: "h1u-h2u-programming §4.3.11",
        expected: trapezoid(0.0, 50_000.0, 200_000.0, 60_000.0),
    },
    Move {
        name: "DRVI, too short for its speed",
        model: ModelId::H2u,
        program: "LD M0\nDDRVI K6000 K50000 Y0 Y4\nEND\n",
        words: &[(8148, 500)],
        source: "h1u-h2u-programming §4.3.11",
        expected: trapezoid(0.0, 50_000.0, 200_000.0, 6_000.0),
    },
    Move {
        name: "DRVA",
        model: ModelId::H2u,
        program: "LD M0\nDDRVA K60000 K50000 Y0 Y4\nEND\n",
        words: &[(8148, 1000)],
        source: "h1u-h2u-programming §4.3.11",
        expected: trapezoid(0.0, 50_000.0, 100_000.0, 60_000.0),
    },
    Move {
        name: "DRVI with a bias speed",
        model: ModelId::H2u,
        program: "LD M0\nDDRVI K60000 K50000 Y0 Y4\nEND\n",
        words: &[(8145, 5000), (8148, 1000)],
        source: "h1u-h2u-programming §4.3.11",
        expected: trapezoid(5_000.0, 50_000.0, 100_000.0, 60_000.0),
    },
    Move {
        name: "DPLSY",
        model: ModelId::Hm,
        program: "LD M0\nDPLSY K500 K30000 K0\nEND\n",
        words: &[],
        source: "hm-motion-controller §8.3.7",
        expected: trapezoid(0.0, 50_000.0, AT_ONCE, 30_000.0),
    },
    Move {
        name: "DPLSR",
        model: ModelId::Hm,
        program: "LD M0\nDPLSR K500 K30000 K200 K0\nEND\n",
        words: &[],
        source: "hm-motion-controller §8.3.8",
        expected: trapezoid(0.0, 50_000.0, 250_000.0, 30_000.0),
    },
    Move {
        name: "DDRVI",
        model: ModelId::Hm,
        program: "LD M0\nDDRVI K60000 K800 K0\nEND\n",
        words: &[],
        source: "hm-motion-controller §8.3.9",
        expected: trapezoid(0.0, 80_000.0, 1_000_000.0, 60_000.0),
    },
    Move {
        name: "DDRVA",
        model: ModelId::Hm,
        program: "LD M0\nDDRVA K60000 K800 K0\nEND\n",
        words: &[],
        source: "hm-motion-controller §8.3.10",
        expected: trapezoid(0.0, 80_000.0, 1_000_000.0, 60_000.0),
    },
    Move {
        name: "PSOUT",
        model: ModelId::Hm,
        program: "LD M0\nPSOUT K0 D1000\nEND\n",
        words: &[(1000, 20_000)],
        source: "hm-motion-controller §8.3.3",
        expected: trapezoid(0.0, 100_000.0, 1_000_000.0, 20_000.0),
    },
];

/// Deviation of a move, and its duration.
struct Measured {
    /// The greatest difference of positions at one time.
    pulses: f64,
    /// End in milliseconds, and the expected one.
    end_ms: [f64; 2],
}

fn measure(order: &Move) -> Measured {
    let module = module(order.program, order.model);
    let mut machine = Machine::new(&module);
    let set_words = |machine: &mut Machine| {
        for &(register, value) in order.words {
            machine
                .set_word(Class::D, register, value)
                .expect("it exists");
        }
    };
    set_words(&mut machine);
    machine.scan(&mut NoHal, 0, 1000);
    machine.set_bit(Class::M, 0, true).expect("it exists");
    set_words(&mut machine);
    let [_, _, whole] = order.expected.times();
    let (mut pulses, mut end_ms) = (0f64, None);
    for ms in 1..=(1000.0 * whole) as u32 + 100 {
        machine.tick(&mut NoHal, ms);
        machine.scan(&mut NoHal, ms, 1000);
        // The first scan with the drive is that of the first millisecond.
        let passed = f64::from(ms - 1) / 1000.0;
        let sent = f64::from(machine.pulses_sent(0));
        pulses = pulses.max((sent - order.expected.position(passed)).abs());
        if end_ms.is_none() && sent >= order.expected.distance {
            end_ms = Some(f64::from(ms - 1));
        }
    }
    assert_eq!(
        f64::from(machine.pulses_sent(0)),
        order.expected.distance,
        "{}",
        order.name
    );
    Measured {
        pulses,
        end_ms: [end_ms.expect("it ends"), 1000.0 * whole],
    }
}

fn table() -> String {
    let mut table = String::from(
        "| move | model | formula | pulses | greatest difference in pulses | ends, by the formula | ends, in ms |\n|---|---|---|--:|--:|--:|--:|\n",
    );
    for order in MOVES {
        let Measured { pulses, end_ms } = measure(order);
        let [is, should] = end_ms;
        let model = rungc_models::Model::get(order.model).name;
        let _ = writeln!(
            table,
            "| {} | {model} | {} | {} | {pulses:.1} | {should:.1} | {is:.0} |",
            order.name, order.source, order.expected.distance
        );
        // A pulse has the speed that it begins with, so a ramp from rest is late by a part of its first pulse. Time is
        // known to the millisecond.
        let first = (2.0 / order.expected.acceleration).sqrt();
        let most = order.expected.peak() * first / 4.0 + 1.0;
        assert!(pulses <= most, "{}: {pulses} of {most} pulses", order.name);
        let late = is - should;
        assert!(
            (-1.0..=1.0 + 1000.0 * first / 2.0).contains(&late),
            "{}: {is} ms, {should} ms",
            order.name
        );
    }
    table
}

/// The page on motion has this table.
fn is_shown(table: &str) {
    let page = Path::new(env!("RUNGC_ROOT")).join("docs/src/motion.md");
    let page = std::fs::read_to_string(page).expect("the page exists");
    assert!(
        page.contains(table),
        "docs/src/motion.md has to show\n{table}"
    );
}

#[test]
fn the_page_on_motion_shows_how_exact_moves_are() {
    is_shown(&table());
}

#[test]
fn the_page_on_motion_shows_moves_that_inputs_steer() {
    is_shown(&homing::table());
}

#[test]
fn the_page_on_motion_shows_axes_that_follow() {
    is_shown(&following::table());
}
