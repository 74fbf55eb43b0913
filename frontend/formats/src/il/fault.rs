//! Errors in a line, and their messages.

use super::grammar;
use chumsky::input::{Checkpoint, Cursor, Input};
use chumsky::inspector::Inspector;
use chumsky::span::SimpleSpan;
use rungc_syntax::diag::did_you_mean;
use rungc_syntax::{DeviceClass, Diagnostic, Fix, OperandKind, Span, codes, phrase};

/// A finding of the grammar, at a range of the folded line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fault {
    /// Position.
    pub span: SimpleSpan,
    /// Kind of error.
    pub kind: Kind,
}

/// Kind of error in a line.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Kind {
    /// The text does not start an instruction, or continues in a way no instruction does.
    Line,
    /// A step number that no program can have.
    Step,
    /// A step number with nothing after it.
    Bare,
    /// Neither device, nor constant, nor text.
    Operand,
    /// A device number over 32 bits.
    DeviceNumber,
    /// An 8 or 9 in the number of an input or output.
    Octal(DeviceClass),
    /// A decimal constant over 32 bits.
    Decimal,
    /// A hexadecimal constant over 32 bits.
    Hex,
    /// A floating constant above what single precision can hold.
    Float,
    /// A floating constant nearer to 0 than the smallest normal number.
    SmallFloat,
    /// A digit count outside 1 to 8.
    DigitCount,
    /// A digit group of a device that is not a bit device.
    DigitClass(DeviceClass),
    /// Not a bit number 0 to F.
    BitNumber,
    /// A string without its closing quote.
    Unclosed,
    /// A word with a letter of another alphabet that looks Latin.
    LookAlike(char),
    /// A label with a space before its number.
    SpacedLabel,
    /// A device or constant with a space before its number.
    SpacedNumber,
    /// The beginning of a comment in other languages.
    CommentSign,
}

impl Fault {
    /// A fault at this range.
    pub fn new(span: SimpleSpan, kind: Kind) -> Self {
        Fault { span, kind }
    }

    /// Diagnostic for the error. `folded` is the text that was read, `place` leads from it to the source; `wanted` is
    /// what its operand names, if only one kind comes into question.
    pub fn diagnostic(
        self,
        folded: &str,
        place: impl Fn(Span) -> Span,
        wanted: Option<Wanted>,
    ) -> Diagnostic {
        let range = self.span.start..self.span.end;
        let span = place(Span::new(range.start as u32, range.end as u32));
        let text = folded.get(range).unwrap_or("");
        match wanted.filter(|_| self.kind == Kind::Operand) {
            Some(wanted) => wanted
                .number(span, text)
                .or_else(|| wanted.label(span, text)),
            None => None,
        }
        .unwrap_or_else(|| self.kind.diagnostic(span, text))
    }
}

/// What an operand names, where only one kind comes into question.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Wanted {
    /// A device or constant with this prefix.
    Prefix(&'static str),
    /// A contact.
    Contact,
    /// A coil.
    Coil,
}

impl Wanted {
    /// What the operand at this position of a line names.
    pub fn at(instr: &grammar::Body, span: SimpleSpan) -> Option<Self> {
        let mut operands = instr.operands.iter();
        let at = operands.position(|operand| operand.span.start as usize == span.start)?;
        Some(match (&*instr.mnemonic, at) {
            ("CALL" | "CALLP" | "CJ" | "CJP", 0) => Wanted::Prefix("P"),
            ("MC" | "MCR", 0) => Wanted::Prefix("N"),
            ("STL", 0) | ("IST", 1 | 2) => Wanted::Prefix("S"),
            ("OUT", 1) => Wanted::Prefix("K"),
            ("OUT" | "SET" | "RST" | "PLS" | "PLF", 0) => Wanted::Coil,
            (
                "LD" | "LDI" | "LDP" | "LDF" | "AND" | "ANI" | "ANDP" | "ANDF" | "OR" | "ORI"
                | "ORP" | "ORF",
                0,
            ) => Wanted::Contact,
            _ => return None,
        })
    }

