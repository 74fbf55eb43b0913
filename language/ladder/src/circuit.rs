//! Flow of power in a drawn network: its nets, each consisting of connected wires, and the cells between them.
//!
//! Power flows from left to right, as the list computes it; it never flows back through a branch.

use crate::layout::{Cell, Grid};

/// A contact, result, coil or box with the nets on both sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Link {
    /// Cell between the nets.
    pub cell: Cell,
    /// The net to its left.
    pub from: usize,
    /// The net to its right; none right of a coil or box.
    pub to: Option<usize>,
}

/// The circuit of a network. Nets have numbers from 0, the left rail.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Circuit {
    /// Number of nets.
    pub nets: usize,
    /// The cells, each after those that feed it.
    pub links: Vec<Link>,
    /// The net of each crossing of a row's wire and a boundary.
    crossings: Vec<usize>,
    columns: usize,
    /// By what lies on the grid: which link it is.
    placed: Vec<Option<usize>>,
}

impl Circuit {
    /// The circuit that a grid draws.
    pub(crate) fn of(grid: &Grid) -> Circuit {
        let mut nets = Nets::new(grid);
        nets.connect(grid);
        let (crossings, count) = nets.numbered();
        let columns = grid.columns;
        let net = |row, boundary| crossings[row * (columns + 1) + boundary];
        let mut order: Vec<usize> = (0..grid.placed.len())
            .filter(|&i| !matches!(grid.placed[i].cell, Cell::FoldOut(_) | Cell::FoldIn(_)))
            .collect();
        let bands = bands(grid);
        order.sort_by_key(|&i| {
            let placed = grid.placed[i];
            (bands[placed.row], placed.column)
        });
        let mut placed = vec![None; grid.placed.len()];
        let mut links = Vec::with_capacity(order.len());
        for i in order {
            let at = grid.placed[i];
            let is_output = matches!(at.cell, Cell::Output(_));
            placed[i] = Some(links.len());
            links.push(Link {
                cell: at.cell,
                from: net(at.row, at.column),
                to: (!is_output).then(|| net(at.row, at.column + at.span)),
            });
        }
        Circuit {
            nets: count,
            links,
            crossings,
            columns,
            placed,
        }
    }

    /// The net of the crossing of a row's wire and a boundary.
    pub(crate) fn net(&self, row: usize, boundary: usize) -> usize {
        self.crossings[row * (self.columns + 1) + boundary]
    }

    /// The number of the link that the `placed`-th cell of the grid is; none if the cell is a mark of a fold.
    pub(crate) fn link(&self, placed: usize) -> Option<usize> {
        self.placed[placed]
    }
}

/// Number of folds above or at each row: cells fed by a row are in the same band or in a later one.
fn bands(grid: &Grid) -> Vec<usize> {
    let mut bands = vec![0; grid.rows];
    for placed in &grid.placed {
        if matches!(placed.cell, Cell::FoldIn(_)) {
            bands[placed.row..].iter_mut().for_each(|band| *band += 1);
        }
    }
    bands
}

/// Crossings that are being connected: each leads to another one of its net, the last to itself.
struct Nets {
    leads_to: Vec<usize>,
    /// True if a wire or a cell ends there.
    used: Vec<bool>,
    columns: usize,
}

impl Nets {
    fn new(grid: &Grid) -> Self {
        let count = grid.rows * (grid.columns + 1);
        Nets {
            leads_to: (0..count).collect(),
            used: vec![false; count],
            columns: grid.columns,
        }
    }

    fn crossing(&self, row: usize, boundary: usize) -> usize {
        row * (self.columns + 1) + boundary
    }

    fn root(&self, mut crossing: usize) -> usize {
        while self.leads_to[crossing] != crossing {
            crossing = self.leads_to[crossing];
        }
        crossing
    }

    fn join(&mut self, a: (usize, usize), b: (usize, usize)) {
        let [a, b] = [a, b].map(|(row, boundary)| self.root(self.crossing(row, boundary)));
        // The first one of a net is its root, so the rail stays number 0.
        self.leads_to[a.max(b)] = a.min(b);
        self.used[a.min(b)] = true;
    }

    fn connect(&mut self, grid: &Grid) {
        let mut folds = Vec::new();
        let mut folded = vec![false; grid.rows];
        for placed in &grid.placed {
            match placed.cell {
                Cell::FoldOut(fold) => folds.push((fold, (placed.row, placed.column))),
                Cell::FoldIn(fold) => {
                    folded[placed.row] = true;
                    let out = folds.iter().find(|(number, _)| *number == fold);
                    if let Some(&(_, out)) = out {
                        self.join(out, (placed.row, placed.column + placed.span));
                        self.join(out, (placed.row, placed.column));
                    }
                }
                Cell::Contact(_) | Cell::Result(_) | Cell::Output(_) => {}
            }
            let start = self.crossing(placed.row, placed.column);
            self.used[start] = true;
            if !matches!(placed.cell, Cell::Output(_)) {
                self.used[start + placed.span] = true;
            }
        }
        for (row, is_folded) in folded.into_iter().enumerate() {
            if !is_folded {
                self.join((0, 0), (row, 0));
            }
            for column in (0..grid.columns).filter(|&column| grid.wire(row, column)) {
                self.join((row, column), (row, column + 1));
            }
            let below = (1..=grid.columns).filter(|&boundary| grid.down(row, boundary));
            for boundary in below {
                self.join((row, boundary), (row + 1, boundary));
            }
        }
    }

    /// The number of each crossing's net, and how many nets there are. Crossings that nothing touches are put to the
    /// rail.
    fn numbered(&self) -> (Vec<usize>, usize) {
        let mut numbers = vec![None; self.leads_to.len()];
        numbers[0] = Some(0);
        let mut count = 1;
        let crossings = (0..self.leads_to.len()).map(|crossing| {
            let root = self.root(crossing);
            if !self.used[crossing] && !self.used[root] {
                return 0;
            }
            *numbers[root].get_or_insert_with(|| {
                count += 1;
                count - 1
            })
        });
        let crossings = crossings.collect();
        (crossings, count)
    }
}
