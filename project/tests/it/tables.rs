//! Tables of which each row stands for something: requests, modules, stations, names.

use crate::common::{mistakes, parse};
use rungc_models::{Model, ModelId};
use rungc_project::{Error, Project};
use std::path::Path;

/// Instructions as a list shows them.
fn shown(program: &rungc_syntax::Program) -> Vec<String> {
    let shown = |instr: &rungc_syntax::Instr| {
        let operands = instr
            .operands
            .iter()
            .map(|operand| operand.kind.to_string());
        let words = std::iter::once(instr.mnemonic.to_string()).chain(operands);
        words.collect::<Vec<_>>().join(" ")
    };
    program.instrs.iter().map(shown).collect()
}

#[test]
fn rows_of_the_modbus_table_become_instructions() {
    let text = r#"[project]
program = "read.rs"

[[modbus]]
station = 2
read = "registers"
address = 0x1001
buffer = "D20"

[[modbus]]
port = "COM2"
station = 0
write = "coils"
address = 0xE000
count = 20
buffer = "d10"
trigger = "M10"
"#;
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/it");
    let project = Project::parse(&folder.join(rungc_project::FILE), text).unwrap();
    let mut program = rungc_frontend::read_text("p.il", "LD X000\nOUT Y000\nEND\n").program;
    let (file, model) = (folder.join("read.rs"), Model::get(ModelId::H2u));
    project.complete(&file, &mut program, model).unwrap();
    let shown = shown(&program);
    assert_eq!(
        shown,
        [
            "LD X000",
            "OUT Y000",
            "LD M8000",
            "MODBUS2 H203 H1001 H1 D20 H1",
            "LD M10",
            "MODBUS2 HF HE000 H14 D10 H2",
            "END"
        ]
    );
    let other = folder.join("snapshots");
    project.complete(&other, &mut program, model).unwrap();
    assert_eq!(program.instrs.len(), shown.len());
    let fx3u = project.complete(&file, &mut program, Model::get(ModelId::Fx3u));
    let Err(Error::Invalid { diagnostics, .. }) = fx3u else {
        panic!("FX3U has no Modbus table");
    };
    let messages: Vec<_> = diagnostics.iter().map(|d| d.message.clone()).collect();
    assert_eq!(messages, ["Mitsubishi FX3U has no Modbus table"]);
}

#[test]
fn mistakes_in_rows_of_the_modbus_table() {
    let rows = [
        "host = \"plc-b\"\nread = \"registers\"\naddress = 0\nbuffer = \"D0\"",
        "host = \"0.0.0.0\"\nread = \"registers\"\naddress = 0\nbuffer = \"D0\"",
        "host = \"::1\"\nport = \"COM1\"\nread = \"registers\"\naddress = 0\nbuffer = \"D0\"",
        "host = \"::1\"\nstation = 256\nread = \"registers\"\naddress = 0\nbuffer = \"D0\"",
        "station = 1\naddress = 0\nbuffer = \"D0\"",
        "station = 1\nread = \"coil\"\naddress = 0\nbuffer = \"D0\"",
        "station = 0\nread = \"coils\"\naddress = 0\nbuffer = \"D0\"",
        "station = 1\nread = \"coils\"\nwrite = \"coils\"\naddress = 0\nbuffer = \"D0\"",
        "station = 1\nwrite = \"registers\"\naddress = 0\ncount = 121\nbuffer = \"D0\"",
        "station = 1\nread = \"registers\"\naddress = 65536\nbuffer = \"D0\"",
        "station = 1\nread = \"registers\"\naddress = 65535\ncount = 2\nbuffer = \"D0\"",
        "station = 1\nread = \"registers\"\naddress = 0",
        "station = 1\nread = \"registers\"\naddress = 0\nbuffer = \"M0\"",
        "port = \"COM0\"\nstation = 1\nread = \"registers\"\naddress = 0\nbuffer = \"D0\"",
        "station = 1\nread = \"registers\"\naddress = 0\nbuffer = \"D0\"\ntrigger = \"X0\"",
        "station = 1\nread = \"registers\"\nadress = 0\nbuffer = \"D0\"",
    ];
    let mut found = String::new();
    for row in rows {
        let text = format!("[project]\nprogram = \"p.il\"\n\n[[modbus]]\n{row}\n");
        let parsed = Project::parse(Path::new("rungc.toml"), &text);
        let Err(Error::Invalid { diagnostics, .. }) = parsed else {
            panic!("{row}: no mistake");
        };
        for diagnostic in diagnostics.iter() {
            found += &format!("{}: {}\n", diagnostic.code, diagnostic.message);
        }
    }
    for text in [
        "modbus = 1",
        "modbus = [1]",
        "[[modbus]]\nstation = 1\nread = \"coils\"\naddress = 0\nbuffer = \"D0\"",
    ] {
        let Err(Error::Invalid { diagnostics, .. }) = Project::parse(Path::new("rungc.toml"), text)
        else {
            panic!("{text}: no mistake");
        };
        for diagnostic in diagnostics.iter() {
            found += &format!("{}: {}\n", diagnostic.code, diagnostic.message);
        }
    }
    insta::assert_snapshot!(found);
}

