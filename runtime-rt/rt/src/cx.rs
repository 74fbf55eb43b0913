//! The call context: operands, devices and hardware in the terms in which manuals describe instructions.

use crate::comm::{PortWiring, note_missing};
use crate::fault::{Done, Fault, report};
use crate::hal::Hal;
use crate::operand::{Operand, OperandKind};
use crate::plc::{Class, Plc, Site, State};
use crate::runs::{FIRST_COUNTER32, FIRST_SPECIAL};
use crate::special::{Register, Relay};
use crate::word;
use core::cell::RefCell;

/// Context of an instruction call. Operands are named by position, from 0; offsets count devices from the named one.
pub struct Cx<'a> {
    /// The devices.
    pub plc: &'a mut dyn Plc,
    /// The hardware. Buffer memory is read as any other operand is, by shared reference.
    pub hal: RefCell<&'a mut dyn Hal>,
    /// The operands in order.
    pub ops: &'a [Operand],
    /// Location of the call, and its form.
    pub site: Site,
}

/// Runs an instruction as emitted Rust does, and reports its fault. The operands come before the PLC so that they may
/// read it.
pub fn call(
    function: fn(&mut Cx) -> Done,
    site: Site,
    ops: &[Operand],
    plc: &mut dyn Plc,
    hal: &mut dyn Hal,
) {
    let done = function(&mut Cx::new(plc, hal, ops, site));
    conclude(done, site, plc);
}

/// Reports the fault of an instruction. One that is not driven only ends what it did: it has none, whatever its
/// operands are.
pub fn conclude(done: Done, site: Site, plc: &mut dyn Plc) {
    if let (Err(fault), true) = (done, site.drive) {
        report(plc, fault, site.step);
    }
}

/// The value of an operand, of the width of the form; `None` after a fault, which is reported.
pub fn fetch(site: Site, from: Operand, plc: &mut dyn Plc, hal: &mut dyn Hal) -> Option<i32> {
    match Cx::new(plc, hal, &[from], site).read(0) {
        Ok(value) => Some(value),
        Err(fault) => {
            report(plc, fault, site.step);
            None
        }
    }
}

/// Writes a value of the width of the form to an operand, or reports a fault.
pub fn send(site: Site, to: Operand, value: i32, plc: &mut dyn Plc, hal: &mut dyn Hal) {
    if let Err(fault) = Cx::new(plc, hal, &[to], site).write(0, value) {
        report(plc, fault, site.step);
    }
}

/// Device number `offset` places after `operand`. Devices together are all general or all special.
#[inline]
fn at(operand: Operand, offset: i32) -> Result<u32, Fault> {
    match u32::try_from(operand.value) {
        // The device that the operand names is the usual one.
        Ok(number) if offset == 0 => Ok(number),
        _ => beyond(operand, offset),
    }
}

/// The same where the device is another one than that of the operand.
fn beyond(operand: Operand, offset: i32) -> Result<u32, Fault> {
    let number = operand
        .value
        .checked_add(offset)
        .and_then(|n| u32::try_from(n).ok())
        .ok_or(Fault::DEVICE)?;
    let special = |n: i64| n >= i64::from(FIRST_SPECIAL);
    let apart = special(operand.value.into()) != special(number.into());
    match operand.class {
        Class::D | Class::M if apart => Err(Fault::DEVICE),
        _ => Ok(number),
    }
}

impl<'a> Cx<'a> {
    /// A context.
    pub fn new(plc: &'a mut dyn Plc, hal: &'a mut dyn Hal, ops: &'a [Operand], site: Site) -> Self {
        Cx {
            plc,
            hal: RefCell::new(hal),
            ops,
            site,
        }
    }

    /// The hardware.
    pub fn hal(&mut self) -> &mut dyn Hal {
        *self.hal.get_mut()
    }

