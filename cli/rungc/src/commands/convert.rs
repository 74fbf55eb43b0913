//! `rungc convert`.

mod omitted;
mod sources;

use super::subject::{self, OutputPaths, Subject};
use super::{
    Context, Failure, Outcome, Result, completed, conclude, eprint_line, print_bytes, print_text,
    read_as_written, stem,
};
use crate::args::{ConvertArgs, ConvertTo, PlcopenBody};
use crate::output::{file, write_file};
use crate::report::{Findings, Reporter};
use rungc_analysis::resolve::resolve;
use rungc_export::{to_ladder, to_plcopen};
use rungc_frontend::{Read, image, print};
use rungc_lower::compile::{CompileOptions, model};
use rungc_models::{Fit, Plc};
use rungc_syntax::{Diagnostics, Program, codes};
use std::borrow::Cow;
use std::io::{self, IsTerminal};
use std::path::Path;

/// Rewrites programs. Nothing is written of one that could not be read whole.
pub fn run(args: &ConvertArgs, cx: Context) -> Result {
    if args.body.is_some() && args.to != ConvertTo::Plcopen {
        let why = "`--body` chooses the language of `--to plcopen`; other forms have no choice";
        return Err(Failure::Because(why.to_owned()));
    }
    if args.to.is_of_sources() && args.inputs.reading.kind.compiled {
        let why = "`--compiled` reads the compiled program, and `--to st`, `labels` and `labels-csv` write sources";
        return Err(Failure::Because(why.to_owned()));
    }
    let mut outputs = OutputPaths::default();
    subject::each(&args.inputs, cx, |subject, reporter| {
        if args.to.is_of_sources() {
            return sources::convert(args, subject, reporter, &mut outputs, cx);
        }
        convert(args, subject, reporter, &mut outputs, cx)
    })
}

fn convert(
    args: &ConvertArgs,
    subject: &Subject,
    reporter: &mut Reporter,
    outputs: &mut OutputPaths,
    cx: Context,
) -> Result {
    let as_written = read_as_written(subject, reporter)?;
    let own = as_written.program.parameters.clone();
    let mut read = completed(as_written, subject, reporter)?;
    name_model(&mut read, subject);
    let mut diagnostics = read.diagnostics.clone();
    let body = args.body.unwrap_or_default();
    let bytes = written(args.to, body, &read, &subject.options(), &mut diagnostics);
    let findings = Findings::new(
        &subject.file,
        &read.program,
        diagnostics,
        &subject.reporting,
    );
    if findings.failed() {
        return conclude(&findings, reporter, cx, String::new);
    }
    reporter.add(&findings)?;
    let options = subject.options();
    for sentence in omitted::sentences(args.to, &read, own.as_ref(), &options, &bytes) {
        eprint_line(&format!("rungc: {sentence}"));
    }
    let name = || format!("{}.{}", stem(subject, &read), args.to.ending());
    let path = outputs.place(file(&args.output), reporter.many(), name, subject)?;
    deliver(args, path.as_deref(), &bytes)
}

/// Writes an output to its file, or to standard output.
fn deliver(args: &ConvertArgs, path: Option<&Path>, bytes: &[u8]) -> Result {
    match path {
        Some(path) => write_file(path, bytes, args.force)?,
        None if args.to.is_text() && io::stdout().is_terminal() => {
            print_text(&String::from_utf8_lossy(bytes))?;
        }
        None => print_bytes(bytes)?,
    }
    Ok(Outcome::Success)
}

/// Names the PLC that was chosen with `--model` or in rungc.toml as the CPU of a program that does not name it.
fn name_model(read: &mut Read, subject: &Subject) {
    let Some(model) = subject.model else {
        return;
    };
    let chosen = Plc {
        model,
        variant: subject.variant,
    };
    let named = read.program.cpu.as_deref().and_then(Plc::for_cpu);
    if named != Some((chosen, Fit::Same)) {
        let cpu = chosen.name().to_uppercase();
        if let Some(head) = &mut read.export_head {
            head.set_cpu(&cpu);
        }
        read.program.cpu = Some(cpu);
    }
}

/// A program with step numbers, as an export has them; numbers that its source has stay.
fn numbered<'p>(program: &'p Program, options: &CompileOptions) -> Cow<'p, Program> {
    if program.instrs.iter().any(|instr| instr.step.is_some()) || !program.is_complete() {
        return Cow::Borrowed(program);
    }
    let (resolved, _) = resolve(program, model(program, options));
    let steps: Vec<u32> = resolved.instrs.iter().map(|instr| instr.step).collect();
    let mut program = program.clone();
    for (instr, step) in program.instrs.iter_mut().zip(steps) {
        instr.step = Some(step);
    }
    Cow::Owned(program)
}

/// A program in an output form, for PLCopen XML in the language of `body`; why it cannot take this form is added to
/// the diagnostics.
pub fn written(
    to: ConvertTo,
    body: PlcopenBody,
    read: &Read,
    options: &CompileOptions,
    diagnostics: &mut Diagnostics,
) -> Vec<u8> {
    let program = &read.program;
    let text = match to {
        ConvertTo::Il | ConvertTo::Ladder | ConvertTo::Autoshop => print::broken_text(program),
        _ => None,
    };
    if let Some(text) = text {
        let diagnostic = codes::TEXT_BREAK
            .at(
                text.span,
                "this text has a line break, which a list cannot represent",
            )
            .help("`--to csv` keeps it");
        diagnostics.push(diagnostic);
    }
    match to {
        ConvertTo::Il => print::to_il(program).into_bytes(),
        ConvertTo::Ladder => to_ladder(program, model(program, options)).into_bytes(),
        ConvertTo::Csv => match &read.export_head {
            Some(head) => print::to_csv_with(program, head),
            None => print::to_csv(&numbered(program, options)),
        },
        ConvertTo::Comments => print::comments_to_csv(program),
        ConvertTo::Image if program.is_complete() => {
            let image =
                image::write(program).map_err(|unknown| diagnostics.extend(unknown.sorted()));
            image.unwrap_or_default()
        }
        ConvertTo::Autoshop if program.is_complete() => print::to_autoshop(program)
            .map_err(|refused| diagnostics.push(*refused))
            .unwrap_or_default()
            .into_bytes(),
        ConvertTo::Plcopen if program.is_complete() => {
            to_plcopen(program, model(program, options), body.into(), diagnostics).into_bytes()
        }
        // Unreadable parts have been reported.
        ConvertTo::Image | ConvertTo::Plcopen | ConvertTo::Autoshop => Vec::new(),
        // These are made of sources, not of a program.
        ConvertTo::St | ConvertTo::Labels | ConvertTo::LabelsCsv => Vec::new(),
    }
}
