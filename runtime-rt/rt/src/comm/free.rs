//! Protocols of the program's own: RS, RS2 (h1u-h2u-programming §5.6, l01s-programming §9), USEND and URCV
//! (hm-motion-controller §6.5).

mod rs;

use super::LineFault;
use super::line::{CharFault, Received};
use super::port::{Session, has_come};
use super::wiring::Choice;
use crate::plc::{Class, Plc};
use crate::runs::FIRST_SPECIAL;
use rs::Marks;

/// Words of HM's work area, counted from its first register.
mod work {
    pub const SEND: u32 = 0;
    pub const SEND_COUNT: u32 = 1;
    pub const RECEIVE: u32 = 2;
    pub const RECEIVE_COUNT: u32 = 3;
    pub const START: u32 = 4;
    pub const END: u32 = 5;
    pub const WAIT_MS: u32 = 6;
    pub const CONTROL: u32 = 7;
    pub const FLAGS: u32 = 8;
    pub const RECEIVED: u32 = 9;
}

/// Bits of the control word of HM's work area.
mod control {
    pub const THEN_RECEIVE: u16 = 1;
    pub const FROM_START: u16 = 1 << 1;
    pub const TO_END: u16 = 1 << 2;
}

/// Bits of the flags of HM's work area.
mod flag {
    pub const SEND: u16 = 1;
    pub const SENT: u16 = 1 << 1;
    pub const RECEIVE: u16 = 1 << 2;
    pub const RECEIVED: u16 = 1 << 3;
    pub const START: u16 = 1 << 4;
    pub const END: u16 = 1 << 5;
    pub const PARITY: u16 = 1 << 6;
    pub const TIME_OUT: u16 = 1 << 7;
    pub const RANGE: u16 = 1 << 8;
}

/// Data that an instruction sends and receives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct Transfer {
    /// First word to send.
    pub source: u32,
    /// First word for what is received.
    pub target: u32,
    /// Characters to send.
    pub send: u16,
    /// Characters to receive.
    pub receive: u16,
    /// Class of the words to send, by its number.
    pub source_class: u8,
    /// Class of the others.
    pub target_class: u8,
    /// A word contains one character, in its low byte; else two, the first in the low byte.
    pub one_a_word: bool,
}

/// State of a port that executes RS or the like. All zero is nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct Free {
    /// Transfer of the driven instruction.
    pub transfer: Transfer,
    /// The step of the instruction, plus 1; 0: none is driven.
    pub owner: u32,
    /// Characters are being received, or may come.
    listens: bool,
    /// All of them have been received, and the program has not reacted yet.
    complete: bool,
    /// An answer is expected, and nothing of it has come.
    awaits: bool,
    /// Characters to send, those before and after the data included.
    total: u16,
    /// Number of them that the hardware has accepted.
    taken: u16,
    /// Data characters received.
    received: u16,
    /// Time of the last received character.
    last_us: u32,
    /// The last four characters received, the last one the lowest.
    window: u32,
    /// The sum of the characters sent, and of those received.
    sent_sum: u16,
    sum: u16,
    /// The sum that has come; above 255, digits of it were wrong.
    claimed: u16,
    /// Number of characters expected after the end of the data: a sum, CR and LF.
    tail: u8,
}

impl Free {
    /// Nothing.
    pub const fn new() -> Self {
        Free {
            transfer: Transfer {
                source: 0,
                target: 0,
                send: 0,
                receive: 0,
                source_class: 0,
                target_class: 0,
                one_a_word: false,
            },
            owner: 0,
            listens: false,
            complete: false,
            awaits: false,
            total: 0,
            taken: 0,
            received: 0,
            last_us: 0,
            window: 0,
            sent_sum: 0,
            sum: 0,
            claimed: 0,
            tail: 0,
        }
    }
}

/// The longest message of HM (hm-motion-controller §6.5).
const HM_LONGEST: u16 = 255;

/// D or R.
fn class(number: u8) -> Class {
    if number == Class::R as u8 {
        Class::R
    } else {
        Class::D
    }
}

/// The place of a character: number of its word, and whether it is the high byte.
fn place(first: u32, index: u16, one_a_word: bool) -> (u32, bool) {
    if one_a_word {
        (first.saturating_add(index.into()), false)
    } else {
        (first.saturating_add(u32::from(index / 2)), index % 2 == 1)
    }
}

