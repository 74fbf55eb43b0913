//! Sessions of the adapter with a client over pipes.

mod client;
mod hostile;
mod sessions;
