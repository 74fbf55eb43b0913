//! Questions as other tools read them: the files are evaluated along runs of the interpreter.

use super::run::{Goal, Rig};
use rungc_ir::Module;
use rungc_sim::property::Condition;
use rungc_verify::aig::Node;
use rungc_verify::model::{Digit, Input, Key};
use rungc_verify::steered::{Run, State, Subject, value_of};
use rungc_verify::system::System;
use rungc_verify::{aiger, btor2};
use std::collections::BTreeMap;
use std::process::Command;

/// Index of a value, and whether it is inverted.
type Operand = (usize, bool);

/// Logic of a file, one bit a line or gate.
struct Logic {
    /// Operands of each gate in order: index of the result, and of the operands with inversion.
    gates: Vec<(usize, Operand, Operand)>,
    inputs: Vec<usize>,
    /// State, its next value, and its initial value; `None`: any.
    states: Vec<(usize, Operand, Option<bool>)>,
    constraints: Vec<Operand>,
    bad: Operand,
    values: Vec<bool>,
}

impl Logic {
    fn of(&self, (at, inverted): Operand) -> bool {
        self.values[at] != inverted
    }

    /// Executes a scan: whether it is bad and keeps all constraints.
    fn scan(&mut self, inputs: &[bool]) -> (bool, bool) {
        for (&at, &on) in self.inputs.iter().zip(inputs) {
            self.values[at] = on;
        }
        for &(at, a, b) in &self.gates {
            self.values[at] = self.of(a) && self.of(b);
        }
        let kept = self.constraints.iter().all(|&holds| self.of(holds));
        let bad = self.of(self.bad);
        let next: Vec<bool> = self
            .states
            .iter()
            .map(|(_, next, _)| self.of(*next))
            .collect();
        for ((at, ..), on) in self.states.iter().zip(next) {
            self.values[*at] = on;
        }
        (bad, kept)
    }

    fn begin(&mut self, states: &[bool]) {
        for (n, &(at, _, init)) in self.states.iter().enumerate() {
            self.values[at] = init.unwrap_or_else(|| states.get(n).copied().unwrap_or(false));
        }
    }
}

/// Reads a file in the binary format of AIGER; `None` if it is none.
fn read_aiger(bytes: &[u8]) -> Option<Logic> {
    let mut rest = bytes;
    let mut line = || {
        let end = rest.iter().position(|&byte| byte == b'\n')?;
        let text = std::str::from_utf8(&rest[..end]).ok()?;
        rest = &rest[end + 1..];
        Some(text.split(' ').map(str::to_string).collect::<Vec<_>>())
    };
    let header = line()?;
    let count = |n: usize| header.get(n)?.parse::<usize>().ok();
    let (most, inputs, latches, ands) = (count(1)?, count(2)?, count(3)?, count(5)?);
    let lit = |code: usize| (code / 2, code % 2 == 1);
    let mut states = Vec::new();
    for n in 0..latches {
        let words = line()?;
        let at = inputs + n + 1;
        let init = words.get(1).map_or(Some(0), |word| word.parse().ok())?;
        let init = match init {
            0 => Some(false),
            1 => Some(true),
            own if own == 2 * at => None,
            _ => return None,
        };
        states.push((at, lit(words.first()?.parse().ok()?), init));
    }
    let bad = lit(line()?.first()?.parse().ok()?);
    let mut bytes = rest.iter();
    let mut delta = || {
        let (mut value, mut shift) = (0usize, 0);
        loop {
            let byte = *bytes.next()?;
            value |= usize::from(byte & 0x7f) << shift;
            shift += 7;
            if byte & 0x80 == 0 {
                return Some(value);
            }
        }
    };
    let mut gates = Vec::new();
    for n in 0..ands {
        let at = inputs + latches + n + 1;
        let high = (2 * at).checked_sub(delta()?)?;
        let low = high.checked_sub(delta()?)?;
        gates.push((at, lit(high), lit(low)));
    }
    Some(Logic {
        gates,
        inputs: (1..=inputs).collect(),
        states,
        constraints: Vec::new(),
        bad,
        values: vec![false; most + 1],
    })
}

/// Reads a file in the format BTOR2 with one sort of one bit; `None` if it is none.
fn read_btor2(text: &str) -> Option<Logic> {
    let mut logic = Logic {
        gates: Vec::new(),
        inputs: Vec::new(),
        states: Vec::new(),
        constraints: Vec::new(),
        bad: (0, false),
        values: vec![false],
    };
    let mut index: BTreeMap<usize, usize> = BTreeMap::new();
    for line in text.lines().filter(|line| !line.starts_with(';')) {
        let words: Vec<&str> = line.split(' ').collect();
        let id: usize = words.first()?.parse().ok()?;
        let number = |n: usize| words.get(n)?.parse::<usize>().ok();
        logic.values.resize(id + 1, false);
        match *words.get(1)? {
            "sort" | "zero" => {}
            "one" => logic.values[id] = true,
            "input" => logic.inputs.push(id),
            "state" => {
                index.insert(id, logic.states.len());
                logic.states.push((id, (id, false), None));
            }
            "init" => {
                let value = logic.values[number(4)?];
                logic.states[*index.get(&number(3)?)?].2 = Some(value);
            }
            "next" => logic.states[*index.get(&number(3)?)?].1 = (number(4)?, false),
            "and" => logic
                .gates
                .push((id, (number(3)?, false), (number(4)?, false))),
            "not" => logic
                .gates
                .push((id, (number(3)?, true), (number(3)?, true))),
            "constraint" => logic.constraints.push((number(2)?, false)),
            "bad" => logic.bad = (number(2)?, false),
            _ => return None,
        }
    }
    Some(logic)
}

