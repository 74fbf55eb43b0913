//! Stack of a function in Thumb code, and its calls: read from its instructions.

/// Use of the stack by a function.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Frame {
    /// Bytes that it takes at most: the sum of all that its instructions push or subtract from SP.
    pub bytes: u32,
    /// Addresses that it calls or jumps to.
    pub calls: Vec<u32>,
    /// It calls through a register.
    pub indirect: bool,
    /// It takes as many bytes as a register says, which is unknown.
    pub dynamic: bool,
    /// Constants that it puts together in registers, which may be addresses of functions.
    pub constants: Vec<u32>,
}

/// Stack pointer.
const SP: u16 = 13;

/// Link register.
const LR: u16 = 14;

/// Reads the instructions of a function that takes the addresses `from` to `end`. `code` gives the halfword at an
/// address; `None` where there are data.
pub fn frame(from: u32, end: u32, code: &impl Fn(u32) -> Option<u16>) -> Frame {
    let mut reader = Reader {
        frame: Frame::default(),
        from,
        end,
        low: [0; 16],
    };
    let mut at = from;
    while at < end {
        let Some(first) = code(at) else {
            at += 2;
            continue;
        };
        if first >> 11 < 0b11101 {
            reader.short(at, first);
            at += 2;
        } else {
            let second = code(at + 2).unwrap_or_default();
            reader.long(at, first, second);
            at += 4;
        }
    }
    reader.frame
}

struct Reader {
    frame: Frame,
    from: u32,
    end: u32,
    /// Value that MOVW left in each register, for a MOVT that follows.
    low: [u16; 16],
}

/// The value of the lowest `bits` bits, with their sign.
fn signed(value: u32, bits: u32) -> i32 {
    ((value << (32 - bits)) as i32) >> (32 - bits)
}

impl Reader {
    fn take(&mut self, bytes: u32) {
        self.frame.bytes = self.frame.bytes.saturating_add(bytes);
    }

    /// A branch: out of the function, it continues with another one.
    fn branch(&mut self, target: u32) {
        if !(self.from..self.end).contains(&target) {
            self.frame.calls.push(target);
        }
    }

    /// An instruction of 16 bits.
    fn short(&mut self, at: u32, code: u16) {
        let pc = at.wrapping_add(4);
        match code >> 8 {
            // PUSH
            0xB4 | 0xB5 => self.take(4 * (code & 0x1FF).count_ones()),
            // SUB SP, #
            0xB0 if code & 0x80 != 0 => self.take(4 * u32::from(code & 0x7F)),
            // BX, BLX register
            0x47 => {
                let calls = code & 0x80 != 0 || (code >> 3 & 0xF) != LR;
                self.frame.indirect |= calls;
            }
            // ADD SP, register
            0x44 if code & 0x87 == 0x85 => self.frame.dynamic = true,
            // B condition
            0xD0..=0xDD => {
                let distance = signed(u32::from(code & 0xFF) << 1, 9);
                self.branch(pc.wrapping_add_signed(distance));
            }
            // B
            0xE0..=0xE7 => {
                let distance = signed(u32::from(code & 0x7FF) << 1, 12);
                self.branch(pc.wrapping_add_signed(distance));
            }
            _ => {}
        }
    }

    /// An instruction of 32 bits.
    fn long(&mut self, at: u32, first: u16, second: u16) {
        let destination = second >> 8 & 0xF;
        let immediate = u32::from(first >> 10 & 1) << 11
            | u32::from(second >> 12 & 7) << 8
            | u32::from(second & 0xFF);
        match first {
            // PUSH.W
            0xE92D => self.take(4 * second.count_ones()),
            // STR [SP, #-n]!
            0xF84D if second & 0x0F00 == 0x0D00 => self.take(u32::from(second & 0xFF)),
            // STRD [SP, #-n]!
            0xE96D => self.take(4 * u32::from(second & 0xFF)),
            // VPUSH
            0xED2D | 0xED6D if second & 0x0E00 == 0x0A00 => {
                self.take(4 * u32::from(second & 0xFF));
            }
            // SUB SP, SP, #
            0xF1AD | 0xF5AD if second & 0x8000 == 0 && destination == SP => {
                self.take(expanded(immediate));
            }
            0xF2AD | 0xF6AD if second & 0x8000 == 0 && destination == SP => self.take(immediate),
            // SUB SP, SP, register
            0xEBAD if destination == SP => self.frame.dynamic = true,
            // MOVW, MOVT
            _ if first & 0xFB70 == 0xF240 && second & 0x8000 == 0 => {
                let half = first << 12 | immediate as u16;
                let register = &mut self.low[usize::from(destination)];
                if first & 0x80 == 0 {
                    *register = half;
                } else {
                    let constant = u32::from(half) << 16 | u32::from(*register);
                    self.frame.constants.push(constant);
                }
            }
            _ if first >> 11 == 0b11110 && second & 0x8000 != 0 => self.far(at, first, second),
            _ => {}
        }
    }

