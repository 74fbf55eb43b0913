//! Instructions of a Cortex-M4 in the longest call that brings a program's serial ports up to date, as stated on the
//! book's page on boards. Without the tools the test reports what is missing and that it did not run; with
//! `RUNGC_REQUIRE_EMBEDDED` set, as in CI, that is a failure.

use crate::common::{folder, text};
use crate::tools;
use crate::tools::{cargo, leave_out, no_rust, tools};
use rungc_rt::comm::modbus::crc16;
use std::path::{Path, PathBuf};
use std::process::Command;

const TARGET: &str = "thumbv7em-none-eabihf";
const PAGE: &str = include_str!(concat!(env!("RUNGC_ROOT"), "/docs/src/boards.md"));
const MAIN: &str = include_str!("port_cost/main.c");

/// Devices that partners ask for beside those that programs name.
const PROJECT: &str = "\
[project]
program = \"station.il\"
model = \"h2u\"

[serve]
D = \"D0-D511\"
M = \"M0-M2047\"
";

/// One row of the book's table.
struct Row {
    /// Its beginning there.
    name: &'static str,
    program: &'static str,
    /// The frame that the port receives.
    frame: Vec<u8>,
    /// Characters that it sends then.
    sent: usize,
}

fn rtu(body: &[u8]) -> Vec<u8> {
    [body, &crc16(body).to_le_bytes()].concat()
}

/// A write of `count` bytes of data.
fn write(function: u8, quantity: u16, count: u8) -> Vec<u8> {
    let [high, low] = quantity.to_be_bytes();
    let mut body = vec![1, function, 0, 0, high, low, count];
    body.resize(7 + usize::from(count), 0x5a);
    rtu(&body)
}

/// An answer with 125 registers.
fn registers() -> Vec<u8> {
    let mut body = vec![1, 3, 250];
    body.resize(253, 0x5a);
    rtu(&body)
}

const RTU_SLAVE: &str = "LD M8002\nMOV H2 D8126\nMOV H81 D8120\nMOV K1 D8121\nEND\n";
const ASCII_SLAVE: &str = "LD M8002\nMOV H3 D8126\nMOV H81 D8120\nMOV K1 D8121\nEND\n";
const RTU_MASTER: &str = "LD M8002\nMOV H20 D8126\nMOV H81 D8120\nMOV K1000 D8129\nLD M8000\nMODBUS H0103 H0 K125 D200\nEND\n";
const LINK: &str = "LD M8002\nMOV H6 D8126\nMOV H81 D8120\nMOV K0 D8121\nEND\n";
const RS: &str = "LD M8002\nMOV H0 D8126\nMOV H81 D8120\nLD M8000\nRS D0 K1 D100 K250\nEND\n";
const NN_SLAVE: &str = "LD M8002\nMOV H4 D8126\nMOV K1 D8176\nLD M8000\nOUT M1064\nEND\n";
const PROGRAMMING_PORT: &str = "LD M8002\nMOV H1 D8126\nEND\n";

fn rows() -> Vec<Row> {
    let row = |name, program, frame: Vec<u8>, sent| Row {
        name,
        program,
        frame,
        sent,
    };
    vec![
        row(
            "Modbus RTU slave, 125 registers read",
            RTU_SLAVE,
            rtu(&[1, 3, 0, 0, 0, 125]),
            255,
        ),
        row(
            "Modbus RTU slave, 120 registers written",
            RTU_SLAVE,
            write(16, 120, 240),
            8,
        ),
        row(
            "Modbus RTU slave, 2000 coils read",
            RTU_SLAVE,
            rtu(&[1, 1, 0, 0, 7, 208]),
            255,
        ),
        row(
            "Modbus RTU slave, 1968 coils written",
            RTU_SLAVE,
            write(15, 1968, 246),
            8,
        ),
        row(
            "Modbus ASCII slave, 125 registers read",
            ASCII_SLAVE,
            b":01030000007D7F\r\n".to_vec(),
            511,
        ),
        row(
            "Modbus RTU master, 125 registers read",
            RTU_MASTER,
            registers(),
            0,
        ),
        row(
            "computer link, 64 registers read",
            LINK,
            b"\x0500FFWR0D000040".to_vec(),
            262,
        ),
        row("RS, 250 characters received", RS, vec![0x5a; 250], 0),
        row(
            "N:N link, a block received and one sent",
            NN_SLAVE,
            round(),
            56,
        ),
        row(
            "programming port, 64 bytes read",
            PROGRAMMING_PORT,
            b"\x020100040\x0358".to_vec(),
            132,
        ),
    ]
}

