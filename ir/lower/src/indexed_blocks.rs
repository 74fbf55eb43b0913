//! Instructions on blocks of devices that an index leads to, or whose length is in a register, as inline code: one
//! check that the whole block exists, then a copy or a fill. What is checked, and in which order, is as in the runtime.

use super::Lowerer;
use super::blocks::{MOVED, SHIFTED_BITS, SHIFTED_WORDS};
use super::operand::{Guards, fixed};
use super::words::constant;
use rungc_ir::node::{Access, Action, BinOp, Block, Branch, Expr, ExprId, Place, Stmt};
use rungc_models::runs::is_special;
use rungc_rt::special::M_BMOV_REVERSE;
use rungc_rt::{CmpOp, RtFn};
use rungc_syntax::{Device, DeviceClass, Index, Instr, OperandKind};

/// The first device of a block, and its index.
pub(super) type First = (Device, Option<Index>);

/// The first of some registers D or R.
pub(super) fn words(operand: &OperandKind) -> Option<First> {
    first(operand).filter(|(device, _)| matches!(device.class, DeviceClass::D | DeviceClass::R))
}

/// The first of some bits X, Y, M or S.
fn bits(operand: &OperandKind) -> Option<First> {
    use DeviceClass::{M, S, X, Y};
    first(operand).filter(|(device, _)| matches!(device.class, X | Y | M | S))
}

/// The first device of a block. Special ones need an index, since those that are named are not in arrays.
fn first(operand: &OperandKind) -> Option<First> {
    let OperandKind::Device(device, index) = *operand else {
        return None;
    };
    (index.is_some() || !is_special(device.class, device.number)).then_some((device, index))
}

/// Returns true if an instruction on blocks, of which one has an index or a length in a register, is inline code.
#[expect(
    clippy::wildcard_enum_match_arm,
    reason = "the other functions of the runtime are called"
)]
pub(super) fn is_inline(function: RtFn, instr: &Instr, wide: bool) -> bool {
    let kind = |i: usize| instr.operands.get(i).map(|operand| &operand.kind);
    let words = |i| kind(i).and_then(words);
    let bits = |i| kind(i).and_then(bits);
    let stated = |i| kind(i).and_then(constant);
    let moved = || match stated(2) {
        Some(n) => (1..=MOVED as i32).contains(&n),
        None => !wide && kind(2).is_some_and(is_length),
    };
    let shifted = |from: Option<First>, to: Option<First>, most: u32| match (stated(2), stated(3)) {
        (Some(n), Some(by)) if (1..=most as i32).contains(&n) && (1..=n).contains(&by) => {
            let right = matches!(function, RtFn::Sftr | RtFn::Wsfr);
            let enter = if right { n - by } else { 0 };
            from.zip(to)
                .is_some_and(|(from, to)| !propagates(from, to, enter, by))
        }
        _ => false,
    };
    match function {
        RtFn::Bmov | RtFn::BmovForward => words(0).is_some() && words(1).is_some() && moved(),
        RtFn::Fmov => words(1).is_some() && moved(),
        RtFn::Zrst => {
            let of = |i| words(i).or(bits(i)).map(|(device, _)| device.class);
            of(0).is_some() && of(0) == of(1)
        }
        RtFn::Sftl | RtFn::Sftr => shifted(bits(0), bits(1), SHIFTED_BITS),
        RtFn::Wsfl | RtFn::Wsfr => shifted(words(0), words(1), SHIFTED_WORDS),
        _ => false,
    }
}

/// Returns true if it is a number that a program computes.
fn is_length(operand: &OperandKind) -> bool {
    matches!(
        operand,
        OperandKind::Device(..)
            | OperandKind::Nibbles(..)
            | OperandKind::Decimal(_, Some(_))
            | OperandKind::Hex(_, Some(_))
    )
}

