//! A client that keeps a transcript.

use serde_json::{Value, json};
use std::fmt::Write as _;
use std::fs;
use std::io::{BufRead, BufReader, PipeReader, PipeWriter, Read, Write, pipe};
use std::path::PathBuf;
use std::thread::{self, JoinHandle};
use tempfile::TempDir;

/// A motor with a delay, and a division that fails while X002 is on.
pub const PROGRAM: &str = "\
;! X000 = Start
;! Y000 = Motor
LD X000
OR M0
ANI X001
OUT M0
LD M0
OUT T0 K5
OUT Y000
LD T0
OUT Y001
LD X002
DIV D0 D1 D2
LD M8000
INC D5
END
";

/// A client with an adapter and a program.
pub struct Client {
    folder: TempDir,
    input: Option<PipeWriter>,
    output: BufReader<PipeReader>,
    adapter: Option<JoinHandle<rungc_dap::Ended>>,
    seq: u64,
    /// What was sent and received, a line each.
    pub transcript: String,
}

impl Client {
    /// A client of an adapter that has received nothing.
    pub fn new() -> Client {
        let (server_input, input) = pipe().unwrap();
        let (output, server_output) = pipe().unwrap();
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("motor.il"), PROGRAM).unwrap();
        let serve = || rungc_dap::serve(server_input, server_output).unwrap();
        Client {
            folder,
            input: Some(input),
            output: BufReader::new(output),
            adapter: Some(thread::spawn(serve)),
            seq: 0,
            transcript: String::new(),
        }
    }

    /// A client whose program has been launched, before its configuration is done.
    pub fn launched(more: &Value) -> Client {
        let mut client = Client::new();
        client.request("initialize", json!({ "adapterID": "rungc" }));
        let mut arguments = json!({ "program": client.program(), "realTime": false });
        for (name, value) in more.as_object().unwrap() {
            arguments[name] = value.clone();
        }
        let launched = client.request("launch", arguments);
        assert_eq!(launched["success"], true, "{launched}");
        client.event("initialized");
        client.transcript.clear();
        client
    }

    /// The file of the program.
    pub fn program(&self) -> PathBuf {
        self.folder.path().join("motor.il")
    }

    /// Writes bytes.
    pub fn write(&mut self, bytes: &[u8]) {
        self.input.as_mut().unwrap().write_all(bytes).unwrap();
    }

    /// Sends a message.
    pub fn send(&mut self, message: &Value) {
        let text = message.to_string();
        self.write(format!("Content-Length: {}\r\n\r\n{text}", text.len()).as_bytes());
    }

    /// The next message; `None` at the end.
    pub fn receive(&mut self) -> Option<Value> {
        let mut length = 0;
        loop {
            let mut line = String::new();
            if self.output.read_line(&mut line).unwrap() == 0 {
                return None;
            }
            match line.trim().split_once(": ") {
                Some(("Content-Length", value)) => length = value.parse().unwrap(),
                _ => break,
            }
        }
        let mut body = vec![0; length];
        self.output.read_exact(&mut body).unwrap();
        let message: Value = serde_json::from_slice(&body).unwrap();
        let (kind, shown) = match message["type"].as_str().unwrap() {
            "event" => (
                format!("event {}", message["event"].as_str().unwrap()),
                &message["body"],
            ),
            _ if message["success"] == true => ("answer".to_owned(), &message["body"]),
            _ => ("error".to_owned(), &message["message"]),
        };
        let folder = self.folder.path().to_string_lossy().into_owned();
        let shown = shown.to_string().replace(&folder, "FOLDER");
        writeln!(self.transcript, "    {kind} {shown}").unwrap();
        Some(message)
    }

    /// The answer to a request; events before it are in the transcript.
    pub fn request(&mut self, command: &str, arguments: Value) -> Value {
        self.seq += 1;
        let folder = self.folder.path().to_string_lossy().into_owned();
        let shown = arguments.to_string().replace(&folder, "FOLDER");
        writeln!(self.transcript, "{command} {shown}").unwrap();
        let seq = self.seq;
        self.send(
            &json!({ "seq": seq, "type": "request", "command": command, "arguments": arguments }),
        );
        loop {
            let message = self.receive().expect("the adapter has ended");
            if message["request_seq"] == seq {
                return message;
            }
        }
    }

    /// The next event of a name.
    pub fn event(&mut self, name: &str) -> Value {
        loop {
            let message = self.receive().expect("the adapter has ended");
            if message["event"] == name {
                return message["body"].clone();
            }
        }
    }

    /// Sends a request of the thread, and waits until the program has stopped. The reason, and the first frame.
    pub fn go(&mut self, command: &str) -> (String, Value) {
        let answer = self.request(command, json!({ "threadId": 1 }));
        assert_eq!(answer["success"], true, "{answer}");
        let stopped = self.event("stopped");
        let reason = stopped["reason"].as_str().unwrap().to_owned();
        (reason, self.frame())
    }

    /// The first frame.
    pub fn frame(&mut self) -> Value {
        let trace = self.request("stackTrace", json!({ "threadId": 1 }));
        trace["body"]["stackFrames"][0].clone()
    }

    /// Value of an expression.
    pub fn value(&mut self, expression: &str) -> String {
        self.evaluate(expression, "watch")
    }

    /// Result of an expression, or its error.
    pub fn evaluate(&mut self, expression: &str, context: &str) -> String {
        let arguments = json!({ "expression": expression, "context": context });
        let answer = self.request("evaluate", arguments);
        let result = answer["body"]["result"].as_str();
        result.or(answer["message"].as_str()).unwrap().to_owned()
    }

    /// Sets the breakpoints of the program.
    pub fn break_at(&mut self, breakpoints: Value) -> Value {
        let path = self.program();
        let arguments = json!({ "source": { "path": path }, "breakpoints": breakpoints });
        self.request("setBreakpoints", arguments)["body"]["breakpoints"].clone()
    }

    /// Closes the input, and waits for the adapter.
    pub fn end(&mut self) -> rungc_dap::Ended {
        self.input = None;
        while self.receive().is_some() {}
        self.adapter.take().unwrap().join().unwrap()
    }
}
