//! The special devices of pulse outputs, by family of models.

use crate::axis_place as place;
use core::ops::Range;

/// Registers D with the speeds and times of ramps; 0 where the model has none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ramps {
    /// Speed that ramps begin and end with, in Hz.
    pub base: u32,
    /// Pair: highest speed, in Hz.
    pub highest: u32,
    /// Milliseconds from 0 to the highest speed.
    pub up: u32,
    /// Milliseconds from the highest speed to 0.
    pub down: u32,
}

/// A signal that clears the counter of a servo amplifier at the origin. A 0 stands for none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Clear {
    /// Relay without which there is none.
    pub enable: u32,
    /// Output Y on which it is given, unless a register says another.
    pub output: u32,
    /// That register.
    pub register: u32,
    /// Relay without which the register has no say.
    pub chooses: u32,
    /// The hexadecimal digits of the register are those of the output's octal number.
    pub octal: bool,
    /// How long it is on, in milliseconds, besides the scan in which it begins.
    pub ms: u32,
}

/// The special devices of a return to the origin by DSZR. A 0 stands for none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Home {
    /// Relay: it returns forward.
    pub forward: u32,
    /// Relays of the limit switches: forward, reverse.
    pub limits: [u32; 2],
    /// Relay: the DOG is on where its input is off.
    pub dog_inverted: u32,
    /// Relay: the zero signal likewise.
    pub zero_inverted: u32,
    /// Speeds and times.
    pub ramps: Ramps,
    /// Register: speed over the DOG, in Hz.
    pub creep: u32,
    /// Pair: speed of the return, in Hz.
    pub speed: u32,
    /// Its signal.
    pub clear: Clear,
}

/// The signal for which DVIT waits. A 0 stands for none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Interrupt {
    /// Input X that gives it, unless a register says another.
    pub input: u32,
    /// Relay with which the register has a say.
    pub chooses: u32,
    /// That register: a hexadecimal digit for each output, that of Y000 the lowest. 0 to 7 stand for X000 to X007, 8 for the relay.
    pub register: u32,
    /// Relay that gives the signal in an input's place.
    pub relay: u32,
    /// Relay: the signal is there where the input is off.
    pub inverted: u32,
}

/// An input that stops the pulses of an output. A 0 stands for none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StopInput {
    /// Relay without which it stops nothing.
    pub enable: u32,
    /// Register with the number of the input X.
    pub register: u32,
}

/// The special devices of one pulse output. A 0 stands for none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wiring {
    /// First register of an axis (HM), whose registers say everything.
    pub axis: u32,
    /// Pair: the position, which positioning instructions count.
    pub position: u32,
    /// Pair: the pulses of PLSY and PLSR.
    pub pulses: u32,
    /// Pair: the pulses of several outputs.
    pub sum: u32,
    /// Relays that show that pulses are sent.
    pub busy: [u32; 2],
    /// Relays that stop the pulses at once.
    pub stop: [u32; 2],
    /// Relay that shows that an instruction for this output is driven.
    pub driven: u32,
    /// Relay with which a driven instruction begins anew, or takes the output from another one.
    pub restart: u32,
    /// Relay with which numbers of pulses may change while they are sent, and `own` holds instead of `ramps`.
    pub changes: u32,
    /// Ramps of positioning.
    pub ramps: Ramps,
    /// Ramps of this output alone.
    pub own: Ramps,
    /// Relay with which PLSV has ramps.
    pub slides: u32,
    /// Relays of limit switches, forward and reverse, at which all instructions come down.
    pub limits: [u32; 2],
    /// Relay that shows that an instruction came to an end before its time.
    pub aborted: u32,
    /// Relay with which the unit of PWM is 1 µs instead of 1 ms.
    pub micro: u32,
    /// Relay that inverts the pin while PWM is sent.
    pub inverts: u32,
    /// Register with the unit of PWM: 0 and 1 for 10 µs, 2 for 1 ms, 3 for 10 ms.
    pub unit: u32,
    /// Signal of ZRN.
    pub zrn_clear: Clear,
    /// DSZR.
    pub home: Home,
    /// DVIT.
    pub interrupt: Interrupt,
    /// An input that stops the pulses.
    pub stop_input: StopInput,
}

const NO_RAMPS: Ramps = Ramps {
    base: 0,
    highest: 0,
    up: 0,
    down: 0,
};

