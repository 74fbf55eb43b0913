//! Special devices of the Mitsubishi models (FX1S/FX1N/FX2N programming manual II §6, FX3 programming manual §37).

use crate::special::{
    ADAPTERS_MISSING, CHECKED, CONTROL_LINES, COUNTER_INPUTS, COUNTING_1, COUNTING_2, DELIMITER,
    DISPLAY, EXTENSION_BOARDS, HARDWARE, INPUT_DELAY, INPUT_FILTER, INTERRUPTS, INVERTERS, LINK_1,
    LINK_2, MAKER, MODBUS_1, MODBUS_2, MODULE_COUNT, POWER, SHOWN, SLAVE_1, SLAVE_2, Special,
    TRACE, specials,
};
use rungc_rt::modules::{ADAPTERS, BOARD, BOARDS};

/// Devices of all.
pub(super) const ALL: &[Special] = specials! {
    M 8000 r 1 scan "on while the program runs";
    M 8001 r 0 scan "off while the program runs";
    M 8002 r 0 scan "on in the first scan of RUN";
    M 8003 r 0 scan "off in the first scan of RUN";
    M 8011 r 0 scan "clock of 10 ms";
    M 8012 r 0 scan "clock of 100 ms";
    M 8013 r 0 scan "clock of 1 s";
    M 8014 r 0 scan "clock of 1 min";
    M 8015 rw 0 scan "stops the real-time clock; its fall sets the clock from D8013–D8019";
    M 8016 rw 0 scan "freezes D8013–D8019 while the clock continues";
    M 8017 rw 0 scan "its rise rounds the clock to a minute";
    M 8018 r 1 scan "there is a real-time clock";
    M 8019 r 0 scan "the clock was set to an invalid date or time";
    M 8020 r 0 by("arithmetic") "zero flag";
    M 8021 r 0 by("arithmetic") "borrow flag: the result was too small";
    M 8022 rw 0 by("arithmetic") "carry flag: the result was too large; the bit that a rotation moved last";
    M 8024 rw 0 by("BMOV") "BMOV copies from D to S";
    M 8026 rw 0 by("RAMP") "RAMP holds the final value";
    M 8029 r 0 by("instructions that take several scans") "an instruction is complete";
    M 8031 rw 0 scan "clears what is not latched";
    M 8032 rw 0 scan "clears what is latched";
    M 8033 rw 0 scan "devices keep their values in STOP";
    M 8034 rw 0 scan "all outputs are off; their images are still updated";
    M 8035 rw 0 scan "allows M8036 to force RUN";
    M 8036 rw 0 scan "forces RUN while M8035 is on, and goes off";
    M 8037 rw 0 scan "STOP is forced";
    M 8038 rw 0 scan "on in the first scan of RUN, in which a program sets an N:N link up";
    M 8039 rw 0 scan "scans last at least D8039";
    M 8040 rw 0 scan "steps do not change";
    M 8041 rw 0 by("IST") "a step program may start";
    M 8042 rw 0 by("IST") "pulse of the start input";
    M 8043 rw 0 by("IST") "the return to the origin is complete";
    M 8044 rw 0 by("IST") "the machine is at its origin";
    M 8045 rw 0 by("IST") "outputs are not reset at a change of mode";
    M 8046 r 0 scan "a step is on (with M8047)";
    M 8047 rw 0 scan "D8040–D8047 and M8046 show the steps";
    M 8050-8055 rw 0 scan "forbids the interrupts of {X0+}";
    M 8061 r 0 scan "hardware error, here of the watchdog, code in D8061";
    M 8063 rw 0 by("serial ports") "communication error, code in D8063";
    M 8064 r 0 inert(CHECKED) "parameter error, code in D8064";
    M 8065 r 0 inert(CHECKED) "syntax error, code in D8065";
    M 8066 r 0 inert(CHECKED) "circuit error, code in D8066";
    M 8067 r 0 scan "operation error, code in D8067";
    M 8068 rw 0 scan "operation error, kept; its step in D8068";
    M 8070-8071 rw 0 by("serial ports") "{master|slave} of a parallel link";
    M 8072-8073 r 0 by("serial ports") "the parallel link {is running|is set up wrongly}";
    M 8121 r 0 by("serial ports") "RS waits to send";
    M 8122 rw 0 by("serial ports") "RS sends";
    M 8123 rw 0 by("serial ports") "RS has received";
    M 8124 r 0 by("serial ports") "RS receives";
    M 8126 r 0 by("serial ports") "computer link: global signal";
    M 8127 r 0 by("serial ports") "computer link: on-demand data is being sent";
    M 8128 r(LINK_1) 0 by("serial ports") "computer link: on-demand data is wrong";
    M 8129 rw 0 by("serial ports") "time-out of RS; computer link: on-demand data is characters, not words";
    M 8162 rw 0 by("serial ports") "fast mode of the parallel link";
    M 8170-8175 rw 0 scan "a pulse came at {X0+}";
    M 8235-8245 rw 0 by("OUT C") "{C235+} counts down";
    M 8246-8255 r 0 by("OUT C") "{C246+} is counting down";
    D 8000 rw 200 scan "longest time of a scan in ms";
    D 8003 r 16 scan "kind of memory";
    D 8004 r 0 scan "number of the error relay that is on, in BCD";
    D 8010 r 0 scan "time of the scan in 0.1 ms";
    D 8011 r 0 scan "shortest time of a scan in 0.1 ms";
    D 8012 r 0 scan "longest time of a scan in 0.1 ms";
    D 8013-8015 rw 0 scan "clock: {second|minute|hour}";
    D 8016-8017 rw 0 scan "clock: {day|month}";
    D 8018 rw 0 scan "clock: year, its last two digits; after a program has written 2000, until power-off, all four";
    D 8019 rw 0 scan "clock: weekday, 0 is Sunday";
    D 8028 rw 0 scan "Z0";
    D 8029 rw 0 scan "V0";
    D 8039 rw 0 scan "constant time of a scan in ms (with M8039)";
    D 8040-8047 r 0 scan "the {lowest|second|third|fourth|fifth|sixth|seventh|eighth} of the steps that are on (with M8047)";
    D 8061 r 0 scan "code of the hardware error: 6105 of the watchdog";
    D 8063 rw 0 by("serial ports") "code of the communication error";
    D 8064 r 0 inert(CHECKED) "code of the parameter error";
    D 8065 r 0 inert(CHECKED) "code of the syntax error";
    D 8066 r 0 inert(CHECKED) "code of the circuit error";
    D 8067 r 0 scan "code of the operation error";
    D 8068 rw 0 scan "step of the operation error, kept";
    D 8069 r 0 scan "step of the error of M8065–M8067";
    D 8070 rw 500 by("serial ports") "error time of the parallel link in ms";
    D 8120-8121 rw 0 by("serial ports") "{communication format|station of a computer link}";
    D 8122-8123 r 0 by("serial ports") "characters that RS {has yet to send|has received}";
    D 8124 rw 2 by("serial ports") "header of RS: STX";
    D 8125 rw 3 by("serial ports") "terminator of RS: ETX";
    D 8127-8129 rw 0 by("serial ports") "computer link: {first register of on-demand data|number of on-demand data|time-out in 10 ms}";
    D 8136-8137 rw 0 by("pulse outputs") "pulses sent at Y000 and Y001, {low|high} word";
    D 8140-8143 rw 0 by("pulse outputs") "pulses sent at {Y0+/2}, {low|high} word";
    D 8173-8175 r 0 by("serial ports") "N:N link: {own station|number of slaves|mode}, as accepted";
    D 8176 rw 0 by("serial ports") "N:N link: own station, 0 the master";
    D 8177 rw 0 by("serial ports") "N:N link: number of slaves, in the master";
    D 8178 rw 0 by("serial ports") "N:N link: mode, in the master";
    D 8179 rw 3 by("serial ports") "N:N link: retries, in the master";
    D 8180 rw 5 by("serial ports") "N:N link: time-out in 10 ms, in the master";
    D 8182 rw 0 scan "Z1";
    D 8183 rw 0 scan "V1";
    D 8184 rw 0 scan "Z2";
    D 8185 rw 0 scan "V2";
    D 8186 rw 0 scan "Z3";
    D 8187 rw 0 scan "V3";
    D 8188 rw 0 scan "Z4";
    D 8189 rw 0 scan "V4";
    D 8190 rw 0 scan "Z5";
    D 8191 rw 0 scan "V5";
    D 8192 rw 0 scan "Z6";
    D 8193 rw 0 scan "V6";
    D 8194 rw 0 scan "Z7";
    D 8195 rw 0 scan "V7";
};

