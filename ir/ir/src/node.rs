//! The typed IR. The docs of this module are the specification that the interpreter and both backends are held to.
//!
//! A [`Module`] is a program: an arena of [`Expr`]s, [`Function`]s whose [`Body`]s are [`Stmt`]s, and what these name
//! by handles. Each variant says what it does; this page says when.
//!
//! # Values
//!
//! Integers are two's complement and wrap. `I16` values are signed 16-bit, `I32` signed 32-bit, `F32` IEEE single,
//! `Bit` true or false. Types are never converted silently: [`Expr::Widen`], [`Expr::Narrow`] and similar expressions
//! say so. An operand comes before the expression that uses it in the arena, so that one walk from the front meets
//! operands first.
//!
//! # Devices
//!
//! What a program reads and writes of its devices is one notion, an [`Access`]: a [`Place`], with or without an index,
//! and what of it, from a bit to several bit devices as a number. [`Expr::Read`] has the access's type,
//! [`Action::Write`] takes a value of it. Coils of timers and counters, [`Action::Reset`], and calls of the runtime
//! access devices, too; [`crate::reach`] says for all of them which ones.
//!
//! # Order
//!
//! Statements are executed in order, and each is over before the next one begins. A statement evaluates all of its
//! expressions when it is executed, before it writes anything. Expressions have no effects, but they read devices,
//! flags, cells and temporaries as these are at that moment. So an expression that two statements name is evaluated
//! twice, and may give two values: a backend never keeps its value from one to the other, and moves a read across a
//! write only where it can tell that they do not meet. Both operands of [`Expr::And`] and [`Expr::Or`] are evaluated;
//! since they have no effects, a backend may leave one out.
//!
//! What would be undefined is kept out by the program itself: a divisor is tested before the division, an index by
//! [`Expr::InRange`] before the access. Faults are [`Action::Fault`] or come from the runtime; they never leave a
//! function.
//!
//! # Temporaries
//!
//! A value that is needed later as it is now is a temporary: [`Action::Let`], [`Action::Edge`] or [`Action::Fetch`]
//! assigns it, [`Expr::Temp`] reads it. It lives in one function, is assigned on every path before it is read, and
//! holds the last value that was assigned. Where it is kept, as a local, in a field, or nowhere because its only use
//! can stand in its place, is up to a backend.
//!
//! # What lasts
//!
//! Devices last from scan to scan, as [`crate::layout`] stores them. So do edge memories, [`Flag`]s, [`Cell`]s,
//! [`Table`]s and the runtime's private memories ([`Action::Call`]); what each of them is when RUN begins is beside it.
//! Nothing else lasts.
//!
//! # Grids
//!
//! Rungs that the program repeats with other devices are one [`Stmt::Repeat`]. In its body a place whose index is an
//! [`Expr::Stride`] leads to the device of the iteration at hand. These devices lie in a [`crate::layout::Grid`],
//! column by column, so no range check is needed. The iterations run in order, each to its end, as the rungs that they
//! stand for would.
//!
//! # Scans and interrupts
//!
//! A scan runs the functions [`FunctionKind::Begin`], [`FunctionKind::Main`] and [`FunctionKind::End`]; in STOP only
//! `Begin`. Nothing else runs meanwhile. What happens outside, an edge of an input or a period of time, sets flags or
//! runs a function [`FunctionKind::InputEdge`] between two scans; an interrupt routine runs where the program calls
//! [`FunctionKind::TakeInterrupts`], at the start of networks for the most part, and as a whole. So a statement never
//! sees a device change under it, and all engines interrupt a program at the same places. A call whose effect nothing
//! can notice up to the next one is left out.
//!
//! # The watchdog
//!
//! A scan that does not end is cut short: [`Stmt::Watch`] is in all loops except those that are known to be short, and
//! at all jumps back, and counts the steps of the program that they repeat. After the last one the function is left,
//! and so is each that called it, up to `Main`; `End` does nothing. If an interrupt routine is cut short, the scan
//! continues to its end.

mod access;
mod expr;
mod handle;
mod module;
mod ops;
mod stmt;

pub use access::*;
pub use expr::*;
pub use handle::*;
pub use module::*;
pub use ops::*;
pub use stmt::*;
