//! Correspondence of the private memory of two programs.
//!
//! Flags, cells and tables have names. Edges and calls of the runtime have numbers, in the order in which they stand:
//! they are aligned by what they look at. A wrong pair does no harm: its memory turns out to differ.

use crate::model::{Key, Names};
use rungc_ir::Module;
use rungc_ir::node::{Action, Expr, ExprId, Stmt, TempId};
use rungc_ir::walk::{operands, statements};
use rungc_syntax::align;
use rustc_hash::{FxHashMap, FxHasher};
use std::hash::{Hash, Hasher};

/// Names of the new program's private memory in the old one.
pub(super) fn names(old: &Module, new: &Module) -> Names {
    let mut names = FxHashMap::default();
    for (flag, at) in new.flags.iter().zip(0..) {
        let mut flags = old.flags.iter().zip(0..);
        if let Some((_, other)) = flags.find(|(other, _)| other.name == flag.name) {
            names.insert(Key::Flag(at), Key::Flag(other));
        }
    }
    for (cell, at) in new.cells.iter().zip(0..) {
        let mut cells = old.cells.iter().zip(0..);
        if let Some((_, other)) = cells.find(|(other, _)| other.name == cell.name) {
            names.insert(Key::Cell(at), Key::Cell(other));
        }
    }
    for (table, at) in new.tables.iter().zip(0..) {
        let mut tables = old.tables.iter().zip(0..);
        let known =
            tables.find(|(other, _)| other.name == table.name && other.length == table.length);
        if let Some((_, other)) = known {
            names.extend((0..table.length).map(|i| (Key::Entry(at, i), Key::Entry(other, i))));
        }
    }
    let [(old_edges, old_slots), (new_edges, new_slots)] = [old, new].map(numbered);
    pair(&old_edges, &new_edges, &mut names);
    pair(&old_slots, &new_slots, &mut names);
    Names(names)
}

/// Memory with what it belongs to, as a number.
type Numbered = Vec<(Key, u64)>;

/// The memories of edges and calls in the order in which they stand.
fn numbered(module: &Module) -> (Numbered, Numbered) {
    let (mut edges, mut slots) = (Vec::new(), Vec::new());
    let mut texts = Texts {
        module,
        known: FxHashMap::default(),
        temps: FxHashMap::default(),
    };
    for function in &module.functions {
        statements(&function.body, &mut |stmt| match stmt {
            Stmt::Do(Action::Let(temp, value)) => {
                let value = texts.of(*value);
                texts.temps.insert(*temp, value);
                texts.known.clear();
            }
            Stmt::Do(Action::Edge(edge)) => {
                let input = texts.of(edge.input);
                edges.push((
                    Key::Edge(edge.memory.0),
                    hashed(&(format!("{:?}", edge.kind), input)),
                ));
            }
            Stmt::Do(Action::Call(call)) if call.slot > 0 => {
                let drive = call.drive.map(|drive| texts.of(drive));
                let text = format!("{:?} {} {:?}", call.function, call.wide, call.args);
                slots.push((Key::Slot(call.slot), hashed(&(text, drive))));
            }
            _ => {}
        });
    }
    (edges, slots)
}

fn hashed(what: &impl Hash) -> u64 {
    let mut hasher = FxHasher::default();
    what.hash(&mut hasher);
    hasher.finish()
}

/// Expressions as numbers: equal ones have the same, in any module.
struct Texts<'m> {
    module: &'m Module,
    known: FxHashMap<ExprId, u64>,
    temps: FxHashMap<TempId, u64>,
}

impl Texts<'_> {
    fn of(&mut self, id: ExprId) -> u64 {
        if let Some(&known) = self.known.get(&id) {
            return known;
        }
        let expr = self.module.expr(id);
        let inner: Vec<u64> = operands(expr).map(|operand| self.of(operand)).collect();
        let own = match expr {
            Expr::Temp(temp) => self.temps.get(temp).copied().unwrap_or(0).to_string(),
            Expr::Read(access) => format!(
                "{:?} {:?} {}",
                access.kind, access.place.class, access.place.number
            ),
            Expr::Bit(_) | Expr::I16(_) | Expr::I32(_) | Expr::F32(_) | Expr::Sys(_) => {
                format!("{expr:?}")
            }
            Expr::Flag(flag) => self.module.flags[*flag].name.clone(),
            Expr::Cell(cell) => self.module.cells[*cell].name.clone(),
            Expr::Cmp(op, ..) => format!("{op:?}"),
            Expr::Bin(op, ..) => format!("{op:?}"),
            Expr::Un(op, ..) => format!("{op:?}"),
            other => format!("{:?}", std::mem::discriminant(other)),
        };
        let number = hashed(&(own, inner));
        self.known.insert(id, number);
        number
    }
}

/// Pairs memories that belong to the same, and between those as many others as both have, in order.
fn pair(old: &Numbered, new: &Numbered, names: &mut FxHashMap<Key, Key>) {
    let texts = |all: &Numbered| all.iter().map(|(_, text)| *text).collect::<Vec<_>>();
    let mut pairs = align::common(&texts(old), &texts(new));
    pairs.push((old.len(), new.len()));
    let (mut from_old, mut from_new) = (0, 0);
    for (at_old, at_new) in pairs {
        let between = old[from_old..at_old].iter().zip(&new[from_new..at_new]);
        let here = old.get(at_old).zip(new.get(at_new));
        names.extend(between.chain(here).map(|((old, _), (new, _))| (*new, *old)));
        (from_old, from_new) = (at_old + 1, at_new + 1);
    }
}
