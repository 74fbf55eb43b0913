//! Devices by number and by name, in programs with and without the runtime.

use crate::build::{STRICT, compilers};
use rungc_codegen_c::{Options, emit};
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;
use rungc_syntax::DeviceClass;
use std::process::Command;

/// Devices of each kind: single ones, arrays, a timer, both kinds of counters, an index register with two names,
/// stations in a grid.
const LIST: &str = "LD X012\nOUT T0 K5\nOUT C0 K3\nLD X001\nOUT C200 K70000\nLD M8000\nMOV D100Z0 D0\nLD X1\nMOV K2 D8028\n";

/// Program that calls the functions of the header.
const CHECKS: &str = r#"
#include "probe_access.h"
#include <stdio.h>

static probe_plc plc;
static int failed;

static void check(bool holds, const char *what)
{
    if (!holds) {
        printf("failed: %s\n", what);
        failed = 1;
    }
}
#define CHECK(holds) check(holds, #holds)

int main(void)
{
    int32_t value = -5;

    probe_init(&plc);
    CHECK(probe_write_named(&plc, "X012", 1));
    CHECK(plc.X12);
    CHECK(probe_write(&plc, PLC_CLASS_X, 1, 7));
    probe_scan(&plc, 0, 0);
    probe_scan(&plc, 200, 0);
    CHECK(probe_read_named(&plc, "T0", &value) && value == 2);
    CHECK(probe_read_named(&plc, "TS0", &value) && value == 0);
    CHECK(probe_write_named(&plc, "TS0", 1) && plc.T0.done && plc.T0.value == 2);
    CHECK(probe_write_named(&plc, "C0", 3) && plc.C0.value == 3);
    CHECK(!probe_write_named(&plc, "C0", 40000) && plc.C0.value == 3);
    CHECK(probe_write(&plc, PLC_CLASS_C, 200, 40000) && plc.C200.value == 40000);
    CHECK(probe_read(&plc, PLC_CLASS_CS, 200, &value) && value == 0);
    CHECK(probe_write(&plc, PLC_CLASS_D, 101, -32768));
    CHECK(probe_read(&plc, PLC_CLASS_D, 101, &value) && value == -32768);
    CHECK(!probe_write(&plc, PLC_CLASS_D, 101, -32769));
    CHECK(probe_read_named(&plc, "Z0", &value) && value == 2);
    CHECK(probe_write_named(&plc, "D8028", 3));
    CHECK(probe_read(&plc, PLC_CLASS_Z, 0, &value) && value == 3);
    for (uint32_t i = 0; i < 12; i++) {
        CHECK(probe_write(&plc, PLC_CLASS_M, 100 + 10 * i, 1));
        probe_scan(&plc, 300, 0);
        CHECK(probe_read(&plc, PLC_CLASS_M, 101 + 10 * i, &value) && value == 1);
        CHECK(probe_read(&plc, PLC_CLASS_M, 101 + 10 * (i + 1), &value) == (i < 11));
    }
    value = 9;
    CHECK(!probe_read(&plc, PLC_CLASS_M, 105, &value));
    CHECK(!probe_read(&plc, PLC_CLASS_R, 0, &value));
    CHECK(!probe_read(&plc, PLC_CLASS_ER, 4000000000u, &value));
    static const char *const wrong[] = {"", "D", "D-1", "X8", "X018", "D1a", "d1", "Q0", "D4294967296", "D65536", "TS", "T", " D0", "D0 "};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        check(!probe_read_named(&plc, wrong[i], &value), wrong[i]);
        check(!probe_write_named(&plc, wrong[i], 0), wrong[i]);
    }
    CHECK(value == 9);
    return failed;
}
"#;

fn module(list: &str, observe: Vec<(DeviceClass, u32)>) -> rungc_ir::Module {
    let read = rungc_frontend::read_text("probe.il", list);
    let options = CompileOptions {
        model: Some(ModelId::Fx3u),
        name: Some("probe".to_string()),
        optimise: true,
        observe,
        ..CompileOptions::default()
    };
    let compiled = compile(&read.program, &options);
    compiled
        .module
        .unwrap_or_else(|| panic!("{:?}", compiled.diagnostics))
}

fn run(module: &rungc_ir::Module, checks: &str) {
    let folder = tempfile::tempdir().unwrap();
    let options = Options {
        access: true,
        ..Options::default()
    };
    let files = emit(module, &options);
    assert!(
        files
            .iter()
            .any(|file| file.path == "Makefile" && file.contents.contains("probe_access.o"))
    );
    for file in &files {
        let path = folder.path().join(&file.path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, &file.contents).unwrap();
    }
    std::fs::write(folder.path().join("checks.c"), checks).unwrap();
    for cc in compilers() {
        let built = Command::new(cc)
            .current_dir(folder.path())
            .args(STRICT)
            .args([
                "-O1",
                "-o",
                "checks",
                "checks.c",
                "probe.c",
                "probe_access.c",
            ])
            .output()
            .unwrap();
        assert!(
            built.status.success(),
            "{cc}: {}",
            String::from_utf8_lossy(&built.stderr)
        );
        let ran = Command::new(folder.path().join("checks")).output().unwrap();
        assert!(
            ran.status.success(),
            "{cc}: {}",
            String::from_utf8_lossy(&ran.stdout)
        );
    }
}

#[test]
fn devices_are_found_by_number_and_by_name() {
    let mut list = LIST.to_string();
    for i in 0..12 {
        let first = 100 + 10 * i;
        list.push_str(&format!("LD M{first}\nOUT M{}\n", first + 1));
    }
    run(&module(&(list + "END\n"), Vec::new()), CHECKS);
}

/// A program that stores nothing has an empty table, which C does not know.
#[test]
fn a_program_without_devices_has_none() {
    let checks = "#include \"probe_access.h\"\n\nint main(void)\n{\n    static probe_plc plc;\n    int32_t value;\n    \
         return probe_read(&plc, PLC_CLASS_X, 0, &value) ? 1 : 0;\n}\n";
    run(&module("END\n", Vec::new()), checks);
}
