//! PLC parameters: `param.wpa` of GX Developer, `Param.wpa` of GX Works2.
//!
//! After the header come blocks: `length:u16` (with this head), `id:u16`, data; a length of FFFFh ends them.

use super::fields::Fields;
use super::{HEADER, tokens};
use rungc_syntax::{DeviceRun, Parameters};

/// Latched ranges: how many, then device code, number of devices, first device of each.
const LATCHED: u16 = 0x2001;
/// Program files that the PLC runs: how many, then the length of each entry and its name, padded to 8 characters.
const PROGRAMS: u16 = 0x7000;
/// Memory capacity in units of 1000 steps.
const CAPACITY: u16 = 0xFFE0;
/// Blocks of 500 steps of that memory that hold comments.
const COMMENTS: u16 = 0xFFE1;
/// Blocks of 500 steps of that memory that hold file registers.
const FILE_REGISTERS: u16 = 0xFFE2;
/// The keyword of the PLC, 8 characters; blank if there is none.
const KEYWORD: u16 = 0xFFE4;

/// Settings in a file of parameters; an offset if it is unreadable from there on.
pub(super) fn read(bytes: &[u8]) -> (Parameters, Option<usize>) {
    let mut parameters = Parameters::default();
    let mut fields = Fields::new(bytes.get(HEADER..).unwrap_or_default());
    loop {
        let at = HEADER + fields.at();
        match fields.u16() {
            Some(u16::MAX) => return (parameters, None),
            Some(length @ 4..) => {
                let mut block = || Some((fields.u16()?, fields.take(usize::from(length) - 4)?));
                let known =
                    block().is_some_and(|(id, data)| set(&mut parameters, id, data).is_some());
                if !known {
                    return (parameters, Some(at));
                }
            }
            _ => return (parameters, Some(at)),
        }
    }
}

/// Takes over what one block sets; nothing if its data do not fit.
fn set(parameters: &mut Parameters, id: u16, data: &[u8]) -> Option<()> {
    let mut fields = Fields::new(data);
    match id {
        LATCHED => {
            let mut latched = Vec::new();
            for _ in 0..fields.u16()? {
                let (code, count, first) = (fields.u16()?, fields.u16()?, fields.u16()?);
                let class = u8::try_from(code).ok().and_then(tokens::commented)?;
                latched.push(DeviceRun {
                    class,
                    first: first.into(),
                    count: count.into(),
                });
            }
            parameters.latched = Some(latched);
        }
        PROGRAMS => {
            for _ in 0..fields.u16()? {
                let length = usize::from(fields.u16()?);
                let name = fields.take(length.checked_sub(2)?)?.get(..8)?;
                let name = String::from_utf8_lossy(name);
                parameters
                    .programs
                    .push(name.trim_end_matches([' ', '\0']).to_owned());
            }
        }
        CAPACITY => parameters.capacity = Some(1000 * u32::from(fields.u16()?)),
        KEYWORD => parameters.protected = data.first().is_some_and(u8::is_ascii_alphanumeric),
        COMMENTS => parameters.comment_blocks = fields.u16()?.into(),
        FILE_REGISTERS => parameters.file_register_blocks = fields.u16()?.into(),
        _ => {}
    }
    Some(())
}
