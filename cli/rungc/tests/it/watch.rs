//! `rungc watch`, and `rungc why` of a PLC: against a running program, by each connection, and against a PLC of others.

use crate::common::clients::python;
use crate::common::running::Run;
use crate::common::{HANG, folder, rungc, soon, text};
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

/// M8012 is what the harness watches; the rest is a start that waits for a guard, a timer and a counter.
const STATION: &str = "\
;! X000 = start\n;! X002 = guard closed\n;! Y000 = motor\n;! M0 = automatic\n;! D0 = speed\n\
LD X000\nOR M0\nAND X002\nOUT M0\nLD M0\nOUT T0 K20\nLD T0\nOUT Y000\nLD M8002\nMOV K-7 D0\nDMOV K-70000 D2\n\
LD M8002\nOUT C0 K3\nLD M8002\nSET S20\nMOV K2 Z0\nLDP X005\nSET M1\nLD M8000\nSET M100\nEND\n";

/// The station in RUN: its folder, the run, and the options that name its connections.
fn station(model: &str) -> (tempfile::TempDir, Run, Vec<Vec<String>>) {
    let folder = folder(&[("p.il", STATION.as_bytes())]);
    let servers = ["--fx", "--mc", "--modbus-tcp"];
    let run = Run::new(folder.path(), model, &servers, &[]);
    let port = format!("tcp:127.0.0.1:{}", run.port("programming port"));
    let mc = format!("127.0.0.1:{}", run.port("MC protocol"));
    let modbus = format!("127.0.0.1:{}", run.port("Modbus TCP"));
    let owned = |args: &[&str]| args.iter().map(|&arg| arg.to_owned()).collect();
    let connections = vec![
        owned(&["--port", &port]),
        owned(&["--mc", &mc]),
        owned(&["--mc", &mc, "--mc-frame", "3e"]),
        owned(&["--modbus", &modbus]),
    ];
    (folder, run, connections)
}

/// The output of a command.
fn printed(folder: &Path, args: &[&str], more: &[String]) -> String {
    let more = more.iter().map(String::as_str);
    let args: Vec<&str> = args.iter().copied().chain(more).collect();
    let output = rungc(folder, &args);
    assert!(
        output.status.success(),
        "{args:?}: {}",
        text(&output.stderr)
    );
    text(&output.stdout)
}

#[test]
fn each_connection_shows_the_same_of_a_plc() {
    for model in ["fx3u", "h2u"] {
        let (folder, _run, connections) = station(model);
        let devices = [
            "X2", "Y0", "M0", "motor", "S20", "D0", "Z0", "C0", "T0", "M100",
        ];
        let watch = [
            &["watch", "p.il", "--model", model, "--once", "--to", "csv"][..],
            &devices,
        ]
        .concat();
        let expected = [
            "X002,0",
            "Y000,0",
            "M0,0",
            "M100,1",
            "S20,1",
            "T0 contact,0",
            "T0,0",
            "C0 contact,0",
            "C0,1",
            "D0,-7",
        ];
        for connection in &connections {
            let shown = printed(folder.path(), &watch, connection);
            for value in expected {
                let row = shown
                    .lines()
                    .any(|row| row.split_once(',').is_some_and(|(_, rest)| rest == value));
                assert!(row, "{model} {connection:?}: {value}: {shown}");
            }
        }
    }
}

