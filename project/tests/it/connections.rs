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

/// A value from elsewhere that each scan replaces is never seen. What the program may write, a connection may, too:
/// M8034 turns the outputs off while an end is lost. Devices that a row writes elsewhere are only read.
#[test]
fn what_each_scan_sets_takes_no_value_from_elsewhere() {
    let model = Model::get(ModelId::Fx3u);
    let panel = "[io.panel]\nfiles = '.'\n";
    let row = "X000 = 'read a'\n";
    for (text, device, place) in [
        (format!("{panel}{row}fault = 'M8000'\n"), "M8000", "'M8000'"),
        (
            format!("{panel}M8010-M8013 = 'read a'\n"),
            "M8011",
            "M8010-M8013",
        ),
        (format!("{panel}D8010 = 'read a'\n"), "D8010", "D8010"),
        (
            "[retain]\nfile = 'r'\nfault = 'M8002'\n".to_string(),
            "M8002",
            "'M8002'",
        ),
    ] {
        let project = parse(&text).unwrap();
        let Err(Error::Invalid { diagnostics, .. }) = project.check_io(model) else {
            panic!("{text}");
        };
        let why = &diagnostics.sorted()[0];
        let expected = format!("the PLC itself sets {device} in each scan");
        assert_eq!(why.message, expected, "{text}");
        assert_eq!(project.source.slice(why.span), place, "{text}");
    }
    for text in [
        format!("{panel}{row}fault = 'M8034'\n"),
        format!("{panel}M8013 = 'write a'\n"),
        "[retain]\nfile = 'r'\nfault = 'Y000'\n".to_string(),
    ] {
        assert!(parse(&text).unwrap().check_io(model).is_ok(), "{text}");
    }
}

/// The device that shows that latched devices cannot be saved takes its value from there alone, wherever `[retain]`
/// stands in the file.
#[test]
fn connections_do_not_set_the_fault_of_retain() {
    let retain = "[retain]\nfile = 'latched'\nfault = 'M105'\n";
    let row = "[io.panel]\nfiles = '.'\nM100-M107 = 'read switches'\n";
    let fault = "[io.panel]\nfiles = '.'\nfault = 'M105'\nX000 = 'read switch'\n";
    for (text, at) in [
        (format!("{retain}{row}"), "6:1 `M100-M107`"),
        (format!("{row}{retain}"), "3:1 `M100-M107`"),
        (format!("{retain}{fault}"), "6:9 `'M105'`"),
    ] {
        let (place, quoted) = at.split_once(' ').unwrap();
        let expected = format!(
            "E0820 {place} `M105` takes its value from two places {quoted}\n    \
             help: a device takes its value from one place\n"
        );
        assert_eq!(mistakes(&text), expected, "{text}");
    }
    let written = row.replace("read", "write");
    assert!(parse(&format!("{retain}{written}")).is_ok());
}

/// Executables read connections line by line, without a library for TOML. What they cannot read so they reject: none of
/// the connections that rungc makes is left out.
#[test]
fn executables_connect_what_rungc_connects_or_refuse() {
    let rows = "files = '.'\nX000 = 'read a'\n";
    let mut agreed = 0;
    for text in [
        format!("[io.a]\n{rows}"),
        format!("[ io . 'a' ] # panel\n{rows}"),
        format!("[\"io\".a]\n{rows}[io.\"b\"]\nfiles = '.'\nX001 = 'read b'\n"),
        format!("[verify]\nassume = [\n  'X0',\n]\n[io.a]\n{rows}"),
        format!("[io.a]\n{rows}[project]\nmodel = 'fx3u'\n"),
        format!("[io]\n[io.a]\n{rows}"),
        "[io]\na = { files = '.', X000 = 'read a' }\n".to_string(),
        "[io]\na.files = '.'\na.X000 = 'read a'\n".to_string(),
        "io.a.files = '.'\nio.a.X000 = 'read a'\n".to_string(),
        "io.a = { files = '.', X000 = 'read a' }\n".to_string(),
        "\"io\" = { a = { files = '.', X000 = 'read a' } }\n".to_string(),
        format!("[io.a]\n{rows}[io]\nb.files = '.'\nb.X001 = 'read b'\n"),
        format!("[io.a]\n{rows}[io.b] \nfiles = \"\"\"\n.\"\"\"\nX001 = 'read b'\n"),
        format!("[io.a]\n{rows}[io.b]\n'files' = '.'\nX001 = 'read b'\n"),
    ] {
        let ours = parse(&text).unwrap().io;
        assert!(!ours.is_empty(), "{text}");
        if let Ok(theirs) = rungc_host::io::parse(&text) {
            agreed += 1;
            let ours: Vec<_> = ours.iter().map(|one| &one.connection).collect();
            assert_eq!(ours, theirs.iter().collect::<Vec<_>>(), "{text}");
        }
    }
    assert!(agreed >= 6, "{agreed}");
}
