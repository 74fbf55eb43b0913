//! Instructions that run again in the next scan: the catalogue says which of them change their operands again, and a
//! warning follows from it. Every row is run, also with its result over or beside each of its sources.

use rungc_catalogue::{Forms, Inst, Repeat, Role, Shape, all};
use rungc_interp::Machine;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::{Model, ModelId};
use rungc_rt::{Class, NoHal, Plc, Program};
use rungc_syntax::{Classes, codes};

/// Instructions whose results change for another reason than that they ran before, or that need a table to work.
const LEFT_OUT: &[&str] = &["RND", "STR", "ESTR", "SCL", "SCL2", "MIDR", "MIDW"];

/// Registers and relays that a program may name.
const COUNT: u32 = 900;

/// The sequence of a linear congruential generator.
struct Random(u32);

impl Random {
    fn next(&mut self, below: u32) -> u32 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.0 >> 8) % below
    }
}

/// Fills registers and relays: small numbers, any, larger numbers and texts by turns, floats.
fn fill(machine: &mut Machine, seed: u32) {
    let mut random = Random(seed);
    for number in 0..COUNT {
        let word = match (seed % 4, number % 100) {
            // Texts end here.
            (_, 50..) => 0,
            (0, _) if seed < 8 => [22, 3][seed as usize / 4],
            (0, _) => random.next(22) + 1,
            (1, _) if seed < 8 => random.next(10_000),
            (1, _) => random.next(0x1_0000),
            (2, at) if number / 100 == 2 => 2 + at,
            (2, 3..) => 10 + random.next(80),
            (2, _) => 0x3030 + random.next(10) + 256 * random.next(10),
            (_, at) if at % 2 == 0 => 0,
            _ => 0x3e80 + 0x40 * random.next(8),
        };
        machine.set_word(Class::D, number, word as u16 as i16);
        machine.set_bit(Class::M, number, random.next(2) == 1);
    }
    machine.set_bit(Class::X, 0, true);
}

/// Values of registers and relays.
fn values(machine: &Machine) -> Vec<i64> {
    let words = (0..COUNT).map(|number| machine.word(Class::D, number).map_or(0, i64::from));
    let bits = (0..COUNT).map(|number| machine.bit(Class::M, number).map_or(0, i64::from));
    let outputs = (0..8).map(|number| machine.bit(Class::Y, number).map_or(0, i64::from));
    words.chain(bits).chain(outputs).collect()
}

/// True if `rungc check` warns of a program, and true if its second scan changes something; `None` if it has errors.
fn outcome(text: &str, model: ModelId) -> Option<(bool, bool)> {
    let read = rungc_frontend::read_text("test.il", text);
    let options = CompileOptions {
        model: Some(model),
        ..CompileOptions::default()
    };
    let compiled = compile(&read.program, &options);
    let module = compiled.module.filter(|_| !read.diagnostics.has_errors())?;
    let mut found = compiled.diagnostics.iter();
    let warned = found.any(|found| found.code == codes::EVERY_SCAN.id);
    let changes = (0..20).any(|seed| {
        let mut machine = Machine::new(&module);
        fill(&mut machine, seed);
        machine.scan(&mut NoHal, 0, 10_000);
        let before = values(&machine);
        machine.scan(&mut NoHal, 10, 10_000);
        values(&machine) != before
    });
    Some((warned, changes))
}

