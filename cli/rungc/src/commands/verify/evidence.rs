//! Evidence of what was decided, for reports and for documents of verdicts.

mod run;
pub mod same;
mod tests;

use super::export::{Written, WrittenFile, slashed};
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
use rungc_verify::prove::{Options, Verdict, Why};
use rungc_verify::{model, proof};
use std::path::Path;
use std::time::{Duration, UNIX_EPOCH};

/// What all verdicts about a program rest on.
#[derive(Clone, Copy)]
pub struct Basis<'a> {
    pub args: &'a VerifyArgs,
    pub subject: &'a Subject,
    pub read: &'a Read,
    pub module: &'a Module,
    pub options: &'a Options,
    pub assumed: &'a [String],
    pub external: &'a ExternalWrites,
    /// Engines that have shown the runs.
    pub engines: &'a [&'static str],
}

/// All that evidence is made of.
pub struct Grounds<'a> {
    pub basis: Basis<'a>,
    pub requested: &'a [RequestedProperty],
    pub results: &'a [report::Result<'a>],
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
    let basis = grounds.basis;
    let mut evidence = Evidence {
        requirements: requirements(basis.subject.own_project()),
        properties: verified(grounds),
        ..begun(&basis)?
    };
    if basis.args.report.is_some() {
        tests::add(grounds, &mut evidence, cx)?;
    }
    Ok(evidence)
}

/// Evidence before any verdict; with its date if it is for a report.
fn begun(basis: &Basis) -> Result<Evidence, Failure> {
    Ok(Evidence {
        report: "rungc verify",
        version: VERSION,
        rungc: env!("CARGO_PKG_VERSION").to_string(),
        date: match basis.args.report {
            Some(_) => date()?,
            None => None,
        },
        subject: subject(basis)?,
        settings: settings(basis),
        assumptions: report::assumptions(&basis.options.world, basis.assumed, basis.external),
        requirements: Vec::new(),
        properties: Vec::new(),
        tests: None,
        missing: Vec::new(),
    })
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

fn subject(basis: &Basis) -> Result<rungc_evidence::Subject, Failure> {
    let (subject, read, model) = (basis.subject, basis.read, basis.module.model);
    let mut files = program_files("program", subject, read)?;
    let program = of_list(&files);
    if let Some(path) = subject.project.as_ref().map(|project| project.path.clone()) {
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

/// The files of a program, each with the part that it has.
fn program_files(role: &'static str, subject: &Subject, read: &Read) -> Result<Vec<File>, Failure> {
    let project = subject.project.as_ref().map(|project| project.path.clone());
    let is_same = |a: &Path, b: &Path| same_file::is_same_file(a, b).unwrap_or(false);
    let mut files = Vec::new();
    if subject.is_stdin() {
        files.push(File {
            role,
            file: "-".to_string(),
            sha256: sha256(read.program.source.text.as_bytes()),
        });
    }
    for path in inputs::all() {
        let is_settings = project.as_deref().is_some_and(|of| is_same(of, &path));
        if path.starts_with(&subject.file) && path.is_file() && !is_settings {
            files.push(file(role, &path)?);
        }
    }
    Ok(files)
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

fn settings(basis: &Basis) -> Vec<Setting> {
    let options = basis.options;
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
    for by in basis.external.sources() {
        let devices = basis.external.devices.iter();
        let own = devices.filter(|(_, named)| **named == by);
        let names = own.map(|((class, number), _)| class.number(*number).to_string());
        add(
            "Written from outside",
            vec![format!("{by}: {}", names.collect::<Vec<_>>().join(", "))],
        );
    }
    let subject = basis.subject;
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
    let basis = grounds.basis;
    let pairs = grounds.requested.iter().zip(grounds.results);
    let pairs = pairs.zip(grounds.certificates);
    pairs
        .map(|((requested, result), written)| {
            let decision = result.decision;
            let run = match &decision.verdict {
                Verdict::Found(trace) => Some(run::run(&basis, result.property, trace)),
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
                reason: reason(&decision.verdict),
                method: method(&decision.verdict, decision.proof.as_ref(), decision.latches),
                gaps: gaps(&decision.gaps),
                inputs: devices(result, basis.module),
                run,
                certificate: certificates(written.iter()),
            }
        })
        .collect()
}

/// Reason why something is not decided.
fn reason(verdict: &Verdict) -> Option<String> {
    match verdict {
        Verdict::Undecided(why) => Some(report::reason(why)),
        Verdict::Proved | Verdict::Found(_) => None,
    }
}

/// Parts that the model leaves open.
pub fn gaps(gaps: &[model::Gap]) -> Vec<Gap> {
    let gaps = gaps.iter().map(|gap| Gap {
        what: gap.what.clone(),
        step: gap.step,
        is_instruction: gap.is_instruction,
    });
    gaps.collect()
}

/// Grounds of a verdict on what depends on this many bits of memory.
fn method(verdict: &Verdict, proof: Option<&proof::Proof>, bits: usize) -> Method {
    match (verdict, proof) {
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

/// Files of a proof.
fn certificates<'w>(written: impl Iterator<Item = &'w WrittenFile>) -> Vec<Certificate> {
    let files = written.map(|(path, bytes, check)| Certificate {
        file: slashed(path),
        sha256: sha256(bytes),
        check: check.clone(),
    });
    files.collect()
}
