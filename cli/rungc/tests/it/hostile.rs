//! Names of files that would act on what reads emitted code.

use crate::common::{folder, rungc, text};

/// `#include <time.h>` finds the system's header where the emitted folder is on the include path.
#[test]
fn programs_never_shadow_headers_of_the_system() {
    let program = b"LD X000\nOUT Y000\nEND\n";
    for name in ["time", "string", "stdint", "rungc_rt", "rungc_board", "plc"] {
        let file = format!("{name}.il");
        let folder = folder(&[(&file, program)]);
        let output = rungc(folder.path(), &["build", &file, "--emit", "c", "-o", "out"]);
        assert!(output.status.success(), "{}", text(&output.stderr));
        let out = folder.path().join("out");
        assert!(!out.join(format!("{name}.h")).exists(), "{name}");
        assert!(out.join(format!("plc_{name}.h")).is_file(), "{name}");
    }
}
