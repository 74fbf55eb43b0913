//! Point tables of HM, whatever they are made by: a count, then positions, both 32 bits (hm-motion-controller §8.3.4).
//! Operand 0 is where the parameters are, operand 1 the table.

use crate::cx::Cx;
use crate::fault::{Done, Fault};

/// Values of the state word of the parameters.
const IDLE: i16 = 0;
const RUNNING: i16 = 16;
const DONE: i16 = 32;
const WRONG: i16 = 64;

/// Generator of the points of a table.
pub trait Maker: Sized {
    /// The word of the parameters that shows the state.
    const STATE: i32;

    /// Generator described by the parameters; `None` if they are invalid.
    fn of(cx: &Cx) -> Result<Option<Self>, Fault>;

    /// Prepares the table.
    fn begin(cx: &mut Cx) -> Done {
        let _ = cx;
        Ok(())
    }

    /// Number of points it makes, at least one.
    fn points(&self) -> i32;

    /// Distance of point `point`, from 1, from the last one of the table before.
    fn position(&self, point: i32) -> i32;

    /// Shows what came out.
    fn end(&self, cx: &mut Cx) -> Done;
}

/// Appends points to a table, one each millisecond. Memory: the state, the points so far.
pub fn make<M: Maker>(cx: &mut Cx) -> Done {
    let dt = cx.elapsed_ms();
    let state = cx.state().0[0];
    if !cx.drive() {
        if state == i32::from(IDLE) {
            return Ok(());
        }
        return show::<M>(cx, IDLE);
    }
    if state == i32::from(IDLE) {
        cx.state().0[1] = 0;
        let begins = match M::of(cx)? {
            Some(maker) => {
                M::begin(cx)?;
                fits(cx, maker.points())?
            }
            None => false,
        };
        return show::<M>(cx, if begins { RUNNING } else { WRONG });
    }
    if state != i32::from(RUNNING) {
        return Ok(());
    }
    let Some(maker) = M::of(cx)? else {
        return show::<M>(cx, WRONG);
    };
    let points = maker.points();
    let before = cx.state().0[1];
    let now = before.saturating_add(dt).min(points);
    let count = cx.dword(1, 0)?;
    let origin = cx.dword(1, 2 * count)?;
    for point in before + 1..=now {
        let position = origin.wrapping_add(maker.position(point));
        cx.set_dword(1, 2 * (count + point), position)?;
    }
    cx.state().0[1] = now;
    if now < points {
        return Ok(());
    }
    cx.set_dword(1, 0, count + points)?;
    maker.end(cx)?;
    show::<M>(cx, DONE)
}

/// Returns true if the table has a point to continue from, and registers for all points.
fn fits(cx: &Cx, points: i32) -> Result<bool, Fault> {
    let count = cx.dword(1, 0)?;
    let last = count
        .checked_add(points)
        .and_then(|points| points.checked_mul(2));
    Ok(count > 0 && last.is_some_and(|last| cx.dword(1, last).is_ok()))
}

fn show<M: Maker>(cx: &mut Cx, state: i16) -> Done {
    cx.state().0[0] = state.into();
    cx.set_word(0, M::STATE, state)
}
