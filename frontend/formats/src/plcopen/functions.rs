//! The standard's functions: what they compute, as instructions.

use super::blocks::Pins;
use super::drawing::{Drawing, Failure, Value, Word};
use super::logic::{Contact, Logic, Sense};
use super::variables::Kind;
use super::{Fault, called};
use roxmltree::Node;
use smol_str::{SmolStr, format_smolstr};
use std::collections::BTreeMap;

type Outputs = BTreeMap<SmolStr, Value>;

/// Reads a function; `None` if there is none of this name.
pub(super) fn read<'a, 'i>(
    drawing: &mut Drawing<'a, 'i, '_>,
    pins: &Pins<'a, 'i>,
) -> Option<Result<Outputs, Failure>> {
    let name = pins.name.as_str();
    let compares = matches!(name, "GT" | "GE" | "EQ" | "LE" | "LT" | "NE");
    let combines = matches!(name, "AND" | "OR" | "XOR" | "NOT");
    let computes = matches!(
        name,
        "MOVE" | "ADD" | "SUB" | "MUL" | "DIV" | "MOD" | "MIN" | "MAX" | "LIMIT" | "SEL"
    );
    (compares || combines || computes).then(|| {
        let mut function = Function::new(drawing, pins)?;
        match () {
            () if compares => function.compare(),
            () if combines => function.combine(),
            () => function.compute(),
        }
    })
}

/// Returns true if an instruction takes 32 bits for these numbers.
pub(super) fn wide(node: Node, words: &[&Word]) -> Result<bool, Fault> {
    let kinds: Vec<_> = words.iter().filter_map(|word| word.kind.as_ref()).collect();
    let wide = kinds.iter().any(|kind| kind.is_wide());
    if wide && kinds.iter().any(|kind| !kind.is_wide()) {
        let what = "numbers of 16 and of 32 bits meet here";
        return Err(Fault::at(node, what, "give all of them one type"));
    }
    let fits = |word: &&&Word| match word.operand.split_at(1) {
        ("K", digits) if word.kind.is_none() => digits.parse::<i16>().is_ok(),
        ("H", digits) if word.kind.is_none() => u16::from_str_radix(digits, 16).is_ok(),
        _ => true,
    };
    match words.iter().find(|word| !fits(word)) {
        Some(_) if kinds.is_empty() => Ok(true),
        Some(word) if !wide => {
            let what = format!("{} does not fit into 16 bits", word.operand);
            Err(Fault::at(node, what, "use variables of the type DINT"))
        }
        _ => Ok(wide),
    }
}

/// A function while it is read.
struct Function<'d, 'a, 'i, 'r> {
    drawing: &'d mut Drawing<'a, 'i, 'r>,
    node: Node<'a, 'i>,
    name: &'d str,
    /// Logic that enables it.
    enable: Logic,
    inputs: Vec<Value>,
}

impl<'d, 'a, 'i, 'r> Function<'d, 'a, 'i, 'r> {
    fn new(drawing: &'d mut Drawing<'a, 'i, 'r>, pins: &'d Pins<'a, 'i>) -> Result<Self, Failure> {
        let enable = pins.flow(drawing, "EN")?.unwrap_or_else(Logic::wire);
        let mut inputs = Vec::new();
        for (name, _) in pins.inputs.iter().filter(|(name, _)| *name != "EN") {
            let value = pins.value(drawing, name)?.ok_or_else(|| {
                let what = format!("nothing leads to `{name}` of {}", called(pins.node));
                Fault::at(pins.node, what, "connect a variable or a constant")
            })?;
            inputs.push(value);
        }
        let (least, most) = match pins.name.as_str() {
            "MOVE" | "NOT" => (1, 1),
            "SUB" | "DIV" | "MOD" | "NE" => (2, 2),
            "LIMIT" | "SEL" => (3, 3),
            _ => (2, 32),
        };
        if inputs.len() < least || inputs.len() > most {
            let what = format!("{} has {} inputs", called(pins.node), inputs.len());
            let help = "connect as many as the function has";
            return Err(Some(Fault::at(pins.node, what, help)));
        }
        Ok(Function {
            drawing,
            node: pins.node,
            name: &pins.name,
            enable,
            inputs,
        })
    }

