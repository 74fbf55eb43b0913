//! Requests of a program to servers over TCP.

use rungc_models::{Model, ModelId};
use rungc_project::{Error, Project};
use std::path::Path;

#[test]
fn rows_with_a_host_become_requests() {
    let text = r#"[project]
program = "read.rs"

[[modbus]]
host = "192.168.50.12"
read = "registers"
address = 0x1F4
buffer = "D205"

[[modbus]]
host = "[::1]:5020"
station = 255
write = "coils"
address = 3
buffer = "D7999"
trigger = "S5"
"#;
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/it");
    let project = Project::parse(&folder.join(rungc_project::FILE), text).unwrap();
    let file = folder.join("read.rs");
    for model in [ModelId::H2u, ModelId::Fx3u] {
        let mut program = rungc_frontend::read_text("p.il", "LD X000\nEND\n").program;
        project
            .complete(&file, &mut program, Model::get(model))
            .unwrap();
        assert_eq!(program.instrs.len(), 2);
        let requests = program.parameters.unwrap().requests;
        let shown = requests.iter().map(|r| {
            let (trigger, buffer) = (r.trigger.to_string(), r.buffer);
            format!(
                "{} {} {:02X} {:X} {} D{buffer} {trigger}",
                r.server, r.unit, r.function, r.address, r.count
            )
        });
        assert_eq!(
            shown.collect::<Vec<_>>(),
            [
                "192.168.50.12:502 1 03 1F4 1 D205 M8000",
                "[::1]:5020 255 05 3 1 D7999 S5"
            ]
        );
    }
    let mut program = rungc_frontend::read_text("p.il", "LD X000\nEND\n").program;
    let fx1s = project.complete(&file, &mut program, Model::get(ModelId::Fx1s));
    let Err(Error::Invalid { diagnostics, .. }) = fx1s else {
        panic!("FX1S has no D205");
    };
    let messages: Vec<_> = diagnostics.iter().map(|d| d.message.clone()).collect();
    assert_eq!(messages, ["D7999 does not exist on Mitsubishi FX1S"]);
}
