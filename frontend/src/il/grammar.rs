//! The grammar of one line. It reads half-width text; places are byte offsets within the line.
//!
//! Each rule is a separate function (`custom`), which is compiled once. A rule that contained the combinators of all
//! rules below it would be compiled anew at each place it is used from.

mod fields;

pub(super) use fields::{device_field, mnemonic_field, operand_field, text_field};

use super::fault::{Fault, Faults, Kind, mistyped_digit};
use chumsky::error::EmptyErr;
use chumsky::input::{InputRef, MapExtra};
use chumsky::prelude::*;
use rungc_syntax::{Device, DeviceClass, Index, Operand, OperandKind, Operands, Span};
use smol_str::{SmolStr, ToSmolStr};
use std::borrow::Cow;

/// No line fails, so expected continuations are never needed: the error type is empty, which makes alternatives cheap.
/// What is wrong with a line goes into the state.
type Extra = extra::Full<EmptyErr, Faults, ()>;

/// The content of one line.
#[derive(Debug)]
pub(super) struct Line<'s> {
    /// Step number in front.
    pub step: Option<u32>,
    /// Label, which may be followed by an instruction.
    pub label: Option<(Device, Span)>,
    /// The instruction.
    pub instr: Option<Body<'s>>,
    /// Where the comment's text starts, after `;` or `//`.
    pub comment: Option<u32>,
}

/// Mnemonic and operands.
#[derive(Debug)]
pub(super) struct Body<'s> {
    /// In upper case, operator joined.
    pub mnemonic: Cow<'s, str>,
    /// Where it is.
    pub mnemonic_span: Span,
    /// The operands.
    pub operands: Operands,
}

/// Says what is wrong with what a parser has read.
fn report<'s>(e: &mut MapExtra<'s, '_, &'s str, Extra>, kind: Kind) {
    let fault = Fault::new(e.span(), kind);
    e.state().push(fault);
}

fn span(span: SimpleSpan) -> Span {
    Span::new(span.start as u32, span.end as u32)
}

fn is_space(c: &char) -> bool {
    c.is_whitespace() || *c == ',' || *c == '\0'
}

/// Skips characters of a kind, as many as there are. As `any().filter(of_kind).repeated()`, but without backtracking
/// after the last.
fn skip<'s>(of_kind: impl Fn(&char) -> bool + Copy) -> impl Parser<'s, &'s str, (), Extra> + Copy {
    custom(move |input| {
        while input.peek().is_some_and(|c| of_kind(&c)) {
            input.skip();
        }
        Ok(())
    })
}

/// Succeeds where such a character is next, or none, taking nothing.
fn at<'s>(
    wanted: impl Fn(Option<char>) -> bool + Copy,
) -> impl Parser<'s, &'s str, (), Extra> + Copy {
    custom(
        move |input: &mut InputRef<'s, '_, &'s str, Extra>| match wanted(input.peek()) {
            true => Ok(()),
            false => Err(EmptyErr::default()),
        },
    )
}

fn space<'s>() -> impl Parser<'s, &'s str, (), Extra> + Copy {
    skip(is_space)
}

/// Succeeds where a word may end, taking nothing.
fn boundary<'s>() -> impl Parser<'s, &'s str, (), Extra> + Copy {
    custom(|input| {
        input.parse(choice((
            at(|next| next.is_none_or(|c| is_space(&c) || c == ';')),
            just("//").ignored().rewind(),
        )))
    })
}

fn digits<'s>() -> impl Parser<'s, &'s str, &'s str, Extra> + Copy {
    custom(|input| {
        input.parse(
            any()
                .filter(char::is_ascii_digit)
                .then(skip(char::is_ascii_digit))
                .to_slice(),
        )
    })
}

/// Anything up to the next boundary; a string is one word with all its spaces.
fn word<'s>() -> impl Parser<'s, &'s str, &'s str, Extra> + Copy {
    custom(|input| {
        let quoted = just('"')
            .then(any().filter(|c| *c != '"').repeated())
            .ignored()
            .then_ignore(just('"').or_not());
        let plain = any().and_is(boundary().not()).ignored();
        input.parse(choice((quoted, plain)).repeated().at_least(1).to_slice())
    })
}

fn letter<'s>(upper: char) -> impl Parser<'s, &'s str, char, Extra> + Copy {
    any().filter(move |c: &char| c.to_ascii_uppercase() == upper)
}

