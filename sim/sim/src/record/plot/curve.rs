//! The points of a curve, as many as can be seen.

use super::Shape;

/// Number of columns of a diagram: two a pixel of its width.
const COLUMNS: f64 = 1600.0;

/// A moment in milliseconds, or a value that the horizontal axis shows, and the value there.
pub(super) type Point = (f64, f64);

/// Points of a column that are stored.
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
    kept: Points,
}

/// Stored points of a curve.
#[derive(Clone, PartialEq, Debug)]
enum Points {
    /// Over time: the columns that hold points, by their numbers.
    Columns {
        duration_ms: f64,
        columns: Vec<(u64, Column)>,
    },
    /// Over a value, which may go back: where it was, one after the other.
    Way(Vec<Point>),
}

impl Curve {
    /// A curve over this much time.
    pub(super) fn over_time(shape: Shape, duration_ms: u64) -> Curve {
        let duration_ms = duration_ms.max(1) as f64;
        let columns = Vec::new();
        Curve {
            shape,
            kept: Points::Columns {
                duration_ms,
                columns,
            },
        }
    }

    /// A curve over a value.
    pub(super) fn over_value(shape: Shape) -> Curve {
        Curve {
            shape,
            kept: Points::Way(Vec::new()),
        }
    }

    /// A value that is not a number is omitted.
    pub(super) fn push(&mut self, at: f64, value: f64) {
        if !value.is_finite() {
            return;
        }
        let point = (at, value);
        match &mut self.kept {
            Points::Columns {
                duration_ms,
                columns,
            } => {
                let number = at.min(*duration_ms) * COLUMNS / *duration_ms;
                add(columns, number as u64, point);
            }
            Points::Way(points) if points.last() == Some(&point) => {}
            Points::Way(points) => points.push(point),
        }
    }

    /// The least and the greatest value; `None` without points.
    pub(super) fn range(&self) -> Option<(f64, f64)> {
        let values = || self.points().map(|(_, value)| value);
        let least = values().reduce(f64::min)?;
        let greatest = values().reduce(f64::max)?;
        Some((least, greatest))
    }

    /// Its points in the order of their times.
    pub(super) fn points(&self) -> impl Iterator<Item = Point> {
        let (columns, way) = match &self.kept {
            Points::Columns { columns, .. } => (&columns[..], &[][..]),
            Points::Way(points) => (&[][..], &points[..]),
        };
        let columns = columns.iter().flat_map(|(_, column)| {
            let mut points = [column.first, column.least, column.greatest, column.last];
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            points
        });
        columns.chain(way.iter().copied())
    }
}

/// Adds a point to its column, the last one or a new one.
fn add(columns: &mut Vec<(u64, Column)>, number: u64, point: Point) {
    match columns.last_mut() {
        Some((last, column)) if *last == number => {
            if point.1 < column.least.1 {
                column.least = point;
            }
            if point.1 > column.greatest.1 {
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
            columns.push((number, column));
        }
    }
}
