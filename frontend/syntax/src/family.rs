//! Families of PLCs other than FX, by the names of their CPUs.

/// The first characters of the names of CPUs, and their family; after letters alone, a digit follows.
const FAMILIES: [(&str, &str); 8] = [
    ("FX5", "MELSEC iQ-F"),
    ("H3", "Inovance H3U"),
    ("H5", "Inovance H5U"),
    ("QS", "MELSEC-QS"),
    ("Q", "MELSEC-Q"),
    ("R", "MELSEC iQ-R"),
    ("S7", "SIMATIC S7"),
    ("XG", "LS XGT"),
];

/// The family that a CPU such as `Q03UDV` or `FX5U` belongs to; `None` for CPUs of FX and unknown ones. Compatible PLCs
/// have names that begin with L, too, so CPUs of MELSEC-L are unknown here.
pub fn other_family(cpu: &str) -> Option<&'static str> {
    let cpu = cpu.trim().to_ascii_uppercase();
    let is_of = |prefix: &str| {
        let rest = cpu.strip_prefix(prefix);
        let is_number = prefix.ends_with(|c: char| c.is_ascii_digit());
        rest.is_some_and(|rest| is_number || rest.starts_with(|c: char| c.is_ascii_digit()))
    };
    let mut families = FAMILIES.iter();
    let found = families.find(|(prefix, _)| is_of(prefix));
    found.map(|(_, family)| *family)
}
