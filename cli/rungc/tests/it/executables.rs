//! Serial ports of executables: `NAME --serial COM1=pty`, in C, and `--serial COM1=/dev/pts/1`, in Rust, with mbpoll as
//! their master; and their servers over TCP.

use crate::common::running::keeps_the_weekday_of_a_client;
use crate::common::{HANG, built_in_rust, folder, rungc, soon, text};
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{self, Receiver};
use std::time::{Duration, Instant};

/// COM1 is a Modbus slave, RTU, station 1, 9600 bit/s, 8 data bits, no parity, 1 stop bit.
const SLAVE: &str = "\
LD M8002
MOV H2 D8126
MOV H81 D8120
MOV K1 D8121
LD M8000
ADD D0 D1 D2
END
";

/// A program that ends with the test.
struct Running(Child);

impl Running {
    /// Starts a program; what it says about COM1 after these words, once it has opened the line.
    fn start(command: &mut Command, words: &str) -> (Running, String) {
        let mut child = command
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let errors = child.stderr.take().unwrap();
        let mut lines = BufReader::new(errors).lines().map_while(Result::ok);
        let messages = lines.find_map(|line| Some(line.split_once(words)?.1.to_owned()));
        std::thread::spawn(move || lines.count());
        (
            Running(child),
            messages.expect("the program opens its line"),
        )
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Returns true if the programs that the test needs are installed.
fn has(programs: &[&str]) -> bool {
    let missing = |program: &&&str| Command::new(program).arg("-V").output().is_err();
    match programs.iter().find(missing) {
        Some(program) => {
            eprintln!("skipped: there is no {program} (apt-get install {program})");
            false
        }
        None => true,
    }
}

/// Writes two registers and reads three. On a loaded machine a request may arrive with a pause in it, which cuts the
/// frame.
fn answers(path: &str) {
    let poll = |args: &[&str]| {
        let line = [
            "-m", "rtu", "-b", "9600", "-P", "none", "-a", "1", "-o", "3", "-r", "1", "-1", "-t",
            "4",
        ];
        let mut shown = String::new();
        soon("mbpoll has an answer", || {
            let output = Command::new("mbpoll").args(line).args(args).output();
            let output = output.unwrap();
            shown = text(&output.stdout);
            output.status.success()
        });
        shown
    };
    poll(&[path, "20", "22"]);
    let mut shown = String::new();
    soon("the next scan adds them", || {
        shown = poll(&["-c", "3", path]);
        shown.contains("[3]: \t42")
    });
    assert!(shown.contains("[1]: \t20"), "{shown}");
}

fn built(folder: &Path, args: &[&str]) {
    let args = [&["build", "slave.il", "--model", "h2u"], args].concat();
    let output = rungc(folder, &args);
    assert!(output.status.success(), "{}", text(&output.stderr));
}

#[test]
fn an_executable_in_c_answers_on_a_pseudo_terminal() {
    if !has(&["mbpoll"]) {
        return;
    }
    let folder = folder(&[("slave.il", SLAVE.as_bytes())]);
    built(folder.path(), &["--emit", "bin", "-o", "slave"]);
    let program = folder.path().join("slave");
    let (_running, path) = Running::start(
        Command::new(&program).args(["--serial", "COM1=pty"]),
        "COM1 at ",
    );
    answers(&path);
    for (args, messages) in [
        (
            &["--serial", "COM7=pty"][..],
            "the program has no port COM7",
        ),
        (&["--serial", "tty"], "a line is written COM1=/dev/ttyUSB0"),
        (&["--serial", "COM1=no-such-tty"], "No such file"),
        (&["--serial", "COM1=tcp:a:1"], "no serial lines over TCP"),
        (
            &["--serial", "COM1=tcp-listen:1"],
            "no serial lines over TCP",
        ),
        (&["--serial", "COM1=/dev/null"], "Inappropriate ioctl"),
        (&["--modem"], "usage: "),
    ] {
        let output = Command::new(&program).args(args).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{args:?}");
        assert!(text(&output.stderr).contains(messages), "{args:?}");
    }
}

/// The emitted package, built as it is.
fn rust_program(folder: &Path, option: &[&str]) -> PathBuf {
    let args = [&["build", "slave.il", "--model", "h2u"], option].concat();
    built_in_rust(folder, &args, "slave", "slave")
}

/// Two pseudo-terminals that are joined.
fn cable(ours: &Path, theirs: &Path) -> Running {
    let end = |path: &Path| format!("pty,raw,echo=0,link={}", path.display());
    let mut socat = Command::new("socat");
    socat.args(["-d", "-d"]).args([end(ours), end(theirs)]);
    Running::start(&mut socat, "starting data transfer loop").0
}

#[test]
fn an_executable_in_rust_answers_on_a_terminal() {
    if !has(&["mbpoll", "socat"]) {
        return;
    }
    let folder = folder(&[("slave.il", SLAVE.as_bytes())]);
    let program = rust_program(folder.path(), &[]);
    let [ours, theirs] = ["ours", "theirs"].map(|name| folder.path().join(name));
    let _cable = cable(&ours, &theirs);
    let line = format!("COM1={}", ours.display());
    let (_running, _) =
        Running::start(Command::new(&program).args(["--serial", &line]), "COM1 at ");
    answers(&theirs.display().to_string());
    for (line, message) in [
        ("COM7=x", "the program has no port COM7"),
        ("COM1=pty", "this program has no pseudo-terminals"),
        ("COM1=tcp:a:1", "no serial lines over TCP"),
        ("COM1=/dev/null", "Inappropriate ioctl"),
    ] {
        let output = Command::new(&program)
            .args(["--serial", line])
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(2), "{line}");
        assert!(text(&output.stderr).contains(message), "{line}");
    }
}

/// A program whose messages are read, and which takes commands.
struct Host {
    child: Child,
    lines: Receiver<String>,
}

impl Host {
    fn start(command: &mut Command) -> Host {
        let mut child = command
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let errors = BufReader::new(child.stderr.take().unwrap());
        let (sender, lines) = mpsc::channel();
        std::thread::spawn(move || {
            let mut lines = errors.lines().map_while(Result::ok);
            lines.try_for_each(|line| sender.send(line))
        });
        Host { child, lines }
    }

