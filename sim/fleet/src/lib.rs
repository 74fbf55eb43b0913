//! Many PLCs in lock step: programs of which each may run any number of times, in one process with its children.
//!
//! [`format`] reads what `fleet.toml` says. A [`Group`] is one program and its PLCs on an [`Engine`]: emitted C that
//! runs them in [`children`], 64 at once where the program allows it, or interpreters ([`machines`]). A group sets
//! devices at given times ([`schedule`]) and serves its PLCs over TCP ([`served`]); a [`Broker`] connects the PLCs of
//! all groups.
//!
//! | file | what |
//! |---|---|
//! | `format.rs` | `fleet.toml`, every mistake with its place |
//! | `engine.rs` | what runs the PLCs of a group, and how their devices are addressed |
//! | `children.rs`, `children.c` | processes that run PLCs in emitted C, and what they are asked over a pipe |
//! | `build.rs`, `lanes.c`, `singles.c` | how these are built: 64 PLCs at once, or one after the other |
//! | `machines.rs` | interpreters |
//! | `schedule.rs` | which PLCs a setting reaches in a span of time |
//! | `served.rs` | Modbus TCP: a port for each PLC, or units of a port |
//! | `broker.rs` | topics of a broker |
//! | `group.rs` | one program and its PLCs |
//!
//! The crate must not know commands. Start reading at [`Group`].
#![deny(missing_docs)]

mod broker;
mod build;
mod children;
mod engine;
mod format;
mod group;
mod machines;
mod schedule;
mod served;

pub use broker::Broker;
pub use build::{Form, needs_runtime, refusal};
pub use children::Children;
pub use engine::{At, Engine, Failed, FleetError};
pub use format::{Choice, Fleet, Plcs, Topics, Written};
pub use group::Group;
pub use machines::Machines;
pub use schedule::{Schedule, Setting};
