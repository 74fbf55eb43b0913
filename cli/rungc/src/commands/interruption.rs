//! A command that is interrupted (Ctrl-C, the end of the terminal, or the system's request to end) ends well: what it
//! was writing is whole or not there, and the exit code says that it was cut short.

#[cfg(unix)]
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use std::process;
use std::sync::Once;
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

/// As [`note`], for commands that wait for others, such as compilers: these are ended, so that their caller cleans up.
/// What takes longer than it may is ended.
pub fn note_for_a_while() {
    install(Some(GRACE));
}

fn install(grace: Option<Duration>) {
    static INSTALLED: Once = Once::new();
    INSTALLED.call_once(|| {
        watch(move || {
            if REQUESTED.swap(true, Ordering::Relaxed) {
                process::exit(EXIT_CODE.into());
            }
            if let Some(grace) = grace {
                #[cfg(target_os = "linux")]
                children::end();
                thread::spawn(move || {
                    thread::sleep(grace);
                    process::exit(EXIT_CODE.into());
                });
            }
        });
    });
}

/// Calls a function at each interruption. Signals that the caller ignores (`nohup`, a shell's background) stay ignored.
/// If the system accepts no handler, it ends the process as if there were none.
#[cfg(unix)]
fn watch(interrupted: impl Fn() + Send + 'static) {
    let signals = [SIGHUP, SIGINT, SIGTERM].into_iter();
    let signals = signals.filter(|&signal| !rungc_host::signals::is_ignored(signal));
    let Ok(mut signals) = signal_hook::iterator::Signals::new(signals) else {
        return;
    };
    let wait = move || signals.forever().for_each(|_| interrupted());
    // Without the thread, the handlers would take signals without an effect: the process could not be ended.
    if let Err(error) = thread::Builder::new().name("signals".into()).spawn(wait) {
        super::eprint_line(&format!("rungc: {error}"));
        process::exit(2);
    }
}

#[cfg(not(unix))]
fn watch(interrupted: impl Fn() + Send + 'static) {
    let _ = ctrlc::set_handler(interrupted);
}

/// The processes that this one has started, and theirs: Ctrl-C in a terminal reaches them, a signal to this process
/// alone does not.
#[cfg(target_os = "linux")]
mod children {
    use rustix::process::{Pid, Signal, kill_process};
    use std::fs;

    /// Asks them to end.
    pub fn end() {
        let mut processes = of(std::process::id());
        while let Some(id) = processes.pop() {
            processes.extend(of(id));
            if let Some(pid) = i32::try_from(id).ok().and_then(Pid::from_raw) {
                let _ = kill_process(pid, Signal::TERM);
            }
        }
    }

    /// Numbers of the processes that the threads of a process have started.
    fn of(id: u32) -> Vec<u32> {
        let threads = fs::read_dir(format!("/proc/{id}/task"));
        let threads = threads.into_iter().flatten().flatten();
        let lists =
            threads.filter_map(|thread| fs::read_to_string(thread.path().join("children")).ok());
        let mut all = Vec::new();
        for list in lists {
            all.extend(
                list.split_ascii_whitespace()
                    .filter_map(|id| id.parse::<u32>().ok()),
            );
        }
        all
    }
}

/// Returns true if the command has been interrupted.
pub fn is_requested() -> bool {
    REQUESTED.load(Ordering::Relaxed)
}
