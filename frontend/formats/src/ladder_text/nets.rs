//! Connected cells of a drawing.

use std::collections::HashMap;

/// Cells of wires that hang together.
#[derive(Default)]
pub(super) struct Nets {
    numbers: HashMap<(usize, usize), usize>,
    parents: Vec<usize>,
}

impl Nets {
    pub(super) fn fresh(&mut self) -> usize {
        self.parents.push(self.parents.len());
        self.parents.len() - 1
    }

    /// The wire of a cell.
    pub(super) fn cell(&mut self, row: usize, column: usize) -> usize {
        let known = self.numbers.get(&(row, column)).copied();
        let number = known.unwrap_or_else(|| {
            let number = self.fresh();
            self.numbers.insert((row, column), number);
            number
        });
        self.root(number)
    }

    pub(super) fn root(&mut self, mut number: usize) -> usize {
        while let Some(&parent) = self.parents.get(number).filter(|parent| **parent != number) {
            let grand = self.parents[parent];
            self.parents[number] = grand;
            number = grand;
        }
        number
    }

    pub(super) fn join(&mut self, a: (usize, usize), b: (usize, usize)) {
        let (a, b) = (self.cell(a.0, a.1), self.cell(b.0, b.1));
        self.merge(a, b);
    }

    pub(super) fn merge(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.parents[a] = b;
    }
}
