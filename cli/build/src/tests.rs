use super::*;
use std::fs;

fn compiled(list: &str) -> (tempfile::TempDir, Result<Vec<String>, Error>) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("machine.il"), list).unwrap();
    let done = compile_into(
        &folder.path().join("machine.il"),
        folder.path(),
        &Options::default(),
    );
    (folder, done)
}

#[test]
fn warnings_and_files_are_reported_to_cargo() {
    let list = "LD X000\nOUT Y000\nLD X001\nOUT Y000\nEND\n";
    let (folder, done) = compiled(list);
    let lines = done.unwrap();
    assert!(
        lines[0].starts_with("cargo::rerun-if-changed="),
        "{lines:?}"
    );
    let warning = lines
        .iter()
        .find(|line| line.starts_with("cargo::warning="));
    let warning = warning.unwrap();
    assert!(
        warning.contains("machine.il:4:1: warning[W0203]"),
        "{warning}"
    );
    assert!(lines.iter().all(|line| !line.contains('\n')));
    let code = fs::read_to_string(folder.path().join("machine.rs")).unwrap();
    assert!(code.contains("pub struct Machine"), "{code}");
    assert!(!code.contains("crate::") && !code.contains("#!["), "{code}");
}

#[test]
fn a_program_with_errors_leaves_nothing() {
    let (folder, done) = compiled("LD X000\nOTU Y000\nEND\n");
    assert!(matches!(done, Err(Error::Rejected(_))));
    assert!(!folder.path().join("machine.rs").exists());
    let missing = compile_into(Path::new("absent.il"), folder.path(), &Options::default());
    assert!(matches!(missing, Err(Error::Open(_))));
}