/// Errors of the programming port, on all but FX3U.
pub(super) const PROGRAMMING_PORT: &[Special] = specials! {
    M 8062 rw 0 by("serial ports") "communication error of the programming port, code in D8062";
    D 8062 rw 0 by("serial ports") "code of the communication error of the programming port";
};

/// Additional devices of all but FX1S.
pub(super) const FROM_FX1N: &[Special] = specials! {
    M 8183 r 0 by("serial ports") "N:N link: the master has an error";
    M 8184-8190 r 0 by("serial ports") "N:N link: slave {1+} has an error";
    M 8191 r 0 by("serial ports") "N:N link: data is sent";
    M 8200-8234 rw 0 by("OUT C") "{C200+} counts down";
    D 8201-8202 r 0 by("serial ports") "N:N link: {time|longest time} of an exchange in 10 ms";
    D 8203 r 0 by("serial ports") "N:N link: errors of the master";
    D 8204-8210 r 0 by("serial ports") "N:N link: errors of slave {1+}";
    D 8211 r 0 by("serial ports") "N:N link: error code of the master";
    D 8212-8218 r 0 by("serial ports") "N:N link: error code of slave {1+}";
};

/// Additional devices of FX2N and FX3.
pub(super) const FROM_FX2N: &[Special] = specials! {
    M 8004 r 0 scan "one of the error relays M8060, M8061 and M8064–M8067 is on";
    M 8005 r 0 scan "the battery is low";
    M 8006 r 0 scan "the battery has been low";
    M 8007 r 0 scan "the power has failed for a moment";
    M 8008 r 0 scan "power failure";
    M 8009 r 0 inert(POWER) "the 24 V supply of an extension has failed";
    M 8025 rw 0 by("HSCS, HSCR, HSZ") "comparisons of high-speed counters act at an external reset too";
    M 8030 rw 0 inert(POWER) "the lamp for a low battery stays off";
    M 8056-8058 rw 0 scan "forbids the timer interrupts {I610–I699|I710–I799|I810–I899}";
    M 8059 rw 0 scan "forbids the interrupts of counters";
    M 8060 r 0 inert(HARDWARE) "I/O configuration error, code in D8060";
    M 8069 rw 0 inert(HARDWARE) "checks the I/O bus";
    M 8099 rw 0 scan "starts the ring counter D8099";
    M 8109 r 0 inert(HARDWARE) "output refresh error, number in D8109";
    M 8168 rw 0 by("SMOV") "SMOV moves hexadecimal digits";
    D 8005 r 0 scan "voltage of the battery in 0.1 V";
    D 8006 rw 30 scan "voltage at which the battery is low";
    D 8007 r 0 scan "how often the power has failed";
    D 8008 rw 10 scan "time after which the power has failed, in ms";
    D 8009 r 0 inert(POWER) "extension whose supply has failed";
    D 8060 r 0 inert(HARDWARE) "number of the missing input or output";
    D 8099 rw 0 scan "ring counter of 0.1 ms";
    D 8109 r 0 inert(HARDWARE) "number of the output with a refresh error";
};

