//! CANlink 3.0 of H1U and H2U, as far as a program sees it (h1u-h2u-programming §5.9): stations write registers of
//! other stations, and watch each other.
//!
//! The manual prints neither a frame nor the form of the editor's configuration. So the frames are our own, between
//! programs of rungc, and `[canlink]` of a project takes the configuration's place: it becomes the instructions CANNET,
//! CANNODE and CANPUT ([`crate::fnc::canlink`]).
//!
//! All frames have identifiers of 29 bits: three bits say what the frame is ([`Kind`]), six are the sender, six the
//! receiver, fourteen a register D. Data are words, the high byte first. Frames with other identifiers are those of
//! CANTX and CANRX.

use super::can::{CAN_PORT, MOST};
use super::memory::{Memory, SIZE};
use super::port::Session;
use super::{CanFrame, Protocols};
use crate::plc::{Class, Plc, Sys};
use crate::special::{Register, Relay};

/// Version 1.00 of the protocol is wanted, which is not there.
pub(crate) const M_VERSION_1: Relay = Relay(8280);
/// [`D_STATION`] is the station number.
pub(crate) const M_OWN_STATION: Relay = Relay(8284);
/// The network runs: the master starts and stops it.
pub(crate) const M_NETWORK: Relay = Relay(8290);
/// All stations send what is to be sent together; the system switches it off.
pub const M_SYNCHRONOUS: Relay = Relay(8291);
/// The station number is wrong.
pub(crate) const M_WRONG_STATION: Relay = Relay(8296);
/// Time between heartbeats in milliseconds.
pub(crate) const D_HEARTBEAT: Register = Register(8282);
/// The station number.
pub(crate) const D_STATION: Register = Register(8284);
/// State of the master in a slave; states of stations 1 to 63 in the master follow.
pub(crate) const D_STATES: u32 = 7800;

/// Relays of CANlink, which are stored where a program is a station of it.
pub const RELAYS: [Relay; 5] = [
    M_VERSION_1,
    M_OWN_STATION,
    M_NETWORK,
    M_SYNCHRONOUS,
    M_WRONG_STATION,
];
/// Registers of CANlink, which are stored likewise.
pub const REGISTERS: [Register; 2] = [D_HEARTBEAT, D_STATION];

/// Stations are 1 to 63.
pub const STATIONS: usize = 64;
/// Frames write registers below this number: those from D7800 on are states, and special.
pub const REGISTERS_END: u16 = D_STATES as u16;
/// Words of a frame.
pub(crate) const WORDS: usize = MOST / 2;
/// Frames that wait for the command that they take effect.
pub const WAITING: usize = 16;
/// A partner is gone that has sent no heartbeat for this many of its times.
const MISSED: u32 = 3;

/// The station is a slave that the master watches.
pub const WATCHED: u8 = 1;
/// Role of a station whose broadcasts this station receives.
pub const HEARD: u8 = 2;

/// States of stations (h1u-h2u-programming §5.9.4).
const ABSENT: i16 = 1;
const NORMAL: i16 = 2;
const GONE: i16 = 5;

/// Kind of a frame. The smaller number comes first on the bus.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(u8)]
pub enum Kind {
    /// A command to all; the register is its number: 0, what waits takes effect; 1, all send what is to be sent
    /// together.
    Command = 0,
    /// Words that wait for the command that they take effect.
    Waits = 1,
    /// Words; the receiver is the sender if they are for all that listen.
    Words = 2,
    /// A station is there; its byte of data is 1 in the master while the network runs.
    Heartbeat = 3,
}

/// Register of the command that puts pending words into effect.
pub(crate) const TAKE_EFFECT: u16 = 0;
/// All send what is to be sent together.
pub(crate) const TOGETHER: u16 = 1;

/// The parts of an identifier.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Head {
    /// Kind of the frame.
    pub kind: Kind,
    /// Station that sends it.
    pub sender: u8,
    /// Whom it is for.
    pub receiver: u8,
    /// The first register, or the number of a command.
    pub register: u16,
}

impl Head {
    /// The identifier.
    pub fn id(self) -> u32 {
        CanFrame::EXTENDED
            | u32::from(self.kind as u8) << 26
            | u32::from(self.sender) << 20
            | u32::from(self.receiver) << 14
            | u32::from(self.register)
    }

    /// The parts of an identifier, if it is one of CANlink.
    pub fn of(id: u32) -> Option<Self> {
        let kind = match id >> 26 {
            0x20 => Kind::Command,
            0x21 => Kind::Waits,
            0x22 => Kind::Words,
            0x23 => Kind::Heartbeat,
            _ => return None,
        };
        Some(Head {
            kind,
            sender: (id >> 20 & 0x3f) as u8,
            receiver: (id >> 14 & 0x3f) as u8,
            register: (id & 0x3fff) as u16,
        })
    }
}

