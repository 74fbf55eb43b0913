//! Runs on emitted C and Rust before they are reported.

use crate::args::EngineChoice;
use crate::commands::test::{BuildFolder, engines};
use crate::commands::{Context, Failure};
use crate::progress;
use rungc_ir::Module;
use rungc_sim::engines::{BuildError, EngineKind, build};
use rungc_syntax::DeviceClass;
use rungc_verify::engines::compare;
use rungc_verify::prove::Why;
use rungc_verify::search::Trace;
use std::collections::BTreeMap;

/// A run that the interpreter has shown.
pub struct Shown<'a> {
    /// Number of the property or the output.
    pub what: usize,
    /// The program, by number.
    pub program: usize,
    /// The devices that are compared after every scan.
    pub devices: Vec<(DeviceClass, u32)>,
    pub trace: &'a Trace,
}

/// Result of replaying runs.
pub struct Replayed {
    /// Names of the engines that have run them.
    pub engines: Vec<&'static str>,
    /// For each run that one of them does not confirm, by the number of the property or output: the reason.
    pub differing: BTreeMap<usize, Why>,
}

/// Replays runs on the engines chosen, if there are others than the interpreter. The first engine that does otherwise
/// makes the difference.
///
/// # Errors
///
/// An engine that was named cannot be built.
pub fn replay(
    choice: Option<EngineChoice>,
    modules: &[Module],
    runs: &[Shown],
    cx: Context,
) -> Result<Replayed, Failure> {
    let mut differing = BTreeMap::new();
    let mut ran = vec![EngineKind::Interp.name()];
    let kinds = engines(choice.unwrap_or(EngineChoice::Interp)).into_iter();
    let kinds: Vec<EngineKind> = kinds.filter(|kind| *kind != EngineKind::Interp).collect();
    if runs.is_empty() || kinds.is_empty() {
        return Ok(Replayed {
            engines: ran,
            differing,
        });
    }
    let folder = BuildFolder::take()?;
    for kind in kinds {
        let built = progress::spin("building the engine", || {
            build(kind, modules, folder.path())
        });
        let mut engine = match (built, choice) {
            (Ok(engine), _) => engine,
            // This engine was not requested by name, and its compiler is not there.
            (Err(error), Some(EngineChoice::All)) if lacks_tool(kind, &error) => {
                let name = kind.name();
                cx.note(&format!(
                    "    Not replayed on {name}: {}",
                    first_line(&error)
                ));
                continue;
            }
            (Err(error), _) => return Err(Failure::Because(error.to_string())),
        };
        ran.push(kind.name());
        for run in runs {
            let module = (run.program, &modules[run.program]);
            if let Err(why) = compare(engine.as_mut(), module, &run.devices, run.trace) {
                let difference = format!("replaying the run on {}: {why}", kind.name());
                differing
                    .entry(run.what)
                    .or_insert(Why::Engines { difference });
            }
        }
    }
    Ok(Replayed {
        engines: ran,
        differing,
    })
}

/// Returns true if a tool is missing, as opposed to a fault of the emitted code.
fn lacks_tool(kind: EngineKind, error: &BuildError) -> bool {
    let runs = |tool: &str| {
        let mut command = std::process::Command::new(tool);
        command
            .arg("--version")
            .output()
            .is_ok_and(|output| output.status.success())
    };
    match (error, kind) {
        (BuildError::Io { .. }, _) => true,
        (BuildError::Tool { .. }, EngineKind::C) => {
            !runs(&std::env::var("CC").unwrap_or_else(|_| "cc".to_string())) || !runs("make")
        }
        (BuildError::Tool { .. }, _) => !runs("cargo") || !runs("rustc"),
    }
}

fn first_line(error: &BuildError) -> String {
    let text = error.to_string();
    text.lines()
        .next()
        .unwrap_or_default()
        .trim_end_matches(':')
        .to_string()
}
