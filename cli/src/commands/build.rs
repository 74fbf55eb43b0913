//! `rungc build`.

use super::setting::setting;
use super::{
    Context, Failure, Outcome, Result, conclude, counted, findings, holder, read, say, stem, tell,
    write_executable, write_file,
};
use crate::args::{BuildArgs, Emit};
use crate::progress;
use crate::report;
use rungc_firmware::board::{self, Board};
use rungc_firmware::build::Tools;
use rungc_firmware::image::{self, Image, Script};
use rungc_firmware::sources;
use rungc_firmware::target::{self, Target};
use rungc_ir::compile::{self, CompileOptions};
use rungc_ir::{Module, dump};
use rungc_sim::plctest::Target as Device;
use rungc_syntax::DeviceClass;
use std::fs;
use std::path::{Path, PathBuf};

/// A file to write, its path relative to the output folder.
type OutFile = (String, Vec<u8>);

/// Compiles a program. Nothing is written if it has errors.
pub fn run(args: &BuildArgs, cx: Context) -> Result {
    let target = fitting(args)?;
    let image = match &args.board {
        Some(path) => Some(ForImage::new(args, path)?),
        None => None,
    };
    let read = read(&args.input, cx)?;
    let name = args
        .name
        .clone()
        .unwrap_or_else(|| stem(&args.input, &read));
    let options = CompileOptions {
        model: args.input.model,
        name: Some(name),
        optimise: !args.no_opt,
        ..CompileOptions::default()
    };
    let compiled = progress::spin("compiling", || compile::compile(&read.program, &options));
    let findings = findings(&args.input, &read, &compiled);
    let module = match compiled.module {
        Some(module) if !findings.failed() => module,
        _ => return conclude(&findings, &args.input.reporting, cx, String::new),
    };
    let written = emit(args, &module, target, image.as_ref())?;
    match written {
        Some(path) => conclude(&findings, &args.input.reporting, cx, || {
            format!(
                "    Emitted {} ({}, {})",
                path.display(),
                module.model.name.to_uppercase(),
                counted(module.steps as usize, "step")
            )
        }),
        None => report::print(&findings, &args.input.reporting, cx.color, cx.taken)
            .map(|()| Outcome::Success)
            .map_err(Failure::from),
    }
}

/// The target, if the options go together.
fn fitting(args: &BuildArgs) -> std::result::Result<&'static Target, Failure> {
    let wrong = |why: &str| Err(Failure::Because(why.to_string()));
    let target = args.target.unwrap_or(target::host());
    match args.emit {
        Emit::Ir if args.target.is_some() => wrong("--target: the IR is the same for all targets"),
        Emit::Ir | Emit::Rust | Emit::Bin | Emit::Lib if args.board.is_some() => {
            wrong("--board: an image is made by --emit elf, its sources by --emit c")
        }
        Emit::Elf if args.board.is_none() => wrong(
            "--emit elf: an image is for a board; --board names its description (docs/boards.md)",
        ),
        Emit::Bin if target.is_bare() => wrong(
            "--emit bin: nothing runs below a program there that could start it; --emit elf makes an image for a board",
        ),
        _ if args.main && args.board.is_some() => {
            wrong("--main: an image has its own main program, which the board's description makes")
        }
        Emit::Lib if args.main => wrong("--main: a library has no main program"),
        _ => Ok(target),
    }
}

/// What an image needs besides its program.
struct ForImage {
    board: Board,
    script: Script,
}

impl ForImage {
    fn new(args: &BuildArgs, path: &Path) -> std::result::Result<Self, Failure> {
        let board = board::load(path).map_err(because)?;
        if let Some(target) = args.target.filter(|target| *target != board.target) {
            return Err(Failure::Because(format!(
                "--target {}: {} is {}",
                target.triple,
                path.display(),
                board.target.triple
            )));
        }
        let settings = args.set.iter().map(|text| setting(text));
        let mut settings = settings.collect::<std::result::Result<Vec<_>, _>>()?;
        settings.sort_by_key(|setting| setting.at_ms);
        let inputs = settings.iter().map(|setting| match setting.target {
            Device::Bit(DeviceClass::X, number) => {
                Ok((milliseconds(setting.at_ms)?, number, setting.value != 0.0))
            }
            other => Err(Failure::Because(format!(
                "--set {other}: in an image only inputs switch themselves"
            ))),
        });
        let script = Script {
            inputs: inputs.collect::<std::result::Result<_, _>>()?,
            until_ms: args.duration.map(milliseconds).transpose()?,
        };
        Ok(ForImage { board, script })
    }

    fn image<'a>(&'a self, module: &'a Module) -> Image<'a> {
        Image {
            module,
            board: &self.board,
            script: &self.script,
        }
    }

    /// The sources of the image. What its board has no pin for is told.
    fn sources(&self, module: &Module) -> std::result::Result<Vec<(String, String)>, Failure> {
        let image = self.image(module);
        let unconnected = image.unconnected();
        if !unconnected.is_empty() {
            let (board, names) = (&self.board.name, unconnected.join(", "));
            tell(&format!("rungc: no pins on {board}: {names}"));
        }
        image::c_project(&image).map_err(Failure::from)
    }
}

