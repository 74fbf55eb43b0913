//! Reports of operation errors to a host.

use crate::build;
use rungc_codegen_c::{Options, emit};
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;
use std::process::Command;

/// Two instructions that fail in one scan.
const LIST: &str = "LD X0\nMOV K30000 Z0\nMOV K1 D500Z0\nDIV D0 D1 D2\nEND\n";

/// A host to which each is reported.
const HOST: &str = r#"
#include "probe.h"
#include <stdio.h>

static void report(const void *program, uint16_t code, uint16_t step)
{
    const probe_plc *plc = program;
    printf("%u at step %u, Z0 is %d\n", code, step, plc->Z0);
}

int main(void)
{
    static probe_plc plc;

    probe_init(&plc);
    plc.X0 = true;
    probe_scan(&plc, 0, 0);
    plc.on_error = report;
    probe_power_cycle(&plc);
    plc.X0 = true;
    probe_scan(&plc, 0, 0);
    printf("the last at step %u\n", probe_error(&plc).step);
    return 0;
}
"#;

#[test]
fn each_error_of_a_scan_reaches_the_host() {
    let read = rungc_frontend::read_text("probe.il", LIST);
    let options = CompileOptions {
        model: Some(ModelId::Fx3u),
        name: Some("probe".to_string()),
        optimise: true,
        ..CompileOptions::default()
    };
    let module = compile(&read.program, &options).module.unwrap();
    let folder = tempfile::tempdir().unwrap();
    for file in emit(&module, &Options::default()) {
        std::fs::write(folder.path().join(&file.path), &file.contents).unwrap();
    }
    std::fs::write(folder.path().join("host.c"), HOST).unwrap();
    for cc in build::compilers() {
        let built = Command::new(cc)
            .current_dir(folder.path())
            .args(build::STRICT)
            .args(["-O1", "-DPLC_ON_ERROR", "-o", "host", "host.c", "probe.c"])
            .output()
            .unwrap();
        assert!(
            built.status.success(),
            "{cc}: {}",
            String::from_utf8_lossy(&built.stderr)
        );
        let ran = Command::new(folder.path().join("host")).output().unwrap();
        let reported = String::from_utf8_lossy(&ran.stdout);
        assert_eq!(
            reported,
            "6706 at step 6, Z0 is 30000\n6706 at step 11, Z0 is 30000\nthe last at step 11\n",
            "{cc}"
        );
    }
}
