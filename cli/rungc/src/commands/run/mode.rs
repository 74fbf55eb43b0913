//! The RUN/STOP switch of a run in real time: SIGUSR1 is STOP, SIGUSR2 is RUN.

#[cfg(unix)]
use signal_hook::consts::{SIGUSR1, SIGUSR2, SIGXFSZ};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Requests by a signal.
const NOTHING: usize = 0;
const STOP: usize = 1;
const RUN: usize = 2;

/// The switch.
#[derive(Default)]
pub struct Mode(Arc<AtomicUsize>);

impl Mode {
    /// From now on the signals turn it in a run in real time. Where the system takes no handler, they end the process.
    pub fn listen(in_real_time: bool) -> Self {
        let mode = Mode::default();
        if !in_real_time {
            return mode;
        }
        #[cfg(unix)]
        for (signal, requested) in [(SIGUSR1, STOP), (SIGUSR2, RUN)] {
            let _ = signal_hook::flag::register_usize(signal, Arc::clone(&mode.0), requested);
        }
        // A file that may not grow is as a full disk: it does not end the run.
        #[cfg(unix)]
        let _ = signal_hook::flag::register(SIGXFSZ, Arc::default());
        mode
    }

    /// RUN (true) or STOP, if a signal has requested it since the last call.
    pub fn requested(&self) -> Option<bool> {
        match self.0.swap(NOTHING, Ordering::Relaxed) {
            STOP => Some(false),
            RUN => Some(true),
            _ => None,
        }
    }
}
