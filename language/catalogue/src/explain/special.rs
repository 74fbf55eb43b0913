//! Pages and tables of special devices.

use rungc_models::special::{Access, Special, Status};
use rungc_models::{Model, ModelId};
use rungc_syntax::DeviceClass;
use std::fmt::Write;

/// Meanings of a special device on each model that has it.
pub(super) fn special_page(name: &str) -> Option<String> {
    let rows: Vec<_> = ModelId::ALL
        .into_iter()
        .filter_map(|id| Some((Model::get(id).name, special_of(name, id)?)))
        .collect();
    let &(_, (first, number)) = rows.first()?;
    let mut page = format!(
        "# {}\n\n| model | access | at power-on | meaning | |\n|---|---|--:|---|---|\n",
        first.class.number(number)
    );
    for (model, (row, number)) in rows {
        let _ = writeln!(
            page,
            "| {model} | {}",
            special_cells(row, &row.meaning(number))
        );
    }
    Some(page)
}

/// The cells of a table's row that describe a special device.
fn special_cells(row: &Special, meaning: &str) -> String {
    let access = match row.access {
        Access::Read => "read".to_owned(),
        Access::ReadWrite => "read, write".to_owned(),
        Access::ReadUnless(role) => {
            format!("read; write while COM{} is {}", role.port, role.title)
        }
    };
    let status = match row.status {
        Status::Scan => "works".to_owned(),
        Status::Instructions(names) => format!("works with {names}"),
        Status::Modules(_) | Status::Module(_) => {
            "works with modules that rungc.toml lists".to_owned()
        }
        Status::Inert(reason) => format!("not simulated: {}", reason.text),
    };
    let default = row.default;
    format!("{access} | {default} | {meaning} | {status} |")
}

/// The row of a special device by its name, and its number.
pub(super) fn special_of(name: &str, model: ModelId) -> Option<(&'static Special, u32)> {
    let class = DeviceClass::from_prefix(name.get(..1)?)?;
    let number = name.get(1..)?.parse().ok()?;
    let row = Model::get(model).special(class, number)?;
    Some((row, number))
}

/// The special relays and registers of a model, in Markdown.
pub fn special_table(model: ModelId) -> String {
    let mut text =
        "| device | access | at power-on | meaning | |\n|---|---|--:|---|---|\n".to_owned();
    let mut rows: Vec<_> = Model::get(model).specials().collect();
    rows.sort_by_key(|row| (row.class, row.first));
    for row in rows {
        let first = row.class.number(row.first);
        let device = match row.first == row.last {
            true => first.to_string(),
            false => format!("{first}–{}", row.class.number(row.last)),
        };
        let _ = writeln!(text, "| {device} | {}", special_cells(row, &row.meanings()));
    }
    text
}
