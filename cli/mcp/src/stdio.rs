//! Messages by lines, and requests one after another.
//!
//! A thread reads, so that a request which runs or waits can be cancelled; it answers `ping`, and what is not a
//! message.

use crate::Options;
use crate::protocol::{Fault, Message, Request, STATELESS, WITH_BATCHES, answer, message};
use crate::server::Server;
use serde_json::{Value, json};
use std::collections::VecDeque;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;

/// Longest line, in bytes.
const MAX_LINE: u64 = 8 << 20;

/// Most requests that wait.
const MAX_WAITING: usize = 256;

/// Serves one client, until its input ends and everything is answered.
///
/// # Errors
/// A folder of the options that does not exist; output that cannot be written.
pub fn serve(
    input: impl Read + Send,
    output: impl Write + Send,
    options: &Options,
) -> io::Result<()> {
    let mut server = Server::new(options)?;
    let line = Line::new(output);
    thread::scope(|scope| {
        scope.spawn(|| {
            // Input that cannot be read ends as input that is at its end.
            let _ = line.read(BufReader::new(input));
            line.close();
        });
        while let Some(work) = line.next() {
            let answers = line.work(&work, &mut server);
            line.done();
            if let Some(answers) = answers {
                line.send(&answers)?;
            }
        }
        Ok(())
    })
}

/// What is to be answered by one line.
enum Work {
    One(Request),
    /// Requests of a batch, and answers to what was not one.
    Batch(Vec<Result<Request, Value>>),
}

/// Requests that wait, and what is known of them.
#[derive(Default)]
struct Waiting {
    queue: VecDeque<Work>,
    /// Identifiers of the requests that are being answered.
    running: Vec<Value>,
    /// Those of them that are cancelled.
    cancelled: Vec<Value>,
    is_closed: bool,
}

/// A client.
struct Line<W> {
    output: Mutex<W>,
    waiting: Mutex<Waiting>,
    changed: Condvar,
    /// Ends what runs.
    stop: AtomicBool,
}

impl<W: Write> Line<W> {
    fn new(output: W) -> Self {
        Line {
            output: Mutex::new(output),
            waiting: Mutex::default(),
            changed: Condvar::new(),
            stop: AtomicBool::new(false),
        }
    }

