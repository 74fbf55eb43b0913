//! The matrix of requirements and what shows that they are met: proofs, tests, mutants.

use crate::words::share;
use crate::{Evidence, Passed, Requirement, Share};
use std::collections::BTreeMap;

/// Judgement of a cell.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Tone {
    /// It speaks for the program.
    Good,
    /// It speaks against it.
    Bad,
    /// It says nothing, or not enough.
    Open,
}

/// Cell of the matrix.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Cell {
    /// Text.
    pub text: String,
    /// Judgement.
    pub tone: Tone,
}

fn cell(text: impl Into<String>, tone: Tone) -> Cell {
    let text = text.into();
    Cell { text, tone }
}

/// Heads of the columns after identifier and text.
pub const HEADS: [&str; 4] = ["Proof", "Tests", "Coverage by them", "Mutants noticed"];

/// The cells of a requirement below [`HEADS`].
pub fn row(evidence: &Evidence, requirement: &Requirement) -> [Cell; 4] {
    [
        proof(evidence, requirement),
        tests(requirement.tests),
        part(requirement.tests, requirement.coverage),
        part(requirement.tests, requirement.mutants),
    ]
}

fn proof(evidence: &Evidence, requirement: &Requirement) -> Cell {
    let properties = evidence.properties.iter();
    let own = properties.filter(|p| p.requirement.as_deref() == Some(&requirement.id));
    let mut words: BTreeMap<&str, usize> = BTreeMap::new();
    let mut tone = Tone::Good;
    for property in own {
        *words.entry(property.verdict).or_default() += 1;
        tone = match (tone, property.holds) {
            (Tone::Bad, _) | (_, Some(false)) => Tone::Bad,
            (_, None) => Tone::Open,
            (tone, Some(true)) => tone,
        };
    }
    let text: Vec<String> = words
        .iter()
        .map(|(word, count)| match count {
            1 if words.len() == 1 => (*word).to_string(),
            count => format!("{count} {word}"),
        })
        .collect();
    match (text.is_empty(), requirement.properties) {
        (false, _) => cell(text.join(", "), tone),
        (true, 0) => cell("no property", Tone::Open),
        (true, _) => cell("not run", Tone::Open),
    }
}

fn tests(tests: Option<Passed>) -> Cell {
    match tests {
        None => cell("not run", Tone::Open),
        Some(Passed {
            passed: 0,
            failed: 0,
        }) => cell("no test", Tone::Open),
        Some(Passed { passed, failed: 0 }) => cell(format!("{passed} passed"), Tone::Good),
        Some(Passed { passed, failed }) => {
            cell(format!("{failed} of {} failed", passed + failed), Tone::Bad)
        }
    }
}

fn part(tests: Option<Passed>, part: Option<Share>) -> Cell {
    match (tests, part) {
        (_, Some(part)) => cell(share(part), Tone::Good),
        (
            Some(Passed {
                passed: 0,
                failed: 0,
            }),
            None,
        ) => cell("no test", Tone::Open),
        (_, None) => cell("not run", Tone::Open),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::{evidence, property};

    fn shown(evidence: &Evidence) -> Vec<String> {
        let rows = evidence.requirements.iter().map(|requirement| {
            let cells = row(evidence, requirement);
            let cells = cells.map(|cell| format!("{} ({:?})", cell.text, cell.tone));
            format!("{}: {}", requirement.id, cells.join(", "))
        });
        rows.collect()
    }

    #[test]
    fn what_did_not_run_says_so() {
        let mut evidence = evidence();
        evidence.properties = vec![
            property("R1", "proved", Some(true)),
            property("R1", "violated", Some(false)),
            property("R1", "not decided", None),
            property("R2", "proved", Some(true)),
            property("R2", "vacuous", None),
        ];
        insta::assert_snapshot!(shown(&evidence).join("\n"), @r"
        R1: 1 not decided, 1 proved, 1 violated (Bad), not run (Open), not run (Open), not run (Open)
        R2: 1 proved, 1 vacuous (Open), not run (Open), not run (Open), not run (Open)
        R3: not run (Open), not run (Open), not run (Open), not run (Open)
        R4: no property (Open), not run (Open), not run (Open), not run (Open)
        ");
        let results = [(2, 1), (3, 0), (0, 0), (1, 0)];
        for (requirement, (passed, failed)) in evidence.requirements.iter_mut().zip(results) {
            requirement.tests = Some(Passed { passed, failed });
        }
        evidence.requirements[1].coverage = Some(Share { reached: 2, all: 3 });
        evidence.requirements[1].mutants = Some(Share { reached: 0, all: 0 });
        insta::assert_snapshot!(shown(&evidence).join("\n"), @r"
        R1: 1 not decided, 1 proved, 1 violated (Bad), 1 of 3 failed (Bad), not run (Open), not run (Open)
        R2: 1 proved, 1 vacuous (Open), 3 passed (Good), 2 of 3 (66 %) (Good), nothing to reach (Good)
        R3: not run (Open), no test (Open), no test (Open), no test (Open)
        R4: no property (Open), 1 passed (Good), not run (Open), not run (Open)
        ");
    }
}
