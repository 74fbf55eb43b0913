//! What is not modelled exactly: free values, each with a note that the verdict quotes.

use super::{Encoder, Input, Writer, device_of};
use crate::bits::Bits;
use crate::system::System;
use rungc_syntax::DeviceClass;
use std::collections::BTreeSet;

/// Something that is not modelled exactly, so that any value is assumed to be possible.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Gap {
    /// Step of the instruction that causes it, or else of the network in which it is, if it is in one.
    pub step: Option<u32>,
    /// True if that is the step of the instruction.
    pub is_instruction: bool,
    /// Description, as the end of "not modelled: …".
    pub what: String,
}

impl Gap {
    /// What no network causes.
    fn apart(what: &str) -> Self {
        Gap {
            step: None,
            is_instruction: false,
            what: what.to_string(),
        }
    }
}

/// Name of devices in which pulse outputs show what they do, which are any value in each scan.
const SHOWN: &str = "special devices of pulse outputs";

/// Devices that are named where many change between two scans.
const NAMED: usize = 4;

/// Everything that a question leaves open, of all that its logic does.
pub(crate) fn gaps_of(system: &System, encoder: &Encoder) -> BTreeSet<Gap> {
    let (mut gaps, mut by_events, mut received) =
        (BTreeSet::new(), BTreeSet::new(), BTreeSet::new());
    for (_, input) in &system.inputs {
        match *input {
            Input::Gap(number) => gaps.extend(encoder.gaps.get(number).cloned()),
            Input::Shown(Writer::Pulses, ..) => {
                gaps.insert(Gap::apart(SHOWN));
            }
            Input::Shown(Writer::Events, key, _) => {
                by_events.insert(device_of(key));
            }
            Input::Device(key, _) if encoder.is_received(key) => {
                received.insert(device_of(key));
            }
            Input::Device(..) | Input::Time(..) | Input::ScanTime(_) | Input::Restart => {}
        }
    }
    let between = "what interrupt routines, edges of inputs and time do between two scans";
    for (what, devices) in [
        (between, by_events),
        ("what serial ports receive", received),
    ] {
        if !devices.is_empty() {
            let names = names_of(devices.into_iter().flatten());
            gaps.insert(Gap::apart(&format!("{what}{names}")));
        }
    }
    gaps
}

/// Some devices in brackets; nothing if there are none.
fn names_of(devices: impl Iterator<Item = (DeviceClass, u32)>) -> String {
    let mut names: Vec<String> = devices
        .map(|(class, number)| class.number(number).to_string())
        .collect();
    let more = names.len().saturating_sub(NAMED);
    names.truncate(NAMED);
    match (names.is_empty(), more) {
        (true, _) => String::new(),
        (false, 0) => format!(" ({})", names.join(", ")),
        (false, more) => format!(" ({} and {more} more)", names.join(", ")),
    }
}

impl Encoder<'_> {
    /// A free value, because of something that is not modelled.
    pub(crate) fn fresh(&mut self, width: usize, what: &str) -> Bits {
        let gap = self.gap(what);
        self.fresh_of(width, gap)
    }

    pub(super) fn gap(&mut self, what: &str) -> usize {
        if self.instruction.is_some() {
            return self.gap_of(Gap {
                step: self.instruction,
                is_instruction: true,
                what: what.to_string(),
            });
        }
        let network = self
            .network
            .and_then(|n| self.module.networks.get(n as usize));
        self.gap_of(Gap {
            step: network.map(|network| network.step),
            is_instruction: false,
            what: what.to_string(),
        })
    }

    /// The number of what no network causes.
    pub(super) fn gap_apart(&mut self, what: &str) -> usize {
        self.gap_of(Gap::apart(what))
    }

    fn gap_of(&mut self, gap: Gap) -> usize {
        let next = self.gaps.len();
        let number = *self.gap_numbers.entry(gap.clone()).or_insert(next);
        if number == next {
            self.gaps.push(gap);
        }
        number
    }

    /// A free value, because an index can lead to very many devices.
    pub(super) fn fresh_by_index(&mut self, width: usize) -> Bits {
        const WHAT: &str = "an index that can lead to very many devices";
        let networks = self
            .network
            .map_or(&[][..], |n| &self.module.networks[n as usize..]);
        let steps = match networks {
            [this, next, ..] => this.step..next.step,
            [this] => this.step..u32::MAX,
            [] => 0..0,
        };
        let origins = self.module.origins.iter();
        let indexed: Vec<_> = origins
            .filter(|origin| steps.contains(&origin.step) && !origin.indexed.is_empty())
            .collect();
        let gap = match indexed[..] {
            [] => self.gap(WHAT),
            [only] => self.gap_of(Gap {
                step: Some(only.step),
                is_instruction: true,
                what: format!("{} ({WHAT})", only.text),
            }),
            [..] => {
                let texts: Vec<&str> = indexed.iter().map(|origin| origin.text.as_str()).collect();
                self.gap(&format!("{} ({WHAT})", texts.join(", ")))
            }
        };
        self.fresh_of(width, gap)
    }

    pub(super) fn fresh_of(&mut self, width: usize, gap: usize) -> Bits {
        let bits = self.aig.inputs_of(width);
        let named = bits.iter().map(|&bit| (bit, Input::Gap(gap)));
        self.inputs.extend(named);
        bits
    }
}
