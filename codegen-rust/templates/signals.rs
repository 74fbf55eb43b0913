
/// Ctrl-C and a request to terminate end the run as `quit` does. The standard library knows no signals, but the C library that it uses does.
#[cfg(unix)]
mod signals {
    use std::sync::atomic::{AtomicBool, Ordering};

    static STOPPED: AtomicBool = AtomicBool::new(false);

    /// SIGINT and SIGTERM.
    const NUMBERS: [i32; 2] = [2, 15];

    unsafe extern "C" {
        safe fn signal(number: i32, handler: extern "C" fn(i32)) -> usize;
    }

    extern "C" fn stop(_: i32) {
        STOPPED.store(true, Ordering::Relaxed);
    }

    /// From now on the signals do not end the program at once.
    pub fn catch() {
        for number in NUMBERS {
            signal(number, stop);
        }
    }

    /// Whether one of them has come.
    pub fn stopped() -> bool {
        STOPPED.load(Ordering::Relaxed)
    }
}

/// Other systems end the program at once.
#[cfg(not(unix))]
mod signals {
    pub fn catch() {}

    pub fn stopped() -> bool {
        false
    }
}