/// Returns true if `by` devices that enter a shift, one by one from the first on, may be read after one of them has
/// been written: then the first of them enters more than once.
fn propagates(from: First, to: First, enter: i32, by: i32) -> bool {
    if by == 1 || from.0.class != to.0.class {
        return false;
    }
    let distance = i64::from(to.0.number) + i64::from(enter) - i64::from(from.0.number);
    from.1 != to.1 || (1..i64::from(by)).contains(&distance)
}

/// A place `offset` devices after another.
pub(super) fn after(place: Place, offset: u32) -> Place {
    let number = place.number + offset;
    Place { number, ..place }
}

/// Returns true if a place names bits.
fn is_bits(place: Place) -> bool {
    use DeviceClass::{M, S, X, Y};
    matches!(place.class, X | Y | M | S)
}

impl Lowerer<'_> {
    /// Emits an instruction on blocks that [`is_inline`].
    #[expect(
        clippy::wildcard_enum_match_arm,
        reason = "the other functions of the runtime are called"
    )]
    pub(super) fn indexed_block(&mut self, function: RtFn) {
        self.driven(|this| {
            this.within_limits(None, |this, _| match function {
                RtFn::Bmov => this.move_run(this.specials.has(M_BMOV_REVERSE)),
                RtFn::BmovForward => this.move_run(false),
                RtFn::Fmov => this.fill_from(),
                RtFn::Zrst => this.reset_run(),
                RtFn::Sftr | RtFn::Wsfr => this.shift_run(true),
                _ => this.shift_run(false),
            });
        });
    }

    /// The first device that operand `i` names, and its index.
    fn first_of(&self, i: usize) -> Option<First> {
        first(self.operand(i)?)
    }

    /// The block of `count` devices at operand `i`.
    pub(super) fn block_at(&mut self, i: usize, count: u32, guards: &mut Guards) -> Option<Place> {
        let (device, index) = self.first_of(i)?;
        let wide = self.wide();
        let exists = index.is_some() || self.exists(device.class, device.number, count);
        let place = self.place(device, index, count, wide, guards);
        exists.then_some(place)
    }

    /// The block at operand `i` whose length, at least 1, is only known at run time, and how many devices it may have.
    fn block_of_length(
        &mut self,
        i: usize,
        length: ExprId,
        guards: &mut Guards,
    ) -> Option<(Place, u32)> {
        let (device, index) = self.first_of(i)?;
        let place = fixed(device.class, device.number);
        let Some(written) = index else {
            let runs = self.model.runs(device.class);
            let run = runs
                .into_iter()
                .find(|run| (run.0..=run.1).contains(&device.number));
            let room = run.map_or(0, |(_, last)| last - device.number + 1);
            let most = self.add(Expr::I32(room as i32));
            guards.demand(self.add(Expr::Cmp(CmpOp::Le, length, most)));
            return (room > 0).then_some((place, room));
        };
        let index = self.index(written, self.wide());
        let bound = self.bound(place, written, 1);
        if bound.is_some() {
            self.demand_device(place, index, 1, bound, guards);
        }
        let everywhere = self.within(index, None);
        guards.demand(self.add(Expr::InRange {
            place: Place {
                index: Some(everywhere),
                ..place
            },
            count: 1,
            length: Some(length),
        }));
        let index = self.within(index, bound);
        self.note_index(index, place, written);
        let index = Some(index);
        Some((Place { index, ..place }, u32::MAX))
    }

    /// Copies a block as a whole.
    pub(super) fn copy_block(
        &mut self,
        from: Place,
        to: Place,
        count: u32,
        length: Option<ExprId>,
    ) {
        match count {
            0 => {}
            1 => {
                let access = if is_bits(to) {
                    Access::bit
                } else {
                    Access::word
                };
                let value = self.add(Expr::Read(access(from)));
                self.emit(Action::Write(access(to), value));
            }
            _ => self.emit(Action::Block(Block::Copy {
                from,
                to,
                count,
                length,
            })),
        }
    }

    /// Fills a block with a value.
    pub(super) fn fill_block_with(
        &mut self,
        to: Place,
        count: u32,
        length: Option<ExprId>,
        value: ExprId,
    ) {
        match count {
            0 => {}
            1 => {
                let access = if is_bits(to) {
                    Access::bit
                } else {
                    Access::word
                };
                self.emit(Action::Write(access(to), value));
            }
            _ => self.emit(Action::Block(Block::Fill {
                to,
                count,
                length,
                value,
            })),
        }
    }

    /// The place with its index as it is now, for several statements one after the other.
    pub(super) fn settled_place(&mut self, place: Place) -> Place {
        let index = place.index.map(|index| {
            let index = self.settled(index);
            self.within(index, None)
        });
        Place { index, ..place }
    }

    /// Gives `make` the length in operand 2, from 1 to what BMOV and FMOV move; any other faults.
    fn with_length(&mut self, make: impl FnOnce(&mut Self, ExprId)) {
        let mut guards = Guards::default();
        let length = self.source(2, &mut guards);
        self.guarded(guards, |this| {
            let length = this.settled(length);
            let [least, most] = [1, MOVED as i32].map(|end| this.int(end, false));
            let not_below = this.add(Expr::Cmp(CmpOp::Ge, length, least));
            let not_above = this.add(Expr::Cmp(CmpOp::Le, length, most));
            let fits = this.and(not_below, not_above);
            this.checked(fits, this.model.value_error, |this| {
                let length = this.add(Expr::Widen(length));
                make(this, length);
            });
        });
    }

    /// BMOV; `reversible` if M8024 chooses the direction.
    fn move_run(&mut self, reversible: bool) {
        let copy = move |this: &mut Self, from, to, count, length| {
            if !reversible {
                return this.copy_block(from, to, count, length);
            }
            let cond = this.add(Expr::Read(Access::bit(M_BMOV_REVERSE)));
            let then = this.body(|this| this.copy_block(to, from, count, length));
            let otherwise = this.body(|this| this.copy_block(from, to, count, length));
            this.emit(Stmt::If(Branch {
                cond,
                then,
                otherwise,
            }));
        };
        if let Some(n) = self.operand(2).and_then(constant) {
            let mut guards = Guards::default();
            let blocks = [0, 1].map(|i| self.block_at(i, n as u32, &mut guards));
            return self.guarded(guards, |this| {
                if let [Some(from), Some(to)] = blocks {
                    copy(this, from, to, n as u32, None);
                }
            });
        }
        self.with_length(|this, length| {
            let mut guards = Guards::default();
            let blocks = [0, 1].map(|i| this.block_of_length(i, length, &mut guards));
            this.guarded(guards, |this| {
                if let [Some((from, most)), Some((to, also))] = blocks {
                    copy(this, from, to, MOVED.min(most).min(also), Some(length));
                }
            });
        });
    }

    /// FMOV.
    fn fill_from(&mut self) {
        if let Some(n) = self.operand(2).and_then(constant) {
            let (wide, n) = (self.wide(), n as u32);
            let mut guards = Guards::default();
            let value = self.source(0, &mut guards);
            let words = if wide { 2 * n } else { n };
            let block = self.block_at(1, words, &mut guards);
            return self.guarded(guards, |this| match block {
                Some(to) if wide => this.fill_pairs_from(to, n, value),
                Some(to) => this.fill_block_with(to, n, None, value),
                None => {}
            });
        }
        self.with_length(|this, length| {
            let mut guards = Guards::default();
            let value = this.source(0, &mut guards);
            let block = this.block_of_length(1, length, &mut guards);
            this.guarded(guards, |this| {
                if let Some((to, most)) = block {
                    this.fill_block_with(to, MOVED.min(most), Some(length), value);
                }
            });
        });
    }

    /// Writes a pair and copies what is there until there are `count`.
    pub(super) fn fill_pairs_from(&mut self, to: Place, count: u32, value: ExprId) {
        let to = self.settled_place(to);
        self.emit(Action::Write(Access::pair(to), value));
        let mut there = 1;
        while there < count {
            let more = there.min(count - there);
            self.copy_block(to, after(to, 2 * there), 2 * more, None);
            there += more;
        }
    }

    /// ZRST: where D2 lies below D1, D1 alone.
    fn reset_run(&mut self) {
        let (Some((first, index)), Some((last, last_index))) = (self.first_of(0), self.first_of(1))
        else {
            return;
        };
        let off = match is_bits(fixed(first.class, first.number)) {
            true => self.bit_const(false),
            false => self.int(0, false),
        };
        let mut guards = Guards::default();
        self.demand_bound(last, last_index, &mut guards);
        if index == last_index {
            let count = last.number.saturating_sub(first.number) + 1;
            let block = self.block_at(0, count, &mut guards);
            return self.guarded(guards, |this| {
                if let Some(to) = block {
                    this.fill_block_with(to, count, None, off);
                }
            });
        }
        self.guarded(guards, |this| {
            let [from, to] = [(first, index), (last, last_index)].map(|end| this.number_of(end));
            let distance = this.add(Expr::Bin(BinOp::Sub, to, from));
            let distance = this.settled(distance);
            let zero = this.int(0, true);
            let several = this.add(Expr::Cmp(CmpOp::Gt, distance, zero));
            let then = this.body(|this| {
                let one = this.int(1, true);
                let length = this.add(Expr::Bin(BinOp::Add, distance, one));
                let mut guards = Guards::default();
                let block = this.block_of_length(0, length, &mut guards);
                this.guarded(guards, |this| {
                    if let Some((to, most)) = block {
                        let count = most.min(this.longest(to.class));
                        this.fill_block_with(to, count, Some(length), off);
                    }
                });
            });
            let otherwise = this.body(|this| {
                let mut guards = Guards::default();
                let block = this.block_at(0, 1, &mut guards);
                this.guarded(guards, |this| {
                    if let Some(to) = block {
                        this.fill_block_with(to, 1, None, off);
                    }
                });
            });
            this.emit(Stmt::If(Branch {
                cond: several,
                then,
                otherwise,
            }));
        });
    }

    /// Number of devices in the longest run of a class.
    fn longest(&self, class: DeviceClass) -> u32 {
        let runs = self.model.runs(class).into_iter();
        runs.map(|(first, last)| last - first + 1)
            .max()
            .unwrap_or(1)
    }

    /// The condition that a device which is not accessed lies within the bound of its operand, if it has one.
    fn demand_bound(&mut self, device: Device, index: Option<Index>, guards: &mut Guards) {
        let place = fixed(device.class, device.number);
        let Some(written) = index else {
            return;
        };
        if let Some(bound) = self.bound(place, written, 1) {
            let index = self.index(written, self.wide());
            self.demand_device(place, index, 1, Some(bound), guards);
        }
    }

    /// The number of a device, as an `I32`.
    fn number_of(&mut self, (device, index): First) -> ExprId {
        let number = self.int(device.number as i32, true);
        match index {
            None => number,
            Some(index) => {
                let index = self.index(index, false);
                self.add(Expr::Bin(BinOp::Add, number, index))
            }
        }
    }

    /// SFTR, SFTL, WSFR and WSFL: the devices that stay move, then others enter.
    fn shift_run(&mut self, right: bool) {
        let (length, by) = (self.stated(2), self.stated(3));
        let mut guards = Guards::default();
        let from = self.block_at(0, by, &mut guards);
        let to = self.block_at(1, length, &mut guards);
        self.guarded(guards, |this| {
            let (Some(from), Some(to)) = (from, to) else {
                return;
            };
            let [from, to] = [from, to].map(|place| this.settled_place(place));
            let (stay, enter) = match right {
                true => ((after(to, by), to), after(to, length - by)),
                false => ((to, after(to, by)), to),
            };
            this.copy_block(stay.0, stay.1, length - by, None);
            this.copy_block(from, enter, by, None);
        });
    }
}
