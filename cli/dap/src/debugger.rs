//! A program that runs under an editor: requests, and the events of its run.

use crate::Ended;
use crate::breakpoints::{Breakpoints, Resolved};
use crate::evaluate::{self, Answer};
use crate::launch::Launch;
use crate::observe::Why;
use crate::places::{LISTING, Source};
use crate::protocol::{
    BreakpointLocations, DataBreakpointInfo, Evaluate, OfThread, Request, SetBreakpoints,
    SetDataBreakpoints, SetExceptionBreakpoints, SetExpression, SetVariable, SourceArguments,
    StackTrace, Variables,
};
use crate::run::{Progress, Run, Stopped};
use crate::server::{Editor, PLC_ERRORS};
use crate::variables::{self, Scopes, device_in};
use crate::wire::{Client, Incoming};
use rungc::Program;
use rungc_models::plc_errors;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::io::{self, Write};
use std::path::PathBuf;
use std::sync::mpsc::RecvTimeoutError;
use std::time::{Duration, Instant};

/// Number of the only thread.
const THREAD: i64 = 1;
/// Time for which scans are executed before messages are looked at.
const SLICE: Duration = Duration::from_millis(5);
/// Delay after which a run in real time does not catch up.
const TOO_LATE: Duration = Duration::from_millis(500);

/// End of a run.
pub enum Next {
    /// The session has ended.
    Ended(Ended),
    /// The program, read again, is to run from power-on.
    Restart(Box<(Launch, Program)>),
}

/// State of a run.
#[derive(Clone, Copy, PartialEq, Eq)]
enum State {
    /// The editor sets its breakpoints.
    Configuring,
    Stopped,
    /// It executes scans; the flag is true before the first one.
    Running(bool),
    /// The program was terminated.
    Terminated,
}

/// A program that runs under an editor.
pub struct Debugger<'a, 'p, W> {
    client: &'a mut Client<W>,
    editor: &'a mut Editor,
    run: Run<'p>,
    launch: &'a Launch,
    scopes: Scopes,
    state: State,
    /// The instruction and the error at which the run has stopped.
    error: Option<(u16, Option<usize>)>,
    /// Errors that were reported, by code and step.
    reported: BTreeSet<(u16, u32)>,
    was_running: bool,
    /// The time at which the run was resumed, by the clock and by that of the PLC.
    resumed: (Instant, u64),
}

impl<'a, 'p, W: Write> Debugger<'a, 'p, W> {
    /// A program that is at power-on.
    pub fn new(
        client: &'a mut Client<W>,
        editor: &'a mut Editor,
        run: Run<'p>,
        launch: &'a Launch,
    ) -> Self {
        Debugger {
            scopes: Scopes::of(run.program()),
            client,
            editor,
            run,
            launch,
            state: State::Configuring,
            error: None,
            reported: BTreeSet::new(),
            was_running: true,
            resumed: (Instant::now(), 0),
        }
    }

    /// Serves the editor; `is_again` is true after a restart, when its breakpoints are known.
    ///
    /// # Errors
    /// Output that cannot be written.
    pub fn serve(mut self, is_again: bool) -> io::Result<Next> {
        match is_again {
            false => self.client.event("initialized", Value::Null)?,
            true => {
                let resolved = self.apply();
                let states = resolved.at_lines.into_values().flatten();
                for mut state in states.chain(resolved.on_devices) {
                    self.shift_line(&mut state);
                    self.client.event(
                        "breakpoint",
                        json!({ "reason": "changed", "breakpoint": state }),
                    )?;
                }
                self.begin()?;
            }
        }
        loop {
            let incoming = match self.state {
                State::Running(_) => {
                    let wait = self.wait();
                    match self.client.receive_within(wait) {
                        Ok(incoming) => Some(incoming),
                        Err(RecvTimeoutError::Disconnected) => None,
                        Err(RecvTimeoutError::Timeout) => {
                            self.advance()?;
                            continue;
                        }
                    }
                }
                _ => self.client.receive(),
            };
            let next = match incoming {
                None => Some(Next::Ended(Ended::Abandoned)),
                Some(Incoming::Malformed(why)) => {
                    self.client.output("stderr", &why)?;
                    None
                }
                Some(Incoming::Request(request)) => self.handle(&request)?,
            };
            if let Some(next) = next {
                return Ok(next);
            }
        }
    }

