//! Types of labels: elementary ones, structures and arrays, and the devices that they take. Bits lie in M and all
//! else in D, each part dense, members in the order of their declaration.

use crate::ast::{Structure as Declared, TypeName, Variable};
use crate::fold;
use crate::functions::elsewhere;
use crate::labels::{Labels, Stored, initial_value};
use crate::literal::{self, Const};
use crate::texts;
use crate::types::Ty;
use rungc_syntax::{Argument, Diagnostic, Say, codes, phrase};
use smol_str::SmolStr;
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

/// Number of members and elements that an assignment of whole structures or arrays copies.
pub(crate) const MOST_LEAVES: usize = 64;

/// Levels of structures within structures.
const DEEPEST: usize = 8;

/// Number of devices of a value, or the distance of one from the first.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(crate) struct Size {
    pub bits: u32,
    pub words: u32,
}

impl Size {
    pub(crate) const fn plus(self, other: Size) -> Size {
        Size {
            bits: self.bits.saturating_add(other.bits),
            words: self.words.saturating_add(other.words),
        }
    }

    pub(crate) fn times(self, count: u64) -> Size {
        let count = u32::try_from(count).unwrap_or(u32::MAX);
        Size {
            bits: self.bits.saturating_mul(count),
            words: self.words.saturating_mul(count),
        }
    }
}

/// Type of a label.
#[derive(Clone, Debug)]
pub(crate) enum Type {
    Plain(Ty),
    Array(Rc<Array>),
    Structure(Rc<Structure>),
}

/// Array of one dimension; one of several dimensions is an array of arrays.
#[derive(Debug)]
pub(crate) struct Array {
    pub first: i64,
    pub last: i64,
    pub of: Type,
}

/// Structure, with its members in the order of their declaration.
#[derive(Debug)]
pub(crate) struct Structure {
    pub name: SmolStr,
    pub members: Vec<Member>,
    size: Size,
}

/// Member of a structure.
#[derive(Debug)]
pub(crate) struct Member {
    pub name: SmolStr,
    pub of: Type,
    /// Distance from the first devices of the structure.
    pub at: Size,
}

/// Member or element of elementary type.
#[derive(Debug)]
pub(crate) struct Leaf {
    /// `.Member`, `[3]`, joined.
    pub path: String,
    pub ty: Ty,
    pub at: Size,
}

impl Type {
    pub(crate) fn size(&self) -> Size {
        match self {
            Type::Plain(Ty::Bool) => Size { bits: 1, words: 0 },
            Type::Plain(ty) => Size {
                bits: 0,
                words: ty.words(),
            },
            Type::Array(array) => {
                let count = array.last.abs_diff(array.first).saturating_add(1);
                array.of.size().times(count)
            }
            Type::Structure(structure) => structure.size,
        }
    }

    /// The elementary type, if it is one.
    pub(crate) const fn plain(&self) -> Option<Ty> {
        match self {
            Type::Plain(ty) => Some(*ty),
            _ => None,
        }
    }

    /// The structure, if it is one.
    pub(crate) fn structure(&self) -> Option<&Structure> {
        match self {
            Type::Structure(structure) => Some(structure),
            _ => None,
        }
    }

    /// The elementary type of an element, however many dimensions there are; `None` in structures.
    pub(crate) fn element(&self) -> Option<Ty> {
        match self {
            Type::Plain(ty) => Some(*ty),
            Type::Array(array) => array.of.element(),
            Type::Structure(_) => None,
        }
    }

    pub(crate) fn is_same(&self, other: &Type) -> bool {
        match (self, other) {
            (Type::Plain(a), Type::Plain(b)) => a == b,
            (Type::Array(a), Type::Array(b)) => {
                (a.first, a.last) == (b.first, b.last) && a.of.is_same(&b.of)
            }
            (Type::Structure(a), Type::Structure(b)) => Rc::ptr_eq(a, b),
            _ => false,
        }
    }

    /// Members and elements of elementary types; `None` if there are more than [`MOST_LEAVES`].
    pub(crate) fn leaves(&self) -> Option<Vec<Leaf>> {
        let mut all = Vec::new();
        self.add_leaves(String::new(), Size::default(), &mut all)
            .then_some(all)
    }

