//! How a [`Map`] finds devices, and what else instructions ask of a program.

use super::hal::Board;
use super::{Area, Kind, Layout, Map};
use crate::axis::Axis;
use crate::comm::codec::Codec;
use crate::comm::model::PortModel;
use crate::comm::{PortMut, Ports};
use crate::cx::Cx;
use crate::fault::{Done, report};
use crate::operand::Operand;
use crate::plc::{Class, Plc, Site, State, Sys};
use crate::runs::FIRST_COUNTER32;
use crate::timing::{Counter16, Counter32, Timer};
use crate::wiring::Pulses;

/// Where a device is.
enum Found {
    /// Stored there.
    At(Kind, *mut u8),
    /// The model has it; the program does not look at it.
    Elsewhere,
    /// The model has no such device.
    Nowhere,
}

/// The elements that a pointer of a [`Layout`] stands for.
fn elements<'a, T>(first: *const T, count: usize) -> &'a [T] {
    if first.is_null() {
        return &[];
    }
    // SAFETY: a Layout's pointers are valid for their counts and as long as the program runs, and nothing writes to them.
    unsafe { core::slice::from_raw_parts(first, count) }
}

impl Area {
    /// Which of its devices one is in memory, if it holds it.
    fn place_of(&self, class: Class, number: u32) -> Option<u32> {
        let n = number.wrapping_sub(self.first);
        if self.class != class || n >= self.count {
            return None;
        }
        // Most have no columns, and a division takes longer than all else here.
        if self.columns <= 1 {
            return Some(n);
        }
        let (row, column) = (n / self.columns, n % self.columns);
        let rows = self.count.div_ceil(self.columns);
        (column < self.kept).then_some(column * rows + row)
    }
}

impl Map {
    fn layout(&self) -> &Layout {
        // SAFETY: whoever makes a Map gives it a valid layout that outlives it.
        unsafe { &*self.layout }
    }

    fn find(&self, class: Class, number: u32) -> Found {
        let layout = self.layout();
        let areas = elements(layout.areas, layout.area_count);
        let after = areas.partition_point(|a| (a.class, a.first) <= (class, number));
        let area = after.checked_sub(1).and_then(|i| areas.get(i));
        if let Some((area, place)) = area.and_then(|a| Some((a, a.place_of(class, number)?))) {
            let size = match area.kind {
                Kind::Bits => size_of::<bool>(),
                Kind::Words => size_of::<i16>(),
                Kind::Timers => size_of::<Timer>(),
                Kind::Counters16 => size_of::<Counter16>(),
                Kind::Counters32 => size_of::<Counter32>(),
            };
            let offset = area.offset + place as usize * size;
            // SAFETY: an area's elements lie inside the program's struct, which `plc` points to.
            return Found::At(area.kind, unsafe { self.plc.cast::<u8>().add(offset) });
        }
        if class == Class::D {
            let aliases = elements(layout.aliases, layout.alias_count);
            if let Some(alias) = aliases
                .iter()
                .find(|a| a.number == number && a.class != Class::D)
            {
                return self.find(alias.class, alias.index);
            }
        }
        let ranges = elements(layout.ranges, layout.range_count);
        let after = ranges.partition_point(|r| (r.class, r.first) <= (class, number));
        let range = after.checked_sub(1).and_then(|i| ranges.get(i));
        match range.filter(|r| r.class == class && number <= r.last) {
            Some(_) => Found::Elsewhere,
            None => Found::Nowhere,
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
        if let Err(fault) = done {
            report(self, fault, site.step);
        }
    }
}

/// Reads an element of the program's struct.
fn read<T: Copy>(at: *mut u8) -> T {
    // SAFETY: `find` gives a pointer to an element of the kind that the caller reads, aligned as the C compiler placed it.
    unsafe { at.cast::<T>().read() }
}

/// Changes an element of the program's struct.
fn change<T>(at: *mut u8, change: impl FnOnce(&mut T)) -> Option<()> {
    // SAFETY: as for `read`; nothing else uses the struct during a call.
    change(unsafe { &mut *at.cast::<T>() });
    Some(())
}

impl Plc for Map {
    fn bit(&self, class: Class, number: u32) -> Option<bool> {
        match self.find(class, number) {
            Found::At(Kind::Bits, at) => Some(read(at)),
            Found::At(Kind::Timers, at) => Some(read::<Timer>(at).done),
            Found::At(Kind::Counters16, at) => Some(read::<Counter16>(at).done),
            Found::At(Kind::Counters32, at) => Some(read::<Counter32>(at).done),
            Found::Elsewhere if is_bit(class) => Some(false),
            _ => None,
        }
    }

