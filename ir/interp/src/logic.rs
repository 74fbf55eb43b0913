//! Contact logic, decoded once into lists.
//!
//! Nearly all of a scan is the logic of contacts, so its expressions ([`Expr::And`], [`Expr::Or`], [`Expr::Not`] and
//! what they join) are not walked as trees. They are decoded into what a ladder's contacts are written as, an
//! instruction list: `((X000 | M0) & !X001)` is LD X000, OR M0, ANI X001. What is joined is a device whose slot is
//! known, or any other expression, which `eval` evaluates.

use crate::devices::{BitSlot, Devices};
use rungc_ir::node::{Expr, ExprId, Place, TempId, Ty};
use rungc_ir::{Module, walk};
use rungc_models::runs::rt_class;
use rungc_rt::Class;
use typed_index_collections::TiVec;

/// Operation of an item on its input.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Join {
    /// Begins a block with it (LD).
    Load,
    /// Puts it in series with the block (AND, ANB).
    And,
    /// Puts it in parallel to the block (OR, ORB).
    Or,
}

/// Source of an item's input.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Input {
    /// A device.
    Bit(BitSlot),
    /// A device that is another one in each iteration of a loop: an index of [`Logic::strided`].
    Strided(u32),
    /// The contact of a timer or counter, which is in its memory.
    Contact(Class, u32),
    /// A temporary.
    Temp(TempId),
    /// Any other expression.
    Expr(ExprId),
    /// The block that has just been finished, which this removes.
    Block,
}

/// An item of a list.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Item {
    pub(crate) join: Join,
    pub(crate) input: Input,
    /// The input is inverted, as by LDI, ANI and ORI.
    pub(crate) inverted: bool,
}

/// A device that a [`rungc_ir::node::Stmt::Repeat`] leads to.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Strided {
    /// In iteration 0.
    pub(crate) first: BitSlot,
    pub(crate) iteration: TempId,
    /// The distance between the devices of two iterations.
    pub(crate) stride: u32,
}

/// The lists of a module.
#[derive(Default)]
pub(crate) struct Logic {
    items: Vec<Item>,
    pub(crate) strided: Vec<Strided>,
    /// List of each expression, by handle; none if it is not logic that a statement uses.
    lists: TiVec<ExprId, List>,
}

/// Items from `begin` up to `end`.
#[derive(Clone, Copy, Default)]
struct List {
    begin: u32,
    end: u32,
}

impl Logic {
    /// Decodes the logic of all statements.
    pub(crate) fn new(module: &Module, devices: &Devices) -> Self {
        let mut decoder = Decoder {
            module,
            devices,
            logic: Logic {
                lists: vec![List::default(); module.exprs.len()].into(),
                ..Logic::default()
            },
            open: Vec::new(),
        };
        for function in &module.functions {
            walk::statements(&function.body, &mut |stmt| {
                walk::for_exprs(stmt, &mut |&id| decoder.expression(id));
            });
        }
        decoder.logic
    }

    /// The list of an expression.
    pub(crate) fn list(&self, id: ExprId) -> &[Item] {
        let List { begin, end } = self.lists[id];
        debug_assert!(begin < end, "logic that no statement looks at");
        &self.items[begin as usize..end as usize]
    }
}

struct Decoder<'m> {
    module: &'m Module,
    devices: &'m Devices,
    logic: Logic,
    /// Expressions still to be looked at.
    open: Vec<ExprId>,
}

