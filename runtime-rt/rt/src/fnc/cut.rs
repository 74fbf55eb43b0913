//! Cam tables of flying and rotary cuts of HM (hm-motion-controller §8.4.3, §8.4.4): the slave waits, catches up with
//! the master, goes with it while it cuts, and comes to rest; or goes back.

use super::table::{Maker, make};
use crate::cx::Cx;
use crate::fault::{Done, Fault};

/// Units of speeds and accelerations: pulses per millisecond, and per its square.
#[derive(Clone, Copy)]
struct Units {
    speed: f64,
    acceleration: f64,
}

impl Units {
    /// From the units of time and of pulses at these words; `None` if one is 0.
    fn of(cx: &Cx, time: i32, pulses: i32) -> Result<Option<Self>, Fault> {
        let [time, pulses] = [cx.word(0, time)? as u16, cx.word(0, pulses)? as u16].map(f64::from);
        Ok((time > 0.0 && pulses > 0.0).then(|| Units {
            speed: pulses / time,
            acceleration: pulses / (time * time),
        }))
    }

    /// A speed in these units.
    fn shown(self, speed: f64) -> i16 {
        nearest(speed / self.speed).clamp(0, i32::from(i16::MAX)) as i16
    }
}

/// The nearest whole number.
fn nearest(value: f64) -> i32 {
    (if value < 0.0 {
        value - 0.5
    } else {
        value + 0.5
    }) as i32
}

/// The square root of a number that is not negative, by Newton.
fn root(square: f64) -> f64 {
    let mut guess = if square > 1.0 { square } else { 1.0 };
    for _ in 0..64 {
        guess = 0.5 * (guess + square / guess);
    }
    guess
}

/// Distance covered in the part `part` of a time in which a speed changes from `from` to 1 by a polynomial of the
/// fourth degree for the way; the acceleration begins and ends with 0.
fn catching_up(from: f64, part: f64) -> f64 {
    from * part + (1.0 - from) * (2.0 - part) * part * part * part
}

/// The highest speed of the master at which a slave keeps to its own limits: `speed` and `acceleration` are what it
/// does for each pulse of the master, and for its square.
fn limit(units: Units, limits: [f64; 2], speed: f64, acceleration: f64) -> f64 {
    let [highest, hardest] = [limits[0] * units.speed, limits[1] * units.acceleration];
    let by_speed = if speed > 0.0 {
        highest / speed
    } else {
        f64::MAX
    };
    let by_acceleration = if acceleration > 0.0 {
        root(hardest / acceleration)
    } else {
        f64::MAX
    };
    by_speed.min(by_acceleration)
}

/// Number of points of a time.
fn points(time: i16, interval: i16) -> Option<i32> {
    let (time, interval) = (i32::from(time), i32::from(interval));
    (time > 0 && interval > 0 && time % interval == 0).then(|| time / interval)
}

/// A cycle of a cut, without the way back.
struct Cut {
    points: i32,
    time: f64,
    master: f64,
    slave: f64,
    /// Distances of master and slave outside the cut, on either side of it.
    master_side: f64,
    slave_side: f64,
    /// Way of the master in which the slave catches up; before, it waits.
    catching_up: f64,
    /// Speed with which the slave begins, as a part of its mean speed while it catches up.
    from: f64,
    /// Speed of the slave in the cut, for each pulse of the master.
    ratio: f64,
    units: Units,
    limits: [f64; 2],
}

impl Cut {
    /// The slave's way for a way of the master in the first half of the cycle.
    fn first_half(&self, master: f64) -> f64 {
        let begins = self.master_side - self.catching_up;
        if master >= self.master_side {
            self.slave_side + self.ratio * (master - self.master_side)
        } else if master <= begins {
            0.0
        } else {
            self.slave_side * catching_up(self.from, (master - begins) / self.catching_up)
        }
    }
}

impl Maker for Cut {
    const STATE: i32 = 14;

