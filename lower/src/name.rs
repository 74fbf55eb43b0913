//! Names of modules, made of the names of files and projects in any script.

use std::sync::OnceLock;

/// What characters are in ASCII, as the build script packs it.
static PACKED: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/ascii.bin"));

/// An identifier in lower case from the name of a file. What is not ASCII is transliterated; since other names can be
/// so, too, a short number that belongs to this name alone follows then: `往复.gxw` becomes `wang_fu_4c1e`.
pub fn module_name(source: &str) -> String {
    let stem = stem(source);
    let mut name = String::new();
    for c in stem.chars() {
        if c.is_ascii() {
            name.push(if c.is_ascii_alphanumeric() {
                c.to_ascii_lowercase()
            } else {
                '_'
            });
        } else {
            transliterate(c, &mut name);
        }
    }
    if !stem.is_ascii() {
        let readable = match name.trim_matches('_') {
            "" => "plc",
            readable => readable,
        };
        name = format!("{readable}_{:04x}", short_hash(stem));
    }
    if !name.starts_with(|c: char| c.is_ascii_alphabetic()) {
        name.insert_str(0, "plc");
    }
    // Some files accompany the module's.
    if TAKEN.contains(&name.as_str()) {
        name.insert_str(0, "plc_");
    }
    name
}

/// The name of a file without its extension.
pub fn stem(source: &str) -> &str {
    match source.rsplit_once('.') {
        Some((stem, extension)) if extension.is_ascii() => stem,
        _ => source,
    }
}

/// Appends what a character is in ASCII. Those that stand for syllables or words (`往`: `Wang `) are set apart from what
/// is before and after them.
fn transliterate(c: char, name: &mut String) {
    let (letters, mark) = ascii(c);
    if mark == "~" && !name.is_empty() && !name.ends_with('_') {
        name.push('_');
    }
    name.push_str(letters);
    if mark != "." && !name.ends_with('_') {
        name.push('_');
    }
}

/// What a character is in ASCII; see [`table`].
fn ascii(c: char) -> (&'static str, &'static str) {
    let place = (c as usize).checked_sub(0x80);
    let known = place.and_then(|place| table().nth(place));
    known.unwrap_or(("", "-"))
}

/// Of each character from U+0080 on its letters and digits in ASCII, and its mark: `~` if it stands for a syllable or a
/// word, `-` if it stands for nothing, and `.` otherwise.
fn table() -> impl Iterator<Item = (&'static str, &'static str)> {
    const MARKS: [char; 3] = ['~', '-', '.'];
    static TEXT: OnceLock<String> = OnceLock::new();
    let text = TEXT.get_or_init(|| {
        let text = miniz_oxide::inflate::decompress_to_vec(PACKED);
        let text = text.expect("the build script deflated it");
        String::from_utf8(text).expect("the build script packs text")
    });
    let entries = text.split_inclusive(MARKS);
    entries.map(|entry| entry.split_at(entry.trim_end_matches(MARKS).len()))
}

/// A number that differs between names, and is the same on every machine: FNV-1a, folded to 16 bits.
fn short_hash(name: &str) -> u16 {
    let hash = name.bytes().fold(0x811C_9DC5_u32, |hash, byte| {
        (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193)
    });
    (hash >> 16 ^ hash) as u16
}

/// Names that emitted files must not have, without their endings, in order: headers of C99 and POSIX, which other
/// sources would find instead of the system's, the files beside a program's own, and the prefix of what `rungc.h` has.
const TAKEN: [&str; 72] = [
    "aio",
    "assert",
    "complex",
    "cpio",
    "ctype",
    "dirent",
    "dlfcn",
    "endian",
    "errno",
    "fcntl",
    "fenv",
    "float",
    "fmtmsg",
    "fnmatch",
    "ftw",
    "glob",
    "grp",
    "iconv",
    "inttypes",
    "iso646",
    "langinfo",
    "libgen",
    "limits",
    "locale",
    "main",
    "malloc",
    "math",
    "memory",
    "monetary",
    "mqueue",
    "ndbm",
    "netdb",
    "nl_types",
    "plc",
    "poll",
    "pthread",
    "pwd",
    "regex",
    "rungc",
    "rungc_board",
    "rungc_rt",
    "sched",
    "search",
    "semaphore",
    "setjmp",
    "signal",
    "spawn",
    "stdalign",
    "stdarg",
    "stdatomic",
    "stdbool",
    "stddef",
    "stdint",
    "stdio",
    "stdlib",
    "stdnoreturn",
    "string",
    "strings",
    "stropts",
    "syslog",
    "tar",
    "termios",
    "tgmath",
    "threads",
    "time",
    "trace",
    "uchar",
    "ulimit",
    "unistd",
    "utime",
    "wchar",
    "wctype",
];

#[cfg(test)]
mod tests {
    use super::{ascii, module_name};
    use deunicode::deunicode_char;

    #[test]
    fn names_in_ascii_stay_as_they_are() {
        for (source, name) in [
            ("motor.il", "motor"),
            ("My Motor-2.csv", "my_motor_2"),
            ("MAIN.wpg", "plc_main"),
            ("3 axes.gxw", "plc3_axes"),
            ("time.il", "plc_time"),
            ("PLC.gxw", "plc_plc"),
            ("", "plc_plc"),
        ] {
            assert_eq!(module_name(source), name);
        }
    }

    #[test]
    fn other_scripts_are_transliterated() {
        insta::assert_snapshot!(
            [
                "往复式传送带.gxw",
                "PLC例程-用PLSY实现加减速",
                "Nível Bóia.il",
                "Förderband 2.il",
                "Насосы.il",
                "정지.gxw",
                "コンベヤ.csv",
                "→→.il",
                "\u{202E}\u{200B}.il",
                "传送带　控制.il",
            ]
            .map(module_name)
            .join("\n")
        );
    }

    #[test]
    fn every_character_is_what_deunicode_makes_of_it() {
        let numbers = 0x80..=u32::from(char::MAX);
        let known = super::table().chain(std::iter::repeat(("", "-")));
        for (number, (letters, mark)) in numbers.zip(known) {
            let expected = char::from_u32(number).and_then(deunicode_char);
            let expected = expected.unwrap_or_default();
            let kept = expected.chars().filter(char::is_ascii_alphanumeric);
            let kept: String = kept.map(|c| c.to_ascii_lowercase()).collect();
            assert_eq!(letters, kept, "{number:x}");
            assert_eq!(mark == "~", expected.ends_with(' '), "{number:x}");
            assert_eq!(mark == "-", expected.is_empty(), "{number:x}");
        }
        assert_eq!(ascii('往'), ("wang", "~"));
        assert_eq!(ascii('é'), ("e", "."));
        assert_eq!(ascii('\u{7f}'), ("", "-"));
    }

    #[test]
    fn names_that_sound_alike_stay_apart() {
        assert_ne!(module_name("电机.il"), module_name("点击.il"));
        assert_ne!(module_name("Nível.il"), module_name("Nivel.il"));
        assert_ne!(module_name("→.il"), module_name("←.il"));
    }
}