/// Inputs of a system in the order of their nodes, which is that of the files.
fn inputs(system: &System) -> Vec<Option<Input>> {
    let named: BTreeMap<usize, Input> = system
        .inputs
        .iter()
        .map(|&(lit, input)| (lit.node(), input))
        .collect();
    let states: Vec<usize> = system
        .latches
        .iter()
        .map(|latch| latch.now.node())
        .collect();
    let nodes = system.aig.nodes().iter().enumerate();
    nodes
        .filter(|(node, what)| matches!(what, Node::Input(_)) && !states.contains(node))
        .map(|(node, _)| named.get(&node).copied())
        .collect()
}

/// States of a system in the order of their nodes: index of the latch.
fn states(system: &System) -> Vec<usize> {
    let mut order: Vec<usize> = (0..system.latches.len()).collect();
    order.sort_by_key(|&n| system.latches[n].now.node());
    order
}

/// Returns true if a run of the interpreter says what every input of a question is.
pub fn is_exact(system: &System) -> bool {
    system.inputs.iter().all(|(_, input)| match input {
        Input::Gap(_) | Input::Device(Key::Buffer(..), _) => false,
        Input::Device(..)
        | Input::Shown(..)
        | Input::Time(..)
        | Input::ScanTime(_)
        | Input::Restart => true,
    })
}

/// Evaluates both files of a question along a run; the number of scans, or what differs.
pub fn evaluate(
    system: &System,
    module: &Module,
    goal: Goal,
    assumed: &[Condition],
    run: &Run,
) -> Result<u64, String> {
    let aiger = read_aiger(&aiger::binary(system));
    let btor2 = read_btor2(&btor2::text(system, &[], "campaign"));
    let (Some(mut aiger), Some(mut btor2)) = (aiger, btor2) else {
        return Err("a file cannot be read".to_string());
    };
    let modules = [module];
    let mut rig = Rig::new(&modules, goal, assumed);
    rig.begin(&run.start);
    let begin: Vec<bool> = system
        .latches
        .iter()
        .map(|latch| value_of(&rig.plants[0].machine, latch.key) >> latch.bit & 1 == 1)
        .collect();
    aiger.begin(&[]);
    let open = system.latches.iter().zip(&begin);
    let open: Vec<bool> = open
        .filter(|(latch, _)| latch.init.is_none())
        .map(|(_, &on)| on)
        .collect();
    btor2.begin(
        &states(system)
            .into_iter()
            .map(|n| begin[n])
            .collect::<Vec<_>>(),
    );
    let named = inputs(system);
    let mut all_kept = true;
    for (n, step) in run.steps.iter().enumerate() {
        let values: Vec<bool> = named
            .iter()
            .map(|input| match *input {
                Some(Input::Device(key, bit) | Input::Shown(_, key, bit)) => {
                    let set = step.set.iter().find(|(of, _)| *of == key);
                    let value = set.map(|(_, value)| *value);
                    let value = value.unwrap_or_else(|| value_of(&rig.plants[0].machine, key));
                    value >> bit & 1 == 1
                }
                Some(Input::Time(digit, bit)) => {
                    let part = match digit {
                        Digit::Hundreds => step.ms / 100,
                        Digit::Tens => step.ms / 10 % 10,
                        Digit::Ones => step.ms % 10,
                    };
                    part >> bit & 1 == 1
                }
                Some(Input::ScanTime(bit)) => (step.scan_us / 100) >> bit & 1 == 1,
                Some(Input::Restart) => step.stop,
                Some(Input::Gap(_)) | None => false,
            })
            .collect();
        let (other, kept) = btor2.scan(&values);
        let (bad, _) = aiger.scan(&[values, open.clone()].concat());
        all_kept &= kept;
        let state = rig.step(step);
        let expected = state == State::Happened;
        let other = other && all_kept;
        if (bad, other) != (expected, expected) {
            return Err(format!(
                "after scan {} it is {expected} on the interpreter, {bad} in AIGER, {other} in BTOR2{}",
                n + 1,
                if all_kept {
                    ""
                } else {
                    ", a constraint is broken"
                }
            ));
        }
        if state != State::Lives {
            return Ok(n as u64 + 1);
        }
    }
    Ok(run.steps.len() as u64)
}

/// Name of the model checker in Debian.
const ABC: &str = "berkeley-abc";

/// Returns true if the other model checker is installed.
pub fn has_abc() -> bool {
    Command::new(ABC).arg("-h").output().is_ok()
}

/// Answer of another model checker: whether it can happen; `None` if it does not know in time.
pub fn asked_abc(system: &System, seconds: u32) -> Option<bool> {
    let folder = tempfile::tempdir().ok()?;
    std::fs::write(folder.path().join("q.aig"), aiger::binary(system)).ok()?;
    let output = Command::new(ABC)
        .args(["-c", &format!("read_aiger q.aig; pdr -T {seconds}")])
        .current_dir(folder.path())
        .output()
        .ok()?;
    let text = String::from_utf8_lossy(&output.stdout);
    match (
        text.contains("Property proved"),
        text.contains("was asserted in frame"),
    ) {
        (true, false) => Some(false),
        (false, true) => Some(true),
        _ => None,
    }
}
