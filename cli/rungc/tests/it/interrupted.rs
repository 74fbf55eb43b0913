//! Executables that run until they are ended: under a flood of commands, in a scan that does not end, with errors.

use crate::common::{code, folder, rungc, soon, text};
use std::io::Read;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::{Arc, Mutex};
use std::thread;

/// Runs an executable until what it has shown and what it has reported fit, and asks it to end; its exit code, and what
/// it has reported.
fn until_terminated(
    program: &Path,
    input: Stdio,
    fits: impl Fn(&str, &str) -> bool,
) -> (Option<i32>, String) {
    let mut child = Command::new(program)
        .stdin(input)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let printed: [Arc<Mutex<Vec<u8>>>; 2] = Default::default();
    let listen = |mut pipe: Box<dyn Read + Send>, printed: &Arc<Mutex<Vec<u8>>>| {
        let printed = Arc::clone(printed);
        thread::spawn(move || {
            let mut bytes = [0; 4096];
            while let Ok(count @ 1..) = pipe.read(&mut bytes) {
                printed.lock().unwrap().extend(&bytes[..count]);
            }
        })
    };
    let listening = [
        listen(Box::new(child.stdout.take().unwrap()), &printed[0]),
        listen(Box::new(child.stderr.take().unwrap()), &printed[1]),
    ];
    let shown = |n: usize| text(&printed[n].lock().unwrap());
    soon("it shows what it should", || fits(&shown(0), &shown(1)));
    let pid = child.id().to_string();
    let ended = Command::new("kill").args(["-TERM", &pid]).status();
    assert!(ended.unwrap().success());
    let code = child.wait().unwrap().code();
    for listener in listening {
        listener.join().unwrap();
    }
    (code, shown(1))
}

/// A flood of commands starves neither the scan nor the signals nor the reports of errors.
#[test]
fn an_executable_goes_on_under_a_flood_of_commands() {
    for tool in ["cc", "make", "yes"] {
        if Command::new(tool).arg("--version").output().is_err() {
            println!("skipped: there is no {tool}");
            return;
        }
    }
    let program = b"LD M8000\nDIV D0 D1 D2\nLD M8013\nOUT Y000\nEND\n";
    let folder = folder(&[("flood.il", program)]);
    let path = folder.path();
    let args = ["build", "flood.il", "--emit", "bin", "-o", "flood"];
    assert_eq!(code(path, &args), 0);
    let mut flood = Command::new("yes")
        .arg("X0=1")
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let commands = flood.stdout.take().unwrap();
    let (code, errors) =
        until_terminated(&path.join("flood"), commands.into(), |outputs, errors| {
            outputs.contains("Y000") && errors.contains("step 1: DIV D0 D1 D2: error 6706")
        });
    assert_eq!(code, Some(0), "it ends by itself: {errors}");
    flood.kill().unwrap();
    flood.wait().unwrap();
}

/// Five loops of 32767 rounds, one in the other: the watchdog ends the scan, and the executable says so.
#[test]
fn an_executable_stops_a_scan_that_does_not_end() {
    for tool in ["cc", "make"] {
        if Command::new(tool).arg("--version").output().is_err() {
            println!("skipped: there is no {tool}");
            return;
        }
    }
    let (begin, end) = ("FOR K32767\n".repeat(5), "NEXT\n".repeat(5));
    let program = format!("{begin}LD M8000\nDINC D0\n{end}END\n");
    let folder = folder(&[("nest.il", program.as_bytes())]);
    let path = folder.path();
    let args = ["build", "nest.il", "--emit", "bin", "-o", "nest"];
    assert_eq!(code(path, &args), 0);
    let is_reported = |_: &str, errors: &str| errors.ends_with('\n');
    let (code, errors) = until_terminated(&path.join("nest"), Stdio::null(), is_reported);
    assert_eq!(code, Some(0), "it ends by itself: {errors}");
    let (head, line) = errors.split_once(", ").unwrap_or_default();
    assert!(
        head.starts_with("nest: at ") && head.ends_with(" ms"),
        "{errors}"
    );
    let expected =
        "step 12: FOR K32767: error 6105, a scan does not end (watchdog); the PLC is in STOP\n";
    assert_eq!(line, expected);
}

/// An executable names the instruction and the device of an error, once, as `rungc run` does.
#[test]
fn an_executable_names_what_an_error_is_about() {
    for tool in ["cc", "make"] {
        if Command::new(tool).arg("--version").output().is_err() {
            println!("skipped: there is no {tool}");
            return;
        }
    }
    let program = b"LD M8000\nMOV K30000 Z0\nMOV K1  D500Z0\nEND\n";
    let folder = folder(&[("reach.il", program)]);
    let path = folder.path();
    let args = ["build", "reach.il", "--emit", "bin", "-o", "reach"];
    assert_eq!(code(path, &args), 0);
    let is_reported = |_: &str, errors: &str| errors.ends_with('\n');
    let (_, errors) = until_terminated(&path.join("reach"), Stdio::null(), is_reported);
    let line = "step 6: MOV K1 D500Z0: error 6706, D30500 does not exist";
    assert_eq!(errors, format!("reach: at 0 ms, {line}\n"));
    let run = text(&rungc(path, &["run", "reach.il", "--for", "20ms"]).stderr);
    assert!(run.contains(line), "{run}");
}
