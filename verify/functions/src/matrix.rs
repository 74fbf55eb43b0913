//! Cause-and-effect matrices: tables of which a row is a cause, a column an effect, and a cell what the one does to the
//! other.
//!
//! The first row has headings: `Cause`, perhaps `Condition` and `Description`, then the effects. Each further row is a
//! cause, or begins with `Effect` (conditions of the effects, whose headings are then names), `Reset` or `Time` (for
//! each effect). [`words`] lists the headings, and [`cell`] what cells may hold.

mod cell;
mod words;

use crate::expand::{Expanded, Part};
use cell::{Action, Cell, Conditions};
use rungc_frontend::{MAX_TABLE, TableRow, read_table};
use rungc_project::property::{PropertyKind, Row, Use};
use rungc_project::{Named, Project, device};
use rungc_syntax::{Diagnostic, Span, codes, inputs};
use std::io::{self, Read};
use std::path::Path;
use words::Heading;

/// An effect: a column.
struct Effect {
    /// Its column, from 0.
    column: usize,
    /// Its heading.
    name: String,
    /// Row of its condition.
    row: usize,
    /// The condition that holds while it acts.
    condition: String,
    /// Condition of the row `Reset`, with the row.
    reset: Option<(usize, String)>,
    /// Time of the row `Time`.
    time: Option<String>,
}

/// A cause: a row.
struct Cause<'t> {
    /// Its name, or its condition.
    name: String,
    /// Column of its condition, from 0.
    column: usize,
    /// The condition that holds while it is present.
    condition: String,
    row: &'t TableRow,
}

/// A matrix that is read, with its mistakes.
struct Matrix<'t> {
    /// Name of the file.
    file: String,
    /// Place of the row in rungc.toml.
    at: Span,
    effects: Vec<Effect>,
    causes: Vec<Cause<'t>>,
    wrong: Vec<Diagnostic>,
}

/// The properties of all cells of the matrix at a path.
pub(crate) fn properties(
    project: &Project,
    row: &Use,
    path: &Named,
) -> Result<Vec<Expanded>, Vec<Diagnostic>> {
    let file = project.at(Path::new(&path.text));
    let failed = |why: String| {
        let message = format!("cannot read the matrix `{}`: {why}", path.text);
        vec![codes::PROJECT_VALUE.at(path.span, message)]
    };
    let bytes = read(&file).map_err(|error| failed(error.to_string()))?;
    let rows = read_table(&bytes, project.encoding).map_err(|error| failed(error.to_string()))?;
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    let mut matrix = Matrix {
        file: name.into_owned(),
        at: path.span,
        effects: Vec::new(),
        causes: Vec::new(),
        wrong: Vec::new(),
    };
    matrix.read(&rows);
    let found = matrix.expanded(row);
    match matrix.wrong.is_empty() {
        true => Ok(found),
        false => Err(matrix.wrong),
    }
}

