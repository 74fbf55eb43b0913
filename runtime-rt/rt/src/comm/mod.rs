//! Communications: what other machines ask of a PLC over its ports, and what it asks of them.
//!
//! # Layers
//!
//! ```text
//!  SerialPort (HAL) ── line.rs ── port.rs ─┬─ free.rs                  instructions of the program
//!  bytes, time stamps  characters  state   ├─ slave codecs ── Map ──── the PLC's devices
//!                      and gaps    machine └─ master codecs ─ Map
//! ```
//!
//! A port is advanced when a scan begins and ends and at ticks, never inside a scan; so what a codec writes reaches the
//! devices between two scans. Nothing here allocates, blocks or panics, and the work of one call is bounded by the
//! longest frame.
//!
//! # The contract of codecs
//!
//! A codec is a pure function on bytes and devices: it knows no port, no time and no special device but those that its
//! protocol defines.
//!
//! * **Framing**: `fn cut(received: &[u8]) -> Cut` says after each character whether the characters so far are a whole
//!   frame ([`Cut`]). Protocols whose frames end by silence (Modbus RTU) have none: the port waits for 3.5 characters
//!   of silence.
//! * **Slaves** answer: `fn answer(settings: &Settings, request: &[u8], map: &mut dyn Map, reply: &mut Frame) ->
//!   Result<(), LineFault>`. `request` is one frame as [`Cut`] or the silence ended it. The reply is what `reply`
//!   holds; an empty one is silence. `Err` says what the port notes in the PLC's error register (D8063 and similar
//!   registers); the reply is sent all the same. A codec checks a request whole before it writes the first device, and
//!   writes nothing where it rejects.
//! * **Masters** ask: `fn request(job, map: &dyn Map, frame: &mut Frame) -> Result<(), LineFault>` makes the request of
//!   a job, and `fn accept(job, reply: &[u8], map: &mut dyn Map) -> Result<(), LineFault>` takes the answer; retries,
//!   time-outs and whose turn it is are the port's.
//!
//! Settings (station, format, what the model serves) are plain values that the port makes of the program's registers
//! for each frame (`slaves.rs`); so a change of the station number in RUN is live.
//!
//! # Files
//!
//! | file | what |
//! |---|---|
//! | `map.rs` | [`Map`]: the PLC's devices as codecs see them |
//! | `elements.rs` | [`Places`]: registers and coils, by the devices of a [`Map`] or where a program stores them |
//! | `mode.rs` | RUN and STOP as partners switch them |
//! | `memory.rs` | [`Memory`]: what a slave keeps from one frame to the next |
//! | `frame.rs` | [`Frame`]: a buffer of fixed capacity; digits and sums |
//! | `line.rs` | format words, character times, line errors |
//! | `wiring.rs` | the special devices of each model's ports, and what chooses their protocols |
//! | `parts.rs` | [`Port`]: what a port consists of in memory |
//! | `port.rs` | the state machine of one port |
//! | `port_protocol.rs` | the protocol side of a port: all protocols that a program links, or less |
//! | `slave_alone.rs` | a port that is nothing but a slave by Modbus RTU |
//! | `codec.rs` | what a port does under each protocol: the table of which a program links what it may need |
//! | `protocols.rs` | sets of protocols, and how much memory they take |
//! | `slaves.rs` | how the codecs that answer are set up |
//! | `free.rs` | RS, RS2, USEND, URCV |
//! | `masters.rs` | a port as a Modbus master |
//! | `modbus/` | Modbus RTU, ASCII, TCP: slave and master |
//! | `fx_port.rs` | programming port, HMI monitor |
//! | `computer_link.rs` | computer link, BD protocol of L01S |
//! | `mc.rs` | MC protocol 1E and 3E |
//! | `link.rs` | links between PLCs: parallel link, N:N link; polling by HM as a computer link's master |
//! | `qlink.rs`, `can.rs`, `canlink.rs` | QLink, CAN, CANlink |
//! | `service.rs` | what servers over TCP speak; a connection to one |

pub(crate) mod can;
pub mod canlink;
pub mod codec;
pub mod computer_link;
mod elements;
mod frame;
pub(crate) mod free;
pub mod fx_port;
mod line;
pub mod link;
mod links;
mod map;
mod masters;
pub mod mc;
mod memory;
pub mod modbus;
pub mod mode;
mod parts;
mod port;
mod port_protocol;
#[cfg(test)]
mod port_tests;
mod protocols;
mod qlink;
pub mod service;
mod slave_alone;
mod slaves;
#[cfg(test)]
mod watched;
mod wiring;

pub use can::{CAN_PORT, CanFrame, CanTurn};
pub use elements::{Element, Elements, Places};
pub use frame::{Frame, hex_byte, hex_digits};
pub use free::{Free, Transfer};
pub use line::{CharFault, LineFormat, Parity, Received};
pub use map::{Map, Served};
pub use memory::Memory;
pub use parts::{Part, Port, PortMut, Progress, Status, Without};
pub use port::{FRAME, advance};
pub use protocols::Protocols;
pub use slave_alone::advance_slave;
pub(crate) use wiring::note_missing;
pub use wiring::{Choice, D_ADPRW_PORT, PortWiring, Ports, Protocol};

/// Classification of the characters received so far, in a protocol whose frames have a length or an end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cut {
    /// A frame continues.
    More,
    /// A frame is whole with the last character.
    Whole,
    /// The last character begins a frame: what came before it is dropped.
    Restart,
    /// No frame begins like this: all characters are dropped.
    Drop,
}

/// Fault of a frame: the kinds of errors that the registers of ports distinguish (h1u-h2u-programming §8.1: 63x0 to
/// 63x9 of Modbus, 6301 to 6306 of the other protocols, 6201 to 6205 of the programming port). The first ten are
/// numbered as the codes of Modbus are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineFault {
    /// The station number is out of range (63x0).
    Station = 0,
    /// The frame is too short or too long (63x1).
    Length,
    /// A device that is not there, or another address than requested (63x2).
    Address,
    /// The sum is wrong (63x3, 6303, 6203).
    Sum,
    /// A function or command that is not known, or another one than requested (63x4, 6305, 6205).
    Command,
    /// No answer in time (63x5, 6306).
    TimeOut,
    /// A wrong quantity or value (63x6).
    Data,
    /// More characters than a frame can have (63x7).
    Overflow,
    /// The frame has not the form of the protocol (63x8, 6304, 6204).
    Form,
    /// The port runs another protocol (63x9).
    Protocol,
    /// Parity, framing or overrun of a character (6301, 6201).
    Character,
    /// A character that the protocol does not know (6302, 6202).
    Unknown,
}
