//! Writing an image with probe-rs, which is a program of its users.

use super::{confirm, failed};
use crate::args::FlashArgs;
use crate::commands::{Context, Failure, Outcome, Result, interruption};
use rungc_firmware::flash::Payload;
use rungc_syntax::codes;
use std::io::ErrorKind;
use std::process::Command;

/// Name of the program.
pub const PROGRAM: &str = "probe-rs";

/// Calls probe-rs to write and verify an image, and to reset the part if it shall start.
pub fn flash(args: &FlashArgs, chip: &str, payload: &Payload, cx: Context) -> Result {
    call(&["--version"], true)?;
    let lost = "what flash holds where the image goes is erased: the firmware and the PLC program in it are lost permanently";
    let all = match args.unprotect {
        true => ". If the part is read protected, all of its flash is erased",
        false => "",
    };
    confirm(&format!("{chip}: {lost}{all}."), args.yes)?;
    interruption::note_for_a_while();
    let file = args.file.display().to_string();
    let mut download = vec!["download", "--chip", chip, "--verify"];
    let origin = format!("0x{:08X}", payload.origin);
    if !payload.is_elf {
        download.extend(["--binary-format", "bin", "--base-address", &origin]);
    }
    if args.unprotect {
        download.push("--allow-erase-all");
    }
    download.push(&file);
    if !call(&download, false)? {
        return Ok(failed(
            &codes::FLASHING_FAILED,
            "probe-rs has not written the image",
        ));
    }
    cx.note(&format!(
        "     Flashed {file}: {} bytes at {origin}, verified by probe-rs",
        payload.bytes.len()
    ));
    if args.start && !call(&["reset", "--chip", chip], false)? {
        return Ok(failed(
            &codes::FLASHING_FAILED,
            "probe-rs has not reset the part",
        ));
    }
    Ok(Outcome::Success)
}

/// Calls it; whether it succeeded. What it prints is shown unless `quiet`.
fn call(args: &[&str], quiet: bool) -> std::result::Result<bool, Failure> {
    let mut command = Command::new(PROGRAM);
    command.args(args);
    let succeeded = match quiet {
        true => command.output().map(|output| output.status.success()),
        false => command.status().map(|status| status.success()),
    };
    succeeded.map_err(|error| {
        Failure::Because(match error.kind() {
            ErrorKind::NotFound => {
                format!("{PROGRAM} is not installed (https://probe.rs); --port writes over the boot loader, without a probe")
            }
            _ => format!("{PROGRAM}: {error}"),
        })
    })
}