    fn waiting(&self) -> MutexGuard<'_, Waiting> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn send(&self, value: &Value) -> io::Result<()> {
        let mut output = self.output.lock().unwrap_or_else(PoisonError::into_inner);
        writeln!(output, "{value}")?;
        output.flush()
    }

    fn close(&self) {
        self.waiting().is_closed = true;
        self.changed.notify_all();
    }

    /// The next work; `None` if there will be no more.
    fn next(&self) -> Option<Work> {
        let mut waiting = self.waiting();
        loop {
            if let Some(work) = waiting.queue.pop_front() {
                waiting.running = work.ids();
                self.stop.store(false, Ordering::Relaxed);
                return Some(work);
            }
            if waiting.is_closed {
                return None;
            }
            waiting = self
                .changed
                .wait(waiting)
                .unwrap_or_else(PoisonError::into_inner);
        }
    }

    fn done(&self) {
        let mut waiting = self.waiting();
        waiting.running.clear();
        waiting.cancelled.clear();
    }

    fn is_cancelled(&self, id: &Value) -> bool {
        self.waiting().cancelled.contains(id)
    }

    /// Answers work; `None` if all of it was cancelled.
    fn work(&self, work: &Work, server: &mut Server) -> Option<Value> {
        match work {
            Work::One(request) => self.respond(request, server),
            Work::Batch(_) if !server.takes_batches() => {
                let why = format!(
                    "several messages in an array are part of version {WITH_BATCHES} alone"
                );
                Some(answer(&Value::Null, Err(Fault::not_a_message(why))))
            }
            Work::Batch(all) => {
                let answers = all.iter().filter_map(|one| match one {
                    Ok(request) => self.respond(request, server),
                    Err(answer) => Some(answer.clone()),
                });
                let answers: Vec<Value> = answers.collect();
                (!answers.is_empty()).then_some(Value::Array(answers))
            }
        }
    }

    /// The answer to a request, unless it is cancelled.
    fn respond(&self, request: &Request, server: &mut Server) -> Option<Value> {
        if self.is_cancelled(&request.id) {
            return None;
        }
        let result = catch_unwind(AssertUnwindSafe(|| server.answer(request, &self.stop)));
        let result = result.unwrap_or_else(|_| Err(Fault::own()));
        (!self.is_cancelled(&request.id)).then(|| answer(&request.id, result))
    }

    /// Reads lines until the input ends.
    fn read(&self, mut input: impl BufRead) -> io::Result<()> {
        loop {
            let mut line = Vec::new();
            (&mut input)
                .take(MAX_LINE + 1)
                .read_until(b'\n', &mut line)?;
            if line.is_empty() {
                return Ok(());
            }
            if line.len() as u64 > MAX_LINE {
                while !line.ends_with(b"\n") {
                    line.clear();
                    if (&mut input).take(MAX_LINE).read_until(b'\n', &mut line)? == 0 {
                        break;
                    }
                }
                let why = format!("a message has at most {} MiB", MAX_LINE >> 20);
                self.send(&answer(&Value::Null, Err(Fault::not_a_message(why))))?;
                continue;
            }
            if !line.iter().all(u8::is_ascii_whitespace) {
                self.line(&line)?;
            }
        }
    }

    fn line(&self, line: &[u8]) -> io::Result<()> {
        match serde_json::from_slice(line) {
            Err(error) => self.send(&answer(&Value::Null, Err(Fault::not_json(&error)))),
            Ok(Value::Array(all)) if all.is_empty() => {
                let why = Fault::not_a_message("an empty array is not a message");
                self.send(&answer(&Value::Null, Err(why)))
            }
            Ok(Value::Array(all)) => self.batch(all),
            Ok(value) => match self.sorted(value) {
                Some(Ok(request))
                    if request.method == "ping" && request.version() != Some(STATELESS) =>
                {
                    self.send(&answer(&request.id, Ok(json!({}))))
                }
                Some(Ok(request)) => self.take(Work::One(request)),
                Some(Err(answer)) => self.send(&answer),
                None => Ok(()),
            },
        }
    }

    fn batch(&self, all: Vec<Value>) -> io::Result<()> {
        let work: Vec<_> = all
            .into_iter()
            .filter_map(|value| self.sorted(value))
            .collect();
        match work.is_empty() {
            true => Ok(()),
            false => self.take(Work::Batch(work)),
        }
    }

    /// A request, or the answer to what is not a message; notifications are taken note of.
    fn sorted(&self, value: Value) -> Option<Result<Request, Value>> {
        match message(value) {
            Ok(Message::Request(request)) => Some(Ok(request)),
            Ok(Message::Notification { method, params }) => {
                if let ("notifications/cancelled", Some(id)) =
                    (method.as_str(), params.get("requestId"))
                {
                    self.cancel(id);
                }
                None
            }
            Ok(Message::Answer) => None,
            Err((id, fault)) => Some(Err(answer(&id, Err(fault)))),
        }
    }

    fn cancel(&self, id: &Value) {
        let mut waiting = self.waiting();
        if waiting.running.contains(id) {
            waiting.cancelled.push(id.clone());
            self.stop.store(true, Ordering::Relaxed);
        }
        for work in &mut waiting.queue {
            if let Work::Batch(all) = work {
                all.retain(|one| !matches!(one, Ok(request) if request.id == *id));
            }
        }
        waiting
            .queue
            .retain(|work| !matches!(work, Work::One(request) if request.id == *id));
    }

    fn take(&self, work: Work) -> io::Result<()> {
        let mut waiting = self.waiting();
        if waiting.queue.len() < MAX_WAITING {
            waiting.queue.push_back(work);
            self.changed.notify_all();
            return Ok(());
        }
        let count = waiting.queue.len();
        drop(waiting);
        let busy = |id: &Value| answer(id, Err(Fault::busy(count)));
        match work {
            Work::One(request) => self.send(&busy(&request.id)),
            batch @ Work::Batch(_) => self.send(&batch.ids().iter().map(busy).collect()),
        }
    }
}

impl Work {
    fn ids(&self) -> Vec<Value> {
        match self {
            Work::One(request) => vec![request.id.clone()],
            Work::Batch(all) => all
                .iter()
                .flatten()
                .map(|request| request.id.clone())
                .collect(),
        }
    }
}
