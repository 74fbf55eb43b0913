//! Causes of findings: what is dead on purpose, and what can never happen since something else cannot.

use super::{Place, Placed, basic, writes};
use rungc_catalogue::{Basic, Drive};
use rungc_ir::Module;
use rungc_models::runs::is_special;
use rungc_syntax::{Device, DeviceClass, Instr, Program};
use rungc_verify::deep::Kind;
use std::collections::BTreeSet;

/// M8000, which is on while the program runs.
const ALWAYS_ON: Device = Device {
    class: DeviceClass::M,
    number: 8000,
};
/// M8001, which is off while the program runs.
const ALWAYS_OFF: Device = Device {
    class: DeviceClass::M,
    number: 8001,
};

/// The device of an instruction's only operand.
fn operand(instr: &Instr) -> Option<Device> {
    instr.operands.first()?.kind.device()
}

/// Returns true if a contact is open unless its device is on, or switches on with it.
fn is_open(contact: Basic) -> bool {
    use Basic::{And, Andf, Andp, Ld, Ldf, Ldp, Or, Orf, Orp};
    matches!(contact, Ld | Ldp | Ldf | And | Andp | Andf | Or | Orp | Orf)
}

/// Returns true if a contact is closed unless its device is on.
fn is_closed(contact: Basic) -> bool {
    matches!(contact, Basic::Ldi | Basic::Ani | Basic::Ori)
}

/// Contacts of a network.
#[derive(Clone, Default)]
pub(super) struct Contacts {
    /// Its contacts with their devices, and that of the step that it belongs to.
    all: Vec<(Basic, Device)>,
    /// It depends on other conditions, too: comparisons or a master control.
    depends: bool,
}

/// The contacts of each network of a module.
pub(super) fn contacts(program: &Program, steps: &[u32], module: &Module) -> Vec<Contacts> {
    let mut found = vec![Contacts::default(); module.networks.len()];
    let mut begins = module
        .networks
        .iter()
        .map(|network| network.step)
        .peekable();
    let (mut begun, mut step, mut masters) = (0, None, 0);
    for (instr, &at) in program.instrs.iter().zip(steps) {
        while begins.next_if(|&begin| begin <= at).is_some() {
            begun += 1;
            if let Some(new) = found.get_mut(begun - 1) {
                new.all.extend(step.map(|step| (Basic::Ld, step)));
                new.depends = masters > 0;
            }
        }
        let logic = rungc_catalogue::find(&instr.mnemonic)
            .is_some_and(|found| found.inst.drive == Drive::Logic);
        match basic(instr) {
            Some(Basic::Stl) => step = operand(instr),
            Some(Basic::Ret | Basic::Fend | Basic::Label) => step = None,
            Some(Basic::Mc) => masters += 1,
            Some(Basic::Mcr) => masters = 0,
            _ => {}
        }
        let Some(here) = begun.checked_sub(1).and_then(|n| found.get_mut(n)) else {
            continue;
        };
        match (basic(instr), operand(instr)) {
            (Some(Basic::Stl), Some(device)) => here.all.push((Basic::Ld, device)),
            (Some(contact), Some(device)) if is_open(contact) || is_closed(contact) => {
                here.all.push((contact, device));
            }
            (None, _) | (Some(Basic::Mc), _) => here.depends |= logic,
            (Some(contact), None) => here.depends |= is_open(contact) || is_closed(contact),
            _ => {}
        }
    }
    found
}