/// A text between STX and its sum, as stations of a link send it.
fn linked(text: &str) -> Vec<u8> {
    let mut frame = format!("\x02{text}\x03").into_bytes();
    let sum = frame[1..]
        .iter()
        .fold(0u8, |sum, &byte| sum.wrapping_add(byte));
    frame.extend(format!("{sum:02X}").bytes());
    frame
}

/// A round of an N:N link in the mode with the largest blocks: the block of the master and its request to station 1.
fn round() -> Vec<u8> {
    let block = "5A5A".repeat(4 + 8);
    [linked(&format!("D012{block}")), linked("P1120000")].concat()
}

/// The numbers that the page states in a row of a table.
fn stated(name: &str) -> Vec<u32> {
    let mut rows = PAGE.lines().map(|line| line.split('|').map(str::trim));
    let row = rows.find(|row| row.clone().nth(1) == Some(name));
    let row = row.unwrap_or_else(|| panic!("the page has no row `{name}`"));
    row.skip(2)
        .filter_map(|number| number.replace(',', "").parse().ok())
        .collect()
}

/// The image that counts.
fn image(folder: &Path, row: &Row, cargo: &Command) -> PathBuf {
    std::fs::write(folder.join("station.il"), row.program).unwrap();
    let mut build = tools::with_cargo(cargo);
    build
        .args([
            "build", "--emit", "lib", "--target", TARGET, "--force", "-o", "lib",
        ])
        .current_dir(folder);
    let output = build.output().unwrap();
    assert!(output.status.success(), "{}", text(&output.stderr));
    let bytes: Vec<String> = row.frame.iter().map(u8::to_string).collect();
    let characters = format!(
        "#define PORT 1u\nstatic const uint8_t characters[] = {{{}}};\n",
        bytes.join(", ")
    );
    std::fs::write(folder.join("characters.h"), characters).unwrap();
    std::fs::write(folder.join("main.c"), MAIN).unwrap();
    let board = Path::new(env!("RUNGC_ROOT")).join("examples/firmware/stm32f405/c");
    let mut link = Command::new("arm-none-eabi-gcc");
    link.args("-mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16 -Os -std=c11 -Wall -Wextra -Werror".split(' '))
        .args("-ffunction-sections -fdata-sections --specs=nano.specs -nostartfiles".split(' '))
        .args(["-Wl,--gc-sections,-z,noexecstack", "-Ilib", "-I.", "-I"])
        .arg(&board)
        .arg("-T")
        .arg(board.join("stm32f405.ld"))
        .args(["-o", "image.elf", "main.c"])
        .args(["startup.c", "board.c"].map(|source| board.join(source)))
        .args(["lib/libstation.a", "lib/librungc_rt.a"])
        .current_dir(folder);
    let output = link.output().unwrap();
    assert!(output.status.success(), "{}", text(&output.stderr));
    folder.join("image.elf")
}