const NO_CLEAR: Clear = Clear {
    enable: 0,
    output: 0,
    register: 0,
    chooses: 0,
    octal: false,
    ms: 0,
};

const NO_HOME: Home = Home {
    forward: 0,
    limits: [0; 2],
    dog_inverted: 0,
    zero_inverted: 0,
    ramps: NO_RAMPS,
    creep: 0,
    speed: 0,
    clear: NO_CLEAR,
};

const NO_INTERRUPT: Interrupt = Interrupt {
    input: 0,
    chooses: 0,
    register: 0,
    relay: 0,
    inverted: 0,
};

const NO_STOP_INPUT: StopInput = StopInput {
    enable: 0,
    register: 0,
};

const NONE: Wiring = Wiring {
    axis: 0,
    position: 0,
    pulses: 0,
    sum: 0,
    busy: [0; 2],
    stop: [0; 2],
    driven: 0,
    restart: 0,
    changes: 0,
    ramps: NO_RAMPS,
    own: NO_RAMPS,
    slides: 0,
    limits: [0; 2],
    aborted: 0,
    micro: 0,
    inverts: 0,
    unit: 0,
    zrn_clear: NO_CLEAR,
    home: NO_HOME,
    interrupt: NO_INTERRUPT,
    stop_input: NO_STOP_INPUT,
};

/// What D8145 to D8148 say for all outputs (h1u-h2u-programming §4.3.11).
const D8145: Ramps = Ramps {
    base: 8145,
    highest: 8146,
    up: 8148,
    down: 8148,
};

/// H1U and H2U, whose second stop relays are those beside DSZR's (h1u-h2u-programming §8.4 to §8.9). Y003 and Y004 are those of the MTQ
/// and MTP types, Y005 to Y007 those of MTP.
const INOVANCE: [Wiring; 8] = [
    inovance(0, 8140, 8136, 8145, 8147),
    inovance(1, 8142, 8136, 8146, 8148),
    inovance(2, 8150, 0, 8152, 8149),
    without_dszr(inovance(3, 8152, 0, 8153, 8150)),
    without_dszr(inovance(4, 8154, 0, 8154, 8151)),
    of_mtp(5, 8138, 8155, 8144, 8030, 8161),
    of_mtp(6, 8162, 8156, 8158, 8032, 8196),
    of_mtp(7, 8170, 8157, 8159, 8172, 8197),
];

const fn inovance(output: u32, position: u32, sum: u32, stop: u32, busy: u32) -> Wiring {
    Wiring {
        position,
        pulses: position,
        sum,
        busy: [busy, 8440 + 10 * output],
        stop: [stop, 8449 + 10 * output],
        driven: 8448 + 10 * output,
        restart: 8085 + output,
        changes: 8135 + output,
        ramps: D8145,
        own: Ramps {
            base: 8034 + output,
            highest: 8050 + 2 * output,
            up: 8104 + output,
            down: 8165 + output,
        },
        aborted: 8429,
        micro: 8095 + output,
        // For one scan (h1u-h2u-programming §8.9).
        zrn_clear: Clear {
            enable: 8140,
            register: 8156 + output,
            ..NO_CLEAR
        },
        home: Home {
            clear: Clear {
                enable: 8441 + 10 * output,
                output: 4 + output,
                register: 8484 + output,
                chooses: 8484 + output,
                octal: false,
                ms: 20,
            },
            ..home(8440 + 10 * output)
        },
        stop_input: StopInput {
            enable: 8141 + output,
            register: 8161 + output,
        },
        ..NONE
    }
}

/// The types with more than three outputs have no DSZR, and no inputs that stop pulses.
const fn without_dszr(wiring: Wiring) -> Wiring {
    Wiring {
        busy: [wiring.busy[0], 0],
        stop: [wiring.stop[0], 0],
        driven: 0,
        home: NO_HOME,
        stop_input: NO_STOP_INPUT,
        ..wiring
    }
}

/// The last three outputs of MTP have their devices elsewhere, and their pulses cause no interrupts.
const fn of_mtp(
    output: u32,
    position: u32,
    stop: u32,
    busy: u32,
    highest: u32,
    clear: u32,
) -> Wiring {
    Wiring {
        changes: 8136 + output,
        own: Ramps {
            base: 8088 + output,
            highest,
            up: 8082 + output,
            down: 8085 + output,
        },
        micro: 0,
        zrn_clear: Clear {
            enable: 8140,
            register: clear,
            ..NO_CLEAR
        },
        ..without_dszr(inovance(output, position, 0, stop, busy))
    }
}

