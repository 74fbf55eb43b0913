//! Lookup of devices by a [`Map`], and the other services that instructions need of a program.

use super::hal::Board;
use super::{Area, Kind, Layout, Map, OnError};
use crate::axis::Axis;
use crate::comm::codec::Codec;
use crate::comm::modbus::{self, Profile};
use crate::comm::{PortMut, PortWiring, Ports};
use crate::cx::{Cx, conclude};
use crate::fault::{Done, ErrorRules};
use crate::operand::Operand;
use crate::plc::{Class, Plc, Site, State, StoredRun, Sys};
use crate::runs::FIRST_COUNTER32;
use crate::timing::{Counter16, Counter32, Timer};
use crate::wiring::Pulses;
use core::mem::offset_of;
use core::ptr::null_mut;

/// Location of a device.
enum Found {
    /// Stored there.
    At(Kind, *mut u8),
    /// The model has it; the program does not look at it.
    Elsewhere,
    /// The model has no such device.
    Nowhere,
}

/// The elements that a pointer of a [`Layout`] stands for.
pub(super) fn elements<'a, T>(first: *const T, count: usize) -> &'a [T] {
    if first.is_null() {
        return &[];
    }
    // SAFETY: a Layout's pointers are valid for their counts and as long as the program runs, and nothing writes to
    // them.
    unsafe { core::slice::from_raw_parts(first, count) }
}

impl Area {
    /// Index of a device in this area's memory, if the area holds it.
    #[inline]
    fn place_of(&self, class: Class, number: u32) -> Option<u32> {
        let n = number.wrapping_sub(self.first);
        if self.class != class || n >= self.count {
            return None;
        }
        // Most have no columns, and a division takes longer than all else here.
        if self.columns <= 1 {
            return Some(n);
        }
        self.place_in_columns(n)
    }

    /// The same of the device `n` places after the first, in an array of columns.
    fn place_in_columns(&self, n: u32) -> Option<u32> {
        let (row, column) = (n / self.columns, n % self.columns);
        let rows = self.count.div_ceil(self.columns);
        (column < self.stored_columns).then_some(column * rows + row)
    }
}

impl Map {
    pub(super) fn layout(&self) -> &Layout {
        // SAFETY: whoever makes a Map gives it a valid layout that outlives it.
        unsafe { &*self.layout }
    }

    /// Areas of its devices, sorted.
    fn areas(&self) -> &[Area] {
        let layout = self.layout();
        elements(layout.areas, layout.area_count)
    }

    /// An area, counted from the last one, as operands name it.
    #[inline]
    fn area(&self, area: u8) -> Option<&Area> {
        let areas = self.areas();
        areas.get(areas.len().checked_sub(area.into())?)
    }

    /// The device in the area that an operand names, if that holds it; most calls need no more.
    #[inline]
    fn named(&self, area: u8, class: Class, number: u32) -> Option<Found> {
        self.at(self.area(area)?, class, number)
    }

    /// Address of the first of `count` words, if this area holds all of them contiguously.
    fn run(&self, area: u8, class: Class, first: u32, count: usize) -> Option<*mut i16> {
        let area = self.area(area)?;
        let last = first.checked_add(u32::try_from(count).ok()?.checked_sub(1)?)?;
        area.place_of(class, last)?;
        match self.at(area, class, first)? {
            Found::At(Kind::Words, at) if area.columns <= 1 => Some(at.cast()),
            _ => None,
        }
    }

    /// Finds a device, in this area if that holds it.
    #[inline]
    fn find_in(&self, area: u8, class: Class, number: u32) -> Found {
        match self.named(area, class, number) {
            Some(found) => found,
            None => self.find(class, number),
        }
    }

    /// A device of an area, if that holds it.
    #[inline]
    fn at(&self, area: &Area, class: Class, number: u32) -> Option<Found> {
        let place = area.place_of(class, number)?;
        let size = match area.kind {
            Kind::Bits => size_of::<bool>(),
            Kind::Words => size_of::<i16>(),
            Kind::Timers => size_of::<Timer>(),
            Kind::Counters16 => size_of::<Counter16>(),
            Kind::Counters32 => size_of::<Counter32>(),
        };
        let offset = area.offset + place as usize * size;
        // SAFETY: an area's elements lie inside the program's struct, which `plc` points to.
        Some(Found::At(area.kind, unsafe {
            self.plc.cast::<u8>().add(offset)
        }))
    }

    /// The area that a device is in, if it is in any.
    fn index_of(&self, class: Class, number: u32) -> Option<usize> {
        let areas = self.areas();
        let after = areas.partition_point(|a| (a.class, a.first) <= (class, number));
        let index = after.checked_sub(1)?;
        areas[index].place_of(class, number).map(|_| index)
    }

