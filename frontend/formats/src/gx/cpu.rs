//! CPU types that projects name.

use crate::Read;
use crate::listing::Listing;
use rungc_syntax::family::other_family as other_family_of;
use rungc_syntax::{Diagnostic, Diagnostics, Program, SourceKind, Span, codes};

/// The high byte of the FX family's numbers.
const FX: u16 = 0x02;

/// Numbers that the vendor's software gives to CPU types, in the headers of GX Developer's files, with their names: the
/// FX family as the list export writes them, and those of other families.
const CPUS: &[(u16, &str)] = &[
    (0x0011, "Q2A"),
    (0x0012, "Q2AS1"),
    (0x0013, "Q3A"),
    (0x0014, "Q4A"),
    (0x0022, "Q02(H)"),
    (0x0023, "Q06H"),
    (0x0024, "Q12H"),
    (0x0025, "Q25H"),
    (0x0030, "Q00J"),
    (0x0031, "Q00"),
    (0x0032, "Q01"),
    (0x0070, "Q03UD"),
    (0x0071, "Q04UDH"),
    (0x0072, "Q06UDH"),
    (0x0073, "Q13UDH"),
    (0x0074, "Q26UDH"),
    (0x0075, "Q10UDH"),
    (0x0076, "Q20UDH"),
    (0x0080, "Q00UJ"),
    (0x0081, "Q00U"),
    (0x0082, "Q01U"),
    (0x0083, "Q02U"),
    (0x0090, "Q03UDE"),
    (0x0091, "Q04UDEH"),
    (0x0092, "Q06UDEH"),
    (0x0093, "Q13UDEH"),
    (0x0094, "Q26UDEH"),
    (0x0095, "Q10UDEH"),
    (0x0096, "Q20UDEH"),
    (0x00A1, "L02"),
    (0x00A2, "L26-BT"),
    (0x00A3, "L02S"),
    (0x00A4, "L26"),
    (0x00A5, "L06"),
    (0x00D1, "Q03UDV"),
    (0x00D2, "Q04UDV"),
    (0x00D3, "Q06UDV"),
    (0x00D4, "Q13UDV"),
    (0x00D5, "Q26UDV"),
    (0x0102, "A0J2H"),
    (0x0103, "A1FX"),
    (0x0104, "A1S"),
    (0x0105, "A1SH"),
    (0x0106, "A1N"),
    (0x0107, "A2C"),
    (0x0108, "A2N"),
    (0x0109, "A2SH"),
    (0x010A, "A3N"),
    (0x010C, "A2A"),
    (0x010D, "A3A"),
    (0x010E, "A2U"),
    (0x010F, "A2USH-S1"),
    (0x0110, "A3U"),
    (0x0111, "A4U"),
    (0x0141, "Q02(H)-A"),
    (0x0142, "Q06H-A"),
    (0x0201, "FX0/FX0S"),
    (0x0202, "FX0N"),
    (0x0203, "FX1"),
    (0x0204, "FX2/FX2C"),
    (0x0205, "FX2N/FX2NC"),
    (0x0206, "FX1S"),
    (0x0207, "FX1N/FX1NC"),
    (0x0208, "FX3U/FX3UC"),
    (0x0209, "FX3G"),
    (0x020A, "FX3S"),
];

/// The name of the CPU type with this number; of one that is not in the table, its family, if that is FX, and the
/// number.
pub(super) fn name(code: u16) -> String {
    let known = CPUS.iter().find(|row| row.0 == code);
    let family = if code >> 8 == FX { "FX " } else { "" };
    known.map_or_else(
        || format!("{family}type {code:04X}h"),
        |row| row.1.to_owned(),
    )
}

/// Returns true for the name of a CPU type of the FX family, as [`name`], `*.prj` of GX Works2 and list exports write
/// it. FX5 is of another family, iQ-F.
fn is_fx(cpu: &str) -> bool {
    let cpu = cpu.trim().to_ascii_uppercase();
    cpu.starts_with("FX") && !cpu.starts_with("FX5")
}

/// The CPU that a row above a list names, as `FXCPU FX3U/FX3UC` or `QCPU (Q mode) Q03UDV` do, without the word for
/// its family if that is FX. After the label of this row, in a field or in the same one, any text is a CPU.
pub(crate) fn of_head<'r>(row: impl IntoIterator<Item = &'r str>) -> Option<&'r str> {
    let mut row = row.into_iter().map(str::trim);
    let first = row.next()?;
    let labelled = is_label(first);
    let of_field = |field: &&str| !field.is_empty() && (labelled || names_cpu(field));
    let cpu = row.find(of_field).or_else(|| in_first(first))?;
    let family = cpu.get(..FAMILY.len());
    let is_family = family.is_some_and(|family| family.eq_ignore_ascii_case(FAMILY));
    let own = cpu[if is_family { FAMILY.len() } else { 0 }..].trim();
    Some(own).filter(|own| !own.is_empty())
}

