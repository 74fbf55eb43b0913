//! Clients and servers that others have written talk to running programs, over TCP and over pseudo-terminals. `.ci/run`
//! installs them: `RUNGC_PYTHON` names a Python with the packages, `RUNGC_NODE_MODULES` a folder with those for Node. A
//! peer that is not there is skipped with a message, or missed if one of these variables, or `RUNGC_REQUIRE_PEERS` for
//! packages of the system, is set.

use crate::common::clients::{client, node, python, succeeds, there};
use crate::common::running::Run;
use crate::common::{folder, free_port, soon, text};
use crate::connected::Form;
use std::env;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use tempfile::TempDir;

/// A sum and an output, for clients of servers.
const SUM: &str = "LD M8000\nADD D0 D1 D2\nLD M0\nOUT Y000\nEND\n";

/// The same with two lines: COM1 is a Modbus slave, RTU, station 1, 8N1; COM2 is one in ASCII, station 3, 7E1.
const SLAVES: &str = "\
LD M8002
MOV H2 D8126
MOV H81 D8120
MOV K1 D8121
MOV H3 D8266
MOV H86 D8260
MOV K3 D8261
LD M8000
ADD D0 D1 D2
LD M0
OUT Y000
END
";

/// Program for `clients/fx_port.py`.
const PROGRAMMING_PORT: &str = "\
LD M8000
ADD D0 D1 D2
LD M0
OUT Y000
LD M1
OUT T0 K5
LD T0
OUT Y001
LD M2
OUT C0 K3
LD M2
OUT C200 K100000
LD M3
OUT S10
END
";

/// Answers frames of two forms on CAN with what they carry plus 1, and sends one every 100 ms.
const BUS: &str = "\
LD M8000
CANRX H0 H123 D100 K2
CANRX H2ABC HDEF1 D110 K8
ADD D100 K1 D200
DADD D110 K1 D210
LD M8012
CANTX H0 H321 D200 K2
CANTX H3FFF HFFFF D210 K4
END
";

fn program(text: &str) -> TempDir {
    folder(&[("p.il", text.as_bytes())])
}

/// Runs a client, where there is one, against a server of a running program: the option that opens it, and its name.
fn by_tcp(client: Option<Command>, list: &str, model: &str, [option, server]: [&str; 2]) {
    let Some(mut client) = client else { return };
    let folder = program(list);
    let run = Run::new(folder.path(), model, &[option], &[]);
    client.arg(run.port(server).to_string());
    succeeds(client);
}

/// The same on a serial or CAN line.
fn on_a_line(client: Option<Command>, list: &str, model: &str, line: &str) {
    let Some(mut client) = client else { return };
    let folder = program(list);
    let run = Run::new(folder.path(), model, &[], &[line]);
    client.arg(run.line(line));
    succeeds(client);
}

#[test]
fn pymodbus_reads_and_writes_over_tcp() {
    by_tcp(
        python("pymodbus", "modbus_tcp.py"),
        SUM,
        "h2u",
        ["--modbus-tcp", "Modbus TCP"],
    );
}

/// Program that runs while a station is killed.
const REMOTE: &str = "\
LD X000
OUT Y000
LD M100
OUT Y001
LD M8000
INC D0
MOV D100 D200
MOV K4X020 D10
MOV D11 K4Y020
END
";

/// A program that runs while a station of pymodbus is killed.
struct Remote {
    folder: TempDir,
    run: Command,
    code: i32,
}

impl Remote {
    /// `None` where something is missing.
    fn new(form: Form) -> Option<Remote> {
        python("pymodbus", "modbus_io.py")?;
        let folder = program(REMOTE);
        let run = form.command(folder.path(), "h2u", &["--modbus-tcp", "0"])?;
        let code = form.code();
        Some(Remote { folder, run, code })
    }

    /// Runs it with the station at these ends of a line, or else over TCP.
    fn with(&self, ends: &[PathBuf]) -> Command {
        let mut client = python("pymodbus", "modbus_io.py").unwrap();
        client.arg(self.folder.path()).arg(self.code.to_string());
        let ends = ends.iter().map(|end| end.display().to_string());
        client.arg(ends.collect::<Vec<_>>().join(","));
        client.arg(self.run.get_program()).args(self.run.get_args());
        client
    }

