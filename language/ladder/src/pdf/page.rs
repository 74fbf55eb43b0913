//! A page of A4: what stands on it, as operators of its content stream.

use super::fonts::{NARROW, runs, width};
use crate::picture::{Mark, Point};
use pdf_writer::{Content, Str};
use rungc_syntax::text::one_line;

/// A4, in points.
pub(super) const PAPER: (f64, f64) = (595.28, 841.89);
/// 12 mm.
pub(super) const EDGE: f64 = 34.0;
/// For the head and the foot of a page.
pub(super) const HEAD: f64 = 20.0;
/// Of the size, how much a control point of a quarter of a circle lies beyond its end.
const ROUND: f64 = 0.5523;

/// A page in work. Places are in points from its upper left corner.
pub(super) struct Page {
    pub content: Content,
}

/// Marks on a page: where their upper left corner lies, and how large they are.
#[derive(Clone, Copy)]
pub(super) struct Placement {
    pub at: Point,
    pub scale: f64,
}

impl Page {
    pub(super) fn new() -> Self {
        let mut content = Content::new();
        content.set_line_cap(pdf_writer::types::LineCapStyle::ProjectingSquareCap);
        Page { content }
    }

    /// A line of text from its base line. `anchor` says how much of it is to the left of the place.
    pub(super) fn text(&mut self, text: &str, at: Point, size: f64, anchor: f64, gray: f32) {
        let text = one_line(text);
        let mut x = at.0 - width(&text) * size * anchor;
        self.content.set_fill_gray(gray);
        for run in runs(&text) {
            self.content.begin_text();
            self.content.set_font(run.font.name(), size as f32);
            let scaling = if run.narrowed { 100.0 * NARROW } else { 100.0 };
            self.content.set_horizontal_scaling(scaling as f32);
            self.content.next_line(x as f32, (PAPER.1 - at.1) as f32);
            self.content.show(Str(&run.bytes));
            self.content.end_text();
            x += run.width * size;
        }
    }

    pub(super) fn line(&mut self, from: Point, to: Point, width: f64) {
        self.content.set_line_width(width as f32);
        self.go(from);
        self.draw_to(to);
        self.content.stroke();
    }

    /// A line through these points.
    pub(super) fn curve(&mut self, points: &[Point], width: f64, colour: [f32; 3]) {
        self.content.save_state();
        let [red, green, blue] = colour;
        self.content.set_stroke_rgb(red, green, blue);
        self.content.set_line_width(width as f32);
        self.path(points);
        self.content.stroke();
        self.content.restore_state();
    }

    /// A filled polygon.
    pub(super) fn area(&mut self, points: &[Point], colour: [f32; 3]) {
        self.content.save_state();
        let [red, green, blue] = colour;
        self.content.set_fill_rgb(red, green, blue);
        self.path(points);
        self.content.fill_nonzero();
        self.content.restore_state();
    }

    fn path(&mut self, points: &[Point]) {
        for (i, point) in points.iter().enumerate() {
            match i {
                0 => self.go(*point),
                _ => self.draw_to(*point),
            }
        }
    }

    fn go(&mut self, to: Point) {
        self.content.move_to(to.0 as f32, (PAPER.1 - to.1) as f32);
    }

    fn draw_to(&mut self, to: Point) {
        self.content.line_to(to.0 as f32, (PAPER.1 - to.1) as f32);
    }

    /// The part of some marks from one height to another, in their own pixels, with the upper one at the placement.
    pub(super) fn slice(&mut self, marks: &[Mark], on: Placement, part: (f64, f64)) {
        self.content.save_state();
        let height = (part.1 - part.0) * on.scale;
        let top = (PAPER.1 - on.at.1 - height) as f32;
        self.content
            .rect(0.0, top, PAPER.0 as f32, height as f32)
            .clip_nonzero()
            .end_path();
        let shifted = Placement {
            at: (on.at.0, on.at.1 - part.0 * on.scale),
            ..on
        };
        for mark in marks {
            self.mark(mark, shifted, part);
        }
        self.content.restore_state();
    }

