//! Texts that are smaller than a program: descriptions, conditions, names of devices and of lines.

use super::Target;
use rungc::trace::Trace;
use rungc_fleet::Fleet;
use rungc_frontend::Names;
use rungc_host::{duration, io};
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::{Model, ModelId};
use rungc_project::Project;
use rungc_project::serve::{FxEnd, Line, LineEnd};
use rungc_sim::property;
use rungc_sim::protocol::Answer;
use std::io::{Cursor, sink};
use std::path::Path;

fn fleet(text: &str) {
    let _ = Fleet::parse(Path::new("fleet.toml"), text);
}

/// A condition, which is read again as it is shown; every word that begins with a small letter stands for two devices,
/// as comments may.
fn condition(text: &str) {
    let names = |word: &str| match word.starts_with(|c: char| c.is_lowercase()) {
        true => ["Y000", "D5"]
            .into_iter()
            .filter_map(|name| rungc_sim::Target::parse(name).ok())
            .collect(),
        false => Vec::new(),
    };
    match property::parse(text, &names) {
        Ok(condition) => {
            let shown = condition.to_string();
            let again = property::parse(&shown, &|_| Vec::new());
            assert_eq!(again.as_ref(), Ok(&condition), "{shown}");
        }
        Err(mistake) => assert!(text.get(mistake.at..).is_some(), "{mistake:?}"),
    }
}

/// Connections as hosts without a library for TOML read them, and what a broker sends for the first of them: the rest
/// of the text after a line of `---`.
fn connections(text: &str) {
    let (text, payload) = text.split_once("---\n").unwrap_or((text, ""));
    let Ok(connections) = io::parse(text) else {
        return;
    };
    for connection in &connections {
        let _ = io::address(&connection.end, 1883);
        let length = connection.rows.iter().map(|row| row.place.end).max();
        let mut inputs = vec![0; length.unwrap_or(0)];
        let topics = connection.directed(true).flat_map(io::topics);
        for topic in topics.collect::<Vec<_>>() {
            let payload = payload.as_bytes();
            let mut left_out = io::LeftOut::default();
            io::take(connection, &topic.name, payload, &mut inputs, &mut left_out);
        }
    }
}

/// Structured text, which is also compiled where it has no mistakes.
fn structured(text: &str) {
    let Ok(mut read) = rungc_frontend::read_bytes("a.st", text.as_bytes()) else {
        return;
    };
    let model = Model::get(ModelId::Fx1s);
    let found = rungc_structured::compile(&mut read.program, model);
    let places = found.iter().all(|one| {
        let range = one.span.range();
        read.program.source.text.get(range).is_some()
    });
    assert!(places, "{found:?}");
    let options = CompileOptions {
        model: Some(model.id),
        ..CompileOptions::default()
    };
    let _ = compile(&read.program, &options);
}

/// A recording of a PLC, and its moments.
fn recording(text: &str) {
    if let Ok(trace) = Trace::read(text.as_bytes(), Model::get(ModelId::Fx3u)) {
        let (first, last) = trace.times();
        assert!(first <= last);
        let _ = (trace.at(first), trace.at(last), trace.at(u64::MAX));
    }
}

/// Messages of an editor to the debug adapter, one a line.
fn debugging(text: &str) {
    let mut messages = Vec::new();
    for line in text.lines() {
        messages.extend(format!("Content-Length: {}\r\n\r\n{line}", line.len()).into_bytes());
    }
    let _ = rungc_dap::serve(Cursor::new(messages), sink());
}

fn names(text: &str) {
    let _ = Names::parse(text);
    let _ = Names::read(text.as_bytes());
}

/// Safety functions of a project's settings, and its cause-and-effect matrix `m.csv`: the text after a line of `---`.
fn functions(text: &str) {
    let (settings, matrix) = text.split_once("---\n").unwrap_or((text, ""));
    let Ok(folder) = tempfile::tempdir() else {
        return;
    };
    if std::fs::write(folder.path().join("m.csv"), matrix).is_ok()
        && let Ok(project) = Project::parse(&folder.path().join("rungc.toml"), settings)
    {
        let _ = rungc_functions::properties(&project);
    }
}

/// Single words, as arguments of the command line and lines between processes have them.
fn words(text: &str) {
    for word in text.lines() {
        let _ = rungc_sim::Target::parse(word);
        let _ = Answer::parse(word);
        let _ = duration::parse_within(word, 1..=60_000);
        let _ = LineEnd::parse(word);
        let _ = LineEnd::parse_can(word);
        let _ = word.parse::<Line>();
        let _ = word.parse::<FxEnd>();
    }
}

fn target(name: &'static str, run: fn(&str), seeds: &[&str]) -> Target {
    Target {
        name,
        run: Box::new(move |input| {
            if let Ok(text) = std::str::from_utf8(input) {
                run(text);
            }
        }),
        seeds: seeds.iter().map(|seed| seed.as_bytes().to_vec()).collect(),
    }
}

