//! Reading conditions: `Y000 & !(Y001 | "Guard open") & D0 + D1 > 100`.

use super::token::{Constant, Token, WRITTEN, tokens};
use super::{Calc, CalcOp, Condition, Number, NumberKind, access};
use crate::Target;
use rungc_host::duration;
use rungc_rt::{CmpOp, word};
use std::ops::RangeInclusive;

/// A mistake in a condition.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct ParseError {
    /// Offset in bytes.
    pub at: usize,
    /// Description, as a sentence without a full stop.
    pub why: String,
}

/// Devices that a word of the plant stands for.
type Names<'n> = &'n dyn Fn(&str) -> Vec<Target>;

/// Reads a condition. `names` gives the devices that words of the plant stand for.
///
/// # Errors
///
/// The first mistake.
pub fn parse(text: &str, names: Names) -> Result<Condition, ParseError> {
    let mut reader = Reader {
        tokens: tokens(text, &|word| !names(word).is_empty())?,
        next: 0,
        end: text.len(),
        names,
    };
    let value = reader.ordered()?;
    match reader.tokens.get(reader.next) {
        None => value.condition(),
        Some((at, Token::Close)) => Err(error(*at, "this `)` closes nothing")),
        Some((at, _)) => Err(error(
            *at,
            "expected `&`, `|`, a comparison or the end here",
        )),
    }
}

pub(super) fn error(at: usize, why: impl Into<String>) -> ParseError {
    let why = why.into();
    ParseError { at, why }
}

/// What stands in a place: a condition, or an operand of a comparison.
struct Value {
    at: usize,
    what: What,
    /// Place of a `for` at its end that no parentheses enclose.
    open_for: Option<usize>,
}

enum What {
    Condition(Condition),
    Number(Number),
    Constant(Constant),
}

impl Value {
    fn new(at: usize, what: What) -> Self {
        Value {
            at,
            what,
            open_for: None,
        }
    }

    /// As a condition.
    fn condition(self) -> Result<Condition, ParseError> {
        match self.what {
            What::Condition(condition) => Ok(condition),
            What::Constant(constant) => match constant.on() {
                Some(on) => Ok(Condition::Constant(on)),
                None => Err(error(self.at, ALONE)),
            },
            What::Number(_) => Err(error(self.at, ALONE)),
        }
    }

    /// As a condition that `&` or `|` joins to others.
    fn joined(self, sign: &str) -> Result<Box<Condition>, ParseError> {
        match self.open_for {
            None => self.condition().map(Box::new),
            Some(at) => Err(error(
                at,
                format!(
                    "put what lasts in parentheses: `(X000 {sign} X001) for 2s` or `X000 {sign} (X001 for 2s)`"
                ),
            )),
        }
    }

    /// Error for a condition that stands for a number.
    fn not_a_number(&self) -> ParseError {
        let why = match self.what {
            What::Condition(Condition::On(_)) => CONTACT,
            _ => "this is a condition, not a number",
        };
        error(self.at, why)
    }
}

impl Constant {
    /// As the state of a bit.
    fn on(&self) -> Option<bool> {
        let is_state = self.float.is_none() && matches!(self.value, 0 | 1);
        is_state.then_some(self.value == 1)
    }
}

struct Reader<'n> {
    tokens: Vec<(usize, Token)>,
    next: usize,
    end: usize,
    names: Names<'n>,
}

/// Maximum nesting of parentheses and inversions.
const DEPTH: usize = 100;

const CONTACT: &str =
    "this is a contact, which is on or off; the value of a timer or counter is `T0.value`";

const ALONE: &str = "compare a number with something: `D0 > 100`";

