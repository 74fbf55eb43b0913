//! Safety functions as properties with parameters, and cause-and-effect matrices.
//!
//! A row of rungc.toml with `use = "two-hand"` stands for the demands of a function, each of which becomes a property
//! with its own verdict; one with `matrix = "cause-effect.csv"` stands for those of all cells. What becomes of them are
//! rows as a user writes them, in the language of conditions: all that proves, searches and reports properties takes
//! them as they are. This crate must not know what a condition means. Start reading at [`properties`]; the functions
//! are in [`library`].
#![deny(missing_docs)]

mod expand;
pub mod library;
pub mod matrix;
pub mod page;
mod template;

pub use expand::{Expanded, Part, properties};

/// A safety function: demands on a program, with parameters.
#[derive(Debug)]
pub struct Function {
    /// Name in rungc.toml: lower case, words joined by `-`.
    pub name: &'static str,
    /// Title, as a noun phrase.
    pub title: &'static str,
    /// Standard whose idea it follows, with the part of it.
    pub standard: &'static str,
    /// Purpose of the function, in plain words.
    pub text: &'static str,
    /// Parameters, those that are required first.
    pub parameters: &'static [Parameter],
    /// Demands, in the order of verdicts.
    pub demands: &'static [Demand],
    /// Limits: what a proof of all demands does not say.
    pub limits: &'static str,
    /// Parameters for both programs, as lines of rungc.toml.
    pub example: &'static str,
    /// An instruction list that violates the demand [`Function::violates`].
    pub wrong: &'static str,
    /// Name of the demand that the wrong program violates.
    pub violates: &'static str,
    /// An instruction list that satisfies all demands.
    pub right: &'static str,
}

/// A parameter of a function.
#[derive(Debug)]
pub struct Parameter {
    /// Key in rungc.toml.
    pub name: &'static str,
    /// Kind of its value.
    pub kind: Kind,
    /// Presence.
    pub presence: Presence,
    /// Meaning, as a noun phrase.
    pub text: &'static str,
}

/// Kind of a parameter.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Kind {
    /// A condition, often a single input: it holds while a button is pressed.
    Condition,
    /// A bit device that the program switches (Y, M or S), or its comment.
    Device,
    /// One such device, or a list.
    Devices,
    /// A list of at least two such devices.
    Several,
    /// A duration.
    Time,
}

impl Kind {
    /// The kind in words.
    pub fn describe(self) -> &'static str {
        match self {
            Kind::Condition => "condition",
            Kind::Device => "device",
            Kind::Devices => "device or list of devices",
            Kind::Several => "list of devices",
            Kind::Time => "time",
        }
    }
}

/// Presence of a parameter.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Presence {
    /// It has no default.
    Required,
    /// Default value, as written in rungc.toml.
    Default(&'static str),
    /// Without it, the demands and parts of conditions that name it are left out.
    Optional,
}

/// A demand of a function, which becomes a property, or several.
#[derive(Debug)]
pub struct Demand {
    /// Name of its violation: `output without the left button`. `{a}` and `{b}` are the devices of [`Over`].
    pub name: &'static str,
    /// Devices for each of which the property is demanded.
    pub over: Over,
    /// Form of the property, with placeholders in its conditions.
    pub form: Form,
}

/// Devices for which a demand is repeated; `{a}` and `{b}` are their placeholders.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Over {
    /// None: a single property.
    Once,
    /// Each device of a parameter, as `{a}`.
    Each(&'static str),
    /// The first device of a parameter, as `{a}`.
    First(&'static str),
    /// Each pair of devices of a parameter, as `{a}` and `{b}`.
    Pairs(&'static str),
    /// Each device of a parameter that has a successor, and the successor.
    Next(&'static str),
}

/// Form of a demand: a property of which the conditions are templates.
///
/// `{name}` stands for a parameter, of a list for any of its devices; a part in `[…]` is left out if a parameter in
/// it is not given.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Form {
    /// It holds after no scan.
    Never(&'static str),
    /// There is a run after which it holds.
    Reachable(&'static str),
    /// The second follows the first, within the time that a parameter gives.
    Whenever {
        /// Triggering condition.
        when: &'static str,
        /// Condition that must follow.
        then: &'static str,
        /// Parameter with the time limit.
        within: &'static str,
    },
    /// From `after` on the condition holds, until another does.
    Stays {
        /// Condition from which on it must hold; empty: itself.
        after: &'static str,
        /// Condition that must hold.
        holds: &'static str,
        /// Condition that ends it.
        until: &'static str,
    },
}

impl Form {
    /// The templates in it, with the name of the parameter that is its time.
    pub fn templates(&self) -> [&'static str; 3] {
        match *self {
            Form::Never(only) | Form::Reachable(only) => [only, "", ""],
            Form::Whenever { when, then, .. } => [when, then, ""],
            Form::Stays {
                after,
                holds,
                until,
            } => [after, holds, until],
        }
    }
}

/// The function of this name.
pub fn find(name: &str) -> Option<&'static Function> {
    library::all().find(|function| function.name == name)
}
