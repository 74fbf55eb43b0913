//! Errors as the PLC would show them while a program runs: the operation errors, and the reason why it stopped.

use crate::commands::eprint_line;
use rungc_interp::OperationError;
use rungc_ir::Module;
use rungc_models::plc_errors;
use rungc_rt::{Class, LastError};
use rungc_syntax::{Device, DeviceClass, Index};

/// Reports errors with the instructions that caused them.
pub struct Errors<'a> {
    module: &'a Module,
    /// True if errors are reported as they occur.
    at_once: bool,
    /// Number of errors reported.
    reported: usize,
}

impl<'a> Errors<'a> {
    /// Those of a program.
    pub fn new(module: &'a Module, at_once: bool) -> Self {
        Errors {
            module,
            at_once,
            reported: 0,
        }
    }

    /// Reports new ones, if requested; what they are.
    pub fn notice(&mut self, errors: &[OperationError]) -> Vec<String> {
        let new = errors.iter().skip(self.reported);
        let new: Vec<_> = new.map(|error| self.describe(error)).collect();
        if self.at_once {
            new.iter()
                .for_each(|text| eprint_line(&format!("rungc: {text}")));
        }
        self.reported = errors.len();
        new
    }

    /// Reports all of them at the end of the run.
    pub fn summarise(&self, errors: &[OperationError]) {
        for error in errors {
            let times = match error.times {
                1 => "once".to_string(),
                times => format!("{times} times"),
            };
            eprint_line(&format!("rungc: {}, {times}", self.describe(error)));
        }
        if let Some(error) = errors.first() {
            let (code, relay) = (error.code, self.module.model.error_relay.number());
            eprint_line(&format!(
                "rungc: a PLC reports these errors in M{relay} and D{relay}; for more, run `rungc explain {code}`"
            ));
        }
    }

    /// Message for a program stopped by the watchdog, at a loop or a jump.
    pub fn watchdog(&self, now_ms: u64, error: LastError) -> String {
        let step = u32::from(error.stop_step);
        let code = plc_errors::WATCHDOG;
        let title = plc_errors::title(code, self.module.model.id);
        format!(
            "at {now_ms} ms, step {step}: {}: error {code}, {title}",
            self.text(step)
        )
    }

    fn describe(&self, error: &OperationError) -> String {
        let title = plc_errors::title(error.code, self.module.model.id);
        let what = match self.missing(error) {
            Some(device) => format!("{device} does not exist"),
            None => title.to_string(),
        };
        let OperationError {
            first_ms,
            step,
            code,
            ..
        } = *error;
        format!(
            "at {first_ms} ms, step {step}: {}: error {code}, {what}",
            self.text(step)
        )
    }

    /// The instruction at a step, as it is written.
    fn text(&self, step: u32) -> &str {
        self.module.origin(step).map_or("", |origin| &origin.text)
    }

    /// A device of the instruction that an index led to and that the model does not have.
    fn missing(&self, error: &OperationError) -> Option<String> {
        let indexed = &self.module.origin(error.step)?.indexed;
        let mut missing = indexed
            .iter()
            .filter_map(|&(device, index)| self.led_to(device, index, error));
        missing.next()
    }

    fn led_to(&self, device: Device, index: Index, error: &OperationError) -> Option<String> {
        let class = match index.class {
            DeviceClass::V => Class::V,
            _ => Class::Z,
        };
        let offset = error.index(class, index.number)?;
        let number = i64::from(device.number) + i64::from(offset);
        let exists = self.module.model.in_range(device.class, number, 1);
        let name = match u32::try_from(number) {
            Ok(number) => device.class.number(number).to_string(),
            Err(_) => format!("{device} with an index of {offset}"),
        };
        (!exists).then_some(name)
    }
}
