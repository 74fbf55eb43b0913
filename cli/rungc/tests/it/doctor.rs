//! `rungc doctor` on machines without tools, with some, and with broken ones.

use crate::common::{folder, text, write_executable};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Output of `doctor` with no variables but these, and nothing on the search path but this folder.
fn doctor(tools: &Path, variables: &[(&str, &str)], args: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_rungc"))
        .arg("doctor")
        .args(args)
        .env_clear()
        .env("PATH", tools)
        .env("HOME", tools)
        .envs(variables.iter().copied())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    text(&output.stdout)
}

fn json(tools: &Path, variables: &[(&str, &str)]) -> Value {
    serde_json::from_str(&doctor(tools, variables, &["--format", "json"])).unwrap()
}

/// The object of this name in a list.
fn named<'a>(list: &'a Value, name: &str) -> &'a Value {
    let mut all = list.as_array().unwrap().iter();
    all.find(|one| one["name"] == name || one["triple"] == name)
        .unwrap_or_else(|| panic!("{name} in {list}"))
}

#[test]
fn without_tools_each_is_missing_with_what_it_prevents_and_a_way_to_install_it() {
    let empty = folder(&[]);
    let report = json(empty.path(), &[]);
    let tools = report["tools"].as_array().unwrap();
    assert!(tools.len() > 5, "{report}");
    let shown = doctor(empty.path(), &[], &[]);
    let verbose = doctor(empty.path(), &[], &["--verbose"]);
    for tool in tools {
        assert_eq!(tool["state"], "missing", "{tool}");
        for field in ["name", "needed_for"] {
            assert!(shown.contains(tool[field].as_str().unwrap()), "{shown}");
        }
        let install = &tool["install"];
        for system in ["debian", "macos", "windows"] {
            assert!(install[system].as_str().unwrap().len() > 3, "{tool}");
        }
    }
    for target in report["targets"].as_array().unwrap() {
        for language in ["missing_for_c", "missing_for_rust"] {
            let reason = target[language].as_str().unwrap();
            assert!(
                verbose.contains(reason) && !shown.contains(reason),
                "{verbose}"
            );
        }
    }
    let characters = named(&report["settings"], "characters");
    assert_eq!(characters["state"], "failed", "{report}");
}

/// Without PATH, systems look in default folders, where a compiler may be without its parts.
#[test]
fn a_search_path_that_is_not_set_is_named() {
    let empty = folder(&[]);
    let run = |path: Option<&str>| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_rungc"));
        command.args(["doctor", "--verbose"]).env_clear();
        command
            .env("HOME", empty.path())
            .envs(path.map(|path| ("PATH", path)));
        let output = command.output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        text(&output.stdout)
    };
    let unset = run(None);
    assert!(
        unset.contains("search path      failed   PATH is not set"),
        "{unset}"
    );
    // A C library that is there is not called missing.
    let has_library = Path::new("/usr/include/string.h").exists();
    let named = unset
        .lines()
        .any(|line| line.contains("no C library for host"));
    assert!(!(has_library && named), "{unset}");
    assert!(
        run(Some("")).contains("search path      failed   PATH is empty"),
        "{unset}"
    );
    assert!(!run(Some("/nowhere")).contains("search path"), "{unset}");
}

#[test]
fn tools_are_found_with_their_versions_and_broken_ones_named() {
    let tools = folder(&[]);
    let script = |name: &str, text: &str| {
        write_executable(
            &tools.path().join(name),
            format!("#!/bin/sh\n{text}\n").as_bytes(),
        );
    };
    script("cc", "echo fake C compiler 1.2.3; echo more");
    script("make", "echo libmake.so is missing >&2; exit 127");
    let cache = tools.path().join("cache");
    let variables = [
        ("RUNGC_CACHE_DIR", cache.to_str().unwrap()),
        ("LANG", "de_DE.UTF-8"),
        ("CC_thumbv7em_none_eabihf", "/nowhere/gcc"),
    ];
    let report = json(tools.path(), &variables);
    let compiler = named(&report["tools"], "C compiler");
    assert_eq!(compiler["state"], "ok");
    assert_eq!(compiler["detail"], "fake C compiler 1.2.3");
    let make = named(&report["tools"], "make");
    assert_eq!(make["state"], "failed");
    assert!(
        make["detail"].as_str().unwrap().contains("libmake.so"),
        "{make}"
    );
    let arm = named(&report["tools"], "Arm C compiler");
    assert_eq!(arm["command"], "/nowhere/gcc");
    assert_eq!(arm["state"], "missing");
    let host = named(&report["targets"], "host");
    assert!(host["missing_for_c"].is_null(), "{host}");
    assert!(host["missing_for_rust"].is_string(), "{host}");
    for setting in ["cache folder", "characters"] {
        assert_eq!(named(&report["settings"], setting)["state"], "ok");
    }
    let latin = [("LANG", "de_DE.UTF-8"), ("LC_ALL", "de_DE.ISO-8859-1")];
    let report = json(tools.path(), &latin);
    assert_eq!(named(&report["settings"], "characters")["state"], "failed");
}

#[test]
fn a_cache_that_cannot_be_written_is_named() {
    let tools = folder(&[("file", b"")]);
    let file = tools.path().join("file");
    let report = json(tools.path(), &[("RUNGC_CACHE_DIR", file.to_str().unwrap())]);
    let cache = named(&report["settings"], "cache folder");
    assert_eq!(cache["state"], "failed");
    assert!(
        cache["detail"]
            .as_str()
            .unwrap()
            .contains("RUNGC_CACHE_DIR"),
        "{cache}"
    );
}

/// The page on installing has a row for each tool.
#[test]
fn the_page_on_installing_has_the_same_table() {
    let report = json(folder(&[]).path(), &[]);
    let page = Path::new(env!("RUNGC_ROOT")).join("docs/src/install.md");
    let page = fs::read_to_string(page).unwrap();
    let code = |way: &Value| match way.as_str().unwrap() {
        address if address.starts_with("https:") => format!("<{address}>"),
        words if words.starts_with("in ") => words.to_owned(),
        command => format!("`{command}`"),
    };
    let mut table = String::from(
        "| tool | needed for | Debian, Ubuntu | macOS | Windows |\n|---|---|---|---|---|\n",
    );
    for tool in report["tools"].as_array().unwrap() {
        let [name, needed_for] = ["name", "needed_for"].map(|field| tool[field].as_str().unwrap());
        let ways = ["debian", "macos", "windows"].map(|system| code(&tool["install"][system]));
        table += &format!("| {name} | {needed_for} | {} |\n", ways.join(" | "));
    }
    assert!(page.contains(&table), "install.md has to have\n{table}");
}
