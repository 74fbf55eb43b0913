//! COMRD: comments of devices, which are known when the program is compiled.

use super::Lowerer;
use super::operand::Guards;
use rungc_ir::node::{Access, Expr};
use rungc_rt::special::M_TEXT_OPEN;
use rungc_syntax::{Device, OperandKind, codes};

/// Characters of a comment on the PLC.
const LENGTH: usize = 16;

/// Characters of a comment in emitted code at most. The editors allow 64 in a statement, 32 in a note and in a device
/// comment; C99 promises no more than 4095 bytes in a string, and a reader wants far less on a line.
const EMITTED: usize = 400;

/// A comment as emitted code shows it: cut, with `…` at its end, if it is longer than any editor's.
pub(super) fn shortened(text: &str) -> String {
    match text.char_indices().nth(EMITTED) {
        Some((end, _)) => format!("{}…", text[..end].trim_end()),
        None => text.to_owned(),
    }
}

impl Lowerer<'_> {
    /// COMRD S D: the characters of S's comment, two a word, padded with spaces, with a zero after them unless M8091 is
    /// on.
    pub(super) fn device_comment(&mut self) {
        let (device, span) = match (self.operand(0), self.instr().operands.first()) {
            (Some(&OperandKind::Device(device, None)), Some(operand)) => (device, operand.span),
            _ => return,
        };
        let Some(characters) = self.characters(device) else {
            let message = format!("the comment of `{device}` is not written in ASCII characters");
            return self.report(
                codes::NOT_IMPLEMENTED
                    .at(span, message)
                    .label("how the PLC stores others is not known"),
            );
        };
        let mut guards = Guards::default();
        let words = LENGTH as u32 / 2;
        let targets: Vec<_> = (0..=words)
            .map(|element| self.result_element(1, element, false, &mut guards))
            .collect();
        self.guarded(guards, |this| {
            for (target, pair) in targets.iter().zip(characters.chunks(2)) {
                let word = i16::from_le_bytes([pair[0], pair[1]]);
                let word = this.int(word.into(), false);
                this.store(*target, word);
            }
            let open = if this.specials.has(M_TEXT_OPEN) {
                this.add(Expr::Read(Access::bit(M_TEXT_OPEN)))
            } else {
                this.bit_const(false)
            };
            let closed = this.not(open);
            this.when(closed, |this| {
                if let Some(end) = targets.last() {
                    let zero = this.int(0, false);
                    this.store(*end, zero);
                }
            });
        });
    }

    /// A comment as the PLC holds it; `None` if it has characters that are not ASCII. A device without one has spaces.
    fn characters(&self, device: Device) -> Option<[u8; LENGTH]> {
        let comment = self.resolved.program.comments.get(&device);
        let comment = comment.map_or("", String::as_str);
        let mut characters = [b' '; LENGTH];
        for (place, character) in characters.iter_mut().zip(comment.chars()) {
            *place = u8::try_from(character).ok().filter(u8::is_ascii)?;
        }
        Some(characters)
    }
}