#[test]
fn the_reason_is_that_of_the_plc() {
    let (folder, _run, connections) = station("fx3u");
    for connection in &connections {
        let why = ["why", "p.il", "motor", "--model", "fx3u"];
        let answer = printed(folder.path(), &why, connection);
        let first = "Y000 \"motor\" is off in the PLC,\nbecause T0 has not run its time (0 s of 2 s, 2 s to go), X000 \"start\" is off and \
                     X002 \"guard closed\" is off.";
        assert!(answer.starts_with(first), "{answer}");
    }
    let json = [
        "why", "p.il", "motor", "--model", "fx3u", "--format", "json", "--how",
    ];
    let json = printed(folder.path(), &json, &connections[0]);
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert!(json["moment"].get("ms").is_none(), "{json}");
    assert_eq!(json["how"]["found"], true, "{json}");
    let compare = ["why", "p.il", "motor", "--model", "fx3u", "--compare"];
    let same = printed(folder.path(), &compare, &connections[0]);
    assert!(
        same.contains("the program in the PLC is this program"),
        "{same}"
    );
    std::fs::write(
        folder.path().join("other.il"),
        STATION.replace("K20", "K30"),
    )
    .unwrap();
    let compare = ["why", "other.il", "motor", "--model", "fx3u", "--compare"];
    let other = printed(folder.path(), &compare, &connections[0]);
    assert!(other.contains("another one, from step"), "{other}");
}

/// A recording of all devices is a moment to take away.
#[test]
fn a_recording_answers_as_the_plc_does() {
    let (folder, _run, connections) = station("fx3u");
    let watch = [
        "watch", "p.il", "--model", "fx3u", "--all", "--once", "--to", "csv",
    ];
    let recording = printed(folder.path(), &watch, &connections[0]);
    let path = folder.path().join("moment.csv");
    std::fs::write(&path, &recording).unwrap();
    for device in ["motor", "M100", "T0", "C0"] {
        let why = ["why", "p.il", device, "--model", "fx3u"];
        let there = printed(folder.path(), &why, &connections[0]);
        let trace = ["--trace".to_owned(), "moment.csv".to_owned()];
        let here = printed(folder.path(), &why, &trace);
        assert_eq!(
            here,
            there.replacen(" in the PLC", " at 0 ms", 1),
            "{device}"
        );
    }
    // The guard is closed and the start pressed, later on.
    let later = format!("{recording}3000,X000,1\n3000,X002,1\n3010,M0,1\n");
    std::fs::write(&path, later).unwrap();
    let why = [
        "why",
        "p.il",
        "automatic",
        "--model",
        "fx3u",
        "--trace",
        "moment.csv",
    ];
    let shown = |more: &[&str]| printed(folder.path(), &[&why[..], more].concat(), &[]);
    assert!(
        shown(&[]).starts_with("M0 \"automatic\" is on at 3.01 s"),
        "{}",
        shown(&[])
    );
    assert!(
        shown(&["--moment", "1s"]).starts_with("M0 \"automatic\" is off at 1 s"),
        "{}",
        shown(&["--moment", "1s"])
    );
    for (trace, more, expected) in [
        (
            recording.as_str(),
            &["--moment", "9s"][..],
            "the recording is from 0 to 0 ms",
        ),
        (
            "ms,device,value\n0,X000,1\n",
            &[],
            "the recording has no `M0`",
        ),
        ("LD X000\n", &[], "line 1: a trace has the columns"),
        (
            "ms,device,value\n0,X000,7\n",
            &[],
            "line 2: `7` is not a value",
        ),
    ] {
        std::fs::write(&path, trace).unwrap();
        let output = rungc(folder.path(), &[&why[..], more].concat());
        let messages = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{messages}");
        assert!(messages.contains(expected), "{messages}");
    }
}

/// Passes a connection on, and notes what the client sends.
fn wire(to: u16) -> (u16, Arc<Mutex<Vec<u8>>>) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = listener.local_addr().unwrap().port();
    let sent = Arc::new(Mutex::new(Vec::new()));
    let noted = Arc::clone(&sent);
    thread::spawn(move || {
        let (mut client, _) = listener.accept().unwrap();
        let mut plc = TcpStream::connect(("127.0.0.1", to)).unwrap();
        let (mut back, mut answers) = (client.try_clone().unwrap(), plc.try_clone().unwrap());
        thread::spawn(move || std::io::copy(&mut answers, &mut back));
        let mut buffer = [0; 1024];
        while let Ok(count @ 1..) = client.read(&mut buffer) {
            noted.lock().unwrap().extend(&buffer[..count]);
            plc.write_all(&buffer[..count]).unwrap();
        }
    });
    (port, sent)
}

