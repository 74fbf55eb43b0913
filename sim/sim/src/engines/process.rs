//! A batch executable as an engine.

use super::{Engine, EngineError};
use crate::protocol::{Answer, Request};
use std::collections::VecDeque;
use std::io::{BufRead, BufReader, BufWriter, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

/// Default time-out of an answer, in seconds. All scans of a case are answered within this time, which a loop in the
/// program would exceed.
const PATIENCE: u32 = 20;

/// A batch executable. It is started at the first request and again after it was killed or has crashed.
pub struct Process {
    name: String,
    command: Command,
    /// Time-out of an answer, in seconds.
    patience: u32,
    running: Option<Running>,
}

struct Running {
    child: Child,
    requests: BufWriter<ChildStdin>,
    answers: Receiver<String>,
    /// Requests not yet known to be answered.
    pending: VecDeque<Request>,
    patience: u32,
}

impl Process {
    /// An engine that runs this command.
    pub fn new(name: impl Into<String>, command: Command) -> Self {
        Process {
            name: name.into(),
            command,
            patience: PATIENCE,
            running: None,
        }
    }

    /// Lets an answer take this many seconds: a simulated machine is slow, and others may use this one.
    #[cfg(feature = "cortex-m")]
    pub(crate) fn with_patience(mut self, patience: u32) -> Self {
        self.patience = patience;
        self
    }

    fn start(&mut self) -> Result<Running, EngineError> {
        let command = self.command.get_program().display().to_string();
        let failed = |error| EngineError::Start { command, error };
        let started = self
            .command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn();
        let mut child = match started {
            Ok(child) => child,
            Err(error) => return Err(failed(error)),
        };
        let (Some(stdin), Some(stdout)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(failed(std::io::Error::other("no pipes")));
        };
        let (sender, answers) = channel();
        // Reads ahead, so that the executable never waits for its answers to be read while it is sent requests.
        std::thread::spawn(move || {
            for line in BufReader::new(stdout).lines().map_while(Result::ok) {
                if sender.send(line).is_err() {
                    break;
                }
            }
        });
        Ok(Running {
            child,
            requests: BufWriter::new(stdin),
            answers,
            pending: VecDeque::new(),
            patience: self.patience,
        })
    }

    /// Kills the executable, if it runs; returns how it ended.
    fn stop(&mut self) -> String {
        let Some(mut running) = self.running.take() else {
            return "it was not running".to_string();
        };
        // It may have ended already; `wait` then returns its status.
        let _ = running.child.kill();
        match running.child.wait() {
            Ok(status) => status.to_string(),
            Err(error) => error.to_string(),
        }
    }
}

impl Running {
    fn send(&mut self, request: Request) -> std::io::Result<()> {
        self.pending.push_back(request);
        writeln!(self.requests, "{request}")
    }

    /// Waits second by second: whoever stops both programs for a while uses up one of the seconds.
    fn next_answer(&self) -> Result<String, RecvTimeoutError> {
        let wait = || self.answers.recv_timeout(Duration::from_secs(1));
        let mut waits = (0..self.patience).map(|_| wait());
        let answered = waits.find(|answer| *answer != Err(RecvTimeoutError::Timeout));
        answered.unwrap_or(Err(RecvTimeoutError::Timeout))
    }

    /// Waits for the answers to all pending requests; returns those to the ones that ask for values.
    fn answers(&mut self) -> Result<Vec<Answer>, EngineError> {
        let mut values = Vec::new();
        let mut missing = None;
        while let Some(request) = self.pending.pop_front() {
            let line = match self.next_answer() {
                Ok(line) => line,
                Err(RecvTimeoutError::Timeout) => return Err(EngineError::Silent(request)),
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(EngineError::Ended(request, String::new()));
                }
            };
            let Some(answer) = Answer::parse(&line) else {
                return Err(EngineError::Garbled(request, line));
            };
            if has_value(request) {
                values.push(answer);
            } else if answer == Answer::Missing {
                missing.get_or_insert(EngineError::Missing(request));
            }
        }
        missing.map_or(Ok(values), Err)
    }

    /// Sends requests; returns the answers to the pending ones if the last of these asks for a value.
    fn converse(&mut self, requests: &[Request]) -> Result<Vec<Answer>, EngineError> {
        for &request in requests {
            self.send(request)
                .map_err(|_| EngineError::Ended(request, String::new()))?;
        }
        match requests.last() {
            Some(&last) if has_value(last) => {
                let flushed = self.requests.flush();
                flushed.map_err(|_| EngineError::Ended(last, String::new()))?;
                self.answers()
            }
            _ => Ok(Vec::new()),
        }
    }
}

fn has_value(request: Request) -> bool {
    matches!(
        request,
        Request::Bit(..)
            | Request::Word(..)
            | Request::Double(..)
            | Request::Digest(..)
            | Request::Output(_)
            | Request::Pulses(_)
            | Request::Pass { .. }
            | Request::Frequency(_)
            | Request::ConstantScan
            | Request::Bfm(..)
            | Request::Signal { .. }
            | Request::Sent(..)
            | Request::Line(_)
    )
}

impl Engine for Process {
    fn name(&self) -> &str {
        &self.name
    }

    fn execute(&mut self, request: Request) -> Result<Answer, EngineError> {
        let answers = self.execute_all(&[request])?;
        Ok(answers.last().copied().unwrap_or(Answer::Ok))
    }

    fn execute_all(&mut self, requests: &[Request]) -> Result<Vec<Answer>, EngineError> {
        let mut running = match self.running.take() {
            Some(running) => running,
            None => self.start()?,
        };
        let result = running.converse(requests);
        self.running = Some(running);
        match result {
            Err(EngineError::Ended(request, _)) => Err(EngineError::Ended(request, self.stop())),
            Err(error @ (EngineError::Silent(_) | EngineError::Garbled(..))) => {
                self.stop();
                Err(error)
            }
            result => result,
        }
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        if let Some(running) = &mut self.running {
            // An executable that does not end by itself is killed.
            let _ = running.send(Request::Exit);
            let _ = running.requests.flush();
        }
        self.stop();
    }
}
