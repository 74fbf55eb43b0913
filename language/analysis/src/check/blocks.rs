//! Contact logic: blocks begun by LD, joined by ANB and ORB, branched by MPS, MRD and MPP, and what they drive.
//!
//! A block is *spent* when its result has driven something. An LD then begins a new rung, unless a following ANB joins
//! the new block to the spent one: lists of rungs that branch again after a coil are written like this (hm-programming
//! §5.2, MPS). Blocks to the left of a spent one wait for an ANB or ORB that joins it to them.

use super::{Code, Part};
use rungc_catalogue::Basic;
use rungc_syntax::{Diagnostic, Diagnostics, Fix, codes, phrase};

/// Maximum number of blocks that may wait to be joined.
const MAX_BLOCKS: usize = 8;
/// Maximum number of results that MPS can store.
const MAX_BRANCHES: usize = 11;

/// A block of contacts.
struct Block {
    /// Its first instruction.
    start: usize,
    /// True if its result has driven something.
    spent: bool,
}

/// A result stored by MPS.
struct Branch {
    /// The MPS.
    at: usize,
    /// Number of blocks, the stored one included.
    blocks: usize,
    /// The last MRD that returned to it.
    read: Option<usize>,
}

struct Rungs<'a, 'p> {
    code: &'a Code<'p>,
    out: &'a mut Diagnostics,
    /// True for each LD that begins a rung.
    starts_rung: Vec<bool>,
    /// The blocks of the rung; the last one is the current result.
    blocks: Vec<Block>,
    branches: Vec<Branch>,
    /// The MPP that closed the last open branch of the rung.
    closed: Option<usize>,
    /// True if coils may be directly on the bus, because it is the sub-bus of a state.
    in_state: bool,
    /// After an instruction that could not be resolved, nothing is certain until a new rung starts.
    unsure: Option<Unsure>,
}

/// Uncertainty about the rung after an instruction that could not be resolved.
enum Unsure {
    /// It continues.
    Rung,
    /// Something was driven, so the next block may begin a new rung.
    Driven,
}

/// Checks the contact logic of a program.
pub(super) fn check(code: &Code, out: &mut Diagnostics) {
    let mut rungs = Rungs {
        code,
        out,
        starts_rung: code.resolved.starts_of_rungs(),
        blocks: Vec::new(),
        branches: Vec::new(),
        closed: None,
        in_state: false,
        unsure: None,
    };
    let mut unread = code.unread();
    for i in 0..code.len {
        if unread.next_if(|&before| before as usize <= i).is_some() {
            while unread.next_if(|&before| before as usize <= i).is_some() {}
            rungs.unknown();
        }
        rungs.instr(i);
    }
    if unread.next().is_some() {
        rungs.unknown();
    }
    rungs.finish(None);
}

impl Rungs<'_, '_> {
    fn instr(&mut self, i: usize) {
        let part = self.code.part(i);
        match part {
            Part::Unknown => {
                self.unknown();
                self.pass_state(i);
            }
            Part::Alone => self.alone(i),
            _ if self.unsure.is_some() => self.behind_unknown(i, part),
            Part::Nothing => self.nothing(),
            Part::Start => self.start(i),
            Part::Continue => self.go_on(i),
            Part::JoinSeries | Part::JoinParallel => self.join(i, part),
            Part::Push => self.push(i),
            Part::Read | Part::Pop => self.go_back(i, part),
            Part::Output => self.output(i),
        }
    }

    /// Stands for an instruction of which nothing is known.
    fn unknown(&mut self) {
        self.blocks.clear();
        self.branches.clear();
        self.unsure = Some(Unsure::Rung);
    }

    fn behind_unknown(&mut self, i: usize, part: Part) {
        match (part, &self.unsure) {
            (Part::Output, _) => self.unsure = Some(Unsure::Driven),
            (Part::Start, Some(Unsure::Driven)) => {
                self.unsure = None;
                self.start(i);
            }
            _ => {}
        }
    }

    fn report(&mut self, diagnostic: Diagnostic) {
        self.out.push(diagnostic);
    }

    /// NOP also marks the place of a deleted coil: the contacts before it drive nothing, which the PLC accepts.
    fn nothing(&mut self) {
        if let Some(block) = self.blocks.last_mut() {
            block.spent = true;
        }
    }

