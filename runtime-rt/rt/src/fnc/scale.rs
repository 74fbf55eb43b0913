//! Scaling: FNC 259 and 269 of the FX3 programming manual, l01s-programming §4.2.

use crate::cx::Cx;
use crate::fault::{Done, Fault};

/// Position of the coordinates of point `i` (from 0) of `count` in the table, as elements after its head.
type Place = fn(i: i32, count: i32) -> (i32, i32);

/// D = the line through the table's points at x = S1, rounded half away from zero. The table's head counts its points.
/// It is searched from its beginning, so that only x that fall before S1 is reached are an error; of points that share
/// an x the second counts.
fn interpolate(cx: &mut Cx, place: Place) -> Done {
    let x = cx.read(0)?;
    let count = cx.elem(1, 0)?;
    if !(1..=i32::from(i16::MAX)).contains(&count) {
        return Err(Fault::DEVICE);
    }
    let point = |cx: &Cx, i: i32| -> Result<(i32, i32), Fault> {
        let (x, y) = place(i, count);
        Ok((cx.elem(1, x)?, cx.elem(1, y)?))
    };
    let mut left = point(cx, 0)?;
    for i in 1..count {
        let right = point(cx, i)?;
        if left.0 == x {
            return cx.write(2, if right.0 == x { right.1 } else { left.1 });
        }
        if right.0 < left.0 {
            return Err(Fault::DEVICE);
        }
        if left.0 < x && x < right.0 {
            return cx.write(2, on_line(left, right, x));
        }
        left = right;
    }
    if left.0 == x {
        cx.write(2, left.1)
    } else {
        Err(Fault::DEVICE)
    }
}

/// y at x on the line through two points, x strictly between them.
fn on_line(left: (i32, i32), right: (i32, i32), x: i32) -> i32 {
    let run = i128::from(right.0) - i128::from(left.0);
    let rise = (i128::from(right.1) - i128::from(left.1)) * (i128::from(x) - i128::from(left.0));
    let half = if rise < 0 { -run } else { run };
    let rounded = (2 * rise + half) / (2 * run);
    (i128::from(left.1) + rounded) as i32
}

/// SCL S1 S2 D (FNC 259): scales by a table x1, y1, x2, y2, ….
pub fn scl(cx: &mut Cx) -> Done {
    interpolate(cx, |i, _| (1 + 2 * i, 2 + 2 * i))
}

/// SCL2 S1 S2 D (FNC 269): scales by a table x1, x2, …, y1, y2, ….
pub fn scl2(cx: &mut Cx) -> Done {
    interpolate(cx, |i, count| (1 + i, 1 + count + i))
}

#[cfg(test)]
mod tests {
    use crate::double::{Double, reg};
    use crate::{Fault, RtFn, k};

    #[test]
    fn scaling_interpolates_and_rounds() {
        let mut plc = Double::new().with_d(10, &[3, 0, 0, 10, 15, 20, -15]);
        let mut at = |x| {
            plc.call(RtFn::Scl, &[k(x), reg(10), reg(0)])
                .map(|()| plc.d(0, 1)[0])
        };
        assert_eq!(at(0), Ok(0));
        assert_eq!(at(1), Ok(2));
        assert_eq!(at(10), Ok(15));
        assert_eq!(at(15), Ok(0));
        assert_eq!(at(20), Ok(-15));
        assert_eq!(at(21), Err(Fault::DEVICE));
        assert_eq!(at(-1), Err(Fault::DEVICE));
        let mut plc = Double::new().with_d(10, &[2, 0, 10, 100, 200]);
        plc.call(RtFn::Scl2, &[k(5), reg(10), reg(0)]).unwrap();
        assert_eq!(plc.d(0, 1), [150]);
    }
}
