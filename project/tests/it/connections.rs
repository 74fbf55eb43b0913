//! `[io]`: messages about connections that cannot be made.

use crate::common::{mistakes, parse};
use rungc_models::{Model, ModelId};
use rungc_project::Error;

#[test]
fn connections_that_cannot_be_made() {
    insta::assert_snapshot!(
        "io",
        mistakes(
            r#"
[io]
name = "valves"
[io.valves]
modbus-tcp = "192.168.1.20"
unit = 300
fault = true
X000-X007 = "read coil 0"
[io.both]
modbus-tcp = "192.168.1.20"
mqtt = "192.168.1.21"
[io.list]
files = ["a", "b"]
[io.one]
files = "."
X000-X007 = "read a"
[io.two]
files = "."
X007-X010 = "read b"
"#
        )
    );
    let project = parse("[io.a]\nfiles = '.'\nX000 = 'read a'\nX777 = 'read b'\n").unwrap();
    let Err(Error::Invalid { diagnostics, .. }) = project.check_io(Model::get(ModelId::Fx1s))
    else {
        panic!("X777 is taken");
    };
    let why = &diagnostics.sorted()[0];
    assert_eq!(why.message, "X777 does not exist on Mitsubishi FX1S");
    assert_eq!(project.source.slice(why.span), "X777");
}
