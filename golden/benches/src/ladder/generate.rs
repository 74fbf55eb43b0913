//! Random programs. The order in which numbers are drawn is part of what a seed means.

use super::driven::Form;
use super::{
    Action, Chain, Contact, Control, Device, Driven, FLAGS, Kind, Ladder, Operation, Process,
    RELAYS, Rung, TERMINALS, control, driven, sequence,
};
use crate::random::Random;
use rungc_syntax::DeviceClass::{self, M, X, Y};

/// Rungs of a station, and how far the relays of stations are apart.
const STATION_RUNGS: u32 = 8;
const STATION_RELAYS: u32 = 10;

/// Steps of a station, about.
const STATION_STEPS: u32 = 41;

/// Inputs and outputs of a station.
const STATION_TERMINALS: u32 = 4;

/// Timers, counters and registers that `mixed` uses, and relays that it sets.
const TIMERS: u32 = 200;
const COUNTERS: u32 = 100;
const REGISTERS: u32 = 200;
const SET_RELAYS: u32 = 3000;

/// A program of a kind.
pub fn ladder(kind: Kind, steps: u32, seed: u32) -> Ladder {
    let mut generator = Generator {
        random: Random::new(seed),
        steps: 0,
        coils: FLAGS,
        outputs: 0,
        timers: 0,
        counters: 0,
        loops: 0,
    };
    let mut sequences = Vec::new();
    let mut rungs = match kind {
        Kind::Stations => generator.stations(steps),
        Kind::Sequence => {
            (sequences, generator.steps) = sequence::sequences(&mut generator.random, steps);
            Vec::new()
        }
        _ => generator.rungs(kind, steps),
    };
    rungs.splice(0..0, control::settings_of(generator.loops));
    Ladder {
        kind,
        rungs,
        sequences,
        steps: generator.steps + 1,
    }
}

/// A contact of a station's rung, which each station has with its own devices.
struct Part {
    /// `G` is a mode flag, `M` the station's own relay.
    class: char,
    number: u32,
    negated: bool,
    parallel: bool,
}

impl Part {
    fn contact(&self, station: u32) -> Contact {
        let terminal = (STATION_TERMINALS * station + self.number % STATION_TERMINALS) % TERMINALS;
        let device = match self.class {
            'X' => (X, terminal),
            'Y' => (Y, terminal),
            'G' => (M, self.number),
            _ => (M, station_relay(station, self.number)),
        };
        Contact {
            device,
            negated: self.negated,
        }
    }
}

fn station_relay(station: u32, number: u32) -> u32 {
    FLAGS + STATION_RELAYS * station + number
}

struct Generator {
    random: Random,
    steps: u32,
    /// The next relay to drive.
    coils: u32,
    /// The next output to drive.
    outputs: u32,
    timers: u32,
    counters: u32,
    /// PID loops.
    loops: u32,
}

impl Generator {
    fn stations(&mut self, steps: u32) -> Vec<Rung> {
        let stations = (steps / STATION_STEPS).max(1);
        let stations = stations.min((RELAYS - FLAGS) / STATION_RELAYS);
        let template: Vec<Vec<Part>> = (0..STATION_RUNGS).map(|_| self.parts()).collect();
        let mut rungs = Vec::new();
        for station in 0..stations {
            for (parts, relay) in template.iter().zip(0..) {
                self.steps += parts.len() as u32 + 1;
                let rest = parts[1..].iter().map(|p| (p.contact(station), p.parallel));
                rungs.push(Rung {
                    chain: Chain {
                        first: parts[0].contact(station),
                        rest: rest.collect(),
                    },
                    block: None,
                    action: Action::Coil((M, station_relay(station, relay))),
                });
            }
        }
        rungs
    }

    /// One rung of all stations: three to five contacts.
    fn parts(&mut self) -> Vec<Part> {
        let classes = ['X', 'X', 'Y', 'M', 'M', 'M', 'G'];
        let count = self.random.between(3, 6);
        let mut part = || Part {
            class: self.random.choice(&classes),
            number: self.random.below(STATION_RUNGS),
            negated: self.random.chance(0.3),
            parallel: self.random.chance(0.35),
        };
        (0..count).map(|_| part()).collect()
    }

    fn rungs(&mut self, kind: Kind, steps: u32) -> Vec<Rung> {
        let mut rungs = Vec::new();
        let draw = driven::of(kind);
        while self.steps + 1 < steps {
            if kind == Kind::Control && self.random.chance(0.4) {
                rungs.push(self.control().rung());
                continue;
            }
            if let Some(draw) = draw
                && self.random.chance(0.45)
            {
                rungs.push(self.driven(draw));
                continue;
            }
            let chain = self.chain();
            let block = self.random.chance(0.3).then(|| {
                let block = self.chain();
                self.steps += 1;
                (block, self.random.chance(0.5))
            });
            let what = self.random.fraction();
            let action = match kind {
                Kind::Mixed => self.action(what),
                Kind::Process if what < 0.4 => {
                    let (steps, process) = Process::random(&mut self.random);
                    self.steps += steps;
                    Action::Process(process)
                }
                // Targets and measured values change.
                Kind::Control if what < 0.3 => self.change(),
                _ => self.coil(),
            };
            rungs.push(Rung {
                chain,
                block,
                action,
            });
        }
        rungs
    }

