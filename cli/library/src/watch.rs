//! Devices that are worth watching in a run.

use crate::Plc;
use rungc_analysis::check::devices::{self, Holds, Use};
use rungc_ir::Module;
use rungc_sim::Target;
use rungc_sim::record::TEXT_LENGTH;
use rungc_syntax::{DeviceClass, Program};

/// Special relays and registers have numbers from here on; they are shown only when asked for.
const SPECIAL_FIRST: u32 = 8000;

/// Devices that change in a run, at most `count`: the outputs that the program drives, the inputs that `moves` names,
/// then the states, timers, counters, registers and relays that the program writes. Special devices are not among them.
pub fn usual(
    program: &Program,
    module: &Module,
    count: usize,
    moves: &dyn Fn(u32) -> bool,
) -> Vec<Target> {
    use DeviceClass::{C, D, M, R, S, T, X, Y};
    let uses = devices::uses(program, module.model);
    let of = |class| {
        let uses = uses.iter().filter(move |(device, _)| device.class == class);
        uses.map(|(device, of)| (device.number, *of))
    };
    let outputs = of(Y).filter(|(_, of)| of.written);
    let inputs = of(X).filter(|(number, of)| of.read && moves(*number));
    let bits = |class, (n, _)| Target::Bit(class, n);
    let written = |class| {
        let special = move |n: u32| matches!(class, D | M) && n >= SPECIAL_FIRST;
        of(class).filter(move |(n, of)| of.written && !special(*n))
    };
    let word = |class, (n, of): (u32, Use)| match of.holds {
        Holds::Single => Target::Word(class, n),
        Holds::Double => Target::Pair(class, n),
        Holds::Float => Target::Float(class, n),
    };
    outputs
        .map(|of| bits(Y, of))
        .chain(inputs.map(|of| bits(X, of)))
        .chain(written(S).map(|of| bits(S, of)))
        .chain(written(T).map(|(n, _)| Target::Current(T, n)))
        .chain(written(C).map(|(n, _)| Target::Current(C, n)))
        .chain(written(D).map(|of| word(D, of)))
        .chain(written(R).map(|of| word(R, of)))
        .chain(written(M).map(|of| bits(M, of)))
        .filter(|target| exists(*target, module))
        .take(count)
        .collect()
}

/// Returns true if the module stores all devices of a target.
fn exists(target: Target, module: &Module) -> bool {
    let areas = &module.layout.areas;
    let (class, first, count) = target.devices(TEXT_LENGTH);
    (first..first.saturating_add(count)).all(|n| {
        let mut areas = areas.iter().filter(|area| area.class == class);
        areas.any(|area| (area.first..area.first + area.count).contains(&n))
    })
}

impl Plc<'_> {
    /// Names of the devices that are worth watching, at most `count`: of the inputs, those that `moved` names.
    pub fn usual_watch(&mut self, count: usize, moved: &[&str]) -> Vec<String> {
        let (source, _) = self.explained();
        let moved = moved
            .iter()
            .filter_map(|name| source.names.target(name).ok());
        let moved: Vec<_> = moved.map(|target| target.devices(TEXT_LENGTH)).collect();
        let moves = |number| {
            let is_input = |&&(class, first, count): &&(DeviceClass, u32, u32)| {
                class == DeviceClass::X && (first..first.saturating_add(count)).contains(&number)
            };
            moved.iter().any(|of| is_input(&of))
        };
        let found = usual(source.program, source.module, count, &moves);
        found.iter().map(ToString::to_string).collect()
    }
}
