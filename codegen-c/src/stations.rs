//! Loops over rungs that the program repeats.

use crate::fields::PrintStorage;
use crate::page::Page;
use crate::writer::Writer;
use rungc_emit::plan::Stations;
use rungc_emit::stations::{self, Device};
use rungc_ir::node::Place;
use std::fmt::Write;

impl<'m> Writer<'_, 'm> {
    /// Writes a loop.
    pub(crate) fn station_loop(&mut self, page: &mut Page, stations: &Stations<'m>) {
        let (variable, count) = (self.loop_variable(), stations.count);
        page.set_off();
        page.comment(&stations::heading(stations));
        let invariants = stations::invariants(self.module, self.fields, stations);
        // Names are declared once in a block.
        let enclosed = !invariants.is_disjoint(&self.invariants_named);
        self.invariants_named.extend(&invariants);
        if enclosed {
            page.open("{");
        }
        for &device in &invariants {
            let mut line = String::from("const bool ");
            invariant_name(&mut line, device);
            line.push_str(" = ");
            self.fields.access(&mut line, device.0, device.1);
            line.push(';');
            page.line(&line);
        }
        let head = format!("for (unsigned {variable} = 0; {variable} < {count}; {variable}++) {{");
        page.open(&head);
        (self.iteration, self.iterations) = (variable, count);
        self.invariants = invariants;
        self.loops += 1;
        self.nodes(page, &stations.body);
        self.loops -= 1;
        self.invariants.clear();
        page.close();
        if enclosed {
            page.close();
        }
    }

    /// Writes the name of a bit that has been read before the loop around; false for any other.
    pub(crate) fn loop_invariant(&self, out: &mut String, place: &Place) -> bool {
        let device = (place.class, place.number);
        let is = place.index.is_none() && self.invariants.contains(&device);
        if is {
            invariant_name(out, device);
        }
        is
    }
}

fn invariant_name(out: &mut String, (class, number): Device) {
    let prefix = class.prefix();
    // Writing to a String does not fail.
    let _ = match class.is_octal() {
        true => write!(out, "{prefix}{number:o}"),
        false => write!(out, "{prefix}{number}"),
    };
}
