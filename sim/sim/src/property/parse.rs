//! Reading conditions: `Y000 & !(Y001 | "Guard open") & D0 > 100`.

use super::{Condition, Number, access};
use crate::Target;
use rungc_rt::CmpOp;

/// A mistake in a condition.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct ParseError {
    /// Offset in bytes.
    pub at: usize,
    /// Description, as a sentence without a full stop.
    pub why: String,
}

/// A word of a condition.
#[derive(Clone, PartialEq, Debug)]
enum Token {
    Open,
    Close,
    Not,
    And,
    Or,
    Compare(CmpOp),
    /// A device, a number, or words of the plant.
    Word(String),
    /// The same in quotes, which is never an operator.
    Quoted(String),
}

/// Reads a condition. `names` gives the devices that words of the plant stand for.
///
/// # Errors
///
/// The first mistake.
pub fn parse(text: &str, names: &dyn Fn(&str) -> Vec<Target>) -> Result<Condition, ParseError> {
    let mut reader = Reader {
        tokens: tokens(text)?,
        next: 0,
        end: text.len(),
        names,
    };
    let condition = reader.either()?;
    match reader.tokens.get(reader.next) {
        None => Ok(condition),
        Some((at, Token::Close)) => Err(error(*at, "this `)` closes nothing")),
        Some((at, _)) => Err(error(
            *at,
            "expected `&`, `|`, a comparison or the end here",
        )),
    }
}

fn error(at: usize, why: impl Into<String>) -> ParseError {
    let why = why.into();
    ParseError { at, why }
}

/// The words of a condition with their places.
fn tokens(text: &str) -> Result<Vec<(usize, Token)>, ParseError> {
    const OPERATORS: [(&str, Token); 15] = [
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
    ];
    let mut found = Vec::new();
    let mut at = 0;
    while let Some(c) = text[at..].chars().next() {
        let rest = &text[at..];
        if c.is_whitespace() {
            at += c.len_utf8();
        } else if let Some((sign, token)) =
            OPERATORS.iter().find(|(sign, _)| rest.starts_with(sign))
        {
            found.push((at, token.clone()));
            at += sign.len();
        } else if c == '"' {
            let Some(length) = rest[1..].find('"') else {
                return Err(error(at, "this quote is not closed"));
            };
            found.push((at, Token::Quoted(rest[1..=length].to_string())));
            at += length + 2;
        } else {
            let is_end = |c: char| c.is_whitespace() || "&|!()=<>\"".contains(c);
            let length = rest.find(is_end).unwrap_or(rest.len());
            let word = &rest[..length];
            found.push((
                at,
                match word.to_ascii_lowercase().as_str() {
                    "and" => Token::And,
                    "or" => Token::Or,
                    "not" => Token::Not,
                    _ => Token::Word(word.to_string()),
                },
            ));
            at += length;
        }
    }
    Ok(found)
}

struct Reader<'n> {
    tokens: Vec<(usize, Token)>,
    next: usize,
    end: usize,
    names: &'n dyn Fn(&str) -> Vec<Target>,
}

