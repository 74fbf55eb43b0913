
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

/// Ctrl-C, Ctrl-Break, and the end of the console, the session or the computer end the run as `quit` does.
#[cfg(windows)]
mod signals {
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::time::Duration;

    static STOPPED: AtomicBool = AtomicBool::new(false);

    /// `CTRL_BREAK_EVENT`; `CTRL_C_EVENT` is 0.
    const BREAK: u32 = 1;

    #[link(name = "kernel32")]
    unsafe extern "system" {
        safe fn SetConsoleCtrlHandler(handler: extern "system" fn(u32) -> i32, add: i32) -> i32;
    }

    extern "system" fn stop(event: u32) -> i32 {
        STOPPED.store(true, Ordering::Relaxed);
        // The process ends when this returns, or a few seconds later: the run has these.
        while event > BREAK {
            std::thread::sleep(Duration::from_secs(1));
        }
        1
    }

    /// From now on the events do not end the program at once.
    pub fn catch() {
        SetConsoleCtrlHandler(stop, 1);
    }

    /// Returns true if one of them has come.
    pub fn stopped() -> bool {
        STOPPED.load(Ordering::Relaxed)
    }
}

/// Other systems end the program at once.
#[cfg(not(any(unix, windows)))]
mod signals {
    pub fn catch() {}

    pub fn stopped() -> bool {
        false
    }
}