/// The relays and registers of a return, which lie alike from this number on.
const fn home(first: u32) -> Home {
    Home {
        forward: first + 2,
        limits: [first + 3, first + 4],
        dog_inverted: first + 5,
        zero_inverted: first + 6,
        ramps: Ramps {
            base: first + 2,
            highest: first + 3,
            up: first + 8,
            down: first + 9,
        },
        creep: first + 5,
        speed: first + 6,
        clear: NO_CLEAR,
    }
}

/// M8340 and D8340 on, ten of each for an output (l01s-programming §7.1, and FX3G, FX3U).
const fn tens(output: u32) -> Wiring {
    let ten = 10 * output;
    Wiring {
        position: 8340 + ten,
        busy: [8340 + ten, 0],
        stop: [8349 + ten, 0],
        driven: 8348 + ten,
        ramps: Ramps {
            base: 8342 + ten,
            highest: 8343 + ten,
            up: 8348 + ten,
            down: 8349 + ten,
        },
        limits: [8343 + ten, 8344 + ten],
        aborted: 8329,
        home: home(8340 + ten),
        ..NONE
    }
}

/// L01S has neither ramps of PLSV, nor a clear signal, nor an inverted DOG.
const fn l01s(output: u32) -> Wiring {
    Wiring {
        inverts: 8473 + output,
        unit: 8473 + output,
        home: Home {
            dog_inverted: 0,
            ..home(8340 + 10 * output)
        },
        ..tens(output)
    }
}

const L01S: [Wiring; 4] = [l01s(0), l01s(1), l01s(2), l01s(3)];

const fn fx3(output: u32) -> Wiring {
    let clear = Clear {
        enable: 8341 + 10 * output,
        output: 4 + output,
        register: 8464 + output,
        chooses: 8464 + output,
        octal: true,
        ms: 20,
    };
    Wiring {
        slides: 8338,
        zrn_clear: clear,
        home: Home {
            clear,
            ..home(8340 + 10 * output)
        },
        interrupt: Interrupt {
            input: output,
            chooses: 8336,
            register: 8336,
            relay: 8460 + output,
            inverted: 8347 + 10 * output,
        },
        ..tens(output)
    }
}

/// The first two outputs also have the devices of FX2N.
const fn fx3_as_fx2n(output: u32) -> Wiring {
    Wiring {
        pulses: 8140 + 2 * output,
        sum: 8136,
        busy: [8340 + 10 * output, 8147 + output],
        stop: [8349 + 10 * output, 8145 + output],
        ..fx3(output)
    }
}

const FX3: [Wiring; 4] = [fx3_as_fx2n(0), fx3_as_fx2n(1), fx3(2), fx3(3)];

const fn fx2n(output: u32) -> Wiring {
    Wiring {
        position: 8140 + 2 * output,
        pulses: 8140 + 2 * output,
        sum: 8136,
        busy: [8147 + output, 0],
        stop: [8145 + output, 0],
        ramps: D8145,
        ..NONE
    }
}

const FX2N: [Wiring; 2] = [fx2n(0), fx2n(1)];

/// FX1S and FX1N: as FX2N, and with M8140 ZRN clears the counter of the amplifier by Y002 for Y000, by Y003 for Y001 (FX1S/FX1N/FX2N
/// programming manual II §5.16).
const fn fx1(output: u32) -> Wiring {
    Wiring {
        zrn_clear: Clear {
            enable: 8140,
            output: 2 + output,
            ms: 20,
            ..NO_CLEAR
        },
        ..fx2n(output)
    }
}

const FX1: [Wiring; 2] = [fx1(0), fx1(1)];

/// Outputs of FX2N-compatible boards: those that FX2N lacks have no special devices that are known.
const FX2N_BOARD: [Wiring; 8] = [fx2n(0), fx2n(1), NONE, NONE, NONE, NONE, NONE, NONE];

/// Outputs of FX3U-compatible boards, likewise.
const FX3_BOARD: [Wiring; 8] = [FX3[0], FX3[1], FX3[2], FX3[3], NONE, NONE, NONE, NONE];

