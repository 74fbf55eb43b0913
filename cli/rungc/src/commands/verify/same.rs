//! `--same-as`: two programs.

use super::engines::{self, Shown};
use super::evidence::same::Comparison;
use super::evidence::{self, Basis};
use super::{export, report};
use crate::args::{Input, VerifyArgs};
use crate::commands::properties::{Reader, at_writes, module};
use crate::commands::subject;
use crate::commands::{Context, Failure, Outcome, Result, counted, read};
use crate::report::junit::{self, Case, Problem, Properties, properties};
use crate::report::{Findings, Reporter};
use rungc_evidence::Evidence;
use rungc_ir::Module;
use rungc_sim::Target;
use rungc_sim::property::{Condition, Property, Reading};
use rungc_syntax::codes::{self, Code};
use rungc_syntax::{Device, DeviceClass, Diagnostics, Span};
use rungc_verify::certificate;
use rungc_verify::prove::{Options, Verdict};
use rungc_verify::replay::Change;
use rungc_verify::same::{Compared, Output, compare};
use rungc_verify::search::Trace;
use rungc_verify::words::vacuous;
use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::Path;

/// Compares a program with an older one.
pub fn run(args: &VerifyArgs, old: &Path, cx: Context) -> Result {
    evidence::check(args)?;
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
    check_models([&old_module, &new_module])?;
    export::can_prove(args)?;
    let modules = [old_module, new_module];
    let mut compared = compare(&modules[0], &modules[1], &options);
    let assumed: Vec<String> = assumed.into_iter().map(|(text, _)| text).collect();
    withdraw(&mut compared, &modules, &options, &assumed);
    let proved = compared.outputs.iter().any(is_same);
    let proofs = proved.then(|| certificate::of_comparison(&compared));
    let time = super::solver_time(&options);
    let certificates = export::proofs(args, vec![(None, proofs)], time, cx)?;
    let names = [&before, &subject].map(|subject| subject.file.display().to_string());
    let shown = shown(&compared);
    let replayed = engines::replay(args.replay, &modules, &shown, cx)?;
    for (number, why) in replayed.differing {
        compared.outputs[number].verdict = Verdict::Undecided(why);
    }
    let basis = Basis {
        args,
        subject: &subject,
        read: &read_new,
        module: &modules[1],
        options: &options,
        assumed: &assumed,
        external: &external,
        engines: &replayed.engines,
    };
    let comparison = Comparison {
        older: &before,
        read: &read_old,
        compared: &compared,
        certificate: &certificates.concat(),
    };
    let evidence = evidence::same::gather(&basis, &comparison)?;
    evidence::write(args, &evidence, cx)?;
    publish(&basis, &comparison, &names, evidence, &mut reporter)?;
    let outputs = compared.outputs.iter();
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

/// Rejects programs for different models.
fn check_models(modules: [&Module; 2]) -> std::result::Result<(), Failure> {
    let [old, new] = modules.map(|module| module.model.name);
    if old == new {
        return Ok(());
    }
    Err(Failure::Because(format!(
        "the programs are for different models: {} and {}",
        old.to_uppercase(),
        new.to_uppercase()
    )))
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
    if let Some(why) = vacuous(modules, options, assumed) {
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

/// The output's name.
pub fn named(output: &Output) -> Device {
    Device {
        class: DeviceClass::Y,
        number: output.number,
    }
}

/// Reports outputs that differ, or may, as diagnostics where they are written.
fn publish(
    basis: &Basis,
    comparison: &Comparison,
    names: &[String; 2],
    evidence: Evidence,
    reporter: &mut Reporter,
) -> std::result::Result<(), Failure> {
    let (subject, program) = (basis.subject, &basis.read.program);
    let outputs = &comparison.compared.outputs;
    let mut diagnostics = Diagnostics::new();
    let model = rungc_lower::compile::model(program, &subject.options());
    for output in outputs {
        let Some((code, text)) = finding(output) else {
            continue;
        };
        let devices = [(DeviceClass::Y, output.number)];
        let diagnostic = code.at(Span::default(), text);
        diagnostics.push(at_writes(diagnostic, &devices, basis.read, model));
    }
    let mut findings = Findings::new(&subject.file, program, diagnostics, &subject.reporting);
    let file = rungc::location::named(&subject.file);
    let cases = outputs.iter().zip(&evidence.properties);
    let cases = cases.map(|(output, verified)| Case {
        properties: properties(verified),
        ..case(output, &file, names, basis.module)
    });
    let cases = cases.collect();
    findings.verification = Some(evidence);
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
            difference(&mut text, output, trace, names, module);
        }
        report::gaps(&mut text, &output.gaps);
        Problem {
            result: match output.verdict {
                Verdict::Undecided(_) => junit::Result::Error,
                _ => junit::Result::Failed,
            },
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
                difference(&mut text, output, trace, names, module);
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
        for line in supposed.iter().chain(&assumptions(compared)) {
            let _ = writeln!(text, "  - {line}");
        }
    }
    text
}

/// Assumptions of every comparison, in addition to those of proofs.
pub fn assumptions(compared: &Compared) -> Vec<String> {
    let mut lines = vec![
        "both begin with the same in latched devices of both, and are not switched off and on again"
            .to_string(),
    ];
    let functions = compared.functions.iter();
    let calls: BTreeSet<&str> = functions.map(|gap| gap.what.as_str()).collect();
    if !calls.is_empty() {
        let list = Vec::from_iter(calls).join(", ");
        lines.push(format!(
            "from the same values this makes the same in both programs: {list}"
        ));
    }
    lines
}

/// Returns true if an output is on at the end of a run of a program.
pub fn is_on(output: &Output, trace: &Trace, module: &Module) -> bool {
    let story = story(output, trace, module);
    let end = story.last().map_or(&[][..], |last| &last.after);
    end.iter().any(|(.., value)| *value != Reading::Integer(0))
}

/// A run in which an output differs.
fn story(output: &Output, trace: &Trace, module: &Module) -> Vec<Change> {
    let Ok(target) = Target::parse(&named(output).to_string()) else {
        return Vec::new();
    };
    let property = Property::Never(Condition::On(target));
    rungc_verify::replay::story(module, &property, trace)
}

/// The run in which an output differs, and what it is then in either program.
fn difference(
    text: &mut String,
    output: &Output,
    trace: &Trace,
    [old, new]: &[String; 2],
    module: &Module,
) {
    report::write_story(text, module, &story(output, trace, module));
    let other = i32::from(!is_on(output, trace, module));
    let _ = writeln!(text, "            {:<26}  in {new}; {other} in {old}", "");
}
