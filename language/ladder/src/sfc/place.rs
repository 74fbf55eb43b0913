//! Layout of a chart, in columns and lines of characters.
//!
//! A flow runs down a line. Where it divides, its branches lie side by side, and meet again at the state or transition
//! that most of them lead to. Each state is placed once; what leads to one that lies elsewhere is an arrow with its
//! name. So the chart is complete whatever the program does, and tidy where the program is.

use super::Chart;
use crate::face::fold;
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use unicode_width::UnicodeWidthStr;

/// Columns of a state's box.
pub(super) const BOX: usize = 9;
/// From the left edge of a branch to its line.
const SPINE: usize = 4;
/// Columns of a line of text before it is folded, on a page that is wide enough.
const ROOM: usize = 40;
/// Columns of a line of text on narrower pages, one after another.
const NARROW: [usize; 3] = [28, 20, 14];
/// Maximum nesting of divergences; beyond, arrows lead on to flows further below.
const DEEPEST: usize = 100;

/// A part of a chart. Columns and lines count from 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Piece {
    /// The box of a state: its upper left corner. It has three lines.
    State { x: usize, y: usize, state: usize },
    /// The bar of a transition.
    Bar { x: usize, y: usize },
    /// A line of text.
    Text { x: usize, y: usize, text: Words },
    /// An arrow to a state that lies elsewhere.
    Arrow {
        x: usize,
        y: usize,
        states: Vec<usize>,
    },
    /// A line between two places; double where branches run together.
    Down { x: usize, from: usize, to: usize },
    Across {
        y: usize,
        from: usize,
        to: usize,
        double: bool,
    },
}

/// Content of a line of text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Words {
    /// The name of a state.
    Name(String),
    /// A line of the action of a state.
    Action(String, usize, usize),
    /// A line of a condition, or of a remark.
    Plain(String),
}

/// A placed chart.
pub(super) struct Sheet {
    pub pieces: Vec<Piece>,
    pub width: usize,
    pub height: usize,
}

#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
enum Point {
    State(usize),
    Transition(usize),
}

/// Extent of a branch.
struct Run {
    width: usize,
    /// The line below it.
    bottom: usize,
    /// True if it ends at the meeting point of the branches.
    open: bool,
    /// The states at its end.
    last: Vec<usize>,
}

/// Branches side by side.
struct Fork {
    run: Run,
    /// Meeting point, if it is not that of the surrounding branches.
    meets: Option<Point>,
}

/// Places a chart.
pub(super) fn place(chart: &Chart) -> Sheet {
    place_in(chart, ROOM, usize::MAX)
}

/// Places a chart on a page of some columns: lines of text become shorter, and where that is not enough, branches that
/// have no room beside the others continue below.
pub(super) fn place_within(chart: &Chart, columns: usize) -> Sheet {
    let rooms = [ROOM].into_iter().chain(NARROW);
    let mut sheets = rooms.map(|room| place_in(chart, room, usize::MAX));
    let fits = sheets.find(|sheet| sheet.width <= columns);
    fits.unwrap_or_else(|| place_in(chart, NARROW[1], columns))
}

fn place_in(chart: &Chart, room: usize, columns: usize) -> Sheet {
    let mut leaving = vec![Vec::new(); chart.states.len()];
    for (t, transition) in chart.transitions.iter().enumerate() {
        transition
            .from
            .iter()
            .for_each(|&from| leaving[from].push(t));
    }
    let mut placer = Placer {
        chart,
        leaving,
        pieces: Vec::new(),
        placed: vec![false; chart.states.len()],
        drawn: vec![false; chart.transitions.len()],
        stops: Vec::new(),
        depth: 0,
        room,
        columns,
        below: VecDeque::new(),
    };
    let mut width = 0;
    let mut y = 0;
    for root in roots(chart) {
        if placer.placed[root] {
            continue;
        }
        let run = placer.flow(root, y);
        width = width.max(run.width);
        y = run.bottom + 1;
        while let Some((above, branches)) = placer.below.pop_front() {
            let run = placer.continued(&above, &branches, y);
            width = width.max(run.width);
            y = run.bottom + 1;
        }
    }
    let remarks = placer.remarks();
    if remarks.is_empty() {
        y -= 1;
    }
    for remark in remarks {
        for line in fold(&remark, (2 * ROOM).min(columns), usize::MAX) {
            width = width.max(line.width());
            placer.text(0, y, Words::Plain(line));
            y += 1;
        }
    }
    Sheet {
        pieces: placer.pieces,
        width,
        height: y,
    }
}

