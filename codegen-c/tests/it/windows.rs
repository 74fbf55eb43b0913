//! Main programs for Windows compile strictly with mingw. Without it the test says so; with `RUNGC_REQUIRE_EMBEDDED`
//! set, as in CI, that is a failure.

use crate::build::{self, Builder};
use rungc_codegen_c::{Options, emit};
use rungc_syntax::DeviceClass::{D, M};
use rungc_syntax::{Device, NetworkRequest};
use std::process::Command;

const COMPILER: &str = "x86_64-w64-mingw32-gcc";

/// A request for D0 to D3 of a server.
fn request() -> NetworkRequest {
    NetworkRequest {
        server: ([127, 0, 0, 1], 502).into(),
        unit: 1,
        function: 3,
        address: 0,
        count: 4,
        buffer: 0,
        trigger: Device {
            class: M,
            number: 0,
        },
    }
}

#[test]
fn a_host_with_servers_and_requests_compiles_for_windows() {
    if Command::new(COMPILER).arg("--version").output().is_err() {
        let required = std::env::var_os("RUNGC_REQUIRE_EMBEDDED").is_some();
        assert!(!required, "missing: {COMPILER}");
        eprintln!("not run: there is no {COMPILER}");
        return;
    }
    let mut program = Builder::new("client");
    let on = program.bit(M, 0);
    program.write_bit(M, 1, on);
    let value = program.word(D, 0);
    program.write_word(D, 1, value);
    let mut module = program.finish();
    module.requests.push(request());
    let options = Options {
        main: true,
        servers: true,
        ..Options::default()
    };
    let folder = tempfile::tempdir().unwrap();
    let files = emit(&module, &options).into_iter();
    for file in files.filter(|file| !file.path.contains('/')) {
        std::fs::write(folder.path().join(&file.path), &file.contents).unwrap();
    }
    let compiled = Command::new(COMPILER)
        .args(build::STRICT)
        .args(["-fsyntax-only", "main.c"])
        .current_dir(folder.path())
        .output()
        .unwrap();
    let errors = String::from_utf8_lossy(&compiled.stderr);
    assert!(compiled.status.success() && errors.is_empty(), "{errors}");
}
