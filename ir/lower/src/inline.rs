//! Selection of the instructions that are inline code although the runtime has functions for them.

use super::{Lowerer, annunciators, blocks, digits, drums, queues, times, words};
use rungc_rt::RtFn;
use rungc_syntax::Instr;

/// Returns true if an instruction is inline code, judging by its operands. It may still be a call where flags ask for
/// more than the code here does.
pub(super) fn is_inline(function: RtFn, instr: &Instr, wide: bool) -> bool {
    words::is_inline(function, instr)
        || digits::is_inline(function, instr)
        || times::is_inline(function, instr)
        || blocks::is_inline(function, instr, wide)
        || queues::is_inline(function, instr)
        || drums::is_inline(function, instr)
        || annunciators::is_inline(function, instr)
}

/// Returns true if the flags of an instruction's row are to be stored: by those that the runtime executes, and by those
/// that read them.
pub(super) fn has_flags(function: RtFn, instr: &Instr, wide: bool) -> bool {
    !is_inline(function, instr, wide) || digits::reads_flag(function)
}

impl Lowerer<'_> {
    /// Emits an instruction as inline code; false if the runtime has to be called.
    pub(super) fn inlined(&mut self, function: RtFn) -> bool {
        self.inline_words(function)
            || self.inline_digits(function)
            || self.inline_times(function)
            || self.inline_block(function)
            || self.inline_queue(function)
            || self.inline_drum(function)
            || self.inline_annunciator(function)
    }
}
