//! Machines around a PLC: how they move, and what is wrong in their files.

use rungc_models::{Model, ModelId};
use rungc_sim::Channel;
use rungc_sim::plant::{self, Look, Plant, Terminals};
use rungc_sim::wire::Change;
use std::collections::BTreeMap;

/// A PLC that does what the test says.
#[derive(Default)]
struct Plc {
    outputs: BTreeMap<u32, bool>,
    pulses: BTreeMap<u32, i32>,
    /// Train of Y000: pulses per millisecond, start, and number of pulses sent.
    train: (i32, u64, u32),
    changes: Vec<Change>,
    inputs: BTreeMap<u32, bool>,
    signals: BTreeMap<String, i32>,
    /// The signal at each channel of a module, in millionths.
    driven: i32,
}

impl Terminals for Plc {
    type Error = ();

    fn look(&mut self, at: &[Look]) -> Result<Vec<i32>, ()> {
        let value = |look: &Look| match look {
            Look::Output(n) => i32::from(self.outputs.get(n).copied().unwrap_or(false)),
            Look::Pulses(n) => self.pulses.get(n).copied().unwrap_or(0),
            Look::Channel(_) => self.driven,
        };
        Ok(at.iter().map(value).collect())
    }

    fn pass(
        &mut self,
        [_, until]: [u32; 2],
        most: u32,
        at: &[Look],
    ) -> Result<(u32, Vec<i32>), ()> {
        let (rate, begin, over) = self.train;
        let each_ms = u64::from(rate.unsigned_abs());
        let by_then = ((u64::from(until) - begin) * each_ms / 1000) as u32;
        let sent = (by_then - over).min(most);
        let reached = match sent == most {
            true => (begin + (u64::from(over + sent) * 1000).div_ceil(each_ms)) as u32,
            false => until,
        };
        self.train.2 += sent;
        *self.pulses.entry(0).or_default() += sent as i32 * rate.signum();
        Ok((reached, self.look(at)?))
    }

    fn change(&mut self, change: Change) -> Result<(), ()> {
        let before = self.inputs.insert(change.input, change.on);
        assert_ne!(before, Some(change.on), "{change:?}");
        assert!(
            self.changes
                .last()
                .is_none_or(|last| last.at_us <= change.at_us)
        );
        self.changes.push(change);
        Ok(())
    }

    fn connect(&mut self, channel: Channel, millionths: i32) -> Result<(), ()> {
        self.signals.insert(channel.to_string(), millionths);
        Ok(())
    }
}

struct Rig {
    plant: Plant,
    plc: Plc,
    now_ms: u64,
}

impl Rig {
    fn new(text: &str) -> Rig {
        let plant = plant::parse("machine.toml", text).unwrap().plant();
        let mut plc = Plc::default();
        plc.inputs.extend(plant.inputs());
        Rig {
            plant,
            plc,
            now_ms: 0,
        }
    }

    fn run(&mut self, ms: u64, pulses_per_ms: i32) -> Vec<(u64, u32, bool)> {
        self.plc.changes.clear();
        self.plc.train = (pulses_per_ms, 1000 * self.now_ms, 0);
        for _ in 0..ms {
            self.now_ms += 1;
            self.plant.step(self.now_ms, &[], &mut self.plc).unwrap();
        }
        let seen = |c: &Change| (c.at_us, c.input, c.on);
        self.plc.changes.iter().map(seen).collect()
    }

    fn position(&self, axis: &str) -> f64 {
        self.plant.axis(axis).unwrap().position()
    }

    fn input(&self, number: u32) -> bool {
        self.plc.inputs[&number]
    }
}

#[test]
fn an_axis_passes_its_switches_at_their_places() {
    let mut rig = Rig::new(
        r#"
        normally_closed = ["X002"]
        [[axis]]
        output = "Y000"
        start = 100
        travel = [-1000, 5000]
        home = "X001"
        home_at = [-200, 25]
        reverse_limit = "X002"
        reverse_limit_at = -300
        "#,
    );
    assert!(
        !rig.input(1) && rig.input(2),
        "X002 is closed until it is pressed"
    );
    // Ten pulses a millisecond: 25 is reached after seven and a half of them, -201 after 30.1, -300 after 40.
    let seen = rig.run(41, -10);
    assert_eq!(
        seen,
        [(7500, 1, true), (30_100, 1, false), (40_000, 2, false)]
    );
    assert_eq!(rig.position("Y000"), -310.0);
    assert_eq!(rig.plant.collision(), None);
    rig.run(69, -10);
    assert_eq!(rig.position("Y000"), -1000.0);
    assert_eq!(rig.plant.collision(), None);
    rig.run(1, -10);
    let collision = rig.plant.collision().unwrap().to_string();
    assert_eq!(
        collision,
        "at 111 ms: the axis Y000 hits its end stop at -1000 pulses"
    );
}