/// Additional devices of FX2N and FX3U: modes of instructions that the others lack.
pub(super) const BIG: &[Special] = specials! {
    M 8027 rw 0 by("PR") "PR sends up to 16 characters";
    M 8130 rw 0 by("HSZ") "HSZ works by a table";
    M 8131 r 0 by("HSZ") "HSZ by a table: the last row was reached";
    M 8132 rw 0 by("HSZ") "HSZ gives PLSY its frequencies by a table";
    M 8133 r 0 by("HSZ") "frequencies by HSZ: the last row was reached";
    M 8160 rw 0 by("XCH") "XCH of a device with itself exchanges its bytes";
    M 8167 rw 0 by("HKY") "HKY reads hexadecimal digits";
    D 8020 rw 10 by("REFF") "filter time of the first inputs in ms";
    D 8130 r 0 by("HSZ") "HSZ by a table: row that waits";
    D 8131 r 0 by("HSZ") "frequencies by HSZ: row that waits";
    D 8132-8133 r 0 by("HSZ") "frequencies by HSZ: the present one in Hz, {low|high} word";
    D 8134-8135 r 0 by("HSZ") "frequencies by HSZ: count at which the next one begins, {low|high} word";
};

/// Their counterparts on FX1S, FX1N, FX3S and FX3G.
pub(super) const SMALL: &[Special] = specials! {
    M 8161 rw 0 by("ASCI, HEX, CCD, RS") "one character or byte a word";
    D 8020 rw 10 inert(INPUT_FILTER) "filter time of the first inputs in ms";
};

/// Additional devices of FX2N, FX3G and FX3U: modules and annunciators.
pub(super) const NOT_FX3S: &[Special] = specials! {
    M 8028 rw 0 inert(INTERRUPTS) "interrupts may break FROM and TO";
    M 8048 r 0 scan "an annunciator is on (with M8049)";
    M 8049 rw 0 scan "D8049 and M8048 show the annunciators";
    D 8049 r 0 scan "the lowest annunciator that is on (with M8049)";
};

/// M8028 of FX1S and FX3S.
pub(super) const FAST_TIMERS: &[Special] = specials! {
    M 8028 rw 0 by("OUT T") "T32–T62 count 10 ms instead of 100 ms";
};

/// Relays of pulse outputs, speeds and times of positioning before FX3.
pub(super) const D8145: &[Special] = specials! {
    M 8145-8146 rw 0 by("pulse outputs") "stops the pulses of {Y0+}";
    M 8147-8148 r 0 by("pulse outputs") "pulses are sent at {Y0+}";
    D 8145 rw 0 by("ZRN, DRVI, DRVA") "base speed in Hz";
    D 8146 rw -31072 by("ZRN, DRVI, DRVA") "highest speed in Hz, low word";
    D 8147 rw 1 by("ZRN, DRVI, DRVA") "highest speed in Hz, high word";
    D 8148 rw 100 by("ZRN, DRVI, DRVA") "time of acceleration and deceleration in ms";
};

/// Additional devices of FX1S and FX1N.
pub(super) const FX1: &[Special] = specials! {
    M 8004 r 0 scan "one of the error relays M8061 and M8064–M8067 is on";
    M 8112-8114 rw 0 module(BOARD) "boards FX1N-2AD-BD and FX1N-1DA-BD: range of {channel 1|channel 2|the output}; FX1N-4EX-BD: an input";
    M 8115 rw 0 inert(EXTENSION_BOARDS) "board FX1N-4EX-BD: inputs";
    M 8116-8117 rw 0 inert(EXTENSION_BOARDS) "board FX1N-2EYT-BD: output {1+}";
    M 8140 rw 0 by("ZRN") "clear signal of Y000 at Y002, of Y001 at Y003";
    D 8030-8031 r 0 scan "potentiometer {VR1|VR2}: 0 to 255";
    D 8112-8114 rw 0 module(BOARD) "boards FX1N-2AD-BD and FX1N-1DA-BD: value of {channel 1|channel 2|the output}";
    D 8158-8159 rw -1 inert(DISPLAY) "display module FX1N-5DM: number of the first {register D|relay M} by which a program controls it";
};

/// FX1S: version 2.00, 2 k steps.
pub(super) const FX1S: &[Special] = specials! {
    D 8001 r 22200 scan "model and version";
    D 8002 r 2 scan "program capacity in k steps";
    D 8102 r 2 scan "program capacity in k steps";
};

/// FX1N: version 2.00, 8 k steps.
pub(super) const FX1N: &[Special] = specials! {
    D 8001 r 26200 scan "model and version";
    D 8002 r 8 scan "program capacity in k steps";
    D 8102 r 8 scan "program capacity in k steps";
};

/// FX2N: version 3.10, 8 k steps.
pub(super) const FX2N: &[Special] = specials! {
    M 8075-8079 rw 0 inert(TRACE) "sampling trace";
    M 8104 r 0 inert(HARDWARE) "the extension ROM FX2N-ROM-E1 is fitted";
    M 8154-8156 r 0 inert(INVERTERS) "EXTR: {an error|in work|communication error}";
    M 8161 rw 0 by("ASC, ASCI, HEX, CCD, RS") "one character or byte a word";
    M 8164 rw 0 by("FROM, TO") "D8164 is the number of words";
    D 8001 r 24310 scan "model and version";
    D 8002 r 8 scan "program capacity in k steps";
    D 8074-8098 rw 0 inert(TRACE) "sampling trace";
    D 8102 r 8 scan "program capacity in k steps";
    D 8104-8105 r 0 inert(HARDWARE) "{type|version} of the extension ROM";
    D 8154-8156 rw 0 inert(INVERTERS) "EXTR: {time for answers|step in work|error code}";
    D 8164 rw 0 by("FROM, TO") "number of words (with M8164)";
};

