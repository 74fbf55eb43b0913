//! Systems as text in the format BTOR2 (Niemetz, Preiner, Wolf and Biere 2018), which other model checkers read.
//!
//! The logic is bits by the time it gets here, so everything has the same sort, one bit. Bits have the names of what
//! they belong to, so that a run which another model checker finds can be read: `Y000`, `D0[3]`, `T0.value[2]`.

use crate::aig::{Lit, Node};
use crate::model::{CounterPart, Digit, Gap, Input, Key, TimerPart};
use crate::system::System;
use rustc_hash::{FxHashMap, FxHashSet};
use std::fmt::Write;

/// The system as a file with one `bad` state property: a scan that violates `asked`, which is quoted. What is not
/// modelled is an input, which a comment explains by the texts of `gaps`.
pub fn text(system: &System, gaps: &[Gap], asked: &str) -> String {
    let mut file = File::default();
    let asked = asked.split_whitespace().collect::<Vec<_>>().join(" ");
    let _ = writeln!(file.text, "; rungc: {asked}");
    let used: FxHashSet<usize> = system
        .inputs
        .iter()
        .filter_map(|(_, input)| match input {
            Input::Gap(n) => Some(*n),
            Input::Device(..)
            | Input::Shown(..)
            | Input::Time(..)
            | Input::ScanTime(_)
            | Input::Restart => None,
        })
        .collect();
    for (n, gap) in gaps.iter().enumerate().filter(|(n, _)| used.contains(n)) {
        let step = gap.step.map(|step| format!(" (step {step})"));
        let step = step.unwrap_or_default();
        let _ = writeln!(file.text, "; gap{n} is not modelled: {}{step}", gap.what);
    }
    file.line("sort bitvec 1");
    let constants = [file.line("zero 1"), file.line("one 1")];
    file.declare(system);
    file.ids.insert(Lit::FALSE, constants[0]);
    file.ids.insert(Lit::TRUE, constants[1]);
    for latch in &system.latches {
        if let Some(on) = latch.init {
            let state = file.lit(latch.now);
            file.line(&format!("init 1 {state} {}", constants[usize::from(on)]));
        }
    }
    for (node, what) in system.aig.nodes().iter().enumerate() {
        if let Node::And(a, b) = *what {
            let (a, b) = (file.lit(a), file.lit(b));
            let id = file.line(&format!("and 1 {a} {b}"));
            file.ids.insert(system.aig.literal(node), id);
        }
    }
    for latch in &system.latches {
        let (state, next) = (file.lit(latch.now), file.lit(latch.next));
        file.line(&format!("next 1 {state} {next}"));
    }
    for &holds in &system.constraints {
        let holds = file.lit(holds);
        file.line(&format!("constraint {holds}"));
    }
    let bad = file.lit(system.bad);
    file.line(&format!("bad {bad} violated"));
    file.text
}

/// A file that is being written.
#[derive(Default)]
struct File {
    text: String,
    /// The number of the last line.
    last: u32,
    /// The lines of literals.
    ids: FxHashMap<Lit, u32>,
    names: FxHashSet<String>,
}

impl File {
    /// Adds a line; its number.
    fn line(&mut self, line: &str) -> u32 {
        self.last += 1;
        let _ = writeln!(self.text, "{} {line}", self.last);
        self.last
    }

    /// Adds what the logic begins with: inputs and states.
    fn declare(&mut self, system: &System) {
        let mut named: FxHashMap<usize, (&str, String)> = FxHashMap::default();
        let inputs = system.inputs.iter();
        named.extend(inputs.map(|(lit, input)| (lit.node(), ("input", of_input(*input)))));
        let states = system.latches.iter();
        named.extend(
            states.map(|latch| (latch.now.node(), ("state", of_bit(latch.key, latch.bit)))),
        );
        for (node, what) in system.aig.nodes().iter().enumerate() {
            let Node::Input(_) = what else {
                continue;
            };
            let id = match named.remove(&node) {
                Some((kind, name)) => {
                    let name = self.unique(name);
                    self.line(&format!("{kind} 1 {name}"))
                }
                // Unnamed inputs may have any value.
                None => self.line("input 1"),
            };
            self.ids.insert(system.aig.literal(node), id);
        }
    }

    /// A name that no other bit has: what is not modelled has many bits.
    fn unique(&mut self, name: String) -> String {
        let mut unique = name.clone();
        let mut count = 1;
        while !self.names.insert(unique.clone()) {
            count += 1;
            unique = format!("{name}#{count}");
        }
        unique
    }

