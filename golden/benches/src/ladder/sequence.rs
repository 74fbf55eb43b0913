//! Step ladders: sequences of states, each of them a ring, as machines of several stations are programmed. A state
//! drives a relay and an output, starts a timer, sets or resets a flag that other sequences read, and is left when its
//! time is over and its contacts conduct; some states have two ways on, of which an input chooses one. A button leads
//! all sequences back to their first state.
//!
//! The hand-written C has one variable for the active state of a sequence and one for its time, and a `switch`. What it
//! has to compare is what a machine sees: outputs, relays and flags, but no states and no timers.

use super::list::{contact as list_contact, name};
use super::{Contact, Device, TERMINALS, hand};
use crate::random::Random;
use rungc_syntax::DeviceClass::{M, S, T, X, Y};
use std::fmt::Write;

/// The first state; those of a sequence follow each other.
const FIRST_STATE: u32 = 20;
/// Maximum number of states that sequences have altogether.
const STATES: u32 = 4000;
/// States of a sequence, at least, and one more than at most.
const LENGTH: (u32, u32) = (10, 14);
/// Steps of a program for each sequence: 14 of them, of some 160 states, in 1000. They have a few more.
const SEQUENCE_STEPS: u32 = 71;
/// The relay of the first state; each state has its own.
const RELAYS: u32 = 100;
/// Relays that states set and reset.
const LATCHES: u32 = 5000;
const LATCH_COUNT: u32 = 64;
/// Outputs of a sequence, as long as there are any.
const OUTPUTS: u32 = 2;
/// The button that leads back to the first states.
const STOP: Contact = Contact {
    device: (X, 0),
    negated: false,
};
/// Timers with their units in milliseconds, without those for subroutines and retentive ones.
const TIMERS: [(std::ops::Range<u32>, u32); 3] = [(0..192, 100), (200..246, 10), (256..512, 1)];

/// A state of a sequence.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct State {
    /// Coils, some of them with a contact.
    coils: Vec<(Device, Option<Contact>)>,
    /// A relay that it sets or resets.
    latch: Option<(u32, bool)>,
    /// Its timer's number, and the preset in milliseconds.
    timer: Option<(u32, u32)>,
    /// Contacts in series through which it is left.
    exit: Vec<Contact>,
    /// The input that chooses between the next state, when it is off, and the one after it.
    choice: Option<u32>,
}

/// A ring of states.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Sequence {
    /// Device number of its first state.
    first: u32,
    states: Vec<State>,
}

/// Sequences of about this many steps, and the number of steps. There is room for 4000 states; a program of them does
/// not get longer.
pub fn sequences(random: &mut Random, steps: u32) -> (Vec<Sequence>, u32) {
    let mut timers = TIMERS
        .into_iter()
        .flat_map(|(all, unit)| all.map(move |n| (n, unit)));
    let mut sequences: Vec<Sequence> = Vec::new();
    let (mut first, mut counted) = (FIRST_STATE, 3);
    let count = (steps / SEQUENCE_STEPS).max(1) as usize;
    while sequences.len() < count && first + LENGTH.1 < STATES {
        let mut generator = Generator {
            random,
            timers: &mut timers,
            number: sequences.len() as u32,
            others: first - FIRST_STATE,
        };
        let states = generator.states();
        // And twice SET of its first state.
        counted += 2 + states.iter().map(State::steps).sum::<u32>();
        let next = first + states.len() as u32;
        sequences.push(Sequence { first, states });
        first = next;
    }
    (sequences, counted)
}

/// Draws the states of a sequence.
struct Generator<'a, Timers> {
    random: &'a mut Random,
    timers: &'a mut Timers,
    /// Number of the sequence.
    number: u32,
    /// Number of states of the sequences before it.
    others: u32,
}