    fn over_tcp(&self) {
        succeeds(self.with(&[]));
    }

    fn on_a_line(&self) {
        let mut socat = Command::new("socat");
        socat.arg("-V");
        if !there("socat", "RUNGC_REQUIRE_PEERS", socat) {
            return;
        }
        let ends = ["station", "plc"].map(|end| self.folder.path().join(end));
        let links = ends
            .each_ref()
            .map(|end| format!("pty,rawer,link={}", end.display()));
        let mut line = Command::new("socat").args(links).spawn().unwrap();
        soon("the line is there", || ends.iter().all(|end| end.exists()));
        let output = self.with(&ends).output().unwrap();
        line.kill().unwrap();
        line.wait().unwrap();
        assert!(
            output.status.success(),
            "{}{}",
            text(&output.stdout),
            text(&output.stderr)
        );
    }
}

#[test]
fn remote_io_of_pymodbus_is_lost_and_comes_back() {
    Remote::new(Form::Serve).inspect(Remote::over_tcp);
}

#[test]
fn remote_io_of_pymodbus_on_a_line_is_lost_and_comes_back() {
    Remote::new(Form::Serve).inspect(Remote::on_a_line);
}

/// The same of executables, with the connections of the runtime.
#[test]
fn remote_io_of_an_executable_is_lost_and_comes_back() {
    Remote::new(Form::C).inspect(Remote::over_tcp);
}

#[test]
fn remote_io_of_an_executable_on_a_line_is_lost_and_comes_back() {
    Remote::new(Form::C).inspect(Remote::on_a_line);
}

#[test]
fn remote_io_of_an_executable_in_rust_is_lost_and_comes_back() {
    let remote = Remote::new(Form::Rust).inspect(Remote::over_tcp);
    remote.inspect(Remote::on_a_line);
}

/// QEMU does not pass the settings of a line on, so over TCP alone.
#[test]
fn remote_io_of_an_executable_for_arm_is_lost_and_comes_back() {
    Remote::new(Form::Arm).inspect(Remote::over_tcp);
}

#[test]
fn pymodbus_reads_and_writes_on_a_line() {
    on_a_line(python("pymodbus", "modbus_rtu.py"), SLAVES, "h2u", "COM1");
}

#[test]
fn minimalmodbus_reads_and_writes_rtu_and_ascii() {
    let Some(mut client) = python("minimalmodbus", "minimal.py") else {
        return;
    };
    let folder = program(SLAVES);
    let run = Run::new(folder.path(), "h2u", &[], &["COM1", "COM2"]);
    client.arg(run.line("COM1")).arg(run.line("COM2"));
    succeeds(client);
}

#[test]
fn libmodbus_reads_and_writes_over_tcp_and_on_a_line() {
    let folder = program(SLAVES);
    let binary = folder.path().join("client");
    let mut compile = Command::new("gcc");
    compile.args([
        "-std=gnu99",
        "-Wall",
        "-Werror",
        "-I/usr/include/modbus",
        "-o",
    ]);
    compile
        .arg(&binary)
        .arg(client("libmodbus.c"))
        .arg("-lmodbus");
    if !there("libmodbus-dev", "RUNGC_REQUIRE_PEERS", compile) {
        return;
    }
    let run = Run::new(folder.path(), "h2u", &["--modbus-tcp"], &["COM1"]);
    for (kind, place) in [
        ("rtu", run.line("COM1").to_owned()),
        ("tcp", run.port("Modbus TCP").to_string()),
    ] {
        let mut client = Command::new(&binary);
        client.args([kind, &place]);
        succeeds(client);
    }
}

