//! Serial ports of images: Modbus slaves answer mbpoll through the UARTs of emulated microcontrollers, and two
//! microcontrollers talk with each other.

use crate::common::{HANG, folder, soon, text};
use crate::tools;
use crate::tools::{cargo, leave_out, no_rust, tools};
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{self, Receiver};

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

/// The slave with more registers than it names.
const PROJECT: &str = "\
[project]
program = \"slave.il\"
model = \"h2u\"

[serve]
D = \"D0-D511\"
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
    /// An image of a program of H2U; `None` if there is no Rust for it, and the test is to be left out.
    fn image(&self, folder: &Path, program: &str) -> Option<PathBuf> {
        let image = format!("{program}-{}.elf", self.name);
        self.build(folder, &[program, "--model", "h2u"], &image)?;
        Some(folder.join(image))
    }

    /// Builds an image; the messages about it.
    fn build(&self, folder: &Path, what: &[&str], image: &str) -> Option<String> {
        let Some(cargo) = cargo(self.target) else {
            leave_out(&no_rust(self.target));
            return None;
        };
        let board = Path::new(env!("RUNGC_ROOT")).join("examples");
        let mut build = tools::with_cargo(&cargo);
        build
            .arg("build")
            .args(what)
            .args(["--emit", "elf"])
            .args(["--backend", self.backend, "--board"])
            .arg(board.join(self.board))
            .args(["-o", image])
            .current_dir(folder);
        let output = build.output().unwrap();
        assert!(output.status.success(), "{}", text(&output.stderr));
        let messages = [output.stderr, output.stdout];
        Some(
            messages
                .map(|messages| text(&messages).to_string())
                .concat(),
        )
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
    /// The rest of the first line that contains `text`.
    fn after(&self, text: &str) -> String {
        let mut printed = Vec::new();
        while let Ok(line) = self.lines.recv_timeout(HANG) {
            if let Some(at) = line.find(text) {
                return line[at + text.len()..].to_string();
            }
            printed.push(line);
        }
        panic!("`{text}` was not printed, but {printed:?}");
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Calls mbpoll until it prints `wanted`: on a loaded machine a request may arrive with a pause in it, which cuts the
/// frame.
fn poll(args: &[&str], wanted: &str) -> String {
    let line = [
        "-m", "rtu", "-b", "9600", "-P", "none", "-a", "1", "-o", "2", "-1", "-t", "4",
    ];
    let mut printed = String::new();
    soon(&format!("mbpoll prints {wanted}"), || {
        let mut command = Command::new("mbpoll");
        let once = command.args(line).args(args).output().unwrap();
        printed = text(&once.stdout) + &text(&once.stderr);
        printed.contains(wanted)
    });
    printed
}

/// Returns true if the tools that build an image and poll it are installed.
fn can_poll() -> bool {
    let there = tools(&["make", "arm-none-eabi-gcc", "qemu-system-arm"]);
    if there && Command::new("mbpoll").arg("-V").output().is_err() {
        leave_out("mbpoll");
        return false;
    }
    there
}

impl Running {
    /// Path of the line that QEMU has made.
    fn line(&self) -> String {
        let path = self.after("redirected to ");
        path.split(' ').next().unwrap_or_default().to_string()
    }
}

fn answers_mbpoll(machine: &Machine) {
    if !can_poll() {
        return;
    }
    let folder = folder(&[("slave.il", SLAVE.as_bytes())]);
    let Some(image) = machine.image(folder.path(), "slave.il") else {
        return;
    };
    let running = machine.start(&image, "pty");
    let path = running.line();
    // Two values are written, and three are read.
    poll(&["-r", "1", &path, "20", "22"], "Written 2 references");
    let shown = poll(&["-r", "1", "-c", "3", &path], "[3]: \t42");
    assert!(shown.contains("[1]: \t20"), "{shown}");
    // D3 is not in the program.
    poll(&["-r", "4", &path], "Illegal data address");
}

/// Registers that `[serve]` adds are there, others are rejected, and the image's report counts them.
fn serves_the_ranges_of_the_project(machine: &Machine) {
    if !can_poll() {
        return;
    }
    let files: [(&str, &[u8]); 2] = [
        ("slave.il", SLAVE.as_bytes()),
        ("rungc.toml", PROJECT.as_bytes()),
    ];
    let folder = folder(&files);
    // Only images from C are measured.
    let measures = machine.backend == "c";
    let what: &[&str] = if measures { &["--report"] } else { &[] };
    let Some(messages) = machine.build(folder.path(), what, "slave.elf") else {
        return;
    };
    assert!(
        messages.contains("D0-D511; requests for others are rejected"),
        "{messages}"
    );
    assert!(!measures || messages.contains("bytes for 52"), "{messages}");
    let running = machine.start(&folder.path().join("slave.elf"), "pty");
    let path = running.line();
    poll(&["-r", "512", &path, "1234"], "Written 1 references");
    poll(&["-r", "512", &path], "[512]: \t1234");
    poll(&["-r", "513", &path], "Illegal data address");
    poll(&["-r", "512", &path, "5", "6"], "Illegal data address");
    poll(&["-r", "512", &path], "[512]: \t1234");
}

#[test]
fn an_image_in_c_serves_the_ranges_of_the_project() {
    serves_the_ranges_of_the_project(&M3_IN_C);
}

#[test]
fn an_image_in_rust_serves_the_ranges_of_the_project() {
    serves_the_ranges_of_the_project(&M4_IN_RUST);
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
    let socket = folder.path().join("line");
    soon("the line is there", || socket.exists());
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
