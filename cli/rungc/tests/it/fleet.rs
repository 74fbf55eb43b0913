//! `rungc fleet`: mistakes in its file, and many PLCs that pymodbus polls and mosquitto connects. `.ci/run` installs
//! these; where they are not, the tests say so, unless `RUNGC_PYTHON` or `RUNGC_REQUIRE_PEERS` is set.

use crate::common;
use crate::common::mosquitto::Ends;
use crate::common::{folder, shown, text};
use std::env;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{ChildStderr, Command, Stdio};

const ADDS: &str = "LD M8000\nADD D0 K1 D1\nLD M0\nOUT M1\nEND\n";

/// Calls the runtime library, which does not run in lanes.
const CALLS: &str = "LD M8000\nADD D0 K1 D1\nDSIN D10 D20\nLD M0\nOUT M1\nEND\n";

/// A fleet at work, and what it reports.
fn start(folder: &Path, file: &str) -> (Ends, BufReader<ChildStderr>) {
    let mut child = Command::new(env!("CARGO_BIN_EXE_rungc"))
        .args(["fleet", "--verbose", file])
        .current_dir(folder)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let errors = BufReader::new(child.stderr.take().unwrap());
    (Ends(child), errors)
}

/// Interrupts a fleet; what it prints at its end.
fn interrupt(fleet: &mut Ends) -> String {
    let mut out = fleet.0.stdout.take().unwrap();
    assert_eq!(fleet.interrupt(), Some(130));
    let mut summary = String::new();
    out.read_to_string(&mut summary).unwrap();
    summary
}

/// Messages of `rungc fleet` about a file.
fn messages(fleet: &str) -> String {
    let folder = folder(&[
        ("p.il", ADDS.as_bytes()),
        ("calls.il", CALLS.as_bytes()),
        ("clock.il", b"LD M8000\nTRD D0\nEND\n"),
        ("wrong.il", b"LD Q0\nOUT M0\nEND\n"),
        ("fleet.toml", fleet.as_bytes()),
    ]);
    shown(
        folder.path(),
        &["fleet", "fleet.toml", "--virtual", "--for", "100ms"],
    )
}

#[test]
fn mistakes_have_their_place() {
    let cases = [
        "",
        "[plc.a\n",
        "[fleets]\n[plc.a]\nprogram = 'p.il'\ncuont = 2\n",
        "[fleet]\ncycle = true\n[plc.a]\nprogram = 'p.il'\ncount = 0\nengine = 'fast'\nset = ['X000=2', 'X009=1']\n",
        "[plc.a]\nprogram = 'p.il'\nset = ['X000=2']\n",
        "[plc.a]\nprogram = 'p.il'\nset = ['0:CH1.V=2']\n",
        "[plc.a]\nprogram = 'p.il'\nmodbus-tcp = 'here'\nstore = ['D0:D9']\nspread = 'soon'\n",
        "[plc.a]\nprogram = 'p.il'\nunits = 9\n",
        "[plc.a]\ncount = 2\n[plc.a.topics]\nY000 = 'write hall/{}'\n",
        "[broker]\nport = '1883'\n[plc.a]\nprogram = 'p.il'\ncount = 2\n[plc.a.topics]\nY000 = 'write hall/{}'\nx = 'read a'\n",
        "[broker]\nmqtt = 'localhost'\nX000 = 'read a'\n[plc.a]\nprogram = 'p.il'\n[plc.a.topics]\nY000 = 'read hall/{}'\n",
        "[plc.a]\nprogram = 'p.il'\n[plc.a.topics]\nX000 = 'read hall/{}'\n",
        "[plc.a]\nprogram = 'p.il'\nstore = ['D9000']\n",
        "[plc.a]\nprogram = 'p.il'\nmodbus-tcp = '127.0.0.1:65535'\ncount = 2\nengine = 'interp'\n",
        "[plc.a]\nprogram = 'calls.il'\nengine = 'lanes'\n",
        "[plc.a]\nprogram = 'clock.il'\nengine = 'c'\n",
        "[plc.a]\nprogram = 'wrong.il'\n",
        "[plc.a]\nprogram = 'none.il'\n",
    ];
    let shown = cases.map(|case| format!("{case}-----\n{}", messages(case)));
    insta::assert_snapshot!(shown.join("\n=====\n"));
}