    fn op(&self, i: usize) -> Result<Operand, Fault> {
        self.ops.get(i).copied().ok_or(Fault::DEVICE)
    }

    /// Returns true for the 32-bit form.
    pub fn wide(&self) -> bool {
        self.site.wide
    }

    /// Returns true if the drive contact is on.
    pub fn drive(&self) -> bool {
        self.site.drive
    }

    /// Keeps the drive in word `word` of the private memory, and returns what was kept there: whether the last scan
    /// drove the instruction.
    pub fn was_driven(&mut self, word: usize) -> bool {
        let drive = self.drive();
        match self.state().0.get_mut(word) {
            Some(kept) => core::mem::replace(kept, drive.into()) != 0,
            None => false,
        }
    }

    /// Milliseconds since the previous scan began.
    pub fn dt_ms(&self) -> i32 {
        i32::try_from(self.plc.sys().dt_ms).unwrap_or(i32::MAX)
    }

    /// Milliseconds since the previous scan began; 0 if the instruction has already run in this scan: time passes
    /// between scans, however often a loop or its routine executes it. The last word of the private memory keeps the
    /// scan.
    pub fn elapsed_ms(&mut self) -> i32 {
        let scan = i32::from(self.plc.sys().scan);
        let before = self.state().0.last_mut();
        match before.map(|before| core::mem::replace(before, scan)) {
            Some(before) if before == scan => 0,
            _ => self.dt_ms(),
        }
    }

    /// Milliseconds since the instruction was last executed, as [`Cx::elapsed_ms`], but the period of a timer interrupt
    /// in its routine: h1u-h2u-programming §4.3.9 recommends it for PID that has to be faster than the scan.
    pub fn sampled_ms(&mut self) -> i32 {
        match self.site.period_ms {
            0 => self.elapsed_ms(),
            period => period.into(),
        }
    }

    /// The instruction's private memory.
    pub fn state(&mut self) -> &mut State {
        self.plc.state(self.site.slot)
    }

    /// Operand `i` as a signed value: 16 bits, or 32 in the 32-bit form. Groups are zero-extended; a group of full
    /// width is signed.
    pub fn read(&self, i: usize) -> Result<i32, Fault> {
        if self.site.wide {
            self.dword(i, 0)
        } else {
            self.word(i, 0).map(i32::from)
        }
    }

    /// Writes operand `i`: the low 16 bits, or all 32 in the 32-bit form. A group takes as many low bits as it has.
    pub fn write(&mut self, i: usize, value: i32) -> Result<(), Fault> {
        if self.site.wide {
            self.set_dword(i, 0, value)
        } else {
            self.set_word(i, 0, value as i16)
        }
    }

    /// Word number `offset` from operand `i`. For a group, element `offset` begins `4 * digits * offset` bits further
    /// on.
    pub fn word(&self, i: usize, offset: i32) -> Result<i16, Fault> {
        let op = self.op(i)?;
        match op.kind {
            OperandKind::Device => self.load(op, at(op, offset)?),
            _ => self.word_elsewhere(op, offset),
        }
    }

    /// A word of an operand that is not a device.
    fn word_elsewhere(&self, op: Operand, offset: i32) -> Result<i16, Fault> {
        match op.kind {
            OperandKind::Const | OperandKind::Float => Ok(op.value as i16),
            OperandKind::Nibbles => self.group(op, offset, 4).map(|v| v as i16),
            OperandKind::Buffer => self.buffer(op, offset),
            OperandKind::Device | OperandKind::WordBit | OperandKind::Text => Err(Fault::DEVICE),
        }
    }

    /// Writes word number `offset` from operand `i`.
    pub fn set_word(&mut self, i: usize, offset: i32, value: i16) -> Result<(), Fault> {
        let op = self.op(i)?;
        match op.kind {
            OperandKind::Device => self.store(op, at(op, offset)?, value),
            OperandKind::Nibbles => self.set_group(op, offset, 4, i32::from(value)),
            OperandKind::Buffer => self.set_buffer(op, offset, value),
            _ => Err(Fault::DEVICE),
        }
    }

