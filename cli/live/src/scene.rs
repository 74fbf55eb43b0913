//! The ladder of a running program: its pictures, and where power flows in them.
//!
//! What is shown is how devices are after a scan, as programming software monitors a PLC: a contact conducts by the
//! value that its device has then, and power flows from the left rail through what conducts. The rail of networks after
//! a master control or in a state has power while that is on. Contacts of edges compare with the scan before.

use crate::probe::{Probe, Watched, holds};
use rungc_analysis::resolve::Resolved;
use rungc_catalogue::Basic;
use rungc_ir::ResetStates;
use rungc_ladder::circuit::Circuit;
use rungc_ladder::drawing::Power;
use rungc_ladder::svg::Painter;
use rungc_ladder::{Ladder, Network};
use rungc_sim::Target;
use rungc_sim::record::{Reading, Seen};
use rungc_syntax::{Device, DeviceClass, OperandKind};
use std::sync::Arc;

/// Characters of a line.
const WIDTH: usize = 104;

/// The ladder of a running program.
pub struct Scene {
    networks: Vec<Shown>,
    /// The networks with edges, whose links are looked at after each scan.
    edged: Vec<usize>,
    /// Memory of the power of each net and of what each link does.
    power: Power,
    /// The reset states of the program, known from the first look on.
    resets: Option<ResetStates>,
}

/// A network of the page.
struct Shown {
    /// Devices that must be on for its rail to have power.
    gates: Vec<Target>,
    nets: usize,
    links: Vec<Link>,
    /// Its state as it was last looked at.
    state: Arc<str>,
}

/// A cell with the nets on both sides.
struct Link {
    watched: Watched,
    from: usize,
    to: Option<usize>,
    /// Of an edge: what it saw in the last scan, and in the one before.
    seen: [bool; 2],
}

impl Scene {
    /// The ladder of a program, and the picture of each network.
    pub fn new(resolved: &Resolved, ladder: &Ladder) -> (Scene, Vec<String>) {
        let numbered: Vec<_> = (1..).zip(&ladder.networks).collect();
        let painter = Painter::new(resolved, &numbered, WIDTH);
        let mut gates = Gates::default();
        let mut networks = Vec::with_capacity(numbered.len());
        let mut pictures = Vec::with_capacity(numbered.len());
        for (number, network) in numbered {
            let (picture, circuit) = painter.live(number, network);
            pictures.push(picture.to_string());
            networks.push(Shown::new(resolved, circuit, gates.targets()));
            gates.pass(resolved, network);
        }
        let with_edges = networks.iter().enumerate();
        let with_edges = with_edges.filter(|(_, shown)| shown.links.iter().any(Link::is_edge));
        let scene = Scene {
            edged: with_edges.map(|(n, _)| n).collect(),
            networks,
            power: Power::default(),
            resets: None,
        };
        (scene, pictures)
    }

    /// Number of networks.
    pub fn networks(&self) -> usize {
        self.networks.len()
    }

    /// Takes notice of how edges are after a scan.
    pub fn scanned(&mut self, seen: Seen) {
        for &network in &self.edged {
            self.networks[network].note_edges(seen, &mut self.power);
        }
    }

    /// States of the edges in the last scans, to be restored later.
    pub fn edges(&self) -> Vec<[bool; 2]> {
        let links = self.networks.iter().flat_map(|shown| &shown.links);
        let edges = links.filter(|link| link.is_edge());
        edges.map(|link| link.seen).collect()
    }

    /// Gives the edges what they had seen.
    pub fn set_edges(&mut self, seen: &[[bool; 2]]) {
        let links = self.networks.iter_mut().flat_map(|shown| &mut shown.links);
        let edges = links.filter(|link| link.is_edge());
        for (link, seen) in edges.zip(seen) {
            link.seen = *seen;
        }
    }

    /// Returns true if power reaches an output of a network, from 0.
    pub fn reaches(&mut self, network: usize, seen: Seen) -> bool {
        let Some(shown) = self.networks.get(network) else {
            return false;
        };
        shown.flow(seen, &mut self.power);
        let mut outputs = shown.links.iter().filter(|link| link.to.is_none());
        outputs.any(|link| self.power.nets[link.from])
    }

    /// The power in a network, from 0; none in one that does not exist.
    pub fn power(&mut self, network: usize, seen: Seen) -> &Power {
        match self.networks.get(network) {
            Some(shown) => shown.flow(seen, &mut self.power),
            None => self.power = Power::default(),
        }
        &self.power
    }

    /// The state of each network as JSON: for each net whether it has power, for each link whether it conducts, is on
    /// or is driven, and the values of links that show some. A network whose state has not changed has the same text.
    pub fn look(&mut self, seen: Seen) -> Vec<Arc<str>> {
        let mut text = String::new();
        let resets = self
            .resets
            .get_or_insert_with(|| ResetStates::of(seen.machine.module()));
        let look = |shown: &mut Shown| {
            shown.flow(seen, &mut self.power);
            text.clear();
            shown.write((seen, resets), &self.power, &mut text);
            if *shown.state != *text {
                shown.state = text.as_str().into();
            }
            Arc::clone(&shown.state)
        };
        self.networks.iter_mut().map(look).collect()
    }
}

