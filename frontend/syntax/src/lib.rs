//! Source text, the program as its author wrote it, and diagnostics.
//!
//! This crate is what the readers of file formats (`rungc-frontend`) and the compiler proper share. It must not know
//! file formats, the models, or what an instruction computes. Start reading at [`Program`], then [`Diagnostic`] and
//! [`codes`].

pub mod align;
mod classes;
pub mod codes;
mod device;
pub mod diag;
pub mod family;
pub mod inputs;
mod phrase;
mod program;
mod source;
pub mod text;
pub mod toml_words;

pub use classes::Classes;
pub use device::{DeviceClass, Number};
pub use diag::{Diagnostic, Diagnostics, Edit, Fix, Label, Severity};
#[doc(hidden)]
pub use phrase::fits;
pub use phrase::{Argument, Phrase, Say};
pub use program::{
    Device, DeviceRun, FittedModule, Index, Instr, NetworkRequest, Operand, OperandKind, Operands,
    Parameters, Program, Remarks, SourceKind,
};
pub use source::{Part, Source, Span};