#[test]
fn nothing_on_the_wire_writes() {
    let (folder, run, _) = station("fx3u");
    let (port, sent) = wire(run.port("programming port"));
    let watch = [
        "watch",
        "p.il",
        "--model",
        "fx3u",
        "--every",
        "100ms",
        "--for",
        "1s",
        "--compare",
    ];
    printed(
        folder.path(),
        &watch,
        &["--port".into(), format!("tcp:127.0.0.1:{port}")],
    );
    let sent = sent.lock().unwrap();
    let frames: Vec<&[u8]> = sent.split(|c| *c == 0x02).skip(1).collect();
    // Read by the basic and the extended commands, the program, a bit; where END is.
    let reads: [&[u8]; 5] = [b"0", b"E00", b"E01", b"F5", b"E41"];
    assert!(frames.len() > 10, "{} frames", frames.len());
    for frame in frames {
        let is_read = reads.iter().any(|command| frame.starts_with(command));
        assert!(is_read, "{}", String::from_utf8_lossy(frame));
    }
    let (port, sent) = wire(run.port("MC protocol"));
    let watch = [
        "watch", "p.il", "--model", "fx3u", "--every", "100ms", "--for", "1s",
    ];
    printed(
        folder.path(),
        &watch,
        &["--mc".into(), format!("127.0.0.1:{port}")],
    );
    let sent = sent.lock().unwrap();
    assert!(
        sent.len() > 12 * 10 && sent.len().is_multiple_of(12),
        "{}",
        sent.len()
    );
    // Batch read of words.
    assert!(sent.chunks(12).all(|request| request[0] == 0x01));
    let (port, sent) = wire(run.port("Modbus TCP"));
    printed(
        folder.path(),
        &watch,
        &["--modbus".into(), format!("127.0.0.1:{port}")],
    );
    let sent = sent.lock().unwrap();
    assert!(
        sent.len() > 12 * 10 && sent.len().is_multiple_of(12),
        "{}",
        sent.len()
    );
    // Coils, inputs and registers.
    assert!(sent.chunks(12).all(|request| matches!(request[7], 1..=4)));
}

/// A group, pairs, characters, and devices in a row, by each connection; rejected are those that a PLC does not show.
#[test]
fn each_form_of_a_value_is_shown() {
    let list = "LD M8002\nMOV H4241 D10\nMOV K0 D11\nDEMOV E1.5 D12\nDMOV K-70000 D14\nMOV K5 K2M20\nSET Y002\n\
                LD M8000\nOUT C235 K100\nOUT T1 K100\nEND\n";
    let folder = folder(&[("p.il", list.as_bytes())]);
    let servers = ["--fx", "--mc", "--modbus-tcp"];
    let run = Run::new(folder.path(), "fx3u", &servers, &[]);
    let ends = [
        [
            "--port".to_owned(),
            format!("tcp:127.0.0.1:{}", run.port("programming port")),
        ],
        [
            "--mc".to_owned(),
            format!("127.0.0.1:{}", run.port("MC protocol")),
        ],
        [
            "--modbus".to_owned(),
            format!("127.0.0.1:{}", run.port("Modbus TCP")),
        ],
    ];
    let watch = [
        "watch",
        "p.il",
        "D10.str",
        "D12.f32",
        "D14.i32",
        "K2M20",
        "Y1..Y3",
        "C235.value",
        "T1",
        "--once",
        "--to",
        "csv",
    ];
    let expected = "\
D10.str,\"\"\"AB\"\"\"
D12.f32,1.5
D14.i32,-70000
K2M20,5
Y001,0
Y002,1
Y003,0
C235,0
T1 contact,";
    for end in &ends {
        let shown = printed(folder.path(), &watch, end);
        let rows = shown
            .lines()
            .skip(1)
            .filter_map(|row| Some(row.split_once(',')?.1));
        let rows: Vec<&str> = rows.collect();
        assert!(rows.join("\n").starts_with(expected), "{end:?}: {shown}");
        assert_eq!(rows.len(), 10, "{shown}");
    }
    for (name, why) in [
        ("Y000.pulses", "does not show `Y000.pulses`"),
        ("K4Y364", "`Y370` does not exist"),
        ("Y0..Y400", "`Y370` does not exist"),
    ] {
        let output = rungc(
            folder.path(),
            &["watch", "p.il", name, "--once", &ends[1][0], &ends[1][1]],
        );
        let messages = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{name}: {messages}");
        assert!(messages.contains(why), "{name}: {messages}");
    }
}