    fn mark(&mut self, mark: &Mark, on: Placement, part: (f64, f64)) {
        let place = |at: Point| (on.at.0 + at.0 * on.scale, on.at.1 + at.1 * on.scale);
        let outside = |top: f64, bottom: f64| bottom < part.0 || top > part.1;
        match mark {
            Mark::Line { class, from, to } => {
                let width = match *class {
                    class if class.ends_with("lit") => 3.2,
                    "rail" => 2.0,
                    _ => 1.3,
                };
                if !outside(from.1.min(to.1), from.1.max(to.1)) {
                    self.line(place(*from), place(*to), width * on.scale);
                }
            }
            Mark::Wires(wires) => {
                for (from, to) in wires {
                    if !outside(from.1, to.1) {
                        self.line(place(*from), place(*to), 1.3 * on.scale);
                    }
                }
            }
            Mark::Text { class, at, text } => {
                let anchor = match class {
                    class if class.contains("middle") => 0.5,
                    class if class.contains("end") => 1.0,
                    _ => 0.0,
                };
                let soft = class.contains("comment") || class.contains("margin");
                let size = if class.contains("comment") {
                    11.0
                } else {
                    12.0
                };
                let gray = if soft { 0.35 } else { 0.0 };
                if !outside(at.1 - size, at.1) {
                    self.text(text, place(*at), size * on.scale, anchor, gray);
                }
            }
            Mark::Frame {
                class: "area" | "area lit",
                ..
            } => {}
            Mark::Frame {
                class,
                at,
                size,
                radius,
            } => {
                if !outside(at.1, at.1 + size.1) {
                    let far = place((at.0 + size.0, at.1 + size.1));
                    let radius = f64::from(radius.unwrap_or(0)) * on.scale;
                    self.frame(place(*at), far, radius);
                    self.content.set_fill_gray(1.0);
                    let width = if *class == "box lit" { 3.2 } else { 1.3 };
                    self.content.set_line_width((width * on.scale) as f32);
                    match *class {
                        "gap" => self.content.fill_nonzero(),
                        _ => self.content.fill_nonzero_and_stroke(),
                    };
                }
            }
            Mark::About(_, marks) | Mark::Link(_, marks) | Mark::Live(_, marks) => {
                marks.iter().for_each(|mark| self.mark(mark, on, part));
            }
        }
    }

    /// The path of a rectangle with round corners.
    fn frame(&mut self, (left, top): Point, (right, bottom): Point, radius: f64) {
        if radius == 0.0 {
            let (width, height) = ((right - left) as f32, (bottom - top) as f32);
            let low = (PAPER.1 - bottom) as f32;
            self.content.rect(left as f32, low, width, height);
            return;
        }
        // From each corner: to its first end, over its control points, to its second end.
        let corners = [
            ((right, top), (-1.0, 0.0), (0.0, 1.0)),
            ((right, bottom), (0.0, -1.0), (-1.0, 0.0)),
            ((left, bottom), (1.0, 0.0), (0.0, -1.0)),
            ((left, top), (0.0, 1.0), (1.0, 0.0)),
        ];
        self.go((left + radius, top));
        for (corner, first, second) in corners {
            let at = |way: (f64, f64), by: f64| {
                let x = corner.0 + way.0 * radius * by;
                let y = corner.1 + way.1 * radius * by;
                (x, y)
            };
            self.draw_to(at(first, 1.0));
            let near = 1.0 - ROUND;
            let points = [at(first, near), at(second, near), at(second, 1.0)];
            let [a, b, c] = points.map(|(x, y)| (x as f32, (PAPER.1 - y) as f32));
            self.content.cubic_to(a.0, a.1, b.0, b.1, c.0, c.1);
        }
        self.content.close_path();
    }
}
