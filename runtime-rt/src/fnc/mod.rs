//! One function per instruction, in files by the manual's families.

mod digits;

pub mod data;
pub mod float;
pub mod move_;
pub mod rotate;
