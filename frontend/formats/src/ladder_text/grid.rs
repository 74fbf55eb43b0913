//! Drawn lines as a grid: which wires hang together, and which symbols lie between them.

mod names;

use super::nets::Nets;
use rungc_syntax::Span;
use smol_str::SmolStr;
use std::collections::HashMap;
use unicode_width::UnicodeWidthChar;

/// Kind of a symbol.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum Kind {
    Open,
    Closed,
    Rising,
    Falling,
    /// A comparison: its operator, after D if it compares 32 bits.
    Compare(String),
    /// INV, MEP or MEF.
    Result(&'static str),
    Output,
    /// OUT: a coil whose text starts with a device.
    Coil,
}

/// A contact, a coil, a box.
#[derive(Clone, Debug)]
pub(super) struct Symbol {
    pub kind: Kind,
    /// Its place in the source.
    pub span: Span,
    /// Words written in or above it, each with its place in the source; empty if an error in them was reported.
    pub words: Vec<(String, u32)>,
    pub row: usize,
    pub column: usize,
    /// The wires to its left and right.
    pub left: usize,
    pub right: usize,
    /// The comment at the end of its line.
    pub note: Option<SmolStr>,
}

/// Contents of a block of lines.
#[derive(Debug, Default)]
pub(super) struct Drawn {
    /// By row and column.
    pub symbols: Vec<Symbol>,
    /// Labels, with the rows that they stand on in `label_rows`.
    pub labels: Vec<(SmolStr, Span)>,
    pub label_rows: Vec<usize>,
    /// The wire that is the left rail.
    pub rail: usize,
    /// The wire that is the right rail, if there is one.
    pub right: Option<usize>,
    /// Ends of wires that lead nowhere: wire, place.
    pub ends: Vec<(usize, Span)>,
    /// Symbols that mean nothing.
    pub odd: Vec<(Span, &'static str)>,
}

const RAILS: &str = "|│┃║├┣+";
const LINES: &str = "-─━═";

/// Returns true if a line is drawn: it begins with a rail, or with a wire that leads to a symbol, after a number and a
/// label perhaps.
pub(super) fn is_drawn(line: &str) -> bool {
    let after = line.trim_start_matches(|c: char| c.is_ascii_alphanumeric() || c.is_whitespace());
    let margin = &line[..line.len() - after.len()];
    let is_margin = margin.split_whitespace().all(|word| {
        let digits = word.trim_start_matches(['P', 'I', 'p', 'i']);
        digits.bytes().all(|b| b.is_ascii_digit()) && word.len() <= digits.len() + 1
    });
    let Some(first) = after.chars().next().filter(|_| is_margin) else {
        return false;
    };
    let leads_on = after[first.len_utf8()..].starts_with(|c| LINES.contains(c));
    match first {
        '+' => leads_on,
        c if RAILS.contains(c) => true,
        c if LINES.contains(c) => is_open(after),
        _ => false,
    }
}

/// Returns true if a line that begins with a wire is drawn without a rail: the wire leads to a contact in brackets or
/// bars, or to an output, and a wire or an output comes after it.
fn is_open(line: &str) -> bool {
    let symbols = line.trim_start_matches(|c| LINES.contains(c));
    // One dash and a space begin an item of a list.
    let is_long = line.chars().nth(1).is_some_and(|c| LINES.contains(c));
    let symbols = symbols
        .strip_prefix(' ')
        .filter(|_| is_long)
        .unwrap_or(symbols);
    let mut inside = symbols.chars();
    let opens = match inside.next() {
        // A line of a table has dashes between its bars.
        Some('|') => inside.next().is_some_and(|c| !LINES.contains(c)),
        first => first.is_some_and(|c| "[(]┤".contains(c)),
    };
    let ends = |(at, close): (usize, char)| {
        let rest = &symbols[at + close.len_utf8()..];
        let rest = rest.strip_prefix(' ').unwrap_or(rest);
        "])|[├".contains(close) && rest.starts_with(|c| LINES.contains(c) || "+┬(".contains(c))
    };
    opens && symbols.char_indices().skip(1).any(ends)
}

/// Returns true if a line without a rail names the contacts of the drawn line below it: it consists of devices alone.
pub(super) fn is_names(line: &str) -> bool {
    let mut words = line.split_whitespace().peekable();
    words.peek().is_some() && words.all(is_device)
}

/// Column of the first rail of a row, or of the first wire of one without rails, after a number and a label perhaps.
fn rail_of(row: &[(char, u32)]) -> Option<usize> {
    let at = row
        .iter()
        .position(|(c, _)| !c.is_ascii_alphanumeric() && *c != ' ')?;
    let is_rail = RAILS.contains(row[at].0)
        || LINES.contains(row[at].0) && {
            let rest: String = row[at..].iter().map(|cell| cell.0).collect();
            is_open(&rest)
        };
    is_rail.then_some(at)
}

/// Neighbours that a character of a wire reaches: left, right, up, down.
fn arms(c: char) -> Option<[bool; 4]> {
    let arms = match c {
        c if LINES.contains(c) => [true, true, false, false],
        '|' | '+' | '┼' | '╋' => [true; 4],
        '│' | '┃' | '║' => [false, false, true, true],
        '├' | '┣' => [false, true, true, true],
        '┤' | '┫' => [true, false, true, true],
        '┬' | '┳' => [true, true, false, true],
        '┴' | '┻' => [true, true, true, false],
        '┌' | '┏' | '╭' => [false, true, false, true],
        '┐' | '┓' | '╮' => [true, false, false, true],
        '└' | '┗' | '╰' => [false, true, true, false],
        '┘' | '┛' | '╯' => [true, false, true, false],
        _ => return None,
    };
    Some(arms)
}

/// Drawn lines that follow each other.
#[derive(Default)]
pub(super) struct Block {
    /// Characters by row and column of a terminal, each with its place in the source; a wide one is followed by NUL.
    rows: Vec<Vec<(char, u32)>>,
    /// Comments at the ends of lines.
    notes: Vec<Option<SmolStr>>,
}

impl Block {
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Takes a line, which starts at `start`.
    pub fn push(&mut self, line: &str, start: u32) {
        // It may hold brackets and rails itself.
        let mut marks = line.match_indices(';').map(|(at, _)| at);
        let comment = marks.find(|at| {
            let drawn = line[..*at].trim_end();
            drawn.ends_with(|c| LINES.contains(c) || "|│┃║┤┫)]".contains(c))
        });
        let (drawn, note) = line.split_at(comment.unwrap_or(line.len()));
        self.notes
            .push(crate::text::clean(note.trim_start_matches(';')));
        let mut row = Vec::with_capacity(drawn.len());
        for (at, c) in drawn.char_indices() {
            let at = start + at as u32;
            let (c, width) = match c {
                '\t' => (' ', 8 - row.len() % 8),
                c => (c, c.width().unwrap_or(0)),
            };
            for i in 0..width {
                row.push((if i == 0 || c == ' ' { c } else { '\0' }, at));
            }
        }
        self.rows.push(row);
    }

