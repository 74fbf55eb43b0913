//! `rungc serve`: servers of rungc.toml, the table of connections, and the log of frames.

use crate::common::{HANG, folder, rungc, soon, text};
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, ChildStderr, Command, Output, Stdio};
use std::time::Duration;

/// COM1 is a Modbus slave, RTU, station 1, 9600 bit/s.
const PROGRAM: &str = "\
LD M8002
MOV H2 D8126
MOV H81 D8120
MOV K1 D8121
LD M8000
ADD D0 D1 D2
END
";

const SETTINGS: &str = "\
[project]
program = 'p.il'
model = 'h2u'

[serve]
modbus-tcp = 0
mc = [0]
fx = '127.0.0.1:0'
serial = { COM1 = 'tcp-listen:0' }
";

/// A running `rungc serve`, with the ports of this machine in the order in which they are reported.
struct Serving {
    child: Child,
    errors: BufReader<ChildStderr>,
    ports: Vec<u16>,
}

impl Serving {
    fn start(folder: &Path, servers: usize, args: &[&str]) -> Serving {
        Self::printing(folder, servers, args, Stdio::piped())
    }

    fn printing(folder: &Path, servers: usize, args: &[&str], output: Stdio) -> Serving {
        let command = Command::new(env!("CARGO_BIN_EXE_rungc"));
        Self::of(command, folder, servers, args, output)
    }

    fn of(
        mut command: Command,
        folder: &Path,
        servers: usize,
        args: &[&str],
        output: Stdio,
    ) -> Serving {
        let mut child = command
            .arg("serve")
            .args(args)
            .current_dir(folder)
            .stdin(Stdio::piped())
            .stdout(output)
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut errors = BufReader::new(child.stderr.take().unwrap());
        let mut ports = Vec::new();
        while ports.len() < servers {
            let mut line = String::new();
            assert_ne!(errors.read_line(&mut line).unwrap(), 0, "it has ended");
            let port = line.trim_end().rsplit_once("127.0.0.1:");
            ports.extend(port.map(|(_, port)| port.parse::<u16>().unwrap()));
        }
        Serving {
            child,
            errors,
            ports,
        }
    }

    fn connect(&self, server: usize) -> TcpStream {
        let stream = TcpStream::connect(("127.0.0.1", self.ports[server])).unwrap();
        stream.set_read_timeout(Some(HANG)).unwrap();
        stream
    }

    /// Asks it to end, as Ctrl-C does, which a caller in the background may ignore. Returns what it has printed; ports
    /// are named after their order.
    fn interrupt(mut self) -> Output {
        let pid = self.child.id().to_string();
        let kill = Command::new("kill").args(["-TERM", &pid]).status().unwrap();
        assert!(kill.success());
        let mut stderr = Vec::new();
        self.errors.read_to_end(&mut stderr).unwrap();
        let mut stdout = String::new();
        if let Some(table) = &mut self.child.stdout {
            table.read_to_string(&mut stdout).unwrap();
        }
        let status = self.child.wait().unwrap();
        for (n, port) in self.ports.iter().enumerate() {
            stdout = stdout.replace(&port.to_string(), &format!("port{n}"));
        }
        Output {
            stdout: stdout.into_bytes(),
            stderr,
            status,
        }
    }
}

