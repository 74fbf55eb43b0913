//! RS and RS2: data, and what surrounds it on the line.

use crate::comm::line::Received;
use crate::comm::port::{Session, has_come};
use crate::comm::wiring::{Choice, Envelope, is_on, set, set_value, value};
use crate::comm::{LineFault, hex_digits};
use crate::special::Register;

/// Bits of the format word: characters before the data, and after it. RS and RS2 send them and wait for them.
const START: u16 = 1 << 8;
const END: u16 = 1 << 9;
/// Bits of the format word of RS2: two digits of a sum, then CR and LF (FX data communication manual, part F, §8.2).
const SUM: u16 = 1 << 13;
const CR_LF: u16 = 1 << 15;

/// Up to four characters before or after data.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Mark {
    bytes: [u8; 4],
    /// Number of characters.
    pub(super) length: u8,
}

impl Mark {
    const NONE: Mark = Mark {
        bytes: [0; 4],
        length: 0,
    };

    /// One character.
    const fn one(byte: u8) -> Self {
        Mark {
            bytes: [byte, 0, 0, 0],
            length: 1,
        }
    }

    /// Those of two registers; the first zero ends them.
    fn of_registers(words: [u16; 2]) -> Self {
        let [[a, b], [c, d]] = words.map(u16::to_le_bytes);
        let bytes = [a, b, c, d];
        let length = bytes.iter().position(|&byte| byte == 0).unwrap_or(4) as u8;
        Mark { bytes, length }
    }

    /// Character number `index`.
    pub(super) fn at(&self, index: u16) -> u8 {
        self.bytes.get(usize::from(index)).copied().unwrap_or(0)
    }

    /// Returns true if the last characters received, the last one the lowest, are these.
    fn ends(&self, window: u32) -> bool {
        let received = window.to_be_bytes();
        let length = usize::from(self.length).min(4);
        length > 0 && received[4 - length..] == self.bytes[..length]
    }
}

/// Marks around data.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Marks {
    pub(super) before: Mark,
    pub(super) after: Mark,
    sum: bool,
    cr_lf: bool,
}

/// CR and LF.
const LINE_END: [u8; 2] = *b"\r\n";

impl Marks {
    /// Nothing.
    pub(super) const NONE: Marks = Marks {
        before: Mark::NONE,
        after: Mark::NONE,
        sum: false,
        cr_lf: false,
    };

    /// Number of characters after the end of the data.
    const fn tail_length(&self) -> u8 {
        2 * self.sum as u8 + 2 * self.cr_lf as u8
    }

    /// All characters around data.
    fn length(&self) -> u16 {
        let all = [self.before.length, self.after.length, self.tail_length()];
        all.into_iter().map(u16::from).sum()
    }

    /// Character number `index` after the end of data with this sum.
    pub(super) fn tail(&self, index: u16, sum: u8) -> u8 {
        let digits = [sum >> 4, sum & 15].map(|digit| match digit {
            0..=9 => b'0' + digit,
            _ => b'A' + digit - 10,
        });
        let [a, b] = if self.sum { digits } else { LINE_END };
        let [c, d] = LINE_END;
        [a, b, c, d][usize::from(index.min(3))]
    }

    /// Mark that ends received data: CR and LF if there is no other.
    fn end(&self) -> (Mark, u8) {
        if self.after.length == 0 && self.cr_lf {
            let [cr, lf] = LINE_END;
            let bytes = [cr, lf, 0, 0];
            return (Mark { bytes, length: 2 }, 0);
        }
        (self.after, self.tail_length())
    }
}

