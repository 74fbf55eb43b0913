//! Output of `rungc run`: a table with a row for each change, and a timing diagram of the bits at the end.

use std::fmt::Write as _;

/// Presentation of a watched device.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Kind {
    /// As a lamp, and as a line of the timing diagram.
    Bit,
    /// As a number.
    Number,
    /// As a number that changes on its own: it does not start a row of the table.
    Running,
}

/// A column.
#[derive(Clone, Debug)]
pub struct Column {
    /// The device's name as given.
    pub name: String,
    /// Presentation.
    pub kind: Kind,
}

/// Collects the watched values scan by scan.
#[derive(Debug)]
pub struct View {
    columns: Vec<Column>,
    shown: Option<Vec<String>>,
    /// For each bit column the moments of its changes, with the new state; none if no diagram is drawn.
    traces: Vec<Vec<(u64, bool)>>,
}

/// Width of the timing diagram in characters.
const DIAGRAM_WIDTH: usize = 64;

impl View {
    /// Nothing seen yet. What a diagram is drawn of is kept if there will be one.
    pub fn new(columns: Vec<Column>, draws: bool) -> Self {
        let traces = match draws {
            true => vec![Vec::new(); columns.len()],
            false => Vec::new(),
        };
        View {
            columns,
            shown: None,
            traces,
        }
    }

    /// The heading of the table.
    pub fn heading(&self) -> String {
        let mut line = format!("{:>10}", "time");
        for column in &self.columns {
            let _ = write!(line, " {:>width$}", column.name, width = width(column));
        }
        line
    }

    /// Takes the values after the scan at `now_ms`; returns a row of the table if any changed since the last row.
    pub fn scan(&mut self, now_ms: u64, values: &[String]) -> Option<String> {
        for (trace, (column, value)) in self.traces.iter_mut().zip(self.columns.iter().zip(values))
        {
            let on = value != "0";
            if column.kind == Kind::Bit && trace.last().map(|&(_, last)| last) != Some(on) {
                trace.push((now_ms, on));
            }
        }
        let same = |shown: &Vec<String>| {
            let mut columns = self.columns.iter().zip(shown.iter().zip(values));
            columns.all(|(column, (old, new))| column.kind == Kind::Running || old == new)
        };
        if self.shown.as_ref().is_some_and(same) {
            return None;
        }
        let mut line = format!("{:>8} s", format!("{:.3}", now_ms as f64 / 1000.0));
        for (column, value) in self.columns.iter().zip(values) {
            let text = match (column.kind, value.as_str()) {
                (Kind::Bit, "0") => "·",
                (Kind::Bit, _) => "█",
                (Kind::Number | Kind::Running, value) => value,
            };
            let _ = write!(line, " {text:>width$}", width = width(column));
        }
        self.shown = Some(values.to_vec());
        Some(line)
    }

    /// The timing diagram of the bit columns over `total_ms`; empty if there are none.
    pub fn diagram(&self, total_ms: u64) -> String {
        let bits: Vec<_> = self
            .columns
            .iter()
            .zip(&self.traces)
            .filter(|(c, _)| c.kind == Kind::Bit)
            .collect();
        let name_width = bits
            .iter()
            .map(|(c, _)| c.name.chars().count())
            .max()
            .unwrap_or(0);
        let mut text = String::new();
        for (column, trace) in &bits {
            let _ = writeln!(
                text,
                "  {:>name_width$}  {}",
                column.name,
                line(trace, total_ms.max(1))
            );
        }
        if !bits.is_empty() {
            let right = format!("{:.3} s", total_ms as f64 / 1000.0);
            let _ = writeln!(
                text,
                "  {:>name_width$}  0{right:>width$}",
                "",
                width = DIAGRAM_WIDTH - 1
            );
        }
        text
    }
}

fn width(column: &Column) -> usize {
    column
        .name
        .chars()
        .count()
        .max(if column.kind == Kind::Bit { 1 } else { 6 })
}

/// One line of the diagram: high, low, or `┃` where a slice of time holds more than one change.
fn line(trace: &[(u64, bool)], total_ms: u64) -> String {
    let slice_of = |ms: u64| (ms as u128 * DIAGRAM_WIDTH as u128 / total_ms as u128) as usize;
    let mut state = trace.first().is_some_and(|&(_, on)| on);
    let mut changes = trace.iter().skip(1).peekable();
    (0..DIAGRAM_WIDTH)
        .map(|slice| {
            let mut count = 0;
            while let Some(&&(_, on)) = changes.peek().filter(|&&&(ms, _)| slice_of(ms) <= slice) {
                state = on;
                count += 1;
                changes.next();
            }
            match (count, state) {
                (2.., _) => '┃',
                (_, true) => '▔',
                (_, false) => '▁',
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_on_change_and_a_diagram() {
        let column = |name: &str, kind| Column {
            name: name.to_string(),
            kind,
        };
        let columns = vec![column("Y000", Kind::Bit), column("D0", Kind::Number)];
        let mut view = View::new(columns, true);
        let row =
            |view: &mut View, ms, y: &str, d: &str| view.scan(ms, &[y.to_string(), d.to_string()]);
        assert_eq!(view.heading(), "      time Y000     D0");
        assert_eq!(
            row(&mut view, 0, "0", "0").as_deref(),
            Some("   0.000 s    ·      0")
        );
        assert_eq!(row(&mut view, 10, "0", "0"), None);
        assert_eq!(
            row(&mut view, 500, "1", "-7").as_deref(),
            Some("   0.500 s    █     -7")
        );
        let diagram = view.diagram(1000);
        let first = diagram.lines().next().unwrap();
        assert_eq!(first.matches('▁').count(), 32);
        assert_eq!(first.matches('▔').count(), 32);
        assert!(diagram.ends_with("1.000 s\n"));
    }
}
