//! Many PLCs in lock step: programs of which each may run any number of times, in one process with its children.
//!
//! [`format`] reads what `fleet.toml` says. A [`Group`] is one program and its PLCs on an [`Engine`]: emitted C that
//! runs 64 of them at once ([`lanes`]), or interpreters ([`machines`]). A group sets devices at given times
//! ([`schedule`]) and serves its PLCs over TCP ([`served`]); a [`Broker`] connects the PLCs of all groups.
//!
//! | file | what |
//! |---|---|
//! | `format.rs` | `fleet.toml`, every mistake with its place |
//! | `engine.rs` | what runs the PLCs of a group, and how their devices are addressed |
//! | `lanes.rs`, `lanes.c` | children that run 64 PLCs at once, and what they are asked over a pipe |
//! | `machines.rs` | interpreters |
//! | `schedule.rs` | which PLCs a setting reaches in a span of time |
//! | `served.rs` | Modbus TCP: a port for each PLC, or units of a port |
//! | `broker.rs` | topics of a broker |
//! | `group.rs` | one program and its PLCs |
//!
//! The crate must not know commands. Start reading at [`Group`].
#![deny(missing_docs)]

mod broker;
mod engine;
mod format;
mod group;
mod lanes;
mod machines;
mod schedule;
mod served;

pub use broker::Broker;
pub use engine::{At, Engine, Trouble};
pub use format::{Choice, Fleet, Plcs, Topics, Written};
pub use group::Group;
pub use lanes::Lanes;
pub use machines::Machines;
pub use schedule::{Schedule, Setting};
