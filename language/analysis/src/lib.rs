//! Analysis of a program before it is compiled, with all diagnostics.
//!
//! [`resolve`] gives every instruction its catalogue row, form and step number, and holds its operands to the row;
//! [`check`] looks at the program as a whole; [`xref`] lists the uses of each device; [`latches`] applies the project's
//! choice of latched devices; [`fitting`] finds the instructions that an unknown code may stand for. This crate knows
//! neither the IR nor output languages. Start reading at [`resolve::resolve`].

mod accesses;
pub mod check;
pub mod fitting;
pub mod latches;
pub mod resolve;
pub mod xref;