impl Reader<'_> {
    fn peek(&self) -> Option<&Token> {
        self.tokens.get(self.next).map(|(_, token)| token)
    }

    fn takes(&mut self, token: &Token) -> bool {
        let found = self.peek() == Some(token);
        self.next += usize::from(found);
        found
    }

    fn at(&self) -> usize {
        self.tokens.get(self.next).map_or(self.end, |(at, _)| *at)
    }

    /// Returns true if these words come next.
    fn is_next(&self, words: &[&str]) -> bool {
        let next = self.tokens[self.next..].iter();
        let mut pairs = words.iter().zip(next.map(|(_, token)| token));
        self.next + words.len() <= self.tokens.len()
            && pairs.all(
                |(word, token)| matches!(token, Token::Word(own) if own.eq_ignore_ascii_case(word)),
            )
    }

    /// Takes a word in the place of an operator.
    fn takes_word(&mut self, word: &str) -> bool {
        let found = self.is_next(&[word]);
        self.next += usize::from(found);
        found
    }

    /// The whole: one condition before another.
    fn ordered(&mut self) -> Result<Value, ParseError> {
        let left = self.either()?;
        let at = left.at;
        if !self.takes_word("before") {
            return Ok(left);
        }
        let (first, second) = (left.condition()?, self.either()?.condition()?);
        if self.is_next(&["before"]) {
            let why = "put one `before` in parentheses: `(X000 before X001) before X002`";
            return Err(error(self.at(), why));
        }
        let ordered = Condition::Before(Box::new(first), Box::new(second));
        Ok(Value::new(at, What::Condition(ordered)))
    }

    fn either(&mut self) -> Result<Value, ParseError> {
        let mut left = self.both()?;
        while self.takes(&Token::Or) {
            let (at, right) = (left.at, self.both()?);
            let either = Condition::Or(left.joined("|")?, right.joined("|")?);
            left = Value::new(at, What::Condition(either));
        }
        Ok(left)
    }

    fn both(&mut self) -> Result<Value, ParseError> {
        let mut left = self.lasting()?;
        while self.takes(&Token::And) {
            let (at, right) = (left.at, self.lasting()?);
            let both = Condition::And(left.joined("&")?, right.joined("&")?);
            left = Value::new(at, What::Condition(both));
        }
        Ok(left)
    }

    /// A condition, which may have to last.
    fn lasting(&mut self) -> Result<Value, ParseError> {
        let single = self.single()?;
        let at = self.at();
        if !self.takes_word("for") {
            return Ok(single);
        }
        let time_at = self.at();
        let Some(Token::Word(time)) = self.peek() else {
            return Err(error(time_at, "expected a time here: `for 2s`"));
        };
        let ms = duration::parse(time).map_err(|why| error(time_at, why))?;
        let ms = u32::try_from(ms).map_err(|_| error(time_at, "49 days is the longest time"))?;
        self.next += 1;
        let start = single.at;
        let lasts = Condition::For(Box::new(single.condition()?), ms);
        Ok(Value {
            at: start,
            what: What::Condition(lasts),
            open_for: Some(at),
        })
    }

    fn single(&mut self) -> Result<Value, ParseError> {
        let nested = self.tokens[..self.next].iter();
        let nested = nested.filter(|(_, token)| matches!(token, Token::Open | Token::Not));
        if nested.count() > DEPTH {
            let why = format!("more than {DEPTH} parentheses and inversions");
            return Err(error(self.at(), why));
        }
        let at = self.at();
        if self.takes(&Token::Not) {
            let inner = self.single()?.condition()?;
            return Ok(Value::new(
                at,
                What::Condition(Condition::Not(Box::new(inner))),
            ));
        }
        self.compared()
    }

    /// An operand, or a comparison.
    fn compared(&mut self) -> Result<Value, ParseError> {
        let left = self.sum()?;
        let Some(&Token::Compare(op)) = self.peek() else {
            return Ok(left);
        };
        self.next += 1;
        let right = self.sum()?;
        let at = left.at;
        Ok(Value::new(
            at,
            What::Condition(comparison(op, left, right)?),
        ))
    }

    fn sum(&mut self) -> Result<Value, ParseError> {
        let mut left = self.product()?;
        while let Some(&Token::Calc(op @ (CalcOp::Add | CalcOp::Sub))) = self.peek() {
            self.next += 1;
            left = calculation(op, left, self.product()?)?;
        }
        Ok(left)
    }

    fn product(&mut self) -> Result<Value, ParseError> {
        let mut left = self.factor()?;
        while let Some(&Token::Calc(op @ (CalcOp::Mul | CalcOp::Div | CalcOp::Rem))) = self.peek() {
            self.next += 1;
            left = calculation(op, left, self.factor()?)?;
        }
        Ok(left)
    }

    fn factor(&mut self) -> Result<Value, ParseError> {
        let at = self.at();
        let mut is_negative = false;
        while self.takes(&Token::Calc(CalcOp::Sub)) {
            is_negative = !is_negative;
        }
        let value = self.operand()?;
        match value.what {
            _ if !is_negative => Ok(value),
            What::Constant(constant) => Ok(Value::new(at, What::Constant(constant.negated()))),
            _ => {
                let zero = Value::new(at, What::Constant(Constant::integer(0)));
                calculation(CalcOp::Sub, zero, value)
            }
        }
    }

    fn operand(&mut self) -> Result<Value, ParseError> {
        let at = self.at();
        if self.takes(&Token::Open) {
            let inner = self.ordered()?;
            self.close(at)?;
            return Ok(Value::new(inner.at, inner.what));
        }
        if let Some(value) = self.function()? {
            return Ok(value);
        }
        let what = match self.peek() {
            Some(Token::Word(word)) => match Constant::parse(word) {
                Some(_) if self.is_name_too(word) => Err(format!(
                    "`{word}` is a number, and the name of a device: write `\"{word}\"` for the device, or the number \
                     without a letter"
                )),
                Some(constant) => Ok(What::Constant(constant.map_err(|why| error(at, why))?)),
                None => self.device(word),
            },
            Some(Token::Quoted(name, view)) => self.named(name, view),
            _ => Err("expected a device, a name or a number here".to_string()),
        };
        let what = what.map_err(|why| error(at, why))?;
        self.next += 1;
        Ok(Value::new(at, what))
    }

    /// Returns true for a constant such as `K1` that is the name of a device, too, as of many a contactor.
    fn is_name_too(&self, word: &str) -> bool {
        word.starts_with(|c: char| c.is_ascii_alphabetic()) && !(self.names)(word).is_empty()
    }

    /// The end of what was opened there.
    fn close(&mut self, open: usize) -> Result<(), ParseError> {
        match self.takes(&Token::Close) {
            true => Ok(()),
            false => Err(error(open, "this `(` is not closed")),
        }
    }

    /// `was(…)`, `exactly one of (…)` and similar ones.
    fn function(&mut self) -> Result<Option<Value>, ParseError> {
        let at = self.at();
        let opens = |words: usize| {
            let token = self.tokens.get(self.next + words);
            token.is_some_and(|(_, token)| *token == Token::Open)
        };
        if let Some(count) = self.count() {
            return self.counted(at, count).map(Some);
        }
        let Some(Token::Word(word)) = self.peek().filter(|_| opens(1)) else {
            return Ok(None);
        };
        let function = word.to_ascii_lowercase();
        let make: fn(Box<Condition>) -> Condition = match function.as_str() {
            "was" => Condition::Was,
            "rises" => Condition::Rises,
            "falls" => Condition::Falls,
            _ => return Ok(None),
        };
        self.next += 1;
        let open = self.at();
        self.next += 1;
        let inner = self.ordered()?;
        self.close(open)?;
        let what = match inner.what {
            What::Number(number) if function == "was" => {
                What::Number(Number::Was(Box::new(number)))
            }
            _ => What::Condition(make(Box::new(inner.condition()?))),
        };
        Ok(Some(Value::new(at, what)))
    }

    /// `exactly one of (`, `at most 2 of (`, `at least 2 of (`, which come next: the limits, and the number of words.
    fn count(&self) -> Option<(RangeInclusive<u32>, usize)> {
        const ALL: u32 = u32::MAX;
        let kinds: [&[&str]; 3] = [&["exactly"], &["at", "most"], &["at", "least"]];
        let kind = kinds.into_iter().find(|words| self.is_next(words))?;
        let word = |offset: usize| match self.tokens.get(self.next + kind.len() + offset) {
            Some((_, Token::Word(word))) => Some(word.to_ascii_lowercase()),
            _ => None,
        };
        let number = match word(0)?.as_str() {
            "one" => 1,
            number => number.parse().ok()?,
        };
        (word(1)? == "of").then_some(())?;
        let limits = match kind {
            ["exactly"] => number..=number,
            [_, "most"] => 0..=number,
            _ => number..=ALL,
        };
        Some((limits, kind.len() + 2))
    }

    fn counted(
        &mut self,
        at: usize,
        (limits, words): (RangeInclusive<u32>, usize),
    ) -> Result<Value, ParseError> {
        self.next += words;
        let open = self.at();
        if !self.takes(&Token::Open) {
            return Err(error(open, "expected a list here: `(Y000, Y001)`"));
        }
        let mut of = Vec::new();
        while of.is_empty() || self.takes(&Token::Comma) {
            of.push(self.ordered()?.condition()?);
        }
        self.close(open)?;
        let all = of.len() as u32;
        let (least, most) = (*limits.start(), (*limits.end()).min(all));
        if least > all {
            return Err(error(at, format!("there are {all}, never {least}")));
        }
        let count = Condition::Count { least, most, of };
        Ok(Value::new(at, What::Condition(count)))
    }

    /// A device, or a comment of one word.
    fn device(&self, word: &str) -> Result<What, String> {
        let upper = word.to_uppercase();
        let written = match word.split_once('.') {
            Some((device, view)) => format!("{}.{view}", device.to_uppercase()),
            None => upper,
        };
        if let Some(found) = target(&written) {
            return found.map_err(|_| neither(word));
        }
        if let Some(device) = self.single_device(word)? {
            return shown(device, "", word);
        }
        if let Some((name, view)) = word.rsplit_once('.')
            && let Some(device) = self.single_device(name)?
        {
            return shown(device, &format!(".{view}"), word);
        }
        Err(format!(
            "`{word}` is neither a device nor the comment of one; write a name with blanks in quotes"
        ))
    }

    /// A comment in quotes, and what follows it.
    fn named(&self, name: &str, view: &str) -> Result<What, String> {
        match self.single_device(name)? {
            Some(device) => shown(device, view, &format!("\"{name}\"{view}")),
            // A view may stand in the quotes, too.
            None => match name.rsplit_once('.').filter(|_| view.is_empty()) {
                Some((name, view)) if !(self.names)(name).is_empty() => {
                    self.named(name, &format!(".{view}"))
                }
                _ => Err(format!("no device has the comment `{name}`")),
            },
        }
    }

    /// The device that a name stands for.
    fn single_device(&self, name: &str) -> Result<Option<Target>, String> {
        match (self.names)(name)[..] {
            [] => Ok(None),
            [target] => Ok(Some(target)),
            [first, second, ..] => Err(format!(
                "`{name}` is the comment of several devices, such as {} and {}",
                plain(first),
                plain(second)
            )),
        }
    }
}

