//! Settings in files, and the messages about their mistakes.

use crate::common::{mistakes, parse};
use proptest::prelude::*;
use rungc_models::{Model, ModelId};
use rungc_project::{Error, FILE, Project};
use rungc_syntax::DeviceClass;
use std::path::Path;

/// A file with every setting.
const EVERY_SETTING: &str = r#"
[project]
program = "Packer.gxw"
model = "FX3U"
name = "packer"
encoding = "windows-1252"

[check]
allow = ["W0201", "double-coil"]
warn = ["E0105"]
deny = ["W0204"]

[build]
target = "host"
board = "board.toml"
emit = "c"
output = "firmware/plc"

[test]
files = ["tests", "extra.plctest.toml"]
engine = "all"

[tokens]
"56 09 02" = "TO"
"5609" = "from"

[index]
"D100Z0" = "D100-D163"
"x0v" = "X000-X017"

[latched]
D = "D200-D511"
M = ["M500-M600", "M700"]

[serve]
modbus-tcp = 5020
mc = ["127.0.0.1:5001", "[::1]:5001"]
fx = "5556"
page = 8080
serial = { COM1 = "/dev/ttyUSB0", COM2 = "tcp:gateway:4001" }
D = "D0-D511"
Y = ["Y000-Y017"]

[hmi]
writes = ["D70-D79", "M100"]
reads = "Y000-Y007"

[verify]
assume = ["!X000"]
scan = "50ms"
effort = 50_000
timeout = "10s"
"#;

fn every_setting() -> Project {
    parse(EVERY_SETTING).unwrap()
}

#[test]
fn settings_of_the_project_and_of_commands_are_read() {
    let project = every_setting();
    assert_eq!(project.model, Some(ModelId::Fx3u));
    assert_eq!(project.name.as_deref(), Some("packer"));
    assert_eq!(project.encoding.unwrap().name(), "windows-1252");
    assert_eq!(project.program().unwrap(), Path::new("plant/Packer.gxw"));
    assert_eq!(project.check.allow, ["W0201", "W0203"]);
    assert_eq!(project.check.warn, ["E0105"]);
    assert_eq!(project.check.deny, ["W0204"]);
    assert_eq!(project.build.emit.as_ref().unwrap().text, "c");
    assert_eq!(
        project.build.output.as_deref(),
        Some(Path::new("firmware/plc"))
    );
    assert_eq!(project.test.files.len(), 2);
}

#[test]
fn settings_of_the_program_are_read() {
    let project = every_setting();
    let reading = project.reading();
    let learned = |body: &[u8]| reading.learned.get(body).map(ToString::to_string);
    assert_eq!(learned(&[0x56, 9]).as_deref(), Some("FROM"));
    assert_eq!(learned(&[0x56, 9, 2]).as_deref(), Some("TO"));
    assert_eq!(learned(&[0x56, 9, 0]), None);
    assert_eq!(reading.encoding, project.encoding);
    let bounds: Vec<_> = project
        .index
        .iter()
        .map(|b| (b.class, b.number, b.first, b.last))
        .collect();
    assert_eq!(
        bounds,
        [(DeviceClass::D, 100, 100, 163), (DeviceClass::X, 0, 0, 15)]
    );
    let latched: Vec<_> = project
        .latched
        .iter()
        .map(|l| (l.class, l.first, l.last))
        .collect();
    let expected = [
        (DeviceClass::M, 500, 600),
        (DeviceClass::M, 700, 700),
        (DeviceClass::D, 200, 511),
    ];
    assert_eq!(latched, expected);
}

#[test]
fn settings_of_proofs_are_read() {
    let verify = every_setting().verify;
    let texts = [verify.scan, verify.timeout].map(|named| named.map(|named| named.text));
    assert_eq!(texts, ["50ms", "10s"].map(|text| Some(text.to_string())));
    assert_eq!(verify.effort, Some(50_000));
    for wrong in ["0", "-1", "1.5", "\"50000\"", "4294967296"] {
        let found = mistakes(&format!("[verify]\neffort = {wrong}\n"));
        assert!(found.contains("`effort` is 1 to 4294967295"), "{found}");
    }
}

