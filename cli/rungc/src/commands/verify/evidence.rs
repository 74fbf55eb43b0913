//! Evidence of what was decided, for reports and for documents of verdicts.

mod run;
mod tests;

use super::export::{Written, slashed};
use super::report;
use crate::args::VerifyArgs;
use crate::commands::properties::{ExternalWrites, RequestedProperty};
use crate::commands::subject::{Subject, near};
use crate::commands::{Context, Failure, view};
use crate::output::{Kind, at, permit, write_file};
use crate::report::to_json;
use rungc_evidence::{
    Certificate, Evidence, File, Gap, Inputs, Method, Requirement, Setting, VERSION, Verified,
    document, of_list, page, sha256,
};
use rungc_frontend::Read;
use rungc_host::io::timestamp;
use rungc_ir::Module;
use rungc_project::{Project, Range};
use rungc_syntax::inputs;
use rungc_verify::proof;
use rungc_verify::prove::{Options, Verdict, Why};
use std::path::Path;
use std::time::{Duration, UNIX_EPOCH};

/// All that evidence is made of.
pub struct Grounds<'a> {
    pub args: &'a VerifyArgs,
    pub subject: &'a Subject,
    pub read: &'a Read,
    pub module: &'a Module,
    pub requested: &'a [RequestedProperty],
    pub results: &'a [report::Result<'a>],
    pub options: &'a Options,
    pub assumed: &'a [String],
    pub external: &'a ExternalWrites,
    /// Engines that have shown the runs.
    pub engines: &'a [&'static str],
    /// Files of each proof.
    pub certificates: &'a [Written],
}

/// Kind of a report, by the ending of its name.
///
/// # Errors
///
/// The ending is another one.
fn kind(path: &Path) -> Result<Kind, Failure> {
    let ending = path.extension().and_then(|ending| ending.to_str());
    match ending {
        Some("html") => Ok(Kind::Html),
        Some("pdf") => Ok(Kind::Pdf),
        Some("json") => Ok(Kind::Report),
        _ => {
            let why = "--report: name a file that ends in .html, .pdf or .json";
            Err(Failure::Because(why.to_string()))
        }
    }
}

/// Checks before long work that the report can be written.
pub fn check(args: &VerifyArgs) -> Result<(), Failure> {
    match &args.report {
        Some(path) => permit(path, kind(path)?, args.force),
        None => Ok(()),
    }
}

/// Writes the report, if one is requested.
pub fn write(args: &VerifyArgs, evidence: &Evidence, cx: Context) -> Result<(), Failure> {
    let Some(path) = &args.report else {
        return Ok(());
    };
    let bytes = match kind(path)? {
        Kind::Html => page::page(evidence).into_bytes(),
        Kind::Pdf => document::document(evidence),
        _ => to_json(evidence)?.into_bytes(),
    };
    write_file(path, &bytes, args.force)?;
    let missing = &evidence.missing;
    missing
        .iter()
        .for_each(|line| cx.note(&format!("     Missing {line}")));
    cx.note(&format!("       Wrote {}", path.display()));
    Ok(())
}

/// The evidence; with tests, pictures and date if it is for a report.
pub fn gather(grounds: &Grounds, cx: Context) -> Result<Evidence, Failure> {
    let is_report = grounds.args.report.is_some();
    let mut evidence = Evidence {
        report: "rungc verify",
        version: VERSION,
        rungc: env!("CARGO_PKG_VERSION").to_string(),
        date: None,
        subject: subject(grounds)?,
        settings: settings(grounds),
        assumptions: report::assumptions(&grounds.options.world, grounds.assumed, grounds.external),
        requirements: requirements(grounds.subject.own_project()),
        properties: verified(grounds),
        tests: None,
        missing: Vec::new(),
    };
    if is_report {
        evidence.date = date()?;
        tests::add(grounds, &mut evidence, cx)?;
    }
    Ok(evidence)
}