/// A slave on a serial line, RTU.
#[test]
fn a_slave_on_a_serial_line_is_read() {
    let list = "LD M8002\nMOV H2 D8126\nMOV H81 D8120\nMOV K3 D8121\nMOV K-7 D0\nSET M3\nEND\n";
    let folder = folder(&[("p.il", list.as_bytes())]);
    let run = Run::new(folder.path(), "h2u", &[], &["COM1"]);
    let watch = [
        "watch", "p.il", "--model", "h2u", "D0", "M3", "--once", "--to", "csv",
    ];
    let line = ["--modbus", run.line("COM1"), "--unit", "3"].map(str::to_owned);
    let shown = printed(folder.path(), &watch, &line);
    assert!(
        shown.contains(",D0,-7\n") && shown.contains(",M3,1\n"),
        "{shown}"
    );
    let line = [
        "--modbus",
        run.line("COM1"),
        "--retries",
        "1",
        "--timeout",
        "200ms",
    ]
    .map(str::to_owned);
    let args: Vec<&str> = watch
        .iter()
        .copied()
        .chain(line.iter().map(String::as_str))
        .collect();
    let output = rungc(folder.path(), &args);
    let messages = text(&output.stderr);
    assert!(
        messages.contains("no answer; check the cable") && messages.contains("asked 2 times"),
        "{messages}"
    );
}

#[test]
fn errors_of_a_program_are_named() {
    let list = "LD X000\nOUT X001\nLD X002\nOUT Y000\nEND\n";
    let folder = folder(&[("p.il", list.as_bytes())]);
    let server = crate::common::folder(&[("p.il", STATION.as_bytes())]);
    let run = Run::new(server.path(), "fx3u", &["--mc"], &[]);
    let mc = format!("127.0.0.1:{}", run.port("MC protocol"));
    let output = rungc(
        folder.path(),
        &["watch", "p.il", "Y0", "--once", "--mc", &mc],
    );
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(
        text(&output.stderr).contains("p.il has 1 error, which `rungc check` shows"),
        "{}",
        text(&output.stderr)
    );
    assert!(text(&output.stdout).contains("Y000"));
}

#[test]
fn changes_are_lines_until_the_end() {
    let list = "LD M8013\nOUT Y000\nLD M8002\nMOV K5 D0\nEND\n";
    let folder = folder(&[("p.il", list.as_bytes())]);
    let run = Run::new(folder.path(), "fx3u", &["--mc"], &[]);
    let mc = format!("127.0.0.1:{}", run.port("MC protocol"));
    let watch = [
        "watch", "p.il", "Y0", "D0", "--every", "50ms", "--for", "3s", "--to", "csv",
    ];
    let shown = printed(folder.path(), &watch, &["--mc".into(), mc]);
    let rows: Vec<&str> = shown.lines().skip(1).collect();
    let of = |device: &str| rows.iter().filter(|row| row.contains(device)).count();
    assert_eq!(of(",D0,5"), 1, "{shown}");
    assert!(of(",Y000,") >= 4, "{shown}");
    let changes = rows
        .iter()
        .filter(|row| row.contains("Y000"))
        .map(|row| row.ends_with('1'));
    let changes: Vec<bool> = changes.collect();
    assert!(changes.windows(2).all(|pair| pair[0] != pair[1]), "{shown}");
}