    /// The index register that a special register is another name of.
    fn alias(&self, class: Class, number: u32) -> Option<(Class, u32)> {
        let layout = self.layout();
        let mut aliases = elements(layout.aliases, layout.alias_count).iter();
        let alias = aliases.find(|a| class == Class::D && a.number == number)?;
        (alias.class != Class::D).then_some((alias.class, alias.index))
    }

    #[cold]
    fn find(&self, class: Class, number: u32) -> Found {
        if let Some(found) = self.find_stored(class, number) {
            return found;
        }
        // No index register is another name of something else.
        let alias = self.alias(class, number);
        if let Some(found) = alias.and_then(|(class, number)| self.find_stored(class, number)) {
            return found;
        }
        let (class, number) = alias.unwrap_or((class, number));
        let layout = self.layout();
        let ranges = elements(layout.ranges, layout.range_count);
        let after = ranges.partition_point(|r| (r.class, r.first) <= (class, number));
        let range = after.checked_sub(1).and_then(|i| ranges.get(i));
        match range.filter(|r| r.class == class && number <= r.last) {
            Some(_) => Found::Elsewhere,
            None => Found::Nowhere,
        }
    }

    /// A device that is stored under its own name.
    fn find_stored(&self, class: Class, number: u32) -> Option<Found> {
        let area = self.areas().get(self.index_of(class, number)?)?;
        self.at(area, class, number)
    }

    /// The word of a device, however it is stored; NULL if the program does not look at it.
    fn word_place(&self, area: u8, class: Class, number: u32) -> Option<*mut i16> {
        match self.find_in(area, class, number) {
            Found::At(kind, at) => word_of(kind, at),
            Found::Elsewhere if is_word(class, number) => Some(null_mut()),
            _ => None,
        }
    }

    /// The state of a device, likewise.
    fn bit_place(&self, area: u8, class: Class, number: u32) -> Option<*mut bool> {
        match self.find_in(area, class, number) {
            Found::At(kind, at) => bit_of(kind, at),
            Found::Elsewhere if is_bit(class) => Some(null_mut()),
            _ => None,
        }
    }

    /// The 32-bit value of a counter, likewise.
    fn counter_place(&self, number: u32) -> Option<*mut i32> {
        match self.find(Class::C, number) {
            Found::At(kind, at) => counter_of(kind, at),
            Found::Elsewhere if number >= FIRST_COUNTER32 => Some(null_mut()),
            _ => None,
        }
    }

    /// Address of a device, if it is stored.
    #[inline(never)]
    pub(super) fn stored(&self, class: Class, number: u32) -> Option<(Kind, *mut u8)> {
        let (class, number) = self.alias(class, number).unwrap_or((class, number));
        // A binary search in less code than that of the library.
        let mut areas = self.areas();
        while areas.len() > 1 {
            let (before, after) = areas.split_at(areas.len() / 2);
            let is_after = after
                .first()
                .is_some_and(|a| (a.class, a.first) <= (class, number));
            areas = if is_after { after } else { before };
        }
        match self.at(areas.first()?, class, number)? {
            Found::At(kind, at) => Some((kind, at)),
            _ => None,
        }
    }

    /// Does something with one device as an instruction would.
    pub(super) fn with_operand<R>(
        &mut self,
        class: Class,
        number: u32,
        what: impl FnOnce(&mut Cx) -> R,
    ) -> R {
        let mut hal = Board::new(self.hal);
        let ops = [Operand::device(
            class,
            i32::try_from(number).unwrap_or(i32::MAX),
        )];
        what(&mut Cx::new(self, &mut hal, &ops, Site::at(0).wide()))
    }

    /// Runs an instruction and reports its fault.
    pub(super) fn call(&mut self, function: fn(&mut Cx) -> Done, site: Site, ops: &[Operand]) {
        let mut hal = Board::new(self.hal);
        let done = function(&mut Cx::new(self, &mut hal, ops, site));
        conclude(done, site, self);
    }
}

/// The word of an element of the program's struct.
pub(super) fn word_of(kind: Kind, at: *mut u8) -> Option<*mut i16> {
    let offset = match kind {
        Kind::Words => 0,
        Kind::Timers => offset_of!(Timer, value),
        Kind::Counters16 => offset_of!(Counter16, value),
        Kind::Bits | Kind::Counters32 => return None,
    };
    // SAFETY: the field of an element that `at` points to, and in which C places it as Rust does.
    Some(unsafe { at.add(offset) }.cast())
}

