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

    /// Name of the program and its model in records of latched devices: `motor (fx3u)`.
    pub fn retained_as(&self) -> String {
        let model = format!(" ({})", self.model.name);
        let room = OWNER_MAX.saturating_sub(model.len());
        let mut name = self.name.clone();
        while name.len() > room {
            name.pop();
        }
        name + &model
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
