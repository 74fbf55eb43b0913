//! Drawing a plot.

use super::curve::Curve;
use super::marks::{Anchor, Diagram, Mark, NO_DASH, Stroke, rounded};
use super::ticks::Ticks;
use super::{Across, Panel, Plot, Shape};

/// Size of the picture and its parts, in pixels.
const WIDTH: f64 = 900.0;
/// Left of the panels, for scales and the names of lanes: minimum and maximum.
const LEFT: [f64; 2] = [84.0, 260.0];
const RIGHT: f64 = 20.0;
const HEAD: f64 = 34.0;
/// Above a panel, for its title and legend.
const TITLE: f64 = 30.0;
/// Between the border of a panel or lane and its scale.
const MARGIN: f64 = 6.0;
const LANE: f64 = 24.0;
/// Below everything, for the horizontal scale.
const FOOT: f64 = 46.0;

/// Colours that are distinguishable with any kind of colour vision (Okabe and Ito), and dashes that distinguish them
/// without colour.
const STROKES: [(&str, &str); 6] = [
    ("#0072b2", NO_DASH),
    ("#d55e00", "7 3"),
    ("#009e73", "2 2"),
    ("#cc79a7", "9 3 2 3"),
    ("#e69f00", "4 2"),
    ("#56b4e9", "1 3"),
];
pub(super) const INK: &str = "#222222";
const GRID: &str = "#dddddd";
const LANE_INK: &str = "#0072b2";
const LANE_FILL: &str = "#d6e6f2";

/// Drawing area: its horizontal scale, and the marks so far.
struct Canvas {
    /// Left edge of the panels.
    left: f64,
    scale: Scale,
    marks: Vec<Mark>,
}

/// The horizontal scale: times in milliseconds, or values.
struct Scale {
    title: String,
    least: f64,
    greatest: f64,
    /// Until when values are held that do not change any more.
    holds_to: Option<f64>,
    /// Marked values, with their labels.
    marks: Vec<(f64, String)>,
}

impl Scale {
    fn of(across: &Across) -> Scale {
        match across {
            Across::Time { duration, last } => Scale::of_time(*duration, *last),
            Across::Value { name, range, .. } => Scale::of_value(name, *range),
        }
    }

    fn of_time(duration: u64, last: u64) -> Scale {
        let greatest = duration.max(1) as f64;
        let (name, factor) = unit(greatest);
        let marks = Ticks::around(0.0, greatest / factor, 10.0).labels();
        Scale {
            title: format!("time ({name})"),
            least: 0.0,
            greatest,
            holds_to: Some(last as f64),
            marks: marks
                .map(|(at, label)| (at * factor, label))
                .filter(|&(at_ms, _)| at_ms <= greatest * (1.0 + 1e-9))
                .collect(),
        }
    }

    fn of_value(name: &str, range: Option<(f64, f64)>) -> Scale {
        let (least, greatest) = range.unwrap_or((0.0, 0.0));
        let ticks = Ticks::around(least, greatest, 10.0);
        Scale {
            title: name.to_string(),
            least: ticks.least().min(least),
            greatest: ticks.greatest().max(greatest),
            holds_to: None,
            marks: ticks.labels().collect(),
        }
    }
}

