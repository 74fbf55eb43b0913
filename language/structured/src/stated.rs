//! Devices that declarations state.

use crate::ast::{Expr, ExprKind, Variable};
use crate::device::{self, Place};
use crate::labels::{Area, Stored};
use crate::layout::{Structure, Type};
use crate::types::Ty;
use rungc_syntax::{Device, DeviceClass, Diagnostic, OperandKind, codes, phrase};
use std::collections::BTreeMap;

/// The device that a declaration states.
pub(crate) fn stated(place: &Expr, found: &mut Vec<Diagnostic>) -> Option<Place> {
    let device = match &place.kind {
        ExprKind::Name(name) => device::find(name),
        ExprKind::Address(address) => device::address(address),
        ExprKind::Member(of, bit) => {
            let word = of.name().and_then(device::find);
            let bit = word.and_then(|(word, _)| device::bit(&word, bit));
            bit.map(|bit| (bit, Ty::Bool))
        }
        _ => None,
    };
    if device.is_none() {
        let error = codes::ST_UNKNOWN_NAME.at(place.span, "this is not a device");
        found.push(error.help("write for example `AT X0`, `AT D10`, `AT D10.3` or `AT K4M0`"));
    }
    device
}

/// The device of a label, or the first one of an array, if it suits the type.
pub(crate) fn suits(
    (operand, of): Place,
    label: &Type,
    variable: &Variable,
) -> Result<Stored, Box<Diagnostic>> {
    let span = variable
        .place
        .as_ref()
        .map_or(variable.span, |place| place.span);
    let Some(ty) = label.element() else {
        let what = phrase!("a structure gets its devices by itself");
        let error = codes::ST_UNSUPPORTED.at(span, what);
        return Err(error.help("leave out `AT`").into());
    };
    let is_bit_device = of == Ty::Bool;
    let suits = match ty {
        Ty::Bool => of.is_bit(),
        Ty::Timer => of.is_bit() && !is_bit_device,
        Ty::Text(_) => matches!(
            operand.device().map(|device| device.class),
            Some(DeviceClass::D | DeviceClass::R)
        ),
        _ => !is_bit_device,
    };
    match (&operand, label.plain()) {
        (_, Some(_)) if suits => return Ok(Stored::Device(operand)),
        (OperandKind::Device(first, None), None) if suits => {
            let is_bits = ty == Ty::Bool;
            return Ok(Stored::Area(Area {
                bits: is_bits.then_some(*first),
                words: (!is_bits).then_some(*first),
                members: BTreeMap::new(),
            }));
        }
        _ => {}
    }
    let what = match label.plain() {
        Some(ty) => phrase!("`{operand}` cannot hold {ty}", operand, ty),
        None => phrase!("an array cannot begin at `{operand}`", operand),
    };
    let help = match ty {
        Ty::Bool => "a BOOL is an X, Y, M, S, or a bit of a word",
        Ty::Timer => "a TIMER is a T, a COUNTER a C",
        Ty::Text(_) => "a STRING begins at a D or R",
        _ => "a number is a D, R, T, C, or a group of bits such as `K4M0`",
    };
    Err(codes::ST_NO_DEVICE.at(span, what).help(help).into())
}

/// Devices of members that a declaration states.
pub(crate) fn stated_members(
    structure: &Structure,
    variable: &Variable,
) -> Result<BTreeMap<String, Device>, Box<Diagnostic>> {
    let mut devices = BTreeMap::new();
    for (name, place) in &variable.members {
        let mut members = structure.members.iter();
        let member = members.find(|one| one.name.eq_ignore_ascii_case(&name.text));
        let Some(member) = member else {
            let what = phrase!(
                "`{name}` has no member `{member}`",
                name = structure.name,
                member = name.text
            );
            return Err(codes::ST_UNKNOWN_NAME.at(name.span, what).into());
        };
        let mut found = Vec::new();
        let Some(device) = stated(place, &mut found) else {
            let unread = codes::ST_UNKNOWN_NAME.at(place.span, "this is not a device");
            return Err(found.pop().unwrap_or(unread).into());
        };
        let whole = Variable {
            place: Some(place.clone()),
            ..variable.clone()
        };
        let device = match suits(device, &member.of, &whole)? {
            Stored::Device(OperandKind::Device(device, None)) => Some(device),
            Stored::Area(area) => area.bits.or(area.words),
            _ => None,
        };
        let Some(device) = device else {
            let what = phrase!("a member is at a device that is not part of another");
            return Err(codes::ST_NO_DEVICE.at(place.span, what).into());
        };
        if devices.insert(name.text.to_uppercase(), device).is_some() {
            let what = phrase!("`{name}` is given twice", name = name.text);
            return Err(codes::ST_DECLARED_TWICE.at(name.span, what).into());
        }
    }
    Ok(devices)
}
