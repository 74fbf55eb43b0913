//! Layout of a network: its parts on a grid of rows and columns, as in the editors.
//!
//! Contacts follow each other from the left rail; branches lie below each other; coils and boxes lie at the right rail.
//! What is wider than the page continues on the rows below.

use crate::network::{Branch, Contact, InstrIndex, Item, Node, Output, Part};

/// Widths of cells in columns.
pub trait Measure {
    /// A contact or comparison; at least 1.
    fn contact(&self, contact: Contact) -> usize;
    /// A coil or box; at least 1.
    fn output(&self, output: Output) -> usize;
}

/// Contents of a cell.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Cell {
    /// A contact or comparison.
    Contact(Contact),
    /// INV, MEP, MEF.
    Result(InstrIndex),
    /// A coil or box.
    Output(Output),
    /// The row continues below, where this number appears again.
    FoldOut(usize),
    /// It continues here.
    FoldIn(usize),
}

/// Something on the grid.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Placed {
    /// Row, from 0 at the top.
    pub row: usize,
    /// Its first column.
    pub column: usize,
    /// Number of columns.
    pub span: usize,
    /// Contents.
    pub cell: Cell,
}

/// A network on its grid. Boundary `n` is the line to the left of column `n`: 0 is the left rail, the number of columns
/// the right one.
#[derive(Clone, Debug, Default)]
pub struct Grid {
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// Placed cells, by row and column.
    pub placed: Vec<Placed>,
    /// True for each cell with a wire through it, by row and column; cells with contents are not wires.
    wires: Vec<bool>,
    /// True for each wire that runs down from a row at a boundary, by row and boundary.
    downs: Vec<bool>,
}

impl Grid {
    /// Returns true if a wire runs through a cell that is otherwise empty.
    pub fn wire(&self, row: usize, column: usize) -> bool {
        self.wires[row * self.columns + column]
    }

    /// Returns true if a wire at a boundary runs from a row to the one below.
    pub fn down(&self, row: usize, boundary: usize) -> bool {
        self.downs[row * (self.columns + 1) + boundary]
    }

    /// Cells of a row, from left to right.
    pub fn row(&self, row: usize) -> &[Placed] {
        let start = self.placed.partition_point(|placed| placed.row < row);
        let rest = &self.placed[start..];
        &rest[..rest.partition_point(|placed| placed.row == row)]
    }
}

/// Lays a network out on at least `columns` columns, and on more only where its branches are wider.
pub fn lay_out(node: &Node, measure: &impl Measure, columns: usize) -> Grid {
    let mut sheet = Sheet {
        measure,
        placed: Vec::new(),
        wires: Vec::new(),
        downs: Vec::new(),
        outputs: Vec::new(),
    };
    let rows = sheet.folded(node, columns);
    sheet.grid(rows, columns)
}

/// A grid whose size is not known yet.
struct Sheet<'a, M> {
    measure: &'a M,
    placed: Vec<Placed>,
    /// Row, first column, end.
    wires: Vec<(usize, usize, usize)>,
    /// Boundary, first row, last row.
    downs: Vec<(usize, usize, usize)>,
    /// Outputs with their row and the column where their wire starts.
    outputs: Vec<(Output, usize, usize)>,
}