/// Programs of a row: its example, and it with its result over each source, or beside it, and with neutral constants.
fn programs(inst: &Inst, model: &Model) -> Vec<String> {
    let example = inst.example_on(model);
    let Some((before, line)) = example.rsplit_once('\n') else {
        return Vec::new();
    };
    let mut words: Vec<String> = line.split(' ').map(str::to_owned).collect();
    let params = inst.params_of(&[], model);
    let places = params.iter().enumerate().take(words.len() - 1);
    let counts = places
        .clone()
        .filter(|(_, param)| param.name.starts_with('n'));
    for (n, _) in counts.filter(|(_, param)| param.classes.meets(Classes::K)) {
        if !words[n + 1].starts_with('K') {
            words[n + 1] = "K3".to_owned();
        }
    }
    let mut lines = vec![words.join(" ")];
    let steps = matches!(inst.repeat, Repeat::Changes(_));
    let results = places.clone().filter(|(_, param)| param.role != Role::Read);
    for (result, of) in results.filter(|_| !steps) {
        let (class, number) = words[result + 1].split_at(1);
        let Ok(number) = number.parse::<u32>() else {
            continue;
        };
        let sources = places
            .clone()
            .filter(|&(n, param)| n != result && param.name.starts_with('S'));
        for (source, _) in sources {
            let shifts = inst.repeat == Repeat::Shifting && of.shape != Shape::Text;
            let beside = [number + 1, number + 2].into_iter().filter(|_| shifts);
            for near in std::iter::once(number).chain(beside) {
                let mut words = words.clone();
                words[source + 1] = format!("{class}{near}");
                lines.push(words.join(" "));
                for &neutral in inst.neutral.operands.iter().filter(|&&n| n != source) {
                    for value in [inst.neutral.value, 7] {
                        words[neutral + 1] = format!("K{value}");
                        lines.push(words.join(" "));
                    }
                }
            }
        }
    }
    let lines = lines.into_iter();
    lines
        .map(|line| format!("{before}\n{line}\nEND\n"))
        .collect()
}

/// Further programs: groups of bits, digits of a word, and forms that are not the first of their rows.
const FURTHER: &[&str] = &[
    "MOV K1M0 K1M1",
    "MOV K2M0 K1M0",
    "MOV K1M0 K2M4",
    "DMOV D0 D1",
    "DMOV D0 D2",
    "BMOV D0 D1 K5",
    "BMOV D1 D0 K5",
    "BMOV D0 D5 K5",
    "SMOV D0 K3 K3 D0 K4",
    "SMOV D0 K4 K2 D0 K3",
    "SMOV D0 K4 K2 D0 K2",
    "SMOV D0 K2 K2 D0 K2",
    "SMOV D0 K3 K3 D1 K4",
    "DADD D0 K1 D0",
    "DADD D0 K1 D2",
    "DSUB K0 D0 D0",
    "MUL D1 K7 D0",
    "DINT D0 D0",
    "MEAN D0 D1 K3",
    "MEAN D0 D3 K3",
    "WSUM D0 D1 K3",
    "ALT M0",
    "DINC D0",
];

#[test]
fn the_warning_of_repeated_changes_fits_what_every_row_does() {
    let mut texts = Vec::new();
    for inst in all().filter(|inst| !LEFT_OUT.contains(&inst.name)) {
        let has_pulse = |id: &ModelId| inst.models.has(*id) && inst.forms_on(*id).has(Forms::PULSE);
        let model = [ModelId::Fx3u, ModelId::H2u, ModelId::Hm];
        if let Some(model) = model.into_iter().find(has_pulse) {
            let programs = programs(inst, Model::get(model));
            texts.extend(programs.into_iter().map(|text| (model, text)));
        }
    }
    let further = FURTHER.iter().map(|line| format!("LD X0\n{line}\nEND\n"));
    texts.extend(further.map(|text| (ModelId::Fx3u, text)));
    let outcomes = texts
        .iter()
        .filter_map(|(model, text)| Some((text, outcome(text, *model)?)));
    let outcomes: Vec<_> = outcomes.collect();
    assert!(outcomes.len() > 300, "{}", outcomes.len());
    let wrong = outcomes
        .iter()
        .filter(|(_, (warned, changes))| warned != changes);
    let wrong =
        wrong.map(|(text, (warned, _))| format!("warned {warned}: {}", text.replace('\n', " / ")));
    let wrong: Vec<_> = wrong.collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
