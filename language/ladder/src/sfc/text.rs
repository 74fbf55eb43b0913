//! Drawing a chart in characters.

use super::Chart;
use super::place::{BOX, Piece, Sheet, Words, place_within};
use unicode_width::UnicodeWidthChar;

/// Neighbours that the lines of a cell reach.
const LEFT: u8 = 1;
const RIGHT: u8 = 2;
const UP: u8 = 4;
const DOWN: u8 = 8;
/// Its lines are double.
const DOUBLE_ACROSS: u8 = 16;
const DOUBLE_DOWN: u8 = 32;

impl Chart {
    /// The chart in characters, on lines of at most `width` columns where a single branch is not wider.
    pub fn text(&self, width: usize) -> String {
        let sheet = place_within(self, width);
        let mut canvas = Canvas::new(&sheet);
        for piece in &sheet.pieces {
            match piece {
                Piece::State { x, y, state } => {
                    canvas.state(*x, *y, self.states[*state].is_initial());
                    let name = self.states[*state].device.to_string();
                    let start = x + (BOX - name.len().min(BOX)) / 2;
                    canvas.put(start, y + 1, &name);
                }
                Piece::Bar { x, y } => canvas.across(*y, x - 1, x + 1, false),
                Piece::Text { x, y, text } => {
                    let (Words::Name(text) | Words::Action(text, ..) | Words::Plain(text)) = text;
                    canvas.put(*x, *y, text);
                }
                Piece::Arrow { x, y, states } => {
                    canvas.put(*x, *y, &format!("↓ {}", self.names(states)));
                }
                Piece::Down { x, from, to } => canvas.down(*x, *from, *to, false),
                Piece::Across {
                    y,
                    from,
                    to,
                    double,
                } => canvas.across(*y, *from, *to, *double),
            }
        }
        canvas.text()
    }

    /// The names of states, one after another.
    pub(super) fn names(&self, states: &[usize]) -> String {
        let names = states
            .iter()
            .map(|&state| self.states[state].device.to_string());
        names.collect::<Vec<_>>().join(" ")
    }
}

/// Lines and texts by cells; a wide character takes two.
struct Canvas {
    lines: Vec<Vec<u8>>,
    texts: Vec<Vec<Option<char>>>,
}

impl Canvas {
    fn new(sheet: &Sheet) -> Self {
        Canvas {
            lines: vec![vec![0; sheet.width + BOX]; sheet.height],
            texts: vec![vec![Some('\0'); sheet.width + BOX]; sheet.height],
        }
    }

    fn state(&mut self, x: usize, y: usize, double: bool) {
        let right = x + BOX - 1;
        for y in [y, y + 2] {
            self.across(y, x, right, double);
        }
        for x in [x, right] {
            self.down(x, y, y + 2, double);
        }
    }

    fn across(&mut self, y: usize, from: usize, to: usize, double: bool) {
        let style = if double { DOUBLE_ACROSS } else { 0 };
        for x in from..=to {
            let left = if x > from { LEFT } else { 0 };
            let right = if x < to { RIGHT } else { 0 };
            self.lines[y][x] |= left | right | style;
        }
    }

    fn down(&mut self, x: usize, from: usize, to: usize, double: bool) {
        let style = if double { DOUBLE_DOWN } else { 0 };
        for y in from..=to {
            let up = if y > from { UP } else { 0 };
            let down = if y < to { DOWN } else { 0 };
            self.lines[y][x] |= up | down | style;
        }
    }

    fn put(&mut self, mut x: usize, y: usize, text: &str) {
        let row = &mut self.texts[y];
        for character in text.chars() {
            let width = character.width().unwrap_or(0);
            if width == 0 || x + width > row.len() {
                continue;
            }
            row[x] = Some(character);
            row[x + 1..x + width].fill(None);
            x += width;
        }
    }

    fn text(&self) -> String {
        let mut out = String::new();
        for (lines, texts) in self.lines.iter().zip(&self.texts) {
            let cells = lines.iter().zip(texts);
            let line: String = cells
                .filter_map(|(arms, text)| match text {
                    Some('\0') => Some(symbol(*arms)),
                    text => *text,
                })
                .collect();
            out.push_str(line.trim_end());
            out.push('\n');
        }
        out
    }
}

/// The character of lines that meet in a cell.
fn symbol(cell: u8) -> char {
    let across = cell & DOUBLE_ACROSS != 0;
    let down = cell & DOUBLE_DOWN != 0;
    let single = match cell & 15 {
        0 => ' ',
        a if a & (UP | DOWN) == 0 => '─',
        a if a & (LEFT | RIGHT) == 0 => '│',
        5 => '┘',
        6 => '└',
        7 => '┴',
        9 => '┐',
        10 => '┌',
        11 => '┬',
        13 => '┤',
        14 => '├',
        _ => '┼',
    };
    let plain = "─│┘└┴┐┌┬┤├┼";
    let other = match (across, down) {
        (false, false) => return single,
        (true, true) => "═║╝╚╩╗╔╦╣╠╬",
        (true, false) => "═│╛╘╧╕╒╤╡╞╪",
        (false, true) => "─║╜╙╨╖╓╥╢╟╫",
    };
    let at = plain.chars().position(|c| c == single);
    at.and_then(|at| other.chars().nth(at)).unwrap_or(single)
}
