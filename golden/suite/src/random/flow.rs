//! Control flow of random programs: jumps, loops, zones, subroutines, interrupt routines, step ladders.

use super::Writer;
use crate::operands::each;
use rungc_models::Model;
use rungc_models::interrupts::{Advanced, Gate, Source};
use rungc_syntax::{Classes, DeviceClass};

/// The last pointers are left to what stands in a program once.
const LABELS: u32 = 56;

/// The register that counts how often a program jumps back; no other instruction names it.
const PASSES: &str = "D120";

/// A subroutine that is called and still to be written.
pub(super) struct Subroutine {
    label: u32,
    /// Number of nested calls that lead to it: 1 from the main program.
    depth: u32,
}

/// Interrupt pointers of a model with what requests and masks them: one edge of the first input, one of the next, two
/// timers, and one of each other kind that the model has.
fn pointers(model: &Model) -> Vec<(u32, Source, Gate)> {
    let find = |n: u32| {
        let found = model.interrupts.find(n)?;
        let source = found.source.filter(|_| model.has(DeviceClass::I, n))?;
        Some((n, source, found.gate))
    };
    let kind = |is_it: fn(Source) -> bool| {
        let mut found = (0..1000).filter_map(find);
        found.find(|&(_, source, _)| is_it(source))
    };
    let [first, second] = [[1, 0], [100, 101]].map(|pair| pair.into_iter().find_map(find));
    let all = [
        first,
        second,
        find(610),
        find(710),
        kind(|source| matches!(source, Source::Comparison { .. })),
        kind(|source| matches!(source, Source::Row { .. })),
        kind(|source| matches!(source, Source::PulsesEnd { .. })),
        kind(|source| matches!(source, Source::Interpolation)),
    ];
    all.into_iter().flatten().collect()
}

/// The advanced interrupts that a program uses: the first, which the system requests, and the next.
fn advanced(model: &Model) -> Vec<(u32, Advanced)> {
    let Some(all) = model.interrupts.advanced else {
        return Vec::new();
    };
    let pointers = [all.pointer, all.pointer + 1].into_iter();
    pointers
        .filter_map(|n| Some((n, model.interrupts.find_advanced(n)?)))
        .collect()
}