/// A device without a view.
fn plain(target: Target) -> String {
    let (class, number, _) = target.devices(0);
    class.number(number).to_string()
}

fn neither(word: &str) -> String {
    format!("`{word}` is neither a bit nor a number")
}

/// A device that a name stands for, in a view: `.f32`, or nothing.
fn shown(device: Target, view: &str, word: &str) -> Result<What, String> {
    let found = match view {
        "" => target(&device.to_string()),
        view => target(&format!("{}{view}", plain(device))),
    };
    match found {
        Some(Ok(what)) => Ok(what),
        Some(Err(why)) => Err(why),
        None => Err(neither(word)),
    }
}

/// Reads a device; `None` if it is none.
fn target(written: &str) -> Option<Result<What, String>> {
    if let Some((word, bit)) = written.split_once('.')
        && let (Ok(word @ Target::Word(..)), 1) = (Target::parse(word), bit.len())
        && let Ok(bit) = u8::from_str_radix(bit, 16)
    {
        return Some(Ok(What::Condition(Condition::WordBit(word, bit))));
    }
    let target = Target::parse(written).ok()?;
    Some(match target {
        Target::Bit(..) => Ok(What::Condition(Condition::On(target))),
        _ if access(target).is_some() => Ok(What::Number(Number::Of(target))),
        _ => Err(neither(written)),
    })
}