    /// The configuration is done.
    fn begin(&mut self) -> io::Result<()> {
        match self.launch.stop_on_entry && !self.launch.no_debug {
            true => {
                self.state = State::Stopped;
                self.stopped("entry", json!({}))
            }
            false => {
                self.resume();
                self.state = State::Running(false);
                Ok(())
            }
        }
    }

    fn resume(&mut self) {
        self.error = None;
        self.resumed = (Instant::now(), self.run.now_ms());
        self.state = State::Running(true);
    }

    /// Time until the next scan is due.
    fn wait(&mut self) -> Duration {
        if !self.launch.real_time {
            return Duration::ZERO;
        }
        let (since, since_ms) = self.resumed;
        let passed = Duration::from_millis(self.run.now_ms().saturating_sub(since_ms));
        let now = since.elapsed();
        if now > passed + TOO_LATE {
            self.resumed = (Instant::now(), self.run.now_ms());
        }
        passed.saturating_sub(now)
    }

    /// Executes scans for a moment, or one that is due.
    fn advance(&mut self) -> io::Result<()> {
        let end = Instant::now() + SLICE;
        loop {
            let Progress { stopped, logged } = match self.state {
                State::Running(true) => self.run.resume(),
                _ => self.run.scan(),
            };
            self.state = State::Running(false);
            for line in logged {
                self.client.output("console", &line)?;
            }
            self.report()?;
            if let Some(stopped) = stopped {
                return self.stop(stopped);
            }
            if self.launch.real_time || Instant::now() >= end {
                return Ok(());
            }
        }
    }

    /// Reports errors of the PLC that are new, and its switch.
    fn report(&mut self) -> io::Result<()> {
        let plc = self.run.before_scan();
        let is_running = plc.is_running();
        let errors = plc.errors();
        let new: Vec<_> = match errors.len() > self.reported.len() {
            true => errors.to_vec(),
            false => Vec::new(),
        };
        for error in new {
            if self.reported.insert((error.code, error.step)) {
                let text = self.error_text(error.code, error.step);
                let line = format!("at {} ms: {text}", error.first_ms);
                self.client.output("important", &line)?;
            }
        }
        if std::mem::replace(&mut self.was_running, is_running) != is_running {
            let mode = if is_running { "RUN" } else { "STOP" };
            let line = format!("at {} ms: the PLC is in {mode}", self.run.now_ms());
            self.client.output("important", &line)?;
        }
        Ok(())
    }

    fn error_text(&self, code: u16, step: u32) -> String {
        let title = plc_errors::title(code, self.run.program().module().model.id);
        match self.run.places.at_step(step) {
            Some(instr) => format!("error {code}, {title}: {}", self.run.places.title(instr)),
            None => format!("error {code}, {title}: step {step}"),
        }
    }

    /// The run has stopped.
    fn stop(&mut self, stopped: Stopped) -> io::Result<()> {
        self.state = State::Stopped;
        match stopped.why {
            None if stopped.is_first => {
                let text = "the recorded history begins here";
                self.stopped("entry", json!({ "description": text, "text": text }))
            }
            None | Some(Why::Place) => self.stopped("step", json!({})),
            Some(Why::Points(ids)) => {
                self.stopped("breakpoint", json!({ "hitBreakpointIds": ids }))
            }
            Some(Why::Data(ids, text)) => self.stopped(
                "data breakpoint",
                json!({ "hitBreakpointIds": ids, "description": text, "text": text }),
            ),
            Some(Why::Error(code, step)) => {
                self.error = Some((code, self.run.places.at_step(step)));
                let text = self.error_text(code, step);
                self.stopped("exception", json!({ "description": text, "text": text }))
            }
        }
    }

