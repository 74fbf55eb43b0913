//! Numbers of the special relays and registers that instructions touch; the catalogue tells the rest of their story.

/// Zero flag.
pub const M_ZERO: u32 = 8020;
/// Borrow flag.
pub const M_BORROW: u32 = 8021;
/// Carry flag.
pub const M_CARRY: u32 = 8022;
/// BMOV's direction.
pub const M_BMOV_REVERSE: u32 = 8024;
/// Execution complete.
pub const M_COMPLETE: u32 = 8029;