    /// Rest of a message after these words, once it comes.
    fn says(&self, words: &str) -> String {
        let end = Instant::now() + HANG;
        loop {
            let left = end.saturating_duration_since(Instant::now());
            let line = self.lines.recv_timeout(left);
            let line = line.unwrap_or_else(|_| panic!("the program never says {words:?}"));
            assert!(!line.contains("has stopped itself"), "{line}");
            if let Some((_, rest)) = line.split_once(words) {
                return rest.to_string();
            }
        }
    }
}

impl Drop for Host {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Sends a request, and returns an answer of this length.
fn ask(address: &str, request: &[u8], length: usize) -> Vec<u8> {
    let mut stream = TcpStream::connect(address).unwrap();
    stream.set_read_timeout(Some(HANG)).unwrap();
    stream.write_all(request).unwrap();
    let mut answer = vec![0; length];
    stream.read_exact(&mut answer).unwrap();
    answer
}

/// A program serves devices that it does not name, rejects others, and ends with a table.
fn serves(program: &Path) {
    let options = ["--modbus-tcp", "0", "--mc", "127.0.0.1:0", "--fx", "0"];
    let mut host = Host::start(Command::new(program).args(options));
    let modbus = host.says("Modbus TCP at ");
    let mc = host.says("MC protocol at ");
    let fx = host.says("programming port at ");
    let write = [0, 1, 0, 0, 0, 6, 1, 6, 0, 200, 0, 7];
    assert_eq!(ask(&modbus, &write, 12), write);
    let missing = [0, 2, 0, 0, 0, 6, 1, 3, 0xea, 0x60, 0, 1];
    assert_eq!(ask(&modbus, &missing, 9), [0, 2, 0, 0, 0, 3, 1, 0x83, 2]);
    // D200, by frame 1E.
    let read = [1, 0xff, 10, 0, 200, 0, 0, 0, 0x20, 0x44, 1, 0];
    assert_eq!(ask(&mc, &read, 4), [0x81, 0, 7, 0]);
    assert_eq!(ask(&fx, b"\x05", 1), [6]);
    // In ASCII: remote STOP and RUN are reported.
    assert_eq!(ask(&mc, b"14FF000A", 4), b"9400");
    host.says("127.0.0.1 switches to STOP (MC protocol)");
    assert_eq!(ask(&mc, b"13FF000A", 4), b"9300");
    host.says("127.0.0.1 switches to RUN (MC protocol)");
    // So are M8037 on, and M8035 and M8036; the program has not stopped itself. STOP in STOP switches nothing.
    assert_eq!(ask(&mc, b"04FF000A01004D2000001F6501", 4), b"8400");
    host.says("127.0.0.1 switches to STOP (MC protocol)");
    let run = b"04FF000A02004D2000001F63014D2000001F6401";
    assert_eq!(ask(&mc, run, 4), b"8400");
    host.says("127.0.0.1 switches to RUN (MC protocol)");
    assert_eq!(ask(&mc, b"14FF000A", 4), b"9400");
    host.says("127.0.0.1 switches to STOP (MC protocol)");
    assert_eq!(ask(&mc, b"14FF000A", 4), b"9400");
    assert_eq!(ask(&mc, b"13FF000A", 4), b"9300");
    host.says("127.0.0.1 switches to RUN (MC protocol)");
    // No request at all: the connection is closed, after the answer, and not reset.
    assert_eq!(answers_until_closed(&modbus, &[b'G'; 6000]), b"");
    assert_eq!(answers_until_closed(&mc, &[6; 6000]), b"\x86\x50");
    // Nor half of one, after a time of silence.
    assert_eq!(answers_until_closed(&mc, b"14FF00"), b"");
    host.child
        .stdin
        .take()
        .unwrap()
        .write_all(b" x0 = 1\n quit \n")
        .unwrap();
    let row = host.says(&format!("{modbus:<21}  "));
    let words: Vec<&str> = row.split_whitespace().collect();
    assert_eq!(
        words,
        ["127.0.0.1", "Modbus", "TCP", "3", "2", "2", "0"],
        "{row}"
    );
    let row = host.says(&format!("{mc:<21}  "));
    let words: Vec<&str> = row.split_whitespace().collect();
    assert_eq!(
        words,
        ["127.0.0.1", "MC", "protocol", "10", "9", "2", "3"],
        "{row}"
    );
    assert_eq!(host.child.wait().unwrap().code(), Some(0));
}

/// What comes back until the PLC closes the connection.
fn answers_until_closed(address: &str, request: &[u8]) -> Vec<u8> {
    let mut stream = TcpStream::connect(address).unwrap();
    stream.write_all(request).unwrap();
    stream.set_read_timeout(Some(HANG)).unwrap();
    let mut received = Vec::new();
    stream.read_to_end(&mut received).unwrap();
    received
}

/// A client sets the program's clock.
fn has_a_clock(program: &Path) {
    let host = Host::start(Command::new(program).args(["--mc", "0"]));
    keeps_the_weekday_of_a_client(&host.says("MC protocol at "));
}

/// The programming port answers on a separate line, and Ctrl-C ends the run with the table of connections.
fn answers_a_programmer_until_interrupted(program: &Path, line: &str, client: Option<&Path>) {
    // A caller in the background ignores SIGINT, and a program that it started would, too.
    let mut command = Command::new("env");
    command.arg("--default-signal=INT").arg(program);
    let mut host = Host::start(command.args(["--fx", line, "--modbus-tcp", "0"]));
    let path = host.says("COM0 at ");
    let client = client.map_or(path, |client| client.display().to_string());
    let modbus = host.says("Modbus TCP at ");
    let mut port = serial2::SerialPort::open(client, 9600).unwrap();
    port.set_read_timeout(Duration::from_secs(4)).unwrap();
    let mut answer = [0];
    // A request that comes while the port still sends is lost.
    let mut ask = |request: &[u8]| {
        soon("the programming port answers", || {
            let sent = port.write_all(request);
            sent.and_then(|()| port.read_exact(&mut answer)).is_ok()
        });
        assert_eq!(answer, [6]);
    };
    ask(b"\x05");
    // M8037 on and off.
    ask(b"\x027250F\x0317");
    host.says("COM0 switches to STOP");
    ask(b"\x028250F\x0318");
    host.says("COM0 switches to RUN");
    let pid = host.child.id().to_string();
    let kill = Command::new("kill").args(["-INT", &pid]).status().unwrap();
    assert!(kill.success());
    let row = host.says(&format!("{modbus:<21}  "));
    assert!(row.contains("Modbus TCP"), "{row}");
    assert_eq!(host.child.wait().unwrap().code(), Some(0));
}

/// A line that vanishes is opened again.
fn reconnects(program: &Path, folder: &Path) {
    let [ours, theirs] = ["far", "near"].map(|name| folder.join(name));
    let first = cable(&ours, &theirs);
    let line = format!("COM1={}", ours.display());
    let host = Host::start(Command::new(program).args(["--serial", &line]));
    host.says("COM1 at ");
    answers(&theirs.display().to_string());
    drop(first);
    host.says("is gone; waiting for it");
    let _second = cable(&ours, &theirs);
    host.says("is back");
    answers(&theirs.display().to_string());
}

/// Output of `--help`, after which the program ends.
fn help(program: &Path) -> String {
    let output = Command::new(program).arg("--help").output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    text(&output.stdout).to_string()
}

#[test]
fn an_executable_in_c_serves_over_tcp_and_reconnects() {
    let folder = folder(&[("slave.il", SLAVE.as_bytes())]);
    built(
        folder.path(),
        &["--emit", "bin", "--servers", "-o", "slave"],
    );
    let program = folder.path().join("slave");
    insta::assert_snapshot!(help(&program));
    serves(&program);
    has_a_clock(&program);
    let output = Command::new(&program)
        .args(["--mc", "127.0.0.1:70000"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("an address is written 127.0.0.1:5020"));
    answers_a_programmer_until_interrupted(&program, "pty", None);
    if has(&["mbpoll", "socat"]) {
        reconnects(&program, folder.path());
    }
}

#[test]
fn an_executable_in_rust_serves_over_tcp_and_reconnects() {
    let folder = folder(&[("slave.il", SLAVE.as_bytes())]);
    let program = rust_program(folder.path(), &["--servers"]);
    insta::assert_snapshot!(help(&program));
    serves(&program);
    has_a_clock(&program);
    if has(&["mbpoll", "socat"]) {
        reconnects(&program, folder.path());
        let [ours, theirs] = ["port", "programmer"].map(|name| folder.path().join(name));
        let _cable = cable(&ours, &theirs);
        let line = ours.display().to_string();
        answers_a_programmer_until_interrupted(&program, &line, Some(&theirs));
    }
}

#[test]
fn servers_need_a_main_program() {
    let folder = folder(&[("slave.il", SLAVE.as_bytes())]);
    let args = [
        "build",
        "slave.il",
        "--model",
        "h2u",
        "--emit",
        "lib",
        "--servers",
    ];
    let output = rungc(folder.path(), &args);
    assert_eq!(output.status.code(), Some(2));
    insta::assert_snapshot!(
        text(&output.stderr).trim_end(),
        @"rungc: --servers only applies to --emit bin, and to --emit c and --emit rust with --main"
    );
}

/// Y000 follows X000; Y010 shows that the folder is lost, D0 counts scans.
const CONNECTED: &str = "\
LD X000
OUT Y000
LD M100
OUT Y010
LD M8000
INC D0
END
";

const CONNECTIONS: &str = "\
[project]
model = 'fx3u'

[io.plant]
files = 'plant'
every = '5ms'
fault = 'M100'
X000 = 'read switch'
Y000 = 'write lamp'

[io.shown]
files = '.'
every = '5ms'
Y010 = 'write lost'
D0 = 'write scans'
";

/// Descriptions that are wrong.
const WRONG: [&str; 12] = [
    "",
    "[io.a]\n",
    "[io.a]\nfiles = '.'\n",
    "[io.a]\nfiles = '.'\nX000 = 'switch'\n",
    "[io.a]\nfiles = '.'\nY000 = 'read lamp'\n",
    "[io.a]\nfiles = '.'\nX000 = 'read a\n",
    "[io.a]\nfiles = '.'\nevery = '5 weeks'\nX000 = 'read a'\n",
    "[io.a]\nfiles = '.'\nbaud = 9600\nX000 = 'read a'\n",
    "[io.a]\nfiles = '.'\nX000 = 'read a'\nX0-X3 = 'read b'\n",
    "[io.a]\nfiles = '.'\nM99999 = 'read a'\n",
    "[io.a]\nmqtt = 'h'\ncertificate = 'c'\nX000 = 'read a'\n",
    "[io.a]\nmqtt = 'h'\nca = 'c'\nX000 = 'read a'\n",
];

/// Waits until a file holds a value.
fn shows(folder: &Path, name: &str, value: &str) {
    soon(&format!("{name} is {value}"), || {
        let shown = std::fs::read_to_string(folder.join(name));
        shown.is_ok_and(|shown| shown.trim() == value)
    });
}

/// Messages of a program about invalid descriptions.
fn refusals(folder: &Path, program: &Path) -> String {
    let mut messages = String::new();
    for wrong in WRONG {
        std::fs::write(folder.join("wrong.toml"), wrong).unwrap();
        let mut command = Command::new(program);
        command.args(["--io", "wrong.toml"]).current_dir(folder);
        let output = command.stdin(Stdio::null()).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{wrong}");
        messages.push_str(&text(&output.stderr));
    }
    // C programs say their name first.
    messages.replace("p: ", "").replace("--io wrong.toml: ", "")
}

/// A program is connected while its outputs have no room, rubbish is typed, its folder goes and comes back; it ends in
/// order.
fn connects(folder: &Path, program: &Path) {
    let plant = folder.join("plant");
    std::fs::create_dir_all(&plant).unwrap();
    std::fs::write(plant.join("switch"), "1").unwrap();
    let full = || {
        std::fs::File::options()
            .write(true)
            .open("/dev/full")
            .unwrap()
    };
    // Tests may run under nohup; a program that it started would stay.
    let mut command = Command::new("env");
    command.arg("--default-signal=HUP").arg(program);
    command.args(["--io", "rungc.toml", "--log", "log"]);
    command.stdin(Stdio::piped()).stdout(full()).stderr(full());
    let mut running = Running(command.current_dir(folder).spawn().unwrap());
    let mut typed = running.0.stdin.take().unwrap();
    let rubbish: Vec<u8> = (0..20_000u32).map(|n| ((n * n) >> 3) as u8).collect();
    let typing = std::thread::spawn(move || typed.write_all(&rubbish));
    for _ in 0..2 {
        shows(folder, "plant/lamp", "1");
        shows(folder, "lost", "0");
        std::fs::rename(&plant, folder.join("away")).unwrap();
        shows(folder, "lost", "1");
        let scans = || std::fs::read_to_string(folder.join("scans")).unwrap();
        let before = scans();
        soon("scans continue", || scans() != before);
        std::fs::rename(folder.join("away"), &plant).unwrap();
    }
    shows(folder, "lost", "0");
    typing.join().unwrap().unwrap();
    // The end of the terminal.
    let pid = running.0.id().to_string();
    let sent = Command::new("kill").args(["-HUP", &pid]).status().unwrap();
    assert!(sent.success());
    assert_eq!(running.0.wait().unwrap().code(), Some(0));
    shows(folder, "plant/lamp", "0");
    let log = std::fs::read_to_string(folder.join("log")).unwrap();
    let line = log
        .lines()
        .find(|line| line.ends_with("io plant: connected to plant"));
    let (time, _) = line.expect("it is in the log").split_once(' ').unwrap();
    assert_eq!((time.len(), time.ends_with('Z')), (20, true), "{time}");
    assert!(log.contains("not an input"), "{log}");
}

#[test]
fn executables_connect_terminals() {
    let folder = folder(&[
        ("p.il", CONNECTED.as_bytes()),
        ("rungc.toml", CONNECTIONS.as_bytes()),
    ]);
    let folder = folder.path();
    let build = |args: &[&str]| {
        let args = [&["build", "p.il", "--io"], args].concat();
        let output = rungc(folder, &args);
        assert!(output.status.success(), "{}", text(&output.stderr));
    };
    build(&["--emit", "bin", "-o", "p"]);
    let in_c = folder.join("p");
    connects(folder, &in_c);
    let in_rust = built_in_rust(folder, &["build", "p.il", "--io"], "rust", "p");
    std::fs::remove_file(folder.join("log")).unwrap();
    connects(folder, &in_rust);
    let messages = refusals(folder, &in_c);
    assert_eq!(messages, refusals(folder, &in_rust));
    insta::assert_snapshot!("wrong_descriptions", messages);
}
