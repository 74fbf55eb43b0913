//! The axis module of L01S (l01s-programming §9.4): four axes, each with a pulse and a direction output and with inputs
//! for its origin and its limit.
//!
//! Axis n has the terminals X 2n (origin), X 2n+1 (limit), Y 2n (pulses) and Y 2n+1 (direction, on towards smaller
//! positions). The limit stops an axis at once, except that the return to the origin by way of the limit turns round
//! there.

use super::{AxisWord, Module, Role};
use crate::pulse::{Generator, Train};

/// Number of axes.
const AXES: usize = 4;

/// Digits of the mode.
const BY_DISTANCE: i16 = 1;
const TO_ORIGIN: i16 = 4;

/// Course of a return to the origin.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Homing {
    /// It does not take place.
    None,
    /// It looks for the limit, to turn round there.
    Limit,
    /// It looks for the origin.
    Origin,
    /// It leaves the origin slowly.
    Leave,
}

/// An axis.
#[derive(Clone, Copy, Debug)]
struct Axis {
    generator: Generator,
    position: i32,
    homing: Homing,
}

/// The axes, and their time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axes {
    all: [Axis; AXES],
    now_us: u32,
    /// The control word as it was last.
    control: i16,
}

impl Axes {
    /// Axes at rest at position 0.
    pub(super) const fn new() -> Self {
        let axis = Axis {
            generator: Generator::new(),
            position: 0,
            homing: Homing::None,
        };
        Axes {
            all: [axis; AXES],
            now_us: 0,
            control: 0,
        }
    }
}

impl Module {
    fn axis_word(&self, word: AxisWord, n: usize) -> i16 {
        self.get(Role::Axis(word), n)
    }

    /// A pair of words, the low one first.
    fn axis_pair(&self, word: AxisWord, n: usize) -> i32 {
        let [low, high] = [n, n + 1].map(|n| self.axis_word(word, n) as u16);
        (u32::from(high) << 16 | u32::from(low)) as i32
    }

    /// A hexadecimal digit of a word.
    fn axis_digit(&self, word: AxisWord, axis: usize) -> i16 {
        self.axis_word(word, 0) >> (4 * axis) & 0xf
    }

    /// The program has written a word.
    pub(super) fn order(&mut self, word: AxisWord, n: usize) {
        match word {
            AxisWord::Control => self.obey(self.axis_word(AxisWord::Control, 0)),
            AxisWord::Position => {
                let position = self.axis_pair(AxisWord::Position, n & !1);
                if let Some(axis) = self.axes.all.get_mut(n / 2) {
                    axis.position = position;
                }
            }
            _ => {}
        }
    }

    fn obey(&mut self, control: i16) {
        let rises = control & !self.axes.control;
        self.axes.control = control;
        for axis in 0..AXES {
            if rises >> (axis + 8) & 1 == 1 {
                self.mark(AxisWord::Done, axis, false);
            }
            if control >> (axis + 4) & 1 == 1 {
                self.halt(axis);
            } else if rises >> axis & 1 == 1 {
                self.start_axis(axis);
            }
        }
        self.show_axes();
    }

    fn mark(&mut self, word: AxisWord, axis: usize, on: bool) {
        let bits = self.axis_word(word, 0);
        let bit = 1 << axis;
        let bits = if on { bits | bit } else { bits & !bit };
        self.set(Role::Axis(word), 0, bits);
    }

    fn halt(&mut self, axis: usize) {
        if let Some(axis) = self.axes.all.get_mut(axis) {
            axis.generator.halt();
            axis.homing = Homing::None;
        }
    }

    fn start_axis(&mut self, n: usize) {
        let Some(&axis) = self.axes.all.get(n) else {
            return;
        };
        self.mark(AxisWord::Done, n, false);
        let target = self.axis_pair(AxisWord::Move, 4 * n);
        let hz = self.axis_pair(AxisWord::Move, 4 * n + 2);
        match self.axis_digit(AxisWord::Mode, n) {
            TO_ORIGIN => {
                let by_limit = self.axis_digit(AxisWord::HomingMode, n) == 2;
                let chooses = self.axis_word(AxisWord::Options, 0) >> (4 + n) & 1 == 1;
                let reverse = !chooses || axis.position >= 0;
                let first = match by_limit {
                    true => Homing::Limit,
                    false => Homing::Origin,
                };
                self.home(n, first, reverse);
            }
            mode => {
                let distance = match mode {
                    BY_DISTANCE => target,
                    _ => target.wrapping_sub(axis.position),
                };
                match distance {
                    0 => self.mark(AxisWord::Done, n, true),
                    _ => self.send(n, hz, distance.unsigned_abs(), distance < 0),
                }
            }
        }
    }