    fn at(&self, row: usize, column: usize) -> char {
        self.rows
            .get(row)
            .and_then(|row| row.get(column))
            .map_or(' ', |cell| cell.0)
    }

    fn span(&self, row: usize, first: usize, end: usize) -> Span {
        let place = |column: usize| self.rows[row].get(column).map(|cell| cell.1);
        let start = place(first).unwrap_or_default();
        let last = end.saturating_sub(1).max(first);
        let last = self.rows[row]
            .get(last)
            .map_or(start, |(c, at)| at + c.len_utf8() as u32);
        Span::new(start, last.max(start))
    }

    /// Finds symbols and wires.
    pub fn read(&self) -> Drawn {
        let mut scan = Scan {
            block: self,
            drawn: Drawn::default(),
            spans: Vec::new(),
            symbol_at: HashMap::new(),
            folds: Vec::new(),
        };
        let firsts: Vec<Option<usize>> = self.rows.iter().map(|row| rail_of(row)).collect();
        let usual = firsts.iter().flatten().min().copied().unwrap_or(0);
        // A number or label before a rail may push it to the right; a row without anything before its first wire has no
        // rail but the usual one.
        let rails: Vec<usize> = firsts
            .iter()
            .zip(&self.rows)
            .map(|(first, row)| {
                let first = first.unwrap_or(usual);
                let blank = row[..first.min(row.len())].iter().all(|cell| cell.0 == ' ');
                if blank { usual } else { first }
            })
            .collect();
        for (row, &rail) in rails.iter().enumerate() {
            scan.margin(row, rail);
            scan.row(row, rail);
        }
        scan.connect(&rails);
        scan.drawn
    }
}

/// A block in work.
struct Scan<'a> {
    block: &'a Block,
    drawn: Drawn,
    /// The columns that each symbol takes, and one past the last.
    spans: Vec<(usize, usize)>,
    /// The symbols by the cells that they take.
    symbol_at: HashMap<(usize, usize), usize>,
    /// Continuations of rows: number, whether it leaves, row, first column and one past the last.
    folds: Vec<(u32, bool, usize, usize, usize)>,
}