/// Analog adapters of FX3U (FX3 programming manual §37.2.18).
pub(super) const ADAPTERS_3U: &[Special] = specials! {
    M 8260-8269 rw 0 module(ADAPTERS[0]) "first analog adapter: ranges, hold, units";
    M 8270-8279 rw 0 module(ADAPTERS[1]) "second analog adapter: ranges, hold, units";
    M 8280-8289 rw 0 module(ADAPTERS[2]) "third analog adapter: ranges, hold, units";
    M 8290-8299 rw 0 module(ADAPTERS[3]) "fourth analog adapter: ranges, hold, units";
    D 8260-8269 rw 0 module(ADAPTERS[0]) "first analog adapter: values, samples per mean, errors, type";
    D 8270-8279 rw 0 module(ADAPTERS[1]) "second analog adapter: values, samples per mean, errors, type";
    D 8280-8289 rw 0 module(ADAPTERS[2]) "third analog adapter: values, samples per mean, errors, type";
    D 8290-8299 rw 0 module(ADAPTERS[3]) "fourth analog adapter: values, samples per mean, errors, type";
};

/// The first analog board and adapter of FX3S and FX3G (FX3 programming manual §37.2.18).
pub(super) const ADAPTERS_3SG: &[Special] = specials! {
    M 8260-8269 rw 0 module(BOARDS[0]) "analog board: ranges, hold, units";
    M 8280-8289 rw 0 module(ADAPTERS[0]) "analog adapter: ranges, hold, units";
    D 8260-8269 rw 0 module(BOARDS[0]) "analog board: values, samples per mean, errors, type";
    D 8280-8289 rw 0 module(ADAPTERS[0]) "analog adapter: values, samples per mean, errors, type";
};

/// The second ones, which FX3G takes.
pub(super) const ADAPTERS_3G: &[Special] = specials! {
    M 8270-8279 rw 0 module(BOARDS[1]) "second analog board: ranges, hold, units";
    M 8290-8299 rw 0 module(ADAPTERS[1]) "second analog adapter: ranges, hold, units";
    D 8270-8279 rw 0 module(BOARDS[1]) "second analog board: values, samples per mean, errors, type";
    D 8290-8299 rw 0 module(ADAPTERS[1]) "second analog adapter: values, samples per mean, errors, type";
};

/// The same devices on boards that take programs for FX3U.
pub(super) const NO_ADAPTERS: &[Special] = specials! {
    M 8260-8299 rw 0 inert(ADAPTERS_MISSING) "analog adapters, ten relays each: ranges, hold, units";
    D 8260-8299 rw 0 inert(ADAPTERS_MISSING) "analog adapters, ten registers each: values, samples per mean, errors, type";
};

