//! The networks of a program as an instruction list of IEC 61131-3.
//!
//! MPS, MRD and MPP keep a result in a variable `MPS_1`, …, and a function of words is executed under the condition
//! that `JMPCN` tests, which jumps over it to `SKIP_1`, ….

use super::Refused;
use super::words::{Drive, Gate, Words};
use rungc_catalogue::Basic;
use rungc_ladder::list::Entry;
use rungc_ladder::{Branch, Contact, Item, Join, Ladder, NetworkBody, Node, Output, Part};
use std::fmt::Write as _;

/// A list while it is written.
pub(super) struct Lines<'s, 'a> {
    pub text: String,
    /// Number of variables that store a result.
    pub kept: usize,
    words: &'s mut Words<'a>,
    /// Number of jumps that skip a function.
    skips: usize,
}

impl<'s, 'a> Lines<'s, 'a> {
    pub fn new(words: &'s mut Words<'a>) -> Self {
        Lines::continued(words, 0)
    }

    /// A list in which results are kept after those of others.
    pub fn continued(words: &'s mut Words<'a>, kept: usize) -> Self {
        Lines {
            text: String::new(),
            kept,
            words,
            skips: 0,
        }
    }

    /// Writes all networks; gives the first that has no structure.
    pub fn write(&mut self, ladder: &Ladder) -> Result<(), Refused> {
        for network in &ladder.networks {
            let first = network.instrs.start;
            let remarks = self.words.remarks(network.instrs.clone());
            self.comments(&remarks);
            for at in first..first + network.labels {
                let name = &self.words.instr(at).mnemonic;
                match name.starts_with('P') {
                    true => self.line(format_args!("{name}:")),
                    false => {
                        self.line("LD TRUE");
                        self.line(format_args!("FX_{name}"));
                    }
                }
            }
            match &network.body {
                NetworkBody::List { why } => return Err(Refused::network(first, why)),
                NetworkBody::Rung(node) if node.items.is_empty() => {}
                NetworkBody::Rung(node) if self.words.is_end(node) => {}
                NetworkBody::Rung(node) => self.node(node, Entry::Ld),
            }
        }
        let closing = self.words.closing(ladder);
        self.comments(&closing);
        Ok(())
    }

    fn comments(&mut self, lines: &[&str]) {
        for line in lines {
            // A comment ends at the first `*)`.
            let line = line.replace("*)", "* )");
            self.line(format_args!("(* {} *)", line.trim()));
        }
    }

    fn line(&mut self, line: impl std::fmt::Display) {
        let _ = writeln!(self.text, "{line}");
    }

    /// Contacts and what they feed.
    pub fn node(&mut self, node: &Node, entry: Entry) {
        if node.series.is_empty() && entry == Entry::Ld {
            self.line("LD TRUE");
        }
        self.series(&node.series, entry);
        let loses = |item: &Item, words: &mut Words| match item {
            Item::Output(output) => matches!(words.output(*output), Drive::Compute { .. }),
            Item::Stack(branches) => branches.len() > 1,
            Item::Continue(_) => false,
        };
        let (last, before) = node.items.split_last().expect("a node feeds something");
        let is_stack = matches!(last, Item::Stack(_));
        let keeps = before.iter().any(|item| loses(item, self.words))
            || is_stack && loses(last, self.words);
        let kept = keeps.then(|| {
            self.kept += 1;
            let name = format!("MPS_{}", self.kept);
            self.line(format_args!("ST {name}"));
            name
        });
        let mut lost = false;
        for item in &node.items {
            if let (true, Some(name)) = (lost, &kept) {
                self.line(format_args!("LD {name}"));
            }
            lost = loses(item, self.words);
            match item {
                Item::Output(output) => self.output(*output),
                Item::Continue(next) => self.node(next, Entry::And),
                Item::Stack(branches) => {
                    for (nth, branch) in branches.iter().enumerate() {
                        if let (1.., Some(name)) = (nth, &kept) {
                            self.line(format_args!("LD {name}"));
                        }
                        self.node(branch, Entry::And);
                    }
                }
            }
        }
    }

