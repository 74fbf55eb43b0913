//! The points of a curve, as many as can be seen.

use super::Shape;
use rungc_syntax::order;

/// How many columns a diagram has: two a pixel of its width.
const COLUMNS: u64 = 1600;

/// A moment in milliseconds, and the value then.
pub(super) type Point = (u64, f64);

/// What a column keeps of the points that fall into it.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Column {
    first: Point,
    least: Point,
    greatest: Point,
    last: Point,
}

#[derive(Clone, PartialEq, Debug)]
pub(super) struct Curve {
    pub(super) shape: Shape,
    duration_ms: u64,
    /// Those that hold points, by their number.
    columns: Vec<(u64, Column)>,
}

impl Curve {
    pub(super) fn new(shape: Shape, duration_ms: u64) -> Curve {
        Curve {
            shape,
            duration_ms: duration_ms.max(1),
            columns: Vec::new(),
        }
    }

    /// A value that is not a number is omitted.
    pub(super) fn push(&mut self, at_ms: u64, value: f64) {
        if !value.is_finite() {
            return;
        }
        let point = (at_ms, value);
        let number = at_ms.min(self.duration_ms) * COLUMNS / self.duration_ms;
        match self.columns.last_mut() {
            Some((last, column)) if *last == number => {
                if value < column.least.1 {
                    column.least = point;
                }
                if value > column.greatest.1 {
                    column.greatest = point;
                }
                column.last = point;
            }
            _ => {
                let column = Column {
                    first: point,
                    least: point,
                    greatest: point,
                    last: point,
                };
                self.columns.push((number, column));
            }
        }
    }

    /// The least and the greatest value; `None` without points.
    pub(super) fn range(&self) -> Option<(f64, f64)> {
        let columns = || self.columns.iter().map(|(_, column)| column);
        let least = columns().map(|c| c.least.1).reduce(f64::min)?;
        let greatest = columns().map(|c| c.greatest.1).reduce(f64::max)?;
        Some((least, greatest))
    }

    /// Its points in the order of their times.
    pub(super) fn points(&self) -> impl Iterator<Item = Point> {
        self.columns.iter().flat_map(|(_, column)| {
            let mut points = [column.first, column.least, column.greatest, column.last];
            order::by_key(&mut points, |&(at_ms, _)| at_ms);
            points
        })
    }
}