    fn start(&mut self, i: usize) {
        let spent = false;
        self.closed = None;
        self.blocks.push(Block { start: i, spent });
        let unspent = self.blocks.iter().rev().take(MAX_BLOCKS + 2);
        let waiting = unspent.take_while(|block| !block.spent).count();
        if waiting == MAX_BLOCKS + 1 {
            let first = self.blocks[self.blocks.len() - waiting].start;
            let diagnostic = codes::TOO_MANY_BLOCKS
                .at(
                    self.code.span(i),
                    "more than eight blocks are waiting to be joined",
                )
                .label("the ninth block")
                .other(self.code.span(first), "the first one starts here")
                .help("write ANB or ORB after each block instead of all at the end");
            self.report(diagnostic);
        }
    }

    fn go_on(&mut self, i: usize) {
        match self.blocks.last_mut() {
            Some(block) => block.spent = false,
            None => {
                let message = phrase!(
                    "`{instr}` has no contact to continue",
                    instr = self.code.instr(i)
                );
                let diagnostic = codes::NO_START
                    .at(self.code.span(i), message)
                    .label("no chain of contacts has started")
                    .help("start it with LD, LDI, LDP or LDF");
                self.report(diagnostic);
                self.start(i);
            }
        }
    }

    fn join(&mut self, i: usize, part: Part) {
        let name = &self.code.instr(i).mnemonic;
        let n = self.blocks.len();
        let joins_spent = part == Part::JoinSeries;
        let joinable =
            n >= 2 && !self.blocks[n - 1].spent && (joins_spent || !self.blocks[n - 2].spent);
        if joinable {
            self.blocks.pop();
            if let Some(block) = self.blocks.last_mut() {
                block.spent = false;
            }
            return;
        }
        let diagnostic = codes::NO_BLOCK.at(
            self.code.span(i),
            phrase!("`{name}` needs two blocks", name),
        );
        let diagnostic = match self.blocks.last() {
            Some(block) => diagnostic
                .label("there is only one block before it")
                .other(self.code.span(block.start), "which starts here"),
            None => diagnostic.label("there is no block before it"),
        };
        let help = phrase!(
            "delete this {name}, or start the second block with LD",
            name
        );
        self.report(diagnostic.help(help));
    }

    fn push(&mut self, i: usize) {
        if self.blocks.is_empty() {
            let diagnostic = codes::NO_START
                .at(self.code.span(i), "MPS has no result to store")
                .label("no chain of contacts has started")
                .help("start it with LD, LDI, LDP or LDF");
            self.report(diagnostic);
            self.start(i);
        }
        let blocks = self.blocks.len();
        self.branches.push(Branch {
            at: i,
            blocks,
            read: None,
        });
        self.closed = None;
        if self.branches.len() == MAX_BRANCHES + 1 {
            let first = self.branches[0].at;
            let diagnostic = codes::TOO_MANY_BRANCHES
                .at(self.code.span(i), "more than eleven branches are open")
                .label("the twelfth MPS")
                .other(self.code.span(first), "the first one is here")
                .help("close branches with MPP, or start a new rung with a relay that holds the result");
            self.report(diagnostic);
        }
    }

    fn go_back(&mut self, i: usize, part: Part) {
        let name = &self.code.instr(i).mnemonic;
        let Some(branch) = self.branches.last_mut() else {
            let diagnostic = codes::NO_BRANCH
                .at(self.code.span(i), phrase!("`{name}` without MPS", name))
                .label("no result is stored here");
            let diagnostic = match self.closed.filter(|_| part == Part::Pop) {
                // The branch is there; it was closed too early.
                Some(closed) => diagnostic
                    .other(self.code.span(closed), "this MPP closed the branch")
                    .help("write MRD to return to a branch that continues")
                    .fix(self.write("MRD", closed)),
                None => diagnostic.help(phrase!(
                    "delete this {name}, or put MPS where the branch starts",
                    name
                )),
            };
            self.report(diagnostic);
            let closed = self.closed.map(|_| i).filter(|_| part == Part::Pop);
            if self.blocks.is_empty() {
                self.start(i);
            }
            self.closed = closed;
            return;
        };
        let (at, blocks) = (branch.at, branch.blocks);
        branch.read = Some(i);
        if part == Part::Pop {
            self.branches.pop();
            self.closed = Some(i).filter(|_| self.branches.is_empty());
        }
        let open = self.blocks.get(blocks).map(|block| block.start);
        if let Some(open) = open {
            let diagnostic = codes::CROSSED_BRANCH
                .at(
                    self.code.span(i),
                    phrase!("`{name}` leaves a block that was not joined", name),
                )
                .label("returns to the branch")
                .other(self.code.span(open), "this block is still open")
                .other(self.code.span(at), "the branch starts here")
                .help("join the block with ANB or ORB first");
            self.report(diagnostic);
        }
        self.blocks.truncate(blocks);
        match self.blocks.last_mut() {
            Some(block) => block.spent = false,
            None => self.start(i),
        }
    }