    /// The `N` words from operand `i` on, all of which have to exist. It takes less time than reading them one by one.
    pub fn words<const N: usize>(&self, i: usize) -> Result<[i16; N], Fault> {
        let op = self.op(i)?;
        let mut words = [0; N];
        match Self::run(op, 0, N) {
            Some(first) => {
                let read = self.plc.words_in(op.area, op.class, first?, &mut words);
                read.ok_or(Fault::DEVICE)?;
            }
            None => {
                for (offset, word) in (0..).zip(&mut words) {
                    *word = self.word(i, offset)?;
                }
            }
        }
        Ok(words)
    }

    /// Writes the words from number `offset` from operand `i` on.
    pub fn set_words(&mut self, i: usize, offset: i32, words: &[i16]) -> Done {
        let op = self.op(i)?;
        match Self::run(op, offset, words.len()) {
            Some(first) => {
                let written = self.plc.set_words_in(op.area, op.class, first?, words);
                written.ok_or(Fault::DEVICE)
            }
            None => (offset..)
                .zip(words)
                .try_for_each(|(offset, word)| self.set_word(i, offset, *word)),
        }
    }

    /// The first of `count` devices from number `offset` from an operand on, if they are words of one kind.
    fn run(op: Operand, offset: i32, count: usize) -> Option<Result<u32, Fault>> {
        if op.kind != OperandKind::Device || op.class == Class::C {
            return None;
        }
        let last = i32::try_from(count).map_or(i32::MAX, |count| offset.saturating_add(count - 1));
        Some(at(op, last).and_then(|_| at(op, offset)))
    }

    /// The word of device `n`, which an operand's devices include. A 32-bit counter is not a word.
    fn load(&self, op: Operand, n: u32) -> Result<i16, Fault> {
        match op.class {
            Class::C if n >= FIRST_COUNTER32 => Err(Fault::DEVICE),
            _ => self.plc.word_in(op.area, op.class, n).ok_or(Fault::DEVICE),
        }
    }

    /// Writes it.
    fn store(&mut self, op: Operand, n: u32, value: i16) -> Done {
        match op.class {
            Class::C if n >= FIRST_COUNTER32 => Err(Fault::DEVICE),
            _ => {
                let done = self.plc.set_word_in(op.area, op.class, n, value);
                done.ok_or(Fault::DEVICE)
            }
        }
    }

    /// The 32-bit value whose low word is word number `offset` from operand `i`: the pair (n+1, n), a 32-bit counter,
    /// the pair (Vn, Zn), or a group of up to 32 bits.
    pub fn dword(&self, i: usize, offset: i32) -> Result<i32, Fault> {
        let op = self.op(i)?;
        match op.kind {
            OperandKind::Const | OperandKind::Float => Ok(op.value),
            OperandKind::Nibbles => self.group(op, offset, 8),
            OperandKind::Buffer => {
                let low = self.buffer(op, offset)?;
                Ok(word::pair(low, self.buffer(op, offset.saturating_add(1))?))
            }
            OperandKind::Device => {
                let n = at(op, offset)?;
                if op.class == Class::C && n >= FIRST_COUNTER32 {
                    return self.plc.counter32(n).ok_or(Fault::DEVICE);
                }
                let (class, high) = self.high_word(op, offset)?;
                let low = self
                    .plc
                    .word_in(op.area, op.class, n)
                    .ok_or(Fault::DEVICE)?;
                let high = self
                    .plc
                    .word_in(op.area, class, high)
                    .ok_or(Fault::DEVICE)?;
                Ok(i32::from(high) << 16 | i32::from(low as u16))
            }
            OperandKind::WordBit | OperandKind::Text => Err(Fault::DEVICE),
        }
    }