/// The date of SOURCE_DATE_EPOCH, which builds that can be repeated set: seconds since 1970.
fn date() -> Result<Option<String>, Failure> {
    const NAME: &str = "SOURCE_DATE_EPOCH";
    let Some(value) = std::env::var_os(NAME) else {
        return Ok(None);
    };
    /// End of the year 9999.
    const LAST: u64 = 253_402_300_799;
    let seconds = value.to_str().and_then(|text| text.parse().ok());
    match seconds.filter(|seconds| *seconds <= LAST) {
        Some(seconds) => Ok(Some(timestamp(UNIX_EPOCH + Duration::from_secs(seconds)))),
        None => Err(Failure::Because(format!(
            "{NAME} must be a number of seconds since 1970, at most until the year 9999"
        ))),
    }
}

fn subject(grounds: &Grounds) -> Result<rungc_evidence::Subject, Failure> {
    let (subject, read, model) = (grounds.subject, grounds.read, grounds.module.model);
    let project = subject.project.as_ref().map(|project| project.path.clone());
    let is_same = |a: &Path, b: &Path| same_file::is_same_file(a, b).unwrap_or(false);
    let mut files = Vec::new();
    if subject.is_stdin() {
        files.push(File {
            role: "program",
            file: "-".to_string(),
            sha256: sha256(read.program.source.text.as_bytes()),
        });
    }
    for path in inputs::all() {
        let is_settings = project.as_deref().is_some_and(|of| is_same(of, &path));
        if path.starts_with(&subject.file) && path.is_file() && !is_settings {
            files.push(file("program", &path)?);
        }
    }
    let program = of_list(&files);
    if let Some(path) = project {
        files.push(file("settings", &near(path))?);
    }
    Ok(rungc_evidence::Subject {
        title: view::title(subject, read),
        file: slashed(&subject.file),
        model: subject
            .variant
            .map_or(model.name, |variant| variant.name)
            .to_string(),
        plc: model.title.to_string(),
        sha256: program,
        files,
    })
}

/// A file with its hash.
fn file(role: &'static str, path: &Path) -> Result<File, Failure> {
    let bytes = std::fs::read(path).map_err(|error| at(path, error))?;
    Ok(File {
        role,
        file: slashed(path),
        sha256: sha256(&bytes),
    })
}

fn settings(grounds: &Grounds) -> Vec<Setting> {
    let options = grounds.options;
    let mut settings = vec![
        Setting {
            name: "Longest time between scans",
            value: format!("{} ms", options.world.scan_ms),
        },
        Setting {
            name: "Latched devices at power-on",
            value: match options.world.fresh {
                true => "0".to_string(),
                false => "any value".to_string(),
            },
        },
        Setting {
            name: "Effort per property",
            value: match options.effort {
                u64::MAX => "no limit".to_string(),
                effort => effort.to_string(),
            },
        },
    ];
    let mut add = |name, values: Vec<String>| {
        if !values.is_empty() {
            let value = values.join(", ");
            settings.push(Setting { name, value });
        }
    };
    if let Some(time) = options.time {
        add(
            "Time limit per property",
            vec![format!("{} s", time.as_secs_f64())],
        );
    }
    for by in grounds.external.sources() {
        let devices = grounds.external.devices.iter();
        let own = devices.filter(|(_, named)| **named == by);
        let names = own.map(|((class, number), _)| class.number(*number).to_string());
        add(
            "Written from outside",
            vec![format!("{by}: {}", names.collect::<Vec<_>>().join(", "))],
        );
    }
    let subject = grounds.subject;
    let warn = &subject.options().warn;
    add(
        "Errors taken as warnings",
        warn.iter().map(ToString::to_string).collect(),
    );
    if let Some(project) = subject.own_project() {
        add(
            "Latched ranges",
            project.latched.iter().map(range).collect(),
        );
        let bounds = project.index.iter();
        let bounds = bounds.map(|bound| {
            let [base, first, last] =
                [bound.number, bound.first, bound.last].map(|number| bound.class.number(number));
            format!("{base}{} = {first}-{last}", bound.index)
        });
        add("Bounds of indexed operands", bounds.collect());
    }
    settings
}

