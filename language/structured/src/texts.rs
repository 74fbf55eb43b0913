//! Values of type STRING: literals, and the functions that FX3 has instructions for.
//!
//! A text is in D, two characters a word, and ends with a byte 0. Positions and lengths that a text does not have are
//! limited to those that it has, since the instructions report an error for them.

use crate::ast::{Arg, Expr, ExprKind, Op};
use crate::conditions::{Cond, Join};
use crate::emit::{Compiler, Made, both, fail};
use crate::labels::Stored;
use crate::literal::Const;
use crate::types::Ty;
use rungc_syntax::{Device, Diagnostic, Operand, OperandKind, Span, codes, phrase};
use smol_str::SmolStr;
use std::rc::Rc;

/// Length of a text whose declaration states none, as in GX Works2.
pub(crate) const USUAL: u16 = 32;

/// Largest length of a label.
pub(crate) const LONGEST: u16 = 255;

/// Largest length of a text in an instruction.
const LONGEST_OPERAND: usize = 32;

/// Function of texts.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Function {
    Len,
    Left,
    Right,
    Mid,
    Concat,
    Insert,
    Delete,
    Replace,
    Find,
    /// Number to text: type of the number, instruction, number of characters.
    From(Ty, &'static str, u16),
    /// Text to number: type of the number, instruction.
    To(Ty, &'static str),
}

static FUNCTIONS: [(&str, Function); 21] = [
    ("LEN", Function::Len),
    ("LEFT", Function::Left),
    ("RIGHT", Function::Right),
    ("MID", Function::Mid),
    ("CONCAT", Function::Concat),
    ("INSERT", Function::Insert),
    ("DELETE", Function::Delete),
    ("REPLACE", Function::Replace),
    ("FIND", Function::Find),
    ("INT_TO_STRING", Function::From(Ty::Int, "STR", 6)),
    ("INT_TO_STR", Function::From(Ty::Int, "STR", 6)),
    ("DINT_TO_STRING", Function::From(Ty::Dint, "DSTR", 11)),
    ("DINT_TO_STR", Function::From(Ty::Dint, "DSTR", 11)),
    ("REAL_TO_STRING", Function::From(Ty::Real, "DESTR", 12)),
    ("REAL_TO_STR", Function::From(Ty::Real, "DESTR", 12)),
    ("STRING_TO_INT", Function::To(Ty::Int, "VAL")),
    ("STR_TO_INT", Function::To(Ty::Int, "VAL")),
    ("STRING_TO_DINT", Function::To(Ty::Dint, "DVAL")),
    ("STR_TO_DINT", Function::To(Ty::Dint, "DVAL")),
    ("STRING_TO_REAL", Function::To(Ty::Real, "DEVAL")),
    ("STR_TO_REAL", Function::To(Ty::Real, "DEVAL")),
];

/// The function of this name.
pub(crate) fn find(name: &str) -> Option<Function> {
    let mut all = FUNCTIONS.iter();
    let found = all.find(|(known, _)| known.eq_ignore_ascii_case(name));
    found.map(|(_, function)| *function)
}

/// Names of all functions.
pub(crate) fn names() -> impl Iterator<Item = &'static str> {
    FUNCTIONS.iter().map(|(name, _)| *name)
}

/// The characters of a literal, in which `$` begins another one.
pub(crate) fn characters(text: &str) -> Option<SmolStr> {
    let mut made = String::new();
    let mut rest = text.chars();
    while let Some(c) = rest.next() {
        let c = match c {
            '$' => escaped(&mut rest)?,
            c => c,
        };
        if !c.is_ascii() && c as u32 > 0xFF || c == '\0' {
            return None;
        }
        made.push(c);
    }
    Some(made.into())
}

/// The text of a constant, or what is wrong with it.
pub(crate) fn constant(text: &str, most: u16, span: Span) -> Result<SmolStr, Box<Diagnostic>> {
    let text = characters(text).ok_or_else(|| not_held(span))?;
    if text.chars().count() > usize::from(most) {
        let what = phrase!("this text has more than {most} characters", most);
        return Err(codes::ST_LITERAL.at(span, what).into());
    }
    Ok(text)
}

/// A literal with a character that a text does not hold.
fn not_held(span: Span) -> Box<Diagnostic> {
    let what = phrase!("this text has a character that STRING does not hold");
    let error = codes::ST_LITERAL.at(span, what);
    error
        .help("it holds ASCII; others are written by their number: `$E9`, and `$$` is one `$`")
        .into()
}