    fn set_bit(&mut self, class: Class, number: u32, value: bool) -> Option<()> {
        match self.find(class, number) {
            Found::At(Kind::Bits, at) => change(at, |bit| *bit = value),
            Found::At(Kind::Timers, at) => change(at, |timer: &mut Timer| timer.done = value),
            Found::At(Kind::Counters16, at) => {
                change(at, |counter: &mut Counter16| counter.done = value)
            }
            Found::At(Kind::Counters32, at) => {
                change(at, |counter: &mut Counter32| counter.done = value)
            }
            Found::Elsewhere if is_bit(class) => Some(()),
            _ => None,
        }
    }

    fn word(&self, class: Class, number: u32) -> Option<i16> {
        match self.find(class, number) {
            Found::At(Kind::Words, at) => Some(read(at)),
            Found::At(Kind::Timers, at) => Some(read::<Timer>(at).value),
            Found::At(Kind::Counters16, at) => Some(read::<Counter16>(at).value),
            Found::Elsewhere if is_word(class, number) => Some(0),
            _ => None,
        }
    }

    fn set_word(&mut self, class: Class, number: u32, value: i16) -> Option<()> {
        match self.find(class, number) {
            Found::At(Kind::Words, at) => change(at, |word| *word = value),
            Found::At(Kind::Timers, at) => change(at, |timer: &mut Timer| timer.value = value),
            Found::At(Kind::Counters16, at) => {
                change(at, |counter: &mut Counter16| counter.value = value)
            }
            Found::Elsewhere if is_word(class, number) => Some(()),
            _ => None,
        }
    }

    fn counter32(&self, number: u32) -> Option<i32> {
        match self.find(Class::C, number) {
            Found::At(Kind::Counters32, at) => Some(read::<Counter32>(at).value),
            Found::Elsewhere if number >= FIRST_COUNTER32 => Some(0),
            _ => None,
        }
    }

    fn set_counter32(&mut self, number: u32, value: i32) -> Option<()> {
        match self.find(Class::C, number) {
            Found::At(Kind::Counters32, at) => {
                change(at, |counter: &mut Counter32| counter.value = value)
            }
            Found::Elsewhere if number >= FIRST_COUNTER32 => Some(()),
            _ => None,
        }
    }

    fn stores(&self, class: Class, number: u32) -> bool {
        matches!(self.find(class, number), Found::At(..))
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
        // SAFETY: a layout names codecs of the library, of which none is NULL and which are there as long as the program runs.
        unsafe { core::slice::from_raw_parts(layout.codecs.cast(), layout.codec_count) }
    }

    fn port_model(&self) -> Option<&'static PortModel> {
        // SAFETY: NULL, or one of the library's.
        unsafe { self.layout().port_model.as_ref() }
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

    fn note_error(&mut self, code: u16, step: u32) {
        let offset = self.layout().error;
        if offset > 0 {
            // SAFETY: the struct holds its `plc_error` there, which begins with the code and the step.
            let at = unsafe { self.plc.cast::<u8>().add(offset) };
            let _ = change(at, |error: &mut [u16; 2]| *error = [code, step as u16]);
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

/// Whether devices of a class have a state.
fn is_bit(class: Class) -> bool {
    matches!(
        class,
        Class::X | Class::Y | Class::M | Class::S | Class::T | Class::C
    )
}

/// Whether a device has a 16-bit value.
fn is_word(class: Class, number: u32) -> bool {
    match class {
        Class::C => number < FIRST_COUNTER32,
        Class::X | Class::Y | Class::M | Class::S => false,
        _ => true,
    }
}
