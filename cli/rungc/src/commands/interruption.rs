//! A command that is interrupted (Ctrl-C, or the system's request to end) ends well: what it was writing is whole or
//! not there, and the exit code says that it was cut short.

use std::process;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

/// Exit code of a command that was interrupted, as shells have it: 128 and the number of the signal.
pub const EXIT_CODE: u8 = 130;

/// Time allowed for a command to react.
const GRACE: Duration = Duration::from_secs(2);

static REQUESTED: AtomicBool = AtomicBool::new(false);

/// From now an interruption is noted, and the command ends when it comes to notice; a second one ends it at once.
pub fn note() {
    install(None);
}

/// As [`note`], for commands that wait for others, such as compilers: these are interrupted as well. What takes longer
/// than it may is ended.
pub fn note_for_a_while() {
    install(Some(GRACE));
}

fn install(grace: Option<Duration>) {
    // If the system accepts no handler, it ends the process as if there were none.
    let _ = ctrlc::set_handler(move || {
        if REQUESTED.swap(true, Ordering::Relaxed) {
            process::exit(EXIT_CODE.into());
        }
        if let Some(grace) = grace {
            thread::spawn(move || {
                thread::sleep(grace);
                process::exit(EXIT_CODE.into());
            });
        }
    });
}

/// Returns true if the command has been interrupted.
pub fn is_requested() -> bool {
    REQUESTED.load(Ordering::Relaxed)
}
