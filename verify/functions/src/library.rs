//! The safety functions.

mod drives;
mod operating;
mod process;
mod stopping;

use crate::{Demand, Form, Function, Kind, Over, Parameter, Presence};

static FUNCTIONS: [&Function; 11] = [
    &operating::TWO_HAND,
    &stopping::EMERGENCY_STOP,
    &stopping::GUARD,
    &operating::MODE_SELECTION,
    &stopping::MUTING,
    &operating::HOLD_TO_RUN,
    &drives::REVERSING,
    &drives::STAR_DELTA,
    &process::LEVEL,
    &process::SEQUENCE,
    &drives::MOVEMENT_TIME_OUT,
];

/// All functions, in the order of the book.
pub fn all() -> impl Iterator<Item = &'static Function> + Clone {
    FUNCTIONS.iter().copied()
}

const fn required(name: &'static str, kind: Kind, text: &'static str) -> Parameter {
    Parameter {
        name,
        kind,
        presence: Presence::Required,
        text,
    }
}

const fn optional(name: &'static str, kind: Kind, text: &'static str) -> Parameter {
    Parameter {
        name,
        kind,
        presence: Presence::Optional,
        text,
    }
}

const fn with_default(
    name: &'static str,
    kind: Kind,
    value: &'static str,
    text: &'static str,
) -> Parameter {
    Parameter {
        name,
        kind,
        presence: Presence::Default(value),
        text,
    }
}

const fn never(name: &'static str, condition: &'static str) -> Demand {
    Demand {
        name,
        over: Over::Once,
        form: Form::Never(condition),
    }
}

const fn reachable(name: &'static str, condition: &'static str) -> Demand {
    Demand {
        name,
        over: Over::Once,
        form: Form::Reachable(condition),
    }
}

/// From `after` on the condition holds, until another does; without `after` once it holds itself.
const fn stays(
    name: &'static str,
    after: &'static str,
    holds: &'static str,
    until: &'static str,
) -> Demand {
    Demand {
        name,
        over: Over::Once,
        form: Form::Stays {
            after,
            holds,
            until,
        },
    }
}

impl Demand {
    /// The same for each of these devices.
    const fn over(self, over: Over) -> Demand {
        Demand { over, ..self }
    }
}
