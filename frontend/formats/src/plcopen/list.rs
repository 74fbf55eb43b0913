//! Instruction lists of IEC 61131-3. Variables `MPS_1`, … and labels `SKIP_1`, …, which `rungc convert` writes, keep a
//! result for several branches, and skip a function of words.

mod calls;
mod source;

use super::drawing::Word;
use super::expression::{bit, comparison, exclusive, number};
use super::logic::{Logic, Part};
use super::{Fault, MOST_CONTACTS, Reader, blocks, functions, text};
use roxmltree::Node;
use smol_str::{SmolStr, ToSmolStr, format_smolstr};
use source::Line;
use std::collections::BTreeMap;

/// Maximum nesting of parentheses.
const DEEPEST: usize = 50;

/// Prefix of a variable that stores a result for branches of the same network.
const KEPT: &str = "MPS_";
/// Prefix of a label that follows a skipped function.
const SKIP: &str = "SKIP_";

/// Finds the timers that a list calls, so that their outputs can be read before them.
pub(super) fn prepare(reader: &mut Reader, body: Node) {
    List::new(reader, body).find_blocks(&source::lines(&text(body)));
}

/// Reads the body of a program or action, whose timers have been found.
pub(super) fn read(reader: &mut Reader, body: Node) {
    let mut list = List::new(reader, body);
    for line in source::lines(&text(body)) {
        if list.reader.gives_up() {
            return;
        }
        let result = match line {
            Line::Comment(comment) => {
                list.remarks.push(comment);
                continue;
            }
            Line::Code(code) => list.line(&code),
        };
        if let Err(fault) = result {
            list.reader.report(fault);
            list.result = Accumulator::Unread;
        }
    }
    list.remark();
    if let Err(fault) = list.closed() {
        list.reader.report(fault);
    }
    if list.skipped.is_some() {
        let fault = list.foreign("JMPCN");
        list.reader.report(fault);
    }
}

/// Reads a list that computes a condition.
pub(super) fn condition(reader: &mut Reader, body: Node) -> Result<Logic, Fault> {
    let mut list = List::new(reader, body);
    for line in source::lines(&text(body)) {
        if let Line::Code(code) = line {
            list.line(&code)?;
        }
    }
    list.closed()?;
    match list.result {
        Accumulator::Flow(logic) => Ok(logic),
        _ => Err(Fault::at(
            body,
            "the list has no bit as its result",
            "end it with one",
        )),
    }
}

/// Current result of the list.
#[derive(Clone, Debug)]
enum Accumulator {
    Nothing,
    /// Anything: what would compute it was reported, so nothing that uses it is.
    Unread,
    Flow(Logic),
    Word(Word),
    /// A sum or difference that waits for its destination: mnemonic and operands.
    Sum(&'static str, Word, Word),
}

/// A list while it is read.
struct List<'a, 'i, 'r> {
    reader: &'r mut Reader,
    body: Node<'a, 'i>,
    result: Accumulator,
    /// Open parentheses.
    deferred: Vec<Deferred>,
    /// Each instruction is a separate element.
    instructions: u32,
    /// Comments above the network that comes next.
    remarks: Vec<String>,
    /// Results that branches continue, by the names of their variables.
    kept: BTreeMap<String, Branched>,
    /// Logic of the timers' inputs, by their instances.
    inputs: BTreeMap<String, Logic>,
    /// The label that skips what is read, and the condition that does not.
    skipped: Option<(String, Logic)>,
}

/// State pushed by a parenthesis.
struct Deferred {
    operator: SmolStr,
    negated: bool,
    /// The result before it.
    before: Accumulator,
    /// The line that opens it.
    code: SmolStr,
}

/// A result that branches continue.
struct Branched {
    logic: Logic,
    /// Number of parts of the program at that time.
    parts: usize,
    /// False if what would compute it was reported.
    is_read: bool,
}

impl<'a, 'i, 'r> List<'a, 'i, 'r> {
    fn new(reader: &'r mut Reader, body: Node<'a, 'i>) -> Self {
        List {
            reader,
            body,
            result: Accumulator::Nothing,
            deferred: Vec::new(),
            instructions: 0,
            remarks: Vec::new(),
            kept: BTreeMap::new(),
            inputs: BTreeMap::new(),
            skipped: None,
        }
    }

