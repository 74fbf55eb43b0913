//! The CAN card of H1U and H2U: frames of the program's own, by CANTX and CANRX (h1u-h2u-programming §4.3.9).
//!
//! Frames go by the hardware's [`CanBus`](crate::CanBus). Where there is none, the card is a serial port, [`CAN_PORT`],
//! whose other end speaks SLCAN, as USB adapters do (LAWICEL, CANable; on Linux any of them is a tty): `tiiildd…` and
//! `Tiiiiiiiildd…` are frames with identifiers of 11 and 29 bits, in hexadecimal digits with l bytes of data, and a
//! carriage return ends them. Its bit rate and whether the bus is open are the adapter's.
//!
//! As the manual says, instructions that receive are served one after the other, and a frame that the waiting one does
//! not name is lost. D8299 is the time after which the next one waits; where it is 0, it is [`TURN_US`]. The card's
//! relays and registers show what happens.

use super::port::Session;
use super::{Cut, Frame, Protocol, hex_digits};
pub use crate::hal::CanFrame;
use crate::hal::Hal;
use crate::plc::Plc;
use crate::special::{Register, Relay};

/// Number of the CAN card among the ports of H1U and H2U, after COM3.
pub const CAN_PORT: u8 = 4;

/// After this many microseconds without its frame, an instruction lets the next one wait, if D8299 is 0.
pub const TURN_US: u32 = 100_000;

/// Special devices of the card (h1u-h2u-programming §8.1): CANRX waits; a frame could not be sent; CANRX has received;
/// CANTX sends; CANRX has waited in vain.
pub(crate) const M_WAITS: Relay = Relay(8292);
pub(crate) const M_SEND_FAILED: Relay = Relay(8293);
pub(crate) const M_RECEIVED: Relay = Relay(8294);
pub(crate) const M_SENDS: Relay = Relay(8298);
pub(crate) const M_LATE: Relay = Relay(8299);
/// There is a card (h1u-h2u-programming §5.9.5).
const M_CARD: Relay = Relay(8281);
/// Bytes of the last frame received; the frame, its first four bytes in the first two registers, the low word first.
pub(crate) const D_LENGTH: Register = Register(8292);
pub(crate) const D_DATA: Register = Register(8295);
/// Time-out of CANRX, in milliseconds.
pub(crate) const D_TIME_OUT: Register = Register(8299);

/// Time-out of CANRX, in microseconds: 5 to 1000 ms (h1u-h2u-programming §5.9.5).
pub(crate) fn turn_us(plc: &dyn Plc) -> u32 {
    match D_TIME_OUT.value(plc) {
        0 => TURN_US,
        ms => u32::from(ms.clamp(5, 1000)) * 1000,
    }
}

/// All special devices of CANTX and CANRX, which are stored where a program uses them.
pub(super) const RELAYS: [Relay; 6] = [M_CARD, M_WAITS, M_SEND_FAILED, M_RECEIVED, M_SENDS, M_LATE];
pub(super) const REGISTERS: [Register; 6] = {
    let [a, b, c, d] = D_DATA.run();
    [D_LENGTH, a, b, c, d, D_TIME_OUT]
};

/// Maximum number of bytes of data.
pub const MOST: usize = 8;

/// Maximum number of characters of a frame.
const LONGEST: usize = 1 + 8 + 1 + 2 * MOST + 1;

impl CanFrame {
    /// Marks an identifier of 29 bits.
    pub const EXTENDED: u32 = 1 << 31;

    /// No identifier and no data.
    pub const fn new() -> Self {
        CanFrame {
            id: 0,
            len: 0,
            data: [0; MOST],
        }
    }

    /// Appends the frame as SLCAN writes it.
    pub fn write(&self, text: &mut Frame) {
        let extended = self.id & Self::EXTENDED != 0;
        text.push(if extended { b'T' } else { b't' });
        text.push_hex(self.id & !Self::EXTENDED, if extended { 8 } else { 3 });
        text.push_hex(self.len.into(), 1);
        for &byte in self.data.iter().take(self.len.into()) {
            text.push_hex(byte.into(), 2);
        }
        text.push(b'\r');
    }

    /// Reads a frame as SLCAN writes it; what follows the data (a time stamp) is ignored.
    pub fn parse(text: &[u8]) -> Option<Self> {
        let (digits, most, mark) = match text.first()? {
            b't' => (3, 0x7ff, 0),
            b'T' => (8, 0x1fff_ffff, Self::EXTENDED),
            _ => return None,
        };
        let mut frame = CanFrame::new();
        let id = hex_digits(text.get(1..1 + digits)?)?;
        frame.id = id | mark;
        frame.len = hex_digits(text.get(1 + digits..2 + digits)?)? as u8;
        let data = text.get(2 + digits..)?;
        for (index, byte) in frame.data.iter_mut().enumerate() {
            if index < frame.len.into() {
                *byte = hex_digits(data.get(2 * index..2 * index + 2)?)? as u8;
            }
        }
        (usize::from(frame.len) <= MOST && id <= most).then_some(frame)
    }
}

