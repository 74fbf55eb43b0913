//! The RUN/STOP switch, the lamps and the watchdog of an image in Rust.

use super::super::Image;
use super::switch;
use std::fmt::Write;

/// Code that follows the switch when it has been in its new position for 20 ms; changes by HMIs and special relays in
/// between remain in effect.
const FOLLOW: &str = "        let now = MICROSECONDS.load(Ordering::Relaxed);
        if (READ) == switch_is_run {
            switched = now;
        } else if now.wrapping_sub(switched) >= 20_000 {
            switch_is_run = !switch_is_run;
            driver.program.set_running(switch_is_run);
        }
";

/// The expression that reads the switch.
fn reads_run(image: &Image) -> Option<String> {
    let pin = image.board.control.switch.as_ref()?;
    let compare = if pin.inverted { "==" } else { "!=" };
    let (at, bit) = (pin.at, 1u32 << pin.bit);
    Some(format!("read(0x{at:08X}) & 0x{bit:X} {compare} 0"))
}

/// Code in `main` before the first scan.
pub(super) fn before(image: &Image) -> String {
    let begin = |read: String| {
        format!(
            "    let mut switch_is_run = {read};\n    let mut switched = MICROSECONDS.load(Ordering::Relaxed);\n    \
             driver.program.set_running(switch_is_run);\n"
        )
    };
    reads_run(image).map_or(String::new(), begin)
}

/// Code in `main` after each scan.
pub(super) fn after_scan(image: &Image) -> String {
    let control = &image.board.control;
    let mut text = reads_run(image).map_or(String::new(), |read| FOLLOW.replace("READ", &read));
    let lamps = [
        (&control.run, "driver.program.sys().running"),
        (
            &control.error,
            "driver.program.last_error() != rungc_rt::LastError::NONE",
        ),
    ];
    for (pin, state) in lamps {
        if let Some(pin) = pin {
            // Writing to a String does not fail.
            let _ = writeln!(text, "        let on = {state};\n        {};", switch(pin));
        }
    }
    if let Some((at, word)) = control.watchdog {
        let _ = writeln!(
            text,
            "        write(0x{at:08X}, 0x{word:X}); // the watchdog"
        );
    }
    text
}
