//! `rungc run --serial`: a serial port of the PLC as a pseudo-terminal, with a client of our own.

use crate::common::running::Run;
use crate::common::{HANG, folder, rungc, soon, text};
use serial2::SerialPort;
use std::io::{ErrorKind, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::process::{Child, Command};
use std::thread;
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

/// Sends a request until it is answered in time: on a loaded machine a request may arrive with a pause in it, which
/// cuts the frame.
fn ask(port: &SerialPort, request: &[u8], length: usize) -> Vec<u8> {
    let mut reply = vec![0; length];
    soon(&format!("an answer to {request:02x?}"), || {
        port.write_all(request).unwrap();
        let is_whole = port.read_exact(&mut reply).is_ok();
        if !is_whole {
            port.discard_buffers().unwrap();
        }
        is_whole
    });
    reply
}

#[test]
fn a_client_on_a_pseudo_terminal_reads_and_writes() {
    let folder = folder(&[("p.il", SLAVE.as_bytes())]);
    let run = Run::new(folder.path(), "h2u", &[], &["COM1"]);
    let mut port = SerialPort::open(run.line("COM1"), 9600).unwrap();
    port.set_read_timeout(Duration::from_secs(4)).unwrap();
    let write_d0 = [1, 6, 0, 0, 0, 5, 0x49, 0xc9];
    assert_eq!(ask(&port, &write_d0, 8), write_d0);
    let read_d2 = [1, 3, 0, 2, 0, 1, 0x25, 0xca];
    assert_eq!(ask(&port, &read_d2, 7)[..5], [1, 3, 2, 0, 5]);
}

/// Everything that a run can open at once, as `rungc run --help` says it: the programming port answers on a separate
/// line. An adapter is a pseudo-terminal of `socat`.
#[test]
fn a_run_opens_lines_and_servers_at_once() {
    if Command::new("socat").arg("-V").output().is_err() {
        eprintln!("skipped: there is no socat (apt-get install socat)");
        return;
    }
    let folder = folder(&[("p.il", SLAVE.as_bytes())]);
    let ends = ["ttyUSB0", "other"].map(|name| {
        let link = folder.path().join(name);
        format!("pty,rawer,link={}", link.display())
    });
    let mut socat = Command::new("socat").args(ends).spawn().unwrap();
    while !folder.path().join("other").exists() {
        thread::sleep(Duration::from_millis(10));
    }
    let args = "--serial COM1=ttyUSB0 --serial COM2=pty --modbus-tcp 127.0.0.1:0 --mc 127.0.0.1:0 --fx pty";
    let args: Vec<_> = args.split(' ').collect();
    let mut run = Run::start(folder.path(), "h2u", &args);
    run.opens(5);
    let mut programmer = SerialPort::open(run.line("COM0"), 9600).unwrap();
    programmer.set_read_timeout(Duration::from_secs(4)).unwrap();
    assert_eq!(ask(&programmer, b"\x05", 1), b"\x06");
    let mut adapter = SerialPort::open(folder.path().join("other"), 9600).unwrap();
    adapter.set_read_timeout(Duration::from_secs(4)).unwrap();
    let write_d0 = [1, 6, 0, 0, 0, 5, 0x49, 0xc9];
    assert_eq!(ask(&adapter, &write_d0, 8), write_d0);
    assert_ne!(run.port("Modbus TCP"), run.port("MC protocol"));
    assert!(!run.line("COM2").is_empty());
    drop(run);
    socat.kill().unwrap();
    socat.wait().unwrap();
}

/// Asks over a connection until it is answered in time.
fn ask_stream(stream: &mut TcpStream, request: &[u8], length: usize) -> Vec<u8> {
    stream
        .set_read_timeout(Some(Duration::from_secs(4)))
        .unwrap();
    let mut reply = vec![0; length];
    soon(&format!("an answer to {request:02x?}"), || {
        stream.write_all(request).unwrap();
        stream.read_exact(&mut reply).is_ok()
    });
    reply
}

/// The next client of a socket, which has to come soon.
fn accepted(listener: &TcpListener) -> TcpStream {
    listener.set_nonblocking(true).unwrap();
    let limit = Instant::now() + HANG;
    loop {
        match listener.accept() {
            Ok((stream, _)) => {
                stream.set_nonblocking(false).unwrap();
                return stream;
            }
            Err(error) if error.kind() == ErrorKind::WouldBlock => {
                assert!(Instant::now() < limit, "no client has connected");
                thread::sleep(Duration::from_millis(10));
            }
            Err(error) => panic!("{error}"),
        }
    }
}

/// A gateway that is restarted: the line is connected again, and each change is reported once.
#[test]
fn a_vanished_gateway_is_connected_again() {
    let folder = folder(&[("p.il", SLAVE.as_bytes())]);
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap();
    let line = format!("COM1=tcp:{address}");
    let run = Run::start(folder.path(), "h2u", &["--serial", &line]);
    let write_d0 = [1, 6, 0, 0, 0, 5, 0x49, 0xc9];
    let mut stream = accepted(&listener);
    assert_eq!(ask_stream(&mut stream, &write_d0, 8), write_d0);
    drop((stream, listener));
    // Long enough for several attempts in vain.
    thread::sleep(Duration::from_millis(1500));
    let listener = TcpListener::bind(address).unwrap();
    let mut stream = accepted(&listener);
    let read_d2 = [1, 3, 0, 2, 0, 1, 0x25, 0xca];
    assert_eq!(ask_stream(&mut stream, &read_d2, 7)[..5], [1, 3, 2, 0, 5]);
    let name = format!("COM1: tcp:{address}");
    run.says(&format!("{name} is back"));
    let messages = run.messages();
    let about = |what: &str| {
        let what = format!("rungc: {name} {what}");
        messages
            .iter()
            .filter(|line| line.starts_with(&what))
            .count()
    };
    assert_eq!((about("is gone"), about("is back")), (1, 1), "{messages:?}");
}

/// An adapter that is unplugged and comes back under the same name: socat's pseudo-terminals are its stand-in.
#[test]
fn a_vanished_adapter_is_opened_again() {
    if Command::new("socat").arg("-V").output().is_err() {
        eprintln!("skipped: there is no socat (apt-get install socat)");
        return;
    }
    let folder = folder(&[("p.il", SLAVE.as_bytes())]);
    let path = folder.path();
    let plug = || {
        let ends = ["adapter", "client"].map(|name| {
            let link = path.join(name);
            format!("pty,rawer,link={}", link.display())
        });
        let socat = Command::new("socat").args(ends).spawn().unwrap();
        while !path.join("client").exists() {
            thread::sleep(Duration::from_millis(10));
        }
        socat
    };
    let unplug = |socat: &mut Child| {
        socat.kill().unwrap();
        socat.wait().unwrap();
        for end in ["adapter", "client"] {
            let _ = std::fs::remove_file(path.join(end));
        }
    };
    let open = || {
        let mut port = SerialPort::open(path.join("client"), 9600).unwrap();
        port.set_read_timeout(Duration::from_secs(4)).unwrap();
        port
    };
    let mut adapter = plug();
    let run = Run::start(path, "h2u", &["--serial", "COM1=adapter"]);
    let write_d0 = [1, 6, 0, 0, 0, 5, 0x49, 0xc9];
    assert_eq!(ask(&open(), &write_d0, 8), write_d0);
    unplug(&mut adapter);
    run.says(" is gone");
    let mut adapter = plug();
    let read_d2 = [1, 3, 0, 2, 0, 1, 0x25, 0xca];
    assert_eq!(ask(&open(), &read_d2, 7)[..5], [1, 3, 2, 0, 5]);
    unplug(&mut adapter);
}

#[test]
fn lines_that_cannot_be_opened() {
    let folder = folder(&[("p.il", SLAVE.as_bytes())]);
    let fails = |line: &str| {
        let output = rungc(
            folder.path(),
            &["run", "p.il", "--model", "h2u", "--serial", line],
        );
        assert_ne!(output.status.code(), Some(0));
        text(&output.stderr).to_string()
    };
    let message = fails("COM1");
    assert!(
        message.contains("a line is written `COM1=/dev/ttyUSB0`"),
        "{message}"
    );
    let message = fails("COM7=pty");
    assert!(
        message.contains("has no port COM7; its ports are COM0, COM1"),
        "{message}"
    );
    let output = rungc(
        folder.path(),
        &[
            "run", "p.il", "--model", "h2u", "--serial", "COM0=pty", "--fx", "pty",
        ],
    );
    assert_eq!(
        text(&output.stderr).trim_end(),
        "rungc: COM0 is connected to two lines"
    );
    let message = fails("COM1=no-such-tty");
    assert!(
        message.contains("--serial: cannot open no-such-tty"),
        "{message}"
    );
}

#[test]
fn a_client_on_a_pseudo_terminal_is_a_can_bus() {
    const BUS: &str = "LD M8000\nCANRX H0 H200 D0 K2\nLD M8012\nCANTX H0 H201 D0 K2\nEND\n";
    let folder = folder(&[("p.il", BUS.as_bytes())]);
    let run = Run::new(folder.path(), "h2u", &[], &["CAN"]);
    let mut port = SerialPort::open(run.line("CAN"), 9600).unwrap();
    port.set_read_timeout(HANG).unwrap();
    // Output of the PLC before it received waits in the terminal.
    for _ in 0..1000 {
        // A command of a client to an adapter is not a frame.
        port.write_all(b"S6\rO\rt20021234\r").unwrap();
        let mut frame = [0; 10];
        port.read_exact(&mut frame).unwrap();
        match &frame {
            b"t20121234\r" => return,
            other => assert_eq!(text(other), "t20120000\r"),
        }
    }
    panic!("the frame has not come");
}

#[test]
fn an_adapter_is_opened_at_its_rate() {
    let gateway = TcpListener::bind("127.0.0.1:0").unwrap();
    let bus = format!("slcan:tcp:{},250", gateway.local_addr().unwrap());
    let folder = folder(&[("p.il", b"LD M8012\nCANTX H0 H200 D0 K1\nEND\n")]);
    let _run = Run::start(folder.path(), "h2u", &["--can", &bus]);
    let mut adapter = accepted(&gateway);
    adapter.set_read_timeout(Some(HANG)).unwrap();
    let mut first = [0; 18];
    adapter.read_exact(&mut first).unwrap();
    assert_eq!(text(&first), "\r\r\rC\rS5\rO\rt200100\r");
}

#[test]
fn buses_that_cannot_be_opened() {
    let folder = folder(&[("p.il", b"LD M8012\nCANTX H0 H200 D0 K1\nEND\n")]);
    let fails = |model: &str, bus: &str| {
        let args = ["run", "p.il", "--model", model, "--can", bus];
        let output = rungc(folder.path(), &args);
        assert_eq!(output.status.code(), Some(2));
        text(&output.stderr).to_string()
    };
    let message = fails("h2u", "nocan9");
    assert!(message.contains("--can: cannot open nocan9"), "{message}");
    let message = fails("h2u", "slcan:no-such-tty");
    assert!(
        message.contains("--can: cannot open no-such-tty"),
        "{message}"
    );
    let message = fails("h2u", "slcan:/dev/ttyACM0,300");
    assert!(message.contains("a rate is one of 10, 20, 50"), "{message}");
    let message = fails("h2u", "/dev/ttyACM0");
    assert!(message.contains("`slcan:/dev/ttyACM0`"), "{message}");
}

#[test]
fn only_some_models_have_a_can_card() {
    let folder = folder(&[("p.il", b"LD M8000\nOUT Y000\nEND\n")]);
    let args = ["run", "p.il", "--model", "fx3u", "--can", "can0"];
    let output = rungc(folder.path(), &args);
    let message = text(&output.stderr);
    assert!(
        message.contains("has no port CAN; its ports are"),
        "{message}"
    );
}

/// A gateway has one client at a time, and who switches the PLC over it is reported.
#[test]
fn one_client_at_a_time_stops_and_starts_the_plc() {
    let folder = folder(&[("p.il", SLAVE.as_bytes())]);
    let mut run = Run::start(folder.path(), "h2u", &["--fx", "tcp-listen:0"]);
    run.opens(1);
    let mut client = TcpStream::connect(("127.0.0.1", run.port("COM0"))).unwrap();
    assert_eq!(ask_stream(&mut client, b"\x05", 1), b"\x06");
    let mut newcomer = TcpStream::connect(("127.0.0.1", run.port("COM0"))).unwrap();
    run.says("rejects 127.0.0.1: another client is connected");
    newcomer.set_read_timeout(Some(HANG)).unwrap();
    assert!(!matches!(newcomer.read(&mut [0]), Ok(1..)));
    assert_eq!(ask_stream(&mut client, b"\x027250F\x0317", 1), b"\x06");
    run.says("COM0 switches to STOP");
    assert_eq!(ask_stream(&mut client, b"\x028250F\x0318", 1), b"\x06");
    run.says("COM0 switches to RUN");
    drop(client);
    run.says("is gone");
    let mut client = TcpStream::connect(("127.0.0.1", run.port("COM0"))).unwrap();
    assert_eq!(ask_stream(&mut client, b"\x05", 1), b"\x06");
}

#[test]
fn a_message_names_the_option_of_its_line() {
    let folder = folder(&[("p.il", SLAVE.as_bytes())]);
    for option in [
        &["--fx", "/dev/no-such-tty"],
        &["--serial", "COM1=/dev/no-such-tty"],
    ] {
        let output = rungc(
            folder.path(),
            &[&["run", "p.il", "--model", "h2u"], &option[..]].concat(),
        );
        let message = text(&output.stderr);
        let expected = format!("rungc: {}: cannot open /dev/no-such-tty", option[0]);
        assert!(message.contains(&expected), "{message}");
    }
}