impl Place<'_> {
    /// The contacts of a network, and that of the step that it belongs to.
    fn contacts(&self, network: u32) -> &[(Basic, Device)] {
        let contacts = self.contacts.get(network as usize);
        contacts.map_or(&[], |contacts| &contacts.all)
    }

    /// Leaves out what was intended: networks that M8000 or M8001 keeps open, and those that relays keep open which are
    /// on or off on purpose.
    pub(super) fn leave_out_intended(&self, found: &mut Vec<Placed>) {
        let constant = self.constant_relays();
        let mut off: BTreeSet<Device> = BTreeSet::new();
        loop {
            let is_intended = |placed: &Placed| {
                let mut contacts = self.contacts(placed.network).iter();
                contacts.any(|(contact, device)| {
                    constant.contains(device) || is_open(*contact) && off.contains(device)
                })
            };
            let more: Vec<Device> = found
                .iter()
                .filter(|placed| matches!(placed.finding.kind, Kind::NeverOn | Kind::NeverReached))
                .filter(|placed| is_intended(placed) || self.is_kept_open(placed.network))
                .filter_map(|placed| placed.device)
                .filter(|device| !off.contains(device))
                .collect();
            if more.is_empty() {
                return found.retain(|placed| {
                    placed.finding.kind == Kind::Oscillates
                        || !is_intended(placed)
                            && !self.is_meant(placed.network)
                            && !self.is_defensive(placed)
                });
            }
            off.extend(more);
        }
    }

    /// Returns true if a rung waits for what the system reports: an error, the end of an instruction. That it never
    /// happens in this program does no harm.
    fn is_defensive(&self, placed: &Placed) -> bool {
        /// Contacts that change in any program: those of the first scan, and clocks.
        const CHANGING: [u32; 6] = [8002, 8003, 8011, 8012, 8013, 8014];
        let mut contacts = self.contacts(placed.network).iter();
        placed.finding.kind == Kind::NeverActs
            && contacts.any(|(_, device)| {
                is_special(device.class, device.number) && !CHANGING.contains(&device.number)
            })
    }

    /// Returns true if a contact of M8000 or M8001 in a network never conducts.
    fn is_kept_open(&self, network: u32) -> bool {
        let mut contacts = self.contacts(network).iter();
        contacts.any(|&(contact, device)| {
            is_closed(contact) && device == ALWAYS_ON || is_open(contact) && device == ALWAYS_OFF
        })
    }

    /// Relays that are always on or off on purpose: only one coil writes them, and before it are only contacts of
    /// M8000, M8001 and such relays.
    fn constant_relays(&self) -> BTreeSet<Device> {
        let mut constant = BTreeSet::new();
        loop {
            let is_constant = |device: &Device| {
                [ALWAYS_ON, ALWAYS_OFF].contains(device) || constant.contains(device)
            };
            let instrs = self.program.instrs.iter().zip(self.steps);
            let coils = instrs.filter(|(instr, _)| basic(instr) == Some(Basic::Out));
            let more: Vec<Device> = coils
                .filter_map(|(instr, step)| Some((operand(instr)?, self.network_at(*step))))
                .filter(|(device, _)| device.class == DeviceClass::M && !constant.contains(device))
                .filter(|(_, network)| {
                    let contacts = self.contacts(*network);
                    let depends = self.contacts.get(*network as usize);
                    depends.is_some_and(|contacts| !contacts.depends)
                        && !contacts.is_empty()
                        && contacts.iter().all(|(_, device)| is_constant(device))
                })
                .map(|(device, _)| device)
                .filter(|device| self.writers(*device) == 1)
                .collect();
            if more.is_empty() {
                return constant;
            }
            constant.extend(more);
        }
    }

    /// Number of instructions that write a device by its name.
    fn writers(&self, device: Device) -> usize {
        let instrs = self.program.instrs.iter();
        let model = self.module.model;
        instrs.filter(|instr| writes(instr, device, model)).count()
    }

    /// The findings without those that follow from another, each with these. A comparison is given with the rung that
    /// it keeps open.
    pub(super) fn by_cause<'p, 'f>(
        &self,
        found: &'p [Placed<'f>],
    ) -> Vec<(&'p Placed<'f>, Vec<&'p Placed<'f>>)> {
        let mut causes: Vec<usize> = (0..found.len()).collect();
        let root = |causes: &[usize], mut i: usize| {
            while causes[i] != i {
                i = causes[i];
            }
            i
        };
        for (i, placed) in found.iter().enumerate() {
            let mut others = (0..found.len()).filter(|&other| root(&causes, other) != i);
            if let Some(cause) = others.find(|&other| self.is_cause(&found[other], placed)) {
                causes[i] = cause;
            }
        }
        let roots = (0..found.len()).filter(|&i| causes[i] == i);
        let of_root = |i: usize| {
            let all = (0..found.len()).filter(|&other| root(&causes, other) == i);
            let all: Vec<_> = all.map(|other| &found[other]).collect();
            let is_rung = |other: &&&Placed| self.is_cause(&found[i], other);
            let compares = matches!(found[i].finding.kind, Kind::Constant { .. });
            let rung = all.iter().find(is_rung).copied().filter(|_| compares);
            let first = rung.unwrap_or(&found[i]);
            let others = all.into_iter().filter(|other| !std::ptr::eq(*other, first));
            (first, others.collect())
        };
        roots.map(of_root).collect()
    }

    /// Returns true if one finding is what keeps a rung from conducting that another is about.
    fn is_cause(&self, cause: &Placed, of: &Placed) -> bool {
        let is_dead = matches!(
            of.finding.kind,
            Kind::NeverOn | Kind::NeverReached | Kind::NeverActs
        );
        let is_inverted = || {
            let mut instrs = self.instrs(of.network);
            instrs.any(|instr| basic(instr) == Some(Basic::Inv))
        };
        if !is_dead || is_inverted() {
            return false;
        }
        match cause.finding.kind {
            Kind::Constant { result: false, .. } => cause.network == of.network,
            // What the rung switches on.
            Kind::NeverActs => cause.network == of.network && of.finding.kind == Kind::NeverOn,
            Kind::NeverOn | Kind::NeverReached | Kind::NeverExpires => {
                let contacts = self.contacts(of.network);
                contacts
                    .iter()
                    .any(|(contact, device)| is_open(*contact) && Some(*device) == cause.device)
            }
            _ => false,
        }
    }
}
