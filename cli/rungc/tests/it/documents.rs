//! Agreement of the documentation with the command line.
//!
//! A fence with a file name (` ```toml lamp.plctest.toml
//! `) is a file of the page's example. In a fence marked `console`, each line that begins with `$ rungc` is run in a
//! folder with these files and the example programs, and what follows it is compared with what the command prints:
//! `...` stands for any lines, times are ignored, and a command without output need only succeed.
//!
//! A fence marked `sh` is run by a shell in the same folder. If its commands begin with `$`, what the last one prints
//! is compared, too, except for numbers, which depend on the tools. The line before such a fence may say what it needs,
//! `<!-- needs: TOOL … -->`, or why it is not run, `<!-- not run: REASON -->`.

use crate::common;
use std::env;
use std::ffi::OsString;
use std::fs;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

fn root() -> PathBuf {
    PathBuf::from(env!("RUNGC_ROOT"))
}

/// A fenced block of a page.
struct Block {
    /// Text after the fence: a language, and the name of a file.
    info: String,
    /// The comment in the line before it.
    comment: String,
    text: String,
}

fn blocks(page: &str) -> Vec<Block> {
    let mut found = Vec::new();
    let mut open: Option<Block> = None;
    let mut before = "";
    for line in page.lines() {
        match (open.as_mut(), line.strip_prefix("```")) {
            (None, Some(info)) => {
                open = Some(Block {
                    info: info.to_owned(),
                    comment: comment(before).to_owned(),
                    text: String::new(),
                });
            }
            (Some(block), None) => block.text += &format!("{line}\n"),
            (Some(_), Some(_)) => found.extend(open.take()),
            (None, None) => {}
        }
        before = line;
    }
    assert!(open.is_none(), "a fence is not closed");
    found
}

/// Contents of a line that is a comment of HTML.
fn comment(line: &str) -> &str {
    let inner = line.strip_prefix("<!-- ");
    inner
        .and_then(|rest| rest.strip_suffix(" -->"))
        .unwrap_or_default()
}

/// The file of a page's example that has this name.
fn example(page: &str, name: &str) -> String {
    let block = blocks(page)
        .into_iter()
        .find(|block| block.info.split(' ').nth(1) == Some(name));
    block.unwrap_or_else(|| panic!("no fence {name}")).text
}

/// Lines without the times that differ from run to run.
fn lines(text: &str) -> Vec<String> {
    let timeless = |line: &str| match (line.split_once(") in "), line.rsplit_once(" (0.")) {
        (Some((before, rest)), _) => {
            let counts = rest.trim_start_matches(|c: char| c.is_ascii_digit());
            format!("{before}) in{counts}")
        }
        (None, Some((before, rest))) if rest.ends_with(" s)") => before.to_owned(),
        _ => line.trim_end().to_owned(),
    };
    let filled = text.lines().filter(|line| !line.trim().is_empty());
    filled.map(timeless).collect()
}

/// Returns true if lines are as expected; `...` matches any of them.
fn fits(printed: &[String], expected: &[String]) -> bool {
    match expected.split_first() {
        None => printed.is_empty(),
        Some((first, rest)) if first == "..." => {
            (0..=printed.len()).any(|skipped| fits(&printed[skipped..], rest))
        }
        Some((first, rest)) => printed.first() == Some(first) && fits(&printed[1..], rest),
    }
}

/// Output of rungc in a folder, as a terminal would show it, and whether it succeeds.
fn rungc(folder: &Path, args: &[&str]) -> (String, bool) {
    let (mut printed, terminal) = std::io::pipe().unwrap();
    let mut child = Command::new(env!("CARGO_BIN_EXE_rungc"))
        .args(args)
        .current_dir(folder)
        .stdout(terminal.try_clone().unwrap())
        .stderr(terminal)
        .spawn()
        .unwrap();
    let mut text = String::new();
    printed.read_to_string(&mut text).unwrap();
    (text, child.wait().unwrap().success())
}

/// The pages that are shown to readers: README and the book's.
fn pages() -> Vec<PathBuf> {
    let mut pages = vec![root().join("README.md")];
    for entry in fs::read_dir(root().join("docs/src")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "md") {
            pages.push(path);
        }
    }
    pages.sort();
    pages
}

