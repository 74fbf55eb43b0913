//! Storms of frames on bad lines.
//!
//! A storm sends many frames to one PLC ([`storm::run`]), a tenth of them bad; `src/bin/storm.rs` runs as many as it is told to.

pub mod partner;
pub mod plc;
pub mod random;
pub mod storm;
pub mod text;
