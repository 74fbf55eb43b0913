//! Projects of the vendor's editors whose codes contradict themselves, or that are for other machines.

use crate::common::{FX3U, folder, rungc, shown, text, wpg};

#[test]
fn lengths_that_do_not_fit_are_errors() {
    // LD of M0 takes one step.
    let bodies: &[&[u8]] = &[
        &[0x00, 0x02],
        &[0x90, 0x00],
        &[0x20],
        &[0x9D, 0x00],
        &[0x34],
    ];
    let folder = folder(&[("MAIN.wpg", &wpg(FX3U, bodies))]);
    insta::assert_snapshot!(shown(folder.path(), &["check", "MAIN.wpg"]));
}

/// A3N is the CPU with the number 010A.
#[test]
fn projects_of_other_families_are_one_error() {
    let folder = folder(&[
        ("MAIN.wpg", &wpg(0x010A, &[&[0x00], &[0x9C, 0x00], &[0x34]])),
        ("COMMENT.wcd", b"not comments"),
    ]);
    insta::assert_snapshot!(shown(folder.path(), &["check", "MAIN.wpg"]));
    for command in ["run", "convert"] {
        let to: &[_] = if command == "convert" {
            &["--to", "il"]
        } else {
            &[]
        };
        let output = rungc(folder.path(), &[&[command, "MAIN.wpg"], to].concat());
        let messages = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{messages}");
        assert_eq!(
            messages.matches("A3N").count(),
            2,
            "message and listing: {messages}"
        );
        assert_eq!(messages.matches("error[").count(), 1, "{messages}");
    }
}
