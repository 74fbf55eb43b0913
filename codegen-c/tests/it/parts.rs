//! The runtime in C: it compiles without a warning, and means the special devices that the library means.

use rungc_codegen_c::batch_in_c;
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

/// The runtime's own files: their names and texts.
fn parts() -> Vec<(String, String)> {
    let files = batch_in_c(&[]).into_iter();
    let shared = ["rungc.h", "rungc_rt.h"];
    let files =
        files.filter(|file| file.path.starts_with("rungc_") && !shared.contains(&&*file.path));
    files.map(|file| (file.path, file.contents)).collect()
}

#[test]
fn all_parts_compile_without_a_warning() {
    let folder = tempfile::tempdir().unwrap();
    for file in batch_in_c(&[]) {
        if !file.path.contains('/') {
            std::fs::write(folder.path().join(&file.path), &file.contents).unwrap();
        }
    }
    let sources: Vec<String> = parts()
        .into_iter()
        .map(|(name, _)| name)
        .filter(|name| name.ends_with(".c"))
        .collect();
    assert!(sources.len() > 10, "{sources:?}");
    // What gcc's sanitizer inserts hides casts from its warnings.
    for compiler in ["gcc", "clang", "gcc -fsanitize=undefined"] {
        let flags =
            "-O2 -Wall -Wextra -Wconversion -Wsign-conversion -Wshadow -pedantic -Werror -c";
        let mut words = compiler.split(' ');
        let output = Command::new(words.next().unwrap())
            .args(words.chain(["-std=c99"]).chain(flags.split(' ')))
            .args(&sources)
            .current_dir(folder.path())
            .output()
            .unwrap();
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
    }
}

#[test]
fn parts_need_neither_heap_nor_mathematics() {
    for (name, text) in parts() {
        for word in ["malloc", "free(", "#include <", "goto ", "setjmp"] {
            assert!(!text.contains(word), "{name}: {word}");
        }
    }
}

/// Constants `NAME: Relay = Relay(8000)` of a source of the library.
fn numbers(path: &str, numbers: &mut BTreeMap<String, String>) {
    let root = Path::new(env!("RUNGC_ROOT")).join("runtime-rt/rt/src");
    let text = std::fs::read_to_string(root.join(path)).unwrap();
    for line in text.lines() {
        let parts = line
            .split_once("const ")
            .and_then(|(_, rest)| rest.split_once(": "));
        let Some((name, rest)) = parts else { continue };
        let number = ["Relay = Relay(", "Register = Register("]
            .iter()
            .find_map(|ty| rest.strip_prefix(ty));
        if let Some(number) = number.and_then(|rest| rest.strip_suffix(");")) {
            numbers.insert(name.to_string(), number.to_string());
        }
    }
}

#[test]
fn special_devices_have_the_numbers_of_the_library() {
    let mut library = BTreeMap::new();
    for path in ["special.rs", "comm/can.rs"] {
        numbers(path, &mut library);
    }
    let mut compared = 0;
    for (file, text) in parts() {
        let constants = text
            .split([',', '{', '}', '\n'])
            .filter_map(|part| part.trim().split_once(" = "));
        for (name, number) in constants {
            let name = name.trim_start_matches("RUNGC_");
            let is_device = name.starts_with("M_") || name.starts_with("D_");
            let expected = library.get(name).filter(|_| is_device);
            if let (Some(expected), true) = (expected, number.parse::<u32>().is_ok()) {
                assert_eq!(expected, number, "{file}: {name}");
                compared += 1;
            }
        }
    }
    assert!(compared > 30, "{compared}");
}
