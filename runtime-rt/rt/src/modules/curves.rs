//! Ranges, offset and gain of channels, as programs change them.

use super::unit::{CHANNELS, word};
use super::{Curve, Module, Role};

impl Module {
    /// Gives channels new ranges, with the offset and gain of the factory.
    pub(super) fn choose_ranges(&mut self, role: Role, value: i16) {
        let changed = (self.get(role, 0) ^ value) as u16;
        self.set(role, 0, value);
        for channel in 0..CHANNELS {
            if changed >> (4 * channel) & 0xf == 0 {
                continue;
            }
            if role == Role::InputRanges {
                if let Some(input) = self.inputs.get_mut(channel) {
                    (input.curve, input.sum, input.samples) = (None, 0, 0);
                }
            } else if let Some(output) = self.outputs.get_mut(channel) {
                output.curve = None;
            }
        }
        self.show_curves();
    }

    /// The words for offset and gain of single channels show those that are in force.
    pub(super) fn show_curves(&mut self) {
        for channel in 0..CHANNELS {
            let of_input = self.inputs.get(channel).and_then(|input| input.curve);
            let usual = self.input_range(channel).map(|range| range.curve());
            if let Some(curve) = of_input.or(usual) {
                self.set(Role::InputOffsets, channel, word(curve.offset));
                self.set(Role::InputGains, channel, word(curve.gain));
            }
            let of_output = self.outputs.get(channel).and_then(|output| output.curve);
            let usual = self.output_range(channel, None).map(|range| range.curve());
            if let Some(curve) = of_output.or(usual) {
                self.set(Role::OutputCurves, 2 * channel, word(curve.offset));
                self.set(Role::OutputCurves, 2 * channel + 1, word(curve.gain));
                self.set(Role::OutputOffsets, channel, word(curve.offset));
                self.set(Role::OutputGains, channel, word(curve.gain));
            }
        }
    }

    /// Bits, offset and gain by turns, give inputs what was written before.
    pub(super) fn take_over_inputs(&mut self, bits: i16) {
        let offset = self.get(Role::InputOffset, 0).into();
        let gain = self.get(Role::InputGain, 0).into();
        for channel in 0..usize::from(self.kind.inputs) {
            let Some(range) = self.input_range(channel) else {
                continue;
            };
            let chosen = bits >> (2 * channel) & 3;
            if let Some(input) = self.inputs.get_mut(channel).filter(|_| chosen != 0) {
                let curve = input.curve.get_or_insert(range.curve());
                curve.offset = if chosen & 1 != 0 {
                    offset
                } else {
                    curve.offset
                };
                curve.gain = if chosen & 2 != 0 { gain } else { curve.gain };
            }
        }
    }

    /// Hexadecimal digits, offset and gain by turns, give two outputs what was written before.
    pub(super) fn take_over_outputs(&mut self, pair: usize, digits: i16) {
        for channel in 2 * pair..(2 * pair + 2).min(usize::from(self.kind.outputs)) {
            let Some(range) = self.output_range(channel, None) else {
                continue;
            };
            let offset = self.get(Role::OutputCurves, 2 * channel).into();
            let gain = self.get(Role::OutputCurves, 2 * channel + 1).into();
            let chosen = digits >> (8 * (channel % 2));
            if let Some(output) = self.outputs.get_mut(channel).filter(|_| chosen & 0xff != 0) {
                let curve = output.curve.get_or_insert(range.curve());
                curve.offset = if chosen & 0x01 != 0 {
                    offset
                } else {
                    curve.offset
                };
                curve.gain = if chosen & 0x10 != 0 { gain } else { curve.gain };
            }
        }
    }

    /// A bit for each channel gives it the offset and gain in its own words.
    pub(super) fn take_over_each(&mut self, offsets: Role, bits: i16) {
        for channel in (0..CHANNELS).filter(|channel| bits >> channel & 1 != 0) {
            let of = |module: &Module, gains| Curve {
                offset: module.get(offsets, channel).into(),
                gain: module.get(gains, channel).into(),
            };
            if offsets == Role::InputOffsets {
                let curve = of(self, Role::InputGains);
                if let Some(input) = self.inputs.get_mut(channel) {
                    input.curve = Some(curve);
                }
            } else {
                let curve = of(self, Role::OutputGains);
                if let Some(output) = self.outputs.get_mut(channel) {
                    output.curve = Some(curve);
                }
            }
        }
    }
}
