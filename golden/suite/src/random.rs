//! Random programs: well-formed by construction, drawing on the whole catalogue.

mod flow;

use crate::operands::{BUFFER_WORDS, Candidate, accepted, first_counter32, special_register};
use crate::rng::Rng;
use crate::{motions, sequences, stations};
use flow::Subroutine;
use rungc_models::{Model, ModelId};
use rungc_syntax::DeviceClass;
use std::collections::BTreeMap;

/// Makes one program.
struct Writer<'c> {
    rng: Rng,
    model: ModelId,
    candidates: &'c [Candidate],
    lines: Vec<String>,
    /// Next pointer to be given away.
    next_label: u32,
    /// Subroutines to be written after FEND, in this order.
    subroutines: Vec<Subroutine>,
    /// Number of nested calls that lead to the code being written.
    depth: u32,
    /// Number of uses of instructions with a limit.
    uses: BTreeMap<&'static str, u32>,
    /// Depth of loops, and of MC.
    loops: u32,
    masters: u32,
}

/// A program of one of all kinds for a model, mostly made of these instructions.
pub fn any(seed: u64, model: ModelId, candidates: &[Candidate]) -> String {
    match seed % 9 {
        0 => stations::program(seed),
        1 => sequences::program(seed),
        2 => motions::program(seed, model),
        _ => program(seed, model, candidates, 8 + (seed % 20) as u32),
    }
}

/// A program of about `rungs` rungs for a model, made of these instructions.
pub fn program(seed: u64, model: ModelId, candidates: &[Candidate], rungs: u32) -> String {
    let mut writer = Writer::new(seed, model, candidates);
    let interrupts = if writer.rng.percent(25) {
        Some(writer.enable_interrupts(60))
    } else {
        writer.high_speed_counter();
        None
    };
    if writer.rng.percent(30) {
        writer.steps(0);
    }
    writer.body(rungs, true);
    writer.routines(interrupts);
    writer.end()
}

/// A program for a model that has each structure there is: loops, zones, jumps, subroutines, interrupt routines, a step
/// ladder.
pub fn with_all_structures(seed: u64, model: ModelId, candidates: &[Candidate]) -> String {
    let mut writer = Writer::new(seed, model, candidates);
    let interrupts = writer.enable_interrupts(100);
    writer.all_structures();
    writer.routines(Some(interrupts));
    writer.end()
}

impl<'c> Writer<'c> {
    fn new(seed: u64, model: ModelId, candidates: &'c [Candidate]) -> Self {
        Writer {
            rng: Rng::new(seed),
            model,
            candidates,
            lines: Vec::new(),
            next_label: 0,
            subroutines: Vec::new(),
            depth: 0,
            uses: BTreeMap::new(),
            loops: 0,
            masters: 0,
        }
    }

    fn end(mut self) -> String {
        self.line("END");
        self.lines.join("\n") + "\n"
    }
}

