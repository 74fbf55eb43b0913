//! Compatibility of the options of `rungc build`.

use super::Failure;
use crate::args::{Backend, Emit, Format, Plan, Reporting};
use rungc_firmware::target::{self, Target};

/// The target, if the options go together.
pub(super) fn fitting(
    args: &Plan,
    reporting: &Reporting,
) -> std::result::Result<&'static Target, Failure> {
    let wrong = |why: &str| Err(Failure::Because(why.to_string()));
    form_fits(args, reporting).map_err(Failure::Because)?;
    let target = args.target.unwrap_or(target::host());
    let Some(emit) = args.emit else {
        return Ok(target);
    };
    match emit {
        Emit::Ir if args.main => wrong("--main does not apply: the IR has no main program"),
        _ if args.backend.is_some() && !emit.is_image() => {
            wrong("--backend only applies to --emit elf and --emit uf2")
        }
        Emit::Elf | Emit::Uf2 if args.report && args.backend == Some(Backend::Rust) => {
            wrong("--report measures C; it does not apply here")
        }
        Emit::Ir | Emit::Rust if args.report => {
            wrong("--report measures C; it does not apply here")
        }
        Emit::Ir if args.target.is_some() => {
            wrong("--target does not apply: the IR is the same for all targets")
        }
        Emit::Ir
        | Emit::Bin
        | Emit::Lib
        | Emit::Arduino
        | Emit::Platformio
        | Emit::Zephyr
        | Emit::EspIdf
        | Emit::Fmu
            if args.board.is_some() =>
        {
            wrong(
                "--board only applies to --emit elf and --emit uf2 (an image), --emit c and --emit rust (its sources)",
            )
        }
        Emit::Elf if args.board.is_none() => wrong(&NO_BOARD.replace("IMAGE", "elf")),
        Emit::Uf2 if args.board.is_none() => wrong(&NO_BOARD.replace("IMAGE", "uf2")),
        Emit::Bin | Emit::Elf | Emit::Uf2 | Emit::Ir | Emit::Rust | Emit::Fmu
            if args.device_access =>
        {
            wrong(
                "--device-access only applies to --emit c and --emit lib; emitted Rust has the trait `Plc` for this",
            )
        }
        Emit::C if args.device_access && args.board.is_some() => wrong(
            "--device-access does not apply to the sources of an image; emit the program without --board",
        ),
        Emit::Bin | Emit::Elf | Emit::Uf2 | Emit::Ir | Emit::Rust | Emit::Fmu if args.retain => {
            wrong("--retain only applies to --emit c and --emit lib (`rungc book retain`)")
        }
        Emit::C if args.retain && args.board.is_some() => wrong(
            "--retain does not apply to the sources of an image: describe its flash as `[retain]` of the board (`rungc book retain`)",
        ),
        Emit::Bin | Emit::Lib | Emit::Elf | Emit::Uf2 | Emit::Ir | Emit::Rust | Emit::Fmu
            if args.lanes.is_some() =>
        {
            wrong("--lanes only applies to --emit c (`rungc book lanes`)")
        }
        Emit::C if args.lanes.is_some() && args.board.is_some() => wrong(
            "--lanes does not apply to the sources of an image; emit the program without --board",
        ),
        _ if args.misra && (args.board.is_some() || !emit.has_headers() || emit == Emit::Lib) => {
            wrong("--misra only applies to emitted C without --board (`rungc book builds`)")
        }
        _ if args.defmt && (emit != Emit::Rust || args.board.is_some()) => {
            wrong("--defmt only applies to --emit rust without --board (`rungc book builds`)")
        }
        _ if args.runtime.is_some() && emit != Emit::Rust => {
            wrong("--runtime only applies to --emit rust (`rungc book embedding`)")
        }
        _ => main_fits(emit, args, target),
    }
}

/// Returns an error for options that go with other forms.
fn form_fits(args: &Plan, reporting: &Reporting) -> std::result::Result<(), String> {
    if args.report && !matches!(reporting.format, Format::Human | Format::Json) {
        return Err(
            "--report is only available as text and as JSON; use --format json".to_string(),
        );
    }
    let is_written = |emit: Emit| match emit {
        Emit::Ir | Emit::C | Emit::Rust => !args.report,
        _ => emit.package().is_some(),
    };
    if !args.cargo_arg.is_empty() && args.emit.is_some_and(is_written) {
        return Err(
            "--cargo-arg only applies to what is built here; sources are only written".to_string(),
        );
    }
    match args.sources_only && args.emit.is_some_and(|emit| emit != Emit::Fmu) {
        true => Err("--sources-only only applies to --emit fmu (`rungc book fmu`)".to_string()),
        false => Ok(()),
    }
}

/// The target, if options of main programs go with what is emitted.
fn main_fits(
    emit: Emit,
    args: &Plan,
    target: &'static Target,
) -> std::result::Result<&'static Target, Failure> {
    let wrong = |why: &str| Err(Failure::Because(why.to_string()));
    match emit {
        _ if args.servers && !matches!(emit, Emit::C | Emit::Rust | Emit::Bin) => wrong(NO_SERVERS),
        Emit::C | Emit::Rust if args.servers && !args.main => wrong(NO_SERVERS),
        _ if args.io && !matches!(emit, Emit::C | Emit::Rust | Emit::Bin) => wrong(NO_IO),
        Emit::C | Emit::Rust if args.io && !args.main => wrong(NO_IO),
        Emit::Bin if target.is_bare() => {
            wrong("--emit bin: the target has no operating system; use --emit elf for an image")
        }
        _ if args.main && args.board.is_some() => wrong(
            "--main does not apply: an image has its own main program, generated from the board's description",
        ),
        Emit::Fmu if args.main => {
            wrong("--main does not apply: importers run a functional mock-up unit")
        }
        Emit::Lib if args.main => wrong("--main does not apply: a library has no main program"),
        _ if args.main && emit.package().is_some() => {
            wrong("--main does not apply: the folder has an example that runs the program")
        }
        _ => Ok(target),
    }
}

/// Message for an image without a board.
const NO_BOARD: &str =
    "--emit IMAGE needs --board, a description of the board (`rungc book boards`)";

/// Message for `--servers` where it does not apply.
const NO_SERVERS: &str =
    "--servers only applies to --emit bin, and to --emit c and --emit rust with --main";

/// Message for `--io` where it does not apply.
const NO_IO: &str = "--io only applies to --emit bin, and to --emit c and --emit rust with --main";
