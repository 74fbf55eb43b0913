//! Evidence of a comparison with an older program: each output is a property.

use super::{Basis, begun, certificates, gaps, program_files, reason, run};
use crate::commands::subject::Subject;
use crate::commands::verify::export::{Written, WrittenFile};
use crate::commands::verify::same::named;
use crate::commands::{Failure, verify::same};
use rungc_evidence::{Evidence, Method, Verified};
use rungc_frontend::Read;
use rungc_sim::Target;
use rungc_sim::property::{Condition, Property};
use rungc_verify::prove::{Verdict, Why};
use rungc_verify::same::{Compared, Output};

/// The older program, and what came of the comparison with it.
pub struct Comparison<'a> {
    pub older: &'a Subject,
    pub read: &'a Read,
    pub compared: &'a Compared,
    /// Files of all proofs.
    pub certificate: &'a Written,
}

/// The evidence; with pictures and date if it is for a report.
pub fn gather(basis: &Basis, comparison: &Comparison) -> Result<Evidence, Failure> {
    let mut evidence = begun(basis)?;
    let older = program_files("older program", comparison.older, comparison.read)?;
    evidence.subject.files.extend(older);
    evidence
        .assumptions
        .extend(same::assumptions(comparison.compared));
    let outputs = comparison.compared.outputs.iter();
    let verified = outputs.map(|output| verified(basis, comparison, output));
    evidence.properties = verified.collect();
    Ok(evidence)
}

fn verified(basis: &Basis, comparison: &Comparison, output: &Output) -> Verified {
    let name = named(output).to_string();
    let older = comparison.older.file.display();
    let target = Target::parse(&name).ok();
    let shown = match (&output.verdict, target) {
        (Verdict::Found(trace), Some(target)) => {
            let property = Property::Never(Condition::On(target));
            Some(run::run(basis, &property, trace))
        }
        _ => None,
    };
    // The run is the newer program's.
    let difference = match &output.verdict {
        Verdict::Found(trace) => {
            let other = i32::from(!same::is_on(output, trace, basis.module));
            Some(format!("{name} = {other} in {older}"))
        }
        Verdict::Proved | Verdict::Undecided(_) => None,
    };
    Verified {
        requirement: None,
        property: format!("{name} is the same as in {older}"),
        verdict: match &output.verdict {
            Verdict::Proved => "the same",
            Verdict::Found(_) => "differs",
            Verdict::Undecided(Why::Vacuous { .. }) => "vacuous",
            Verdict::Undecided(_) => "not decided",
        },
        holds: match &output.verdict {
            Verdict::Proved => Some(true),
            Verdict::Found(_) => Some(false),
            Verdict::Undecided(_) => None,
        },
        reason: difference.or_else(|| reason(&output.verdict)),
        method: method(output),
        gaps: gaps(&output.gaps),
        inputs: Vec::new(),
        run: shown,
        certificate: match output.verdict {
            Verdict::Proved => certificates(own(comparison, &name)),
            Verdict::Found(_) | Verdict::Undecided(_) => Vec::new(),
        },
    }
}

/// Grounds of the verdict on an output.
pub fn method(output: &Output) -> Method {
    let bits = output.proof.as_ref();
    let bits = bits.map_or(0, |proof| proof.system.latches.len());
    match (&output.verdict, &output.proof) {
        (Verdict::Proved, None) => Method::Common,
        (verdict, proof) => super::method(verdict, proof.as_ref(), bits),
    }
}

/// Files that prove that an output is the same: those of all memory in common, and its own.
fn own<'a>(comparison: &Comparison<'a>, name: &str) -> impl Iterator<Item = &'a WrittenFile> {
    let prefix = format!("{name}-");
    let files = comparison.certificate.iter();
    files.filter(move |(path, ..)| {
        let file = path.file_name().unwrap_or_default().to_string_lossy();
        file.starts_with("memory.") || file.starts_with(&prefix)
    })
}
