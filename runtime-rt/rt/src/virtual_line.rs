//! A serial line for tests and simulation, with exact time.

use crate::comm::{LineFormat, Received};
use crate::hal::SerialPort;

/// Characters that wait on their way to the PLC, and on their way from it.
const WAITING: usize = 640;

/// Characters in the order of their times.
#[derive(Clone, Debug)]
struct Queue {
    characters: [Received; WAITING],
    first: usize,
    len: usize,
}

impl Queue {
    const fn new() -> Self {
        Queue {
            characters: [const { Received::new() }; WAITING],
            first: 0,
            len: 0,
        }
    }

    fn push(&mut self, character: Received) -> bool {
        if self.len == WAITING {
            return false;
        }
        self.characters[(self.first + self.len) % WAITING] = character;
        self.len += 1;
        true
    }

    /// Takes the oldest character that was there by `now_us`.
    fn pop(&mut self, now_us: u32) -> Option<Received> {
        let oldest = self.characters[self.first];
        if self.len == 0 || (now_us.wrapping_sub(oldest.at_us) as i32) < 0 {
            return None;
        }
        self.first = (self.first + 1) % WAITING;
        self.len -= 1;
        Some(oldest)
    }
}

/// A line without allocation. What the PLC sends has the times that its bits take, from the moment at which it is
/// handed over.
#[derive(Clone, Debug)]
pub struct VirtualLine {
    format: LineFormat,
    to_plc: Queue,
    from_plc: Queue,
    /// End of the last character that the PLC sends; nanoseconds beyond the microsecond.
    end_us: u32,
    end_ns: u32,
}

impl VirtualLine {
    pub(crate) const fn new() -> Self {
        VirtualLine {
            format: LineFormat::new(),
            to_plc: Queue::new(),
            from_plc: Queue::new(),
            end_us: 0,
            end_ns: 0,
        }
    }

    /// Line format set up by the PLC.
    pub fn format(&self) -> LineFormat {
        self.format
    }

    /// A character comes to the PLC, not before those that are on their way; `None` if too many are.
    pub fn feed(&mut self, character: Received) -> Option<()> {
        self.to_plc.push(character).then_some(())
    }

    /// Takes the oldest character that the PLC has sent by `now_us`, with the time at which its last bit was out.
    pub fn take(&mut self, now_us: u32) -> Option<Received> {
        self.from_plc.pop(now_us)
    }

    /// The same as one number: the time, shifted left by 8, plus the character.
    pub fn take_packed(&mut self, now_us: u32) -> Option<i64> {
        let sent = self.take(now_us)?;
        Some(i64::from(sent.at_us) << 8 | i64::from(sent.byte))
    }
}

impl SerialPort for VirtualLine {
    fn set_format(&mut self, format: LineFormat) {
        self.format = format;
    }

    fn receive(&mut self, now_us: u32) -> Option<Received> {
        self.to_plc.pop(now_us)
    }

    fn send(&mut self, byte: u8, now_us: u32) -> bool {
        if (self.end_us.wrapping_sub(now_us) as i32) < 0 {
            (self.end_us, self.end_ns) = (now_us, 0);
        }
        let ns = self.format.nanoseconds(2) + u64::from(self.end_ns);
        let at_us = self.end_us.wrapping_add((ns / 1000) as u32);
        let sent = self.from_plc.push(Received {
            at_us,
            byte: byte & self.format.mask(),
            ..Received::new()
        });
        if sent {
            (self.end_us, self.end_ns) = (at_us, (ns % 1000) as u32);
        }
        sent
    }

    fn unsent(&mut self, now_us: u32) -> u16 {
        let rest_us = self.end_us.wrapping_sub(now_us) as i32;
        if rest_us <= 0 {
            return 0;
        }
        let rest_ns = u64::from(rest_us.unsigned_abs()) * 1000 + u64::from(self.end_ns);
        rest_ns.div_ceil(self.format.nanoseconds(2).max(1)) as u16
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn characters_take_their_time() {
        let mut line = VirtualLine::new();
        line.set_format(LineFormat::from_word(0x81));
        assert!(line.send(1, 0) && line.send(2, 0) && line.send(3, 0));
        assert_eq!(line.unsent(0), 3);
        assert_eq!(line.take(1040), None);
        let sent = core::array::from_fn(|_| line.take(4000).map(|c| (c.at_us, c.byte)));
        assert_eq!(sent, [Some((1041, 1)), Some((2083, 2)), Some((3124, 3))]);
        assert_eq!(
            (line.take(9000), line.unsent(3123), line.unsent(3124)),
            (None, 1, 0)
        );
        line.send(4, 10_000);
        assert_eq!(line.take(12_000).map(|c| c.at_us), Some(11_041));
    }

    #[test]
    fn a_full_line_refuses() {
        let mut line = VirtualLine::new();
        for _ in 0..WAITING {
            line.feed(Received::new()).unwrap();
        }
        assert_eq!(line.feed(Received::new()), None);
        assert!(line.receive(0).is_some());
        assert_eq!(line.feed(Received::new()), Some(()));
    }
}
