//! Moves that inputs steer: how many pulses they differ from their formula, and how far they go once an input has
//! changed. Pulses are sent edge by edge, as a board's timer sends them, and an input changes at the very pulse.

use rungc_golden::module;
use rungc_interp::Machine;
use rungc_models::{Model, ModelId};
use rungc_rt::{Class, Hal, NoHal, Plc, Program};
use std::fmt::Write;

/// A part of a move with constant acceleration.
struct Phase {
    /// Pulses.
    distance: f64,
    /// Speed at its beginning and at its end, in pulses per second.
    speeds: [f64; 2],
}

/// A move, the inputs that steer it, and its formula.
struct Steered {
    name: &'static str,
    model: ModelId,
    program: &'static str,
    source: &'static str,
    /// Inputs that change when this many pulses have been sent.
    inputs: &'static [(u32, u32, bool)],
    /// For how many milliseconds it is driven, if it does not end by itself.
    driven_ms: Option<u32>,
    acceleration: f64,
    phases: &'static [Phase],
}

/// From one speed to another with an acceleration of a million pulses per second².
const fn ramp(from: f64, to: f64) -> Phase {
    let distance = (to * to - from * from) / (2.0 * ACCELERATION);
    Phase {
        distance: if distance < 0.0 { -distance } else { distance },
        speeds: [from, to],
    }
}

/// Steadily.
const fn level(distance: f64, speed: f64) -> Phase {
    Phase {
        distance,
        speeds: [speed, speed],
    }
}

/// From 0 to 100 kHz in 100 ms, as FX3U and H2U have it at power-on.
const ACCELERATION: f64 = 1_000_000.0;

/// An axis of HM on Y000 with a direction, speeds in pulses per 10 ms, and the inputs X for its events.
macro_rules! hm_axis {
    ($program:literal) => {
        concat!(
            "LD M8002\nAXPO K0 K0 K1\nAXPU K0 K10 K0 K0\nAXSP K0 K500 K0\nAXAS K0 K100\n",
            $program,
            "END\n"
        )
    };
}

const MOVES: [Steered; 8] = [
    Steered {
        name: "PLSV",
        model: ModelId::Fx3u,
        program: "LD M0\nDPLSV K20000 Y0 Y4\nEND\n",
        source: "FX3 positioning manual §9",
        inputs: &[],
        driven_ms: Some(501),
        acceleration: f64::INFINITY,
        phases: &[level(10_000.0, 20_000.0)],
    },
    Steered {
        name: "ZRN",
        model: ModelId::H2u,
        program: "LD M0\nDZRN K50000 K2000 X5 Y0\nEND\n",
        source: "h1u-h2u-programming §4.3.11",
        inputs: &[(10_000, 5, true), (12_000, 5, false)],
        driven_ms: None,
        acceleration: ACCELERATION,
        phases: &[
            ramp(0.0, 50_000.0),
            level(10_000.0 - 1250.0, 50_000.0),
            ramp(50_000.0, 2000.0),
            level(2000.0 - 1248.0, 2000.0),
        ],
    },
    Steered {
        name: "DSZR",
        model: ModelId::Fx3u,
        program: "LD M0\nDSZR X5 X6 Y0 Y4\nEND\n",
        source: "FX3 positioning manual §6",
        inputs: &[(10_000, 5, true), (12_000, 5, false), (12_200, 6, true)],
        driven_ms: None,
        acceleration: ACCELERATION,
        phases: &[
            ramp(0.0, 50_000.0),
            level(10_000.0 - 1250.0, 50_000.0),
            ramp(50_000.0, 1000.0),
            level(2200.0 - 1249.5, 1000.0),
        ],
    },
    Steered {
        name: "DVIT",
        model: ModelId::Fx3u,
        program: "LD M0\nDDVIT K5000 K50000 Y0 Y4\nEND\n",
        source: "FX3 positioning manual §8",
        inputs: &[(10_000, 0, true)],
        driven_ms: None,
        acceleration: ACCELERATION,
        phases: &[
            ramp(0.0, 50_000.0),
            level(15_000.0 - 2500.0, 50_000.0),
            ramp(50_000.0, 0.0),
        ],
    },
    Steered {
        name: "DPLSV",
        model: ModelId::Hm,
        program: hm_axis!("LD M0\nDPLSV K200 K0\n"),
        source: "hm-motion-controller §8.3.12",
        inputs: &[],
        driven_ms: Some(501),
        acceleration: ACCELERATION,
        phases: &[
            ramp(0.0, 20_000.0),
            level(9600.0, 20_000.0),
            ramp(20_000.0, 0.0),
        ],
    },
    Steered {
        name: "DDVIT",
        model: ModelId::Hm,
        program: hm_axis!("MOV K2 D324\nMOV H2200 D314\nLD M0\nDDVIT K5000 K200 K0\n"),
        source: "hm-motion-controller §8.3.11",
        inputs: &[(10_000, 1, true)],
        driven_ms: None,
        acceleration: ACCELERATION,
        phases: &[
            ramp(0.0, 20_000.0),
            level(15_000.0 - 400.0, 20_000.0),
            ramp(20_000.0, 0.0),
        ],
    },
    Steered {
        name: "HOME",
        model: ModelId::Hm,
        program: hm_axis!(
            "AXEI K0 K32 K16 K0 K0\nAXOSP K0 K200 K20\nAXOX K0 H2003 K1 K0\nLD M0\nHOME K0\n"
        ),
        source: "hm-motion-controller §8.3.1",
        inputs: &[(10_000, 5, true), (12_000, 5, false), (12_200, 4, true)],
        driven_ms: None,
        acceleration: ACCELERATION,
        phases: &[
            ramp(0.0, 20_000.0),
            level(10_000.0 - 200.0, 20_000.0),
            ramp(20_000.0, 2000.0),
            level(2200.0 - 198.0, 2000.0),
        ],
    },
    Steered {
        name: "JOG",
        model: ModelId::Hm,
        program: hm_axis!("LD M0\nOUT M8099\nJOG K0 K10000 K200 K8 K16\n"),
        source: "hm-motion-controller §8.3.2",
        inputs: &[],
        driven_ms: None,
        acceleration: f64::INFINITY,
        phases: &[level(10_000.0, 20_000.0)],
    },
];

