//! A program beside the PLC that runs it: the values that the PLC has, in a session of the program here.

use rungc_analysis::resolve::resolve;
use rungc_analysis::xref::CrossReference;
use rungc_frontend::image;
use rungc_interp::Machine;
use rungc_models::Model;
use rungc_models::runs::{IndexAlias, name_class, rt_class};
use rungc_monitor::{Item, Sample};
use rungc_rt::{Class, Plc as _, special};
use rungc_sim::record::{Reading, TEXT_LENGTH, Values};
use rungc_sim::{Session, Target};
use rungc_syntax::{Device, DeviceClass, Diagnostics, Index, OperandKind, Program};
use std::collections::BTreeSet;

/// Shows that the PLC is in RUN.
const RUNS: Item = Item::Bit(Class::M, special::M_RUNNING.number());

/// The values of the devices that the instructions of a program name, and whether the PLC is in RUN. Those that only an
/// index register leads to are not among them.
pub fn items(program: &Program, model: &'static Model) -> BTreeSet<Item> {
    let (resolved, _) = resolve(program, model);
    let rows = CrossReference::new(&resolved).rows.into_iter();
    let devices = rows.flat_map(|row| {
        let class = row.first.class;
        (row.first.number..=row.last.number).map(move |number| Device { class, number })
    });
    let registers = indexed(program).map(|(_, _, index)| register(&index));
    let devices = devices.chain(registers);
    let items = devices.flat_map(|device| items_of(device, model));
    items.chain([RUNS]).collect()
}

/// The operands of a program that have an index: the device as written, how many devices there are from there on, and
/// the index.
fn indexed(program: &Program) -> impl Iterator<Item = (Device, u32, Index)> {
    let operands = program.instrs.iter().flat_map(|instr| &instr.operands);
    operands.filter_map(|operand| match operand.kind {
        // Of words, the two of a 32-bit instruction.
        OperandKind::Device(device, Some(index)) => Some((device, 2, index)),
        OperandKind::WordBit(device, _, Some(index)) => Some((device, 1, index)),
        OperandKind::Nibbles(digits, device, Some(index)) => {
            Some((device, 4 * u32::from(digits), index))
        }
        _ => None,
    })
}

fn register(index: &Index) -> Device {
    Device {
        class: index.class,
        number: index.number,
    }
}

/// The values that index registers lead to, as far as the registers are known: what each indexed operand names now. A
/// second look reads them.
pub fn indexed_items(program: &Program, model: &'static Model, sample: &Sample) -> BTreeSet<Item> {
    let value = |index: &Index| -> i32 {
        let items = items_of(register(index), model).into_iter();
        let values = items.filter_map(|item| sample.values.get(&item));
        values.copied().next().unwrap_or(0)
    };
    let named = indexed(program).filter_map(|(device, count, index)| {
        let number = device.number.checked_add_signed(value(&index))?;
        Some((number..number.saturating_add(count)).map(move |number| Device { number, ..device }))
    });
    let devices = named
        .flatten()
        .filter(|device| model.has(device.class, device.number));
    devices.flat_map(|device| items_of(device, model)).collect()
}

/// The values of a device: of a timer or counter its contact and its current value, of an index register its special
/// register.
pub fn items_of(device: Device, model: &Model) -> Vec<Item> {
    let mut aliases = model.index_aliases.iter();
    let alias = aliases.find(|alias| (alias.class, alias.index) == (device.class, device.number));
    if let Some(alias) = alias {
        return vec![Item::Word(Class::D, alias.register.number())];
    }
    let Some(class) = rt_class(device.class) else {
        return Vec::new();
    };
    let bit = Item::Bit(class, device.number);
    let word = Item::Word(class, device.number);
    match device.class {
        DeviceClass::X | DeviceClass::Y | DeviceClass::M | DeviceClass::S => vec![bit],
        DeviceClass::T | DeviceClass::C => vec![bit, word],
        _ => vec![word],
    }
}