    fn output(&mut self, i: usize) {
        let Some(top) = self.blocks.len().checked_sub(1) else {
            if !self.in_state {
                let message = phrase!(
                    "`{mnemonic}` needs a contact before it",
                    mnemonic = self.code.instr(i).mnemonic
                );
                let diagnostic = codes::NO_CONTACT
                    .at(self.code.span(i), message)
                    .label("connected directly to the bus")
                    .help("put LD M8000 before it to run it always");
                self.report(diagnostic);
            }
            return;
        };
        if !self.starts_rung[self.blocks[top].start] {
            // What waits to its left is joined later: GX Works2 loads index registers in the middle of a rung.
            self.blocks[top].spent = true;
            return;
        }
        let lost = self.blocks[..top]
            .iter()
            .find(|block| !block.spent)
            .map(|block| block.start);
        if let Some(lost) = lost {
            let diagnostic = codes::NOT_JOINED
                .at(
                    self.code.span(lost),
                    "nothing joins this block to the next one",
                )
                .label("the result of this block is lost")
                .other(
                    self.code.span(self.blocks[top].start),
                    "the next block starts here",
                )
                .other(self.code.span(i), "and alone drives this")
                .help("join the blocks with ANB (both) or ORB (either)");
            self.report(diagnostic);
        }
        self.blocks[top].spent = true;
        if top > 0 {
            self.begin_new_rung(i, top);
        }
    }

    /// Forgets the blocks below the topmost one, which has driven `i`: with it a new rung has begun.
    fn begin_new_rung(&mut self, i: usize, top: usize) {
        self.blocks.drain(..top);
        for mut branch in std::mem::take(&mut self.branches) {
            if branch.blocks > top {
                branch.blocks -= top;
                self.branches.push(branch);
                continue;
            }
            let diagnostic = self.open_branch(&branch);
            let started = (self.code.span(i), "a new rung started before this");
            self.report(diagnostic.other(started.0, started.1));
        }
    }

    /// The error about a branch without MPP. Where MRD returns to it last, MPP there does the same and closes it.
    fn open_branch(&self, branch: &Branch) -> Diagnostic {
        let diagnostic = codes::OPEN_BRANCH
            .at(self.code.span(branch.at), "no MPP closes this branch")
            .label("stored here");
        match branch.read {
            Some(last) => diagnostic
                .other(self.code.span(last), "the last return to it")
                .help("write MPP for the last return to a branch")
                .fix(self.write("MPP", last)),
            None => {
                diagnostic.help("put MPP before the last coil of the branch, or delete this MPS")
            }
        }
    }

    /// The fix that writes another mnemonic for an instruction without operands.
    fn write(&self, mnemonic: &'static str, i: usize) -> Fix {
        Fix::certain(phrase!("write {mnemonic}", mnemonic))
            .replace(self.code.instr(i).mnemonic_span, mnemonic)
    }

    fn alone(&mut self, i: usize) {
        self.unsure = None;
        self.finish(Some(i));
        self.pass_state(i);
    }

    fn pass_state(&mut self, i: usize) {
        match self.code.basic(i) {
            Some(Basic::Stl) => self.in_state = true,
            Some(Basic::Ret | Basic::Fend | Basic::Label) => self.in_state = false,
            _ => {}
        }
    }

    /// Ends the rung before an instruction without contacts, or at the end of the program.
    fn finish(&mut self, before: Option<usize>) {
        for branch in std::mem::take(&mut self.branches) {
            let diagnostic = self.open_branch(&branch);
            self.report(diagnostic);
        }
        let unspent = self
            .blocks
            .iter()
            .find(|block| !block.spent)
            .map(|block| block.start);
        self.blocks.clear();
        let Some(start) = unspent else {
            return;
        };
        let ends =
            before.filter(|&i| !matches!(self.code.basic(i), Some(Basic::End | Basic::Fend)));
        let diagnostic = match ends {
            Some(i) => codes::STANDS_ALONE
                .at(
                    self.code.span(i),
                    phrase!("`{mnemonic}` must not have contacts before it", mnemonic = self.code.instr(i).mnemonic),
                )
                .label("must be connected directly to the bus")
                .other(self.code.span(start), "these contacts drive nothing")
                .help(match self.code.basic(i) {
                    Some(Basic::For) => "end the rung with a coil before it, or jump over the loop with CJ if it is to run under a condition",
                    _ => "end the rung with a coil before it, or delete these contacts",
                }),
            None => codes::NO_COIL
                .at(self.code.span(start), "these contacts drive nothing")
                .label("the result of this block is lost")
                .help("end the rung with a coil or an instruction"),
        };
        self.report(diagnostic);
    }
}