    fn refuse<T>(&self, why: &str, help: &'static str) -> Result<T, Failure> {
        let what = format!("{}: {why}", called(self.node));
        Err(Some(Fault::at(self.node, what, help)))
    }

    fn words(&self) -> Result<Vec<Word>, Failure> {
        let mut words = Vec::new();
        for value in &self.inputs {
            match value {
                Value::Word(word) => words.push(word.clone()),
                Value::Flow(_) => {
                    return self.refuse("a bit is where a number is expected", "connect numbers");
                }
            }
        }
        Ok(words)
    }

    /// The power at all inputs, if they are bits.
    fn flows(&self) -> Result<Option<Vec<Logic>>, Failure> {
        let flows: Vec<_> = self.inputs.iter().filter_map(Value::flow).collect();
        match flows.len() {
            0 => Ok(None),
            n if n < self.inputs.len() => {
                self.refuse("bits and numbers meet here", "connect one or the other")
            }
            _ if !self.enable.is_wire() => {
                let help = "connect EN to the left power rail, and put a contact after it";
                self.refuse("a bit that keeps its value while EN is off", help)
            }
            _ => Ok(Some(flows)),
        }
    }

    fn flow_out(&self, logic: Logic) -> Result<Outputs, Failure> {
        let outputs = [("OUT", logic), ("ENO", Logic::wire())];
        let outputs = outputs.map(|(name, logic)| (name.into(), Value::Flow(logic)));
        Ok(BTreeMap::from(outputs))
    }

    fn contact(&self, how: &str, a: &str, b: &str) -> Logic {
        Logic::Contact(Contact {
            element: self.node.id().get(),
            sense: Sense::Compare(how.into()),
            operands: format_smolstr!("{a} {b}"),
        })
    }

    fn ordered(&self, words: &[&Word]) -> Result<(), Failure> {
        let unsigned = |word: &&&Word| matches!(word.kind, Some(Kind::Word | Kind::Dword));
        match words.iter().find(unsigned) {
            Some(_) => {
                let help = "the PLC's numbers have a sign: use INT or DINT";
                self.refuse("a number without a sign", help)
            }
            None => Ok(()),
        }
    }

    fn compare(&mut self) -> Result<Outputs, Failure> {
        if !self.enable.is_wire() {
            let help = "connect EN to the left power rail, and put a contact after it";
            return self.refuse("a bit that keeps its value while EN is off", help);
        }
        let words = self.words()?;
        let all: Vec<_> = words.iter().collect();
        let sign = match self.name {
            "GT" => ">",
            "GE" => ">=",
            "LE" => "<=",
            "LT" => "<",
            "EQ" => "=",
            _ => "<>",
        };
        if !matches!(sign, "=" | "<>") {
            self.ordered(&all)?;
        }
        let wide = wide(self.node, &all)?;
        let how = format!("{}{sign}", if wide { "D" } else { "" });
        let pairs = words.windows(2).map(|pair| {
            let [a, b] = pair else { return Logic::wire() };
            self.contact(&how, &a.operand, &b.operand)
        });
        let logic = pairs.fold(Logic::wire(), Logic::then);
        self.flow_out(logic)
    }

    fn combine(&mut self) -> Result<Outputs, Failure> {
        let Some(flows) = self.flows()? else {
            return self.compute();
        };
        let logic = match self.name {
            "AND" => flows.into_iter().fold(Logic::wire(), Logic::then),
            "OR" => Logic::joined(flows),
            "NOT" => flows
                .into_iter()
                .fold(Logic::wire(), Logic::then)
                .changed("INV"),
            _ => flows
                .into_iter()
                .reduce(|a, b| {
                    let one = a.clone().then(b.clone().changed("INV"));
                    let other = a.changed("INV").then(b);
                    Logic::joined(vec![one, other])
                })
                .unwrap_or_else(Logic::wire),
        };
        if logic.size() > super::MOST_CONTACTS {
            return self.refuse("more contacts than a network holds", "divide it");
        }
        self.flow_out(logic)
    }

