//! `rungc diff`.

mod git;
mod json;
mod proof;
mod text;

use super::subject::{self, Subject};
use super::view::PICTURE_WIDTH;
use super::{Context, Failure, Outcome, Result, eprint_line, print_text, read_as_written};
use crate::args::{DiffArgs, DiffFormat, Input};
use crate::output::{file, write_file};
use crate::report::{Findings, Reporter};
use proof::Proofs;
use rungc_analysis::resolve::{Resolved, resolve};
use rungc_frontend::Read;
use rungc_ir::compare::{Behaviour, behaviour, list};
use rungc_ir::passes::simplify;
use rungc_ladder::compare::{Comparison, Drawn, compare};
use rungc_ladder::{Ladder, build, html, svg};
use rungc_lower::compile::{CompileOptions, compile, model};
use rungc_models::Model;
use rungc_syntax::{DeviceClass, Program};
use rungc_verify::same::Output;
use std::path::{Path, PathBuf};

/// Compares two programs.
pub fn run(args: &DiffArgs, cx: Context) -> Result {
    match &args.files[..] {
        [old, new] => {
            let [old, new] = [old, new].map(|file| Side::read(file, file.clone(), args, cx));
            let differs = report(&old?, &new?, args)?;
            Ok(match differs {
                true => Outcome::Failed,
                false => Outcome::Success,
            })
        }
        files => match git::call(files) {
            Some(call) => git::run(&call, args, cx),
            None => Err(Failure::Because(format!(
                "diff takes two programs, or the seven or nine arguments of a Git diff driver, not {}",
                files.len()
            ))),
        },
    }
}

/// One of two programs.
struct Side {
    /// Name of the program.
    name: String,
    subject: Option<Subject>,
    read: Read,
    /// The program with what its settings say of it, which decides what it does.
    meant: Program,
    model: &'static Model,
}

impl Side {
    fn read(
        file: &Path,
        named: PathBuf,
        args: &DiffArgs,
        cx: Context,
    ) -> std::result::Result<Side, Failure> {
        let input = Input {
            file: Some(file.to_owned()),
            reading: args.reading(),
        };
        let subject = subject::one(&input, cx)?;
        let named = match file.is_dir() {
            true => subject.file.clone(),
            false => named,
        };
        let mut reporter = Reporter::new(&subject.reporting, cx, true);
        let read = read_as_written(&subject, &mut reporter)?;
        if read.diagnostics.has_errors() || !read.program.is_complete() {
            let diagnostics = read.diagnostics.clone();
            let findings = Findings::new(&named, &read.program, diagnostics, &subject.reporting);
            reporter.add(&findings)?;
            reporter.finish()?;
            let name = named.display();
            let why = format!("{name} cannot be read whole, so it is not compared");
            return Err(Failure::Because(why));
        }
        let model = model(&read.program, &subject.options());
        let mut meant = read.program.clone();
        super::complete(&subject, &mut meant, &mut reporter)?;
        Ok(Side {
            name: named.display().to_string(),
            subject: Some(subject),
            read,
            meant,
            model,
        })
    }

    /// A file that is not there yet, or not any more.
    fn absent(name: &Path) -> Side {
        let read = Read::default();
        let model = model(&read.program, &CompileOptions::default());
        Side {
            name: name.display().to_string(),
            subject: None,
            meant: read.program.clone(),
            read,
            model,
        }
    }

    fn options(&self) -> CompileOptions {
        let options = self.subject.as_ref().map(Subject::options);
        options.unwrap_or_default()
    }
}

/// Two programs with what differs between them.
struct Compared<'a> {
    names: [&'a str; 2],
    old: Drawn<'a>,
    new: Drawn<'a>,
    comparison: Comparison,
    /// Difference in behaviour, if requested.
    behaviour: Option<Behaviour>,
    /// Outputs that are proved the same.
    proved: Proofs,
}

