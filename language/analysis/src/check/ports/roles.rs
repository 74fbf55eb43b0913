//! Roles of serial ports, which decide on the meaning of special devices.

use super::super::Code;
use super::areas::{Area, areas};
use super::facts::{Facts, RegisterValue, d};
use rungc_models::special::PortRole;
use rungc_rt::comm::{PortWiring, Protocol};

/// The roles in which a program puts its serial ports.
pub(in super::super) struct Roles<'a> {
    code: &'a Code<'a>,
}

impl<'a> Roles<'a> {
    pub(in super::super) fn new(code: &'a Code<'a>) -> Self {
        Roles { code }
    }

    /// Relays of the links between PLCs that the program may set up.
    pub(in super::super) fn areas(&self) -> Vec<Area> {
        areas(self.code.model(), self.code.facts())
    }

    /// Returns true or false if a port is certainly in a role, or certainly not; `None` if that depends on what
    /// happens, or on parameters of the PLC.
    pub(in super::super) fn contain(&self, role: &PortRole) -> Option<bool> {
        let Some(wiring) = self.code.model().ports.get(role.port) else {
            return Some(false);
        };
        let facts = self.code.facts();
        if role.by_parameters && !wiring.sets().any(|set| facts.touch(set)) {
            return None;
        }
        let mut protocols = chosen(facts, wiring).map(|set| facts.protocol(set));
        let is = |protocol: Option<Protocol>| Some(role.protocols.contains(protocol?));
        let first = is(protocols.next()?);
        first.filter(|_| protocols.all(|other| is(other) == first))
    }
}

/// The sets of special devices that a port may have.
pub(super) fn chosen<'f>(
    facts: &'f Facts,
    wiring: &'static PortWiring,
) -> impl Iterator<Item = &'static PortWiring> + use<'f> {
    let format = wiring.instead.and_then(|other| other.format);
    let format = format.map(|register| facts.held(d(register)));
    let is_other = match format {
        None => Some(false),
        Some(RegisterValue::Unknown) => None,
        Some(RegisterValue::Default(word) | RegisterValue::Constant(word)) => Some(word != 0),
    };
    let all = wiring.sets().enumerate();
    all.filter(move |(n, _)| is_other.is_none_or(|other| other == (*n == 1)))
        .map(|(_, set)| set)
}