#[test]
fn mbpoll_reads_and_writes_everything() {
    let mut version = Command::new("mbpoll");
    version.arg("-V");
    if !there("mbpoll", "RUNGC_REQUIRE_PEERS", version) {
        return;
    }
    let folder = program(SLAVES);
    let run = Run::new(folder.path(), "h2u", &["--modbus-tcp"], &["COM1"]);
    let port = run.port("Modbus TCP").to_string();
    let line = ["-m", "rtu", "-b", "9600", "-P", "none", run.line("COM1")];
    for place in [&line[..], &["-m", "tcp", "-p", &port, "127.0.0.1"]] {
        // Everything once, references as in frames, several tries on a loaded machine.
        let poll = |args: &[&str], values: &[&str]| {
            let mut client = Command::new("mbpoll");
            client.args(["-a", "1", "-0", "-1", "-o", "5"]);
            client.args(args).args(place).args(values);
            succeeds(client)
        };
        poll(&["-t", "4", "-r", "0"], &["20", "22"]);
        poll(&["-t", "4", "-r", "1"], &["23"]);
        let shown = poll(&["-t", "4", "-r", "0", "-c", "3"], &[]);
        assert!(shown.contains("[2]: \t43"), "{shown}");
        let shown = poll(&["-t", "3", "-r", "2"], &[]);
        assert!(shown.contains("[2]: \t43"), "{shown}");
        poll(&["-t", "0", "-r", "0"], &["1"]);
        poll(&["-t", "0", "-r", "10"], &["1", "0", "1"]);
        let shown = poll(&["-t", "0", "-r", "10", "-c", "3"], &[]);
        assert!(shown.contains("[10]: \t1\n[11]: \t0\n[12]: \t1"), "{shown}");
        let shown = poll(&["-t", "0", "-r", "64512"], &[]);
        assert!(shown.contains("[64512]: \t1"), "{shown}");
        let shown = poll(&["-t", "1", "-r", "63488", "-c", "8"], &[]);
        assert!(shown.contains("[63495]: \t0"), "{shown}");
        poll(&["-t", "0", "-r", "0"], &["0"]);
    }
}

#[test]
fn pymcprotocol_reads_and_writes() {
    by_tcp(
        python("pymcprotocol", "mc.py"),
        SUM,
        "h2u",
        ["--mc", "MC protocol"],
    );
}

#[test]
fn pymcprotocol_and_fx3u_mcprotocol_read_and_write_in_ascii() {
    by_tcp(
        python("fx3u_mcprotocol", "mc_ascii.py"),
        SUM,
        "fx3u",
        ["--mc", "MC protocol"],
    );
}

#[test]
fn mcprotocol_reads_and_writes_in_both_frames() {
    let folder = program(SUM);
    for frame in ["1E", "3E"] {
        let Some(mut client) = node("mcprotocol", "mc.js") else {
            return;
        };
        let run = Run::new(folder.path(), "h2u", &["--mc"], &[]);
        client.arg(run.port("MC protocol").to_string()).arg(frame);
        succeeds(client);
    }
}

#[test]
fn node_fxplc_reads_and_writes() {
    by_tcp(
        node("node-fxplc", "fxplc.js"),
        PROGRAMMING_PORT,
        "fx3u",
        ["--fx", "programming port"],
    );
}

#[test]
fn node_red_reads_and_writes_by_a_flow() {
    by_tcp(
        node("node-red-contrib-modbus/package.json", "nodered.js"),
        SUM,
        "h2u",
        ["--modbus-tcp", "Modbus TCP"],
    );
}

/// Rows of what a program asks, with `host` before each.
const ROWS: [&str; 6] = [
    "read = 'registers'\naddress = 500\ncount = 2\nbuffer = 'D205'",
    "write = 'registers'\naddress = 600\ncount = 2\nbuffer = 'D220'\ntrigger = 'M10'",
    "write = 'coils'\naddress = 10\nbuffer = 'D230'\ntrigger = 'M11'",
    "read = 'coils'\naddress = 20\ncount = 20\nbuffer = 'D240'\ntrigger = 'M12'",
    "write = 'coils'\naddress = 40\ncount = 10\nbuffer = 'D245'\ntrigger = 'M13'",
    "read = 'registers'\naddress = 2000\nbuffer = 'D250'\ntrigger = 'M14'",
];

/// A program that asks a server at this port.
fn that_asks(server: u16) -> TempDir {
    let mut settings = String::from("[project]\nprogram = 'p.il'\nmodel = 'h2u'\n");
    for row in ROWS {
        settings += &format!("\n[[modbus]]\nhost = '127.0.0.1:{server}'\n{row}\n");
    }
    let list = b"LD M8000\nOUT Y000\nEND\n";
    folder(&[("p.il", list), ("rungc.toml", settings.as_bytes())])
}

