//! Descriptions of buffer memory.

use super::{Access, AxisWord, Role, Term};

impl Role {
    /// Meaning of a word with this role, as a phrase.
    pub fn meaning(self) -> &'static str {
        match self {
            Role::InputRanges => "range of each input, a hexadecimal digit each, the lowest CH1's",
            Role::Samples => "samples per mean",
            Role::Mean => "mean value",
            Role::Present => "present value",
            Role::MeanFahrenheit => "mean value in 0.1 °F",
            Role::PresentFahrenheit => "present value in 0.1 °F",
            Role::Rate => {
                "time per conversion: 0 is 15 ms, 1 is 6 ms, 1000 to 30000 are microseconds; writing it sets the samples \
                 per mean to 8"
            }
            Role::InputReset => "1 restores the factory settings of the inputs",
            Role::InputLock => "whether ranges, offset and gain of the inputs may be changed",
            Role::InputTakeOver => {
                "bits for each input, offset and gain by turns from bit 0: a 1 gives the channel the offset or gain \
                 written before"
            }
            Role::InputOffset => "offset to take over: the input in mV or µA that is 0",
            Role::InputGain => "gain to take over: the input in mV or µA at 1000",
            Role::InputTakeOverBoth => {
                "a bit for each input: the channel takes its offset and gain over"
            }
            Role::InputOffsets => "offset: the input in mV or µA that is 0",
            Role::InputGains => "gain: the input in mV or µA at half of the range",
            Role::Addition => "added to the value",
            Role::LeastPeak => "least value since the last reset",
            Role::GreatestPeak => "greatest value since the last reset",
            Role::PeakReset => {
                "a bit for each input: the channel's peaks begin at its present value"
            }
            Role::RangeLatch => {
                "two bits for each input, too low and too high, the latter also without a sensor; they stay until 0 is \
                 written"
            }
            Role::InputError => "error bits of the inputs",
            Role::OutputRanges => {
                "range of each output, a hexadecimal digit each, the lowest the first output's"
            }
            Role::Output => "value to put out",
            Role::StopModes => {
                "in STOP, a hexadecimal digit each: 0 holds the output, 1 puts out its offset"
            }
            Role::OutputTakeOver => {
                "hexadecimal digits for two outputs, offset and gain by turns: 1 takes it over"
            }
            Role::OutputCurves => {
                "offset, then gain to take over: the output in mV or µA at 0 and at 1000"
            }
            Role::OutputTakeOverBoth => "a bit for each output: it takes its offset and gain over",
            Role::OutputOffsets => "offset: the output in mV or µA at 0",
            Role::OutputGains => "gain: the output in mV or µA at half of the range",
            Role::OutputReset => "1 restores the factory settings of the outputs",
            Role::OutputLock => "whether ranges, offset and gain of the outputs may be changed",
            Role::OutputError => "error bits of the outputs",
            Role::Version => "software version",
            Role::Identification => "identification code",
            Role::Setting => "a setting that is kept without effect in simulation",
            Role::LowByte => "low byte of the last conversion",
            Role::HighBits => "high four bits of the last conversion",
            Role::Data => "value to put out, a byte at a time",
            Role::Control => "channel, and bits that start conversions",
            Role::InputTypes => "type of the input",
            Role::OutputTypes => "type of the output",
            Role::OutputShown => "value that is put out",
            Role::InputPoints => "input terminals, a bit each, the lowest X0",
            Role::OutputPoints => "output terminals, a bit each, the lowest Y0",
            Role::Silence => {
                "milliseconds without an exchange after which the outputs go off, 0 for never; exchanges never fail here"
            }
            Role::Command => {
                "command: 0 works, C000h pauses, C001h takes the next word as the filter"
            }
            Role::Answer => "the type of the board, or the command that it obeys",
            Role::Thermostat(term) => term.meaning(),
            Role::Axis(word) => word.meaning(),
            Role::Fahrenheit | Role::SensorType | Role::StopMode => self.meaning_in_adapters(),
            Role::Unused | Role::AdapterError | Role::Exchange => self.meaning_in_adapters(),
        }
    }

    /// Meaning of a word that only analog adapters and boards of FX have.
    fn meaning_in_adapters(self) -> &'static str {
        match self {
            Role::Fahrenheit => "1 shows 0.1 °F, 0 shows 0.1 °C",
            Role::SensorType => "type of the sensors",
            Role::StopMode => "in STOP, 0 holds the output, 1 puts out its offset",
            Role::Unused => "1 for a channel that is not used",
            Role::AdapterError => {
                "errors: bits 0 to 3 a channel out of its range, bit 5 samples per mean out of 1 to 4095"
            }
            Role::Exchange => "writing it converts all inputs",
            _ => "",
        }
    }
}

