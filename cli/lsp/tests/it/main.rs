//! The server over a connection in memory, as an editor talks to it.

mod client;
mod features;
mod fuzz;
mod large;
mod sync;