    /// Parts in series, of which the first contact has this entry.
    pub fn series(&mut self, series: &[Part], mut entry: Entry) {
        for part in series {
            match part {
                Part::Contact(contact) => self.contact(*contact, entry),
                Part::Result(at) if self.words.basic(*at) == Some(Basic::Inv) => self.line("NOT"),
                Part::Result(at) => {
                    let name = self.words.special(&self.words.instr(*at).mnemonic);
                    self.line(format_args!("FX_{name}"));
                }
                Part::Parallel(branches) if entry == Entry::Ld => self.parallel(branches),
                Part::Parallel(branches) => {
                    self.nested(entry, |lines| lines.parallel(branches));
                }
                Part::Group(parts) => {
                    self.nested(entry, |lines| lines.series(parts, Entry::Ld));
                }
            }
            entry = Entry::And;
        }
    }

    fn parallel(&mut self, branches: &[Branch]) {
        for branch in branches {
            match (branch.join, &branch.series[..]) {
                (Join::First, series) => self.series(series, Entry::Ld),
                (Join::Or, series) => self.series(series, Entry::Or),
                (Join::Block, series) => {
                    self.nested(Entry::Or, |lines| lines.series(series, Entry::Ld));
                }
            }
        }
    }

    /// A block in parentheses, or as it is where it begins the list.
    pub fn nested(&mut self, entry: Entry, inside: impl FnOnce(&mut Self)) {
        if entry == Entry::Ld {
            return inside(self);
        }
        self.line(format_args!("{}(", operator(entry)));
        inside(self);
        self.line(")");
    }

    fn contact(&mut self, contact: Contact, entry: Entry) {
        match self.words.contact(contact) {
            Gate::Contact {
                variable,
                negated,
                edge: "none",
            } => {
                let not = if negated { "N" } else { "" };
                self.line(format_args!("{}{not} {variable}", operator(entry)));
            }
            Gate::Contact { variable, edge, .. } => {
                let mnemonic = if edge == "rising" { "LDP" } else { "LDF" };
                let mnemonic = self.words.special(mnemonic);
                self.nested(entry, |lines| lines.call(&mnemonic, &[variable]));
            }
            Gate::Compare { function, words } => self.nested(entry, |lines| {
                lines.line(format_args!("LD {}", words[0]));
                lines.line(format_args!("{function} {}", words[1]));
            }),
            Gate::Special { mnemonic, operands } => {
                self.nested(entry, |lines| lines.call(&mnemonic, &operands));
            }
        }
    }

    /// A function that gives a bit.
    fn call(&mut self, mnemonic: &str, operands: &[String]) {
        self.line(format_args!("FX_{mnemonic}("));
        let named = (1..).zip(operands);
        let named: Vec<_> = named
            .map(|(n, operand)| format!("p{n} := {operand}"))
            .collect();
        self.line(named.join(",\n"));
        self.line(")");
    }

    /// Writes an output driven by the result.
    pub fn output(&mut self, output: Output) {
        match self.words.output(output) {
            Drive::Coil {
                variable,
                storage,
                edge: "none",
            } => {
                let operator = match storage {
                    "set" => "S",
                    "reset" => "R",
                    _ => "ST",
                };
                self.line(format_args!("{operator} {variable}"));
            }
            Drive::Coil { variable, edge, .. } => {
                let mnemonic = if edge == "rising" { "PLS" } else { "PLF" };
                let mnemonic = self.words.special(mnemonic);
                self.line(format_args!("FX_{mnemonic} {variable}"));
            }
            Drive::Timer { timer, preset } => {
                self.line(format_args!("ST {timer}.IN"));
                self.line(format_args!("CAL {timer}(\nPT := T#{preset}ms\n)"));
            }
            Drive::Jump(to) => self.line(format_args!("JMPC {to}")),
            Drive::Compute {
                function,
                words,
                to,
            } => {
                self.skips += 1;
                let skip = format!("SKIP_{}", self.skips);
                self.line(format_args!("JMPCN {skip}\nLD {}", words[0]));
                if let Some(word) = words.get(1) {
                    self.line(format_args!("{function} {word}"));
                }
                self.line(format_args!("ST {to}\n{skip}:"));
            }
            Drive::Special { mnemonic, operands } => {
                let operands = operands.join(", ");
                self.line(
                    format_args!("FX_{mnemonic} {operands}")
                        .to_string()
                        .trim_end(),
                );
            }
        }
    }
}

/// Operator by which a contact or block joins the result before it.
const fn operator(entry: Entry) -> &'static str {
    match entry {
        Entry::Ld => "LD",
        Entry::And => "AND",
        Entry::Or => "OR",
    }
}
