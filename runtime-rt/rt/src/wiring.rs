//! The special devices of pulse outputs, by family of models.

use crate::axis_place as place;
use crate::special::{D_OUTPUT_USE, Register, Relay};
use core::ops::Range;

/// Registers D with the speeds and times of ramps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ramps {
    /// Speed that ramps begin and end with, in Hz.
    pub base: Register,
    /// Pair: highest speed, in Hz.
    pub highest: Register,
    /// Milliseconds from 0 to the highest speed.
    pub up: Register,
    /// Milliseconds from the highest speed to 0.
    pub down: Register,
}

/// A signal that clears the counter of a servo amplifier at the origin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Clear {
    /// Relay without which there is none.
    pub enable: Relay,
    /// Output Y on which it is given, unless a register says another.
    pub output: u32,
    /// That register.
    pub register: Option<Register>,
    /// Relay without which the register is ignored; `None`: it always counts.
    pub chooses: Option<Relay>,
    /// The hexadecimal digits of the register are those of the output's octal number.
    pub octal: bool,
    /// On-time in milliseconds, in addition to the scan in which it starts.
    pub ms: u32,
}

impl Clear {
    /// Output that its register names with this value: 16 for H20, which stands for Y020, if digits are octal; `None`
    /// if one of them is not.
    pub fn named(self, value: u16) -> Option<u32> {
        if !self.octal {
            return Some(value.into());
        }
        let digits = [12, 8, 4, 0].map(|shift| u32::from(value >> shift & 15));
        let octal = digits.iter().all(|&digit| digit < 8);
        octal.then(|| digits.iter().fold(0, |number, digit| 8 * number + digit))
    }
}

/// The special devices of a return to the origin by DSZR.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Home {
    /// It returns forward.
    pub forward: Relay,
    /// Limit switches: forward, reverse.
    pub limits: [Relay; 2],
    /// The DOG is on where its input is off.
    pub dog_inverted: Option<Relay>,
    /// The zero signal likewise.
    pub zero_inverted: Relay,
    /// Speeds and times.
    pub ramps: Ramps,
    /// Speed over the DOG, in Hz.
    pub creep: Register,
    /// Pair: speed of the return, in Hz.
    pub speed: Register,
    /// Its signal.
    pub clear: Option<Clear>,
}

/// The signal for which DVIT waits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Interrupt {
    /// Input X that gives it, unless a register says another.
    pub input: u32,
    /// Relay with which the register counts.
    pub chooses: Option<Relay>,
    /// That register: a hexadecimal digit for each output, that of Y000 the lowest. 0 to 7 stand for X000 to X007, 8
    /// for the relay.
    pub register: Option<Register>,
    /// Relay that gives the signal in an input's place.
    pub relay: Option<Relay>,
    /// The signal is there where the input is off.
    pub inverted: Option<Relay>,
}

/// An input that stops the pulses of an output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StopInput {
    /// Relay without which it stops nothing.
    pub enable: Relay,
    /// Register with the number of the input X.
    pub register: Register,
}

/// The special devices of one pulse output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wiring {
    /// First register of an axis (HM), whose registers say everything.
    pub axis: Option<Register>,
    /// Pair: the position, which positioning instructions count.
    pub position: Option<Register>,
    /// Pair: the pulses of PLSY and PLSR.
    pub pulses: Option<Register>,
    /// Pair: the pulses of several outputs.
    pub sum: Option<Register>,
    /// Relays that show that pulses are sent.
    pub busy: [Option<Relay>; 2],
    /// Relays that stop the pulses at once.
    pub stop: [Option<Relay>; 2],
    /// Relay that shows that an instruction for this output is driven.
    pub driven: Option<Relay>,
    /// Relay with which a driven instruction begins anew, or takes the output from another one.
    pub restart: Option<Relay>,
    /// Relay with which numbers of pulses may change while they are sent, and `own` holds instead of `ramps`.
    pub changes: Option<Relay>,
    /// Ramps of positioning.
    pub ramps: Option<Ramps>,
    /// Ramps of this output alone.
    pub own: Option<Ramps>,
    /// Relay with which PLSV has ramps.
    pub slides: Option<Relay>,
    /// Relays of limit switches, forward and reverse, at which all instructions come down.
    pub limits: [Option<Relay>; 2],
    /// Relay that shows that an instruction came to an end before its time.
    pub aborted: Option<Relay>,
    /// Relay with which the unit of PWM is 1 µs instead of 1 ms.
    pub micro: Option<Relay>,
    /// Relay that inverts the pin while PWM is sent.
    pub inverts: Option<Relay>,
    /// Register with the unit of PWM: 0 and 1 for 10 µs, 2 for 1 ms, 3 for 10 ms.
    pub unit: Option<Register>,
    /// Signal of ZRN.
    pub zrn_clear: Option<Clear>,
    /// DSZR.
    pub home: Option<Home>,
    /// DVIT.
    pub interrupt: Interrupt,
    /// An input that stops the pulses.
    pub stop_input: Option<StopInput>,
}