/// Offsets in the memory of the card.
const STATION: usize = 0;
const MASTER: usize = 1;
const COUNT: usize = 2;
const STOPPED: usize = 3;
const HEARTBEAT_MS: usize = 4;
const REFUSED: usize = 8;
const BEAT: usize = 12;
const ROLES: usize = 16;
const LAST_SEEN_MS: usize = ROLES + STATIONS;
const FRAMES: usize = LAST_SEEN_MS + 4 * STATIONS;
/// A frame that waits: its register, how many words, the words.
const FRAME: usize = 4 + 2 * WORDS;
const _: () = assert!(FRAMES + WAITING * FRAME <= SIZE);

/// State of a station's network.
pub(crate) struct Network<'a>(&'a mut Memory);

impl<'a> Network<'a> {
    /// That of the CAN card.
    pub(crate) fn of(plc: &'a mut dyn Plc) -> Option<Self> {
        plc.port(CAN_PORT)?.memory.map(Network)
    }

    fn byte(&self, at: usize) -> u8 {
        self.0.0.get(at).copied().unwrap_or(0)
    }

    fn set_byte(&mut self, at: usize, value: u8) {
        if let Some(place) = self.0.0.get_mut(at) {
            *place = value;
        }
    }

    fn number(&self, at: usize) -> u32 {
        let bytes = [0, 1, 2, 3].map(|n| self.byte(at + n));
        u32::from_le_bytes(bytes)
    }

    fn set_number(&mut self, at: usize, value: u32) {
        for (n, byte) in value.to_le_bytes().into_iter().enumerate() {
            self.set_byte(at + n, byte);
        }
    }

    /// RUN begins: nothing is known of other stations.
    pub(crate) fn begin(&mut self) {
        *self.0 = Memory::new();
    }

    /// Sets this station, the master, and the interval of heartbeats.
    pub(crate) fn set_up(&mut self, station: u8, master: u8, heartbeat_ms: u16) {
        self.set_byte(STATION, station);
        self.set_byte(MASTER, master);
        self.set_number(HEARTBEAT_MS, heartbeat_ms.into());
    }

    /// This station; 0 is none.
    pub(crate) fn station(&self) -> u8 {
        self.byte(STATION)
    }

    /// Returns true if this station is the master.
    pub(crate) fn is_master(&self) -> bool {
        self.byte(STATION) == self.byte(MASTER)
    }

    /// Sets the roles of another station towards this one.
    pub(crate) fn set_roles(&mut self, station: u8, roles: u8) {
        if usize::from(station) < STATIONS {
            self.set_byte(ROLES + usize::from(station), roles);
        }
    }

    fn has_role(&self, station: u8, role: u8) -> bool {
        self.byte(ROLES + usize::from(station)) & role != 0
    }

    /// Returns true if the master has stopped the network, as a slave knows it.
    fn is_stopped(&self) -> bool {
        self.byte(STOPPED) != 0
    }

    /// Returns true if a heartbeat is due; the next one is due after its interval.
    pub(crate) fn beats(&mut self, now_ms: u32) -> bool {
        let every = self.number(HEARTBEAT_MS);
        let due = every > 0 && now_ms.wrapping_sub(self.number(BEAT)) >= every;
        if due {
            self.set_number(BEAT, now_ms);
        }
        due
    }

    /// A heartbeat has come.
    fn note_heartbeat(&mut self, station: u8, runs: bool, now_ms: u32) {
        // 0 is a station without a frame so far.
        self.set_number(LAST_SEEN_MS + 4 * usize::from(station), now_ms | 1);
        if station == self.byte(MASTER) {
            self.set_byte(STOPPED, u8::from(!runs));
        }
    }

    /// State of a station; `None` if no one watches it.
    pub(crate) fn state(&self, station: u8, now_ms: u32) -> Option<i16> {
        let watched = match self.is_master() {
            true => self.has_role(station, WATCHED),
            false => station == self.byte(MASTER),
        };
        let every = self.number(HEARTBEAT_MS);
        if !watched || every == 0 {
            return None;
        }
        let last_seen_ms = self.number(LAST_SEEN_MS + 4 * usize::from(station));
        Some(match last_seen_ms {
            0 => ABSENT,
            _ if now_ms.wrapping_sub(last_seen_ms) as i32 > (MISSED * every) as i32 => GONE,
            _ => NORMAL,
        })
    }

    /// Returns true if the bus has rejected a frame in this scan: those after it wait, so that frames keep their order.
    pub(crate) fn has_refused(&self, scan: u16) -> bool {
        self.number(REFUSED) == u32::from(scan)
    }

    pub(crate) fn refuse(&mut self, scan: u16) {
        self.set_number(REFUSED, scan.into());
    }

    /// Keeps words until they take effect; more than fit are lost.
    fn keep(&mut self, register: u16, data: &[u8]) {
        let count = self.byte(COUNT);
        if usize::from(count) >= WAITING {
            return;
        }
        let at = FRAMES + usize::from(count) * FRAME;
        self.set_number(at, u32::from(register) << 8 | data.len() as u32);
        for (n, &byte) in data.iter().enumerate() {
            self.set_byte(at + 4 + n, byte);
        }
        self.set_byte(COUNT, count + 1);
    }

