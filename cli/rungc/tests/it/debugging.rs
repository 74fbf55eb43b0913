//! `rungc dap` under the client of the protocol's authors.

use crate::common::clients::{node, succeeds};
use crate::common::{code, folder};

/// A motor that stays on.
const LIST: &[u8] =
    b";! X000 = Start\nLD X000\nOR M0\nANI X001\nOUT M0\nOUT Y000\nLD Y000\nOUT T0 K5\nLD T0\nOUT Y001\nEND\n";

#[test]
fn the_client_of_the_protocol_debugs_a_program() {
    let Some(mut debugger) = node("@vscode/debugadapter-testsupport", "debugger.js") else {
        return;
    };
    let folder = folder(&[("motor.il", LIST)]);
    let list = folder.path().join("motor.il");
    let xml = folder.path().join("motor.xml");
    let args = ["convert", "motor.il", "--to", "plcopen", "-o", "motor.xml"];
    assert_eq!(code(folder.path(), &args), 0);
    debugger.arg(env!("CARGO_BIN_EXE_rungc")).args([list, xml]);
    assert!(succeeds(debugger).contains("3 sessions"));
}