    fn add_leaves(&self, path: String, at: Size, all: &mut Vec<Leaf>) -> bool {
        match self {
            Type::Plain(ty) => {
                let ty = *ty;
                all.push(Leaf { path, ty, at });
                all.len() <= MOST_LEAVES
            }
            Type::Array(array) => (array.first..=array.last).all(|index| {
                let at = at.plus(array.of.size().times(index.abs_diff(array.first)));
                array.of.add_leaves(format!("{path}[{index}]"), at, all)
            }),
            Type::Structure(structure) => structure.members.iter().all(|member| {
                let path = format!("{path}.{}", member.name);
                member.of.add_leaves(path, at.plus(member.at), all)
            }),
        }
    }
}

impl Say for Type {
    fn said(&self) -> Argument {
        match self {
            Type::Plain(ty) => ty.said(),
            Type::Array(_) => phrase!("a whole array").said(),
            Type::Structure(structure) => {
                phrase!("a structure `{name}`", name = structure.name).said()
            }
        }
    }
}

/// Structures by their names in upper case. One with a mistake has no members that can be used, which is reported.
#[derive(Debug, Default)]
pub(crate) struct Structures {
    by_name: BTreeMap<String, Option<Rc<Structure>>>,
}

impl Structures {
    /// Reads the structures of a text, in any order. `labels` has the constants for bounds of arrays.
    pub(crate) fn new(all: &[Declared], labels: &Labels, found: &mut Vec<Diagnostic>) -> Self {
        let mut structures = Structures::default();
        let mut open = BTreeSet::new();
        // The name of an elementary type is reported.
        let all: Vec<_> = all
            .iter()
            .filter(|one| !Ty::is_name(&one.name.text))
            .cloned()
            .collect();
        for (at, one) in all.iter().enumerate() {
            let same = |other: &&Declared| other.name.text.eq_ignore_ascii_case(&one.name.text);
            if let Some(first) = all[..at].iter().find(same) {
                let what = phrase!("`{name}` is declared twice", name = one.name.text);
                let error = codes::ST_DECLARED_TWICE.at(one.name.span, what);
                found.push(
                    error
                        .label("again here")
                        .other(first.name.span, "first here"),
                );
                continue;
            }
            structures.add(one, &all, labels, &mut open, found);
        }
        structures
    }

    /// Adds a structure after those that it is made of.
    fn add(
        &mut self,
        one: &Declared,
        all: &[Declared],
        labels: &Labels,
        open: &mut BTreeSet<String>,
        found: &mut Vec<Diagnostic>,
    ) {
        let key = one.name.text.to_uppercase();
        if self.by_name.contains_key(&key) {
            return;
        }
        let is_deep = open.len() >= DEEPEST;
        if is_deep || !open.insert(key.clone()) {
            let what = match is_deep {
                true => phrase!("structures nest deeper than {most} levels", most = DEEPEST),
                false => phrase!(
                    "the structure `{name}` contains itself",
                    name = one.name.text
                ),
            };
            found.push(codes::ST_TYPE.at(one.name.span, what));
            self.by_name.insert(key, None);
            return;
        }
        for variable in &one.members {
            let name = &variable.of.name.text;
            let inner = all
                .iter()
                .find(|other| other.name.text.eq_ignore_ascii_case(name));
            if let Some(inner) = inner {
                self.add(inner, all, labels, open, found);
            }
        }
        let members = self.members(one, labels, found);
        open.remove(&key);
        // A structure that contains itself is known by now.
        self.by_name
            .entry(key)
            .or_insert_with(|| members.map(Rc::new));
    }

    fn members(
        &self,
        one: &Declared,
        labels: &Labels,
        found: &mut Vec<Diagnostic>,
    ) -> Option<Structure> {
        let mut members: Vec<Member> = Vec::new();
        let mut size = Size::default();
        let mut is_whole = !one.members.is_empty();
        if !is_whole {
            let what = phrase!(
                "the structure `{name}` has no members",
                name = one.name.text
            );
            found.push(codes::ST_TYPE.at(one.name.span, what));
        }
        for variable in &one.members {
            let of = labels.type_of(&variable.of, self, found);
            let of = of.filter(|of| self.is_storable(of, variable, found));
            found.extend(
                variable
                    .initial
                    .iter()
                    .filter_map(|initial| initial_value(labels, initial)),
            );
            for name in &variable.names {
                if members
                    .iter()
                    .any(|member| member.name.eq_ignore_ascii_case(&name.text))
                {
                    let what = phrase!("`{name}` is declared twice", name = name.text);
                    found.push(codes::ST_DECLARED_TWICE.at(name.span, what));
                }
                let Some(of) = of.clone() else {
                    is_whole = false;
                    continue;
                };
                let each = of.size();
                members.push(Member {
                    name: name.text.clone(),
                    of,
                    at: size,
                });
                size = size.plus(each);
            }
        }
        let name = one.name.text.clone();
        is_whole.then_some(Structure {
            name,
            members,
            size,
        })
    }