    fn stopped(&mut self, reason: &str, mut body: Value) -> io::Result<()> {
        body["reason"] = json!(reason);
        body["threadId"] = json!(THREAD);
        body["allThreadsStopped"] = json!(true);
        self.client.event("stopped", body)
    }

    fn handle(&mut self, request: &Request) -> io::Result<Option<Next>> {
        match request.command.as_str() {
            "disconnect" => {
                self.client.respond(request, Ok(Value::Null))?;
                return Ok(Some(Next::Ended(Ended::Disconnected)));
            }
            command if self.state == State::Terminated => {
                let why = format!("`{command}`: the program was terminated");
                self.client.respond(request, Err(why))?;
            }
            "terminate" => {
                self.state = State::Terminated;
                self.client.respond(request, Ok(Value::Null))?;
                self.client.event("exited", json!({ "exitCode": 0 }))?;
                self.client.event("terminated", Value::Null)?;
            }
            "restart" => return self.restart(request),
            "configurationDone" => match self.state {
                State::Configuring => {
                    self.client.respond(request, Ok(Value::Null))?;
                    self.begin()?;
                }
                _ => {
                    let why = "the configuration is done already".to_owned();
                    self.client.respond(request, Err(why))?;
                }
            },
            "continue" | "next" | "stepIn" | "stepOut" | "stepBack" | "reverseContinue"
            | "pause" => {
                self.control(request)?;
            }
            _ => {
                let result = self.answer(request);
                self.client.respond(request, result)?;
            }
        }
        Ok(None)
    }

    /// Reads the program again, and starts it.
    fn restart(&mut self, request: &Request) -> io::Result<Option<Next>> {
        let again = match request
            .arguments
            .get("arguments")
            .and_then(Value::as_object)
        {
            Some(arguments) => Launch::read(arguments),
            None => Ok(self.launch.clone()),
        };
        let compiled = again.and_then(|launch| {
            let program = launch.compile()?;
            Run::new(&program, &launch)?;
            Ok((launch, program))
        });
        match compiled {
            Ok(compiled) => {
                self.client.respond(request, Ok(Value::Null))?;
                Ok(Some(Next::Restart(Box::new(compiled))))
            }
            Err(why) => {
                self.client.respond(request, Err(why))?;
                Ok(None)
            }
        }
    }

    /// Resumes, steps or pauses.
    fn control(&mut self, request: &Request) -> io::Result<()> {
        let command = request.command.as_str();
        let thread = request.arguments::<OfThread>();
        let checked = thread.and_then(|thread| check_thread(thread.thread_id));
        let checked = checked.and_then(|()| match (self.state, command) {
            (State::Running(_), "pause") | (State::Stopped, _) => Ok(()),
            (State::Configuring, _) => Err(format!("`{command}`: send `configurationDone` first")),
            _ => Err(format!(
                "`{command}`: the program is running; pause it first"
            )),
        });
        if let Err(why) = checked {
            return self.client.respond(request, Err(why));
        }
        let body = match command {
            "continue" => json!({ "allThreadsContinued": true }),
            _ => Value::Null,
        };
        self.client.respond(request, Ok(body))?;
        let stepped = Stopped {
            why: None,
            is_first: false,
        };
        if command != "pause" {
            self.error = None;
        }
        let stopped = match command {
            "continue" => {
                self.resume();
                return Ok(());
            }
            "pause" => {
                self.state = State::Stopped;
                return self.stopped("pause", json!({}));
            }
            "stepOut" => {
                self.run.step_out();
                stepped
            }
            "stepBack" => Stopped {
                is_first: !self.run.step_back(),
                ..stepped
            },
            "reverseContinue" => self.run.reverse(),
            _ => {
                self.run.step();
                stepped
            }
        };
        self.report()?;
        self.stop(stopped)
    }

