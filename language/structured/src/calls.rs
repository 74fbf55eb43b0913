//! Instructions that are called like functions: `MOV(EN, S, D)`.

use crate::ast::{Arg, Expr, ExprKind, Op};
use crate::conditions::Cond;
use crate::emit::{Compiler, Made, fail};
use crate::fold;
use crate::functions::elsewhere;
use crate::labels::Stored;
use crate::literal::Const;
use crate::types::Ty;
use crate::values::changes_index;
use rungc_catalogue::{Drive, Found, Param, Role, Shape};
use rungc_syntax::diag::did_you_mean;
use rungc_syntax::{Diagnostic, Operand, OperandKind, Phrase, codes, phrase};
use std::rc::Rc;

impl Compiler<'_> {
    /// Compiles a call that is a statement.
    pub(crate) fn call(&mut self, expr: &Expr) -> Made<()> {
        let ExprKind::Call(of, args) = &expr.kind else {
            let error = codes::ST_SYNTAX.at(expr.span, "this alone is not a statement");
            return fail(
                error.help("assign something to it, `NAME := VALUE;`, or call it, `NAME(…);`"),
            );
        };
        if let ExprKind::Member(..) | ExprKind::Index(..) = &of.kind {
            if let Some(instance) = self.instance(of) {
                return self.called_block(&instance, args, expr);
            }
            // What it is instead is worth more than that it cannot be called.
            self.spot(of)?;
        }
        let Some(name) = of.name() else {
            return fail(codes::ST_UNSUPPORTED.at(of.span, "this cannot be called"));
        };
        let labels = Rc::clone(&self.labels);
        if let Some(label) = labels.get(name) {
            if let Stored::Instance(instance) = &label.stored {
                return self.called_block(instance, args, expr);
            }
            if matches!(label.stored, Stored::Instances) {
                self.spot(of)?;
            }
            let what = phrase!("`{name}` is a label, which cannot be called", name);
            return fail(codes::ST_TYPE.at(of.span, what));
        }
        if let Some(function) = self.functions.get(&name.to_uppercase()).cloned() {
            return self.call_routine(&function, args, expr);
        }
        let upper = name.to_ascii_uppercase();
        if let Some(arg) = args.iter().find_map(|arg| arg.name.as_ref()) {
            let what = phrase!("arguments of instructions have no names");
            return fail(codes::ST_ARGUMENTS.at(arg.span, what));
        }
        match upper.as_str() {
            "OUT_T" | "OUT_C" | "OUT_C_32" => return self.counted_out(&upper, of, args),
            _ => {}
        }
        let found = rungc_catalogue::find(&upper).filter(|found| is_callable(found, &upper));
        let Some(found) = found else {
            return fail(unknown(name, of));
        };
        if found.inst.drive == Drive::Alone {
            return self.alone(&upper, of, args);
        }
        let Some((enable, rest)) = args.split_first() else {
            let what = phrase!("`{name}` takes EN and its operands", name = upper);
            return fail(
                codes::ST_ARGUMENTS
                    .at(expr.span, what)
                    .help(usage(&upper, &found)),
            );
        };
        let params = parameters(&found, rest.len());
        if params.len() != rest.len() {
            let (count, given) = (params.len(), rest.len());
            let what = phrase!(
                "`{name}` takes {count} operands after EN, not {given}",
                name = upper,
                count,
                given
            );
            return fail(
                codes::ST_ARGUMENTS
                    .at(expr.span, what)
                    .help(usage(&upper, &found)),
            );
        }
        self.driven(&upper, &found, &enable.value, rest)
    }

    /// An instruction without a contact before it: `EI(TRUE)`.
    fn alone(&mut self, name: &str, of: &Expr, args: &[Arg]) -> Made<()> {
        if let [arg] = args
            && let Some((Const::Bool(true), _)) = self.constant(&arg.value)?
        {
            self.push(name, []);
            self.is_powered = false;
            return Ok(());
        }
        fail(codes::ST_ARGUMENTS.at(
            of.span,
            phrase!("`{name}` takes EN alone, which is TRUE", name),
        ))
    }

    /// An instruction after its condition.
    fn driven(&mut self, name: &str, found: &Found, enable: &Expr, args: &[Arg]) -> Made<()> {
        let params = parameters(found, args.len());
        let order = call_order(params);
        let (mut errors, mut failed) = (Vec::new(), false);
        let mut operands: Vec<Option<Operand>> = vec![None; params.len()];
        let mut widths = Ty::Int;
        // A compound EN is stored before anything is computed, and a sign counts as that.
        let is_signed = |arg: &Arg| matches!(arg.value.kind, ExprKind::Neg(_));
        let computed = args
            .iter()
            .any(|arg| is_signed(arg) || !self.is_plain(&arg.value));
        let enabled = match computed {
            true => self.enabled(enable),
            false => Ok(None),
        };
        // Z0 has to hold its value when the instruction runs.
        let mut in_order: Vec<_> = args.iter().zip(order).collect();
        in_order.sort_by_key(|(arg, _)| self.is_indexed(&arg.value));
        if let [.., (one, _), (other, _)] = in_order.as_slice()
            && self.is_indexed(&one.value)
            && self.is_indexed(&other.value)
        {
            let what = phrase!("an instruction takes one element with a variable index");
            let error = codes::ST_UNSUPPORTED.at(other.value.span, what);
            return fail(
                error
                    .other(one.value.span, "another one")
                    .help("assign one of them to a label"),
            );
        }
        for (arg, at) in in_order {
            match self.argument(&arg.value, &params[at], found.form.wide) {
                Ok((operand, ty)) => {
                    widths = ty.unwrap_or(widths);
                    operands[at] = Some(operand);
                }
                Err(more) => {
                    failed = true;
                    errors.extend(more);
                }
            }
        }
        let enabled = match enabled {
            Ok(Some(stored)) => Ok(stored),
            Ok(None) => self.condition(enable),
            Err(more) => Err(more),
        };
        let enabled = match enabled {
            Ok(enabled) if !failed => enabled,
            Ok(_) => return Err(errors),
            Err(more) => {
                errors.extend(more);
                return Err(errors);
            }
        };
        // M8000 that is written as a device is a contact like others.
        let is_device = fold::constant(&self.labels, enable).is_none();
        match computed || is_device {
            true => self.load(&enabled),
            false => self.enable(&enabled),
        }
        let operands: Vec<Operand> = operands.into_iter().flatten().collect();
        if name == "RST" && widths.is_wide() && widths != Ty::WideCounter {
            return self.reset_both(operands);
        }
        self.push(name, operands);
        Ok(())
    }

    /// RST of a register of 32 bits resets both words.
    fn reset_both(&mut self, operands: Vec<Operand>) -> Made<()> {
        for operand in operands {
            let mut upper = operand.clone();
            if let OperandKind::Device(device, _) = &mut upper.kind {
                device.number = device.number.saturating_add(1);
            }
            self.push("RST", [operand]);
            self.push("RST", [upper]);
        }
        Ok(())
    }

    /// The bit of a compound EN; `None` for a single contact or comparison.
    fn enabled(&mut self, enable: &Expr) -> Made<Option<Cond>> {
        let is_logic =
            |expr: &Expr| matches!(expr.kind, ExprKind::Binary(op, ..) if !op.compares());
        let is_compound = match &enable.kind {
            ExprKind::Not(of) => is_logic(of),
            _ => is_logic(enable) || self.is_equality(enable),
        };
        // Operands may need Z0, too.
        if !is_compound && !changes_index(enable) {
            return Ok(None);
        }
        let cond = self.condition(enable)?;
        self.load(&cond);
        self.in_bit(enable.span).map(Some)
    }

    /// Returns true for an argument that nothing has to be computed for.
    fn is_plain(&self, expr: &Expr) -> bool {
        matches!(self.constant(expr), Ok(Some(_)))
            || !matches!(self.place(expr), Ok(None)) && !self.is_indexed(expr)
    }

    /// Returns true for an element by a variable index.
    fn is_indexed(&self, expr: &Expr) -> bool {
        matches!(self.place(expr), Ok(Some(place)) if place.is_variable())
    }

    /// Begins a rung with a condition, such as that of EN.
    pub(crate) fn enable(&mut self, cond: &Cond) {
        match cond {
            Cond::Contact {
                operand,
                is_closed: false,
                ..
            } if operand.kind == crate::emit::ON => self.power(),
            cond => self.load(cond),
        }
    }

    /// An argument as an operand, and its type if it is a declared one.
    fn argument(
        &mut self,
        expr: &Expr,
        param: &Param,
        is_wide: bool,
    ) -> Made<(Operand, Option<Ty>)> {
        let writes = is_output(param);
        if let Some(place) = self.place(expr)? {
            if place.is_variable() && place.ty.is_bit() {
                let what = phrase!("a bit with a variable index cannot stand in an instruction");
                let error = codes::ST_UNSUPPORTED.at(expr.span, what);
                return fail(error.help("assign it to a label, or the label to it"));
            }
            let operand = self.reached(&place, expr.span)?;
            return Ok((operand, Some(place.ty)));
        }
        if writes {
            let what = phrase!(
                "`{name}` is written, so it has to be a label or device",
                name = param.name
            );
            return fail(codes::ST_NOT_WRITABLE.at(expr.span, what));
        }
        let of = self.ty(expr)?;
        let ty = match (param.shape, of) {
            (_, of) if !of.is_untyped() => of,
            (Shape::Float, _) | (_, Ty::Fraction) => Ty::Real,
            (Shape::Pair, _) => Ty::Raw32,
            (Shape::Value, _) if is_wide => Ty::Raw32,
            _ => Ty::Raw16,
        };
        if ty == Ty::Bool {
            let what = phrase!("a condition cannot stand here");
            return fail(
                codes::ST_TYPE
                    .at(expr.span, what)
                    .help("assign it to a label first"),
            );
        }
        Ok((self.operand(expr, ty)?, None))
    }

    /// `OUT_T(EN, TC0, 50)`.
    fn counted_out(&mut self, name: &str, of: &Expr, args: &[Arg]) -> Made<()> {
        let [enable, device, value] = args else {
            let what = phrase!("`{name}` takes EN, a device and a value", name);
            let help = phrase!(
                "write `{name}(EN, {device}, 50)`",
                name,
                device = if name == "OUT_T" { "TC0" } else { "CC0" }
            );
            return fail(codes::ST_ARGUMENTS.at(of.span, what).help(help));
        };
        let is_timer = name == "OUT_T";
        let place = self.place(&device.value)?;
        let class = if is_timer {
            rungc_syntax::DeviceClass::T
        } else {
            rungc_syntax::DeviceClass::C
        };
        let place = place.filter(|place| match &place.operand {
            OperandKind::Device(device, _) => device.class == class,
            _ => false,
        });
        let Some(place) = place else {
            let what = if is_timer {
                "this is not a timer T"
            } else {
                "this is not a counter C"
            };
            return fail(codes::ST_TYPE.at(device.value.span, what));
        };
        let is_wide = place.ty == Ty::WideCounter || name == "OUT_C_32";
        let of_value = self.ty(&value.value)?;
        let ty = match of_value {
            Ty::Integer if is_wide => Ty::Raw32,
            Ty::Integer => Ty::Raw16,
            ty => ty,
        };
        let device = Operand {
            span: device.value.span,
            kind: place.operand,
        };
        if ty == Ty::Time {
            let ExprKind::Binary(Op::Div, duration, step) = &value.value.kind else {
                let what = phrase!("the value of a timer counts its steps, and this is a TIME");
                let error = codes::ST_TYPE.at(value.value.span, what);
                return fail(error.help("divide it: `T#5s / T#100ms`"));
            };
            if self.is_plain(duration) && self.is_plain(step) {
                return self.timed_out(&enable.value, device, &value.value);
            }
        }
        let stored = self.enabled(&enable.value)?;
        let value = self.kept_operand(&value.value, ty)?;
        let cond = match stored {
            Some(stored) => stored,
            None => self.condition(&enable.value)?,
        };
        self.enable(&cond);
        self.push("OUT", [device, value]);
        Ok(())
    }

    /// A timer for the quotient of two durations, which is computed while it runs, as in the blocks of GX Works2.
    fn timed_out(&mut self, enable: &Expr, timer: Operand, value: &Expr) -> Made<()> {
        let cond = match self.enabled(enable)? {
            Some(stored) => stored,
            None => self.condition(enable)?,
        };
        self.load(&cond);
        // What follows belongs to the rung.
        self.is_powered = true;
        let value = self.operand(value, Ty::Time);
        self.is_powered = false;
        self.push("OUT", [timer, value?]);
        Ok(())
    }
}