/// Devices of a range, as settings name them.
fn range(range: &Range) -> String {
    let [first, last] = [range.first, range.last].map(|number| range.class.number(number));
    format!("{first}-{last}")
}

fn requirements(project: Option<&Project>) -> Vec<Requirement> {
    let Some(project) = project else {
        return Vec::new();
    };
    let requirements = project.requirements.iter();
    let own = |id: &str| {
        let rows = project.properties.iter().map(|row| &row.requirement);
        let uses = project.uses.iter().map(|row| &row.requirement);
        let own = rows.chain(uses).filter(|of| of.as_deref() == Some(id));
        own.count()
    };
    requirements
        .map(|requirement| Requirement {
            id: requirement.id.clone(),
            text: requirement.text.clone(),
            source: requirement.source.clone(),
            properties: own(&requirement.id),
            tests: None,
            coverage: None,
            mutants: None,
        })
        .collect()
}

fn verified(grounds: &Grounds) -> Vec<Verified> {
    let drawn = grounds.args.report.is_some();
    let pairs = grounds.requested.iter().zip(grounds.results);
    let pairs = pairs.zip(grounds.certificates);
    pairs
        .map(|((requested, result), written)| {
            let decision = result.decision;
            let gaps = decision.gaps.iter().map(|gap| Gap {
                what: gap.what.clone(),
                step: gap.step,
                is_instruction: gap.is_instruction,
            });
            let reason = match &decision.verdict {
                Verdict::Undecided(why) => Some(report::reason(why)),
                Verdict::Proved | Verdict::Found(_) => None,
            };
            let run = match &decision.verdict {
                Verdict::Found(trace) => Some(run::run(grounds, result.property, trace, drawn)),
                Verdict::Proved | Verdict::Undecided(_) => None,
            };
            Verified {
                requirement: requested.requirement.clone(),
                property: requested.text.clone(),
                verdict: result.word(),
                holds: match (&decision.verdict, result.property.is_wanted()) {
                    (Verdict::Undecided(_), _) => None,
                    (Verdict::Proved, wanted) => Some(!wanted),
                    (Verdict::Found(_), wanted) => Some(wanted),
                },
                reason,
                method: method(decision),
                gaps: gaps.collect(),
                inputs: devices(result, grounds.module),
                run,
                certificate: certificate(written),
            }
        })
        .collect()
}

fn method(decision: &rungc_verify::prove::Decision) -> Method {
    let bits = decision.latches;
    match (&decision.verdict, &decision.proof) {
        (Verdict::Proved, Some(proof)) => match &proof.method {
            proof::Method::Induction(scans) => Method::Induction {
                scans: *scans,
                bits,
            },
            proof::Method::Invariant(cubes) => Method::Invariant {
                clauses: cubes.len(),
                bits,
            },
        },
        (Verdict::Found(_), _) => Method::Run,
        (Verdict::Undecided(Why::Time { scans } | Why::Effort { scans, .. }), _) => {
            Method::Bounded { scans: *scans }
        }
        (Verdict::Proved | Verdict::Undecided(_), _) => Method::None,
    }
}

/// Devices that a property depends on and that count as inputs.
fn devices(result: &report::Result, module: &Module) -> Vec<Inputs> {
    let unwritten = report::names(&result.decision.unwritten);
    let unwritten = (!unwritten.is_empty()).then_some(Inputs {
        named_by: None,
        devices: unwritten,
    });
    let outside = result.outside(module).into_iter();
    let outside = outside.map(|(by, keys)| Inputs {
        named_by: Some(by),
        devices: report::names(&keys),
    });
    unwritten.into_iter().chain(outside).collect()
}

fn certificate(written: &Written) -> Vec<Certificate> {
    let files = written.iter().map(|(path, bytes, check)| Certificate {
        file: slashed(path),
        sha256: sha256(bytes),
        check: check.clone(),
    });
    files.collect()
}