fn read(path: &Path) -> io::Result<Vec<u8>> {
    inputs::open(path)?;
    let mut bytes = Vec::new();
    let file = std::fs::File::open(path)?;
    file.take(MAX_TABLE + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MAX_TABLE {
        let message = format!("it is larger than {} MiB", MAX_TABLE >> 20);
        return Err(io::Error::new(io::ErrorKind::InvalidData, message));
    }
    Ok(bytes)
}

/// Letters of a column, as spreadsheets have them: A to Z, AA, …
fn letters(column: usize) -> String {
    let last = char::from(b'A' + (column % 26) as u8).to_string();
    match column / 26 {
        0 => last,
        more => letters(more - 1) + &last,
    }
}

/// A cell of a row; empty if the row has no such column.
fn at(row: &TableRow, column: usize) -> &str {
    row.cells.get(column).map_or("", String::as_str)
}

/// A condition as a cell has it: a name needs no quotes there.
fn condition(text: &str) -> String {
    let operators = ["and", "or", "not", "for", "before"];
    let is_operator = |word: &str| operators.contains(&&*word.to_ascii_lowercase());
    let is_joined = text.contains(|c: char| "&|!()=<>\"".contains(c));
    let device = text.split('.').next().unwrap_or_default().to_uppercase();
    let is_device = device::device(device.trim()).is_some();
    match is_joined || is_device || text.split_whitespace().any(is_operator) {
        true => text.to_string(),
        false => format!("\"{}\"", one_line(text)),
    }
}

/// A text of several lines in one.
fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

impl<'t> Matrix<'t> {
    fn place(&self, row: usize, column: usize) -> String {
        format!("{}, row {row}, column {}: ", self.file, letters(column))
    }

    fn mistake(&mut self, row: usize, column: usize, why: &str, help: &str) {
        let message = self.place(row, column) + why;
        let mistake = codes::PROJECT_VALUE.at(self.at, message);
        self.wrong.push(match help {
            "" => mistake,
            help => mistake.help(help.to_string()),
        });
    }

    fn read(&mut self, rows: &'t [TableRow]) {
        let Some((head, rest)) = rows.split_first() else {
            let message = format!("the matrix `{}` is empty", self.file);
            self.wrong.push(codes::PROJECT_VALUE.at(self.at, message));
            return;
        };
        let headings: Vec<_> = head.cells.iter().map(|cell| words::heading(cell)).collect();
        let place = |wanted| headings.iter().position(|heading| *heading == wanted);
        let (cause, device) = (place(Heading::Cause), place(Heading::Condition));
        let Some(first) = cause.or(device) else {
            let help = "the first row has the headings `Cause`, perhaps `Condition` and `Description`, and the effects";
            self.mistake(head.number, 0, "there is no column `Cause`", help);
            return;
        };
        for (column, heading) in headings.iter().enumerate() {
            if *heading == Heading::Other {
                let name = head.cells[column].clone();
                self.effects.push(Effect {
                    column,
                    row: head.number,
                    condition: condition(&name),
                    name,
                    reset: None,
                    time: None,
                });
            }
        }
        if self.effects.is_empty() {
            let help =
                "each further heading is an effect: `Y000`, or `!Y000` for an output that goes off";
            self.mistake(head.number, first, "there is no effect", help);
        }
        for wanted in [Heading::Cause, Heading::Condition] {
            let columns = headings.iter().enumerate();
            let mut columns = columns.filter(|(_, heading)| **heading == wanted);
            if let Some((second, _)) = columns.nth(1) {
                self.mistake(head.number, second, "this heading is there twice", "");
            }
        }
        for row in rest {
            let cells = row.cells.iter().enumerate();
            for (column, _) in cells.filter(|(_, cell)| !cell.is_empty()) {
                if headings
                    .get(column)
                    .is_none_or(|heading| *heading == Heading::Empty)
                {
                    self.mistake(row.number, column, "this column has no heading", "");
                }
            }
            self.row(row, cause, device.unwrap_or(first));
        }
    }

    fn row(&mut self, row: &'t TableRow, cause: Option<usize>, device: usize) {
        let name = cause.map_or("", |column| at(row, column));
        let text = at(row, device);
        let first = if name.is_empty() { text } else { name };
        // A cause with a condition may have any name.
        let has_condition = !text.is_empty() && cause.is_some_and(|cause| cause != device);
        let Some(about) = words::row(first).filter(|_| !has_condition) else {
            if text.is_empty() {
                let why = match name.is_empty() {
                    true => "this row has no cause",
                    false => "this cause has no condition",
                };
                self.mistake(row.number, device, why, "");
                return;
            }
            let condition = condition(text);
            self.causes.push(Cause {
                name: one_line(first),
                column: device,
                condition,
                row,
            });
            return;
        };
        for effect in &mut self.effects {
            let text = at(row, effect.column);
            if text.is_empty() {
                continue;
            }
            match about {
                words::About::Effects => {
                    effect.condition = condition(text);
                    effect.row = row.number;
                }
                words::About::Reset => effect.reset = Some((row.number, condition(text))),
                words::About::Time => effect.time = Some(text.to_string()),
                words::About::Nothing => {}
            }
        }
    }

    /// The properties of all cells.
    fn expanded(&mut self, of: &Use) -> Vec<Expanded> {
        let (effects, causes) = (
            std::mem::take(&mut self.effects),
            std::mem::take(&mut self.causes),
        );
        let mut found = Vec::new();
        for effect in &effects {
            let cells = self.column(effect, &causes);
            let resets = self.resets(effect, &causes, &cells);
            for (cause, cell) in causes.iter().zip(&cells) {
                let Some(cell) = cell else { continue };
                found.extend(self.cell(of, cause, effect, cell, &resets));
            }
        }
        if found.is_empty() && self.wrong.is_empty() {
            let message = format!("the matrix `{}` has no cell with X, N or S", self.file);
            self.wrong.push(codes::PROJECT_VALUE.at(self.at, message));
        }
        found.sort_by_key(|(number, _)| *number);
        found.into_iter().map(|(_, expanded)| expanded).collect()
    }

    /// The cells of a column, for each cause.
    fn column(&mut self, effect: &Effect, causes: &[Cause]) -> Vec<Option<Cell>> {
        let mut cells = Vec::new();
        for cause in causes {
            let text = at(cause.row, effect.column);
            let read = match Cell::parse(text) {
                Ok(Some(cell)) if cell.within.is_none() && cell.action != Action::Resets => {
                    cell.with(effect.time.as_deref()).map(Some)
                }
                other => other,
            };
            cells.push(read.unwrap_or_else(|why| {
                self.mistake(cause.row.number, effect.column, &why, cell::HELP);
                None
            }));
        }
        cells
    }

    /// Conditions that reset an effect, with their places.
    fn resets(&mut self, effect: &Effect, causes: &[Cause], cells: &[Option<Cell>]) -> Vec<Part> {
        let of_row = effect
            .reset
            .iter()
            .map(|(row, text)| (*row, effect.column, text));
        let pairs = causes.iter().zip(cells);
        let by_cause = pairs.filter_map(|(cause, cell)| {
            let resets = cell.as_ref()?.action == Action::Resets;
            resets.then_some((cause.row.number, cause.column, &cause.condition))
        });
        let resets: Vec<Part> = of_row
            .chain(by_cause)
            .map(|(row, column, text)| self.part(row, column, text))
            .collect();
        let is = |action| move |cell: &&Cell| cell.action == action;
        let stored = cells.iter().flatten().find(is(Action::Stored));
        let first = cells.iter().flatten().find(is(Action::Resets));
        if stored.is_some() && resets.is_empty() {
            let help = "add an R to the cause that resets it, or a row `Reset`";
            self.mistake(
                effect.row,
                effect.column,
                "nothing resets this effect, which has an S",
                help,
            );
        }
        if stored.is_none() && first.is_some() {
            let help = "an R ends what an S has stored";
            self.mistake(
                effect.row,
                effect.column,
                "this effect has an R, but no S",
                help,
            );
        }
        resets
    }

    fn part(&self, row: usize, column: usize, text: &str) -> Part {
        Part {
            named: self.named(text.to_string()),
            place: self.place(row, column),
        }
    }

    fn named(&self, text: String) -> Named {
        let span = self.at;
        Named { text, span }
    }

    /// The properties of a cell, each with the number of its row.
    fn cell(
        &self,
        of: &Use,
        cause: &Cause,
        effect: &Effect,
        cell: &Cell,
        resets: &[Part],
    ) -> Vec<(usize, Expanded)> {
        let mut parts = vec![
            self.part(cause.row.number, cause.column, &cause.condition),
            self.part(effect.row, effect.column, &effect.condition),
        ];
        let resets_text: Vec<_> = resets.iter().map(|part| &*part.named.text).collect();
        if cell.action == Action::Stored {
            parts.extend(resets.iter().cloned());
        }
        let demands = cell.demands(&Conditions {
            cause: &cause.condition,
            effect: &effect.condition,
            reset: resets_text.join(" | "),
        });
        let place = format!("{}{}", letters(effect.column), cause.row.number);
        let (file, cause_name, effect_name) = (&self.file, &cause.name, &effect.name);
        let own = of
            .name
            .as_ref()
            .map(|own| format!("{own}, "))
            .unwrap_or_default();
        let demands = demands.into_iter().map(|(fault, kind)| {
            let name = format!("{own}{file} {place} ({cause_name}, {effect_name}): {fault}");
            let row = Row {
                name: Some(name),
                requirement: of.requirement.clone(),
                kind: self.kind(kind),
                span: of.span,
            };
            let parts = parts.clone();
            (cause.row.number, Expanded { row, parts })
        });
        demands.collect()
    }

    fn kind(&self, demand: cell::Demand) -> PropertyKind {
        match demand {
            cell::Demand::Never(only) => PropertyKind::Never(self.named(only)),
            cell::Demand::Whenever { when, then, within } => PropertyKind::Whenever {
                when: self.named(when),
                then: self.named(then),
                within: Some(self.named(within)),
            },
            cell::Demand::Stays {
                after,
                holds,
                until,
            } => PropertyKind::Stays {
                after: Some(self.named(after)),
                holds: self.named(holds),
                until: Some(self.named(until)),
            },
        }
    }
}
