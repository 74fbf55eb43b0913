//! A run that writes files ends well when it is interrupted: what there is of them is written.

use std::sync::atomic::{AtomicBool, Ordering};

static ASKED: AtomicBool = AtomicBool::new(false);

/// From now an interruption (Ctrl-C, or the system's request to end) is only noted.
pub fn note() {
    // Where the system takes no handler, it ends the process as if there were none.
    let _ = ctrlc::set_handler(|| ASKED.store(true, Ordering::Relaxed));
}

/// Whether the run has been interrupted.
pub fn is_asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}