    /// Sends pulses at a speed in Hz; 0 pulses: without end.
    fn send(&mut self, n: usize, hz: i32, total: u32, reverse: bool) {
        let hz = u32::try_from(hz).unwrap_or(0).min(100_000);
        let ramp_ms = u32::from(self.axis_word(AxisWord::Ramp, n).max(0).unsigned_abs());
        let lowest = self.axis_word(AxisWord::LowestSpeed, n).max(1);
        let lowest = u64::from(lowest.unsigned_abs()) * 1000;
        let slope = Train::slope(hz, ramp_ms);
        let now_us = self.axes.now_us;
        if let Some(axis) = self.axes.all.get_mut(n) {
            axis.generator.set_time(now_us);
            axis.generator.start(Train {
                speed: hz * 1000,
                lowest: lowest * lowest,
                up: slope,
                down: slope,
                total,
                reverse,
            });
        }
    }

    /// Begins a part of the return to the origin.
    fn home(&mut self, n: usize, homing: Homing, reverse: bool) {
        let hz = match homing {
            Homing::Leave => self.axis_word(AxisWord::SlowHoming, 0).into(),
            _ => self.axis_pair(AxisWord::FastHoming, 0),
        };
        self.send(n, hz, 0, reverse);
        if let Some(axis) = self.axes.all.get_mut(n) {
            axis.homing = homing;
        }
    }

    /// A millisecond of all axes.
    pub(super) fn move_axes(&mut self) {
        self.axes.now_us = self.axes.now_us.wrapping_add(1000);
        let now_us = self.axes.now_us;
        for n in 0..AXES {
            let Some(axis) = self.axes.all.get_mut(n).filter(|a| a.generator.is_busy()) else {
                continue;
            };
            let reverse = axis.generator.is_reverse();
            let pulses = axis.generator.advance(now_us) as i32;
            let pulses = if reverse { -pulses } else { pulses };
            axis.position = axis.position.wrapping_add(pulses);
            let (homing, is_complete) = (axis.homing, axis.generator.is_complete());
            let (origin, limit) = (self.is_on(2 * n), self.is_on(2 * n + 1));
            let turns = self.axis_digit(AxisWord::HomingMode, n) != 0;
            match homing {
                Homing::None if limit => self.halt(n),
                Homing::None if is_complete => self.mark(AxisWord::Done, n, true),
                Homing::None => {}
                Homing::Limit if limit => self.home(n, Homing::Origin, !reverse),
                Homing::Limit => {}
                Homing::Origin if origin => self.home(n, Homing::Leave, reverse != turns),
                Homing::Origin if limit && !turns => self.halt(n),
                Homing::Origin => {}
                Homing::Leave if !origin => {
                    self.halt(n);
                    if let Some(axis) = self.axes.all.get_mut(n) {
                        axis.position = 0;
                    }
                    self.mark(AxisWord::Done, n, true);
                }
                Homing::Leave => {}
            }
        }
        self.show_axes();
    }