/// Returns true for the name of an instruction that can be called.
pub(crate) fn is_instruction(name: &str) -> bool {
    let upper = name.to_ascii_uppercase();
    rungc_catalogue::find(&upper).is_some_and(|found| is_callable(&found, &upper))
}

/// Returns true for what GX Works2 offers as a function: an instruction that a rung drives, or one that stands alone.
fn is_callable(found: &Found, name: &str) -> bool {
    const NOT: [&str; 12] = [
        "CJ", "CALL", "SRET", "IRET", "FEND", "END", "FOR", "NEXT", "MC", "MCR", "STL", "RET",
    ];
    let is_label = found.inst.name == "P" || found.inst.name == "I";
    let drives = match found.inst.drive {
        Drive::Contact => true,
        Drive::Alone => found.inst.params.is_empty(),
        Drive::Logic => false,
    };
    !is_label
        && drives
        && !NOT.contains(&name)
        && !name.starts_with("CJ")
        && !name.starts_with("CALL")
}

/// The operands of a call with this many arguments.
fn parameters(found: &Found, given: usize) -> &'static [Param] {
    let all = found.inst.params;
    let least = all.iter().filter(|param| !param.optional).count();
    &all[..given.clamp(least, all.len())]
}

/// Returns true for a destination. BMOV may write its source, too, which stays one.
fn is_output(param: &Param) -> bool {
    match param.role {
        Role::Read => false,
        Role::Write => true,
        Role::ReadWrite => !param.name.starts_with('S'),
    }
}