#[test]
fn modules_are_fitted_to_the_plc() {
    let text = "[[module]]\nat = 0\nkind = \"fx2n-4ad\"\n\n[[module]]\nat = 101\nkind = \"H2U-4DAR\"\nanswers-after = 20\n";
    let project = parse(text).unwrap();
    let mut program = rungc_frontend::read_text("p.il", "LD X0\nOUT Y0\nEND\n").program;
    let path = Path::new("plant/p.il");
    let h2u = Model::get(ModelId::H2u);
    project.complete(path, &mut program, h2u).unwrap();
    let fitted = program.parameters.unwrap().modules;
    let fitted: Vec<_> = fitted
        .iter()
        .map(|m| (m.unit, m.kind, m.delay_ms))
        .collect();
    assert_eq!(fitted, [(0, "FX2N-4AD", 0), (101, "H2U-4DA", 20)]);
    let mut program = rungc_frontend::read_text("p.il", "END\n").program;
    let of_fx = project.complete(path, &mut program, Model::get(ModelId::Fx3u));
    let Err(Error::Invalid { diagnostics, .. }) = of_fx else {
        panic!("FX3U has no remote modules");
    };
    let messages: Vec<_> = diagnostics.iter().map(|d| d.message.clone()).collect();
    assert_eq!(messages, ["Mitsubishi FX3U has no remote modules"]);
    for (at, kind, id, message) in [
        ("\"board\"", "H2U-6A-BD", ModelId::H2u, None),
        ("3", "EX1-4AD", ModelId::Hm, None),
        (
            "3",
            "EX1-4AD",
            ModelId::H2u,
            Some("EX1-4AD does not fit Inovance H2U"),
        ),
        (
            "\"board\"",
            "H1U-4A-BD",
            ModelId::Fx3u,
            Some("H1U-4A-BD does not fit Mitsubishi FX3U"),
        ),
    ] {
        let project = parse(&format!("[[module]]\nat = {at}\nkind = \"{kind}\"\n")).unwrap();
        let mut program = rungc_frontend::read_text("p.il", "END\n").program;
        let fits = project.complete(path, &mut program, Model::get(id));
        let why = match fits {
            Err(Error::Invalid { diagnostics, .. }) => {
                diagnostics.iter().next().map(|d| d.message.clone())
            }
            _ => None,
        };
        assert_eq!(why.as_deref(), message, "{at} {kind}");
    }
    insta::assert_snapshot!(
        "modules",
        mistakes(
            "[[module]]\nat = 0\nkind = \"FX2N-4AB\"\n[[module]]\nat = 8\nkind = \"FX2N-4AD\"\n[[module]]\nat = 1\n\
             [[module]]\nkind = \"FX2N-4AD\"\n[[module]]\nat = 2\nkind = \"FX2N-4AD\"\n[[module]]\nat = 2\nkind = \"FX2N-4DA\"\n\
             [[module]]\nat = 3\nkind = \"FX2N-4DA\"\nid = 1\n\
             [[module]]\nat = 4\nkind = \"H2U-6A-BD\"\n[[module]]\nat = \"board\"\nkind = \"H2U-4AD\"\n[[module]]\nat = 5\n\
             kind = \"H2U-0808ERDR\"\n[[module]]\nat = 6\nkind = \"EX1-4AD\"\n\
             [[module]]\nat = 7\nkind = \"FX2N-4AD\"\nanswers-after = 5\n\
             [[module]]\nat = 103\nkind = \"H2U-4AD\"\nanswers-after = 60_001\n"
        )
    );
}

