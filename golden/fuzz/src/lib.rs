//! Fuzz targets of everything that reads what others have written, and storms of frames on bad lines.
//!
//! A target is a function on bytes that panics if something is wrong. `tests/it/targets.rs` runs each of them on its
//! corpus (`corpus/`) and for a short random campaign; `libfuzzer/` runs one under libFuzzer. A storm sends many frames
//! to one PLC, a tenth of them bad; `src/bin/storm.rs` runs storms of any length. Start reading at [`targets::all`] and
//! [`storm::run`].

pub mod partner;
pub mod plc;
pub mod random;
pub mod storm;
pub mod targets;
pub mod text;