impl Decoder<'_> {
    /// Decodes an expression, and the logic that it has its operands from.
    fn expression(&mut self, id: ExprId) {
        self.open.push(id);
        while let Some(id) = self.open.pop() {
            if self.module.ty(id) == Ty::Bit {
                self.list(id);
            } else {
                self.open.extend(walk::operands(self.module.expr(id)));
            }
        }
    }

    fn list(&mut self, id: ExprId) {
        let List { begin, end } = self.logic.lists[id];
        if begin == end {
            let begin = self.length();
            self.block(id);
            self.logic.lists[id] = List {
                begin: begin as u32,
                end: self.length() as u32,
            };
        }
    }

    fn length(&self) -> usize {
        self.logic.items.len()
    }

    fn push(&mut self, join: Join, input: Input, inverted: bool) {
        self.logic.items.push(Item {
            join,
            input,
            inverted,
        });
    }

    /// Appends the items that make a block of an expression. Returns how many blocks are open at most meanwhile.
    fn block(&mut self, id: ExprId) -> u32 {
        let (inner, inverted) = self.plain(id);
        let depth = if let Expr::And(a, b) = *self.module.expr(inner) {
            self.join(Join::And, a, b)
        } else if let Expr::Or(a, b) = *self.module.expr(inner) {
            self.join(Join::Or, a, b)
        } else {
            let input = self.input(inner);
            self.push(Join::Load, input, inverted);
            return 1;
        };
        if inverted {
            self.push(Join::Load, Input::Block, true);
        }
        depth
    }

    /// Appends the items of two joined expressions. The one that needs more open blocks comes first, so that their
    /// number grows only with the logarithm of the length.
    fn join(&mut self, join: Join, a: ExprId, b: ExprId) -> u32 {
        for (block, other) in [(a, b), (b, a)] {
            let (contact, inverted) = self.plain(other);
            if !matches!(self.module.expr(contact), Expr::And(..) | Expr::Or(..)) {
                let depth = self.block(block);
                let input = self.input(contact);
                self.push(join, input, inverted);
                return depth;
            }
        }
        let begin = self.length();
        let first = self.block(a);
        let length = self.length() - begin;
        let second = self.block(b);
        if second > first {
            self.logic.items[begin..].rotate_left(length);
        }
        self.push(join, Input::Block, false);
        first.max(second).max(first.min(second) + 1)
    }

    /// An expression without the inversions around it, and whether they invert it.
    fn plain(&self, mut id: ExprId) -> (ExprId, bool) {
        let mut inverted = false;
        while let Expr::Not(inner) = *self.module.expr(id) {
            (id, inverted) = (inner, !inverted);
        }
        (id, inverted)
    }

    /// Input of an item for an expression that joins no others.
    fn input(&mut self, id: ExprId) -> Input {
        let expr = self.module.expr(id);
        if let Expr::Temp(temp) = *expr {
            return Input::Temp(temp);
        }
        if let Some(place) = expr.as_bit()
            && let Some(device) = self.device(place)
        {
            return device;
        }
        self.open.extend(walk::operands(expr));
        Input::Expr(id)
    }

    /// A device whose slot is known when the program is loaded, except for the iteration of a loop.
    fn device(&mut self, place: Place) -> Option<Input> {
        let class = rt_class(place.class)?;
        let slot = self.devices.bit_slot(class, place.number);
        let Some(index) = place.index else {
            return Some(slot.map_or(Input::Contact(class, place.number), Input::Bit));
        };
        let Expr::Stride(iteration, stride) = *self.module.expr(index) else {
            return None;
        };
        let strided = Strided {
            first: slot?,
            iteration,
            stride,
        };
        self.logic.strided.push(strided);
        Some(Input::Strided(self.logic.strided.len() as u32 - 1))
    }
}

#[cfg(test)]
mod tests {
    use super::{Input, Join, Logic};
    use crate::Machine;
    use crate::devices::Devices;
    use rungc_ir::Module;
    use rungc_ir::node::{Access, Action, Expr, ExprId, Place, Stmt};
    use rungc_models::{Model, ModelId};
    use rungc_rt::{Class, NoHal, Plc, Program};
    use rungc_syntax::DeviceClass;

    fn place(class: DeviceClass, number: u32) -> Place {
        Place {
            class,
            number,
            index: None,
        }
    }