/// Additional devices of FX3S, FX3G and FX3U.
pub(super) const FX3: &[Special] = specials! {
    M 8105 r 0 inert(MAKER) "the program is being changed in RUN";
    M 8151 r 0 inert(INVERTERS) "channel 1: inverter communication: an instruction is in work";
    M 8152-8153 r 0 inert(INVERTERS) "channel 1: inverter communication: {error|error, kept}";
    M 8156 r 0 inert(INVERTERS) "channel 2: inverter communication: an instruction is in work";
    M 8157-8158 r 0 inert(INVERTERS) "channel 2: inverter communication: {error|error, kept}";
    M 8178-8179 rw 0 by("serial ports") "the {parallel|N:N} link is on channel 2";
    M 8198-8199 rw 0 by("OUT C") "four counts a cycle for {C251, C252 and C254|C253 and C255}";
    M 8304 r 0 by("MUL, DIV") "zero flag of multiplication and division";
    M 8306 r 0 by("DIV") "carry flag of division";
    M 8316 r 0 inert(HARDWARE) "an input or output is named that is not fitted";
    M 8318 r 0 inert(HARDWARE) "buffer memory could not be initialised";
    M 8338 rw 0 by("PLSV") "PLSV with ramps";
    M 8340 r 0 by("pulse outputs") "pulses are sent at Y000";
    M 8341 rw 0 by("ZRN, DSZR") "Y000: clear signal";
    M 8342 rw 0 by("DSZR") "Y000: returns forward";
    M 8343-8344 rw 0 by("pulse outputs") "Y000: {forward|reverse} limit";
    M 8345-8346 rw 0 by("DSZR") "Y000: {DOG|zero} signal inverted";
    M 8348 r 0 by("pulse outputs") "Y000: an instruction is driven";
    M 8349 rw 0 by("pulse outputs") "stops the pulses of Y000";
    M 8350 r 0 by("pulse outputs") "pulses are sent at Y001";
    M 8351 rw 0 by("ZRN, DSZR") "Y001: clear signal";
    M 8352 rw 0 by("DSZR") "Y001: returns forward";
    M 8353-8354 rw 0 by("pulse outputs") "Y001: {forward|reverse} limit";
    M 8355-8356 rw 0 by("DSZR") "Y001: {DOG|zero} signal inverted";
    M 8358 r 0 by("pulse outputs") "Y001: an instruction is driven";
    M 8359 rw 0 by("pulse outputs") "stops the pulses of Y001";
    M 8393 r 1 inert(INPUT_DELAY) "contact for the delay of an input interrupt: on in its routine";
    M 8398 rw 0 scan "starts the ring counter D8398";
    M 8401 r 0 by("serial ports") "channel 1: RS2 waits to send; ADPRW is in work";
    M 8402 rw 0 by("serial ports") "channel 1: RS2 sends; the last exchange of Modbus has failed";
    M 8403 rw 0 by("serial ports") "channel 1: RS2 has received; an exchange of Modbus has failed";
    M 8404 r 0 by("serial ports") "channel 1: RS2 receives";
    M 8405 r 0 inert(CONTROL_LINES) "channel 1: DSR is on";
    M 8408 r 0 by("serial ports") "channel 1: ADPRW has sent its request again";
    M 8409 rw 0 by("serial ports") "channel 1: time-out of RS2 or ADPRW";
    M 8411 rw 0 scan "on in the first scan of RUN, in which a program sets Modbus up";
    M 8421 r 0 by("serial ports") "channel 2: RS2 waits to send; ADPRW is in work";
    M 8422 rw 0 by("serial ports") "channel 2: RS2 sends; the last exchange of Modbus has failed";
    M 8423 rw 0 by("serial ports") "channel 2: RS2 has received; an exchange of Modbus has failed";
    M 8424 r 0 by("serial ports") "channel 2: RS2 receives";
    M 8425 r 0 inert(CONTROL_LINES) "channel 2: DSR is on";
    M 8426-8427 r 0 by("serial ports") "channel 2: computer link: {global signal|on-demand data is being sent}";
    M 8428 rw 0 by("serial ports") "channel 2: on-demand data is wrong; ADPRW has sent its request again";
    M 8429 rw 0 by("serial ports") "channel 2: time-out of RS2 or ADPRW; bytes of on-demand data";
    M 8438 rw 0 by("serial ports") "channel 2: communication error, code in D8438";
    M 8449 r 0 inert(HARDWARE) "a special module has an error, code in D8449";
    M 8464-8465 rw 0 by("ZRN, DSZR") "{Y0+}: {D8464+} names the output of the clear signal";
    D 8107 r 0 inert(MAKER) "how many comments of devices the PLC holds";
    D 8108 r 0 inert(MODULE_COUNT) "how many special modules are connected";
    D 8150 rw 0 inert(INVERTERS) "channel 1: inverter communication: time for answers";
    D 8151 r -1 inert(INVERTERS) "channel 1: inverter communication: step in work";
    D 8152 r 0 inert(INVERTERS) "channel 1: inverter communication: error code";
    D 8153 r -1 inert(INVERTERS) "channel 1: inverter communication: step of the error";
    D 8155 rw 0 inert(INVERTERS) "channel 2: inverter communication: time for answers";
    D 8156 r -1 inert(INVERTERS) "channel 2: inverter communication: step in work";
    D 8157 r 0 inert(INVERTERS) "channel 2: inverter communication: error code";
    D 8158 r -1 inert(INVERTERS) "channel 2: inverter communication: step of the error";
    D 8169 r 0 inert(MAKER) "restriction of access to the program";
    D 8312-8313 r 0 inert(SHOWN) "step of D8068 in 32 bits, {low|high} word";
    D 8314-8315 r 0 inert(SHOWN) "step of D8069 in 32 bits, {low|high} word";
    D 8316-8317 r 0 inert(HARDWARE) "step that names an input or output that is not fitted, {low|high} word";
    D 8318-8319 r 0 inert(HARDWARE) "{module|address} of buffer memory that could not be initialised";
    D 8340-8341 rw 0 by("ZRN, PLSV, DRVI, DRVA, DSZR") "Y000: position, {low|high} word";
    D 8342 rw 0 by("ZRN, PLSV, DRVI, DRVA, DSZR") "Y000: base speed in Hz";
    D 8343 rw -31072 by("ZRN, PLSV, DRVI, DRVA, DSZR") "Y000: highest speed in Hz, low word";
    D 8344 rw 1 by("ZRN, PLSV, DRVI, DRVA, DSZR") "Y000: highest speed in Hz, high word";
    D 8345 rw 1000 by("DSZR") "Y000: creep speed in Hz";
    D 8346 rw -15536 by("DSZR") "Y000: speed of the return in Hz, low word";
    D 8347 rw 0 by("DSZR") "Y000: speed of the return in Hz, high word";
    D 8348-8349 rw 100 by("ZRN, PLSV, DRVI, DRVA, DSZR") "Y000: time of {acceleration|deceleration} in ms";
    D 8350-8351 rw 0 by("ZRN, PLSV, DRVI, DRVA, DSZR") "Y001: position, {low|high} word";
    D 8352 rw 0 by("ZRN, PLSV, DRVI, DRVA, DSZR") "Y001: base speed in Hz";
    D 8353 rw -31072 by("ZRN, PLSV, DRVI, DRVA, DSZR") "Y001: highest speed in Hz, low word";
    D 8354 rw 1 by("ZRN, PLSV, DRVI, DRVA, DSZR") "Y001: highest speed in Hz, high word";
    D 8355 rw 1000 by("DSZR") "Y001: creep speed in Hz";
    D 8356 rw -15536 by("DSZR") "Y001: speed of the return in Hz, low word";
    D 8357 rw 0 by("DSZR") "Y001: speed of the return in Hz, high word";
    D 8358-8359 rw 100 by("ZRN, PLSV, DRVI, DRVA, DSZR") "Y001: time of {acceleration|deceleration} in ms";
    D 8393 rw 0 inert(INPUT_DELAY) "delay time of input interrupts in ms";
    D 8398-8399 rw 0 scan "ring counter of 1 ms, 0 to 2147483647, {low|high} word";
    D 8400 rw 0 by("serial ports") "channel 1: communication format; another value than 0 chooses these registers instead of those of RS";
    D 8401 rw 0 by("serial ports") "channel 1: bit 0 Modbus, bit 4 slave, bit 8 ASCII";
    D 8402 r(MODBUS_1) 0 by("serial ports") "channel 1: characters that RS2 has yet to send; code of the last error of Modbus";
    D 8403 r(MODBUS_1) 0 by("serial ports") "channel 1: characters that RS2 has received; details of the last error of Modbus";
    D 8404 r(MODBUS_1) 0 by("serial ports") "channel 1: step of the first ADPRW that failed";
    D 8405 r 0 inert(SHOWN) "channel 1: communication format";
    D 8406 rw 0 inert(DELIMITER) "channel 1: last character of Modbus ASCII";
    D 8407 r 0 by("serial ports") "channel 1: step of the last ADPRW";
    D 8408 r 0 by("serial ports") "channel 1: how often ADPRW has sent its request again";
    D 8409 rw 0 by("serial ports") "channel 1: time-out, of RS2 in 10 ms, of ADPRW in ms";
    D 8410 rw 2 by("serial ports") "channel 1: header of RS2, characters 1 and 2; how long slaves work on a broadcast in ms";
    D 8411 rw 0 by("serial ports") "channel 1: header of RS2, characters 3 and 4; silence between messages of Modbus in ms";
    D 8412 rw 3 by("serial ports") "channel 1: terminator of RS2, characters 1 and 2; retries of ADPRW";
    D 8413 rw 0 by("serial ports") "channel 1: terminator of RS2, characters 3 and 4";
    D 8414 rw 0 by("serial ports") "channel 1: sum that RS2 has received; station of a Modbus slave";
    D 8415 r(COUNTING_1) 0 by("serial ports") "channel 1: sum of what RS2 has received; what a Modbus slave stores of its communication";
    D 8416 r(SLAVE_1) 0 by("serial ports") "channel 1: sum of what RS2 has sent; first register of what a Modbus slave stores";
    D 8419 r 0 inert(SHOWN) "channel 1: mode of operation";
    D 8420 rw 0 by("serial ports") "channel 2: communication format; another value than 0 chooses these registers instead of those of RS";
    D 8421 rw 0 by("serial ports") "channel 2: bit 0 Modbus, bit 4 slave, bit 8 ASCII; station of a computer link";
    D 8422 r(MODBUS_2) 0 by("serial ports") "channel 2: characters that RS2 has yet to send; code of the last error of Modbus";
    D 8423 r(MODBUS_2) 0 by("serial ports") "channel 2: characters that RS2 has received; details of the last error of Modbus";
    D 8424 r(MODBUS_2) 0 by("serial ports") "channel 2: step of the first ADPRW that failed";
    D 8425 r 0 inert(SHOWN) "channel 2: communication format";
    D 8426 rw 0 inert(DELIMITER) "channel 2: last character of Modbus ASCII";
    D 8427 r(LINK_2) 0 by("serial ports") "channel 2: step of the last ADPRW; first register of on-demand data";
    D 8428 r(LINK_2) 0 by("serial ports") "channel 2: how often ADPRW has sent its request again; number of on-demand data";
    D 8429 rw 0 by("serial ports") "channel 2: time-out, of RS2 in 10 ms, of ADPRW in ms";
    D 8430 rw 2 by("serial ports") "channel 2: header of RS2, characters 1 and 2; how long slaves work on a broadcast in ms";
    D 8431 rw 0 by("serial ports") "channel 2: header of RS2, characters 3 and 4; silence between messages of Modbus in ms";
    D 8432 rw 3 by("serial ports") "channel 2: terminator of RS2, characters 1 and 2; retries of ADPRW";
    D 8433 rw 0 by("serial ports") "channel 2: terminator of RS2, characters 3 and 4";
    D 8434 rw 0 by("serial ports") "channel 2: sum that RS2 has received; station of a Modbus slave";
    D 8435 r(COUNTING_2) 0 by("serial ports") "channel 2: sum of what RS2 has received; what a Modbus slave stores of its communication";
    D 8436 r(SLAVE_2) 0 by("serial ports") "channel 2: sum of what RS2 has sent; first register of what a Modbus slave stores";
    D 8438 rw 0 by("serial ports") "channel 2: code of the communication error";
    D 8439 r 0 inert(SHOWN) "channel 2: mode of operation";
    D 8449 r 0 inert(HARDWARE) "code of the error of a special module";
    D 8464-8465 rw 0 by("ZRN, DSZR") "{Y0+}: output of the clear signal (with {M8464+})";
};

