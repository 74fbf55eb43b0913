//! Clients that others have written, as far as they are installed.

use super::text;
use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// A script of `tests/clients`.
pub fn client(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/clients")
        .join(name)
}

/// Returns true if the peer is installed. If it is not, but `variable` says that it has to be, the test fails.
pub fn there(peer: &str, variable: &str, mut look: Command) -> bool {
    let look = look.stdout(Stdio::null()).stderr(Stdio::null());
    if look.status().is_ok_and(|status| status.success()) {
        return true;
    }
    assert!(
        env::var_os(variable).is_none(),
        "{variable} is set, but there is no {peer}"
    );
    eprintln!("skipped: there is no {peer} ({variable}; see .ci/run)");
    false
}

/// Runs a client to its end, which is well if it says so.
pub fn succeeds(mut client: Command) -> String {
    let output = client.output().unwrap();
    let (shown, errors) = (text(&output.stdout), text(&output.stderr));
    assert!(output.status.success(), "{shown}{errors}");
    shown
}

/// A client of `tests/clients` for Python, if there is a Python that has the module.
pub fn python(module: &str, script: &str) -> Option<Command> {
    let python = env::var_os("RUNGC_PYTHON").unwrap_or_else(|| "python3".into());
    let mut import = Command::new(&python);
    import.args(["-c", &format!("import {module}")]);
    let mut run = Command::new(&python);
    run.arg(client(script));
    there(module, "RUNGC_PYTHON", import).then_some(run)
}

/// A client of `tests/clients` for Node, if the package is there.
pub fn node(package: &str, script: &str) -> Option<Command> {
    let modules = env::var_os("RUNGC_NODE_MODULES").unwrap_or_default();
    let command = || {
        let mut command = Command::new("node");
        command.env("NODE_PATH", &modules);
        command
    };
    let mut require = command();
    require.args(["-e", &format!("require('{package}')")]);
    let mut run = command();
    run.arg(client(script));
    there(package, "RUNGC_NODE_MODULES", require).then_some(run)
}
