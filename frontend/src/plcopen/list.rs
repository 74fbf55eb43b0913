//! Instruction lists of IEC 61131-3.

use super::drawing::Word;
use super::expression::{bit, comparison, exclusive, number};
use super::logic::{Logic, Part};
use super::{Fault, MOST_CONTACTS, Reader, functions, text};
use roxmltree::Node;
use smol_str::{SmolStr, ToSmolStr, format_smolstr};

/// How deep parentheses may be nested.
const DEEPEST: usize = 50;

/// Reads the body of a program.
pub(super) fn read(reader: &mut Reader, body: Node) {
    let mut list = List::new(reader, body);
    for line in without_comments(&text(body)).lines() {
        if list.reader.has_given_up() {
            return;
        }
        if let Err(fault) = list.line(line) {
            list.reader.report(fault);
        }
    }
}

/// Reads a list that computes a condition.
pub(super) fn condition(reader: &mut Reader, body: Node) -> Result<Logic, Fault> {
    let mut list = List::new(reader, body);
    for line in without_comments(&text(body)).lines() {
        list.line(line)?;
    }
    match list.result {
        Held::Flow(logic) => Ok(logic),
        _ => Err(Fault::at(
            body,
            "the list has no bit as its result",
            "end it with one",
        )),
    }
}

/// A text with its comments blank.
fn without_comments(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(start) = rest.find("(*") {
        out.push_str(&rest[..start]);
        let end = rest[start..]
            .find("*)")
            .map_or(rest.len(), |end| start + end + 2);
        out.extend(rest[start..end].chars().filter(|c| *c == '\n'));
        rest = &rest[end..];
    }
    out.push_str(rest);
    out
}

/// What the list has computed so far.
#[derive(Clone, Debug)]
enum Held {
    Nothing,
    Flow(Logic),
    Word(Word),
    /// A sum or difference that waits for its destination: mnemonic and operands.
    Sum(&'static str, Word, Word),
}

/// A list while it is read.
struct List<'a, 'i, 'r> {
    reader: &'r mut Reader,
    body: Node<'a, 'i>,
    result: Held,
    /// What parentheses hold back: the operator, whether it negates, and the result before it.
    held: Vec<(SmolStr, bool, Held)>,
    /// Each instruction is a separate element.
    instructions: u32,
}

impl<'a, 'i, 'r> List<'a, 'i, 'r> {
    fn new(reader: &'r mut Reader, body: Node<'a, 'i>) -> Self {
        List {
            reader,
            body,
            result: Held::Nothing,
            held: Vec::new(),
            instructions: 0,
        }
    }

    fn line(&mut self, line: &str) -> Result<(), Fault> {
        let mut code = line.trim();
        if let Some((label, rest)) = code.split_once(':') {
            let pointer = self.reader.pointer(label.trim());
            self.reader.parts.push(Part::Line(pointer.into()));
            self.result = Held::Nothing;
            code = rest.trim();
        }
        if code.is_empty() {
            return Ok(());
        }
        self.instructions += 1;
        if let Some(rest) = code.strip_prefix(')') {
            let (operator, negated, before) = self.held.pop().ok_or_else(|| self.foreign(code))?;
            let inner = self.flow(code)?;
            let inner = if negated { inner.changed("INV") } else { inner };
            self.result = before;
            self.combine(&operator, inner, code)?;
            return self.line(rest);
        }
        let (operator, operand) = code
            .split_once(|c: char| c.is_whitespace())
            .unwrap_or((code, ""));
        let (operator, operand) = match operator.split_once('(') {
            Some((operator, rest)) => (operator, format!("({rest} {operand}")),
            None => (operator, operand.trim().to_owned()),
        };
        self.instruction(&operator.to_ascii_uppercase(), operand.trim(), code)
    }

    fn foreign(&self, code: &str) -> Fault {
        let what = format!("`{code}` has no counterpart in an FX list");
        let help = "docs/src/plcopen.md lists the operators that rungc reads";
        Fault::at(self.body, what, help)
    }

    /// The result so far, if it is a bit.
    fn flow(&self, code: &str) -> Result<Logic, Fault> {
        match &self.result {
            Held::Flow(logic) => Ok(logic.clone()),
            _ => Err(self.foreign(code)),
        }
    }

    fn word(&self, code: &str) -> Result<Word, Fault> {
        match &self.result {
            Held::Word(word) => Ok(word.clone()),
            _ => Err(self.foreign(code)),
        }
    }