/// Additional devices of FX3G and FX3U: outputs from Y002 up.
pub(super) const FX3GU: &[Special] = specials! {
    M 8360 r 0 by("pulse outputs") "pulses are sent at Y002";
    M 8361 rw 0 by("ZRN, DSZR") "Y002: clear signal";
    M 8362 rw 0 by("DSZR") "Y002: returns forward";
    M 8363-8364 rw 0 by("pulse outputs") "Y002: {forward|reverse} limit";
    M 8365-8366 rw 0 by("DSZR") "Y002: {DOG|zero} signal inverted";
    M 8368 r 0 by("pulse outputs") "Y002: an instruction is driven";
    M 8369 rw 0 by("pulse outputs") "stops the pulses of Y002";
    M 8466 rw 0 by("ZRN, DSZR") "Y002: D8466 names the output of the clear signal";
    D 8360-8361 rw 0 by("ZRN, PLSV, DRVI, DRVA, DSZR") "Y002: position, {low|high} word";
    D 8362 rw 0 by("ZRN, PLSV, DRVI, DRVA, DSZR") "Y002: base speed in Hz";
    D 8363 rw -31072 by("ZRN, PLSV, DRVI, DRVA, DSZR") "Y002: highest speed in Hz, low word";
    D 8364 rw 1 by("ZRN, PLSV, DRVI, DRVA, DSZR") "Y002: highest speed in Hz, high word";
    D 8365 rw 1000 by("DSZR") "Y002: creep speed in Hz";
    D 8366 rw -15536 by("DSZR") "Y002: speed of the return in Hz, low word";
    D 8367 rw 0 by("DSZR") "Y002: speed of the return in Hz, high word";
    D 8368-8369 rw 100 by("ZRN, PLSV, DRVI, DRVA, DSZR") "Y002: time of {acceleration|deceleration} in ms";
    D 8466 rw 0 by("ZRN, DSZR") "Y002: output of the clear signal (with M8466)";
};