    /// Writes the 32-bit value whose low word is word number `offset` from operand `i`. Writes nothing if it does not
    /// fit whole.
    pub fn set_dword(&mut self, i: usize, offset: i32, value: i32) -> Result<(), Fault> {
        let op = self.op(i)?;
        match op.kind {
            OperandKind::Nibbles => self.set_group(op, offset, 8, value),
            OperandKind::Buffer => {
                let next = offset.saturating_add(1);
                self.buffer(op, next)?;
                let [low, high] = word::words(value);
                self.set_buffer(op, offset, low)?;
                self.set_buffer(op, next, high)
            }
            OperandKind::Device => {
                let n = at(op, offset)?;
                if op.class == Class::C && n >= FIRST_COUNTER32 {
                    return self.plc.set_counter32(n, value).ok_or(Fault::DEVICE);
                }
                let (class, high) = self.high_word(op, offset)?;
                self.plc
                    .word_in(op.area, class, high)
                    .ok_or(Fault::DEVICE)?;
                self.plc
                    .set_word_in(op.area, op.class, n, value as i16)
                    .ok_or(Fault::DEVICE)?;
                self.plc
                    .set_word_in(op.area, class, high, (value >> 16) as i16)
                    .ok_or(Fault::DEVICE)
            }
            _ => Err(Fault::DEVICE),
        }
    }

    /// The device that holds the high word of a pair.
    fn high_word(&self, op: Operand, offset: i32) -> Result<(Class, u32), Fault> {
        if op.class == Class::Z && self.plc.z_pairs_with_v() {
            Ok((Class::V, at(op, offset)?))
        } else {
            Ok((op.class, at(op, offset.saturating_add(1))?))
        }
    }

    /// Float whose pair begins `offset` words from operand `i`. An integer constant is converted.
    pub fn float(&self, i: usize, offset: i32) -> Result<f32, Fault> {
        let op = self.op(i)?;
        match op.kind {
            OperandKind::Const => Ok(op.value as f32),
            _ => self
                .dword(i, offset)
                .map(|bits| f32::from_bits(bits as u32)),
        }
    }

    /// Bits of the float at operand `i`, every one of them kept. An integer constant is converted.
    pub fn float_bits(&self, i: usize) -> Result<i32, Fault> {
        let op = self.op(i)?;
        match op.kind {
            OperandKind::Const => Ok((op.value as f32).to_bits() as i32),
            _ => self.dword(i, 0),
        }
    }

    /// Clears word, timer or counter number `offset` from operand `i`.
    pub fn reset(&mut self, i: usize, offset: i32) -> Done {
        let op = self.op(i)?;
        match op.class {
            Class::T | Class::C if op.kind == OperandKind::Device => self
                .plc
                .reset(op.class, at(op, offset)?)
                .ok_or(Fault::DEVICE),
            _ => self.set_word(i, offset, 0),
        }
    }

    /// Returns true if operand `i` is a constant.
    pub fn is_constant(&self, i: usize) -> bool {
        self.op(i).is_ok_and(|op| op.kind == OperandKind::Const)
    }

    /// Byte number `n` from operand `i`: two a word, the low one first, or one a word in its low byte.
    pub fn byte(&self, i: usize, n: i32, one_a_word: bool) -> Result<u8, Fault> {
        if one_a_word {
            return self.word(i, n).map(|w| w as u8);
        }
        let [low, high] = self.word(i, n / 2)?.to_le_bytes();
        Ok(if n % 2 == 0 { low } else { high })
    }

    /// Writes byte number `n` from operand `i`; one a word clears the high byte.
    pub fn set_byte(&mut self, i: usize, n: i32, one_a_word: bool, byte: u8) -> Done {
        if one_a_word {
            return self.set_word(i, n, byte.into());
        }
        let [low, high] = self.word(i, n / 2)?.to_le_bytes();
        let word = if n % 2 == 0 {
            [byte, high]
        } else {
            [low, byte]
        };
        self.set_word(i, n / 2, i16::from_le_bytes(word))
    }