    fn instruction(&mut self, operator: &str, operand: &str, code: &str) -> Result<(), Fault> {
        let element = self.instructions;
        let plain = operator.strip_suffix('N').filter(|plain| {
            matches!(
                *plain,
                "LD" | "ST" | "AND" | "&" | "OR" | "XOR" | "JMPC" | "RETC"
            )
        });
        let (name, negated) = plain.map_or((operator, false), |plain| (plain, true));
        match name {
            "LD" => self.load(operand, !negated)?,
            "AND" | "&" | "OR" | "XOR" => {
                if let Some(rest) = operand.strip_prefix('(') {
                    if self.held.len() == DEEPEST {
                        return Err(self.foreign(code));
                    }
                    let before = std::mem::replace(&mut self.result, Held::Nothing);
                    self.held.push((name.into(), negated, before));
                    return self.parenthesis(rest.trim());
                }
                let next = bit(self.reader, self.body, element, !negated, operand)?;
                self.combine(name, next, code)?;
            }
            "NOT" if operand.is_empty() => {
                self.result = Held::Flow(self.flow(code)?.changed("INV"));
            }
            "S" | "R" => {
                let device = self.reader.bit(self.body, operand)?;
                let mnemonic = if name == "S" { "SET" } else { "RST" };
                let logic = self.flow(code)?;
                self.reader
                    .output(logic, format_smolstr!("{mnemonic} {device}"));
            }
            "ST" => self.store(operand, negated, code)?,
            "ADD" | "SUB" => {
                let other = number(self.reader, self.body, operand)?;
                let mnemonic = if name == "ADD" { "ADD" } else { "SUB" };
                self.result = Held::Sum(mnemonic, self.word(code)?, other);
            }
            "GT" | "GE" | "EQ" | "LE" | "LT" | "NE" => {
                let sign = match name {
                    "GT" => ">",
                    "GE" => ">=",
                    "EQ" => "=",
                    "LE" => "<=",
                    "LT" => "<",
                    _ => "<>",
                };
                let other = number(self.reader, self.body, operand)?;
                let first = self.word(code)?;
                let logic = comparison(self.body, element, sign, [&first, &other])?;
                self.result = Held::Flow(logic);
            }
            "JMP" | "JMPC" | "RET" | "RETC" => self.jump(name, negated, operand, code)?,
            _ => return Err(self.foreign(code)),
        }
        Ok(())
    }

    /// What follows a parenthesis: the operand that it begins with, and perhaps its end.
    fn parenthesis(&mut self, rest: &str) -> Result<(), Fault> {
        let (operand, end) = match rest.split_once(')') {
            Some((operand, after)) => (operand.trim(), Some(format!("){after}"))),
            None => (rest, None),
        };
        if !operand.is_empty() {
            self.load(operand, true)?;
        }
        end.map_or(Ok(()), |end| self.line(&end))
    }

    fn load(&mut self, operand: &str, on: bool) -> Result<(), Fault> {
        let element = self.instructions;
        let name = operand.to_ascii_uppercase();
        let is_number =
            super::variables::constant(&name).is_some() || self.reader.variables.is_number(&name);
        self.result = match is_number && on {
            true => Held::Word(number(self.reader, self.body, operand)?),
            false => Held::Flow(bit(self.reader, self.body, element, on, operand)?),
        };
        Ok(())
    }

    fn combine(&mut self, operator: &str, next: Logic, code: &str) -> Result<(), Fault> {
        let before = self.flow(code)?;
        let logic = match operator {
            "OR" => Logic::joined(vec![before, next]),
            "XOR" => exclusive(before, next),
            _ => before.then(next),
        };
        if logic.size() > MOST_CONTACTS {
            return Err(self.foreign(code));
        }
        self.result = Held::Flow(logic);
        Ok(())
    }

    fn store(&mut self, operand: &str, negated: bool, code: &str) -> Result<(), Fault> {
        if let Held::Flow(logic) = self.result.clone() {
            let device = self.reader.bit(self.body, operand)?;
            let logic = if negated { logic.changed("INV") } else { logic };
            self.reader.output(logic, format_smolstr!("OUT {device}"));
            return Ok(());
        }
        if negated {
            return Err(self.foreign(code));
        }
        let to = number(self.reader, self.body, operand)?;
        let line = match &self.result {
            Held::Word(from) => {
                let wide = functions::wide(self.body, &[from, &to])?;
                let d = if wide { "D" } else { "" };
                format_smolstr!("{d}MOV {} {}", from.operand, to.operand)
            }
            Held::Sum(mnemonic, a, b) => {
                let wide = functions::wide(self.body, &[a, b, &to])?;
                let d = if wide { "D" } else { "" };
                format_smolstr!("{d}{mnemonic} {} {} {}", a.operand, b.operand, to.operand)
            }
            _ => return Err(self.foreign(code)),
        };
        self.reader.output(Logic::wire(), line);
        self.result = Held::Word(to);
        Ok(())
    }

    fn jump(&mut self, name: &str, negated: bool, label: &str, code: &str) -> Result<(), Fault> {
        let logic = match name {
            "JMP" | "RET" => Logic::wire(),
            _ if negated => self.flow(code)?.changed("INV"),
            _ => self.flow(code)?,
        };
        let label = if name.starts_with('R') {
            super::RETURN
        } else {
            label
        };
        let pointer = self.reader.pointer(label);
        self.reader
            .output(logic, format_smolstr!("CJ {}", pointer.to_smolstr()));
        Ok(())
    }
}
