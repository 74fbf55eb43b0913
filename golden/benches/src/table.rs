//! Results: printed as tables, written as JSON for tools.

use serde::Serialize;
use std::fmt;

/// One value of a row.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub enum Cell {
    /// A name, or why there is no number.
    Text(String),
    /// A number, printed with this many digits after the point.
    Number {
        /// The number.
        value: f64,
        /// Number of digits.
        #[serde(skip)]
        digits: usize,
    },
}

impl Cell {
    /// A number that is printed with this many digits after the point.
    pub fn number(value: impl Into<f64>, digits: usize) -> Cell {
        Cell::Number {
            value: value.into(),
            digits,
        }
    }

    /// A whole number.
    pub fn count(value: u64) -> Cell {
        Cell::number(value as f64, 0)
    }
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Cell::Text(text.to_string())
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Cell::Text(text)
    }
}

impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Cell::Text(text) => f.pad(text),
            Cell::Number { value, digits } => {
                let text = grouped(&format!("{value:.digits$}"));
                f.pad(&text)
            }
        }
    }
}

/// The digits in front of the point in groups of three.
fn grouped(number: &str) -> String {
    let whole = number.find('.').unwrap_or(number.len());
    let mut out = String::with_capacity(number.len() + 4);
    for (i, c) in number.char_indices() {
        let left = whole.saturating_sub(i);
        if i > 0 && i < whole && left % 3 == 0 && !out.ends_with('-') {
            out.push(' ');
        }
        out.push(c);
    }
    out
}

/// A table.
#[derive(Clone, Debug, Serialize)]
pub struct Table {
    /// Title.
    pub title: String,
    /// Names of the columns.
    pub columns: Vec<String>,
    /// The rows. A row that is shorter ends with a text that says why.
    pub rows: Vec<Vec<Cell>>,
}

impl Table {
    /// An empty table.
    pub fn new(title: impl Into<String>, columns: &[&str]) -> Self {
        Table {
            title: title.into(),
            columns: columns.iter().map(|name| (*name).to_string()).collect(),
            rows: Vec::new(),
        }
    }

    /// Adds a row.
    pub fn row(&mut self, cells: impl IntoIterator<Item = Cell>) {
        self.rows.push(cells.into_iter().collect());
    }
}

impl fmt::Display for Table {
    /// As Markdown.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut widths: Vec<usize> = self.columns.iter().map(|c| c.chars().count()).collect();
        for row in self
            .rows
            .iter()
            .filter(|row| row.len() == self.columns.len())
        {
            for (width, cell) in widths.iter_mut().zip(row) {
                *width = (*width).max(cell.to_string().chars().count());
            }
        }
        writeln!(f, "### {}\n", self.title)?;
        let right = |column: usize| {
            let mut cells = self.rows.iter().filter_map(|row| row.get(column));
            cells.any(|cell| matches!(cell, Cell::Number { .. }))
        };
        let mut line = |cells: &mut dyn Iterator<Item = String>| -> fmt::Result {
            write!(f, "|")?;
            for (column, cell) in cells.enumerate() {
                let width = widths[column];
                match right(column) {
                    true => write!(f, " {cell:>width$} |")?,
                    false => write!(f, " {cell:<width$} |")?,
                }
            }
            writeln!(f)
        };
        line(&mut self.columns.iter().cloned())?;
        let rule = |column: usize| match right(column) {
            true => format!("{}:", "-".repeat(widths[column].saturating_sub(1))),
            false => "-".repeat(widths[column]),
        };
        line(&mut (0..widths.len()).map(rule))?;
        for row in &self.rows {
            let blank = std::iter::repeat_n(String::new(), self.columns.len() - row.len());
            line(&mut row.iter().map(Cell::to_string).chain(blank))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_markdown() {
        let mut table = Table::new("Sizes", &["what", "bytes", "per step"]);
        table.row([
            "hand-written".into(),
            Cell::count(1_234_567),
            Cell::number(-1234.5, 2),
        ]);
        table.row(["Rust".into(), "not installed: cargo".into()]);
        assert_eq!(
            table.to_string(),
            "### Sizes\n\n\
             | what         |     bytes |  per step |\n\
             | ------------ | --------: | --------: |\n\
             | hand-written | 1 234 567 | -1 234.50 |\n\
             | Rust         | not installed: cargo |           |\n"
        );
    }
}
