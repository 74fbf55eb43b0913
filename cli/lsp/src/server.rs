//! The connection with an editor: its messages in their order, and checks in the pauses between them.

use crate::capabilities::{can_watch, capabilities, watch};
use crate::checks::{Checked, Job, PAUSE};
use crate::document::{Document, Kind};
use crate::lines::Encoding;
use crate::publish::Places;
use crate::uri;
use crate::view::View;
use crate::{actions, completion, decoration, format, hover, navigation, rename};
use crossbeam_channel::{Receiver, Sender, after, never, select, unbounded};
use gen_lsp_types::{
    CodeActionParams, CompletionRequest, DefinitionRequest, Diagnostic,
    DidChangeTextDocumentParams, DidCloseTextDocumentParams, DidOpenTextDocumentParams,
    DocumentFormattingRequest, DocumentHighlightRequest, DocumentSymbolRequest,
    FoldingRangeRequest, HoverRequest, Id, InitializeParams, InitializeResult, InlayHintRequest,
    MessageType, Notification as _, PrepareRenameRequest, PublishDiagnosticsNotification,
    PublishDiagnosticsParams, ReferencesRequest, RenameRequest, SemanticTokensRangeRequest,
    SemanticTokensRequest, ServerInfo, ShowMessageNotification, ShowMessageParams,
    SignatureHelpRequest, Uri,
};
use lsp_server::{Connection, ErrorCode, Message, Notification, Request, RequestId, Response};
use rungc::Unsaved;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::collections::{BTreeMap, VecDeque};
use std::path::Path;
use std::time::Instant;

/// End of a connection.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Ended {
    /// The editor has shut the server down.
    Exit,
    /// The connection ended without that.
    Abandoned,
}

/// Serves one editor until it ends the connection.
pub fn serve(connection: &Connection) -> Ended {
    let (sender, receiver) = unbounded();
    let mut server = Server {
        connection,
        phase: Phase::Starting,
        encoding: Encoding::default(),
        can_watch: false,
        documents: BTreeMap::new(),
        unsaved: Unsaved::default(),
        queue: VecDeque::new(),
        results: sender,
        checked: receiver,
        of_settings: BTreeMap::new(),
    };
    server.run()
}

/// Phases of a connection.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Phase {
    /// Before `initialize`.
    Starting,
    /// Until `shutdown`.
    Running,
    /// Until `exit`.
    ShutDown,
}

/// A refusal of a request.
pub(crate) type Refusal = (ErrorCode, String);

struct Server<'c> {
    connection: &'c Connection,
    phase: Phase,
    encoding: Encoding,
    /// True if the editor reports changes of files on request.
    can_watch: bool,
    /// By their addresses.
    documents: BTreeMap<String, Document>,
    unsaved: Unsaved,
    /// Messages that wait.
    queue: VecDeque<Message>,
    /// Results of checks.
    results: Sender<Checked>,
    checked: Receiver<Checked>,
    /// For each settings file with mistakes that a program's check found, the address of that program.
    of_settings: BTreeMap<String, String>,
}

