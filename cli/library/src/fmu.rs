//! Variables of a program as a functional mock-up unit: its terminals, and the devices that it names.

use crate::lists::{identifier, unique};
use rungc_analysis::check::devices::{Holds, uses};
use rungc_emit::storage::Storage;
use rungc_firmware::fmu::{Causality, SCAN_NAME, TIME_NAME, Value, Variable};
use rungc_ir::Module;
use rungc_models::runs::is_special;
use rungc_syntax::text::one_line;
use rungc_syntax::{Device, DeviceClass, DeviceRun, Program};
use std::collections::{BTreeMap, HashSet};

/// The variables of a compiled program: inputs X, outputs Y, and other devices that instructions name, without special
/// ones. An importer sets what `written` lists, and `read` lists outputs. Names are those of [`crate::lists::tags`]:
/// from the comment, else the device.
pub fn variables(
    program: &Program,
    module: &Module,
    written: &[DeviceRun],
    read: &[DeviceRun],
) -> Vec<Variable> {
    let devices = devices(program, module, written.iter().chain(read));
    let mut names = HashSet::from([TIME_NAME.to_string(), SCAN_NAME.to_string()]);
    let mut variables = Vec::new();
    for (device, holds) in devices {
        let comment = program.comments.get(&device);
        let description: String = comment.map(|c| one_line(c).into()).unwrap_or_default();
        let is_in = |runs: &[DeviceRun]| runs.iter().any(|run| holds_device(run, device));
        let causality = match device.class {
            DeviceClass::X => Causality::Input,
            DeviceClass::Y => Causality::Output,
            _ if is_in(written) => Causality::Input,
            _ if is_in(read) => Causality::Output,
            _ => Causality::Local,
        };
        for &value in values(device.class, holds) {
            let is_value = [DeviceClass::T, DeviceClass::C].contains(&device.class);
            let (suffix, causality) = match (is_value, value, causality) {
                // A contact follows its coil.
                (true, Value::Bit, Causality::Input) => ("", Causality::Local),
                (true, Value::Word, causality) => ("_value", causality),
                (_, _, causality) => ("", causality),
            };
            variables.push(Variable {
                name: unique(&identifier(&description), device, suffix, &mut names),
                description: description.clone(),
                device,
                value,
                causality,
            });
        }
    }
    variables
}

/// The devices, and what each holds.
fn devices<'a>(
    program: &Program,
    module: &Module,
    panels: impl Iterator<Item = &'a DeviceRun>,
) -> BTreeMap<Device, Holds> {
    let mut devices = BTreeMap::new();
    let storage = Storage::new(module);
    for class in [DeviceClass::X, DeviceClass::Y] {
        let fields = storage.of_class(class).iter();
        let numbers = fields.flat_map(|field| field.numbers());
        devices.extend(numbers.map(|number| (Device { class, number }, Holds::Single)));
    }
    for run in panels {
        let numbers = run.first..run.first.saturating_add(run.count);
        let there = numbers.filter(|&number| storage.find(run.class, number).is_some());
        let class = run.class;
        devices.extend(there.map(|number| (Device { class, number }, Holds::Single)));
    }
    for (device, used) in uses(program, module.model) {
        let is_listed = devices.contains_key(&device);
        if is_listed || !is_special(device.class, device.number) {
            devices.insert(device, used.holds);
        }
    }
    // A word that is but the high half of a number has no variable.
    let pairs: Vec<Device> = devices
        .iter()
        .filter(|(_, holds)| **holds != Holds::Single)
        .map(|(device, _)| *device)
        .collect();
    let named = uses(program, module.model);
    for Device { class, number } in pairs {
        let number = number + 1;
        let high = Device { class, number };
        if !named.contains_key(&high) {
            devices.remove(&high);
        }
    }
    devices
}

fn holds_device(run: &DeviceRun, device: Device) -> bool {
    let number = device.number;
    run.class == device.class && number >= run.first && number - run.first < run.count
}

/// The values of a device.
fn values(class: DeviceClass, holds: Holds) -> &'static [Value] {
    use DeviceClass::{C, M, S, T, X, Y};
    match (class, holds) {
        (X | Y | M | S, _) => &[Value::Bit],
        (T | C, _) => &[Value::Bit, Value::Word],
        (_, Holds::Single) => &[Value::Word],
        (_, Holds::Double) => &[Value::Double],
        (_, Holds::Float) => &[Value::Float],
    }
}
