//! `rungc flash --volume`, with a folder that does what the volume of an RP2040 does: it vanishes when it has the last
//! block.

use super::code;
use crate::common::{folder, normal, rungc, text};
use rungc_firmware::flash::{Payload, uf2};
use std::fs;
use std::path::Path;
use std::process::Output;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;
use tempfile::TempDir;

const INFO: &str = "UF2 Bootloader v3.0\r\nModel: Raspberry Pi RP2\r\nBoard-ID: RPI-RP2\r\n";

fn image(origin: u32) -> Payload {
    Payload {
        origin,
        bytes: (0..1000u32).map(|n| (n % 251) as u8).collect(),
        is_elf: false,
    }
}

/// A folder with an image and a volume.
fn rig(info: &str) -> TempDir {
    let rig = folder(&[
        ("p.uf2", &uf2::write(&image(0x1000_0000))),
        ("far.uf2", &uf2::write(&image(0x0800_0000))),
        ("damaged.uf2", &uf2::write(&image(0x1000_0000))[..1000]),
    ]);
    fs::create_dir(rig.path().join("RPI-RP2")).unwrap();
    fs::write(rig.path().join("RPI-RP2/INFO_UF2.TXT"), info).unwrap();
    rig
}

fn flash(rig: &TempDir, file: &str, options: &[&str]) -> Output {
    let usual = ["flash", file, "--wait", "1"];
    rungc(rig.path(), &[&usual, options].concat())
}

/// The same with a board that restarts when it has the image.
fn flash_to_board(rig: &TempDir, options: &[&str]) -> Output {
    let done = AtomicBool::new(false);
    thread::scope(|scope| {
        scope.spawn(|| {
            let volume = rig.path().join("RPI-RP2");
            while !done.load(Ordering::Relaxed) {
                if fs::metadata(volume.join("p.uf2")).is_ok_and(|file| file.len() == 4 * 512) {
                    fs::remove_file(volume.join("INFO_UF2.TXT")).unwrap();
                    return;
                }
                thread::sleep(Duration::from_millis(5));
            }
        });
        let usual = ["flash", "p.uf2", "--volume", "RPI-RP2", "--wait", "60"];
        let output = rungc(rig.path(), &[&usual, options].concat());
        done.store(true, Ordering::Relaxed);
        output
    })
}

fn says(rig: &TempDir, output: &Output) -> String {
    normal(&text(&output.stderr), rig.path())
}

fn is_untouched(folder: &Path) -> bool {
    fs::read_dir(folder.join("RPI-RP2")).unwrap().count() == 1
}

#[test]
fn an_image_is_copied_to_the_volume() {
    let rig = rig(INFO);
    // Without a terminal no one can agree.
    let asked = flash_to_board(&rig, &[]);
    assert_eq!(code(&asked), 2);
    assert!(is_untouched(rig.path()));
    insta::assert_snapshot!("volume_asked", says(&rig, &asked));
    let flashed = flash_to_board(&rig, &["--yes"]);
    assert_eq!(code(&flashed), 0, "{}", text(&flashed.stderr));
    insta::assert_snapshot!("volume_flashed", says(&rig, &flashed));
    let written = fs::read(rig.path().join("RPI-RP2/p.uf2")).unwrap();
    let read = uf2::read(&written).unwrap();
    assert_eq!(read.bytes[..1000], image(0).bytes);
}

#[test]
fn what_is_not_for_the_volume_is_rejected() {
    let board = rig(INFO);
    let mut messages = String::new();
    for (file, options, exit) in [
        ("far.uf2", ["--volume", "RPI-RP2"], 1),
        ("damaged.uf2", ["--volume", "RPI-RP2"], 2),
        ("p.uf2", ["--volume", "nowhere"], 1),
        ("p.uf2", ["--port", "/dev/nothing"], 2),
    ] {
        let output = flash(&board, file, &options);
        assert_eq!(code(&output), exit, "{}", text(&output.stderr));
        messages += &format!("{file} {}:\n{}\n", options.join(" "), says(&board, &output));
    }
    let output = flash(&board, "p.uf2", &["--volume", "RPI-RP2", "--backup", "b"]);
    assert_eq!(code(&output), 2);
    messages += &says(&board, &output);
    assert!(is_untouched(board.path()));
    let other = rig("UF2 Bootloader v1.0\r\nBoard-ID: RP2350\r\n");
    let output = flash(&other, "p.uf2", &["--volume", "RPI-RP2", "--yes"]);
    assert_eq!(code(&output), 1);
    assert!(is_untouched(other.path()));
    messages += &format!("\n{}", says(&other, &output));
    insta::assert_snapshot!("volume_rejected", messages);
}

#[test]
fn a_board_that_does_not_restart_has_not_taken_the_image() {
    let board = rig(INFO);
    let output = flash(&board, "p.uf2", &["--volume", "RPI-RP2", "--yes"]);
    assert_eq!(code(&output), 1);
    insta::assert_snapshot!("volume_stays", says(&board, &output));
}

/// Ctrl-C while the board is awaited says what has become of the image.
#[cfg(unix)]
#[test]
fn an_interruption_says_what_it_leaves() {
    use crate::common::soon;
    use std::process::{Command, Stdio};
    let board = rig(INFO);
    let flashing = Command::new(env!("CARGO_BIN_EXE_rungc"))
        .args([
            "flash", "p.uf2", "--volume", "RPI-RP2", "--wait", "600", "--yes",
        ])
        .current_dir(board.path())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let copy = board.path().join("RPI-RP2/p.uf2");
    soon("the image is copied", || {
        fs::metadata(&copy).is_ok_and(|file| file.len() == 4 * 512)
    });
    let pid = flashing.id().to_string();
    assert!(
        Command::new("kill")
            .args(["-TERM", &pid])
            .status()
            .unwrap()
            .success()
    );
    let output = flashing.wait_with_output().unwrap();
    assert_eq!(code(&output), 130);
    let messages = says(&board, &output);
    assert!(
        messages.contains("interrupted before the board has restarted"),
        "{messages}"
    );
}
