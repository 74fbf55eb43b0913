//! `--same-as`: two programs.

use super::engines::{self, Shown};
use super::{export, report};
use crate::args::{Input, VerifyArgs};
use crate::commands::check::deep::writes;
use crate::commands::properties::{Reader, module};
use crate::commands::subject::{self, Subject};
use crate::commands::{Context, Failure, Outcome, Result, counted, read};
use crate::report::junit::{Case, Problem, Properties};
use crate::report::{Findings, Reporter};
use rungc_frontend::Read;
use rungc_ir::Module;
use rungc_sim::Target;
use rungc_sim::property::{Condition, Property, Reading};
use rungc_syntax::codes::{self, Code};
use rungc_syntax::{Device, DeviceClass, Diagnostics};
use rungc_verify::certificate;
use rungc_verify::prove::{Options, Verdict};
use rungc_verify::same::{Compared, Output, compare};
use rungc_verify::search::Trace;
use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::Path;

/// Compares a program with an older one.
pub fn run(args: &VerifyArgs, old: &Path, cx: Context) -> Result {
    let subject = subject::one(&args.input, cx)?;
    let before = subject::one(&input_of(args, old), cx)?;
    let mut reporter = Reporter::new(&subject.reporting, cx, false);
    let both = read(&before, &mut reporter)
        .and_then(|old| read(&subject, &mut reporter).map(|new| (old, new)));
    let (read_old, read_new) = match both {
        Ok(both) => both,
        Err(failure) => return super::unread(args, failure, reporter, cx),
    };
    let reader = Reader {
        args: &args.properties,
        subject: &subject,
        program: &read_new.program,
        cx,
    };
    let assumed = reader.assumed()?;
    let external = reader.external()?;
    if let Some((text, _)) = assumed.iter().find(|(_, a)| a.has_memory()) {
        return Err(Failure::Because(format!(
            "--same-as assumes of a scan what its devices are then, and `{text}` depends on earlier scans"
        )));
    }
    let options = super::options(args, &reader, &assumed, &external)?;
    let looked = || options.assumed.iter();
    let old_module = module(&before, &read_old, looked(), &external, &mut reporter)?;
    let new_module = module(&subject, &read_new, looked(), &external, &mut reporter)?;
    let (Some(old_module), Some(new_module)) = (old_module, new_module) else {
        super::deliver(args, reporter, String::new, super::UNUSABLE, cx)?;
        return Ok(Outcome::Unusable);
    };
    if old_module.model.name != new_module.model.name {
        let models = [&old_module, &new_module].map(|module| module.model.name.to_uppercase());
        let why = format!(
            "the programs are for different models: {} and {}",
            models[0], models[1]
        );
        return Err(Failure::Because(why));
    }
    export::can_prove(args)?;
    let modules = [old_module, new_module];
    let mut compared = compare(&modules[0], &modules[1], &options);
    let assumed: Vec<String> = assumed.into_iter().map(|(text, _)| text).collect();
    withdraw(&mut compared, &modules, &options, &assumed);
    let proved = compared.outputs.iter().any(is_same);
    let proofs = proved.then(|| certificate::of_comparison(&compared));
    let time = super::solver_time(&options);
    export::proofs(args, vec![(None, proofs)], time, cx)?;
    let names = [&before, &subject].map(|subject| subject.file.display().to_string());
    let shown = shown(&compared);
    for (number, why) in engines::replay(args.replay, &modules, &shown, cx)?.differing {
        compared.outputs[number].verdict = Verdict::Undecided(why);
    }
    let outputs = compared.outputs.iter();
    let file = subject.file.display().to_string();
    let cases = outputs
        .clone()
        .map(|output| case(output, &file, &names, &modules[1]));
    publish(
        &subject,
        &read_new,
        &compared,
        cases.collect(),
        &mut reporter,
    )?;
    let supposed = report::assumptions(&options.world, &assumed, &external);
    let text = || text(&compared, &names, &modules[1], &supposed);
    let outcomes = outputs.map(|output| outcome(&output.verdict));
    let same = outcomes.clone().filter(|one| *one == Outcome::Success);
    let summary = format!(
        "{} of {} outputs are the same",
        same.count(),
        compared.outputs.len()
    );
    super::deliver(args, reporter, text, &summary, cx)?;
    Ok(outcomes.max().unwrap_or(Outcome::Success))
}

/// The older program, which is read as the newer one.
fn input_of(args: &VerifyArgs, old: &Path) -> Input {
    Input {
        file: Some(old.to_owned()),
        reading: args.input.reading.clone(),
    }
}

fn is_same(output: &Output) -> bool {
    output.verdict == Verdict::Proved
}

/// Takes proofs back if one of the programs contradicts an assumption.
fn withdraw(compared: &mut Compared, modules: &[Module; 2], options: &Options, assumed: &[String]) {
    if let Some(why) = super::vacuous(modules, options, assumed) {
        for output in compared.outputs.iter_mut().filter(|output| is_same(output)) {
            output.proof = None;
            output.verdict = Verdict::Undecided(why.clone());
        }
    }
}

/// The runs in which outputs differ, of either program.
fn shown(compared: &Compared) -> Vec<Shown<'_>> {
    let outputs = compared.outputs.iter().enumerate();
    let found = outputs.filter_map(|(what, output)| {
        let Verdict::Found(trace) = &output.verdict else {
            return None;
        };
        Some([0, 1].map(|program| Shown {
            what,
            program,
            devices: vec![(DeviceClass::Y, output.number)],
            trace,
        }))
    });
    found.flatten().collect()
}