    /// Adds a rung with instructions of a kind.
    fn driven(&mut self, draw: fn(&mut Random) -> Driven) -> Rung {
        let driven = draw(&mut self.random);
        self.steps += driven.steps;
        let chain = match driven.form {
            Form::Always => Chain {
                first: control::ALWAYS_ON,
                rest: Vec::new(),
            },
            Form::Driven | Form::Contacts => self.chain(),
        };
        let coil = (driven.form == Form::Contacts).then(|| self.coil_device());
        Rung {
            chain,
            block: None,
            action: Action::Driven(driven, coil),
        }
    }

    /// Adds an instruction of `control`; a loop with its settings.
    fn control(&mut self) -> Control {
        let before = self.loops;
        let (steps, control) = Control::random(&mut self.random, &mut self.loops);
        self.steps += steps + (self.loops - before) * control::SETTINGS_STEPS;
        control
    }

    /// MOV of a constant to a target or a measured value.
    fn change(&mut self) -> Action {
        self.steps += 5;
        let value = self.random.below(1000);
        Action::Constant(value, control::limited(&mut self.random))
    }

    fn chain(&mut self) -> Chain {
        let first = self.contact();
        let count = self.random.between(1, 5);
        let mut contact = || {
            let contact = self.contact();
            (contact, self.random.chance(0.35))
        };
        let rest = (0..count).map(|_| contact()).collect();
        self.steps += count + 1;
        Chain { first, rest }
    }

    fn contact(&mut self) -> Contact {
        let device = self.contact_device();
        let negated = self.random.chance(0.3);
        Contact { device, negated }
    }

    fn contact_device(&mut self) -> Device {
        let what = self.random.fraction();
        if what < 0.25 {
            (X, self.random.below(TERMINALS))
        } else if what < 0.35 {
            (Y, self.random.below(TERMINALS))
        } else if what < 0.5 {
            (M, self.random.below(FLAGS))
        } else if what < 0.85 {
            let back = self.random.below(30) + 1;
            (M, self.coils.saturating_sub(back))
        } else {
            (M, self.random.below(self.coils))
        }
    }

    /// Instruction driven by a rung of `mixed`.
    fn action(&mut self, what: f64) -> Action {
        if what < 0.08 {
            self.timer()
        } else if what < 0.14 {
            let number = self.counters % COUNTERS;
            self.counters += 1;
            self.steps += 3;
            Action::Counter(number, self.random.between(1, 50))
        } else if what < 0.34 {
            self.calculation()
        } else if what < 0.44 {
            let set = self.random.below(2) == 0;
            let relay = self.random.below(SET_RELAYS);
            self.steps += 1;
            match set {
                true => Action::Set(relay),
                false => Action::Reset(relay),
            }
        } else {
            self.coil()
        }
    }

    /// A timer that has no coil yet, or a coil when all have one: a timer with several coils counts once in a scan,
    /// which code written by hand has no use for.
    fn timer(&mut self) -> Action {
        if self.timers == TIMERS {
            return self.coil();
        }
        self.timers += 1;
        self.steps += 3;
        Action::Timer(self.timers - 1, self.random.between(1, 500))
    }

    /// An instruction with registers. The operands of all of them are drawn, whichever it is.
    fn calculation(&mut self) -> Action {
        let which = self.random.below(8);
        let mut number = |end| self.random.below(end);
        let constant = Action::Constant(number(1000), number(REGISTERS));
        let move_once = Action::MoveOnce(number(REGISTERS), number(REGISTERS));
        let increment = Action::IncrementOnce(number(REGISTERS));
        let compare = Action::Compare(number(REGISTERS), number(1000), number(SET_RELAYS));
        let registers = [0; 3].map(|_| number(REGISTERS));
        let (steps, action) = match which {
            0 => (5, constant),
            1 => (7, Action::Arithmetic(Operation::Add, registers)),
            2 => (7, Action::Arithmetic(Operation::Sub, registers)),
            3 => (5, move_once),
            4 => (3, increment),
            5 => (7, compare),
            6 => (13, Action::Arithmetic(Operation::AddLong, registers)),
            _ => (7, Action::Arithmetic(Operation::And, registers)),
        };
        self.steps += steps;
        action
    }

    /// OUT of an output, or of the next relay.
    fn coil(&mut self) -> Action {
        Action::Coil(self.coil_device())
    }

    fn coil_device(&mut self) -> Device {
        self.steps += 1;
        let output = self.random.chance(0.1) && self.outputs < TERMINALS;
        let (class, next): (DeviceClass, _) = match output {
            true => (Y, &mut self.outputs),
            false => (M, &mut self.coils),
        };
        let number = *next;
        *next += 1;
        self.coils = self.coils.min(RELAYS - 1);
        (class, number)
    }
}
