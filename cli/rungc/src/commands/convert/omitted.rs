//! What a program loses in an output form: all that does not come back when the output is read.

use crate::args::ConvertTo;
use crate::commands::counted;
use rungc_analysis::latches;
use rungc_analysis::resolve::resolve;
use rungc_frontend::{Read, read_bytes};
use rungc_lower::compile::{CompileOptions, model};
use rungc_models::Model;
use rungc_syntax::{DeviceRun, Instr, Parameters, Program, codes};
use std::collections::BTreeMap;

/// Sentences that name what `bytes`, a program in an output form, do not hold of the program. `own` are the parameters
/// that its source has.
pub fn sentences(
    to: ConvertTo,
    read: &Read,
    own: Option<&Parameters>,
    options: &CompileOptions,
    bytes: &[u8],
) -> Vec<String> {
    let Some(form) = to.form() else {
        return Vec::new();
    };
    let Ok(back) = read_bytes("converted", bytes) else {
        return Vec::new();
    };
    let (program, back) = (&read.program, &back.program);
    let mut sentences = Vec::new();
    let mut say = |omitted: Vec<String>, advice: &dyn Fn(&str) -> String| {
        if !omitted.is_empty() {
            let (omitted, them) = (listed(&omitted), pronoun(&omitted));
            let advice = advice(them);
            sentences.push(format!(
                "{omitted} omitted, because {form} cannot store {them}{advice}"
            ));
        }
    };
    let in_list = |them: &str| format!("; `--to il` keeps {them}");
    let in_table = |them: &str| match to {
        ConvertTo::Csv | ConvertTo::Image => {
            format!("{}, and `--to comments` writes {them}", in_list(them))
        }
        _ => in_list(them),
    };
    say(comments(program, back), &in_table);
    // Of PLCopen XML, N0741 says what becomes of each instruction.
    if to != ConvertTo::Plcopen {
        say(instructions(program, back), &in_list);
    }
    say(texts(program, back), &in_list);
    let model = model(program, options);
    let stated = Program {
        parameters: own.cloned(),
        ..Program::default()
    };
    let latched = chosen_latches(&stated, back, model);
    let sets_latched = !latched.is_empty();
    let in_settings = |_: &str| "; `[latched]` of rungc.toml sets latched devices".to_owned();
    let capacity = capacity(program, back, model);
    let all = [latched, capacity, blocks(&stated, back)].concat();
    match sets_latched {
        true => say(all, &in_settings),
        false => say(all, &|_| String::new()),
    }
    if back.retained.is_empty() && !program.retained.is_empty() {
        let retained = format!("RETAIN of {}", listed(&named(&program.retained)));
        say(vec![retained], &in_settings);
    }
    if to == ConvertTo::Plcopen {
        sentences.extend(moved(program, back).map(|moved| {
            let them = pronoun(std::slice::from_ref(&moved));
            let (moves, network) = match them {
                "it" => ("moves", "its network"),
                _ => ("move", "their networks"),
            };
            format!(
                "{moved} {moves} to the start of {network}, because {form} has no place inside; \
                 `--to il` keeps {them} there"
            )
        }));
    }
    sentences
}

/// The word for these things.
fn pronoun(things: &[String]) -> &'static str {
    match things {
        [one] if !one.starts_with(|c: char| c.is_ascii_digit()) && !one.contains("devices") => "it",
        [one] if one.starts_with("1 ") => "it",
        _ => "them",
    }
}

/// Things as a list: `a, b and c`.
fn listed(things: &[String]) -> String {
    match things {
        [all @ .., last] if !all.is_empty() => format!("{} and {last}", all.join(", ")),
        _ => things.concat(),
    }
}

/// The devices whose comments do not come back.
fn comments(program: &Program, back: &Program) -> Vec<String> {
    let lost = program.comments.iter();
    let lost = lost.filter(|(device, text)| back.comments.get(device) != Some(text));
    Vec::from_iter(some(lost.count(), "device comment"))
}

/// A number of things, unless there are none.
fn some(count: usize, what: &str) -> Option<String> {
    (count > 0).then(|| counted(count, what))
}

/// The elements of one list that another lacks, with their numbers.
fn lacking<'a>(
    all: impl Iterator<Item = &'a str>,
    back: impl Iterator<Item = &'a str>,
) -> BTreeMap<&'a str, usize> {
    let mut numbers = BTreeMap::new();
    for thing in all {
        *numbers.entry(thing).or_insert(0) += 1;
    }
    for thing in back {
        if let Some(number) = numbers.get_mut(thing) {
            *number = usize::saturating_sub(*number, 1);
        }
    }
    numbers.retain(|_, number| *number > 0);
    numbers
}

