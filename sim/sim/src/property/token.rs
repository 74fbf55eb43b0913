//! The words of conditions.

use super::parse::error;
use super::{CalcOp, ParseError};
use crate::Target;
use rungc_rt::CmpOp;
use std::ops::RangeInclusive;

/// A word of a condition.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum Token {
    Open,
    Close,
    Comma,
    Not,
    And,
    Or,
    Compare(CmpOp),
    Calc(CalcOp),
    /// A device, a number, or words of the plant.
    Word(String),
    /// A name in quotes, which is never an operator, and what follows it: `.f32`.
    Quoted(String, String),
}

const OPERATORS: [(&str, Token); 21] = [
    ("&&", Token::And),
    ("||", Token::Or),
    ("==", Token::Compare(CmpOp::Eq)),
    ("!=", Token::Compare(CmpOp::Ne)),
    ("<>", Token::Compare(CmpOp::Ne)),
    ("<=", Token::Compare(CmpOp::Le)),
    (">=", Token::Compare(CmpOp::Ge)),
    ("=", Token::Compare(CmpOp::Eq)),
    ("<", Token::Compare(CmpOp::Lt)),
    (">", Token::Compare(CmpOp::Gt)),
    ("&", Token::And),
    ("|", Token::Or),
    ("!", Token::Not),
    ("(", Token::Open),
    (")", Token::Close),
    (",", Token::Comma),
    ("+", Token::Calc(CalcOp::Add)),
    ("-", Token::Calc(CalcOp::Sub)),
    ("*", Token::Calc(CalcOp::Mul)),
    ("/", Token::Calc(CalcOp::Div)),
    ("%", Token::Calc(CalcOp::Rem)),
];

/// Maximum number of words in a condition: evaluation follows its structure.
const MOST: usize = 2000;

/// The words of a condition with their places. `is_name` recognises words of the plant, which may contain signs of
/// arithmetic.
pub(super) fn tokens(
    text: &str,
    is_name: &dyn Fn(&str) -> bool,
) -> Result<Vec<(usize, Token)>, ParseError> {
    let mut found = Vec::new();
    let mut at = 0;
    while let Some(c) = text[at..].chars().next() {
        let rest = &text[at..];
        if found.len() == MOST {
            return Err(error(at, format!("a condition of more than {MOST} words")));
        }
        if c.is_whitespace() {
            at += c.len_utf8();
            continue;
        }
        if c == '"' {
            let Some(length) = rest[1..].find('"') else {
                return Err(error(at, "this quote is not closed"));
            };
            let view = &rest[length + 2..];
            let is_view = |c: char| c == '.' || c.is_ascii_alphanumeric();
            let end = view.find(|c| !is_view(c)).unwrap_or(view.len());
            let view = if view.starts_with('.') {
                &view[..end]
            } else {
                ""
            };
            found.push((
                at,
                Token::Quoted(rest[1..=length].to_string(), view.to_string()),
            ));
            at += length + 2 + view.len();
            continue;
        }
        let whole = whole_word(rest);
        let mut signs = OPERATORS.iter();
        let sign = signs.find(|(sign, _)| rest.starts_with(sign));
        if let Some((sign, token)) = sign.filter(|_| whole.is_empty() || !is_name(whole)) {
            found.push((at, token.clone()));
            at += sign.len();
            continue;
        }
        let word = word(whole, is_name);
        let token = match word.to_ascii_lowercase().as_str() {
            "and" => Token::And,
            "or" => Token::Or,
            "not" => Token::Not,
            _ => Token::Word(word.to_string()),
        };
        found.push((at, token));
        at += word.len();
    }
    Ok(found)
}

/// What stands until a blank or a sign that no name contains.
fn whole_word(rest: &str) -> &str {
    let is_end = |c: char| c.is_whitespace() || "&|!()=<>\"".contains(c);
    &rest[..rest.find(is_end).unwrap_or(rest.len())]
}

/// The word at the beginning of this, which is not empty: all of it, or until a sign of arithmetic or a comma.
fn word<'t>(whole: &'t str, is_name: &dyn Fn(&str) -> bool) -> &'t str {
    let is_sign = |c: char| "+-*/%,".contains(c);
    let ends = whole.match_indices(is_sign).map(|(at, _)| at);
    let is_whole = |text: &str| is_name(text) || Constant::parse(text).is_some();
    // `1e-5` and `K-5` are numbers, `Pump-1` may be a name.
    let longest = ends
        .chain([whole.len()])
        .rfind(|&end| is_whole(&whole[..end]));
    &whole[..longest.unwrap_or_else(|| whole.find(is_sign).unwrap_or(whole.len()))]
}