#[test]
fn ports_that_lead_nowhere_are_reported() {
    let rs = b"LD M8000\nRS D0 K1 D10 K1\nEND\n";
    let fleet = b"[plc.scale]\nprogram = 'rs.il'\n[plc.adds]\nprogram = 'p.il'\n";
    let folder = folder(&[
        ("p.il", ADDS.as_bytes()),
        ("rs.il", rs),
        ("fleet.toml", fleet),
    ]);
    let args = ["fleet", "fleet.toml", "--virtual", "--for", "100ms"];
    let said = shown(folder.path(), &args);
    let report = "serial ports and CAN cards of a fleet are not connected";
    assert_eq!(said.matches(report).count(), 1, "{said}");
    assert!(said.contains(&format!("scale: {report}")), "{said}");
}

#[test]
fn settings_come_to_each_plc_in_its_time() {
    // D0 counts the scans in which X000 is on: 5 of 10, later in each PLC; D1 has its number.
    let program = "LD X000\nINC D0\nLD M8000\nMOV D10 D11\nEND\n";
    let fleet = "\
[plc.lanes]
program = 'p.il'
count = 100
set = ['X000=1@20ms', 'X000=0@70ms', 'D10=7']
spread = '3ms'
engine = 'ENGINE'
";
    for engine in ["lanes", "interp"] {
        let folder = folder(&[
            ("p.il", program.as_bytes()),
            ("fleet.toml", fleet.replace("ENGINE", engine).as_bytes()),
        ]);
        let args = ["fleet", "fleet.toml", "--virtual", "--for", "1s"];
        let out = common::rungc(folder.path(), &args);
        let (out, err) = (text(&out.stdout), text(&out.stderr));
        assert!(
            out.starts_with("101 scans of all PLCs, 0 missed\n"),
            "{out}{err}"
        );
        let what = match engine {
            "lanes" => "lanes: 100 PLCs, 64 at once in ",
            _ => "lanes: 100 PLCs, on the interpreter\n",
        };
        assert!(out.contains(what), "{out}{err}");
    }
}

/// Divides by zero in each PLC later than in the one before it: only PLCs 5 to 24 have come to it at the end.
const DIVIDES: &str = "LD X000\nDIV D0 D1 D2\nLD X000\nINC D5\nEND\n";

/// The same, and the runtime library is called for the root of a negative number; then the program stops itself.
const ROOTS: &str = "\
LD X000
DIV D0 D1 D2
LDP X000
MOV K-5 D10
SQR D10 D20
LD X001
OUT M8037
END
";

/// Jumps back for as long as an input is on, which is until the watchdog stops it.
const LOOPS: &str = "P0\nLD X001\nCJ P0\nLD X000\nOUT Y000\nEND\n";

/// Summary of a fleet of 100 PLCs on an engine, with the line about the engine cut.
fn summary(program: &str, engine: &str) -> String {
    let fleet = format!(
        "[plc.a]\nprogram = 'p.il'\ncount = 100\nfirst = 5\nset = ['X000=1@20ms', 'X001=1@150ms']\nspread = '10ms'\nengine = '{engine}'\n"
    );
    let program = ("p.il", program.as_bytes());
    let folder = folder(&[program, ("fleet.toml", fleet.as_bytes())]);
    let args = ["fleet", "fleet.toml", "--virtual", "--for", "210ms"];
    let out = common::rungc(folder.path(), &args);
    let (printed, err) = (text(&out.stdout), text(&out.stderr));
    assert!(out.status.success(), "{printed}{err}");
    let begins = match engine {
        "lanes" => "a: 100 PLCs, 64 at once in ",
        "c" | "auto" => "a: 100 PLCs, in C in ",
        _ => "a: 100 PLCs, on the interpreter\n",
    };
    assert!(printed.contains(begins), "{printed}{err}");
    let mut lines = printed.lines().filter(|line| line.starts_with("a: "));
    lines.next();
    lines.collect::<Vec<_>>().join("\n")
}

#[test]
fn operation_errors_are_in_the_summary() {
    let lanes = summary(DIVIDES, "lanes");
    insta::assert_snapshot!(lanes);
    for engine in ["c", "interp"] {
        assert_eq!(summary(DIVIDES, engine), lanes, "{engine}");
    }
}

#[test]
fn a_program_that_calls_the_runtime_runs_in_c() {
    let called = summary(ROOTS, "c");
    insta::assert_snapshot!(called);
    for engine in ["auto", "interp"] {
        assert_eq!(summary(ROOTS, engine), called, "{engine}");
    }
}

