//! Conditions in structured text, as transitions have them: bits, comparisons, AND, OR, XOR and NOT.

use super::drawing::Word;
use super::logic::{Contact, Logic, Sense};
use super::variables::{Kind, constant};
use super::{Fault, Reader, functions};
use roxmltree::Node;
use smol_str::{SmolStr, ToSmolStr, format_smolstr};

/// Maximum nesting of parentheses.
const DEEPEST: usize = 50;

/// Reads a condition.
pub(super) fn read(reader: &mut Reader, node: Node, text: &str) -> Result<Logic, Fault> {
    let text = text.trim().trim_start_matches(":=").trim_end_matches(';');
    let mut parser = Parser {
        reader,
        node,
        words: words(text).collect(),
        at: 0,
        depth: 0,
        contacts: 0,
    };
    let logic = parser.any_of()?;
    match parser.peek() {
        None => Ok(logic),
        Some(_) => Err(parser.wrong()),
    }
}

/// A bit that a name means, as a contact.
pub(super) fn bit(
    reader: &mut Reader,
    node: Node,
    element: u32,
    on: bool,
    name: &str,
) -> Result<Logic, Fault> {
    match name.trim().to_uppercase().as_str() {
        "TRUE" if on => return Ok(Logic::wire()),
        "FALSE" if !on => return Ok(Logic::wire()),
        "TRUE" | "FALSE" => return Ok(Logic::contact(element, false, "M8000")),
        _ => {}
    }
    let device = reader.bit(node, name)?;
    Ok(Logic::contact(element, on, device.to_smolstr()))
}

/// A number that a name or a constant means.
pub(super) fn number(reader: &mut Reader, node: Node, written: &str) -> Result<Word, Fault> {
    if let Some(operand) = constant(written) {
        return Ok(Word {
            operand,
            kind: None,
        });
    }
    let found = reader.find(node, written)?;
    if found.kind == Kind::Bool {
        let what = format!("`{}` is not a number", written.trim());
        return Err(Fault::at(node, what, "compare numbers"));
    }
    Ok(Word {
        operand: found.device.to_smolstr(),
        kind: Some(found.kind),
    })
}

/// A comparison of two numbers as a contact; `sign` is `=`, `<>`, `<`, `<=`, `>` or `>=`.
pub(super) fn comparison(
    node: Node,
    element: u32,
    sign: &str,
    [a, b]: [&Word; 2],
) -> Result<Logic, Fault> {
    let unsigned = |word: &Word| matches!(word.kind, Some(Kind::Word | Kind::Dword));
    if !matches!(sign, "=" | "<>") && (unsigned(a) || unsigned(b)) {
        let what = "a number without a sign is compared";
        let help = "the PLC's numbers have a sign: use INT or DINT";
        return Err(Fault::at(node, what, help));
    }
    let wide = if functions::wide(node, &[a, b])? {
        "D"
    } else {
        ""
    };
    Ok(Logic::Contact(Contact {
        element,
        sense: Sense::Compare(format_smolstr!("{wide}{sign}")),
        operands: format_smolstr!("{} {}", a.operand, b.operand),
    }))
}

/// The words and signs of a text.
fn words(text: &str) -> impl Iterator<Item = SmolStr> {
    let mut rest = text;
    std::iter::from_fn(move || {
        rest = rest.trim_start();
        let is_word = |c: char| c.is_alphanumeric() || "_.#%".contains(c);
        let first = rest.chars().next()?;
        let length = if is_word(first) || first == '-' {
            let after = &rest[first.len_utf8()..];
            first.len_utf8() + after.find(|c| !is_word(c)).unwrap_or(after.len())
        } else if ["<=", ">=", "<>"].iter().any(|sign| rest.starts_with(sign)) {
            2
        } else {
            first.len_utf8()
        };
        let (word, after) = rest.split_at(length);
        rest = after;
        Some(word.into())
    })
}

struct Parser<'a, 'i, 'r> {
    reader: &'r mut Reader,
    node: Node<'a, 'i>,
    words: Vec<SmolStr>,
    at: usize,
    depth: usize,
    /// Number of contacts so far: each is a separate element.
    contacts: u32,
}

impl Parser<'_, '_, '_> {
    fn peek(&self) -> Option<&str> {
        self.words.get(self.at).map(SmolStr::as_str)
    }

    fn take(&mut self, words: &[&str]) -> bool {
        let found = self
            .peek()
            .is_some_and(|next| words.iter().any(|word| word.eq_ignore_ascii_case(next)));
        self.at += usize::from(found);
        found
    }

    fn wrong(&self) -> Fault {
        let what = match self.peek() {
            Some(word) => format!("`{word}` in structured text has no counterpart here"),
            None => "the structured text of this condition is not complete".to_owned(),
        };
        let help = "conditions consist of bits, comparisons, AND, OR, XOR, NOT and parentheses";
        Fault::at(self.node, what, help)
    }

    fn element(&mut self) -> u32 {
        self.contacts += 1;
        self.node.id().get().wrapping_add(self.contacts << 20)
    }

    fn any_of(&mut self) -> Result<Logic, Fault> {
        let mut ways = vec![self.one_of()?];
        while self.take(&["OR"]) {
            ways.push(self.one_of()?);
        }
        Ok(Logic::joined(ways))
    }

    fn one_of(&mut self) -> Result<Logic, Fault> {
        let mut first = self.all_of()?;
        while self.take(&["XOR"]) {
            let second = self.all_of()?;
            first = exclusive(first, second);
            if first.size() > super::MOST_CONTACTS {
                return Err(self.wrong());
            }
        }
        Ok(first)
    }

    fn all_of(&mut self) -> Result<Logic, Fault> {
        let mut logic = self.operand()?;
        while self.take(&["AND", "&"]) {
            logic = logic.then(self.operand()?);
        }
        Ok(logic)
    }

    fn operand(&mut self) -> Result<Logic, Fault> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(self.wrong());
        }
        let logic = if self.take(&["NOT"]) {
            self.operand()?.changed("INV")
        } else if self.take(&["("]) {
            let logic = self.any_of()?;
            if !self.take(&[")"]) {
                return Err(self.wrong());
            }
            logic
        } else {
            self.bit_or_comparison()?
        };
        self.depth -= 1;
        Ok(logic)
    }

    fn bit_or_comparison(&mut self) -> Result<Logic, Fault> {
        let is_name =
            |word: &&str| word.starts_with(|c: char| c.is_alphanumeric() || "_%-".contains(c));
        let name = self.peek().filter(is_name).map(str::to_owned);
        let Some(name) = name else {
            return Err(self.wrong());
        };
        self.at += 1;
        let sign = ["=", "<>", "<=", ">=", "<", ">"]
            .into_iter()
            .find(|sign| self.take(&[sign]));
        let element = self.element();
        let Some(sign) = sign else {
            return bit(self.reader, self.node, element, true, &name);
        };
        let Some(other) = self.peek().filter(is_name).map(str::to_owned) else {
            return Err(self.wrong());
        };
        self.at += 1;
        let a = number(self.reader, self.node, &name)?;
        let b = number(self.reader, self.node, &other)?;
        comparison(self.node, element, sign, [&a, &b])
    }
}

/// One or the other, but not both.
pub(super) fn exclusive(a: Logic, b: Logic) -> Logic {
    let one = a.clone().then(b.clone().changed("INV"));
    let other = a.changed("INV").then(b);
    Logic::joined(vec![one, other])
}