    /// Faults unless the words of the `count` bytes from operand `i` on exist.
    pub fn check_bytes(&self, i: usize, count: i32, one_a_word: bool) -> Done {
        self.check_words(i, if one_a_word { count } else { (count + 1) / 2 })
    }

    /// Writes a float.
    pub fn set_float(&mut self, i: usize, offset: i32, value: f32) -> Result<(), Fault> {
        self.set_dword(i, offset, value.to_bits() as i32)
    }

    /// Word and mask of bit number `offset` from the bit of a word that `op` names; continues into the next words.
    fn word_bit(op: Operand, offset: i32) -> Result<(u32, u16), Fault> {
        let bit = offset
            .checked_add(i32::from(op.digits))
            .ok_or(Fault::DEVICE)?;
        Ok((at(op, bit.div_euclid(16))?, 1 << bit.rem_euclid(16)))
    }

    /// Bit number `offset` from operand `i`.
    pub fn bit(&self, i: usize, offset: i32) -> Result<bool, Fault> {
        let op = self.op(i)?;
        match op.kind {
            OperandKind::WordBit => {
                let (n, mask) = Self::word_bit(op, offset)?;
                let word = self
                    .plc
                    .word_in(op.area, op.class, n)
                    .ok_or(Fault::DEVICE)?;
                Ok(word as u16 & mask != 0)
            }
            _ => self
                .plc
                .bit_in(op.area, op.class, at(op, offset)?)
                .ok_or(Fault::DEVICE),
        }
    }

    /// Sets bit number `offset` from operand `i`.
    pub fn set_bit(&mut self, i: usize, offset: i32, value: bool) -> Result<(), Fault> {
        let op = self.op(i)?;
        match op.kind {
            OperandKind::WordBit => {
                let (n, mask) = Self::word_bit(op, offset)?;
                let word = self
                    .plc
                    .word_in(op.area, op.class, n)
                    .ok_or(Fault::DEVICE)? as u16;
                let word = if value { word | mask } else { word & !mask };
                self.plc
                    .set_word_in(op.area, op.class, n, word as i16)
                    .ok_or(Fault::DEVICE)
            }
            _ => self
                .plc
                .set_bit_in(op.area, op.class, at(op, offset)?, value)
                .ok_or(Fault::DEVICE),
        }
    }

    /// Low `count` (at most 32) of the bits from operand `i` on, as a number.
    pub fn bits(&self, i: usize, offset: i32, count: i32) -> Result<u32, Fault> {
        let mut value = 0;
        for n in 0..count.min(32) {
            value |= u32::from(self.bit(i, offset.saturating_add(n))?) << n;
        }
        Ok(value)
    }

    /// Sets `count` bits (at most 32) from operand `i` on to a number.
    pub fn set_bits(&mut self, i: usize, offset: i32, count: i32, value: u32) -> Result<(), Fault> {
        for n in 0..count.min(32) {
            self.set_bit(i, offset.saturating_add(n), value >> n & 1 == 1)?;
        }
        Ok(())
    }

    /// Returns true if operand `i` names a bit (X, Y, M, S or a bit of a word) rather than a word.
    pub fn is_bit(&self, i: usize) -> bool {
        self.op(i).is_ok_and(|op| match op.kind {
            OperandKind::Device => matches!(op.class, Class::X | Class::Y | Class::M | Class::S),
            OperandKind::WordBit => true,
            _ => false,
        })
    }

    /// Returns true if operand `i` is a group of less than sixteen bits.
    pub fn is_short_group(&self, i: usize) -> bool {
        let op = self.op(i);
        op.is_ok_and(|op| op.kind == OperandKind::Nibbles && op.digits < 4)
    }

