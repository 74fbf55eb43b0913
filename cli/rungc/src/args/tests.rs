//! Tests of the arguments.

use super::*;
use clap::{Arg, CommandFactory};
use std::any::TypeId;
use std::collections::BTreeSet;

/// Arguments whose files are read. Those that are written have the type [`OutputPath`].
const INPUTS: [&str; 16] = [
    "allow_folder",
    "allow_write",
    "board",
    "export",
    "file",
    "files",
    "io",
    "machine",
    "names",
    "project",
    "retain",
    "root",
    "same_as",
    "topic",
    "trace",
    "volume",
];

fn is<T: 'static>(arg: &Arg) -> bool {
    arg.get_value_parser().type_id() == TypeId::of::<T>()
}

#[test]
fn each_path_is_an_input_or_an_output_with_a_test() {
    let cli = Cli::command();
    let mut outputs = BTreeSet::new();
    for command in cli.get_subcommands() {
        for arg in command.get_arguments() {
            let (command, id) = (command.get_name(), arg.get_id().as_str());
            let names = arg.get_value_names().unwrap_or_default();
            let is_path = names
                .iter()
                .any(|n| matches!(n.as_str(), "FILE" | "PATH" | "FOLDER"));
            if is::<OutputPath>(arg) {
                outputs.insert(format!("{command} --{id}"));
            } else if is::<PathBuf>(arg) || is_path {
                assert!(INPUTS.contains(&id), "{command} {id}: not an OutputPath");
            }
        }
    }
    let lines = include_str!("../../tests/outputs.txt").lines();
    let lines = lines.filter(|line| !line.starts_with('#'));
    let tested: BTreeSet<String> = lines
        .map(|line| {
            line.split('|')
                .take(2)
                .map(str::trim)
                .collect::<Vec<_>>()
                .join(" ")
        })
        .collect();
    assert_eq!(outputs, tested, "tests/outputs.txt has a line for each");
}

/// Options whose values are a choice of each command, or a file, a folder or a flag by what the command makes;
/// `--mc` is the address of a server of a run, or that of a PLC that is read.
const DIFFERENT: [&str; 9] = [
    "engine", "format", "io", "mc", "model", "output", "report", "retain", "to",
];

#[test]
fn options_of_one_name_take_values_of_one_kind() {
    let cli = Cli::command();
    let mut known = std::collections::BTreeMap::new();
    for command in cli.get_subcommands() {
        for arg in command.get_arguments().filter(|arg| !arg.is_hide_set()) {
            let Some(long) = arg.get_long() else { continue };
            let value = arg.get_value_names().map(|names| names.to_vec());
            let kind = arg.get_value_parser().type_id();
            let takes = arg.get_action().takes_values();
            let (first, other) = known
                .entry(long.to_string())
                .or_insert_with(|| (command.get_name(), (value.clone(), kind, takes)));
            if !DIFFERENT.contains(&long) {
                let name = command.get_name();
                assert_eq!(*other, (value, kind, takes), "--{long}: {first}, {name}");
            }
        }
    }
}

#[test]
fn earlier_names_are_still_understood() {
    for line in [
        "run a.il --record a.plctest.toml",
        "test --watch",
        "test --only x",
        "explore a.il --for 10s",
        "stats a.il --json",
        "flash a.elf --port /dev/ttyUSB0 --wait 60",
        "read --port /dev/ttyUSB0 --timeout 1000",
    ] {
        let words = std::iter::once("rungc").chain(line.split(' '));
        assert!(Cli::try_parse_from(words).is_ok(), "{line}");
    }
}
