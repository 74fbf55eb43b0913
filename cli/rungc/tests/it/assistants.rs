//! `rungc mcp` under the official clients, `rungc guide`, and what `rungc init` writes for assistants.

#[cfg(unix)]
use crate::common::clients::python;
use crate::common::clients::{node, succeeds};
use crate::common::{code, folder, rungc, text};
use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

/// A test file whose program is outside of its folder.
const STEALS: &str = "model = \"fx3u\"\ntopic = \"t\"\nprogram = \"../secret.il\"\n[[case]]\nname = \"a\"\n\
                      [[case.step]]\nexpect = { Y000 = 0 }\n";

/// A folder in one that has a program which is not for assistants.
fn project() -> (tempfile::TempDir, std::path::PathBuf) {
    let folder = folder(&[("secret.il", b"LD X007\nOUT Y007\nEND\n")]);
    let inside = folder.path().join("press");
    fs::create_dir(&inside).unwrap();
    fs::write(inside.join("a.il"), "LD X000\nOUT Y000\nEND\n").unwrap();
    fs::write(inside.join("steals.plctest.toml"), STEALS).unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink("../secret.il", inside.join("link.il")).unwrap();
    (folder, inside)
}

#[cfg(unix)]
#[test]
fn the_python_client_does_what_assistants_do() {
    let Some(mut assistant) = python("mcp", "assistant.py") else {
        return;
    };
    let (_folder, inside) = project();
    assistant.arg(env!("CARGO_BIN_EXE_rungc")).arg(&inside);
    assert!(succeeds(assistant).contains("17 tasks"));
}

#[test]
fn the_typescript_client_does_what_assistants_do() {
    let Some(mut assistant) = node("@modelcontextprotocol/sdk/client", "assistant.mjs") else {
        return;
    };
    let (_folder, inside) = project();
    assistant.arg(env!("CARGO_BIN_EXE_rungc")).arg(&inside);
    succeeds(assistant);
}

/// Lines that `rungc mcp` answers to lines.
fn answers(folder: &Path, args: &[&str], input: &str) -> String {
    let mut command = Command::new(env!("CARGO_BIN_EXE_rungc"));
    command.arg("mcp").args(args).current_dir(folder);
    let pipes = command.stdin(Stdio::piped()).stdout(Stdio::piped());
    let mut server = pipes.spawn().unwrap();
    let mut stdin = server.stdin.take().unwrap();
    stdin.write_all(input.as_bytes()).unwrap();
    drop(stdin);
    let output = server.wait_with_output().unwrap();
    assert!(output.status.success());
    text(&output.stdout)
}

fn call(tool: &str, path: &str) -> String {
    let begin = r#"{"jsonrpc":"2.0","id":0,"method":"initialize","params":{"protocolVersion":"2025-11-25","capabilities":{},"clientInfo":{"name":"t","version":"1"}}}"#;
    format!(
        "{begin}\n{{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"tools/call\",\"params\":\
         {{\"name\":\"{tool}\",\"arguments\":{{\"path\":\"{path}\"}}}}}}\n"
    )
}

/// Neither paths nor what files name lead out of the folder.
#[test]
fn nothing_outside_the_folder_is_read() {
    let (folder, inside) = project();
    for (tool, path) in [
        ("check", "../secret.il"),
        ("view", "/etc/passwd"),
        ("test", "steals.plctest.toml"),
    ] {
        let all = answers(&inside, &[], &call(tool, path));
        assert!(all.contains("outside of"), "{tool} {path}: {all}");
        assert!(!all.contains("X007"), "{all}");
    }
    // Settings above the folder would change what the program means.
    fs::write(
        folder.path().join("rungc.toml"),
        "[project]\nmodel = \"fx1s\"\n",
    )
    .unwrap();
    let all = answers(&inside, &[], &call("check", "a.il"));
    assert!(
        all.contains("rungc.toml") && all.contains("outside of"),
        "{all}"
    );
    let root = folder.path().display().to_string();
    let all = answers(&inside, &["--root", &root], &call("check", "press/a.il"));
    assert!(all.contains("fx1s"), "{all}");
}

/// The examples of the guide are programs without errors, and the page is short.
#[test]
fn the_guide_is_short_and_its_examples_are_right() {
    let folder = folder(&[]);
    let guide = rungc(folder.path(), &["guide"]);
    let guide = text(&guide.stdout);
    assert!(guide.split_whitespace().count() <= 2_000);
    let mut count = 0;
    for block in guide.split("\n```text ").skip(1) {
        let (name, rest) = block.split_once('\n').unwrap();
        let (list, _) = rest.split_once("\n```").unwrap();
        fs::write(folder.path().join(name), format!("{list}\n")).unwrap();
        let checked = rungc(folder.path(), &["check", name, "--deny-warnings"]);
        assert!(
            checked.status.success(),
            "{name}: {}",
            text(&checked.stderr)
        );
        count += 1;
    }
    assert!(count >= 4, "{count}");
}

#[test]
fn init_writes_instructions_for_assistants_once() {
    let folder = folder(&[("a.il", b"LD X000\nOUT Y000\nEND\n")]);
    let path = folder.path();
    assert_eq!(code(path, &["init"]), 0);
    let agents = fs::read_to_string(path.join("AGENTS.md")).unwrap();
    // Each command that it names is one.
    for command in agents.split("`rungc ").skip(1) {
        let command = command.split([' ', '`']).next().unwrap();
        assert_eq!(code(path, &[command, "--help"]), 0, "{command}");
    }
    fs::remove_file(path.join("rungc.toml")).unwrap();
    fs::write(path.join("AGENTS.md"), "mine\n").unwrap();
    assert_eq!(code(path, &["init"]), 0);
    assert_eq!(
        fs::read_to_string(path.join("AGENTS.md")).unwrap(),
        "mine\n"
    );
}
