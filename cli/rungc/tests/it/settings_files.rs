//! Files in TOML that a user names: all commands say the same of one that cannot be read.

use crate::common::{MOTOR, folder, rungc, text};
use std::fs;

/// Command lines that take a file in TOML at the end, and lines of one that they read.
const READERS: [(&str, &str); 6] = [
    ("test", "topic = \"t\"\n[[case]]\n"),
    ("fleet --virtual --for 20ms", "[plc.a]\n"),
    ("boards", "chip = \"x\"\n[pins]\n"),
    ("run motor.il --for 20ms --machine", "[[axis]]\n"),
    ("run motor.il --for 20ms --io", "[io.a]\n"),
    ("check motor.il --project", "[project]\n"),
];

#[test]
fn encodings_and_other_files_are_named() {
    let folder = folder(&[("motor.il", MOTOR.as_bytes())]);
    let path = folder.path();
    for (command, start) in READERS {
        // A comment in GBK: 启动.
        let gbk = [b"# \xC6\xF4\xB6\xAF\n", start.as_bytes()].concat();
        let utf16: Vec<u8> = ["\u{FEFF}# 启动\n", start]
            .concat()
            .encode_utf16()
            .flat_map(u16::to_le_bytes)
            .collect();
        for (bytes, why) in [
            (&gbk[..], "it is not UTF-8; save it as UTF-8"),
            (&utf16[..], "it is UTF-16; save it as UTF-8"),
            (
                &b"\x7FELF\x01\x02\xFF"[..],
                "this is an executable or an image (ELF): ",
            ),
            (&b"<html>\n<body>\n"[..], "this is a page (HTML): "),
            (MOTOR.as_bytes(), "this is a program: "),
        ] {
            fs::write(path.join("given.toml"), bytes).unwrap();
            let line = format!("{command} given.toml");
            let output = rungc(path, &line.split(' ').collect::<Vec<_>>());
            let messages = text(&output.stderr);
            assert_eq!(output.status.code(), Some(2), "{line}: {messages}");
            assert!(messages.contains(why), "{line}: {messages}");
        }
    }
}
