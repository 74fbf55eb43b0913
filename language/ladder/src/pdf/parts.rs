//! Parts of documents about a program: headings, paragraphs, rows of tables, drawings, diagrams.

use super::fonts::NARROW;
use super::page::{EDGE, HEAD, Page};
use super::{LINE, ROOM, SIZE, Sheets};
use crate::drawing::Drawing;
use crate::face::fold;

/// Shades of text: usual, and softer.
const INK: f32 = 0.0;
const SOFT: f32 = 0.35;

impl Sheets<'_> {
    /// A heading of this size in points, with an entry in the outline. Some lines follow on its page.
    pub fn heading(&mut self, text: &str, size: f64) {
        let height = size * 1.4;
        self.need(height + 4.0 * LINE);
        self.y += LINE / 2.0;
        self.outline(text);
        let room = (ROOM.0 / (size * NARROW)) as usize;
        for line in fold(text, room, usize::MAX) {
            self.need(height);
            let y = EDGE + HEAD + self.y + size;
            self.last().text(&line, (EDGE, y), size, 0.0, INK);
            self.y += height;
        }
    }

    /// A text in lines as wide as the page, indented by some points.
    pub fn paragraph(&mut self, text: &str, indent: f64) {
        for line in text.lines() {
            self.row(&[(indent, line)], false);
        }
    }

    /// A row of a table: texts that begin at these points and are folded before the next one begins. A soft row is
    /// paler: the heads of columns.
    pub fn row(&mut self, cells: &[(f64, &str)], is_soft: bool) {
        let ends = cells.iter().skip(1).map(|(from, _)| *from);
        let columns: Vec<(f64, Vec<String>)> = cells
            .iter()
            .zip(ends.chain([ROOM.0]))
            .map(|((from, text), end)| {
                let room = ((end - from) / (SIZE * NARROW)) as usize;
                (*from, fold(text, room.saturating_sub(1).max(1), usize::MAX))
            })
            .collect();
        let lines = columns.iter().map(|(_, lines)| lines.len()).max();
        let gray = if is_soft { SOFT } else { INK };
        for i in 0..lines.unwrap_or(0) {
            let texts: Vec<(f64, &str)> = columns
                .iter()
                .filter_map(|(from, lines)| Some((*from, lines.get(i)?.as_str())))
                .collect();
            self.line(&texts, gray);
        }
    }

    /// An empty line.
    pub fn gap(&mut self) {
        self.y += LINE / 2.0;
    }

    /// A drawing; one that is higher than the page continues on others.
    pub fn drawing(&mut self, drawing: &Drawing) {
        self.picture(&drawing.0);
    }

    /// A diagram of this size in pixels, as large as the page allows.
    pub fn figure(&mut self, size: [f64; 2], draw: impl FnOnce(&mut Pen)) {
        let scale = (ROOM.0 / size[0]).min(ROOM.1 / size[1]);
        self.need(size[1] * scale);
        let at = [EDGE, EDGE + HEAD + self.y];
        let page = self.last();
        draw(&mut Pen { page, at, scale });
        self.y += size[1] * scale;
    }
}

/// Pen for a diagram. Places are in its pixels, from the upper left corner; colours are red, green and blue, from 0 to
/// 1.
pub struct Pen<'p> {
    page: &'p mut Page,
    at: [f64; 2],
    scale: f64,
}

impl Pen<'_> {
    fn place(&self, [x, y]: [f64; 2]) -> (f64, f64) {
        (self.at[0] + x * self.scale, self.at[1] + y * self.scale)
    }

    /// A line through these points, of this width in pixels.
    pub fn curve(&mut self, points: &[[f64; 2]], width: f64, colour: [f32; 3]) {
        let points: Vec<_> = points.iter().map(|point| self.place(*point)).collect();
        self.page.curve(&points, width * self.scale, colour);
    }

    /// A polygon filled with a colour.
    pub fn area(&mut self, points: &[[f64; 2]], colour: [f32; 3]) {
        let points: Vec<_> = points.iter().map(|point| self.place(*point)).collect();
        self.page.area(&points, colour);
    }

    /// A line of text of this height in pixels; `anchor` is the part of it that is left of the place.
    pub fn text(&mut self, text: &str, at: [f64; 2], size: f64, anchor: f64) {
        let at = self.place(at);
        // The font is wider than that of the picture.
        let size = size * self.scale * 0.85;
        self.page.text(text, at, size, anchor, INK);
    }
}