    /// The error for a word that names no label, where a pointer is wanted.
    fn label(self, span: Span, text: &str) -> Option<Diagnostic> {
        let is_word = text.bytes().all(|byte| byte.is_ascii_alphabetic());
        let upper = text.to_ascii_uppercase();
        let mistyped = mistyped_digit(&upper).is_some_and(|meant| is_operand(&meant));
        let is_device = mistyped || DeviceClass::from_prefix(&upper).is_some();
        (self == Wanted::Prefix("P") && is_word && !is_device && !is_name(text)).then(|| {
            codes::BAD_OPERAND
                .at(span, phrase!("`{text}` is not a valid operand", text))
                .label("not a pointer")
                .help("jumps and calls name the number of a label, for example `P0`")
        })
    }

    /// The error for a number alone, if it is one.
    fn number(self, span: Span, text: &str) -> Option<Diagnostic> {
        let number = text
            .bytes()
            .all(|byte| byte.is_ascii_digit())
            .then_some(text)?;
        let prefix = match self {
            Wanted::Prefix(prefix) => prefix,
            Wanted::Contact => "X",
            Wanted::Coil => "Y",
        };
        let mut meant = [format!("{prefix}{number}"), format!("M{number}")].into_iter();
        let meant = meant.find(|meant| is_operand(meant))?;
        let error = codes::BAD_OPERAND.at(span, phrase!("`{text}` is not a valid operand", text));
        Some(match self {
            Wanted::Prefix(_) => error
                .label(phrase!("a number without its {prefix}", prefix))
                .help(phrase!("write `{meant}`", meant))
                .fix(Fix::suggested(phrase!("write `{meant}`", meant)).replace(span, meant)),
            _ => error.label("a number without its device").help(phrase!(
                "write the device with its letter, for example `{meant}`",
                meant
            )),
        })
    }
}

/// Errors that the grammar has found so far. Those of an alternative that fails are discarded.
#[derive(Default)]
pub(super) struct Faults(Vec<Fault>);

impl Faults {
    /// Adds a finding.
    pub fn push(&mut self, fault: Fault) {
        self.0.push(fault);
    }

    /// Those of the part of the line that begins here and was read last.
    pub fn since(&self, start: usize) -> &[Fault] {
        let before = self.0.iter().rev();
        let count = before.take_while(|fault| fault.span.start >= start).count();
        &self.0[self.0.len() - count..]
    }

    /// All of them.
    #[cfg(test)]
    pub fn iter(&self) -> impl Iterator<Item = &Fault> {
        self.0.iter()
    }

    /// Returns true if all of them are of this kind.
    pub(crate) fn are_all(&self, kind: Kind) -> bool {
        self.0.iter().all(|fault| fault.kind == kind)
    }

    /// Returns true if there is none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Takes all of them.
    pub fn drain(&mut self) -> impl Iterator<Item = Fault> {
        self.0.drain(..)
    }
}

impl<'s, I: Input<'s>> Inspector<'s, I> for Faults {
    type Checkpoint = usize;

    fn on_token(&mut self, _: &I::Token) {}

    fn on_save<'p>(&self, _: &Cursor<'s, 'p, I>) -> usize {
        self.0.len()
    }

    fn on_rewind<'p>(&mut self, mark: &Checkpoint<'s, 'p, I, usize>) {
        self.0.truncate(*mark.inspector());
    }
}

impl Kind {
    /// Returns true if the number of the operand is not known.
    pub(super) fn loses_number(self) -> bool {
        self == Kind::DeviceNumber
    }

