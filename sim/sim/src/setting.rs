//! Setting devices of the interpreter by their names.

use crate::record::TEXT_LENGTH;
use crate::target::Target;
use rungc_interp::{Machine, rt_class};
use rungc_models::Model;
use rungc_models::runs::is_counter32;
use rungc_rt::modules::Signal;
use rungc_rt::special::{D_SECOND, M_CLOCK_HOLD, M_CLOCK_STOP};
use rungc_rt::{Class, Plc, Relay, VirtualHal};
use rungc_syntax::DeviceClass;

fn set_pair(machine: &mut Machine, class: Class, number: u32, value: i32) -> Option<()> {
    machine.set_word(class, number, value as i16)?;
    machine.set_word(class, number + 1, (value >> 16) as i16)
}

/// Sets a device, or the signal at an input of a module; `None` if the model or its hardware has none.
pub fn set(machine: &mut Machine, hal: &mut VirtualHal, target: Target, value: f64) -> Option<()> {
    let integer = value as i64;
    match target {
        Target::Bit(class, n) => machine.set_bit(rt_class(class)?, n, value != 0.0),
        Target::Current(class, n) if is_counter32(class, n) => {
            machine.set_counter32(n, integer as i32)
        }
        Target::Word(class, n) | Target::Current(class, n) => {
            machine.set_word(rt_class(class)?, n, integer as i16)
        }
        Target::Pair(class, n) => set_pair(machine, rt_class(class)?, n, integer as i32),
        Target::Float(class, n) => {
            let bits = (value as f32).to_bits() as i32;
            set_pair(machine, rt_class(class)?, n, bits)
        }
        Target::Nibbles(digits, class, n) => {
            let class = rt_class(class)?;
            (0..4 * u32::from(digits))
                .try_for_each(|i| machine.set_bit(class, n + i, integer >> i & 1 == 1))
        }
        Target::Channel(channel) => {
            let signal = Signal {
                quantity: channel.quantity,
                millionths: (value * 1e6).round() as i32,
            };
            hal.set_signal(channel.unit, channel.number, signal)
        }
        Target::Text(..) | Target::Pulses(_) | Target::Frequency(_) => None,
    }
}

/// Checks that a device keeps a value that it is given until the program reads it; the error states who sets it
/// instead. `is_on` is the state of relays that let the clock's registers be set.
///
/// # Errors
/// Each scan gives it its own value.
pub fn check_lasts(
    model: &Model,
    target: Target,
    is_on: impl Fn(Relay) -> bool,
) -> Result<(), String> {
    let (class, first, count) = target.devices(TEXT_LENGTH);
    for number in first..first.saturating_add(count) {
        let device = class.number(number);
        if model.is_set_by_scan(class, number) {
            let meaning = model.special(class, number).map(|row| row.meaning(number));
            let meaning = meaning.unwrap_or_default();
            return Err(format!(
                "`{device}` cannot be set: each scan sets it ({meaning})"
            ));
        }
        let clock = D_SECOND.run::<7>();
        let shows_clock = model.scan_keeps(D_SECOND)
            && class == DeviceClass::D
            && clock.iter().any(|register| register.number() == number);
        if shows_clock && !is_on(M_CLOCK_STOP) && !is_on(M_CLOCK_HOLD) {
            let stop = DeviceClass::M.number(M_CLOCK_STOP.number());
            return Err(format!(
                "`{device}` follows the clock: set {stop} first, then the registers; when {stop} goes off, they set it"
            ));
        }
    }
    Ok(())
}