impl Writer<'_> {
    fn line(&mut self, line: impl Into<String>) {
        self.lines.push(line.into());
    }

    /// A counter of the first inputs, sometimes, with comparisons at the count and a table.
    fn high_speed_counter(&mut self) {
        if self.rng.percent(75) {
            return;
        }
        let model = Model::get(self.model);
        let mut counters = vec![235, 239, 241, 244, 246, 247, 248, 250, 251, 254];
        counters.retain(|&counter| model.high_speed.counter(counter).is_some());
        let Some(counter) = self.rng.pick(&counters) else {
            return;
        };
        self.logic(1);
        let preset = self.rng.below(5);
        self.line(format!("OUT C{counter} K{preset}"));
        for compare in ["DHSCS K2", "DHSCR K4", "DHSZ K1 K3"] {
            if self.rng.percent(60) && self.knows(compare) {
                self.logic(1);
                let bit = ["Y000", "M10", "S20"][self.rng.below(3) as usize];
                let zone = match model.high_speed.crossing_zones {
                    Some(_) => " K0",
                    None => "",
                };
                self.line(format!("{compare} C{counter} {bit}{zone}"));
            }
        }
        if self.rng.percent(50) && self.knows("DHSZ") {
            self.logic(1);
            match model.high_speed.patterns.relay {
                Some(relay) => self.line(format!("DHSZ D0 K3 C{counter} M{}", relay.number())),
                None if self.knows("DHSCT") => {
                    self.line(format!("DHSCT D1000 K3 C{counter} M16 K6"));
                }
                None => self.line("OUT M16"),
            }
        }
    }

    /// Returns true if the model has the instruction that a line begins with.
    fn knows(&self, line: &str) -> bool {
        let found = line.split(' ').next().and_then(rungc_catalogue::find);
        found.is_some_and(|found| found.inst.models.has(self.model))
    }

    /// Rungs and what surrounds them; `main` bodies may hold MC zones.
    fn body(&mut self, rungs: u32, main: bool) {
        // Calls nest in routines, of which there are few.
        let kinds = if self.depth > 0 { 10 } else { 20 };
        for _ in 0..rungs {
            match self.rng.below(kinds) {
                0 => self.jumps(main),
                1 if self.loops < 2 => self.repeat(),
                2 if main && self.loops == 0 && self.masters < 3 => self.master(),
                // A call in a loop would be made again for each call that leads to it.
                3 if self.loops == 0 => self.call(),
                4 if self.loops == 0 => self.seldom(),
                _ => self.rung(),
            }
        }
    }

    /// Rungs in which it shows how far an index leads: after a comparison or a mask, in a loop, or over many scans.
    fn bounded_index(&mut self) {
        let register = self.rng.pick(&["Z0", "Z1", "V1"]).unwrap_or("Z0");
        let (base, source, end) = (self.rng.below(40), self.rng.below(24), self.rng.below(20));
        let indexed = match self.rng.below(3) {
            0 => format!("BMOV D{base}{register} D{source} K3"),
            1 => format!("MOV D{base}{register} D{source}"),
            _ => format!("MOV D{source} D{base}{register}"),
        };
        match self.rng.below(4) {
            0 => {
                let least = -self.rng.value(4).abs();
                self.line(format!("LD>= D{source} K{least}"));
                self.line(format!("AND< D{source} K{end}"));
                self.line(format!("MOV D{source} {register}"));
                self.line(indexed);
            }
            1 => {
                self.logic(1);
                self.line(format!("WAND D{source} K{end} {register}"));
                self.line(indexed);
            }
            2 if self.loops < 2 => {
                self.line("LD M8000");
                self.line(format!("MOV K{end} {register}"));
                let iterations = 1 + self.rng.below(12);
                self.line(format!("FOR K{iterations}"));
                self.logic(1);
                self.line(indexed);
                let step = self.rng.pick(&["INC", "DEC"]).unwrap_or("INC");
                self.line(format!("{step} {register}"));
                self.line("NEXT");
            }
            _ => {
                self.logic(1);
                self.line(format!("INC {register}"));
                self.line(format!("LD>= {register} K{end}"));
                self.line(format!("MOV K0 {register}"));
                self.line("LD M8000");
                self.line(indexed);
            }
        }
    }

    fn rung(&mut self) {
        self.logic(2);
        if self.rng.percent(12) {
            for stack in ["MPS", "MRD", "MPP"] {
                if stack == "MRD" && self.rng.percent(50) {
                    continue;
                }
                self.line(stack);
                let contact = self.contact("AND");
                self.line(contact);
                self.output();
            }
            return;
        }
        let outputs = 1 + self.rng.below(3);
        (0..outputs).for_each(|_| self.output());
    }

    /// Contacts in series and parallel.
    fn logic(&mut self, depth: u32) {
        let contact = self.contact("LD");
        self.line(contact);
        let more = self.rng.below(4);
        for _ in 0..more {
            match self.rng.below(10) {
                0 if depth > 0 => {
                    self.logic(depth - 1);
                    let join = self.rng.pick(&["ANB", "ORB"]).unwrap_or("ANB");
                    self.line(join);
                }
                1 => self.line("INV"),
                2 if accepted("MEP\nOUT M0", self.model) => {
                    let edge = self.rng.pick(&["MEP", "MEF"]).unwrap_or("MEP");
                    self.line(edge);
                }
                3..=5 => {
                    let contact = self.contact("OR");
                    self.line(contact);
                }
                _ => {
                    let contact = self.contact("AND");
                    self.line(contact);
                }
            }
        }
    }

    fn bit(&mut self) -> String {
        let n = self.rng.below(16);
        match self.rng.below(12) {
            0..=3 => format!("X{n:03o}"),
            4 => format!("Y{n:03o}"),
            5..=7 => format!("M{n}"),
            8 => format!("S{n}"),
            9 => format!("T{}", n % 6),
            10 if n < 8 => format!("C{}", self.counter32(n % 3)),
            10 => format!("C{}", n % 3),
            _ => {
                let specials = [
                    8000, 8001, 8002, 8003, 8011, 8012, 8013, 8014, 8020, 8021, 8022,
                ];
                format!("M{}", specials[n as usize % specials.len()])
            }
        }
    }

    /// A contact that joins as `LD`, `AND` or `OR`.
    fn contact(&mut self, join: &str) -> String {
        if self.rng.percent(15) {
            let operator = self
                .rng
                .pick(&["=", "<>", "<", "<=", ">", ">="])
                .unwrap_or("=");
            let wide = if self.rng.percent(30) { "D" } else { "" };
            let left = self.word(!wide.is_empty());
            let right = match self.rng.below(2) {
                0 => format!("K{}", self.rng.value(16)),
                _ => self.word(!wide.is_empty()),
            };
            let contact = format!("{join}{wide}{operator} {left} {right}");
            return self.on_model(contact, join);
        }
        let bit = self.bit();
        let bit = self.indexed(bit);
        let verb = match (join, self.rng.below(8)) {
            ("LD", 0..=1) => "LDI",
            ("AND", 0..=1) => "ANI",
            ("OR", 0..=1) => "ORI",
            ("LD", 2) => "LDP",
            ("LD", 3) => "LDF",
            ("AND", 2) => "ANDP",
            ("AND", 3) => "ANDF",
            ("OR", 2) => "ORP",
            ("OR", 3) => "ORF",
            (join, _) => join,
        };
        self.on_model(format!("{verb} {bit}"), join)
    }

    /// A contact, or another one where the model lacks one of its devices.
    fn on_model(&self, contact: String, join: &str) -> String {
        let joined = if join == "LD" { "\nANB" } else { "" };
        match accepted(&format!("{contact}{joined}\nOUT M0"), self.model) {
            true => contact,
            false => format!("{join} M0"),
        }
    }

    /// A 32-bit counter that the model has, if need be one whose input interrupts nothing.
    fn counter32(&self, n: u32) -> u32 {
        match first_counter32(Model::get(self.model)) {
            first if first < 235 => first + n,
            _ => 238 + n,
        }
    }

    fn word(&mut self, wide: bool) -> String {
        match self.rng.below(6) {
            4 if self.rng.percent(20) && accepted("MOV U0\\G0 D0", self.model) => {
                format!("U0\\G{}", self.rng.below(BUFFER_WORDS))
            }
            0 if !wide => format!("T{}", self.rng.below(6)),
            0 => {
                let n = self.rng.below(3);
                format!("C{}", self.counter32(n))
            }
            1 if !wide => format!("C{}", self.rng.below(3)),
            2 => {
                let (digits, further) = (1 + self.rng.below(4), self.rng.percent(50));
                let further = further && Model::get(self.model).has(DeviceClass::X, 31);
                format!("K{digits}X{}", if further { "010" } else { "000" })
            }
            3 if self.rng.percent(15) => {
                let first = special_register(&mut self.rng, Model::get(self.model));
                match self.rng.percent(50) {
                    true => format!("D{first}"),
                    false => format!("D{}Z0", 8000 + first % 10),
                }
            }
            3 => format!("D{}Z0", self.rng.below(20)),
            _ => format!("D{}", self.rng.below(24)),
        }
    }

    /// The operand of a basic instruction, sometimes with an index register, where the model takes one.
    fn indexed(&mut self, operand: String) -> String {
        if self.rng.percent(75) {
            return operand;
        }
        let register = self.rng.pick(&["Z0", "V1"]).unwrap_or("Z0");
        let indexed = format!("{operand}{register}");
        match accepted(&format!("AND {indexed}\nOUT M0"), self.model) {
            true => indexed,
            false => operand,
        }
    }

    fn coil(&mut self) -> String {
        let n = self.rng.below(16);
        match self.rng.below(3) {
            0 if Model::get(self.model).has(DeviceClass::Y, n) => format!("OUT Y{n:03o}"),
            _ => {
                let relay = self.indexed(format!("M{n}"));
                format!("OUT {relay}")
            }
        }
    }

    fn output(&mut self) {
        let n = self.rng.below(16);
        let preset = match self.rng.below(4) {
            0 => format!("D{}", self.rng.below(24)),
            _ => format!("K{}", self.rng.below(12)),
        };
        let timer = format!(
            "T{}",
            [n % 6, 196, 200, 246, 250][self.rng.below(5) as usize]
        );
        let (timer, counter) = (self.indexed(timer), self.indexed(format!("C{}", n % 3)));
        let line = match self.rng.below(20) {
            0..=2 => self.coil(),
            3 => {
                let relay = self.indexed(format!("M{n}"));
                format!("SET {relay}")
            }
            4 => {
                let relay = self.indexed(format!("M{n}"));
                format!("RST {relay}")
            }
            5 => format!("SET Y{n:03o}"),
            6 => format!("RST Y{n:03o}"),
            7 => format!("{} M{n}", self.rng.pick(&["PLS", "PLF"]).unwrap_or("PLS")),
            8 => format!("OUT {timer} {preset}"),
            9 => format!("OUT {counter} {preset}"),
            10 => format!("OUT C{} {preset}", self.counter32(n % 3)),
            11 => format!(
                "RST {}",
                ["T0", "C0", "C1", "C200", "D8028", "Z0"][n as usize % 6]
            ),
            12 => format!("OUT T{} K{}", [200, 246, 250, 1][n as usize % 4], n),
            _ => match self.applied() {
                Some(line) => line,
                None => self.coil(),
            },
        };
        let line = if accepted(&line, self.model) {
            line
        } else {
            self.coil()
        };
        self.line(line);
    }

    /// A block over special registers, some of which are index registers.
    fn special_block(&mut self) -> String {
        let first = special_register(&mut self.rng, Model::get(self.model));
        let (other, count) = (self.rng.below(24), 1 + self.rng.below(9));
        let last = first + count;
        match self.rng.below(8) {
            0 => format!("BMOV D{first} D{other} K{count}"),
            1 => format!("BMOV D{other} D{first} K{count}"),
            2 => format!("BMOV D{first} D{other} D{count}"),
            3 => format!("FMOV D{other} D{first} K{count}"),
            4 => format!("ZRST D{first} D{last}"),
            5 => format!("MEAN D{first} D{other} K{count}"),
            6 => format!("DMOV D{first} D{other}"),
            _ => format!("DSUM D{first} D{other}"),
        }
    }

    /// An applied instruction of the catalogue.
    fn applied(&mut self) -> Option<String> {
        // Index registers with small values keep indexed operands within reach.
        if self.rng.percent(8) {
            let register = self.rng.pick(&["Z0", "Z1", "V0", "V1"])?;
            let value = match self.rng.below(12) {
                // From general devices to special ones, and to those that are index registers.
                0 => 7990 + self.rng.below(50),
                1 => 8160 + self.rng.below(30),
                _ => self.rng.below(9),
            };
            return Some(match self.rng.below(20) {
                0 => format!("MOV D{value} {register}"),
                1 => format!("MOV K-{value} {register}"),
                _ => format!("MOV K{value} {register}"),
            });
        }
        if self.rng.percent(3) {
            return Some(self.special_block());
        }
        let i = self.rng.below(self.candidates.len() as u32);
        let candidate = self.candidates.get(i as usize)?;
        let inst = candidate.inst();
        let uses = self.uses.entry(inst.name).or_default();
        if inst.max_uses.is_some_and(|max| *uses >= max) {
            return None;
        }
        let drawn = candidate.draw(&mut self.rng, self.model)?;
        *uses += 1;
        Some(drawn)
    }
}