/// Additional devices of FX3S and FX3G.
pub(super) const FX3SG: &[Special] = specials! {
    M 8075 rw 0 scan "pulses of X000, X001, X003 and X004 are measured";
    M 8076-8079 rw 0 scan "measures the pulses of {X000|X001|X003|X004}";
    M 8080-8083 rw 0 scan "measures the periods of pulses at {X000|X001|X003|X004} instead of their widths";
    M 8139 r 0 by("HSCS, HSCR, HSZ") "a comparison of a high-speed counter is executed";
    M 8329 r 0 by("pulse outputs") "an instruction ended abnormally";
    D 8030-8031 r 0 scan "potentiometer {VR1|VR2}: 0 to 255";
    D 8074-8077 r 0 scan "X000: ring counter of 1/6 us at the {rising edge, low word|rising edge, high word|falling edge, low word|falling edge, high word}";
    D 8078-8079 r 0 scan "X000: width or period of the pulse in 10 us, {low|high} word";
    D 8080-8083 r 0 scan "X001: ring counter of 1/6 us at the {rising edge, low word|rising edge, high word|falling edge, low word|falling edge, high word}";
    D 8084-8085 r 0 scan "X001: width or period of the pulse in 10 us, {low|high} word";
    D 8086-8089 r 0 scan "X003: ring counter of 1/6 us at the {rising edge, low word|rising edge, high word|falling edge, low word|falling edge, high word}";
    D 8090-8091 r 0 scan "X003: width or period of the pulse in 10 us, {low|high} word";
    D 8092-8095 r 0 scan "X004: ring counter of 1/6 us at the {rising edge, low word|rising edge, high word|falling edge, low word|falling edge, high word}";
    D 8096-8097 r 0 scan "X004: width or period of the pulse in 10 us, {low|high} word";
    D 8139 r 0 by("HSCS, HSCR, HSZ") "how many comparisons of high-speed counters are executed";
};

/// FX3S: version 1.00, 4 k steps.
pub(super) const FX3S: &[Special] = specials! {
    D 8001 r 28100 scan "model and version";
    D 8002 r 4 scan "program capacity in k steps";
    D 8101 r 28100 scan "model and version";
    D 8102 r 4 scan "program capacity in k steps";
};

/// FX3G: version 2.00, 32 k steps; RS2 on the programming port.
pub(super) const FX3G: &[Special] = specials! {
    M 8371 r 0 by("serial ports") "programming port: RS2 waits to send";
    M 8372 rw 0 by("serial ports") "programming port: RS2 sends";
    M 8373 rw 0 by("serial ports") "programming port: RS2 has received";
    M 8374 r 0 by("serial ports") "programming port: RS2 receives";
    M 8379 rw 0 by("serial ports") "programming port: time-out of RS2";
    D 8001 r 26200 scan "model and version";
    D 8002 r 8 scan "program capacity in k steps; 8 also where it is more";
    D 8101 r 26200 scan "model and version";
    D 8102 r 32 scan "program capacity in k steps";
    D 8370 rw 0 by("serial ports") "programming port: format of RS2, which takes the port over where it is not 0";
    D 8372 r 0 by("serial ports") "programming port: characters that RS2 has yet to send";
    D 8373 r 0 by("serial ports") "programming port: characters that RS2 has received";
    D 8379 rw 0 by("serial ports") "programming port: time-out of RS2 in 10 ms";
    D 8380 rw 2 by("serial ports") "programming port: header of RS2, characters 1 and 2";
    D 8381 rw 0 by("serial ports") "programming port: header of RS2, characters 3 and 4";
    D 8382 rw 3 by("serial ports") "programming port: terminator of RS2, characters 1 and 2";
    D 8383 rw 0 by("serial ports") "programming port: terminator of RS2, characters 3 and 4";
    D 8384 r 0 by("serial ports") "programming port: sum that RS2 has received";
    D 8385 r 0 by("serial ports") "programming port: sum of what RS2 has received";
    D 8386 r 0 by("serial ports") "programming port: sum of what RS2 has sent";
};

