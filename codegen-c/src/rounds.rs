//! Loops over rungs that the program repeats.

use crate::fields::PrintStorage;
use crate::plan::Node;
use crate::writer::Writer;
use crate::{text, walk};
use rungc_emit::storage::Kind;
use rungc_ir::node::{Expr, ExprId, Place, Stmt};
use rungc_ir::walk::for_exprs;
use rungc_syntax::DeviceClass;
use std::collections::HashSet;
use std::fmt::Write;

/// Class and number.
pub type Device = (DeviceClass, u32);

impl<'m> Writer<'_, 'm> {
    /// Writes a loop.
    pub fn rounds(
        &mut self,
        out: &mut String,
        (count, (first, last)): (u32, (u32, u32)),
        body: &[Node<'m>],
        indent: usize,
    ) {
        let variable = self.loop_variable();
        if !out.ends_with("{\n") {
            out.push('\n');
        }
        let comment = format!(
            "/* steps {first} to {last}: {count} times the same rungs, each time with the next devices */"
        );
        text::line(out, indent, &comment, None);
        let constants = self.constants(body);
        // Names are declared once in a block.
        let enclosed = !constants.is_disjoint(&self.constants_named);
        self.constants_named.extend(&constants);
        if enclosed {
            text::line(out, indent, "{", None);
        }
        let indent = if enclosed { indent + 4 } else { indent };
        let mut sorted: Vec<Device> = constants.iter().copied().collect();
        sorted.sort_unstable();
        for device in sorted {
            let mut line = String::from("const bool ");
            constant_name(&mut line, device);
            line.push_str(" = ");
            self.fields.access(&mut line, device.0, device.1);
            line.push(';');
            text::line(out, indent, &line, None);
        }
        let head = format!("for (unsigned {variable} = 0; {variable} < {count}; {variable}++) {{");
        text::line(out, indent, &head, None);
        (self.round, self.rounds) = (variable, count);
        self.constants = constants;
        self.loops += 1;
        self.nodes(out, body, indent + 4);
        self.loops -= 1;
        self.constants.clear();
        text::line(out, indent, "}", None);
        if enclosed {
            text::line(out, indent - 4, "}", None);
        }
    }

    /// Bits that a loop only reads, and that are the same in all of its rounds. They are read before it: clang makes no vectors if they
    /// stand behind an array in memory to which the loop writes.
    fn constants(&self, body: &[Node]) -> HashSet<Device> {
        let (mut roots, mut written) = (Vec::new(), HashSet::new());
        collect(body, &mut roots, &mut written);
        let (mut below, mut all) = (Vec::new(), Vec::new());
        for root in roots {
            walk::below(self.module, root, &mut below);
            all.append(&mut below);
        }
        let devices = all.iter().filter_map(|&id| match *self.module.expr(id) {
            Expr::ReadBit(place) if place.index.is_none() => Some((place.class, place.number)),
            _ => None,
        });
        devices
            .filter(|device| !written.contains(device))
            .filter(|&(class, number)| {
                let field = self.fields.find(class, number);
                field.is_some_and(|field| field.kind == Kind::Bit)
            })
            .collect()
    }

    /// Writes the name of a bit that has been read before the loop around; false for any other.
    pub fn constant_of_rounds(&self, out: &mut String, place: &Place) -> bool {
        let device = (place.class, place.number);
        let is = place.index.is_none() && self.constants.contains(&device);
        if is {
            constant_name(out, device);
        }
        is
    }
}

/// The expressions that statements evaluate, and the bits that they write by name.
fn collect(nodes: &[Node], roots: &mut Vec<ExprId>, written: &mut HashSet<Device>) {
    for node in nodes {
        match node {
            Node::Stmt(stmt) => {
                for_exprs(stmt, &mut |&root| roots.push(root));
                if let Stmt::WriteBit(place, _) = stmt {
                    written.insert((place.class, place.number));
                }
            }
            Node::If {
                cond,
                then,
                otherwise,
            } => {
                roots.push(*cond);
                collect(then, roots, written);
                collect(otherwise, roots, written);
            }
            Node::For { .. } | Node::Repeat { .. } | Node::Parts { .. } | Node::Stretch(_) => {}
        }
    }
}

fn constant_name(out: &mut String, (class, number): Device) {
    let prefix = class.prefix();
    // Writing to a String does not fail.
    let _ = match class.is_octal() {
        true => write!(out, "{prefix}{number:o}"),
        false => write!(out, "{prefix}{number}"),
    };
}
