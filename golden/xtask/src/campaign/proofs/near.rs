//! Devices by how near they are to a condition: those that its rungs name, those that the rungs of these name, and so
//! on. An estimate that steers attacks; nothing depends on its being complete.

use rungc_syntax::{DeviceClass, OperandKind, Program};
use rungc_verify::steered::Levels;

/// A device.
type Device = (DeviceClass, u32);

/// Devices of a rung.
#[derive(Default)]
struct Rung {
    /// Of its contacts and comparisons.
    read: Vec<Device>,
    /// Of everything else in it.
    other: Vec<Device>,
}

/// The devices from which something leads to these.
pub fn levels(text: &str, targets: impl IntoIterator<Item = Device>) -> Levels {
    let program = rungc_frontend::read_text("campaign.il", text).program;
    let rungs = rungs(&program);
    let mut levels: Levels = targets.into_iter().map(|device| (device, 0)).collect();
    for level in 1..=5 {
        let mut found: Vec<Device> = Vec::new();
        for rung in &rungs {
            let mut written = rung.other.iter();
            if written.any(|device| levels.contains_key(device)) {
                found.extend(rung.read.iter().chain(&rung.other).copied());
            }
        }
        for device in found {
            levels.entry(device).or_insert(level);
        }
    }
    levels
}

fn rungs(program: &Program) -> Vec<Rung> {
    let mut rungs: Vec<Rung> = Vec::new();
    let mut is_new = true;
    for instr in &program.instrs {
        let verb = instr.mnemonic.as_str();
        let contacts = [
            "LD", "AND", "ANI", "OR", "ANB", "INV", "MEP", "MEF", "MPS", "MRD", "MPP",
        ];
        let is_contact = contacts.iter().any(|contact| verb.starts_with(contact));
        if verb.starts_with("LD") && is_new {
            rungs.push(Rung::default());
        }
        is_new = !is_contact;
        let named = instr
            .operands
            .iter()
            .flat_map(|operand| devices(&operand.kind));
        if let Some(rung) = rungs.last_mut() {
            match is_contact {
                true => rung.read.extend(named),
                false => rung.other.extend(named),
            }
        }
    }
    rungs
}

/// The devices that an operand names, without what an index leads to.
fn devices(operand: &OperandKind) -> Vec<Device> {
    let run = |class, first: u32, count: u32| (first..first + count).map(|n| (class, n)).collect();
    match *operand {
        OperandKind::Device(device, _) => match device.class {
            DeviceClass::D | DeviceClass::R => run(device.class, device.number, 2),
            class => run(class, device.number, 1),
        },
        OperandKind::WordBit(device, ..) => run(device.class, device.number, 1),
        OperandKind::Nibbles(digits, device, _) => {
            run(device.class, device.number, 4 * u32::from(digits.min(8)))
        }
        _ => Vec::new(),
    }
}
