//! Selection of the engine for a group's PLCs, with the reason.

use crate::commands::build::announced;
use crate::commands::{Context, Failure};
use rungc_codegen_c::lanes;
use rungc_firmware::build::{BuildError, Tools};
use rungc_firmware::target;
use rungc_fleet::{Children, Choice, Engine, FleetError, Form, Plcs, needs_runtime, refusal};
use rungc_ir::Module;
use std::path::{Path, PathBuf};

/// From how many PLCs on a program is worth the C compiler.
const WORTH_COMPILING: u32 = 8;

/// From how many on it is worth the runtime library, which takes a minute the first time.
const WORTH_LIBRARY: u32 = 64;

/// Engine chosen for a group.
pub struct Chosen<'m> {
    /// Emitted C; `None`: interpreters.
    pub engine: Option<Box<dyn Engine + 'm>>,
    /// Reason why it is nothing faster; `None` if there is none to report.
    pub why: Option<String>,
}

/// Emitted C that a group may run in, and why it is nothing faster.
enum Suits {
    Lanes,
    Singles(Option<String>),
    /// Interpreters have to run it.
    None(Option<String>),
}

/// Chooses an engine for a group, and starts it if that is emitted C, which is built in a folder.
pub fn choose<'m>(
    plcs: &Plcs,
    module: &'m Module,
    folder: &Path,
    cx: Context,
) -> Result<Chosen<'m>, Failure> {
    let none = |why| Ok(Chosen { engine: None, why });
    let (form, why) = match suits(plcs, module) {
        Suits::None(why) => return none(why),
        Suits::Lanes => (Form::Lanes, None),
        Suits::Singles(why) => match runtime(module, folder, cx) {
            Ok(runtime) => (Form::Singles { runtime }, why),
            Err(BuildError::Missing(missing)) => return none(Some(missing)),
            Err(error) => return Err(Failure::Because(error.to_string())),
        },
    };
    match Children::start(module, plcs.count, folder, form) {
        Ok(children) => Ok(Chosen {
            engine: Some(Box::new(children)),
            why,
        }),
        Err(FleetError::Io { what, error }) if what == "cc" => {
            none(Some(format!("the C compiler `cc` does not start: {error}")))
        }
        Err(error) => Err(Failure::Because(error.to_string())),
    }
}

fn suits(plcs: &Plcs, module: &Module) -> Suits {
    let by_lanes = lanes::refusal(module).map(|why| format!("the program {why}"));
    let small = |worth: u32| plcs.engine == Choice::Auto && plcs.count < worth;
    match (plcs.engine, by_lanes) {
        (Choice::Interp, _) => Suits::None(None),
        (Choice::Auto | Choice::Lanes, None) if small(WORTH_COMPILING) => {
            Suits::None(Some(format!(
                "fewer than {WORTH_COMPILING} PLCs are not worth the C compiler, unless engine = \"lanes\""
            )))
        }
        (Choice::Auto | Choice::Lanes, None) => Suits::Lanes,
        (Choice::Lanes, why) => Suits::None(why),
        (Choice::Auto | Choice::C, by_lanes) => {
            let worth = match needs_runtime(module) {
                true => WORTH_LIBRARY,
                false => WORTH_COMPILING,
            };
            match (refusal(module), by_lanes) {
                (Some(why), _) => Suits::None(Some(format!("the program {why}"))),
                (None, Some(why)) if small(worth) => Suits::None(Some(format!(
                    "{why}, and fewer than {worth} PLCs are not worth building it, unless engine = \"c\""
                ))),
                (None, why) => Suits::Singles(why.filter(|_| plcs.engine == Choice::Auto)),
            }
        }
    }
}

/// The runtime library for this machine, if the program calls it.
fn runtime(module: &Module, folder: &Path, cx: Context) -> Result<Option<PathBuf>, BuildError> {
    if !needs_runtime(module) {
        return Ok(None);
    }
    let tools = announced(Tools::new(target::host(), &[]), cx);
    tools.runtime(folder).map(Some)
}
