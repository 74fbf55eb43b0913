//! Test cases of a program as evidence: their results, what they reach, and which mutants they notice.

use super::{Grounds, file};
use crate::commands::test::coverage::tell_equivalent;
use crate::commands::test::files;
use crate::commands::test::report::message;
use crate::commands::verify::export::slashed;
use crate::commands::{Context, Failure, counted, subject};
use crate::progress;
use rungc_coverage::mutants::{self, Fate, Mutant};
use rungc_coverage::{Covered, cover};
use rungc_evidence::{Case, Evidence, Passed, Requirement, Share, Tests};
use rungc_project::Project;
use rungc_sim::plctest::{self, CaseProgram, Id, Report, Suite, TestFile};
use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// Runs the test cases of the program that its settings name, and adds their results; says what is missing.
pub fn add(grounds: &Grounds, evidence: &mut Evidence, cx: Context) -> Result<(), Failure> {
    if let Some(project) = grounds.basis.subject.own_project() {
        let paths = project.test.files.iter();
        let paths = paths.map(|file| subject::near(project.at(Path::new(&file.text))));
        let mut files = match project.test.files.is_empty() {
            true => Vec::new(),
            false => files::load(&paths.collect::<Vec<_>>(), None)
                .map_err(|unread| unread.failure(cx))?,
        };
        note_unknown(project, &files, evidence);
        let is_own = |case: &plctest::Case| match &case.program {
            CaseProgram::File(file) => {
                same_file::is_same_file(&file.path, &grounds.basis.subject.file).unwrap_or(false)
            }
            CaseProgram::List(_) => false,
        };
        note_foreign(&mut files, &is_own, evidence);
        files.retain(|file| !file.cases.is_empty());
        run(grounds, project, files, evidence, cx)?;
    }
    note_missing(evidence);
    Ok(())
}

/// Notes cases that name requirements which the settings do not have.
fn note_unknown(project: &Project, files: &[TestFile], evidence: &mut Evidence) {
    let known: BTreeSet<&str> = project.requirements.iter().map(|r| r.id.as_str()).collect();
    for (file, case) in cases(files) {
        let unknown = case.requirements.iter();
        for id in unknown.filter(|id| !known.contains(id.as_str())) {
            evidence.missing.push(format!(
                "requirement `{id}`, which the case `{}` names ({}:{}): no `[[property]]` of {} has this `id`",
                case.name,
                slashed(Path::new(&file.name)),
                case.line,
                slashed(&subject::near(project.path.clone()))
            ));
        }
    }
}

fn cases(files: &[TestFile]) -> impl Iterator<Item = (&TestFile, &plctest::Case)> {
    files
        .iter()
        .flat_map(|file| file.cases.iter().map(move |case| (file, case)))
}

/// Leaves out cases of other programs, and notes those of them that name requirements.
fn note_foreign(
    files: &mut [TestFile],
    is_own: &dyn Fn(&plctest::Case) -> bool,
    evidence: &mut Evidence,
) {
    for (file, case) in cases(files) {
        if !is_own(case) && !case.requirements.is_empty() {
            evidence.missing.push(format!(
                "the case `{}` ({}:{}), which names requirement `{}`: it tests another program",
                case.name,
                slashed(Path::new(&file.name)),
                case.line,
                case.requirements.join("`, `")
            ));
        }
    }
    for file in files {
        file.cases.retain(is_own);
    }
}

/// Notes requirements without a property or a test.
fn note_missing(evidence: &mut Evidence) {
    for requirement in &evidence.requirements {
        let id = &requirement.id;
        let tested = requirement
            .tests
            .is_some_and(|of| of.passed + of.failed > 0);
        let lacks = match (requirement.properties, tested) {
            (0, false) => "a property and a test case",
            (0, true) => "a property",
            (_, false) => "a test case",
            (_, true) => continue,
        };
        evidence
            .missing
            .push(format!("{lacks} for requirement `{id}`"));
    }
}