/// FX3U: version 3.20, 64 k steps.
pub(super) const FX3U: &[Special] = specials! {
    M 8075-8079 rw 0 inert(TRACE) "sampling trace";
    M 8090 r 0 by("BKCMP") "all comparisons of BKCMP hold";
    M 8091 rw 0 by("BINDA, COMRD") "no zero after the characters";
    M 8104 r 0 inert(HARDWARE) "function extension memory is fitted";
    M 8107 r 0 inert(MAKER) "comments of devices could not be registered";
    M 8138 r 0 by("HSCT") "on for a scan when the last row of the table was reached";
    M 8139 r 0 by("HSCS, HSCR, HSZ, HSCT") "a comparison of a high-speed counter is executed";
    M 8154 r 0 inert(INVERTERS) "channel 1: inverter communication: IVBWR has an error";
    M 8159 r 0 inert(INVERTERS) "channel 2: inverter communication: IVBWR has an error";
    M 8161 rw 0 by("ASC, ASCI, HEX, CCD, CRC, RS") "one character or byte a word";
    M 8165 rw 0 by("SORT2") "SORT2 sorts in falling order";
    M 8176-8177 rw 0 scan "a pulse came at {X6+}";
    M 8328-8329 r 0 by("RBFM, WBFM") "an instruction {is not carried out|ended abnormally}";
    M 8330-8334 r 0 by("DUTY") "timing pulse {1+} of DUTY";
    M 8336 rw 0 by("DVIT") "D8336 chooses the interrupt inputs";
    M 8347 rw 0 by("DVIT") "Y000: interrupt signal inverted";
    M 8357 rw 0 by("DVIT") "Y001: interrupt signal inverted";
    M 8367 rw 0 by("DVIT") "Y002: interrupt signal inverted";
    M 8370 r 0 by("pulse outputs") "pulses are sent at Y003";
    M 8371 rw 0 by("ZRN, DSZR") "Y003: clear signal";
    M 8372 rw 0 by("DSZR") "Y003: returns forward";
    M 8373-8374 rw 0 by("pulse outputs") "Y003: {forward|reverse} limit";
    M 8375-8376 rw 0 by("DSZR") "Y003: {DOG|zero} signal inverted";
    M 8377 rw 0 by("DVIT") "Y003: interrupt signal inverted";
    M 8378 r 0 by("pulse outputs") "Y003: an instruction is driven";
    M 8379 rw 0 by("pulse outputs") "stops the pulses of Y003";
    M 8380 r 0 inert(COUNTER_INPUTS) "a counter of C235, C241, C244, C246, C247, C249, C251, C252 and C254 counts in hardware";
    M 8381 r 0 inert(COUNTER_INPUTS) "C236 counts in hardware";
    M 8382 r 0 inert(COUNTER_INPUTS) "a counter of C237, C242 and C245 counts in hardware";
    M 8383 r 0 inert(COUNTER_INPUTS) "a counter of C238, C248, C250, C253 and C255 counts in hardware";
    M 8384 r 0 inert(COUNTER_INPUTS) "a counter of C239 and C243 counts in hardware";
    M 8385 r 0 inert(COUNTER_INPUTS) "C240 counts in hardware";
    M 8386-8387 r 0 inert(COUNTER_INPUTS) "{C244|C245} with other inputs counts in hardware";
    M 8388 r 0 inert(COUNTER_INPUTS) "contact that changes functions of high-speed counters";
    M 8389 rw 0 inert(COUNTER_INPUTS) "inverts external reset inputs of high-speed counters";
    M 8390-8391 rw 0 inert(COUNTER_INPUTS) "changes the inputs of {C244|C245}";
    M 8392 rw 0 inert(COUNTER_INPUTS) "changes the inputs of C248 and C253";
    M 8394 r 1 by("HCMOV") "contact for HCMOV in an interrupt routine: on";
    M 8460-8463 rw 0 by("DVIT") "{Y0+}: interrupt signal that the program gives, where D8336 says 8";
    M 8467 rw 0 by("ZRN, DSZR") "Y003: D8467 names the output of the clear signal";
    D 8001 r 24320 scan "model and version";
    D 8002 r 8 scan "program capacity in k steps; 8 also where it is more";
    D 8074-8098 rw 0 inert(TRACE) "sampling trace";
    D 8101 r 16320 scan "model and version";
    D 8102 r 64 scan "program capacity in k steps";
    D 8104-8105 r 0 inert(HARDWARE) "{type|version} of the function extension memory";
    D 8138 r 0 by("HSCT") "the row of the table that waits";
    D 8139 r 0 by("HSCS, HSCR, HSZ, HSCT") "how many comparisons of high-speed counters are executed";
    D 8154 r -1 inert(INVERTERS) "channel 1: inverter communication: parameter of IVBWR with an error";
    D 8159 r -1 inert(INVERTERS) "channel 2: inverter communication: parameter of IVBWR with an error";
    D 8300-8303 rw 0 inert(DISPLAY) "display module: {first register D that controls it|first relay M that controls it|language|contrast}";
    D 8310 rw 1 by("RND") "state of RND, low word";
    D 8311 rw 0 by("RND") "state of RND, high word";
    D 8330-8334 r 0 by("DUTY") "scans counted by DUTY for pulse {1+}";
    D 8336 rw 0 by("DVIT") "a hexadecimal digit for each output, that of Y000 the lowest: 0 to 7 for X000 to X007, 8 for M8460 to M8463";
    D 8370-8371 rw 0 by("ZRN, PLSV, DRVI, DRVA, DSZR") "Y003: position, {low|high} word";
    D 8372 rw 0 by("ZRN, PLSV, DRVI, DRVA, DSZR") "Y003: base speed in Hz";
    D 8373 rw -31072 by("ZRN, PLSV, DRVI, DRVA, DSZR") "Y003: highest speed in Hz, low word";
    D 8374 rw 1 by("ZRN, PLSV, DRVI, DRVA, DSZR") "Y003: highest speed in Hz, high word";
    D 8375 rw 1000 by("DSZR") "Y003: creep speed in Hz";
    D 8376 rw -15536 by("DSZR") "Y003: speed of the return in Hz, low word";
    D 8377 rw 0 by("DSZR") "Y003: speed of the return in Hz, high word";
    D 8378-8379 rw 100 by("ZRN, PLSV, DRVI, DRVA, DSZR") "Y003: time of {acceleration|deceleration} in ms";
    D 8467 rw 0 by("ZRN, DSZR") "Y003: output of the clear signal (with M8467)";
};
