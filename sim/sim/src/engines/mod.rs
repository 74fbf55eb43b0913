//! The ways to execute compiled programs, with one interface.

mod build;
#[cfg(feature = "cortex-m")]
pub mod cortex_m;
mod interpreter;
mod piped;
mod process;

pub use build::{
    BuildError, EngineKind, Ready, build, build_c_with, build_c_with_parts, build_with_main,
    host_runtime, prepare,
};
pub use interpreter::{Interpreter, Observers};
pub use piped::Piped;
pub use process::Process;

use crate::protocol::{Answer, Request};

/// Something that executes compiled programs: [`Request::Case`] chooses one of those that it was made with.
pub trait Engine {
    /// Its name on the command line: `interp`, `c`, `rust`.
    fn name(&self) -> &str;

    /// Executes a request. Requests that ask for no value may be answered [`Answer::Ok`] before they are carried out;
    /// what went wrong is then the answer to the next one that does.
    fn execute(&mut self, request: Request) -> Result<Answer, EngineError>;

    /// The answers to many requests that ask for values.
    fn execute_all(&mut self, requests: &[Request]) -> Result<Vec<Answer>, EngineError> {
        requests
            .iter()
            .map(|&request| self.execute(request))
            .collect()
    }
}

/// Error of an engine.
#[derive(Debug, thiserror::Error)]
pub enum EngineError {
    /// The batch has no such program.
    #[error("no program {0}")]
    NoProgram(usize),
    /// The executable could not be started.
    #[error("cannot start {command}: {error}")]
    Start {
        /// Its path.
        command: String,
        /// The underlying I/O error.
        error: std::io::Error,
    },
    /// The executable ended before it answered.
    #[error("the executable ended at `{0}` ({1})")]
    Ended(Request, String),
    /// The executable did not answer in time.
    #[error("no answer to `{0}`: a scan does not end")]
    Silent(Request),
    /// A scan with WDT does not end.
    #[error("a scan does not end: WDT restarts the watchdog more than {0} times")]
    Endless(u32),
    /// Unexpected output of the executable.
    #[error("unexpected answer to `{0}`: `{1}`")]
    Garbled(Request, String),
    /// A client connects to what the case does not serve.
    #[error("{0}")]
    Unserved(String),
    /// A device, module or channel to be set does not exist.
    #[error("`{0}`: no such device")]
    Missing(Request),
}

impl std::fmt::Debug for dyn Engine + '_ {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Engine({})", self.name())
    }
}
