//! The server of a page: a token in its address, a connection a request, a stream of events for each page that is open.
//!
//! The address is one of this machine alone. A page of another origin cannot use it: the name that the browser was
//! given (`Host`) must be this address, which defeats names that are made to lead here (DNS rebinding); a request from
//! a page must come from this one (`Origin`); and without the token, nothing is answered but a rejection. A client that
//! connects and sends no request gives way to others.

use crate::asset;
use crate::command::Command;
use crate::frame::Frame;
use crate::http::{PATIENCE, Rejection, Request, begin_events, respond};
use std::collections::VecDeque;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::{self, Read, Write};
use std::net::{Shutdown, SocketAddr, TcpListener, TcpStream};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, SyncSender, channel, sync_channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// Maximum number of simultaneous connections.
const CONNECTIONS: usize = 32;
/// Interval of comments to a page if nothing has changed, by which a lost connection is detected.
const HEARTBEAT: Duration = Duration::from_secs(5);
/// Time for which a rejected client is read.
const LINGER: Duration = Duration::from_millis(500);
/// Time-out of a command.
const ANSWER: Duration = Duration::from_secs(10);

/// The modules and the style of the page: what they are called, their types, and their texts.
const ASSETS: [(&str, &str, &str); 6] = [
    ("live.css", "text/css", asset!("live.css")),
    ("ladder.css", "text/css", rungc_ladder::html::STYLE),
    ("live.js", "text/javascript", asset!("live.js")),
    ("ladder.js", "text/javascript", asset!("ladder.js")),
    ("panels.js", "text/javascript", asset!("panels.js")),
    ("controls.js", "text/javascript", asset!("controls.js")),
];

/// A command, and where its answer goes.
pub struct Order {
    /// The command.
    pub command: Command,
    answer: SyncSender<Result<(), String>>,
}

impl Order {
    /// Answers: it is carried out, or why it cannot be.
    pub fn answer(self, answer: Result<(), String>) {
        // A page that has gone does not wait for it.
        let _ = self.answer.send(answer);
    }
}

/// State shared by the connections.
struct Shared {
    address: SocketAddr,
    token: String,
    html: String,
    /// A number that distinguishes this page from that of another program.
    page: u64,
    read_only: bool,
    frame: Mutex<(u64, Arc<Frame>)>,
    changed: Condvar,
    /// Numbers of open connections, and of streams of events among them.
    open: AtomicUsize,
    watching: AtomicUsize,
    /// Connections whose requests have not come yet, the oldest first, by the client's address.
    silent: Mutex<VecDeque<(SocketAddr, TcpStream)>>,
}

/// The server of a page.
pub struct Server {
    shared: Arc<Shared>,
    orders: Receiver<Order>,
}

impl Server {
    /// Serves this page at an address of this machine alone, under a path that begins with a secret token. A page that
    /// is only read takes no commands.
    ///
    /// # Errors
    /// An address that others can reach or that cannot be had.
    pub fn open(
        address: SocketAddr,
        token: String,
        html: String,
        read_only: bool,
    ) -> io::Result<Server> {
        if !address.ip().is_loopback() {
            let why = "the page is served to this machine alone: use a port or an address such as 127.0.0.1:8080";
            return Err(io::Error::new(io::ErrorKind::InvalidInput, why));
        }
        let listener = TcpListener::bind(address)?;
        let mut hasher = DefaultHasher::new();
        html.hash(&mut hasher);
        let shared = Arc::new(Shared {
            address: listener.local_addr()?,
            token,
            html,
            page: hasher.finish(),
            read_only,
            frame: Mutex::default(),
            changed: Condvar::new(),
            open: AtomicUsize::new(0),
            watching: AtomicUsize::new(0),
            silent: Mutex::default(),
        });
        let (sender, orders) = channel();
        let accepting = Arc::clone(&shared);
        thread::Builder::new()
            .name("page".to_string())
            .spawn(move || accept(&listener, &accepting, &sender))?;
        Ok(Server { shared, orders })
    }

    /// The address to open in a browser.
    pub fn url(&self) -> String {
        let Shared { address, token, .. } = &*self.shared;
        format!("http://{address}/{token}/")
    }

