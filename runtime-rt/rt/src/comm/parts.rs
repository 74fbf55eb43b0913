//! Components of a port in a program's memory.

use super::can::CanTurn;
use super::computer_link::Remote;
use super::free::Free;
use super::line::LineFormat;
use super::link::Link;
use super::modbus::Exchange;
use super::port::FRAME;
use super::{Memory, Protocol};

/// State of a port.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct Status {
    /// Protocol that it speaks.
    pub protocol: Protocol,
    /// The first scan in RUN is over: what the port speaks stays until STOP.
    pub bound: bool,
    /// Characters of a frame have come, and the silence that ends it has not.
    pub open: bool,
    /// A character of the frame was wrong: it is not answered.
    pub spoiled: bool,
    /// A frame is being sent, or waits to be.
    pub sending: bool,
    /// RUN and STOP by computer link.
    pub remote: Remote,
    /// The bit rate that a partner has requested instead of the protocol's own, in hundreds of bits per second; 0: none
    /// has.
    pub rate: u16,
    /// Setup by UINIT: protocol and station, format, first register of the work area.
    pub uinit: [u16; 3],
    /// Characters received.
    pub received: u16,
    /// Characters to send.
    pub to_send: u16,
    /// Characters of them that the hardware has taken.
    pub taken: u16,
    /// The last settings of the hardware.
    pub format: LineFormat,
    /// Time of the last received character.
    pub last_us: u32,
    /// Time at which a frame begins to be sent.
    pub due_us: u32,
}

impl Status {
    /// A port that has not been set up.
    pub const fn new() -> Self {
        Status {
            protocol: Protocol::Off,
            bound: false,
            open: false,
            spoiled: false,
            sending: false,
            remote: Remote::new(),
            rate: 0,
            uinit: [0; 3],
            received: 0,
            to_send: 0,
            taken: 0,
            format: LineFormat {
                data_bits: 0,
                stop_bits: 0,
                ..LineFormat::new()
            },
            last_us: 0,
            due_us: 0,
        }
    }
}

/// Progress of the protocols that do more than answer: those of instructions, and links. All zero is a beginning.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct Progress {
    /// RS, RS2, USEND, URCV.
    pub free: Free,
    /// Links between PLCs.
    pub link: Link,
    /// Instruction that waits for a frame on CAN.
    pub can: CanTurn,
    /// Instructions of a Modbus master.
    pub exchange: Exchange,
}

impl Progress {
    /// As each of them begins.
    pub const fn new() -> Self {
        Progress {
            free: Free::new(),
            link: Link::new(),
            can: CanTurn::new(),
            exchange: Exchange::new(),
        }
    }
}

/// A serial port in a program's memory, with room for a frame of `LENGTH` characters, for the progress of its protocols
/// and for what they keep from one frame to the next: [`Progress`] and [`Memory`], each or [`Without`]. All zero is one
/// that has not been set up.
#[derive(Clone, Debug)]
#[repr(C)]
pub struct Port<const LENGTH: usize = FRAME, P = Progress, K = Memory> {
    /// State of the port.
    pub status: Status,
    /// Progress of its protocols.
    pub progress: P,
    /// The frame that is received or sent.
    pub buffer: [u8; LENGTH],
    /// State of a slave between frames.
    pub memory: K,
}

/// A part that none of the port's protocols needs.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Without;

/// A part of a port that only some protocols need: it, or [`Without`].
pub trait Part<T> {
    /// As it begins.
    const NEW: Self;

    /// The part, if it is there.
    fn get(&mut self) -> Option<&mut T>;
}

impl<T> Part<T> for Without {
    const NEW: Self = Without;

    fn get(&mut self) -> Option<&mut T> {
        None
    }
}

impl Part<Progress> for Progress {
    const NEW: Self = Progress::new();

    fn get(&mut self) -> Option<&mut Progress> {
        Some(self)
    }
}

impl Part<Memory> for Memory {
    const NEW: Self = Memory::new();

    fn get(&mut self) -> Option<&mut Memory> {
        Some(self)
    }
}

impl<const LENGTH: usize, P: Part<Progress>, K: Part<Memory>> Default for Port<LENGTH, P, K> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const LENGTH: usize, P: Part<Progress>, K: Part<Memory>> Port<LENGTH, P, K> {
    /// A port that has not been set up.
    pub const fn new() -> Self {
        Port {
            status: Status::new(),
            progress: P::NEW,
            buffer: [0; LENGTH],
            memory: K::NEW,
        }
    }

    /// The port, whatever it has room for.
    pub fn parts(&mut self) -> PortMut<'_> {
        PortMut {
            status: &mut self.status,
            progress: self.progress.get(),
            buffer: &mut self.buffer,
            memory: self.memory.get(),
        }
    }
}

/// A serial port in a program's memory, whatever it has room for.
#[derive(Debug)]
pub struct PortMut<'a> {
    /// State of the port.
    pub status: &'a mut Status,
    /// Progress of its protocols, if they do more than answer.
    pub progress: Option<&'a mut Progress>,
    /// The frame that is received or sent.
    pub buffer: &'a mut [u8],
    /// State of a slave between frames, if its protocols have any.
    pub memory: Option<&'a mut Memory>,
}
