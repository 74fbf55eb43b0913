//! Machines are built of equal stations, and their programs repeat the same rungs with other devices. This pass finds
//! such rungs, where each device is as far from the one before as in the iteration before, and makes a loop of them
//! ([`Stmt::Repeat`]) that C and Rust compilers vectorise. The iterations run in the program's order, so nothing has to
//! be proved but that they are alike.

mod maker;
mod pair;
mod runs;
mod shape;

use super::grids::{self, Arrays, meets_other_grid, spread};
use crate::node::{Body, Module, Repeat, Stmt, Ty};
use maker::Maker;
use pair::{Kind, Named};
use rungc_syntax::DeviceClass;
use runs::{Networks, Runs};
use shape::shape;

/// Makes loops of repeated rungs.
pub(super) fn run(module: &mut Module) {
    let named = module.layout.clone();
    for n in 0..module.functions.len() {
        let body = std::mem::take(&mut module.functions[n].body);
        module.functions[n].body = roll(module, body);
    }
    grids::trim(module, &named);
}

fn roll(module: &mut Module, body: Body) -> Body {
    let shapes = body
        .iter()
        .map(|stmt| shape(module, stmt))
        .collect::<Vec<_>>();
    let networks = Networks::of(&body, &shapes);
    let mut runs = Runs::of(module, &body, shapes);
    let mut out = Body::with_capacity(body.len());
    let mut at = 0;
    while at < body.len() {
        let found = runs
            .best(module, networks.from(at))
            .filter(|group| group.fits(module, &runs.arrays))
            .filter(|group| group.store(module));
        match found {
            Some(group) => {
                out.push(group.repeat(module, &body));
                at += group.length * group.iterations;
            }
            None => {
                out.push(body[at].clone());
                at += 1;
            }
        }
    }
    out
}

/// Rungs that are repeated.
struct Group {
    /// First statement.
    first: usize,
    /// Statements of an iteration.
    length: usize,
    iterations: usize,
    /// Devices and edges that the first iteration names, in order.
    named: Vec<Named>,
}

impl Group {
    /// Returns true if nothing is known that prevents [`Group::store`] from making its arrays, which takes longer to
    /// find out.
    fn fits(&self, module: &Module, arrays: &Arrays) -> bool {
        let reached = self.iterations as u32 - 1;
        let mut devices: Vec<_> = self
            .moving()
            .map(|(class, first, stride)| (class, first, first + reached * stride, stride))
            .collect();
        devices.sort();
        // Per distance of what goes before in the same class: where that ends.
        let mut ends: Vec<(DeviceClass, u32, u32)> = Vec::new();
        devices.into_iter().all(|(class, first, last, stride)| {
            ends.retain(|end| end.0 == class);
            let apart = ends
                .iter()
                .all(|&(_, other, end)| other == stride || end + 1 < first);
            match ends.iter_mut().find(|end| end.1 == stride) {
                Some(end) => end.2 = end.2.max(last),
                None => ends.push((class, stride, last)),
            }
            apart
                && !arrays.meet(class, first, last)
                && !meets_other_grid(&module.layout, (class, first, last), stride)
        })
    }

    /// The devices that are others in each iteration, and how far apart.
    fn moving(&self) -> impl Iterator<Item = (DeviceClass, u32, u32)> {
        self.named.iter().filter_map(|named| match named.kind {
            Kind::Device(class) => {
                (named.stride > 0).then_some((class, named.number, named.stride))
            }
            Kind::Edge => None,
        })
    }

    /// Makes the areas that the iterations go through; false if the devices are needed otherwise.
    fn store(&self, module: &mut Module) -> bool {
        let mut layout = module.layout.clone();
        let reached = self.iterations as u32 - 1;
        let stored = self.moving().all(|(class, number, stride)| {
            let devices = (class, number, number + reached * stride);
            spread(&mut layout, module, devices, stride)
        });
        if stored {
            module.layout = layout;
        }
        stored
    }

    /// The loop.
    fn repeat(&self, module: &mut Module, body: &Body) -> Stmt {
        let iteration = module.temps.push_and_get_key(Ty::I32);
        let mut maker = Maker {
            module,
            iteration,
            strides: self.named.iter().map(|named| named.stride),
        };
        let statements = &body[self.first..self.first + self.length];
        let inner = maker.body(statements);
        let all = &body[self.first..self.first + self.iterations * self.length];
        let mut steps = all.iter().filter_map(|stmt| {
            let Stmt::Network(network) = stmt else {
                return None;
            };
            Some(maker.module.networks.get(*network as usize)?.step)
        });
        let first = steps.next().unwrap_or_default();
        let last = steps.next_back().unwrap_or(first);
        Stmt::Repeat(Repeat {
            count: self.iterations as u32,
            iteration,
            body: inner,
            steps: (first, last),
        })
    }
}