#[test]
fn bad_addresses_are_errors() {
    let folder = folder(&[("p.il", STATION.as_bytes())]);
    // Nothing listens there.
    let closed = TcpListener::bind("127.0.0.1:0")
        .unwrap()
        .local_addr()
        .unwrap();
    let closed = closed.to_string();
    for (args, expected) in [
        (&["watch", "p.il"][..], "name the PLC: `--port PORT`"),
        (&["watch", "p.il", "--modbus", &closed], "cannot open"),
        (
            &["watch", "p.il", "--modbus", &closed, "--port", "x"],
            "cannot be used with",
        ),
        (
            &["watch", "p.il", "--mc", &closed, "--unit", "3"],
            "cannot be used with",
        ),
        (&["watch", "p.il", "--mc", &closed], "cannot open"),
        (&["watch", "p.il", "--mc", "plc"], "HOST:PORT"),
        (
            &["watch", "p.il", "--mc", "tcp:127.0.0.1:5000"],
            "HOST:PORT",
        ),
        (&["watch", "p.il", "P0", "--mc", &closed], "`P0`"),
        (
            &["watch", "p.il", "M99999", "--mc", &closed],
            "does not exist on",
        ),
        (
            &["watch", "p.il", "moter", "--mc", &closed],
            "did you mean `motor`",
        ),
        (
            &["watch", "p.il", "--mc", &closed, "--compare"],
            "cannot be used with",
        ),
        (
            &["why", "p.il", "Y0", "--mc", &closed, "--set", "X0=1"],
            "cannot be used with",
        ),
        (&["why", "p.il", "Y0", "--mc-frame", "3e"], "--mc"),
    ] {
        let output = rungc(folder.path(), args);
        let messages = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{args:?}: {messages}");
        assert!(messages.contains(expected), "{args:?}: {messages}");
    }
}

/// Devices at the end of their class, where a request of whole words is rejected.
#[test]
fn the_last_devices_are_shown() {
    for (model, devices) in [
        ("fx1s", ["Y000", "X000", "S127"]),
        ("fx2n", ["S999", "M3071", "Y000"]),
        ("fx3u", ["X367", "X177", "S4095"]),
    ] {
        let list = format!(
            "LD X000\nAND {0}\nOUT M0\nLD {1}\nAND {2}\nOUT M1\nEND\n",
            devices[0], devices[1], devices[2]
        );
        let folder = folder(&[("p.il", list.as_bytes())]);
        let run = Run::new(folder.path(), model, &["--mc"], &[]);
        let mc = format!("127.0.0.1:{}", run.port("MC protocol"));
        let watch = [
            &["watch", "p.il", "--model", model, "--once", "--to", "csv"][..],
            &devices,
        ]
        .concat();
        for frame in ["1e", "3e"] {
            let more = ["--mc", &mc, "--mc-frame", frame].map(str::to_owned);
            let shown = printed(folder.path(), &watch, &more);
            for device in devices {
                assert!(
                    shown.contains(&format!(",{device},0")),
                    "{model} {frame}: {shown}"
                );
            }
        }
    }
}

#[test]
fn what_is_not_shown_is_not_explained() {
    let list = "LD M8002\nMOV K100 R0\nLD> R0 K50\nOUT Y000\nLD M8002\nMOV K5 Z0\nSET M5\nLD M0Z0\nOUT Y001\nEND\n";
    let folder = folder(&[("p.il", list.as_bytes())]);
    let run = Run::new(folder.path(), "fx3u", &["--fx"], &[]);
    let port = format!("tcp:127.0.0.1:{}", run.port("programming port"));
    let why = |device: &str| rungc(folder.path(), &["why", "p.il", device, "--port", &port]);
    let output = why("R0");
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("does not show `R0`"));
    let answer = text(&why("Y000").stdout);
    assert!(
        answer.contains("R0 is 0") && answer.contains("taken for off or 0: R0"),
        "{answer}"
    );
    // What an index leads to is read, too.
    let answer = text(&why("Y001").stdout);
    assert!(answer.starts_with("Y001 is on in the PLC"), "{answer}");
    assert!(!answer.contains("next scan"), "{answer}");
}