    /// A function whose result is a number, or a bit that MOVE and SEL pass on.
    fn compute(&mut self) -> Result<Outputs, Failure> {
        match (self.name, self.inputs.as_slice()) {
            ("MOVE", _) => {
                if let Some(flows) = self.flows()? {
                    return self.flow_out(flows.into_iter().fold(Logic::wire(), Logic::then));
                }
            }
            ("SEL", [Value::Flow(choice), off, on]) => {
                return match (off, on) {
                    (Value::Flow(off), Value::Flow(on)) if self.enable.is_wire() => {
                        let off = choice.clone().changed("INV").then(off.clone());
                        let ways = vec![off, choice.clone().then(on.clone())];
                        self.flow_out(Logic::joined(ways))
                    }
                    (Value::Word(off), Value::Word(on)) => {
                        let (choice, off, on) = (choice.clone(), off.clone(), on.clone());
                        self.select(&choice, &off, &on)
                    }
                    _ => self.refuse("bits and numbers meet here", "connect one or the other"),
                };
            }
            _ => {}
        }
        let words = self.words()?;
        let like = words.iter().find_map(|word| word.kind.clone());
        let to = self
            .drawing
            .destination(self.node, "OUT", &like.unwrap_or(Kind::Int))?;
        let mut all: Vec<_> = words.iter().collect();
        all.push(&to);
        let wide = wide(self.node, &all)?;
        let d = if wide { "D" } else { "" };
        let outputs = self.outputs(&to);
        match (self.name, words.as_slice()) {
            ("MOVE", [from]) => {
                self.line(format_smolstr!("{d}MOV {} {}", from.operand, to.operand))
            }
            ("NOT", [from]) => self.line(format_smolstr!("{d}CML {} {}", from.operand, to.operand)),
            ("ADD" | "SUB" | "AND" | "OR" | "XOR", [first, rest @ ..]) => {
                self.chain(d, first, rest, &to)?;
            }
            ("MUL" | "DIV" | "MOD", [first, rest @ ..]) => {
                self.ordered(&all)?;
                self.product(d, first, rest, &to)?;
            }
            ("LIMIT", [least, value, most]) => {
                self.ordered(&all)?;
                self.bounded(d, value, &[("<", least), (">", most)], &to)?;
            }
            ("MIN", [first, rest @ ..]) => {
                self.ordered(&all)?;
                let rest: Vec<_> = rest.iter().map(|word| (">", word)).collect();
                self.bounded(d, first, &rest, &to)?;
            }
            (_, [first, rest @ ..]) => {
                self.ordered(&all)?;
                let rest: Vec<_> = rest.iter().map(|word| ("<", word)).collect();
                self.bounded(d, first, &rest, &to)?;
            }
            _ => return self.refuse("its inputs do not fit", "connect as many as it has"),
        }
        Ok(outputs)
    }

    /// Outputs of the function: its result, and ENO, as long as the result does not change the enabling logic.
    fn outputs(&self, to: &Word) -> Outputs {
        let mut outputs = Outputs::from([("OUT".into(), Value::Word(to.clone()))]);
        if !self.enable.names(&to.operand) {
            outputs.insert("ENO".into(), Value::Flow(self.enable.clone()));
        }
        outputs
    }

    fn line(&mut self, line: SmolStr) {
        self.drawing.reader.output(self.enable.clone(), line);
    }

    /// Rejects a result that would overwrite what is read after it.
    fn apart(&self, to: &Word, read_later: &[&Word]) -> Result<(), Failure> {
        let overlaps = |word: &&&Word| word.kind.is_some() && overlap(to, word);
        match read_later.iter().find(overlaps) {
            Some(_) => {
                let help = "store the result in another variable";
                self.refuse("the result overwrites an input that is still read", help)
            }
            None => Ok(()),
        }
    }