    /// Answers a request that moves nothing.
    fn answer(&mut self, request: &Request) -> Result<Value, String> {
        match request.command.as_str() {
            "threads" => Ok(json!({ "threads": [{ "id": THREAD, "name": "scan" }] })),
            "stackTrace" => self.stack_trace(&request.arguments()?),
            "scopes" => Ok(json!({ "scopes": self.scopes.list() })),
            "variables" => {
                let Variables {
                    variables_reference,
                    start,
                    count,
                } = request.arguments()?;
                let range = (start.unwrap_or(0), count.unwrap_or(0));
                let plc = self.run.plc_mut();
                let variables = self.scopes.variables(plc, variables_reference, range)?;
                Ok(json!({ "variables": variables }))
            }
            "setVariable" => {
                let SetVariable {
                    variables_reference,
                    name,
                    value,
                } = request.arguments()?;
                self.scopes.check(variables_reference)?;
                variables::set(&mut self.run, &name, &value)
            }
            "setExpression" => {
                let SetExpression { expression, value } = request.arguments()?;
                variables::set(&mut self.run, &expression, &value)
            }
            "evaluate" => self.evaluate(&request.arguments()?),
            "source" => self.listing(),
            "setBreakpoints" => self.set_breakpoints(request.arguments()?),
            "breakpointLocations" => self.breakpoint_locations(&request.arguments()?),
            "setDataBreakpoints" => {
                let SetDataBreakpoints { breakpoints } = request.arguments()?;
                self.editor.breakpoints.set_on_devices(breakpoints)?;
                Ok(json!({ "breakpoints": self.apply().on_devices }))
            }
            "dataBreakpointInfo" => self.data_breakpoint_info(&request.arguments()?),
            "setExceptionBreakpoints" => {
                let SetExceptionBreakpoints { filters } = request.arguments()?;
                if let Some(unknown) = filters.iter().find(|filter| *filter != PLC_ERRORS) {
                    return Err(format!("there is no filter `{unknown}`"));
                }
                self.editor.breakpoints.errors = !filters.is_empty();
                self.apply();
                Ok(Value::Null)
            }
            "exceptionInfo" => self.exception_info(),
            "attach" | "launch" | "initialize" => Err("a program runs already".to_owned()),
            command => Err(format!("this debug adapter has no request `{command}`")),
        }
    }

    /// Finds the breakpoints of the editor in the program.
    fn apply(&self) -> Resolved {
        let resolved = self.run.set_breakpoints(&self.editor.breakpoints);
        if self.launch.no_debug {
            self.run.set_breakpoints(&Breakpoints::default());
        }
        resolved
    }

    fn stack_trace(&self, arguments: &StackTrace) -> Result<Value, String> {
        check_thread(arguments.thread_id)?;
        let erred = self.error.and_then(|(_, instr)| instr);
        let instr = erred.unwrap_or(self.run.instr());
        let places = &self.run.places;
        let line = self.shown_line(places.line(instr));
        let frame = |id: i64, name: String, hint: &str| {
            json!({
                "id": id,
                "name": name,
                "line": line,
                "column": i64::from(self.editor.lines_start_at1),
                "source": places.source(instr),
                "presentationHint": hint,
            })
        };
        let state = if self.run.is_inside() { "in" } else { "before" };
        let scan = format!(
            "{state} scan {} · {} ms",
            self.run.scans() + 1,
            self.run.now_ms()
        );
        let frames = [
            frame(1, places.title(instr), "normal"),
            frame(2, scan, "label"),
        ];
        let start = usize::try_from(arguments.start_frame.unwrap_or(0)).unwrap_or(0);
        let frames: Vec<_> = frames.into_iter().skip(start).collect();
        Ok(json!({ "stackFrames": frames, "totalFrames": 2 }))
    }