/// An output without any special device.
const NONE: Wiring = Wiring {
    axis: None,
    position: None,
    pulses: None,
    sum: None,
    busy: [None; 2],
    stop: [None; 2],
    driven: None,
    restart: None,
    changes: None,
    ramps: None,
    own: None,
    slides: None,
    limits: [None; 2],
    aborted: None,
    micro: None,
    inverts: None,
    unit: None,
    zrn_clear: None,
    home: None,
    interrupt: Interrupt {
        input: 0,
        chooses: None,
        register: None,
        relay: None,
        inverted: None,
    },
    stop_input: None,
};

const fn m(number: u16) -> Option<Relay> {
    Some(Relay(number))
}

const fn d(number: u16) -> Option<Register> {
    Some(Register(number))
}

/// Ramps of all outputs, set by D8145 to D8148 (h1u-h2u-programming §4.3.11).
const D8145: Ramps = Ramps {
    base: Register(8145),
    highest: Register(8146),
    up: Register(8148),
    down: Register(8148),
};

/// H1U and H2U, whose second stop relays are those beside DSZR's (h1u-h2u-programming §8.4 to §8.9). Y003 and Y004 are
/// those of the MTQ and MTP types, Y005 to Y007 those of MTP.
const INOVANCE: [Wiring; 8] = [
    inovance(0, 8140, d(8136), 8145, 8147),
    inovance(1, 8142, d(8136), 8146, 8148),
    inovance(2, 8150, None, 8152, 8149),
    without_dszr(inovance(3, 8152, None, 8153, 8150)),
    without_dszr(inovance(4, 8154, None, 8154, 8151)),
    of_mtp(5, 8138, 8155, 8144, 8030, 8161),
    of_mtp(6, 8162, 8156, 8158, 8032, 8196),
    of_mtp(7, 8170, 8157, 8159, 8172, 8197),
];

const fn inovance(
    output: u16,
    position: u16,
    sum: Option<Register>,
    stop: u16,
    busy: u16,
) -> Wiring {
    Wiring {
        position: d(position),
        pulses: d(position),
        sum,
        busy: [m(busy), m(8440 + 10 * output)],
        stop: [m(stop), m(8449 + 10 * output)],
        driven: m(8448 + 10 * output),
        restart: m(8085 + output),
        changes: m(8135 + output),
        ramps: Some(D8145),
        own: Some(Ramps {
            base: Register(8034 + output),
            highest: Register(8050 + 2 * output),
            up: Register(8104 + output),
            down: Register(8165 + output),
        }),
        aborted: m(8429),
        micro: m(8095 + output),
        zrn_clear: Some(zrn_clear_of_a_scan(8156 + output)),
        home: Some(Home {
            clear: Some(Clear {
                enable: Relay(8441 + 10 * output),
                output: 4 + output as u32,
                register: d(8484 + output),
                chooses: m(8484 + output),
                octal: false,
                ms: 20,
            }),
            ..home(8440 + 10 * output)
        }),
        stop_input: Some(StopInput {
            enable: Relay(8141 + output),
            register: Register(8161 + output),
        }),
        ..NONE
    }
}

/// The signal of ZRN on H1U and H2U, which is on for one scan (h1u-h2u-programming §8.9).
const fn zrn_clear_of_a_scan(register: u16) -> Clear {
    Clear {
        enable: Relay(8140),
        output: 0,
        register: d(register),
        chooses: None,
        octal: false,
        ms: 0,
    }
}

/// The types with more than three outputs have no DSZR, and no inputs that stop pulses.
const fn without_dszr(wiring: Wiring) -> Wiring {
    Wiring {
        busy: [wiring.busy[0], None],
        stop: [wiring.stop[0], None],
        driven: None,
        home: None,
        stop_input: None,
        ..wiring
    }
}

