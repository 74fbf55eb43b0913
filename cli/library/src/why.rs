//! Reasons for a device to be on or off.

use crate::language::{Language, phrase};
use crate::settings::is_written_outside;
use crate::{Error, Names, Plc, Program};
use rungc_ir::Module;
use rungc_lower::marks::Marks;
use rungc_project::Project as Settings;
use rungc_syntax::Device;
use rungc_why::{Explainer, How, HowOptions, Why};

/// The device of a name, if the model has it and the program names it.
///
/// # Errors
/// A name that no device has, a device that the model does not have, or that no instruction names.
pub fn device(
    name: &str,
    names: &Names,
    module: &Module,
    explainer: &Explainer,
) -> Result<Device, String> {
    let device = names.device(name)?;
    if !module.model.has(device.class, device.number) {
        let model = module.model.title;
        return Err(format!("`{device}` does not exist on {model}"));
    }
    if !explainer.has(device) {
        return Err(format!("no instruction names `{device}`"));
    }
    Ok(device)
}

/// An answer as text in a language.
pub fn text(why: &Why, language: Language) -> String {
    why.text_in(&|said| phrase(language, said))
}

/// A program as it was read, and as it runs.
pub(crate) struct Source<'p> {
    pub(crate) program: &'p rungc_syntax::Program,
    pub(crate) module: &'p Module,
    pub(crate) marks: &'p Marks,
    pub(crate) names: &'p Names,
    pub(crate) settings: Option<&'p Settings>,
}

impl<'p> Source<'p> {
    fn explain<T>(
        &self,
        name: &str,
        answer: impl FnOnce(&Explainer<'p>, Device) -> T,
    ) -> Result<T, Error> {
        let explainer = Explainer::new(self.program, self.module, self.marks);
        let device = device(name, self.names, self.module, &explainer);
        Ok(answer(&explainer, device.map_err(Error::Device)?))
    }
}

impl Program {
    /// Finds out what can switch a device: the instructions that write it, with their conditions.
    ///
    /// # Errors
    /// A name that no device has, a device that the model does not have, or that no instruction names.
    pub fn why(&self, name: &str) -> Result<Why, Error> {
        let answer = |explainer: &Explainer, device| explainer.of_program(device);
        self.source().explain(name, answer)
    }
}

impl Plc<'_> {
    /// Finds out why a device is on or off: what the next scan makes of it, with all else as it is now.
    ///
    /// # Errors
    /// A name that no device has, a device that the model does not have, or that no instruction names.
    pub fn why(&mut self, name: &str) -> Result<Why, Error> {
        let (source, session) = self.explained();
        source.explain(name, |explainer, device| {
            explainer.at_moment(session, None, device, None)
        })
    }

    /// Searches for what a person can do from now on so that a device changes: inputs, and devices that the program
    /// reads and something outside writes, are changed one after another.
    ///
    /// # Errors
    /// A name that no device has, a device that the model does not have, or that no instruction names.
    pub fn how(&mut self, name: &str) -> Result<How, Error> {
        let (source, session) = self.explained();
        let is_outside = |device| is_written_outside(source.settings, device);
        source.explain(name, |explainer, device| {
            let options = HowOptions {
                is_outside: &is_outside,
                ..HowOptions::default()
            };
            explainer.how(session, device, &options)
        })
    }
}