fn run(
    grounds: &Grounds,
    project: &Project,
    files: Vec<TestFile>,
    evidence: &mut Evidence,
    cx: Context,
) -> Result<(), Failure> {
    for test in &files {
        evidence
            .subject
            .files
            .push(file("tests", &PathBuf::from(&test.name))?);
    }
    let suite = progress::spin("compiling the cases", || {
        Suite::compile_marked(files, &project.check.warn)
    });
    if !suite.is_empty() {
        cx.note(&format!(
            "     Running {} on interp",
            counted(suite.len(), "case")
        ));
    }
    let (programs, report) = cover(&suite, &mut |_| ControlFlow::Continue(()));
    let failed = report.failures().count();
    if failed > 0 {
        cx.note(&format!("      Failed {}", counted(failed, "case")));
    }
    let is_own = |covered: &Covered| {
        let path = covered.path.as_ref();
        path.is_some_and(|path| {
            same_file::is_same_file(path, &grounds.basis.subject.file).unwrap_or(false)
        })
    };
    let programs: Vec<Covered> = programs.into_iter().filter(is_own).collect();
    if grounds.basis.args.mutants && !report.is_success() {
        let why = "--mutants: all cases must pass before the program is changed";
        return Err(Failure::Because(why.to_string()));
    }
    let mutants = grounds.basis.args.mutants.then(|| {
        let programs = programs.iter();
        programs
            .map(|program| mutants_of(&suite, program))
            .collect()
    });
    let ran = Ran {
        suite: &suite,
        report: &report,
        programs: &programs,
        mutants,
    };
    for requirement in &mut evidence.requirements {
        of_requirement(&ran, requirement);
    }
    let all = |_: Id| true;
    evidence.tests = Some(Tests {
        cases: suite
            .cases()
            .map(|(id, _)| case(&suite, &report, id))
            .collect(),
        coverage: coverage(&programs, &all),
        mutants: ran.noticed(&all),
    });
    Ok(())
}

/// A suite that ran.
struct Ran<'a> {
    suite: &'a Suite,
    /// Results of its cases.
    report: &'a Report,
    /// The programs that they run.
    programs: &'a [Covered],
    /// Mutants of each, if they are to run.
    mutants: Option<Vec<Vec<Mutant>>>,
}

/// The mutants of a program that a case could notice: those that can change an output.
fn mutants_of(suite: &Suite, program: &Covered) -> Vec<Mutant> {
    let mut all = mutants::mutants(program);
    let mut fates = fates(suite, program, &all);
    tell_equivalent(program, &all, &mut fates);
    let mut fates = fates.into_iter();
    all.retain(|_| !matches!(fates.next(), Some(Fate::Equivalent | Fate::Invalid)));
    all
}

fn fates(suite: &Suite, program: &Covered, mutants: &[Mutant]) -> Vec<Fate> {
    let bar = progress::bar(mutants.len() as u64).with_message("mutants");
    let fates = mutants::run(suite, program, mutants, &|| {
        bar.inc(1);
        true
    });
    bar.finish_and_clear();
    fates
}

impl Ran<'_> {
    /// Mutants of the programs that some of the cases notice; `None` if they are not to run, or without programs.
    fn noticed(&self, is_one: &dyn Fn(Id) -> bool) -> Option<Share> {
        let of_each = self.mutants.as_ref()?;
        let mut share = Share { reached: 0, all: 0 };
        for (program, mutants) in self.programs.iter().zip(of_each) {
            let fates = fates(self.suite, &program.only(is_one), mutants);
            share.reached += fates.iter().filter(|fate| **fate == Fate::Noticed).count();
            share.all += fates.len();
        }
        (!self.programs.is_empty()).then_some(share)
    }
}

fn of_requirement(ran: &Ran, requirement: &mut Requirement) {
    let (suite, report) = (ran.suite, ran.report);
    let cases = suite.cases();
    let own = cases.filter(|(_, case)| case.requirements.contains(&requirement.id));
    let own: BTreeSet<Id> = own.map(|(id, _)| id).collect();
    let failed: BTreeSet<Id> = report.failures().map(|outcome| outcome.id).collect();
    let failures = own.intersection(&failed).count();
    requirement.tests = Some(Passed {
        passed: own.len() - failures,
        failed: failures,
    });
    if !own.is_empty() {
        let is_own = |id: Id| own.contains(&id);
        requirement.coverage = coverage(ran.programs, &is_own);
        requirement.mutants = ran.noticed(&is_own);
    }
}

/// Share of the programs that some of the cases reach; `None` without programs.
fn coverage(programs: &[Covered], is_one: &dyn Fn(Id) -> bool) -> Option<Share> {
    let reached = programs
        .iter()
        .map(|program| program.only(is_one).reached());
    (!programs.is_empty()).then(|| Share {
        reached: reached.sum(),
        all: programs.iter().map(|program| program.goals.len()).sum(),
    })
}

fn case(suite: &Suite, report: &Report, id: Id) -> Case {
    let file = &suite.files()[id.file];
    let case = &file.cases[id.case];
    let failure = report.failures().find(|outcome| outcome.id == id);
    Case {
        file: slashed(Path::new(&file.name)),
        line: case.line,
        name: case.name.clone(),
        requirements: case.requirements.clone(),
        failure: failure
            .and_then(|outcome| outcome.failure.as_ref())
            .map(message),
    }
}