impl<M: Measure> Sheet<'_, M> {
    /// Places the node at the rail, folded to a page; how many rows it takes.
    fn folded(&mut self, node: &Node, columns: usize) -> usize {
        let mut row = 0;
        let mut column = 0;
        let mut height = 1;
        let mut folds = 0;
        let mut parts = Vec::new();
        flatten(&node.series, &mut parts);
        let (needed, _) = self.items_size(node);
        for (i, part) in parts.iter().enumerate() {
            let (width, _) = self.part_size(part);
            // The next element needs space: the mark of a fold, or the outputs.
            let after = if i + 1 == parts.len() { needed } else { 1 };
            if column > 1 && column + width + after > columns {
                self.put(row, column, 1, Cell::FoldOut(folds));
                row += height;
                self.put(row, 0, 1, Cell::FoldIn(folds));
                (column, height) = (1, 1);
                folds += 1;
            }
            let (width, part_height) = self.part(part, row, column);
            column += width;
            height = height.max(part_height);
        }
        row + height.max(self.items(node, row, column))
    }

    fn put(&mut self, row: usize, column: usize, span: usize, cell: Cell) {
        self.placed.push(Placed {
            row,
            column,
            span,
            cell,
        });
    }

    /// Places a node whose contacts start at a cell; how many rows it takes.
    fn node(&mut self, node: &Node, row: usize, column: usize) -> usize {
        let (width, height) = self.series(&node.series, row, column);
        height.max(self.items(node, row, column + width))
    }

    /// Places what is connected to a node at a boundary.
    fn items(&mut self, node: &Node, row: usize, boundary: usize) -> usize {
        let mut below = row;
        let mut last = row;
        for item in &node.items {
            match item {
                Item::Output(output) => {
                    self.outputs.push((*output, below, boundary));
                    last = below;
                    below += 1;
                }
                Item::Continue(next) => {
                    last = below;
                    below += self.node(next, below, boundary);
                }
                Item::Stack(branches) => {
                    for branch in branches {
                        last = below;
                        below += self.node(branch, below, boundary);
                    }
                }
            }
        }
        self.downs.push((boundary, row, last));
        below - row
    }

    /// Columns and rows of parts in series, placed.
    fn series(&mut self, series: &[Part], row: usize, column: usize) -> (usize, usize) {
        let mut width = 0;
        let mut height = 1;
        for part in series {
            let (columns, rows) = self.part(part, row, column + width);
            width += columns;
            height = height.max(rows);
        }
        (width, height)
    }

    fn part(&mut self, part: &Part, row: usize, column: usize) -> (usize, usize) {
        match part {
            Part::Contact(contact) => {
                let span = self.measure.contact(*contact);
                self.put(row, column, span, Cell::Contact(*contact));
                (span, 1)
            }
            Part::Result(instr) => {
                self.put(row, column, 1, Cell::Result(*instr));
                (1, 1)
            }
            Part::Group(series) => self.series(series, row, column),
            Part::Parallel(branches) => self.parallel(branches, row, column),
        }
    }

    fn parallel(&mut self, branches: &[Branch], row: usize, column: usize) -> (usize, usize) {
        let mut below = row;
        let mut ends = Vec::with_capacity(branches.len());
        for branch in branches {
            let (width, height) = self.series(&branch.series, below, column);
            ends.push((below, width));
            below += height;
        }
        let width = ends.iter().map(|end| end.1).max().unwrap_or(0);
        let last = ends.last().map_or(row, |end| end.0);
        for (row, end) in ends {
            self.wires.push((row, column + end, column + width));
        }
        self.downs.push((column, row, last));
        self.downs.push((column + width, row, last));
        (width, below - row)
    }

    /// Columns and rows of a part, without placing it.
    fn part_size(&self, part: &Part) -> (usize, usize) {
        match part {
            Part::Contact(contact) => (self.measure.contact(*contact), 1),
            Part::Result(_) => (1, 1),
            Part::Group(series) => self.series_size(series),
            Part::Parallel(branches) => {
                let sizes = branches
                    .iter()
                    .map(|branch| self.series_size(&branch.series));
                sizes.fold((0, 0), |(width, height), (w, h)| (width.max(w), height + h))
            }
        }
    }

    fn series_size(&self, series: &[Part]) -> (usize, usize) {
        let sizes = series.iter().map(|part| self.part_size(part));
        sizes.fold((0, 1), |(width, height), (w, h)| (width + w, height.max(h)))
    }

    /// Columns and rows of what is connected to a node.
    fn items_size(&self, node: &Node) -> (usize, usize) {
        let mut size = (0, 0);
        let mut add = |(width, height): (usize, usize)| size = (size.0.max(width), size.1 + height);
        for item in &node.items {
            match item {
                Item::Output(output) => add((self.measure.output(*output), 1)),
                Item::Continue(next) => add(self.node_size(next)),
                Item::Stack(branches) => branches
                    .iter()
                    .for_each(|branch| add(self.node_size(branch))),
            }
        }
        size
    }

    fn node_size(&self, node: &Node) -> (usize, usize) {
        let (width, height) = self.series_size(&node.series);
        let (more, rows) = self.items_size(node);
        (width + more, height.max(rows))
    }

    /// The finished grid: outputs at the right rail, wires to them.
    fn grid(mut self, rows: usize, columns: usize) -> Grid {
        let ends = self.placed.iter().map(|placed| placed.column + placed.span);
        let outputs = self.outputs.iter();
        let outputs = outputs.map(|(output, _, from)| from + self.measure.output(*output));
        let columns = ends.chain(outputs).fold(columns.max(1), usize::max);
        for (output, row, from) in std::mem::take(&mut self.outputs) {
            let span = self.measure.output(output);
            self.wires.push((row, from, columns - span));
            self.put(row, columns - span, span, Cell::Output(output));
        }
        self.placed
            .sort_by_key(|placed| (placed.row, placed.column));
        let mut grid = Grid {
            rows,
            columns,
            placed: self.placed,
            wires: vec![false; rows * columns],
            downs: vec![false; rows * (columns + 1)],
        };
        for (row, from, end) in self.wires {
            grid.wires[row * columns + from..row * columns + end].fill(true);
        }
        for (boundary, first, last) in self.downs {
            for row in first..last {
                grid.downs[row * (columns + 1) + boundary] = true;
            }
        }
        grid
    }
}

/// Parts in series, with groups taken apart.
fn flatten<'a>(series: &'a [Part], parts: &mut Vec<&'a Part>) {
    for part in series {
        match part {
            Part::Group(series) => flatten(series, parts),
            Part::Contact(_) | Part::Result(_) | Part::Parallel(_) => parts.push(part),
        }
    }
}
