//! Exports for other programs: the question, or the proof.

use crate::args::VerifyArgs;
use crate::commands::properties::RequestedProperty;
use crate::commands::{Context, Failure, counted};
use crate::output::{Kind, at, make_folder, permit, write_file};
use rungc_ir::Module;
use rungc_verify::certificate::Certificate;
use rungc_verify::prove::{Options, system};
use rungc_verify::{aiger, btor2};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

/// Writes the question, if requested.
///
/// # Errors
///
/// A file cannot be written, more than one property is asked where one file takes one, or what proves formulas is
/// missing.
pub fn questions(
    args: &VerifyArgs,
    module: &Module,
    requested: &[RequestedProperty],
    options: &Options,
    cx: Context,
) -> std::result::Result<(), Failure> {
    let only = |option: &str| match requested {
        [only] => Ok(only),
        _ => Err(Failure::Because(format!("{option}: name one property"))),
    };
    let write = |path: &Path, bytes: &[u8]| -> std::result::Result<(), Failure> {
        write_file(path, bytes, args.force)?;
        cx.note(&format!("       Wrote {}", path.display()));
        Ok(())
    };
    if let Some(path) = &args.aiger {
        let (_, system) = system(module, &only("--aiger")?.property, options);
        write(path, &aiger::binary(&system))?;
    }
    if let Some(path) = &args.btor2 {
        let requested = only("--btor2")?;
        let (encoder, system) = system(module, &requested.property, options);
        let text = btor2::text(&system, &encoder.gaps, &requested.text);
        write(path, text.as_bytes())?;
    }
    can_prove(args)
}

/// Checks that the prover of formulas is installed, if it is needed.
pub fn can_prove(args: &VerifyArgs) -> std::result::Result<(), Failure> {
    match args.drat {
        true => solver(),
        false => Ok(()),
    }
}

/// A file of a proof as it was written: path, contents, and the command that checks it.
pub type WrittenFile = (PathBuf, Vec<u8>, String);

/// The files of a proof.
pub type Written = Vec<WrittenFile>;

/// Writes proofs into folders, if requested: those of several properties into one folder each, `1` or `1-R1` by the
/// number of the property and its requirement. `None` stands for what was not proved. Returns what was written of each.
///
/// # Errors
///
/// A file cannot be written, or there is no proof of a formula because `cadical` is missing or fails.
pub fn proofs(
    args: &VerifyArgs,
    proofs: Vec<(Option<&str>, Option<Certificate>)>,
    time: Duration,
    cx: Context,
) -> std::result::Result<Vec<Written>, Failure> {
    let Some(folder) = &args.certificate else {
        return Ok(vec![Vec::new(); proofs.len()]);
    };
    if proofs.iter().all(|(_, files)| files.is_none()) {
        cx.note("     Nothing was proved, so no certificate is written");
        return Ok(vec![Vec::new(); proofs.len()]);
    }
    let is_single = proofs.len() == 1;
    let (mut all, mut formulas) = (Vec::new(), 0);
    for (number, (requirement, files)) in (1..).zip(proofs) {
        let files = files.unwrap_or_default();
        formulas += files.len();
        let own = match is_single {
            true => folder.to_path_buf(),
            false => folder.join(part(number, requirement)),
        };
        all.push(proof(args, &own, files, time)?);
    }
    let count = counted(formulas, "formula");
    let proofs = if args.drat { " with proofs" } else { "" };
    cx.note(&format!(
        "       Wrote {count}{proofs} into {}",
        folder.display()
    ));
    Ok(all)
}

/// Folder of a property among several.
fn part(number: usize, requirement: Option<&str>) -> String {
    let plain = |c: char| match c.is_ascii_alphanumeric() || c == '-' {
        true => c,
        false => '_',
    };
    match requirement {
        Some(id) => format!("{number}-{}", id.chars().map(plain).collect::<String>()),
        None => number.to_string(),
    }
}

/// Writes the formulas of a proof into a folder.
fn proof(
    args: &VerifyArgs,
    folder: &Path,
    files: Certificate,
    time: Duration,
) -> std::result::Result<Written, Failure> {
    let mut written = Vec::new();
    if !files.is_empty() {
        make_folder(folder)?;
    }
    for (name, text) in files {
        let path = folder.join(name);
        write_file(&path, text.as_bytes(), args.force)?;
        let shown = slashed(&path);
        written.push((path.clone(), text.into_bytes(), format!("{SOLVER} {shown}")));
        if args.drat {
            prove(&path, time, args.force)?;
            let proof = path.with_extension("drat");
            let bytes = std::fs::read(&proof).map_err(|error| at(&proof, error))?;
            let check = format!("drat-trim {shown} {}", slashed(&proof));
            written.push((proof, bytes, check));
        }
    }
    Ok(written)
}

/// A path with slashes, as documents have it.
pub fn slashed(path: &Path) -> String {
    path.display().to_string().replace('\\', "/")
}

/// The solver that writes proofs.
pub const SOLVER: &str = "cadical";

/// Failure to start the solver.
fn unstarted(error: &std::io::Error) -> Failure {
    Failure::Because(format!(
        "--drat: `{SOLVER}`, which makes the proofs, cannot be started: {error}; install it (Debian: `apt install \
         cadical`), or leave --drat out and prove the formulas with another solver"
    ))
}

/// Checks that the solver is installed.
fn solver() -> std::result::Result<(), Failure> {
    let version = Command::new(SOLVER).arg("--version").output();
    version.map(|_| ()).map_err(|error| unstarted(&error))
}

/// Has the solver prove a formula, in a file beside it.
fn prove(formula: &Path, time: Duration, force: bool) -> std::result::Result<(), Failure> {
    let proof = formula.with_extension("drat");
    permit(&proof, Kind::Refutation, force)?;
    let output = Command::new(SOLVER)
        .args(["-q", "--no-binary", "-t"])
        .arg(time.as_secs().max(1).to_string())
        .arg(formula)
        .arg(&proof)
        .output()
        .map_err(|error| unstarted(&error))?;
    /// Exit code of SAT solvers for a formula that cannot be satisfied.
    const UNSATISFIABLE: i32 = 20;
    if output.status.code() == Some(UNSATISFIABLE) {
        return Ok(());
    }
    // Half a proof is none.
    let _ = std::fs::remove_file(&proof);
    let stderr = String::from_utf8_lossy(&output.stderr);
    Err(Failure::Because(format!(
        "--drat: `{SOLVER}` does not prove {} ({}): {}",
        formula.display(),
        output.status,
        stderr.trim()
    )))
}