/// A character after `$`: by its letter, or by two hexadecimal digits.
fn escaped(rest: &mut std::str::Chars) -> Option<char> {
    let first = rest.next()?;
    Some(match first.to_ascii_uppercase() {
        '$' | '\'' | '"' => first,
        'L' | 'N' => '\n',
        'P' => '\x0C',
        'R' => '\r',
        'T' => '\t',
        _ => {
            let digits = [first, rest.next()?].map(|digit| digit.to_digit(16));
            char::from_u32(digits[0]? * 16 + digits[1]?)?
        }
    })
}

impl Function {
    /// Least and most arguments, and how it is written.
    const fn usage(self) -> (usize, usize, &'static str) {
        match self {
            Function::Len => (1, 1, "LEN(text)"),
            Function::Left => (2, 2, "LEFT(text, length)"),
            Function::Right => (2, 2, "RIGHT(text, length)"),
            Function::Mid => (3, 3, "MID(text, length, position)"),
            Function::Concat => (2, 16, "CONCAT(text, text, …)"),
            Function::Insert => (3, 3, "INSERT(text, inserted, position)"),
            Function::Delete => (3, 3, "DELETE(text, length, position)"),
            Function::Replace => (4, 4, "REPLACE(text, new, length, position)"),
            Function::Find => (2, 2, "FIND(text, searched)"),
            Function::From(..) | Function::To(..) => (1, 1, "NAME(value)"),
        }
    }

    /// Number of arguments that are texts, of this many; lengths and positions follow.
    const fn texts(self, given: usize) -> usize {
        match self {
            Function::From(..) => 0,
            Function::Concat => given,
            Function::Find | Function::Insert | Function::Replace => 2,
            _ => 1,
        }
    }
}

