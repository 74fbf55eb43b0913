//! Threads that exchange values with the other ends, and what they share with the scan.

use super::settings::{Connection, Kind, Loss, Row};
use rungc_rt::{Class, Hal, NoHal, Plc, Program};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, TryLockError};
use std::thread;
use std::time::{Duration, Instant};

/// Pause of a thread between attempts to reach the other end.
const RETRY: Duration = Duration::from_secs(1);

/// Time that the end of a run allows the threads for switching their outputs off.
const GRACE: Duration = Duration::from_secs(2);

/// Consumer of the values of a row: the indices of its connection and of the row in it, the row, and its values.
pub type TakeRow<'a> = dyn FnMut(usize, usize, &Row, &mut dyn Iterator<Item = Option<i16>>) + 'a;

/// Producer of the values of a row, with arguments as for [`TakeRow`].
pub type GiveRow<'a> = dyn FnMut(usize, usize, &Row, &mut [i16]) + 'a;

/// Reason why an exchange failed.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum ExchangeError {
    /// The other end cannot be reached any more; it is opened again.
    Lost(String),
    /// It answers, but not with the requested data.
    Refused(String),
}

impl ExchangeError {
    fn why(self) -> String {
        match self {
            ExchangeError::Lost(why) | ExchangeError::Refused(why) => why,
        }
    }
}

/// Exchange of values with a remote end.
pub trait Driver: Send {
    /// Reads all rows that are read into `inputs` and writes `outputs` by the rows that are written, each at the
    /// places that [`Row::place`](super::Row::place) names; a bit is 0 or 1. A row that the other end rejects keeps no
    /// other row from its turn: outputs change, and are turned off at the end, whatever becomes of an input.
    ///
    /// # Errors
    /// Why the inputs are not those of the other end.
    fn exchange(
        &mut self,
        connection: &Connection,
        inputs: &mut [i16],
        outputs: &[i16],
    ) -> Result<(), ExchangeError>;

    /// Reports of input since the last call that is left out; each is made once.
    fn reports(&mut self) -> Vec<String> {
        Vec::new()
    }

    /// The run is over, and the outputs are off.
    fn end(&mut self) {}
}

/// Gives each row its turn, also after one that is rejected; the first error is returned, a lost end at once.
pub(super) fn each_row(
    connection: &Connection,
    mut turn: impl FnMut(&Row) -> Result<(), ExchangeError>,
) -> Result<(), ExchangeError> {
    let mut result = Ok(());
    for row in &connection.rows {
        match turn(row) {
            Ok(()) => {}
            Err(error @ ExchangeError::Refused(_)) => result = result.and(Err(error)),
            Err(lost) => return Err(lost),
        }
    }
    result
}

/// Opens an other end, waiting for it no longer than the connection says.
pub type Opener = fn(&Connection) -> Result<Box<dyn Driver>, String>;

/// A running program as its connections see it.
pub trait Terminals {
    /// Its devices.
    fn plc(&mut self) -> &mut dyn Plc;

    /// State of output terminal Y `number` ([`Program::output`]).
    fn output(&mut self, number: u32) -> bool;

    /// Input terminal X `number` turns on or off ([`Program::input_edge`]).
    fn input_edge(&mut self, number: u32, on: bool);
}

/// A program and its hardware.
pub struct Of<'a, P>(pub &'a mut P, pub &'a mut dyn Hal);

impl<P: Program> Terminals for Of<'_, P> {
    fn plc(&mut self) -> &mut dyn Plc {
        self.0
    }

    fn output(&mut self, number: u32) -> bool {
        self.0.output(number)
    }

    fn input_edge(&mut self, number: u32, on: bool) {
        self.0.input_edge(self.1, number, on);
    }
}

/// State shared between a thread and the scan.
#[derive(Default)]
struct State {
    inputs: Vec<i16>,
    outputs: Vec<i16>,
    is_up: bool,
    /// The run ends: the outputs are written once more.
    ends: bool,
    /// The thread has ended.
    over: bool,
    /// Messages to report.
    messages: Vec<String>,
}

/// The state, and what wakes those who wait for it.
#[derive(Default)]
struct Shared {
    state: Mutex<State>,
    changed: Condvar,
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The state, unless the other side is at it.
    fn try_lock(&self) -> Option<MutexGuard<'_, State>> {
        match self.state.try_lock() {
            Ok(state) => Some(state),
            Err(TryLockError::Poisoned(error)) => Some(error.into_inner()),
            Err(TryLockError::WouldBlock) => None,
        }
    }
}

/// A connection at work, as the scan sees it.
struct Running {
    connection: Arc<Connection>,
    shared: Arc<Shared>,
    inputs: Vec<i16>,
    outputs: Vec<i16>,
    is_up: bool,
}

/// The connections of a running program.
#[derive(Default)]
pub struct Io {
    running: Vec<Running>,
    messages: Vec<String>,
}

