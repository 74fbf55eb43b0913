//! An editor.

use lsp_server::{Connection, Message, Notification, Request, Response};
use rungc_lsp::Ended;
use serde_json::{Value, json};
use std::path::PathBuf;
use std::thread::JoinHandle;
use std::time::Duration;
use tempfile::TempDir;

/// An editor with a folder of files.
pub struct Client {
    connection: Option<Connection>,
    server: Option<JoinHandle<Ended>>,
    folder: TempDir,
    next: i32,
    version: i32,
    /// Notifications that no one has waited for yet.
    pub notes: Vec<Notification>,
}

impl Client {
    /// An editor that has initialized the server, with these files.
    pub fn new(files: &[(&str, &[u8])]) -> Client {
        let mut client = Client::silent(files);
        let general = json!({ "general": { "positionEncodings": ["utf-16"] } });
        client.ask("initialize", json!({ "capabilities": general }));
        client.note("initialized", json!({}));
        client
    }

    /// One that has sent nothing.
    pub fn silent(files: &[(&str, &[u8])]) -> Client {
        let folder = tempfile::tempdir().unwrap();
        for (name, content) in files {
            std::fs::write(folder.path().join(name), content).unwrap();
        }
        let (client, server) = Connection::memory();
        Client {
            connection: Some(client),
            server: Some(std::thread::spawn(move || rungc_lsp::serve(&server))),
            folder,
            next: 0,
            version: 1,
            notes: Vec::new(),
        }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Address of a file in the folder.
    pub fn uri(&self, name: &str) -> String {
        format!("file://{}/{name}", self.folder.path().display())
    }

    pub fn document(&self, name: &str) -> Value {
        json!({ "uri": self.uri(name) })
    }

    fn connection(&self) -> &Connection {
        self.connection.as_ref().unwrap()
    }

    pub fn note(&self, method: &str, params: Value) {
        let note = Notification::new(method.to_owned(), params);
        self.connection().sender.send(note.into()).unwrap();
    }

    /// Sends a request without waiting, and returns its number.
    pub fn send(&mut self, method: &str, params: Value) -> i32 {
        self.next += 1;
        let request = Request::new(self.next.into(), method.to_owned(), params);
        self.connection().sender.send(request.into()).unwrap();
        self.next
    }

    /// The next request of the server.
    pub fn request(&mut self) -> Request {
        loop {
            match self.receive() {
                Message::Request(request) => return request,
                Message::Notification(note) => self.notes.push(note),
                other => panic!("{other:?}"),
            }
        }
    }

    fn receive(&self) -> Message {
        let patience = Duration::from_secs(60);
        self.connection().receiver.recv_timeout(patience).unwrap()
    }

    /// The response to a request that was sent.
    pub fn response(&mut self, id: i32) -> Response {
        loop {
            match self.receive() {
                Message::Response(response) if response.id == id.into() => return response,
                Message::Notification(note) => self.notes.push(note),
                other => panic!("{other:?}"),
            }
        }
    }

    /// The result of a request, or its error.
    pub fn try_ask(&mut self, method: &str, params: Value) -> Result<Value, (i32, String)> {
        let id = self.send(method, params);
        let answer = self.response(id).response_result;
        answer.map_err(|error| (error.code, error.message))
    }

    pub fn ask(&mut self, method: &str, params: Value) -> Value {
        self.try_ask(method, params).unwrap()
    }

    pub fn open(&mut self, name: &str, text: &str) {
        let uri = self.uri(name);
        let item = json!({ "uri": uri, "languageId": "il", "version": self.version, "text": text });
        self.note("textDocument/didOpen", json!({ "textDocument": item }));
    }

    /// Replaces a piece of a text, or all of it.
    pub fn change(&mut self, name: &str, range: Option<[u32; 4]>, text: &str) {
        self.version += 1;
        let change = match range {
            Some(range) => json!({ "range": self::range(range), "text": text }),
            None => json!({ "text": text }),
        };
        let document = json!({ "uri": self.uri(name), "version": self.version });
        let params = json!({ "textDocument": document, "contentChanges": [change] });
        self.note("textDocument/didChange", params);
    }

    /// The next diagnostics of a file.
    pub fn diagnostics(&mut self, name: &str) -> Value {
        let uri = self.uri(name);
        let is_of = |note: &Notification| {
            note.method == "textDocument/publishDiagnostics" && note.params["uri"] == uri
        };
        if let Some(at) = self.notes.iter().position(is_of) {
            return self.notes.remove(at).params;
        }
        loop {
            match self.receive() {
                Message::Notification(note) if is_of(&note) => return note.params,
                Message::Notification(note) => self.notes.push(note),
                other => panic!("{other:?}"),
            }
        }
    }

    /// The next diagnostics of a file, a line each.
    pub fn findings(&mut self, name: &str) -> String {
        let found = self.diagnostics(name);
        let lines = found["diagnostics"]
            .as_array()
            .unwrap()
            .iter()
            .map(|found| {
                let message = found["message"].as_str().unwrap().replace('\n', "\n    ");
                let related = found["relatedInformation"].as_array().into_iter().flatten();
                let related = related.map(|other| {
                    let place = place(&other["location"]["range"]);
                    format!("    {place}: {}\n", other["message"].as_str().unwrap())
                });
                let (place, code) = (place(&found["range"]), found["code"].as_str().unwrap());
                let related: String = related.collect();
                format!("{place} {} {code}: {message}\n{related}", found["severity"])
            });
        let lines: String = lines.collect();
        lines.replace(self.folder.path().to_str().unwrap(), "FOLDER")
    }

    /// An answer as text, with the folder as `FOLDER`.
    pub fn shown(&self, answer: &Value) -> String {
        let text = serde_json::to_string_pretty(answer).unwrap();
        text.replace(&self.uri(""), "FOLDER/")
    }

    /// Shuts the server down.
    pub fn end(mut self) -> Ended {
        self.ask("shutdown", Value::Null);
        self.note("exit", Value::Null);
        self.server.take().unwrap().join().unwrap()
    }

    /// Closes the connection.
    pub fn abandon(mut self) -> Ended {
        self.connection = None;
        self.server.take().unwrap().join().unwrap()
    }
}

/// `2:0-2:4`
pub fn place(range: &Value) -> String {
    let at = |end: &str| format!("{}:{}", range[end]["line"], range[end]["character"]);
    format!("{}-{}", at("start"), at("end"))
}

pub fn position(line: u32, character: u32) -> Value {
    json!({ "line": line, "character": character })
}

pub fn range([line, character, end_line, end_character]: [u32; 4]) -> Value {
    json!({ "start": position(line, character), "end": position(end_line, end_character) })
}
