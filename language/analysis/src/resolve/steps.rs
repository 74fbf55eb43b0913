//! Counts steps, and compares them with the step numbers that the source states.

use rungc_models::Model;
use rungc_syntax::{Diagnostics, Instr, Parameters, Phrase, Program, Span, codes, phrase};

/// Counts steps from instruction to instruction.
#[derive(Default)]
pub(super) struct Counter {
    /// Steps so far.
    counted: u32,
    /// Difference by which the source's numbers run ahead of the count.
    ahead: i64,
    /// True if the last instruction's length is unknown, so that the next number is accepted.
    lost: bool,
    /// The first place where the source's numbers leave the count: span, number stated, number counted.
    first: Option<(Span, u32, u32)>,
    /// Number of such mismatches.
    mismatches: u32,
}

impl Counter {
    /// Takes the next instruction with its length, `None` if it is not known, and gives its step number.
    pub(super) fn next(&mut self, instr: &Instr, length: Option<u32>) -> u32 {
        let expected = self.numbered();
        if let Some(stated) = instr.step
            && stated != expected
        {
            if !self.lost {
                self.first.get_or_insert((instr.span, stated, expected));
                self.mismatches += 1;
            }
            self.ahead = i64::from(stated) - i64::from(self.counted);
        }
        let step = self.numbered();
        self.lost = length.is_none();
        self.counted = self.counted.saturating_add(length.unwrap_or(1));
        step
    }

    /// Goes past something that could not be read, so that the next number is taken as it is.
    pub(super) fn lose(&mut self) {
        self.lost = true;
        self.counted = self.counted.saturating_add(1);
    }

    /// The number that the next instruction should have in the source's count.
    fn numbered(&self) -> u32 {
        let number = i64::from(self.counted) + self.ahead;
        u32::try_from(number.max(0)).unwrap_or(u32::MAX)
    }

    /// Reports what does not fit, and gives the length of the program.
    pub(super) fn finish(self, program: &Program, model: &Model, out: &mut Diagnostics) -> u32 {
        // Of a project, the length that each code states was held to the instruction already.
        let listed = !program.kind.is_project();
        if let Some((span, stated, expected)) = self.first.filter(|_| listed) {
            let more = match self.mismatches {
                1 => Phrase::default(),
                n => phrase!(" (and {n} more such steps after it)", n = n - 1),
            };
            let message = phrase!(
                "the source numbers this step {stated}, but on {model} it is step {expected}{more}",
                stated,
                model = model.name,
                expected,
                more
            );
            out.push(
                codes::STEPS_DIFFER
                    .at(span, message)
                    .label(phrase!("step {expected}, counting the instructions before it", expected))
                    .help("the program may be for another model (`--model`), or a line may be missing before this one"),
            );
        }
        let parameters = program.parameters.as_ref();
        let own = parameters.and_then(Parameters::program_steps);
        let own = own.filter(|&steps| steps < model.max_steps);
        if self.counted > own.unwrap_or(model.max_steps)
            && let Some(last) = program.instrs.last()
        {
            let room = match own {
                Some(steps) => phrase!(
                    "the memory capacity in the PLC parameters leaves {steps}",
                    steps
                ),
                None => phrase!(
                    "{model} holds {max_steps}",
                    model = model.name,
                    max_steps = model.max_steps
                ),
            };
            let message = phrase!(
                "the program has {counted} steps, but {room}",
                counted = self.counted,
                room
            );
            let warning = codes::TOO_LONG.at(last.span, message);
            out.push(match own {
                Some(_) => warning.help("choose a larger memory capacity in the PLC parameters"),
                None => warning,
            });
        }
        self.counted
    }
}
