//! Grids for the devices that loops over repeated rungs go through ([`Grid`]).

use crate::layout::{Area, Grid, Layout};
use crate::node::Module;
use rungc_models::Model;
use rungc_models::runs::is_special;
use rungc_syntax::DeviceClass;

/// The last device of the run of general devices that holds this one; `None` if it is a special device.
pub(super) fn last_alike(model: &Model, class: DeviceClass, number: u32) -> Option<u32> {
    let mut runs = model.runs(class).into_iter();
    let (_, last) = runs.find(|(first, last)| (first..=last).contains(&&number))?;
    (!is_special(class, number) && !is_special(class, last)).then_some(last)
}

/// Arrays that must stay contiguous: an index or a block goes through them.
pub(super) struct Arrays(Vec<Area>);

impl Arrays {
    /// Those of a layout without grids.
    pub(super) fn of(layout: &Layout) -> Self {
        let in_grid = |area: &&Area| layout.grid(area.class, area.first).is_some();
        let arrays = layout
            .areas
            .iter()
            .filter(|area| area.array && !in_grid(area));
        Arrays(arrays.copied().collect())
    }

    /// Returns true if one of them holds one of the devices from `first` to `last`.
    pub(super) fn meet(&self, class: DeviceClass, first: u32, last: u32) -> bool {
        let ends_before = |area: &Area| (area.class, area.first + area.count) <= (class, first);
        let next = self.0.get(self.0.partition_point(ends_before));
        next.is_some_and(|area| area.class == class && area.first <= last)
    }
}

/// Returns true if a grid with another number of columns touches the devices from `first` to `last`.
pub(super) fn meets_other_grid(
    layout: &Layout,
    (class, first, last): (DeviceClass, u32, u32),
    columns: u32,
) -> bool {
    let ends_before = |grid: &Grid| (grid.class, grid.end()) < (class, first);
    let from = layout.grids.partition_point(ends_before);
    let touching = layout.grids[from..].iter();
    let mut touching = touching.take_while(|grid| grid.class == class && grid.first <= last + 1);
    touching.any(|grid| grid.columns != columns)
}

/// Stores the devices from `first` to `last` of a class in a grid of `columns` columns, joined with neighbouring grids
/// of as many; false if something needs them in another order.
pub(super) fn spread(
    layout: &mut Layout,
    module: &Module,
    (class, first, last): (DeviceClass, u32, u32),
    columns: u32,
) -> bool {
    // A gap of less than an iteration belongs to both neighbours.
    let touches = |grid: &Grid| {
        let gap = if grid.columns == columns {
            columns - 1
        } else {
            0
        };
        grid.class == class && grid.first <= last + 1 + gap && first <= grid.end() + gap
    };
    let grids = &mut layout.grids;
    let before = |grid: &&Grid| !touches(grid) && (grid.class, grid.first) < (class, first);
    let from = grids.iter().take_while(before).count();
    let to = from
        + grids[from..]
            .iter()
            .take_while(|grid| touches(grid))
            .count();
    let joined = &grids[from..to];
    if joined.iter().any(|grid| grid.columns != columns) {
        return false;
    }
    let first = joined.first().map_or(first, |grid| grid.first.min(first));
    let end = joined.last().map_or(0, Grid::end).max(last + 1);
    let areas = &mut layout.areas;
    let begin = areas.partition_point(|a| (a.class, a.first + a.count) <= (class, first));
    let after = areas.partition_point(|a| (a.class, a.first) < (class, end));
    let in_grid = |area: &Area| {
        joined
            .iter()
            .any(|g| (g.first..g.end()).contains(&area.first))
    };
    if areas[begin..after]
        .iter()
        .any(|area| area.array && !in_grid(area))
    {
        return false;
    }
    let ranges = module
        .ranges_of(class)
        .filter(|r| r.first < end && first <= r.last);
    let new: Vec<Area> = ranges
        .map(|range| {
            let (from, to) = (range.first.max(first), range.last.min(end - 1));
            Area {
                class,
                first: from,
                count: to - from + 1,
                array: true,
                latched: range.latched,
            }
        })
        .collect();
    areas.splice(begin..after, new);
    let grid = Grid {
        class,
        first,
        count: end - first,
        columns,
        stored_columns: columns,
    };
    grids.splice(from..to, [grid]);
    true
}

