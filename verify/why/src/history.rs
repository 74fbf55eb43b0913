//! Changes of devices in a run.

use crate::explain::state;
use rungc_interp::Machine;
use rungc_ir::Module;
use rungc_ir::node::{AccessKind, Expr};
use rungc_syntax::Device;
use std::collections::BTreeMap;

/// The last change of each bit device that a program reads as a contact.
#[derive(Clone, Default)]
pub struct History {
    devices: BTreeMap<Device, Seen>,
    scans: u64,
}

#[derive(Clone, Copy)]
struct Seen {
    on: bool,
    /// Time in milliseconds and number of the scan.
    changed: Option<(u64, u64)>,
}

impl History {
    /// Of a program at power-on; `device` is followed in addition to its contacts.
    pub fn new(machine: &Machine, device: Device) -> Self {
        let devices = contacts(machine.module()).chain([device]);
        let devices = devices.map(|device| {
            let seen = Seen {
                on: state(machine, device),
                changed: None,
            };
            (device, seen)
        });
        History {
            devices: devices.collect(),
            scans: 0,
        }
    }

    /// Notes the state after a scan that began at this time.
    pub fn scanned(&mut self, machine: &Machine, ms: u64) {
        self.scans += 1;
        for (device, seen) in &mut self.devices {
            let on = state(machine, *device);
            if on != seen.on {
                *seen = Seen {
                    on,
                    changed: Some((ms, self.scans)),
                };
            }
        }
    }

    /// Number of scans.
    pub fn scans(&self) -> u64 {
        self.scans
    }

    /// The last change of a device: time in milliseconds, number of the scan from 1.
    pub(crate) fn changed(&self, device: Device) -> Option<(u64, u64)> {
        self.devices.get(&device)?.changed
    }
}

/// Bit devices that a program reads as contacts.
pub(crate) fn contacts(module: &Module) -> impl Iterator<Item = Device> {
    module.exprs.iter().filter_map(|expr| match expr {
        Expr::Read(access) if access.kind == AccessKind::Bit => {
            let (class, number) = access.device()?;
            Some(Device { class, number })
        }
        _ => None,
    })
}