pub(super) fn targets() -> [Target; 9] {
    [
        target(
            "fleet-file",
            fleet,
            &[
                "[fleet]\ncycle = \"10ms\"\n[plc.motor]\nprogram = \"motor.il\"\ncount = 1000\nset = [\"X000=1@100ms\"]\nspread = \"2ms\"\nrepeat = \"5s\"\nmodbus-tcp = \"127.0.0.1:5020\"\nunits = 10\n",
                "[broker]\nmqtt = \"192.168.1.5:1883\"\nevery = \"200ms\"\n[plc.press]\nprogram = \"a.il\"\ncount = 2\n[plc.press.topics]\nX000-X001 = \"read hall/press/{n}/{}\"\nD0 = \"write hall/press/{n}/strokes\"\n",
            ],
        ),
        target(
            "condition",
            condition,
            &[
                "Y000 & !Y001 | (D0 >= 10 & D1 <> -3)",
                "\"motor left\" & pump = 1 | !(C0.value < D5.i32) & K4X000 > 7",
            ],
        ),
        target(
            "safety-functions",
            functions,
            &[
                "[[property]]\nuse = \"two-hand\"\nleft = \"X000\"\nright = \"X001\"\noutput = \"Y000\"\nwithin = \"500ms\"\n",
                "[[property]]\nmatrix = \"m.csv\"\n---\n;;Y000;Y001\n;;pump;valve\nX000;stop;X;S\nX001;level;X 2s;R\n",
            ],
        ),
        target(
            "connections",
            connections,
            &[
                "[io.panel]\nfiles = \"panel\"\nX000-X001 = \"read buttons\"\nD100 = \"read level loss -1\"\nevery = \"10ms\"\nfault = \"M100\"\n",
                "[io.cell]\nmqtt = \"192.168.1.5\"\nX000-X007 = \"read cell/in\"\nD0-D3 = \"read cell/{}\"\nY000 = \"write cell/lamp\"\n---\n{\"X000\":1,\"X003\":false,\"D0\":-7}",
                "[io.remote]\nmodbus-tcp = \"127.0.0.1:502\"\nX010-X017 = \"discrete 1/0\"\nD0 = \"holding 1/100\"\n---\n[1, 2, 3]",
            ],
        ),
        target(
            "recording",
            recording,
            &[
                "ms,device,value\n0,X000,1\n0,T0 contact,0\n0,T0,12\n500,D0.i32,-70000\n500,D4.f32,1.5\n900,K2M20,5\n",
                "ms,device,value\r\n0,D10.str,\"\"\"AB\"\"\"\r\n0,C235,-7\r\n1000,M8000,1\r\n",
            ],
        ),
        target(
            "debugging",
            debugging,
            &[
                r#"{"seq":1,"type":"request","command":"initialize","arguments":{"adapterID":"rungc"}}
{"seq":2,"type":"request","command":"setBreakpoints","arguments":{"source":{"path":"a.il"},"breakpoints":[{"line":2,"condition":"X0"}]}}
{"seq":3,"type":"request","command":"launch","arguments":{"program":"no such program.il","scan":10}}
{"seq":4,"type":"request","command":"disconnect"}"#,
                r#"{"seq":1,"type":"request","command":"threads"}
{"seq":"2","type":"request","command":3,"arguments":[]}
{"seq":2,"type":"event","event":"stopped"}"#,
            ],
        ),
        target(
            "structured-text",
            structured,
            &[
                "PROGRAM P\nVAR\n  a AT X0 : BOOL;\n  n : INT;\n  x : ARRAY [0..3] OF DINT;\nEND_VAR\nIF a AND n < 10 THEN n := n + 1; ELSIF NOT a THEN n := 0; ELSE x[1] := x[0] * 3; END_IF;\nOUT_T(a, TC0, 50);\nMOV(TS0 AND a, n + 1, D10);\nEND_PROGRAM\n",
                "PROGRAM P\nCASE D0 OF 1, 3: D1 := 16#FF; 5..7: SET(X0, M1); ELSE D1 := D2 MOD 3; END_CASE;\nFOR D3 := 0 TO 9 BY 3 DO D4 := D4 + D3; EXIT; END_FOR;\nWHILE D5 > 0 DO D5 := D5 - 1; END_WHILE;\nREPEAT D6 := -D6; UNTIL M0 = (M1 OR D7.3) END_REPEAT; (* end *)\nRETURN; // last\nEND_PROGRAM\n",
            ],
        ),
        target(
            "variable-names",
            names,
            &["Start,X000\n\"Motor left\"\tY0\n*,M100-M199\n*,T0\n"],
        ),
        target(
            "words",
            words,
            &[
                "20ms\n1.5h\nK4X000\nD0.f32\nT5.value\nY000.pulses\n-12\nnone\n",
                "COM1=/dev/ttyUSB0\ntcp:localhost:5000\nslcan:/dev/ttyACM0,250\nCOM3\n127.0.0.1:5551\n",
            ],
        ),
    ]
}