fn class<'s>() -> impl Parser<'s, &'s str, DeviceClass, Extra> + Copy {
    custom(|input| {
        let single = select! {
            'X' | 'x' => DeviceClass::X,
            'M' | 'm' => DeviceClass::M,
            'Y' | 'y' => DeviceClass::Y,
            'S' | 's' => DeviceClass::S,
            'T' | 't' => DeviceClass::T,
            'C' | 'c' => DeviceClass::C,
            'D' | 'd' => DeviceClass::D,
            'R' | 'r' => DeviceClass::R,
            'V' | 'v' => DeviceClass::V,
            'Z' | 'z' => DeviceClass::Z,
            'P' | 'p' => DeviceClass::P,
            'I' | 'i' => DeviceClass::I,
            'N' | 'n' => DeviceClass::N,
        };
        input.parse(choice((
            single,
            letter('E').then(letter('R')).to(DeviceClass::ER),
        )))
    })
}

/// The number of a device of this class, as far as its digits can be read.
fn number(class: DeviceClass, digits: &str) -> (u32, Option<Kind>) {
    let radix = if class.is_octal() { 8 } else { 10 };
    if class.is_octal() && digits.bytes().any(|b| b > b'7') {
        return (digits.parse().unwrap_or(0), Some(Kind::Octal(class)));
    }
    match u32::from_str_radix(digits, radix) {
        Ok(number) => (number, None),
        Err(_) => (0, Some(Kind::DeviceNumber)),
    }
}

fn device<'s>() -> impl Parser<'s, &'s str, Device, Extra> + Copy {
    custom(|input| {
        let bare = any()
            .filter(|c: &char| matches!(c, 'V' | 'v' | 'Z' | 'z'))
            .then_ignore(boundary());
        let numbered = class().then(digits()).map_with(|(class, digits), e| {
            let (number, fault) = number(class, digits);
            if let Some(kind) = fault {
                report(e, kind);
            }
            Device { class, number }
        });
        input.parse(numbered.or(bare.map(|c| Device {
            class: index_class(c),
            number: 0,
        })))
    })
}

fn index_class(c: char) -> DeviceClass {
    if c.eq_ignore_ascii_case(&'V') {
        DeviceClass::V
    } else {
        DeviceClass::Z
    }
}

fn index<'s>() -> impl Parser<'s, &'s str, Option<Index>, Extra> + Copy {
    custom(|input| {
        input.parse(
            any()
                .filter(|c: &char| matches!(c, 'V' | 'v' | 'Z' | 'z'))
                .then(digits().or_not())
                .map_with(|(c, digits), e| {
                    let class = index_class(c);
                    let (number, fault) = digits.map_or((0, None), |digits| number(class, digits));
                    if let Some(kind) = fault {
                        report(e, kind);
                    }
                    Index { class, number }
                })
                .or_not(),
        )
    })
}

/// `X000`, `D0Z1`, `D0.F`, `D0.FZ1`.
fn device_operand<'s>() -> impl Parser<'s, &'s str, OperandKind, Extra> + Copy {
    custom(|input| {
        let bit = just('.').ignore_then(
            any()
                .filter(char::is_ascii_alphanumeric)
                .then(digits().or_not())
                .to_slice(),
        );
        input.parse(device().then(bit.or_not()).then(index()).map_with(
            |((device, bit), index), e| {
                let Some(bit) = bit else {
                    return OperandKind::Device(device, index);
                };
                let bit = match u8::from_str_radix(bit, 16) {
                    Ok(bit @ 0..=15) => bit,
                    _ => {
                        report(e, Kind::BitNumber);
                        0
                    }
                };
                OperandKind::WordBit(device, bit, index)
            },
        ))
    })
}

/// `K10`, `K-5Z0`, `K4M0`, `K2X010Z1`.
fn k_operand<'s>() -> impl Parser<'s, &'s str, OperandKind, Extra> + Copy {
    custom(|input| {
        let amount = one_of("+-").or_not().then(digits()).to_slice();
        let group = device().and_is(index().then(boundary()).not());
        input.parse(
            letter('K')
                .ignore_then(amount)
                .then(group.or_not())
                .then(index())
                .map_with(|((amount, group), index), e| {
                    let mut fault = |kind| report(e, kind);
                    let Some(device) = group else {
                        let value = amount.parse::<i32>().unwrap_or_else(|_| {
                            fault(Kind::Decimal);
                            0
                        });
                        return OperandKind::Decimal(value.into(), index);
                    };
                    use DeviceClass::{M, S, X, Y};
                    if !matches!(device.class, X | Y | M | S) {
                        fault(Kind::DigitClass(device.class));
                    }
                    let digits = match amount.parse() {
                        Ok(digits @ 1..=8) => digits,
                        _ => {
                            fault(Kind::DigitCount);
                            4
                        }
                    };
                    OperandKind::Nibbles(digits, device, index)
                }),
        )
    })
}