/// A constant: `100`, `K100`, `K-5`, `H0F`, `0x0F`, `1.5`, `2e-3`.
#[derive(Clone, Debug)]
pub(super) struct Constant {
    /// As it is written.
    pub text: String,
    /// Value of an integer.
    pub value: i64,
    /// Value of what has a decimal point or an exponent.
    pub float: Option<f32>,
    /// Written in hexadecimal: the bits of a value.
    pub is_hex: bool,
}

impl Constant {
    /// An integer in decimal.
    pub fn integer(value: i64) -> Self {
        Constant {
            text: value.to_string(),
            value,
            float: None,
            is_hex: false,
        }
    }

    /// A float.
    pub fn of_float(value: f32) -> Self {
        Constant {
            text: format!("{value:?}"),
            value: 0,
            float: Some(value),
            is_hex: false,
        }
    }

    /// Reads a constant; an error if it is too large for 32 bits.
    pub fn parse(word: &str) -> Option<Result<Constant, String>> {
        let upper = word.to_ascii_uppercase();
        let (digits, radix) = match upper.strip_prefix("0X").or_else(|| upper.strip_prefix('H')) {
            Some(digits) => (digits, 16),
            None => (upper.strip_prefix('K').unwrap_or(&upper), 10),
        };
        let plain = digits.strip_prefix('-').unwrap_or(digits);
        let does_not_fit = || format!("`{word}` does not fit in 32 bits");
        if plain.is_empty() || !plain.chars().all(|c| c.is_digit(radix)) {
            let value = Self::float_of(&upper)?;
            let fits = Target::is_float(value);
            return Some(match fits {
                true => Ok(Constant::of_float(value as f32)),
                false => Err(does_not_fit()),
            });
        }
        let value = i64::from_str_radix(digits, radix).ok();
        let value = value.filter(|value| WRITTEN.contains(value));
        let constant = |value| Constant {
            text: word.to_string(),
            value,
            float: None,
            is_hex: radix == 16,
        };
        Some(value.map(constant).ok_or_else(does_not_fit))
    }

    /// Value of `1.5` or `2E-3`.
    fn float_of(upper: &str) -> Option<f64> {
        let (number, exponent) = match upper.split_once('E') {
            Some((number, exponent)) => (number, Some(exponent)),
            None => (upper, None),
        };
        let is_digits = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
        let is_number = match number.split_once('.') {
            Some((whole, part)) => is_digits(whole) && is_digits(part),
            None => is_digits(number) && exponent.is_some(),
        };
        let is_exponent = |text: &str| is_digits(text.strip_prefix(['+', '-']).unwrap_or(text));
        (is_number && exponent.is_none_or(is_exponent)).then(|| upper.parse().ok())?
    }

    /// With the other sign.
    pub fn negated(&self) -> Self {
        match self.float {
            Some(value) => Constant::of_float(-value),
            None => Constant {
                text: format!("-{}", self.text),
                value: -self.value,
                ..self.clone()
            },
        }
    }

    /// As a float.
    pub fn as_float(&self) -> f32 {
        self.float.unwrap_or(self.value as f32)
    }

    /// Its value where no other number says what it can be.
    ///
    /// # Errors
    ///
    /// It does not fit.
    pub fn plain(&self) -> Result<i32, String> {
        i32::try_from(self.value).map_err(|_| format!("`{}` does not fit in 32 bits", self.text))
    }

    /// Its value beside a number that has these, signed or not: `HFFFF` has the bits of -1 beside a word, as in the
    /// PLC's `LD= D0 HFFFF`.
    ///
    /// # Errors
    ///
    /// The other number cannot have the value.
    pub fn beside(
        &self,
        number: &str,
        range: &RangeInclusive<i64>,
        is_equality: bool,
    ) -> Result<i32, String> {
        let (text, value) = (&self.text, self.value);
        let (first, last) = (*range.start(), *range.end());
        let is_word = last == 0xffff;
        let is_held = range.contains(&value);
        let last = if first < 0 { !first } else { last };
        if !is_held {
            return Err(format!(
                "`{number}` is never {text}: its values are {first} to {last}"
            ));
        }
        let signed = match is_word {
            true => i32::from(value as i16),
            false => value as i32,
        };
        if i64::from(signed) != value && !is_equality && !self.is_hex {
            return Err(format!(
                "`{number}` is signed, {first} to {last}: the bits of {text} are {signed} there, so write H{value:X} if that is meant"
            ));
        }
        Ok(signed)
    }
}

/// Integers that can be written.
pub(super) const WRITTEN: RangeInclusive<i64> = i32::MIN as i64..=u32::MAX as i64;
