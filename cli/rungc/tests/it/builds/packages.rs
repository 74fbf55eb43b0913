//! Folders for Arduino, PlatformIO, Zephyr and ESP-IDF.
//!
//! Arduino's are compiled by its own builder with its own core and executed on a simulated ATmega2560. PlatformIO's
//! and ESP-IDF's tools check their descriptions. Neither Zephyr nor ESP-IDF come from a registry: their folders are
//! built by CMake with `stubs`, the functions and declarations that they use.

use super::{LIGHT, TANK, emit, run};
use crate::common::{MOTOR, folder, text};
use crate::tools::{leave_out, tools};
use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};

const ARITH: &[u8] = include_bytes!("arith.il");

fn programs() -> tempfile::TempDir {
    folder(&[
        ("motor.il", MOTOR.as_bytes()),
        ("light.il", LIGHT),
        ("tank.il", TANK),
        ("arith.il", ARITH),
    ])
}

/// Debian's core of Arduino for AVR.
const CORE: &str = "/usr/share/arduino/hardware/arduino";

/// Compiles a sketch for an ATmega2560. Debian's compiler is older than the core: it lacks `DECIMAL_DIG` in C++.
fn sketch(folder: &Path, sketch: &str) -> PathBuf {
    let out = folder.join("out");
    let _ = fs::remove_dir_all(&out);
    fs::create_dir(&out).unwrap();
    run(
        folder,
        &format!(
            "arduino-builder -compile -hardware hardware -tools /usr/bin -libraries libraries -build-path {} -warnings all \
             -fqbn arduino:avr:mega:cpu=atmega2560 -prefs compiler.cpp.extra_flags=-DDECIMAL_DIG=17 \
             -prefs runtime.tools.avr-gcc.path=/usr -prefs runtime.tools.avrdude.path=/usr -prefs runtime.ide.path=/usr/share/arduino \
             {sketch}",
            out.display()
        ),
    );
    let name = Path::new(sketch).file_name().unwrap().to_string_lossy();
    out.join(format!("{name}.elf"))
}

#[test]
fn arduino_compiles_libraries_and_an_avr_computes_what_a_pc_computes() {
    if !tools(&[
        "arduino-builder",
        "arduino-ctags",
        "avr-gcc",
        "simavr",
        "gcc",
    ]) {
        return;
    }
    if !Path::new(CORE).is_dir() {
        return leave_out("core of Arduino for AVR");
    }
    let folder = programs();
    let path = folder.path();
    fs::create_dir(path.join("hardware")).unwrap();
    symlink(CORE, path.join("hardware/arduino")).unwrap();
    fs::copy(
        "/usr/share/arduino-builder/platform.txt",
        path.join("hardware/platform.txt"),
    )
    .unwrap();
    for name in ["motor", "light"] {
        emit(
            path,
            &format!("build {name}.il --emit arduino -o libraries/{name}"),
        );
        sketch(
            path,
            &format!("libraries/{name}/examples/{name}/{name}.ino"),
        );
    }
    emit(
        path,
        "build arith.il --emit arduino --device-access -o libraries/arith",
    );
    let compare = path.join("compare");
    fs::create_dir(&compare).unwrap();
    fs::write(compare.join("compare.h"), include_str!("compare.h")).unwrap();
    fs::write(compare.join("compare.ino"), COMPARE_INO).unwrap();
    fs::write(path.join("host.c"), COMPARE_C).unwrap();
    let elf = sketch(path, "compare/compare.ino");
    let simulated = run(
        path,
        &format!(
            "timeout 60 simavr -m atmega2560 -f 16000000 {}",
            elf.display()
        ),
    );
    let source = "libraries/arith/src";
    run(
        path,
        &format!(
            "gcc -std=c99 -I{source} -Icompare host.c {source}/arith.c {source}/arith_access.c -o host"
        ),
    );
    let expected = run(path, "./host");
    let sums = |printed: &str| {
        let lines = printed.lines().filter_map(|line| line.split_once('='));
        lines
            .map(|(_, sum)| sum.chars().take_while(char::is_ascii_hexdigit).collect())
            .collect::<Vec<String>>()
    };
    assert_eq!(sums(&expected).len(), 300, "{expected}");
    assert_eq!(sums(&simulated), sums(&expected));
}

