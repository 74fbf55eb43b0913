//! Programs that call the runtime: built from sources that are complete, once for each target.

use crate::common::{MOTOR, folder, text};
use std::path::Path;
use std::process::{Command, Output};

const PROGRAM: &[u8] = b"LD X000\nPID D0 D1 D100 D150\nEND\n";

/// Calls rungc without a registry, and with variables that have led builds astray.
fn rungc(folder: &Path, args: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_rungc"));
    command
        .args(args)
        .current_dir(folder)
        .env("RUNGC_CACHE_DIR", folder.join("cache"))
        .env("CARGO_HOME", folder.join("no-registry"))
        .env("CARGO_NET_OFFLINE", "true")
        .env("CARGO_TARGET_DIR", folder.join("elsewhere"))
        .env("CFLAGS", "-O1");
    command.output().unwrap()
}

#[test]
fn the_runtime_needs_no_registry_and_is_built_once() {
    let folder = folder(&[("heating.il", PROGRAM)]);
    let build = |name: &str| {
        let output = rungc(
            folder.path(),
            &["build", "heating.il", "--emit", "bin", "-o", name],
        );
        let messages = text(&output.stderr);
        assert!(output.status.success(), "{messages}");
        assert!(folder.path().join(name).is_file());
        messages.contains("Building the runtime")
    };
    assert!(build("first"));
    assert!(!build("second"), "it is in the cache");
    assert!(!folder.path().join("elsewhere").exists());
    let bytes = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    assert_eq!(bytes("first"), bytes("second"));
}

#[test]
fn emitted_crates_come_with_all_they_depend_on() {
    let folder = folder(&[("heating.il", PROGRAM)]);
    let args = ["build", "heating.il", "--emit", "rust", "-o", "plc"];
    let output = rungc(folder.path(), &args);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let cargo = Command::new(env!("CARGO"))
        .args(["check", "--locked", "--offline"])
        .current_dir(folder.path().join("plc"))
        .env("CARGO_HOME", folder.path().join("no-registry"))
        .env("CARGO_TARGET_DIR", folder.path().join("plc/target"))
        .output()
        .unwrap();
    assert!(cargo.status.success(), "{}", text(&cargo.stderr));
}

#[test]
fn emitted_crates_share_a_runtime() {
    let folder = folder(&[("heating.il", PROGRAM), ("motor.il", MOTOR.as_bytes())]);
    let path = folder.path();
    let build = |more: &[&str]| {
        let args = [
            "build",
            "heating.il",
            "motor.il",
            "--emit",
            "rust",
            "-o",
            "plc",
        ];
        rungc(path, &[&args[..], &["--runtime", "rt"], more].concat())
    };
    let output = build(&[]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let check = |package: &str| {
        let checked = Command::new(env!("CARGO"))
            .args(["check", "--locked", "--offline"])
            .current_dir(path.join("plc").join(package))
            .env("CARGO_HOME", path.join("no-registry"))
            .env("CARGO_TARGET_DIR", path.join("target"))
            .output()
            .unwrap();
        let messages = text(&checked.stderr);
        assert!(checked.status.success(), "{messages}");
        assert!(!path.join("plc").join(package).join("rungc-rt").exists());
        messages.contains("Checking rungc-rt")
    };
    assert!(check("heating"));
    assert!(!check("motor"), "it is compiled");
    // Another version, or something else, is not overwritten unless requested.
    let source = path.join("rt/src/lib.rs");
    std::fs::write(&source, "// Changed.").unwrap();
    std::fs::remove_dir_all(path.join("plc")).unwrap();
    let refused = build(&[]);
    assert_eq!(refused.status.code(), Some(2));
    let messages = text(&refused.stderr);
    assert!(
        messages.contains("rt already exists and is not empty"),
        "{messages}"
    );
    assert!(build(&["--force"]).status.success());
    assert_ne!(std::fs::read_to_string(source).unwrap(), "// Changed.");
}

#[test]
fn crates_of_one_firmware_share_a_runtime() {
    let folder = folder(&[("heating.il", PROGRAM), ("motor.il", MOTOR.as_bytes())]);
    let path = folder.path();
    let args = ["build", "heating.il", "motor.il", "--emit", "rust"];
    let output = rungc(path, &[&args[..], &["-o", "plc"]].concat());
    assert!(output.status.success(), "{}", text(&output.stderr));
    let manifest = "[package]\nname = \"firmware\"\nversion = \"0.1.0\"\nedition = \"2024\"\n[workspace]\nexclude = [\"plc\"]\n[dependencies]\n\
                    heating = { path = \"plc/heating\" }\nmotor = { path = \"plc/motor\" }\n\
                    rungc-rt = { path = \"plc/rungc-rt\" }\n";
    let main = "fn main() {\n    let _ = (heating::Heating::new(), motor::Motor::new());\n}\n";
    std::fs::create_dir(path.join("src")).unwrap();
    std::fs::write(path.join("Cargo.toml"), manifest).unwrap();
    std::fs::write(path.join("src/main.rs"), main).unwrap();
    let checked = Command::new(env!("CARGO"))
        .args(["check", "--offline"])
        .current_dir(path)
        .env("CARGO_HOME", path.join("no-registry"))
        .env("CARGO_TARGET_DIR", path.join("target"))
        .output()
        .unwrap();
    assert!(checked.status.success(), "{}", text(&checked.stderr));
}

#[test]
fn a_missing_compiler_is_named() {
    let folder = folder(&[("motor.il", b"LD X000\nOUT Y000\nEND\n")]);
    let output = Command::new(env!("CARGO_BIN_EXE_rungc"))
        .args(["build", "motor.il", "--emit", "bin", "-o", "motor"])
        .current_dir(folder.path())
        .env("CC", "no-such-compiler")
        .output()
        .unwrap();
    let messages = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{messages}");
    assert!(
        messages.contains("no-such-compiler not found"),
        "{messages}"
    );
}
