//! `rungc watch`, and `rungc why` of a PLC: against a running program, by each connection, and against a PLC of others.

use crate::common::running::Run;
use crate::common::{HANG, folder, rungc, soon, text};
use crate::peers::python;
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
    let run = Run::new(folder.path(), model, &["--fx", "--mc"], &[]);
    let port = format!("tcp:127.0.0.1:{}", run.port("programming port"));
    let mc = format!("127.0.0.1:{}", run.port("MC protocol"));
    let owned = |args: &[&str]| args.iter().map(|&arg| arg.to_owned()).collect();
    let connections = vec![
        owned(&["--port", &port]),
        owned(&["--mc", &mc]),
        owned(&["--mc", &mc, "--mc-frame", "3e"]),
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
        (&["watch", "p.il", "--mc", &closed], "cannot open"),
        (&["watch", "p.il", "--mc", "plc"], "HOST:PORT"),
        (
            &["watch", "p.il", "--mc", "tcp:127.0.0.1:5000"],
            "HOST:PORT",
        ),
        (&["watch", "p.il", "P0", "--mc", &closed], "has no value"),
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

/// A simulated PLC of others, which speaks frame 3E.
#[test]
fn a_plc_of_others_is_read() {
    let Some(mut server) = python("virtual_plc", "simulated_plc.py") else {
        return;
    };
    let mut child = server
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut port = String::new();
    let mut out = BufReader::new(child.stdout.take().unwrap());
    out.read_line(&mut port).unwrap();
    let list = "LD X020\nAND M3\nOUT T4 K50\nMOV D0 D1\nOUT Y000\nEND\n";
    let folder = folder(&[("p.il", list.as_bytes())]);
    let address = format!("127.0.0.1:{}", port.trim());
    let watch = [
        "watch", "p.il", "X20", "M3", "D0", "D1", "T4", "--once", "--to", "csv",
    ];
    let shown = printed(
        folder.path(),
        &watch,
        &["--mc".into(), address, "--mc-frame".into(), "3e".into()],
    );
    let _ = child.kill();
    let _ = child.wait();
    let values: Vec<&str> = shown
        .lines()
        .skip(1)
        .filter_map(|row| Some(row.split_once(',')?.1))
        .collect();
    assert_eq!(
        values,
        ["X020,1", "M3,1", "T4 contact,0", "T4,12", "D0,7", "D1,-1"]
    );
}