/// A folder with the example programs, a board, and the files of a page.
fn desk(page: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for part in DESK {
        let examples = folder.path().join(part);
        fs::create_dir_all(&examples).unwrap();
        for entry in fs::read_dir(root().join(part)).unwrap() {
            let entry = entry.unwrap();
            if entry.file_type().unwrap().is_file() {
                fs::copy(entry.path(), examples.join(entry.file_name())).unwrap();
            }
        }
    }
    for block in blocks(page) {
        if let Some(name) = block.info.split(' ').nth(1) {
            fs::write(folder.path().join(name), block.text).unwrap();
        }
    }
    folder
}

const EXAMPLES: &str = "examples/programs";
const FLEET: &str = "examples/fleet";

/// Files named by the commands of the pages.
const DESK: [&str; 10] = [
    EXAMPLES,
    FLEET,
    "examples/oven",
    "examples/kiln",
    "examples/tank",
    "examples/feeder",
    "examples/blend",
    "examples/analog",
    "examples/press",
    "examples/firmware/stm32f405",
];

#[test]
fn commands_print_what_the_pages_show() {
    let mut run = 0;
    for path in pages() {
        let page = fs::read_to_string(&path).unwrap();
        let folder = desk(&page);
        for block in blocks(&page) {
            if block.info != "console" {
                continue;
            }
            for part in block.text.split("$ rungc ").skip(1) {
                let (command, expected) = part.split_once('\n').unwrap();
                let args: Vec<_> = command.split_whitespace().collect();
                let (printed, succeeded) = rungc(folder.path(), &args);
                let page = path.display();
                assert!(succeeded, "{page}: {command}\n{printed}");
                let (printed, expected) = (lines(&printed), lines(expected));
                assert!(
                    expected.is_empty() || fits(&printed, &expected),
                    "{page}: {command}\nprints\n{}\nnot\n{}",
                    printed.join("\n"),
                    expected.join("\n")
                );
                run += 1;
            }
        }
    }
    assert!(run >= 10, "only {run} commands were found");
}

/// The search path with rungc in front.
fn path_with_rungc() -> OsString {
    let own = Path::new(env!("CARGO_BIN_EXE_rungc")).parent().unwrap();
    let others = env::var_os("PATH").unwrap_or_default();
    let folders = std::iter::once(own.to_owned()).chain(env::split_paths(&others));
    env::join_paths(folders).unwrap()
}

fn is_installed(tool: &str) -> bool {
    let path = env::var_os("PATH").unwrap_or_default();
    env::split_paths(&path).any(|folder| folder.join(tool).is_file())
}

/// The commands of a block for a shell, and what the last one prints: nothing where only the commands are shown.
fn script(text: &str) -> (Vec<&str>, &str) {
    if !text.starts_with("$ ") {
        return (vec![text], "");
    }
    let mut commands = Vec::new();
    let mut rest = text;
    while let Some(command) = rest.strip_prefix("$ ") {
        // A command goes over several lines where each but the last ends in a backslash.
        let mut lines = command.split_inclusive('\n');
        let mut end = 0;
        for line in lines.by_ref() {
            end += line.len();
            if !line.ends_with("\\\n") {
                break;
            }
        }
        commands.push(&command[..end]);
        rest = &command[end..];
    }
    (commands, rest)
}