    /// The diagnostic for this fault at `span`; `text` is the text there, folded.
    fn diagnostic(self, span: Span, text: &str) -> Diagnostic {
        match self {
            Kind::Line => line(span, text),
            Kind::Bare => codes::BAD_INSTRUCTION
                .at(
                    span,
                    phrase!("step number `{text}` has no instruction", text),
                )
                .label("nothing follows it")
                .help("put an instruction and all its operands on one line"),
            Kind::Operand => operand(span, text),
            Kind::Octal(class) => octal(class, span, text),
            Kind::DigitCount => codes::DIGITS
                .at(
                    span,
                    phrase!("`{text}` does not group 1 to 8 digits of 4 bits", text),
                )
                .label("the digit count is 1 to 8")
                .help("16-bit instructions accept K1 to K4, 32-bit ones K1 to K8"),
            Kind::DigitClass(class) => codes::OPERAND_CLASS
                .at(
                    span,
                    phrase!(
                        "`{text}` groups {prefix} devices, which cannot be grouped",
                        text,
                        prefix = class.prefix()
                    ),
                )
                .label("only X, Y, M and S can be grouped")
                .help(
                    "words have no digit count, for example `D0`; separate operands with a space",
                ),
            Kind::BitNumber => codes::BAD_OPERAND
                .at(
                    span,
                    phrase!("`{text}` does not name a bit of a word", text),
                )
                .label("the bit number is one hexadecimal digit, 0 to F")
                .help("bit 10 is `.A`, bit 15 is `.F`"),
            Kind::Unclosed => codes::OPEN_TEXT
                .at(span, "this text has no closing quotation mark")
                .label("no closing `\"` on this line")
                .help("put `\"` after the last character")
                .fix(Fix::suggested("close the text").replace(Span::new(span.end, span.end), "\"")),
            Kind::LookAlike(letter) => look_alike(span, letter, text),
            Kind::SpacedLabel | Kind::SpacedNumber => {
                let joined: String = text.split_whitespace().collect();
                let what = match self {
                    Kind::SpacedLabel => "this label has a space before its number",
                    _ => "this operand has a space before its number",
                };
                codes::BAD_OPERAND
                    .at(span, what)
                    .label("is one word")
                    .help(phrase!("write `{joined}`", joined))
                    .fix(Fix::certain(phrase!("write `{joined}`", joined)).replace(span, joined))
            }
            Kind::CommentSign => codes::BAD_INSTRUCTION
                .at(span, phrase!("`{text}` does not start a comment", text))
                .label("neither an instruction nor an operand")
                .help("comments start with `;` or `//` and end with their line"),
            Kind::Step | Kind::DeviceNumber | Kind::Decimal | Kind::Hex | Kind::Float => {
                self.too_large(span, text)
            }
            Kind::SmallFloat => codes::BIG_NUMBER
                .at(
                    span,
                    phrase!("floating constant `{text}` is too close to 0", text),
                )
                .label("single precision begins at about 1.18E-38")
                .help("check the exponent, or write `E0`"),
        }
    }

    fn too_large(self, span: Span, text: &str) -> Diagnostic {
        let (what, label, help) = match self {
            Kind::Step => (
                "step number",
                "a program has at most 64000 steps",
                "step numbers are optional: omit it",
            ),
            Kind::DeviceNumber => (
                "the number of",
                "no model has a device with this number",
                "check the number for surplus digits",
            ),
            Kind::Hex => (
                "constant",
                "H is H0 to HFFFFFFFF",
                "16-bit instructions accept H0 to HFFFF, 32-bit ones H0 to HFFFFFFFF",
            ),
            Kind::Float => (
                "floating constant",
                "single precision ends at about 3.4E+38",
                "check the exponent",
            ),
            _ => (
                "constant",
                "K is K-2147483648 to K2147483647",
                "16-bit instructions accept K-32768 to K32767, 32-bit ones K-2147483648 to K2147483647",
            ),
        };
        codes::BIG_NUMBER
            .at(span, phrase!("{what} `{text}` is too large", what, text))
            .label(label)
            .help(help)
    }
}

/// The error for a letter of another script.
fn look_alike(span: Span, letter: char, text: &str) -> Diagnostic {
    let message = phrase!(
        "`{letter}` is U+{code}, not a Latin letter",
        letter,
        code = format!("{:04X}", u32::from(letter))
    );
    codes::LOOK_ALIKE
        .at(span, message)
        .label("only looks like one")
        .help(phrase!("type `{text}` with Latin letters", text))
        .fix(Fix::certain(phrase!("write `{text}`", text)).replace(span, text))
}

