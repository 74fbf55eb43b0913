//! Requests and responses of HTTP/1.1, one a connection. A request is small, and has a few seconds to arrive.

use std::io::{self, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

/// Time-out of receiving a request, and of sending a response.
pub(crate) const PATIENCE: Duration = Duration::from_secs(10);
/// Maximum length of a request's head and body, in bytes.
const HEAD: usize = 8 * 1024;
const BODY: usize = 4 * 1024;
/// Maximum number of headers of a request.
const HEADERS: usize = 64;

/// Headers of every response: nothing from elsewhere is loaded, and no other page may load or frame it.
const PROTECTION: &str = "Content-Security-Policy: default-src 'none'; script-src 'self'; style-src 'self'; \
     connect-src 'self'; img-src data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'\r\n\
     X-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\nCross-Origin-Resource-Policy: same-origin\r\n\
     Cache-Control: no-store\r\nConnection: close\r\n";

/// Reason to reject a request, by the status of the response.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Rejection {
    BadRequest,
    Forbidden,
    NotFound,
    MethodNotAllowed,
    Timeout,
    TooLarge,
    UnsupportedType,
    HeadTooLarge,
    Busy,
}

impl Rejection {
    /// The status, and what to say of it.
    fn text(self) -> (&'static str, &'static str) {
        match self {
            Rejection::BadRequest => ("400 Bad Request", "This is not a request of HTTP/1.1."),
            Rejection::Forbidden => (
                "403 Forbidden",
                "Open the address that rungc has printed, with its token.",
            ),
            Rejection::NotFound => ("404 Not Found", "There is no such page."),
            Rejection::MethodNotAllowed => (
                "405 Method Not Allowed",
                "This method is not for this path.",
            ),
            Rejection::Timeout => ("408 Request Timeout", "The request took too long."),
            Rejection::TooLarge => ("413 Content Too Large", "The request is too long."),
            Rejection::UnsupportedType => ("415 Unsupported Media Type", "Send JSON."),
            Rejection::HeadTooLarge => (
                "431 Request Header Fields Too Large",
                "The request has too many headers, or too long ones.",
            ),
            Rejection::Busy => ("503 Service Unavailable", "Too many connections are open."),
        }
    }

    /// Sends it. A client that does not take it is not waited for.
    pub(crate) fn send(self, stream: &mut TcpStream) {
        let (status, text) = self.text();
        let _ = respond(stream, status, "text/plain; charset=utf-8", text.as_bytes());
    }
}

/// A request.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) struct Request {
    pub(crate) method: String,
    pub(crate) path: String,
    pub(crate) host: Option<String>,
    pub(crate) origin: Option<String>,
    pub(crate) content_type: Option<String>,
    pub(crate) body: Vec<u8>,
}

impl Request {
    /// Reads a request.
    pub(crate) fn read(stream: &mut TcpStream) -> Result<Request, Rejection> {
        let mut reader = Reader {
            stream,
            until: Instant::now() + PATIENCE,
            bytes: Vec::with_capacity(1024),
        };
        loop {
            if let Some((mut request, head, length)) = parse(&reader.bytes)? {
                while reader.bytes.len() < head + length {
                    reader.more()?;
                }
                request.body = reader.bytes[head..head + length].to_vec();
                return Ok(request);
            }
            if reader.bytes.len() > HEAD {
                return Err(Rejection::HeadTooLarge);
            }
            reader.more()?;
        }
    }
}

/// Received part of a request.
struct Reader<'a> {
    stream: &'a mut TcpStream,
    until: Instant,
    bytes: Vec<u8>,
}

impl Reader<'_> {
    /// Waits for more, at most until the request has had its time.
    fn more(&mut self) -> Result<(), Rejection> {
        let left = self.until.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(Rejection::Timeout);
        }
        let mut chunk = [0; 1024];
        let limited = self.stream.set_read_timeout(Some(left));
        match limited.and_then(|()| self.stream.read(&mut chunk)) {
            Ok(0) => Err(Rejection::BadRequest),
            Ok(count) => {
                self.bytes.extend_from_slice(&chunk[..count]);
                Ok(())
            }
            Err(error) if error.kind() == ErrorKind::Interrupted => Ok(()),
            Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {
                Err(Rejection::Timeout)
            }
            Err(_) => Err(Rejection::BadRequest),
        }
    }
}