/// The last three outputs of MTP have their devices elsewhere, and their pulses cause no interrupts.
const fn of_mtp(
    output: u16,
    position: u16,
    stop: u16,
    busy: u16,
    highest: u16,
    clear: u16,
) -> Wiring {
    Wiring {
        changes: m(8136 + output),
        own: Some(Ramps {
            base: Register(8088 + output),
            highest: Register(highest),
            up: Register(8082 + output),
            down: Register(8085 + output),
        }),
        micro: None,
        zrn_clear: Some(zrn_clear_of_a_scan(clear)),
        ..without_dszr(inovance(output, position, None, stop, busy))
    }
}

/// The relays and registers of a return, which lie alike from this number on.
const fn home(first: u16) -> Home {
    Home {
        forward: Relay(first + 2),
        limits: [Relay(first + 3), Relay(first + 4)],
        dog_inverted: m(first + 5),
        zero_inverted: Relay(first + 6),
        ramps: Ramps {
            base: Register(first + 2),
            highest: Register(first + 3),
            up: Register(first + 8),
            down: Register(first + 9),
        },
        creep: Register(first + 5),
        speed: Register(first + 6),
        clear: None,
    }
}

/// M8340 and D8340 on, ten of each for an output (l01s-programming §7.1, and FX3G, FX3U).
const fn tens(output: u16) -> Wiring {
    let first = 8340 + 10 * output;
    Wiring {
        position: d(first),
        busy: [m(first), None],
        stop: [m(first + 9), None],
        driven: m(first + 8),
        ramps: Some(Ramps {
            base: Register(first + 2),
            highest: Register(first + 3),
            up: Register(first + 8),
            down: Register(first + 9),
        }),
        limits: [m(first + 3), m(first + 4)],
        aborted: m(8329),
        home: Some(home(first)),
        ..NONE
    }
}

/// L01S has neither ramps of PLSV, nor a clear signal, nor an inverted DOG.
const fn l01s(output: u16) -> Wiring {
    Wiring {
        inverts: m(8473 + output),
        unit: d(8473 + output),
        home: Some(Home {
            dog_inverted: None,
            ..home(8340 + 10 * output)
        }),
        ..tens(output)
    }
}

const L01S: [Wiring; 4] = [l01s(0), l01s(1), l01s(2), l01s(3)];

const fn fx3(output: u16) -> Wiring {
    let clear = Some(Clear {
        enable: Relay(8341 + 10 * output),
        output: 4 + output as u32,
        register: d(8464 + output),
        chooses: m(8464 + output),
        octal: true,
        ms: 20,
    });
    Wiring {
        slides: m(8338),
        zrn_clear: clear,
        home: Some(Home {
            clear,
            ..home(8340 + 10 * output)
        }),
        interrupt: Interrupt {
            input: output as u32,
            chooses: m(8336),
            register: d(8336),
            relay: m(8460 + output),
            inverted: m(8347 + 10 * output),
        },
        ..tens(output)
    }
}

/// The first two outputs also have the counts of FX2N.
const fn fx3_as_fx2n(output: u16) -> Wiring {
    Wiring {
        pulses: d(8140 + 2 * output),
        sum: d(8136),
        ..fx3(output)
    }
}

const FX3: [Wiring; 4] = [fx3_as_fx2n(0), fx3_as_fx2n(1), fx3(2), fx3(3)];

const fn fx2n(output: u16) -> Wiring {
    Wiring {
        position: d(8140 + 2 * output),
        pulses: d(8140 + 2 * output),
        sum: d(8136),
        busy: [m(8147 + output), None],
        stop: [m(8145 + output), None],
        ramps: Some(D8145),
        ..NONE
    }
}

const FX2N: [Wiring; 2] = [fx2n(0), fx2n(1)];

/// FX1S and FX1N: as FX2N, and with M8140 ZRN clears the counter of the amplifier by Y002 for Y000, by Y003 for Y001
/// (FX1S/FX1N/FX2N programming manual II §5.16).
const fn fx1(output: u16) -> Wiring {
    Wiring {
        zrn_clear: Some(Clear {
            enable: Relay(8140),
            output: 2 + output as u32,
            register: None,
            chooses: None,
            octal: false,
            ms: 20,
        }),
        ..fx2n(output)
    }
}

const FX1: [Wiring; 2] = [fx1(0), fx1(1)];

