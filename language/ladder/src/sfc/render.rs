//! Drawing a chart as a picture.

use super::Chart;
use super::place::{BOX, Piece, Sheet, Words, place};
use crate::picture::{CHARACTER, Mark, Picture, line, text};

/// Height of a line of text, in pixels.
const LINE: f64 = 17.0;
/// Around the chart.
const BORDER: f64 = 6.0;
/// From the middle of a double line to each of its lines.
const APART: f64 = 2.0;

/// The middle of a cell.
fn middle(x: usize, y: usize) -> (f64, f64) {
    let x = (x as f64 + 0.5) * CHARACTER + BORDER;
    (x, (y as f64 + 0.5) * LINE + BORDER)
}

impl Chart {
    pub(crate) fn picture(&self) -> Picture {
        let sheet = place(self);
        let marks = sheet.pieces.iter().map(|piece| self.piece(piece));
        let size = (
            sheet.width as f64 * CHARACTER + 2.0 * BORDER,
            sheet.height as f64 * LINE + 2.0 * BORDER,
        );
        Picture {
            size,
            marks: marks.collect(),
            breaks: Chart::breaks(&sheet),
        }
    }

    /// Heights that cut no text and no box.
    fn breaks(sheet: &Sheet) -> Vec<f64> {
        let mut whole = vec![true; sheet.height + 1];
        for piece in &sheet.pieces {
            if let Piece::State { y, .. } = piece {
                whole[y + 1] = false;
                whole[y + 2] = false;
            }
        }
        let lines = whole.into_iter().enumerate().filter(|(_, whole)| *whole);
        lines.map(|(y, _)| y as f64 * LINE + BORDER).collect()
    }

    fn piece(&self, piece: &Piece) -> Mark {
        match piece {
            Piece::State { x, y, state } => self.state((*x, *y), *state),
            Piece::Bar { x, y } => {
                let (x, y) = middle(*x, *y);
                line("rail", (x - 10.0, y), (x + 10.0, y))
            }
            Piece::Text { x, y, text: words } => {
                let (x, y) = middle(*x, *y);
                let at = (x - CHARACTER / 2.0, y + 4.0);
                match words {
                    Words::Name(name) => text("comment", at, name),
                    Words::Plain(words) => text("text", at, words),
                    Words::Action(words, state, action) => {
                        let device = self.states[*state].actions[*action].device;
                        Mark::About(device, vec![text("text", at, words)])
                    }
                }
            }
            Piece::Arrow { x, y, states } => self.arrow(middle(*x, *y), states),
            Piece::Down { x, from, to } => line("wire", middle(*x, *from), middle(*x, *to)),
            Piece::Across {
                y,
                from,
                to,
                double,
            } => {
                let (from, to) = (middle(*from, *y), middle(*to, *y));
                if !double {
                    return line("wire", from, to);
                }
                let lines = [-APART, APART]
                    .map(|by| line("wire", (from.0, from.1 + by), (to.0, to.1 + by)));
                Mark::About(None, lines.to_vec())
            }
        }
    }

    /// The box of a state, which leads to its network.
    fn state(&self, (x, y): (usize, usize), state: usize) -> Mark {
        let about = &self.states[state];
        let (left, top) = middle(x, y);
        let (right, bottom) = middle(x + BOX - 1, y + 2);
        let frame = |inset: f64| Mark::Frame {
            class: "box",
            at: (left + inset, top + inset),
            size: (right - left - 2.0 * inset, bottom - top - 2.0 * inset),
            radius: None,
        };
        let mut marks = vec![frame(0.0)];
        if about.is_initial() {
            marks.push(frame(3.0));
        }
        let name = about.device.to_string();
        let at = ((left + right) / 2.0, (top + bottom) / 2.0 + 4.0);
        let name = Mark::Link(about.network, vec![text("name middle", at, &name)]);
        marks.push(name);
        Mark::About(Some(about.device), marks)
    }

    /// An arrow to states that lie elsewhere.
    fn arrow(&self, (x, y): (f64, f64), states: &[usize]) -> Mark {
        let tip = y + LINE / 4.0;
        let mut marks = vec![line("wire", (x, y), (x, tip))];
        for side in [-4.0, 4.0] {
            marks.push(line("wire", (x + side, tip - 5.0), (x, tip)));
        }
        let names = text("name", (x + 8.0, y + 4.0), &self.names(states));
        marks.push(match states.first() {
            Some(&state) => Mark::Link(self.states[state].network, vec![names]),
            None => names,
        });
        Mark::About(None, marks)
    }
}