impl Session<'_> {
    /// A character of a protocol of the program's own.
    pub(super) fn take_free(&mut self, character: Received) {
        match self.own.wiring.choice {
            Choice::Uinit => self.take_hm(character),
            _ => self.take_rs(character),
        }
    }

    /// Sends, and takes notice of time, for a protocol of the program's own.
    pub(super) fn advance_free(&mut self) {
        match self.own.wiring.choice {
            Choice::Uinit => self.advance_hm(),
            _ => self.advance_rs(),
        }
    }

    /// Hands data characters, with what surrounds them, to the hardware; returns how many of all are not out yet.
    fn send_data(&mut self, marks: &Marks) -> u16 {
        while self.own.progress.free.taken < self.own.progress.free.total {
            let (byte, summed) = self.next_character(marks);
            if !self
                .serial()
                .is_some_and(|(port, now)| port.send(byte, now))
            {
                break;
            }
            self.own.progress.free.taken += 1;
            if summed {
                let sum = &mut self.own.progress.free.sent_sum;
                *sum = sum.wrapping_add(byte.into());
            }
        }
        let unsent = self.serial().map_or(0, |(port, now)| port.unsent(now));
        let free = self.own.progress.free;
        (free.total - free.taken).saturating_add(unsent)
    }

    /// The character that is to be sent next, and whether the sum counts it: the data and what ends it.
    fn next_character(&self, marks: &Marks) -> (u8, bool) {
        let free = self.own.progress.free;
        let at = free.taken;
        let Some(at) = at.checked_sub(marks.before.length.into()) else {
            return (marks.before.at(at), false);
        };
        let Some(at) = at.checked_sub(free.transfer.send) else {
            return (self.data(at).unwrap_or(0), true);
        };
        match at.checked_sub(marks.after.length.into()) {
            None => (marks.after.at(at), true),
            Some(at) => (marks.tail(at, free.sent_sum as u8), false),
        }
    }

    /// Data character number `index` to send.
    fn data(&self, index: u16) -> Option<u8> {
        let transfer = self.own.progress.free.transfer;
        let (number, high) = place(transfer.source, index, transfer.one_a_word);
        let word = self.plc.word(class(transfer.source_class), number)?;
        let [low, high_byte] = word.to_le_bytes();
        Some(if high { high_byte } else { low })
    }

    /// Stores data character number `index`.
    fn store_data(&mut self, index: u16, byte: u8) {
        let transfer = self.own.progress.free.transfer;
        let (number, high) = place(transfer.target, index, transfer.one_a_word);
        let class = class(transfer.target_class);
        let Some(before) = self.plc.word(class, number) else {
            return;
        };
        let [low, high_byte] = before.to_le_bytes();
        let bytes = match (transfer.one_a_word, high) {
            (true, _) => [byte, 0],
            (false, true) => [low, byte],
            (false, false) => [byte, high_byte],
        };
        let _ = self.plc.set_word(class, number, i16::from_le_bytes(bytes));
    }

    /// The next character begins another reception.
    fn end_reception(&mut self) {
        self.own.progress.free.listens = false;
        self.own.progress.free.window = 0;
    }

    /// Time at which a character began.
    fn begin_of(&self, character: Received) -> u32 {
        character
            .at_us
            .wrapping_sub(self.status.format.character_us())
    }

    /// Returns true if a character is faulty and so dropped, after reporting the fault.
    fn is_wrong(&mut self, character: Received) -> bool {
        if character.fault == CharFault::None {
            return false;
        }
        self.note(LineFault::Character);
        character.fault != CharFault::Overrun
    }
}