fn comparison(op: CmpOp, left: Value, right: Value) -> Result<Condition, ParseError> {
    let is_equality = matches!(op, CmpOp::Eq | CmpOp::Ne);
    let or_inverse = |condition: Condition, on: bool| match (op == CmpOp::Eq) == on {
        true => condition,
        false => Condition::Not(Box::new(condition)),
    };
    // `Y000 = 1` is a way to say that a bit is on, `Y000 = Y001` that two are alike.
    match (&left.what, &right.what) {
        (What::Condition(a), What::Condition(b)) if is_equality => {
            let same = Condition::Same(Box::new(a.clone()), Box::new(b.clone()));
            return Ok(or_inverse(same, true));
        }
        (What::Condition(a), What::Constant(constant))
        | (What::Constant(constant), What::Condition(a))
            if is_equality && constant.on().is_some() =>
        {
            return Ok(or_inverse(a.clone(), constant.on() == Some(true)));
        }
        _ => {}
    }
    let purpose = match is_equality {
        true => Purpose::Equality,
        false => Purpose::Order,
    };
    let (_, a, b) = operands(left, right, purpose)?;
    Ok(Condition::Compare(op, a, b))
}

fn calculation(op: CalcOp, left: Value, right: Value) -> Result<Value, ParseError> {
    let (at, right_at) = (left.at, right.at);
    if let (What::Constant(a), What::Constant(b)) = (&left.what, &right.what) {
        let folded = folded(op, a, b).map_err(|why| error(right_at, why))?;
        return Ok(Value::new(at, What::Constant(folded)));
    }
    let (kind, a, b) = operands(left, right, Purpose::Calc(op))?;
    let kind = match (op, kind) {
        (CalcOp::Rem, NumberKind::Float) => {
            return Err(error(right_at, "`%` is the remainder of integers"));
        }
        (CalcOp::Mul, NumberKind::Word) => NumberKind::Double,
        (_, kind) => kind,
    };
    let calc = Calc { op, kind, a, b };
    Ok(Value::new(at, What::Number(Number::Calc(Box::new(calc)))))
}

