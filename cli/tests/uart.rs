//! Serial ports of images: Modbus slaves answer mbpoll through the UARTs of emulated microcontrollers, and two
//! microcontrollers talk with each other.
#![cfg(unix)]

mod common;
mod tools;

use common::{folder, text};
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{self, Receiver};
use std::time::{Duration, Instant};
use tools::{cargo, leave_out, no_rust, tools};

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

/// COM1 asks a slave for the sum of the two values that it writes before.
const MASTER: &str = "\
LD M8002
MOV H20 D8126
MOV H81 D8120
MOV K100 D8129
MOV K20 D10
MOV K22 D11
LD M8000
MODBUS H0110 H0 K2 D10
MODBUS H0103 H2 K1 D20
LD= D20 K42
OUT Y000
END
";

const PARALLEL_MASTER: &str = "\
LD M8000
OUT M8070
OUT M800
MOV K5 D490
LD M900
AND= D500 K12
OUT Y000
END
";

const PARALLEL_SLAVE: &str = "\
LD M8000
OUT M8071
ADD D490 K7 D500
LD M800
OUT M900
END
";

const NN_MASTER: &str = "\
LD M8002
MOV H40 D8126
MOV K1 D8177
MOV K1 D8178
MOV K3 D8179
MOV K50 D8180
LD M8000
OUT M1000
MOV K5 D0
LD M1064
AND= D10 K12
OUT Y000
END
";

const NN_SLAVE: &str = "\
LD M8002
MOV H4 D8126
MOV K1 D8176
LD M1000
OUT M1064
LD M8000
ADD D0 K7 D10
END
";

/// A microcontroller that QEMU emulates, with its board's description.
struct Machine {
    name: &'static str,
    board: &'static str,
    target: &'static str,
    backend: &'static str,
    /// Serial ports of the machine before the one that is COM1.
    others: &'static [&'static str],
}

/// C on a Cortex-M3, whose COM1 is a CMSDK UART.
const M3_IN_C: Machine = Machine {
    name: "mps2-an385",
    board: "boards/mps2-an385.toml",
    target: "thumbv7m-none-eabi",
    backend: "c",
    others: &[],
};

/// Rust on a Cortex-M4, whose COM1 is the second USART of an STM32F4.
const M4_IN_RUST: Machine = Machine {
    name: "netduinoplus2",
    board: "firmware/stm32f405/board.toml",
    target: "thumbv7em-none-eabihf",
    backend: "rust",
    others: &["-serial", "null"],
};

impl Machine {
    /// An image of a program; `None` if there is no Rust for it, and the test is to be left out.
    fn image(&self, folder: &Path, program: &str) -> Option<PathBuf> {
        let Some(cargo) = cargo(self.target) else {
            leave_out(&no_rust(self.target));
            return None;
        };
        let board = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples");
        let image = folder.join(format!("{program}-{}.elf", self.name));
        let mut build = tools::with_cargo(&cargo);
        build
            .args(["build", program, "--model", "h2u", "--emit", "elf"])
            .args(["--backend", self.backend, "--board"])
            .arg(board.join(self.board))
            .arg("-o")
            .arg(&image)
            .current_dir(folder);
        let output = build.output().unwrap();
        assert!(output.status.success(), "{}", text(&output.stderr));
        Some(image)
    }

    /// Starts an image, with COM1 at a character device of QEMU's.
    fn start(&self, image: &Path, line: &str) -> Running {
        let mut child = Command::new("qemu-system-arm")
            .args(["-M", self.name, "-display", "none", "-monitor", "none"])
            .args(["-semihosting-config", "enable=on,target=native"])
            .args(self.others)
            .args(["-serial", line, "-kernel"])
            .arg(image)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let (sender, lines) = mpsc::channel();
        let outputs: [Box<dyn Read + Send>; 2] = [
            Box::new(child.stdout.take().unwrap()),
            Box::new(child.stderr.take().unwrap()),
        ];
        for output in outputs {
            let sender = sender.clone();
            std::thread::spawn(move || {
                for line in BufReader::new(output).lines().map_while(Result::ok) {
                    let _ = sender.send(line);
                }
            });
        }
        Running { child, lines }
    }
}