/// Outputs of FX2N-compatible boards: those that FX2N lacks have no special devices that are known.
const FX2N_BOARD: [Wiring; 8] = [fx2n(0), fx2n(1), NONE, NONE, NONE, NONE, NONE, NONE];

/// Outputs of FX3U-compatible boards, likewise.
const FX3_BOARD: [Wiring; 8] = [FX3[0], FX3[1], FX3[2], FX3[3], NONE, NONE, NONE, NONE];

const fn of_axis(number: u16) -> Wiring {
    Wiring {
        axis: d(300 + 50 * number),
        ..NONE
    }
}

const HM: [Wiring; 6] = [
    of_axis(0),
    of_axis(1),
    of_axis(2),
    of_axis(3),
    of_axis(4),
    of_axis(5),
];

/// The pulse outputs of a family of models.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(u8)]
pub enum Pulses {
    /// None, or none that instructions name by output.
    Without = 0,
    /// H1U, H2U.
    Inovance = 1,
    /// L01S.
    L01s = 2,
    /// FX2N.
    Fx2n = 3,
    /// FX3G, FX3U.
    Fx3 = 4,
    /// HM: axes, which are bound to outputs.
    Hm = 5,
    /// FX1S, FX1N.
    Fx1 = 6,
    /// FX2N-compatible boards.
    Board2n = 7,
    /// FX3U-compatible boards.
    Board3u = 8,
}

/// Common properties of a family's pulse outputs.
struct Family {
    outputs: &'static [Wiring],
    lowest_hz: u32,
    highest_hz: u32,
    raises_speeds: bool,
    fewest_with_ramps: u32,
    conflict: u16,
}

/// Properties of most families.
const PLAIN: Family = Family {
    outputs: &[],
    lowest_hz: 1,
    highest_hz: 100_000,
    raises_speeds: true,
    fewest_with_ramps: 1,
    conflict: 6764,
};

impl Pulses {
    const fn family(self) -> Family {
        match self {
            Pulses::Without => PLAIN,
            Pulses::Inovance => Family {
                outputs: &INOVANCE,
                fewest_with_ramps: 110,
                conflict: 6770,
                ..PLAIN
            },
            Pulses::L01s => Family {
                outputs: &L01S,
                lowest_hz: 10,
                highest_hz: 200_000,
                raises_speeds: false,
                ..PLAIN
            },
            Pulses::Fx2n => Family {
                outputs: &FX2N,
                fewest_with_ramps: 110,
                ..PLAIN
            },
            Pulses::Fx3 => Family {
                outputs: &FX3,
                ..PLAIN
            },
            Pulses::Hm => Family {
                outputs: &HM,
                highest_hz: 600_000,
                ..PLAIN
            },
            Pulses::Fx1 => Family {
                outputs: &FX1,
                fewest_with_ramps: 110,
                ..PLAIN
            },
            Pulses::Board2n => Family {
                outputs: &FX2N_BOARD,
                fewest_with_ramps: 110,
                ..PLAIN
            },
            Pulses::Board3u => Family {
                outputs: &FX3_BOARD,
                ..PLAIN
            },
        }
    }

    /// The outputs, Y000 first.
    pub const fn outputs(self) -> &'static [Wiring] {
        self.family().outputs
    }

    /// Lowest speed of PLSY in Hz.
    pub const fn lowest_hz(self) -> u32 {
        self.family().lowest_hz
    }

    /// Highest speed in Hz.
    pub const fn highest_hz(self) -> u32 {
        self.family().highest_hz
    }

    /// Returns true if DRVI and DRVA raise a speed below √(highest speed / 2·time) to it.
    pub const fn raises_speeds(self) -> bool {
        self.family().raises_speeds
    }

    /// The fewest pulses that PLSR sends (h1u-h2u-programming §4.3.6).
    pub const fn fewest_with_ramps(self) -> u32 {
        self.family().fewest_with_ramps
    }

    /// Code of an instruction for an output that another one uses (h1u-h2u-programming §8.2).
    pub const fn conflict(self) -> u16 {
        self.family().conflict
    }
}

/// Registers that an instruction reads in addition to its operands, and those in which pulses are counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Looks {
    /// The position, and speeds and times of ramps.
    pub ramps: bool,
    /// Those of DSZR.
    pub home: bool,
    /// The unit of PWM.
    pub unit: bool,
    /// The outputs for clear signals.
    pub clears: bool,
    /// The interrupt input.
    pub interrupt: bool,
}

