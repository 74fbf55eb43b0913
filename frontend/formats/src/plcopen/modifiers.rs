//! The attributes by which an element or a pin changes what passes it: `negated`, `edge` and `storage`.

use super::logic::Logic;
use super::{Fault, called};
use roxmltree::Node;

/// Modifiers of one way through an element or a pin.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub(super) struct Modifiers {
    pub negated: bool,
    pub edge: Option<Edge>,
    pub storage: Option<Storage>,
}

/// A change of the value.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Edge {
    Rising,
    Falling,
}

/// A lasting effect on the variable.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Storage {
    Set,
    Reset,
}

/// The modifiers that a reader of an element acts on.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Accepted {
    /// All of them: coils and output variables.
    All,
    /// `negated` and `edge`: contacts and input variables.
    Read,
    /// `negated` alone: outputs of blocks.
    Negated,
    /// None of them: numbers, jumps.
    None,
}

/// Names of the attributes that an element has for a value that passes it; `In` and `Out` for the two ways of an
/// `inOutVariable`.
pub(super) const ONE_WAY: [&str; 3] = ["negated", "edge", "storage"];
pub(super) const INTO: [&str; 3] = ["negatedIn", "edgeIn", "storageIn"];
pub(super) const OUT_OF: [&str; 3] = ["negatedOut", "edgeOut", "storageOut"];

impl Modifiers {
    /// The modifiers of an element or a pin. What its reader does not act on, and a value that the schema does not
    /// have, is an error: nothing is dropped.
    pub fn of(node: Node, names: [&'static str; 3], accepted: Accepted) -> Result<Self, Fault> {
        let [negated, edge, storage] = names;
        let found = Modifiers {
            negated: value(node, negated, &NEGATED)?.unwrap_or(false),
            edge: value(node, edge, &EDGES)?.flatten(),
            storage: value(node, storage, &STORAGES)?.flatten(),
        };
        let present = [
            (negated, found.negated && accepted == Accepted::None),
            (
                edge,
                found.edge.is_some() && !matches!(accepted, Accepted::All | Accepted::Read),
            ),
            (
                storage,
                found.storage.is_some() && accepted != Accepted::All,
            ),
        ];
        match present.iter().find(|(_, unused)| *unused) {
            Some((name, _)) => Err(without_meaning(node, name)),
            None => Ok(found),
        }
    }

    /// The value that passes, negated.
    pub fn negate(self, logic: Logic) -> Logic {
        match self.negated {
            true => logic.changed("INV"),
            false => logic,
        }
    }
}

impl Edge {
    /// The edge of the negated value.
    pub fn opposite(self) -> Self {
        match self {
            Edge::Rising => Edge::Falling,
            Edge::Falling => Edge::Rising,
        }
    }
}

const NEGATED: [(&str, bool); 4] = [("false", false), ("0", false), ("true", true), ("1", true)];
const EDGES: [(&str, Option<Edge>); 3] = [
    ("none", None),
    ("rising", Some(Edge::Rising)),
    ("falling", Some(Edge::Falling)),
];
const STORAGES: [(&str, Option<Storage>); 3] = [
    ("none", None),
    ("set", Some(Storage::Set)),
    ("reset", Some(Storage::Reset)),
];

/// Value of an attribute, if it is written.
fn value<T: Copy>(node: Node, name: &str, known: &[(&str, T)]) -> Result<Option<T>, Fault> {
    let Some(written) = node.attribute(name) else {
        return Ok(None);
    };
    let found = known.iter().find(|(value, _)| *value == written.trim());
    let meaning = found.map(|(_, meaning)| *meaning);
    meaning.map(Some).ok_or_else(|| {
        let values: Vec<_> = known.iter().map(|(value, _)| *value).collect();
        let what = format!(
            "{} has {name}=\"{written}\"; its values are {}",
            pin(node),
            values.join(", ")
        );
        Fault::at(node, what, "export the project again")
    })
}

/// Value of a boolean attribute.
pub(super) fn flag(node: Node, name: &str) -> Result<bool, Fault> {
    Ok(value(node, name, &NEGATED)?.unwrap_or(false))
}

/// An attribute that has no counterpart at this element.
fn without_meaning(node: Node, name: &str) -> Fault {
    let written = node.attribute(name).unwrap_or_default();
    let what = format!(
        "{name}=\"{written}\" at {} has no counterpart in an FX program",
        pin(node)
    );
    let help = match name {
        _ if name.starts_with("edge") => "lead it through R_TRIG or F_TRIG",
        _ if name.starts_with("storage") => "set and reset a variable by a coil",
        _ => "a number, a jump or a rail cannot be negated",
    };
    Fault::at(node, what, help)
}

/// An element, or a pin of a block with its name.
fn pin(node: Node) -> String {
    match node.attribute("formalParameter") {
        Some(name) => format!("the pin `{name}`"),
        None => called(node),
    }
}

/// Checks the modifiers of the elements of a drawing that no reader asks for: of elements that have none, and of the
/// pins of blocks.
pub(super) fn check(node: Node) -> Result<(), Fault> {
    match node.tag_name().name() {
        "coil" | "outVariable" => _ = Modifiers::of(node, ONE_WAY, Accepted::All)?,
        "contact" | "inVariable" => _ = Modifiers::of(node, ONE_WAY, Accepted::Read)?,
        "inOutVariable" => {
            Modifiers::of(node, ONE_WAY, Accepted::None)?;
            Modifiers::of(node, INTO, Accepted::All)?;
            Modifiers::of(node, OUT_OF, Accepted::Read)?;
        }
        _ => _ = Modifiers::of(node, ONE_WAY, Accepted::None)?,
    }
    let pins = node
        .descendants()
        .filter(|n| n.tag_name().name() == "variable" && n.has_attribute("formalParameter"));
    for pin in pins {
        let list = pin.parent_element().map(|list| list.tag_name().name());
        let accepted = match list {
            Some("inputVariables") => Accepted::Read,
            Some("outputVariables") => Accepted::Negated,
            _ => Accepted::None,
        };
        Modifiers::of(pin, ONE_WAY, accepted)?;
    }
    Ok(())
}