/// The CAN card as a port.
impl Session<'_> {
    /// Takes the frames of a CAN bus, and shows whether there is a card, and whether it still sends. True if there is a
    /// bus: then there is no line.
    pub(super) fn advance_can(&mut self) -> bool {
        let mut sends = false;
        let mut is_there = false;
        let is_on = self.status.protocol == Protocol::Can;
        let is_bus = self.hal.can_bus().is_some();
        while let Some(frame) = self.hal.can_bus().and_then(|bus| bus.receive()) {
            if is_on {
                self.take_from_bus(frame);
            }
        }
        if let Some(bus) = self.hal.can_bus() {
            sends = bus.is_sending();
            is_there = true;
        } else if let Some((port, now_us)) = self.serial() {
            sends = port.unsent(now_us) > 0;
            is_there = true;
        }
        M_CARD.set(self.plc, is_there);
        if !sends {
            M_SENDS.set(self.plc, false);
        }
        is_bus
    }

    /// A frame has come as SLCAN.
    pub(super) fn take_can(&mut self, received: usize) {
        let port = self.plc.port(self.own.wiring.number);
        let frame = port.as_ref().and_then(|port| port.buffer.get(..received));
        if let Some(frame) = frame.and_then(CanFrame::parse) {
            self.take_from_bus(frame);
        }
    }

    /// A frame has come: one of CANlink, if the program is a station of it, or one for an instruction that waits.
    pub(super) fn take_from_bus(&mut self, frame: CanFrame) {
        if !self.take_canlink(&frame) {
            self.own.progress.can.receive(frame);
        }
    }
}

/// Sends a frame by the CAN bus, or as SLCAN by the port; false if it is not taken.
pub(crate) fn send(hal: &mut dyn Hal, frame: &CanFrame, now_us: u32) -> bool {
    if let Some(bus) = hal.can_bus() {
        return bus.send(frame);
    }
    let Some(port) = hal.serial_port(CAN_PORT) else {
        return false;
    };
    let mut text = [0; LONGEST];
    let mut writer = Frame::new(&mut text);
    frame.write(&mut writer);
    let mut characters = writer.as_slice().iter();
    characters.all(|&byte| port.send(byte, now_us))
}

/// Decides whether the characters received so far form a frame. Answers of the adapter are dropped.
pub(super) fn cut(received: &[u8]) -> Cut {
    match received {
        // Neither letter is a digit: what came before was cut.
        [_, .., b't' | b'T'] => Cut::Restart,
        [b't' | b'T', .., b'\r'] => Cut::Whole,
        // A time stamp has four digits more.
        [b't' | b'T', ..] if received.len() < LONGEST + 4 => Cut::More,
        _ => Cut::Drop,
    }
}

/// Instruction that waits for a frame. All zero is none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct CanTurn {
    /// The instruction: its step plus 1; 0: none waits.
    pub owner: u32,
    /// Start of its wait.
    pub since_us: u32,
    /// Its identifier.
    pub id: u32,
    /// It has taken a frame, and lets another instruction wait if one wants to.
    pub released: bool,
    /// Its frame has come.
    pub come: bool,
    /// The frame.
    pub frame: CanFrame,
}

impl CanTurn {
    /// None waits.
    pub const fn new() -> Self {
        CanTurn {
            owner: 0,
            since_us: 0,
            id: 0,
            released: false,
            come: false,
            frame: CanFrame::new(),
        }
    }

    /// A frame has come.
    pub(super) fn receive(&mut self, frame: CanFrame) {
        if self.owner != 0 && frame.id == self.id && !self.come {
            self.frame = frame;
            self.come = true;
            self.released = false;
        }
    }

    /// Returns true if the waiting instruction has exceeded its time-out.
    pub fn is_late(&self, now_us: u32, turn_us: u32) -> bool {
        self.owner != 0 && !self.released && now_us.wrapping_sub(self.since_us) >= turn_us
    }

    /// Returns true if an instruction waits for its frame.
    pub fn waits(&self) -> bool {
        self.owner != 0 && !self.released && !self.come
    }