#[test]
fn a_program_asks_a_server_of_pymodbus() {
    let Some(mut server) = python("pymodbus", "modbus_server.py") else {
        return;
    };
    let own = free_port();
    let folder = that_asks(own);
    let run = Run::new(folder.path(), "h2u", &["--modbus-tcp"], &[]);
    server.arg(run.port("Modbus TCP").to_string());
    server.arg(own.to_string());
    succeeds(server);
}

#[test]
fn executables_ask_a_server_of_pymodbus() {
    let Some(mut server) = python("pymodbus", "modbus_server.py") else {
        return;
    };
    let [own, port] = [free_port(), free_port()];
    let folder = that_asks(own);
    let build = ["build", "p.il", "--emit", "bin", "--servers", "-o", "p"];
    let mut rungc = Command::new(env!("CARGO_BIN_EXE_rungc"));
    rungc.args(build).current_dir(folder.path());
    succeeds(rungc);
    let mut program = Command::new(folder.path().join("p"));
    let program = program.args(["--modbus-tcp", &port.to_string()]);
    let mut running = program
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    server.args([port.to_string(), own.to_string()]);
    let output = server.output().unwrap();
    running.kill().unwrap();
    running.wait().unwrap();
    let (shown, errors) = (text(&output.stdout), text(&output.stderr));
    assert!(output.status.success(), "{shown}{errors}");
}

#[test]
fn umodbus_reads_and_writes_over_tcp() {
    by_tcp(
        python("umodbus", "umodbus_tcp.py"),
        SUM,
        "h2u",
        ["--modbus-tcp", "Modbus TCP"],
    );
}

#[test]
fn python_can_exchanges_frames_over_slcan() {
    on_a_line(python("can", "can_bus.py"), BUS, "h2u", "CAN");
}

#[test]
fn a_client_written_from_public_documents_uses_the_programming_port() {
    let client = || python("tty", "fx_port.py");
    let tcp = ["--fx", "programming port"];
    by_tcp(client(), PROGRAMMING_PORT, "fx3u", tcp);
    on_a_line(client(), PROGRAMMING_PORT, "fx3u", "COM0");
}

/// A master asks a slave of pymodbus, whose answers are wrong in many ways. `addresses` are those of M0, D0 and, where
/// its codes are known, D8063.
fn asks_a_faulty_slave(model: &str, port: &str, addresses: &[&str], text: &str) {
    let Some(mut client) = python("pymodbus", "modbus_slave.py") else {
        return;
    };
    let folder = program(text);
    let run = Run::new(folder.path(), model, &["--modbus-tcp"], &[port]);
    client.arg(run.line(port));
    client.arg(run.port("Modbus TCP").to_string());
    client.args(addresses);
    succeeds(client);
}

#[test]
fn a_master_of_h2u_asks_a_faulty_slave() {
    let text = "\
LD M8002
MOV H20 D8126
MOV H81 D8120
MOV K30 D8129
LD M0
MODBUS H0203 K100 K4 D10
LD M1
MODBUS H0210 K200 K2 D20
END
";
    asks_a_faulty_slave("h2u", "COM1", &["0", "0", "8063"], text);
}

#[test]
fn a_master_of_l01s_asks_a_faulty_slave() {
    let text = "\
LD M8002
SET M8196
SET M8125
MOV H81 D8120
MOV K255 D8121
MOV K0 D8126
MOV K300 D8129
LD M0
ADPRW H2 H3 K100 K4 D10
LD M1
ADPRW H2 H10 K200 K2 D20
END
";
    asks_a_faulty_slave("l01s", "COM2", &["0", "0"], text);
}

#[test]
fn a_master_of_a_compatible_board_asks_a_faulty_slave() {
    let text = "\
LD M8002
MOV H8081 D8120
MOV K300 D8129
LD M0
IVRD H203 K100 D10 K4
LD M1
IVWR H210 K200 D20 K2
END
";
    asks_a_faulty_slave("fx3u-compatible", "COM1", &["0", "0"], text);
}

#[test]
fn a_master_of_hm_asks_a_faulty_slave() {
    let text = "\
LD M8002
UINIT H0400 H0008 K7000 K1
LD M0
MRDD K2 K100 K4 D10 K1
LD M1
MWRDS K2 K200 K2 D20 K1
LDI M50
OUT M50
END
";
    asks_a_faulty_slave("hm", "COM1", &["512", "368"], text);
}
