//! Diagrams of a run: positions, speeds and values over time, or over one of the values, as an SVG that needs nothing
//! beside it.
//!
//! Curves over time are thinned out while they are collected, to what a column of the diagram can show: its first,
//! least, greatest and last value. So a run of any length takes the same space, and no peak is lost.

mod curve;
mod draw;
mod marks;
mod ticks;

use curve::Curve;
pub use marks::{Anchor, Diagram, Mark, NO_DASH, Stroke};

/// Interpolation of a curve between its points.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Shape {
    /// Straight from one to the next.
    Line,
    /// It holds its value until the next point.
    Step,
}

/// One of the curves of a plot.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct CurveId(usize);

/// A part of the diagram, with a separate scale.
#[derive(Clone, PartialEq, Debug)]
struct Panel {
    /// Title of its scale, with the unit.
    title: String,
    /// Its height in pixels.
    height: f64,
    /// True if its scale always includes 0.
    with_zero: bool,
    /// Its curves: the name of each and which one it is.
    curves: Vec<(String, CurveId)>,
}

/// Quantity on the horizontal axis.
#[derive(Clone, PartialEq, Debug)]
enum Across {
    /// Time, in milliseconds: all of it, and that of the last point.
    Time { duration: u64, last: u64 },
    /// A value: its name, where it is now, and the least and the greatest that it has been.
    Value {
        name: String,
        at: f64,
        range: Option<(f64, f64)>,
    },
}

/// A diagram: panels of curves one below the other over the same time or value, and below them lanes of bits.
#[derive(Clone, PartialEq, Debug)]
pub struct Plot {
    title: String,
    across: Across,
    curves: Vec<Curve>,
    panels: Vec<Panel>,
    lanes: Vec<(String, CurveId)>,
}

impl Plot {
    /// An empty diagram for this much time.
    pub fn new(title: &str, duration_ms: u64) -> Plot {
        Plot {
            title: title.to_string(),
            across: Across::Time {
                duration: duration_ms,
                last: 0,
            },
            curves: Vec::new(),
            panels: Vec::new(),
            lanes: Vec::new(),
        }
    }

    /// Shows this value on the horizontal axis instead of time. Say so before the first curve.
    pub fn over(&mut self, name: &str) {
        self.across = Across::Value {
            name: name.to_string(),
            at: 0.0,
            range: None,
        };
    }

    /// Sets the present value of the horizontal axis; a value that is not a number leaves it unchanged.
    pub fn place(&mut self, value: f64) {
        if let Across::Value { at, range, .. } = &mut self.across
            && value.is_finite()
        {
            let (least, greatest) = range.unwrap_or((value, value));
            *at = value;
            *range = Some((least.min(value), greatest.max(value)));
        }
    }

    /// Returns true if there is nothing to draw.
    pub fn is_empty(&self) -> bool {
        self.curves.is_empty()
    }

    /// A new curve in the panel with this title, which comes below the others if it is new, too. Position and speed are
    /// derived from 0, other values from where they are.
    pub fn curve(&mut self, panel: &str, name: &str, shape: Shape) -> CurveId {
        let id = self.add(shape);
        let curve = (name.to_string(), id);
        match self.panels.iter_mut().find(|p| p.title == panel) {
            Some(panel) => panel.curves.push(curve),
            None => self.panels.push(Panel {
                title: panel.to_string(),
                height: match shape {
                    Shape::Line => 190.0,
                    Shape::Step => 120.0,
                },
                with_zero: shape == Shape::Line,
                curves: vec![curve],
            }),
        }
        id
    }

    /// A new lane of a bit.
    pub fn lane(&mut self, name: &str) -> CurveId {
        let id = self.add(Shape::Step);
        self.lanes.push((name.to_string(), id));
        id
    }

    fn add(&mut self, shape: Shape) -> CurveId {
        self.curves.push(match self.across {
            Across::Time { duration, .. } => Curve::over_time(shape, duration),
            Across::Value { .. } => Curve::over_value(shape),
        });
        CurveId(self.curves.len() - 1)
    }

    /// A curve has this value at this time. Times do not go back.
    pub fn point(&mut self, curve: CurveId, at_ms: u64, value: f64) {
        let at = match &mut self.across {
            Across::Time { last, .. } => {
                *last = at_ms;
                at_ms as f64
            }
            Across::Value { at, .. } => *at,
        };
        self.curves[curve.0].push(at, value);
    }

    /// The diagram as marks.
    pub fn diagram(&self) -> Diagram {
        draw::draw(self)
    }

    /// The diagram as SVG.
    pub fn draw(&self) -> String {
        self.diagram().svg()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_diagram() {
        let mut plot = Plot::new("a <program> & its machine", 1000);
        let position = plot.curve("Position (mm)", "X", Shape::Line);
        let other = plot.curve("Position (mm)", "Y", Shape::Line);
        let word = plot.curve("D0", "D0", Shape::Step);
        let bit = plot.lane("X005");
        for t in 0..=1000 {
            let x = t as f64;
            plot.point(position, t, x.min(1500.0 - x) / 10.0);
            plot.point(other, t, -x / 40.0);
            plot.point(word, t, (t / 300) as f64);
            plot.point(bit, t, f64::from(t % 250 > 200));
        }
        insta::assert_snapshot!(plot.draw());
    }

    #[test]
    fn a_diagram_over_a_value() {
        let mut plot = Plot::new("a slave & its master", 1000);
        plot.over("D1220");
        let slave = plot.curve("D318", "D318", Shape::Line);
        let bit = plot.lane("M0");
        for t in 0..=1000 {
            // There and back again, on another way.
            let master = f64::from(t.min(1200 - t));
            plot.place(master);
            plot.point(slave, t as u64, master * master / 100.0 + f64::from(t));
            plot.point(bit, t as u64, f64::from(u8::from(master > 400.0)));
        }
        insta::assert_snapshot!(plot.draw());
    }

    #[test]
    fn a_diagram_of_no_time_and_of_no_numbers() {
        let mut plot = Plot::new("", 0);
        let curve = plot.curve("D0.f32", "D0.f32", Shape::Step);
        plot.point(curve, 0, f64::NAN);
        let drawn = plot.draw();
        assert!(!drawn.contains("NaN") && !drawn.contains("inf"), "{drawn}");
    }

    #[test]
    fn no_peak_is_lost_and_long_runs_take_no_more_space() {
        let mut plot = Plot::new("", 10_000_000);
        let curve = plot.curve("D0", "D0", Shape::Step);
        for t in (0..10_000_000).step_by(10) {
            plot.point(curve, t, if t == 7_777_770 { 99.0 } else { 0.0 });
        }
        let (least, greatest) = plot.curves[0].range().unwrap();
        assert_eq!((least, greatest), (0.0, 99.0));
        assert!(plot.draw().len() < 10_000);
    }
}
