//! Roles of words of buffer memory.

/// Role of a word of buffer memory.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Role {
    /// The ranges of the inputs, a hexadecimal digit each, the lowest that of the first.
    InputRanges,
    /// Number of samples in a mean.
    Samples,
    /// The mean of the last samples.
    Mean,
    /// The last sample.
    Present,
    /// The mean in tenths of a degree Fahrenheit.
    MeanFahrenheit,
    /// The last sample in tenths of a degree Fahrenheit.
    PresentFahrenheit,
    /// Conversion time.
    Rate,
    /// 1 restores what the inputs were set to at the factory.
    InputReset,
    /// Lock of ranges, offset and gain of the inputs.
    InputLock,
    /// Bits that give the offset or the gain to channels, two for each.
    InputTakeOver,
    /// Offset for the channels that take it over.
    InputOffset,
    /// Gain for the channels that take it over.
    InputGain,
    /// Bits that give offset and gain to channels, one for each.
    InputTakeOverBoth,
    /// Offset of a channel, once it takes it over.
    InputOffsets,
    /// Gain of a channel, once it takes it over.
    InputGains,
    /// Added to what a channel measures.
    Addition,
    /// The least value measured since the last reset.
    LeastPeak,
    /// The greatest value measured since the last reset.
    GreatestPeak,
    /// Bits that set the peaks of channels to the present value, one for each.
    PeakReset,
    /// Channels that have measured too little or too much, two bits for each; stays until 0 is written.
    RangeLatch,
    /// Error of the inputs.
    InputError,
    /// The ranges of the outputs, a hexadecimal digit each.
    OutputRanges,
    /// Value of an output.
    Output,
    /// Behaviour of the outputs in STOP, a hexadecimal digit each: 0 they hold, 1 they go to their offset.
    StopModes,
    /// Hexadecimal digits that give offset or gain to two channels.
    OutputTakeOver,
    /// Offset and gain of the outputs by turns, once they take them over.
    OutputCurves,
    /// Bits that give offset and gain to outputs, one for each.
    OutputTakeOverBoth,
    /// Offset of an output, once it takes it over.
    OutputOffsets,
    /// Gain of an output, once it takes it over.
    OutputGains,
    /// 1 restores what the outputs were set to at the factory.
    OutputReset,
    /// Lock of ranges, offset and gain of the outputs.
    OutputLock,
    /// Error of the outputs.
    OutputError,
    /// The version of the module's software.
    Version,
    /// Identification of the module.
    Identification,
    /// A setting that the simulated module keeps and does not act on.
    Setting,
    /// The low byte of what was measured last.
    LowByte,
    /// The high bits of what was measured last.
    HighBits,
    /// Value to output.
    Data,
    /// Bits that choose a channel and start conversions.
    Control,
    /// Type of each input, a word each.
    InputTypes,
    /// Type of each output, a word each.
    OutputTypes,
    /// Value of an output, as the module shows it.
    OutputShown,
    /// The input terminals, a bit each.
    InputPoints,
    /// The output terminals, a bit each.
    OutputPoints,
    /// After how many milliseconds without an exchange the output terminals go off.
    Silence,
    /// Command to a board.
    Command,
    /// Answer of a board.
    Answer,
    /// 1 shows degrees Fahrenheit instead of Celsius.
    Fahrenheit,
    /// Type of the sensors of all inputs.
    SensorType,
    /// 1 for an output that goes to its offset in STOP, 0 for one that holds.
    StopMode,
    /// 1 for a channel that is not used.
    Unused,
    /// Error bits of an adapter.
    AdapterError,
    /// Writing it converts all inputs.
    Exchange,
    /// A word of the control of temperatures, one for each channel.
    Thermostat(Term),
    /// A word of the control of axes.
    Axis(AxisWord),
}

/// A word of the control of temperatures (h1u-h2u-programming §6.6, items 11 to 14).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Term {
    /// 1 while the temperature is controlled.
    Start,
    /// 1 while control is held up.
    Pause,
    /// The set temperature in 0.1 °C.
    Setpoint,
    /// Bits that choose the kind of control.
    Mode,
    /// Bits that switch limits on.
    Limits,
    /// Proportional gain in percent.
    Kp,
    /// Integral time in 100 ms; 0: none.
    Ti,
    /// Derivative time in 100 ms; 0: none.
    Td,
    /// Sampling time in milliseconds.
    Ts,
    /// Input filter in percent.
    Filter,
    /// The output while tuning.
    TuneOutput,
    /// The present target of a ramp.
    Target,
    /// The output while control is held up or the sensor is broken.
    PauseOutput,
    /// Period of the main relay in seconds.
    MainCycle,
    /// Period of the second relay in seconds.
    SecondCycle,
    /// Hysteresis of the main output.
    MainHysteresis,
    /// Hysteresis of the second output.
    SecondHysteresis,
    /// Gain of the second output in percent.
    SecondGain,
    /// Unit of the ramp's time: 0 minutes, 1 seconds.
    RampUnit,
    /// Rise of the target per unit of time.
    RampStep,
    /// Upper limit of the measured value.
    UpperInput,
    /// Its lower limit.
    LowerInput,
    /// Greatest deviation.
    Deviation,
    /// Upper limit of the main output.
    UpperMain,
    /// Its lower limit.
    LowerMain,
    /// Upper limit of the second output.
    UpperSecond,
    /// Its lower limit.
    LowerSecond,
    /// Upper limit of the set temperature.
    UpperSetpoint,
    /// Its lower limit.
    LowerSetpoint,
    /// Upper limit of the change of the measured value in a sample.
    UpperInputChange,
    /// Its lower limit.
    LowerInputChange,
    /// Upper limit of the change of the output in a sample.
    UpperOutputChange,
    /// Its lower limit.
    LowerOutputChange,
    /// State of control: 0 none, 1 on and off, 2 tuning, 3 PID.
    State,
    /// The alarm that stopped it.
    Alarm,
    /// Bits of limits that are exceeded.
    Warnings,
    /// The main output as a number.
    MainDigital,
    /// The main relay.
    MainRelay,
    /// The second output as a number.
    SecondDigital,
    /// The second relay.
    SecondRelay,
    /// The main output, a number or a relay.
    MainOutput,
    /// The second output, a number or a relay.
    SecondOutput,
    /// Least time between two actions of a relay in milliseconds.
    DeadTime,
    /// The deviation at which the outputs stop, in 0.1 °C; 0: none.
    StopDifference,
}

/// A word of the control of axes (l01s-programming §9.4.1).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum AxisWord {
    /// Time of acceleration and deceleration of an axis in milliseconds.
    Ramp,
    /// Bits that start and stop axes and clear what they have reached.
    Control,
    /// Mode of each axis, a hexadecimal digit each.
    Mode,
    /// Target and speed of each axis, two words each.
    Move,
    /// The high speed of a return to the origin, two words.
    FastHoming,
    /// Its low speed.
    SlowHoming,
    /// Bits for directions.
    Options,
    /// The lowest speed of an axis in Hz.
    LowestSpeed,
    /// Homing mode of each axis, a hexadecimal digit each.
    HomingMode,
    /// A bit for each axis that moves.
    Busy,
    /// A bit for each axis that has reached its target.
    Done,
    /// The position of each axis, two words each.
    Position,
}
