//! Servers of a PLC over TCP: Modbus, MC protocol, the programming port's protocol.
//!
//! A [`Dialogue`] is what one connection has said so far and is answered; it knows no network. A [`Server`] has the
//! connections of one address, [`Servers`] are those of a program, and [`Clients`] ask other servers. They work only
//! when polled, between two scans, so a frame's writes reach the program together.
//!
//! None of these protocols knows a password: whoever reaches the address reads and writes every device. Hence servers
//! bind to the loopback address by default.

mod all;
mod clients;
mod dialogue;
mod server;
#[cfg(test)]
mod tests;

pub use all::{Servers, Switch, after, cannot_serve, full, switched, switched_by_line};
pub use clients::{ClientFrame, Clients};
pub use dialogue::{Dialogue, Exchange, Reaction};
pub use server::{Limits, Server, ServerEvent};
