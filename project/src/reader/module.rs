//! `[[module]]`.

use super::{Reader, Value, hint, span};
use crate::Project;
use crate::module::{LOCAL, REMOTE, Row};
use rungc_rt::modules::{self, BOARD, KINDS, Kind, Place};
use rungc_syntax::Span;
use toml::de::DeTable;

/// The table of which each entry is a module.
pub(super) const MODULE: &str = "module";

/// The key that says after how many milliseconds a remote module answers.
const DELAY: &str = "answers-after";

/// The longest time that can be given there, in milliseconds.
const LONGEST_MS: u32 = 60_000;

/// Maximum number of modules of a PLC.
const MOST: usize = 8;

impl Reader {
    pub(super) fn modules(&mut self, at: Span, value: &Value<'_>, project: &mut Project) {
        for (at, table) in self.rows(MODULE, at, value) {
            let Some(row) = self.module(at, table, &project.modules) else {
                continue;
            };
            if project.modules.iter().any(|other| other.unit == row.unit) {
                let name = modules::name(row.unit).map_or(row.unit.to_string(), str::to_owned);
                self.wrong(row.span, format!("module {name} is listed twice"), "");
            } else if row.unit < BOARD && project.numbered_modules() == MOST {
                self.wrong(at, format!("a PLC has at most {MOST} modules"), "");
            } else {
                project.modules.push(row);
            }
        }
    }

    /// The number of a module, which may be named; without either, boards and adapters follow each other.
    fn unit(
        &mut self,
        table: &DeTable<'_>,
        at: Span,
        kind: Option<&Kind>,
        others: &[Row],
    ) -> Option<u16> {
        let text = table.get("at").and_then(|value| value.get_ref().as_str());
        if let Some(unit) = text.and_then(modules::named) {
            return Some(unit);
        }
        let own = kind.map_or(&[][..], |kind| kind.place.named());
        if let ([.., last], None) = (own, table.get("at")) {
            let is_free = |unit: &&u16| others.iter().all(|row| row.unit != **unit);
            return Some(*own.iter().find(is_free).unwrap_or(last));
        }
        let unit = self.number(table, at, "at", 0..=(*REMOTE.end()).into(), None);
        unit.and_then(|unit| u16::try_from(unit).ok())
    }

    /// `pins = { CH1 = "AI0" }`.
    fn pins(&mut self, table: &DeTable<'_>, kind: &Kind) -> Vec<(u8, String)> {
        let Some(value) = table.get("pins") else {
            return Vec::new();
        };
        let Some(pins) = value.get_ref().as_table() else {
            let help = "write `pins = { CH1 = \"AI0\" }`, with pins of the board's description";
            self.wrong(span(value.span()), "`pins` must be a table", help);
            return Vec::new();
        };
        let mut found = Vec::new();
        for (name, pin) in pins {
            let number = name.get_ref().to_uppercase();
            let number = number.strip_prefix("CH").and_then(|n| n.parse().ok());
            let number = number.and_then(|number: u8| number.checked_sub(1));
            let number = number.filter(|&number| number < kind.inputs + kind.outputs);
            match (number, self.text(name.get_ref(), pin)) {
                (Some(number), Some(pin)) => found.push((number, pin.text)),
                (None, _) => {
                    let message = format!("{} has no channel `{}`", kind.name, name.get_ref());
                    self.wrong(span(name.span()), message, "");
                }
                (Some(_), None) => {}
            }
        }
        found
    }

    fn module(&mut self, at: Span, table: &DeTable<'_>, others: &[Row]) -> Option<Row> {
        self.known(MODULE, table, &["at", "kind", DELAY, "pins"]);
        let named = table.get("kind").and_then(|value| value.get_ref().as_str());
        let unit = self.unit(table, at, named.and_then(Kind::find), others);
        let Some(named) = self.get(table, "kind") else {
            if !table.contains_key("kind") {
                self.wrong(
                    at,
                    "a module has `kind`",
                    "add for example `kind = \"FX2N-4AD\"`",
                );
            }
            return None;
        };
        let Some(kind) = Kind::find(&named.text) else {
            let names: Vec<_> = KINDS.iter().map(|kind| kind.name).collect();
            let message = format!("unknown module `{}`", named.text);
            self.wrong(
                named.span,
                message,
                &hint(&named.text.to_uppercase(), &names),
            );
            return None;
        };
        let at = table.get("at").map_or(at, |value| span(value.span()));
        let unit = unit?;
        if let Some((message, help)) = misplaced(unit, kind) {
            self.wrong(at, message, help);
            return None;
        }
        if unit < BOARD && !LOCAL.contains(&unit) && !REMOTE.contains(&unit) {
            let help = "the number is 0 to 7 beside the main unit, or 100 and the station on the CAN bus of H1U and H2U";
            self.wrong(at, format!("no module has the number {unit}"), help);
            return None;
        }
        let delay_ms = self.number(table, at, DELAY, 0..=LONGEST_MS, Some(0))?;
        if let Some(value) = table.get(DELAY)
            && !REMOTE.contains(&unit)
        {
            let message = format!("module {unit} is not remote: FROM and TO do not wait for it");
            self.wrong(span(value.span()), message, "");
        }
        let pins = self.pins(table, kind);
        Some(Row {
            unit,
            kind,
            delay_ms: delay_ms as u16,
            pins,
            span: at,
        })
    }
}

/// Error in the number of a kind of module, and the remedy.
fn misplaced(unit: u16, kind: &Kind) -> Option<(String, &'static str)> {
    let name = kind.name;
    match (kind.place, unit) {
        (place, _) if place.named().contains(&unit) => None,
        (Place::Slot | Place::Board1n, _) => Some((
            format!("{name} is a board in the main unit"),
            "write `at = \"board\"`",
        )),
        (Place::Board3g, _) => Some((
            format!("{name} is a board in the main unit"),
            "write `at = \"board\"` or `at = \"board2\"`",
        )),
        (Place::Adapter, _) => Some((
            format!("{name} is an adapter on the left of the main unit"),
            "leave `at` out, or write `at = \"adapter1\"` for the first one",
        )),
        (_, BOARD..) => Some((
            format!("{name} is not a board in the main unit"),
            "the number of a module beside the main unit is 0 to 7",
        )),
        (Place::Remote, _) if !REMOTE.contains(&unit) => Some((
            format!("{name} is a remote module"),
            "its number is 100 and its station on the CAN bus",
        )),
        (Place::Hm, 6..) => Some((
            "HM has at most six modules".to_owned(),
            "their numbers are 0 to 5",
        )),
        _ => None,
    }
}
