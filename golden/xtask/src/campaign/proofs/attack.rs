//! Attacks: searches for a run in which something happens, on the interpreter alone.

use super::run::{Goal, Rig};
use rungc_ir::Module;
use rungc_sim::property::Condition;
use rungc_syntax::DeviceClass;
use rungc_verify::model::{CounterPart, Key, TimerPart};
use rungc_verify::steered::{Outside, Run, Steered};
use std::time::{Duration, Instant};

/// Result of a search.
#[derive(Clone, Debug, Default)]
pub struct Found {
    /// The run, if there is one.
    pub run: Option<Run>,
    /// Number of scans executed.
    pub scans: u64,
}

/// Time limit of a search, for programs whose scans repeat very many instructions.
const LIMIT: Duration = Duration::from_secs(4);

/// Devices of each area whose values say how far a run has come.
const WATCHED: u32 = 48;

/// Searches a run of these programs in which it happens, over this many scans.
pub fn search(
    modules: &[&Module],
    goal: Goal,
    assumed: &[Condition],
    outside: &Outside,
    (seed, scans): (u64, u64),
) -> Found {
    let rig = Rig::new(modules, goal, assumed);
    // Stretches are short beside the few scans of a search.
    let chosen = (seed, (scans / 16).max(1));
    let mut steered = Steered::new(rig, outside.clone(), watched(modules), chosen);
    let end = Instant::now() + LIMIT;
    let run = steered.search(&|done| done >= scans || Instant::now() >= end);
    Found {
        run,
        scans: steered.scans(),
    }
}

/// The memory that says how far a run has come: some of each area that programs store.
fn watched(modules: &[&Module]) -> Vec<Key> {
    let mut keys = Vec::new();
    for area in modules.iter().flat_map(|module| &module.layout.areas) {
        for number in area.first..area.first + area.count.min(WATCHED) {
            use DeviceClass::{C, M, S, T, X, Y};
            match area.class {
                X => {}
                Y | M | S => keys.push(Key::Bit(area.class, number)),
                T => {
                    keys.extend([TimerPart::Done, TimerPart::Value].map(|p| Key::Timer(number, p)))
                }
                C => keys.extend(
                    [CounterPart::Done, CounterPart::Value].map(|p| Key::Counter(number, p)),
                ),
                _ => keys.push(Key::Word(area.class, number)),
            }
        }
    }
    keys.sort();
    keys.dedup();
    keys
}