/// Maximum nesting of parentheses and inversions.
const DEPTH: usize = 200;

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

    fn either(&mut self) -> Result<Condition, ParseError> {
        let mut left = self.both()?;
        while self.takes(&Token::Or) {
            left = Condition::Or(Box::new(left), Box::new(self.both()?));
        }
        Ok(left)
    }

    fn both(&mut self) -> Result<Condition, ParseError> {
        let mut left = self.single()?;
        while self.takes(&Token::And) {
            left = Condition::And(Box::new(left), Box::new(self.single()?));
        }
        Ok(left)
    }

    fn single(&mut self) -> Result<Condition, ParseError> {
        let nested = self.tokens[..self.next].iter();
        let nested = nested.filter(|(_, token)| matches!(token, Token::Open | Token::Not));
        if nested.count() > DEPTH {
            return Err(error(self.at(), "more than 200 parentheses and inversions"));
        }
        if self.takes(&Token::Not) {
            return Ok(Condition::Not(Box::new(self.single()?)));
        }
        let open = self.at();
        if self.takes(&Token::Open) {
            let inner = self.either()?;
            return match self.takes(&Token::Close) {
                true => Ok(inner),
                false => Err(error(open, "this `(` is not closed")),
            };
        }
        self.term()
    }

    /// A bit, or a comparison.
    fn term(&mut self) -> Result<Condition, ParseError> {
        let (at, left) = self.operand()?;
        let Some(&Token::Compare(op)) = self.peek() else {
            return match left {
                Operand::On(target) => Ok(Condition::On(target)),
                Operand::Constant(constant) if matches!(constant.value, 0 | 1) => {
                    Ok(Condition::Constant(constant.value == 1))
                }
                _ => Err(error(at, "compare a number with something: `D0 > 100`")),
            };
        };
        self.next += 1;
        let (right_at, right) = self.operand()?;
        let is_equality = matches!(op, CmpOp::Eq | CmpOp::Ne);
        let or_inverse = |condition: Condition, on: bool| match (op == CmpOp::Eq) == on {
            true => condition,
            false => Condition::Not(Box::new(condition)),
        };
        match (left, right) {
            // `Y000 = 1` is a way to say that a bit is on, `Y000 = Y001` that two are alike.
            (Operand::On(bit), Operand::Constant(Constant { value, .. }))
            | (Operand::Constant(Constant { value, .. }), Operand::On(bit))
                if is_equality && matches!(value, 0 | 1) =>
            {
                Ok(or_inverse(Condition::On(bit), value == 1))
            }
            (Operand::On(a), Operand::On(b)) if is_equality => {
                let [a, b] = [a, b].map(|bit| Box::new(Condition::On(bit)));
                Ok(or_inverse(Condition::Same(a, b), true))
            }
            (Operand::On(_), _) => Err(error(at, CONTACT)),
            (_, Operand::On(_)) => Err(error(right_at, CONTACT)),
            (left, right) => {
                let number = |at, operand: &Operand, other: &Operand| match *operand {
                    Operand::Of(target) | Operand::On(target) => Ok(Number::Of(target)),
                    Operand::Constant(ref constant) => constant
                        .beside(other, is_equality)
                        .map(Number::Constant)
                        .map_err(|why| error(at, why)),
                };
                let (a, b) = (number(at, &left, &right)?, number(right_at, &right, &left)?);
                Ok(Condition::Compare(op, a, b))
            }
        }
    }

    fn operand(&mut self) -> Result<(usize, Operand), ParseError> {
        let at = self.at();
        let (word, quoted) = match self.peek() {
            Some(Token::Word(word)) => (word.clone(), false),
            Some(Token::Quoted(word)) => (word.clone(), true),
            _ => return Err(error(at, "expected a device, a name or a number here")),
        };
        self.next += 1;
        if !quoted && let Some(constant) = Constant::parse(&word) {
            let does_not_fit = || error(at, format!("`{word}` does not fit in 32 bits"));
            return Ok((at, Operand::Constant(constant.ok_or_else(does_not_fit)?)));
        }
        let target = self.target(&word, quoted).map_err(|why| error(at, why))?;
        Ok((
            at,
            match target {
                Target::Bit(..) => Operand::On(target),
                _ => Operand::Of(target),
            },
        ))
    }

    /// Target of a name.
    fn target(&self, word: &str, quoted: bool) -> Result<Target, String> {
        let upper = word.to_uppercase();
        let written = match word.split_once('.') {
            Some((device, view)) => format!("{}.{view}", device.to_uppercase()),
            None => upper,
        };
        let named = (self.names)(word);
        let device = Target::parse(&written).ok().filter(|_| !quoted);
        match (device, &named[..]) {
            (Some(target), _) if access(target).is_some() => Ok(target),
            (Some(_), _) => Err(format!("`{word}` is neither a bit nor an integer")),
            (None, [target]) => Ok(*target),
            (None, []) => Err(format!(
                "`{word}` is neither a device nor the comment of one; write a name with blanks in quotes"
            )),
            (None, [first, second, ..]) => Err(format!(
                "`{word}` is the comment of several devices, such as {} and {}",
                shown(*first),
                shown(*second)
            )),
        }
    }
}

const CONTACT: &str =
    "this is a contact, which is on or off; the value of a timer or counter is `T0.value`";

/// A device as it is written.
fn shown(target: Target) -> String {
    let (class, number, _) = target.devices(0);
    class.number(number).to_string()
}

/// Operand of a comparison, or a single condition.
enum Operand {
    On(Target),
    Of(Target),
    Constant(Constant),
}

/// A constant: `100`, `-5`, `K100`, `H0F`, `0x0F`.
struct Constant {
    /// As it is written.
    text: String,
    /// From -2147483648 to 4294967295.
    value: i64,
    /// Written in hexadecimal: the bits of a value.
    is_hex: bool,
}

impl Constant {
    /// Reads a constant; `Some(None)` if it is too large for 32 bits.
    fn parse(word: &str) -> Option<Option<Constant>> {
        let upper = word.to_ascii_uppercase();
        let (digits, radix) = match upper.strip_prefix("0X").or_else(|| upper.strip_prefix('H')) {
            Some(digits) => (digits, 16),
            None => (upper.strip_prefix('K').unwrap_or(&upper), 10),
        };
        let plain = digits.strip_prefix('-').unwrap_or(digits);
        if plain.is_empty() || !plain.chars().all(|c| c.is_digit(radix)) {
            return None;
        }
        let value = i64::from_str_radix(digits, radix).ok();
        let fits = |value: &i64| (i64::from(i32::MIN)..=i64::from(u32::MAX)).contains(value);
        Some(value.filter(fits).map(|value| Constant {
            text: word.to_string(),
            value,
            is_hex: radix == 16,
        }))
    }

