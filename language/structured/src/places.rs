//! Devices that expressions name: labels, members of structures, elements of arrays, and bits of words. An index that
//! is not constant is in index register Z0 when the instruction runs.

use crate::ast::{Expr, ExprKind};
use crate::device;
use crate::emit::{Compiler, Made, fail};
use crate::fold;
use crate::labels::{Area, Instance, Label, Stored, element};
use crate::layout::{Size, Type};
use crate::literal::Const;
use crate::types::Ty;
use rungc_syntax::{
    Device, DeviceClass, Index, Operand, OperandKind, Span, codes, diag::did_you_mean, phrase,
};
use std::rc::Rc;

/// Register of variable indexes, as in GX Works2.
const Z0: Index = Index {
    class: DeviceClass::Z,
    number: 0,
};

/// An index that is known when the program runs.
#[derive(Clone, Debug)]
pub(crate) struct Scaled<'e> {
    index: &'e Expr,
    /// The value, if it is computed already.
    stored: Option<Operand>,
    /// Index of the first element.
    first: i64,
    /// Distance of the elements.
    each: Size,
}

/// Storage of a whole label or a part of it.
#[derive(Clone, Debug)]
enum At {
    Operand(OperandKind),
    Area(Area),
}

/// Something that has devices, of any type.
#[derive(Clone, Debug)]
pub(crate) struct Spot<'e> {
    pub of: Type,
    at: At,
    is_name: bool,
    scaled: Vec<Scaled<'e>>,
    /// Largest distance that the indexes can add.
    reach: Size,
}

/// Something of elementary type that has a device.
#[derive(Clone, Debug)]
pub(crate) struct Place<'e> {
    /// The device; with variable indexes, that of the first elements.
    pub operand: OperandKind,
    pub ty: Ty,
    /// True for a name, false for a bit, member or element of one.
    pub is_name: bool,
    pub scaled: Vec<Scaled<'e>>,
    /// Largest distance that the indexes can add.
    pub reach: u32,
}

impl Place<'_> {
    /// Returns true if an index has to be computed.
    pub(crate) fn is_variable(&self) -> bool {
        !self.scaled.is_empty()
    }
}

impl<'e> Spot<'e> {
    fn new(operand: OperandKind, ty: Ty) -> Self {
        Spot {
            of: Type::Plain(ty),
            at: At::Operand(operand),
            is_name: true,
            scaled: Vec::new(),
            reach: Size::default(),
        }
    }

    /// Moves on within the devices, to a part of this type.
    fn part(self, distance: Size, of: Type) -> Self {
        let moved = |device: Option<Device>, by: u32| {
            device.map(|device| Device {
                number: device.number.saturating_add(by),
                ..device
            })
        };
        let at = match self.at {
            At::Area(area) => At::Area(Area {
                bits: moved(area.bits, distance.bits),
                words: moved(area.words, distance.words),
                members: Default::default(),
            }),
            operand => operand,
        };
        Spot {
            of,
            at,
            is_name: false,
            ..self
        }
    }

    /// The spot as a place, if its type is elementary and it has devices.
    fn place(self) -> Option<Place<'e>> {
        let ty = self.of.plain()?;
        let (operand, reach) = match self.at {
            At::Operand(operand) => (operand, 0),
            At::Area(area) if ty == Ty::Bool => {
                (OperandKind::Device(area.bits?, None), self.reach.bits)
            }
            At::Area(area) => (OperandKind::Device(area.words?, None), self.reach.words),
        };
        let (is_name, scaled) = (self.is_name, self.scaled);
        Some(Place {
            operand,
            ty,
            is_name,
            scaled,
            reach,
        })
    }

    /// A member or element of elementary type, by its path and distance.
    pub(crate) fn member(&self, path: &str, distance: Size, ty: Ty) -> Option<Place<'e>> {
        let first = path.trim_start_matches('.').split(['.', '[']).next();
        if let (At::Area(area), Type::Structure(structure), Some(first)) =
            (&self.at, &self.of, first)
            && let Some(device) = area.members.get(&first.to_uppercase())
        {
            let mut members = structure.members.iter();
            let at = members
                .find(|member| member.name.eq_ignore_ascii_case(first))?
                .at;
            let within = match ty {
                Ty::Bool => distance.bits - at.bits,
                _ => distance.words - at.words,
            };
            let number = device.number + within;
            return Spot::new(OperandKind::Device(Device { number, ..*device }, None), ty).place();
        }
        self.clone().part(distance, Type::Plain(ty)).place()
    }

    /// The devices of an array or structure without a variable index.
    pub(crate) fn area(&self) -> Option<&Area> {
        match &self.at {
            At::Area(area) if self.scaled.is_empty() => Some(area),
            _ => None,
        }
    }
}

