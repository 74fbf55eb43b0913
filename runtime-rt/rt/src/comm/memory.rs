//! State of a slave between frames.

/// Bytes of a monitor list of the programming port, which needs the most.
pub const SIZE: usize = 0x390;

/// State of a slave between frames: the monitor list of the programming port, or the blocks of QLink. A port speaks one
/// protocol at a time, so they share it. All zero is nothing.
#[derive(Clone, Debug)]
#[repr(C)]
pub struct Memory(pub(super) [u8; SIZE]);

impl Default for Memory {
    fn default() -> Self {
        Self::new()
    }
}

impl Memory {
    /// Nothing is kept, as at power-on.
    pub const fn new() -> Self {
        Memory([0; SIZE])
    }
}
