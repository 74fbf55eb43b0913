//! Descriptions of boards: what they may say, and what is wrong with others.

use rungc_firmware::board::{Board, OutputPin, Uart, parse};
use rungc_syntax::Source;
use std::path::Path;

const DESK: &str = "\
name = \"Desk\"
target = \"thumbv7m-none-eabi\"

[memory]
flash = { origin = 0, length = \"64K\" }
ram = { origin = 0x2000_0000, length = 16384 }

[clock]
hz = 25_000_000
";

fn read(text: &str) -> Result<Board, String> {
    let source = Source::new("board.toml".to_string(), text.to_string());
    parse(&source, Path::new("nowhere")).map_err(|error| error.to_string())
}

#[test]
fn what_is_left_out_has_a_default() {
    let board = read(DESK).unwrap();
    assert_eq!((board.flash.length, board.ram.length), (65_536, 16_384));
    assert_eq!(
        (board.tick_us, board.scan_us, board.stack),
        (1000, 10_000, 1024)
    );
    assert!(!board.console && board.inputs.is_empty() && board.functions.is_empty());
}

#[test]
fn pins_have_octal_numbers() {
    let pins = "[inputs]\nx17 = { at = 4, bit = 31 }\n[outputs]\nY010 = { at = 8, on = 1, off = 2, off_at = 12 }\n\
                Y011 = { at = 8, bit = 0, inverted = true }\n";
    let board = read(&format!("{DESK}{pins}")).unwrap();
    assert_eq!(board.inputs[&15].bit, 31);
    let (on, off) = ((8, 1), (12, 2));
    assert_eq!(board.outputs[&8], OutputPin::Words { on, off });
    let bit = OutputPin::Bit {
        at: 8,
        bit: 0,
        inverted: true,
    };
    assert_eq!(board.outputs[&9], bit);
}

#[test]
fn serial_ports_are_uarts() {
    let serial = "[[serial]]\nport = \"COM1\"\nuart = \"stm32\"\nat = 0x40004400\ninterrupts = [38]\n\
                  de = { at = 8, on = 1, off = 2 }\n[[serial]]\nport = \"COM0\"\nuart = \"stm32\"\nat = 0x40011000\n\
                  interrupts = [37]\nhz = 8_000_000\nalways = true\nreceive = 128\nsend = 16\n";
    let board = read(&format!("{DESK}{serial}")).unwrap();
    let [com1, com0] = &board.serial[..] else {
        panic!("{:?}", board.serial)
    };
    assert_eq!((com1.port, com1.uart), (1, Uart::Stm32));
    assert_eq!((com1.receive, com1.send, com1.always), (64, 256, false));
    let [on, off] = [(8, 1), (8, 2)];
    assert_eq!(com1.driver, Some(OutputPin::Words { on, off }));
    assert_eq!(
        (com1.clock_hz, com0.clock_hz, com0.receive, com0.send),
        (25_000_000, 8_000_000, 128, 16)
    );
    assert!(com0.always);
}

/// Each mistake in a description of serial ports is reported with its place.
#[test]
fn mistakes_in_serial_ports_are_named() {
    let line = "port = \"COM1\"\nuart = \"cmsdk\"\nat = 0\ninterrupts = [0]\n";
    let second = |line: &str| format!("[[serial]]\n{line}");
    for (from, to, messages) in [
        (
            "COM1",
            "UART1",
            "board.toml:12:8: `UART1` is not a serial port",
        ),
        ("\"cmsdk\"", "\"z80\"", "unknown name `z80`"),
        ("[0]", "[]", "name at least one interrupt"),
        ("[0]", "[480]", "from 0 to 479"),
        (
            "at = 0",
            "at = 0\nreceive = 1",
            "board.toml:15:11: a queue has room for 2 to 4096",
        ),
        (
            "at = 0",
            "at = 0\nde = { at = 0, bit = 1 }",
            "a CMSDK UART does not say when",
        ),
        (
            "[0]\n",
            &format!("[0]\n{}", second(line)),
            "COM1 is listed twice",
        ),
        (
            "[0]\n",
            &format!("[0]\n{}", second(&line.replace("COM1", "COM2"))),
            "interrupt 0 belongs to another port",
        ),
        (
            "[0]\n",
            &format!(
                "[0]\n{}",
                second(&line.replace("COM1", "COM2").replace("cmsdk", "stm32"))
            ),
            "the UARTs of a board are of one kind",
        ),
    ] {
        let error = read(&format!("{DESK}\n{}", second(&line.replacen(from, to, 1)))).unwrap_err();
        assert!(error.contains(messages), "{error}");
    }
    let both = format!("[functions]\nset_line = \"f\"\n{}", second(line));
    let error = read(&format!("{DESK}{both}")).unwrap_err();
    assert!(error.contains("use only one of them"), "{error}");
}

/// Each mistake is reported with its place.
#[test]
fn mistakes_are_named() {
    for (from, to, messages) in [
        ("thumbv7m", "thumbv9", "board.toml:2:10: unknown target"),
        (
            "hz = 25_000_000",
            "hz = 100",
            "board.toml:9:6: a tick of 1000 µs is 0 counts",
        ),
        (
            "hz = ",
            "tick_us = 10_000_000\nhz = ",
            "SysTick has 2 to 16 777 216",
        ),
        ("hz = ", "herz = 1\nhz = ", "there is no key `herz`"),
        ("length = 16384", "length = 0", "`ram` is empty"),
        ("\n[clock]", "[clock]\nhz = 1\n[clock]", "duplicate key"),
    ] {
        let error = read(&DESK.replacen(from, to, 1)).unwrap_err();
        assert!(error.contains(messages), "{error}");
    }
    for (added, messages) in [
        (
            "[inputs]\nX8 = { at = 4, bit = 0 }",
            "board.toml:12:1: `X8` is not a terminal",
        ),
        ("[inputs]\nX0 = { at = 4, bit = 32 }", "bits 0 to 31"),
        (
            "[inputs]\nX0 = { at = 4, bit = 0 }\nX000 = { at = 4, bit = 1 }",
            "X000 is listed twice",
        ),
        ("[outputs]\nY0 = { at = 4, on = 1 }", "an output has either"),
        (
            "[analog.inputs]\nAD0 = { at = 8, full = 4095, unit = \"V\", signal = [0.0, 10.0], function = 2 }",
            "board.toml:12:7: `function` is that of an output (PWM); an input has none",
        ),
        (
            "[analog.outputs]\nDA0 = { at = 8, full = 4095, unit = \"V\", signal = [0.0, 10.0], start = { at = 4, write = 1, wait = 1 } }",
            "board.toml:12:7: `start` starts the conversion of an input; an output has none",
        ),
        (
            "[analog.inputs]\nAD0 = { at = 8, full = 4095, unit = \"V\", signal = [0.0, 10.0], channel = 3 }\n\
             AD1 = { at = 8, full = 4095, unit = \"V\", signal = [0.0, 10.0], channel = 3 }",
            "board.toml:13:1: channel 3 is listed twice",
        ),
        (
            "[functions]\nblink = \"f\"",
            "unknown function; available: init",
        ),
        (
            "[functions]\ninput = \"2f\"",
            "`2f` is not the name of a C function",
        ),
        ("[functions]\ninput = \"f\"", "`sources` is missing"),
        ("[interrupts]\nTIM2 = \"f\"", "a number from 0 to 479"),
    ] {
        let error = read(&format!("{DESK}\n{added}\n")).unwrap_err();
        assert!(error.contains(messages), "{error}");
    }
    let sources = |name: &str| {
        read(&DESK.replacen("\n[memory]", &format!("sources = [{name:?}]\n[memory]"), 1))
    };
    assert!(
        sources("a.rs")
            .unwrap_err()
            .contains("sources are files *.c and *.h")
    );
    assert!(sources("a.c").unwrap_err().contains("not found"));
}

/// `make` would run commands in the name of a source.
#[test]
fn names_of_sources_mean_nothing_to_make() {
    let folder = tempfile::tempdir().unwrap();
    let files = [
        "$(shell touch PWNED).c",
        "a b.c",
        "a;b.c",
        "größe.c",
        "main.c",
        "panel.c",
        "panel.h",
    ];
    for file in files {
        std::fs::write(folder.path().join(file), "").unwrap();
    }
    std::fs::create_dir(folder.path().join("more")).unwrap();
    std::fs::write(folder.path().join("more/panel.c"), "").unwrap();
    let sources = |names: &[&str]| {
        let text = DESK.replacen("\n[memory]", &format!("sources = {names:?}\n[memory]"), 1);
        parse(&Source::new("board.toml", text), folder.path()).map_err(|error| error.to_string())
    };
    for file in &files[..4] {
        let error = sources(&[file]).unwrap_err();
        assert!(error.contains("`make` cannot build"), "{file}: {error}");
    }
    let error = sources(&["main.c"]).unwrap_err();
    assert!(error.contains("already has a file"), "{error}");
    let error = sources(&["panel.c", "more/panel.c"]).unwrap_err();
    assert!(error.contains("another source `panel.c`"), "{error}");
    assert!(sources(&["panel.c", "panel.h"]).is_ok());
}
