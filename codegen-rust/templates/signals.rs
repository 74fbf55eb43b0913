
/// Ctrl-C, the end of the terminal and a request to terminate end the run as `quit` does. The standard library knows no signals, but the C library that it uses does.
#[cfg(unix)]
mod signals {
    use std::sync::atomic::{AtomicBool, Ordering};

    static STOPPED: AtomicBool = AtomicBool::new(false);

    /// SIGHUP, SIGINT and SIGTERM.
    const NUMBERS: [i32; 3] = [1, 2, 15];

    /// SIGXFSZ, as all have it but MIPS: a file that may not grow is as a full disk.
    const FILE_SIZE: i32 = 25;

    /// Nothing is done about a signal: `SIG_IGN`.
    const IGNORED: usize = 1;

    unsafe extern "C" {
        safe fn signal(number: i32, handler: usize) -> usize;
    }

    extern "C" fn stop(_: i32) {
        STOPPED.store(true, Ordering::Relaxed);
    }

    /// From now on the signals do not end the program at once. What the caller ignores (`nohup`) stays so.
    pub fn catch() {
        signal(FILE_SIZE, IGNORED);
        for number in NUMBERS {
            if signal(number, stop as extern "C" fn(i32) as usize) == IGNORED {
                signal(number, IGNORED);
            }
        }
    }

    /// Returns true if one of them was received.
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
