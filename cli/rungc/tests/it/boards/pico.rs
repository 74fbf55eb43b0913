//! The image of a Raspberry Pi Pico in an emulator that others wrote (rp2040js), and its file read by others
//! (uf2utils).

use super::{PUBLISHED, Published, answer, client, folder, leave_out, pins, python};
use serde_json::{Value, json};
use std::path::Path;
use std::process::Command;
use std::{env, fs};

/// Node with the emulator, if it is there.
fn node() -> Option<Command> {
    let modules = env::var_os("RUNGC_RP2040").unwrap_or_default();
    let node = || {
        let mut node = Command::new("node");
        node.env("NODE_PATH", &modules);
        node
    };
    let mut require = node();
    require.args(["-e", "require('rp2040js')"]);
    if !require.output().is_ok_and(|output| output.status.success()) {
        leave_out("rp2040js (RUNGC_RP2040)");
        return None;
    }
    let mut run = node();
    run.arg(client("rp2040.js"));
    Some(run)
}

/// The image in the emulator: clocks, pins, the switch, both UARTs, converters and the watchdog.
pub fn check_emulated(board: &Published, image: &Path) {
    let Some(mut run) = node() else { return };
    let inputs = pins(board.inputs);
    let steps = json!([
        { "ms": 60 },
        { "low": [inputs[0]], "adc": [1024, 3072, 100], "feed": "05" },
        { "low": [inputs[1], "GP22"] },
        { "low": [inputs[1]], "adc": [1024, 3072, 100], "ms": 2500 },
        { "low": [inputs[7]] },
        {},
        { "low": [inputs[7]] },
    ]);
    let found = answer({
        run.arg(image).arg(steps.to_string());
        run
    });
    let step = |n: usize, of: &str| found[n][of].clone();
    // The emulator divides the clock that the image has made of the crystal's.
    assert_eq!(step(0, "baud"), json!([9600, 9600]));
    assert_eq!(step(0, "high"), json!(["GP25"]));
    assert_eq!(step(1, "high"), json!(["GP14", "GP25"]));
    assert_eq!(step(1, "sent"), "06");
    assert_eq!(step(2, "high"), json!([]));
    assert_eq!(step(3, "high"), json!(["GP15", "GP25"]));
    let duty: Vec<f64> = serde_json::from_value(step(3, "duty")).unwrap();
    assert!((duty[0] - 0.25).abs() < 0.02, "{duty:?}");
    assert!((duty[1] - 0.75).abs() < 0.02, "{duty:?}");
    // RS-485: the driver is on before the first byte.
    assert_eq!(step(6, "uart1"), "414243");
    assert_eq!(step(6, "driver"), true);
    let high = found[6]["high"].as_array().unwrap();
    assert!(!high.contains(&json!("GP3")), "{high:?}");
    // The watchdog was served for all of the time.
    assert_eq!(step(6, "resets"), 0);
}

/// Other tools read the image of the ELF file from the file for the volume.
#[test]
fn others_read_the_image_for_the_volume() {
    let board = &PUBLISHED[4];
    let folder = folder(&[]);
    let at = folder.path();
    let Some(file) = board.build(at, "c", "uf2") else {
        return;
    };
    let elf = board.build(at, "c", "elf").unwrap();
    let Some(mut read) = python() else { return };
    read.arg(client("uf2_image.py")).arg(&file);
    let found: Value = answer(read);
    let image = rungc_firmware::flash::Payload::read(&fs::read(elf).unwrap(), 0).unwrap();
    assert_eq!(found["origin"], image.origin);
    assert_eq!(found["families"], json!([0xE48B_FF56_u32]));
    let bytes: Vec<u8> = serde_json::from_value(found["bytes"].clone()).unwrap();
    assert_eq!(&bytes[..image.bytes.len()], image.bytes);
    assert_eq!(bytes[..STAGE_LENGTH], second_stage(at));
    check_emulated(board, &file);
}

/// Bytes of the machine code of the second stage of the boot ROM.
const STAGE_LENGTH: usize = 76;

/// Machine code of its source.
fn second_stage(folder: &Path) -> Vec<u8> {
    let source = Path::new(env!("RUNGC_ROOT")).join("firmware/templates/boot2.s");
    for (tool, args) in [
        ("as", vec![source.to_str().unwrap(), "-o", "boot2.o"]),
        ("objcopy", vec!["-O", "binary", "boot2.o", "boot2.bin"]),
    ] {
        let mut run = Command::new(format!("arm-none-eabi-{tool}"));
        let done = run.args(args).current_dir(folder).status().unwrap();
        assert!(done.success());
    }
    fs::read(folder.join("boot2.bin")).unwrap()
}