impl Session<'_> {
    /// Marks around data, as the format word selects them.
    fn marks(&self) -> Marks {
        let format = value(self.plc, self.own.wiring.format);
        let is = |bit: u16| format & bit != 0;
        if let Some(envelope) = self.own.wiring.envelope {
            let mark = |bit: u16, first: Register| match is(bit) {
                true => Mark::of_registers(first.run().map(|register| register.value(self.plc))),
                false => Mark::NONE,
            };
            return Marks {
                before: mark(START, envelope.headers),
                after: mark(END, envelope.terminators),
                sum: is(SUM),
                cr_lf: is(CR_LF),
            };
        }
        let mark = |bit: u16, register: Option<Register>| match register.filter(|_| is(bit)) {
            Some(register) => Mark::one(register.value(self.plc) as u8),
            None => Mark::NONE,
        };
        Marks {
            before: mark(START, self.own.wiring.start),
            after: mark(END, self.own.wiring.end),
            ..Marks::NONE
        }
    }

    /// Shows a sum of RS2.
    fn show_sum(&mut self, register: fn(Envelope) -> Option<Register>, sum: u16) {
        if let Some(register) = self.own.wiring.envelope.and_then(register) {
            register.set(self.plc, sum & 0xff);
        }
    }

    pub(super) fn take_rs(&mut self, character: Received) {
        self.close_rs(self.begin_of(character));
        let transfer = self.own.progress.free.transfer;
        let wants = self.own.progress.free.owner != 0 && transfer.receive > 0;
        if !wants || is_on(self.plc, self.own.wiring.done) || self.is_wrong(character) {
            return;
        }
        let byte = character.byte & self.status.format.mask();
        let marks = self.marks();
        self.own.progress.free.window = self.own.progress.free.window << 8 | u32::from(byte);
        if !self.own.progress.free.listens {
            let begins = marks.before.ends(self.own.progress.free.window);
            if marks.before.length > 0 && !begins {
                return;
            }
            self.own.progress.free.listens = true;
            self.own.progress.free.received = 0;
            self.own.progress.free.sum = 0;
            self.own.progress.free.tail = 0;
            self.own.progress.free.last_us = character.at_us;
            self.show_sum(|envelope| Some(envelope.computed_sum), 0);
            if begins {
                self.own.progress.free.window = 0;
                return;
            }
            self.own.progress.free.window = byte.into();
        }
        self.own.progress.free.last_us = character.at_us;
        match self.own.progress.free.tail {
            0 => self.take_data(byte, &marks),
            _ => self.take_tail(byte, &marks),
        }
    }

    /// A character of the data, or of what ends it. RS2 stores that, too.
    fn take_data(&mut self, byte: u8, marks: &Marks) {
        let with_end = self.own.wiring.envelope.is_some();
        let (end, tail) = marks.end();
        let received = self.own.progress.free.received;
        let whole = received >= u16::from(end.length.saturating_sub(1));
        let ends = whole && end.ends(self.own.progress.free.window);
        if !ends || with_end {
            self.store_data(received, byte);
            self.own.progress.free.received += 1;
            let sum = self.own.progress.free.sum.wrapping_add(byte.into());
            self.own.progress.free.sum = sum;
            self.show_sum(|envelope| Some(envelope.computed_sum), sum);
        }
        if ends && tail > 0 {
            self.own.progress.free.tail = tail;
            self.own.progress.free.claimed = 0;
        } else if ends || self.own.progress.free.received >= self.own.progress.free.transfer.receive
        {
            self.complete_rs();
        }
    }

    /// A character of the sum, CR or LF.
    fn take_tail(&mut self, byte: u8, marks: &Marks) {
        let free = &mut self.own.progress.free;
        let index = marks.tail_length().saturating_sub(free.tail);
        free.tail -= 1;
        if marks.sum && index < 2 {
            const WRONG: u32 = 0x100;
            let digit = hex_digits(&[byte]).unwrap_or(WRONG);
            free.claimed = free.claimed << 4 | digit as u16;
        }
        if free.tail > 0 {
            return;
        }
        let (sum, claimed) = (free.sum & 0xff, free.claimed);
        if !marks.sum {
            return self.complete_rs();
        }
        self.show_sum(|envelope| envelope.received_sum, claimed);
        if sum == claimed {
            self.complete_rs();
        } else {
            self.note(LineFault::Sum);
            self.end_reception();
        }
    }

    /// Ends a reception that is complete.
    fn complete_rs(&mut self) {
        self.end_reception();
        self.own.progress.free.complete = true;
        set(self.plc, self.own.wiring.done, true);
    }

    /// An answer that does not continue in time is over. On FX3 that completes it.
    fn close_rs(&mut self, at_us: u32) {
        let free = self.own.progress.free;
        let quiet_us = at_us.wrapping_sub(free.last_us);
        let late =
            has_come(at_us, free.last_us) && quiet_us > self.own.wiring.time_out_us(self.plc);
        if free.listens && late {
            self.end_reception();
            set(self.plc, self.own.wiring.late, true);
            if matches!(self.own.wiring.choice, Choice::Channel | Choice::Channel0) {
                self.complete_rs();
            }
        }
    }

    pub(super) fn advance_rs(&mut self) {
        let wiring = self.own.wiring;
        self.close_rs(self.now_us);
        let free = self.own.progress.free;
        let asked = free.owner != 0 && is_on(self.plc, wiring.sends);
        let busy = free.listens && self.status.format.half_duplex;
        let marks = self.marks();
        if asked && !self.status.sending && !busy {
            self.own.progress.free.total = free.transfer.send + marks.length();
            self.own.progress.free.taken = 0;
            self.own.progress.free.sent_sum = 0;
            self.status.sending = true;
        }
        if self.status.sending {
            let left = self.send_data(&marks);
            // RS2 counts the data alone.
            let shown = match wiring.envelope {
                Some(_) => {
                    let after = marks.length() - u16::from(marks.before.length);
                    left.saturating_sub(after).min(free.transfer.send)
                }
                None => left,
            };
            set_value(self.plc, wiring.left, shown);
            self.show_sum(
                |envelope| Some(envelope.sent_sum),
                self.own.progress.free.sent_sum,
            );
            if left == 0 {
                self.status.sending = false;
                set(self.plc, wiring.sends, false);
            }
        }
        let waits = asked && busy && !self.status.sending;
        set(self.plc, wiring.waits, waits);
        // The program's reset of the flag opens the next reception.
        if self.own.progress.free.complete && !is_on(self.plc, wiring.done) {
            self.own.progress.free.complete = false;
            self.own.progress.free.received = 0;
        }
        let free = self.own.progress.free;
        set_value(self.plc, wiring.received, free.received);
        set(self.plc, wiring.receives, free.listens);
    }
}