impl Scan<'_> {
    /// A label to the left of the rail.
    fn margin(&mut self, row: usize, rail: usize) {
        let mut at = 0;
        while at < rail {
            let start = at;
            while at < rail && self.block.at(row, at).is_ascii_alphanumeric() {
                at += 1;
            }
            let word: String = (start..at)
                .map(|column| self.block.at(row, column))
                .collect();
            if word.starts_with(|c: char| c.is_ascii_alphabetic()) {
                let span = self.block.span(row, start, at);
                self.drawn.labels.push((word.to_uppercase().into(), span));
                self.drawn.label_rows.push(row);
            }
            at = at.max(start + 1);
        }
    }

    fn row(&mut self, row: usize, rail: usize) {
        let mut at = rail + 1;
        while at < self.block.rows[row].len() {
            at = match self.symbol(row, at) {
                Some(end) => end,
                None => at + 1,
            };
        }
    }

    fn is_wire(&self, row: usize, column: usize) -> bool {
        let c = self.block.at(row, column);
        LINES.contains(c) || "+┬┴┼├┤".contains(c)
    }

    /// Returns true if a wire or another symbol is to the left of a bracket; other brackets are parts of comments.
    fn is_led_to(&self, row: usize, at: usize) -> bool {
        let mut before = (0..at).rev();
        let before = before.find(|column| self.block.at(row, *column) != ' ');
        before.is_some_and(|column| {
            let c = self.block.at(row, column);
            let is_symbol = self.symbol_at.contains_key(&(row, column));
            is_symbol || LINES.contains(c) || "→|+├┤┼┬┴└┌┣".contains(c)
        })
    }

    /// The symbol that starts at a cell: its end.
    fn symbol(&mut self, row: usize, at: usize) -> Option<usize> {
        let line = |column: usize| self.block.at(row, column);
        let (first, second, third) = (line(at), line(at + 1), line(at + 2));
        let before = at
            .checked_sub(1)
            .is_some_and(|before| self.is_wire(row, before));
        match first {
            '(' if self.is_led_to(row, at) => return self.enclosed(row, at, ')'),
            '[' if self.is_led_to(row, at) => return self.enclosed(row, at, ']'),
            '┤' | ']' if matches!((first, third), ('┤', '├') | (']', '[')) => {
                return self.contact(row, at, at + 3, second);
            }
            ']' if second == '[' => return self.contact(row, at, at + 2, ' '),
            '|' if before && second == '|' && self.is_wire(row, at + 2) => {
                return self.contact(row, at, at + 2, ' ');
            }
            '|' if before
                && third == '|'
                && self.is_wire(row, at + 3)
                && kind(second).is_some() =>
            {
                return self.contact(row, at, at + 3, second);
            }
            '|' if before => return self.between_bars(row, at),
            '→' => {
                let mut end = at + 1;
                while line(end).is_ascii_digit() {
                    end += 1;
                }
                let digits = |from: usize, end: usize| -> Option<u32> {
                    (from..end).map(line).collect::<String>().parse().ok()
                };
                if let Some(number) = digits(at + 1, end) {
                    self.folds.push((number, true, row, at, end));
                    return Some(end);
                }
                let mut start = at;
                while start > 0 && line(start - 1).is_ascii_digit() {
                    start -= 1;
                }
                self.folds
                    .push((digits(start, at)?, false, row, start, at + 1));
                return Some(at + 1);
            }
            '/' | '↑' | '↓' if before && self.is_wire(row, at + 1) => {
                let name = match first {
                    '/' => "INV",
                    '↑' => "MEP",
                    _ => "MEF",
                };
                self.add(row, (at, at + 1), Kind::Result(name), Vec::new());
                return Some(at + 1);
            }
            _ => {}
        }
        None
    }

    /// `|X000|` or `|/X000|`, between wires.
    fn between_bars(&mut self, row: usize, at: usize) -> Option<usize> {
        let mut end = at + 1;
        while self.block.at(row, end).is_ascii_alphanumeric()
            || "/. ↑↓".contains(self.block.at(row, end))
        {
            if end >= self.block.rows[row].len() {
                return None;
            }
            end += 1;
        }
        let has_name = (at + 1..end).any(|column| self.block.at(row, column).is_ascii_digit());
        if !has_name || self.block.at(row, end) != '|' || !self.is_wire(row, end + 1) {
            return None;
        }
        let words = self.words(row, at + 1, end);
        self.named(row, (at, end + 1), words);
        Some(end + 1)
    }

    /// Finds the end of a bracket; brackets in texts do not count.
    fn enclosed(&mut self, row: usize, at: usize, close: char) -> Option<usize> {
        let mut quoted = false;
        let mut end = at + 1;
        while end < self.block.rows[row].len() {
            let c = self.block.at(row, end);
            quoted ^= c == '"';
            if c == close && !quoted {
                break;
            }
            end += 1;
        }
        let open = end >= self.block.rows[row].len();
        let mut words = self.words(row, at + 1, end);
        if close == ')' && !open {
            self.name_coil(row, (at, end + 1), &mut words);
        }
        let span = self.block.span(row, at, end + 1);
        if open || words.is_empty() && close == ')' {
            let why = if open {
                "this bracket is not closed"
            } else {
                "a coil needs a device"
            };
            self.drawn.odd.push((span, why));
            self.add(row, (at, end + 1), Kind::Output, Vec::new());
            return Some(end + 1);
        }
        if words.is_empty() {
            return self.contact(row, at, end + 1, ' ');
        }
        let one = words.iter().map(|word| &*word.0).collect::<Vec<_>>();
        if close == ')' {
            let kind = if is_device(one[0]) {
                Kind::Coil
            } else {
                Kind::Output
            };
            self.add(row, (at, end + 1), kind, words);
            return Some(end + 1);
        }
        let operators = ["=", ">", "<", "<>", "<=", ">=", "=>", "=<"];
        let plain = one[0].trim_start_matches(['D', 'd']);
        let infix = one.get(1).is_some_and(|word| operators.contains(word)) && one.len() == 3;
        if operators.contains(&plain) || infix {
            let mut words = words;
            let (operator, _) = words.remove(usize::from(infix));
            let kind = Kind::Compare(operator.to_uppercase());
            self.add(row, (at, end + 1), kind, words);
        } else if one.len() <= 2 && is_device(one[one.len() - 1]) && kind_of(one[0]).is_some()
            || one.len() == 1 && is_device(one[0].trim_start_matches(['/', '↑', '↓']))
        {
            self.named(row, (at, end + 1), words);
        } else {
            self.add(row, (at, end + 1), Kind::Output, words);
        }
        Some(end + 1)
    }

    /// A contact with its name in it, after a sign for what it is perhaps.
    fn named(&mut self, row: usize, columns: (usize, usize), mut words: Vec<(String, u32)>) {
        let mut kind = Kind::Open;
        if words.len() == 2 {
            kind = kind_of(&words.remove(0).0).unwrap_or(Kind::Open);
        } else if let Some(sign) = words[0].0.chars().next().filter(|c| "/↑↓".contains(*c)) {
            kind = kind_of(&sign.to_string()).unwrap_or(Kind::Open);
            let rest = words[0].0[sign.len_utf8()..].to_string();
            words[0] = (rest, words[0].1 + sign.len_utf8() as u32);
        }
        self.add(row, columns, kind, words);
    }

    /// The words in some columns; a text in quotation marks is one.
    fn words(&self, row: usize, from: usize, end: usize) -> Vec<(String, u32)> {
        let mut words: Vec<(String, u32)> = Vec::new();
        let (mut open, mut quoted) = (false, false);
        let cells = &self.block.rows[row];
        let end = end.min(cells.len());
        for &(c, at) in cells.get(from..end).unwrap_or_default() {
            if c == '\0' {
                continue;
            }
            quoted ^= c == '"';
            if !quoted && (c.is_whitespace() || "|│,;".contains(c)) {
                open = false;
                continue;
            }
            match words.last_mut().filter(|_| open) {
                Some((word, _)) => word.push(c),
                None => words.push((c.to_string(), at)),
            }
            open = true;
        }
        words
    }

    fn add(&mut self, row: usize, columns: (usize, usize), kind: Kind, words: Vec<(String, u32)>) {
        for column in columns.0..columns.1 {
            self.symbol_at
                .insert((row, column), self.drawn.symbols.len());
        }
        self.spans.push(columns);
        self.drawn.symbols.push(Symbol {
            kind,
            span: self.block.span(row, columns.0, columns.1),
            words,
            row,
            column: columns.0,
            left: 0,
            right: 0,
            note: self.block.notes[row].clone(),
        });
    }

    /// Neighbours that each cell with a wire reaches.
    fn wires(&self, rails: &[usize]) -> Vec<Vec<Option<[bool; 4]>>> {
        let rows = self.block.rows.iter().enumerate();
        let mut wires: Vec<Vec<_>> = rows
            .map(|(row, cells)| {
                let cells = cells.iter().enumerate();
                let wire = |(column, cell): (usize, &(char, u32))| {
                    let free = column >= rails[row] && !self.symbol_at.contains_key(&(row, column));
                    arms(cell.0).filter(|_| free)
                };
                cells.map(wire).collect()
            })
            .collect();
        for (_, _, row, first, end) in &self.folds {
            wires[*row][*first..*end].fill(None);
        }
        wires
    }

    /// Finds out which wires each symbol lies between.
    fn connect(&mut self, rails: &[usize]) {
        let mut nets = Nets::default();
        let block = self.block;
        let last = block.rows.iter().map(Vec::len).max().unwrap_or(0);
        let wires = self.wires(rails);
        let wire = |row: usize, column: usize| *wires.get(row)?.get(column)?;
        for (row, cells) in block.rows.iter().enumerate() {
            for column in rails[row]..cells.len() {
                let Some([_, right, _, down]) = wire(row, column) else {
                    continue;
                };
                nets.cell(row, column);
                if right && wire(row, column + 1).is_some_and(|arms| arms[0]) {
                    nets.join((row, column), (row, column + 1));
                }
                if down && wire(row + 1, column).is_some_and(|arms| arms[2]) {
                    nets.join((row, column), (row + 1, column));
                }
            }
        }
        let rows =
            |column: usize| (0..block.rows.len()).filter(move |row| wire(*row, column).is_some());
        let mut left = None;
        for (row, &rail) in rails.iter().enumerate() {
            if wire(row, rail).is_some() {
                let first = *left.get_or_insert((row, rail));
                nets.join(first, (row, rail));
            }
        }
        let least = rails.iter().max().copied().unwrap_or(0);
        let right_column = last.checked_sub(1).filter(|column| *column > least);
        let mut right = None;
        if let Some(column) = right_column {
            for row in rows(column).filter(|row| "|│┃║┤┫+".contains(block.at(*row, column)))
            {
                let first = *right.get_or_insert((row, column));
                nets.join(first, (row, column));
            }
        }
        self.attach(&mut nets, &wire);
        for (row, &rail) in rails.iter().enumerate() {
            for column in rail..block.rows[row].len() {
                let Some([_, true, ..]) = wire(row, column) else {
                    continue;
                };
                let is_line = LINES.contains(block.at(row, column));
                let ends =
                    is_line && wire(row, column + 1).is_none() && !self.leads_on(row, column + 1);
                if ends {
                    let span = block.span(row, column, column + 1);
                    let net = nets.cell(row, column);
                    self.drawn.ends.push((net, span));
                }
            }
        }
        let find = |nets: &mut Nets, place: Option<(usize, usize)>| {
            place.map(|(row, column)| nets.cell(row, column))
        };
        self.drawn.rail = find(&mut nets, left).unwrap_or(usize::MAX);
        self.drawn.right = find(&mut nets, right);
        for end in &mut self.drawn.ends {
            end.0 = nets.root(end.0);
        }
        for symbol in &mut self.drawn.symbols {
            symbol.left = nets.root(symbol.left);
            symbol.right = nets.root(symbol.right);
        }
    }

    /// Returns true if a symbol or fold comes after at most two spaces.
    fn leads_on(&self, row: usize, column: usize) -> bool {
        let mut at = column;
        while at < column + 3 && self.block.at(row, at) == ' ' {
            at += 1;
        }
        let fold = |fold: &(u32, bool, usize, usize, usize)| {
            fold.2 == row && (fold.3..fold.4).contains(&at)
        };
        self.symbol_at.contains_key(&(row, at))
            || self.folds.iter().any(fold)
            || arms(self.block.at(row, at)).is_some_and(|arms| arms[0])
    }

    /// The wires beside symbols and folds, at most two spaces away.
    fn attach(&mut self, nets: &mut Nets, wire: &impl Fn(usize, usize) -> Option<[bool; 4]>) {
        let symbols = &self.symbol_at;
        let beside =
            |nets: &mut Nets, row: usize, column: usize, to_left: bool| -> (usize, Option<usize>) {
                for away in 0..3 {
                    let at = if to_left {
                        column.checked_sub(1 + away)
                    } else {
                        Some(column + away)
                    };
                    let Some(at) = at else { break };
                    if wire(row, at).is_some_and(|arms| arms[usize::from(to_left)]) {
                        return (nets.cell(row, at), None);
                    }
                    if let Some(other) = symbols.get(&(row, at)) {
                        return (nets.fresh(), Some(*other));
                    }
                    if self.block.at(row, at) != ' ' {
                        break;
                    }
                }
                (nets.fresh(), None)
            };
        let mut folds = HashMap::new();
        for (number, leaves, row, first, end) in &self.folds {
            let net = match leaves {
                true => beside(nets, *row, *first, true).0,
                false => beside(nets, *row, *end, false).0,
            };
            match folds.remove(number) {
                Some(other) => nets.merge(other, net),
                None => _ = folds.insert(*number, net),
            }
        }
        let mut sides = Vec::with_capacity(self.spans.len());
        for (i, (first, end)) in self.spans.iter().enumerate() {
            let row = self.drawn.symbols[i].row;
            sides.push((
                beside(nets, row, *first, true),
                beside(nets, row, *end, false),
            ));
        }
        // Symbols without a wire between them.
        for (i, (left, right)) in sides.iter().enumerate() {
            self.drawn.symbols[i].left = left.0;
            self.drawn.symbols[i].right = right.0;
            if let Some(before) = left.1 {
                nets.merge(left.0, sides[before].1.0);
            }
        }
    }
}

/// Kind of a contact by its sign.
fn kind(sign: char) -> Option<Kind> {
    Some(match sign {
        ' ' => Kind::Open,
        '/' | '\\' => Kind::Closed,
        '↑' | '^' | 'P' | 'p' => Kind::Rising,
        '↓' | 'v' | 'N' | 'n' | 'F' | 'f' => Kind::Falling,
        _ => return None,
    })
}

fn kind_of(word: &str) -> Option<Kind> {
    let mut signs = word.chars();
    let sign = signs.next()?;
    kind(sign).filter(|_| signs.next().is_none())
}

/// Returns true if a word looks like a device that has a contact or a coil; the grammar of operands decides.
pub(super) fn is_device(word: &str) -> bool {
    let letters = word.trim_end_matches(|c: char| !c.is_ascii_alphabetic());
    let digits = word.trim_start_matches(|c: char| c.is_ascii_alphabetic());
    let mut class = word.chars();
    class.next().is_some_and(|c| "XYMSTCDxymstcd".contains(c))
        && class.next().is_some_and(|c| c.is_ascii_digit())
        && !letters.is_empty()
        && !digits.is_empty()
        && word.chars().all(|c| c.is_ascii_alphanumeric() || c == '.')
}