/// What two numbers are for.
#[derive(Clone, Copy, PartialEq)]
enum Purpose {
    /// `=` or `!=`
    Equality,
    /// Another comparison.
    Order,
    /// A calculation.
    Calc(CalcOp),
}

/// Two numbers of one kind, and which: constants are as the other number needs them.
fn operands(
    left: Value,
    right: Value,
    purpose: Purpose,
) -> Result<(NumberKind, Number, Number), ParseError> {
    for value in [&left, &right] {
        if let What::Condition(_) = value.what {
            return Err(value.not_a_number());
        }
    }
    let kinds = [left.kind(), right.kind()];
    let kind = match kinds {
        kinds if kinds.contains(&NumberKind::Float) => NumberKind::Float,
        kinds if kinds.contains(&NumberKind::Double) => NumberKind::Double,
        [NumberKind::Constant, NumberKind::Constant] => NumberKind::Double,
        _ => NumberKind::Word,
    };
    let a = left.number(&right, kind, purpose)?;
    let b = right.number(&left, kind, purpose)?;
    Ok((kind, a, b))
}

impl Value {
    fn kind(&self) -> NumberKind {
        match &self.what {
            What::Number(number) => number.kind(),
            What::Constant(constant) if constant.float.is_some() => NumberKind::Float,
            What::Constant(_) | What::Condition(_) => NumberKind::Constant,
        }
    }

