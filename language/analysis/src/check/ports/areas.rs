//! Relays that links between PLCs carry from one to the other.

use super::facts::Facts;
use super::roles::chosen;
use rungc_models::Model;
use rungc_rt::comm::{Choice, PortWiring, Protocol};

/// Number of blocks of an N:N link, and of an enhanced one.
const STATIONS: u32 = 8;
const ENHANCED_STATIONS: u32 = 16;

/// Relays of a link.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in super::super) struct Area {
    pub(in super::super) first: u32,
    pub(in super::super) count: u32,
    /// True if the partners may read them.
    pub(in super::super) is_sent: bool,
    /// True if the partners may write them.
    pub(in super::super) is_received: bool,
}

/// The relays of all links that a program may set up.
pub(super) fn areas(model: &'static Model, facts: &Facts) -> Vec<Area> {
    let ports = model.ports.all().iter();
    let used = ports.filter(|wiring| wiring.sets().any(|set| facts.touch(set)));
    let sets = used.flat_map(|wiring| chosen(facts, wiring));
    sets.flat_map(|set| possible(facts, set))
        .flat_map(of)
        .collect()
}

/// The links that a port may keep up: its protocol, one that a relay chooses at times, or any where that is not known.
fn possible(facts: &Facts, wiring: &'static PortWiring) -> Vec<Protocol> {
    use Protocol::{EnhancedMaster, EnhancedSlave, NnMaster, NnSlave};
    use Protocol::{ParallelMaster, ParallelSlave};
    let mut all = match facts.protocol(wiring) {
        Some(protocol) => vec![protocol],
        None => vec![
            EnhancedMaster,
            EnhancedSlave,
            NnMaster,
            NnSlave,
            ParallelMaster,
            ParallelSlave,
        ],
    };
    if matches!(wiring.choice, Choice::Com1 | Choice::Format) {
        let relays = wiring.setup_relays().zip([ParallelMaster, ParallelSlave]);
        let may_be = relays.filter(|&(relay, _)| facts.may_be_on(relay));
        all.extend(may_be.map(|(_, protocol)| protocol));
    }
    all
}

/// The relays of a link (h1u-h2u-programming §5.3.2, §5.4, §5.5). Station 0 of an N:N link is the master; which block
/// a slave sends is not looked at.
fn of(protocol: Protocol) -> Vec<Area> {
    let sent = |first, count| Area {
        first,
        count,
        is_sent: true,
        is_received: false,
    };
    let received = |first, count| Area {
        is_sent: false,
        is_received: true,
        ..sent(first, count)
    };
    let either = |first, count| Area {
        is_received: true,
        ..sent(first, count)
    };
    let blocks = |first: u32, apart: u32, stations: u32, is_master: bool| {
        let slaves = (first + apart, (stations - 1) * apart);
        match is_master {
            true => vec![sent(first, apart), received(slaves.0, slaves.1)],
            false => vec![received(first, apart), either(slaves.0, slaves.1)],
        }
    };
    match protocol {
        Protocol::ParallelMaster => vec![sent(800, 100), received(900, 100)],
        Protocol::ParallelSlave => vec![received(800, 100), sent(900, 100)],
        Protocol::NnMaster => blocks(1000, 64, STATIONS, true),
        Protocol::NnSlave => blocks(1000, 64, STATIONS, false),
        Protocol::EnhancedMaster => blocks(500, 70, ENHANCED_STATIONS, true),
        Protocol::EnhancedSlave => blocks(500, 70, ENHANCED_STATIONS, false),
        _ => Vec::new(),
    }
}