#[test]
fn settings_of_servers_are_read() {
    let project = every_setting();
    let serve = &project.serve;
    assert_eq!(serve.modbus_tcp, ["127.0.0.1:5020".parse().unwrap()]);
    assert_eq!((serve.mc.len(), serve.fx.len()), (2, 1));
    assert_eq!(serve.page, "127.0.0.1:8080".parse().ok());
    let lines: Vec<_> = serve.serial.iter().map(|s| s.line.clone()).collect();
    let expected = ["COM1=/dev/ttyUSB0", "COM2=tcp:gateway:4001"];
    assert_eq!(lines, expected.map(|line| line.parse().unwrap()));
    assert_eq!(serve.stored().count(), 512 + 16);
}

#[test]
fn what_a_panel_writes_is_read() {
    let written = |text: &str| {
        let written = parse(text).unwrap().written_externally();
        let written = written.iter().map(|(by, run)| format!("{by} {run}"));
        written.collect::<Vec<_>>()
    };
    assert_eq!(written("[hmi]\nwrites = 'd70-D79'\n"), ["[hmi] D70 to D79"]);
    assert_eq!(
        written("[hmi]\nwrites = ['M100', 'X000-X007']\n"),
        ["[hmi] M100 to M100", "[hmi] X000 to X007"]
    );
    assert_eq!(every_setting().hmi.len(), 2);
    assert_eq!(every_setting().hmi_reads.len(), 1);
    let wrong = mistakes(
        "[hmi]\nwrites = ['pump', 'D9-D5', 'P3', 7, '']\nreads = ['P4', 'D5']\nshows = 'D5'\n",
    );
    assert_eq!(wrong.matches("names no devices").count(), 2, "{wrong}");
    assert!(
        wrong.contains("a panel writes devices X, Y, M, S, T, C, D, R"),
        "{wrong}"
    );
    assert!(
        wrong.contains("a panel reads devices X, Y, M, S, T, C, D, R"),
        "{wrong}"
    );
    assert!(wrong.contains("`[hmi]` has no key `shows`"), "{wrong}");
    let wrong = mistakes("[hmi]\nwrites = 'D200-D299, m100'\n[latched]\nM = 'M500-M600,M700'\n");
    for list in [r#"["D200-D299", "m100"]"#, r#"["M500-M600", "M700"]"#] {
        assert!(
            wrong.contains(&format!("write a list: `{list}`")),
            "{wrong}"
        );
    }
}

#[test]
fn what_is_served_has_to_be_there() {
    insta::assert_snapshot!(
        "serve",
        mistakes(
            r#"
[serve]
modbus = 5020
modbus-tcp = 99999
mc = "plc:5001"
fx = [5556, true]
serial = { COMM1 = "pty", COM1 = "tcp:gateway", COM2 = 3 }
D = "M0-M10"
K = "K0"
"#
        )
    );
    // Neither a port nor an address; addresses that are given twice.
    insta::assert_snapshot!(
        "serve_addresses",
        mistakes(
            r#"
[serve]
page = 5556
mc = [22.5, true, 5077, "0.0.0.0:6000"]
modbus-tcp = [5077, 6000, 0, 0, "[::1]:5077"]
fx = "tcp-listen:5556"
serial = { COM1 = "tcp-listen:5077" }
can = "slcan:tcp-listen:6000"
"#
        )
    );
    insta::assert_snapshot!("serve_lines", mistakes("[serve]\nserial = 'COM1=pty'\n"));
    let why = |text: &str, model| {
        let project = parse(text).unwrap();
        let mut program = rungc_syntax::Program::default();
        let path = Path::new("p.il");
        match project.complete(path, &mut program, Model::get(model)) {
            Err(Error::Invalid {
                text, diagnostics, ..
            }) => {
                let d = diagnostics.sorted().remove(0);
                let help = d.help.unwrap_or_default();
                format!("{} {}; {help}", text.slice(d.span), d.message)
            }
            _ => panic!("{text} is taken"),
        }
    };
    let fx1s = ModelId::Fx1s;
    insta::assert_snapshot!(
        "serve_model",
        [
            why("[serve]\nserial = { COM3 = 'pty' }\n", fx1s),
            why("[serve]\nfx = 'pty'\nserial = { COM0 = 'pty' }\n", fx1s),
            why("[serve]\nfx = ['pty', '/dev/ttyS0']\n", fx1s),
            why("[serve]\nD = ['D0', 'D200-D300']\n", fx1s),
        ]
        .join("\n")
    );
}

#[test]
fn an_empty_file_sets_nothing() {
    for text in [
        "",
        "\u{feff}",
        "# nothing\n",
        "[project]\n[check]\nallow = []\n",
    ] {
        let project = parse(text).unwrap();
        assert!(project.model.is_none() && project.check.allow.is_empty());
    }
}