/// Positions of the operands in the order of a call: what is read stands before what is written.
fn call_order(params: &[Param]) -> impl Iterator<Item = usize> {
    let is = |writes: bool| {
        let positions = params.iter().enumerate();
        positions
            .filter(move |(_, param)| is_output(param) == writes)
            .map(|(at, _)| at)
    };
    is(false).chain(is(true))
}

fn usage(name: &str, found: &Found) -> Phrase {
    let params = found.inst.params;
    let names: String = call_order(params)
        .map(|at| format!(", {}", params[at].name))
        .collect();
    phrase!("write `{name}(EN{names})`", name, names)
}

fn unknown(name: &str, of: &Expr) -> Diagnostic {
    let upper = name.to_ascii_uppercase();
    let spellings: Vec<String> = rungc_catalogue::all()
        .flat_map(|inst| inst.spellings().into_iter().map(|(spelling, _)| spelling))
        .filter(|name| is_instruction(name))
        .collect();
    let what = phrase!("nothing defines `{name}`, which is called here", name);
    let error = codes::ST_UNKNOWN_NAME.at(of.span, what);
    match did_you_mean(&upper, spellings.iter().map(String::as_str)) {
        Some(meant) if meant != upper => error.help(phrase!("did you mean `{meant}`?", meant)),
        _ => error.help(elsewhere()),
    }
}