fn line(span: Span, text: &str) -> Diagnostic {
    let word = text.split_whitespace().next().unwrap_or(text);
    let digits = word.len() - word.trim_start_matches(|c: char| c.is_ascii_digit()).len();
    if text.starts_with(char::from(crate::encoding::DOS_END)) {
        return codes::BAD_INSTRUCTION
            .at(
                span,
                "the text continues after Ctrl-Z (1Ah), the end of a text in DOS",
            )
            .label("the Ctrl-Z")
            .help("delete it, and what is below it if that is not part of the program");
    }
    let error = codes::BAD_INSTRUCTION.at(
        span,
        phrase!("expected an instruction, found `{word}`", word),
    );
    match word.split_at_checked(digits) {
        Some((step, rest)) if digits > 0 && !rest.is_empty() => error
            .label("a mnemonic starts with a letter")
            .help(phrase!("if `{step}` is the step number, put a space after it: `{step} {rest}`", step, rest)),
        _ => error
            .label("not an instruction")
            .help("an instruction is a mnemonic and its operands, for example `OUT T0 K30`; comments start with `;` or `//`"),
    }
}

fn octal(class: DeviceClass, span: Span, text: &str) -> Diagnostic {
    let prefix = class.prefix();
    let digits = text.trim_start_matches(|c: char| c.is_ascii_alphabetic());
    let error = codes::BAD_OCTAL
        .at(
            span,
            phrase!(
                "`{text}` is not an octal number: {prefix} devices have no digits 8 and 9",
                text,
                prefix
            ),
        )
        .label("8 and 9 are not octal digits");
    // No model has a terminal beyond 377.
    let decimal = digits.parse().ok().filter(|&n: &u32| n <= 0o377);
    let decimal =
        decimal.map(|n| phrase!("; decimal {n} is `{number}`", n, number = class.number(n)));
    error.help(phrase!(
        "{prefix} counts in octal, so {prefix}007 is followed by {prefix}010{decimal}",
        prefix,
        decimal = decimal.unwrap_or_default()
    ))
}

/// Says what an unreadable operand lacks, as precisely as its text allows.
fn operand(span: Span, text: &str) -> Diagnostic {
    let upper = text.to_ascii_uppercase();
    let letters = upper.len()
        - upper
            .trim_start_matches(|c: char| c.is_ascii_alphabetic())
            .len();
    let (prefix, rest) = upper.split_at(letters);
    let known = DeviceClass::from_prefix(prefix).is_some();
    if rest.is_empty() && (known || matches!(prefix, "K" | "H" | "E")) {
        return codes::BAD_OPERAND
            .at(span, phrase!("`{text}` lacks its number", text))
            .label(if known {
                "device without a number"
            } else {
                "constant without a value"
            })
            .help(phrase!("write for example `{prefix}10`", prefix));
    }
    let error = codes::BAD_OPERAND.at(span, phrase!("`{text}` is not a valid operand", text));
    let accepted = |meant: &String| is_operand(meant);
    if let Some((what, meant)) = other_notation(&upper).filter(|(_, meant)| is_operand(meant)) {
        let fix = Fix::certain(phrase!("write `{meant}`", meant)).replace(span, meant.as_str());
        return error
            .label(what)
            .help(phrase!("write `{meant}`", meant))
            .fix(fix);
    }
    if let Ok(number) = upper.parse::<i64>() {
        let decimal = Some(format!("K{number}")).filter(accepted);
        let hexadecimal = Some(format!("H{upper}")).filter(accepted);
        let help = match (decimal, hexadecimal) {
            (None, None) => return Kind::Decimal.too_large(span, text),
            (Some(k), None) => phrase!("write `{k}` for a decimal constant", k),
            (None, Some(h)) => phrase!("write `{h}` for a hexadecimal constant", h),
            (Some(k), Some(h)) => {
                phrase!(
                    "write `{k}` for a decimal constant, `{h}` for a hexadecimal one",
                    k,
                    h
                )
            }
        };
        return error.label("a number without its kind").help(help);
    }
    if let Some(meant) = mistyped_digit(&upper).filter(accepted) {
        return error
            .label("a letter where a digit is expected")
            .help(phrase!("did you mean `{meant}`?", meant))
            .fix(Fix::suggested(phrase!("write `{meant}`", meant)).replace(span, meant.as_str()));
    }
    match prefix {
        "K" => error.label("not a decimal constant").help("write for example `K10`, `K-5`, or `K4M0` for a group of bits"),
        "H" => error.label("not a hexadecimal constant").help("write for example `H1F`: digits 0 to 9 and A to F, no sign"),
        "E" => error.label("not a floating constant").help("write for example `E1.5` or `E-1.5E+3`"),
        "U" => error.label("not an address in buffer memory").help("write for example `U0\\G5`: module 0, address 5"),
        _ if known => error
            .label(phrase!("unexpected text after the number of this {prefix} device", prefix))
            .help(phrase!("an operand is for example `{prefix}10`, with an index register `D0Z0`, or a bit of a word `D0.F`", prefix)),
        _ => {
            if is_name(text) {
                return codes::LABEL_OPERAND
                    .at(span, phrase!("`{text}` is a label, not a device", text))
                    .label("only the compiled program says which device this is")
                    .help("export the list of the compiled program, or write the device that the label stands for");
            }
            let classes = DeviceClass::ALL.map(DeviceClass::prefix);
            let near = did_you_mean(prefix, classes.into_iter().filter(|c| c.len() > 1));
            let help = match near.map(|near| format!("{near}{rest}")).filter(accepted) {
                Some(meant) => phrase!("did you mean `{meant}`?", meant),
                None => phrase!("devices are {classes}; constants start with K, H or E; text is quoted", classes = classes.join(", ")),
            };
            error.label("neither a device nor a constant").help(help)
        }
    }
}