    /// `a + b + c`: the result takes the place of the first two.
    fn chain(&mut self, d: &str, first: &Word, rest: &[Word], to: &Word) -> Result<(), Failure> {
        let mnemonic = match self.name {
            "AND" => "WAND",
            "OR" => "WOR",
            "XOR" => "WXOR",
            other => other,
        };
        self.apart(to, &rest.iter().skip(1).collect::<Vec<_>>())?;
        let mut from = first;
        for word in rest {
            let (a, b, to_here) = (&from.operand, &word.operand, &to.operand);
            self.line(format_smolstr!("{d}{mnemonic} {a} {b} {to_here}"));
            from = to;
        }
        Ok(())
    }

    fn product(&mut self, d: &str, first: &Word, rest: &[Word], to: &Word) -> Result<(), Failure> {
        let [second] = rest else {
            return self.refuse("more than two factors", "multiply two at a time");
        };
        let kind = if d.is_empty() { Kind::Int } else { Kind::Dint };
        // The PLC's product has twice the bits; a quotient is followed by its remainder.
        let space = self.drawing.register(self.node, "product", &kind, 2)?;
        let mnemonic = if self.name == "MUL" { "MUL" } else { "DIV" };
        let result = match (self.name, super::variables::device(&space.operand)) {
            ("MOD", Some(mut device)) => {
                device.number += if d.is_empty() { 1 } else { 2 };
                format_smolstr!("{device}")
            }
            _ => space.operand.clone(),
        };
        let (a, b) = (&first.operand, &second.operand);
        self.line(format_smolstr!("{d}{mnemonic} {a} {b} {}", space.operand));
        self.line(format_smolstr!("{d}MOV {result} {}", to.operand));
        Ok(())
    }

    /// A value that others replace where it compares so with them.
    fn bounded(
        &mut self,
        d: &str,
        value: &Word,
        bounds: &[(&str, &Word)],
        to: &Word,
    ) -> Result<(), Failure> {
        let later: Vec<_> = bounds.iter().map(|(_, bound)| *bound).collect();
        self.apart(to, &later)?;
        if self.enable.names(&to.operand) {
            return self.refuse("the result changes what enables it", "enable it by a relay");
        }
        self.line(format_smolstr!("{d}MOV {} {}", value.operand, to.operand));
        for (sign, bound) in bounds {
            let how = format!("{d}{sign}");
            let beyond = self.contact(&how, &to.operand, &bound.operand);
            let line = format_smolstr!("{d}MOV {} {}", bound.operand, to.operand);
            let logic = self.enable.clone().then(beyond);
            self.drawing.network(logic, vec![line]);
        }
        Ok(())
    }

    fn select(&mut self, choice: &Logic, off: &Word, on: &Word) -> Result<Outputs, Failure> {
        let like = on.kind.clone().or_else(|| off.kind.clone());
        let to = self
            .drawing
            .destination(self.node, "OUT", &like.unwrap_or(Kind::Int))?;
        let wide = wide(self.node, &[off, on, &to])?;
        self.apart(&to, &[on])?;
        if choice.names(&to.operand) || self.enable.names(&to.operand) {
            return self.refuse(
                "the result changes what it depends on",
                "store it elsewhere",
            );
        }
        let mnemonic = if wide { "DMOV" } else { "MOV" };
        for (choice, word) in [(choice.clone().changed("INV"), off), (choice.clone(), on)] {
            let logic = self.enable.clone().then(choice);
            let line = format_smolstr!("{mnemonic} {} {}", word.operand, to.operand);
            self.drawing.network(logic, vec![line]);
        }
        Ok(self.outputs(&to))
    }
}

/// Returns true if two registers, or pairs of them, overlap.
fn overlap(a: &Word, b: &Word) -> bool {
    let span = |word: &Word| {
        let device = super::variables::device(&word.operand)?;
        let count = if word.kind.as_ref().is_some_and(Kind::is_wide) {
            2
        } else {
            1
        };
        Some((device.class, device.number, device.number + count))
    };
    match (span(a), span(b)) {
        (Some(a), Some(b)) => a.0 == b.0 && a.1 < b.2 && b.1 < a.2,
        _ => false,
    }
}