#[test]
fn plcopen() {
    let project = parse(
        "[plcopen]\nfree = ['M100-M199', 'T5']\n[plcopen.names]\nStart = 'X010'\n\"main.Level\" = 'D10'\n",
    )
    .unwrap();
    let names = project.reading().names;
    let shown = names
        .devices
        .iter()
        .map(|(name, device)| format!("{name} {device}"));
    assert_eq!(shown.collect::<Vec<_>>(), ["MAIN.LEVEL D10", "START X010"]);
    assert_eq!(names.free.len(), 2);
    insta::assert_snapshot!(
        "plcopen",
        [
            mistakes("[plcopen]\nfree = ['M5-D6', 7]\nnames = 'names.csv'\n"),
            mistakes("[plcopen.names]\nStart = 'X9'\nStop = 1\n[plcopen.devices]\n"),
        ]
        .concat()
    );
}

#[test]
fn a_station_of_canlink_becomes_instructions() {
    let entry = |keys: &str| format!("[[canlink.send]]\nfrom = \"D10\"\n{keys}\n");
    let master = "[project]\nprogram = \"read.rs\"\n[canlink]\nstation = 1\nheartbeat = 500\nslaves = [2, 3]\nlisten = [3]\n";
    let entries = [
        "together = \"M1\"\nto = 2\nregister = 5\ncount = 2",
        "event = \"M100\"\nto = 3",
        "every = 50",
        "event = \"M100\"\nto = 2",
        "sync = true\nto = 2",
    ];
    let text = master.to_string() + &entries.map(entry).concat();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/it");
    let completed = |text: &str| {
        let project = Project::parse(&folder.join(rungc_project::FILE), text).unwrap();
        let mut program = rungc_frontend::read_text("p.il", "LD X000\nOUT Y000\nEND\n").program;
        let (file, model) = (folder.join("read.rs"), Model::get(ModelId::H2u));
        project.complete(&file, &mut program, model).unwrap();
        shown(&program)
    };
    insta::assert_snapshot!("canlink_master", completed(&text).join("\n"));
    let slave = "[project]\nprogram = \"read.rs\"\n[canlink]\nstation = 2\n";
    insta::assert_snapshot!("canlink_slave", completed(slave).join("\n"));
}

