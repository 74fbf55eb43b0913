//! Published projects read without a finding. They are not part of this repository: where they are absent, the tests
//! say so.

use rungc_syntax::Program;
use std::path::{Path, PathBuf};

/// The folder of the corpus, if there is one.
fn corpus() -> Option<PathBuf> {
    let folder = Path::new(env!("RUNGC_ROOT")).join("../shared/corpus");
    if !folder.is_dir() {
        println!("skipped: no corpus at {}", folder.display());
        return None;
    }
    Some(folder)
}

fn files(folder: &Path, name: &str, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap().flatten() {
        let path = entry.path();
        if path.is_dir() {
            files(&path, name, found);
        } else if path.file_name().is_some_and(|n| n == name) {
            found.push(path);
        }
    }
}

fn texts(program: &Program) -> Vec<String> {
    program.instrs.iter().map(ToString::to_string).collect()
}

fn read_clean(path: &Path) -> Program {
    let read = rungc_frontend::read(path).unwrap();
    let findings: Vec<_> = read.diagnostics.iter().map(|d| &d.message).collect();
    assert!(findings.is_empty(), "{}: {findings:#?}", path.display());
    read.program
}

#[test]
fn every_project_reads_without_a_finding() {
    let Some(corpus) = corpus() else { return };
    let mut found = Vec::new();
    files(&corpus, "MAIN.wpg", &mut found);
    assert!(found.len() > 50, "{} projects", found.len());
    for path in found {
        let program = read_clean(&path);
        assert_eq!(
            texts(&program).last().map(String::as_str),
            Some("END"),
            "{}",
            path.display()
        );
        assert!(
            program.cpu.is_some_and(|cpu| cpu.starts_with("FX")),
            "{}",
            path.display()
        );
    }
}

#[test]
fn a_project_is_found_in_its_folder_with_its_comments() {
    let Some(corpus) = corpus() else { return };
    let program = read_clean(&corpus.join("fx3u-examples/Timer_Delay_to_ON"));
    let comments: Vec<_> = program
        .comments
        .iter()
        .map(|(d, c)| format!("{d} {c}"))
        .collect();
    assert_eq!(comments, ["T1 K100=10 segundos"]);
    assert_eq!(program.cpu.as_deref(), Some("FX3U/FX3UC"));
}

#[test]
fn a_project_and_its_export_are_one_program() {
    let Some(corpus) = corpus() else { return };
    let export = read_clean(&corpus.join("fx2n-list/MAIN.csv"));
    let project = read_clean(&corpus.join("fx2n-list/FX2N.gxw"));
    assert_eq!(texts(&project), texts(&export));
    let steps = |program: &Program| -> Vec<_> { program.instrs.iter().map(|i| i.step).collect() };
    assert_eq!(steps(&project), steps(&export));
    assert!(steps(&export).iter().all(Option::is_some));
    assert_eq!(export.instrs.len(), 170);
    assert_eq!(project.cpu, export.cpu);
    assert_eq!(export.cpu.as_deref(), Some("FX2N/FX2NC"));
}

#[test]
fn exports_are_written_as_their_editors_wrote_them() {
    let Some(corpus) = corpus() else { return };
    let mut found = Vec::new();
    files(&corpus, "MAIN.csv", &mut found);
    assert!(found.len() >= 2, "{found:?}");
    for path in found {
        let read = rungc_frontend::read(&path).unwrap();
        let head = read.export_head.as_ref().expect("an export has a head");
        let written = rungc_frontend::print::to_csv_with(&read.program, head);
        assert!(
            written == std::fs::read(&path).unwrap(),
            "{}",
            path.display()
        );
    }
}
