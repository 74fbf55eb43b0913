//! Characters on a line as frames, for the log and the table of connections. What the PLC takes for a frame is its own
//! affair: this is what somebody sees who listens on the wire.

use rungc_rt::comm::{Cut, LineFormat, Protocol, fx_port, modbus};
use rungc_sim::serve::Direction;

/// Silence that ends a frame of protocols whose frames have an end that is not looked for here, in microseconds.
const GAP_US: u32 = 50_000;

/// The same for those whose end is looked for.
const LONG_GAP_US: u32 = 1_000_000;

/// Characters that went one way, one after the other.
#[derive(Debug, Default)]
pub struct Frames {
    characters: Vec<u8>,
    incoming: bool,
    last_us: u32,
}

/// A frame, and when its last character was there.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Whole {
    /// Direction.
    pub direction: Direction,
    /// Time in microseconds since the run began, wrapping.
    pub at_us: u32,
    /// Its characters.
    pub bytes: Vec<u8>,
}

impl Frames {
    /// A character was there at a time; returns the frame that ended before it, and the one that ends with it.
    pub fn push(
        &mut self,
        direction: Direction,
        at_us: u32,
        byte: u8,
        line: (Protocol, LineFormat),
    ) -> [Option<Whole>; 2] {
        let begin_us = at_us.wrapping_sub(line.1.character_us());
        let before = match (direction == Direction::In) == self.incoming {
            true => self.end(begin_us, line),
            false => self.take(),
        };
        self.incoming = direction == Direction::In;
        self.characters.push(byte);
        self.last_us = at_us;
        let ends = self.cut(line.0) == Some(Cut::Whole);
        [before, if ends { self.take() } else { None }]
    }

    /// The frame that is over at a time.
    pub fn end(
        &mut self,
        now_us: u32,
        (protocol, format): (Protocol, LineFormat),
    ) -> Option<Whole> {
        let gap_us = match self.cut(protocol) {
            _ if protocol.ends_by_silence() || !self.incoming => format.silence_us(),
            Some(_) => LONG_GAP_US,
            None => GAP_US,
        };
        let quiet_us = now_us.wrapping_sub(self.last_us) as i32;
        // Characters come with times in whole microseconds.
        if quiet_us + 2 >= gap_us as i32 {
            self.take()
        } else {
            None
        }
    }

    /// Returns the characters so far, complete or not.
    pub fn take(&mut self) -> Option<Whole> {
        let bytes = std::mem::take(&mut self.characters);
        let direction = if self.incoming {
            Direction::In
        } else {
            Direction::Out
        };
        let at_us = self.last_us;
        (!bytes.is_empty()).then_some(Whole {
            direction,
            at_us,
            bytes,
        })
    }

    /// Classification of a request, in a protocol whose frames show their end.
    fn cut(&self, protocol: Protocol) -> Option<Cut> {
        let cut = match protocol {
            Protocol::ProgrammingPort => fx_port::cut,
            Protocol::ModbusAscii => modbus::cut_ascii,
            // Frames of both ways follow each other without a pause.
            Protocol::Can => {
                let ends = self.characters.ends_with(b"\r");
                return Some(if ends { Cut::Whole } else { Cut::More });
            }
            _ => return None,
        };
        self.incoming.then(|| cut(&self.characters))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn silence_and_the_other_way_end_frames() {
        let format = LineFormat::from_word(0x81);
        let line = (Protocol::ModbusRtu, format);
        let mut frames = Frames::default();
        let mut push = |direction, at_us, byte| {
            let whole = frames.push(direction, at_us, byte, line);
            whole.map(|whole| whole.map(|whole| whole.bytes))
        };
        assert_eq!(push(Direction::In, 1041, 1), [None, None]);
        assert_eq!(push(Direction::In, 2082, 2), [None, None]);
        assert_eq!(push(Direction::In, 9000, 3), [Some(vec![1, 2]), None]);
        assert_eq!(push(Direction::Out, 12_000, 4), [Some(vec![3]), None]);
        assert_eq!(frames.end(13_000, line), None);
        let whole = frames.end(16_000, line).unwrap();
        assert_eq!((whole.direction, whole.at_us), (Direction::Out, 12_000));
    }

    #[test]
    fn frames_on_can_follow_each_other() {
        let line = (Protocol::Can, LineFormat::new());
        let mut frames = Frames::default();
        let whole = b"t2000\rt2011FF\r"
            .iter()
            .flat_map(|&byte| frames.push(Direction::Out, 0, byte, line));
        let whole: Vec<_> = whole.flatten().map(|whole| whole.bytes).collect();
        assert_eq!(whole, [b"t2000\r".to_vec(), b"t2011FF\r".to_vec()]);
    }

    #[test]
    fn a_request_with_an_end_is_whole_at_once() {
        let line = (
            Protocol::ProgrammingPort,
            LineFormat::seven_even(9600, false),
        );
        let whole = Frames::default().push(Direction::In, 0, 5, line);
        assert_eq!(
            whole.map(|whole| whole.map(|w| w.bytes)),
            [None, Some(vec![5])]
        );
    }
}
