//! A program as an instruction list.

use super::{Action, Chain, Contact, Device, Ladder, Operation, sequence};
use std::fmt::Write;

/// The program's instructions, one a line.
pub fn list(ladder: &Ladder) -> String {
    let mut out = String::new();
    sequence::list(&ladder.sequences, &mut out);
    for rung in &ladder.rungs {
        chain(&mut out, &rung.chain);
        if let Some((block, parallel)) = &rung.block {
            chain(&mut out, block);
            out.push_str(if *parallel { "ORB\n" } else { "ANB\n" });
        }
        action(&mut out, &rung.action);
    }
    out.push_str("END\n");
    out
}

/// A device's name: terminals are numbered in octal.
pub fn name((class, number): Device) -> String {
    let prefix = class.prefix();
    match class.is_octal() {
        true => format!("{prefix}{number:03o}"),
        false => format!("{prefix}{number}"),
    }
}

fn chain(out: &mut String, chain: &Chain) {
    contact(out, "LD", &chain.first);
    for (next, parallel) in &chain.rest {
        contact(out, if *parallel { "OR" } else { "AND" }, next);
    }
}

/// LD, AND or OR of a contact.
pub fn contact(out: &mut String, mnemonic: &str, contact: &Contact) {
    // ANDI is written ANI.
    let mnemonic = match (mnemonic, contact.negated) {
        (_, false) => mnemonic,
        ("LD", true) => "LDI",
        ("OR", true) => "ORI",
        (_, true) => "ANI",
    };
    // Writing to a String does not fail.
    let _ = writeln!(out, "{mnemonic} {}", name(contact.device));
}

fn action(out: &mut String, action: &Action) {
    let _ = match *action {
        Action::Coil(device) => writeln!(out, "OUT {}", name(device)),
        Action::Timer(n, preset) => writeln!(out, "OUT T{n} K{preset}"),
        Action::Counter(n, preset) => writeln!(out, "OUT C{n} K{preset}"),
        Action::Constant(value, to) => writeln!(out, "MOV K{value} D{to}"),
        Action::MoveOnce(from, to) => writeln!(out, "MOVP D{from} D{to}"),
        Action::IncrementOnce(n) => writeln!(out, "INCP D{n}"),
        Action::Compare(register, value, relay) => {
            writeln!(out, "CMP D{register} K{value} M{relay}")
        }
        Action::Arithmetic(operation, [a, b, to]) => {
            let mnemonic = match operation {
                Operation::Add => "ADD",
                Operation::Sub => "SUB",
                Operation::And => "WAND",
                Operation::AddLong => "DADD",
            };
            writeln!(out, "{mnemonic} D{a} D{b} D{to}")
        }
        Action::Set(n) => writeln!(out, "SET M{n}"),
        Action::Reset(n) => writeln!(out, "RST M{n}"),
        Action::Process(process) => {
            process.list(out);
            Ok(())
        }
        Action::Driven(ref driven, coil) => {
            out.push_str(&driven.list);
            let mut coils = coil.iter();
            coils.try_for_each(|coil| writeln!(out, "OUT {}", name(*coil)))
        }
        Action::Control(control) => {
            control.list(out);
            Ok(())
        }
    };
}