    /// BL, B.W and B.W with a condition.
    fn far(&mut self, at: u32, first: u16, second: u16) {
        let (first, second) = (u32::from(first), u32::from(second));
        let sign = first >> 10 & 1;
        let (j1, j2) = (second >> 13 & 1, second >> 11 & 1);
        let low = (second & 0x7FF) << 1;
        let distance = match second >> 12 & 0b101 {
            // B condition: J2 comes before J1; without a condition it is not a branch.
            0b000 if first >> 7 & 0b111 != 0b111 => {
                let high = sign << 20 | j2 << 19 | j1 << 18;
                signed(high | (first & 0x3F) << 12 | low, 21)
            }
            0b000 => return,
            _ => {
                let (i1, i2) = (1 ^ j1 ^ sign, 1 ^ j2 ^ sign);
                let high = sign << 24 | i1 << 23 | i2 << 22;
                signed(high | (first & 0x3FF) << 12 | low, 25)
            }
        };
        let target = at.wrapping_add(4).wrapping_add_signed(distance);
        // BL
        match second >> 12 & 0b101 {
            0b101 => self.frame.calls.push(target),
            _ => self.branch(target),
        }
    }
}

/// A modified immediate constant.
fn expanded(immediate: u32) -> u32 {
    let byte = immediate & 0xFF;
    match immediate >> 8 {
        0b0000 => byte,
        0b0001 => byte << 16 | byte,
        0b0010 => byte << 24 | byte << 8,
        0b0011 => byte << 24 | byte << 16 | byte << 8 | byte,
        _ => (0x80 | immediate & 0x7F).rotate_right(immediate >> 7),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(at: u32, code: &[u16]) -> Frame {
        let end = at + 2 * code.len() as u32;
        frame(at, end, &|address| {
            code.get((address.checked_sub(at)? / 2) as usize).copied()
        })
    }

    #[test]
    fn what_is_pushed_and_subtracted() {
        // push {r4, r5, lr}; sub sp, #12; push.w {r4-r8, lr}; vpush {d8}; sub.w sp, sp, #512; subw sp, sp, #1020; bx lr
        let code = [
            0xB530, 0xB083, 0xE92D, 0x41F0, 0xED2D, 0x8B02, 0xF5AD, 0x7D00, 0xF2AD, 0x3DFC, 0x4770,
        ];
        let frame = read(0x100, &code);
        assert_eq!(frame.bytes, 12 + 12 + 24 + 8 + 512 + 1020);
        assert!(!frame.indirect && !frame.dynamic && frame.calls.is_empty());
    }

    #[test]
    fn what_is_called() {
        // As an assembler has it at 0x0800013A: bl 0x080002F0, and at 0x0800014C: bl 0x08000514.
        assert_eq!(read(0x0800_013A, &[0xF000, 0xF8D9]).calls, [0x0800_02F0]);
        assert_eq!(read(0x0800_014C, &[0xF000, 0xF9E2]).calls, [0x0800_0514]);
        // b.n out of the function, blx r3, bx r3.
        assert_eq!(read(0x0800_0060, &[0xE7FA]).calls, [0x0800_0058]);
        assert!(read(0, &[0x4798]).indirect);
        assert!(read(0, &[0x4718]).indirect);
        assert!(!read(0, &[0x4770]).indirect, "a return");
    }

    #[test]
    fn constants_in_halves() {
        // movw r0, #0x1235; movt r0, #0x0800
        let frame = read(0, &[0xF241, 0x2035, 0xF6C0, 0x0000]);
        assert_eq!(frame.constants, [0x0800_1235]);
    }
}