impl<Timers: Iterator<Item = (u32, u32)>> Generator<'_, Timers> {
    fn states(&mut self) -> Vec<State> {
        let length = self.random.between(LENGTH.0, LENGTH.1);
        let mut states: Vec<State> = (0..length).map(|at| self.state(at, length)).collect();
        // No state is entered twice in a scan, and none again in the scan in which it ends.
        states[0].exit.push(Contact {
            negated: true,
            ..STOP
        });
        let gate = (X, 1 + self.random.below(TERMINALS - 1));
        for (state, negated) in states[1..3].iter_mut().zip([false, true]) {
            state.exit.push(Contact {
                device: gate,
                negated,
            });
        }
        states
    }

    fn state(&mut self, at: u32, length: u32) -> State {
        let mut coils = Vec::new();
        if self.random.chance(0.7) {
            let gate = self.random.chance(0.4).then(|| self.gate());
            coils.push(((M, RELAYS + self.others + at), gate));
        }
        let output = OUTPUTS * self.number + at % OUTPUTS;
        if self.random.chance(0.5) && output < TERMINALS && (1..length - 1).contains(&at) {
            coils.push(((Y, output), None));
        }
        let latch = self.random.chance(0.15);
        let latch = latch.then(|| (self.latch(), self.random.chance(0.5)));
        let timer = match at != 0 && self.random.chance(0.6) {
            true => self.timers.next(),
            false => None,
        };
        let timer = timer.map(|(number, _)| (number, 100 * self.random.between(1, 13)));
        let mut exit = Vec::new();
        if timer.is_none() {
            exit.push(self.input());
        }
        if self.random.chance(0.5) {
            exit.push(self.interlock());
        }
        let choice = (3..length - 2).contains(&at) && self.random.chance(0.2);
        State {
            coils,
            latch,
            timer,
            exit,
            choice: choice.then(|| 1 + self.random.below(TERMINALS - 1)),
        }
    }

    fn latch(&mut self) -> u32 {
        LATCHES + self.random.below(LATCH_COUNT)
    }

    fn input(&mut self) -> Contact {
        Contact {
            device: (X, 1 + self.random.below(TERMINALS - 1)),
            negated: self.random.chance(0.3),
        }
    }

    /// Contact in front of a coil: an input, a flag or a relay of another sequence.
    fn gate(&mut self) -> Contact {
        let what = self.random.fraction();
        let device = if what < 0.4 {
            return self.input();
        } else if what < 0.7 || self.others == 0 {
            (M, self.latch())
        } else {
            (M, RELAYS + self.random.below(self.others))
        };
        let negated = self.random.chance(0.3);
        Contact { device, negated }
    }

    /// Contact that a sequence waits for: an input, or another sequence that is elsewhere.
    fn interlock(&mut self) -> Contact {
        if self.others == 0 || self.random.chance(0.6) {
            return self.input();
        }
        Contact {
            device: (M, RELAYS + self.random.below(self.others)),
            negated: true,
        }
    }
}

impl State {
    fn steps(&self) -> u32 {
        let coils = self
            .coils
            .iter()
            .map(|(_, gate)| 1 + u32::from(gate.is_some()));
        let exit = self.exit.len() as u32 + 1 + u32::from(self.timer.is_some());
        let ways = if self.choice.is_some() { exit + 2 } else { 0 };
        let timer = if self.timer.is_some() { 3 } else { 0 };
        1 + coils.sum::<u32>() + u32::from(self.latch.is_some()) + timer + exit + ways
    }

    /// The contacts through which it is left, with the timer's.
    fn exits(&self) -> impl Iterator<Item = Contact> {
        let timer = self.timer.map(|(number, _)| Contact {
            device: (T, number),
            negated: false,
        });
        timer.into_iter().chain(self.exit.iter().copied())
    }

    fn list(&self, out: &mut String, number: u32, next: u32, is_last: bool) {
        // Writing to a String does not fail.
        let _ = writeln!(out, "STL S{number}");
        // Coils with contacts come last: what follows is with them, too.
        for (device, _) in self.coils.iter().filter(|(_, gate)| gate.is_none()) {
            let _ = writeln!(out, "OUT {}", name(*device));
        }
        if let Some((latch, on)) = self.latch {
            let _ = writeln!(out, "{} M{latch}", if on { "SET" } else { "RST" });
        }
        if let Some((timer, ms)) = self.timer {
            let _ = writeln!(out, "OUT T{timer} K{}", ms / unit(timer));
        }
        for (device, gate) in &self.coils {
            if let Some(gate) = gate {
                list_contact(out, "LD", gate);
                let _ = writeln!(out, "OUT {}", name(*device));
            }
        }
        let ways: &[Option<bool>] = match self.choice {
            Some(_) => &[Some(false), Some(true)],
            None => &[None],
        };
        for (way, target) in ways.iter().zip(next..) {
            let choice = self.choice.zip(*way).map(|(input, on)| Contact {
                device: (X, input),
                negated: !on,
            });
            for (contact, i) in self.exits().chain(choice).zip(0..) {
                list_contact(out, if i == 0 { "LD" } else { "AND" }, &contact);
            }
            let set = if is_last { "OUT" } else { "SET" };
            let _ = writeln!(out, "{set} S{target}");
        }
    }