/// A sketch that ends: with interrupts off, a sleeping processor does nothing more, and its simulator stops.
const COMPARE_INO: &str = r#"
#include <avr/sleep.h>
#include "compare.h"

static void show(uint32_t sum)
{
    Serial.print('=');
    Serial.println(sum, HEX);
}

void setup()
{
    Serial.begin(1000000);
    compare(show);
    Serial.flush();
    cli();
    sleep_enable();
    sleep_cpu();
}

void loop()
{
}
"#;

const COMPARE_C: &str = r#"
#include "compare.h"
#include <stdio.h>

static void show(uint32_t sum)
{
    printf("=%lX\n", (unsigned long)sum);
}

int main(void)
{
    compare(show);
    return 0;
}
"#;

#[test]
fn a_program_that_calls_the_runtime_needs_its_library_for_arduino() {
    let folder = programs();
    let path = folder.path();
    let rejected = super::rungc(path, &["build", "tank.il", "--emit", "arduino"]);
    assert_eq!(rejected.status.code(), Some(2));
    assert_eq!(
        text(&rejected.stderr),
        "rungc: tank calls the runtime library, which Arduino cannot build: name the processor with --target \
         (`rungc book builds`)\n"
    );
    assert!(!path.join("tank-arduino").exists());
}

/// A tool that pip installs beside the Python with the packages of tests.
fn python_tool(name: &str) -> Option<String> {
    let python = std::env::var_os("RUNGC_PYTHON").map(PathBuf::from);
    let tool = python.and_then(|python| Some(python.parent()?.join(name)));
    let found = tool.filter(|tool| tool.is_file());
    if found.is_none() {
        leave_out(name);
    }
    Some(found?.display().to_string())
}

#[test]
fn platformio_packs_a_library() {
    let Some(pio) = python_tool("pio") else {
        return;
    };
    let folder = programs();
    let path = folder.path();
    emit(path, "build light.il --emit platformio -o light");
    // Packing validates the manifest.
    run(
        path,
        &format!("env PLATFORMIO_CORE_DIR=core {pio} pkg pack light"),
    );
    let packed = run(path, "tar -tzf light-0.1.0.tar.gz");
    for there in [
        "library.json",
        "src/light.c",
        "examples/light/platformio.ini",
    ] {
        assert!(
            packed.lines().any(|line| line == there),
            "{there}: {packed}"
        );
    }
    let broken = path.join("light/library.json");
    let manifest = fs::read_to_string(&broken).unwrap();
    fs::write(&broken, manifest.replace("\"version\"", "\"edition\"")).unwrap();
    let output = std::process::Command::new(&pio)
        .args(["pkg", "pack", "light"])
        .env("PLATFORMIO_CORE_DIR", path.join("core"))
        .current_dir(path)
        .output()
        .unwrap();
    assert!(
        !output.status.success(),
        "a manifest without a version is packed"
    );
}

#[test]
fn the_component_manager_of_esp_idf_packs_a_component() {
    let Some(compote) = python_tool("compote") else {
        return;
    };
    let folder = programs();
    let path = folder.path();
    emit(path, "build light.il --emit esp-idf -o light");
    run(&path.join("light"), &format!("{compote} manifest lint"));
    run(
        &path.join("light"),
        &format!("{compote} component pack --name light"),
    );
    let packed = run(path, "tar -tzf light/dist/light_0.1.0.tgz");
    assert!(
        packed.contains("light.c") && packed.contains("idf_component.yml"),
        "{packed}"
    );
}

/// The folder of stubs.
const STUBS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/it/builds/stubs");