#[test]
fn unknown_tables_and_keys() {
    insta::assert_snapshot!(
        "unknown",
        mistakes(
            "[projekt]\nprogram = 'a.il'\n\n[check]\nalow = []\n\n[io]\nX0 = 1\n\nmodel = 'fx3u'\n[latched]\nY = 'Y0-Y7'\n"
        )
    );
    insta::assert_snapshot!(
        "unknown_at_top",
        mistakes("model = 'fx3u'\n[[device]]\nat = 0\n")
    );
}

#[test]
fn values_that_do_not_fit() {
    insta::assert_snapshot!(
        "values",
        mistakes(
            r#"
build = "c"
[project]
program = 3
model = "fx3uu"
name = "packer"
encoding = "klingon"

[check]
allow = ["W0203", "E0106", "W9999", "duoble-coil"]
warn = ["W0201", "E0106"]
deny = "W0203"

[test]
files = "tests"

[tokens]
"56 0" = "TO"
"56" = "TOO"
"57 01" = "TO"
"5701" = "FROM"

[index]
"D100" = "D100-D163"
"D100Z0" = "M0-M10"
"D100Z" = "D163-D100"

[latched]
D = "200-511"
M = ["M5-M1", 7]
"#
        )
    );
    insta::assert_snapshot!(
        "allowed_and_denied",
        mistakes("[check]\nallow = ['W0203']\ndeny = ['double-coil']\n")
    );
    insta::assert_snapshot!("empty", mistakes("[project]\nprogram = ''\n"));
}

#[test]
fn lines_that_are_not_toml() {
    insta::assert_snapshot!(
        "not_toml",
        mistakes("[project]\nprogram = Packer.gxw\n[check\nallow = ['W0203]\n")
    );
    insta::assert_snapshot!(
        "twice",
        mistakes("[project]\nmodel = 'fx3u'\nmodel = 'fx2n'\n")
    );
}

#[test]
fn latched_devices_are_those_that_can_be() {
    let mut program = rungc_syntax::Program::default();
    let project = parse("[latched]\nD = 'D200-D299'\n").unwrap();
    project
        .complete(Path::new("p.il"), &mut program, Model::get(ModelId::Fx3u))
        .unwrap();
    let latched = program.parameters.clone().unwrap().latched.unwrap();
    let of = |class| {
        let runs = latched.iter().filter(|run| run.class == class);
        runs.map(|run| (run.first, run.count)).collect::<Vec<_>>()
    };
    assert_eq!(of(DeviceClass::D), [(200, 100)]);
    assert_eq!(of(DeviceClass::M), [(500, 524)], "as usual");
    let why = |text: &str, model| {
        let project = parse(text).unwrap();
        let Err(Error::Invalid {
            text, diagnostics, ..
        }) = project.complete(
            Path::new("p.il"),
            &mut rungc_syntax::Program::default(),
            Model::get(model),
        )
        else {
            panic!("{text} is taken");
        };
        let d = diagnostics.sorted().remove(0);
        format!("{} {}; {}", text.slice(d.span), d.message, d.help.unwrap())
    };
    insta::assert_snapshot!(
        "latched",
        [
            why("[latched]\nD = 'D100-D8005'\n", ModelId::Fx3u),
            why("[latched]\nM = ['M500-M510', 'M3-M4']\n", ModelId::Fx3g),
        ]
        .join("\n")
    );
}

#[test]
fn the_nearest_file_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let root = dunce::canonicalize(folder.path()).unwrap();
    let inner = root.join("a/b");
    std::fs::create_dir_all(&inner).unwrap();
    std::fs::write(root.join(FILE), "").unwrap();
    std::fs::write(inner.join("x.il"), "END\n").unwrap();
    assert_eq!(Project::find(&inner.join("x.il")), Some(root.join(FILE)));
    assert_eq!(Project::find(&inner), Some(root.join(FILE)));
    std::fs::write(inner.join(FILE), "").unwrap();
    assert_eq!(Project::find(&inner.join("x.il")), Some(inner.join(FILE)));
    assert_eq!(
        Project::find(&inner.join("not/there.il")),
        Some(inner.join(FILE))
    );
}