impl Writer<'_> {
    /// EI, and whatever else pointers need that it gives: this many of a hundred of the model's.
    pub(super) fn enable_interrupts(&mut self, percent: u32) -> Vec<u32> {
        self.line("EI");
        self.line("LD M8002");
        let model = Model::get(self.model);
        let mut all = pointers(model);
        all.retain(|_| self.rng.percent(percent));
        for (_, _, gate) in &all {
            self.line(match gate {
                Gate::Forbids(mask) => format!("RST M{}", mask.number()),
                Gate::Allows(mask) => format!("SET M{}", mask.number()),
                Gate::Open => continue,
            });
        }
        // A contact leads to something.
        self.line("SET M58");
        for &(_, source, _) in &all {
            self.request(source);
        }
        for (_, interrupt) in advanced(model) {
            for relay in [interrupt.request, interrupt.again] {
                let input = self.rng.below(8);
                self.line(format!("LDP X{input:03o}"));
                self.line(format!("SET M{}", relay.number()));
            }
        }
        all.into_iter().map(|(pointer, ..)| pointer).collect()
    }

    /// Instructions that cause an interrupt, where this is more than an input or time: a count, a row of a table of
    /// counts, the end of pulses.
    fn request(&mut self, source: Source) {
        let model = Model::get(self.model);
        // Its input interrupts nothing.
        let counter = 238;
        let lines = match source {
            Source::Comparison { pointer } => vec![
                "LD M8000".to_string(),
                format!("OUT C{counter} K4"),
                "LD M8000".to_string(),
                format!("DHSCS K2 C{counter} I{pointer:03}"),
            ],
            Source::Row { .. } => {
                let Some(table) = model.interrupts.count_rows else {
                    return;
                };
                let registers = [
                    (table.counter, counter),
                    (table.rows, 2),
                    (table.first, 100),
                ];
                let registers = registers
                    .map(|(register, value)| format!("MOV K{value} D{}", register.number()));
                let mut lines = vec!["LD M8002".to_string()];
                lines.extend(registers);
                lines.extend(["DMOV K1 D100".to_string(), "DMOV K3 D102".to_string()]);
                lines.extend([
                    "LD M8000".to_string(),
                    format!("OUT M{}", table.enable.number()),
                    "LD M8000".to_string(),
                    format!("OUT C{counter} K5"),
                ]);
                lines
            }
            Source::PulsesEnd { output } => vec![
                "LDI X003".to_string(),
                format!("PLSY K1000 K3 Y{output:03o}"),
            ],
            Source::Input { .. } | Source::Period { .. } | Source::Interpolation => return,
        };
        let has_counter = model.high_speed.counter(counter).is_some();
        if has_counter || matches!(source, Source::PulsesEnd { .. }) {
            self.lines.extend(lines);
        }
    }

    /// Each structure once, in the pulse form too.
    pub(super) fn all_structures(&mut self) {
        self.steps(0);
        for drive in ["M60", "Y000"] {
            self.master_of(drive.to_string());
        }
        for class in self.counts() {
            self.repeat_by(class);
        }
        self.web();
        for verb in ["CJ", "CJP"] {
            let label = self.label();
            self.logic(1);
            self.line(format!("{verb} P{label}"));
            self.rung();
            self.line(format!("P{label}"));
        }
        for verb in ["CALL", "CALLP"] {
            let label = self.label();
            self.subroutines.push(Subroutine { label, depth: 1 });
            self.logic(1);
            self.line(format!("{verb} P{label}"));
        }
        self.line("DI");
        self.rung();
        self.line("EI");
        for stack in ["MPS", "MRD", "MPP"] {
            if stack == "MPS" {
                self.logic(1);
            }
            self.line(stack);
            let contact = self.contact("AND");
            self.line(contact);
            self.output();
        }
        for join in ["ANB", "ORB"] {
            self.line("LD X000");
            self.line("LD M0");
            self.line(join);
            self.output();
        }
    }

    /// Writes the routines after the main program: interrupt routines, and the subroutines that are called, by these
    /// routines too.
    pub(super) fn routines(&mut self, interrupts: Option<Vec<u32>>) {
        let advanced = match interrupts {
            Some(_) => advanced(Model::get(self.model)),
            None => Vec::new(),
        };
        let interrupts = interrupts.unwrap_or_default();
        if self.subroutines.is_empty() && interrupts.is_empty() && advanced.is_empty() {
            return;
        }
        self.line("FEND");
        for pointer in interrupts {
            self.line(format!("I{pointer:03}"));
            self.body(2, false);
            self.line("IRET");
        }
        for (pointer, _) in advanced {
            self.line(format!("I{pointer}"));
            self.rung();
            self.line("PROC");
            self.rung();
            self.logic(1);
            self.line("PEND");
            self.rung();
            self.line("PRET");
        }
        let mut next = 0;
        while let Some(&Subroutine { label, depth }) = self.subroutines.get(next) {
            self.depth = depth;
            self.line(format!("P{label}"));
            self.body(2, false);
            self.line("SRET");
            next += 1;
        }
    }

    fn label(&mut self) -> u32 {
        self.next_label += 1;
        // P63 means END and is not a label.
        if self.next_label == 63 {
            self.next_label = 64;
        }
        self.next_label - 1
    }

    /// Returns true if there are pointers left for this many labels.
    fn has_labels(&self, count: u32) -> bool {
        self.next_label + count <= LABELS
    }

    /// A jump or call to a label, sometimes in the pulse form.
    fn go(&mut self, verb: &str, label: u32) {
        self.logic(1);
        let pulse = if self.rng.percent(25) { "P" } else { "" };
        self.line(format!("{verb}{pulse} P{label}"));
    }

    /// Jumps of one of the kinds, as far as there are labels.
    pub(super) fn jumps(&mut self, main: bool) {
        match self.rng.below(4) {
            _ if !self.has_labels(6) => self.rung(),
            0 => self.web(),
            1 if self.loops == 0 => self.jump_back(),
            _ => self.jump(main),
        }
    }

    /// CJ over some rungs.
    fn jump(&mut self, main: bool) {
        let label = self.label();
        self.go("CJ", label);
        let rungs = 1 + self.rng.below(2);
        for _ in 0..rungs {
            if main && self.rng.percent(20) && self.loops < 2 {
                self.repeat();
            } else {
                self.rung();
            }
        }
        self.line(format!("P{label}"));
    }

    /// Jumps whose ways nest and cross: each leads to one of the labels that follow it.
    fn web(&mut self) {
        let count = 3 + self.rng.below(3);
        let labels: Vec<u32> = (0..count).map(|_| self.label()).collect();
        for (i, label) in labels.iter().enumerate() {
            for _ in 0..1 + self.rng.below(2) {
                let further = self.rng.pick(&labels[i..]).unwrap_or(*label);
                self.go("CJ", further);
                if self.rng.percent(50) {
                    self.rung();
                }
            }
            self.rung();
            self.line(format!("P{label}"));
        }
    }

    /// A jump back, which makes a loop of a few passes.
    fn jump_back(&mut self) {
        let label = self.label();
        let passes = 1 + self.rng.below(4);
        self.line("LD M8000");
        self.line(format!("MOV K{passes} {PASSES}"));
        self.line(format!("P{label}"));
        self.rung();
        self.line("LD M8000");
        self.line(format!("DEC {PASSES}"));
        self.line(format!("LD> {PASSES} K0"));
        self.line(format!("CJ P{label}"));
    }

    /// A loop of a few passes, whose count is written or only known in the run.
    pub(super) fn repeat(&mut self) {
        let class = match self.rng.percent(60) {
            true => None,
            false => self.rng.pick(&self.counts()),
        };
        self.repeat_by(class.unwrap_or(Classes::K));
    }

    /// Classes of a count of FOR on the model.
    fn counts(&self) -> Vec<Classes> {
        let model = Model::get(self.model);
        let count = rungc_catalogue::find("FOR").map(|found| found.inst.params_of(&[], model));
        let count = count.and_then(|params| params.first());
        count.map_or(Vec::new(), |count| each(count.classes_on(model)))
    }

    /// A loop whose count is of this class.
    fn repeat_by(&mut self, class: Classes) {
        let passes = self.rng.below(4);
        // Values that other instructions leave there would mean many passes.
        let set = match class {
            Classes::T => Some("T5"),
            Classes::C => Some("C5"),
            Classes::D => Some("D121"),
            Classes::R => Some("R90"),
            Classes::V => Some("V2"),
            Classes::Z => Some("Z2"),
            Classes::BUFFER => Some("U0\\G15"),
            _ => None,
        };
        let count = match class {
            Classes::H => format!("H{passes}"),
            Classes::KNX => "K1X000".to_string(),
            Classes::KNY => "K1Y000".to_string(),
            Classes::KNM => "K1M0".to_string(),
            Classes::KNS => "K1S0".to_string(),
            _ => format!("K{passes}"),
        };
        if let Some(set) = set {
            self.line("LD M8000");
            self.line(format!("MOV {count} {set}"));
        }
        self.line(format!("FOR {}", set.unwrap_or(&count)));
        self.loops += 1;
        let rungs = 1 + self.rng.below(2);
        self.body(rungs, false);
        self.loops -= 1;
        self.line("NEXT");
    }

    /// A zone that a relay or an output shows.
    pub(super) fn master(&mut self) {
        let number = self.rng.below(4);
        match self.rng.percent(80) {
            true => self.master_of(format!("M{}", 60 + number)),
            false => self.master_of(format!("Y{number:03o}")),
        }
    }

    fn master_of(&mut self, drive: String) {
        let level = self.masters;
        self.logic(1);
        self.line(format!("MC N{level} {drive}"));
        self.masters += 1;
        if level == 0 && self.rng.percent(25) {
            self.steps(20);
        }
        let rungs = 1 + self.rng.below(3);
        self.body(rungs, true);
        self.masters -= 1;
        self.line(format!("MCR N{level}"));
    }

    /// A call of a new subroutine or of one that is called elsewhere, sometimes of one that calls it in turn.
    pub(super) fn call(&mut self) {
        let depth = self.depth;
        let again = depth > 0 && self.rng.percent(30);
        let known = self.subroutines.iter();
        let known: Vec<u32> = known
            .filter(|routine| again || routine.depth > depth)
            .map(|routine| routine.label)
            .collect();
        // One more than may nest: the PLC skips a call that is too deep.
        let new = self.has_labels(1) && depth <= Model::get(self.model).max_call;
        let label = match self.rng.pick(&known) {
            Some(label) if again || !new || self.rng.percent(40) => label,
            _ if new => {
                let label = self.label();
                let depth = depth + 1;
                self.subroutines.push(Subroutine { label, depth });
                label
            }
            _ => return self.rung(),
        };
        self.go("CALL", label);
    }

    /// Instructions that stand in a program now and then: interrupts forbidden for a while, the watchdog, nothing.
    pub(super) fn seldom(&mut self) {
        match self.rng.below(4) {
            0 => {
                self.line("DI");
                self.rung();
                self.line("EI");
            }
            1 => {
                self.logic(1);
                let refresh = self.rng.pick(&["WDT", "WDTP"]).unwrap_or("WDT");
                self.line(refresh);
            }
            2 => self.line("NOP"),
            _ => self.bounded_index(),
        }
    }

    /// A step ladder of a few states that hand on to each other, from this one on. In the states are jumps, loops and
    /// calls, and some ladders branch and join.
    pub(super) fn steps(&mut self, first: u32) {
        self.line("LD M8002");
        self.line(format!("SET S{first}"));
        let count = 2 + self.rng.below(4);
        for state in first..first + count {
            self.line(format!("STL S{state}"));
            if self.rng.percent(50) {
                let coil = self.coil();
                self.line(coil);
            }
            self.section();
            self.logic(1);
            let verb = if self.rng.percent(70) { "SET" } else { "OUT" };
            let target = if self.rng.percent(70) {
                first + (state - first + 1) % count
            } else {
                first + self.rng.below(count)
            };
            self.line(format!("{verb} S{target}"));
        }
        if self.rng.percent(50) {
            self.branches(first);
        }
        self.line("RET");
    }

    /// Something of a state.
    fn section(&mut self) {
        match self.rng.below(8) {
            0 => self.jumps(false),
            1..=2 if self.depth == 0 => self.call(),
            3 => self.repeat(),
            n => (0..n % 2).for_each(|_| self.rung()),
        }
    }

    /// Two branches side by side, which begin together and are joined.
    fn branches(&mut self, first: u32) {
        let [one, other] = [first + 8, first + 9];
        self.logic(1);
        self.line(format!("SET S{one}"));
        self.line(format!("SET S{other}"));
        for state in [one, other] {
            self.line(format!("STL S{state}"));
            self.section();
        }
        self.line(format!("STL S{one}"));
        self.line(format!("STL S{other}"));
        self.logic(1);
        self.line(format!("SET S{first}"));
    }
}
