//! Names of modules, made of the names of files and projects in any script.

use deunicode::deunicode_char;
use rungc_ir::fnv1a;

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
    let ascii = deunicode_char(c).unwrap_or_default();
    let is_word = ascii.ends_with(' ');
    if is_word && !name.is_empty() && !name.ends_with('_') {
        name.push('_');
    }
    let letters = ascii.chars().filter(char::is_ascii_alphanumeric);
    name.extend(letters.map(|c| c.to_ascii_lowercase()));
    if (is_word || ascii.is_empty()) && !name.ends_with('_') {
        name.push('_');
    }
}

/// A number that differs between names, and is the same on every machine: a hash folded to 16 bits.
fn short_hash(name: &str) -> u16 {
    let hash = fnv1a(name);
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
    use super::module_name;

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
    fn names_that_sound_alike_stay_apart() {
        assert_ne!(module_name("电机.il"), module_name("点击.il"));
        assert_ne!(module_name("Nível.il"), module_name("Nivel.il"));
        assert_ne!(module_name("→.il"), module_name("←.il"));
    }
}
