//! Instructions of a rung in all forms that are needed: as a list, as C written by hand, and the devices they use.

use super::{Device, index};
use super::{compare, display, float, recipe};
use crate::ladder::Kind;
use crate::random::Random;
use rungc_syntax::DeviceClass::{self, D};

/// Words that are calculated with, in all kinds that have instructions of this form.
pub const WORDS: u32 = 200;

/// Position of instructions in a rung.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Form {
    /// With contacts, executed while these conduct.
    Driven,
    /// Executed in each scan.
    Always,
    /// More contacts in front of a coil: the C is an expression.
    Contacts,
}

/// Instructions that belong together.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Driven {
    /// Their position in a rung.
    pub form: Form,
    /// Steps, as these programs count them.
    pub steps: u32,
    /// The instructions, one a line.
    pub list: String,
    /// Statements of the hand-written C, or an expression.
    pub hand: String,
    /// A statement that is executed in each scan, after them.
    pub after: String,
    /// The devices that they read and write, without index registers.
    pub devices: Vec<Device>,
}

impl Driven {
    /// Instructions with contacts; `list` has them with `;` between.
    pub fn new(steps: u32, list: String, hand: String, devices: Vec<Device>) -> Self {
        Driven {
            form: Form::Driven,
            steps,
            list: list.replace(';', "\n") + "\n",
            hand,
            after: String::new(),
            devices,
        }
    }

    /// The same in another form.
    pub fn with(self, form: Form) -> Self {
        Driven { form, ..self }
    }

    /// With bits that it reads or writes, as many from one on.
    pub fn and_bits(mut self, class: DeviceClass, first: u32, count: u32) -> Self {
        let bits = (first..first + count).map(|number| (class, number));
        self.devices.extend(bits);
        self
    }

    /// With a statement that contacts do not govern.
    pub fn then(self, after: String) -> Self {
        Driven { after, ..self }
    }

    /// MOV of a constant, which gives the others something to work on.
    pub fn constant(random: &mut Random) -> Self {
        let [value, a] = [10_000, WORDS].map(|end| random.below(end));
        Driven::new(
            5,
            format!("MOV K{value} D{a}"),
            format!("p->D[{a}] = {value};"),
            words([a]),
        )
    }
}

impl Driven {
    /// DMOV of a constant.
    pub fn long_constant(value: u32, long: u32) -> Self {
        Driven::new(
            9,
            format!("DMOV K{value} D{long}"),
            format!("put_long(&p->D[{long}], {value});"),
            words_and_pairs([], [long]),
        )
    }
}

/// Draws instructions of a kind, of those that have some of this form.
pub fn of(kind: Kind) -> Option<fn(&mut Random) -> Driven> {
    match kind {
        Kind::Index => Some(index::random),
        Kind::Recipe => Some(recipe::random),
        Kind::Display => Some(display::random),
        Kind::Compare => Some(compare::random),
        Kind::Float => Some(float::random),
        Kind::Contacts
        | Kind::Stations
        | Kind::Mixed
        | Kind::Process
        | Kind::Control
        | Kind::Sequence => None,
    }
}

/// Registers.
pub fn words(numbers: impl IntoIterator<Item = u32>) -> Vec<Device> {
    numbers.into_iter().map(|number| (D, number)).collect()
}

/// Assignments to three relays in a row.
pub fn three_relays(first: u32, values: [String; 3]) -> String {
    let values = values.iter().zip(first..);
    let all = values.map(|(value, relay)| format!("p->M[{relay}] = {value};"));
    all.collect::<Vec<_>>().join(" ")
}

/// The registers of some words, and of floats or long words at `pairs`.
pub fn words_and_pairs<const N: usize, const P: usize>(
    singles: [u32; N],
    pairs: [u32; P],
) -> Vec<Device> {
    let pairs = pairs.into_iter().flat_map(|number| [number, number + 1]);
    words(singles.into_iter().chain(pairs))
}
