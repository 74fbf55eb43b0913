//! `rungc flash`: an image into a microcontroller.

mod port;
pub mod probe;
mod volume;

use super::{Context, Failure, Outcome, Result, eprint_line, interruption};
use crate::args::FlashArgs;
use crate::output::{spare, write_file};
use crate::progress;
use indicatif::ProgressBar;
use port::Port;
use rungc_firmware::flash::chips::{self, Chip, Pages};
use rungc_firmware::flash::loader::{BLOCK, Loader, LoaderError};
use rungc_firmware::flash::uf2;
use rungc_firmware::flash::{FlashError, Payload, Plan, Step, Writer};
use rungc_project::serve::LineEnd;
use rungc_syntax::codes::{self, Code};
use std::fs;
use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::time::Duration;

/// The answer that starts erasing.
const YES: &str = "yes";

/// Writes an image. Nothing is erased before the image has been read, the part is known, and the user has agreed.
pub fn run(args: &FlashArgs, cx: Context) -> Result {
    if let Some(path) = &args.backup {
        spare(path, args.force)?;
    }
    let wrong = |why: String| Failure::Because(format!("{}: {why}", args.file.display()));
    let file = fs::read(&args.file).map_err(|error| wrong(error.to_string()))?;
    let is_uf2 = uf2::is_uf2(&file);
    let payload = match is_uf2 {
        true => uf2::read(&file).map_err(|error| wrong(error.to_string()))?,
        false => Payload::read(&file, args.at).map_err(|error| wrong(error.to_string()))?,
    };
    if is_uf2 && args.volume.is_none() {
        return Err(wrong("UF2 is for --volume; use the ELF file".to_string()));
    }
    match (&args.volume, &args.probe, &args.port) {
        (Some(folder), ..) => volume::flash(args, folder, &payload, cx),
        (None, Some(chip), _) => probe::flash(args, chip, &payload, cx),
        (None, None, Some(port)) => over(port, args, &payload, cx),
        (None, None, None) => {
            let why = "--port, --volume or --probe is missing";
            Err(Failure::Because(why.to_string()))
        }
    }
}

/// Over a serial line.
fn over(port: &LineEnd, args: &FlashArgs, payload: &Payload, cx: Context) -> Result {
    let line = Port::open(port, args.baud)?;
    if args.wait() > Duration::from_secs(1) {
        cx.note(&format!(
            "     Waiting for the boot loader at {port}: set BOOT0 and reset the board"
        ));
    }
    let board = Board::connect(line, args);
    match board.and_then(|board| board.flash(args, payload, cx)) {
        Err(Stop::Because(failure)) => Err(failure),
        Err(Stop::Failed(code, why)) => Ok(failed(code, &format!("{port}: {why}"))),
        Ok(outcome) => Ok(outcome),
    }
}

/// Reports an error with its code.
fn failed(code: &Code, why: &str) -> Outcome {
    let id = code.id;
    eprint_line(&format!(
        "rungc: error[{id}]: {why}\n       for more, run `rungc explain {id}`"
    ));
    match interruption::is_requested() {
        true => Outcome::Interrupted,
        false => Outcome::Failed,
    }
}

/// Reason to stop.
enum Stop {
    Because(Failure),
    /// The board does not allow it.
    Failed(&'static Code, String),
}

impl From<Failure> for Stop {
    fn from(failure: Failure) -> Self {
        Stop::Because(failure)
    }
}

type Done<T> = std::result::Result<T, Stop>;

/// Error before anything is erased.
fn early(error: LoaderError) -> Stop {
    Stop::Failed(&codes::BOOT_LOADER_SILENT, error.to_string())
}

/// Error while the image is written.
fn late(error: FlashError) -> Stop {
    let why = match &error {
        FlashError::Loader(LoaderError::Rejected(_)) => {
            "; if pages are write protected, --unprotect lifts that"
        }
        FlashError::Loader(LoaderError::Line(_)) => {
            "; the image is incomplete and does not start: run the command again"
        }
        _ => "",
    };
    Stop::Failed(&codes::FLASHING_FAILED, format!("{error}{why}"))
}

/// A board whose boot loader has answered.
struct Board {
    loader: Loader<Port>,
    chip: &'static Chip,
    /// Bytes of flash.
    flash: u32,
    is_readable: bool,
}

impl Board {
    fn connect(line: Port, args: &FlashArgs) -> Done<Self> {
        let mut loader = Loader::connect(line, args.wait()).map_err(early)?;
        let id = loader.id().map_err(early)?;
        let Some(chip) = chips::find(id) else {
            let what =
                format!("the part reports the product number 0x{id:03X}, which is not known");
            return Err(Stop::Failed(&codes::WRONG_CHIP, what));
        };
        let is_readable = loader.is_readable().map_err(early)?;
        let mut flash = chip.flash;
        // Some boot loaders do not read this register: then the image fits the largest part, and reading back decides.
        if is_readable && let Ok(size) = loader.read(chip.size_at, 4) {
            let kib = u16::from_le_bytes([size[0], size[1]]);
            if !matches!(kib, 0 | u16::MAX) {
                flash = flash.min(u32::from(kib) * 1024);
            }
        }
        Ok(Board {
            loader,
            chip,
            flash,
            is_readable,
        })
    }

