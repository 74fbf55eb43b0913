//! Memory of a board for latched devices: `[retain]`.

use super::pins::InputFormat;
use super::{Board, BoardError, InputPin, Reader, Region};
use rungc_rt::retain::f4_sectors;
use serde::Deserialize;

/// Memory for latched devices, and the time at which they are saved.
#[derive(Clone, Debug, PartialEq)]
pub struct Retain {
    /// Kind of memory.
    pub memory: RetainMemory,
    /// Two slots, each of which is erased as a whole.
    pub slots: [Region; 2],
    /// Bytes of a page of an STM32F1.
    pub page: u32,
    /// Minimum interval of saves for a changed device, in milliseconds.
    pub every_ms: u32,
    /// The pin by which the supply says that power is about to fail.
    pub power_fail: Option<InputPin>,
}

/// Kinds of memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum RetainMemory {
    /// RAM with a battery, or FRAM.
    Ram,
    /// Pages of an STM32F1.
    Stm32f1,
    /// Sectors of an STM32F4.
    Stm32f4,
    /// Sectors of the flash beside an RP2040.
    Rp2040,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Format {
    memory: RetainMemory,
    slots: toml::Spanned<[Region; 2]>,
    #[serde(default = "default_page")]
    page: u32,
    #[serde(default = "default_every_ms")]
    every_ms: u32,
    power_fail: Option<toml::Spanned<InputFormat>>,
}

fn default_page() -> u32 {
    1024
}

fn default_every_ms() -> u32 {
    60_000
}

impl Reader<'_> {
    /// The memory for latched devices, in slots that can be erased.
    pub(super) fn retain(&self, format: Format) -> Result<Retain, BoardError> {
        let wrong = |message: &str| Err(self.at(&format.slots, message.to_string()));
        let slots = *format.slots.get_ref();
        let ends = slots.map(|slot| slot.origin.checked_add(slot.length));
        let [Some(_), Some(_)] = ends else {
            return wrong("a slot extends past the address range");
        };
        if overlaps(slots[0], slots[1]) {
            return wrong("the slots overlap");
        }
        if slots[0].length != slots[1].length || slots[0].length == 0 {
            return wrong("both slots have the same length, which is not 0");
        }
        let (step, what) = match format.memory {
            RetainMemory::Ram => (8, "slots begin and end at multiples of 8"),
            RetainMemory::Stm32f1 => (format.page, "a slot consists of whole pages (`page`)"),
            RetainMemory::Stm32f4 => (8, ""),
            RetainMemory::Rp2040 => (
                4096,
                "a slot beside an RP2040 consists of whole sectors of 4K",
            ),
        };
        let whole = |n: u32| step != 0 && n.is_multiple_of(step) && n.is_multiple_of(8);
        if slots.iter().any(|s| !whole(s.origin) || !whole(s.length)) {
            return wrong(what);
        }
        if format.memory == RetainMemory::Rp2040 && slots.iter().any(|s| s.origin >> 24 != 0x10) {
            return wrong("flash of an RP2040 is at 0x10000000");
        }
        let in_sectors = |slot: &Region| f4_sectors(&(slot.origin..slot.origin + slot.length));
        if format.memory == RetainMemory::Stm32f4 && slots.iter().any(|s| in_sectors(s).is_none()) {
            return wrong(
                "a slot of an STM32F4 consists of whole sectors: 16K each from 0x08000000 on, 64K at 0x08010000, 128K each from 0x08020000 on",
            );
        }
        let power_fail = format.power_fail.map(|pin| {
            let place = pin.span().start;
            self.input(place, "supply", pin.into_inner())
        });
        Ok(Retain {
            memory: format.memory,
            slots,
            page: format.page,
            every_ms: format.every_ms,
            power_fail: power_fail.transpose()?,
        })
    }

    /// The image uses no memory of the slots.
    pub(super) fn free_slots(&self, board: &Board) -> Result<(), BoardError> {
        let slots = board.retain.iter().flat_map(|retain| retain.slots);
        for slot in slots {
            for (region, name) in [(board.flash, "flash"), (board.ram, "ram")] {
                if overlaps(slot, region) {
                    let what = format!(
                        "a slot of `[retain]` at 0x{:08X} is in `{name}`, where the image is: leave it out of `[memory]`",
                        slot.origin
                    );
                    return Err(self.wrong(0, what));
                }
            }
        }
        Ok(())
    }
}

/// Returns true if two runs of memory overlap.
fn overlaps(a: Region, b: Region) -> bool {
    let end = |region: Region| u64::from(region.origin) + u64::from(region.length);
    u64::from(a.origin) < end(b) && u64::from(b.origin) < end(a)
}