/// The states in the order in which flows begin: initial ones, those that no other leads to, the rest.
fn roots(chart: &Chart) -> Vec<usize> {
    let mut led_to = vec![false; chart.states.len()];
    for transition in chart
        .transitions
        .iter()
        .filter(|made| !made.from.is_empty())
    {
        transition.to.iter().for_each(|&to| led_to[to] = true);
    }
    let mut order: Vec<usize> = (0..chart.states.len()).collect();
    order.sort_by_key(|&state| (!chart.states[state].is_initial(), led_to[state]));
    order
}

struct Placer<'a> {
    chart: &'a Chart,
    /// The transitions that leave each state.
    leaving: Vec<Vec<usize>>,
    pieces: Vec<Piece>,
    placed: Vec<bool>,
    drawn: Vec<bool>,
    /// Meeting points of the surrounding branches, the innermost last.
    stops: Vec<Point>,
    /// Number of surrounding divergences.
    depth: usize,
    /// Columns of a line of text.
    room: usize,
    /// Columns of the page.
    columns: usize,
    /// Branches that continue below, and the states that their heading names.
    below: VecDeque<(Vec<usize>, Vec<Point>)>,
}

impl Placer<'_> {
    /// A flow that begins with a state, from a line on.
    fn flow(&mut self, root: usize, y: usize) -> Run {
        let entries = self.chart.transitions.iter().enumerate();
        let entries = entries.filter(|(_, entry)| entry.from.is_empty() && entry.to == [root]);
        let (entries, conditions): (Vec<usize>, Vec<&str>) = entries
            .map(|(t, entry)| (t, entry.condition.as_str()))
            .unzip();
        if entries.is_empty() {
            return self.chain(Point::State(root), (0, y), &[], false);
        }
        entries.iter().for_each(|&t| self.drawn[t] = true);
        let (width, bottom) = self.bar(&conditions.join(" + "), 0, y, false);
        let run = self.chain(Point::State(root), (0, bottom), &[], true);
        Run {
            width: width.max(run.width),
            ..run
        }
    }

    /// Branches that had no room beside others, below the names of the states that they follow or, of parallel ones,
    /// of the first state that is active at the same time.
    fn continued(&mut self, above: &[usize], branches: &[Point], y: usize) -> Run {
        let heading = match branches[0] {
            Point::State(_) => format!("beside {} …", self.chart.names(above)),
            Point::Transition(_) => format!("{} …", self.chart.names(above)),
        };
        // No line shows through it.
        let heading = format!("{heading:<BOX$}");
        let width = heading.width();
        self.text(0, y, Words::Plain(heading));
        let mut run = match *branches {
            [only] => self.chain(only, (0, y + 1), above, true),
            _ => {
                let fork = self.fork(branches, (0, y + 1), above);
                match fork.meets.filter(|_| fork.run.open) {
                    None => fork.run,
                    Some(meets) => {
                        let mut run = self.chain(meets, (0, fork.run.bottom), &fork.run.last, true);
                        run.width = run.width.max(fork.run.width);
                        run
                    }
                }
            }
        };
        run.width = run.width.max(width);
        run
    }

    fn text(&mut self, x: usize, y: usize, text: Words) {
        self.pieces.push(Piece::Text { x, y, text });
    }

    /// Connects a part to the line above it.
    fn connect(&mut self, x: usize, y: usize) {
        self.down(x + SPINE, y - 1, y);
    }

    fn down(&mut self, x: usize, from: usize, to: usize) {
        self.pieces.push(Piece::Down { x, from, to });
    }

    /// Places what follows a point of a branch at a column, from a line on; `below` is whether a line leads to it.
    fn chain(&mut self, first: Point, (x, y): (usize, usize), above: &[usize], below: bool) -> Run {
        let mut run = Run {
            width: BOX + 2,
            bottom: y,
            open: false,
            last: Vec::new(),
        };
        let mut next = Some(first);
        let mut below = below;
        let mut above = above.to_vec();
        while let Some(point) = next {
            if self.stops.last() == Some(&point) {
                run.open = true;
                run.last = above;
                return run;
            }
            let y = run.bottom;
            let (width, bottom, follows) = match point {
                Point::State(state) if self.is_elsewhere(state) => {
                    let (width, bottom) = self.arrow(&[state], x, y);
                    (width, bottom, Vec::new())
                }
                Point::State(state) => {
                    if below {
                        self.connect(x, y);
                    }
                    let (width, bottom) = self.state(state, x, y);
                    above = vec![state];
                    let leaving = self.leaving[state].iter();
                    (
                        width,
                        bottom,
                        leaving.map(|&t| Point::Transition(t)).collect(),
                    )
                }
                Point::Transition(t) => self.transition(t, x, y, &above),
            };
            below = true;
            run.width = run.width.max(width);
            run.bottom = bottom;
            next = match follows[..] {
                [] => None,
                [only] => Some(only),
                _ => {
                    let fork = self.fork(&follows, (x, bottom), &above);
                    run.width = run.width.max(fork.run.width);
                    run.bottom = fork.run.bottom;
                    run.open = fork.run.open && fork.meets.is_none();
                    run.last.clone_from(&fork.run.last);
                    above = fork.run.last;
                    fork.meets.filter(|_| fork.run.open)
                }
            };
        }
        run
    }

    /// Returns true if a state's place is not at the end of the current branch.
    fn is_elsewhere(&self, state: usize) -> bool {
        let meets = self.stops.contains(&Point::State(state));
        self.placed[state] || meets || self.depth > DEEPEST
    }

    /// The box of a state with its actions: width, and the line below.
    fn state(&mut self, state: usize, x: usize, y: usize) -> (usize, usize) {
        self.placed[state] = true;
        self.pieces.push(Piece::State { x, y, state });
        let about = &self.chart.states[state];
        let mut lines = Vec::new();
        for line in about
            .name
            .iter()
            .flat_map(|name| fold(name, self.room, usize::MAX))
        {
            lines.push((line.width(), Words::Name(line)));
        }
        for (i, action) in about.actions.iter().enumerate() {
            for line in fold(&action.text, self.room, usize::MAX) {
                lines.push((line.width(), Words::Action(line, state, i)));
            }
        }
        let width = lines.iter().map(|line| line.0).max().unwrap_or(0);
        let bottom = y + lines.len().max(3);
        for (i, (_, text)) in lines.into_iter().enumerate() {
            self.text(x + BOX + 1, y + i, text);
        }
        if bottom > y + 3 && !self.leaving[state].is_empty() {
            self.down(x + SPINE, y + 2, bottom - 1);
        }
        (BOX + 1 + width + 3, bottom)
    }

    /// A transition below states, and what it leads to.
    fn transition(
        &mut self,
        t: usize,
        x: usize,
        y: usize,
        above: &[usize],
    ) -> (usize, usize, Vec<Point>) {
        let transition = &self.chart.transitions[t];
        // States that the line above does not join are contacts.
        let elsewhere = transition.from.iter().filter(|from| !above.contains(from));
        let factors = elsewhere.map(|&from| self.chart.states[from].device.to_string());
        let factors = factors.chain([transition.condition.clone()]);
        let condition = factors.collect::<Vec<_>>().join(" · ");
        let (width, bottom) = self.bar(&condition, x, y, true);
        let again = std::mem::replace(&mut self.drawn[t], true);
        if again {
            let (more, bottom) = self.arrow(&transition.to, x, bottom);
            return (width.max(more), bottom, Vec::new());
        }
        let to = transition.to.iter().map(|&to| Point::State(to));
        (width, bottom, to.collect())
    }

    /// A bar with its condition: width, and the line below.
    fn bar(&mut self, condition: &str, x: usize, y: usize, below: bool) -> (usize, usize) {
        if below {
            self.connect(x, y);
        }
        self.pieces.push(Piece::Bar { x: x + SPINE, y });
        let lines = fold(condition, self.room, usize::MAX);
        let width = lines.iter().map(|line| line.width()).max().unwrap_or(0);
        let bottom = y + lines.len().max(1);
        for (i, line) in lines.into_iter().enumerate() {
            self.text(x + SPINE + 3, y + i, Words::Plain(line));
        }
        if bottom > y + 1 {
            self.down(x + SPINE, y, bottom - 1);
        }
        (SPINE + 3 + width + 3, bottom)
    }

    /// An arrow to states that lie elsewhere: width, and the line below.
    fn arrow(&mut self, states: &[usize], x: usize, y: usize) -> (usize, usize) {
        self.connect(x, y);
        self.pieces.push(Piece::Arrow {
            x: x + SPINE,
            y,
            states: states.to_vec(),
        });
        (SPINE + 2 + 6 * states.len() + 2, y + 1)
    }

    /// Branches side by side, below a line: double where one transition begins all of them.
    fn fork(&mut self, branches: &[Point], (x, y): (usize, usize), above: &[usize]) -> Fork {
        let parallel = matches!(branches[0], Point::State(_));
        let meets = self.meeting(branches, parallel);
        self.stops.extend(meets);
        self.depth += 1;
        self.connect(x, y);
        let mut width = 0;
        let mut last = x;
        let mut open = Vec::new();
        let mut bottom = y + 1;
        let mut joined = Vec::new();
        for (nth, &branch) in branches.iter().enumerate() {
            let at = x + width;
            let Some(run) = self.branch(branch, (at, y + 1), above, nth == 0) else {
                let after = match branches[0] {
                    Point::State(first) => vec![first],
                    Point::Transition(_) => above.to_vec(),
                };
                self.below.push_back((after, branches[nth..].to_vec()));
                self.text(last + SPINE + 3, y, Words::Plain("…".to_string()));
                break;
            };
            last = at;
            if run.open {
                open.push((last, run.bottom));
                joined.extend(run.last);
            }
            bottom = bottom.max(run.bottom);
            width += run.width;
        }
        self.depth -= 1;
        self.across(y, x, last, parallel);
        if meets.is_some() {
            self.stops.pop();
        }
        if let Some(&(last, _)) = open.last() {
            for &(x, end) in &open {
                self.down(x + SPINE, end - 1, bottom);
            }
            self.across(bottom, x, last, parallel);
            bottom += 1;
        }
        let run = Run {
            width,
            bottom,
            open: !open.is_empty(),
            last: joined,
        };
        Fork { run, meets }
    }

    /// A branch beside others, unless the page has no room for it; for the first one there is always.
    fn branch(
        &mut self,
        branch: Point,
        place: (usize, usize),
        above: &[usize],
        first: bool,
    ) -> Option<Run> {
        if first || self.columns == usize::MAX {
            return Some(self.chain(branch, place, above, true));
        }
        let before = (self.pieces.len(), self.below.len());
        let (placed, drawn) = (self.placed.clone(), self.drawn.clone());
        let run = self.chain(branch, place, above, true);
        if place.0 + run.width <= self.columns {
            return Some(run);
        }
        self.pieces.truncate(before.0);
        self.below.truncate(before.1);
        (self.placed, self.drawn) = (placed, drawn);
        None
    }

    fn across(&mut self, y: usize, first: usize, last: usize, double: bool) {
        let (from, to) = (first + SPINE, last + SPINE);
        let beyond = if double { 2 } else { 0 };
        self.pieces.push(Piece::Across {
            y,
            from: from - beyond,
            to: to + beyond,
            double,
        });
    }

    /// Meeting point of most of these branches: the nearest state that selected ones lead to, or the nearest transition
    /// that leaves states of parallel ones together.
    fn meeting(&self, branches: &[Point], parallel: bool) -> Option<Point> {
        let mut reached: BTreeMap<Point, (usize, usize)> = BTreeMap::new();
        for &branch in branches {
            for (point, distance) in self.distances(branch) {
                let (count, sum) = reached.entry(point).or_default();
                *count += 1;
                *sum += distance;
            }
        }
        let candidates = reached.into_iter().filter(|(point, (count, _))| {
            let fits = match *point {
                Point::State(_) => !parallel,
                Point::Transition(t) => parallel && self.chart.transitions[t].from.len() > 1,
            };
            fits && *count > 1
        });
        let best = candidates.max_by_key(|(point, (count, sum))| {
            (*count, std::cmp::Reverse(*sum), std::cmp::Reverse(*point))
        });
        best.map(|(point, _)| point)
    }

    /// The points to which one leads without passing any that is placed, or where branches around it meet, by how far
    /// they are.
    fn distances(&self, start: Point) -> BTreeMap<Point, usize> {
        let stops: BTreeSet<_> = self.stops.iter().copied().collect();
        let mut found = BTreeMap::new();
        let mut open = VecDeque::from([(start, 0)]);
        while let Some((point, distance)) = open.pop_front() {
            let placed = match point {
                Point::State(state) => self.placed[state],
                Point::Transition(t) => self.drawn[t],
            };
            if placed || stops.contains(&point) || found.contains_key(&point) {
                continue;
            }
            found.insert(point, distance);
            match point {
                Point::State(state) => {
                    let next = self.leaving[state].iter();
                    open.extend(next.map(|&t| (Point::Transition(t), distance + 1)));
                }
                Point::Transition(t) => {
                    let next = self.chart.transitions[t].to.iter();
                    open.extend(next.map(|&to| (Point::State(to), distance + 1)));
                }
            }
        }
        found
    }

    /// Remarks on parts that the flows do not show.
    fn remarks(&self) -> Vec<String> {
        let names = |states: &[usize]| {
            let names = states
                .iter()
                .map(|&to| self.chart.states[to].device.to_string());
            names.collect::<Vec<_>>().join(", ")
        };
        let entries = self.chart.transitions.iter().zip(&self.drawn);
        let entries = entries.filter(|(_, drawn)| !**drawn).map(|(entry, _)| {
            let (network, condition) = (entry.network, &entry.condition);
            format!(
                "Network {network} also sets {}: {condition}",
                names(&entry.to)
            )
        });
        let others = self.chart.others.iter();
        let others = others.map(|other| format!("Step {}: {}", other.step, other.text));
        entries.chain(others).collect()
    }
}