    fn of(cx: &Cx) -> Result<Option<Self>, Fault> {
        let [master, master_cut, slave, slave_cut] = [
            cx.dword(0, 0)?,
            cx.dword(0, 2)?,
            cx.dword(0, 4)?,
            cx.dword(0, 6)?,
        ];
        let right = (1..=master).contains(&master_cut) && (1..=slave).contains(&slave_cut);
        let points = points(cx.word(0, 8)?, cx.word(0, 9)?);
        let limits = [cx.word(0, 10)?, cx.word(0, 11)?].map(f64::from);
        let units = Units::of(cx, 12, 13)?;
        let (Some(points), Some(units), true) = (points, units, right) else {
            return Ok(None);
        };
        if limits.iter().any(|&limit| limit <= 0.0) {
            return Ok(None);
        }
        let [master, master_cut, slave, slave_cut] =
            [master, master_cut, slave, slave_cut].map(f64::from);
        let [master_side, slave_side] = [(master - master_cut) / 2.0, (slave - slave_cut) / 2.0];
        // The cut is relative: the slave goes with the master's speed, in the units of both.
        let ratio = slave_cut / master_cut;
        // From rest, its mean speed is half of that in the cut.
        let from_rest = 2.0 * slave_side / ratio;
        let waits = from_rest < master_side;
        let catching_up = if waits { from_rest } else { master_side };
        let from = if waits || slave_side == 0.0 {
            0.0
        } else {
            2.0 - ratio * master_side / slave_side
        };
        Ok(Some(Cut {
            points,
            time: f64::from(cx.word(0, 8)?),
            master,
            slave,
            master_side,
            slave_side,
            catching_up,
            from,
            ratio,
            units,
            limits,
        }))
    }

    fn begin(cx: &mut Cx) -> Done {
        cx.set_dword(1, 0, 1)?;
        cx.set_dword(1, 2, 0)
    }

    fn points(&self) -> i32 {
        self.points
    }

    fn position(&self, point: i32) -> i32 {
        // The second half mirrors the first one.
        if 2 * point <= self.points {
            let master = self.master * f64::from(point) / f64::from(self.points);
            return nearest(self.first_half(master));
        }
        let left = self.master * f64::from(self.points - point) / f64::from(self.points);
        nearest(self.slave - self.first_half(left))
    }

    fn end(&self, cx: &mut Cx) -> Done {
        let mean = if self.catching_up > 0.0 {
            self.slave_side / self.catching_up
        } else {
            0.0
        };
        let speed = self.ratio.max(self.from * mean);
        let change = (1.0 - self.from) * mean;
        let change = if change < 0.0 { -change } else { change };
        let acceleration = if self.catching_up > 0.0 {
            3.0 * change / self.catching_up
        } else {
            0.0
        };
        let kept = limit(self.units, self.limits, speed, acceleration);
        let fastest = kept.min(self.master / self.time);
        cx.set_word(0, 15, self.units.shown(fastest))
    }
}

/// PCTAB: the cam table of a cut. Memory: that of [`make`].
pub fn pctab(cx: &mut Cx) -> Done {
    make::<Cut>(cx)
}

/// The way back.
struct Return {
    points: i32,
    time: f64,
    master: f64,
    slave: f64,
    /// The part of the time in which it gets fast, and in which it gets slow.
    change: f64,
    units: Units,
    limits: [f64; 2],
}

impl Maker for Return {
    const STATE: i32 = 10;

    fn of(cx: &Cx) -> Result<Option<Self>, Fault> {
        let (master, slave) = (cx.dword(0, 0)?, cx.dword(0, 2)?);
        let points = points(cx.word(0, 4)?, cx.word(0, 5)?);
        let limits = [cx.word(0, 6)?, cx.word(0, 7)?].map(|limit| -f64::from(limit));
        let units = Units::of(cx, 8, 9)?;
        let (Some(points), Some(units)) = (points, units) else {
            return Ok(None);
        };
        if master <= 0 || slave >= 0 || limits.iter().any(|&limit| limit <= 0.0) {
            return Ok(None);
        }
        let time = f64::from(cx.word(0, 4)?);
        let slave = f64::from(slave);
        // It changes its speed as gently as its highest speed allows; faster than twice the mean it never is.
        let mean = -slave / time;
        let highest = (limits[0] * units.speed / mean).clamp(1.0, 2.0);
        Ok(Some(Return {
            points,
            time,
            master: f64::from(master),
            slave,
            change: 1.0 - 1.0 / highest,
            units,
            limits,
        }))
    }

    fn points(&self) -> i32 {
        self.points
    }