    /// The scan reaches a driven instruction that waits for this identifier; returns its frame if one has come. It lets
    /// others wait after `turn_us` without one.
    pub fn visit(&mut self, owner: u32, id: u32, now_us: u32, turn_us: u32) -> Option<CanFrame> {
        let expired = now_us.wrapping_sub(self.since_us) >= turn_us;
        let frame = if self.owner == owner && self.id == id {
            let come = core::mem::take(&mut self.come).then_some(self.frame);
            self.released = self.released || expired || come.is_some();
            come
        } else {
            None
        };
        let is_own = self.owner == owner && self.id == id;
        if self.owner == 0 || !is_own && (self.released || expired) {
            *self = CanTurn {
                owner,
                since_us: now_us,
                id,
                ..CanTurn::new()
            };
        }
        frame
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CanBus;
    use crate::comm::watched::reply_of;
    use crate::double::Double;
    use proptest::prelude::*;
    use std::vec::Vec;

    fn text(frame: CanFrame) -> Vec<u8> {
        reply_of(|text| {
            frame.write(text);
            Ok(())
        })
        .0
    }

    #[test]
    fn frames_are_written_as_slcan() {
        let mut frame = CanFrame {
            id: 0x200,
            len: 3,
            data: [0x12, 0x34, 0x56, 0, 0, 0, 0, 0],
        };
        assert_eq!(text(frame), b"t2003123456\r");
        frame.id = 0x134f_0200 | CanFrame::EXTENDED;
        assert_eq!(text(frame), b"T134F02003123456\r");
        assert_eq!(CanFrame::parse(b"T134F02003123456\r"), Some(frame));
        assert_eq!(CanFrame::parse(b"t20031234\r"), None);
        assert_eq!(CanFrame::parse(b"t2009112233445566778899\r"), None);
        assert_eq!(CanFrame::parse(b"t8000\r"), None);
        assert_eq!(CanFrame::parse(b"T200000000\r"), None);
        assert_eq!(cut(b"t2003123456\r"), Cut::Whole);
        assert_eq!(cut(b"z\r"), Cut::Drop);
        assert_eq!(cut(b"t2003t"), Cut::Restart);
    }

    #[test]
    fn instructions_take_turns() {
        let mut turn = CanTurn::new();
        let frame = |id| CanFrame {
            id,
            ..CanFrame::new()
        };
        assert_eq!(turn.visit(1, 0x200, 0, TURN_US), None);
        assert_eq!(turn.visit(2, 0x201, 0, TURN_US), None);
        turn.receive(frame(0x201));
        turn.receive(frame(0x200));
        assert_eq!(turn.visit(1, 0x200, 1000, TURN_US), Some(frame(0x200)));
        assert_eq!(turn.visit(2, 0x201, 1000, TURN_US), None);
        turn.receive(frame(0x200));
        turn.receive(frame(0x201));
        assert_eq!(turn.visit(1, 0x200, 2000, TURN_US), None);
        assert_eq!(turn.visit(2, 0x201, 2000, TURN_US), Some(frame(0x201)));
        // An instruction without a frame lets the next one wait.
        assert_eq!(turn.visit(1, 0x200, 3000, TURN_US), None);
        assert_eq!(turn.visit(2, 0x201, 3000 + TURN_US, TURN_US), None);
        turn.receive(frame(0x201));
        assert_eq!(
            turn.visit(2, 0x201, 4000 + TURN_US, TURN_US),
            Some(frame(0x201))
        );
        // Alone, it keeps waiting.
        turn.receive(frame(0x201));
        assert_eq!(
            turn.visit(2, 0x201, 5000 + TURN_US, TURN_US),
            Some(frame(0x201))
        );
    }

    /// A bus that takes one frame at a time.
    #[derive(Default)]
    struct Bus {
        come: Vec<CanFrame>,
        sent: Option<CanFrame>,
    }

    impl CanBus for Bus {
        fn receive(&mut self) -> Option<CanFrame> {
            self.come.pop()
        }

        fn send(&mut self, frame: &CanFrame) -> bool {
            let is_free = self.sent.is_none();
            self.sent = self.sent.or(Some(*frame));
            is_free
        }

        fn is_sending(&mut self) -> bool {
            self.sent.is_some()
        }
    }

    impl Hal for Bus {
        fn can_bus(&mut self) -> Option<&mut dyn CanBus> {
            Some(self)
        }
    }

    #[test]
    fn frames_go_by_the_bus() {
        let mut plc = Double::new();
        let mut bus = Bus::default();
        let frame = |id| CanFrame {
            id,
            len: 2,
            data: [1, 2, 0, 0, 0, 0, 0, 0],
        };
        assert!(send(&mut bus, &frame(0x200), 0));
        assert!(!send(&mut bus, &frame(0x201), 0));
        assert_eq!(bus.sent, Some(frame(0x200)));
        M_SENDS.set(&mut plc, true);
        crate::comm::advance(&mut plc, &mut bus, 0);
        assert!(M_SENDS.is_on(&plc) && M_CARD.is_on(&plc));
        let can = |plc: &mut Double| plc.port(CAN_PORT).unwrap().progress.unwrap().can;
        let mut turn = can(&mut plc);
        assert_eq!(turn.visit(1, 0x300, 0, TURN_US), None);
        plc.port(CAN_PORT).unwrap().progress.unwrap().can = turn;
        bus.come = std::vec![frame(0x300), frame(0x301)];
        bus.sent = None;
        crate::comm::advance(&mut plc, &mut bus, 1000);
        assert!(!M_SENDS.is_on(&plc));
        assert_eq!(
            can(&mut plc).visit(1, 0x300, 1000, TURN_US),
            Some(frame(0x300))
        );
        crate::comm::advance(&mut plc, &mut crate::NoHal, 2000);
        assert!(!M_CARD.is_on(&plc));
    }

    proptest! {
        #[test]
        fn any_bytes(received in proptest::collection::vec(any::<u8>(), 0..40)) {
            cut(&received);
            if let Some(frame) = CanFrame::parse(&received) {
                prop_assert_eq!(CanFrame::parse(&text(frame)), Some(frame));
            }
        }
    }
}
