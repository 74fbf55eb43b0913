//! Writing an image to the volume that the boot ROM of an RP2040 shows over USB.

use super::{Done, Stop, confirm, failed};
use crate::args::FlashArgs;
use crate::commands::{Context, Failure, Outcome, Result, interruption};
use rungc_firmware::flash::Payload;
use rungc_firmware::flash::uf2::{self, INFO, RP2040_BOARD};
use rungc_syntax::codes;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

/// Argument for a volume to be searched for.
const AUTO: &str = "auto";

/// Start and end of an RP2040's flash, and the unit of erasing.
const FLASH: u32 = 0x1000_0000;
const FLASH_END: u64 = 0x1100_0000;
const SECTOR: u32 = 4096;

/// Size of what is written at once, in bytes: between two blocks an interruption is noticed.
const BLOCK: usize = 512;

/// Interval of checks for a restarted board.
const PERIOD: Duration = Duration::from_millis(100);

/// Copies an image to a volume.
pub fn flash(args: &FlashArgs, volume: &Path, payload: &Payload, cx: Context) -> Result {
    if args.backup.is_some() || args.unprotect {
        let why = "--backup and --unprotect do not apply: a volume shows nothing of flash, and \
                   an RP2040 has no protection";
        return Err(Failure::Because(why.to_string()));
    }
    match copy(args, volume, payload, cx) {
        Ok(()) => Ok(Outcome::Success),
        Err(Stop::Because(failure)) => Err(failure),
        Err(Stop::Failed(code, why)) => Ok(failed(code, &why)),
    }
}

fn copy(args: &FlashArgs, volume: &Path, payload: &Payload, cx: Context) -> Done<()> {
    if payload.origin < FLASH || payload.end() > FLASH_END {
        let why = format!(
            "the image takes 0x{:08X} to 0x{:08X}, flash of an RP2040 begins at 0x{FLASH:08X}",
            payload.origin,
            payload.end() - 1
        );
        return Err(Stop::Failed(&codes::IMAGE_MISFIT, why));
    }
    let volume = match volume.to_str() {
        Some(AUTO) => find()?,
        _ => volume.to_path_buf(),
    };
    check(&volume)?;
    cx.note(&format!("       Found an RP2040 at {}", volume.display()));
    confirm(&loss(payload), args.yes)?;
    interruption::note();
    let name = args.file.file_stem().unwrap_or("image".as_ref());
    let path = volume.join(name).with_extension("uf2");
    let file = uf2::write(payload);
    let late = |why: String| Stop::Failed(&codes::FLASHING_FAILED, why);
    let again = |why: &str| late(format!("{why}; unplug it and begin again"));
    let why = |error: io::Error| format!("{}: {error}", path.display());
    let mut copy = File::create_new(&path).map_err(|error| late(why(error)))?;
    for block in file.chunks(BLOCK) {
        if interruption::is_requested() {
            return Err(again("interrupted: the image is incomplete"));
        }
        copy.write_all(block).map_err(|error| late(why(error)))?;
    }
    // The board restarts as soon as it has the last block: then nothing is there to say that all is written.
    let written = copy.sync_all();
    drop(copy);
    if !is_gone(&volume, args.wait()) {
        return Err(again(&match written {
            Err(error) => why(error),
            Ok(()) if interruption::is_requested() => {
                "interrupted before the board has restarted with the image".to_string()
            }
            Ok(()) => "the board has not restarted, so it has not taken the image".to_string(),
        }));
    }
    cx.note(&format!(
        "     Flashed {}: {} bytes at 0x{:08X}; the board has restarted with it",
        args.file.display(),
        payload.bytes.len(),
        payload.origin
    ));
    Ok(())
}

/// Warning about the data that are lost permanently.
fn loss(payload: &Payload) -> String {
    let first = payload.origin - payload.origin % SECTOR;
    let last = payload.end().next_multiple_of(SECTOR.into()) - 1;
    format!(
        "Erases 0x{first:08X} to 0x{last:08X} of flash: the program in it is lost permanently, and cannot be read from \
         the volume before (`picotool save` can). The board then starts the new one at once; its outputs switch."
    )
}

/// Returns true if the volume vanishes before long, and before an interruption.
fn is_gone(volume: &Path, wait: Duration) -> bool {
    let begin = Instant::now();
    while volume.join(INFO).exists() {
        if begin.elapsed() >= wait || interruption::is_requested() {
            return false;
        }
        thread::sleep(PERIOD);
    }
    true
}

/// Looks whether a folder is the volume of an RP2040.
fn check(volume: &Path) -> Done<()> {
    let info = fs::read_to_string(volume.join(INFO)).map_err(|error| {
        let why = format!(
            "{} is not the volume of a boot loader: {INFO}: {error}",
            volume.display()
        );
        Stop::Failed(&codes::NO_BOOT_VOLUME, why)
    })?;
    let mut ids = info
        .lines()
        .filter_map(|line| line.strip_prefix("Board-ID:"));
    match ids.next().map(str::trim) {
        Some(RP2040_BOARD) => Ok(()),
        other => {
            let why = format!(
                "{} belongs to {}, not to an RP2040 ({RP2040_BOARD})",
                volume.display(),
                other.unwrap_or("a board without a name")
            );
            Err(Stop::Failed(&codes::WRONG_CHIP, why))
        }
    }
}

/// The one volume of an RP2040 that is mounted.
fn find() -> Done<PathBuf> {
    let mounts = fs::read_to_string("/proc/self/mounts").unwrap_or_default();
    let volumes = fs::read_dir("/Volumes").into_iter().flatten().flatten();
    let drives = ('D'..='Z').map(|letter| PathBuf::from(format!("{letter}:\\")));
    let all = mount_points(&mounts).chain(volumes.map(|entry| entry.path()));
    let mut found: Vec<_> = all
        .chain(drives)
        .filter(|path| check(path).is_ok())
        .collect();
    let why = match (found.pop(), found.pop()) {
        (Some(only), None) => return Ok(only),
        (None, _) => "no volume RPI-RP2 is mounted: hold BOOTSEL while you plug USB in, mount it, or name its \
                      folder with --volume"
            .to_string(),
        (Some(a), Some(b)) => format!(
            "{} and {} are both volumes of an RP2040: name one with --volume",
            a.display(),
            b.display()
        ),
    };
    Err(Stop::Failed(&codes::NO_BOOT_VOLUME, why))
}

/// The folders in the system's table of mounts, in which spaces are octal.
fn mount_points(table: &str) -> impl Iterator<Item = PathBuf> {
    let folders = table.lines().filter_map(|line| line.split(' ').nth(1));
    folders.map(|folder| PathBuf::from(folder.replace("\\040", " ")))
}
