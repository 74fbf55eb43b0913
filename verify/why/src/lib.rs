//! Finds out why a device of a PLC program is on or off.
//!
//! [`Explainer::of_program`] lists what can switch a device. [`Explainer::at_moment`] looks on at the next scan of a
//! running program, which does not take place, and follows each bit back through the contacts to what the scan began
//! with: conditions that name instructions. From these come the smallest sets of contacts that keep the device as it
//! is, and so on for the devices of these contacts. What cannot be followed is named as such.
//!
//! [`Explainer::how`] searches for what a person can do so that the device changes.
//!
//! Start reading at [`Explainer`] (`explain.rs`), then `trace.rs` (a scan as conditions) and `sets.rs`.

mod answer;
mod causes;
mod explain;
mod graph;
mod history;
mod levers;
mod logic;
mod needs;
mod roots;
mod sets;
mod sites;
mod text;
mod trace;
mod ways;
mod words;

pub use answer::{Action, Cause, How, Link, Moment, Place, Progress, Reason, Since, Why, Writer};
pub use explain::Explainer;
pub use history::History;
pub use roots::Roots;
pub use ways::HowOptions;

#[cfg(test)]
mod tests;
