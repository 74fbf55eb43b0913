//! Servers of a PLC over TCP: Modbus, MC protocol, the programming port's protocol.
//!
//! A [`Dialogue`] is what one connection has said so far and is answered; it knows no network. A [`Server`] has the connections of one
//! address. Both work only when they are asked to, between two scans, so a frame's writes reach the program together.
//!
//! What goes over them, and over serial ports, is decoded ([`Decoder`]) and counted ([`Traffic`]).
//!
//! None of these protocols knows a password: whoever reaches the address reads and writes every device. Hence servers bind to the loopback
//! address by default.

mod decode;
mod dialogue;
mod probe;
mod server;
#[cfg(test)]
mod tests;
mod traffic;

pub use decode::{Decoded, Decoder, Direction, Speech};
pub use dialogue::{Dialogue, Exchange, Reaction, Service};
pub use server::Server;
pub use traffic::{Place, Seen, Traffic};
