//! Signals that the caller of a process ignores.

/// Returns true if the process ignores a signal, as one does that `nohup` or a shell's background has started: it stays
/// so. To be called before a handler is installed.
pub fn is_ignored(number: i32) -> bool {
    /// `SIG_IGN`.
    const IGNORED: usize = 1;

    #[allow(unsafe_code, reason = "a function of the C library")]
    unsafe extern "C" {
        safe fn signal(number: i32, handler: usize) -> usize;
    }

    let before = signal(number, IGNORED);
    if before != IGNORED {
        signal(number, before);
    }
    before == IGNORED
}
