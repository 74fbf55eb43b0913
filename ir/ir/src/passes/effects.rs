//! Reads of expressions and writes of statements, and whether a read may be moved after a write.

use crate::node::{
    Action, Count, Counter16Coil, Counter32Coil, Expr, ExprId, IndexedCoil, Place, Stmt, TimerCoil,
};
use crate::walk::operands;
use rungc_models::Model;
use rungc_syntax::DeviceClass;
use typed_index_collections::TiSlice;

/// Reads of an expression.
#[derive(Clone, Debug, Default)]
pub(super) struct Reads {
    /// Runs of devices: (class, first, last).
    devices: Vec<(DeviceClass, u32, u32)>,
    /// Index registers by their other names.
    index: bool,
    /// A flag, a cell or a table.
    private: bool,
}

/// Writes of a statement.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Writes {
    /// No device.
    Nothing,
    /// The devices of a class from the one number to the other.
    Run(DeviceClass, u32, u32),
    /// Index registers, some of which are pairs.
    Index,
    /// Anything.
    All,
}

impl Reads {
    /// Reads of an expression.
    pub(super) fn of(exprs: &TiSlice<ExprId, Expr>, model: &Model, id: ExprId) -> Self {
        let mut reads = Reads::default();
        reads.collect(exprs, model, id);
        reads
    }

    fn collect(&mut self, exprs: &TiSlice<ExprId, Expr>, model: &Model, id: ExprId) {
        let expr = exprs[id];
        for operand in operands(&expr) {
            self.collect(exprs, model, operand);
        }
        if let Expr::Read(access) = expr {
            let class = access.place.class;
            let (first, last) = run(exprs, access.place, access.extent());
            self.devices.push((class, first, last));
            self.index |= model.has_alias(class, first, last);
        }
        self.private |= matches!(expr, Expr::Flag(_) | Expr::Cell(_) | Expr::Entry(..));
    }

    /// Returns true if the value may differ after the write.
    pub(super) fn disturbed_by(&self, writes: Writes) -> bool {
        let private = self.private && writes == Writes::All;
        let index = self.index && matches!(writes, Writes::Index | Writes::All);
        private
            || index
            || self
                .devices
                .iter()
                .any(|&(class, first, last)| match writes {
                    Writes::Nothing => false,
                    Writes::Run(other, from, to) => class == other && first <= to && from <= last,
                    Writes::Index => is_index(class),
                    Writes::All => true,
                })
    }
}

fn is_index(class: DeviceClass) -> bool {
    matches!(class, DeviceClass::V | DeviceClass::Z)
}

/// The numbers that an access may touch.
fn run(exprs: &TiSlice<ExprId, Expr>, place: Place, count: u32) -> (u32, u32) {
    let (low, high) = match place.index.map(|index| &exprs[index]) {
        None => (0, 0),
        Some(&Expr::Within { low, high, .. }) => (low, high),
        Some(_) => return (0, u32::MAX),
    };
    let last = place.number.saturating_add(count - 1);
    (
        place.number.saturating_add_signed(low),
        last.saturating_add_signed(high),
    )
}

/// Writes of a statement with these expressions, when it is executed.
#[expect(clippy::wildcard_enum_match_arm, reason = "others may write anything")]
pub(super) fn writes(model: &Model, exprs: &TiSlice<ExprId, Expr>, stmt: &Stmt) -> Writes {
    let place = |place: Place, count| {
        if is_index(place.class) {
            return Writes::Index;
        }
        let (first, last) = run(exprs, place, count);
        if model.has_alias(place.class, first, last) {
            return Writes::All;
        }
        Writes::Run(place.class, first, last)
    };
    let Stmt::Do(action) = stmt else {
        return match stmt {
            Stmt::Network(_) => Writes::Nothing,
            _ => Writes::All,
        };
    };
    match *action {
        Action::Let(..) | Action::Edge(_) => Writes::Nothing,
        Action::Write(access, _) => place(access.place, access.extent()),
        Action::TimerAt(IndexedCoil { place: at, .. })
        | Action::Counter16At(IndexedCoil { place: at, .. })
        | Action::Reset { place: at, .. } => place(at, 1),
        Action::Block(block) => {
            let (to, count) = block.written();
            place(to, count)
        }
        Action::Timer(TimerCoil { number, .. }) | Action::TimerGoesOn { number, .. } => {
            Writes::Run(DeviceClass::T, number, number)
        }
        Action::Counter16(Counter16Coil { number, .. })
        | Action::Counter32(Counter32Coil { number, .. })
        | Action::Count(Count { number, .. }) => Writes::Run(DeviceClass::C, number, number),
        _ => Writes::All,
    }
}