/// Its state.
pub(super) fn bit_of(kind: Kind, at: *mut u8) -> Option<*mut bool> {
    let offset = match kind {
        Kind::Bits => 0,
        Kind::Timers => offset_of!(Timer, done),
        Kind::Counters16 => offset_of!(Counter16, done),
        Kind::Counters32 => offset_of!(Counter32, done),
        Kind::Words => return None,
    };
    // SAFETY: as for words.
    Some(unsafe { at.add(offset) }.cast())
}

/// Its 32-bit value.
pub(super) fn counter_of(kind: Kind, at: *mut u8) -> Option<*mut i32> {
    match kind {
        // SAFETY: as for words.
        Kind::Counters32 => Some(unsafe { at.add(offset_of!(Counter32, value)) }.cast()),
        _ => None,
    }
}

/// Value at an address in the program's struct; 0 or off for NULL.
pub(super) fn read<T: Copy + Default>(at: *mut T) -> T {
    // SAFETY: NULL, or what the program's struct holds there, as the C compiler placed it.
    unsafe { at.as_ref() }.copied().unwrap_or_default()
}

/// Writes to a place in the program's struct, if there is one.
pub(super) fn write<T>(at: *mut T, value: T) {
    // SAFETY: as for `read`; nothing else uses the struct during a call.
    if let Some(place) = unsafe { at.as_mut() } {
        *place = value;
    }
}

/// Changes an element of the program's struct.
fn change<T>(at: *mut u8, change: impl FnOnce(&mut T)) -> Option<()> {
    // SAFETY: as for `read`; nothing else uses the struct during a call.
    change(unsafe { &mut *at.cast::<T>() });
    Some(())
}

impl Plc for Map {
    fn bit(&self, class: Class, number: u32) -> Option<bool> {
        self.bit_in(0, class, number)
    }

    fn set_bit(&mut self, class: Class, number: u32, value: bool) -> Option<()> {
        self.set_bit_in(0, class, number, value)
    }

    fn coil(&self, class: Class, number: u32) -> Option<bool> {
        match self.find(class, number) {
            Found::At(Kind::Timers, at) => Some(read(at.cast::<Timer>()).coil != 0),
            Found::At(Kind::Counters16, at) => Some(read(at.cast::<Counter16>()).coil),
            Found::At(Kind::Counters32, at) => Some(read(at.cast::<Counter32>()).coil),
            _ => self.bit(class, number),
        }
    }

    fn word(&self, class: Class, number: u32) -> Option<i16> {
        self.word_place(0, class, number).map(read)
    }

    fn set_word(&mut self, class: Class, number: u32, value: i16) -> Option<()> {
        let at = self.word_place(0, class, number)?;
        write(at, value);
        Some(())
    }

    fn bit_in(&self, area: u8, class: Class, number: u32) -> Option<bool> {
        self.bit_place(area, class, number).map(read)
    }

    fn set_bit_in(&mut self, area: u8, class: Class, number: u32, value: bool) -> Option<()> {
        let at = self.bit_place(area, class, number)?;
        write(at, value);
        Some(())
    }

    // Most operands are registers in the area that they name.
    fn word_in(&self, area: u8, class: Class, number: u32) -> Option<i16> {
        match self.named(area, class, number) {
            Some(Found::At(Kind::Words, at)) => Some(read(at.cast())),
            _ => self.word(class, number),
        }
    }

    fn set_word_in(&mut self, area: u8, class: Class, number: u32, value: i16) -> Option<()> {
        match self.named(area, class, number) {
            Some(Found::At(Kind::Words, at)) => {
                write(at.cast(), value);
                Some(())
            }
            _ => self.set_word(class, number, value),
        }
    }

    fn words_in(&self, area: u8, class: Class, first: u32, words: &mut [i16]) -> Option<()> {
        if let Some(run) = self.run(area, class, first, words.len()) {
            // SAFETY: the struct holds as many words there; nothing else uses it during a call.
            words.copy_from_slice(unsafe { core::slice::from_raw_parts(run, words.len()) });
            return Some(());
        }
        let mut all = (first..).zip(words);
        all.try_for_each(|(number, word)| {
            self.word_in(area, class, number).map(|value| *word = value)
        })
    }

    fn set_words_in(&mut self, area: u8, class: Class, first: u32, words: &[i16]) -> Option<()> {
        if let Some(run) = self.run(area, class, first, words.len()) {
            // SAFETY: as for reading.
            unsafe { core::slice::from_raw_parts_mut(run, words.len()) }.copy_from_slice(words);
            return Some(());
        }
        let mut all = (first..).zip(words);
        all.try_for_each(|(number, word)| self.set_word_in(area, class, number, *word))
    }