    /// Returns true if operand `i` is numbered in octal: X or Y.
    pub fn is_octal(&self, i: usize) -> bool {
        self.op(i)
            .is_ok_and(|op| matches!(op.class, Class::X | Class::Y))
    }

    /// Faults unless the `count` bits from operand `i` on exist.
    pub fn check_bits(&self, i: usize, count: i32) -> Done {
        (0..count).try_for_each(|n| self.bit(i, n).map(drop))
    }

    /// Faults unless the `count` words from operand `i` on exist.
    pub fn check_words(&self, i: usize, count: i32) -> Done {
        (0..count).try_for_each(|n| self.word(i, n).map(drop))
    }

    /// Faults unless the `count` words, timers and counters from operand `i` on exist.
    pub fn check_resets(&self, i: usize, count: i32) -> Done {
        let op = self.op(i)?;
        (0..count).try_for_each(|n| match op.class {
            Class::C if at(op, n)? >= FIRST_COUNTER32 => self.dword(i, n).map(drop),
            _ => self.word(i, n).map(drop),
        })
    }

    /// Faults unless the `count` elements from operand `i` on exist: words, or pairs in the 32-bit form.
    pub fn check_elems(&self, i: usize, count: i32) -> Done {
        (0..count).try_for_each(|n| self.elem(i, n).map(drop))
    }

    /// Offset of element `n` of the table at operand `i`: two words an element in the 32-bit form, but for 32-bit
    /// counters and groups.
    fn elem_offset(&self, i: usize, n: i32) -> Result<i32, Fault> {
        let op = self.op(i)?;
        let pairs = match op.kind {
            OperandKind::Device => !(op.class == Class::C && op.value >= FIRST_COUNTER32 as i32),
            kind => kind == OperandKind::Buffer,
        };
        Ok(if self.site.wide && pairs {
            n.saturating_mul(2)
        } else {
            n
        })
    }

    /// Element `n` of the table at operand `i`: a word, or a pair in the 32-bit form. Every element of a constant is
    /// the constant.
    pub fn elem(&self, i: usize, n: i32) -> Result<i32, Fault> {
        let offset = self.elem_offset(i, n)?;
        if self.site.wide {
            self.dword(i, offset)
        } else {
            self.word(i, offset).map(i32::from)
        }
    }

    /// Writes element `n` of the table at operand `i`.
    pub fn set_elem(&mut self, i: usize, n: i32, value: i32) -> Result<(), Fault> {
        let offset = self.elem_offset(i, n)?;
        if self.site.wide {
            self.set_dword(i, offset, value)
        } else {
            self.set_word(i, offset, value as i16)
        }
    }

    /// Operand `i` (as wide as the form) as a count or mode; faults unless it lies in `range`.
    pub fn count(&self, i: usize, range: core::ops::RangeInclusive<i32>) -> Result<i32, Fault> {
        let n = self.read(i)?;
        if range.contains(&n) {
            Ok(n)
        } else {
            Err(Fault::VALUE)
        }
    }

    /// Width of the form in bits: 16 or 32.
    pub fn width(&self) -> u32 {
        if self.site.wide { 32 } else { 16 }
    }

    /// Operand `i` without its sign: the low 16 bits, or all 32.
    pub fn read_unsigned(&self, i: usize) -> Result<u32, Fault> {
        self.read(i).map(|value| match self.site.wide {
            true => value as u32,
            false => u32::from(value as u16),
        })
    }

    /// Returns true if operand `b` starts after operand `a` in the same class, so that a block copied from `a` to `b`
    /// must be copied from its end.
    pub fn begins_behind(&self, a: usize, b: usize) -> bool {
        matches!((self.op(a), self.op(b)), (Ok(a), Ok(b))
            if (a.kind, a.class) == (b.kind, b.class) && b.value > a.value
                && (a.kind != OperandKind::Buffer || a.digits == b.digits))
    }

