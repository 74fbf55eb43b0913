//! A special module at work.

use super::{Access, Bfm, Curve, Kind, Quantity, Range, Role, Signal, Start};

/// Words of buffer memory that a module may have: more than any kind has.
const WORDS: usize = 64;

/// Inputs that a module may have, and outputs.
const CHANNELS: usize = 4;

/// Bits of error words: any error, a value out of range, a number of samples out of range, settings locked.
const RANGE_ERROR: i16 = 1 << 10;
const SAMPLES_ERROR: i16 = 1 << 11;
const LOCKED: i16 = 1 << 12;

/// An input.
#[derive(Clone, Copy, Debug)]
struct Input {
    signal: Option<Signal>,
    /// Offset and gain that the program has given it.
    curve: Option<Curve>,
    sum: i32,
    samples: i16,
    /// Whether the last sample was out of range.
    is_out: bool,
}

/// An output.
#[derive(Clone, Copy, Debug)]
struct Output {
    digital: i32,
    curve: Option<Curve>,
    is_out: bool,
}

/// A special module: its buffer memory and its channels.
///
/// Time passes for it when [`Module::pass`] says so. It converts its open inputs together, once in the time that all
/// of them take.
#[derive(Clone, Copy, Debug)]
pub struct Module {
    kind: &'static Kind,
    /// The words of the table's rows, in their order.
    words: [i16; WORDS],
    inputs: [Input; CHANNELS],
    outputs: [Output; CHANNELS],
    /// Microseconds since the last conversion.
    since_us: u32,
    /// The low byte that the next conversion of an output takes.
    held_low: i16,
    is_running: bool,
}

impl Module {
    /// A module as it comes from the factory, with nothing connected to it.
    pub fn new(kind: &'static Kind) -> Self {
        let input = Input {
            signal: None,
            curve: None,
            sum: 0,
            samples: 0,
            is_out: false,
        };
        let output = Output {
            digital: 0,
            curve: None,
            is_out: false,
        };
        let mut module = Module {
            kind,
            words: [0; WORDS],
            inputs: [input; CHANNELS],
            outputs: [output; CHANNELS],
            since_us: 0,
            held_low: 0,
            is_running: true,
        };
        module.restore(|_| true);
        module
    }