impl Io {
    /// Starts a thread for each connection; `opener` knows the drivers of this program.
    ///
    /// # Errors
    /// A connection that this program has no driver for, or a thread that cannot be had.
    pub fn start(
        connections: Vec<Connection>,
        opener: impl Fn(&Connection) -> Result<Opener, String>,
    ) -> Result<Self, String> {
        let mut io = Io::default();
        for connection in connections {
            let open =
                opener(&connection).map_err(|why| format!("[io.{}]: {why}", connection.name))?;
            let shared = Arc::new(Shared::default());
            let (inputs, outputs) = (connection.values(true), connection.values(false));
            *shared.lock() = State {
                inputs: vec![0; inputs],
                outputs: vec![0; outputs],
                ..State::default()
            };
            let connection = Arc::new(connection);
            let (its, both) = (Arc::clone(&connection), Arc::clone(&shared));
            thread::Builder::new()
                .name(format!("io {}", connection.name))
                .spawn(move || work(&its, &both, open))
                .map_err(|error| format!("[io.{}]: {error}", connection.name))?;
            io.running.push(Running {
                connection,
                shared,
                inputs: vec![0; inputs],
                outputs: vec![0; outputs],
                is_up: false,
            });
        }
        Ok(io)
    }

    /// Returns true if there is a connection.
    pub fn any(&self) -> bool {
        !self.running.is_empty()
    }

    /// Before a scan: devices take what the other ends have given, or what they are to be while an end is lost.
    /// Returns what there is to report.
    pub fn take(&mut self, plc: &mut impl Program, hal: &mut dyn Hal) -> Vec<String> {
        self.take_into(&mut Of(plc, hal))
    }

    /// The same without a [`Program`].
    pub fn take_into(&mut self, plc: &mut dyn Terminals) -> Vec<String> {
        for running in &mut self.running {
            running.refresh(&mut self.messages);
            running.apply(plc);
        }
        std::mem::take(&mut self.messages)
    }

    /// As [`Io::take`], for a host of several PLCs: calls `set` with each row that is read, the places of its
    /// connection and of the row in it, and the values of its devices; `None` of one that stays as it is.
    pub fn take_rows(&mut self, set: &mut TakeRow) -> Vec<String> {
        for (n, running) in self.running.iter_mut().enumerate() {
            running.refresh(&mut self.messages);
            let rows = running.connection.rows.iter().enumerate();
            for (place, row) in rows.filter(|(_, row)| row.reads) {
                set(n, place, row, &mut running.values(row));
            }
        }
        std::mem::take(&mut self.messages)
    }

    /// The rows that are written, with the places of their connection and of the row in it.
    pub fn written(&self) -> impl Iterator<Item = (usize, usize, &Row)> {
        self.running.iter().enumerate().flat_map(|(n, running)| {
            let rows = running.connection.rows.iter().enumerate();
            let rows = rows.filter(|(_, row)| !row.reads);
            rows.map(move |(place, row)| (n, place, row))
        })
    }

    /// As [`Io::give`], for a host of several PLCs: calls `get` with each row that is written, as [`Io::take_rows`]
    /// does; it fills in the values.
    pub fn give_rows(&mut self, get: &mut GiveRow) {
        for (n, running) in self.running.iter_mut().enumerate() {
            let rows = running.connection.rows.iter().enumerate();
            for (place, row) in rows.filter(|(_, row)| !row.reads) {
                get(n, place, row, &mut running.outputs[row.place.clone()]);
            }
            running.publish();
        }
    }

    /// After a scan: the other ends are given what the devices are.
    pub fn give(&mut self, plc: &mut impl Program) {
        self.give_from(&mut Of(plc, &mut NoHal));
    }

    /// The same without a [`Program`].
    pub fn give_from(&mut self, plc: &mut dyn Terminals) {
        for running in &mut self.running {
            for row in running.connection.directed(false) {
                for (value, number) in running.outputs[row.place.clone()]
                    .iter_mut()
                    .zip(row.first..)
                {
                    *value = match row.class {
                        Class::Y => i16::from(plc.output(number)),
                        class if row.is_bits() => {
                            i16::from(plc.plc().bit(class, number) == Some(true))
                        }
                        class => plc.plc().word(class, number).unwrap_or(0),
                    };
                }
            }
            running.publish();
        }
    }

    /// The run is over: all bits that are written are turned off. Waits for that, up to two seconds; returns what there
    /// is to report.
    pub fn end(self) -> Vec<String> {
        for running in &self.running {
            let mut state = running.shared.lock();
            for row in running
                .connection
                .directed(false)
                .filter(|row| row.is_bits())
            {
                state.outputs[row.place.clone()].fill(0);
            }
            state.ends = true;
            running.shared.changed.notify_all();
        }
        let until = Instant::now() + GRACE;
        let mut messages = self.messages;
        for running in &self.running {
            let left = until.saturating_duration_since(Instant::now());
            let state = running.shared.lock();
            let ended = running
                .shared
                .changed
                .wait_timeout_while(state, left, |state| !state.over);
            let (mut state, _) = ended.unwrap_or_else(PoisonError::into_inner);
            messages.append(&mut state.messages);
            // Nothing is switched by standard output.
            let is_console = running.connection.kind == Kind::Console;
            let is_off = is_console || state.over && state.is_up;
            if !is_off && !running.outputs.is_empty() {
                let name = &running.connection.name;
                messages.push(format!(
                    "io {name}: not reached at the end: its outputs may still be on"
                ));
            }
        }
        messages
    }
}