#[test]
fn a_watch_ends_as_it_should() {
    let (folder, _run, connections) = station("fx3u");
    let mc = &connections[1];
    let begin = Instant::now();
    printed(
        folder.path(),
        &["watch", "p.il", "--every", "1h", "--for", "1s"],
        mc,
    );
    assert!(begin.elapsed() >= Duration::from_secs(1) && begin.elapsed() < HANG);
    let mut watch = Command::new(env!("CARGO_BIN_EXE_rungc"));
    watch
        .args(["watch", "p.il", "--every", "50ms"])
        .args(mc)
        .current_dir(folder.path());
    watch.stdout(Stdio::piped()).stderr(Stdio::null());
    // The reader has gone.
    let mut child = Command::new(env!("CARGO_BIN_EXE_rungc"))
        .args(["watch", "p.il", "T0", "--every", "0ms", "--for", "60s"])
        .args(mc)
        .current_dir(folder.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    soon("the watch ends", || child.try_wait().unwrap().is_some());
    #[cfg(unix)]
    {
        let mut child = watch.spawn().unwrap();
        let mut first = String::new();
        BufReader::new(child.stdout.take().unwrap())
            .read_line(&mut first)
            .unwrap();
        let id = child.id().to_string();
        assert!(
            Command::new("kill")
                .args(["-INT", &id])
                .status()
                .unwrap()
                .success()
        );
        assert_eq!(child.wait().unwrap().code(), Some(130));
    }
}

/// Values that a PLC of others shows: of virtual-plc by frame 3E, of pymodbus as a slave.
fn shown_by_another(module: &str, script: &str, connection: &[&str]) -> Option<Vec<String>> {
    let mut child = python(module, script)?
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut port = String::new();
    let mut out = BufReader::new(child.stdout.take().unwrap());
    out.read_line(&mut port).unwrap();
    let list = "LD X020\nAND M3\nOUT T4 K50\nMOV D0 D1\nOUT C200 K5\nOUT Y000\nEND\n";
    let folder = folder(&[("p.il", list.as_bytes())]);
    let address = format!("127.0.0.1:{}", port.trim());
    let watch = [
        "watch",
        "p.il",
        "X20",
        "M3",
        "D0",
        "D1",
        "T4",
        "C200.value",
        "--once",
        "--to",
        "csv",
    ];
    let connection = connection.iter().map(|&option| option.to_owned());
    let connection: Vec<String> = connection.chain([address]).collect();
    let shown = printed(folder.path(), &watch, &connection);
    let _ = child.kill();
    let _ = child.wait();
    let values = shown.lines().skip(1);
    Some(
        values
            .filter_map(|row| Some(row.split_once(',')?.1.to_owned()))
            .collect(),
    )
}

#[test]
fn a_plc_of_others_is_read() {
    let connection = ["--mc-frame", "3e", "--mc"];
    if let Some(values) = shown_by_another("virtual_plc", "simulated_plc.py", &connection) {
        let expected = ["X020,1", "M3,1", "D0,7", "D1,-1", "T4 contact,0", "T4,12"];
        assert_eq!(values[..6], expected);
    }
}

#[test]
fn a_slave_of_others_is_read() {
    if let Some(values) = shown_by_another("pymodbus", "simulated_slave.py", &["--modbus"]) {
        let expected = [
            "X020,1",
            "M3,1",
            "D0,7",
            "D1,-1",
            "T4 contact,1",
            "T4,12",
            "C200,-70000",
        ];
        assert_eq!(values, expected);
    }
}