impl Term {
    fn meaning(self) -> &'static str {
        match self {
            Term::Start => "1 controls the temperature",
            Term::Pause => "1 holds control up: the output is that of BFM 118 (218, 318, 418)",
            Term::Setpoint => "set temperature in 0.1 °C",
            Term::Mode => {
                "bit 0: digital output instead of a relay; bit 1: on and off instead of PID; bit 2: a second output for \
                 the other direction; bit 3: the main output heats (0: it cools); bit 4: tune the gains first, goes off \
                 by itself; bit 5: the target rises by a ramp (4PT)"
            }
            Term::Limits => {
                "limits that are watched: bit 0 input, 1 deviation, 2 output, 3 set value, 4 change of the input, 5 change \
                 of the output, 6 second output"
            }
            Term::Kp => "proportional gain in %",
            Term::Ti => "integral time in 100 ms, 0 for none",
            Term::Td => "derivative time in 100 ms, 0 for none",
            Term::Ts => "sampling time in ms",
            Term::Filter => "input filter in %",
            Term::TuneOutput => "output while tuning",
            Term::Target => "present target of the ramp",
            Term::PauseOutput => "output while control is held up or the sensor is broken",
            Term::MainCycle => "period of the main relay in s",
            Term::SecondCycle => "period of the second relay in s",
            Term::MainHysteresis => "hysteresis of the main output, on and off",
            Term::SecondHysteresis => "hysteresis of the second output",
            Term::SecondGain => "proportional gain of the second output in %",
            Term::RampUnit => "unit of the ramp's time: 0 minute, 1 second",
            Term::RampStep => "ramp: 0.1 °C in a unit of time",
            Term::UpperInput => "upper limit of the input",
            Term::LowerInput => "lower limit of the input",
            Term::Deviation => "greatest deviation",
            Term::UpperMain => "upper limit of the main output",
            Term::LowerMain => "lower limit of the main output",
            Term::UpperSecond => "upper limit of the second output",
            Term::LowerSecond => "lower limit of the second output",
            Term::UpperSetpoint => "upper limit of the set temperature",
            Term::LowerSetpoint => "lower limit of the set temperature",
            Term::UpperInputChange => "upper limit of the change of the input in a sample",
            Term::LowerInputChange => "lower limit of the change of the input in a sample",
            Term::UpperOutputChange => "upper limit of the change of the output in a sample",
            Term::LowerOutputChange => "lower limit of the change of the output in a sample",
            Term::State => "0 stopped, 1 on and off, 2 tuning, 3 PID",
            Term::Alarm => {
                "alarm that has stopped control: 0 for none, else the code of the manual"
            }
            Term::Warnings => {
                "limits exceeded: bit 0 input, 1 set value, 2 output, 3 deviation, 4 change of the input, 5 change of the \
                 output, 6 second output"
            }
            Term::MainDigital => "main output as a number; with a relay, its duty",
            Term::MainRelay => "main relay: 1 is on",
            Term::SecondDigital => "second output as a number; with a relay, its duty",
            Term::SecondRelay => "second relay: 1 is on",
            Term::MainOutput => "main output: 0 to 10000, or a relay that is 0 or 1",
            Term::SecondOutput => "second output: 0 to 10000, or a relay that is 0 or 1",
            Term::DeadTime => "least time between two actions of a relay in ms",
            Term::StopDifference => {
                "deviation beyond the set temperature, in 0.1 °C, at which the output stops; 0 for none"
            }
        }
    }
}

impl AxisWord {
    fn meaning(self) -> &'static str {
        match self {
            AxisWord::Ramp => "time of acceleration and deceleration of axes 0 to 3 in ms",
            AxisWord::Control => {
                "bits 0 to 3 start axes 0 to 3, bits 4 to 7 stop them at once, bits 8 to 11 clear that they are in position"
            }
            AxisWord::Mode => {
                "a hexadecimal digit for each axis: 0 to a position, 1 by a distance, 4 to the origin"
            }
            AxisWord::Move => "for axes 0 to 3: target (two words), speed in Hz (two words)",
            AxisWord::FastHoming => "high speed to the origin in Hz, two words",
            AxisWord::SlowHoming => "low speed to the origin in Hz",
            AxisWord::Options => {
                "bits 0 to 3 turn directions round; bits 4 to 7: the return to the origin chooses its direction by the \
                 position; bits 8 to 11, S-shaped ramps, and 12 to 15, backlash, are kept without effect"
            }
            AxisWord::LowestSpeed => "lowest speed of axes 0 to 3 in Hz",
            AxisWord::HomingMode => {
                "a hexadecimal digit for each axis: 0 slow down at the origin, stop when it ends; 1 turn round there; 2 turn \
                 round at the limit first"
            }
            AxisWord::Busy => "a bit for each axis that moves",
            AxisWord::Done => "a bit for each axis that is in position",
            AxisWord::Position => "position of axes 0 to 3, two words each",
        }
    }
}

impl Access {
    /// As tables write it.
    pub fn name(self) -> &'static str {
        match self {
            Access::Read => "R",
            Access::ReadWrite => "R/W",
            Access::Retained => "R/W, kept",
        }
    }
}