    /// The first words that have waited, and where they go.
    fn pending(&self, index: u8) -> Option<(u16, [u8; MOST], usize)> {
        let at = FRAMES + usize::from(index) * FRAME;
        let head = (index < self.byte(COUNT)).then(|| self.number(at))?;
        let mut data = [0; MOST];
        for (n, byte) in data.iter_mut().enumerate() {
            *byte = self.byte(at + 4 + n);
        }
        Some(((head >> 8) as u16, data, (head & 0xff) as usize))
    }
}

/// Returns true if a station takes part in its network now. A slave obeys the master's heartbeats.
pub(crate) fn runs(plc: &mut dyn Plc) -> bool {
    let on = M_NETWORK.is_on(plc);
    let Some(network) = Network::of(plc) else {
        return false;
    };
    network.station() != 0
        && match network.is_master() {
            true => on,
            false => !network.is_stopped(),
        }
}

/// Writes words to registers, as far as a frame may and the program has them.
fn write(plc: &mut dyn Plc, register: u16, data: &[u8]) {
    for (n, word) in data.chunks_exact(2).enumerate() {
        let number = u32::from(register) + n as u32;
        if let (&[high, low], true) = (word, number < u32::from(REGISTERS_END)) {
            let value = i16::from_be_bytes([high, low]);
            // A register that the program does not have holds nothing.
            let _ = plc.set_word(Class::D, number, value);
        }
    }
}

/// Takes a frame; false if it is one of CANRX.
pub(super) fn take(plc: &mut dyn Plc, frame: &CanFrame) -> bool {
    let Sys {
        now_ms, running, ..
    } = *plc.sys();
    let Some(mut network) = Network::of(plc) else {
        return false;
    };
    let own = network.station();
    let Some(head) = Head::of(frame.id).filter(|_| own != 0) else {
        return false;
    };
    let data = frame.data.get(..frame.len.into()).unwrap_or_default();
    if !running || head.sender == 0 || head.sender == own {
        return true;
    }
    let for_all = head.receiver == head.sender && network.has_role(head.sender, HEARD);
    match head.kind {
        Kind::Heartbeat => {
            let runs = data.first().is_none_or(|&byte| byte != 0);
            network.note_heartbeat(head.sender, runs, now_ms);
            if head.sender == network.byte(MASTER) {
                M_NETWORK.set(plc, runs);
            }
        }
        // Words are whole ones.
        _ if network.is_stopped() || data.len() % 2 != 0 => {}
        Kind::Waits if head.receiver == own => network.keep(head.register, data),
        Kind::Words if head.receiver == own || for_all => write(plc, head.register, data),
        Kind::Command if head.sender == network.byte(MASTER) => match head.register {
            TAKE_EFFECT => take_effect(plc),
            TOGETHER => M_SYNCHRONOUS.set(plc, true),
            _ => {}
        },
        Kind::Waits | Kind::Words | Kind::Command => {}
    }
    true
}

/// Writes the pending words.
fn take_effect(plc: &mut dyn Plc) {
    let mut index = 0;
    while let Some((register, data, length)) =
        Network::of(plc).and_then(|network| network.pending(index))
    {
        write(plc, register, data.get(..length).unwrap_or_default());
        index += 1;
    }
    if let Some(mut network) = Network::of(plc) {
        network.set_byte(COUNT, 0);
    }
}

impl Session<'_> {
    /// Takes a frame of CAN if it is one of CANlink, and the program is a station of it.
    pub(super) fn take_canlink(&mut self, frame: &CanFrame) -> bool {
        let codec = self.codec_of(Protocols::CANLINK);
        codec.is_some_and(|codec| codec.handler.receive_can(self.plc, frame))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identifiers_come_back_as_they_were() {
        let kinds = [Kind::Command, Kind::Waits, Kind::Words, Kind::Heartbeat];
        for kind in kinds {
            let head = Head {
                kind,
                sender: 63,
                receiver: 1,
                register: 7799,
            };
            assert_eq!(Head::of(head.id()), Some(head));
        }
        // Those of the program's own.
        assert_eq!(Head::of(0x123), None);
        assert_eq!(Head::of(CanFrame::EXTENDED | 4 << 26), None);
    }

    #[test]
    fn more_than_can_wait_is_lost() {
        let mut memory = Memory::new();
        let mut network = Network(&mut memory);
        for n in 0..20 {
            network.keep(n, &[1, 2]);
        }
        assert_eq!(network.pending(15), Some((15, [1, 2, 0, 0, 0, 0, 0, 0], 2)));
        assert_eq!(network.pending(16), None);
    }

    #[test]
    fn a_station_is_gone_after_three_heartbeats() {
        let mut memory = Memory::new();
        let mut network = Network(&mut memory);
        network.set_up(1, 1, 100);
        network.set_roles(2, WATCHED);
        assert_eq!(network.state(3, 0), None);
        assert_eq!(network.state(2, 0), Some(ABSENT));
        network.note_heartbeat(2, true, 1000);
        assert_eq!(network.state(2, 1300), Some(NORMAL));
        assert_eq!(network.state(2, 1302), Some(GONE));
        network.note_heartbeat(2, true, 1400);
        assert_eq!(network.state(2, 1400), Some(NORMAL));
    }
}