/// Ticks of the longest call, characters sent before it, and since.
fn run(image: &Path) -> [u32; 3] {
    let options = "-M netduinoplus2 -nographic -icount shift=0,sleep=off -semihosting-config enable=on,target=native";
    let output = Command::new("qemu-system-arm")
        .args(options.split(' '))
        .arg("-kernel")
        .arg(image)
        .output()
        .unwrap();
    let printed = [output.stdout, output.stderr].concat();
    let printed = String::from_utf8_lossy(&printed).into_owned();
    let numbers: Vec<u32> = printed
        .split_whitespace()
        .filter_map(|n| n.parse().ok())
        .collect();
    numbers.try_into().unwrap_or_else(|_| panic!("{printed}"))
}

/// The same program, whose first registers set nothing up.
const WITHOUT_PORT: &str =
    "LD M8002\nMOV H2 D126\nMOV H81 D120\nMOV K1 D121\nLD M8000\nADD D0 D1 D2\nEND\n";
const WITH_PORT: &str =
    "LD M8002\nMOV H2 D8126\nMOV H81 D8120\nMOV K1 D8121\nLD M8000\nADD D0 D1 D2\nEND\n";

/// Bytes of flash and RAM of the image of a program.
fn size(folder: &Path, program: &str, backend: &str, cargo: &Command) -> [u32; 2] {
    std::fs::write(folder.join("station.il"), program).unwrap();
    let board = Path::new(env!("RUNGC_ROOT")).join("examples/firmware/stm32f405/board.toml");
    let mut build = tools::with_cargo(cargo);
    build
        .args([
            "build",
            "station.il",
            "--model",
            "h2u",
            "--emit",
            "elf",
            "--force",
            "-o",
            "station.elf",
        ])
        .args(["--backend", backend, "--board"])
        .arg(board)
        .current_dir(folder);
    let output = build.output().unwrap();
    assert!(output.status.success(), "{}", text(&output.stderr));
    let size = Command::new("arm-none-eabi-size")
        .arg(folder.join("station.elf"))
        .output()
        .unwrap();
    let numbers: Vec<u32> = text(&size.stdout)
        .split_whitespace()
        .filter_map(|n| n.parse().ok())
        .collect();
    let [code, data, bss] = numbers[..3] else {
        panic!("{}", text(&size.stdout));
    };
    [code + data, data + bss]
}

#[test]
fn a_modbus_slave_adds_no_more_than_the_book_says() {
    if !tools(&["make", "arm-none-eabi-gcc"]) {
        return;
    }
    let Some(cargo) = cargo(TARGET) else {
        return leave_out(&no_rust(TARGET));
    };
    let folder = folder(&[]);
    for (backend, name) in [("c", "image from C"), ("rust", "image from Rust")] {
        let [plain, slave] =
            [WITHOUT_PORT, WITH_PORT].map(|program| size(folder.path(), program, backend, &cargo));
        let stated = stated(name);
        for (what, at) in [("flash", 0), ("RAM", 1)] {
            let added = slave[at] - plain[at];
            eprintln!("{name}: {added} bytes of {what}");
            assert!(
                added <= stated[at],
                "{name}: {added} bytes of {what}, stated are {}",
                stated[at]
            );
        }
    }
}

#[test]
fn the_longest_call_takes_as_long_as_the_book_says() {
    if !tools(&["arm-none-eabi-gcc", "qemu-system-arm"]) {
        return;
    }
    let Some(cargo) = cargo(TARGET) else {
        return leave_out(&no_rust(TARGET));
    };
    let folder = folder(&[("rungc.toml", PROJECT.as_bytes())]);
    let mut wrong = Vec::new();
    for row in rows() {
        let [ticks, _, sent] = run(&image(folder.path(), &row, &cargo));
        assert_eq!(sent as usize, row.sent, "{}", row.name);
        // A tick of 168 MHz is 5.95 instructions of a nanosecond.
        let instructions = (u64::from(ticks) * 1000 / 168) as u32;
        let stated = stated(row.name)[0];
        if instructions > stated || instructions < stated / 10 * 8 {
            wrong.push(format!("{}: {instructions}, stated are {stated}", row.name));
        }
    }
    assert!(wrong.is_empty(), "instructions: {wrong:#?}");
}