const fn of_axis(number: u32) -> Wiring {
    Wiring {
        axis: 300 + 50 * number,
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

impl Pulses {
    /// The outputs, Y000 first.
    pub const fn outputs(self) -> &'static [Wiring] {
        match self {
            Pulses::Without => &[],
            Pulses::Inovance => &INOVANCE,
            Pulses::L01s => &L01S,
            Pulses::Fx2n => &FX2N,
            Pulses::Fx3 => &FX3,
            Pulses::Hm => &HM,
            Pulses::Fx1 => &FX1,
            Pulses::Board2n => &FX2N_BOARD,
            Pulses::Board3u => &FX3_BOARD,
        }
    }

    /// Highest speed in Hz.
    pub const fn highest_hz(self) -> u32 {
        match self {
            Pulses::L01s => 200_000,
            Pulses::Hm => 600_000,
            _ => 100_000,
        }
    }

    /// Whether DRVI and DRVA raise a speed below √(highest speed / 2·time) to it.
    pub const fn raises_speeds(self) -> bool {
        !matches!(self, Pulses::L01s)
    }

    /// The fewest pulses that PLSR sends (h1u-h2u-programming §4.3.6).
    pub const fn fewest_with_ramps(self) -> u32 {
        match self {
            Pulses::Inovance | Pulses::Fx1 | Pulses::Fx2n | Pulses::Board2n => 110,
            _ => 1,
        }
    }

    /// Code of an instruction for an output that another one uses (h1u-h2u-programming §8.2).
    pub const fn conflict(self) -> u16 {
        match self {
            Pulses::Inovance => 6770,
            _ => 6764,
        }
    }
}

/// Which registers an instruction looks at besides its operands, and those in which pulses are counted.
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
    const fn registers(self) -> [u32; 5] {
        let high = self.highest + (self.highest > 0) as u32;
        [self.base, self.highest, high, self.up, self.down]
    }
}

/// Inputs that the registers of an axis may name.
const AXIS_INPUTS: u32 = 16;

impl Wiring {
    /// Inputs X whose edges an instruction takes notice of at once if it names them; others are looked at once a scan.
    pub const FAST_INPUTS: u32 = 8;

    /// The inputs X, besides those that it names, at which an instruction looks, `chosen` telling whether a register may choose the
    /// interrupt input.
    pub fn inputs(&self, looks: Looks, chosen: bool) -> Range<u32> {
        match (self.axis, looks.interrupt, chosen) {
            (1.., ..) => 0..AXIS_INPUTS,
            (_, true, true) => 0..Self::FAST_INPUTS,
            (_, true, false) => self.interrupt.input..self.interrupt.input + 1,
            (_, false, _) => 0..0,
        }
    }

    /// The registers that an instruction looks at.
    pub fn registers(&self, looks: Looks) -> impl Iterator<Item = u32> {
        let home = self.home;
        let pair = |low: u32| [low, if low > 0 { low + 1 } else { 0 }];
        let counters = pair(self.pulses).into_iter().chain(pair(self.sum));
        let ramps = pair(self.position)
            .into_iter()
            .chain(self.ramps.registers())
            .chain(self.own.registers())
            .filter(move |_| looks.ramps);
        let home = home
            .ramps
            .registers()
            .into_iter()
            .chain(pair(home.speed))
            .chain([home.creep])
            .filter(move |_| looks.home);
        let unit = looks.unit.then_some(self.unit);
        let clears = [self.zrn_clear.register, self.home.clear.register];
        let clears = clears.into_iter().filter(move |_| looks.clears);
        let interrupt = looks.interrupt.then_some(self.interrupt.register);
        let clears = clears.chain(interrupt);
        let of_axis = match self.axis {
            0 => 0..0,
            first => first..first + place::COUNT,
        };
        let outputs = match self.axis {
            0 => 0..0,
            _ => place::PULSES..place::PULSES + 2 * place::OUTPUTS,
        };
        let all = counters.chain(ramps).chain(home).chain(unit).chain(clears);
        // How many outputs are in use limits the speed of each.
        let bindings = match self.axis {
            0 => &[][..],
            _ => &HM[..],
        };
        let bindings = bindings.iter().map(|wiring| wiring.axis + place::OUTPUT);
        let all = all.chain(of_axis).chain(outputs).chain(bindings);
        all.filter(|&register| register > 0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn registers_are_those_that_a_model_has() {
        let of = |wiring: &Wiring, looks| {
            let registers = wiring.registers(looks);
            registers.collect::<std::vec::Vec<u32>>()
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