    fn counter32(&self, number: u32) -> Option<i32> {
        self.counter_place(number).map(read)
    }

    fn set_counter32(&mut self, number: u32, value: i32) -> Option<()> {
        let at = self.counter_place(number)?;
        write(at, value);
        Some(())
    }

    fn stored_run(&self, class: Class, number: u32) -> Option<StoredRun> {
        let alias = self.alias(class, number);
        let (class, number) = alias.unwrap_or((class, number));
        let index = self.index_of(class, number)?;
        let areas = self.areas();
        let area = areas.get(index)?;
        // Other names, and devices in columns, are found one by one.
        let count = match area.columns {
            0 | 1 if alias.is_none() => area.first + area.count - number,
            _ => 1,
        };
        // Areas that an operand names are counted from the last.
        let area = u8::try_from(areas.len() - index).unwrap_or(0);
        Some(StoredRun { count, area })
    }

    fn state(&mut self, slot: u16) -> &mut State {
        let layout = *self.layout();
        if slot == 0 || slot > layout.state_count {
            return &mut self.none;
        }
        let offset = layout.states + usize::from(slot - 1) * size_of::<State>();
        // SAFETY: the struct holds `state_count` memories there, and nothing else uses it during a call.
        unsafe { &mut *self.plc.cast::<u8>().add(offset).cast::<State>() }
    }

    fn sys(&self) -> &Sys {
        // SAFETY: the struct holds its `plc_sys` there, which is the same type.
        unsafe { &*self.plc.cast::<u8>().add(self.layout().sys).cast::<Sys>() }
    }

    fn axis(&mut self, output: u32) -> Option<&mut Axis> {
        let layout = *self.layout();
        let outputs = elements(layout.outputs, layout.output_count);
        let i = outputs.iter().position(|&n| u32::from(n) == output)?;
        let offset = layout.axes + i * size_of::<Axis>();
        // SAFETY: the struct holds `output_count` outputs there, and nothing else uses it during a call.
        Some(unsafe { &mut *self.plc.cast::<u8>().add(offset).cast::<Axis>() })
    }

    fn port(&mut self, number: u8) -> Option<PortMut<'_>> {
        let layout = *self.layout();
        let mut places = elements(layout.ports, layout.port_count).iter();
        let place = places.find(|place| place.number == number)?;
        // SAFETY: the layout says so, and nothing else uses the struct during a call.
        Some(unsafe { place.port(self.plc.cast()) })
    }

    fn codecs(&self) -> &'static [&'static Codec] {
        let layout = self.layout();
        if layout.codecs.is_null() {
            return &[];
        }
        // SAFETY: a layout names codecs of the library, of which none is NULL and which are there as long as the
        // program runs.
        unsafe { core::slice::from_raw_parts(layout.codecs.cast(), layout.codec_count) }
    }

    fn port_wiring(&self, index: usize) -> Option<&'static PortWiring> {
        let layout = self.layout();
        let place = elements(layout.ports, layout.port_count).get(index)?;
        // SAFETY: NULL, or one of the library's.
        unsafe { place.wiring.as_ref() }
    }

    fn modbus(&self) -> &'static Profile {
        // SAFETY: NULL, or one of the library's.
        unsafe { self.layout().modbus.as_ref() }.unwrap_or(&modbus::NOTHING)
    }

    fn ports(&self) -> Ports {
        self.layout().port_family
    }

    fn type_code(&self) -> u16 {
        self.layout().type_code
    }

    fn pulses(&self) -> Pulses {
        self.layout().pulses
    }

    fn text(&self, index: u32) -> &[u8] {
        let layout = self.layout();
        let texts = elements(layout.texts, layout.text_count);
        texts
            .get(index as usize)
            .map_or(&[], |text| elements(text.bytes, text.length))
    }

    fn z_pairs_with_v(&self) -> bool {
        self.layout().z_pairs_with_v
    }

    fn error_relay(&self) -> u32 {
        self.layout().error_relay.into()
    }

    fn value_error(&self) -> u16 {
        self.layout().value_error
    }

    fn error_rules(&self) -> ErrorRules {
        let layout = self.layout();
        ErrorRules {
            sums_up_ports: layout.sums_up_ports,
            logs: layout.logs_errors,
        }
    }

    fn note_error(&mut self, code: u16, step: u32) {
        let offset = self.layout().error;
        if offset > 0 {
            // SAFETY: the struct holds its `plc_error` there, which begins with the code and the step.
            let at = unsafe { self.plc.cast::<u8>().add(offset) };
            let _ = change(at, |error: &mut [u16; 2]| *error = [code, step as u16]);
        }
        let offset = self.layout().on_error;
        if offset > 0 {
            // SAFETY: the struct holds a pointer to such a function there, or NULL.
            let on_error = unsafe {
                self.plc
                    .cast::<u8>()
                    .add(offset)
                    .cast::<Option<OnError>>()
                    .read()
            };
            if let Some(on_error) = on_error {
                on_error(self.plc, code, step as u16);
            }
        }
    }

    fn reset(&mut self, class: Class, number: u32) -> Option<()> {
        match self.find(class, number) {
            Found::At(Kind::Timers, at) => change(at, Timer::reset),
            Found::At(Kind::Counters16, at) => change(at, Counter16::reset),
            Found::At(Kind::Counters32, at) => change(at, Counter32::reset),
            Found::Elsewhere if matches!(class, Class::T | Class::C) => Some(()),
            _ => None,
        }
    }
}