#[test]
fn a_process_settles_and_sensors_measure() {
    let mut rig = Rig::new(
        r#"
        [[process]]
        name = "oven"
        rest = 20
        full = 220
        drive = "Y001"
        time_constant_s = 10
        dead_time_s = 1
        sensor = [{ channel = "0:CH1.mA", range = [0, 400], signal = [4, 20] }, { channel = "0:CH2.C" }]
        [[axis]]
        output = "Y000"
        sensor = [{ channel = "1:CH1.V", range = [0, 1000], signal = [0, 10] }]
        "#,
    );
    rig.plant.measure(&mut rig.plc).unwrap();
    let at = |rig: &Rig, channel: &str| f64::from(rig.plc.signals[channel]) / 1e6;
    assert_eq!(at(&rig, "0:CH1.mA"), 4.8);
    rig.plc.outputs.insert(1, true);
    rig.run(1000, 0);
    assert_eq!(at(&rig, "0:CH2.C"), 20.0);
    // After one time constant, 63.2 % of the way.
    rig.run(10_000, 0);
    assert!((at(&rig, "0:CH2.C") - (20.0 + 200.0 * 0.632_12)).abs() < 0.01);
    assert!(rig.plant.processes()[0].is_at(146.4));
    rig.plc.outputs.insert(1, false);
    rig.run(60_000, 1);
    assert!(at(&rig, "0:CH2.C") < 21.0);
    rig.plc.pulses.insert(0, 500);
    rig.run(1, 0);
    assert_eq!(at(&rig, "1:CH1.V"), 5.0);
}

#[test]
fn a_channel_drives_a_process() {
    let mut rig = Rig::new(
        r#"
        [[process]]
        name = "tank"
        full = 100
        drive = "2:CH1.mA"
        drive_signal = [4, 20]
        time_constant_s = 0.1
        sensor = [{ channel = "0:CH1.V", range = [0, 100], signal = [0, 10] }]
        "#,
    );
    rig.plc.driven = 12_000_000;
    rig.run(2000, 0);
    assert_eq!(rig.plc.signals["0:CH1.V"], 5_000_000);
    rig.plc.driven = 0;
    rig.run(2000, 0);
    assert_eq!(rig.plc.signals["0:CH1.V"], 0);
}

#[test]
fn a_direction_output_turns_pulses_round() {
    let mut rig = Rig::new(
        r#"
        [[axis]]
        name = "table"
        output = "Y000"
        direction = "Y004"
        pulses_per_unit = 100
        unit = "mm"
        switch = [{ input = "X010", at = [1, 1.5], every = 10 }]
        "#,
    );
    rig.plc.outputs.insert(4, true);
    let seen = rig.run(5, 250);
    assert_eq!(rig.position("table"), 12.5);
    let times: Vec<_> = seen.iter().map(|&(at, ..)| at).collect();
    assert_eq!(times, [400, 600, 4400, 4600]);
    rig.plc.outputs.insert(4, false);
    rig.run(5, 250);
    assert_eq!(rig.position("table"), 0.0);
    // Pulses are counted from 0 when the PLC is switched on again; the table stays.
    rig.plant.power_cycle();
    rig.plc.pulses.clear();
    rig.run(1, 250);
    assert_eq!(rig.position("table"), -2.5);
}

/// Counts edges of an encoder as a fourfold counter does.
fn count(seen: &[(u64, u32, bool)], mut lines: [bool; 2]) -> i32 {
    let quarter = |[a, b]: [bool; 2]| i32::from(a != b) + 2 * i32::from(b);
    let mut count = 0;
    for &(_, input, on) in seen {
        let before = quarter(lines);
        lines[input as usize] = on;
        match (quarter(lines) - before).rem_euclid(4) {
            1 => count += 1,
            3 => count -= 1,
            _ => panic!("a step was lost at {seen:?}"),
        }
    }
    count
}

#[test]
fn an_encoder_counts_what_the_axis_goes() {
    let mut rig = Rig::new(
        r#"
        [[axis]]
        output = "Y000"
        encoder = { a = "X000", b = "X001", cycles_per_unit = 0.5 }
        "#,
    );
    let there = rig.run(1000, 100);
    assert_eq!(count(&there, [false, false]), 200_000);
    let lines = [rig.input(0), rig.input(1)];
    let back = rig.run(900, -123);
    assert_eq!(count(&back, lines), -221_400);
}

#[test]
fn a_motor_moves_while_it_is_driven_one_way() {
    let mut rig = Rig::new(
        r#"
        [[axis]]
        name = "gate"
        unit = "mm"
        forward = "Y000"
        reverse = "Y001"
        speed = 500
        travel = [0, 1000]
        forward_limit = "X000"
        reverse_limit = "X001"
        "#,
    );
    assert!(rig.input(1));
    rig.plc.outputs.insert(0, true);
    assert_eq!(rig.run(1980, 0), [(20_000, 1, false), (1_980_000, 0, true)]);
    rig.plc.outputs.insert(1, true);
    assert_eq!(rig.run(100, 0), []);
    assert_eq!(rig.position("gate"), 990.0);
}