    /// An empty module, and contacts X0 … in it.
    fn contacts(count: u32) -> (Module, Vec<ExprId>) {
        let model = Model::get(ModelId::Fx3u);
        let mut module = Module::empty("rung".into(), "rung.il".into(), model);
        let contact = |n| module.add(Expr::Read(Access::bit(place(DeviceClass::X, n))));
        let contacts = (0..count).map(contact).collect();
        (module, contacts)
    }

    /// The main program writes the value to Y`number`.
    fn out(module: &mut Module, number: u32, value: ExprId) {
        let coil = Stmt::Do(Action::Write(
            Access::bit(place(DeviceClass::Y, number)),
            value,
        ));
        module.functions[1].body.push(coil);
    }

    /// Y`number` after a scan with these inputs on.
    fn scan(module: &Module, inputs: u32, number: u32) -> bool {
        let mut machine = Machine::new(module);
        for n in 0..32 {
            let _ = machine.set_bit(Class::X, n, inputs >> n & 1 == 1);
        }
        machine.scan(&mut NoHal, 0, 0);
        machine.output(number)
    }

    #[test]
    fn blocks_are_joined_and_inverted() {
        let (mut module, contacts) = contacts(5);
        let [a, b, c, d, e] = contacts[..] else {
            panic!("5 contacts");
        };
        let not_b = module.add(Expr::Not(b));
        let left = module.add(Expr::Or(a, not_b));
        let both = module.add(Expr::And(c, d));
        let right = module.add(Expr::Not(both));
        let middle = module.add(Expr::And(left, right));
        let either = module.add(Expr::Or(e, middle));
        let value = module.add(Expr::Not(either));
        out(&mut module, 0, value);
        for inputs in 0..32 {
            let [a, b, c, d, e] = [0, 1, 2, 3, 4].map(|n| inputs >> n & 1 == 1);
            let (left, right) = (a || !b, !(c && d));
            let expected = !(e || left && right);
            assert_eq!(scan(&module, inputs, 0), expected, "{inputs:05b}");
        }
    }

    /// Contacts in series, joined in pairs, pairs of pairs and so on.
    fn halves(module: &mut Module, contacts: &[ExprId]) -> ExprId {
        if let [only] = contacts {
            return *only;
        }
        let (left, right) = contacts.split_at(contacts.len() / 2);
        let (left, right) = (halves(module, left), halves(module, right));
        module.add(Expr::And(left, right))
    }

    /// The most blocks that are open in the list, which leaves one.
    fn open_blocks(module: &Module, value: ExprId) -> usize {
        let logic = Logic::new(module, &Devices::new(module));
        let (mut open, mut most) = (0, 0);
        for item in logic.list(value) {
            open -= usize::from(item.input == Input::Block);
            open += usize::from(item.join == Join::Load);
            most = most.max(open);
        }
        assert_eq!(open, 1);
        most
    }

    #[test]
    fn few_blocks_are_open_however_long_the_logic() {
        let (mut module, contacts) = contacts(32);
        let pairs = contacts.chunks(2).map(|pair| halves(&mut module, pair));
        let pairs: Vec<_> = pairs.collect();
        let after = |a, b| Expr::And(a, b);
        let before = |a, b| Expr::And(b, a);
        let mut chain = |join: fn(ExprId, ExprId) -> Expr| {
            let all = pairs.iter().copied();
            all.reduce(|chain, pair| module.add(join(chain, pair)))
                .expect("16 pairs")
        };
        let chains = [chain(after), chain(before)];
        let tree = halves(&mut module, &contacts);
        for (number, (value, most)) in (0..).zip([(chains[0], 2), (chains[1], 2), (tree, 5)]) {
            out(&mut module, number, value);
            assert_eq!(open_blocks(&module, value), most);
            assert!(scan(&module, u32::MAX, number));
            assert!((0..32).all(|n| !scan(&module, !(1 << n), number)));
        }
    }
}