/// Compiles a source without a warning; returns its object.
fn strict(folder: &Path, compiler: &str, includes: &[&str], source: &str) {
    let includes: Vec<String> = includes.iter().map(|path| format!("-I{path}")).collect();
    run(
        folder,
        &format!(
            "{compiler} -std=c11 -Wall -Wextra -Wno-missing-field-initializers -Werror {} -c {source} -o main.o",
            includes.join(" ")
        ),
    );
}

#[test]
fn a_component_of_esp_idf_builds_for_risc_v() {
    let compiler = "riscv64-unknown-elf-gcc";
    if !tools(&["cmake", "make", compiler]) {
        return;
    }
    let folder = programs();
    let path = folder.path();
    let flags = "-march=rv32imc_zicsr;-mabi=ilp32;--specs=picolibc.specs";
    for (name, definition) in [("light", ""), ("tank", "-DRUNGC_RT=/dev/null")] {
        emit(path, &format!("build {name}.il --emit esp-idf -o {name}"));
        let project = format!(
            "cmake_minimum_required(VERSION 3.16)\nproject(firmware LANGUAGES C)\nadd_compile_options({flags})\n\
             include({STUBS}/idf.cmake)\ninclude({name}/CMakeLists.txt)\n"
        );
        let inside = path.join(name).join("CMakeLists.txt");
        let lists = fs::read_to_string(&inside).unwrap();
        fs::write(
            &inside,
            lists.replace(&format!("\"{name}"), &format!("\"{name}/{name}")),
        )
        .unwrap();
        fs::write(path.join("CMakeLists.txt"), project).unwrap();
        run(
            path,
            &format!(
                "cmake -S . -B {name}-out -DCMAKE_C_COMPILER={compiler} -DCMAKE_SYSTEM_NAME=Generic \
                 -DCMAKE_TRY_COMPILE_TARGET_TYPE=STATIC_LIBRARY {definition}"
            ),
        );
        run(path, &format!("cmake --build {name}-out"));
        let main = format!("{name}/examples/{name}/main/main.c");
        let compiler = format!("{compiler} {}", flags.replace(';', " "));
        strict(path, &compiler, &[name, &format!("{STUBS}/esp_idf")], &main);
    }
}

#[test]
fn a_module_of_zephyr_builds() {
    if !tools(&["cmake", "make", "gcc"]) {
        return;
    }
    let folder = programs();
    let path = folder.path();
    for (name, definition) in [("light", ""), ("tank", "-DRUNGC_RT=/dev/null")] {
        emit(path, &format!("build {name}.il --emit zephyr -o {name}"));
        let option = format!("CONFIG_PLC_{}", name.to_uppercase());
        let project = format!(
            "cmake_minimum_required(VERSION 3.20)\nproject(firmware LANGUAGES C)\nset({option} y)\n\
             include({STUBS}/zephyr.cmake)\nadd_subdirectory({name}/zephyr)\n"
        );
        fs::write(path.join("CMakeLists.txt"), project).unwrap();
        run(path, &format!("cmake -S . -B {name}-out {definition}"));
        run(path, &format!("cmake --build {name}-out"));
        let main = format!("{name}/samples/{name}/src/main.c");
        strict(path, "gcc", &[name, &format!("{STUBS}/zephyr")], &main);
    }
}

#[test]
fn zephyrs_own_parser_reads_the_options_of_a_module() {
    let Some(python) = python_tool("python") else {
        return;
    };
    let folder = programs();
    let path = folder.path();
    emit(path, "build tank.il --emit zephyr -o tank");
    let script = "import kconfiglib\nsymbols = kconfiglib.Kconfig('tank/zephyr/Kconfig', warn=False).unique_defined_syms\n\
                  print(*sorted(symbol.name for symbol in symbols))";
    let output = std::process::Command::new(python)
        .args(["-c", script])
        .current_dir(path)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(text(&output.stdout), "PLC_TANK PLC_TANK_RUST_TARGET\n");
}
