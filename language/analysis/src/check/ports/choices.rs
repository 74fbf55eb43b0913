//! Protocols that serial ports may speak at some time of a run: those whose code a compiled program needs.

use super::super::Code;
use super::facts::{Facts, Memory, d, m};
use crate::resolve::Resolved;
use rungc_rt::comm::{Choice, PortWiring, Protocols};
use rungc_syntax::Device;

/// Station numbers to try: that of a slave, and that of a master on L01S.
const STATIONS: [u16; 2] = [1, 255];

/// A port with more states than this is taken for one whose registers may have any value.
const MOST_STATES: usize = 4096;

/// Possible values of the devices that choose the protocols of ports.
pub struct Choices<'a> {
    facts: Facts,
    outside: &'a dyn Fn(Device) -> bool,
}

impl<'a> Choices<'a> {
    /// Collects what a program writes to them; `outside` says which devices others may write.
    pub fn new(resolved: &Resolved, outside: &'a dyn Fn(Device) -> bool) -> Self {
        let facts = Facts::new(&Code::new(resolved));
        Choices { facts, outside }
    }

    /// All protocols that the registers and relays of a port, and UINIT, can choose.
    pub fn protocols(&self, wiring: &PortWiring) -> Protocols {
        let Some(states) = self.states(wiring) else {
            return Protocols::ALL;
        };
        let uinits = self.uinits(wiring);
        let chosen = states.iter().flat_map(|memory| {
            let words = uinits.iter();
            words.map(|&word| wiring.protocol(memory, [word, 0, 0]))
        });
        chosen.collect()
    }

    /// All states of the devices that choose; `None` if a register may have any value, or very many.
    fn states(&self, wiring: &PortWiring) -> Option<Vec<Memory>> {
        let mut states = [false, true]
            .map(|running| self.facts.cleared(running))
            .to_vec();
        for register in [wiring.protocol, wiring.format].into_iter().flatten() {
            let values = self.facts.values(register);
            let values = values.filter(|_| !(self.outside)(d(register)))?;
            let values = Vec::from_iter(values);
            if states.len() * values.len() > MOST_STATES {
                return None;
            }
            states = each(&states, &values, |memory, value| {
                memory.set_register(register, value)
            });
        }
        if let Some(register) = wiring.station {
            states = each(&states, &STATIONS, |memory, value| {
                memory.set_register(register, value)
            });
        }
        for relay in wiring.setup_relays() {
            if self.facts.may_be_on(relay) || (self.outside)(m(relay)) {
                states = each(&states, &[false, true], |memory, on| {
                    memory.set_relay(relay, on)
                });
            }
        }
        Some(states)
    }

    /// The first words that UINIT may have for a port, and 0 of a port without UINIT.
    fn uinits(&self, wiring: &PortWiring) -> Vec<u16> {
        if wiring.choice != Choice::Uinit {
            return vec![0];
        }
        let uinits = self.facts.uinit.get(&wiring.number).into_iter().flatten();
        let words: Option<Vec<u16>> = uinits.map(|uinit| uinit.protocol).collect();
        let any = || (0..8).flat_map(|protocol| [protocol << 8, protocol << 8 | 1]);
        let words = words.unwrap_or_else(|| any().collect());
        std::iter::once(0).chain(words).collect()
    }
}

/// Each state with each of the values.
fn each<T: Copy>(states: &[Memory], values: &[T], set: impl Fn(&mut Memory, T)) -> Vec<Memory> {
    let set = &set;
    let with = states.iter().flat_map(|state| {
        values.iter().map(move |&value| {
            let mut state = state.clone();
            set(&mut state, value);
            state
        })
    });
    with.collect()
}