/// Runs commands in a folder one after the other, as far as they succeed; what the last one prints, and whether all
/// succeed. What they leave in the background ends with them.
fn shell(folder: &Path, commands: &[&str]) -> (String, bool) {
    let mut printed = String::new();
    for command in commands {
        // Not a pipe, which those in the background would keep open.
        let mut messages = tempfile::tempfile().unwrap();
        let mut shell = Command::new("sh");
        shell
            .args(["-e", "-c", &format!("exec 2>&1\n{command}")])
            .current_dir(folder)
            .env("PATH", path_with_rungc())
            .env("HOME", folder)
            .stdin(Stdio::null())
            .stdout(messages.try_clone().unwrap());
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut shell, 0);
        let mut shell = shell.spawn().unwrap();
        let ended = shell.wait().unwrap();
        #[cfg(unix)]
        if let Some(group) = rustix::process::Pid::from_raw(shell.id() as i32) {
            // Mostly there is nothing left.
            let _ = rustix::process::kill_process_group(group, rustix::process::Signal::KILL);
        }
        let mut bytes = Vec::new();
        messages.seek(SeekFrom::Start(0)).unwrap();
        messages.read_to_end(&mut bytes).unwrap();
        printed = String::from_utf8_lossy(&bytes).into_owned();
        if !ended.success() {
            return (printed, false);
        }
    }
    (printed, true)
}

/// The usual port of brokers.
const BROKER: &str = "1883";

/// Lets a block that has a broker use a port that is free: in the block, and in the files of fleets that it runs.
fn with_free_port(text: &str, folder: &Path) -> String {
    if !text.contains("mosquitto") {
        return text.to_string();
    }
    let port = common::free_port().to_string();
    for entry in fs::read_dir(folder.join(FLEET)).unwrap() {
        let path = entry.unwrap().path();
        let written = fs::read_to_string(&path).unwrap();
        fs::write(&path, written.replace(BROKER, &port)).unwrap();
    }
    text.replace(BROKER, &port)
}

/// Lines without their numbers and the spaces that align them.
fn without_numbers(text: &str) -> Vec<String> {
    let bare = |line: &str| {
        let words = line.split_whitespace();
        let words = words.map(|word| word.replace(|c: char| c.is_ascii_digit(), ""));
        words
            .filter(|word| !word.is_empty())
            .collect::<Vec<_>>()
            .join(" ")
    };
    text.lines()
        .map(bare)
        .filter(|line| !line.is_empty())
        .collect()
}

#[test]
fn shell_commands_of_the_pages_run() {
    let (mut run, mut left_out) = (0, 0);
    for path in pages() {
        let page = fs::read_to_string(&path).unwrap();
        let folder = desk(&page);
        let page_name = path.display();
        for block in blocks(&page).into_iter().filter(|block| block.info == "sh") {
            if let Some(reason) = block.comment.strip_prefix("not run: ") {
                assert!(reason.len() > 8, "{page_name}: the reason is missing");
                left_out += 1;
                continue;
            }
            let needs = block.comment.strip_prefix("needs: ").unwrap_or_default();
            let missing = needs
                .split(' ')
                .filter(|tool| !tool.is_empty() && !is_installed(tool));
            let missing: Vec<_> = missing.collect();
            if !missing.is_empty() {
                let required = env::var_os("RUNGC_REQUIRE_EMBEDDED").is_some();
                assert!(!required, "{page_name}: {missing:?} are not installed");
                eprintln!("skipped a block of {page_name}: {missing:?} are not installed");
                continue;
            }
            let text = with_free_port(&block.text, folder.path());
            let (commands, expected) = script(&text);
            let (printed, succeeded) = shell(folder.path(), &commands);
            assert!(succeeded, "{page_name}: {commands:?}\n{printed}");
            let fits =
                expected.is_empty() || fits(&without_numbers(&printed), &without_numbers(expected));
            assert!(fits, "{page_name}: {commands:?}\nprints\n{printed}");
            run += 1;
        }
    }
    assert!(
        run >= 1 && left_out <= 9,
        "{run} blocks were run, {left_out} are left out"
    );
}

/// The host in Rust on the page on embedding compiles with the crate that it is about.
#[test]
fn the_host_in_rust_compiles() {
    let page = fs::read_to_string(root().join("docs/src/embedding.md")).unwrap();
    let block = blocks(&page)
        .into_iter()
        .find(|block| block.info.starts_with("rust"));
    let block = block.expect("a block of Rust").text;
    let folder = desk(&page);
    let program = format!("{EXAMPLES}/motor.il");
    let (printed, succeeded) = rungc(
        folder.path(),
        &["build", &program, "--emit", "rust", "-o", "motor"],
    );
    assert!(succeeded, "{printed}");
    let host = folder.path().join("motor/examples");
    fs::create_dir(&host).unwrap();
    fs::write(host.join("host.rs"), format!("fn main() {{\n{block}}}\n")).unwrap();
    let checked = Command::new(env!("CARGO"))
        .args(["check", "--locked", "--offline", "--example", "host"])
        .current_dir(folder.path().join("motor"))
        .env("CARGO_TARGET_DIR", folder.path().join("target"))
        .output()
        .unwrap();
    let messages = String::from_utf8_lossy(&checked.stderr);
    assert!(checked.status.success(), "{messages}");
}