#[test]
fn the_watchdog_is_in_the_summary() {
    let stopped = summary(LOOPS, "auto");
    insta::assert_snapshot!(stopped);
    assert_eq!(summary(LOOPS, "interp"), stopped);
}

#[test]
fn pymodbus_polls_many_ports_and_units() {
    let python = env::var_os("RUNGC_PYTHON").unwrap_or_else(|| "python3".into());
    let mut look = Command::new(&python);
    look.args(["-c", "import pymodbus"]).stderr(Stdio::null());
    if !look.status().is_ok_and(|status| status.success()) {
        assert!(
            env::var_os("RUNGC_PYTHON").is_none(),
            "RUNGC_PYTHON is set, but there is no pymodbus"
        );
        eprintln!("skipped: there is no pymodbus (see .ci/run)");
        return;
    }
    let fleet = "\
[plc.ports]
program = 'p.il'
count = 200
modbus-tcp = '0'

[plc.units]
program = 'p.il'
count = 100
modbus-tcp = '0'
units = 100

[plc.calls]
program = 'calls.il'
count = 20
modbus-tcp = '0'
";
    let folder = folder(&[
        ("p.il", ADDS.as_bytes()),
        ("calls.il", CALLS.as_bytes()),
        ("fleet.toml", fleet.as_bytes()),
    ]);
    let (mut fleet, errors) = start(folder.path(), "fleet.toml");
    let (mut ports, mut units) = (Vec::new(), String::new());
    for line in errors.lines().map_while(Result::ok) {
        let address = line.rsplit_once(" at 127.0.0.1:").map(|(_, port)| port);
        match address {
            Some(port) if line.starts_with("    units ") => units = port.to_string(),
            Some(port) if line.starts_with("    ") => ports.push(port.to_string()),
            _ if line.contains("a scan of all every") => break,
            _ => {}
        }
    }
    assert_eq!(ports.len(), 220);
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/clients/fleet_tcp.py");
    let polled = Command::new(&python)
        .arg(script)
        .args([&ports.join(","), &units, "100"])
        .output()
        .unwrap();
    assert_eq!(
        text(&polled.stdout),
        "320 PLCs\n",
        "{}",
        text(&polled.stderr)
    );
    let summary = interrupt(&mut fleet);
    for line in [
        "ports: 200 PLCs, 64 at once in ",
        "units: 100 PLCs, 64 at once in ",
        "calls: 20 PLCs, on the interpreter: the program calls the runtime library, and fewer than 64 PLCs are ",
    ] {
        assert!(summary.contains(line), "{summary}");
    }
}

/// The answer of unit 2 to a request of Modbus TCP.
fn ask(client: &mut TcpStream, request: &[u8]) -> Vec<u8> {
    let mut frame = vec![0, 1, 0, 0, 0, request.len() as u8 + 1, 2];
    frame.extend_from_slice(request);
    client.write_all(&frame).unwrap();
    let mut answer = [0; 260];
    let count = client.read(&mut answer).unwrap();
    answer[7..count].to_vec()
}

/// PLCs on an interpreter have all special devices, as in `rungc serve`: the program names none of them.
#[test]
fn clients_see_special_devices_and_switch_to_stop() {
    let fleet = "\
[plc.presses]
program = 'p.il'
count = 3
first = 11
units = 3
engine = 'interp'
modbus-tcp = 0
";
    let folder = folder(&[
        ("p.il", b"LD M0\nOUT M1\nEND\n"),
        ("fleet.toml", fleet.as_bytes()),
    ]);
    let (mut fleet, errors) = start(folder.path(), "fleet.toml");
    let mut lines = errors.lines().map_while(Result::ok);
    let line = lines.find(|line| line.contains("Modbus TCP at ")).unwrap();
    let address = line.split(" at ").nth(1).unwrap();
    let address = address.split(',').next().unwrap();
    let mut client = TcpStream::connect(address).unwrap();
    client.set_nodelay(true).unwrap();
    // M8011, the clock of 10 ms: M8000 is 1E00h.
    let blinks = |client: &mut TcpStream| ask(client, &[1, 0x1e, 11, 0, 2]);
    let first = blinks(&mut client);
    common::soon("M8011 or M8012 changes", || blinks(&mut client) != first);
    // D8018, the year: D8000 is 1F40h.
    assert!(ask(&mut client, &[3, 0x1f, 0x52, 0, 1])[3] >= 26);
    let runs = |client: &mut TcpStream| ask(client, &[1, 0x1e, 0, 0, 1]) == [1, 1, 1];
    assert!(runs(&mut client));
    let stop = [5, 0x1e, 37, 0xff, 0];
    assert_eq!(ask(&mut client, &stop), stop);
    common::soon("it is in STOP", || !runs(&mut client));
    let line = lines.find(|line| line.contains(" switches ")).unwrap();
    assert_eq!(
        line,
        "rungc: presses: 127.0.0.1 switches PLC 12 to STOP (Modbus TCP)"
    );
    let summary = interrupt(&mut fleet);
    assert!(summary.contains("presses: 1 PLC in STOP"), "{summary}");
}