impl Server<'_> {
    fn run(&mut self) -> Ended {
        loop {
            self.queue.extend(self.connection.receiver.try_iter());
            let Some(message) = self.queue.pop_front() else {
                if self.wait().is_none() {
                    return Ended::Abandoned;
                }
                continue;
            };
            match message {
                Message::Request(request) => {
                    let response = self.respond(request);
                    self.send(response);
                }
                Message::Notification(note) if note.method == "exit" => {
                    return match self.phase {
                        Phase::ShutDown => Ended::Exit,
                        Phase::Starting | Phase::Running => Ended::Abandoned,
                    };
                }
                Message::Notification(note) => self.take(note),
                // The server asks nothing.
                Message::Response(_) => {}
            }
        }
    }

    /// Waits for a message, the result of a check, or the time of the next one; `None` if the connection has ended.
    fn wait(&mut self) -> Option<()> {
        let due = self.documents.values().filter_map(|document| document.due);
        let next = match due.min() {
            Some(time) => after(time.saturating_duration_since(Instant::now())),
            None => never(),
        };
        select! {
            recv(self.connection.receiver) -> message => self.queue.push_back(message.ok()?),
            recv(self.checked) -> checked => {
                if let Ok(checked) = checked {
                    self.take_check(checked);
                }
            }
            recv(next) -> _ => self.start_checks(),
        }
        Some(())
    }

    fn send(&self, message: impl Into<Message>) {
        // A closed connection ends the loop where it is read.
        let _ = self.connection.sender.send(message.into());
    }

    fn respond(&mut self, request: Request) -> Response {
        let Request { id, method, params } = request;
        if self.is_cancelled(&id) {
            let code = ErrorCode::RequestCanceled as i32;
            return Response::new_err(id, code, "canceled".to_owned());
        }
        let answer = std::panic::AssertUnwindSafe(|| self.answer(&method, params));
        let answer = std::panic::catch_unwind(answer).unwrap_or_else(|_| {
            let why = "this is an error in rungc, please report it";
            Err((ErrorCode::InternalError, why.to_owned()))
        });
        match answer {
            Ok(result) => Response::new_ok(id, result),
            Err((code, why)) => Response::new_err(id, code as i32, why),
        }
    }

    /// Returns true if the editor has canceled a request that it sent before.
    fn is_cancelled(&self, id: &RequestId) -> bool {
        self.queue.iter().any(|message| {
            let Message::Notification(note) = message else {
                return false;
            };
            let params = || parsed::<gen_lsp_types::CancelParams>(note.params.clone());
            note.method == "$/cancelRequest"
                && params().is_ok_and(|params| match params.id {
                    Id::Int(number) => *id == RequestId::from(number),
                    Id::String(text) => *id == RequestId::from(text),
                })
        })
    }

    fn answer(&mut self, method: &str, params: Value) -> Result<Value, Refusal> {
        match (self.phase, method) {
            (Phase::Starting, "initialize") => self.initialize(params),
            (Phase::Starting, _) => {
                let why = "the first request is `initialize`";
                Err((ErrorCode::ServerNotInitialized, why.to_owned()))
            }
            (Phase::ShutDown, _) => Err((
                ErrorCode::InvalidRequest,
                "the server is shut down".to_owned(),
            )),
            (Phase::Running, "initialize") => {
                let why = "the server is initialized already";
                Err((ErrorCode::InvalidRequest, why.to_owned()))
            }
            (Phase::Running, "shutdown") => {
                self.phase = Phase::ShutDown;
                Ok(Value::Null)
            }
            (Phase::Running, "textDocument/codeAction") => self.actions(params),
            (Phase::Running, method) => self.feature(method, params),
        }
    }

    fn feature(&self, method: &str, params: Value) -> Result<Value, Refusal> {
        match method {
            "textDocument/hover" => self.about::<HoverRequest>(params, hover::hover),
            "textDocument/documentSymbol" => {
                self.about::<DocumentSymbolRequest>(params, navigation::symbols)
            }
            "textDocument/definition" => {
                self.about::<DefinitionRequest>(params, navigation::definition)
            }
            "textDocument/references" => {
                self.about::<ReferencesRequest>(params, navigation::references)
            }
            "textDocument/documentHighlight" => {
                self.about::<DocumentHighlightRequest>(params, navigation::highlights)
            }
            "textDocument/foldingRange" => {
                self.about::<FoldingRangeRequest>(params, navigation::folds)
            }
            "textDocument/completion" => {
                self.about::<CompletionRequest>(params, completion::completion)
            }
            "textDocument/signatureHelp" => {
                self.about::<SignatureHelpRequest>(params, completion::signature)
            }
            "textDocument/inlayHint" => self.about::<InlayHintRequest>(params, decoration::hints),
            "textDocument/semanticTokens/full" => {
                self.about::<SemanticTokensRequest>(params, decoration::tokens)
            }
            "textDocument/semanticTokens/range" => {
                self.about::<SemanticTokensRangeRequest>(params, decoration::tokens_in)
            }
            "textDocument/prepareRename" => {
                self.about_or::<PrepareRenameRequest>(params, rename::prepare)
            }
            "textDocument/rename" => self.about_or::<RenameRequest>(params, |view, params| {
                let (edit, notes) = rename::rename(view, params)?;
                notes.into_iter().for_each(|note| self.show(note));
                Ok(edit)
            }),
            "textDocument/formatting" => {
                self.about_or::<DocumentFormattingRequest>(params, format::format)
            }
            method => {
                let why = format!("there is no method `{method}`");
                Err((ErrorCode::MethodNotFound, why))
            }
        }
    }

    /// Answers a request about a text.
    fn about<R: gen_lsp_types::Request>(
        &self,
        params: Value,
        answer: impl FnOnce(&View, &R::Params) -> R::Result,
    ) -> Result<Value, Refusal> {
        self.about_or::<R>(params, |view, params| Ok(answer(view, params)))
    }

    /// The same, where the answer may be a refusal.
    fn about_or<R: gen_lsp_types::Request>(
        &self,
        params: Value,
        answer: impl FnOnce(&View, &R::Params) -> Result<R::Result, Refusal>,
    ) -> Result<Value, Refusal> {
        let uri = params["textDocument"]["uri"]
            .as_str()
            .unwrap_or_default()
            .to_owned();
        let params: R::Params = parsed(params)?;
        let document = self
            .documents
            .get(&uri)
            .ok_or_else(|| unopened(&Uri(uri)))?;
        let view = View {
            document,
            index: document.index(&self.unsaved),
        };
        result(&answer(&view, &params)?)
    }

    /// Shows a message to the user.
    fn show(&self, message: String) {
        let params = ShowMessageParams {
            kind: MessageType::Warning,
            message,
        };
        let method = String::from(ShowMessageNotification::METHOD);
        self.send(Notification::new(method, params));
    }

    /// Answers with the fixes of what is there now, which is checked first if it has changed.
    fn actions(&mut self, params: Value) -> Result<Value, Refusal> {
        let params: CodeActionParams = parsed(params)?;
        let document = self.documents.get_mut(&params.text_document.uri.0);
        let document = document.ok_or_else(|| unopened(&params.text_document.uri))?;
        if document.findings().is_none() {
            let checked = Job::of(document, &self.unsaved).run();
            document.checked = Some((checked.revision, checked.findings.into()));
        }
        let findings = document.findings().map(|found| &found[..]);
        let places = Places {
            uri: &document.uri,
            text: &document.now,
            project: None,
        };
        result(&actions::actions(
            &places,
            findings.unwrap_or_default(),
            &params,
        ))
    }

    fn initialize(&mut self, params: Value) -> Result<Value, Refusal> {
        let params: InitializeParams = parsed(params)?;
        self.encoding = Encoding::negotiated(params.capabilities.general.as_ref());
        self.can_watch = can_watch(&params.capabilities);
        self.phase = Phase::Running;
        result(&InitializeResult {
            capabilities: capabilities(self.encoding),
            server_info: Some(ServerInfo {
                name: "rungc".to_owned(),
                version: Some(env!("CARGO_PKG_VERSION").to_owned()),
            }),
        })
    }

    /// Takes a notification. One that cannot be read is left out, as the protocol has no answer to it.
    fn take(&mut self, note: Notification) {
        if self.phase != Phase::Running {
            return;
        }
        let Notification { method, params } = note;
        match method.as_str() {
            "initialized" if self.can_watch => self.send(watch()),
            "textDocument/didOpen" => {
                if let Ok(params) = parsed(params) {
                    self.open(params);
                }
            }
            "textDocument/didChange" => {
                if let Ok(params) = parsed(params) {
                    self.change(params);
                }
            }
            "textDocument/didClose" => {
                if let Ok(params) = parsed(params) {
                    self.close(params);
                }
            }
            // Programs depend on files beside them.
            "textDocument/didSave" | "workspace/didChangeWatchedFiles" => self.changed(None),
            _ => {}
        }
    }

    fn open(&mut self, params: DidOpenTextDocumentParams) {
        let document = Document::new(params.text_document, self.encoding);
        let uri = document.uri.0.clone();
        self.documents.insert(uri.clone(), document);
        self.updated(&uri);
        // At once.
        self.start_checks_before(Instant::now() + PAUSE);
    }

    fn change(&mut self, params: DidChangeTextDocumentParams) {
        let uri = params.text_document.text_document_identifier.uri.0;
        let encoding = self.encoding;
        let Some(document) = self.documents.get_mut(&uri) else {
            return;
        };
        document.change(
            params.text_document.version,
            params.content_changes,
            encoding,
        );
        self.updated(&uri);
    }

    fn close(&mut self, params: DidCloseTextDocumentParams) {
        let uri = params.text_document.uri;
        if let Some(document) = self.documents.remove(&uri.0) {
            self.unsaved.remove(&document.path);
            self.publish(uri, None, Vec::new());
            self.changed(None);
        }
    }

    /// Notes that a text is another one.
    fn updated(&mut self, uri: &str) {
        let Some(document) = self.documents.get(uri) else {
            return;
        };
        self.unsaved
            .insert(&document.path, document.now.text.clone());
        let is_alone =
            document.kind == Kind::Test || document.path.extension().is_some_and(|e| e == "il");
        self.changed(is_alone.then_some(uri));
    }

    /// Has a text checked, or all: settings, and comments beside an export, concern others.
    fn changed(&mut self, only: Option<&str>) {
        let due = Some(Instant::now() + PAUSE);
        for (uri, document) in &mut self.documents {
            if only.is_none_or(|only| only == uri) {
                document.invalidate();
                document.due = due;
            }
        }
    }

    fn start_checks(&mut self) {
        self.start_checks_before(Instant::now());
    }

    /// Starts the checks that are due at a time, one of each text.
    fn start_checks_before(&mut self, time: Instant) {
        for document in self.documents.values_mut() {
            if document.due.is_some_and(|due| due <= time) {
                document.due = None;
                if document.in_check.is_none() {
                    document.in_check = Some(document.revision);
                    Job::of(document, &self.unsaved).start(self.results.clone());
                }
            }
        }
    }

    /// Takes the result of a check. That of an earlier text is left out, and the check repeated.
    fn take_check(&mut self, checked: Checked) {
        let Some(document) = self.documents.get_mut(&checked.uri.0) else {
            return;
        };
        document.in_check = None;
        if document.revision != checked.revision {
            document.due.get_or_insert_with(Instant::now);
            return;
        }
        let places = Places {
            uri: &checked.uri,
            text: &checked.text,
            project: checked.project.as_ref(),
        };
        let findings = checked
            .findings
            .iter()
            .map(|finding| places.diagnostic(finding));
        let findings = findings.collect();
        document.checked = Some((checked.revision, checked.findings.into()));
        self.publish(checked.uri.clone(), Some(checked.version), findings);
        self.publish_mistakes(&checked.uri, &checked.mistakes);
    }

    /// Publishes mistakes in settings that are not open, and removes them when they are corrected. Open settings are
    /// checked separately.
    fn publish_mistakes(&mut self, program: &Uri, mistakes: &[rungc::Diagnostic]) {
        let file = mistakes
            .first()
            .map(|mistake| Path::new(&mistake.file).to_owned());
        let found = file.as_deref().map(uri::of);
        let cleared: Vec<String> = self
            .of_settings
            .iter()
            .filter(|(settings, of)| {
                **of == program.0 && found.as_ref().is_none_or(|found| found.0 != **settings)
            })
            .map(|(settings, _)| settings.clone())
            .collect();
        for settings in cleared {
            self.of_settings.remove(&settings);
            if !self.documents.contains_key(&settings) {
                self.publish(Uri(settings), None, Vec::new());
            }
        }
        if let (Some(found), Some(file)) = (found, file)
            && !self.documents.contains_key(&found.0)
        {
            let text = std::fs::read_to_string(file).unwrap_or_default();
            let text = crate::document::Text::new(text, self.encoding);
            let places = Places {
                uri: &found,
                text: &text,
                project: None,
            };
            let shown = mistakes.iter().map(|mistake| places.diagnostic(mistake));
            let shown = shown.collect();
            self.publish(found.clone(), None, shown);
            self.of_settings.insert(found.0, program.0.clone());
        }
    }

    fn publish(&self, uri: Uri, version: Option<i32>, diagnostics: Vec<Diagnostic>) {
        let params = PublishDiagnosticsParams {
            uri,
            version,
            diagnostics,
        };
        let method = String::from(PublishDiagnosticsNotification::METHOD);
        self.send(Notification::new(method, params));
    }
}

/// That a request is about a text that is not open.
fn unopened(uri: &Uri) -> Refusal {
    (ErrorCode::InvalidParams, format!("`{}` is not open", uri.0))
}

/// Parameters of a message.
fn parsed<T: DeserializeOwned>(params: Value) -> Result<T, Refusal> {
    let params = serde_json::from_value(params);
    params.map_err(|error| (ErrorCode::InvalidParams, error.to_string()))
}

/// The result of a request.
fn result(result: &impl serde::Serialize) -> Result<Value, Refusal> {
    let result = serde_json::to_value(result);
    result.map_err(|error| (ErrorCode::InternalError, error.to_string()))
}