/// Returns true for a text that is read as an operand: what a message proposes is accepted.
fn is_operand(text: &str) -> bool {
    let line = format!("LD {text}");
    let mut faults = Faults::default();
    let instr = grammar::parse(&grammar::line(), &line, &mut faults).and_then(|line| line.instr);
    let operands = instr.map(|body| body.operands).unwrap_or_default();
    faults.is_empty()
        && operands.len() == 1
        && !matches!(operands[0].kind, OperandKind::Unreadable(_))
}

/// Counterpart of another language's notation: its meaning there, and the spelling here.
fn other_notation(upper: &str) -> Option<(&'static str, String)> {
    let hexadecimal = |digits: &str| {
        let hex = !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_hexdigit());
        hex.then(|| format!("H{digits}"))
    };
    let prefixes = ["0X", "16#", "$", "&H"];
    let prefixed = prefixes
        .iter()
        .find_map(|prefix| upper.strip_prefix(prefix));
    let begins_with_digit = upper.starts_with(|c: char| c.is_ascii_digit());
    let suffixed = upper.strip_suffix('H').filter(|_| begins_with_digit);
    if let Some(meant) = prefixed.or(suffixed).and_then(hexadecimal) {
        return Some(("a hexadecimal constant starts with H here", meant));
    }
    if upper.contains('.')
        && upper
            .parse()
            .is_ok_and(|value| OperandKind::float(value).is_some())
    {
        return Some((
            "a floating constant starts with E here",
            format!("E{upper}"),
        ));
    }
    let (digits, device) = upper.split_at_checked(1)?;
    let number = device.get(1..)?;
    let group = ("1"..="8").contains(&digits)
        && device.starts_with(['X', 'Y', 'M', 'S'])
        && !number.is_empty()
        && number.bytes().all(|b| b.is_ascii_digit());
    group.then(|| ("a group of bits starts with K", format!("K{upper}")))
}

/// Returns true if a word can only be a name given by a user: `bSpeed`, `motor_on`.
fn is_name(text: &str) -> bool {
    /// No mistyped device or constant has this many letters in a row.
    const LETTERS: usize = 3;
    let word = text.chars().all(|c| c.is_alphanumeric() || c == '_');
    let letters = text
        .chars()
        .take_while(|c| c.is_alphabetic() || *c == '_')
        .count();
    word && letters > LETTERS
}

/// Correction of `XO01` or `Dl0`, where letters that look like digits follow a device letter.
pub(super) fn mistyped_digit(upper: &str) -> Option<String> {
    let (head, tail) = upper.split_at_checked(1)?;
    let digits = tail.replace('O', "0").replace(['I', 'L'], "1");
    let real = DeviceClass::from_prefix(head).is_some() || head == "K";
    (real && digits != tail && digits.bytes().all(|b| b.is_ascii_digit()))
        .then(|| format!("{head}{digits}"))
}
