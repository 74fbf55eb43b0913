//! Special modules whose channels are pins of the board.

use super::Image;
use crate::board::AnalogPin;
use rungc_ir::Module;
use rungc_ir::node::{Action, Stmt};
use rungc_ir::walk;
use rungc_rt::RtFn;
use rungc_rt::modules::Kind;

/// A module in an image.
pub(super) struct Fitted {
    /// Its number.
    pub(super) unit: u16,
    /// Kind of the module.
    pub(super) kind: &'static Kind,
    /// Its inputs, by channels counted from 0, and their pins.
    pub(super) inputs: Vec<(u8, AnalogPin)>,
    /// Its outputs.
    pub(super) outputs: Vec<(u8, AnalogPin)>,
}

/// A channel whose pin the board does not have: the module's number, the channel counted from 1, and the pin.
pub(crate) type NoPin = (u16, u8, String);

/// Returns true if a program uses hardware, buffer memory included.
fn uses_hardware(module: &Module) -> bool {
    let mut asks = false;
    for function in &module.functions {
        walk::statements(&function.body, &mut |stmt| {
            asks |= match stmt {
                Stmt::Do(Action::Call(call)) => call.function.needs().hal,
                Stmt::Do(Action::Fetch(_) | Action::Send(_)) => true,
                _ => false,
            };
        });
    }
    asks
}

/// Returns true if a program sets analog outputs of the board itself.
fn puts_out(module: &Module) -> bool {
    let mut does = false;
    for function in &module.functions {
        walk::statements(&function.body, &mut |stmt| {
            does |=
                matches!(stmt, Stmt::Do(Action::Call(call)) if call.function == RtFn::Wr3aBoard);
        });
    }
    does
}

impl Image<'_> {
    /// The board's own analog outputs by their channels (WR3A K0 of compatible boards), if the program uses any. They
    /// are the buffer memory of unit 0, the board.
    pub(super) fn own_outputs(&self) -> Vec<(u8, AnalogPin)> {
        let outputs = self.board.analog.output_channels();
        match puts_out(self.module) {
            true => outputs.map(|(channel, pin)| (channel, *pin)).collect(),
            false => Vec::new(),
        }
    }

    /// The modules whose channels are pins, if the program reaches any.
    pub(super) fn modules(&self) -> Vec<Fitted> {
        if !uses_hardware(self.module) {
            return Vec::new();
        }
        let fitted = self.modules.iter().filter(|module| !module.pins.is_empty());
        let fitted = fitted.filter_map(|module| {
            let kind = Kind::find(module.kind)?;
            let analog = &self.board.analog;
            let of = |outputs: bool| {
                let pins = if outputs {
                    &analog.outputs
                } else {
                    &analog.inputs
                };
                let channels = module.pins.iter();
                let channels = channels.filter(|(channel, _)| (*channel >= kind.inputs) == outputs);
                let found =
                    channels.filter_map(|(channel, name)| Some((*channel, *pins.get(name)?)));
                found.collect::<Vec<_>>()
            };
            Some(Fitted {
                unit: module.unit,
                kind,
                inputs: of(false),
                outputs: of(true),
            })
        });
        fitted.collect()
    }

    /// Channels whose pin the board does not have.
    pub fn missing_pins(&self) -> Vec<NoPin> {
        let analog = &self.board.analog;
        let channels = self.modules.iter().flat_map(|module| {
            let kind = Kind::find(module.kind);
            let pins = module.pins.iter();
            pins.filter(move |(channel, name)| {
                let is_output = kind.is_some_and(|kind| *channel >= kind.inputs);
                let known = if is_output {
                    &analog.outputs
                } else {
                    &analog.inputs
                };
                !known.contains_key(name)
            })
            .map(|(channel, name)| (module.unit, channel + 1, name.clone()))
        });
        channels.collect()
    }
}