fn outcome(verdict: &Verdict) -> Outcome {
    match verdict {
        Verdict::Proved => Outcome::Success,
        Verdict::Undecided(_) => Outcome::Undecided,
        Verdict::Found(_) => Outcome::Failed,
    }
}

fn named(output: &Output) -> Device {
    Device {
        class: DeviceClass::Y,
        number: output.number,
    }
}

/// Reports outputs that differ, or may, as diagnostics where they are written.
fn publish(
    subject: &Subject,
    read: &Read,
    compared: &Compared,
    cases: Vec<Case>,
    reporter: &mut Reporter,
) -> std::result::Result<(), Failure> {
    let mut diagnostics = Diagnostics::new();
    let model = rungc_lower::compile::model(&read.program, &subject.options());
    for output in &compared.outputs {
        let name = named(output);
        let Some((code, text)) = finding(output) else {
            continue;
        };
        let mut written = read
            .program
            .instrs
            .iter()
            .filter(|instr| writes(instr, name, model));
        let span = written.next().map(|instr| instr.span);
        let mut diagnostic = code.at(span.unwrap_or_default(), text);
        if span.is_some() {
            diagnostic.label = format!("`{name}` is written here").into();
        }
        diagnostics.push(diagnostic);
    }
    let findings = Findings::new(
        &subject.file,
        &read.program,
        diagnostics,
        &subject.reporting,
    );
    Ok(reporter.add_verdicts(&findings, cases)?)
}

/// Diagnostic for a verdict.
fn finding(output: &Output) -> Option<(&'static Code, String)> {
    let name = named(output);
    match &output.verdict {
        Verdict::Proved => None,
        Verdict::Found(trace) => {
            let scans = counted(trace.scans.len(), "scan");
            let text = format!("`{name}` can differ from the older program, after {scans}");
            Some((&codes::OUTPUTS_DIFFER, text))
        }
        Verdict::Undecided(why) => {
            let reason = report::reason(why);
            let text = format!("`{name}` may differ from the older program: {reason}");
            Some((&codes::SAMENESS_UNDECIDED, text))
        }
    }
}

/// An output as a case of a test report.
fn case(output: &Output, file: &str, names: &[String; 2], module: &Module) -> Case {
    let name = named(output).to_string();
    let problem = finding(output).map(|(code, message)| {
        let mut text = format!("{message}\n");
        if let Verdict::Found(trace) = &output.verdict {
            difference(&mut text, &name, trace, names, module);
        }
        report::gaps(&mut text, &output.gaps);
        Problem {
            is_error: matches!(output.verdict, Verdict::Undecided(_)),
            kind: code.name,
            text: text.trim_end().to_string(),
            message,
        }
    });
    Case {
        name: format!("{name} is the same"),
        class: file.to_string(),
        time: output.time,
        properties: Properties::new(),
        problem,
    }
}

/// The answer in words.
fn text(compared: &Compared, names: &[String; 2], module: &Module, supposed: &[String]) -> String {
    let mut text = String::new();
    let same: Vec<String> = compared
        .outputs
        .iter()
        .filter(|output| output.verdict == Verdict::Proved)
        .map(|output| named(output).to_string())
        .collect();
    if !same.is_empty() {
        let list = same.join(", ");
        let all = if same.len() == compared.outputs.len() {
            "all outputs: "
        } else {
            ""
        };
        let _ = writeln!(text, "the same    {all}{list}");
    }
    for output in &compared.outputs {
        let (name, seconds) = (named(output), output.time.as_secs_f64());
        match &output.verdict {
            Verdict::Proved => continue,
            Verdict::Found(trace) => {
                let _ = writeln!(text, "differs     {name} ({seconds:.2} s)");
                difference(&mut text, &name.to_string(), trace, names, module);
            }
            Verdict::Undecided(why) => {
                let _ = writeln!(text, "not decided {name} ({seconds:.2} s)");
                let _ = writeln!(text, "            {}", report::reason(why));
            }
        }
        report::gaps(&mut text, &output.gaps);
    }
    if !compared.latched_apart.is_empty() {
        let list = report::devices(&compared.latched_apart);
        let _ = writeln!(text, "latched in one of the programs only: {list}");
    }
    if !compared.same_environment {
        let _ = writeln!(
            text,
            "not compared: what the programs send to modules, serial ports and pulse outputs"
        );
    }
    if !same.is_empty() {
        let _ = writeln!(text, "Proved for this model under these assumptions:");
        for line in supposed {
            let _ = writeln!(text, "  - {line}");
        }
        let _ = writeln!(
            text,
            "  - both begin with the same in latched devices of both, and are not switched off and on again"
        );
        let calls: BTreeSet<&str> = compared
            .functions
            .iter()
            .map(|gap| gap.what.as_str())
            .collect();
        if !calls.is_empty() {
            let list = Vec::from_iter(calls).join(", ");
            let _ = writeln!(
                text,
                "  - from the same values this makes the same in both programs: {list}"
            );
        }
    }
    text
}

/// The run in which an output differs, and what it is then in either program.
fn difference(
    text: &mut String,
    name: &str,
    trace: &Trace,
    [old, new]: &[String; 2],
    module: &Module,
) {
    let Ok(target) = Target::parse(name) else {
        return;
    };
    let property = Property::Never(Condition::On(target));
    let story = rungc_verify::replay::story(module, &property, trace);
    let on = story.last().is_some_and(|last| {
        last.after
            .iter()
            .any(|(.., value)| *value != Reading::Integer(0))
    });
    report::write_story(text, module, &story);
    let other = i32::from(!on);
    let _ = writeln!(text, "            {:<26}  in {new}; {other} in {old}", "");
}