/// Word for the FX family before the names of its CPUs.
const FAMILY: &str = "FXCPU";

/// Returns true for the label of the row that names the CPU.
pub(crate) fn is_label(field: &str) -> bool {
    field.contains("PLC") || field.trim_end().ends_with([':', '：'])
}

/// Returns true if words of a field name a CPU.
fn names_cpu(field: &str) -> bool {
    let is_name = |word: &str| {
        let word = word.to_ascii_uppercase();
        word.starts_with("FX") || word.ends_with("CPU") || is_other(&word)
    };
    let mut words = field.split(|c: char| !c.is_ascii_alphanumeric());
    words.any(is_name)
}

/// The CPU in the first field of a row: after a label in the same field, or alone with the word for its family.
fn in_first(field: &str) -> Option<&str> {
    let labelled = field.split_once([':', '：']);
    if let Some((label, cpu)) = labelled.filter(|(label, _)| !label.trim().is_empty()) {
        let is_usual = label.to_ascii_uppercase().starts_with("PLC INF");
        return (is_usual || names_cpu(cpu)).then_some(cpu.trim());
    }
    let family = field.split(|c: char| !c.is_ascii_alphanumeric()).next()?;
    let is_family = family.len() > 3 && family.to_ascii_uppercase().ends_with("CPU");
    is_family.then_some(field)
}

/// CPUs of MELSEC-L whose names compatible PLCs have, too.
const AMBIGUOUS: [&str; 2] = ["L02", "L02S"];

/// Returns true for the name of a CPU of another family.
fn is_other(word: &str) -> bool {
    let word = word.to_ascii_uppercase();
    let known = CPUS
        .iter()
        .any(|&(code, name)| code >> 8 != FX && name == word && !AMBIGUOUS.contains(&name));
    let special = ["NZ2GACP", "LJ72MS"];
    known || other_family_of(&word).is_some() || special.iter().any(|name| word.starts_with(name))
}

/// Returns true for the CPU of a list that is not for the FX family, nor of an unknown one.
pub(crate) fn is_other_family(cpu: &str) -> bool {
    let cpu = cpu.to_ascii_uppercase();
    let words = cpu.split(|c: char| !c.is_ascii_alphanumeric());
    // A hyphen parts some names, and is a part of others.
    let mut words = words.chain(cpu.split_whitespace());
    let series = ["IQ-F", "IQ-L", "IQ-R"];
    !is_fx(&cpu)
        && words.any(|word| is_other(word) || series.contains(&word) || word.ends_with("CPU"))
}

/// Result of reading a project for a CPU of another family: only an error that names the CPU.
pub(crate) fn refused(file: &str, kind: SourceKind, cpu: &str) -> Option<Read> {
    (!is_fx(cpu)).then(|| other_family(file, kind, cpu))
}

/// Advice about programs for a CPU of another family.
pub(crate) const ONLY_FX: &str = "only FX programs can be compiled: change the PLC type in the editor if the program is for an FX PLC";

/// That a program is for a CPU of another family.
pub(crate) fn rejection(span: Span, what: &str, cpu: &str) -> Diagnostic {
    codes::OTHER_FAMILY
        .at(span, rejection_message(what, cpu))
        .label(format!("the CPU of the {what}"))
        .help(ONLY_FX)
}

/// Message of [`rejection`].
pub(crate) fn rejection_message(what: &str, cpu: &str) -> String {
    format!("the {what} is for the CPU {cpu}, which is not one of the FX family")
}

fn other_family(file: &str, kind: SourceKind, cpu: &str) -> Read {
    let mut listing = Listing::default();
    listing.next_line();
    let span = listing.word(&format!("?? CPU {cpu}"));
    let mut diagnostics = Diagnostics::new();
    diagnostics.push(rejection(span, "project", cpu));
    Read {
        program: Program {
            source: listing.finish(file),
            kind,
            unread: vec![0],
            ..Program::default()
        },
        diagnostics,
        ..Read::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn families_are_told_apart() {
        for (code, name) in CPUS {
            assert_eq!(code >> 8 == FX, is_fx(name), "{name}");
        }
        assert!(is_fx(" fx3u/FX3UC") && !is_fx("Q03UDV"));
        assert_eq!(name(0x010A), "A3N");
        assert_eq!(name(0x02FF), "FX type 02FFh");
        assert_eq!(name(0x0999), "type 0999h");
    }
}
