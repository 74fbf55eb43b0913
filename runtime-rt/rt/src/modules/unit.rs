//! A special module at work.

use super::positioner::Axes;
use super::thermostat::Thermostat;
use super::{Access, Bfm, Curve, Duty, Kind, Quantity, Range, Role, Signal, Start};

/// Words of buffer memory that a module may have: more than any kind has.
const WORDS: usize = 208;

/// Inputs that a module may have, and outputs.
pub(super) const CHANNELS: usize = 4;

/// By how much the type of an input is greater in the table of ranges for the other of its terminals.
const OTHER_TERMINAL: usize = 16;

/// Bits of error words: any error, a value out of range, a number of samples out of range, settings locked.
const RANGE_ERROR: i16 = 1 << 10;
const SAMPLES_ERROR: i16 = 1 << 11;
const LOCKED: i16 = 1 << 12;

/// The bit of an adapter's errors for a number of samples out of range.
const ADAPTER_SAMPLES_ERROR: i16 = 1 << 5;

/// An input.
#[derive(Clone, Copy, Debug)]
pub(super) struct Input {
    signal: Option<Signal>,
    /// Offset and gain that the program has given it.
    pub(super) curve: Option<Curve>,
    pub(super) sum: i32,
    pub(super) samples: i16,
    /// True if the last sample was out of range.
    is_out: bool,
    /// True if there was a sample since power-on.
    is_measured: bool,
}

/// An output.
#[derive(Clone, Copy, Debug)]
pub(super) struct Output {
    digital: i32,
    pub(super) curve: Option<Curve>,
    is_out: bool,
}