    /// Writes the comments above a network.
    fn remark(&mut self) {
        let lines = self.remarks.drain(..);
        let lines = lines.map(|line| Part::Line(format!("; {line}")));
        self.reader.parts.extend(lines);
    }

    /// The number of the element that is read.
    fn element(&self) -> u32 {
        self.body.id().get().wrapping_add(self.instructions << 20)
    }

    fn line(&mut self, line: &str) -> Result<(), Fault> {
        let mut code = line.trim();
        let label = code.split_once(':').filter(|(label, rest)| {
            !rest.starts_with('=') && !label.contains(|c: char| c.is_whitespace() || c == '(')
        });
        if let Some((label, rest)) = label {
            let skips = self.skipped.take_if(|(skip, _)| skip == label.trim());
            if let Some((_, logic)) = skips {
                self.result = Accumulator::Flow(logic);
                return self.line(rest);
            }
            self.closed()?;
            self.remark();
            let pointer = self.reader.pointer(label.trim());
            self.reader.parts.push(Part::Line(pointer.into()));
            self.result = Accumulator::Nothing;
            code = rest.trim();
        }
        if code.is_empty() {
            return Ok(());
        }
        self.instructions += 1;
        if let Some(rest) = code.strip_prefix(')') {
            let open = self.deferred.pop().ok_or_else(|| self.foreign(code))?;
            let inner = self.flow(code)?;
            let inner = match open.negated {
                true => inner.changed("INV"),
                false => inner,
            };
            self.result = open.before;
            self.combine(&open.operator, inner, code)?;
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
        let help = "`rungc book plcopen` lists the operators that rungc reads";
        Fault::at(self.body, what, help)
    }

    /// An error if a parenthesis is open, since what stands before it would be lost.
    fn closed(&self) -> Result<(), Fault> {
        let Some(open) = self.deferred.last() else {
            return Ok(());
        };
        let what = format!("the parenthesis of `{}` is not closed", open.code);
        Err(Fault::at(self.body, what, "close it by a line `)`"))
    }

    /// The result so far, if it is a bit.
    fn flow(&self, code: &str) -> Result<Logic, Fault> {
        match &self.result {
            Accumulator::Flow(logic) => Ok(logic.clone()),
            Accumulator::Unread => Ok(Logic::wire()),
            _ => Err(self.foreign(code)),
        }
    }

    fn word(&self, code: &str) -> Result<Word, Fault> {
        match &self.result {
            Accumulator::Word(word) => Ok(word.clone()),
            Accumulator::Unread => Ok(Word {
                operand: "K0".into(),
                kind: None,
            }),
            _ => Err(self.foreign(code)),
        }
    }

    fn instruction(&mut self, operator: &str, operand: &str, code: &str) -> Result<(), Fault> {
        let loads = matches!(operator, "LD" | "LDN")
            || operator.starts_with(blocks::INSTRUCTION) && operand.starts_with('(');
        let stays_unread = matches!(self.result, Accumulator::Unread) && !loads;
        let read = self.operation(operator, operand, code);
        if stays_unread {
            self.result = Accumulator::Unread;
        }
        read
    }

    fn operation(&mut self, operator: &str, operand: &str, code: &str) -> Result<(), Fault> {
        if let Some(mnemonic) = operator.strip_prefix(blocks::INSTRUCTION) {
            return self.function(mnemonic, operand, code);
        }
        let element = self.element();
        let plain = operator.strip_suffix('N').filter(|plain| {
            matches!(
                *plain,
                "LD" | "ST" | "AND" | "&" | "OR" | "XOR" | "JMPC" | "RETC"
            )
        });
        let (name, negated) = plain.map_or((operator, false), |plain| (plain, true));
        match name {
            "LD" => {
                if negated || !self.continues(operand)? {
                    if self.deferred.is_empty() && self.skipped.is_none() {
                        self.remark();
                    }
                    self.load(operand, !negated)?;
                }
            }
            "CAL" => self.call(operand, code)?,
            "AND" | "&" | "OR" | "XOR" => {
                if let Some(rest) = operand.strip_prefix('(') {
                    if self.deferred.len() == DEEPEST {
                        return Err(self.foreign(code));
                    }
                    let before = std::mem::replace(&mut self.result, Accumulator::Nothing);
                    self.deferred.push(Deferred {
                        operator: name.into(),
                        negated,
                        before,
                        code: code.into(),
                    });
                    return self.parenthesis(rest.trim());
                }
                let next = bit(self.reader, self.body, element, !negated, operand)?;
                self.combine(name, next, code)?;
            }
            "NOT" if operand.is_empty() => {
                self.result = Accumulator::Flow(self.flow(code)?.changed("INV"));
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
                self.result = Accumulator::Sum(mnemonic, self.word(code)?, other);
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
                self.result = Accumulator::Flow(logic);
            }
            "JMP" | "JMPC" | "RET" | "RETC" => self.jump(name, negated, operand, code)?,
            _ => return Err(self.foreign(code)),
        }
        Ok(())
    }

    /// Parses the text after a parenthesis: the operand that it begins with, and perhaps its end.
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
        let element = self.element();
        let name = operand.to_ascii_uppercase();
        let is_number =
            super::variables::constant(&name).is_some() || self.reader.variables.is_number(&name);
        self.result = match is_number && on {
            true => Accumulator::Word(number(self.reader, self.body, operand)?),
            false => Accumulator::Flow(bit(self.reader, self.body, element, on, operand)?),
        };
        Ok(())
    }