#[test]
fn mistakes_in_a_network_of_canlink() {
    let of_slave = |entry: &str| format!("[canlink]\nstation = 2\n[[canlink.send]]\n{entry}\n");
    let many = "[[canlink.send]]\nevery = 5\nfrom = \"D0\"\n".repeat(17);
    let relays = |count: usize, each: usize| {
        let relay = |n| format!("[[canlink.send]]\ntogether = \"M{n}\"\nfrom = \"D0\"\n");
        let all: Vec<_> = (0..count).map(|n| relay(n).repeat(each)).collect();
        format!("[canlink]\nstation = 1\n{}", all.concat())
    };
    let texts = [
        "[canlink]\nmaster = 1".to_string(),
        "[canlink]\nstation = 64\nheartbeat = 5".to_string(),
        "[canlink]\nstation = 2\nslaves = [3]\nlisten = [2]".to_string(),
        "[canlink]\nstation = 1\nslaves = [0]\nlisten = 3".to_string(),
        "[canlink]\nstation = 1\nlisten = [2, 3, 4, 5, 6, 7, 8, 9, 10]".to_string(),
        of_slave("from = \"D0\""),
        of_slave("every = 5\nsync = true\nfrom = \"D0\""),
        of_slave("sync = false\nfrom = \"D0\""),
        of_slave("event = \"X0\"\nfrom = \"D0\""),
        of_slave("every = 5"),
        of_slave("every = 5\nfrom = \"D7799\"\ncount = 2"),
        of_slave("every = 5\nfrom = \"D0\"\nregister = 7800"),
        of_slave("together = \"M0\"\nfrom = \"D0\""),
        format!("[canlink]\nstation = 2\n{many}"),
        relays(9, 1),
        relays(1, 17),
    ];
    let mut found = String::new();
    for text in texts {
        let text = format!("[project]\nprogram = \"p.il\"\n{text}\n");
        found += &mistakes(text.trim_end());
    }
    insta::assert_snapshot!(found);
    let text = "[project]\nprogram = \"read.rs\"\n[canlink]\nstation = 2\n";
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/it");
    let project = Project::parse(&folder.join(rungc_project::FILE), text).unwrap();
    let mut program = rungc_frontend::read_text("p.il", "END\n").program;
    let (file, fx3u) = (folder.join("read.rs"), Model::get(ModelId::Fx3u));
    let of_fx = project.complete(&file, &mut program, fx3u);
    let Err(Error::Invalid { diagnostics, .. }) = of_fx else {
        panic!("FX3U has no CANlink");
    };
    let messages: Vec<_> = diagnostics.iter().map(|d| d.message.clone()).collect();
    assert_eq!(messages, ["Mitsubishi FX3U has no CANlink"]);
}

/// A program with these labels, as this model completes it.
fn labelled(labels: &str, model: ModelId) -> Result<rungc_syntax::Program, Error> {
    let text = format!("[project]\nprogram = \"tables.rs\"\n[labels]\n{labels}");
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/it");
    let project = Project::parse(&folder.join(rungc_project::FILE), &text)?;
    let list = ";! M100 = at rest\n;! M101 = jammed\nLD M100\nOUT M101\nEND\n";
    let mut program = rungc_frontend::read_text("p.il", list).program;
    project.complete(&folder.join("tables.rs"), &mut program, Model::get(model))?;
    Ok(program)
}

#[test]
fn labels_name_devices_in_place_of_comments() {
    let labels = "\"Axis1.Ready\" = \"M100\"\nAxis1.Position = \"d200\"\n\"起动\" = \"X000\"\n";
    let program = labelled(labels, ModelId::Fx3u).unwrap();
    let names: Vec<_> = program
        .comments
        .iter()
        .map(|(device, name)| format!("{device} {name}"))
        .collect();
    let mut expected = [
        "X000 起动",
        "M100 Axis1.Ready",
        "M101 jammed",
        "D200 Axis1.Position",
    ];
    expected.sort_by_key(|row| names.iter().position(|name| name == row));
    assert_eq!(names, expected);
}

#[test]
fn mistakes_in_labels() {
    let wrong = [
        "Ready = \"M100\"\nBusy = \"M100\"",
        "Ready = \"M100\"\nready = \"M101\"",
        "M5 = \"M100\"",
        "x0 = \"M100\"",
        "\" \" = \"M100\"",
        "\"a\\nb\" = \"M100\"",
        "Ready = 100",
        "Ready = \"M100.2\"",
        "Ready = \"Q5\"",
        "Ready = \"M100000\"",
    ];
    let found: Vec<_> = wrong
        .into_iter()
        .map(|labels| match labelled(labels, ModelId::Fx3u) {
            Err(Error::Invalid { diagnostics, .. }) => {
                let found = diagnostics.iter().map(|it| it.message.to_string());
                format!("{labels:?}: {}", found.collect::<Vec<_>>().join("; "))
            }
            other => panic!("{labels}: {other:?}"),
        })
        .collect();
    insta::assert_snapshot!(found.join("\n"));
}
