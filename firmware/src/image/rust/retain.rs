//! Latched devices in an image in Rust.

use super::super::Image;
use crate::board::{InputPin, Retain, RetainMemory};
use crate::template;
use std::fmt::Write;

/// Access of the runtime's drivers to memory.
const BUS: &str = "/// Memory that holds latched devices, and its controller.
struct Bus;

impl Registers for Bus {
    fn read(&mut self, address: u32) -> u32 {
        read(address as usize)
    }

    fn write(&mut self, address: u32, value: u32) {
        write(address as usize, value);
    }

    fn write_half(&mut self, address: u32, value: u16) {
        // SAFETY: the address is one of a slot's.
        unsafe { (address as usize as *mut u16).write_volatile(value) }
    }
}

";

/// The type that drives the memory.
fn name(memory: RetainMemory) -> &'static str {
    match memory {
        RetainMemory::Ram => "Ram",
        RetainMemory::Stm32f1 => "Stm32f1",
        RetainMemory::Stm32f4 => "Stm32f4",
        RetainMemory::Rp2040 => "Rp2040",
    }
}

/// Imports for latched devices.
pub(super) fn uses(image: &Image) -> String {
    match image.retain().map(|retain| retain.memory) {
        None => String::new(),
        Some(RetainMemory::Rp2040) => {
            "use core::ops::Range;\nuse rungc_rt::retain::{Flash, FlashFailed, Slots};\n"
                .to_string()
        }
        Some(memory) => {
            let name = name(memory);
            format!("use rungc_rt::retain::{{{name}, Registers, Slots}};\n")
        }
    }
}

/// Functions for latched devices, before `main`.
pub(super) fn drivers(image: &Image) -> String {
    let supply = image.supply().map(power_fails).unwrap_or_default();
    let Some(retain) = image.retain() else {
        return supply;
    };
    let slots = retain.slots.map(|slot| {
        let end = slot.origin + slot.length;
        format!("0x{:08X}..0x{end:08X}", slot.origin)
    });
    let page = match retain.memory {
        RetainMemory::Stm32f1 => format!(", page: {}", retain.page),
        RetainMemory::Ram | RetainMemory::Stm32f4 | RetainMemory::Rp2040 => String::new(),
    };
    if retain.memory == RetainMemory::Rp2040 {
        let slots = slots.join(", ");
        return format!(
            "{supply}{}/// The memory that holds latched devices.\nconst fn kept() -> Rp2040 {{\n    Rp2040 {{ slots: [{slots}] }}\n}}\n\n",
            template!("retain_rp2040.rs")
        );
    }
    let (name, slots) = (name(retain.memory), slots.join(", "));
    format!(
        "{supply}{BUS}/// The memory that holds latched devices.\nconst fn kept() -> {name}<Bus> {{\n    {name} {{ registers: Bus, slots: [{slots}]{page} }}\n}}\n\n"
    )
}

/// Code in `main` before the first scan.
pub(super) fn load(image: &Image) -> String {
    let mut text = String::new();
    if image.retain().is_some() {
        text.push_str(
            "    let mut slots = Slots::open(kept()).ok();\n    if let Some(slots) = &mut slots {\n        \
             let _ = slots.load(&mut driver.program);\n    }\n",
        );
    }
    if image.supply().is_some() {
        text.push_str("    let mut failed = false;\n");
    }
    text
}

/// Code in `main` after each scan: it saves latched devices once when power fails, and restarts when power is back
/// after the program has stopped.
pub(super) fn save(image: &Image) -> String {
    let mut text = String::new();
    if image.supply().is_some() {
        text.push_str("        let fails = power_fails();\n");
    }
    if let Some(Retain { every_ms, .. }) = image.retain() {
        text.push_str("        if let Some(slots) = &mut slots {\n");
        if image.supply().is_some() {
            text.push_str(
                "            if fails && !failed {\n                let _ = slots.save(&driver.program);\n            }\n",
            );
        }
        let _ = write!(
            text,
            "            let _ = slots.poll(&driver.program, driver.now_ms(), {every_ms});\n        }}\n"
        );
    }
    if image.supply().is_some() {
        text.push_str(
            "        if failed && !fails && !driver.program.sys().running {\n            \
             driver.program.power_cycle();\n        }\n        failed = fails;\n",
        );
    }
    text
}

/// Function that returns true if power is about to fail.
fn power_fails(pin: &InputPin) -> String {
    let compare = if pin.inverted { "==" } else { "!=" };
    format!(
        "/// Returns true if the supply reports an imminent power failure.\nfn power_fails() -> bool {{\n    \
         read(0x{:08X}) & 0x{:X} {compare} 0\n}}\n\n",
        pin.at,
        1u32 << pin.bit
    )
}
