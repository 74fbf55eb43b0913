//! Jumps become structured statements where they nest, and parts with labels where they do not.

use super::advanced::FIRST_PLACE;
use rungc_ir::node::{Body, Branch, ExprId, LabelId, Part, Stmt};
use rungc_syntax::DeviceClass;
use rustc_hash::{FxHashMap, FxHashSet};

/// Jumps nested deeper than this become parts, so that bodies do not nest too deep.
const MAX_NESTING: usize = 12;

/// Item of a body before its jumps are resolved.
#[derive(Debug)]
pub(super) enum Item {
    /// A statement.
    Code(Stmt),
    /// A place that jumps go to.
    Label(u32),
    /// A conditional jump.
    Jump(Jump),
    /// A statement with bodies that jump to labels outside of it.
    Nested(Stmt, Vec<Jump>),
}

/// A conditional jump.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jump {
    /// Jumps if on.
    pub(super) cond: ExprId,
    /// The opposite.
    pub(super) stay: ExprId,
    /// Pointer.
    pub(super) target: u32,
    /// Its instruction.
    pub(super) at: usize,
}

impl Item {
    /// As a statement; a jump goes to a label that is a part.
    pub(super) fn into_stmt(self) -> Option<Stmt> {
        match self {
            Item::Code(stmt) | Item::Nested(stmt, _) => Some(stmt),
            Item::Label(_) => None,
            Item::Jump(jump) => Some(Stmt::If(Branch {
                cond: jump.cond,
                then: vec![Stmt::Goto(LabelId(jump.target))],
                otherwise: Vec::new(),
            })),
        }
    }
}

/// A run of items, from `first` up to and without `end`, that jumps hold together.
struct Group {
    first: usize,
    end: usize,
    /// True if its jumps go forward and nest.
    nests: bool,
}

/// A jump from item `from` to the label at item `to`, in the same body.
struct Leap {
    from: usize,
    to: usize,
    /// True if the jump is in a nested body.
    nested: bool,
}

impl Leap {
    fn first(&self) -> usize {
        self.from.min(self.to)
    }

    fn last(&self) -> usize {
        self.from.max(self.to)
    }
}

/// Makes a body of items, and returns which jumps leave it.
pub(super) fn structure(items: Vec<Item>) -> (Body, Vec<Jump>) {
    let mut labels = FxHashMap::default();
    for (i, item) in items.iter().enumerate() {
        if let Item::Label(label) = item {
            labels.insert(*label, i);
        }
    }
    let (leaps, escapes) = leaps(&items, &labels);
    let targets: FxHashSet<usize> = leaps.iter().map(|leap| leap.to).collect();
    let mut groups = groups(leaps).into_iter().peekable();
    let mut body = Vec::with_capacity(items.len());
    let mut items = items.into_iter().enumerate().peekable();
    while let Some(&(i, _)) = items.peek() {
        match groups.next_if(|group| group.first == i) {
            Some(group) => {
                let run: Vec<_> =
                    std::iter::from_fn(|| items.next_if(|&(i, _)| i < group.end)).collect();
                if group.nests {
                    nest(run, &labels, &mut body);
                } else {
                    body.push(parts(run, &targets));
                }
            }
            None => {
                if let Some((_, item)) = items.next() {
                    body.extend(item.into_stmt());
                }
            }
        }
    }
    (body, escapes)
}

/// The jumps within a body, by place, and those that leave it.
fn leaps(items: &[Item], labels: &FxHashMap<u32, usize>) -> (Vec<Leap>, Vec<Jump>) {
    let (mut leaps, mut escapes) = (Vec::new(), Vec::new());
    let mut sort = |from, jump: &Jump, nested| match labels.get(&jump.target) {
        Some(&to) => leaps.push(Leap { from, to, nested }),
        None => escapes.push(*jump),
    };
    for (i, item) in items.iter().enumerate() {
        match item {
            Item::Jump(jump) => sort(i, jump, false),
            Item::Nested(_, jumps) => jumps.iter().for_each(|jump| sort(i, jump, true)),
            Item::Code(_) | Item::Label(_) => {}
        }
    }
    leaps.sort_by_key(|leap| (leap.first(), std::cmp::Reverse(leap.last())));
    (leaps, escapes)
}

/// Overlapping jumps belong together.
fn groups(leaps: Vec<Leap>) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    let mut ends: Vec<usize> = Vec::new();
    for leap in leaps {
        if groups.last().is_none_or(|group| group.end <= leap.first()) {
            ends.clear();
            groups.push(Group {
                first: leap.first(),
                end: 0,
                nests: true,
            });
        }
        let Some(group) = groups.last_mut() else {
            continue;
        };
        while ends.last().is_some_and(|&end| end <= leap.first()) {
            ends.pop();
        }
        let crosses = ends.last().is_some_and(|&end| leap.last() > end);
        ends.push(leap.last());
        group.nests &= !crosses && !leap.nested && leap.from < leap.to && ends.len() <= MAX_NESTING;
        group.end = group.end.max(leap.last() + 1);
    }
    groups
}

/// Statements that a jump over them skips.
struct Skipped {
    stay: ExprId,
    target: u32,
    body: Body,
}

/// Forward jumps that nest: what each leaves out is executed if it does not jump.
fn nest(run: Vec<(usize, Item)>, labels: &FxHashMap<u32, usize>, body: &mut Body) {
    let mut open: Vec<Skipped> = Vec::new();
    for (_, item) in run {
        match item {
            Item::Jump(jump) if labels.contains_key(&jump.target) => open.push(Skipped {
                stay: jump.stay,
                target: jump.target,
                body: Vec::new(),
            }),
            Item::Label(label) => {
                while let Some(skipped) = open.pop_if(|skipped| skipped.target == label) {
                    let stmt = Stmt::If(Branch {
                        cond: skipped.stay,
                        then: skipped.body,
                        otherwise: Vec::new(),
                    });
                    innermost(&mut open, body).push(stmt);
                }
            }
            item @ Item::Code(_) | item @ Item::Jump(_) | item @ Item::Nested(..) => {
                innermost(&mut open, body).extend(item.into_stmt())
            }
        }
    }
}

fn innermost<'b>(open: &'b mut [Skipped], body: &'b mut Body) -> &'b mut Body {
    open.last_mut().map_or(body, |skipped| &mut skipped.body)
}

/// Jumps that do not nest: a part begins at each label that is jumped to.
fn parts(run: Vec<(usize, Item)>, targets: &FxHashSet<usize>) -> Stmt {
    let mut parts = vec![Part {
        label: None,
        name: None,
        body: Vec::new(),
    }];
    for (i, item) in run {
        match item {
            Item::Label(label) if targets.contains(&i) => {
                if parts
                    .last()
                    .is_some_and(|p| p.label.is_none() && p.body.is_empty())
                {
                    parts.pop();
                }
                parts.push(Part {
                    label: Some(LabelId(label)),
                    name: (label < FIRST_PLACE).then(|| DeviceClass::P.number(label).to_string()),
                    body: Vec::new(),
                });
            }
            item @ Item::Code(_)
            | item @ Item::Label(_)
            | item @ Item::Jump(_)
            | item @ Item::Nested(..) => {
                if let (Some(part), Some(stmt)) = (parts.last_mut(), item.into_stmt()) {
                    part.body.push(stmt);
                }
            }
        }
    }
    Stmt::Parts(parts)
}
