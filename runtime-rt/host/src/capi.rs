//! Connections and log of a program on a computer, for hosts in C: one instance per process.

use crate::io::{Environment, Terminals};
use rungc_rt::Plc;
use rungc_rt::capi::Map;
use std::borrow::Cow;
use std::ffi::{CStr, c_char, c_void};
use std::sync::{Mutex, MutexGuard, PoisonError};

static ENVIRONMENT: Mutex<Option<Environment>> = Mutex::new(None);

/// The one that there is.
fn with<T>(does: impl FnOnce(&mut Environment) -> T) -> T {
    let mut environment: MutexGuard<'_, _> =
        ENVIRONMENT.lock().unwrap_or_else(PoisonError::into_inner);
    does(environment.get_or_insert_with(Environment::new))
}

fn text<'a>(text: *const c_char) -> Cow<'a, str> {
    if text.is_null() {
        return Cow::Borrowed("");
    }
    // SAFETY: a host passes texts that end with a zero and outlive the call.
    unsafe { CStr::from_ptr(text) }.to_string_lossy()
}

/// Reports what is wrong with the value of an option.
fn check(program: &str, option: &str, value: &str, result: Result<(), String>) -> bool {
    let wrong = result.err();
    if let Some(why) = &wrong {
        with(|environment| environment.report(&format!("{program}: {option} {value}: {why}")));
    }
    wrong.is_none()
}

/// `--io FILE`: reads the connections that a file describes; false after a message if it cannot be used.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_io_describe(program: *const c_char, path: *const c_char) -> bool {
    let (program, path) = (text(program), text(path));
    let described = with(|environment| environment.describe(&path));
    check(&program, "--io", &path, described)
}

/// `--log FILE`: begins or continues a log; false after a message if it cannot be written.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_io_open_log(program: *const c_char, path: *const c_char) -> bool {
    let (program, path) = (text(program), text(path));
    let begun = with(|environment| environment.log(&path));
    check(&program, "--log", &path, begun)
}

/// Adds a line to the log, if there is one.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_io_log(line: *const c_char) {
    with(|environment| environment.log_line(text(line).trim_end_matches('\n')));
}

/// Returns true if a connection reads standard input, which leaves none for commands.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_io_uses_stdin() -> bool {
    with(|environment| environment.takes_input())
}

/// Starts the connections, before the first scan; false after a message if that cannot be done.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_io_begin(program: *const c_char, map: &Map) -> bool {
    let begun = with(|environment| environment.begin(map));
    if let Err(why) = &begun {
        let program = text(program);
        with(|environment| environment.report(&format!("{program}: {why}")));
    }
    begun.is_ok()
}

/// Callbacks of a host for connections: `input_edge` receives changes of inputs, `output` returns the state of an
/// output terminal. Both are given `context`; `input_edge` may be NULL.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Terminal {
    /// Argument passed to the functions.
    pub context: *mut c_void,
    /// An input terminal turns on or off.
    pub input_edge: Option<extern "C" fn(context: *mut c_void, number: u32, on: bool)>,
    /// The state of an output terminal.
    pub output: Option<extern "C" fn(context: *mut c_void, number: u32) -> bool>,
}

/// A program in C.
struct InC<'a>(&'a mut Map, &'a Terminal);

impl Terminals for InC<'_> {
    fn plc(&mut self) -> &mut dyn Plc {
        self.0
    }

    fn output(&mut self, number: u32) -> bool {
        self.1.output.is_some_and(|f| f(self.1.context, number))
    }

    fn input_edge(&mut self, number: u32, on: bool) {
        if let Some(notify) = self.1.input_edge {
            notify(self.1.context, number, on);
        }
    }
}

/// Before a scan: devices take what the other ends have given, or what they are to be while an end is lost.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_io_read_inputs(map: &mut Map, terminal: &Terminal) {
    with(|environment| environment.read_inputs(&mut InC(map, terminal)));
}

/// After a scan: the other ends are given what the devices are.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_io_write_outputs(map: &mut Map, terminal: &Terminal) {
    with(|environment| environment.write_outputs(&mut InC(map, terminal)));
}

/// The run is over: outputs are turned off, and the log is written.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_io_end() {
    with(Environment::end);
}
