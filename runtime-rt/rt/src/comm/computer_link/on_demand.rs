//! On-demand transmission: the PLC speaks first (h1u-h2u-programming §5.6, on-demand function).

use super::{ETX, STX, Settings, end, head};
use crate::comm::{Frame, Map};
use crate::plc::Class;
use crate::special::{Register, Relay};

/// Registers from this one on are not sent.
const END_OF_REGISTERS: u32 = 8000;
/// Maximum number of registers of one transmission.
const MOST: u32 = 64;

/// The devices that a port has for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Devices {
    /// Register with the number of the first D; the next one holds how many are sent (D8127, D8128).
    pub first_register: Register,
    /// Relay that is on while the frame is sent; the next one reports a range error, the one after it chooses 8-bit
    /// data (M8127 to M8129).
    pub first_relay: Relay,
}

impl Devices {
    /// The devices of a port whose block begins at this number (8120 for COM1).
    pub const fn of_block(base: Register) -> Self {
        Devices {
            first_register: base.after(7),
            first_relay: Relay(base.0 + 7),
        }
    }
}

/// Makes the frame that the program asks for by a count other than 0: `STX station FE data ETX [sum] [CR LF]`. Empty if
/// it asks for none, or for registers that are not there.
///
/// The count is set back to 0, so that a frame is sent once for each time that the program writes it. (The manual's
/// example program does that itself.)
pub fn request(settings: Settings, devices: Devices, map: &mut dyn Map, frame: &mut Frame) {
    frame.clear();
    let (register, relay) = (devices.first_register, devices.first_relay);
    let word = |map: &dyn Map, n: u32| map.word(Class::D, n).map_or(0, |w| u32::from(w as u16));
    let count = word(map, register.after(1).number());
    if count == 0 {
        return;
    }
    let first = word(map, register.number());
    let bytes = map.bit(Class::M, relay.after(2).number()) == Some(true);
    let _ = map.set_word(Class::D, register.after(1).number(), 0);
    let fits =
        count <= MOST && first + count <= END_OF_REGISTERS && map.has_words(Class::D, first, count);
    let _ = map.set_bit(Class::M, relay.after(1).number(), !fits);
    if !fits {
        return;
    }
    head(STX, settings.station, b"FE", frame);
    for number in first..first + count {
        frame.push_hex(word(map, number), if bytes { 2 } else { 4 });
    }
    frame.push(ETX);
    end(settings, frame);
    let _ = map.set_bit(Class::M, relay.number(), true);
}

/// The frame of [`request`] has been sent.
pub fn sent(devices: Devices, map: &mut dyn Map) {
    let _ = map.set_bit(Class::M, devices.first_relay.number(), false);
}
