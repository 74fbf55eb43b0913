//! Forward jumps that skip instructions.

use super::Code;
use super::pointers::Pointers;
use rungc_catalogue::Basic;
use rungc_syntax::DeviceClass;

/// Forward jumps that skip each instruction.
pub(super) struct Skips(Option<Vec<u64>>);

impl Skips {
    pub(super) fn new(code: &Code, pointers: &Pointers) -> Self {
        let mut marks = vec![0u64; code.len + 1];
        let mut any = false;
        for (device, pointer) in pointers.iter() {
            let end = code.model().end_pointer;
            let to_end = device.class == DeviceClass::P && end == Some(device.number);
            let label = match pointer.labels.first() {
                Some(&label) => label,
                None if to_end => end_of_main(code),
                None => continue,
            };
            for &jump in pointer.jumps.iter().filter(|&&jump| jump < label) {
                // A hash per jump, so that the marks of different sets of jumps differ.
                let mark = (jump as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
                marks[jump] ^= mark;
                marks[label] ^= mark;
                any = true;
            }
        }
        Skips(any.then(|| {
            marks
                .into_iter()
                .scan(0, |mark, change| {
                    *mark ^= change;
                    Some(*mark)
                })
                .collect()
        }))
    }

    /// A mark of the jumps that skip an instruction: instructions with different marks need not run in the same scan.
    /// 0: none does.
    pub(super) fn mark(&self, i: usize) -> u64 {
        self.0.as_ref().map_or(0, |marks| marks[i])
    }
}

/// Place at which the main program ends.
fn end_of_main(code: &Code) -> usize {
    let fend = (0..code.len).find(|&i| code.basic(i) == Some(Basic::Fend));
    fend.unwrap_or(code.len)
}