    /// Positions, what moves, and the directions.
    fn show_axes(&mut self) {
        for n in 0..AXES {
            let Some(&axis) = self.axes.all.get(n) else {
                continue;
            };
            let is_busy = axis.generator.is_busy();
            self.mark(AxisWord::Busy, n, is_busy);
            let position = axis.position as u32;
            self.set(Role::Axis(AxisWord::Position), 2 * n, position as i16);
            let high = (position >> 16) as i16;
            self.set(Role::Axis(AxisWord::Position), 2 * n + 1, high);
            let turned = self.axis_word(AxisWord::Options, 0) >> n & 1 == 1;
            let back = is_busy && axis.generator.is_reverse() != turned;
            let pulse = is_busy && axis.generator.level();
            let bits = u16::from(pulse) | u16::from(back) << 1;
            self.points[1] = self.points[1] & !(3 << (2 * n)) | bits << (2 * n);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Kind, Module, Quantity, Signal};

    fn module() -> Module {
        Module::new(Kind::find("L02S-4AXIS").unwrap())
    }

    fn write(module: &mut Module, words: &[(u16, i16)]) {
        for &(number, value) in words {
            module.write(number, value).unwrap();
        }
    }

    fn position(module: &Module, axis: u16) -> i32 {
        let [low, high] = [44, 45].map(|n| module.read(n + 2 * axis).unwrap() as u16);
        (u32::from(high) << 16 | u32::from(low)) as i32
    }

    fn terminal(module: &mut Module, number: u8, on: bool) {
        let signal = Signal {
            quantity: Quantity::InputTerminal,
            millionths: on.into(),
        };
        module.connect(number, signal).unwrap();
    }

    #[test]
    fn an_axis_goes_to_a_position_and_back() {
        // l01s-programming §9.4.2: 2,000,000 pulses forward and back, here 20,000.
        let mut module = module();
        assert_eq!((module.read(0), module.read(1)), (Some(50), Some(0x4514)));
        write(&mut module, &[(7, 1), (8, 20_000), (10, 10_000), (6, 1)]);
        assert_eq!((module.read(42), module.read(43)), (Some(1), Some(0)));
        module.pass(1_000_000);
        let under_way = position(&module, 0);
        assert!((9_000..10_000).contains(&under_way), "{under_way}");
        module.pass(1_200_000);
        assert_eq!(position(&module, 0), 20_000);
        assert_eq!((module.read(42), module.read(43)), (Some(0), Some(1)));
        // Back to position 0, absolutely; the direction output is on.
        write(&mut module, &[(6, 0), (7, 0), (8, 0), (6, 1)]);
        assert_eq!(module.read(43), Some(0));
        module.pass(100_000);
        assert_eq!(module.signal(1, Quantity::OutputTerminal), Some(1_000_000));
        module.pass(3_000_000);
        assert_eq!((position(&module, 0), module.read(43)), (0, Some(1)));
        write(&mut module, &[(6, 0x0100)]);
        assert_eq!(module.read(43), Some(0));
    }

    #[test]
    fn stop_bits_and_limits_stop_at_once() {
        let mut module = module();
        write(
            &mut module,
            &[(7, 0x10), (12, 30_000), (14, 1000), (38, 1000), (6, 2)],
        );
        module.pass(500_000);
        write(&mut module, &[(6, 0x22)]);
        let stopped = position(&module, 1);
        assert!((498..=500).contains(&stopped), "{stopped}");
        module.pass(500_000);
        assert_eq!(position(&module, 1), stopped);
        write(&mut module, &[(6, 0), (6, 2)]);
        terminal(&mut module, 3, true);
        module.pass(500_000);
        assert_eq!(
            (position(&module, 1), module.read(42)),
            (stopped + 1, Some(0))
        );
        assert_eq!(module.read(43), Some(0));
    }

    #[test]
    fn the_ways_to_the_origin() {
        for mode in 0..3 {
            let mut module = module();
            write(
                &mut module,
                &[
                    (7, 4),
                    (24, 2000),
                    (26, 100),
                    (37, 100),
                    (41, mode),
                    (44, 500),
                    (6, 1),
                ],
            );
            module.pass(200_000);
            assert!(position(&module, 0) < 500, "{mode}");
            if mode == 2 {
                terminal(&mut module, 1, true);
                module.pass(200_000);
                terminal(&mut module, 1, false);
            }
            let before = position(&module, 0);
            terminal(&mut module, 0, true);
            module.pass(2_000);
            let at_switch = position(&module, 0);
            module.pass(200_000);
            let slow = (position(&module, 0) - at_switch).abs();
            assert!((18..=22).contains(&slow), "{mode}: {slow}");
            let turned = (position(&module, 0) > at_switch) != (at_switch > before);
            assert_eq!(turned, mode != 0, "{mode}");
            terminal(&mut module, 0, false);
            module.pass(2_000);
            assert_eq!(
                (position(&module, 0), module.read(43)),
                (0, Some(1)),
                "{mode}"
            );
        }
    }
}