impl Running {
    /// Takes what the thread has left.
    fn refresh(&mut self, messages: &mut Vec<String>) {
        if let Some(mut state) = self.shared.try_lock() {
            self.inputs.copy_from_slice(&state.inputs);
            self.is_up = state.is_up;
            messages.append(&mut state.messages);
        }
    }

    /// Leaves the outputs to the thread.
    fn publish(&self) {
        if let Some(mut state) = self.shared.try_lock() {
            state.outputs.copy_from_slice(&self.outputs);
        }
    }

    /// New values of a row's devices; `None` leaves a device unchanged.
    fn values(&self, row: &Row) -> impl Iterator<Item = Option<i16>> {
        let way = (self.is_up, row.loss, self.connection.loss);
        let values = self.inputs[row.place.clone()].iter();
        values.map(move |&value| match way {
            (true, ..) => Some(value),
            (false, Some(value), _) => Some(value),
            (false, None, Loss::Zero) => Some(0),
            (false, None, Loss::Hold) => None,
        })
    }

    fn apply(&self, plc: &mut dyn Terminals) {
        let fault = self.connection.fault;
        for row in self.connection.directed(true) {
            for (value, number) in self.values(row).zip(row.first..) {
                let Some(value) = value else { continue };
                if !row.is_bits() {
                    let _ = plc.plc().set_word(row.class, number, value);
                    continue;
                }
                let on = value != 0;
                let before = plc.plc().bit(row.class, number);
                let _ = plc.plc().set_bit(row.class, number, on);
                if row.class == Class::X && before != Some(on) {
                    plc.input_edge(number, on);
                }
            }
        }
        if let Some((class, number)) = fault {
            let _ = plc.plc().set_bit(class, number, !self.is_up);
        }
    }
}

/// The thread of a connection.
fn work(connection: &Connection, shared: &Shared, open: Opener) {
    let every = Duration::from_millis(connection.every_ms);
    let mut driver: Option<Box<dyn Driver>> = None;
    let mut inputs = vec![0; connection.values(true)];
    let mut outputs = vec![0; connection.values(false)];
    let mut reported: Option<Option<String>> = None;
    let mut next = Instant::now();
    loop {
        let ends = {
            let state = shared.lock();
            outputs.copy_from_slice(&state.outputs);
            state.ends
        };
        let result = match &mut driver {
            // What is read then is of no use, and whether it comes is not asked.
            Some(driver) if ends && connection.kind.asks() => {
                driver.exchange(&connection.written(), &mut inputs, &outputs)
            }
            Some(driver) => driver.exchange(connection, &mut inputs, &outputs),
            // An end that was lost is not waited for any more.
            None if ends => Err(ExchangeError::Lost("the run has ended".to_string())),
            None => match open(connection) {
                Ok(opened) => {
                    let opened = driver.insert(opened);
                    opened.exchange(connection, &mut inputs, &outputs)
                }
                Err(why) => Err(ExchangeError::Lost(why)),
            },
        };
        let reports = driver.as_mut().map(|driver| driver.reports());
        let is_up = result.is_ok();
        let is_lost = matches!(result, Err(ExchangeError::Lost(_)));
        if is_lost {
            // At once: a chip or a line that comes back has its old name only when the old one is closed.
            driver = None;
        }
        let news = result.err().map(ExchangeError::why);
        let mut state = shared.lock();
        state.is_up = is_up;
        let reports = reports.unwrap_or_default().into_iter();
        let reports = reports.map(|report| format!("io {}: {report}", connection.name));
        state.messages.extend(reports);
        if is_up {
            state.inputs.copy_from_slice(&inputs);
        }
        // An end that stays away is reported once.
        if !ends && reported.as_ref().map(Option::is_none) != Some(is_up) {
            let name = &connection.name;
            state.messages.push(match &news {
                None => format!("io {name}: connected to {}", connection.place()),
                Some(why) if connection.kind == Kind::Console => format!("io {name}: {why}"),
                Some(why) => format!("io {name}: {}: {why}", connection.place()),
            });
            reported = Some(news);
        }
        if ends {
            if let (Some(driver), true) = (&mut driver, is_up) {
                driver.end();
            }
            state.over = true;
            shared.changed.notify_all();
            return;
        }
        let now = Instant::now();
        next = match is_lost {
            true => now + RETRY,
            false => (next + every).max(now),
        };
        let wait = next.saturating_duration_since(now);
        let waited = shared
            .changed
            .wait_timeout_while(state, wait, |state| !state.ends);
        drop(waited);
    }
}
