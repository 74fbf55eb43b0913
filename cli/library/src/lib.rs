//! Programs of FX-family PLCs in your own tools: open a project, check it, compile it to C or Rust, run it.
//!
//! ```
//! use rungc::Project;
//! use std::time::Duration;
//!
//! # fn main() -> Result<(), rungc::Error> {
//! # let folder = tempfile::tempdir().unwrap();
//! # let file = folder.path().join("motor.il");
//! # std::fs::write(&file, ";! X000 = Start\nLD X000\nOUT T0 K30\nLD T0\nOUT Y000\nEND\n").unwrap();
//! let project = Project::open(&file)?; // a list, an export, a GX Works2 project, a folder with rungc.toml
//! let checked = project.check();
//! for diagnostic in &checked.diagnostics {
//!     eprintln!("{diagnostic}");
//! }
//! let program = checked.compile()?;
//! for file in program.emit_c() {
//!     println!("{}: {} bytes", file.path, file.contents.len());
//! }
//! let mut plc = program.start();
//! plc.set("Start", true)?; // a comment of the program, or X000
//! plc.run_for(Duration::from_secs(2));
//! assert!(!plc.bit("Y000")?);
//! plc.run_for(Duration::from_secs(2));
//! assert!(plc.bit("Y000")?);
//! # Ok(())
//! # }
//! ```
//!
//! A [`Project`] is a program with the settings of its `rungc.toml`; [`Checked`] is what `rungc check` finds in it, as
//! data ([`Diagnostic`] is serialisable); a [`Program`] is compiled; a [`Plc`] runs one in virtual time, on the
//! reference interpreter, which all outputs are held to. What the parts below offer in addition is in their own crates:
//! `rungc-sim` (test files, machines), `rungc-verify` (certificates), `rungc-ladder` (drawings).
//!
//! Start reading at [`Project`].
#![deny(missing_docs)]

mod diagnostic;
pub mod document;
mod error;
pub mod explain;
pub mod fmu;
pub mod index;
pub mod language;
pub mod lists;
pub mod location;
pub mod mistakes;
pub mod monitor;
pub mod names;
pub mod other_model;
mod plc;
mod program;
mod project;
pub mod prove;
pub mod recompiled;
pub mod settings;
pub mod sources;
pub mod structured;
pub mod trace;
pub mod unproven;
pub mod watch;
pub mod why;
pub mod xref;

pub use diagnostic::{Diagnostic, Levels, Proposal, Related, Replacement};
pub use error::Error;
pub use language::Language;
pub use location::Location;
pub use names::Names;
pub use plc::{Plc, Snapshot, Value};
pub use program::Program;
pub use project::{Checked, Options, Project};
pub use rungc_emit::OutFile;
pub use rungc_frontend::Unsaved;
pub use rungc_syntax::Severity;
pub use rungc_why::{How, Why};

/// A code of diagnostics, `W0203`, or that of a name, `double-coil`, as [`Options`] takes it; `None` if there is none.
pub fn code(name: &str) -> Option<&'static str> {
    rungc_syntax::codes::find(name).map(|code| code.id)
}