/// Returns true if devices of a class have a state.
fn is_bit(class: Class) -> bool {
    matches!(
        class,
        Class::X | Class::Y | Class::M | Class::S | Class::T | Class::C
    )
}

/// Returns true if a device has a 16-bit value.
fn is_word(class: Class, number: u32) -> bool {
    match class {
        Class::C => number < FIRST_COUNTER32,
        Class::X | Class::Y | Class::M | Class::S => false,
        _ => true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::capi::Range;
    use core::ffi::c_void;
    use core::sync::atomic::{AtomicU32, Ordering};

    /// Two areas, of words and of relays.
    #[repr(C)]
    struct Devices {
        m10: [bool; 3],
        d20: [i16; 3],
        on_error: Option<OnError>,
    }

    /// The last error that was reported: its code and, above it, its step.
    static REPORTED: AtomicU32 = AtomicU32::new(0);

    extern "C" fn note(_: *const c_void, code: u16, step: u16) {
        REPORTED.store(u32::from(code) | u32::from(step) << 16, Ordering::Relaxed);
    }

    fn area(class: Class, kind: Kind, first: u32, offset: usize) -> Area {
        Area {
            class,
            kind,
            first,
            count: 3,
            columns: 1,
            stored_columns: 1,
            offset,
        }
    }

    #[test]
    fn a_device_is_found_whatever_area_the_operand_names() {
        let areas = [
            area(Class::M, Kind::Bits, 10, offset_of!(Devices, m10)),
            area(Class::D, Kind::Words, 20, offset_of!(Devices, d20)),
        ];
        let ranges = [Range {
            class: Class::D,
            first: 0,
            last: 30,
        }];
        let layout = Layout {
            areas: areas.as_ptr(),
            area_count: areas.len(),
            ranges: ranges.as_ptr(),
            range_count: ranges.len(),
            on_error: offset_of!(Devices, on_error),
            // SAFETY: everything else of a layout may be zero: null pointers of no elements, offsets, numbers.
            ..unsafe { core::mem::zeroed() }
        };
        let mut devices = Devices {
            m10: [false, true, false],
            d20: [5, 6, 7],
            on_error: Some(note),
        };
        let mut map = Map {
            layout: &layout,
            plc: (&raw mut devices).cast(),
            hal: core::ptr::null(),
            none: State::new(),
        };
        for named in [0, 1, 2, 3, 255] {
            assert_eq!(map.word_in(named, Class::D, 22), Some(7), "{named}");
            assert_eq!(map.word_in(named, Class::D, 23), Some(0), "not stored");
            assert_eq!(map.word_in(named, Class::D, 31), None, "not of the model");
            assert_eq!(map.bit_in(named, Class::M, 11), Some(true), "{named}");
            assert_eq!(map.set_word_in(named, Class::D, 20, named.into()), Some(()));
            assert_eq!(map.word(Class::D, 20), Some(named.into()));
            assert_eq!(
                map.set_bit_in(named, Class::M, 12, named % 2 == 0),
                Some(())
            );
            assert_eq!(map.bit(Class::M, 12), Some(named % 2 == 0));
        }
        let stored = |class, number| map.stored_run(class, number);
        assert_eq!(
            stored(Class::D, 21),
            Some(StoredRun { count: 2, area: 1 }),
            "the last area is 1"
        );
        assert_eq!(stored(Class::M, 10), Some(StoredRun { count: 3, area: 2 }));
        assert_eq!(stored(Class::D, 23), None);
        map.note_error(6706, 12);
        assert_eq!(REPORTED.load(Ordering::Relaxed), 6706 | 12 << 16);
    }
}