/// `H1F`, `H1FZ0`.
fn h_operand<'s>() -> impl Parser<'s, &'s str, OperandKind, Extra> + Copy {
    custom(|input| {
        let hex = any()
            .filter(char::is_ascii_hexdigit)
            .repeated()
            .at_least(1)
            .to_slice();
        input.parse(
            letter('H')
                .ignore_then(hex)
                .then(index())
                .map_with(|(hex, index), e| {
                    let value = u32::from_str_radix(hex, 16).unwrap_or_else(|_| {
                        report(e, Kind::Hex);
                        0
                    });
                    OperandKind::Hex(value.into(), index)
                }),
        )
    })
}

/// `E1.5`, `E-1.5E+3`, and `E1.5+3` as the manuals of FX print it.
fn e_operand<'s>() -> impl Parser<'s, &'s str, OperandKind, Extra> + Copy {
    custom(|input| {
        let sign = one_of("+-");
        let mantissa = sign.or_not().then(choice((
            digits()
                .then(just('.').then(digits().or_not()).or_not())
                .ignored(),
            just('.').then(digits()).ignored(),
        )));
        let exponent = choice((
            letter('E').ignore_then(sign.or_not().then(digits()).to_slice()),
            sign.then(digits()).to_slice(),
        ));
        input.parse(
            letter('E')
                .ignore_then(mantissa.to_slice())
                .then(exponent.or_not())
                .map_with(|(mantissa, exponent): (&str, Option<&str>), e| {
                    let value = match exponent {
                        None => mantissa.parse::<f32>(),
                        Some(exponent) => format!("{mantissa}e{exponent}").parse(),
                    };
                    OperandKind::Float(value.ok().filter(|v| v.is_finite()).unwrap_or_else(|| {
                        report(e, Kind::Float);
                        0.0
                    }))
                }),
        )
    })
}

/// `"ABC"`; a quote inside is written twice.
fn text_operand<'s>() -> impl Parser<'s, &'s str, OperandKind, Extra> + Copy {
    custom(|input| {
        let inside = choice((
            just("\"\"").ignored(),
            any().filter(|c| *c != '"').ignored(),
        ));
        let closed = inside
            .repeated()
            .to_slice()
            .delimited_by(just('"'), just('"'));
        input.parse(closed.map(|text: &str| {
            let text = if text.contains('"') {
                text.replace("\"\"", "\"").into()
            } else {
                SmolStr::new(text)
            };
            OperandKind::Text(text)
        }))
    })
}

/// `U0\G5`.
fn buffer_operand<'s>() -> impl Parser<'s, &'s str, OperandKind, Extra> + Copy {
    custom(|input| {
        let part = |c| letter(c).ignore_then(digits());
        input.parse(
            part('U')
                .then_ignore(just('\\'))
                .then(part('G'))
                .then(index())
                .map_with(|((module, address), index), e| {
                    let mut number = |digits: &str| {
                        digits.parse().unwrap_or_else(|_| {
                            report(e, Kind::DeviceNumber);
                            0
                        })
                    };
                    OperandKind::Buffer {
                        module: number(module),
                        address: number(address),
                        index,
                    }
                }),
        )
    })
}

/// `K 10`, `X 000`: a space before the number.
fn spaced_operand<'s>() -> impl Parser<'s, &'s str, OperandKind, Extra> + Copy {
    custom(|input| {
        let prefix = choice((
            class().ignored(),
            letter('K').ignored(),
            letter('H').ignored(),
        ));
        let spaces = any()
            .filter(|c: &char| c.is_whitespace())
            .repeated()
            .at_least(1);
        input.parse(
            prefix
                .then_ignore(spaces)
                .then_ignore(digits())
                .then_ignore(boundary().rewind())
                .to_slice()
                .map_with(|text: &str, e| {
                    report(e, Kind::SpacedNumber);
                    let joined: String = text.split_whitespace().collect();
                    match parse(&device_field(), &joined, &mut Faults::default()) {
                        Some(device) => OperandKind::Device(device, None),
                        None => OperandKind::Unreadable(None),
                    }
                }),
        )
    })
}