/// The instructions that do not come back. Forms leave out what has no effect, or what their structure implies.
fn instructions(program: &Program, back: &Program) -> Vec<String> {
    let words = |program: &Program| -> Vec<String> {
        program.instrs.iter().map(Instr::to_string).collect()
    };
    let (old, new) = (words(program), words(back));
    let lost = lacking(
        old.iter().map(String::as_str),
        new.iter().map(String::as_str),
    );
    let lost = lost.into_iter();
    lost.map(|(instr, number)| format!("{number} {instr}"))
        .collect()
}

/// The texts that do not come back: statements, notes, title and CPU type.
fn texts(program: &Program, back: &Program) -> Vec<String> {
    fn notes(program: &Program) -> impl Iterator<Item = &str> {
        program.instrs.iter().filter_map(Instr::note)
    }
    let lines = lacking(statements(program), statements(back));
    // The note of an instruction that is implied becomes a separate line.
    let notes = lacking(notes(program), notes(back).chain(statements(back)));
    let is_lost = |old: &Option<String>, new: &Option<String>| old.is_some() && old != new;
    let title = is_lost(&program.title, &back.title).then(|| "the title".to_owned());
    let cpu = is_lost(&program.cpu, &back.cpu).then(|| "the CPU type".to_owned());
    let texts = [
        some(lines.values().sum(), "statement line"),
        some(notes.values().sum(), "note"),
        title,
        cpu,
    ];
    texts.into_iter().flatten().collect()
}

/// The statement lines that come back above another instruction.
fn moved(program: &Program, back: &Program) -> Option<String> {
    fn places(program: &Program) -> Vec<String> {
        let instrs = program.instrs.iter();
        let lines = |instr: &Instr| {
            let lines = instr.statement().into_iter().flat_map(str::lines);
            Vec::from_iter(lines.map(|line| format!("{line}\n{instr}")))
        };
        instrs.flat_map(lines).collect()
    }
    let [old, new] = [places(program), places(back)];
    let [old, new] = [&old, &new].map(|places| places.iter().map(String::as_str));
    let elsewhere: usize = lacking(old, new).values().sum();
    let lost: usize = lacking(statements(program), statements(back))
        .values()
        .sum();
    some(elsewhere.saturating_sub(lost), "statement line")
}

/// The lines of all statements.
fn statements(program: &Program) -> impl Iterator<Item = &str> {
    let above = program.instrs.iter().filter_map(Instr::statement);
    above.chain(program.closing.as_deref()).flat_map(str::lines)
}

/// The latched devices that the parameters choose, if the output leaves other ones latched.
fn chosen_latches(program: &Program, back: &Program, model: &Model) -> Vec<String> {
    let latched = program
        .parameters
        .as_ref()
        .and_then(|of| of.latched.as_ref());
    let is_same = latches::ranges(program, model) == latches::ranges(back, model);
    let runs = latched.filter(|_| !is_same).into_iter().flatten();
    let runs: Vec<_> = runs.filter(|run| run.count > 0).copied().collect();
    match runs.is_empty() {
        true => Vec::new(),
        false => vec![format!("the latched devices ({})", named(&runs).join(", "))],
    }
}

/// Runs of devices by their names.
fn named(runs: &[DeviceRun]) -> Vec<String> {
    let name = |run: &DeviceRun| match run.count {
        1 => run.class.number(run.first).to_string(),
        _ => run.to_string(),
    };
    runs.iter().map(name).collect()
}

/// The memory capacity, if the program does not fit in it and the output does not say so any more.
fn capacity(program: &Program, back: &Program, model: &'static Model) -> Vec<String> {
    let fits = |program: &Program| {
        let (_, found) = resolve(program, model);
        found.iter().all(|one| one.code != codes::TOO_LONG.id)
    };
    let capacity = program.parameters.as_ref().and_then(|of| of.capacity);
    let lost = capacity.filter(|_| !fits(program) && fits(back));
    let named = lost.map(|steps| counted(steps as usize, "step"));
    named
        .map(|steps| format!("the memory capacity ({steps})"))
        .into_iter()
        .collect()
}

/// Blocks of memory beside the program that do not come back.
fn blocks(program: &Program, back: &Program) -> Vec<String> {
    let of = |program: &Program| program.parameters.clone().unwrap_or_default();
    let (old, new) = (of(program), of(back));
    let blocks = |old: u32, new: u32, what| some(old.saturating_sub(new) as usize, what);
    let parameters = [
        blocks(old.comment_blocks, new.comment_blocks, "comment block"),
        blocks(
            old.file_register_blocks,
            new.file_register_blocks,
            "file register block",
        ),
    ];
    parameters.into_iter().flatten().collect()
}
