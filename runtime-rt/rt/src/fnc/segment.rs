//! Segments of point tables of HM: where a slave is while its master moves (hm-motion-controller §8.3.4).

use super::table::{Maker, make};
use crate::cx::Cx;
use crate::fault::{Done, Fault};

/// Words of the parameters of a segment.
const KIND: i32 = 0;
const SCHEME: i32 = 1;
const DISPLACEMENT: i32 = 2;
const RANGE: i32 = 4;
const START_SPEED: i32 = 5;
const END_SPEED: i32 = 6;
const ACCELERATION: i32 = 7;
const TIME_UNIT: i32 = 8;
const PULSE_UNIT: i32 = 9;
const STATE: i32 = 10;

/// Change of speed over the segment.
#[derive(Clone, Copy)]
enum Curve {
    /// Evenly.
    Even,
    /// By a polynomial of the fourth degree for the way, with an acceleration that begins and ends with 0.
    Quartic,
}

/// A segment of a table. Ways are reckoned in `1 / (2 * time unit)` pulses, so that everything is whole.
struct Segment {
    curve: Curve,
    range: i128,
    points: i32,
    interval: i128,
    /// Twice the start speed.
    start: i128,
    /// The whole way.
    way: i128,
    time_unit: i128,
    pulse_unit: i128,
    /// The end speed was given, and not the way.
    by_speed: bool,
}

impl Segment {
    /// The segment that the parameters describe; `None` if they are invalid.
    fn described(cx: &Cx) -> Result<Option<Self>, Fault> {
        let number = |offset| cx.word(0, offset).map(i128::from);
        let unsigned = |offset| cx.word(0, offset).map(|word| i128::from(word as u16));
        let curve = match cx.word(0, KIND)? {
            0 => Curve::Even,
            2 => Curve::Quartic,
            _ => return Ok(None),
        };
        let by_speed = match cx.word(0, SCHEME)? {
            0 => false,
            1 => true,
            _ => return Ok(None),
        };
        let (range, interval) = (unsigned(RANGE)?, i128::from(cx.word(2, 0)?));
        let (time_unit, pulse_unit) = (unsigned(TIME_UNIT)?, unsigned(PULSE_UNIT)?);
        let right = range > 0 && interval > 0 && time_unit > 0 && pulse_unit > 0;
        if !right || range % interval != 0 {
            return Ok(None);
        }
        let start = number(START_SPEED)? * pulse_unit;
        let way = if by_speed {
            (start + number(END_SPEED)? * pulse_unit) * range
        } else {
            2 * time_unit * i128::from(cx.dword(0, DISPLACEMENT)?)
        };
        Ok(Some(Segment {
            curve,
            range,
            points: (range / interval) as i32,
            interval,
            start: 2 * start,
            way,
            time_unit,
            pulse_unit,
            by_speed,
        }))
    }

    /// The way beyond that of the start speed, which is due to acceleration.
    fn gain(&self) -> i128 {
        self.way - self.start * self.range
    }

    /// Pulses up to a point.
    fn way_to(&self, point: i32) -> i32 {
        let (at, range) = (i128::from(point) * self.interval, self.range);
        let (part, whole) = match self.curve {
            Curve::Even => (at * at, range * range),
            Curve::Quartic => (
                (2 * range - at) * at * at * at,
                range * range * range * range,
            ),
        };
        let way = self.start * at * whole + self.gain() * part;
        rounded(way, 2 * self.time_unit * whole) as i32
    }

    /// In pulses.
    fn displacement(&self) -> i32 {
        rounded(self.way, 2 * self.time_unit) as i32
    }

    /// In units of pulses over units of time.
    fn end_speed(&self) -> i16 {
        let twice = 2 * self.way - self.start * self.range;
        rounded(twice, 2 * self.range * self.pulse_unit) as i16
    }

    /// The highest one, in units of pulses over the square of units of time.
    fn acceleration(&self) -> i16 {
        let (times, over) = match self.curve {
            Curve::Even => (1, 1),
            Curve::Quartic => (3, 2),
        };
        let squared = self.range * self.range * self.pulse_unit;
        rounded(self.gain() * self.time_unit * times, squared * over) as i16
    }
}

/// The quotient, rounded to the nearest number; halves away from 0.
fn rounded(a: i128, b: i128) -> i128 {
    let half = b / 2;
    (if a < 0 { a - half } else { a + half }) / b
}

impl Maker for Segment {
    const STATE: i32 = STATE;

    fn of(cx: &Cx) -> Result<Option<Self>, Fault> {
        Segment::described(cx)
    }

    fn points(&self) -> i32 {
        self.points
    }

    fn position(&self, point: i32) -> i32 {
        self.way_to(point)
    }

    fn end(&self, cx: &mut Cx) -> Done {
        if self.by_speed {
            cx.set_dword(0, DISPLACEMENT, self.displacement())?;
        } else {
            cx.set_word(0, END_SPEED, self.end_speed())?;
        }
        cx.set_word(0, ACCELERATION, self.acceleration())
    }
}

/// PTAB: appends the points of a segment to a table. Memory: that of [`make`].
pub fn ptab(cx: &mut Cx) -> Done {
    make::<Segment>(cx)
}

#[cfg(test)]
mod tests {
    use crate::double::{Double, reg};
    use crate::{RtFn, k};

    /// The table after D5000 with the segment at D1000.
    fn run(segment: &[i32], interval: i32) -> Double {
        let mut plc = Double::new();
        plc.set_d(1000, segment);
        plc.set_dd(5000, 1);
        for _ in 0..40 {
            let operands = [reg(1000), reg(5000), k(interval)];
            plc.scan(10, true, RtFn::Ptab, &operands).unwrap();
        }
        plc
    }

    #[test]
    fn a_quartic_curve_is_symmetrical() {
        let plc = run(&[2, 0, 8000, 0, 100, 0, 0, 0, 1, 1], 1);
        assert_eq!(plc.d(1010, 1), [32]);
        assert_eq!([plc.dd(5102), plc.dd(5202)], [1500, 8000]);
        // It ends twice as fast as it is on average, and its acceleration is half as high again as an even one.
        assert_eq!(plc.d(1006, 2), [160, 2]);
    }

    #[test]
    fn what_cannot_be_computed_is_wrong() {
        let wrong = [
            [1, 0, 100, 0, 10, 0, 0, 0, 1, 1],
            [0, 2, 100, 0, 10, 0, 0, 0, 1, 1],
            [0, 0, 100, 0, 0, 0, 0, 0, 1, 1],
            [0, 0, 100, 0, 10, 0, 0, 0, 0, 1],
        ];
        for segment in wrong {
            assert_eq!(run(&segment, 1).d(1010, 1), [64]);
        }
        assert_eq!(run(&[0, 0, 100, 0, 10, 0, 0, 0, 1, 1], 3).d(1010, 1), [64]);
    }
}