    /// State of a special relay.
    pub fn special(&self, relay: Relay) -> bool {
        self.plc.bit(Class::M, relay.number()).unwrap_or(false)
    }

    /// Sets a special relay, if the program looks at it.
    pub fn set_special(&mut self, relay: Relay, value: bool) {
        let _ = self.plc.set_bit(Class::M, relay.number(), value);
    }

    /// Value of a special register.
    pub fn special_word(&self, register: Register) -> i16 {
        self.plc.word(Class::D, register.number()).unwrap_or(0)
    }

    /// Enters an error in the log.
    pub(crate) fn log_error(&mut self, code: u16) {
        crate::log_error(self.plc, code);
    }

    /// Sets a special register, if the program looks at it.
    pub fn set_special_word(&mut self, register: Register, value: i16) {
        let _ = self.plc.set_word(Class::D, register.number(), value);
    }

    /// The serial port that operand `i` names; one that the program does not have is an error of communication.
    pub fn named_port(&mut self, i: usize) -> Result<Option<u8>, Fault> {
        let number = self.read(i)?;
        let named = self.plc.ports().named(number);
        let named = named.filter(|&number| self.plc.port(number).is_some());
        if named.is_none() {
            note_missing(self.plc);
        }
        Ok(named)
    }

    /// Shows in the program's special devices that a serial port runs another protocol than an instruction needs.
    pub fn note_other_protocol(&mut self, number: u8) {
        let protocol = match self.plc.port(number) {
            Some(port) => port.status.protocol,
            None => return,
        };
        if let Some(wiring) = PortWiring::of(self.plc, number) {
            wiring.note_other_protocol(self.plc, protocol);
        }
    }

    /// Module and address of word number `offset` after the one that `op` names.
    fn buffer_place(op: Operand, offset: i32) -> Result<(u16, u16), Fault> {
        let address = op.value.checked_add(offset);
        let address = address.and_then(|address| u16::try_from(address).ok());
        Ok((op.digits.into(), address.ok_or(Fault::MODULE)?))
    }

    /// A word of the buffer memory of a module.
    fn buffer(&self, op: Operand, offset: i32) -> Result<i16, Fault> {
        let (module, address) = Self::buffer_place(op, offset)?;
        let hal = self.hal.try_borrow_mut().ok();
        hal.and_then(|mut hal| hal.read_bfm(module, address))
            .ok_or(Fault::MODULE)
    }

    /// Writes one.
    fn set_buffer(&mut self, op: Operand, offset: i32, value: i16) -> Done {
        let (module, address) = Self::buffer_place(op, offset)?;
        self.hal()
            .write_bfm(module, address, value)
            .ok_or(Fault::MODULE)
    }

    /// Element `offset` of a group, at most `max` digits of it.
    fn group(&self, op: Operand, offset: i32, max: u8) -> Result<i32, Fault> {
        let first = at(op, offset.saturating_mul(4 * i32::from(op.digits)))?;
        let mut value = 0u32;
        for bit in 0..4 * u32::from(op.digits.min(max)) {
            let on = self
                .plc
                .bit_in(op.area, op.class, first + bit)
                .ok_or(Fault::DEVICE)?;
            value |= u32::from(on) << bit;
        }
        Ok(value as i32)
    }

    /// Writes element `offset` of a group; all of its bits must exist.
    fn set_group(&mut self, op: Operand, offset: i32, max: u8, value: i32) -> Result<(), Fault> {
        let first = at(op, offset.saturating_mul(4 * i32::from(op.digits)))?;
        let bits = 4 * u32::from(op.digits.min(max));
        self.plc
            .bit_in(op.area, op.class, first + bits.saturating_sub(1))
            .ok_or(Fault::DEVICE)?;
        for bit in 0..bits {
            self.plc
                .set_bit_in(op.area, op.class, first + bit, value >> bit & 1 == 1)
                .ok_or(Fault::DEVICE)?;
        }
        Ok(())
    }
}
