//! From instructions to machine code.

use super::devices::{operand_words, point};
use super::table::{self, BARE, COILS, CONTACTS, EDGES, END, PULSES};
use rungc_syntax::{Device, DeviceClass, Diagnostics, Instr, OperandKind, Program, codes};

/// The words of a program; an error for each instruction whose machine code is not known.
pub(super) fn words(program: &Program) -> Result<Vec<u16>, Diagnostics> {
    let mut words = Vec::new();
    let mut diagnostics = Diagnostics::new();
    let end = program.instrs.iter().position(|i| i.mnemonic == "END");
    let end = end.map_or(program.instrs.len(), |end| end + 1);
    let (executed, after) = program.instrs.split_at(end);
    for instr in executed {
        match instruction(instr) {
            Some(more) => words.extend(more),
            None => diagnostics.push(
                codes::NO_MACHINE_CODE
                    .at(
                        instr.span,
                        format!("the machine code of `{instr}` is not known"),
                    )
                    .label("no image shows it")
                    .help("`--to il` and `--to csv` write every instruction"),
            ),
        }
    }
    // Memory after the program is filled with NOP.
    if let Some(lost) = after.iter().find(|instr| instr.mnemonic != "NOP") {
        diagnostics.push(
            codes::NO_MACHINE_CODE
                .at(
                    lost.span,
                    format!("`{lost}` stands after `END`, where a PLC stops reading"),
                )
                .label("an image ends before it")
                .help("remove what follows `END`"),
        );
    }
    let last = executed.last();
    if last.is_none_or(|last| last.mnemonic != "END") {
        let span = last.map(|last| last.span).unwrap_or_default();
        diagnostics.push(
            codes::NO_MACHINE_CODE
                .at(
                    span,
                    "the program does not end with `END`, where a PLC stops reading",
                )
                .help("add `END` as the last instruction"),
        );
    }
    if diagnostics.is_empty() {
        Ok(words)
    } else {
        Err(diagnostics)
    }
}

/// One instruction's words.
fn instruction(instr: &Instr) -> Option<Vec<u16>> {
    use DeviceClass::P;
    let mnemonic = instr.mnemonic.as_str();
    let operands: Vec<&OperandKind> = instr.operands.iter().map(|operand| &operand.kind).collect();
    if operands.is_empty() {
        if let Some((word, _)) = BARE.iter().find(|(_, name)| *name == mnemonic) {
            return Some(vec![*word]);
        }
        if let Some(Device {
            class: P,
            number: number @ 0..256,
        }) = crate::il::device(mnemonic)
        {
            return Some(vec![0xB000 | number as u16]);
        }
    }
    basic(mnemonic, &operands).or_else(|| applied(mnemonic, &operands))
}

/// The words of an instruction that has no FNC number.
fn basic(mnemonic: &str, operands: &[&OperandKind]) -> Option<Vec<u16>> {
    use DeviceClass::{M, N, S, Y};
    let (first, more) = operands.split_first()?;
    let device = first.device()?;
    let place = |names: &[&str]| names.iter().position(|name| *name == mnemonic);
    let near = |nibble: usize, device| Some(vec![(nibble as u16) << 12 | point(device)?]);
    let far = |code: usize, device| Some(vec![code as u16, 0x8000 | point(device)?]);
    let low = |class, most| {
        let number = u16::try_from(device.number).ok()?;
        (device.class == class && number <= most).then_some(number)
    };
    match more {
        [] => {
            if let Some(at) = place(&CONTACTS) {
                return match point(device)? {
                    ..0x1000 => near(at + 2, device),
                    _ => far(0x01C2 + at, device),
                };
            }
            if let Some(at) = place(&EDGES) {
                return far(0x01CA + at, device);
            }
            if let Some(at) = place(&PULSES).filter(|_| matches!(device.class, Y | M)) {
                return far(0x0008 + at, device);
            }
            match mnemonic {
                "MCR" => Some(vec![0x000B, 0x8000 | low(N, 0xFF)?]),
                "STL" => Some(vec![0xF000 | low(S, 0x3FF)?]),
                _ => coil(place(&COILS)?, device, first),
            }
        }
        [second] if mnemonic == "MC" => {
            let coil = second.device().filter(|d| matches!(d.class, Y | M))?;
            Some(vec![0x000A, 0x8000 | low(N, 0xFF)?, 0x8000 | point(coil)?])
        }
        [value] if mnemonic == "OUT" => timed(device, value),
        _ => None,
    }
}

/// `OUT`, `SET` or `RST`, by its place in [`COILS`], of a device.
fn coil(at: usize, device: Device, operand: &OperandKind) -> Option<Vec<u16>> {
    use DeviceClass::{C, M, S, T, X, Y};
    const RST: usize = 2;
    let code = at as u16;
    match device {
        Device { class: Y, .. }
        | Device {
            class: M,
            number: 0..1536,
        } => Some(vec![(code + 0xC) << 12 | point(device)?]),
        Device { class: M, .. } => Some(vec![code + 0x0002, 0x8000 | point(device)?]),
        Device {
            class: S,
            number: 0..1024,
        } => Some(vec![code + 0x0005, 0x8000 | device.number as u16]),
        Device { class: T | C, .. } if at == RST => Some(vec![0x000C, 0x8000 | point(device)?]),
        Device { class: X | S, .. } => None,
        _ if at == RST => {
            let mut words = vec![0x000D];
            words.extend(operand_words(operand, false)?);
            Some(words)
        }
        _ => None,
    }
}

/// `OUT` of a timer or counter with its set value.
fn timed(device: Device, value: &OperandKind) -> Option<Vec<u16>> {
    let (code, wide) = match device {
        Device {
            class: DeviceClass::T,
            number: 0..512,
        } => (0x0600, false),
        Device {
            class: DeviceClass::C,
            number: 0..256,
        } => (0x0E00, device.number >= 200),
        _ => return None,
    };
    let mut words = vec![code + device.number as u16];
    words.extend(operand_words(value, wide)?);
    Some(words)
}

/// The words of an applied instruction.
fn applied(mnemonic: &str, operands: &[&OperandKind]) -> Option<Vec<u16>> {
    let row = table::named(mnemonic).filter(|row| row.operands == operands.len())?;
    let mut words = vec![row.word];
    for operand in operands {
        words.extend(operand_words(operand, row.wide)?);
    }
    Some(words)
}

/// The word of `END`, low byte first, as the programming port searches for it.
pub(super) const END_BYTES: [u8; 2] = END.to_le_bytes();