    /// Reports timers and counters, which a structure does not hold, and devices.
    fn is_storable(&self, of: &Type, variable: &Variable, found: &mut Vec<Diagnostic>) -> bool {
        let place = variable.place.as_ref().map(|place| place.span);
        let (span, what) = match (of.element(), place) {
            (Some(Ty::Timer), _) => (
                variable.of.span,
                phrase!("a structure with a TIMER or COUNTER is not compiled yet"),
            ),
            (_, Some(place)) => (place, phrase!("a member of a structure states no device")),
            _ => return true,
        };
        found.push(codes::ST_UNSUPPORTED.at(span, what));
        false
    }

    /// The structure of this name; `Some(None)` for one with a mistake.
    pub(crate) fn get(&self, name: &str) -> Option<Option<Rc<Structure>>> {
        self.by_name.get(&name.to_uppercase()).cloned()
    }
}

impl Labels {
    /// The type of a declaration; an error is reported.
    pub(crate) fn type_of(
        &self,
        of: &TypeName,
        structures: &Structures,
        found: &mut Vec<Diagnostic>,
    ) -> Option<Type> {
        let name = of.name.text.as_str();
        let mut ty = match (Ty::named(name), structures.get(name)) {
            _ if name.eq_ignore_ascii_case("STRING") => Type::Plain(self.text_type(of, found)?),
            (Some(ty), _) => Type::Plain(ty),
            (None, Some(structure)) => Type::Structure(structure?),
            (None, None) => {
                found.push(not_a_type(of));
                return None;
            }
        };
        for (first, last) in self.bounds(of, found)?.into_iter().rev() {
            let of = ty;
            ty = Type::Array(Rc::new(Array { first, last, of }));
        }
        Some(ty)
    }

    /// The type of a STRING with the length that a declaration states.
    fn text_type(&self, of: &TypeName, found: &mut Vec<Diagnostic>) -> Option<Ty> {
        let Some(length) = &of.length else {
            return Some(Ty::Text(texts::USUAL));
        };
        let stated = match literal::number(&length.text) {
            Some((Const::Int(value), _)) => Some(value),
            _ => match self.get(&length.text).map(|label| &label.stored) {
                Some(Stored::Constant(Const::Int(value))) => Some(*value),
                _ => None,
            },
        };
        let stated = stated.and_then(|value| u16::try_from(value).ok());
        let Some(stated) = stated.filter(|length| (1..=texts::LONGEST).contains(length)) else {
            let what = phrase!(
                "the length of a STRING is 1 to {most}",
                most = texts::LONGEST
            );
            found.push(codes::ST_LITERAL.at(length.span, what));
            return None;
        };
        Some(Ty::Text(stated))
    }

    /// First and last index of each dimension of an array.
    pub(crate) fn bounds(
        &self,
        of: &TypeName,
        found: &mut Vec<Diagnostic>,
    ) -> Option<Vec<(i64, i64)>> {
        let value = |bound| match fold::constant(self, bound) {
            Some((Const::Int(value), _)) => Some(value),
            _ => None,
        };
        let mut all = Vec::new();
        for (first, last) in &of.bounds {
            let bounds = value(first).zip(value(last));
            let Some(bounds) = bounds.filter(|(first, last)| first <= last) else {
                let span = first.span.to(last.span);
                found.push(codes::ST_LITERAL.at(span, "these are not the bounds of an array"));
                return None;
            };
            all.push(bounds);
        }
        Some(all)
    }
}

fn not_a_type(of: &TypeName) -> Diagnostic {
    let name = of.name.text.as_str();
    let (code, what) = match name.to_ascii_uppercase().as_str() {
        "WSTRING" | "SINT" | "LINT" | "USINT" | "UINT" | "UDINT" | "LREAL" | "BYTE" | "LWORD"
        | "DATE" => (
            &codes::ST_UNSUPPORTED,
            phrase!("FX has no type {name}", name),
        ),
        _ => (
            &codes::ST_UNKNOWN_NAME,
            phrase!("nothing defines the type `{name}`", name),
        ),
    };
    let error = code.at(of.name.span, what);
    error.help(match code.id == codes::ST_UNKNOWN_NAME.id {
        true => elsewhere(),
        false => {
            phrase!("types are BOOL, INT, WORD, DINT, DWORD, REAL, TIME, STRING, TIMER and COUNTER")
        }
    })
}
