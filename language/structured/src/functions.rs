//! Functions of the library: selection, limits, shifts, and those of numbers.

use crate::ast::{Arg, Expr, Op};
use crate::conditions::Cond;
use crate::convert;
use crate::emit::{Compiler, Made, both, fail};
use crate::literal::Const;
use crate::texts;
use crate::types::Ty;
use rungc_syntax::{
    Device, Diagnostic, Operand, OperandKind, Phrase, codes, diag::did_you_mean, phrase,
};

/// Function of the library.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Function {
    /// Smallest or largest of several values.
    Extreme(Op),
    Limit,
    Select,
    Multiplex,
    Absolute,
    /// Instruction with a REAL value and a REAL result.
    OfReal(&'static str),
    /// Shift by a constant number of places.
    Shift(Shift),
}

/// Direction of a shift, and whether bits come back on the other side.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Shift {
    Left,
    Right,
    RotateLeft,
    RotateRight,
}

/// Names of functions; GX Works2 writes some of them in full.
static FUNCTIONS: [(&str, Function); 23] = [
    ("MIN", Function::Extreme(Op::Gt)),
    ("MINIMUM", Function::Extreme(Op::Gt)),
    ("MAX", Function::Extreme(Op::Lt)),
    ("MAXIMUM", Function::Extreme(Op::Lt)),
    ("LIMIT", Function::Limit),
    ("LIMITATION", Function::Limit),
    ("SEL", Function::Select),
    ("MUX", Function::Multiplex),
    ("ABS", Function::Absolute),
    ("SQRT", Function::OfReal("DESQR")),
    ("SIN", Function::OfReal("DSIN")),
    ("COS", Function::OfReal("DCOS")),
    ("TAN", Function::OfReal("DTAN")),
    ("ASIN", Function::OfReal("DASIN")),
    ("ACOS", Function::OfReal("DACOS")),
    ("ATAN", Function::OfReal("DATAN")),
    ("EXP", Function::OfReal("DEXP")),
    ("LN", Function::OfReal("DLOGE")),
    ("LOG", Function::OfReal("DLOG10")),
    ("SHL", Function::Shift(Shift::Left)),
    ("SHR", Function::Shift(Shift::Right)),
    ("ROL", Function::Shift(Shift::RotateLeft)),
    ("ROR", Function::Shift(Shift::RotateRight)),
];

/// The function of this name.
pub(crate) fn find(name: &str) -> Option<Function> {
    let mut all = FUNCTIONS.iter();
    let found = all.find(|(known, _)| known.eq_ignore_ascii_case(name));
    found.map(|(_, function)| *function)
}

/// What to do where a text does not define a unit.
pub(crate) fn elsewhere() -> Phrase {
    phrase!(
        "define it here, in a file of the same folder, or in one that `[project] program` in rungc.toml lists"
    )
}

/// A function of an unknown name.
pub(crate) fn unknown(name: &str, of: &Expr) -> Diagnostic {
    let what = phrase!("nothing defines the function `{name}`", name);
    let error = codes::ST_UNKNOWN_NAME.at(of.span, what);
    let names = FUNCTIONS.iter().map(|(name, _)| *name);
    let names = names.chain(convert::names()).chain(texts::names());
    match did_you_mean(&name.to_uppercase(), names) {
        Some(meant) => error.help(phrase!("did you mean `{meant}`?", meant)),
        None => error.help(elsewhere()),
    }
}

