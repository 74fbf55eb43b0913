//! Emitted folders in the builds that firmware has.

// With a C compiler and libraries as Linux has them.
#[cfg(target_os = "linux")]
mod fmu;
mod misra;
// With tools as Debian installs them.
#[cfg(unix)]
mod packages;

use crate::common::{folder, rungc, text};
use crate::tools::tools;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Needs no runtime; takes an input edge, so that it has a board's header.
const LIGHT: &[u8] = b"EI\nLD X001\nOUT Y000\nFEND\nI001\nLD M8000\nINC D0\nIRET\nEND\n";

/// Calls the runtime.
const TANK: &[u8] = b"LD X001\nASC ABCDEFGH D10\nOUT Y001\nEND\n";

/// Uses both.
const FIRMWARE: &str = r#"
#include "light.h"
#include "tank.h"
#include <stdio.h>

static light_plc light;
static tank_plc tank;

int main(void)
{
    light_init(&light);
    tank_init(&tank);
    light.X1 = true;
    tank.X1 = true;
    light_scan(&light, 0, 0);
    tank_scan(&tank, 0, 0);
    printf("%d %d %x\n", light_output(&light, 0), tank_output(&tank, 1), (unsigned)tank.D10[0]);
    return 0;
}
"#;

/// Runs a command to its end and returns what it prints.
fn run(folder: &Path, command: &str) -> String {
    let mut words = command.split_whitespace();
    let output = Command::new(words.next().unwrap())
        .args(words)
        .current_dir(folder)
        .output()
        .unwrap();
    let messages = text(&output.stdout) + &text(&output.stderr);
    assert!(output.status.success(), "{command}: {messages}");
    messages
}

/// Emits programs in C into the folder `plc`.
fn emit(folder: &Path, args: &str) {
    let args: Vec<&str> = args.split_whitespace().collect();
    let built = rungc(folder, &args);
    assert!(built.status.success(), "{}", text(&built.stderr));
}

/// A CMake project that finds the programs in some way, and what its executable prints.
fn firmware(path: &Path, name: &str, finds: &str, options: &str) -> String {
    let project = path.join(name);
    fs::create_dir(&project).unwrap();
    fs::write(project.join("main.c"), FIRMWARE).unwrap();
    let lists = format!(
        "cmake_minimum_required(VERSION 3.16)\nproject(firmware LANGUAGES C)\n{finds}\n\
         add_executable(firmware main.c)\ntarget_link_libraries(firmware PRIVATE rungc::light rungc::tank)\n"
    );
    fs::write(project.join("CMakeLists.txt"), lists).unwrap();
    run(path, &format!("cmake -S {name} -B {name}/out {options}"));
    run(path, &format!("cmake --build {name}/out"));
    run(path, &format!("{name}/out/firmware"))
}

#[test]
fn cmake_takes_emitted_folders_as_they_are_or_installed() {
    if !tools(&["cmake", "make", "gcc"]) {
        return;
    }
    let folder = folder(&[("light.il", LIGHT), ("tank.il", TANK)]);
    let path = folder.path();
    emit(path, "build light.il --emit c -o light-c");
    emit(path, "build tank.il --emit c -o tank-c");
    emit(path, "build tank.il --emit lib -o lib");
    let runtime = path.join("lib/librungc_rt.a");
    let built = format!("-DRUNGC_RT={}", runtime.display());
    let subdirectories = "add_subdirectory(../light-c light)\nadd_subdirectory(../tank-c tank)";
    let printed = firmware(path, "inside", subdirectories, &built);
    assert_eq!(printed, "1 1 4241\n");
    for name in ["light", "tank"] {
        run(
            path,
            &format!("cmake -S {name}-c -B {name}-out -DCMAKE_INSTALL_PREFIX=there {built}"),
        );
        run(path, &format!("cmake --build {name}-out"));
        run(path, &format!("cmake --install {name}-out --prefix there"));
    }
    // An installation does not need its sources, and may be moved.
    for gone in ["light-c", "tank-c", "light-out", "tank-out", "lib"] {
        fs::remove_dir_all(path.join(gone)).unwrap();
    }
    fs::rename(path.join("there"), path.join("moved")).unwrap();
    let found = "find_package(plc_light REQUIRED)\nfind_package(plc_tank REQUIRED)";
    let prefix = format!("-DCMAKE_PREFIX_PATH={}", path.join("moved").display());
    assert_eq!(firmware(path, "found", found, &prefix), "1 1 4241\n");
}

#[test]
fn cmake_builds_programs_that_share_a_folder_with_their_runtime_and_main_programs() {
    if !tools(&["cmake", "make", "gcc"]) {
        return;
    }
    let folder = folder(&[("light.il", LIGHT), ("tank.il", TANK)]);
    let path = folder.path();
    emit(path, "build light.il tank.il --emit c -o plc");
    let printed = firmware(
        path,
        "inside",
        "add_subdirectory(../plc plc)",
        "-DRUNGC_OPT=0",
    );
    assert_eq!(printed, "1 1 4241\n");
    emit(path, "build light.il --emit c --main -o host");
    run(path, "cmake -S host -B host/out");
    run(path, "cmake --build host/out");
    let help = run(path, "host/out/light --help");
    assert!(help.contains("Runs light.il in real time"), "{help}");
}

#[test]
fn cmake_knows_the_target_that_a_folder_is_emitted_for() {
    let folder = folder(&[("tank.il", TANK)]);
    let path = folder.path();
    emit(
        path,
        "build tank.il --emit c --target thumbv7em-none-eabihf -o plc",
    );
    let lists = fs::read_to_string(path.join("plc/CMakeLists.txt")).unwrap();
    assert!(
        lists.contains("set(RUNGC_TARGET \"thumbv7em-none-eabihf\" CACHE"),
        "{lists}"
    );
}

#[test]
fn defmt_is_for_emitted_rust() {
    let folder = folder(&[("light.il", LIGHT)]);
    let built = rungc(
        folder.path(),
        &["build", "light.il", "--emit", "c", "--defmt"],
    );
    assert_eq!(built.status.code(), Some(2));
    insta::assert_snapshot!(
        text(&built.stderr).trim_end(),
        @"rungc: --defmt only applies to --emit rust without --board (`rungc book builds`)"
    );
}