/// Compares two programs and prints the result; whether they differ.
fn report(old: &Side, new: &Side, args: &DiffArgs) -> std::result::Result<bool, Failure> {
    let [a, b] = [old, new].map(|side| resolve(&side.read.program, side.model).0);
    let (ladder_a, ladder_b) = (build::ladder(&a), build::ladder(&b));
    let compared = compared(old, new, [(&a, &ladder_a), (&b, &ladder_b)], args.semantic);
    let differs = match &compared.behaviour {
        Some(Behaviour::Same) => false,
        Some(Behaviour::CanDiffer {
            devices, hardware, ..
        }) => !devices.is_empty() || *hardware,
        Some(Behaviour::Undecided(_)) => true,
        None => !compared.comparison.is_empty(),
    };
    let text = match args.format {
        DiffFormat::Human => text::human(&compared, args.width),
        DiffFormat::Md => text::markdown(&compared, args.width),
        DiffFormat::Json => json::object(&compared, differs)?,
        DiffFormat::Svg => {
            let sides = [compared.old, compared.new];
            svg::comparison(sides, &compared.comparison, PICTURE_WIDTH).to_string()
        }
        DiffFormat::Html => {
            let summary = text::summary(&compared);
            html::comparison(
                compared.names,
                [compared.old, compared.new],
                &compared.comparison,
                &summary,
            )
        }
    };
    match file(&args.output) {
        Some(path) => write_file(path, text.as_bytes(), args.force)?,
        None => print_text(&text)?,
    }
    Ok(differs)
}

fn compared<'a>(
    old: &'a Side,
    new: &'a Side,
    [a, b]: [(&'a Resolved<'a>, &'a Ladder); 2],
    semantic: bool,
) -> Compared<'a> {
    let drawn = |(resolved, ladder)| Drawn { resolved, ladder };
    let (drawn_old, drawn_new) = (drawn(a), drawn(b));
    let mut behaviour = semantic.then(|| of_both(old, new));
    let found = behaviour.as_mut();
    let proved = found.map(|behaviour| proof::proved(old, new, behaviour));
    Compared {
        names: [&old.name, &new.name],
        old: drawn_old,
        new: drawn_new,
        comparison: compare(drawn_old, drawn_new),
        behaviour,
        proved: proved.unwrap_or_default(),
    }
}

/// Comparison of the behaviour of both programs.
fn of_both(old: &Side, new: &Side) -> Behaviour {
    let modules = [old, new].map(|side| {
        let module = compile(&side.meant, &side.options()).module;
        module.map(|mut module| {
            simplify(&mut module);
            module
        })
    });
    match modules {
        [Some(old), Some(new)] => behaviour(&old, &new),
        [None, _] => Behaviour::Undecided("the old program does not compile (see `rungc check`)"),
        [_, None] => Behaviour::Undecided("the new program does not compile (see `rungc check`)"),
    }
}

/// Maximum number of instructions named as limiting the comparison.
const MOST_NAMED: usize = 12;

impl Compared<'_> {
    /// The instructions that are assumed to use all special devices, where that matters: whether each is in the new
    /// program, its mnemonic and its step.
    fn vague(&self) -> Vec<(bool, &str, u32)> {
        let Some(Behaviour::CanDiffer { vague, .. }) = &self.behaviour else {
            return Vec::new();
        };
        let sides = [self.old, self.new]
            .into_iter()
            .zip(vague)
            .zip([false, true]);
        let named = sides.flat_map(|((side, steps), is_new)| {
            steps.iter().map(move |step| {
                let instrs = &side.resolved.instrs;
                let at = instrs.partition_point(|instr| instr.step < *step);
                let instr = side.resolved.program.instrs.get(at);
                (is_new, instr.map_or("", |instr| &*instr.mnemonic), *step)
            })
        });
        named.collect()
    }

    /// Result of comparing the behaviour, in sentences.
    fn in_words(&self) -> Vec<String> {
        let mut words = match &self.behaviour {
            Some(behaviour) => behaviour.in_words(proved_in_words(&self.proved.outputs)),
            None => return Vec::new(),
        };
        let vague = self.vague();
        if !vague.is_empty() {
            let named = vague.iter().take(MOST_NAMED);
            let mut named: Vec<String> = named
                .map(|(is_new, mnemonic, step)| match is_new {
                    true => format!("{mnemonic} (step {step})"),
                    false => format!("{mnemonic} (step {step} before)"),
                })
                .collect();
            if let Some(more @ 1..) = vague.len().checked_sub(MOST_NAMED) {
                named.push(format!("{more} more"));
            }
            let named = named.join(", ");
            words.push(format!(
                "Instructions that are taken to use all special devices, which can make these lists longer: {named}."
            ));
        }
        words
    }
}

/// Outputs that are proved the same, in a sentence.
fn proved_in_words(proved: &[Output]) -> Option<String> {
    let mut runs = Vec::new();
    for output in proved {
        proof::add(&mut runs, DeviceClass::Y, output.number);
    }
    (!runs.is_empty()).then(|| {
        format!(
            "Outputs that are proved the same, with scans of at most {} ms: {}.",
            proof::scan_ms(),
            list(&runs.iter().collect::<Vec<_>>())
        )
    })
}
