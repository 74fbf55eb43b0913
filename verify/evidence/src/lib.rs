//! Evidence that a program does what is required of it: requirements, proofs with what they suppose, runs that violate
//! properties, and tests, as an assessor reads them.
//!
//! [`Evidence`] is plain data, and as JSON a document for programs (`docs/src/verification.schema.json`); [`page`] and
//! [`document`] show it to people. The same evidence gives the same bytes. Whoever calls has decided and run all of it.
//! Start reading at [`Evidence`].

#![deny(missing_docs)]

pub mod document;
mod hash;
pub mod matrix;
pub mod page;
mod words;

pub use hash::{of_list, sha256};

use rungc_ladder::drawing::Drawing;
use rungc_sim::record::plot::Diagram;
use serde::Serialize;

/// Version of the JSON document; a higher one may lack members of lower ones.
pub const VERSION: u32 = 1;

/// Evidence about a program.
#[derive(Clone, Debug, Serialize)]
pub struct Evidence {
    /// Kind of the document: `rungc verify`.
    pub report: &'static str,
    /// [`VERSION`].
    pub version: u32,
    /// Version of rungc.
    pub rungc: String,
    /// Date of the report, as ISO 8601 has it, if it is to have one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub date: Option<String>,
    /// The program.
    pub subject: Subject,
    /// Settings on which verdicts depend: a name, and a value.
    pub settings: Vec<Setting>,
    /// Assumptions of all proofs.
    pub assumptions: Vec<String>,
    /// Requirements in the order of the settings.
    pub requirements: Vec<Requirement>,
    /// Properties in the order in which they were decided.
    pub properties: Vec<Verified>,
    /// Test cases of the program; `None` if tests did not run.
    pub tests: Option<Tests>,
    /// Gaps of the evidence: requirements without a property or a test, cases that name unknown requirements.
    pub missing: Vec<String>,
}

/// A program, as it was verified.
#[derive(Clone, Debug, Serialize)]
pub struct Subject {
    /// Title of the program.
    pub title: String,
    /// The program's file or folder.
    pub file: String,
    /// PLC model, by its name in settings.
    pub model: String,
    /// PLC model, by the name that its maker gives it.
    pub plc: String,
    /// SHA-256 of the program: of its file, or of the list of its files as `sha256sum` prints it.
    pub sha256: String,
    /// Files that verdicts depend on.
    pub files: Vec<File>,
}

/// A file that verdicts depend on.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
pub struct File {
    /// Part that it has: `program`, `older program`, `settings` or `tests`.
    pub role: &'static str,
    /// Path, with slashes.
    pub file: String,
    /// SHA-256 of its contents.
    pub sha256: String,
}

/// A setting on which verdicts depend.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
pub struct Setting {
    /// Name for readers.
    pub name: &'static str,
    /// Value.
    pub value: String,
}

/// A requirement, and what shows that it is met.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
pub struct Requirement {
    /// Identifier.
    pub id: String,
    /// Text of the requirement; empty if it is not known.
    pub text: String,
    /// Its place in the sheet; empty if it is not known.
    pub source: String,
    /// Number of rows of the settings with properties of it, whether they were decided or not.
    pub properties: usize,
    /// Its test cases; `None` if tests did not run.
    pub tests: Option<Passed>,
    /// Part of the program that its test cases reach; `None` if tests did not run, or it has none.
    pub coverage: Option<Share>,
    /// Mutants of the program that its test cases notice; `None` if mutants did not run, or it has no cases.
    pub mutants: Option<Share>,
}

/// Test cases by result.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize)]
pub struct Passed {
    /// Number of cases that passed.
    pub passed: usize,
    /// Number of cases that failed.
    pub failed: usize,
}

/// A part of several.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize)]
pub struct Share {
    /// Number of those that count.
    pub reached: usize,
    /// Number of all.
    pub all: usize,
}

/// A property, and its verdict.
#[derive(Clone, Debug, Serialize)]
pub struct Verified {
    /// Identifier of the requirement that it belongs to.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub requirement: Option<String>,
    /// Property as written, with its name if it has one.
    pub property: String,
    /// Verdict in a word: `proved`, `violated`, `reached`, `not reachable`, `vacuous` or `not decided`; of an output
    /// that
    /// is compared with that of an older program, `the same` or `differs`.
    pub verdict: &'static str,
    /// True if the program has the property, false if not; `None` if that is not decided.
    pub holds: Option<bool>,
    /// Reason why it is not decided, or how the older program differs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// Grounds of the verdict.
    pub method: Method,
    /// Parts of the program that the property depends on and the model leaves open: any result is possible there.
    pub gaps: Vec<Gap>,
    /// Devices that the property depends on and that count as inputs.
    pub inputs: Vec<Inputs>,
    /// Run that violates or reaches it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub run: Option<Run>,
    /// Files by which others can check the proof.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub certificate: Vec<Certificate>,
}