/// A unit of time: its name and its milliseconds.
type Unit = (&'static str, f64);

/// Units of time, each with the longest time that is shown in it, in milliseconds.
const UNITS: [(f64, Unit); 3] = [
    (1000.0, ("ms", 1.0)),
    (600_000.0, ("s", 1000.0)),
    (7_200_000.0, ("min", 60_000.0)),
];

/// The unit for a run of this many milliseconds.
fn unit(duration_ms: f64) -> Unit {
    let fits = UNITS.iter().find(|&&(longest, _)| duration_ms < longest);
    fits.map_or(("h", 3_600_000.0), |&(_, unit)| unit)
}

/// A panel's place: its upper edge, its height, and its scale.
#[derive(Clone, Copy)]
struct Frame {
    top: f64,
    height: f64,
    least: f64,
    greatest: f64,
}

impl Frame {
    /// Height of a value; the border is a little farther out.
    fn y(&self, value: f64) -> f64 {
        let part = (value - self.least) / (self.greatest - self.least);
        self.top + MARGIN + (self.height - 2.0 * MARGIN) * (1.0 - part)
    }

    fn bottom(&self) -> f64 {
        self.top + self.height
    }
}

/// The picture.
pub(super) fn draw(plot: &Plot) -> Diagram {
    let names = plot.lanes.iter().map(|(name, _)| 20.0 + width(name));
    let left = names.fold(LEFT[0], f64::max).min(LEFT[1]);
    let mut canvas = Canvas {
        left,
        scale: Scale::of(&plot.across),
        marks: Vec::new(),
    };
    canvas.add(Mark::Text {
        at: [left, 22.0],
        anchor: Anchor::Start,
        size: Some(15),
        bold: true,
        text: plot.title.clone(),
    });
    let mut top = HEAD;
    for panel in &plot.panels {
        top = canvas.panel(plot, panel, top + TITLE);
    }
    top = canvas.lanes(plot, top);
    canvas.foot(top);
    Diagram {
        size: [WIDTH, top + FOOT],
        marks: canvas.marks,
    }
}

impl Canvas {
    fn add(&mut self, mark: Mark) {
        self.marks.push(mark);
    }

    fn x(&self, at: f64) -> f64 {
        let Scale {
            least, greatest, ..
        } = self.scale;
        self.left + (WIDTH - self.left - RIGHT) * (at - least) / (greatest - least)
    }

    /// A panel whose frame begins at `top`; returns where it ends.
    fn panel(&mut self, plot: &Plot, panel: &Panel, top: f64) -> f64 {
        let curves = panel.curves.iter().map(|(_, id)| &plot.curves[id.0]);
        let zero = panel.with_zero.then_some((0.0, 0.0));
        let ranges = curves.filter_map(Curve::range).chain(zero);
        let range = ranges.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        let (least, greatest) = range.unwrap_or((0.0, 0.0));
        let ticks = Ticks::around(least, greatest, panel.height / 38.0);
        let frame = Frame {
            top,
            height: panel.height,
            least: ticks.least(),
            greatest: ticks.greatest(),
        };
        self.add(Mark::Text {
            at: [self.left, top - 9.0],
            anchor: Anchor::Start,
            size: None,
            bold: true,
            text: panel.title.clone(),
        });
        if panel.curves.iter().any(|(name, _)| *name != panel.title) {
            self.legend(panel, top - 9.0);
        }
        self.upright_lines(frame);
        for (value, label) in ticks.labels() {
            let y = frame.y(value);
            let colour = if value == 0.0 { "#999999" } else { GRID };
            self.add(line([self.left, y], [WIDTH - RIGHT, y], colour));
            self.add(text(self.left - 8.0, y + 4.0, Anchor::End, &label));
        }
        for (i, (_, id)) in panel.curves.iter().enumerate() {
            let (colour, dash) = STROKES[i % STROKES.len()];
            let points = self.places(&plot.curves[id.0], frame);
            self.add(Mark::Curve {
                points,
                stroke: Stroke {
                    colour,
                    width: 1.6,
                    dash,
                },
                is_round: true,
            });
        }
        self.border(frame);
        frame.bottom()
    }

    /// The names of a panel's curves, from the right.
    fn legend(&mut self, panel: &Panel, y: f64) {
        let mut x = WIDTH - RIGHT;
        for (i, (name, _)) in panel.curves.iter().enumerate().rev() {
            let (colour, dash) = STROKES[i % STROKES.len()];
            self.add(text(x, y, Anchor::End, name));
            x -= width(name) + 6.0;
            self.add(Mark::Line {
                from: [x - 26.0, y - 4.0],
                to: [x, y - 4.0],
                stroke: Stroke {
                    colour,
                    width: 1.6,
                    dash,
                },
            });
            x -= 26.0 + 18.0;
        }
    }

    /// Lanes of bits below the panels; returns where they end.
    fn lanes(&mut self, plot: &Plot, top: f64) -> f64 {
        if plot.lanes.is_empty() {
            return top;
        }
        let all = Frame {
            top: top + 16.0,
            height: LANE * plot.lanes.len() as f64,
            least: 0.0,
            greatest: 1.0,
        };
        self.upright_lines(all);
        for (i, (name, id)) in plot.lanes.iter().enumerate() {
            let top = all.top + LANE * i as f64;
            let frame = Frame {
                top,
                height: LANE,
                ..all
            };
            if i > 0 {
                self.add(line([self.left, top], [WIDTH - RIGHT, top], GRID));
            }
            self.add(text(
                self.left - 8.0,
                top + LANE / 2.0 + 4.0,
                Anchor::End,
                &shortened(name),
            ));
            let points = self.places(&plot.curves[id.0], frame);
            let (Some(&[first, _]), Some(&[last, _])) = (points.first(), points.last()) else {
                continue;
            };
            let ground = frame.y(0.0);
            let closed = [&[[first, ground]], &points[..], &[[last, ground]]].concat();
            self.add(Mark::Area {
                points: closed,
                colour: LANE_FILL,
            });
            self.add(Mark::Curve {
                points,
                stroke: Stroke {
                    colour: LANE_INK,
                    width: 1.2,
                    dash: NO_DASH,
                },
                is_round: false,
            });
        }
        self.border(all);
        all.bottom()
    }

    /// The horizontal scale, below everything.
    fn foot(&mut self, y: f64) {
        for (at, label) in self.scale.marks.clone() {
            let x = self.x(at);
            self.add(line([x, y], [x, y + 4.0], INK));
            self.add(text(x, y + 18.0, Anchor::Middle, &label));
        }
        let middle = (self.left + WIDTH - RIGHT) / 2.0;
        let title = text(middle, y + 36.0, Anchor::Middle, &self.scale.title);
        self.add(title);
    }

    fn upright_lines(&mut self, frame: Frame) {
        for (at, _) in self.scale.marks.clone() {
            let x = self.x(at);
            self.add(line([x, frame.top], [x, frame.bottom()], GRID));
        }
    }

    fn border(&mut self, frame: Frame) {
        self.add(Mark::Frame {
            at: [self.left, frame.top],
            size: [WIDTH - self.left - RIGHT, frame.height],
            stroke: thin(INK),
        });
    }

    /// Positions of a curve's points, without those that change nothing.
    fn places(&self, curve: &Curve, frame: Frame) -> Vec<[f64; 2]> {
        let mut places: Vec<[f64; 2]> = Vec::new();
        let mut put = |place: [f64; 2]| {
            if places.last() != Some(&place) {
                places.push(place);
            }
        };
        let mut held = None;
        for (at, value) in curve.points() {
            let [x, y] = [self.x(at), frame.y(value)].map(rounded);
            if let Some(y) = held.filter(|_| curve.shape == Shape::Step) {
                put([x, y]);
            }
            put([x, y]);
            held = Some(y);
        }
        if let (Some(y), Shape::Step, Some(last)) = (held, curve.shape, self.scale.holds_to) {
            put([rounded(self.x(last)), y]);
        }
        thinned(&places)
    }
}

/// The points that a line needs to pass all of them closer than can be seen (Ramer, Douglas and Peucker).
fn thinned(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut kept = vec![false; points.len()];
    let mut open = vec![(0, points.len().saturating_sub(1))];
    while let Some((from, to)) = open.pop() {
        for end in [from, to] {
            if let Some(kept) = kept.get_mut(end) {
                *kept = true;
            }
        }
        let between = (from + 1)..to;
        let aside = between.map(|i| (distance(points[i], points[from], points[to]), i));
        if let Some((far, i)) = aside.max_by(|a, b| a.0.total_cmp(&b.0))
            && far > 0.05
        {
            open.extend([(from, i), (i, to)]);
        }
    }
    let kept = points.iter().zip(kept).filter(|(_, kept)| *kept);
    kept.map(|(&point, _)| point).collect()
}

/// Distance of a point from the line between two others.
fn distance([x, y]: [f64; 2], [ax, ay]: [f64; 2], [bx, by]: [f64; 2]) -> f64 {
    let (dx, dy) = (bx - ax, by - ay);
    let square = dx * dx + dy * dy;
    let part = match square > 0.0 {
        true => (((x - ax) * dx + (y - ay) * dy) / square).clamp(0.0, 1.0),
        false => 0.0,
    };
    (x - ax - part * dx).hypot(y - ay - part * dy)
}

fn thin(colour: &'static str) -> Stroke {
    Stroke {
        colour,
        width: 0.8,
        dash: NO_DASH,
    }
}

fn line(from: [f64; 2], to: [f64; 2], colour: &'static str) -> Mark {
    let stroke = thin(colour);
    Mark::Line { from, to, stroke }
}

fn text(x: f64, y: f64, anchor: Anchor, content: &str) -> Mark {
    Mark::Text {
        at: [x, y],
        anchor,
        size: None,
        bold: false,
        text: content.to_string(),
    }
}

/// A name as long as there is room for left of a lane.
fn shortened(name: &str) -> String {
    if width(name) + 20.0 <= LEFT[1] {
        return name.to_string();
    }
    let mut room = LEFT[1] - 32.0;
    let fits = |c: &char| {
        room -= char_width(*c);
        room >= 0.0
    };
    name.chars().take_while(fits).chain(['…']).collect()
}

/// About how wide a text is: non-Latin characters count as wide.
fn width(content: &str) -> f64 {
    content.chars().map(char_width).sum()
}

fn char_width(c: char) -> f64 {
    if c < '\u{2000}' { 7.0 } else { 12.0 }
}
