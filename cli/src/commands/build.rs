//! `rungc build`.

use super::{
    Context, Failure, Outcome, Result, conclude, counted, findings, holder, read, say, stem,
    write_executable, write_file,
};
use crate::args::{BuildArgs, Emit};
use crate::progress;
use crate::report;
use rungc_ir::compile::{self, CompileOptions};
use rungc_ir::{Module, dump};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A file to write, its path relative to the output folder.
type OutFile = (String, String);

/// Compiles a program. Nothing is written if it has errors.
pub fn run(args: &BuildArgs, cx: Context) -> Result {
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
    let written = emit(args, &module)?;
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

/// Writes what was asked for; returns where, or `None` for standard output.
fn emit(args: &BuildArgs, module: &Module) -> std::result::Result<Option<PathBuf>, Failure> {
    let output = |default: String| {
        args.output
            .clone()
            .unwrap_or_else(|| PathBuf::from(default))
    };
    match args.emit {
        Emit::Ir => {
            let text = dump::dump(module);
            match &args.output {
                None => say(&text)?,
                Some(path) => write_file(path, text.as_bytes(), args.force)?,
            }
            Ok(args.output.clone())
        }
        Emit::C => {
            let path = output(format!("{}-c", module.name));
            write_folder(&path, &c_files(module, args.main), args.force)?;
            Ok(Some(path))
        }
        Emit::Rust => {
            let path = output(format!("{}-rust", module.name));
            write_folder(&path, &rust_files(module, args.main), args.force)?;
            Ok(Some(path))
        }
        Emit::Bin => {
            let path = output(module.name.clone());
            executable(module, &path, args.force)?;
            Ok(Some(path))
        }
    }
}

fn c_files(module: &Module, main: bool) -> Vec<OutFile> {
    let options = rungc_codegen_c::Options { main };
    rungc_codegen_c::emit(module, &options)
        .into_iter()
        .map(|f| (f.path, f.text))
        .collect()
}

fn rust_files(module: &Module, main: bool) -> Vec<OutFile> {
    let options = rungc_codegen_rust::Options {
        main,
        ..Default::default()
    };
    rungc_codegen_rust::emit(module, &options)
        .into_iter()
        .map(|f| (f.path, f.text))
        .collect()
}

/// Writes all files into a folder: a new one appears only when complete, in one that is there (not empty only with `force`) they
/// take their places when all of them are written.
fn write_folder(folder: &Path, files: &[OutFile], force: bool) -> std::result::Result<(), Failure> {
    let at = |path: &Path, error: std::io::Error| {
        Failure::Because(format!("{}: {error}", path.display()))
    };
    let there = folder.exists();
    let occupied = there
        && fs::read_dir(folder)
            .map_err(|e| at(folder, e))?
            .next()
            .is_some();
    if occupied && !force {
        return Err(Failure::Because(format!(
            "{} is already there and not empty; --force writes into it",
            folder.display()
        )));
    }
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
    for (path, text) in files {
        write_file(&inside.join(path), text.as_bytes(), false)?;
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

/// Emits C with a main program into a temporary folder, builds it with make, and keeps the executable.
fn executable(module: &Module, path: &Path, force: bool) -> std::result::Result<(), Failure> {
    if path.exists() && !force {
        return Err(Failure::Because(format!(
            "{} is already there; --force replaces it",
            path.display()
        )));
    }
    let folder = tempfile::tempdir()?;
    let source = folder.path().join("src");
    write_folder(&source, &c_files(module, true), false)?;
    let built = progress::spin("building", || {
        Command::new("make").arg("-C").arg(&source).output()
    })
    .map_err(|error| {
        Failure::Because(format!(
            "cannot run make: {error}; building an executable needs make and a C compiler"
        ))
    })?;
    if !built.status.success() {
        return Err(Failure::Because(format!(
            "the C compiler failed:\n{}",
            String::from_utf8_lossy(&built.stderr)
        )));
    }
    let binary = source.join(&module.name);
    let program = fs::read(&binary)?;
    write_executable(path, &program, force)
}