/// Grounds of a verdict.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Method {
    /// A proof by induction over scans.
    Induction {
        /// Number of scans.
        scans: usize,
        /// Number of bits of memory that the property depends on.
        bits: usize,
    },
    /// A proof by an invariant: states that cannot be reached, found by property-directed reachability.
    Invariant {
        /// Number of sets of states that are excluded.
        clauses: usize,
        /// Number of bits of memory that the property depends on.
        bits: usize,
    },
    /// A proof by induction over all memory that two programs have in common: it ends each scan with the same values.
    Common,
    /// A run that was replayed.
    Run,
    /// A search for a run that ended without one.
    Bounded {
        /// Number of scans for which there is none.
        scans: usize,
    },
    /// None: the reason says why.
    None,
}

/// A part of the program that the model leaves open.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
pub struct Gap {
    /// Description.
    pub what: String,
    /// Step of the instruction that causes it, or of its network.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub step: Option<u32>,
    /// True if that is the step of the instruction.
    pub is_instruction: bool,
}

/// Devices that count as inputs.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
pub struct Inputs {
    /// Option or table of the settings that names them; `None` if nothing in the program writes them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub named_by: Option<&'static str>,
    /// The devices.
    pub devices: Vec<String>,
}

/// A run from power-on to the scan in which what is searched for has happened.
#[derive(Clone, Debug, Serialize)]
pub struct Run {
    /// Number of scans.
    pub scans: usize,
    /// Time from power-on to the last of them, in milliseconds.
    pub ms: u64,
    /// Engines that have shown it.
    pub engines: Vec<&'static str>,
    /// Devices that are not 0 at power-on.
    pub start: Vec<Value>,
    /// Changes from outside.
    pub changes: Vec<Change>,
    /// Values after the last scan of what the property looks at.
    pub end: Vec<Value>,
    /// Timing diagram.
    #[serde(skip)]
    pub diagram: Option<Diagram>,
    /// Networks that write what the property looks at, with the power that flows in them after the last scan.
    #[serde(skip)]
    pub networks: Vec<Network>,
}

/// Scans of a run in which nothing changes from outside after the first.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Change {
    /// The first of the scans, from 1.
    pub scan: usize,
    /// Number of scans.
    pub scans: usize,
    /// Time of the first since power-on, in milliseconds.
    pub at_ms: u64,
    /// True if the PLC is in STOP before the first, and then in RUN.
    pub restart: bool,
    /// Time from each of them to the next scan, in milliseconds.
    pub scan_ms: u32,
    /// Values that are set before the first of them.
    pub set: Vec<Value>,
}

/// A number.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
#[serde(untagged)]
pub enum Number {
    /// A bit or an integer.
    Integer(i64),
    /// A float; in JSON, `null` if it is not a number.
    Float(f32),
}

/// Value of a device.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Value {
    /// The device, as test files name it.
    pub device: String,
    /// Its value.
    pub value: Number,
    /// Its comment.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub comment: Option<String>,
}

/// A network as it is drawn.
#[derive(Clone, Debug)]
pub struct Network {
    /// Number, from 1.
    pub number: usize,
    /// Its instructions, for those who do not see the drawing.
    pub list: String,
    /// The drawing.
    pub drawing: Drawing,
}

/// A file by which others can check a proof.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
pub struct Certificate {
    /// Path of the file, with slashes.
    pub file: String,
    /// SHA-256 of its contents.
    pub sha256: String,
    /// Command that checks it.
    pub check: String,
}

/// Test cases of the program, on the interpreter.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
pub struct Tests {
    /// The cases.
    pub cases: Vec<Case>,
    /// Part of the program that they reach.
    pub coverage: Option<Share>,
    /// Mutants of the program that they notice; `None` if mutants did not run.
    pub mutants: Option<Share>,
}