#[test]
fn readme_shows_the_example_and_its_code() {
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    let motor = fs::read_to_string(root().join(EXAMPLES).join("motor.il")).unwrap();
    let folder = desk(&readme);
    let shown = |start: &str| {
        let block = blocks(&readme)
            .into_iter()
            .find(|block| block.text.starts_with(start));
        block.unwrap_or_else(|| panic!("no fence {start}")).text
    };
    assert_eq!(shown("; A motor").trim(), motor.trim());
    let program = format!("{EXAMPLES}/motor.il");
    let (printed, succeeded) = rungc(
        folder.path(),
        &["build", &program, "--emit", "c", "-o", "plc"],
    );
    assert!(succeeded, "{printed}");
    let emitted = fs::read_to_string(folder.path().join("plc/motor.c")).unwrap();
    assert!(
        emitted.contains(&shown("    /* step 0")),
        "motor.c is now:\n{emitted}"
    );
}

#[test]
fn the_test_of_the_feeder_has_its_program() {
    let page = fs::read_to_string(root().join("docs/src/machines.md")).unwrap();
    let program = example(&page, "feeder.il");
    let bare = |line: &str| line.split(';').next().unwrap().trim_end().to_owned();
    let bare: Vec<_> = program.lines().map(bare).collect();
    let test = example(&page, "feeder.plctest.toml");
    assert!(test.contains(&bare.join("\n")));
}

#[test]
fn the_page_on_machines_shows_the_machine_of_the_drill() {
    let page = fs::read_to_string(root().join("docs/src/machines.md")).unwrap();
    let machine = fs::read_to_string(root().join(EXAMPLES).join("drill.machine.toml")).unwrap();
    assert!(blocks(&page).iter().any(|block| block.text == machine));
}

/// The project of the page on builds builds with CMake, where there is one.
#[test]
fn the_cmake_project_builds() {
    let page = fs::read_to_string(root().join("docs/src/builds.md")).unwrap();
    let folder = desk(&page);
    let tool = |args: &[&str]| {
        Command::new("cmake")
            .args(args)
            .current_dir(folder.path())
            .env("PATH", path_with_rungc())
            .output()
    };
    let Ok(configured) = tool(&["-S", ".", "-B", "build"]) else {
        eprintln!("skipped: cmake is not installed");
        return;
    };
    assert!(configured.status.success(), "{configured:?}");
    let built = tool(&["--build", "build"]).unwrap();
    assert!(built.status.success(), "{built:?}");
    let run = Command::new(folder.path().join("build/firmware")).status();
    assert!(run.unwrap().success());
}

/// The example on access to devices builds without warnings and finds what it says.
#[test]
fn the_panel_finds_devices_by_name() {
    let page = fs::read_to_string(root().join("docs/src/embedding.md")).unwrap();
    let folder = desk(&page);
    let built = Command::new(env!("CARGO_BIN_EXE_rungc"))
        .args(["build", "machine.il", "--emit", "c", "-o", "plc"])
        .arg("--device-access")
        .current_dir(folder.path())
        .status();
    assert!(built.unwrap().success());
    let compiled = Command::new("cc")
        .args(["-std=c99", "-Wall", "-Wextra", "-Wconversion", "-Werror"])
        .args(["-Iplc", "-o", "panel", "panel.c"])
        .args(["plc/machine.c", "plc/machine_access.c"])
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert!(compiled.status.success(), "{compiled:?}");
    let run = Command::new(folder.path().join("panel")).status();
    assert_eq!(run.unwrap().code(), Some(0));
}
