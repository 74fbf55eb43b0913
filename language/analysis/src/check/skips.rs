//! Jumps that decide which instructions a run of a routine executes.

use super::Code;
use super::pointers::Pointers;
use rungc_catalogue::Basic;

/// Shares are computed modulo this prime.
const PRIME: u64 = (1 << 61) - 1;

/// All runs.
pub(super) const ALL: u64 = 1;

/// Share of the runs of a routine in which each instruction is executed, as if each jump were taken in an arbitrary but
/// fixed share of them. Instructions that are executed in the same runs have equal shares, and others different ones.
/// `None` without jumps.
pub(super) struct Skips(Option<Vec<u64>>);

impl Skips {
    pub(super) fn new(code: &Code, pointers: &Pointers) -> Self {
        let jumps = (0..code.len).any(|i| code.basic(i) == Some(Basic::Cj));
        Skips(jumps.then(|| Paths::new(code, pointers).shares()))
    }

    /// Share of the runs that execute an instruction.
    pub(super) fn share(&self, i: usize) -> u64 {
        self.0.as_ref().map_or(ALL, |shares| shares[i])
    }

    /// A mark of the jumps that decide on an instruction: instructions with different marks need not run in the same
    /// scan. 0: each run of the routine executes it.
    pub(super) fn mark(&self, i: usize) -> u64 {
        minus(self.share(i), ALL)
    }
}

/// Sum of two shares.
pub(super) fn plus(a: u64, b: u64) -> u64 {
    (a + b) % PRIME
}

fn minus(a: u64, b: u64) -> u64 {
    plus(a, PRIME - b)
}

fn times(a: u64, b: u64) -> u64 {
    (u128::from(a) * u128::from(b) % u128::from(PRIME)) as u64
}

/// A share for instruction `i`, such that sums and products of them differ.
fn arbitrary(i: usize) -> u64 {
    let mut bits = (i as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    (bits ^ bits >> 31) % PRIME
}

/// Progress of the search at an instruction.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Visit {
    New,
    /// What follows it is being searched.
    Open,
    Done,
}

/// The ways through the instructions. A last one stands for the end of the run.
struct Paths {
    /// True where a routine begins.
    begins: Vec<bool>,
    /// True at a label to which a jump with an index register may lead.
    may_begin: Vec<bool>,
    /// For each instruction the one that follows it, and the one to which it jumps.
    next: Vec<[Option<usize>; 2]>,
    /// Instructions, each before those that are executed after it.
    order: Vec<usize>,
}

impl Paths {
    fn new(code: &Code, pointers: &Pointers) -> Self {
        let mut paths = Paths {
            begins: vec![false; code.len + 1],
            may_begin: vec![false; code.len + 1],
            next: vec![[None; 2]; code.len + 1],
            order: Vec::with_capacity(code.len + 1),
        };
        let mut after_fend = false;
        for i in 0..code.len {
            let label = code.label(i);
            let is_routine = label.is_some_and(|label| pointers.begins_routine(label, after_fend));
            paths.begins[i] = i == 0 || is_routine;
            paths.may_begin[i] = label.is_some() && pointers.any_may_be_jumped_to();
            let target = || target(code, pointers, i);
            paths.next[i] = match code.basic(i) {
                Some(Basic::End | Basic::Fend | Basic::Sret | Basic::Iret | Basic::Pret) => {
                    [None; 2]
                }
                Some(Basic::Cj) => [Some(i + 1), Some(target())],
                _ => [Some(i + 1), None],
            };
            after_fend |= code.basic(i) == Some(Basic::Fend);
        }
        paths.search();
        paths
    }

    /// Finds the order, and removes the ways back to the beginning of a loop, which is executed at least once.
    fn search(&mut self) {
        let mut visits = vec![Visit::New; self.next.len()];
        let mut stack = Vec::new();
        for begin in 0..self.next.len() {
            let is_begin = self.begins[begin] || self.may_begin[begin];
            stack.extend(Some(begin).filter(|_| is_begin && visits[begin] == Visit::New));
            while let Some(&i) = stack.last() {
                visits[i] = Visit::Open;
                for way in &mut self.next[i] {
                    *way = way.filter(|&to| visits[to] != Visit::Open);
                }
                let mut ways = self.next[i].into_iter().flatten();
                if let Some(to) = ways.find(|&to| visits[to] == Visit::New) {
                    stack.push(to);
                } else {
                    visits[i] = Visit::Done;
                    self.order.push(i);
                    stack.pop();
                }
            }
        }
        self.order.reverse();
    }

    /// The share of the runs that reach each instruction.
    fn shares(&self) -> Vec<u64> {
        let mut shares = vec![0; self.next.len()];
        for &i in &self.order {
            if self.begins[i] {
                shares[i] = ALL;
            } else if self.may_begin[i] {
                shares[i] = plus(shares[i], arbitrary(i));
            }
            let share = shares[i];
            let mut pass = |to: usize, share| shares[to] = plus(shares[to], share);
            match self.next[i] {
                [Some(next), Some(label)] => {
                    let jumping = times(share, arbitrary(i));
                    pass(label, jumping);
                    pass(next, minus(share, jumping));
                }
                [Some(only), None] | [None, Some(only)] => pass(only, share),
                [None, None] => {}
            }
        }
        shares
    }
}

/// Instruction to which a jump leads; the end of the run, if that is not known.
fn target(code: &Code, pointers: &Pointers, i: usize) -> usize {
    let pointer = code.device(i, 0).and_then(|device| pointers.get(device));
    let label = pointer.and_then(|pointer| pointer.labels.first());
    label.copied().unwrap_or(code.len)
}