#[test]
fn a_file_that_cannot_be_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(FILE);
    let why = |path: &Path| Project::load(path).unwrap_err().to_string();
    assert!(why(&path).starts_with("cannot read"), "{}", why(&path));
    for (bytes, message) in [
        (&[0xff, 0xfe, 0x41][..], "it is UTF-16; save it as UTF-8"),
        (&[0x41, 0xff], "it is not UTF-8; save it as UTF-8"),
    ] {
        std::fs::write(&path, bytes).unwrap();
        assert!(why(&path).ends_with(message), "{}", why(&path));
    }
    std::fs::write(&path, vec![b'#'; (rungc_project::MAX_SIZE + 1) as usize]).unwrap();
    assert!(
        why(&path).ends_with("it is larger than 1 MiB"),
        "{}",
        why(&path)
    );
}

/// Pieces of files, put together at random.
fn piece() -> impl Strategy<Value = String> {
    let known = prop::sample::select(vec![
        "[project]\n",
        "[check]\n",
        "[tokens]\n",
        "[index]\n",
        "[latched]\n",
        "[build]\n",
        "[test]\n",
        "[serve]\n",
        "serial = { COM1 = \"pty\" }",
        "mc = ",
        "model = ",
        "allow = ",
        "warn = ",
        "D = ",
        "\"D0Z0\" = ",
        "\"56 09\" = ",
        "files = ",
        "\"W0203\"",
        "\"D0-D9\"",
        "\"fx3u\"",
        "[",
        "]",
        "{",
        "}",
        ",",
        "\n",
        "=",
        "\"",
        "'",
        "\u{feff}",
        "\"D0-D4294967296\"",
    ]);
    prop_oneof![known.prop_map(str::to_string), ".{0,4}"]
}

proptest! {
    #[test]
    fn no_text_makes_it_panic(text in "\\PC{0,200}") {
        let _ = parse(&text);
    }

    #[test]
    fn no_pieces_make_it_panic(pieces in prop::collection::vec(piece(), 0..40)) {
        if let Err(Error::Invalid { text, diagnostics, .. }) = parse(&pieces.concat()) {
            for d in diagnostics.iter() {
                prop_assert!(d.span.start <= d.span.end && d.span.end as usize <= text.text.len());
            }
        }
    }
}

/// Unknown keys are marked themselves, not their values.
#[test]
fn unknown_keys_are_marked() {
    let shown = [
        "[[property]]\nneverr = 'Y000'\n",
        "[[property]]\nname = 'a'\n",
        "[io.a]\nmqtt = 'host'\nqoss = '1'\nX0 = 'read a'\n",
        "[io.a]\nmqtt = 'host'\nQ0 = 'read a'\nevery = 'soon'\n",
        "[project]\nmodl = 'fx3u'\n",
        "[verify]\nasume = ['M0']\n",
        "[[module]]\nnumbre = 0\n",
        "[[modbus]]\nservr = 'a'\n",
        "[canlink]\nstaton = 1\n",
    ];
    insta::assert_snapshot!(shown.map(mistakes).join("\n"));
}

/// Rows with one `id` describe one requirement, which need not have a property.
#[test]
fn properties_belong_to_requirements() {
    let text = "[[property]]\nid = 'R1'\ntext = 'never both'\nsource = 'sheet, 3'\nnever = 'Y000 & Y001'\n\
                [[property]]\nid = 'R1'\nname = 'other'\nnever = 'Y002'\n[[property]]\nid = 'R2'\ntext = 'a lamp'\n\
                [[property]]\nnever = 'Y003'\n";
    let project = parse(text).unwrap();
    let requirements = project.requirements.iter();
    let requirements: Vec<_> = requirements
        .map(|r| (&*r.id, &*r.text, &*r.source))
        .collect();
    assert_eq!(
        requirements,
        [("R1", "never both", "sheet, 3"), ("R2", "a lamp", "")]
    );
    let rows = project.properties.iter();
    let rows: Vec<_> = rows.map(|row| row.requirement.as_deref()).collect();
    assert_eq!(rows, [Some("R1"), Some("R1"), None]);
    let shown = [
        "[[property]]\ntext = 'never'\nnever = 'Y000'\n",
        "[[property]]\nid = ''\ntext = 'never'\nnever = 'Y000'\n",
        "[[property]]\nid = 5\nnever = 'Y000'\n",
        "[[property]]\nid = \"a\\nb\"\nnever = 'Y000'\n",
        "[[property]]\nid = 'R1'\ntext = 'a'\n[[property]]\nid = 'R1'\ntext = 'b'\nnever = 'Y000'\n",
        "[[property]]\nid = 'R1'\ntxt = 'a'\n",
        "[[property]]\nid = 'R1'\nthen = 'a'\n",
    ];
    insta::assert_snapshot!(shown.map(mistakes).join("\n"));
}