impl Compiler<'_> {
    /// The type of a call of a function, which has to fit its arguments.
    pub(crate) fn type_of_function(
        &self,
        function: Function,
        args: &[Arg],
        expr: &Expr,
    ) -> Made<Ty> {
        if let Some(arg) = args.iter().find_map(|arg| arg.name.as_ref()) {
            let what = phrase!("arguments of functions of the library have no names");
            return fail(codes::ST_ARGUMENTS.at(arg.span, what));
        }
        let (least, most, usage) = match function {
            Function::Extreme(_) => (2, 16, "NAME(a, b, …)"),
            Function::Limit => (3, 3, "LIMIT(least, value, most)"),
            Function::Select => (3, 3, "SEL(condition, when FALSE, when TRUE)"),
            Function::Multiplex => (3, 17, "MUX(number, value 0, value 1, …)"),
            Function::Absolute | Function::OfReal(_) => (1, 1, "NAME(value)"),
            Function::Shift(_) => (2, 2, "NAME(value, places)"),
        };
        if args.len() < least || args.len() > most {
            let what = phrase!(
                "this function does not take {given} arguments",
                given = args.len()
            );
            let error = codes::ST_ARGUMENTS.at(expr.span, what);
            return fail(error.help(phrase!("write `{usage}`", usage)));
        }
        let values = match function {
            Function::Select => {
                self.expect(&args[0].value, Ty::Bool)?;
                &args[1..]
            }
            Function::Multiplex => {
                self.expect(&args[0].value, Ty::Int)?;
                &args[1..]
            }
            Function::Shift(_) => &args[..1],
            _ => args,
        };
        let ty = self.common_type(values)?;
        let suits = match function {
            Function::OfReal(_) => ty == Ty::Real,
            Function::Absolute => !ty.is_unsigned() && ty != Ty::Bool,
            Function::Shift(_) => ty.is_whole() && !matches!(ty, Ty::Time | Ty::Integer),
            Function::Select | Function::Multiplex => ty != Ty::Bool,
            _ => ty != Ty::Bool && !ty.is_text(),
        };
        if !suits {
            let what = phrase!("this function is not compiled for {ty}", ty);
            return fail(codes::ST_TYPE.at(values[0].value.span, what));
        }
        Ok(ty)
    }

    /// The type that several values have in common.
    fn common_type(&self, values: &[Arg]) -> Made<Ty> {
        let mut common: Option<Ty> = None;
        for arg in values {
            let ty = self.ty(&arg.value)?;
            common = match common {
                None => Some(ty),
                Some(before) => match before.common(ty) {
                    Some(ty) => Some(ty),
                    None => {
                        let what =
                            phrase!("this is {ty}, and the value before it {before}", ty, before);
                        return fail(codes::ST_TYPE.at(arg.value.span, what));
                    }
                },
            };
        }
        Ok(match common {
            Some(Ty::Fraction) => Ty::Real,
            Some(Ty::Timer) => Ty::Raw16,
            Some(ty) => ty,
            None => Ty::Bool,
        })
    }

    /// Computes a function into a target or a temporary; gives the device that holds it.
    pub(crate) fn function(
        &mut self,
        function: Function,
        args: &[Arg],
        ty: Ty,
        target: Option<&Operand>,
    ) -> Made<OperandKind> {
        let result = match function {
            Function::Limit => return self.limit(args, ty, target),
            Function::Select => return self.select(args, ty, target),
            Function::Extreme(op) => self.extreme(op, args, ty)?,
            Function::Multiplex => self.multiplex(args, ty)?,
            Function::Absolute => self.absolute(&args[0].value, ty)?,
            Function::OfReal(name) => {
                let operand = self.operand(&args[0].value, ty)?;
                let result = self.result_in(ty, target)?;
                self.always(name, [operand, result.clone()]);
                return Ok(result.kind);
            }
            Function::Shift(shift) => self.shift(shift, args, ty)?,
        };
        self.moved(result.kind, ty, target)
    }

    /// The target, or a temporary in place of it.
    fn result_in(&mut self, ty: Ty, target: Option<&Operand>) -> Made<Operand> {
        match target {
            Some(target) => Ok(target.clone()),
            None => self.scratch(ty.words()),
        }
    }

    /// A temporary of this many words as an operand.
    fn scratch(&mut self, words: u32) -> Made<Operand> {
        let temporary = self.temporary(words)?;
        Ok(self.here(OperandKind::Device(temporary, None)))
    }

    fn kept_operands(&mut self, args: &[Arg], ty: Ty) -> Made<Vec<Operand>> {
        args.iter()
            .map(|arg| self.kept_operand(&arg.value, ty))
            .collect()
    }

    /// Copies a value where a condition holds.
    fn copy_if(&mut self, cond: &Cond, value: &Operand, ty: Ty, result: &Operand) {
        self.load(cond);
        self.push(Self::sized("MOV", ty), [value.clone(), result.clone()]);
    }

    fn copy(&mut self, value: &Operand, ty: Ty, result: &Operand) {
        self.always(&Self::sized("MOV", ty), [value.clone(), result.clone()]);
    }

    /// `LIMIT(least, value, most)` in the steps of GX Works2.
    fn limit(&mut self, args: &[Arg], ty: Ty, target: Option<&Operand>) -> Made<OperandKind> {
        let operands = self.kept_operands(args, ty)?;
        let [least, value, most] = operands.as_slice() else {
            return Err(Vec::new());
        };
        let result = self.result_in(ty, target)?;
        let not_below = self.compared(Op::Ge, value, least, ty)?;
        let not_above = self.compared(Op::Le, value, most, ty)?;
        self.copy_if(&Cond::both(not_below, not_above), value, ty, &result);
        let below = self.compared(Op::Lt, value, least, ty)?;
        self.copy_if(&below, least, ty, &result);
        let above = self.compared(Op::Gt, value, most, ty)?;
        self.copy_if(&above, most, ty, &result);
        Ok(result.kind)
    }

    /// `SEL(condition, when FALSE, when TRUE)` in the steps of GX Works2.
    fn select(&mut self, args: &[Arg], ty: Ty, target: Option<&Operand>) -> Made<OperandKind> {
        let cond = self.condition(&args[0].value)?;
        self.load(&cond);
        let bit = self.in_bit(args[0].value.span)?;
        let (off, on) = both(
            self.kept_operand(&args[1].value, ty),
            self.kept_operand(&args[2].value, ty),
        )?;
        let result = self.result_in(ty, target)?;
        self.copy_if(&bit.opposite(), &off, ty, &result);
        self.copy_if(&bit, &on, ty, &result);
        Ok(result.kind)
    }

    fn extreme(&mut self, op: Op, args: &[Arg], ty: Ty) -> Made<Operand> {
        let operands = self.kept_operands(args, ty)?;
        let result = self.scratch(ty.words())?;
        for (at, value) in operands.iter().enumerate() {
            if at == 0 {
                self.copy(value, ty, &result);
                continue;
            }
            let better = self.compared(op, &result, value, ty)?;
            self.copy_if(&better, value, ty, &result);
        }
        Ok(result)
    }

    /// `MUX(number, value 0, …)`; with a number beyond the values, the last one.
    fn multiplex(&mut self, args: &[Arg], ty: Ty) -> Made<Operand> {
        let number = self.kept_operand(&args[0].value, Ty::Int)?;
        let operands = self.kept_operands(&args[1..], ty)?;
        let result = self.scratch(ty.words())?;
        let Some((last, others)) = operands.split_last() else {
            return Err(Vec::new());
        };
        self.copy(last, ty, &result);
        for (at, value) in others.iter().enumerate() {
            let at = self.here(OperandKind::Decimal(at as i64, None));
            let chosen = self.compared(Op::Eq, &number, &at, Ty::Int)?;
            self.copy_if(&chosen, value, ty, &result);
        }
        Ok(result)
    }

    fn absolute(&mut self, arg: &Expr, ty: Ty) -> Made<Operand> {
        let value = self.kept_operand(arg, ty)?;
        let zero = self.here(match ty {
            Ty::Real => OperandKind::Float(0.0),
            _ => OperandKind::Decimal(0, None),
        });
        let result = self.scratch(ty.words())?;
        self.copy(&value, ty, &result);
        let negative = self.compared(Op::Lt, &value, &zero, ty)?;
        self.load(&negative);
        self.push(Self::sized("SUB", ty), [zero, value, result.clone()]);
        Ok(result)
    }

    /// Shifts by a constant number of places: rotations by their instructions, others by multiplication and division.
    fn shift(&mut self, shift: Shift, args: &[Arg], ty: Ty) -> Made<Operand> {
        let bits = if ty.is_wide() { 32 } else { 16 };
        let places = match self.constant(&args[1].value)? {
            Some((Const::Int(places), _)) => u32::try_from(places).ok(),
            _ => None,
        };
        let Some(places) = places.filter(|places| *places < bits) else {
            let what = phrase!(
                "the number of places is a constant from 0 to {most}",
                most = bits - 1
            );
            return fail(codes::ST_LITERAL.at(args[1].value.span, what));
        };
        let value = self.operand(&args[0].value, ty)?;
        let decimal = |value: i64| OperandKind::Decimal(value, None);
        match shift {
            Shift::RotateLeft | Shift::RotateRight => {
                let name = if shift == Shift::RotateLeft {
                    "ROL"
                } else {
                    "ROR"
                };
                let result = self.scratch(ty.words())?;
                self.copy(&value, ty, &result);
                if places > 0 {
                    let places = self.here(decimal(places.into()));
                    self.push(Self::sized(name, ty), [result.clone(), places]);
                }
                Ok(result)
            }
            Shift::Left => {
                // The highest power is negative, with the same bits.
                let power = 1i64 << places;
                let power = if places + 1 == bits { -power } else { power };
                let power = self.here(decimal(power));
                let result = self.scratch(2 * ty.words())?;
                self.always(&Self::sized("MUL", ty), [value, power, result.clone()]);
                Ok(result)
            }
            Shift::Right if ty.is_wide() => self.wide_right(value, places, ty),
            Shift::Right => {
                let value = self.zero_extended(value)?;
                let power = self.here(decimal(1 << places));
                let result = self.scratch(4)?;
                self.always("DDIV", [value, power, result.clone()]);
                Ok(result)
            }
        }
    }

    /// Shifts 32 bits to the right: the highest bit apart, since a division takes it for a sign.
    fn wide_right(&mut self, value: Operand, places: u32, ty: Ty) -> Made<Operand> {
        let value = {
            let copy = self.scratch(2)?;
            self.copy(&value, ty, &copy);
            copy
        };
        if places == 0 {
            return Ok(value);
        }
        let hex = |value: u64| OperandKind::Hex(value, None);
        let (rest, result) = (self.scratch(2)?, self.scratch(4)?);
        let mask = self.here(hex(0x7FFF_FFFF));
        self.always("DAND", [value.clone(), mask, rest.clone()]);
        let zero = self.here(OperandKind::Decimal(0, None));
        match places {
            31 => self.always("DMOV", [zero.clone(), result.clone()]),
            _ => {
                let power = self.here(OperandKind::Decimal(1 << places, None));
                self.always("DDIV", [rest, power, result.clone()]);
            }
        }
        let highest = self.here(hex(1 << (31 - places)));
        let negative = self.compared(Op::Lt, &value, &zero, Ty::Dint)?;
        self.load(&negative);
        self.push("DOR", [result.clone(), highest, result.clone()]);
        Ok(result)
    }

    /// A value of 16 bits without a sign as one of 32 bits.
    fn zero_extended(&mut self, value: Operand) -> Made<Operand> {
        if value.kind.constant().is_some() {
            return Ok(value);
        }
        let temporary = self.temporary(2)?;
        let [low, high] = [0, 1].map(|word| Device {
            number: temporary.number + word,
            ..temporary
        });
        let low = self.here(OperandKind::Device(low, None));
        let high = self.here(OperandKind::Device(high, None));
        self.always("MOV", [value, low.clone()]);
        self.push("RST", [high]);
        Ok(low)
    }

    /// `/` and `MOD` of values without a sign, by the division of 32 bits.
    pub(crate) fn unsigned_quotient(
        &mut self,
        op: Op,
        [a, b]: [Operand; 2],
        ty: Ty,
        target: Option<&Operand>,
    ) -> Made<OperandKind> {
        if ty.is_wide() {
            let what = phrase!(
                "`{sign}` of DWORD values is not compiled yet",
                sign = op.sign()
            );
            let error = codes::ST_UNSUPPORTED.at(a.span.to(b.span), what);
            return fail(error.help("convert to DINT, which has a sign: `DWORD_TO_DINT(…)`"));
        }
        let (a, b) = (self.zero_extended(a)?, self.zero_extended(b)?);
        let temporary = self.temporary(4)?;
        let result = self.here(OperandKind::Device(temporary, None));
        self.always("DDIV", [a, b, result]);
        let number = temporary.number + if op == Op::Mod { 2 } else { 0 };
        let result = Device {
            number,
            ..temporary
        };
        self.moved(OperandKind::Device(result, None), ty, target)
    }

    /// 1 or 0 by a condition.
    pub(crate) fn bit_value(
        &mut self,
        arg: &Expr,
        ty: Ty,
        target: Option<&Operand>,
    ) -> Made<OperandKind> {
        let cond = self.condition(arg)?;
        self.load(&cond);
        let bit = self.in_bit(arg.span)?;
        let result = self.result_in(ty, target)?;
        for (cond, value) in [(bit.opposite(), 0), (bit, 1)] {
            let value = self.here(OperandKind::Decimal(value, None));
            self.copy_if(&cond, &value, ty, &result);
        }
        Ok(result.kind)
    }
}
