//! Several programs in one firmware: one folder, one Makefile, one set of shared files.

use crate::common::{folder, rungc, text};
use crate::tools::tools;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// Needs no runtime; takes an input edge, so that it has a board's header.
const LIGHT: &[u8] = b"EI\nLD X001\nOUT Y000\nFEND\nI001\nLD M8000\nINC D0\nIRET\nEND\n";

/// Calls the runtime.
const TANK: &[u8] = b"LD X001\nASC ABCDEFGH D10\nOUT Y001\nEND\n";

/// Uses both.
const FIRMWARE: &str = r#"
#include "light.h"
#include "light_access.h"
#include "tank.h"
#include "tank_access.h"
#include <stdio.h>

static light_plc light;
static tank_plc tank;

int main(void)
{
    int32_t value = 0;

    light_init(&light);
    tank_init(&tank);
    light.X1 = true;
    tank.X1 = true;
    light_scan(&light, 0, 0);
    tank_scan(&tank, 0, 0);
    tank_read_named(&tank, "D10", &value);
    printf("%d %d %x\n", light_output(&light, 0), tank.Y1, (unsigned)value);
    return 0;
}
"#;

const STRICT: &str = "-std=c99 -O1 -Wall -Wextra -Wconversion -Werror -pedantic";

fn make(folder: &Path, args: &[&str]) -> Output {
    let mut make = Command::new("make");
    make.args(args).current_dir(folder.join("plc"));
    make.env("RUNTIME_OPT", "0").output().unwrap()
}

#[test]
fn programs_of_one_firmware_share_files_and_a_makefile() {
    if !tools(&["make", "gcc"]) {
        return;
    }
    let folder = folder(&[("light.il", LIGHT), ("tank.il", TANK)]);
    let path = folder.path();
    let args = "build light.il tank.il --emit c --device-access -o plc";
    let args: Vec<&str> = args.split(' ').collect();
    let built = rungc(path, &args);
    let messages = text(&built.stderr);
    assert!(built.status.success(), "{messages}");
    assert!(
        messages.contains("Emitted plc/Makefile for 2 programs"),
        "{messages}"
    );
    let mut there = Vec::new();
    for shared in [
        "rungc.h",
        "rungc_rt.h",
        "rungc_board.h",
        "rungc_access.h",
        "Makefile",
    ] {
        assert!(path.join("plc").join(shared).is_file(), "{shared}");
        there.extend(["light", "tank"].map(|name| path.join("plc").join(name).join(shared)));
    }
    assert!(!there.iter().any(|path| path.exists()), "{there:?}");
    fs::write(path.join("main.c"), FIRMWARE).unwrap();
    let library = "rungc-rt/target/release/librungc_rt.a";
    let flags = format!("CFLAGS={STRICT}");
    for (cc, known) in [
        ("gcc", "CARGOFLAGS="),
        ("clang", "RUNGC_RT=rungc-rt/target/release/librungc_rt.a"),
    ] {
        if !tools(&[cc]) {
            continue;
        }
        let compiler = format!("CC={cc}");
        let made = make(path, &["-B", &compiler, &flags, known]);
        assert!(made.status.success(), "{cc}: {}", text(&made.stderr));
        let linked = Command::new(cc)
            .args(STRICT.split(' '))
            .args([
                "-Iplc",
                "-Iplc/light",
                "-Iplc/tank",
                "main.c",
                "plc/light/liblight.a",
                "plc/tank/libtank.a",
            ])
            .arg(format!("plc/{library}"))
            .args(["-o", "firmware"])
            .current_dir(path)
            .output()
            .unwrap();
        assert!(linked.status.success(), "{cc}: {}", text(&linked.stderr));
        let ran = Command::new(path.join("firmware")).output().unwrap();
        assert_eq!(text(&ran.stdout), "1 1 4241\n", "{cc}");
    }
    other_headers_are_rejected(path, library);
    // The folder is not written into a second time.
    let again = rungc(path, &args);
    assert_eq!(again.status.code(), Some(2));
    assert!(
        text(&again.stderr).contains("already exists"),
        "{}",
        text(&again.stderr)
    );
    let forced = rungc(path, &[&args[..], &["--force"]].concat());
    assert!(forced.status.success(), "{}", text(&forced.stderr));
}

/// A header of another version is rejected by the programs that include it.
fn other_headers_are_rejected(path: &Path, library: &str) {
    for (header, guard) in [("rungc.h", "RUNGC_H"), ("rungc_rt.h", "RUNGC_RT_H")] {
        let file = path.join("plc").join(header);
        let right = fs::read_to_string(&file).unwrap();
        let wrong = right.replace(&format!("{guard}_STAMP 0x"), &format!("{guard}_STAMP 0x1"));
        assert_ne!(right, wrong);
        fs::write(&file, wrong).unwrap();
        let made = make(path, &["CC=gcc", &format!("RUNGC_RT={library}")]);
        let messages = text(&made.stderr);
        let expected =
            format!("tank.h and the {header} that was found come from different versions");
        assert!(!made.status.success(), "{header}");
        assert!(
            messages.contains(&expected) || messages.contains("light.h and the rungc.h"),
            "{messages}"
        );
        fs::write(&file, right).unwrap();
    }
}

/// Each host is a separate executable.
#[test]
fn hosts_are_built_by_one_makefile() {
    if !tools(&["make", "gcc"]) {
        return;
    }
    let folder = folder(&[
        ("pump.il", b"LD X0\nOUT Y0\nEND\n"),
        ("fan.il", b"LD X1\nOUT Y1\nEND\n"),
    ]);
    let path = folder.path();
    let args = [
        "build", "pump.il", "fan.il", "--emit", "c", "--main", "-o", "plc",
    ];
    assert!(rungc(path, &args).status.success());
    let made = make(path, &[&format!("CFLAGS={STRICT}")]);
    assert!(made.status.success(), "{}", text(&made.stderr));
    for name in ["pump", "fan"] {
        assert!(path.join("plc").join(name).join(name).is_file());
    }
}