    /// Its kind.
    pub fn kind(&self) -> &'static Kind {
        self.kind
    }

    /// Gives the words of rows their defaults.
    fn restore(&mut self, which: impl Fn(&Bfm) -> bool) {
        for bfm in self.kind.bfms {
            if which(bfm) {
                for n in 0..usize::from(bfm.count) {
                    self.set_of(bfm, n, bfm.default);
                }
            }
        }
        self.show_curves();
    }

    /// Power off and on: what the module keeps stays, and what is connected to it.
    pub fn power_cycle(&mut self) {
        self.restore(|bfm| bfm.access != Access::Kept);
        for input in &mut self.inputs {
            (input.sum, input.samples, input.is_out) = (0, 0, false);
        }
        for output in &mut self.outputs {
            (output.digital, output.is_out) = (0, false);
        }
        (self.since_us, self.held_low) = (0, 0);
        self.is_running = true;
    }

    /// The PLC is in RUN or in STOP from now on.
    pub fn set_running(&mut self, running: bool) {
        self.is_running = running;
    }

    /// Where word `n` of a row is among all.
    fn place(&self, bfm: &Bfm, n: usize) -> Option<usize> {
        let before = self.kind.bfms.iter();
        let before = before.take_while(|other| other.first != bfm.first);
        let start: usize = before.map(|other| usize::from(other.count)).sum();
        (n < usize::from(bfm.count)).then_some(start + n)
    }

    /// Word `n` of a role; 0 if the module has none.
    fn get(&self, role: Role, n: usize) -> i16 {
        let bfm = self.kind.with(role);
        bfm.map_or(0, |bfm| self.get_of(bfm, n))
    }

    /// Word `n` of a row; 0 if it has none.
    fn get_of(&self, bfm: &Bfm, n: usize) -> i16 {
        let place = self.place(bfm, n);
        let word = place.and_then(|place| self.words.get(place));
        word.copied().unwrap_or(0)
    }

    /// Sets word `n` of a role, if the module has it.
    fn set(&mut self, role: Role, n: usize, value: i16) {
        if let Some(bfm) = self.kind.with(role) {
            self.set_of(bfm, n, value);
        }
    }

    /// Sets word `n` of a row, if it has it.
    fn set_of(&mut self, bfm: &Bfm, n: usize, value: i16) {
        let place = self.place(bfm, n);
        if let Some(word) = place.and_then(|place| self.words.get_mut(place)) {
            *word = value;
        }
    }

    /// The range with the digit of a channel, a hexadecimal digit of the words with this role.
    fn range(&self, channel: usize, role: Role, ranges: &[Option<Range>]) -> Option<Range> {
        let word = self.get(role, 0) as u16;
        let digit = usize::from(word >> (4 * channel) & 0xf);
        ranges.get(digit).copied().flatten()
    }

    /// The range of an input; `None` if it is off.
    fn input_range(&self, channel: usize) -> Option<Range> {
        if channel >= usize::from(self.kind.inputs) {
            return None;
        }
        if self.kind.start == Start::Itself {
            return self.range(channel, Role::InputRanges, self.kind.input_ranges);
        }
        // These inputs have a terminal for each quantity.
        let signal = self.inputs.get(channel)?.signal?;
        let ranges = self.kind.input_ranges.iter().flatten();
        ranges
            .copied()
            .find(|range| range.quantity == signal.quantity)
    }

    /// The range of an output; `None` if it is off.
    fn output_range(&self, channel: usize, quantity: Option<Quantity>) -> Option<Range> {
        if channel >= usize::from(self.kind.outputs) {
            return None;
        }
        if self.kind.start == Start::Itself {
            return self.range(channel, Role::OutputRanges, self.kind.output_ranges);
        }
        let ranges = self.kind.output_ranges.iter().flatten();
        ranges
            .copied()
            .find(|range| quantity.is_none_or(|quantity| range.quantity == quantity))
    }

    /// What is connected to input `channel`, counted from 0, from now on; `None` if the module does not have it.
    pub fn connect(&mut self, channel: u8, signal: Signal) -> Option<()> {
        let channel = usize::from(channel);
        if channel >= usize::from(self.kind.inputs) {
            return None;
        }
        self.inputs.get_mut(channel)?.signal = Some(signal);
        Some(())
    }

    /// What is at a channel, counted from 0: what is connected to an input, or what an output puts out, in
    /// millionths; 0 if that is of another quantity. `None` if the module does not have the channel.
    pub fn signal(&self, channel: u8, quantity: Quantity) -> Option<i32> {
        let channel = usize::from(channel);
        let inputs = usize::from(self.kind.inputs);
        if channel < inputs {
            let signal = self.inputs.get(channel)?.signal;
            let signal = signal.filter(|signal| signal.quantity == quantity);
            return Some(signal.map_or(0, |signal| signal.millionths));
        }
        let channel = channel - inputs;
        if channel >= usize::from(self.kind.outputs) {
            return None;
        }
        let range = self.output_range(channel, Some(quantity));
        let range = range.filter(|range| range.quantity == quantity);
        Some(range.map_or(0, |range| self.put_out(channel, &range)))
    }

    /// What an output puts out, in millionths.
    fn put_out(&self, channel: usize, range: &Range) -> i32 {
        let Some(output) = self.outputs.get(channel) else {
            return 0;
        };
        let goes_to_offset = self.get(Role::StopModes, 0) >> (4 * channel) & 0xf != 0;
        let digital = match goes_to_offset && !self.is_running {
            true => 0,
            false => output.digital.clamp(range.low, range.high),
        };
        let millionths = range.analog(output.curve.unwrap_or(range.curve()), digital);
        match range.quantity {
            // A current output drives in one direction only.
            Quantity::Milliamperes => millionths.max(0),
            Quantity::Volts | Quantity::Celsius => millionths,
        }
    }

    /// Microseconds pass.
    pub fn pass(&mut self, microseconds: u32) {
        if self.kind.start != Start::Itself {
            return;
        }
        let channels = 0..usize::from(self.kind.inputs);
        let open = channels.filter(|&channel| self.input_range(channel).is_some());
        let open = open.count() as u32;
        if open == 0 {
            return;
        }
        let round_us = open * self.conversion_us();
        self.since_us = self.since_us.saturating_add(microseconds);
        while self.since_us >= round_us {
            self.since_us -= round_us;
            for channel in 0..usize::from(self.kind.inputs) {
                self.convert(channel);
            }
        }
    }

    /// How long it takes to convert a channel.
    fn conversion_us(&self) -> u32 {
        match (self.kind.with(Role::Rate), self.get(Role::Rate, 0)) {
            (Some(_), 1) => 6000,
            (Some(_), chosen @ 1000..=30_000) => chosen.unsigned_abs().into(),
            _ => self.kind.conversion_us,
        }
    }

    /// What an input measures, held in its range, and whether it had to be.
    fn measure(&self, channel: usize, range: &Range) -> (i32, bool, bool) {
        let Some(input) = self.inputs.get(channel) else {
            return (0, false, false);
        };
        let seen = input
            .signal
            .and_then(|signal| signal.seen_as(range.quantity));
        let digital = match seen {
            Some(millionths) => range.digital(input.curve.unwrap_or(range.curve()), millionths),
            // A temperature input without a sensor measures too much, any other one nothing.
            None if range.quantity == Quantity::Celsius => i32::MAX,
            None => 0,
        };
        let value = digital.clamp(range.low, range.high);
        (value, digital < range.low, digital > range.high)
    }

    /// Takes a sample of an input.
    fn convert(&mut self, channel: usize) {
        let Some(range) = self.input_range(channel) else {
            return;
        };
        let (measured, too_low, too_high) = self.measure(channel, &range);
        let value = measured.saturating_add(self.get(Role::Addition, channel).into());
        let value = word(value);
        let wanted = self.samples_wanted(channel);
        let Some(input) = self.inputs.get_mut(channel) else {
            return;
        };
        input.is_out = too_low || too_high;
        input.sum = input.sum.saturating_add(value.into());
        input.samples += 1;
        let mut mean = None;
        if input.samples >= wanted {
            mean = Some((input.sum / i32::from(input.samples)) as i16);
            (input.sum, input.samples) = (0, 0);
        }
        let latch = i16::from(too_low) | i16::from(too_high) << 1;
        let latched = self.get(Role::RangeLatch, 0) | latch << (2 * channel);
        self.set(Role::RangeLatch, 0, latched);
        self.set(Role::Present, channel, value);
        self.set(Role::PresentFahrenheit, channel, fahrenheit(value));
        if let Some(mean) = mean {
            self.set(Role::Mean, channel, mean);
            self.set(Role::MeanFahrenheit, channel, fahrenheit(mean));
            let (least, greatest) = (Role::LeastPeak, Role::GreatestPeak);
            self.set(least, channel, mean.min(self.get(least, channel)));
            self.set(greatest, channel, mean.max(self.get(greatest, channel)));
        }
    }

    /// How many samples make a mean of a channel.
    fn samples_wanted(&self, channel: usize) -> i16 {
        let asked = self.get(Role::Samples, channel);
        match (1..=self.kind.most_samples).contains(&asked) {
            true => asked,
            false => self.kind.usual_samples,
        }
    }

    /// Reads a word of buffer memory; `None` if the module does not have that many.
    pub fn read(&self, number: u16) -> Option<i16> {
        let Some(bfm) = self.kind.bfm(number) else {
            return (number <= self.kind.last).then_some(0);
        };
        let n = bfm.word(number)?;
        Some(match bfm.role {
            Role::InputError => self.input_error(),
            Role::OutputError => self.output_error(),
            _ => self.get_of(bfm, n),
        })
    }

    fn input_error(&self) -> i16 {
        let channels = 0..usize::from(self.kind.inputs);
        let of_inputs = channels.clone().zip(&self.inputs);
        let mut open = of_inputs.filter(|&(channel, _)| self.input_range(channel).is_some());
        let is_out = open.any(|(_, input)| input.is_out);
        let most = self.kind.most_samples;
        let samples = channels.map(|channel| self.get(Role::Samples, channel));
        let wrong = samples
            .into_iter()
            .any(|samples| !(1..=most).contains(&samples));
        bit(is_out, RANGE_ERROR)
            | bit(wrong, SAMPLES_ERROR)
            | bit(self.is_locked(Role::InputLock), LOCKED)
    }

    fn output_error(&self) -> i16 {
        let outputs = self.outputs.iter().take(usize::from(self.kind.outputs));
        let is_out = outputs.into_iter().any(|output| output.is_out);
        bit(is_out, RANGE_ERROR) | bit(self.is_locked(Role::OutputLock), LOCKED)
    }

    /// Whether settings may not be changed.
    fn is_locked(&self, role: Role) -> bool {
        self.kind.with(role).is_some() && self.get(role, 0) != self.kind.unlocked
    }

    /// Sets a word of buffer memory, also one that a program only reads; `None` if the module does not have that many.
    pub fn poke(&mut self, number: u16, value: i16) -> Option<()> {
        match self.kind.bfm(number) {
            Some(bfm) if bfm.access == Access::Read => {
                self.set_of(bfm, bfm.word(number)?, value);
                Some(())
            }
            _ => self.write(number, value),
        }
    }

    /// Writes a word of buffer memory; `None` if the module does not have that many. What is read-only or locked
    /// stays as it is.
    pub fn write(&mut self, number: u16, value: i16) -> Option<()> {
        let Some(bfm) = self.kind.bfm(number) else {
            return (number <= self.kind.last).then_some(());
        };
        let n = bfm.word(number)?;
        let (inputs, outputs) = (
            self.is_locked(Role::InputLock),
            self.is_locked(Role::OutputLock),
        );
        match bfm.role {
            _ if bfm.access == Access::Read => {}
            Role::InputRanges | Role::InputOffset | Role::InputGain if inputs => {}
            Role::InputTakeOver | Role::InputTakeOverBoth | Role::InputReset if inputs => {}
            Role::OutputRanges | Role::OutputTakeOver | Role::OutputTakeOverBoth if outputs => {}
            Role::OutputCurves | Role::OutputReset if outputs => {}
            Role::InputRanges | Role::OutputRanges => self.choose_ranges(bfm.role, value),
            Role::Rate => {
                self.set(Role::Rate, n, value);
                let samples = self.kind.with(Role::Samples);
                let (count, usual) = samples.map_or((0, 0), |bfm| (bfm.count, bfm.default));
                for channel in 0..usize::from(count) {
                    self.set(Role::Samples, channel, usual);
                }
            }
            Role::Output => {
                self.set(Role::Output, n, value);
                self.put(n, value.into());
            }
            Role::InputTakeOver => {
                self.take_over_inputs(value);
                self.set(Role::InputTakeOver, 0, value);
            }
            Role::InputTakeOverBoth => self.take_over_each(Role::InputOffsets, value),
            Role::OutputTakeOverBoth => self.take_over_each(Role::OutputOffsets, value),
            Role::OutputTakeOver => {
                self.take_over_outputs(n, value);
                self.set(Role::OutputTakeOver, n, value);
            }
            Role::PeakReset => self.reset_peaks(value),
            Role::InputReset | Role::OutputReset if value == 1 => self.reset(bfm.role),
            Role::Control => {
                self.control(self.get(Role::Control, 0), value);
                self.set(Role::Control, 0, value);
            }
            _ => self.set_of(bfm, n, value),
        }
        Some(())
    }

    /// Gives channels new ranges, with the offset and gain of the factory.
    fn choose_ranges(&mut self, role: Role, value: i16) {
        let changed = (self.get(role, 0) ^ value) as u16;
        self.set(role, 0, value);
        for channel in 0..CHANNELS {
            if changed >> (4 * channel) & 0xf == 0 {
                continue;
            }
            if role == Role::InputRanges {
                if let Some(input) = self.inputs.get_mut(channel) {
                    (input.curve, input.sum, input.samples) = (None, 0, 0);
                }
            } else if let Some(output) = self.outputs.get_mut(channel) {
                output.curve = None;
            }
        }
        self.show_curves();
    }

    /// The words for offset and gain of single channels show those that are in force.
    fn show_curves(&mut self) {
        for channel in 0..CHANNELS {
            let of_input = self.inputs.get(channel).and_then(|input| input.curve);
            let usual = self.input_range(channel).map(|range| range.curve());
            if let Some(curve) = of_input.or(usual) {
                self.set(Role::InputOffsets, channel, word(curve.offset));
                self.set(Role::InputGains, channel, word(curve.gain));
            }
            let of_output = self.outputs.get(channel).and_then(|output| output.curve);
            let usual = self.output_range(channel, None).map(|range| range.curve());
            if let Some(curve) = of_output.or(usual) {
                self.set(Role::OutputCurves, 2 * channel, word(curve.offset));
                self.set(Role::OutputCurves, 2 * channel + 1, word(curve.gain));
                self.set(Role::OutputOffsets, channel, word(curve.offset));
                self.set(Role::OutputGains, channel, word(curve.gain));
            }
        }
    }

    /// Bits, offset and gain by turns, give inputs what was written before.
    fn take_over_inputs(&mut self, bits: i16) {
        let offset = self.get(Role::InputOffset, 0).into();
        let gain = self.get(Role::InputGain, 0).into();
        for channel in 0..usize::from(self.kind.inputs) {
            let Some(range) = self.input_range(channel) else {
                continue;
            };
            let chosen = bits >> (2 * channel) & 3;
            if let Some(input) = self.inputs.get_mut(channel).filter(|_| chosen != 0) {
                let curve = input.curve.get_or_insert(range.curve());
                curve.offset = if chosen & 1 != 0 {
                    offset
                } else {
                    curve.offset
                };
                curve.gain = if chosen & 2 != 0 { gain } else { curve.gain };
            }
        }
    }

    /// Hexadecimal digits, offset and gain by turns, give two outputs what was written before.
    fn take_over_outputs(&mut self, pair: usize, digits: i16) {
        for channel in 2 * pair..(2 * pair + 2).min(usize::from(self.kind.outputs)) {
            let Some(range) = self.output_range(channel, None) else {
                continue;
            };
            let offset = self.get(Role::OutputCurves, 2 * channel).into();
            let gain = self.get(Role::OutputCurves, 2 * channel + 1).into();
            let chosen = digits >> (8 * (channel % 2));
            if let Some(output) = self.outputs.get_mut(channel).filter(|_| chosen & 0xff != 0) {
                let curve = output.curve.get_or_insert(range.curve());
                curve.offset = if chosen & 0x01 != 0 {
                    offset
                } else {
                    curve.offset
                };
                curve.gain = if chosen & 0x10 != 0 { gain } else { curve.gain };
            }
        }
    }

    /// A bit for each channel gives it the offset and gain in its own words.
    fn take_over_each(&mut self, offsets: Role, bits: i16) {
        for channel in (0..CHANNELS).filter(|channel| bits >> channel & 1 != 0) {
            let of = |module: &Module, gains| Curve {
                offset: module.get(offsets, channel).into(),
                gain: module.get(gains, channel).into(),
            };
            if offsets == Role::InputOffsets {
                let curve = of(self, Role::InputGains);
                if let Some(input) = self.inputs.get_mut(channel) {
                    input.curve = Some(curve);
                }
            } else {
                let curve = of(self, Role::OutputGains);
                if let Some(output) = self.outputs.get_mut(channel) {
                    output.curve = Some(curve);
                }
            }
        }
    }

    fn reset_peaks(&mut self, bits: i16) {
        for channel in (0..CHANNELS).filter(|channel| bits >> channel & 1 != 0) {
            let mean = self.get(Role::Mean, channel);
            self.set(Role::LeastPeak, channel, mean);
            self.set(Role::GreatestPeak, channel, mean);
        }
    }

    /// What the inputs or outputs were set to at the factory. The word that asked for it is 0 then.
    fn reset(&mut self, role: Role) {
        let both = self.kind.inputs == 0 || self.kind.outputs == 0;
        let first_of_outputs = self
            .kind
            .with(Role::OutputRanges)
            .map_or(0, |bfm| bfm.first);
        let of_outputs = role == Role::OutputReset;
        if both || of_outputs {
            for output in &mut self.outputs {
                (output.curve, output.digital, output.is_out) = (None, 0, false);
            }
        }
        if both || !of_outputs {
            for input in &mut self.inputs {
                (input.curve, input.sum, input.samples) = (None, 0, 0);
            }
        }
        self.restore(|bfm| both || of_outputs == (bfm.first >= first_of_outputs));
    }

    /// Gives an output a value.
    fn put(&mut self, channel: usize, digital: i32) {
        let range = self.output_range(channel, None);
        if let Some(output) = self.outputs.get_mut(channel) {
            output.digital = digital;
            output.is_out = range.is_some_and(|range| !range.holds(digital));
        }
    }

    /// Bits of the control word that rise and fall start conversions.
    fn control(&mut self, before: i16, now: i16) {
        let rises = |bit: i16| !before & now & bit != 0;
        let falls = |bit: i16| before & !now & bit != 0;
        let data = self.get(Role::Data, 0);
        let start = self.kind.start;
        if matches!(start, Start::Fx0n3a | Start::Fx2n2ad) && rises(2) {
            let channel = usize::from(now & 1 != 0);
            let range = self.input_range(channel);
            let value = range.map_or(0, |range| self.measure(channel, &range).0);
            self.set(Role::LowByte, 0, (value & 0xff) as i16);
            self.set(Role::HighBits, 0, (value >> 8 & 0xf) as i16);
        }
        if start == Start::Fx0n3a && falls(4) {
            self.put(0, i32::from(data & 0xff));
        }
        if start == Start::Fx2n2da {
            if falls(4) {
                self.held_low = data & 0xff;
            }
            let value = i32::from(self.held_low | (data & 0xf) << 8);
            for (channel, bit) in [2, 1].into_iter().enumerate() {
                if falls(bit) {
                    self.put(channel, value);
                }
            }
        }
    }
}

/// A bit if it is on.
fn bit(on: bool, bit: i16) -> i16 {
    if on { bit } else { 0 }
}

/// A number held in what a word holds.
fn word(value: i32) -> i16 {
    value.clamp(i16::MIN.into(), i16::MAX.into()) as i16
}

/// Tenths of a degree Fahrenheit of tenths of a degree Celsius.
fn fahrenheit(celsius: i16) -> i16 {
    word(i32::from(celsius) * 9 / 5 + 320)
}

#[cfg(test)]
mod tests;