/// Hardware that counts the pulses at Y000, and knows its level.
struct Pins(u32, bool);

impl Hal for Pins {
    fn set_output(&mut self, number: u16, value: bool) {
        if number == 0 {
            self.0 += u32::from(value && !self.1);
            self.1 = value;
        }
    }
}

impl Steered {
    /// Position at a time, in seconds, and the duration.
    fn position(&self, at: f64) -> (f64, f64) {
        let (mut begin, mut place) = (0.0, 0.0);
        let mut found = None;
        for Phase { distance, speeds } in self.phases {
            let [from, to] = *speeds;
            let time = 2.0 * distance / (from + to);
            if found.is_none() && at < begin + time {
                let passed = at - begin;
                found = Some(place + from * passed + (to - from) / time * passed * passed / 2.0);
            }
            begin += time;
            place += distance;
        }
        (found.unwrap_or(place), begin)
    }

    /// Runs it; the greatest difference in pulses, the pulses sent, and when the last one began, in milliseconds.
    fn run(&self) -> (f64, f64, f64) {
        let module = module(self.program, self.model);
        let mut machine = Machine::new(&module);
        machine.scan(&mut NoHal, 0, 1000);
        let mut inputs = self.inputs.iter().peekable();
        let mut pins = Pins(0, false);
        let (mut greatest, mut end_us) = (0f64, 0);
        let (_, whole) = self.position(0.0);
        for ms in 1..=(1000.0 * whole) as u32 + 50 {
            machine.tick(&mut pins, ms);
            let driven = self.driven_ms.is_none_or(|most| ms < most);
            machine.set_bit(Class::M, 0, driven).expect("it exists");
            machine.scan(&mut pins, ms, 1000);
            let mut now_us = 1000 * ms;
            while let Some(wait) = machine.pulse_timer(&mut pins, now_us) {
                now_us += wait;
                if now_us >= 1000 * (ms + 1) {
                    break;
                }
                let before = pins.0;
                machine.pulse_timer(&mut pins, now_us);
                if pins.0 > before {
                    end_us = now_us;
                    // The first scan with the drive is that of the first millisecond.
                    let (expected, _) = self.position(f64::from(now_us - 1000) / 1e6);
                    greatest = greatest.max((f64::from(pins.0) - expected).abs());
                }
                while let Some((_, input, on)) = inputs.next_if(|(at, ..)| pins.0 >= *at) {
                    machine.set_bit(Class::X, *input, *on).expect("it exists");
                    machine.input_edge(&mut pins, *input, *on);
                    machine.take_interrupts(&mut pins);
                }
            }
        }
        // PLSV may be stopped while a pulse is under way, which is then at the pin and is not counted.
        let counted = machine.pulses_sent(0).unsigned_abs();
        assert!(counted.abs_diff(pins.0) <= 1, "{}: {counted}", self.name);
        (
            greatest,
            f64::from(pins.0),
            f64::from(end_us - 1000) / 1000.0,
        )
    }
}

/// The rows of the table of moves that inputs steer.
pub fn table() -> String {
    let mut table = String::from(
        "| move | model | formula | pulses, by the formula | pulses | greatest difference in pulses | ends, by the \
         formula | ends, in ms |\n|---|---|---|--:|--:|--:|--:|--:|\n",
    );
    for order in &MOVES {
        let (greatest, sent, end_ms) = order.run();
        let (distance, whole) = order.position(f64::INFINITY);
        let model = Model::get(order.model).name;
        let _ = writeln!(
            table,
            "| {} | {model} | {} | {distance} | {sent} | {greatest:.1} | {:.1} | {end_ms:.1} |",
            order.name,
            order.source,
            1000.0 * whole
        );
        let first = (2.0 / order.acceleration).sqrt();
        let peak = order.phases[0].speeds[1];
        // A pulse is under way when the input changes: DVIT counts it among those that follow. What a drive stops in
        // time lacks the way by which its ramp is late.
        let late = order.driven_ms.map_or(0.0, |_| peak * first / 2.0);
        let missing = (sent - distance).abs();
        assert!(missing <= 1.0 + late, "{}: {sent}", order.name);
        let most = peak * first + 1.5;
        assert!(
            greatest <= most,
            "{}: {greatest} of {most} pulses",
            order.name
        );
    }
    table
}