/// A test case.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
pub struct Case {
    /// Test file, with slashes.
    pub file: String,
    /// Line of the case in it.
    pub line: u32,
    /// Name.
    pub name: String,
    /// Identifiers of requirements that it belongs to.
    pub requirements: Vec<String>,
    /// Reason why it failed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failure: Option<String>,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Evidence about four requirements of which nothing is known; the last has no property.
    pub(crate) fn evidence() -> Evidence {
        let requirement = |(id, properties): (&str, usize)| Requirement {
            id: id.to_string(),
            text: format!("What {id} <asks>."),
            source: String::new(),
            properties,
            tests: None,
            coverage: None,
            mutants: None,
        };
        let requirements = [("R1", 3), ("R2", 2), ("R3", 1), ("R4", 0)];
        Evidence {
            report: "rungc verify",
            version: VERSION,
            rungc: "1.2.3".to_string(),
            date: None,
            subject: Subject {
                title: "a & b".to_string(),
                file: "a.il".to_string(),
                model: "fx3u".to_string(),
                plc: "Mitsubishi FX3U".to_string(),
                sha256: sha256(b"a"),
                files: Vec::new(),
            },
            settings: Vec::new(),
            assumptions: vec!["`X000` is on".to_string()],
            requirements: requirements.map(requirement).into(),
            properties: Vec::new(),
            tests: None,
            missing: Vec::new(),
        }
    }

    pub(crate) fn property(id: &str, verdict: &'static str, holds: Option<bool>) -> Verified {
        Verified {
            requirement: Some(id.to_string()),
            property: "never Y000".to_string(),
            verdict,
            holds,
            reason: None,
            method: Method::None,
            gaps: Vec::new(),
            inputs: Vec::new(),
            run: None,
            certificate: Vec::new(),
        }
    }

    /// A run of two changes.
    fn run() -> Run {
        let value = |device: &str, value| Value {
            device: device.to_string(),
            value: Number::Integer(value),
            comment: None,
        };
        let change = |scan, scans, at_ms, set| Change {
            scan,
            scans,
            at_ms,
            restart: scan == 4,
            scan_ms: 10,
            set,
        };
        Run {
            scans: 4,
            ms: 30,
            engines: vec!["interp", "c"],
            start: vec![value("D200", -5)],
            changes: vec![
                change(1, 3, 0, vec![value("X000", 1), value("X001", 1)]),
                change(4, 1, 30, Vec::new()),
            ],
            end: vec![value("Y000", 1)],
            diagram: None,
            networks: Vec::new(),
        }
    }

    #[test]
    fn methods_and_runs_have_words() {
        let methods = [
            Method::Induction { scans: 1, bits: 8 },
            Method::Induction { scans: 3, bits: 1 },
            Method::Invariant {
                clauses: 2,
                bits: 9,
            },
            Method::Bounded { scans: 40 },
            Method::Run,
            Method::None,
        ];
        let words = methods.map(|method| {
            let verified = Verified {
                method,
                run: Some(run()),
                ..property("R1", "proved", Some(true))
            };
            verified.method().unwrap_or_default()
        });
        insta::assert_snapshot!(words.join("\n"), @r"
        induction over 1 scan: no scan violates it, from whatever state of memory (8 bits)
        induction over 3 scans: no run of 3 scans from power-on violates it, and no scan that follows 2 scans without that does, from whatever state of memory (1 bit)
        invariant of 2 clauses over 9 bits of memory, found by property-directed reachability (PDR) and confirmed by a second run of the solver
        bounded search: no run of up to 40 scans; longer ones are unknown
        run of 4 scans, replayed on interp, c
        ");
        insta::assert_snapshot!(run().to_string(), @"at power-on: D200 = -5; scan 1 to 3 (0 ms): X000 = 1, X001 = 1; scan 4 (30 ms): STOP, then RUN; then: Y000 = 1");
    }

    #[test]
    fn a_page_escapes_what_it_shows() {
        let mut evidence = evidence();
        evidence.subject.title = "<script>".to_string();
        evidence.properties = vec![Verified {
            property: "never \"<b>\"".to_string(),
            requirement: None,
            ..property("R1", "proved", Some(true))
        }];
        evidence.missing = vec!["`<i>` and a ` alone".to_string()];
        let page = page::page(&evidence);
        for raw in ["<script>", "<b>", "<i>", "<asks>"] {
            assert!(!page.contains(raw), "{raw}");
        }
        assert!(page.contains("<li><code>X000</code> is on</li>"));
        assert!(page.contains("Proved for this model under these assumptions."));
    }

    #[test]
    fn the_same_evidence_gives_the_same_bytes() {
        let mut evidence = evidence();
        evidence.properties = vec![Verified {
            run: Some(run()),
            method: Method::Run,
            ..property("R1", "violated", Some(false))
        }];
        let long = "a requirement of many words ".repeat(400);
        evidence.requirements[0].text = long;
        let document = document::document(&evidence);
        assert_eq!(document, document::document(&evidence));
        assert!(document.starts_with(b"%PDF-"));
        assert_eq!(page::page(&evidence), page::page(&evidence));
    }
}