/// The request that these bytes begin with, the length of its head, and that of its body; `None` if more must come.
fn parse(bytes: &[u8]) -> Result<Option<(Request, usize, usize)>, Rejection> {
    let mut headers = [httparse::EMPTY_HEADER; HEADERS];
    let mut parsed = httparse::Request::new(&mut headers);
    let head = match parsed.parse(bytes) {
        Ok(httparse::Status::Complete(head)) => head,
        Ok(httparse::Status::Partial) => return Ok(None),
        Err(httparse::Error::TooManyHeaders) => return Err(Rejection::HeadTooLarge),
        Err(_) => return Err(Rejection::BadRequest),
    };
    if head > HEAD {
        return Err(Rejection::HeadTooLarge);
    }
    let header = |name: &str| {
        let mut named = parsed
            .headers
            .iter()
            .filter(|header| header.name.eq_ignore_ascii_case(name));
        let value = match named.next() {
            Some(header) => str::from_utf8(header.value).map_err(|_| Rejection::BadRequest)?,
            None => return Ok(None),
        };
        // Of what decides who may ask, there is one.
        match named.next() {
            Some(_) => Err(Rejection::BadRequest),
            None => Ok(Some(value.to_string())),
        }
    };
    if header("transfer-encoding")?.is_some() {
        return Err(Rejection::BadRequest);
    }
    let length = match header("content-length")? {
        None => 0,
        // `parse` alone takes a sign.
        Some(digits) if digits.bytes().all(|byte| byte.is_ascii_digit()) => {
            digits.parse().map_err(|_| Rejection::BadRequest)?
        }
        Some(_) => return Err(Rejection::BadRequest),
    };
    if length > BODY {
        return Err(Rejection::TooLarge);
    }
    let request = Request {
        method: parsed.method.unwrap_or("").to_string(),
        path: parsed.path.unwrap_or("").to_string(),
        host: header("host")?,
        origin: header("origin")?,
        content_type: header("content-type")?,
        body: Vec::new(),
    };
    Ok(Some((request, head, length)))
}

/// Sends a whole response.
pub(crate) fn respond(
    stream: &mut TcpStream,
    status: &str,
    kind: &str,
    body: &[u8],
) -> io::Result<()> {
    let length = body.len();
    let mut bytes = format!(
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {length}\r\n{PROTECTION}\r\n"
    )
    .into_bytes();
    bytes.extend_from_slice(body);
    stream.write_all(&bytes)
}

/// Begins a stream of events.
pub(crate) fn begin_events(stream: &mut TcpStream) -> io::Result<()> {
    let head = format!("HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\n{PROTECTION}\r\n");
    stream.write_all(head.as_bytes())
}

#[cfg(test)]
mod tests {
    use super::{BODY, HEAD, Rejection, parse};

    fn rejected(text: &str) -> Option<Rejection> {
        parse(text.as_bytes()).err()
    }

    #[test]
    fn requests_are_parsed() {
        let text = b"POST /a HTTP/1.1\r\nHOST: localhost:1\r\nOrigin: http://a\r\ncontent-length: 2\r\n\r\n{}";
        let (request, head, length) = parse(text).unwrap().unwrap();
        assert_eq!([head, length], [text.len() - 2, 2]);
        assert_eq!([&*request.method, &*request.path], ["POST", "/a"]);
        assert_eq!(request.host.as_deref(), Some("localhost:1"));
        assert_eq!(parse(b"GET / HT"), Ok(None));
    }

    #[test]
    fn what_is_not_a_request_is_rejected() {
        use Rejection::{BadRequest, HeadTooLarge, TooLarge};
        let with = |header: &str| format!("GET / HTTP/1.1\r\n{header}\r\n\r\n");
        assert_eq!(rejected("\u{0}\u{1}\r\n\r\n"), Some(BadRequest));
        assert_eq!(rejected(&with("Host: a\r\nHost: b")), Some(BadRequest));
        assert_eq!(
            rejected(&with("Transfer-Encoding: chunked")),
            Some(BadRequest)
        );
        for length in ["-1", "+36", "", "0x10", "1 2", "99999999999999999999"] {
            let header = format!("Content-Length: {length}");
            assert_eq!(rejected(&with(&header)), Some(BadRequest), "{length}");
        }
        let long = format!("Content-Length: {}", BODY + 1);
        assert_eq!(rejected(&with(&long)), Some(TooLarge));
        let many: Vec<_> = (0..65).map(|n| format!("A{n}: b")).collect();
        assert_eq!(rejected(&with(&many.join("\r\n"))), Some(HeadTooLarge));
        let long = format!("A: {}", "b".repeat(HEAD));
        assert_eq!(rejected(&with(&long)), Some(HeadTooLarge));
        let wrong = b"GET / HTTP/1.1\r\nHost: \xff\xfe\r\n\r\n";
        assert_eq!(parse(wrong).err(), Some(BadRequest));
    }
}