/// USEND and URCV.
impl Session<'_> {
    /// A word of the work area.
    fn work(&self, word: u32) -> u16 {
        area_word(self.plc, u32::from(self.status.uinit[2]) + word)
    }

    fn set_work(&mut self, word: u32, value: u16) {
        set_area_word(self.plc, u32::from(self.status.uinit[2]) + word, value);
    }

    fn raise(&mut self, flags: u16) {
        self.set_work(work::FLAGS, self.work(work::FLAGS) | flags);
    }

    fn clear(&mut self, flags: u16) {
        self.set_work(work::FLAGS, self.work(work::FLAGS) & !flags);
    }

    fn take_hm(&mut self, character: Received) {
        self.close_hm(self.begin_of(character));
        if self.work(work::FLAGS) & flag::RECEIVE == 0 {
            return;
        }
        if matches!(character.fault, CharFault::Parity | CharFault::Framing) {
            self.raise(flag::PARITY);
        }
        if !matches!(character.fault, CharFault::None | CharFault::Overrun) {
            return;
        }
        let control = self.work(work::CONTROL);
        let byte = character.byte & self.status.format.mask();
        let is = |this: &Self, word: u32| this.work(word) == u16::from(byte);
        if is(self, work::START) {
            self.raise(flag::START);
        } else if control & control::FROM_START != 0 && !self.own.progress.free.listens {
            return;
        }
        if !core::mem::replace(&mut self.own.progress.free.listens, true) {
            self.own.progress.free.received = 0;
            self.own.progress.free.transfer = Transfer {
                target: self.work(work::RECEIVE).into(),
                receive: self.work(work::RECEIVE_COUNT),
                one_a_word: true,
                target_class: Class::D as u8,
                ..self.own.progress.free.transfer
            };
        }
        self.own.progress.free.last_us = character.at_us;
        self.own.progress.free.awaits = false;
        self.store_data(self.own.progress.free.received, byte);
        self.own.progress.free.received += 1;
        self.set_work(work::RECEIVED, self.own.progress.free.received);
        let mut ends = self.own.progress.free.received >= self.own.progress.free.transfer.receive;
        if is(self, work::END) {
            self.raise(flag::END);
            ends |= control & control::TO_END != 0;
        }
        if ends {
            self.end_hm();
        }
    }

    /// Ends a reception that is complete.
    fn end_hm(&mut self) {
        self.end_reception();
        self.clear(flag::RECEIVE);
        self.raise(flag::RECEIVED);
    }

    /// A reception ends when nothing more comes; an answer that does not come is late.
    fn close_hm(&mut self, at_us: u32) {
        let free = self.own.progress.free;
        if !free.listens && !free.awaits {
            return;
        }
        let wait_us = u32::from(self.work(work::WAIT_MS)) * 1000;
        let quiet_us = at_us.wrapping_sub(free.last_us);
        if !has_come(at_us, free.last_us) || quiet_us <= wait_us {
            return;
        }
        if free.listens {
            self.end_hm();
        } else {
            self.own.progress.free.awaits = false;
            self.raise(flag::TIME_OUT);
        }
    }

    fn advance_hm(&mut self) {
        self.close_hm(self.now_us);
        if !self.status.sending && self.work(work::FLAGS) & flag::SEND != 0 {
            let send = self.work(work::SEND_COUNT).min(HM_LONGEST);
            self.own.progress.free.transfer = Transfer {
                source: self.work(work::SEND).into(),
                source_class: Class::D as u8,
                send,
                one_a_word: true,
                ..self.own.progress.free.transfer
            };
            self.own.progress.free.total = send;
            self.own.progress.free.taken = 0;
            self.status.sending = true;
        }
        if !self.status.sending || self.send_data(&Marks::NONE) > 0 {
            return;
        }
        self.status.sending = false;
        self.clear(flag::SEND);
        self.raise(flag::SENT);
        if self.work(work::CONTROL) & control::THEN_RECEIVE != 0 {
            self.clear(flag::RECEIVED);
            self.raise(flag::RECEIVE);
            self.own.progress.free.awaits = true;
            self.own.progress.free.last_us = self.now_us;
        }
    }
}

/// The instructions of HM, which leave what they want in the work area.
pub(crate) fn usend(plc: &mut dyn Plc, area: u32, first: u16, count: u16) {
    if !fits(first, count) {
        return change_flags(plc, area, 0, flag::RANGE);
    }
    set_area_word(plc, area + work::SEND, first);
    set_area_word(plc, area + work::SEND_COUNT, count);
    change_flags(plc, area, flag::SENT, flag::SEND);
}

/// Waits for characters.
pub(crate) fn urcv(plc: &mut dyn Plc, area: u32, first: u16, count: u16) {
    if !fits(first, count) {
        return change_flags(plc, area, 0, flag::RANGE);
    }
    set_area_word(plc, area + work::RECEIVE, first);
    set_area_word(plc, area + work::RECEIVE_COUNT, count);
    change_flags(plc, area, flag::RECEIVED, flag::RECEIVE);
}

/// UINIT finds fault with a work area whose receive area lies beyond the registers.
pub(crate) fn check_area(plc: &mut dyn Plc, area: u32) {
    let first = area_word(plc, area + work::RECEIVE);
    if !fits(first, area_word(plc, area + work::RECEIVE_COUNT)) {
        change_flags(plc, area, 0, flag::RANGE);
    }
}

/// A register of a work area; 0 of one that the model does not have.
fn area_word(plc: &dyn Plc, register: u32) -> u16 {
    plc.word(Class::D, register).unwrap_or(0) as u16
}

fn set_area_word(plc: &mut dyn Plc, register: u32, value: u16) {
    let _ = plc.set_word(Class::D, register, value as i16);
}

fn fits(first: u16, count: u16) -> bool {
    u32::from(first) + u32::from(count) <= FIRST_SPECIAL
}

fn change_flags(plc: &mut dyn Plc, area: u32, clear: u16, raise: u16) {
    let flags = area_word(plc, area + work::FLAGS);
    set_area_word(plc, area + work::FLAGS, flags & !clear | raise);
}
