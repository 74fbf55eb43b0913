//! Assignments: to labels and devices, to elements by variable indexes, and of whole structures and arrays.

use crate::ast::{Expr, ExprKind};
use crate::conditions::Cond;
use crate::emit::{Compiler, Made, fail};
use crate::layout::{MOST_LEAVES, Type};
use crate::places::{self, Place, Spot};
use crate::types::Ty;
use crate::values::changes_index;
use rungc_syntax::{DeviceClass, Operand, OperandKind, Span, codes, phrase};

impl Compiler<'_> {
    /// A label or device that can be written.
    pub(crate) fn target<'e>(&self, target: &'e Expr) -> Made<Place<'e>> {
        if target
            .name()
            .is_some_and(|name| self.labels.is_rejected(name))
        {
            return Err(Vec::new());
        }
        let Some(place) = self.place(target)? else {
            let what = match target.kind {
                ExprKind::Call(..) => "a call cannot be assigned to",
                _ => "a constant cannot be assigned to",
            };
            return fail(codes::ST_NOT_WRITABLE.at(target.span, what));
        };
        self.is_writable(&place, target.span)?;
        Ok(place)
    }

    fn is_writable(&self, place: &Place, span: Span) -> Made<()> {
        let device = place.operand.device();
        if device.is_some_and(|device| device.class == DeviceClass::X) {
            let what = phrase!(
                "`{operand}` is an input, which the PLC reads",
                operand = place.operand
            );
            return fail(codes::ST_NOT_WRITABLE.at(span, what));
        }
        if let (Some(device), Ty::Bool) = (device, place.ty)
            && matches!(device.class, DeviceClass::T | DeviceClass::C)
        {
            let what = phrase!("the contact of `{device}` is not assigned to", device);
            let error = codes::ST_NOT_WRITABLE.at(span, what);
            return fail(
                error.help("call `OUT_T(EN, TC0, 50)`, `OUT_C(EN, CC0, 50)` or `RST(EN, TC0)`"),
            );
        }
        Ok(())
    }

    pub(crate) fn assign(&mut self, target: &Expr, value: &Expr) -> Made<()> {
        if let Some(spot) = self.spot(target)?
            && spot.of.plain().is_none()
        {
            return self.assign_whole(spot, value, target.span.to(value.span));
        }
        let place = self.target(target)?;
        if place.ty == Ty::Bool {
            return self.assign_bit(&place, value, target.span);
        }
        self.expect(value, place.ty)?;
        if place.is_variable() && changes_index(value) {
            let temporary = self.temporary(place.ty.words())?;
            let copy = self.here(OperandKind::Device(temporary, None));
            let kind = self.compute(value, place.ty, Some(&copy))?;
            let target = self.reached(&place, target.span)?;
            self.moved(kind, place.ty, Some(&target))?;
            return Ok(());
        }
        let target = self.reached(&place, target.span)?;
        self.compute(value, place.ty, Some(&target))?;
        Ok(())
    }

    fn assign_bit(&mut self, place: &Place, value: &Expr, span: Span) -> Made<()> {
        if !place.is_variable() {
            let cond = self.condition(value)?;
            let kind = place.operand.clone();
            self.drive(&cond, Operand { span, kind });
            return Ok(());
        }
        self.expect(value, Ty::Bool)?;
        if let Some(source) = self.place(value)?
            && let Some(bits) = self.neighbours(&source, value.span)
        {
            return self.store_bit(place, bits, span);
        }
        let cond = self.condition(value)?;
        let word = self.in_word(&cond)?;
        self.store_bit(place, word, span)
    }

    /// Drives a coil.
    pub(crate) fn drive(&mut self, cond: &Cond, coil: Operand) {
        self.enable(cond);
        self.push("OUT", [coil]);
    }

    /// A bit and the next 15 as a word, as GX Works2 reads it; `None` if fewer follow.
    fn neighbours(&self, place: &Place, span: Span) -> Option<Operand> {
        let device = place.operand.device()?;
        let is_bit = matches!(
            device.class,
            DeviceClass::X | DeviceClass::Y | DeviceClass::M | DeviceClass::S
        );
        let follow = self
            .model
            .has(device.class, device.number.saturating_add(15));
        let kind = places::group(place)
            .filter(|_| is_bit && follow && !place.is_variable() && device.number < 8000)?;
        Some(Operand { span, kind })
    }

    /// A condition as a word that is 1 or 0.
    fn in_word(&mut self, cond: &Cond) -> Made<Operand> {
        self.load(cond);
        let bit = self.in_bit(self.span)?;
        let temporary = self.temporary(1)?;
        let word = self.here(OperandKind::Device(temporary, None));
        for (cond, value) in [(bit.opposite(), 0), (bit, 1)] {
            self.load(&cond);
            let value = self.here(OperandKind::Decimal(value, None));
            self.push("MOV", [value, word.clone()]);
        }
        Ok(word)
    }

    /// Stores the lowest bit of a word in an element by a variable index, in the steps of GX Works2.
    fn store_bit(&mut self, place: &Place, word: Operand, span: Span) -> Made<()> {
        let kind = self.group_of(place, span)?;
        self.reached(place, span)?;
        let group = Operand { span, kind };
        let temporary = self.temporary(1)?;
        let bit = self.here(OperandKind::Device(temporary, None));
        let one = self.here(OperandKind::Hex(1, None));
        let others = self.here(OperandKind::Hex(0xFFFE, None));
        self.always("WAND", [word, one, bit.clone()]);
        self.push("WAND", [group.clone(), others, group.clone()]);
        self.push("WOR", [group.clone(), bit, group]);
        Ok(())
    }

    /// Copies a structure or array, member by member.
    fn assign_whole(&mut self, to: Spot, value: &Expr, span: Span) -> Made<()> {
        let Some(from) = self.spot(value)? else {
            let what = phrase!("a value is assigned to {to}", to = to.of);
            return fail(codes::ST_TYPE.at(span, what));
        };
        if !to.of.is_same(&from.of) {
            let what = phrase!(
                "this is {given}, where {expected} is expected",
                given = from.of,
                expected = to.of
            );
            return fail(codes::ST_TYPE.at(value.span, what));
        }
        let Some(leaves) = to.of.leaves() else {
            let what = phrase!(
                "more than {most} members and elements are not copied at once",
                most = MOST_LEAVES
            );
            let error = codes::ST_UNSUPPORTED.at(span, what);
            return fail(match to.of {
                Type::Array(_) => error.help("copy them with `BMOV(EN, From[0], Count, To[0])`"),
                _ => error,
            });
        };
        let (to, from) = (self.fixed(to)?, self.fixed(from)?);
        for leaf in leaves {
            let pair = to
                .member(&leaf.path, leaf.at, leaf.ty)
                .zip(from.member(&leaf.path, leaf.at, leaf.ty));
            let Some((to, from)) = pair else {
                return Err(Vec::new());
            };
            self.is_writable(&to, span)?;
            self.copy_leaf(&to, &from, span)?;
        }
        Ok(())
    }

    fn copy_leaf(&mut self, to: &Place, from: &Place, span: Span) -> Made<()> {
        if to.ty != Ty::Bool {
            let value = match to.is_variable() {
                true => self.kept(from, span)?,
                false => self.reached(from, span)?,
            };
            let target = self.reached(to, span)?;
            self.moved(value.kind, to.ty, Some(&target))?;
            return Ok(());
        }
        let cond = match from.is_variable() {
            true => self.bit_of(from, span)?,
            false => Cond::contact(Operand {
                span,
                kind: from.operand.clone(),
            }),
        };
        if !to.is_variable() {
            let kind = to.operand.clone();
            self.drive(&cond, Operand { span, kind });
            return Ok(());
        }
        let word = match self.neighbours(from, span) {
            Some(bits) => bits,
            None => self.in_word(&cond)?,
        };
        self.store_bit(to, word, span)
    }
}