    /// The line of a literal. Inversions are separate lines, since not every reader knows the short form.
    fn lit(&mut self, lit: Lit) -> u32 {
        if let Some(&id) = self.ids.get(&lit) {
            return id;
        }
        // Operands come before what they are operands of, so the node has a line.
        let node = self.ids[&!lit];
        let id = self.line(&format!("not 1 {node}"));
        self.ids.insert(lit, id);
        id
    }
}

fn of_input(input: Input) -> String {
    match input {
        Input::Device(key, bit) | Input::Shown(_, key, bit) => of_bit(key, bit),
        Input::Time(digit, bit) => {
            let digit = match digit {
                Digit::Hundreds => "hundreds",
                Digit::Tens => "tens",
                Digit::Ones => "ones",
            };
            format!("elapsed.{digit}[{bit}]")
        }
        Input::ScanTime(bit) => format!("scan_time[{bit}]"),
        Input::Restart => "restart".to_string(),
        Input::Gap(n) => format!("gap{n}"),
    }
}

/// Name of a bit of memory.
fn of_bit(key: Key, bit: usize) -> String {
    use rungc_syntax::DeviceClass::{C, T};
    match key {
        Key::Bit(class, number) => class.number(number).to_string(),
        Key::Word(class, number) => format!("{}[{bit}]", class.number(number)),
        Key::Timer(number, part) => {
            let timer = T.number(number);
            match part {
                TimerPart::Done => timer.to_string(),
                TimerPart::Coil => format!("{timer}.coil"),
                TimerPart::Counted => format!("{timer}.counted"),
                TimerPart::Value => format!("{timer}.value[{bit}]"),
                TimerPart::Preset => format!("{timer}.preset[{bit}]"),
                TimerPart::Part => format!("{timer}.part[{bit}]"),
            }
        }
        Key::Counter(number, part) => {
            let counter = C.number(number);
            match part {
                CounterPart::Done => counter.to_string(),
                CounterPart::Coil => format!("{counter}.coil"),
                CounterPart::Value => format!("{counter}.value[{bit}]"),
            }
        }
        Key::Edge(n) => format!("edge{n}"),
        Key::Slot(n) => format!("slot{n}"),
        Key::Outer => "outside".to_string(),
        Key::Flag(n) => format!("flag{n}"),
        Key::Cell(n) => format!("cell{n}[{bit}]"),
        Key::Entry(table, n) => format!("table{table}.{n}[{bit}]"),
        Key::Buffer(module, address) => format!("U{module}\\G{address}[{bit}]"),
        Key::First => "first_scan".to_string(),
        Key::Running => "run".to_string(),
        Key::Now => format!("now[{bit}]"),
        Key::Minute => format!("minute[{bit}]"),
        Key::Monitor(n) => format!("property{n}[{bit}]"),
    }
}

#[cfg(test)]
mod tests {
    use super::text;
    use crate::aig::{Aig, Lit};
    use crate::model::{Gap, Input, Key};
    use crate::system::{Latch, System};
    use rungc_syntax::DeviceClass::{D, M, X};

    #[test]
    fn a_question_is_written_with_the_names_of_devices() {
        let mut aig = Aig::default();
        let (button, gap, other_gap, relay, bit) = (
            aig.input(),
            aig.input(),
            aig.input(),
            aig.input(),
            aig.input(),
        );
        let held = aig.or(button, relay);
        let either = aig.or(gap, other_gap);
        let bad = aig.and(held, !bit);
        let latch = |now, next, init, key, bit| Latch {
            now,
            next,
            init,
            key,
            bit,
        };
        let system = System {
            latches: vec![
                latch(relay, held, Some(false), Key::Bit(M, 10), 0),
                latch(bit, Lit::TRUE, None, Key::Word(D, 3), 7),
            ],
            inputs: vec![
                (button, Input::Device(Key::Bit(X, 8), 0)),
                (gap, Input::Gap(0)),
                (other_gap, Input::Gap(0)),
            ],
            constraints: vec![either],
            replay_assumptions: vec![!gap],
            first_replay_assumptions: Vec::new(),
            lags: Vec::new(),
            bad,
            aig,
        };
        let gaps = [Gap {
            step: Some(4),
            is_instruction: false,
            what: "PID".to_string(),
        }];
        insta::assert_snapshot!(text(&system, &gaps, "never\nM10"));
    }
}
