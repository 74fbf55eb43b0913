//! A diagram as marks, for pages and documents.

use super::draw::INK;
use svg::node::element::{Element, Group, Line, Polygon, Polyline, Rectangle, Text};
use svg::{Document, Node};

/// A drawn diagram.
#[derive(Clone, PartialEq, Debug)]
pub struct Diagram {
    /// Width and height, in pixels.
    pub size: [f64; 2],
    /// Its marks, the lower ones first.
    pub marks: Vec<Mark>,
}

/// A line to draw.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Stroke {
    /// Colour, as `#rrggbb`.
    pub colour: &'static str,
    /// Width, in pixels.
    pub width: f64,
    /// Lengths of dashes and gaps, in pixels; [`NO_DASH`] without.
    pub dash: &'static str,
}

/// Dashes of a continuous line.
pub const NO_DASH: &str = "none";

/// Part of a text that is at its place.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Anchor {
    /// Its beginning.
    Start,
    /// Its middle.
    Middle,
    /// Its end.
    End,
}

/// Mark of a diagram. Places are in pixels from the upper left corner.
#[derive(Clone, PartialEq, Debug)]
pub enum Mark {
    /// A straight line.
    Line {
        /// Beginning.
        from: [f64; 2],
        /// End.
        to: [f64; 2],
        /// Style of the line.
        stroke: Stroke,
    },
    /// A line through several points.
    Curve {
        /// The points.
        points: Vec<[f64; 2]>,
        /// Style of the line.
        stroke: Stroke,
        /// True if its corners are round.
        is_round: bool,
    },
    /// A filled polygon.
    Area {
        /// Its corners.
        points: Vec<[f64; 2]>,
        /// Colour, as `#rrggbb`.
        colour: &'static str,
    },
    /// The border of a rectangle.
    Frame {
        /// Its upper left corner.
        at: [f64; 2],
        /// Its width and height.
        size: [f64; 2],
        /// Style of the line.
        stroke: Stroke,
    },
    /// A line of text.
    Text {
        /// Place on its base line.
        at: [f64; 2],
        /// Part of the text that is there.
        anchor: Anchor,
        /// Height in pixels, if it is not the usual one, 12.
        size: Option<u8>,
        /// True if it is bold.
        bold: bool,
        /// The text.
        text: String,
    },
}

impl Diagram {
    /// The diagram as SVG that needs nothing beside it.
    pub fn svg(&self) -> String {
        let [width, height] = self.size;
        let group = Group::new()
            .set("font-family", "Helvetica, Arial, sans-serif")
            .set("font-size", 12)
            .set("fill", INK);
        let marks = self.marks.iter();
        let group = marks.fold(group, |group, mark| group.add(element(mark)));
        let background = Rectangle::new()
            .set("width", number(width))
            .set("height", number(height))
            .set("fill", "#ffffff");
        let document = Document::new()
            .set("width", number(width))
            .set("height", number(height))
            .set(
                "viewBox",
                format!("0 0 {} {}", number(width), number(height)),
            )
            .add(background)
            .add(group);
        format!("{document}\n")
    }
}

fn element(mark: &Mark) -> Element {
    match mark {
        Mark::Line { from, to, stroke } => {
            let line = Line::new()
                .set("x1", number(from[0]))
                .set("y1", number(from[1]))
                .set("x2", number(to[0]))
                .set("y2", number(to[1]));
            stroked(line.into(), *stroke)
        }
        Mark::Curve {
            points,
            stroke,
            is_round,
        } => {
            let mut curve = Polyline::new()
                .set("points", joined(points))
                .set("fill", "none");
            if *is_round {
                curve.assign("stroke-linejoin", "round");
            }
            stroked(curve.into(), *stroke)
        }
        Mark::Area { points, colour } => Polygon::new()
            .set("points", joined(points))
            .set("fill", *colour)
            .into(),
        Mark::Frame { at, size, stroke } => {
            let frame = Rectangle::new()
                .set("x", number(at[0]))
                .set("y", number(at[1]))
                .set("width", number(size[0]))
                .set("height", number(size[1]))
                .set("fill", "none");
            stroked(frame.into(), *stroke)
        }
        Mark::Text {
            at,
            anchor,
            size,
            bold,
            text,
        } => {
            let anchor = match anchor {
                Anchor::Start => "start",
                Anchor::Middle => "middle",
                Anchor::End => "end",
            };
            let mut element = Text::new(text.as_str())
                .set("x", number(at[0]))
                .set("y", number(at[1]))
                .set("text-anchor", anchor);
            if let Some(size) = size {
                element.assign("font-size", *size);
            }
            if *bold {
                element.assign("font-weight", "bold");
            }
            element.into()
        }
    }
}

fn stroked(mut element: Element, stroke: Stroke) -> Element {
    let attributes = element.get_attributes_mut();
    attributes.insert("stroke".to_string(), stroke.colour.into());
    attributes.insert("stroke-width".to_string(), number(stroke.width).into());
    if stroke.dash != NO_DASH {
        attributes.insert("stroke-dasharray".to_string(), stroke.dash.into());
    }
    element
}

/// To a hundredth of a pixel.
pub(super) fn rounded(value: f64) -> f64 {
    (value * 100.0).round() / 100.0
}

fn number(value: f64) -> String {
    rounded(value).to_string()
}

fn joined(points: &[[f64; 2]]) -> String {
    let pair = |[x, y]: &[f64; 2]| format!("{},{}", number(*x), number(*y));
    points.iter().map(pair).collect::<Vec<_>>().join(" ")
}