/// Leaves out columns without a device that the program names (`named` stores those). A grid then starts at the column
/// after the longest row of unused ones, if its devices are free.
pub(super) fn trim(module: &mut Module, named: &Layout) {
    for i in 0..module.layout.grids.len() {
        let grid = module.layout.grids[i];
        let mut used = vec![false; grid.columns as usize];
        let areas = named.areas.iter().filter(|area| area.class == grid.class);
        for area in areas {
            let end = (area.first + area.count).min(grid.end());
            for number in area.first.max(grid.first)..end {
                used[grid.position(number).0 as usize] = true;
            }
        }
        let (first, stored) = rotated(&used);
        let before = (grid.columns - first) % grid.columns;
        let begin = grid.first.saturating_sub(before);
        let free = |number| module.layout.area(grid.class, number).is_none();
        let alike = last_alike(module.model, grid.class, begin);
        let previous = module.layout.grids[..i].last();
        let previous = previous.filter(|previous| previous.class == grid.class);
        let turns = before <= grid.first
            && previous.is_none_or(|previous| previous.end() <= begin)
            && alike.is_some_and(|last| last >= grid.first)
            && (begin..grid.first).all(free);
        let (first, stored_columns) = match turns {
            true => (begin, stored),
            false => (grid.first, last_used(&used)),
        };
        let grid = Grid {
            first,
            count: grid.end() - first,
            stored_columns,
            ..grid
        };
        module.layout.grids[i] = grid;
        store_columns(module, &grid);
    }
}

/// The column after the longest row of unused ones, and how many columns there are from there to the start of that row.
fn rotated(used: &[bool]) -> (u32, u32) {
    let columns = used.len();
    let row = |first: usize| {
        let before = (1..=columns).take_while(|n| !used[(first + columns - n) % columns]);
        before.count()
    };
    let longest = (0..columns).max_by_key(|&first| (row(first), columns - first));
    let first = longest.unwrap_or(0);
    (first as u32, (columns - row(first)).max(1) as u32)
}

/// The number of columns up to the last one used.
fn last_used(used: &[bool]) -> u32 {
    let last = used.iter().rposition(|&used| used);
    last.map_or(1, |last| last as u32 + 1)
}

/// Replaces the areas of a grid by those of its stored columns.
fn store_columns(module: &mut Module, grid: &Grid) {
    let ranges = module.ranges_of(grid.class).copied();
    let ranges: Vec<_> = ranges
        .filter(|r| r.first < grid.end() && grid.first <= r.last)
        .collect();
    let mut stored: Vec<Area> = Vec::new();
    for range in ranges {
        let numbers = range.first.max(grid.first)..=range.last.min(grid.end() - 1);
        for number in numbers.filter(|&number| grid.stores(number)) {
            match stored.last_mut() {
                Some(last) if last.first + last.count == number && last.first >= range.first => {
                    last.count += 1;
                }
                _ => stored.push(Area {
                    class: grid.class,
                    first: number,
                    count: 1,
                    array: true,
                    latched: range.latched,
                }),
            }
        }
    }
    let areas = &mut module.layout.areas;
    let begin = areas.partition_point(|a| (a.class, a.first) < (grid.class, grid.first));
    let after = areas.partition_point(|a| (a.class, a.first) < (grid.class, grid.end()));
    areas.splice(begin..after, stored);
}

#[cfg(test)]
mod tests {
    use super::{last_used, rotated};

    #[test]
    fn grids_start_after_the_longest_row_of_unused_columns() {
        let columns = |text: &str| text.chars().map(|c| c == '1').collect::<Vec<_>>();
        for (used, expected) in [
            ("11111", (0, 5)),
            ("11000", (0, 2)),
            ("11001", (4, 3)),
            ("10001011", (4, 5)),
            ("1", (0, 1)),
        ] {
            assert_eq!(rotated(&columns(used)), expected, "{used}");
        }
        assert_eq!(last_used(&columns("10100")), 3);
    }
}
