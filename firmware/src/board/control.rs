//! Controls around the program on a board: the RUN/STOP switch, its lamps, the watchdog.

use super::pins::{InputFormat, Output};
use super::{BoardError, InputPin, OutputPin, Reader};
use serde::Deserialize;

/// The switch and the lamps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Control {
    /// The RUN/STOP switch; on is RUN.
    pub switch: Option<InputPin>,
    /// The lamp that is on in RUN.
    pub run: Option<OutputPin>,
    /// The lamp that is on after an operation error, and after the watchdog or a damaged program stopped the PLC.
    pub error: Option<OutputPin>,
    /// Service of the microcontroller's watchdog: an address, and the word written to it after each scan.
    pub watchdog: Option<(u32, u32)>,
}

impl Control {
    /// Returns true if a board has any lamp or a switch.
    pub fn is_there(&self) -> bool {
        self.switch.is_some() || self.run.is_some() || self.error.is_some()
    }

    /// The lamps.
    pub fn lamps(&self) -> impl Iterator<Item = &OutputPin> {
        self.run.iter().chain(&self.error)
    }
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
pub(super) struct Run {
    switch: Option<toml::Spanned<InputFormat>>,
    lamp: Option<toml::Spanned<Output>>,
    error: Option<toml::Spanned<Output>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Watchdog {
    at: u32,
    word: u32,
}

impl Reader<'_> {
    pub(super) fn control(
        &self,
        run: Run,
        watchdog: Option<Watchdog>,
    ) -> Result<Control, BoardError> {
        let lamp = |name: &str, lamp: Option<toml::Spanned<Output>>| {
            let read =
                |lamp: toml::Spanned<Output>| self.output(lamp.span().start, name, lamp.get_ref());
            lamp.map(read).transpose()
        };
        let switch = run.switch.map(|switch| {
            let place = switch.span().start;
            self.input(place, "RUN/STOP", switch.into_inner())
        });
        Ok(Control {
            switch: switch.transpose()?,
            run: lamp("RUN", run.lamp)?,
            error: lamp("ERROR", run.error)?,
            watchdog: watchdog.map(|watchdog| (watchdog.at, watchdog.word)),
        })
    }
}