    fn position(&self, point: i32) -> i32 {
        let at = f64::from(point) / f64::from(self.points);
        let mirrored = at > 0.5;
        let part = if mirrored { 1.0 - at } else { at };
        // In the first part it gets half as far as at full speed.
        let speed = 1.0 / (1.0 - self.change);
        let way = if part < self.change {
            0.5 * self.change * speed * catching_up(0.0, part / self.change)
        } else {
            speed * (part - 0.5 * self.change)
        };
        nearest(self.slave * if mirrored { 1.0 - way } else { way })
    }

    fn end(&self, cx: &mut Cx) -> Done {
        let mean = -self.slave / self.master;
        let speed = mean / (1.0 - self.change);
        let acceleration = if self.change > 0.0 {
            1.5 * speed / (self.change * self.master)
        } else {
            0.0
        };
        let kept = limit(self.units, self.limits, speed, acceleration);
        let fastest = kept.min(self.master / self.time);
        let shown = self.units.shown(fastest).min(cx.word(0, 11)?);
        cx.set_word(0, 11, shown)
    }
}

/// PBTAB: appends the way back to the cam table of a cut. Memory: that of [`make`].
pub fn pbtab(cx: &mut Cx) -> Done {
    make::<Return>(cx)
}

#[cfg(test)]
mod tests {
    use crate::double::{Double, reg};
    use crate::{RtFn, k};
    use std::vec::Vec;

    /// Positions of the table that the parameters make.
    fn table(function: RtFn, master: [i32; 2], slave: [i32; 2], count: u32) -> Vec<i32> {
        let mut plc = Double::new();
        for (first, value) in (0..)
            .step_by(2)
            .zip([master[0], master[1], slave[0], slave[1]])
        {
            plc.set_dd(1000 + first, value);
        }
        plc.set_d(1008, &[count as i32, 1, 2000, 2000, 1, 1]);
        for _ in 0..=count / 10 + 1 {
            let operands = [reg(1000), reg(5000), k(0)];
            plc.scan(10, true, function, &operands[..2]).unwrap();
        }
        assert_eq!(plc.d(1014, 1), [32]);
        (0..=count).map(|point| plc.dd(5002 + 2 * point)).collect()
    }

    #[test]
    fn the_slave_waits_catches_up_and_rests() {
        let points = table(RtFn::Pctab, [60000, 1500], [15000, 1000], 500);
        // It waits for 8250 pulses of the master, 68 points, and cuts with two pulses for three.
        assert!(points[..=68].iter().all(|&position| position == 0));
        assert!(points.is_sorted() && points[69] >= 0 && points[80] > 0);
        assert_eq!((points[250], points[500]), (7500, 15000));
        assert_eq!(points[253] - points[250], 240);
        assert_eq!(points[440], 15000);
        for (point, &position) in points.iter().enumerate() {
            assert_eq!(position, 15000 - points[500 - point]);
        }
    }

    #[test]
    fn the_way_back_keeps_to_its_highest_speed() {
        let mut plc = Double::new();
        plc.set_dd(1000, 40000);
        plc.set_dd(1002, -15000);
        plc.set_d(1004, &[500, 5, -40, -2000, 1, 1, 0, 100]);
        plc.set_dd(5000, 1);
        plc.set_dd(5002, 15000);
        for _ in 0..20 {
            let operands = [reg(1000), reg(5000)];
            plc.scan(10, true, RtFn::Pbtab, &operands).unwrap();
        }
        assert_eq!((plc.d(1010, 1), plc.dd(5000)), (std::vec![32], 101));
        // A quarter of the time it gets fast; then it goes 40 pulses a millisecond, 200 from point to point.
        let at = |point: u32| plc.dd(5002 + 2 * point);
        assert_eq!([at(25), at(50), at(75), at(100)], [12500, 7500, 2500, 0]);
        assert_eq!(at(40) - at(41), 200);
        assert_eq!(plc.d(1011, 1), [80]);
    }

    #[test]
    fn a_slave_that_need_not_rest_goes_on() {
        let points = table(RtFn::Pctab, [1000, 500], [1000, 600], 100);
        assert!(points.is_sorted() && points[1] > 0);
        assert_eq!((points[25], points[75], points[100]), (200, 800, 1000));
        let faster = table(RtFn::Pctab, [1000, 500], [1000, 400], 100);
        assert_eq!((faster[25], faster[75], faster[100]), (300, 700, 1000));
        assert!(faster[1] > 12, "it is faster outside of the cut");
    }
}
