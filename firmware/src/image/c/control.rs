//! The RUN/STOP switch, the lamps and the watchdog of an image in C.

use super::super::Image;
use super::switch;
use crate::template;
use std::fmt::Write;

/// Functions that follow the switch, and show RUN and errors.
pub(super) fn functions(image: &Image) -> String {
    let control = &image.board.control;
    let mut text = String::new();
    if let Some(pin) = &control.switch {
        let compare = if pin.inverted { "==" } else { "!=" };
        let read = format!(
            "(REGISTER(0x{:08X}u) & 0x{:X}u) {compare} 0u",
            pin.at,
            1u32 << pin.bit
        );
        text.push_str(&template!("switch.c").replace("/* READ */", &read));
    }
    let error = format!(
        "const plc_error error = {}_error(&plc);\n    on = error.code != 0u || error.stop != 0u;",
        image.module.name
    );
    let lamps = [
        (&control.run, "on = plc.sys.running;"),
        (&control.error, &error),
    ];
    let mut body = String::new();
    for (pin, state) in lamps {
        if let Some(pin) = pin {
            // Writing to a String does not fail.
            let _ = write!(body, "    {state}\n{}", switch(pin, "    "));
        }
    }
    if !body.is_empty() {
        let _ = write!(
            text,
            "/* The lamps. */\nstatic void show_state(void)\n{{\n    bool on;\n\n{body}}}\n\n"
        );
    }
    text
}

/// Code in `main` before the first scan.
pub(super) fn begin(image: &Image) -> &'static str {
    match image.board.control.switch {
        Some(_) => {
            "    switch_is_run = reads_run();\n    PROGRAM_set_running(&plc, switch_is_run);\n"
        }
        None => "",
    }
}

/// Code in `main` after each scan.
pub(super) fn after_scan(image: &Image) -> String {
    let control = &image.board.control;
    let mut text = String::new();
    if control.switch.is_some() {
        text.push_str("        follow_switch();\n");
    }
    if control.lamps().next().is_some() {
        text.push_str("        show_state();\n");
    }
    if let Some((at, word)) = control.watchdog {
        let _ = writeln!(
            text,
            "        REGISTER(0x{at:08X}u) = 0x{word:X}u; /* the watchdog */"
        );
    }
    text
}
