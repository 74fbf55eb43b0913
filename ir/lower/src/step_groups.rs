//! Blocks of the step ladder that a scan leaves out while their states are off: each by itself, and neighbours as one.
//!
//! A block whose state is off, is not being left, and was off before has no effect. Most blocks of a sequence are so. A
//! test of a block replaces what it does ([`Steps`]), and a test of up to [`LARGEST`] neighbours replaces theirs. Up to
//! [`WORD`] neighbours with rising states have one more, since backends have a bit for each. The tests read the states
//! themselves, since MOV, ZRST, an index, a host or a server may write any of them; and each is made where its blocks
//! begin, so that a state that is set further up begins in the same scan.

use super::flow::Open;
use super::{Lowerer, basic_of};
use rungc_analysis::resolve::Resolved;
use rungc_catalogue::Basic;
use rungc_ir::node::{Body, EdgeId, Steps};
use rungc_syntax::DeviceClass;
use rustc_hash::FxHashMap;
use std::ops::Range;

/// Minimum and maximum number of blocks that are left out together.
const SMALLEST: usize = 4;
const LARGEST: usize = 8;
/// Maximum number of states that a test of these reads: two words of a 64-bit machine.
const WIDEST: u32 = 16;
/// Maximum number of states of blocks that are together once more.
const WORD: u32 = 32;
/// Maximum number of their instructions: those of a function.
const LONGEST: usize = 256;

/// A block of one state, from STL to the next one or RET, which control enters and leaves nowhere else.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
struct Block {
    /// Its STL.
    at: usize,
    /// Its state.
    state: u32,
    /// The instruction that ends it.
    end: usize,
}

/// Tests that leave blocks out.
#[derive(Default)]
pub(super) struct Guards {
    /// Those that begin with a block, by its STL: outermost first.
    begin: FxHashMap<usize, Vec<Steps>>,
    /// Number of those that end with a block, by its STL.
    end: FxHashMap<usize, u32>,
    /// Memories of whether a block was on, by its STL.
    was_on: FxHashMap<usize, EdgeId>,
    /// Number of tests that end with the block at hand.
    open: u32,
}

/// The blocks of a program that may be left out, in order.
fn blocks(resolved: &Resolved) -> Vec<Block> {
    let count = resolved.instrs.len();
    let starts: Vec<usize> = (0..count)
        .filter(|&i| basic_of(resolved, i) == Some(Basic::Stl))
        .collect();
    let mut uses: FxHashMap<u32, u32> = FxHashMap::default();
    for &at in &starts {
        *uses
            .entry(state(resolved, at).unwrap_or(u32::MAX))
            .or_default() += 1;
    }
    let mut blocks = Vec::new();
    for &at in &starts {
        let ends = |&i: &usize| matches!(basic_of(resolved, i), Some(Basic::Stl | Basic::Ret));
        let end = (at + 1..count).find(ends).unwrap_or(count);
        let plain =
            (at + 1..end).all(|i| is_plain(resolved, i)) && resolved.instrs[at].label.is_none();
        if let Some(state) = state(resolved, at)
            && uses.get(&state) == Some(&1)
            && plain
            && !is_in_row(resolved, at, end)
            && end < count
        {
            blocks.push(Block { at, state, end });
        }
    }
    blocks
}

/// The state of an STL.
fn state(resolved: &Resolved, at: usize) -> Option<u32> {
    let device = resolved
        .program
        .instrs
        .get(at)?
        .operands
        .first()?
        .kind
        .device()?;
    (device.class == DeviceClass::S).then_some(device.number)
}

/// Returns true if an STL, whose block ends at `end`, continues a row of STLs or is continued by one.
fn is_in_row(resolved: &Resolved, at: usize, end: usize) -> bool {
    let empty = |range: Range<usize>| {
        let mut others = range.filter(|&i| basic_of(resolved, i) != Some(Basic::Nop));
        others.next().is_none()
    };
    let is_stl = |i: usize| basic_of(resolved, i) == Some(Basic::Stl);
    let before = (0..at)
        .rev()
        .find(|&i| basic_of(resolved, i) != Some(Basic::Nop));
    before.is_some_and(is_stl) || is_stl(end) && empty(at + 1..end)
}

/// Returns true if an instruction neither is the target of a jump nor changes the flow beyond itself.
fn is_plain(resolved: &Resolved, i: usize) -> bool {
    let changes = matches!(
        basic_of(resolved, i),
        Some(
            Basic::Label
                | Basic::Cj
                | Basic::For
                | Basic::Next
                | Basic::Mc
                | Basic::Mcr
                | Basic::Fend
                | Basic::End
                | Basic::Sret
                | Basic::Iret
                | Basic::Pret
                | Basic::Proc
                | Basic::Pend
        )
    );
    !changes && resolved.instrs[i].label.is_none()
}