impl Drop for Serving {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Asks until there is an answer: on a loaded machine a request on a line may arrive with a pause in it, which cuts the
/// frame.
fn ask(stream: &mut TcpStream, request: &[u8], length: usize) -> Vec<u8> {
    let patience = Some(Duration::from_secs(4));
    stream.set_read_timeout(patience).unwrap();
    let mut reply = vec![0; length];
    soon(&format!("an answer to {request:02x?}"), || {
        stream.write_all(request).unwrap();
        stream.read_exact(&mut reply).is_ok()
    });
    reply
}

const WRITE_D100: [u8; 12] = [0, 1, 0, 0, 0, 6, 1, 6, 0, 100, 0, 7];
const WRITE_D0: [u8; 12] = [0, 1, 0, 0, 0, 6, 1, 6, 0, 0, 0, 7];
const READ_60000: [u8; 12] = [0, 2, 0, 0, 0, 6, 1, 3, 0xea, 0x60, 0, 1];
const RTU_WRITE_D0: [u8; 8] = [1, 6, 0, 0, 0, 5, 0x49, 0xc9];

/// The row of a table that begins so, its cells.
fn row(table: &str, begin: &[&str]) -> Vec<String> {
    let mut lines = table.lines();
    let line = lines.find(|line| begin.iter().all(|part| line.contains(part)));
    let line = line.unwrap_or_else(|| panic!("{begin:?} is not in\n{table}"));
    let cells = line
        .split("  ")
        .map(str::trim)
        .filter(|cell| !cell.is_empty());
    cells.map(str::to_string).collect()
}

/// The answer of the protocol is that the request is carried out.
#[test]
fn writes_without_effect_are_reported_once() {
    let folder = folder(&[
        ("p.il", PROGRAM.as_bytes()),
        ("rungc.toml", SETTINGS.as_bytes()),
    ]);
    let serving = Serving::start(folder.path(), 4, &[]);
    let mut modbus = serving.connect(0);
    let write_m8000 = [0, 3, 0, 0, 0, 6, 1, 5, 0x1f, 0x40, 0, 0];
    for request in [write_m8000, write_m8000, WRITE_D100] {
        assert_eq!(ask(&mut modbus, &request, 12), request);
    }
    let errors = text(&serving.interrupt().stderr);
    let report = "writes M8000, without effect: each scan sets it (RUN monitor";
    assert_eq!(errors.matches(report).count(), 1, "{errors}");
    assert_eq!(errors.matches("without effect").count(), 1, "{errors}");
}

/// As an executable does: what the caller ignores stays ignored.
#[test]
fn a_run_under_nohup_outlives_its_terminal() {
    let folder = folder(&[
        ("p.il", PROGRAM.as_bytes()),
        ("rungc.toml", SETTINGS.as_bytes()),
    ]);
    let mut command = Command::new("nohup");
    command.arg(env!("CARGO_BIN_EXE_rungc"));
    let serving = Serving::of(command, folder.path(), 4, &[], Stdio::piped());
    let pid = serving.child.id().to_string();
    let sent = Command::new("kill").args(["-HUP", &pid]).status().unwrap();
    assert!(sent.success());
    let mut client = serving.connect(0);
    for _ in 0..20 {
        ask(&mut client, &WRITE_D100, 12);
    }
    assert_eq!(serving.interrupt().status.code(), Some(130));
}

#[test]
fn the_table_of_connections() {
    let folder = folder(&[
        ("p.il", PROGRAM.as_bytes()),
        ("rungc.toml", SETTINGS.as_bytes()),
    ]);
    let serving = Serving::start(folder.path(), 4, &["--trace-frames=frames.log"]);
    let mut modbus = serving.connect(0);
    assert_eq!(ask(&mut modbus, &WRITE_D100, 12), WRITE_D100);
    assert_eq!(ask(&mut modbus, &READ_60000, 9)[7..], [0x83, 2]);
    assert_eq!(ask(&mut serving.connect(2), b"\x05", 1), b"\x06");
    let mut line = serving.connect(3);
    assert_eq!(ask(&mut line, &RTU_WRITE_D0, 8), RTU_WRITE_D0);
    let output = serving.interrupt();
    assert_eq!(output.status.code(), Some(130), "{}", text(&output.stderr));
    let table = &text(&output.stdout);
    let modbus = row(table, &["port0"]);
    let exception = "exception 02 (illegal data address)";
    assert_eq!(
        modbus[2..],
        ["Modbus TCP", "2", "2", "1", exception, "D100"]
    );
    assert_eq!(
        row(table, &["port1"])[1..],
        ["–", "MC protocol", "0", "0", "0", "–", "–"]
    );
    let fx = row(table, &["port2", "programming port"]);
    assert_eq!(fx[3..], ["1", "1", "0", "–", "–"]);
    let com1 = row(table, &["COM1", "Modbus slave RTU"]);
    assert_eq!(com1.last().unwrap(), "D0");
    let log = fs::read_to_string(folder.path().join("frames.log")).unwrap();
    for messages in [
        "<- 127.0.0.1  unit 1: 06 write register 100 = 7: writes D100  [00 01 00 00 00 06 01 06 00 64 00 07]",
        "-> 127.0.0.1  unit 1: 06 done  [00 01 00 00 00 06 01 06 00 64 00 07]",
        "unit 1: 03 exception 02 (illegal data address)  [00 02 00 00 00 03 01 83 02]",
        "<- 127.0.0.1  <ENQ>  [05]",
        "station 1: 06 write register 0 = 5: writes D0  [01 06 00 00 00 05 49 C9]",
        "station 1: 06 done  [01 06 00 00 00 05 49 C9]",
    ] {
        assert!(log.contains(messages), "{messages} is not in\n{log}");
    }
}

/// Standard output is a full disk, and then closed; rubbish is typed, and then nothing any more: clients are served.
#[test]
fn nobody_who_listens_is_needed() {
    let folder = folder(&[
        ("p.il", PROGRAM.as_bytes()),
        ("rungc.toml", SETTINGS.as_bytes()),
    ]);
    let full = fs::File::options().write(true).open("/dev/full").unwrap();
    let (closed, writer) = std::io::pipe().unwrap();
    drop(closed);
    for (output, why) in [
        (Stdio::from(full), "No space left"),
        (writer.into(), "Broken pipe"),
    ] {
        let watch = ["--watch", "D2", "--for", "30min"];
        let mut serving = Serving::printing(folder.path(), 4, &watch, output);
        let mut typed = serving.child.stdin.take().unwrap();
        let rubbish: Vec<u8> = (0..60_000u32).map(|n| ((n * n) >> 3) as u8).collect();
        // As much as the pipe takes, since nothing reads it.
        let _ = typed.write(&rubbish);
        drop(typed);
        let mut modbus = serving.connect(0);
        for _ in 0..5 {
            // Changes D2, which is printed.
            assert_eq!(ask(&mut modbus, &WRITE_D0, 12), WRITE_D0);
        }
        let messages = serving.interrupt();
        let messages = text(&messages.stderr);
        let reported = format!("rungc: standard output: {why}");
        assert_eq!(messages.matches(&reported).count(), 1, "{messages}");
        assert!(
            messages.contains("; the run continues") && messages.contains("interrupted"),
            "{messages}"
        );
    }
}

/// A second client does not cut the first one off; when that has gone, the next one is served.
#[test]
fn the_present_client_keeps_the_line() {
    let folder = folder(&[
        ("p.il", PROGRAM.as_bytes()),
        ("rungc.toml", SETTINGS.as_bytes()),
    ]);
    let serving = Serving::start(folder.path(), 4, &[]);
    let mut present = serving.connect(3);
    assert_eq!(ask(&mut present, &RTU_WRITE_D0, 8), RTU_WRITE_D0);
    let rejected = serving.connect(3).read(&mut [0]);
    assert!(!matches!(rejected, Ok(1..)), "{rejected:?}");
    assert_eq!(ask(&mut present, &RTU_WRITE_D0, 8), RTU_WRITE_D0);
    drop(present);
    soon("the next client is served", || {
        let mut next = serving.connect(3);
        let mut reply = [0; 8];
        next.write_all(&RTU_WRITE_D0).is_ok()
            && next.read_exact(&mut reply).is_ok()
            && reply == RTU_WRITE_D0
    });
}

/// The command line takes precedence about a protocol, and about a port.
#[test]
fn options_override_settings() {
    let settings = SETTINGS.replace("modbus-tcp = 0", "modbus-tcp = '203.0.113.1:502'");
    let settings = settings.replace("tcp-listen:0", "no-such-tty");
    let folder = folder(&[
        ("p.il", PROGRAM.as_bytes()),
        ("rungc.toml", settings.as_bytes()),
    ]);
    let args = ["--modbus-tcp", "0", "--serial", "COM1=tcp-listen:0"];
    let serving = Serving::start(folder.path(), 4, &args);
    assert_eq!(ask(&mut serving.connect(0), &WRITE_D100, 12), WRITE_D100);
    assert_eq!(serving.interrupt().status.code(), Some(130));
}

/// A value that cannot be had is named by its key and file, or by its option.
#[test]
fn messages_name_where_an_address_comes_from() {
    let says = |settings: &str, args: &[&str]| {
        let settings = format!("[serve]\n{settings}\n");
        let folder = folder(&[
            ("p.il", PROGRAM.as_bytes()),
            ("rungc.toml", settings.as_bytes()),
        ]);
        let output = rungc(folder.path(), &[&["serve", "p.il"], args].concat());
        assert_ne!(output.status.code(), Some(0));
        text(&output.stderr).to_string()
    };
    let key = |key: &str| format!("rungc.toml: `{key}` of `[serve]`");
    for (settings, args, message) in [
        (
            "mc = '203.0.113.1:5001'",
            &[][..],
            key("mc") + ": cannot serve MC protocol at 203.0.113.1:5001: ",
        ),
        (
            "mc = 0",
            &["--modbus-tcp", "203.0.113.1:502"],
            "rungc: --modbus-tcp: cannot serve Modbus TCP".to_string(),
        ),
        (
            "serial = { COM1 = '/no/such/tty' }",
            &[],
            key("serial") + ": cannot open /no/such/tty",
        ),
        ("fx = '/no/such/tty'", &[], key("fx") + ": cannot open"),
        ("page = '0.0.0.0:0'", &[], key("page") + " 0.0.0.0:0: "),
        (
            "mc = 5077\nmodbus-tcp = 5077",
            &[],
            "`mc` has port 5077 already".to_string(),
        ),
        ("mc = 0", &["--read-only"], "add --page".to_string()),
    ] {
        let reported = says(settings, args);
        assert!(reported.contains(&message), "{settings}: {reported}");
    }
}

#[test]
fn nothing_to_serve() {
    let alone = folder(&[("p.il", PROGRAM.as_bytes())]);
    let output = rungc(alone.path(), &["serve", "p.il"]);
    insta::assert_snapshot!("nothing", text(&output.stderr));
    assert_eq!(output.status.code(), Some(2));
    let silent = folder(&[
        ("p.il", PROGRAM.as_bytes()),
        ("rungc.toml", b"[serve]\nD = 'D0'\n"),
    ]);
    let output = rungc(silent.path(), &["serve", "p.il"]);
    assert!(
        text(&output.stderr).contains("[serve]` of "),
        "{}",
        text(&output.stderr)
    );
    assert_eq!(output.status.code(), Some(2));
}

/// Set-up of a program's ports: in reports, as data, and the devices that an emitted program serves.
#[test]
fn ports_in_reports() {
    let settings = b"[serve]\nD = 'D0-D511'\n";
    let folder = folder(&[("p.il", PROGRAM.as_bytes()), ("rungc.toml", settings)]);
    let says = |args: &[&str]| {
        let output = rungc(folder.path(), &[args, &["p.il", "--model", "h2u"]].concat());
        assert_eq!(output.status.code(), Some(0));
        output
    };
    let port = "Port COM1: Modbus slave RTU, station 1, 9600 8N1";
    assert!(text(&says(&["check", "-v"]).stderr).contains(port));
    assert!(!text(&says(&["check"]).stderr).contains(port));
    let built = says(&["build", "--emit", "c"]);
    let built = text(&built.stderr);
    assert!(built.contains(port), "{built}");
    let served =
        "Serves the devices that the program names, D0-D511; requests for others are rejected";
    assert!(built.contains(served), "{built}");
    let json = says(&["check", "--format", "json"]);
    let json: serde_json::Value = serde_json::from_slice(&json.stdout).unwrap();
    assert_eq!(
        json["ports"],
        serde_json::json!([{
            "port": "COM1", "protocol": "Modbus slave RTU", "station": 1,
            "bits_per_second": 9600, "data_bits": 8, "parity": "none", "stop_bits": 1
        }])
    );
}

#[test]
fn logs_that_cannot_be_written() {
    let folder = folder(&[("p.il", PROGRAM.as_bytes())]);
    let fails = |log: &str| {
        let output = rungc(folder.path(), &["run", "p.il", "--modbus-tcp", "0", log]);
        assert_eq!(output.status.code(), Some(2));
        text(&output.stderr).to_string()
    };
    let message = fails("--trace-frames=p.il");
    assert!(
        message.contains("--trace-frames p.il: this file is an input of this run"),
        "{message}"
    );
    let message = fails("--trace-frames=p.il/frames.log");
    assert!(message.contains("p.il is not a folder"), "{message}");
}

/// The kinds and link types of the blocks of a capture.
fn blocks(capture: &[u8]) -> Vec<u32> {
    let word = |at: usize| u32::from_le_bytes(capture[at..at + 4].try_into().unwrap());
    let mut at = 0;
    let mut kinds = Vec::new();
    while at < capture.len() {
        let length = word(at + 4) as usize;
        assert_eq!(
            word(at + length - 4) as usize,
            length,
            "both lengths are the same"
        );
        kinds.push(word(at));
        at += length;
    }
    kinds
}

#[test]
fn a_capture_for_wireshark() {
    let folder = folder(&[
        ("p.il", PROGRAM.as_bytes()),
        ("rungc.toml", SETTINGS.as_bytes()),
    ]);
    let serving = Serving::start(folder.path(), 4, &["--trace-frames=frames.pcapng"]);
    let mut modbus = serving.connect(0);
    assert_eq!(ask(&mut modbus, &WRITE_D100, 12), WRITE_D100);
    assert_eq!(ask(&mut modbus, &READ_60000, 9)[7..], [0x83, 2]);
    let mut line = serving.connect(3);
    let read_d0 = [1, 3, 0, 0, 0, 1, 0x84, 0x0a];
    assert_eq!(ask(&mut line, &read_d0, 7)[..5], [1, 3, 2, 0, 0]);
    let port = serving.ports[0];
    serving.interrupt();
    let path = folder.path().join("frames.pcapng");
    let kinds = blocks(&fs::read(&path).unwrap());
    assert_eq!(
        kinds[..6],
        [0x0a0d_0d0a, 1, 6, 6, 6, 6],
        "section, TCP, its packets"
    );
    assert_eq!(kinds[6], 1, "the serial port");
    if Command::new("tshark").arg("--version").output().is_err() {
        eprintln!("the capture was not read by tshark: there is none (apt-get install tshark)");
        return;
    }
    let mut tshark = Command::new("tshark");
    let tcp_port = format!("mbtcp.tcp.port:{port}");
    tshark.args(["-o", &tcp_port, "-d", "rtacser.data,mbrtu", "-r"]);
    let read = tshark.arg(path).output().unwrap();
    let shown = text(&read.stdout);
    for messages in [
        "Query: Trans:     1; Unit:   1, Func:   6: Write Single Register",
        "Response: Trans:     2; Unit:   1, Func:   3: Read Holding Registers. Exception returned",
        "Query: Unit:   1, Func:   3: Read Holding Registers",
        "Response: Unit:   1, Func:   3: Read Holding Registers",
    ] {
        assert!(
            shown.contains(messages),
            "{messages} is not in\n{shown}{}",
            text(&read.stderr)
        );
    }
}

#[test]
fn a_server_takes_the_place_of_an_ethernet_card() {
    const CARD: &[u8] = b"LD M8002\nMOV HC1 D8270\nMOV K1 D8271\nMOV H2 D8276\nEND\n";
    let check = |settings: &str| {
        let folder = folder(&[("p.il", CARD), ("rungc.toml", settings.as_bytes())]);
        let output = rungc(folder.path(), &["check", "p.il"]);
        assert_eq!(output.status.code(), Some(0));
        text(&output.stderr).contains("W0700")
    };
    let project = "[project]\nmodel = 'h2u'\n";
    assert!(check(project));
    assert!(!check(&format!("{project}[serve]\nmodbus-tcp = 5020\n")));
}
