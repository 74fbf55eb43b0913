//! The adapter under a client of its own, over pipes.

mod client;
mod hostile;
mod sessions;