    /// Returns true if a page is open.
    pub fn is_watched(&self) -> bool {
        self.shared.watching.load(Ordering::Relaxed) > 0
    }

    /// Shows a frame on all pages.
    pub fn show(&self, frame: Frame) {
        let mut shown = self.shared.frame();
        *shown = (shown.0 + 1, Arc::new(frame));
        self.shared.changed.notify_all();
    }

    /// The next command, if one comes within this time.
    pub fn order(&self, within: Duration) -> Option<Order> {
        match self.orders.recv_timeout(within) {
            Ok(order) => Some(order),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => {
                thread::sleep(within);
                None
            }
        }
    }
}

fn accept(listener: &TcpListener, shared: &Arc<Shared>, orders: &Sender<Order>) {
    for stream in listener.incoming() {
        let Ok(mut stream) = stream else {
            // Too many files are open, for example.
            thread::sleep(Duration::from_millis(50));
            continue;
        };
        let _ = stream.set_write_timeout(Some(PATIENCE));
        let _ = stream.set_nodelay(true);
        if shared.open.load(Ordering::Relaxed) >= CONNECTIONS && !shared.close_silent() {
            Rejection::Busy.send(&mut stream);
            continue;
        }
        shared.is_silent(&stream);
        shared.open.fetch_add(1, Ordering::Relaxed);
        let (of_thread, orders) = (Arc::clone(shared), orders.clone());
        let begun = thread::Builder::new()
            .name("page connection".to_string())
            .spawn(move || {
                if let Err(rejection) = of_thread.serve(&mut stream, &orders) {
                    rejection.send(&mut stream);
                    linger(&mut stream);
                }
                of_thread.open.fetch_sub(1, Ordering::Relaxed);
            });
        if begun.is_err() {
            shared.open.fetch_sub(1, Ordering::Relaxed);
        }
    }
}

/// Takes what a client still sends for a moment: closed at once, the connection would be reset, and the rejection lost.
fn linger(stream: &mut TcpStream) {
    let until = Instant::now() + LINGER;
    let mut rest = [0; 4096];
    let _ = stream.shutdown(Shutdown::Write);
    let _ = stream.set_read_timeout(Some(LINGER));
    while Instant::now() < until && stream.read(&mut rest).is_ok_and(|count| count > 0) {}
}

impl Shared {
    fn silent(&self) -> MutexGuard<'_, VecDeque<(SocketAddr, TcpStream)>> {
        self.silent.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Notes a connection whose request is still to come.
    fn is_silent(&self, stream: &TcpStream) {
        if let (Ok(peer), Ok(stream)) = (stream.peer_addr(), stream.try_clone()) {
            self.silent().push_back((peer, stream));
        }
    }

    /// Notes that the request of a connection has come, or that it has ended.
    fn is_not_silent(&self, stream: &TcpStream) {
        if let Ok(peer) = stream.peer_addr() {
            self.silent().retain(|(other, _)| *other != peer);
        }
    }

    /// Closes the connection that has been silent longest; false if none is.
    fn close_silent(&self) -> bool {
        let Some((_, stream)) = self.silent().pop_front() else {
            return false;
        };
        let _ = stream.shutdown(Shutdown::Both);
        true
    }

    fn frame(&self) -> MutexGuard<'_, (u64, Arc<Frame>)> {
        self.frame.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Answers the request of a connection.
    fn serve(&self, stream: &mut TcpStream, orders: &Sender<Order>) -> Result<(), Rejection> {
        let request = Request::read(stream);
        self.is_not_silent(stream);
        let request = request?;
        let name = self.admit(&request)?;
        match (&*request.method, name) {
            ("GET", "") => self.send(stream, "text/html", &self.html),
            ("GET", "events") => self.events(stream),
            ("POST", "command") if self.read_only => Err(Rejection::Forbidden),
            ("POST", "command") => self.command(stream, &request, orders),
            ("GET", name) => {
                let found = ASSETS.iter().find(|asset| asset.0 == name);
                let (_, kind, text) = found.ok_or(Rejection::NotFound)?;
                self.send(stream, kind, text)
            }
            _ => Err(Rejection::MethodNotAllowed),
        }
    }

