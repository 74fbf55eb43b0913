//! The rules of MISRA C:2012 from which emitted C deviates, as far as cppcheck's addon checks them.

use super::emit;
use crate::common::folder;
use crate::tools::tools;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Programs that between them contain what rungc emits: contacts, steps, jumps, events, calls of the runtime.
const PROGRAMS: [&str; 2] = ["drill", "jumps"];

/// The rules that cppcheck reports of the sources in a folder.
fn reported(folder: &Path, options: &[String]) -> BTreeSet<String> {
    let sources = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let sources = sources.filter(|path| path.extension().is_some_and(|ending| ending == "c"));
    let output = Command::new("cppcheck")
        .args([
            "--addon=misra",
            "--std=c99",
            "--platform=unix32",
            "-q",
            "--template={id}",
        ])
        .arg("--suppress=missingIncludeSystem")
        // The configuration of C99, and not each one that the headers have for C++ and later standards: those take five
        // times as long.
        .args(["-D__STDC_VERSION__=199901L", "-U__cplusplus"])
        .args(options)
        .args(sources)
        .current_dir(folder)
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
    let messages = String::from_utf8(output.stderr).unwrap();
    let rules = messages.lines().filter(|line| line.starts_with("misra-"));
    rules.map(str::to_string).collect()
}

#[test]
fn emitted_c_deviates_from_the_listed_rules_only() {
    if !tools(&["cppcheck"]) {
        return;
    }
    let folder = folder(&[]);
    let path = folder.path();
    let (mut all, mut listed) = (BTreeSet::new(), BTreeSet::new());
    for name in PROGRAMS {
        let source = format!("{}/examples/programs/{name}.il", env!("RUNGC_ROOT"));
        emit(
            path,
            &format!("build {source} --emit c --device-access --retain --misra -o {name}"),
        );
        let inside = path.join(name);
        let list = fs::read_to_string(inside.join("misra.txt")).unwrap();
        let rules = list.lines().filter(|line| line.starts_with("misra-"));
        listed.extend(rules.map(str::to_string));
        all.extend(reported(&inside, &[]));
        let left = reported(&inside, &["--suppressions-list=misra.txt".to_string()]);
        assert!(left.is_empty(), "{name}: {left:?}");
    }
    // One finding hides others at the same place.
    for name in PROGRAMS {
        if all != listed {
            let found = all.iter().map(|rule| format!("--suppress={rule}"));
            let hidden = reported(&path.join(name), &found.collect::<Vec<_>>());
            all.extend(hidden);
        }
    }
    // A deviation that no longer occurs leaves the list.
    assert_eq!(all, listed);
}