    fn flash(mut self, args: &FlashArgs, payload: &Payload, cx: Context) -> Done<Outcome> {
        cx.note(&format!(
            "       Found {}, {} KiB of flash, boot loader {}.{}",
            self.chip.name,
            self.flash / 1024,
            self.loader.version >> 4,
            self.loader.version & 0xF,
        ));
        let misfit = |error: FlashError| Stop::Failed(&codes::IMAGE_MISFIT, error.to_string());
        let mut plan = Writer::<Port>::fit(self.chip, self.flash, payload).map_err(misfit)?;
        if !self.is_readable && !args.unprotect {
            let why = "the part is read protected: its firmware and program cannot be read or saved, only erased permanently, \
                       with --unprotect";
            return Err(Stop::Failed(&codes::CHIP_PROTECTED, why.to_string()));
        }
        if let Some(path) = &args.backup {
            self.back_up(path, args.force, cx)?;
        }
        let bar = progress::bar(0);
        if self.is_readable {
            let mut writer = self.writer(&bar);
            writer.compare(&mut plan, payload).map_err(late)?;
        }
        if plan.changed().next().is_none() {
            cx.note("   Unchanged: flash already holds the image");
            return self.finish(args, payload, cx);
        }
        confirm(&self.loss(&plan, args), args.yes)?;
        interruption::note();
        if !self.is_readable {
            self.lift(Loader::unprotect)?;
        } else if args.unprotect {
            self.lift(Loader::unprotect_pages)?;
        }
        let written = self.writer(&bar).write(&plan, payload);
        bar.finish_and_clear();
        written.map_err(late)?;
        cx.note(&format!(
            "     Flashed {}: {} bytes at 0x{:08X}, read back and compared",
            args.file.display(),
            payload.bytes.len(),
            payload.origin
        ));
        self.finish(args, payload, cx)
    }

    fn writer<'a>(&'a mut self, bar: &'a ProgressBar) -> Writer<'a, Port> {
        Writer {
            chip: self.chip,
            flash: self.flash,
            loader: &mut self.loader,
            progress: Box::new(|step, done, total| {
                bar.set_message(match step {
                    Step::Compare => "compared",
                    Step::Erase => "pages erased",
                    Step::Write => "bytes written",
                    Step::Verify => "bytes verified",
                });
                bar.set_length(total as u64);
                bar.set_position(done as u64);
            }),
        }
    }

    /// Saves all of flash.
    fn back_up(&mut self, path: &Path, force: bool, cx: Context) -> Done<()> {
        if !self.is_readable {
            let why = "the part is read protected: there is nothing that --backup could save";
            return Err(Stop::Failed(&codes::CHIP_PROTECTED, why.to_string()));
        }
        let bar = progress::bar(self.flash.into());
        let mut bytes = Vec::new();
        for at in (chips::FLASH..chips::FLASH + self.flash).step_by(BLOCK) {
            bytes.extend(self.loader.read(at, BLOCK).map_err(early)?);
            bar.set_position(bytes.len() as u64);
        }
        bar.finish_and_clear();
        write_file(path, &bytes, force)?;
        cx.note(&format!(
            "       Saved {} bytes to {}",
            bytes.len(),
            path.display()
        ));
        Ok(())
    }

    /// Warning about the data that are lost permanently.
    fn loss(&self, plan: &Plan, args: &FlashArgs) -> String {
        if !self.is_readable {
            return "All of flash is erased: the firmware and the PLC program in it are lost permanently. The part is read protected: they cannot \
                    be saved before or restored afterwards."
                .to_string();
        }
        let unit = match self.chip.pages {
            Pages::Equal(_) => "page",
            Pages::Sectors => "sector",
        };
        let pages: Vec<_> = plan.changed().collect();
        let [(first, start), ..] = pages.as_slice() else {
            return String::new();
        };
        let (last, end) = pages
            .last()
            .map_or((first, start), |(last, end)| (last, end));
        let saved = match &args.backup {
            Some(path) => format!("{} holds all of flash as it was.", path.display()),
            None => "All of flash can be saved first, with --backup FILE.".to_string(),
        };
        let some = match last - first + 1 {
            all if all as usize == pages.len() => String::new(),
            _ => format!("{} of ", pages.len()),
        };
        format!(
            "Erases {some}{unit}s {first} to {last} (0x{:08X} to 0x{:08X}): the firmware and the PLC program in them are lost permanently. {saved}",
            start.start,
            end.end - 1,
        )
    }

    fn lift(
        &mut self,
        lift: impl FnOnce(&mut Loader<Port>) -> std::result::Result<(), LoaderError>,
    ) -> Done<()> {
        lift(&mut self.loader).map_err(|error| match error {
            LoaderError::Line(_) => late(error.into()),
            error => Stop::Failed(
                &codes::CHIP_PROTECTED,
                format!("the protection cannot be lifted: {error}"),
            ),
        })
    }

    fn finish(mut self, args: &FlashArgs, payload: &Payload, cx: Context) -> Done<Outcome> {
        match args.start {
            true => self
                .loader
                .start(payload.origin)
                .map_err(|e| late(e.into()))?,
            false => {
                cx.note("             set BOOT0 back and reset the board to start the program")
            }
        }
        Ok(Outcome::Success)
    }
}

/// Says what is lost, and asks whether to continue.
fn confirm(loss: &str, yes: bool) -> std::result::Result<(), Failure> {
    eprint_line(&format!("rungc: {loss}"));
    if yes {
        return Ok(());
    }
    if !io::stdin().is_terminal() {
        let why = "nothing was erased: no terminal to ask at; --yes agrees for scripts";
        return Err(Failure::Because(why.to_string()));
    }
    let _ = write!(io::stderr(), "rungc: type `{YES}` to erase: ");
    let mut answer = String::new();
    io::stdin().read_line(&mut answer)?;
    match answer.trim() == YES {
        true => Ok(()),
        false => Err(Failure::Because("nothing was erased".to_string())),
    }
}