/// A time in an image.
fn milliseconds(ms: u64) -> std::result::Result<u32, Failure> {
    let wrong = |_| Failure::Because("an image's time goes to 49 days".to_string());
    u32::try_from(ms).map_err(wrong)
}

fn because(error: impl std::fmt::Display) -> Failure {
    Failure::Because(error.to_string())
}

/// Writes what was asked for; returns where, or `None` for standard output.
fn emit(
    args: &BuildArgs,
    module: &Module,
    target: &'static Target,
    image: Option<&ForImage>,
) -> std::result::Result<Option<PathBuf>, Failure> {
    let output = |default: String| {
        args.output
            .clone()
            .unwrap_or_else(|| PathBuf::from(default))
    };
    let name = &module.name;
    let tools = |target| Tools::new(target, &args.cargo_arg);
    let path = match (args.emit, image) {
        (Emit::Ir, _) => {
            let text = dump::dump(module);
            match &args.output {
                None => say(&text)?,
                Some(path) => write_file(path, text.as_bytes(), args.force)?,
            }
            return Ok(args.output.clone());
        }
        (Emit::C, None) => {
            let path = output(format!("{name}-c"));
            write_folder(
                &path,
                &texts(sources::c(module, target, args.main)),
                args.force,
            )?;
            path
        }
        (Emit::C, Some(image)) => {
            let path = output(format!("{name}-c"));
            write_folder(&path, &texts(image.sources(module)?), args.force)?;
            path
        }
        (Emit::Rust, _) => {
            let path = output(format!("{name}-rust"));
            write_folder(
                &path,
                &texts(sources::rust(module, target, args.main)),
                args.force,
            )?;
            path
        }
        (Emit::Lib, _) => {
            let path = output(format!("{name}-lib"));
            free(&path, args.force)?;
            let files = sources::c(module, target, false);
            let built = progress::spin("building", || tools(target).c_library(&files, name));
            write_folder(&path, &built.map_err(because)?, args.force)?;
            path
        }
        (Emit::Bin, _) => {
            let path = output(name.clone());
            vacant(&path, args.force)?;
            let files = sources::c(module, target, true);
            let built = progress::spin("building", || tools(target).c_program(&files, name));
            write_executable(&path, &built.map_err(because)?, args.force)?;
            path
        }
        (Emit::Elf, Some(image)) => {
            let file = format!("{name}.elf");
            let path = output(file.clone());
            vacant(&path, args.force)?;
            let files = image.sources(module)?;
            let tools = tools(image.board.target);
            let built = progress::spin("building", || tools.c_program(&files, &file));
            write_executable(&path, &built.map_err(because)?, args.force)?;
            path
        }
        (Emit::Elf, None) => return Err(Failure::Because("an image is for a board".to_string())),
    };
    Ok(Some(path))
}

/// Files as they are written.
fn texts(files: Vec<(String, String)>) -> Vec<OutFile> {
    let files = files.into_iter();
    files
        .map(|(path, text)| (path, text.into_bytes()))
        .collect()
}

/// Refuses a file that is there before a long build, unless it may be replaced.
fn vacant(path: &Path, force: bool) -> std::result::Result<(), Failure> {
    match path.exists() && !force {
        true => Err(Failure::Because(format!(
            "{} is already there; --force replaces it",
            path.display()
        ))),
        false => Ok(()),
    }
}

/// The same of a folder: an empty one may be there. Returns whether it is there.
fn free(folder: &Path, force: bool) -> std::result::Result<bool, Failure> {
    let there = folder.exists();
    let occupied = there
        && fs::read_dir(folder)
            .map_err(|e| at(folder, e))?
            .next()
            .is_some();
    match occupied && !force {
        true => Err(Failure::Because(format!(
            "{} is already there and not empty; --force writes into it",
            folder.display()
        ))),
        false => Ok(there),
    }
}

fn at(path: &Path, error: std::io::Error) -> Failure {
    Failure::Because(format!("{}: {error}", path.display()))
}

/// Writes all files into a folder: a new one appears only when complete, in one that is there (not empty only with `force`) they
/// take their places when all of them are written.
fn write_folder(folder: &Path, files: &[OutFile], force: bool) -> std::result::Result<(), Failure> {
    let there = free(folder, force)?;
    let beside = match there {
        true => folder,
        false => holder(folder),
    };
    fs::create_dir_all(beside).map_err(|e| at(beside, e))?;
    let fresh = tempfile::Builder::new()
        .prefix(".rungc-")
        .tempdir_in(beside)
        .map_err(|e| at(beside, e))?;
    let inside = fresh.path().join("out");
    fs::create_dir(&inside).map_err(|e| at(&inside, e))?;
    for (path, contents) in files {
        write_file(&inside.join(path), contents, false)?;
    }
    if !there {
        return fs::rename(&inside, folder).map_err(|e| at(folder, e));
    }
    for (path, _) in files {
        let to = folder.join(path);
        fs::create_dir_all(holder(&to)).map_err(|e| at(&to, e))?;
        fs::rename(inside.join(path), &to).map_err(|e| at(&to, e))?;
    }
    Ok(())
}