/// A special module: its buffer memory and its channels.
///
/// Time passes for it when [`Module::pass`] says so. It converts its open inputs together, once in the time that all
/// of them take.
#[derive(Clone, Copy, Debug)]
pub struct Module {
    pub(super) kind: &'static Kind,
    /// The words of the table's rows, in their order.
    words: [i16; WORDS],
    pub(super) inputs: [Input; CHANNELS],
    pub(super) outputs: [Output; CHANNELS],
    /// Microseconds since the last conversion.
    since_us: u32,
    /// The low byte that the next conversion of an output takes.
    held_low: i16,
    is_running: bool,
    /// States of the input terminals, and of the output terminals.
    pub(super) points: [u16; 2],
    /// The filter of a board.
    pub(super) filter: i16,
    /// Microseconds that are not a millisecond yet.
    rest_us: u32,
    pub(super) thermostats: [Thermostat; CHANNELS],
    pub(super) axes: Axes,
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
            is_measured: false,
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
            points: [0; 2],
            filter: 1,
            rest_us: 0,
            thermostats: [Thermostat::new(); CHANNELS],
            axes: Axes::new(),
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
        self.restore(|bfm| bfm.access != Access::Retained);
        for input in &mut self.inputs {
            (input.sum, input.samples, input.is_out) = (0, 0, false);
            input.is_measured = false;
        }
        for output in &mut self.outputs {
            (output.digital, output.is_out) = (0, false);
        }
        (self.since_us, self.held_low, self.rest_us) = (0, 0, 0);
        (self.points[1], self.filter) = (0, 1);
        self.thermostats = [Thermostat::new(); CHANNELS];
        self.axes = Axes::new();
        self.is_running = true;
    }

    /// The PLC is in RUN or in STOP from now on.
    pub fn set_running(&mut self, running: bool) {
        self.is_running = running;
    }

    /// Index of word `n` of a row among all.
    fn place(&self, bfm: &Bfm, n: usize) -> Option<usize> {
        let before = self.kind.bfms.iter();
        let before = before.take_while(|other| other.first != bfm.first);
        let start: usize = before.map(|other| usize::from(other.count)).sum();
        (n < usize::from(bfm.count)).then_some(start + n)
    }

    /// Word `n` of a role; 0 if the module has none.
    pub(super) fn get(&self, role: Role, n: usize) -> i16 {
        let word = self.slot(role, n).and_then(|place| self.words.get(place));
        word.copied().unwrap_or(0)
    }

    /// Index of word `n` of a role among all, if the module has it.
    fn slot(&self, role: Role, n: usize) -> Option<usize> {
        let mut start = 0;
        for bfm in self.kind.bfms {
            if bfm.role == role {
                return (n < usize::from(bfm.count)).then_some(start + n);
            }
            start += usize::from(bfm.count);
        }
        None
    }

    /// Word `n` of a row; 0 if it has none.
    fn get_of(&self, bfm: &Bfm, n: usize) -> i16 {
        let place = self.place(bfm, n);
        let word = place.and_then(|place| self.words.get(place));
        word.copied().unwrap_or(0)
    }

    /// Sets word `n` of a role, if the module has it.
    pub(super) fn set(&mut self, role: Role, n: usize, value: i16) {
        let place = self.slot(role, n);
        if let Some(word) = place.and_then(|place| self.words.get_mut(place)) {
            *word = value;
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

    /// The range that a separate word chooses for a channel.
    fn chosen(&self, channel: usize, role: Role, ranges: &[Option<Range>]) -> Option<Range> {
        let chosen = usize::try_from(self.get(role, channel)).ok()?;
        let range = ranges.get(chosen).copied().flatten()?;
        let signal = self.inputs.get(channel).and_then(|input| input.signal);
        let other = ranges.get(chosen + OTHER_TERMINAL).copied().flatten();
        let other = other.filter(|other| signal.is_some_and(|s| s.quantity == other.quantity));
        Some(other.unwrap_or(range))
    }

    /// The range of the terminal that a signal is connected to.
    fn connected(&self, channel: usize) -> Option<Range> {
        let signal = self.inputs.get(channel)?.signal?;
        let mut ranges = self.kind.input_ranges.iter().flatten();
        ranges
            .find(|range| range.quantity == signal.quantity)
            .copied()
    }

    /// The range of an input; `None` if it is off.
    pub(super) fn input_range(&self, channel: usize) -> Option<Range> {
        let ranges = self.kind.input_ranges;
        if channel >= usize::from(self.kind.inputs) || self.get(Role::Unused, channel) != 0 {
            return None;
        }
        match self.kind.duty {
            Duty::Board { has_both: true, .. } => return self.connected(channel),
            Duty::Board { .. } => return ranges.get(channel).copied().flatten(),
            _ if self.kind.start.is_programmed() => return self.connected(channel),
            _ => {}
        }
        if self.kind.with(Role::InputTypes).is_some() {
            return self.chosen(channel, Role::InputTypes, ranges);
        }
        if self.kind.with(Role::SensorType).is_some() {
            return self.chosen(0, Role::SensorType, ranges);
        }
        self.range(channel, Role::InputRanges, ranges)
    }

    /// The range of an output; `None` if it is off.
    pub(super) fn output_range(&self, channel: usize, quantity: Option<Quantity>) -> Option<Range> {
        let among_all = channel + usize::from(self.kind.inputs);
        if channel >= usize::from(self.kind.outputs) || self.get(Role::Unused, among_all) != 0 {
            return None;
        }
        let is_board = matches!(self.kind.duty, Duty::Board { .. });
        if self.kind.with(Role::OutputTypes).is_some() {
            return self.chosen(channel, Role::OutputTypes, self.kind.output_ranges);
        }
        if !self.kind.start.is_programmed() && !is_board {
            return self.range(channel, Role::OutputRanges, self.kind.output_ranges);
        }
        let ranges = self.kind.output_ranges.iter().flatten();
        ranges
            .copied()
            .find(|range| quantity.is_none_or(|quantity| range.quantity == quantity))
    }

    /// Connects a signal to input `channel`, counted from 0; `None` if the module does not have it.
    pub fn connect(&mut self, channel: u8, signal: Signal) -> Option<()> {
        match signal.quantity {
            Quantity::InputTerminal => return self.switch(channel, signal.millionths != 0),
            Quantity::OutputTerminal => return None,
            _ => {}
        }
        let channel = usize::from(channel);
        if channel >= usize::from(self.kind.inputs) {
            return None;
        }
        self.inputs.get_mut(channel)?.signal = Some(signal);
        Some(())
    }

    /// Signal at a channel, counted from 0: that connected to an input, or that of an output, in millionths; 0 if that
    /// is of another quantity. `None` if the module does not have the channel.
    pub fn signal(&self, channel: u8, quantity: Quantity) -> Option<i32> {
        if let Quantity::InputTerminal | Quantity::OutputTerminal = quantity {
            return self.point(channel, quantity);
        }
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

    /// Output value in millionths.
    fn put_out(&self, channel: usize, range: &Range) -> i32 {
        let Some(output) = self.outputs.get(channel) else {
            return 0;
        };
        let goes_to_offset = self.get(Role::StopModes, 0) >> (4 * channel) & 0xf != 0
            || self.get(Role::StopMode, channel) != 0;
        let digital = match goes_to_offset && !self.is_running {
            true => 0,
            false => output.digital.clamp(range.low, range.high),
        };
        let millionths = range.analog(output.curve.unwrap_or(range.curve()), digital);
        match range.quantity {
            // A current output drives in one direction only.
            Quantity::Milliamperes => millionths.max(0),
            _ => millionths,
        }
    }

    /// Microseconds pass.
    pub fn pass(&mut self, microseconds: u32) {
        if self.kind.start == Start::Itself {
            self.take_samples(microseconds);
        }
        self.rest_us = self.rest_us.saturating_add(microseconds);
        while self.rest_us >= 1000 {
            self.rest_us -= 1000;
            match self.kind.duty {
                Duty::Thermostat { relay, digital } => self.regulate(relay, digital),
                Duty::Positioner => self.move_axes(),
                Duty::None | Duty::Board { .. } => return self.rest_us %= 1000,
            }
        }
    }

    /// Converts the open inputs as often as there is time.
    fn take_samples(&mut self, microseconds: u32) {
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
            self.convert_all();
        }
    }

    /// Takes a sample of each input that is open.
    fn convert_all(&mut self) {
        for channel in 0..usize::from(self.kind.inputs) {
            self.convert(channel);
        }
    }

    /// Returns true if there is a sample of an input.
    pub(super) fn is_measured(&self, channel: usize) -> bool {
        let input = self.inputs.get(channel);
        input.is_some_and(|input| input.is_measured)
    }

    /// Returns true if nothing is connected to an input.
    pub(super) fn is_open(&self, channel: usize) -> bool {
        let input = self.inputs.get(channel);
        input.is_none_or(|input| input.signal.is_none())
    }

    /// Conversion time of a channel.
    fn conversion_us(&self) -> u32 {
        match (self.kind.with(Role::Rate), self.get(Role::Rate, 0)) {
            (Some(_), 1) => 6000,
            (Some(_), chosen @ 1000..=30_000) => chosen.unsigned_abs().into(),
            _ => self.kind.conversion_us,
        }
    }

    /// Measured value of an input, limited to its range, and flags for a value above or below it.
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
        input.is_measured = true;
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

    /// Number of samples in a mean of a channel.
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
            Role::AdapterError => self.adapter_error(),
            Role::Mean if self.get(Role::Fahrenheit, 0) != 0 => fahrenheit(self.get_of(bfm, n)),
            Role::InputPoints => self.points[0] as i16,
            Role::OutputShown => self.shown(n),
            Role::Present => self.answered(n),
            Role::Answer => self.answer(),
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

    /// Errors of an adapter: a bit for each channel, inputs first, and one for numbers of samples. A voltage or current
    /// is out of its range above it only.
    fn adapter_error(&self) -> i16 {
        let most = self.kind.most_samples;
        let mut error = 0;
        for channel in 0..usize::from(self.kind.inputs) {
            let (_, low, high) = match self.input_range(channel) {
                Some(range) if self.is_measured(channel) => {
                    let (value, low, high) = self.measure(channel, &range);
                    (value, low && range.quantity == Quantity::Celsius, high)
                }
                _ => (0, false, false),
            };
            let samples = self.get(Role::Samples, channel);
            error |= bit(low || high, 1 << channel)
                | bit(!(1..=most).contains(&samples), ADAPTER_SAMPLES_ERROR);
        }
        for (channel, output) in (self.kind.inputs..).zip(&self.outputs) {
            error |= bit(output.is_out, 1 << channel);
        }
        error
    }

    /// Returns true if settings are locked.
    pub(super) fn is_locked(&self, role: Role) -> bool {
        self.kind.with(role).is_some() && self.get(role, 0) != self.kind.unlocked
    }

    /// Sets a word of buffer memory, also one that a program only reads; `None` if the module does not have that many.
    pub fn poke(&mut self, number: u16, value: i16) -> Option<()> {
        match self.kind.bfm(number) {
            Some(bfm) if bfm.role == Role::InputPoints => {
                self.points[0] = value as u16;
                Some(())
            }
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
            Role::Output => self.output(n, value),
            Role::OutputPoints => {
                self.set(Role::OutputPoints, n, value);
                self.points[1] = value as u16;
            }
            Role::Axis(word) => {
                self.set_of(bfm, n, value);
                self.order(word, n);
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
            Role::Exchange => self.convert_all(),
            Role::InputReset | Role::OutputReset if value == 1 => self.reset(bfm.role),
            Role::Control => {
                self.control(self.get(Role::Control, 0), value);
                self.set(Role::Control, 0, value);
            }
            _ => self.set_of(bfm, n, value),
        }
        Some(())
    }

    fn reset_peaks(&mut self, bits: i16) {
        for channel in (0..CHANNELS).filter(|channel| bits >> channel & 1 != 0) {
            let mean = self.get(Role::Mean, channel);
            self.set(Role::LeastPeak, channel, mean);
            self.set(Role::GreatestPeak, channel, mean);
        }
    }

    /// Restores the factory settings of the inputs or outputs. The word that requested it is 0 then.
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

    /// Value last written to an output.
    pub(super) fn given(&self, channel: usize) -> i32 {
        let output = self.outputs.get(channel);
        output.map_or(0, |output| output.digital)
    }

    /// Gives an output a value.
    pub(super) fn put(&mut self, channel: usize, digital: i32) {
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
pub(super) fn word(value: i32) -> i16 {
    value.clamp(i16::MIN.into(), i16::MAX.into()) as i16
}

/// Tenths of a degree Fahrenheit of tenths of a degree Celsius.
fn fahrenheit(celsius: i16) -> i16 {
    word(i32::from(celsius) * 9 / 5 + 320)
}

#[cfg(test)]
mod tests;