impl Compiler<'_> {
    /// The device that an expression names, `None` if it names none, or an error if it names a whole array or
    /// structure.
    pub(crate) fn place<'e>(&self, expr: &'e Expr) -> Made<Option<Place<'e>>> {
        let Some(spot) = self.spot(expr)? else {
            return Ok(None);
        };
        if spot.of.plain().is_none() {
            let error = codes::ST_TYPE.at(expr.span, phrase!("this is {given}", given = spot.of));
            return fail(error.help("name a member or element; only `:=` copies all of them"));
        }
        Ok(spot.place())
    }

    /// The devices that an expression names, of any type; `None` if it names none.
    pub(crate) fn spot<'e>(&self, expr: &'e Expr) -> Made<Option<Spot<'e>>> {
        match &expr.kind {
            ExprKind::Name(name) => self.named(name, expr),
            ExprKind::Address(text) => match device::address(text) {
                Some((operand, ty)) => Ok(Some(Spot::new(operand, ty))),
                None => {
                    let error = codes::ST_UNKNOWN_NAME
                        .at(expr.span, phrase!("`{text}` is not an address", text));
                    fail(error.help("write the device, such as `X0`, `M10` or `D10`"))
                }
            },
            ExprKind::Member(of, member) => self.member(of, member, expr),
            ExprKind::Index(of, indexes) => self.element(of, indexes).map(Some),
            _ => Ok(None),
        }
    }

    fn named<'e>(&self, name: &str, expr: &Expr) -> Made<Option<Spot<'e>>> {
        let Some(label) = self.labels.get(name) else {
            if let Some((operand, ty)) = device::find(name) {
                self.note_register(&operand, expr.span);
                return Ok(Some(Spot::new(operand, ty)));
            }
            if fold::constant(&self.labels, expr).is_some() {
                return Ok(None);
            }
            return fail(self.unknown(name, expr));
        };
        self.stored(label, expr)
    }

    /// The storage of a label.
    fn stored<'e>(&self, label: &Label, expr: &Expr) -> Made<Option<Spot<'e>>> {
        let at = match &label.stored {
            Stored::Device(operand) => {
                self.note_register(operand, expr.span);
                At::Operand(operand.clone())
            }
            Stored::Area(area) => At::Area(area.clone()),
            Stored::Constant(_) | Stored::Text(_) => return Ok(None),
            Stored::Instance(_) => {
                let what = phrase!(
                    "`{name}` is an instance of a function block",
                    name = label.name
                );
                let error = codes::ST_TYPE.at(expr.span, what);
                return fail(error.help(phrase!("call it: `{name}(…);`", name = label.name)));
            }
            Stored::Instances => {
                let name = &label.name;
                let what = phrase!("`{name}` is an array of function blocks", name);
                let error = codes::ST_TYPE.at(expr.span, what);
                let help = phrase!("name one of them by a constant index within the bounds");
                return fail(error.help(help));
            }
            // Its declaration is reported.
            Stored::Unknown => return Err(Vec::new()),
        };
        Ok(Some(Spot {
            of: label.of.clone(),
            at,
            is_name: true,
            scaled: Vec::new(),
            reach: Size::default(),
        }))
    }

    fn unknown(&self, name: &str, expr: &Expr) -> rungc_syntax::Diagnostic {
        let upper = name.to_uppercase();
        let names = self
            .labels
            .all()
            .map(|label| (label.name.to_uppercase(), &label.name));
        let names: Vec<_> = names.collect();
        let meant = did_you_mean(&upper, names.iter().map(|(upper, _)| upper.as_str()));
        let meant = meant.and_then(|meant| names.iter().find(|(upper, _)| upper == meant));
        let error =
            codes::ST_UNKNOWN_NAME.at(expr.span, phrase!("nothing declares `{name}`", name));
        match meant {
            Some((_, meant)) => error.help(phrase!("did you mean `{meant}`?", meant)),
            None => error.help("declare it in `VAR` … `END_VAR`, or write a device such as `M0`"),
        }
    }

    /// The instance that an expression names.
    pub(crate) fn instance(&self, expr: &Expr) -> Option<Rc<Instance>> {
        let label = match &expr.kind {
            ExprKind::Name(name) => self.labels.get(name).cloned()?,
            ExprKind::Member(of, member) => self.instance(of)?.own.own(member).cloned()?,
            ExprKind::Index(of, indexes) => {
                let index = |index| match fold::constant(&self.labels, index) {
                    Some((Const::Int(value), _)) => Some(value),
                    _ => None,
                };
                let indexes: Option<Vec<_>> = indexes.iter().map(index).collect();
                match &of.kind {
                    ExprKind::Name(name) => {
                        self.labels.get(name)?;
                        self.labels.get(&element(name, &indexes?)).cloned()?
                    }
                    ExprKind::Member(of, member) => {
                        let outer = self.instance(of)?;
                        outer.own.own(member)?;
                        outer.own.own(&element(member, &indexes?)).cloned()?
                    }
                    _ => return None,
                }
            }
            _ => return None,
        };
        match label.stored {
            Stored::Instance(instance) => Some(instance),
            _ => None,
        }
    }

    /// A member of a structure or instance, or a bit of a register.
    fn member<'e>(&self, of: &'e Expr, member: &str, expr: &Expr) -> Made<Option<Spot<'e>>> {
        if let Some(name) = of.name()
            && self.labels.get(name).is_none()
            && device::float(name, member).is_some()
        {
            return Ok(None);
        }
        if let Some(instance) = self.instance(of) {
            return self.of_instance(&instance, member, expr);
        }
        let Some(spot) = self.spot(of)? else {
            return fail(codes::ST_TYPE.at(of.span, "this has no members"));
        };
        match (&spot.of, &spot.at) {
            (Type::Structure(structure), At::Area(area)) => {
                let structure = Rc::clone(structure);
                let mut members = structure.members.iter();
                let found = members.find(|one| one.name.eq_ignore_ascii_case(member));
                let Some(found) = found else {
                    let what = phrase!(
                        "`{name}` has no member `{member}`",
                        member,
                        name = structure.name
                    );
                    let names = structure.members.iter().map(|one| one.name.as_str());
                    let error = codes::ST_UNKNOWN_NAME.at(expr.span, what);
                    return fail(match did_you_mean(member, names) {
                        Some(meant) => error.help(phrase!("did you mean `{meant}`?", meant)),
                        None => error,
                    });
                };
                let elsewhere = area.members.get(&member.to_uppercase()).copied();
                let mut spot = spot.part(found.at, found.of.clone());
                if let Some(device) = elsewhere {
                    spot.at = At::Area(Area {
                        bits: Some(device),
                        words: Some(device),
                        members: Default::default(),
                    });
                }
                Ok(Some(spot))
            }
            _ => self.bit(spot, member, expr).map(Some),
        }
    }

    fn bit<'e>(&self, spot: Spot<'e>, member: &str, expr: &Expr) -> Made<Spot<'e>> {
        let of = spot.of.clone();
        let words = of.plain().map_or(0, Ty::words);
        let bit = spot
            .place()
            .filter(|word| words == 1 && !word.is_variable());
        let Some(operand) = bit.and_then(|word| device::bit(&word.operand, member)) else {
            let error = codes::ST_TYPE.at(
                expr.span,
                phrase!("`{member}` is not a bit of {of}", member, of),
            );
            return fail(error.help("a register of 16 bits has the bits 0 to F"));
        };
        let mut spot = Spot::new(operand, Ty::Bool);
        spot.is_name = false;
        Ok(spot)
    }

    /// An input, output or label of an instance.
    fn of_instance<'e>(
        &self,
        instance: &Rc<Instance>,
        member: &str,
        expr: &Expr,
    ) -> Made<Option<Spot<'e>>> {
        let Some(label) = instance.own.own(member) else {
            let block = &self.units[instance.unit].name.text;
            let what = phrase!("`{block}` has no `{member}`", block, member);
            return fail(codes::ST_UNKNOWN_NAME.at(expr.span, what));
        };
        self.note_own(instance, &label.name, expr.span);
        let spot = self.stored(label, expr)?;
        Ok(spot.map(|spot| Spot {
            is_name: false,
            ..spot
        }))
    }

    /// Remembers that a program needs the value of an input or output that an instance has itself.
    pub(crate) fn note_own(&self, instance: &Rc<Instance>, name: &str, span: Span) {
        let used = (Rc::clone(instance), name.to_owned(), span);
        self.own_used.borrow_mut().push(used);
    }

    /// An element of an array.
    fn element<'e>(&self, of: &'e Expr, indexes: &'e [Expr]) -> Made<Spot<'e>> {
        let Some(mut spot) = self.spot(of)? else {
            return fail(codes::ST_TYPE.at(of.span, "this is not an array"));
        };
        for index in indexes {
            let Type::Array(array) = &spot.of else {
                let what = phrase!("this is {given}, not an array", given = spot.of);
                return fail(codes::ST_TYPE.at(of.span.to(index.span), what));
            };
            let array = Rc::clone(array);
            let each = array.of.size();
            let distance = match fold::constant(&self.labels, index) {
                Some((Const::Int(at), _)) if at < array.first || at > array.last => {
                    let (first, last) = (array.first, array.last);
                    let what = phrase!("the array has the elements {first} to {last}", first, last);
                    return fail(codes::ST_LITERAL.at(index.span, what));
                }
                Some((Const::Int(at), _)) => each.times(at.abs_diff(array.first)),
                Some(_) => {
                    return fail(codes::ST_TYPE.at(index.span, "an index is a whole number"));
                }
                None => {
                    let ty = self.ty(index)?;
                    if !ty.is_whole() {
                        let what = phrase!("an index is a whole number, and this is {ty}", ty);
                        return fail(codes::ST_TYPE.at(index.span, what));
                    }
                    let first = array.first;
                    spot.scaled.push(Scaled {
                        index,
                        stored: None,
                        first,
                        each,
                    });
                    spot.reach = spot.reach.plus(each.times(array.last.abs_diff(first)));
                    Size::default()
                }
            };
            spot = spot.part(distance, array.of.clone());
        }
        Ok(spot)
    }

    /// The operand of a place; variable indexes are computed into Z0 before.
    pub(crate) fn reached(&mut self, place: &Place, span: Span) -> Made<Operand> {
        if place.is_variable() {
            self.index(place)?;
        }
        Ok(Operand {
            span,
            kind: indexed(place),
        })
    }

    /// As [`Self::reached`], in a temporary if Z0 is needed: it keeps its value while others are computed.
    pub(crate) fn kept(&mut self, place: &Place, span: Span) -> Made<Operand> {
        let operand = self.reached(place, span)?;
        if !place.is_variable() {
            return Ok(operand);
        }
        let temporary = self.temporary(place.ty.words())?;
        let copy = self.here(OperandKind::Device(temporary, None));
        self.always(&Self::sized("MOV", place.ty), [operand, copy.clone()]);
        Ok(copy)
    }

    fn type_of_index(&self, scaled: &Scaled) -> Made<Ty> {
        Ok(match self.ty(scaled.index)? {
            Ty::Timer => Ty::Raw16,
            ty => ty,
        })
    }

    /// Computes the indexes of a structure or array that is copied: its members may be parts of them.
    pub(crate) fn fixed<'e>(&mut self, mut spot: Spot<'e>) -> Made<Spot<'e>> {
        for scaled in &mut spot.scaled {
            if scaled.index.name().is_some() {
                continue;
            }
            let ty = self.type_of_index(scaled)?;
            let temporary = self.temporary(ty.words())?;
            let copy = self.here(OperandKind::Device(temporary, None));
            self.compute(scaled.index, ty, Some(&copy))?;
            scaled.stored = Some(copy);
        }
        Ok(spot)
    }

    /// Computes the distance of an element into Z0.
    fn index(&mut self, place: &Place) -> Made<()> {
        let z0 = self.here(OperandKind::Device(
            Device {
                class: Z0.class,
                number: Z0.number,
            },
            None,
        ));
        let mut sum: Option<Operand> = None;
        for (at, scaled) in place.scaled.iter().enumerate() {
            let ty = self.type_of_index(scaled)?;
            let index = match &scaled.stored {
                Some(stored) => stored.clone(),
                None => self.operand(scaled.index, ty)?,
            };
            self.always(&Self::sized("MOV", ty), [index, z0.clone()]);
            if scaled.first != 0 {
                let first = self.here(OperandKind::Decimal(scaled.first, None));
                self.always("SUB", [z0.clone(), first, z0.clone()]);
            }
            let each = match place.ty {
                Ty::Bool => scaled.each.bits,
                _ => scaled.each.words,
            };
            if each != 1 {
                let each = self.here(OperandKind::Hex(each.into(), None));
                self.always("MUL", [z0.clone(), each, z0.clone()]);
            }
            if let Some(sum) = &sum {
                self.always("ADD", [z0.clone(), sum.clone(), z0.clone()]);
            }
            if at + 1 < place.scaled.len() {
                let temporary = self.temporary(1)?;
                let copy = self.here(OperandKind::Device(temporary, None));
                self.always("MOV", [z0.clone(), copy.clone()]);
                sum = Some(copy);
            }
        }
        self.indexes.get_or_insert(self.span);
        Ok(())
    }

    /// Warns of an index register that the program uses and variable indexes change.
    pub(crate) fn check_registers(&mut self) {
        if let (Some(register), Some(index)) = (self.registers.get(), self.indexes) {
            let what = phrase!("this index register does not keep its value");
            let warning = codes::ST_INDEX_REGISTER.at(register, what);
            let warning = warning.other(index, "a variable index is computed in Z0 here");
            self.found.push(warning.help("use Z1 or one above it"));
        }
    }

    /// Remembers that the program uses an index register that variable indexes change.
    fn note_register(&self, operand: &OperandKind, span: Span) {
        let changes = |class| matches!(class, DeviceClass::Z | DeviceClass::V);
        let used = match operand {
            OperandKind::Device(device, _) if changes(device.class) => device.number,
            OperandKind::Device(_, Some(index))
            | OperandKind::Nibbles(_, _, Some(index))
            | OperandKind::WordBit(_, _, Some(index)) => index.number,
            _ => return,
        };
        if used == 0 && self.registers.get().is_none() {
            self.registers.set(Some(span));
        }
    }
}