    /// The number in an operation of a kind with another.
    fn number(
        &self,
        other: &Value,
        kind: NumberKind,
        purpose: Purpose,
    ) -> Result<Number, ParseError> {
        let wrong = |why: String| error(self.at, why);
        match (&self.what, kind) {
            (What::Constant(constant), NumberKind::Float) => match constant.is_hex {
                true => Err(wrong("write a float as `1.5`".to_string())),
                false => Ok(Number::Float(constant.as_float())),
            },
            (What::Constant(constant), _) => {
                let value = match &other.what {
                    What::Number(number) => constant_beside(constant, number, purpose),
                    _ => constant.plain(),
                };
                value.map(Number::Constant).map_err(wrong)
            }
            (What::Number(number), NumberKind::Float) if number.kind() != kind => {
                Err(wrong(format!(
                    "`{number}` is an integer, compared or calculated with a float; a float is `D0.f32`"
                )))
            }
            (What::Number(number), _) => Ok(number.clone()),
            (What::Condition(_), _) => Err(self.not_a_number()),
        }
    }
}

/// A constant beside an integer.
fn constant_beside(constant: &Constant, number: &Number, purpose: Purpose) -> Result<i32, String> {
    let name = number.to_string();
    let of_kind = match number.kind() {
        NumberKind::Word => -0x8000..=0xffff,
        _ => -0x8000_0000..=0xffff_ffff,
    };
    match purpose {
        // A product has 32 bits.
        Purpose::Calc(CalcOp::Mul) if !of_kind.contains(&constant.value) => constant.plain(),
        Purpose::Calc(CalcOp::Mul) if !constant.is_hex => constant.plain(),
        Purpose::Calc(_) => constant.beside(&name, &of_kind, false),
        _ => {
            let range = values(number).unwrap_or(of_kind);
            constant.beside(&name, &range, purpose == Purpose::Equality)
        }
    }
}

/// The integers that a device can have, signed or unsigned.
fn values(number: &Number) -> Option<RangeInclusive<i64>> {
    match number {
        Number::Of(target) => target.integers(),
        Number::Was(of) => values(of),
        Number::Constant(_) | Number::Float(_) | Number::Calc(_) => None,
    }
}

/// The result of an operation on constants.
fn folded(op: CalcOp, a: &Constant, b: &Constant) -> Result<Constant, String> {
    let too_large = || "the result does not fit in 32 bits".to_string();
    if a.float.is_some() || b.float.is_some() {
        let (a, b) = (a.as_float(), b.as_float());
        let result = match op {
            CalcOp::Add => word::float_add(a, b),
            CalcOp::Sub => word::float_sub(a, b),
            CalcOp::Mul => word::float_mul(a, b),
            CalcOp::Div => word::float_div(a, b),
            CalcOp::Rem => return Err("`%` is the remainder of integers".to_string()),
        };
        return match result.is_finite() {
            true => Ok(Constant::of_float(result)),
            false => Err(too_large()),
        };
    }
    let (a, b) = (a.value, b.value);
    let result = match op {
        CalcOp::Add => Some(a + b),
        CalcOp::Sub => Some(a - b),
        CalcOp::Mul => a.checked_mul(b),
        CalcOp::Div | CalcOp::Rem if b == 0 => return Err("this divides by 0".to_string()),
        CalcOp::Div => Some(a / b),
        CalcOp::Rem => Some(a % b),
    };
    let result = result.filter(|result| WRITTEN.contains(result));
    result.map(Constant::integer).ok_or_else(too_large)
}