    /// Path of a request after the token; a rejection if it is not permitted.
    fn admit<'r>(&self, request: &'r Request) -> Result<&'r str, Rejection> {
        // As browsers write it: no sign, no leading zeros.
        let port = self.address.port().to_string();
        let named = |host: &str| {
            let (name, given) = host.rsplit_once(':').unwrap_or((host, "80"));
            let name = name.to_ascii_lowercase();
            ["127.0.0.1", "localhost", "[::1]"].contains(&&*name) && given == port
        };
        let host = request.host.as_deref().filter(|host| named(host));
        let host = host.ok_or(Rejection::Forbidden)?;
        if let Some(origin) = &request.origin
            && origin.strip_prefix("http://") != Some(host)
        {
            return Err(Rejection::Forbidden);
        }
        let path = request.path.strip_prefix('/');
        let (token, name) = path
            .and_then(|path| path.split_once('/'))
            .unwrap_or(("", ""));
        match equal(token.as_bytes(), self.token.as_bytes()) {
            true => Ok(name),
            false => Err(Rejection::Forbidden),
        }
    }

    /// Sends a text. A client that does not take it is not waited for.
    fn send(&self, stream: &mut TcpStream, kind: &str, text: &str) -> Result<(), Rejection> {
        let _ = respond(
            stream,
            "200 OK",
            &format!("{kind}; charset=utf-8"),
            text.as_bytes(),
        );
        Ok(())
    }

    /// Sends what changes, until the client has gone.
    fn events(&self, stream: &mut TcpStream) -> Result<(), Rejection> {
        self.watching.fetch_add(1, Ordering::Relaxed);
        // It has gone: that is how streams end.
        let _ = self.stream(stream);
        self.watching.fetch_sub(1, Ordering::Relaxed);
        Ok(())
    }

    fn stream(&self, stream: &mut TcpStream) -> io::Result<()> {
        begin_events(stream)?;
        write!(stream, "event: page\ndata: {:016x}\n\n", self.page)?;
        // A frame from before anyone watched is outdated.
        let mut number = self.frame().0;
        let mut last: Option<Arc<Frame>> = None;
        loop {
            let waited = self
                .changed
                .wait_timeout_while(self.frame(), HEARTBEAT, |shown| shown.0 == number);
            let (shown, waited) = waited.unwrap_or_else(PoisonError::into_inner);
            let frame = Arc::clone(&shown.1);
            number = shown.0;
            drop(shown);
            if waited.timed_out() {
                stream.write_all(b":\n\n")?;
                continue;
            }
            let news = frame.since(last.as_deref());
            stream.write_all(format!("data: {news}\n\n").as_bytes())?;
            last = Some(frame);
        }
    }

    /// Hands a command to the run, and sends its answer.
    fn command(
        &self,
        stream: &mut TcpStream,
        request: &Request,
        orders: &Sender<Order>,
    ) -> Result<(), Rejection> {
        // No form of another page can send this type.
        let kind = request.content_type.as_deref().unwrap_or("");
        let kind = kind.split(';').next().unwrap_or_default().trim();
        if !kind.eq_ignore_ascii_case("application/json") {
            return Err(Rejection::UnsupportedType);
        }
        let answer = Command::read(&request.body).and_then(|command| {
            let (answer, answered) = sync_channel(1);
            let gone = |_| "the run has ended".to_string();
            orders
                .send(Order { command, answer })
                .map_err(|_| gone(()))?;
            answered.recv_timeout(ANSWER).map_err(|_| gone(()))?
        });
        let (status, body) = match answer {
            Ok(()) => ("200 OK", "{}".to_string()),
            Err(error) => (
                "422 Unprocessable Content",
                serde_json::json!({ "error": error }).to_string(),
            ),
        };
        let _ = respond(stream, status, "application/json", body.as_bytes());
        Ok(())
    }
}

/// Returns true if two texts are equal, in a time that does not depend on where they differ.
fn equal(a: &[u8], b: &[u8]) -> bool {
    let differences = a.iter().zip(b).fold(0, |all, (a, b)| all | (a ^ b));
    a.len() == b.len() && differences == 0
}