    /// Its value in a comparison with this: `HFFFF` has the bits of -1 beside a word, as in the PLC's `LD= D0 HFFFF`.
    ///
    /// # Errors
    ///
    /// The other operand cannot have the value.
    fn beside(&self, other: &Operand, is_equality: bool) -> Result<i32, String> {
        let (text, value) = (&self.text, self.value);
        let range = match *other {
            Operand::Of(target) => target.integers().map(|range| (target, range)),
            _ => None,
        };
        let Some((target, range)) = range else {
            return i32::try_from(value).map_err(|_| format!("`{text}` does not fit in 32 bits"));
        };
        let (first, last) = (*range.start(), *range.end());
        let is_word = last == 0xffff;
        let is_held = range.contains(&value);
        let last = if first < 0 { !first } else { last };
        if !is_held {
            return Err(format!(
                "`{target}` is never {text}: its values are {first} to {last}"
            ));
        }
        let signed = match is_word {
            true => i32::from(value as i16),
            false => value as i32,
        };
        if i64::from(signed) != value && !is_equality && !self.is_hex {
            return Err(format!(
                "`{target}` is signed, {first} to {last}: the bits of {text} are {signed} there, so write H{value:X} if that is meant"
            ));
        }
        Ok(signed)
    }
}

#[cfg(test)]
mod tests {
    use super::{Condition, parse};
    use crate::Target;
    use rungc_syntax::DeviceClass;

    fn read(text: &str) -> Result<Condition, String> {
        let names = |name: &str| match name {
            "Guard open" | "guard" => vec![Target::Bit(DeviceClass::X, 3)],
            "Motor" => vec![
                Target::Bit(DeviceClass::Y, 0),
                Target::Bit(DeviceClass::Y, 1),
            ],
            _ => Vec::new(),
        };
        parse(text, &names).map_err(|mistake| format!("{}: {}", mistake.at, mistake.why))
    }

    #[test]
    fn operators_bind_as_in_logic() {
        let is = |a, b| assert_eq!(read(a), read(b), "{a}");
        is("X0 | X1 & X2", "X0 | (X1 & X2)");
        is("!X0 & X1", "(not x0) AND x1");
        is("Y000 = 1 & Y1 == 0", "Y0 & !Y1");
        is("D0 >= K100", "D0>=100");
        is("\"Guard open\" & guard", "X3 & X003");
        is("1 = Y0 & Y0 != Y1", "Y0 & !(Y0 = Y1)");
        assert!(read("T0 & T0.value > 5 & C200.value < -3 & K1X0 = H0F").is_ok());
    }

    #[test]
    fn constants_are_bits_of_signed_values() {
        let is = |a, b| assert_eq!(read(a), read(b), "{a}");
        is("D0 = HFFFF", "D0 = -1");
        is("D0 != 65535", "D0 <> -1");
        is("D0 > H8000", "D0 > -32768");
        is("K4Y000 = 0x9C40", "K4Y000 = -25536");
        is("D0.i32 = HFFFFFFFF", "D0.i32 = -1");
        is("D0.i32 > HFFFF", "D0.i32 > 65535");
        is("K5X0 < HFFFFF", "K5X0 < 1048575");
        is("C200.value = 4294967295", "C200.value = -1");
    }

    #[test]
    fn mistakes_have_a_place() {
        let why = |text| read(text).unwrap_err();
        insta::assert_snapshot!(why("Y000 & "), @"7: expected a device, a name or a number here");
        insta::assert_snapshot!(why("(Y000 & X1"), @"0: this `(` is not closed");
        insta::assert_snapshot!(why("Y000) & X1"), @"4: this `)` closes nothing");
        insta::assert_snapshot!(why("Y000 X1"), @"5: expected `&`, `|`, a comparison or the end here");
        insta::assert_snapshot!(why("D0"), @"0: compare a number with something: `D0 > 100`");
        insta::assert_snapshot!(why("Y000 > 3"), @"0: this is a contact, which is on or off; the value of a timer or counter is `T0.value`");
        insta::assert_snapshot!(why("D0 > 40000"), @"5: `D0` is signed, -32768 to 32767: the bits of 40000 are -25536 there, so write H9C40 if that is meant");
        insta::assert_snapshot!(why("K4Y000 < 65536"), @"9: `K4Y000` is never 65536: its values are -32768 to 32767");
        insta::assert_snapshot!(why("16 = K1X0"), @"0: `K1X000` is never 16: its values are 0 to 15");
        insta::assert_snapshot!(why("D0.i32 >= 2147483648"), @"10: `D0.i32` is signed, -2147483648 to 2147483647: the bits of 2147483648 are -2147483648 there, so write H80000000 if that is meant");
        insta::assert_snapshot!(why("Y0 < Y1"), @"0: this is a contact, which is on or off; the value of a timer or counter is `T0.value`");
        insta::assert_snapshot!(why("D0 > 99999999999"), @"5: `99999999999` does not fit in 32 bits");
        insta::assert_snapshot!(why("Pump & X0"), @"0: `Pump` is neither a device nor the comment of one; write a name with blanks in quotes");
        insta::assert_snapshot!(why("Motor"), @"0: `Motor` is the comment of several devices, such as Y000 and Y001");
        insta::assert_snapshot!(why("\"Guard"), @"0: this quote is not closed");
        insta::assert_snapshot!(why("D0.f32 > 1"), @"0: `D0.f32` is neither a bit nor an integer");
    }
}