#[test]
fn cylinders_and_delays_answer_after_their_times() {
    let mut rig = Rig::new(
        r#"
        [[cylinder]]
        extend = "Y000"
        extended = "X000"
        retracted = "X001"
        time_ms = 30
        retract_ms = 20

        [[cylinder]]
        extend = "Y001"
        retract = "Y002"
        extended = "X002"
        time_ms = 10
        start = "extended"

        [[delay]]
        output = "Y000"
        input = "X003"
        on_ms = 5
        "#,
    );
    assert!(!rig.input(0) && rig.input(1) && rig.input(2) && !rig.input(3));
    rig.plc.outputs.insert(0, true);
    let seen = rig.run(40, 0);
    assert_eq!(seen, [(0, 1, false), (5000, 3, true), (30_000, 0, true)]);
    rig.plc.outputs.insert(0, false);
    let seen = rig.run(40, 0);
    assert_eq!(
        seen,
        [(40_000, 0, false), (41_000, 3, false), (60_000, 1, true)]
    );
    rig.plc.outputs.insert(2, true);
    assert_eq!(rig.run(20, 0).len(), 1);
    rig.plc.outputs.insert(2, false);
    assert_eq!(rig.run(20, 0), [], "it stays where it was driven to");
    // Too short for the delay.
    rig.plc.outputs.insert(0, true);
    rig.run(4, 0);
    rig.plc.outputs.insert(0, false);
    assert!(rig.run(9, 0).iter().all(|&(_, input, _)| input != 3));
}

fn problems(text: &str) -> String {
    plant::parse("machine.toml", text).unwrap_err().to_string()
}

#[test]
fn mistakes_are_reported_with_their_places() {
    let text = r#"
normally_closed = ["X077"]
[[axis]]
output = "Y000"
direction_on = "reverse"
speed = 5
start = 9
travel = [0, 5]
home = "Y005"
forward_limit_at = 1
zero_phase = "X004"
encoder = { a = "X004", b = "X001", cycles_per_unit = 20 }
[[axis]]
output = "Y000"
home = "X002"
reverse_limit = "X003"
switch = [{ input = "X010", at = [5, 1] }, { input = "X011", at = [0, 5], every = 2 }]
[[axis]]
name = "nothing"
[[axis]]
forward = "Y4"
[[axis]]
forward = "D4"
speed = 1
pulses_per_unit = nan
[[cylinder]]
extend = "Y009"
time_ms = 0
[[delay]]
output = "Y001"
input = "X001"
"#;
    insta::assert_snapshot!(problems(text));
    for (name, text) in [
        ("empty", ""),
        (
            "unknown_key",
            "[[axis]]\noutput = \"Y000\"\nhomee = \"X000\"\n",
        ),
        (
            "process",
            "[[process]]\nname = \"a\"\ndrive = \"0:CH1.V\"\nfull = 0\ntime_constant_s = 0\n[[process]]\nname = \"a\"\nfull = 1\n\
             drive = \"D0\"\ntime_constant_s = 1\ndead_time_s = 999\nsensor = [{ channel = \"0:CH1.V\" }, { channel = \"0:CH1.C\" }, \
             { channel = \"D0\" }, { channel = \"0:1\" }]\n",
        ),
        ("unknown_part", "[[motor]]\noutput = \"Y000\"\n"),
        ("no_number", "[[axis]]\noutput = \"Y000\"\nspeed = \"5\"\n"),
        ("no_list", "[[axis]]\noutput = \"Y000\"\ntravel = 5\n"),
        (
            "long_list",
            "[[axis]]\noutput = \"Y000\"\ntravel = [0, 5, 6]\n",
        ),
        ("single_brackets", "[axis]\noutput = \"Y000\"\n"),
        (
            "direction",
            "[[axis]]\noutput = \"Y000\"\ndirection = \"Y0\"\n",
        ),
        ("wrong_type", "[[axis]]\noutput = 0\n"),
        ("no_toml", "[[axis]\n"),
    ] {
        insta::assert_snapshot!(format!("machine_{name}"), problems(text));
    }
}

#[test]
fn terminals_are_held_to_the_model() {
    let text = "[[delay]]\noutput = \"Y000\"\ninput = \"X777\"\non_ms = 5\n";
    let described = plant::parse("machine.toml", text).unwrap();
    let error = described.check(Model::get(ModelId::Fx3u)).unwrap_err();
    assert_eq!(
        error.to_string(),
        "machine.toml:3:9: `X777` does not exist on Mitsubishi FX3U"
    );
}
