//! Data that a module retains over power-off, for hosts that save it.

use crate::Module;
use crate::layout::Area;
use rungc_models::runs::{is_border, rt_class};
use rungc_rt::retain::{OWNER_MAX, RetainedRun};
use rungc_syntax::DeviceClass;

impl Module {
    /// The latched devices that it stores, as runs of consecutive numbers.
    pub fn retained(&self) -> Vec<RetainedRun> {
        let mut runs: Vec<RetainedRun> = Vec::new();
        let areas = self.layout.areas.iter();
        let latched = areas.filter(|area| area.latched && area.class != DeviceClass::X);
        for (area, number) in latched.flat_map(|area| self.numbers(area).map(move |n| (area, n))) {
            let Some((class, first)) = rt_class(area.class).zip(u16::try_from(number).ok()) else {
                continue;
            };
            match runs.last_mut() {
                Some(run)
                    if run.class == class
                        && u32::from(run.first) + u32::from(run.count) == number
                        && !is_border(area.class, number) =>
                {
                    run.count += 1;
                }
                _ => runs.push(RetainedRun {
                    class,
                    first,
                    count: 1,
                }),
            }
        }
        runs
    }

    /// Name of the program and its model in records of latched devices: `motor (fx3u)`. A hash of the full name and
    /// model follows a name that other programs may have, too: one that is not as the user wrote it (`a-b` and `a b`
    /// become `a_b`), and one for which a record has no room, which is cut.
    pub fn retained_as(&self) -> String {
        let (name, model) = (&self.name, self.model.name);
        let whole = format!("{name} ({model})");
        if *name == self.full_name && whole.len() <= OWNER_MAX {
            return whole;
        }
        let full = format!("{} ({model})", self.full_name);
        let end = format!("~{:08x} ({model})", fnv1a(&full));
        let mut short = name.clone();
        while short.len() + end.len() > OWNER_MAX {
            short.pop();
        }
        short + &end
    }

    /// The devices of an area that are stored: in a grid, those of its columns.
    fn numbers(&self, area: &Area) -> impl Iterator<Item = u32> {
        let class = area.class;
        (area.first..area.first + area.count).filter(move |&number| {
            let mut grids = self.layout.grids.iter();
            let grid = grids.find(|g| g.class == class && (g.first..g.end()).contains(&number));
            grid.is_none_or(|grid| grid.stores(number))
        })
    }
}

/// Hash of a text that is the same on every machine: FNV-1a.
pub fn fnv1a(text: &str) -> u32 {
    text.bytes().fold(0x811C_9DC5, |hash, byte| {
        (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193)
    })
}
