//! `[[module]]`: the special modules that are fitted to the PLC, for checks and simulation.

use crate::{Error, Project};
use rungc_models::Model;
use rungc_rt::modules::{self, BOARD, Kind, Place};
use rungc_syntax::{FittedModule, Program, Span, codes};

/// Numbers of modules beside the main unit.
pub(crate) const LOCAL: std::ops::RangeInclusive<u16> = 0..=7;

/// Numbers of modules on the CAN bus of H1U and H2U: 100 and their station.
pub const REMOTE: std::ops::RangeInclusive<u16> = 101..=163;

/// A module.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Row {
    /// Its number in FROM and TO.
    pub unit: u16,
    /// Trigger of the function.
    pub kind: &'static Kind,
    /// Response time of a remote module in a simulation, in milliseconds.
    pub delay_ms: u16,
    /// Channels, counted from 0, and the analog pins of a board that they are.
    pub pins: Vec<(u8, String)>,
    /// Position of the number.
    pub span: Span,
}

impl Project {
    /// Number of modules other than boards and adapters.
    pub(crate) fn numbered_modules(&self) -> usize {
        self.modules.iter().filter(|row| row.unit < BOARD).count()
    }

    /// Gives a program the modules of its PLC.
    pub(crate) fn fit_modules(&self, program: &mut Program, model: &Model) -> Result<(), Error> {
        if self.modules.is_empty() {
            return Ok(());
        }
        let places = model.module_places;
        for row in &self.modules {
            let why = if REMOTE.contains(&row.unit) && !places.contains(&Place::Remote) {
                let message = format!("{} has no remote modules", model.title);
                let why = codes::PROJECT_VALUE.at(row.span, message);
                why.help("the modules beside it have the numbers 0 to 7")
            } else if !places.contains(&row.kind.place) {
                let message = format!("{} does not fit {}", row.kind.name, model.title);
                let why = codes::PROJECT_VALUE.at(row.span, message);
                why.help(format!("it is described in {}", row.kind.source))
            } else if let Some(name) = missing_place(model, row) {
                let message = format!("{} has no place for {name}", model.title);
                codes::PROJECT_VALUE.at(row.span, message)
            } else {
                continue;
            };
            return Err(self.error(why));
        }
        let fitted = self.modules.iter().map(|row| FittedModule {
            unit: row.unit,
            kind: row.kind.name,
            delay_ms: row.delay_ms,
            pins: row.pins.clone(),
        });
        program.parameters.get_or_insert_default().modules = fitted.collect();
        Ok(())
    }
}

/// The name of a module's place, if the model does not have it.
fn missing_place(model: &Model, row: &Row) -> Option<&'static str> {
    let has_devices = row.kind.place == Place::Slot || model.module_devices(row.unit).is_some();
    modules::name(row.unit).filter(|_| !has_devices)
}