    /// The case of the hand-written `switch`; `at` is its place in the ring of these states.
    fn hand(&self, out: &mut String, at: usize, ring: &[State]) {
        // Writing to a String does not fail.
        let _ = writeln!(out, "  case {at}:");
        for (device, gate) in &self.coils {
            let on = gate.as_ref().map_or("true".to_string(), hand::contact);
            let _ = writeln!(out, "    p->{} = {on};", hand::place(*device));
        }
        if let Some((latch, on)) = self.latch {
            let _ = writeln!(out, "    p->M[{latch}] = {on};");
        }
        let timer = self.timer.map(|_| "!s->remaining_ms".to_string());
        let contacts = timer.into_iter().chain(self.exit.iter().map(hand::contact));
        let exit: Vec<String> = contacts.collect();
        let enter = |to: usize| {
            let ms = ring[to].timer.map_or(0, |(_, ms)| ms);
            format!("enter(s, {to}, {ms});")
        };
        let to = (at + 1) % ring.len();
        let _ = writeln!(out, "    if (!({})) return false;", exit.join(" & "));
        let _ = match self.choice {
            Some(input) => writeln!(
                out,
                "    if (p->X[{input}]) {} else {}",
                enter(to + 1),
                enter(to)
            ),
            None => writeln!(out, "    {}", enter(to)),
        };
        let _ = writeln!(out, "    return {};", to != 0);
    }
}

/// Milliseconds of a timer's unit.
fn unit(timer: u32) -> u32 {
    let found = TIMERS.iter().find(|(all, _)| all.contains(&timer));
    found.map_or(100, |(_, unit)| *unit)
}

/// The sequences as a list, with what starts them.
pub fn list(sequences: &[Sequence], out: &mut String) {
    let (Some(first), Some(last)) = (sequences.first(), sequences.last()) else {
        return;
    };
    let end = last.first + last.states.len() as u32 - 1;
    let sets: String = sequences
        .iter()
        .map(|s| format!("SET S{}\n", s.first))
        .collect();
    // Writing to a String does not fail.
    let _ = write!(
        out,
        "LD M8002\n{sets}LDP X000\nZRST S{} S{end}\n{sets}",
        first.first
    );
    for sequence in sequences {
        let last = sequence.states.len() - 1;
        for ((at, state), number) in sequence.states.iter().enumerate().zip(sequence.first..) {
            let next = if at == last {
                sequence.first
            } else {
                number + 1
            };
            state.list(out, number, next, at == last);
        }
    }
    out.push_str("RET\n");
}

/// The sequences as a function of C.
pub fn hand(sequences: &[Sequence], prefix: &str, out: &mut String) {
    for (i, sequence) in sequences.iter().enumerate() {
        hand_sequence(sequence, i, out);
    }
    // Writing to a String does not fail.
    let _ = writeln!(out, "void {prefix}_scan(struct plc *p, uint32_t dt) {{");
    out.push_str("  const bool stop = rising(&p->stopped, p->X[0]);\n");
    for i in 0..sequences.len() {
        let _ = writeln!(out, "  sequence{i}(p, &p->sequence[{i}], stop, dt);");
    }
    out.push_str("}\n");
}

fn hand_sequence(sequence: &Sequence, i: usize, out: &mut String) {
    let ring = &sequence.states;
    // Writing to a String does not fail.
    let _ = writeln!(out, "/* Switches the outputs of a state off. */");
    let _ = writeln!(
        out,
        "static void leave{i}(struct plc *p, unsigned state) {{\n  switch (state) {{"
    );
    for (at, state) in ring
        .iter()
        .enumerate()
        .filter(|(_, state)| !state.coils.is_empty())
    {
        let _ = write!(out, "  case {at}:");
        for (device, _) in &state.coils {
            let _ = write!(out, " p->{} = false;", hand::place(*device));
        }
        out.push_str(" break;\n");
    }
    out.push_str("  }\n}\n/* Runs the active state; true if a later one is active now, which runs, too. */\n");
    let _ = writeln!(
        out,
        "static bool step{i}(struct plc *p, struct sequence *s) {{\n  switch (s->state) {{"
    );
    for (at, state) in ring.iter().enumerate() {
        state.hand(out, at, ring);
    }
    let _ = writeln!(
        out,
        "  default: return false;\n  }}\n}}\n\
         static void sequence{i}(struct plc *p, struct sequence *s, bool stop, uint32_t dt) {{\n\
         \x20 sequence_begin(s, stop, dt);\n\
         \x20 for (unsigned state = 0; s->left; state++, s->left >>= 1)\n    if (s->left & 1u) leave{i}(p, state);\n\
         \x20 while (step{i}(p, s)) {{}}\n}}"
    );
}

impl Sequence {
    /// The devices that it reads and writes.
    pub fn devices(&self) -> Vec<Device> {
        let mut devices = Vec::new();
        for (state, number) in self.states.iter().zip(self.first..) {
            devices.push((S, number));
            devices.extend(state.exits().map(|contact| contact.device));
            for (device, gate) in &state.coils {
                devices.push(*device);
                devices.extend(gate.map(|contact| contact.device));
            }
            devices.extend(state.latch.map(|(latch, _)| (M, latch)));
            devices.extend(state.choice.map(|input| (X, input)));
        }
        devices
    }
}
