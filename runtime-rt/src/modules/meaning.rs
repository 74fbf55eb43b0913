//! What buffer memory is for, in words.

use super::{Access, Role};

impl Role {
    /// What a word with this role is for, as a phrase.
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
        }
    }
}

impl Access {
    /// As tables write it.
    pub fn name(self) -> &'static str {
        match self {
            Access::Read => "R",
            Access::ReadWrite => "R/W",
            Access::Kept => "R/W, kept",
        }
    }
}
