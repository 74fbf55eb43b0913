//! One function per instruction, in files by the manual's families.

pub mod data;
