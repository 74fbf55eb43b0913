//! Exports for other programs: the question, or the proof.

use crate::args::VerifyArgs;
use crate::commands::properties::RequestedProperty;
use crate::commands::{Context, Failure, counted};
use crate::output::{Kind, make_folder, permit, write_file};
use rungc_ir::Module;
use rungc_verify::certificate::Certificate;
use rungc_verify::prove::{Options, system};
use rungc_verify::{aiger, btor2};
use std::path::Path;
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
    if args.certificate.is_some() {
        only("--certificate")?;
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

/// Writes proofs into a folder, if requested; `None`: nothing was proved.
///
/// # Errors
///
/// A file cannot be written, or there is no proof of a formula because `cadical` is missing or fails.
pub fn proofs(
    args: &VerifyArgs,
    files: Option<Certificate>,
    time: Duration,
    cx: Context,
) -> std::result::Result<(), Failure> {
    let Some(folder) = &args.certificate else {
        return Ok(());
    };
    let Some(files) = files else {
        cx.note("     Nothing was proved, so no certificate is written");
        return Ok(());
    };
    make_folder(folder)?;
    for (name, text) in &files {
        let path = folder.join(name);
        write_file(&path, text.as_bytes(), args.force)?;
        if args.drat {
            prove(&path, time, args.force)?;
        }
    }
    let count = counted(files.len(), "formula");
    let proofs = if args.drat { " with proofs" } else { "" };
    cx.note(&format!(
        "       Wrote {count}{proofs} into {}",
        folder.display()
    ));
    Ok(())
}

/// The solver that writes proofs.
const SOLVER: &str = "cadical";

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