#[cfg(feature = "mqtt")]
mod brokers {
    use super::*;
    use common::mosquitto::{self, broker, is_there, open_to_all};
    use common::{free_port, soon};
    use std::thread;
    use std::time::Duration;

    const PRESS: &str = include_str!(concat!(env!("RUNGC_ROOT"), "/examples/fleet/press.il"));

    /// Number of presses that show a value of a topic.
    fn count(port: u16, topic: &str, payload: &str) -> usize {
        let topic = format!("hall/press/+/{topic}");
        let shown = mosquitto::subscribe(port, None, &["-W", "1", "-t", &topic]);
        shown.lines().filter(|line| *line == payload).count()
    }

    fn publish(port: u16, press: u32, topic: &str, payload: &str) {
        let topic = format!("hall/press/{press}/{topic}");
        mosquitto::publish(port, None, &topic, payload);
    }

    /// Presses of both processes are started and stopped.
    fn works(port: u16) {
        soon("all presses are there", || count(port, "Y001", "0") == 200);
        for press in [1, 64, 100, 101, 200] {
            publish(port, press, "X001", "0");
            publish(port, press, "X000", "1");
        }
        soon("five run", || count(port, "Y001", "1") == 5);
        for press in [1, 64, 100, 101, 200] {
            publish(port, press, "X000", "0");
            publish(port, press, "X001", "1");
        }
        soon("none runs", || count(port, "Y001", "0") == 200);
    }

    #[test]
    fn two_processes_share_a_broker_that_is_killed() {
        if !is_there() {
            return;
        }
        let port = free_port();
        let halls = [
            include_str!(concat!(env!("RUNGC_ROOT"), "/examples/fleet/hall-1.toml")),
            include_str!(concat!(env!("RUNGC_ROOT"), "/examples/fleet/hall-2.toml")),
        ];
        // A tenth of the example's cycles, and a fifth of its presses, for a machine that does other things, too.
        let halls = halls.map(|hall| {
            hall.replace("count = 500", "count = 100")
                .replace("first = 501", "first = 101")
                .replace("\"10ms\"", "\"100ms\"")
                .replace("1883", &port.to_string())
        });
        let folder = folder(&[
            ("press.il", PRESS.as_bytes()),
            ("hall-1.toml", halls[0].as_bytes()),
            ("hall-2.toml", halls[1].as_bytes()),
            ("mosquitto.conf", open_to_all(port).as_bytes()),
        ]);
        let folder = folder.path();
        let first = broker(folder);
        let mut fleets = ["hall-1.toml", "hall-2.toml"].map(|file| {
            let (fleet, errors) = start(folder, file);
            thread::spawn(move || errors.lines().map_while(Result::ok).count());
            fleet
        });
        works(port);
        drop(first);
        thread::sleep(Duration::from_millis(500));
        let _second = broker(folder);
        works(port);
        for fleet in &mut fleets {
            let summary = interrupt(fleet);
            assert!(
                summary.contains("press: 100 PLCs, 64 at once in "),
                "{summary}"
            );
        }
        soon("both say that they are gone", || {
            let topics = ["-W", "1", "-t", "hall/process-1", "-t", "hall/process-2"];
            mosquitto::subscribe(port, None, &topics) == "offline\noffline\n"
        });
    }
}

#[test]
fn programs_are_not_taken_for_fleets() {
    let folder = common::folder(&[("motor.il", common::MOTOR.as_bytes())]);
    let output = common::rungc(folder.path(), &["fleet", "motor.il"]);
    assert_eq!(output.status.code(), Some(2));
    let messages = common::text(&output.stderr);
    assert!(
        messages.contains("this is a program: a fleet is a file with"),
        "{messages}"
    );
}