/// What begins a comment in other languages.
fn comment_sign<'s>() -> impl Parser<'s, &'s str, (), Extra> + Copy {
    choice((just("(*").ignored(), just('#').ignored()))
}

fn placed<'s>(
    kind: impl Parser<'s, &'s str, OperandKind, Extra> + Copy,
) -> impl Parser<'s, &'s str, Operand, Extra> + Copy {
    kind.map_with(|kind, e| Operand {
        span: span(e.span()),
        kind,
    })
    .then_ignore(boundary())
}

/// One operand. What cannot be read is reported and stays as such, and the next operand is read.
fn operand<'s>() -> impl Parser<'s, &'s str, Operand, Extra> + Copy {
    custom(|input| {
        let readable = choice((
            device_operand(),
            k_operand(),
            h_operand(),
            e_operand(),
            text_operand(),
            buffer_operand(),
        ));
        let unreadable = word().map_with(|word: &str, e| {
            let open = word.starts_with('"') && word.matches('"').count() % 2 == 1;
            let kind = if open { Kind::Unclosed } else { Kind::Operand };
            report(e, kind);
            OperandKind::Unreadable(meant_device(word))
        });
        // After the last operand no kind of operand is tried.
        input.parse(
            choice((boundary(), comment_sign()))
                .not()
                .ignore_then(choice((
                    placed(readable),
                    placed(spaced_operand()),
                    placed(unreadable),
                ))),
        )
    })
}

fn operands<'s>() -> impl Parser<'s, &'s str, Operands, Extra> + Copy {
    custom(|input| input.parse(space().ignore_then(operand()).repeated().collect()))
}

/// The mnemonic's spelling: upper case, without the space or the second `D` of `LD D>=`, operators in the usual order.
fn spelling<'s>(name: &'s str, wide: bool, operator: &str, pulse: &str) -> Cow<'s, str> {
    if operator.is_empty() && !name.bytes().any(|b| b.is_ascii_lowercase()) {
        return Cow::Borrowed(name);
    }
    let operator = match operator {
        "=>" => ">=",
        "=<" => "<=",
        "><" => "<>",
        other => other,
    };
    let parts = [name, if wide { "D" } else { "" }, operator, pulse];
    let letters = parts.into_iter().flat_map(str::chars);
    Cow::Owned(letters.map(|c| c.to_ascii_uppercase()).collect())
}

fn mnemonic<'s>() -> impl Parser<'s, &'s str, (Cow<'s, str>, Span), Extra> + Copy {
    custom(|input| {
        let head = any().filter(|c: &char| c.is_ascii_alphabetic() || matches!(c, '$' | '_'));
        let rest = skip(|c| c.is_ascii_alphanumeric() || *c == '_');
        let name = head.then(rest).to_slice();
        let compare = any()
            .filter(|c| matches!(c, '<' | '=' | '>'))
            .repeated()
            .at_least(1)
            .at_most(2)
            .to_slice();
        let pulse = letter('P').then_ignore(boundary()).to_slice();
        let compared = space()
            .ignore_then(letter('D').or_not())
            .then(compare)
            .then(pulse.or_not())
            .map(|((wide, operator), pulse)| (wide.is_some(), operator, pulse.unwrap_or("")));
        let added = one_of("+-")
            .to_slice()
            .then(pulse.or_not())
            .then_ignore(boundary())
            .map(|(operator, pulse)| (false, operator, pulse.unwrap_or("")));
        let plain = boundary().to((false, "", ""));
        input.parse(name.then(choice((added, compared, plain))).map_with(
            |(name, (wide, operator, pulse)), e| {
                (spelling(name, wide, operator, pulse), span(e.span()))
            },
        ))
    })
}

/// `ASC ABCDEFGH D300`: the characters are bare, whatever they look like.
fn asc<'s>() -> impl Parser<'s, &'s str, Body<'s>, Extra> + Copy {
    custom(|input| {
        let name = letter('A')
            .then(letter('S'))
            .then(letter('C'))
            .to_span()
            .then_ignore(boundary());
        let bare = any()
            .and_is(boundary().not())
            .filter(|c| *c != '"')
            .repeated()
            .at_least(1)
            .to_slice();
        let text = choice((
            text_operand(),
            bare.map(|text: &str| OperandKind::Text(text.into())),
        ));
        input.parse(
            name.then_ignore(space())
                .then(placed(text))
                .then(operands())
                .map(|((name, text), mut rest)| {
                    rest.insert(0, text);
                    Body {
                        mnemonic: Cow::Borrowed("ASC"),
                        mnemonic_span: span(name),
                        operands: rest,
                    }
                }),
        )
    })
}