    fn combine(&mut self, operator: &str, next: Logic, code: &str) -> Result<(), Fault> {
        if matches!(self.result, Accumulator::Unread) {
            return Ok(());
        }
        let before = self.flow(code)?;
        let logic = match operator {
            "OR" => Logic::joined(vec![before, next]),
            "XOR" => exclusive(before, next),
            _ => before.then(next),
        };
        if logic.size() > MOST_CONTACTS {
            return Err(self.foreign(code));
        }
        self.result = Accumulator::Flow(logic);
        Ok(())
    }

    fn store(&mut self, operand: &str, negated: bool, code: &str) -> Result<(), Fault> {
        if let Accumulator::Flow(logic) = self.result.clone() {
            if self.keep(operand, negated, &logic) {
                return Ok(());
            }
            let device = self.reader.bit(self.body, operand)?;
            let logic = if negated { logic.changed("INV") } else { logic };
            self.reader.output(logic, format_smolstr!("OUT {device}"));
            return Ok(());
        }
        if matches!(self.result, Accumulator::Unread) {
            return self.store_unread(operand, negated);
        }
        if negated || matches!(self.result, Accumulator::Nothing) {
            return Err(self.foreign(code));
        }
        let to = number(self.reader, self.body, operand)?;
        let line = match &self.result {
            Accumulator::Word(from) => {
                let wide = functions::wide(self.body, &[from, &to])?;
                let d = if wide { "D" } else { "" };
                format_smolstr!("{d}MOV {} {}", from.operand, to.operand)
            }
            Accumulator::Sum(mnemonic, a, b) => {
                let wide = functions::wide(self.body, &[a, b, &to])?;
                let d = if wide { "D" } else { "" };
                format_smolstr!("{d}{mnemonic} {} {} {}", a.operand, b.operand, to.operand)
            }
            _ => return Err(self.foreign(code)),
        };
        let enable = self.skipped.as_ref().map(|(_, logic)| logic.clone());
        self.reader.output(enable.unwrap_or_else(Logic::wire), line);
        self.result = Accumulator::Word(to);
        Ok(())
    }

    /// Checks the destination of a result that could not be read.
    fn store_unread(&mut self, operand: &str, negated: bool) -> Result<(), Fault> {
        if self.keep(operand, negated, &Logic::wire()) {
            if let Some(kept) = self.kept.get_mut(operand) {
                kept.is_read = false;
            }
        } else if !operand.contains('.') {
            self.reader.find(self.body, operand)?;
        }
        Ok(())
    }

    fn jump(&mut self, name: &str, negated: bool, label: &str, code: &str) -> Result<(), Fault> {
        if name == "JMPC" && negated && label.starts_with(SKIP) && self.skipped.is_none() {
            self.skipped = Some((label.to_owned(), self.flow(code)?));
            return Ok(());
        }
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