/// The groups of these blocks, a ladder after those in it.
fn groups(blocks: &[Block]) -> Vec<Range<usize>> {
    let mut groups = Vec::new();
    let mut neighbours = |range: Range<usize>| {
        let parts = divided(&blocks[range.clone()], LARGEST, are_close).into_iter();
        let parts = parts.filter(|part| part.len() >= SMALLEST);
        groups.extend(parts.map(|part| range.start + part.start..range.start + part.end));
    };
    let mut ladders = divided(blocks, WORD as usize, are_ladder);
    ladders.retain(|ladder| ladder.len() > LARGEST);
    let mut from = 0;
    for ladder in &ladders {
        neighbours(from..ladder.start);
        neighbours(ladder.clone());
        from = ladder.end;
    }
    neighbours(from..blocks.len());
    groups.extend(ladders);
    groups
}

/// Divides blocks into neighbours of about the same number, not more than this one, that are as `alike` says.
fn divided(
    blocks: &[Block],
    largest: usize,
    alike: impl Fn(&[Block]) -> bool,
) -> Vec<Range<usize>> {
    let mut parts = Vec::new();
    let mut from = 0;
    while from < blocks.len() {
        let follows = |i: &usize| *i == from || blocks[i - 1].end == blocks[*i].at;
        let run = (from..blocks.len()).take_while(follows).count();
        let size = run.div_ceil(run.div_ceil(largest));
        let ends = (from + 2..=from + size).take_while(|&end| alike(&blocks[from..end]));
        let end = ends.last().unwrap_or(from + 1);
        parts.push(from..end);
        from = end;
    }
    parts
}

/// Returns true if the states of some blocks lie close together.
fn are_close(blocks: &[Block]) -> bool {
    let states = || blocks.iter().map(|block| block.state);
    let spread = states().max().zip(states().min());
    spread.is_none_or(|(high, low)| high - low < WIDEST)
}

/// Returns true if the states of some blocks rise, so that a word has a bit for each.
fn are_ladder(blocks: &[Block]) -> bool {
    let (Some(first), Some(last)) = (blocks.first(), blocks.last()) else {
        return false;
    };
    blocks.is_sorted_by_key(|block| block.state)
        && last.state - first.state < WORD
        && last.end - first.at <= LONGEST
}

impl Lowerer<'_> {
    /// Decides which blocks are left out. Interrupts are taken at the start of each network, so each block is tested by
    /// itself where there are any; a marked module has no tests, since it shows how each network is executed.
    pub(super) fn guard_steps(&mut self) {
        if self.marks.is_some() {
            return;
        }
        let blocks = blocks(self.resolved);
        let tests: Vec<Steps> = blocks.iter().map(|block| self.test_of(block)).collect();
        let groups = match self.takes_interrupts() {
            true => Vec::new(),
            false => groups(&blocks),
        };
        let guards = &mut self.steps.guards;
        for (block, test) in blocks.iter().zip(&tests) {
            guards.begin.insert(block.at, vec![test.clone()]);
            guards.end.insert(block.at, 1);
        }
        for group in groups {
            let (first, last) = (group.start, group.end - 1);
            let test = joined(&tests[group]);
            guards
                .begin
                .entry(blocks[first].at)
                .or_default()
                .insert(0, test);
            *guards.end.entry(blocks[last].at).or_default() += 1;
        }
    }

    /// The test of a block, with new memories.
    fn test_of(&mut self, block: &Block) -> Steps {
        // Also a state that nothing leaves has a mark, so that all blocks begin alike.
        let memory = self.new_edge();
        self.steps.set_mark(block.state, memory);
        let was_on = self.new_edge();
        self.steps.guards.was_on.insert(block.at, was_on);
        Steps {
            first: block.state,
            states: 1,
            memory,
            memories: self.module.edges - memory.0,
            body: Body::new(),
        }
    }

    /// The memory of whether the block at hand was on.
    pub(super) fn was_on(&mut self) -> EdgeId {
        match self.steps.guards.was_on.get(&self.at) {
            Some(&memory) => memory,
            None => self.new_edge(),
        }
    }

    /// Opens the tests that begin with the block at hand.
    pub(super) fn open_tests(&mut self) {
        let guards = &mut self.steps.guards;
        guards.open = guards.end.get(&self.at).copied().unwrap_or(0);
        for steps in guards.begin.remove(&self.at).unwrap_or_default() {
            let outer = std::mem::take(&mut self.out);
            self.open.push(Open::Steps { steps, outer });
        }
    }

    /// Closes the tests that end with the block at hand.
    pub(super) fn close_tests(&mut self) {
        for _ in 0..std::mem::take(&mut self.steps.guards.open) {
            self.close();
        }
    }
}

/// One test instead of those of neighbours.
fn joined(tests: &[Steps]) -> Steps {
    let low = tests.iter().map(|test| test.first).min().unwrap_or(0);
    let high = tests.iter().map(|test| test.first).max().unwrap_or(0);
    Steps {
        first: low,
        states: high - low + 1,
        memory: tests[0].memory,
        memories: tests.iter().map(|test| test.memories).sum(),
        body: Body::new(),
    }
}