/// The values that a target is made of; empty for what a PLC does not show: pulses, signals of modules.
pub fn items_of_target(target: Target, model: &Model) -> Vec<Item> {
    let (class, first, count) = target.devices(TEXT_LENGTH);
    let numbers = match target {
        Target::Pulses(_) | Target::Frequency(_) | Target::Channel(_) => 0..0,
        // Shorter at the end of a class.
        Target::Text(..) => {
            let there = (first..first + count).take_while(|&number| model.has(class, number));
            first..first + there.count() as u32
        }
        _ => first..first.saturating_add(count),
    };
    let items = numbers.flat_map(|number| items_of(Device { class, number }, model));
    let is_bit = matches!(target, Target::Bit(..) | Target::Nibbles(..));
    items
        .filter(|item| matches!(item, Item::Bit(..)) == is_bit)
        .collect()
}

/// Value of a target in a sample; `None` where the PLC did not show all of it.
pub fn reading(target: Target, sample: &Sample, model: &Model) -> Option<Reading> {
    Reading::of_values(&Sampled { sample, model }, target)
}

/// The values of a sample, by devices.
struct Sampled<'a> {
    sample: &'a Sample,
    model: &'a Model,
}

impl Sampled<'_> {
    fn value(&self, class: DeviceClass, number: u32, is_bit: bool) -> Option<i32> {
        let items = items_of(Device { class, number }, self.model);
        let mut own = items.iter();
        let own = own.find(|item| matches!(item, Item::Bit(..)) == is_bit)?;
        self.sample.values.get(own).copied()
    }
}

impl Values for Sampled<'_> {
    fn bit(&self, class: DeviceClass, number: u32) -> Option<bool> {
        self.value(class, number, true).map(|value| value != 0)
    }

    fn word(&self, class: DeviceClass, number: u32) -> Option<i16> {
        self.value(class, number, false).map(|value| value as i16)
    }

    fn counter32(&self, number: u32) -> Option<i32> {
        self.value(DeviceClass::C, number, false)
    }
}

/// The device that a value belongs to.
pub fn device_of(item: Item) -> Device {
    let (Item::Bit(class, number) | Item::Word(class, number)) = item;
    Device {
        class: name_class(class),
        number,
    }
}

/// Brings a session that has not begun to where a PLC stands. Edges are over, as after scans in which nothing changes:
/// what the program remembers of earlier scans to notice them, a PLC does not show. What is hidden counts as off.
pub fn take_over(session: &mut Session, sample: &Sample) {
    give(session.machine_mut(), sample);
    // The first scan initialises, the second one sees what the PLC has, and both write devices.
    for _ in 0..2 {
        session.scan(0);
        give(session.machine_mut(), sample);
    }
    if sample.values.get(&RUNS) == Some(&0) {
        session.set_running(false);
        give(session.machine_mut(), sample);
    }
}

/// The first step at which the program memory of a PLC differs from a program; `None` if they are the same.
///
/// # Errors
/// Instructions of the program whose machine code is not known.
pub fn first_difference(program: &Program, memory: &[u8]) -> Result<Option<usize>, Diagnostics> {
    const WORD: usize = 2;
    let own = image::write(program)?;
    let steps = |image: &[u8]| -> Vec<[u8; WORD]> {
        let code = image.get(image::program_start(image)..).unwrap_or_default();
        code.chunks_exact(WORD)
            .map(|word| [word[0], word[1]])
            .collect()
    };
    let (own, there) = (steps(&own), steps(memory));
    let differs = own.iter().zip(&there).position(|(own, there)| own != there);
    let shorter = own.len().min(there.len());
    Ok(differs.or_else(|| (own.len() != there.len()).then_some(shorter)))
}

fn give(machine: &mut Machine, sample: &Sample) {
    let hidden = sample.hidden.iter().map(|item| (item, &0));
    for (&item, &value) in sample.values.iter().chain(hidden) {
        // What the program does not store has no part in it.
        let _ = match item {
            Item::Bit(class, number) => machine.set_bit(class, number, value != 0),
            Item::Word(Class::C, number) if machine.counter32(number).is_some() => {
                machine.set_counter32(number, value)
            }
            Item::Word(class, number) => {
                let mut aliases = machine.module().model.index_aliases.iter();
                let is_shown = |alias: &&IndexAlias| alias.is_within(number, number);
                let alias = aliases.find(|alias| class == Class::D && is_shown(alias));
                let index = alias.and_then(|alias| Some((rt_class(alias.class)?, alias.index)));
                let (class, number) = index.unwrap_or((class, number));
                machine.set_word(class, number, value as i16)
            }
        };
    }
}