#[cfg(test)]
mod tests {
    use super::{Model, ModelId, program, with_all_structures};
    use crate::operands::candidates;
    use rungc_lower::compile::{CompileOptions, compile};

    /// The structures of a model fit each other, whatever stands in them.
    #[test]
    fn programs_with_all_structures_compile() {
        for model in ModelId::ALL {
            let pool = candidates(model);
            let mut messages = Vec::new();
            let compiles = (0..8).any(|seed| {
                let text = with_all_structures(seed, model, &pool);
                let read = rungc_frontend::read_text("structures.il", &text);
                let options = CompileOptions {
                    model: Some(model),
                    ..CompileOptions::default()
                };
                let compiled = compile(&read.program, &options);
                let errors = compiled.diagnostics.iter();
                messages.extend(errors.map(|found| found.message.clone()));
                compiled.module.is_some()
            });
            assert!(compiles, "{model:?}: {messages:?}");
        }
    }

    /// Engines differ in how they find special devices, most of all those that are index registers.
    #[test]
    fn special_devices_are_reached_in_all_ways() {
        let (mut blocks, mut coils, mut far, mut names) = (0, 0, 0, 0);
        for (model, programs) in [(ModelId::Fx3u, 60), (ModelId::Hm, 20)] {
            let pool = candidates(model);
            let aliases = Model::get(model).index_aliases;
            let named = |operand: &&str| {
                let number = operand.strip_prefix('D').and_then(|n| n.parse().ok());
                aliases.iter().any(|alias| Some(alias.register.0) == number)
            };
            let special = |operand: &&str| operand.starts_with("D8") && operand.len() == 5;
            let indexed = |operand: &&str| operand.starts_with('M') && operand.contains(['Z', 'V']);
            let large =
                |operand: &&str| ["K79", "K80", "K81"].iter().any(|k| operand.starts_with(k));
            for seed in 0..programs {
                for line in program(seed, model, &pool, 20).lines() {
                    let words: Vec<&str> = line.split(' ').collect();
                    let (verb, operands) = (words[0], &words[1..]);
                    let any = |what: &dyn Fn(&&str) -> bool| u32::from(operands.iter().any(what));
                    match verb {
                        "BMOV" | "FMOV" | "ZRST" | "MEAN" => blocks += any(&special),
                        "SET" | "RST" | "OUT" | "LD" | "AND" | "OR" => coils += any(&indexed),
                        "MOV" => far += any(&large),
                        _ => {}
                    }
                    names += any(&named);
                }
            }
        }
        let least = blocks.min(coils).min(far).min(names);
        assert!(
            least > 10,
            "{blocks} blocks, {coils} coils, {far} far, {names} names"
        );
    }
}
