//! Calling the command line and looking at what it does.
#![cfg_attr(
    not(all(unix, feature = "mqtt")),
    allow(dead_code, reason = "tests with brokers and on Unix use the rest")
)]

pub mod chromium;
pub mod clients;
#[cfg(unix)]
pub mod hosts;
pub mod mosquitto;
pub mod running;

use rungc_runtime_sources::cache::{self, Slot};
use rungc_runtime_sources::library;
use std::fs::{self, File};
use std::io::Write as _;
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::thread;
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// Bounds a hang: events are waited for as long as the machine takes.
pub const HANG: Duration = Duration::from_secs(300);

/// Waits until something is so.
#[track_caller]
pub fn soon(what: &str, mut is_so: impl FnMut() -> bool) {
    let until = Instant::now() + HANG;
    while !is_so() {
        assert!(Instant::now() < until, "{what}");
        thread::sleep(Duration::from_millis(10));
    }
}

/// A port that no other test uses as long as this process lives. The system gives none of these to who asks for any.
pub fn free_port() -> u16 {
    let locks = std::env::temp_dir().join("rungc-ports");
    fs::create_dir_all(&locks).unwrap();
    let is_free = |port: &u16| {
        let lock = File::create(locks.join(port.to_string())).unwrap();
        let free = lock.try_lock().is_ok() && TcpListener::bind(("127.0.0.1", *port)).is_ok();
        if free {
            // Locked until the process ends.
            std::mem::forget(lock);
        }
        free
    };
    (21_000..29_000).find(is_free).expect("a port is free")
}

/// A start-stop circuit with a timer and a counted edge.
pub const MOTOR: &str = "\
LD X000      ; start
OR M0
ANI X001     ; stop
OUT M0       ; motor latch
LD M0
OUT T0 K3
LD T0
OUT Y000     ; main contactor
LDP X002
ADD D0 K1 D0
LD>= D0 K10
OUT Y001
END
";

/// A motor that runs forward and backward; `lock` is the contact before the second coil.
pub fn reverser(lock: &str) -> String {
    format!(
        "\
;! Y000 = forward contactor
;! Y001 = reverse contactor
LD X000
OR Y000
ANI X002
ANI Y001
OUT Y000
LD X001
OR Y001
ANI X002
{lock}
OUT Y001
END
"
    )
}

/// The number of the CPU type FX3U/FX3UC.
pub const FX3U: u16 = 0x0208;

/// A `MAIN.wpg` for the CPU type with this number, with these bodies of tokens.
pub fn wpg(cpu: u16, bodies: &[&[u8]]) -> Vec<u8> {
    let mut bytes = vec![0x40, 0x00, 0x22, 0x01];
    bytes.resize(0x24, b' ');
    bytes.extend([0x04, 0x02]);
    bytes.extend(cpu.to_le_bytes());
    bytes.resize(0x40, 0xFF);
    bytes.extend([0x04, 0x00, 0xFF, 0xFF]);
    for body in bodies {
        let len = body.len() as u8 + 2;
        bytes.push(len);
        bytes.extend_from_slice(body);
        bytes.push(len);
    }
    bytes.extend([0x02; 64]);
    bytes
}

/// A separate folder with these files.
pub fn folder(files: &[(&str, &[u8])]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, content) in files {
        fs::write(folder.path().join(name), content).unwrap();
    }
    folder
}

pub fn rungc(folder: &Path, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_rungc"))
        .args(args)
        .current_dir(folder)
        .output()
        .unwrap()
}

/// Builds a program in Rust: emits a package with these arguments into a folder and lets cargo build it. Returns its
/// executable `name`.
pub fn built_in_rust(folder: &Path, args: &[&str], output: &str, name: &str) -> PathBuf {
    let objects = cargo(folder, args, output, &["build"]);
    let executable = folder.join(output).join(name);
    let built = fs::read(objects.path().join("debug").join(name)).unwrap();
    write_executable(&executable, &built);
    executable
}

