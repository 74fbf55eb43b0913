//! Drawing a plot.

use super::curve::Curve;
use super::ticks::Ticks;
use super::{Across, Panel, Plot, Shape};
use svg::Document;
use svg::node::element::{Element, Group, Line, Polygon, Polyline, Rectangle, Text};

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
    ("#0072b2", "none"),
    ("#d55e00", "7 3"),
    ("#009e73", "2 2"),
    ("#cc79a7", "9 3 2 3"),
    ("#e69f00", "4 2"),
    ("#56b4e9", "1 3"),
];
const INK: &str = "#222222";
const GRID: &str = "#dddddd";
const LANE_INK: &str = "#0072b2";
const LANE_FILL: &str = "#d6e6f2";

/// Drawing area: its horizontal scale, and the elements so far.
struct Canvas {
    /// Left edge of the panels.
    left: f64,
    scale: Scale,
    group: Group,
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
pub(super) fn draw(plot: &Plot) -> String {
    let names = plot.lanes.iter().map(|(name, _)| 20.0 + width(name));
    let left = names.fold(LEFT[0], f64::max).min(LEFT[1]);
    let mut canvas = Canvas {
        left,
        scale: Scale::of(&plot.across),
        group: Group::new()
            .set("font-family", "Helvetica, Arial, sans-serif")
            .set("font-size", 12)
            .set("fill", INK),
    };
    let title = text(left, 22.0, "start", &plot.title);
    canvas.add(title.set("font-size", 15).set("font-weight", "bold"));
    let mut top = HEAD;
    for panel in &plot.panels {
        top = canvas.panel(plot, panel, top + TITLE);
    }
    top = canvas.lanes(plot, top);
    canvas.foot(top);
    let height = top + FOOT;
    let background = Rectangle::new()
        .set("width", number(WIDTH))
        .set("height", number(height))
        .set("fill", "#ffffff");
    let document = Document::new()
        .set("width", number(WIDTH))
        .set("height", number(height))
        .set(
            "viewBox",
            format!("0 0 {} {}", number(WIDTH), number(height)),
        )
        .add(background)
        .add(canvas.group);
    format!("{document}\n")
}

impl Canvas {
    fn add(&mut self, element: impl Into<Element>) {
        let group = std::mem::replace(&mut self.group, Group::new());
        self.group = group.add(element.into());
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
        self.add(text(self.left, top - 9.0, "start", &panel.title).set("font-weight", "bold"));
        if panel.curves.iter().any(|(name, _)| *name != panel.title) {
            self.legend(panel, top - 9.0);
        }
        self.upright_lines(frame);
        for (value, label) in ticks.labels() {
            let y = frame.y(value);
            let colour = if value == 0.0 { "#999999" } else { GRID };
            self.add(line([self.left, y], [WIDTH - RIGHT, y], colour));
            self.add(text(self.left - 8.0, y + 4.0, "end", &label));
        }
        for (i, (_, id)) in panel.curves.iter().enumerate() {
            let (colour, dash) = STROKES[i % STROKES.len()];
            let points = self.places(&plot.curves[id.0], frame);
            let curve = Polyline::new()
                .set("points", joined(&points))
                .set("fill", "none")
                .set("stroke", colour)
                .set("stroke-width", "1.6")
                .set("stroke-linejoin", "round");
            self.add(dashed(curve.into(), dash));
        }
        self.border(frame);
        frame.bottom()
    }

    /// The names of a panel's curves, from the right.
    fn legend(&mut self, panel: &Panel, y: f64) {
        let mut x = WIDTH - RIGHT;
        for (i, (name, _)) in panel.curves.iter().enumerate().rev() {
            let (colour, dash) = STROKES[i % STROKES.len()];
            self.add(text(x, y, "end", name));
            x -= width(name) + 6.0;
            let sample = line([x - 26.0, y - 4.0], [x, y - 4.0], colour);
            self.add(dashed(sample.set("stroke-width", "1.6").into(), dash));
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
                "end",
                &shortened(name),
            ));
            let points = self.places(&plot.curves[id.0], frame);
            let (Some(&[first, _]), Some(&[last, _])) = (points.first(), points.last()) else {
                continue;
            };
            let ground = frame.y(0.0);
            let closed = [&[[first, ground]], &points[..], &[[last, ground]]].concat();
            self.add(
                Polygon::new()
                    .set("points", joined(&closed))
                    .set("fill", LANE_FILL),
            );
            self.add(
                Polyline::new()
                    .set("points", joined(&points))
                    .set("fill", "none")
                    .set("stroke", LANE_INK)
                    .set("stroke-width", "1.2"),
            );
        }
        self.border(all);
        all.bottom()
    }

    /// The horizontal scale, below everything.
    fn foot(&mut self, y: f64) {
        for (at, label) in self.scale.marks.clone() {
            let x = self.x(at);
            self.add(line([x, y], [x, y + 4.0], INK));
            self.add(text(x, y + 18.0, "middle", &label));
        }
        let middle = (self.left + WIDTH - RIGHT) / 2.0;
        let title = text(middle, y + 36.0, "middle", &self.scale.title);
        self.add(title);
    }

    fn upright_lines(&mut self, frame: Frame) {
        for (at, _) in self.scale.marks.clone() {
            let x = self.x(at);
            self.add(line([x, frame.top], [x, frame.bottom()], GRID));
        }
    }

    fn border(&mut self, frame: Frame) {
        self.add(
            Rectangle::new()
                .set("x", number(self.left))
                .set("y", number(frame.top))
                .set("width", number(WIDTH - self.left - RIGHT))
                .set("height", number(frame.height))
                .set("fill", "none")
                .set("stroke", INK)
                .set("stroke-width", "0.8"),
        );
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

/// To a hundredth of a pixel.
fn rounded(value: f64) -> f64 {
    (value * 100.0).round() / 100.0
}

fn number(value: f64) -> String {
    rounded(value).to_string()
}

fn joined(points: &[[f64; 2]]) -> String {
    let pair = |[x, y]: &[f64; 2]| format!("{},{}", number(*x), number(*y));
    points.iter().map(pair).collect::<Vec<_>>().join(" ")
}

fn line(from: [f64; 2], to: [f64; 2], colour: &str) -> Line {
    Line::new()
        .set("x1", number(from[0]))
        .set("y1", number(from[1]))
        .set("x2", number(to[0]))
        .set("y2", number(to[1]))
        .set("stroke", colour)
        .set("stroke-width", "0.8")
}

fn dashed(element: Element, dash: &str) -> Element {
    let mut element = element;
    if dash != "none" {
        let attributes = element.get_attributes_mut();
        attributes.insert("stroke-dasharray".to_string(), dash.into());
    }
    element
}

fn text(x: f64, y: f64, anchor: &str, content: &str) -> Text {
    Text::new(content)
        .set("x", number(x))
        .set("y", number(y))
        .set("text-anchor", anchor)
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