/// The operand of a place, with Z0 if an index is variable.
fn indexed(place: &Place) -> OperandKind {
    match place.operand {
        OperandKind::Device(device, None) if place.is_variable() => {
            OperandKind::Device(device, Some(Z0))
        }
        ref other => other.clone(),
    }
}

/// The members of a structure of elementary type, with the names that follow that of the label.
pub(crate) fn members(label: &Label) -> Vec<(String, Device)> {
    let (Type::Structure(_), Stored::Area(area)) = (&label.of, &label.stored) else {
        return Vec::new();
    };
    let whole = Spot {
        of: label.of.clone(),
        at: At::Area(area.clone()),
        is_name: true,
        scaled: Vec::new(),
        reach: Size::default(),
    };
    let leaves = label.of.leaves().unwrap_or_default();
    let places = leaves.into_iter().filter_map(|leaf| {
        let place = whole.member(&leaf.path, leaf.at, leaf.ty)?;
        Some((leaf.path, place.operand.device()?))
    });
    places.collect()
}

/// Sixteen bits from a place of a BOOL on.
pub(crate) fn group(place: &Place) -> Option<OperandKind> {
    match place.operand {
        OperandKind::Device(device, None) => {
            let index = place.is_variable().then_some(Z0);
            Some(OperandKind::Nibbles(4, device, index))
        }
        _ => None,
    }
}
