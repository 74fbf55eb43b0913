//! Latched devices in an image in C.

use super::super::Image;
use crate::board::{InputPin, Retain, RetainMemory};
use crate::template;
use rungc_rt::retain::f4_sectors;
use std::fmt::Write;

/// Access of the drivers to memory.
const REACH: &str = "\
#define READ(address) REGISTER(address)
#define WRITE(address, value) (REGISTER(address) = (value))
#define WRITE_UNIT(address, value) (*(volatile flash_unit *)(uintptr_t)(address) = (value))

";

/// Functions for latched devices, before `main`.
pub(super) fn drivers(image: &Image) -> String {
    let watch = image.supply().map(|pin| power_fails(image, pin));
    let watch = watch.unwrap_or_default();
    let Some(retain) = image.retain() else {
        return watch;
    };
    let mut text = String::from("/* Latched devices, which survive power-off. */\n");
    if retain.memory != RetainMemory::Ram {
        text.push_str(REACH);
    }
    text.push_str(&driver(retain));
    text.push_str(
        "static const rungc_flash kept = {\n    .slot_length = KEPT_LENGTH,\n    .read = read_kept,\n    .erase = erase_kept,\n    \
         .program = program_kept,\n};\nstatic rungc_slots slots = {.flash = &kept};\n\n",
    );
    text + &watch
}

/// Driver of the memory: `kept_slots`, and functions that read, erase and write.
pub(super) fn driver(retain: &Retain) -> String {
    let [a, b] = retain.slots;
    let mut text = format!(
        "#define KEPT_LENGTH {}u\nstatic const uint32_t kept_slots[2] = {{0x{:08X}u, 0x{:08X}u}};\n",
        a.length, a.origin, b.origin
    );
    let body = match retain.memory {
        RetainMemory::Ram => template!("retain_ram.c").to_string(),
        RetainMemory::Stm32f1 => {
            let _ = writeln!(text, "#define KEPT_PAGE {}u", retain.page);
            text.push_str("typedef uint16_t flash_unit; /* half a word at a time is written */\n");
            stm32(
                "STM32F1",
                ["0x40022000", "1u", "0x14u", "(1u << 7)"],
                template!("retain_erase_f1.c"),
                "1u",
            )
        }
        RetainMemory::Rp2040 => template!("retain_rp2040.c").to_string(),
        RetainMemory::Stm32f4 => {
            let sectors = retain.slots.map(|slot| {
                let sectors = f4_sectors(&(slot.origin..slot.origin + slot.length));
                let sectors = sectors.unwrap_or_default();
                format!("{{{}u, {}u}}", sectors.start, sectors.end)
            });
            let _ = writeln!(
                text,
                "static const struct {{\n    uint32_t first, end;\n}} kept_sectors[2] = {{{}}};",
                sectors.join(", ")
            );
            text.push_str("typedef uint32_t flash_unit; /* a word at a time is written */\n");
            let bits = ["0x40023C00", "(1u << 16)", "0xF2u", "(1u << 31)"];
            stm32(
                "STM32F4",
                bits,
                template!("retain_erase_f4.c"),
                "2u << 8 | 1u",
            )
        }
    };
    format!("{text}\n{body}\n")
}

fn stm32(part: &str, [base, busy, errors, lock]: [&str; 4], erase: &str, program: &str) -> String {
    template!("retain_stm32.c")
        .replace("/* PART */", part)
        .replace("/* BASE */", base)
        .replace("/* BUSY */", busy)
        .replace("/* ERRORS */", errors)
        .replace("/* LOCK */", lock)
        .replace("/* ERASE */", erase)
        .replace("/* PROGRAM */", program)
}

/// Function that reads the supply's pin.
fn power_fails(image: &Image, pin: &InputPin) -> String {
    let compare = if pin.inverted { "==" } else { "!=" };
    let save = match image.retain() {
        Some(_) => {
            "    if (fails && !failed) {\n        (void)PROGRAM_save_latched(&plc, &slots);\n    }\n"
        }
        None => "",
    };
    format!(
        "/* Returns true if the supply reports an imminent power failure. */\nstatic bool power_fails(void *context)\n{{\n    \
         (void)context;\n    return (REGISTER(0x{:08X}u) & 0x{:X}u) {compare} 0u;\n}}\n\n\
         /* Saves latched devices once when power fails, and begins anew when it is back after the program has stopped. */\n\
         static void watch_supply(void)\n{{\n    static bool failed;\n    const bool fails = power_fails(NULL);\n\n{save}    \
         if (failed && !fails && !plc.sys.running) {{\n        PROGRAM_power_cycle(&plc);\n    }}\n    failed = fails;\n}}\n\n",
        pin.at,
        1u32 << pin.bit
    )
}

/// Code in `main` after the program's devices have their initial values.
pub(super) fn load(image: &Image) -> &'static str {
    match image.retain() {
        Some(_) => "    (void)PROGRAM_load_latched(&plc, &slots);\n",
        None => "",
    }
}

/// Code in `main` after each scan.
pub(super) fn save(image: &Image) -> String {
    let mut text = String::new();
    if image.supply().is_some() {
        text.push_str("        watch_supply();\n");
    }
    if let Some(retain) = image.retain() {
        let _ = writeln!(
            text,
            "        (void)PROGRAM_save_changes(&plc, &slots, board.now_ms, {}u);",
            retain.every_ms
        );
    }
    text
}