impl Compiler<'_> {
    /// The characters of a literal, or of a constant; `None` if an expression is neither.
    pub(crate) fn literal_text(&self, expr: &Expr) -> Made<Option<SmolStr>> {
        match &expr.kind {
            ExprKind::Text(text) => match characters(text) {
                Some(text) => Ok(Some(text)),
                None => Err(vec![*not_held(expr.span)]),
            },
            ExprKind::Name(name) => Ok(match self.labels.get(name).map(|label| &label.stored) {
                Some(Stored::Text(text)) => Some(text.clone()),
                _ => None,
            }),
            _ => Ok(None),
        }
    }

    /// The type of a call of a function, which has to fit its arguments.
    pub(crate) fn type_of_text(&self, function: Function, args: &[Arg], expr: &Expr) -> Made<Ty> {
        if let Some(arg) = args.iter().find_map(|arg| arg.name.as_ref()) {
            let what = phrase!("arguments of functions of the library have no names");
            return fail(codes::ST_ARGUMENTS.at(arg.span, what));
        }
        let (least, most, usage) = function.usage();
        if args.len() < least || args.len() > most {
            let given = args.len();
            let what = phrase!("this function does not take {given} arguments", given);
            let error = codes::ST_ARGUMENTS.at(expr.span, what);
            return fail(error.help(phrase!("write `{usage}`", usage)));
        }
        if let Function::From(of, _, length) = function {
            self.expect(&args[0].value, of)?;
            return Ok(Ty::Text(length));
        }
        let (texts, numbers) = args.split_at(function.texts(args.len()));
        let mut lengths = Vec::new();
        for arg in texts {
            match self.ty(&arg.value)? {
                Ty::Text(length) => lengths.push(length),
                ty => {
                    let what = phrase!("this is {ty}, where a STRING is expected", ty);
                    return fail(codes::ST_TYPE.at(arg.value.span, what));
                }
            }
        }
        for arg in numbers {
            self.expect(&arg.value, Ty::Int)?;
        }
        let whole = lengths[0];
        let stated = match numbers.first() {
            Some(arg) => self.constant(&arg.value)?,
            None => None,
        };
        let part = match stated {
            Some((Const::Int(length), _)) => whole.min(length.clamp(0, LONGEST.into()) as u16),
            _ => whole,
        };
        let sum = lengths
            .iter()
            .fold(0u16, |sum, length| sum.saturating_add(*length));
        Ok(match function {
            Function::Len | Function::Find => Ty::Int,
            Function::To(ty, _) => ty,
            Function::Left | Function::Right | Function::Mid => Ty::Text(part),
            _ => Ty::Text(sum),
        })
    }

    /// Reports an instruction that the model does not have.
    pub(crate) fn need(&self, name: &str, span: Span) -> Made<()> {
        let found = rungc_catalogue::find(name);
        if found.is_some_and(|found| found.inst.models.has(self.model.id)) {
            return Ok(());
        }
        let model = self.model.title;
        let what = phrase!(
            "this takes the instruction `{name}`, which {model} does not have",
            name,
            model
        );
        fail(codes::ST_UNSUPPORTED.at(span, what))
    }

    /// A literal as an operand of an instruction, or in a temporary where it cannot stand in one.
    pub(crate) fn text_operand(&mut self, text: &str, span: Span) -> Made<Operand> {
        self.need("$MOV", span)?;
        let is_plain = |c: char| (' '..='~').contains(&c) && c != '"';
        if text.chars().all(is_plain) {
            if text.len() > LONGEST_OPERAND {
                let what = phrase!(
                    "a text of an instruction has at most {most} characters",
                    most = LONGEST_OPERAND
                );
                let error = codes::ST_LITERAL.at(span, what);
                return fail(error.help("join several: `CONCAT('…', '…')`"));
            }
            return Ok(Operand {
                span,
                kind: OperandKind::Text(text.into()),
            });
        }
        let mut bytes: Vec<u8> = text.chars().map(|c| c as u32 as u8).collect();
        bytes.resize(bytes.len() + 2 - bytes.len() % 2, 0);
        let first = self.temporary((bytes.len() / 2) as u32)?;
        for (at, pair) in bytes.chunks_exact(2).enumerate() {
            let word = u64::from(u16::from_le_bytes([pair[0], pair[1]]));
            let word = self.here(OperandKind::Hex(word, None));
            let to = self.here(further(first, at as u32));
            self.always("MOV", [word, to]);
        }
        Ok(Operand {
            span,
            kind: OperandKind::Device(first, None),
        })
    }

    /// A text as an operand that keeps its value while others are computed.
    fn text(&mut self, expr: &Expr) -> Made<Operand> {
        let ty = self.ty(expr)?;
        self.kept_operand(expr, ty)
    }

    /// As [`Self::text`], in a register: most instructions take no literal.
    fn stored_text(&mut self, expr: &Expr) -> Made<Operand> {
        let operand = self.text(expr)?;
        match operand.kind {
            OperandKind::Text(_) => {
                let ty = self.ty(expr)?;
                let copy = self.room(ty.words())?;
                self.always("$MOV", [operand, copy.clone()]);
                Ok(copy)
            }
            _ => Ok(operand),
        }
    }

    fn room(&mut self, words: u32) -> Made<Operand> {
        let temporary = self.temporary(words)?;
        Ok(self.here(OperandKind::Device(temporary, None)))
    }

    fn decimal(&self, value: i64) -> Operand {
        self.here(OperandKind::Decimal(value, None))
    }

    /// Number of characters of a text.
    fn length(&mut self, text: &Operand) -> Made<Operand> {
        let length = self.room(1)?;
        self.always("LEN", [text.clone(), length.clone()]);
        Ok(length)
    }

    /// A number, at least 0 and at most another.
    fn limited(&mut self, value: Operand, most: &Operand) -> Made<Operand> {
        let result = self.room(1)?;
        self.always("MOV", [value, result.clone()]);
        let zero = self.decimal(0);
        for (op, limit) in [(Op::Lt, &zero), (Op::Gt, most)] {
            let beyond = self.compared(op, &result, limit, Ty::Int)?;
            self.load(&beyond);
            self.push("MOV", [limit.clone(), result.clone()]);
        }
        Ok(result)
    }

    fn difference(&mut self, from: &Operand, less: Operand) -> Made<Operand> {
        let result = self.room(1)?;
        self.always("SUB", [from.clone(), less, result.clone()]);
        Ok(result)
    }

    /// Calls a function, with its result in the target or a temporary; gives the device that holds it.
    pub(crate) fn text_function(
        &mut self,
        (function, ty): (Function, Ty),
        args: &[Arg],
        expr: &Expr,
        target: Option<&Operand>,
    ) -> Made<OperandKind> {
        match function {
            Function::From(_, name, _) | Function::To(_, name) => self.need(name, expr.span)?,
            _ => self.need("LEN", expr.span)?,
        }
        let result = match function {
            Function::Len => {
                let text = self.stored_text(&args[0].value)?;
                self.length(&text)?
            }
            Function::Left | Function::Right => {
                let name = if function == Function::Left {
                    "LEFT"
                } else {
                    "RIGHT"
                };
                let (text, count) = both(self.stored_text(&args[0].value), self.number(&args[1]))?;
                let length = self.length(&text)?;
                let count = self.limited(count, &length)?;
                let result = self.room(ty.words())?;
                self.always(name, [text, result.clone(), count]);
                result
            }
            Function::Mid => self.middle(args)?,
            Function::Concat => self.joined(args)?,
            Function::Insert | Function::Delete | Function::Replace => {
                self.replaced(function, args, ty)?
            }
            Function::Find => {
                let (text, searched) =
                    both(self.stored_text(&args[0].value), self.text(&args[1].value))?;
                let result = self.room(1)?;
                let first = self.decimal(1);
                self.always("INSTR", [searched, text, result.clone(), first]);
                result
            }
            Function::From(of, name, length) => {
                self.number_to_text(&args[0].value, (of, name, length))?
            }
            Function::To(of, name) => self.text_to_number(&args[0].value, of, name)?,
        };
        self.moved(result.kind, ty, target)
    }

    fn number(&mut self, arg: &Arg) -> Made<Operand> {
        self.kept_operand(&arg.value, Ty::Int)
    }

    /// `MID(text, length, position)`: the beginning of what the text ends with.
    fn middle(&mut self, args: &[Arg]) -> Made<Operand> {
        let text = self.stored_text(&args[0].value)?;
        let (count, position) = both(self.number(&args[1]), self.number(&args[2]))?;
        let words = self.ty(&args[0].value)?.words();
        let length = self.length(&text)?;
        let before = self.before(position, &length)?;
        let left = self.difference(&length, before)?;
        let end = self.room(words)?;
        self.always("RIGHT", [text, end.clone(), left.clone()]);
        let count = self.limited(count, &left)?;
        let result = self.room(words)?;
        self.always("LEFT", [end, result.clone(), count]);
        Ok(result)
    }

    /// Number of characters before a position, which counts from 1.
    fn before(&mut self, position: Operand, length: &Operand) -> Made<Operand> {
        let one = self.decimal(1);
        let result = self.difference(&position, one)?;
        self.limited(result, length)
    }

    /// `CONCAT(text, text, …)`.
    fn joined(&mut self, args: &[Arg]) -> Made<Operand> {
        let mut length = 0;
        let mut joined: Option<Operand> = None;
        for arg in args {
            let Ty::Text(own) = self.ty(&arg.value)? else {
                return Err(Vec::new());
            };
            length += own;
            let text = self.text(&arg.value)?;
            joined = Some(match joined {
                None => text,
                Some(before) => {
                    let result = self.room(Ty::Text(length).words())?;
                    self.always("$+", [before, text, result.clone()]);
                    result
                }
            });
        }
        joined.ok_or_else(Vec::new)
    }

    /// The text before a position, another one in place of what follows, and the rest.
    fn replaced(&mut self, function: Function, args: &[Arg], ty: Ty) -> Made<Operand> {
        let (texts, numbers) = args.split_at(function.texts(args.len()));
        let whole = self.ty(&texts[0].value)?.words();
        let text = self.stored_text(&texts[0].value)?;
        let new = match texts.get(1) {
            Some(new) => Some(self.text(&new.value)?),
            None => None,
        };
        let mut values = Vec::new();
        for number in numbers {
            values.push(self.number(number)?);
        }
        let length = self.length(&text)?;
        let (before, removed) = match values.as_slice() {
            [count, position] => {
                let before = self.before(position.clone(), &length)?;
                let left = self.difference(&length, before.clone())?;
                (before, Some(self.limited(count.clone(), &left)?))
            }
            [position] => (self.limited(position.clone(), &length)?, None),
            _ => return Err(Vec::new()),
        };
        let mut left = self.difference(&length, before.clone())?;
        if let Some(removed) = removed {
            left = self.difference(&left, removed)?;
        }
        let mut head = self.room(whole)?;
        self.always("LEFT", [text.clone(), head.clone(), before]);
        if let Some(new) = new {
            let longer = self.room(ty.words())?;
            self.always("$+", [head, new, longer.clone()]);
            head = longer;
        }
        let end = self.room(whole)?;
        self.always("RIGHT", [text, end.clone(), left]);
        let result = self.room(ty.words())?;
        self.always("$+", [head, end, result.clone()]);
        Ok(result)
    }

    /// A number as a text of a fixed length: the sign, spaces, and the digits.
    fn number_to_text(
        &mut self,
        value: &Expr,
        (of, name, length): (Ty, &str, u16),
    ) -> Made<Operand> {
        let value = self.kept_operand(value, of)?;
        // A REAL has one digit before the point and five after it, and an exponent.
        let form: &[i64] = match of {
            Ty::Real => &[1, length as i64, 5],
            _ => &[length as i64, 0],
        };
        let first = self.temporary(form.len() as u32)?;
        for (at, part) in form.iter().enumerate() {
            let part = self.decimal(*part);
            let to = self.here(further(first, at as u32));
            self.always("MOV", [part, to]);
        }
        let form = self.here(OperandKind::Device(first, None));
        let result = self.room(Ty::Text(length).words())?;
        let operands = match of {
            Ty::Real => [value, form, result.clone()],
            _ => [form, value, result.clone()],
        };
        self.always(name, operands);
        Ok(result)
    }

    /// A text as a number. VAL takes texts that begin with a sign or a space alone.
    fn text_to_number(&mut self, text: &Expr, of: Ty, name: &str) -> Made<Operand> {
        let Ty::Text(length) = self.ty(text)? else {
            return Err(Vec::new());
        };
        let text = self.stored_text(text)?;
        let result = self.room(of.words())?;
        if of == Ty::Real {
            self.always(name, [text, result.clone()]);
            return Ok(result);
        }
        let first = self.room(1)?;
        let (low, minus) = (OperandKind::Hex(0xFF, None), OperandKind::Hex(0x2D, None));
        let (low, minus) = (self.here(low), self.here(minus));
        self.always("WAND", [text.clone(), low, first.clone()]);
        /// VAL looks at this many words.
        const LEAST: u32 = 7;
        let signed = self.room(Ty::Text(length.saturating_add(1)).words().max(LEAST))?;
        let negative = self.compared(Op::Eq, &first, &minus, Ty::Int)?;
        self.load(&negative);
        self.push("$MOV", [text.clone(), signed.clone()]);
        self.load(&negative.opposite());
        let space = self.here(OperandKind::Text(" ".into()));
        self.push("$+", [space, text, signed.clone()]);
        let form = self.room(2)?;
        self.always(name, [signed, form, result.clone()]);
        Ok(result)
    }

    /// Equality of texts: both have one length, and the first character that one is found from in the other is the
    /// first.
    pub(crate) fn compared_texts(&mut self, op: Op, left: &Expr, right: &Expr) -> Made<Cond> {
        self.need("INSTR", left.span.to(right.span))?;
        // One of them may be a literal.
        let is_literal = self.literal_text(right)?.is_some();
        let (one, other) = if is_literal {
            (right, left)
        } else {
            (left, right)
        };
        let (one, other) = both(self.text(one), self.stored_text(other))?;
        let of_one = match &one.kind {
            OperandKind::Text(text) => self.decimal(text.len() as i64),
            _ => self.length(&one)?,
        };
        let of_other = self.length(&other)?;
        let place = self.room(1)?;
        let (zero, first) = (self.decimal(0), self.decimal(1));
        self.always("INSTR", [one, other, place.clone(), first.clone()]);
        let equal = |a: &Operand, b: &Operand| Cond::Compare {
            op: Op::Eq,
            is_wide: false,
            operands: [a.clone(), b.clone()],
        };
        let found = Cond::Joined(
            Join::Or,
            Rc::new(equal(&place, &first)),
            Rc::new(equal(&of_other, &zero)),
        );
        let same = Cond::both(equal(&of_one, &of_other), found);
        Ok(if op == Op::Eq { same } else { same.opposite() })
    }
}

/// A device some places after another.
const fn further(first: Device, by: u32) -> OperandKind {
    let number = first.number + by;
    OperandKind::Device(Device { number, ..first }, None)
}

#[cfg(test)]
mod tests {
    use super::characters;

    #[test]
    fn characters_after_a_dollar_sign() {
        assert_eq!(characters("a$'b$$c").as_deref(), Some("a'b$c"));
        assert_eq!(characters("$R$l$41$E9").as_deref(), Some("\r\nA\u{E9}"));
        for wrong in ["$", "$4", "$G0", "$00", "中"] {
            assert_eq!(characters(wrong), None, "{wrong}");
        }
    }
}