impl Ramps {
    const fn registers(self) -> [Register; 5] {
        [
            self.base,
            self.highest,
            self.highest.after(1),
            self.up,
            self.down,
        ]
    }
}

/// Inputs that the registers of an axis may name.
const AXIS_INPUTS: u32 = 16;

impl Wiring {
    /// Inputs X whose edges an instruction takes notice of at once if it names them; others are looked at once a scan.
    pub const FAST_INPUTS: u32 = 8;

    /// The inputs X, in addition to those that it names, that an instruction reads, `chosen` telling whether a register
    /// may choose the interrupt input.
    pub fn inputs(&self, looks: Looks, chosen: bool) -> Range<u32> {
        match (self.axis, looks.interrupt, chosen) {
            (Some(_), ..) => 0..AXIS_INPUTS,
            (None, true, true) => 0..Self::FAST_INPUTS,
            (None, true, false) => self.interrupt.input..self.interrupt.input + 1,
            (None, false, _) => 0..0,
        }
    }

    /// The registers that an instruction looks at.
    pub fn registers(&self, looks: Looks) -> impl Iterator<Item = Register> {
        let pairs = |low: Option<Register>| low.into_iter().flat_map(Register::run::<2>);
        let counters = pairs(self.pulses).chain(pairs(self.sum));
        let ramps = [self.ramps, self.own].into_iter().flatten();
        let ramps = pairs(self.position)
            .chain(ramps.flat_map(Ramps::registers))
            .filter(move |_| looks.ramps);
        let home = self.home.into_iter().filter(move |_| looks.home);
        let home = home.flat_map(|home| {
            let speeds = home.speed.run::<2>().into_iter().chain([home.creep]);
            home.ramps.registers().into_iter().chain(speeds)
        });
        let unit = self.unit.filter(|_| looks.unit);
        let clears = [self.zrn_clear, self.home.and_then(|home| home.clear)];
        let clears = clears.into_iter().flatten().filter(move |_| looks.clears);
        let clears = clears.filter_map(|clear| clear.register);
        let interrupt = self.interrupt.register.filter(|_| looks.interrupt);
        counters
            .chain(ramps)
            .chain(home)
            .chain(unit)
            .chain(clears)
            .chain(interrupt)
            .chain(self.axis.into_iter().flat_map(of_axes))
    }

    /// Relays that the runtime writes: they show pulses, and instructions that send them.
    pub fn shown_relays(&self) -> impl Iterator<Item = Relay> {
        let relays = self.busy.into_iter().chain([self.driven, self.aborted]);
        relays.flatten()
    }

    /// Registers that the runtime writes: counts of pulses, and on HM all of axes.
    pub fn shown_registers(&self) -> impl Iterator<Item = Register> {
        let counts = [self.position, self.pulses, self.sum].into_iter().flatten();
        let uses = self.axis.map(|_| D_OUTPUT_USE.run::<16>());
        counts
            .flat_map(Register::run::<2>)
            .chain(self.axis.into_iter().flat_map(of_axes))
            .chain(uses.into_iter().flatten())
    }
}

/// The registers of an axis, those in which outputs are counted, and those that bind axes: how many outputs are in use
/// limits the speed of each.
fn of_axes(first: Register) -> impl Iterator<Item = Register> {
    let own = first.run::<{ place::COUNT as usize }>();
    let counted = place::PULSES.run::<{ 2 * place::OUTPUTS as usize }>();
    let axes = HM.iter().filter_map(|wiring| wiring.axis);
    let bindings = axes.map(|axis| axis.after(place::OUTPUT));
    own.into_iter().chain(counted).chain(bindings)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn registers_are_those_that_a_model_has() {
        let of = |wiring: &Wiring, looks| {
            let registers = wiring.registers(looks);
            let numbers = registers.map(Register::number);
            numbers.collect::<std::vec::Vec<u32>>()
        };
        let ramps = Looks {
            ramps: true,
            ..Looks::default()
        };
        assert_eq!(
            of(&INOVANCE[2], ramps),
            [
                8150, 8151, 8150, 8151, 8145, 8146, 8147, 8148, 8148, 8036, 8054, 8055, 8106, 8167
            ]
        );
        assert_eq!(
            of(&L01S[1], ramps),
            [8350, 8351, 8352, 8353, 8354, 8358, 8359]
        );
        assert_eq!(of(&L01S[0], Looks::default()), []);
    }
}