fn body<'s>() -> impl Parser<'s, &'s str, Body<'s>, Extra> + Copy {
    custom(|input| {
        let usual = mnemonic()
            .then(operands())
            .map(|((mnemonic, mnemonic_span), operands)| Body {
                mnemonic,
                mnemonic_span,
                operands,
            });
        input.parse(choice((asc(), usual)))
    })
}

fn step<'s>() -> impl Parser<'s, &'s str, (Option<u32>, Span), Extra> + Copy {
    custom(|input| {
        let after = choice((boundary(), one_of(":.)").ignored()));
        let number = digits().map_with(|digits: &str, e| {
            let step = digits.parse().unwrap_or_else(|_| {
                report(e, Kind::Step);
                0
            });
            (Some(step), span(e.span()))
        });
        input.parse(
            number
                .then_ignore(after)
                .or_not()
                .map(Option::unwrap_or_default),
        )
    })
}

/// `P0`, `P0:`, `I001`.
fn label<'s>() -> impl Parser<'s, &'s str, (Device, Span), Extra> + Copy {
    custom(|input| {
        let pointer = any()
            .filter(|c: &char| matches!(c, 'P' | 'p' | 'I' | 'i'))
            .rewind()
            .ignore_then(device());
        let spaces = any()
            .filter(|c: &char| c.is_whitespace())
            .repeated()
            .at_least(1);
        let spaced = select! { 'P' | 'p' => DeviceClass::P, 'I' | 'i' => DeviceClass::I }
            .then_ignore(spaces)
            .then(digits())
            .map_with(|(class, digits), e| {
                report(e, Kind::SpacedLabel);
                let number = number(class, digits).0;
                Device { class, number }
            });
        input.parse(
            choice((pointer, spaced))
                .map_with(|device, e| (device, span(e.span())))
                .then_ignore(choice((space().then(just(':')).ignored(), boundary()))),
        )
    })
}

/// A whole line. A line that is not an instruction is reported and skipped up to its comment.
pub(super) fn line<'s>() -> impl Parser<'s, &'s str, Line<'s>, Extra> + Copy {
    custom(|input| {
        let comment_start = choice((just(';').ignored(), just("//").ignored()));
        let foreign_start = comment_sign().to_span().map_with(|s: SimpleSpan, e| {
            report(e, Kind::CommentSign);
            s
        });
        let comment = choice((comment_start.to_span(), foreign_start))
            .then_ignore(any().repeated())
            .map(|s: SimpleSpan| s.end as u32);
        let nonsense = any()
            .and_is(comment_start.not())
            .repeated()
            .at_least(1)
            .to_slice()
            .and_is(comment_sign().not())
            .map_with(|text: &str, e: &mut MapExtra<'s, '_, &'s str, Extra>| {
                let whole = e.span();
                let end = whole.start + text.trim_end().len();
                let fault = Fault::new((whole.start..end).into(), Kind::Line);
                e.state().push(fault);
                None
            });
        let content = choice((body().map(Some), nonsense)).or_not();
        input.parse(
            space()
                .ignore_then(step())
                .then_ignore(space())
                .then(label().or_not())
                .then_ignore(space())
                .then(content)
                .then_ignore(space())
                .then(comment.or_not())
                .map_with(|((((step, place), label), content), comment), e| {
                    if step.is_some() && label.is_none() && content.is_none() {
                        let place = place.start as usize..place.end as usize;
                        e.state().push(Fault::new(place.into(), Kind::Bare));
                    }
                    Line {
                        step,
                        label,
                        instr: content.flatten(),
                        comment,
                    }
                }),
        )
    })
}

/// What a parser makes of a text; its faults come after `faults`. A text that lacks something gives nothing.
pub(super) fn parse<'s, T>(
    parser: &impl Parser<'s, &'s str, T, Extra>,
    text: &'s str,
    faults: &mut Faults,
) -> Option<T> {
    let output = parser.parse_with_state(text, faults).into_output();
    if output.is_none() {
        let end = text.len();
        faults.push(Fault::new((end..end).into(), Kind::Line));
    }
    output
}

/// The device that an unreadable operand was probably meant to name: `MO`, `XOO1`.
fn meant_device(word: &str) -> Option<Device> {
    let meant = mistyped_digit(&word.to_ascii_uppercase())?;
    parse(&device_field(), &meant, &mut Faults::default())
}