    fn evaluate(&mut self, arguments: &Evaluate) -> Result<Value, String> {
        let expression = &arguments.expression;
        let Answer {
            text,
            kind,
            has_changed,
        } = match arguments.context.as_deref() {
            Some("repl") => evaluate::command(&mut self.run, expression)?,
            _ => evaluate::look(&mut self.run, expression)?,
        };
        if has_changed && self.editor.takes_invalidated {
            // Output that cannot be written is found with the answer.
            let _ = self
                .client
                .event("invalidated", json!({ "areas": ["variables"] }));
        }
        let mut body = json!({ "result": text, "variablesReference": 0 });
        if let Some(kind) = kind {
            body["type"] = json!(kind);
        }
        Ok(body)
    }

    fn listing(&self) -> Result<Value, String> {
        let listing = self.run.places.listing();
        let listing = listing.ok_or("the program is a text, which the editor opens itself")?;
        Ok(json!({ "content": listing }))
    }

    fn set_breakpoints(&mut self, arguments: SetBreakpoints) -> Result<Value, String> {
        let source = source(&arguments.source)?;
        let mut wanted = arguments.breakpoints;
        for point in &mut wanted {
            point.line = self.read_line(point.line);
        }
        self.editor
            .breakpoints
            .set_at_lines(source.clone(), wanted)?;
        let mut states = self.apply().at_lines.remove(&source).unwrap_or_default();
        for state in &mut states {
            self.shift_line(state);
        }
        Ok(json!({ "breakpoints": states }))
    }

    fn breakpoint_locations(&self, arguments: &BreakpointLocations) -> Result<Value, String> {
        let first = self.read_line(arguments.line);
        let last = arguments
            .end_line
            .map_or(first, |line| self.read_line(line));
        let lines = self
            .run
            .places
            .lines(&source(&arguments.source)?, first, last)?;
        let lines = lines
            .into_iter()
            .map(|line| json!({ "line": self.shown_line(line) }));
        Ok(json!({ "breakpoints": lines.collect::<Vec<_>>() }))
    }

    fn data_breakpoint_info(&self, arguments: &DataBreakpointInfo) -> Result<Value, String> {
        let plc = self.run.plc();
        let name = device_in(plc, &arguments.name);
        Ok(match plc.get(name) {
            Ok(_) => json!({
                "dataId": name,
                "description": name,
                "accessTypes": ["write"],
                "canPersist": true,
            }),
            Err(error) => json!({ "dataId": null, "description": error.to_string() }),
        })
    }

    fn exception_info(&self) -> Result<Value, String> {
        let (code, instr) = self
            .error
            .ok_or("the program has not stopped at an error")?;
        let title = plc_errors::title(code, self.run.program().module().model.id);
        let place = instr
            .map(|instr| self.run.places.title(instr))
            .unwrap_or_default();
        Ok(json!({
            "exceptionId": code.to_string(),
            "description": format!("{title}: {place} (`rungc explain {code}` has more)"),
            "breakMode": "always",
        }))
    }

    /// A line of the editor, counted from 1.
    fn read_line(&self, line: i64) -> i64 {
        line.saturating_add(i64::from(!self.editor.lines_start_at1))
    }

    /// A line as the editor counts it.
    fn shown_line(&self, line: u32) -> i64 {
        i64::from(line) - i64::from(!self.editor.lines_start_at1)
    }

    /// Counts the line of a breakpoint as the editor does.
    fn shift_line(&self, state: &mut Value) {
        let line = state.get("line").and_then(Value::as_u64);
        if let Some(line) = line.and_then(|line| u32::try_from(line).ok()) {
            state["line"] = json!(self.shown_line(line));
        }
    }
}

fn check_thread(thread: i64) -> Result<(), String> {
    match thread {
        THREAD => Ok(()),
        other => Err(format!("there is no thread {other}")),
    }
}

/// The source that arguments name.
fn source(arguments: &SourceArguments) -> Result<Source, String> {
    match (arguments.source_reference, &arguments.path) {
        (Some(LISTING), _) => Ok(Source::Listing),
        (None | Some(0), Some(path)) => Ok(Source::File(PathBuf::from(path))),
        _ => Err("the source has neither a path nor a known reference".to_owned()),
    }
}