/// A machine that stops with the test.
struct Running {
    child: Child,
    lines: Receiver<String>,
}

impl Running {
    /// The rest of the first line that contains `text`, within a minute.
    fn after(&self, text: &str) -> String {
        let end = Instant::now() + Duration::from_secs(60);
        let mut printed = Vec::new();
        while let Some(left) = end.checked_duration_since(Instant::now()) {
            let Ok(line) = self.lines.recv_timeout(left) else {
                break;
            };
            if let Some(at) = line.find(text) {
                return line[at + text.len()..].to_string();
            }
            printed.push(line);
        }
        panic!("`{text}` was not printed within a minute, but {printed:?}");
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Calls mbpoll until it succeeds: on a loaded machine a request may arrive with a pause in it, which cuts the frame.
fn poll(args: &[&str]) -> String {
    let line = [
        "-m", "rtu", "-b", "9600", "-P", "none", "-a", "1", "-o", "2", "-r", "1", "-1", "-t", "4",
    ];
    let mut output = None;
    for _ in 0..10 {
        let mut command = Command::new("mbpoll");
        let once = command.args(line).args(args).output().unwrap();
        if once.status.success() {
            return text(&once.stdout).to_string();
        }
        output = Some(once);
    }
    panic!(
        "{}",
        output.map_or(String::new(), |o| text(&o.stderr).to_string())
    );
}

fn answers_mbpoll(machine: &Machine) {
    if !tools(&["make", "arm-none-eabi-gcc", "qemu-system-arm"]) {
        return;
    }
    if Command::new("mbpoll").arg("-V").output().is_err() {
        return leave_out("mbpoll");
    }
    let folder = folder(&[("slave.il", SLAVE.as_bytes())]);
    let Some(image) = machine.image(folder.path(), "slave.il") else {
        return;
    };
    let running = machine.start(&image, "pty");
    let path = running.after("redirected to ");
    let path = path.split(' ').next().unwrap();
    // Two values are written, and three are read.
    poll(&[path, "20", "22"]);
    let mut shown = String::new();
    let end = Instant::now() + Duration::from_secs(30);
    while !shown.contains("[3]: \t42") && Instant::now() < end {
        shown = poll(&["-c", "3", path]);
    }
    assert!(shown.contains("[1]: \t20"), "{shown}");
    assert!(shown.contains("[3]: \t42"), "{shown}");
}

#[test]
fn an_image_in_c_answers_mbpoll() {
    answers_mbpoll(&M3_IN_C);
}

#[test]
fn an_image_in_rust_answers_mbpoll() {
    answers_mbpoll(&M4_IN_RUST);
}

/// Two microcontrollers on one line: the master, in C, switches Y000 on when it knows what the slave, in Rust, has made
/// of its values.
fn they_talk(master: &str, slave: &str) {
    if !tools(&["make", "arm-none-eabi-gcc", "qemu-system-arm"]) {
        return;
    }
    let folder = folder(&[
        ("master.il", master.as_bytes()),
        ("slave.il", slave.as_bytes()),
    ]);
    let Some(slave) = M4_IN_RUST.image(folder.path(), "slave.il") else {
        return;
    };
    let Some(master) = M3_IN_C.image(folder.path(), "master.il") else {
        return;
    };
    let line = format!("unix:{}", folder.path().join("line").display());
    let _slave = M4_IN_RUST.start(&slave, &format!("{line},server=on,wait=off"));
    // QEMU makes the socket before it runs the image.
    let end = Instant::now() + Duration::from_secs(60);
    while !folder.path().join("line").exists() && Instant::now() < end {
        std::thread::sleep(Duration::from_millis(20));
    }
    let master = M3_IN_C.start(&master, &line);
    assert!(master.after("Y000").starts_with(" on"));
}

#[test]
fn a_modbus_master_and_a_slave_talk() {
    they_talk(MASTER, SLAVE);
}

#[test]
fn a_parallel_link_keeps_devices_equal() {
    they_talk(PARALLEL_MASTER, PARALLEL_SLAVE);
}

#[test]
fn an_nn_link_keeps_devices_equal() {
    they_talk(NN_MASTER, NN_SLAVE);
}