/// Emits a package in Rust with these arguments into a folder and lets cargo do something with it, with the runtime
/// that all tests share. Returns the folder where that is compiled once.
pub fn cargo(folder: &Path, args: &[&str], output: &str, command: &[&str]) -> Slot {
    let kept = cache::folder().unwrap();
    let runtime = library::unpacked(&kept).unwrap();
    let form = ["--emit", "rust", "--main", "-o", output, "--runtime"];
    let emitted = rungc(
        folder,
        &[args, &form, &[runtime.to_str().unwrap()]].concat(),
    );
    assert!(emitted.status.success(), "{}", text(&emitted.stderr));
    let package = folder.join(output);
    let objects = Slot::wait(kept.join("packages")).unwrap();
    // Cargo takes packages with the same name for one, and compiles those again that are newer.
    for root in ["src/lib.rs", "src/main.rs"] {
        cache::touch(&package.join(root)).unwrap();
    }
    let done = Command::new("cargo")
        .args(command)
        .args(["--quiet", "--offline"])
        .env("CARGO_PROFILE_DEV_DEBUG", "false")
        .env("CARGO_INCREMENTAL", "0")
        .env("CARGO_TARGET_DIR", objects.path())
        .current_dir(&package)
        .output()
        .unwrap();
    assert!(done.status.success(), "{}", text(&done.stderr));
    objects
}

/// Writes a file that can be executed. On Unix a shell writes it: a program that another test starts at that moment
/// would inherit a file that this process has open for writing, and such a file cannot be executed.
pub fn write_executable(path: &Path, contents: &[u8]) {
    if !cfg!(unix) {
        return fs::write(path, contents).unwrap();
    }
    let mut shell = Command::new("sh")
        .args(["-c", "cat >\"$0\" && chmod 755 \"$0\""])
        .arg(path)
        .stdin(Stdio::piped())
        .spawn()
        .unwrap();
    shell.stdin.take().unwrap().write_all(contents).unwrap();
    assert!(shell.wait().unwrap().success());
}

pub fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// Times differ from run to run, paths and numbers of errors from system to system.
pub fn normal(text: &str, folder: &Path) -> String {
    let text = text.replace(&folder.display().to_string(), "FOLDER");
    let absent = std::io::Error::from_raw_os_error(2).to_string();
    let text = text.replace(&absent, "No such file or directory (os error 2)");
    let text = text.replace(r"FOLDER\", "FOLDER/");
    let mut lines = Vec::new();
    for line in text.lines() {
        let mut line = line.to_owned();
        if let Some((before, rest)) = line.split_once(") in ") {
            let rest = rest.trim_start_matches(|c: char| c.is_ascii_digit());
            line = format!("{before}) in …{rest}");
        }
        if let Some((before, _)) = line.split_once(" failed (") {
            line = format!("{before} failed (… s)");
        }
        lines.push(line);
    }
    lines.join("\n")
}

/// The text with slashes in paths, as on Unix. JSON doubles backslashes; those of its line breaks stay.
pub fn with_slashes(text: &str) -> String {
    if cfg!(unix) {
        return text.to_owned();
    }
    let text = text.replace(r"\\", "/");
    let mut parts = text.split('\\');
    let mut slashed = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        slashed.push(if part.starts_with('n') { '\\' } else { '/' });
        slashed += part;
    }
    slashed
}

/// Command, its output and its exit code.
pub fn shown(folder: &Path, args: &[&str]) -> String {
    let output = rungc(folder, args);
    let (out, err) = (text(&output.stdout), text(&output.stderr));
    for printed in [&out, &err] {
        assert!(
            !printed.contains('\u{1b}'),
            "colours without a terminal: {printed}"
        );
        assert!(!printed.contains("panicked"), "{printed}");
    }
    let code = output.status.code().unwrap();
    let args = args.join(" ");
    format!(
        "$ rungc {args}\n{}\n--- standard error\n{}\n--- exit code {code}",
        normal(&out, folder),
        normal(&err, folder)
    )
}

pub fn code(folder: &Path, args: &[&str]) -> i32 {
    rungc(folder, args).status.code().unwrap()
}
