//! Report of a mistake in rungc itself.

use std::backtrace::Backtrace;
use std::{env, panic, process, thread};

/// Reports panics with a backtrace, and ends the process also if another thread than the present one panics: what that
/// thread did (serve, save, log) would be missing unnoticed.
pub(crate) fn report_panics() {
    let main = thread::current().id();
    let message = panic::take_hook();
    panic::set_hook(Box::new(move |panic| {
        message(panic);
        if env::var_os("RUST_BACKTRACE").is_none() {
            eprintln!("{}", Backtrace::force_capture());
        }
        eprintln!(
            "This is a mistake in rungc {}. Please report it: {}/issues",
            env!("CARGO_PKG_VERSION"),
            env!("CARGO_PKG_REPOSITORY")
        );
        if thread::current().id() != main {
            process::abort();
        }
    }));
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::process::Command;

    /// Set in the process that panics.
    const PANICS: &str = "RUNGC_TEST_PANICS";

    #[test]
    fn a_panic_of_a_thread_ends_the_process_with_a_backtrace() {
        if env::var_os(PANICS).is_some() {
            report_panics();
            let _ = thread::spawn(|| panic!("lost")).join();
            return;
        }
        let output = Command::new(env::current_exe().unwrap())
            .args(["--exact", "--nocapture"])
            .arg("crash::tests::a_panic_of_a_thread_ends_the_process_with_a_backtrace")
            .env(PANICS, "")
            .env_remove("RUST_BACKTRACE")
            .output()
            .unwrap();
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success());
        for part in ["lost", "rungc_cli::crash", "Please report it"] {
            assert!(stderr.contains(part), "{part}: {stderr}");
        }
    }
}