impl Shown {
    fn new(resolved: &Resolved, circuit: Option<Circuit>, gates: Vec<Target>) -> Shown {
        let (nets, links) =
            circuit.map_or((1, Vec::new()), |circuit| (circuit.nets, circuit.links));
        let links = links.into_iter().map(|link| Link {
            watched: Watched::of(resolved, link.cell),
            from: link.from,
            to: link.to,
            seen: [false; 2],
        });
        Shown {
            gates,
            nets,
            links: links.collect(),
            state: "".into(),
        }
    }

    /// Computes the flow of power.
    fn flow(&self, seen: Seen, power: &mut Power) {
        use rungc_rt::Plc;
        let Power { nets, links } = power;
        nets.clear();
        nets.resize(self.nets, false);
        links.clear();
        let is_on = |&gate: &Target| Reading::of(seen, gate) == Some(Reading::Bit(true));
        nets[0] = seen.machine.sys().running && self.gates.iter().all(is_on);
        let fed = nets[0];
        for link in &self.links {
            let input = nets[link.from];
            let is_lit = match link.watched.probe {
                Probe::Contact { bit, closed } => bit.is_on(seen) != closed,
                Probe::Edge { rising, .. } => link.edge(rising),
                Probe::Compare(op, values) => holds(op, values, seen),
                Probe::Invert => fed && !input,
                Probe::Pulse { rising } => fed && link.edge(rising),
                Probe::Coil(bit) => bit.is_on(seen),
                Probe::Box => input,
                Probe::Unknown => false,
            };
            links.push(is_lit);
            if let Some(to) = link.to {
                let makes = matches!(link.watched.probe, Probe::Invert | Probe::Pulse { .. });
                nets[to] |= is_lit && (input || makes);
            }
        }
    }

    /// Takes notice of what its edges see.
    fn note_edges(&mut self, seen: Seen, power: &mut Power) {
        let is_pulse = |link: &Link| matches!(link.watched.probe, Probe::Pulse { .. });
        if self.links.iter().any(is_pulse) {
            self.flow(seen, power);
        }
        for link in &mut self.links {
            let now = match link.watched.probe {
                Probe::Edge { bit, .. } => bit.is_on(seen),
                Probe::Pulse { .. } => power.nets[link.from],
                _ => continue,
            };
            link.seen = [now, link.seen[0]];
        }
    }

    fn write(&self, (seen, resets): (Seen, &ResetStates), power: &Power, out: &mut String) {
        let digits = |bits: &[bool], out: &mut String| {
            out.extend(bits.iter().map(|&bit| if bit { '1' } else { '0' }));
        };
        out.push_str("[\"");
        digits(&power.nets, out);
        out.push_str("\",\"");
        digits(&power.links, out);
        out.push_str("\",{");
        let mut separator = "";
        for (i, link) in self.links.iter().enumerate() {
            if link.watched.has_values() {
                let values = serde_json::Value::from(link.watched.values(seen, resets));
                out.push_str(&format!("{separator}\"{i}\":{values}"));
                separator = ",";
            }
        }
        out.push_str("}]");
    }
}

impl Link {
    /// Returns true if it stores a previous state.
    fn is_edge(&self) -> bool {
        matches!(self.watched.probe, Probe::Edge { .. } | Probe::Pulse { .. })
    }

    /// Returns true if the watched device has turned on, or off, in the last scan.
    fn edge(&self, rising: bool) -> bool {
        self.seen == [rising, !rising]
    }
}

/// The master controls and states between which a network is.
#[derive(Default)]
struct Gates {
    masters: Vec<(u32, Device)>,
    states: Vec<Device>,
    /// True if the previous instruction was STL.
    after_stl: bool,
}

impl Gates {
    fn targets(&self) -> Vec<Target> {
        let masters = self.masters.iter().map(|(_, device)| *device);
        let devices = masters.chain(self.states.iter().copied());
        let targets = devices.map(|Device { class, number }| Target::Bit(class, number));
        targets.collect()
    }

    /// Moves on after a network.
    fn pass(&mut self, resolved: &Resolved, network: &Network) {
        for instr in network.instrs.clone() {
            let operands = &resolved.program.instrs[instr].operands;
            let device = |i: usize| match operands.get(i).map(|operand| &operand.kind) {
                Some(OperandKind::Device(device, None)) => Some(*device),
                _ => None,
            };
            let level = device(0).filter(|device| device.class == DeviceClass::N);
            let basic = resolved.instrs[instr].basic();
            match basic {
                Some(Basic::Mc) => {
                    if let (Some(level), Some(relay)) = (level, device(1)) {
                        self.masters.retain(|(outer, _)| *outer < level.number);
                        self.masters.push((level.number, relay));
                    }
                }
                Some(Basic::Mcr) => {
                    if let Some(level) = level {
                        self.masters.retain(|(outer, _)| *outer < level.number);
                    }
                }
                Some(Basic::Stl) => {
                    if !self.after_stl {
                        self.states.clear();
                    }
                    self.states.extend(device(0));
                }
                Some(Basic::Ret | Basic::Fend | Basic::End) => self.states.clear(),
                _ => {}
            }
            self.after_stl = basic == Some(Basic::Stl);
        }
    }
}
