//! Messages on the wire: a header with the length, then JSON.

use crate::protocol::Request;
use serde_json::{Value, json};
use std::io::{self, BufRead, BufReader, Read, Write};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TryRecvError, sync_channel};
use std::thread;
use std::time::Duration;

/// Longest message, in bytes.
const MAX_LENGTH: u64 = 8 << 20;
/// Longest line of a header, in bytes.
const MAX_HEADER: u64 = 8 << 10;
/// Most messages that wait.
const MAX_WAITING: usize = 256;

/// A message from the client.
#[derive(Debug)]
pub enum Incoming {
    /// A request.
    Request(Request),
    /// Something else, with the reason why it is not a request.
    Malformed(String),
}

/// A client.
pub struct Client<W> {
    output: W,
    incoming: Receiver<Incoming>,
    /// Number of the last message sent.
    seq: u64,
}

impl<W: Write> Client<W> {
    /// A client, whose input a thread reads until it ends.
    pub fn new(input: impl Read + Send + 'static, output: W) -> Self {
        let (sender, incoming) = sync_channel(MAX_WAITING);
        // It ends with its input, or with the receiver.
        thread::spawn(move || read_all(BufReader::new(input), &sender));
        Client {
            output,
            incoming,
            seq: 0,
        }
    }

    /// Waits for the next message; `None` at the end of the input.
    pub fn receive(&self) -> Option<Incoming> {
        self.incoming.recv().ok()
    }

    /// Waits for the next message for a time.
    ///
    /// # Errors
    /// There is none, or there will be no more.
    pub fn receive_within(&self, time: Duration) -> Result<Incoming, RecvTimeoutError> {
        match time.is_zero() {
            false => self.incoming.recv_timeout(time),
            true => self.incoming.try_recv().map_err(|error| match error {
                TryRecvError::Empty => RecvTimeoutError::Timeout,
                TryRecvError::Disconnected => RecvTimeoutError::Disconnected,
            }),
        }
    }

    /// Answers a request; an error has a message for the user.
    ///
    /// # Errors
    /// Output that cannot be written.
    pub fn respond(&mut self, request: &Request, result: Result<Value, String>) -> io::Result<()> {
        let mut message = json!({
            "type": "response",
            "request_seq": request.seq,
            "command": request.command,
            "success": result.is_ok(),
        });
        match result {
            Ok(Value::Null) => {}
            Ok(body) => message["body"] = body,
            Err(why) => {
                // Clients replace what is in braces by variables of the error, of which there are none.
                let format = why.replace('{', "(").replace('}', ")");
                message["message"] = json!(why);
                message["body"] =
                    json!({ "error": { "id": 1, "format": format, "showUser": true } });
            }
        }
        self.send(message)
    }

    /// Sends an event.
    ///
    /// # Errors
    /// Output that cannot be written.
    pub fn event(&mut self, event: &str, body: Value) -> io::Result<()> {
        let mut message = json!({ "type": "event", "event": event });
        if !body.is_null() {
            message["body"] = body;
        }
        self.send(message)
    }

    /// Sends a line for the user. `category` is `console`, `important`, `stdout` or `stderr`.
    ///
    /// # Errors
    /// Output that cannot be written.
    pub fn output(&mut self, category: &str, line: &str) -> io::Result<()> {
        self.event(
            "output",
            json!({ "category": category, "output": format!("{line}\n") }),
        )
    }

    fn send(&mut self, mut message: Value) -> io::Result<()> {
        self.seq += 1;
        message["seq"] = json!(self.seq);
        let text = message.to_string();
        write!(self.output, "Content-Length: {}\r\n\r\n{text}", text.len())?;
        self.output.flush()
    }
}

/// Reads until the input ends.
fn read_all(mut input: impl BufRead, sender: &SyncSender<Incoming>) {
    // Input that cannot be read ends as input that is at its end.
    while let Ok(Some(incoming)) = read(&mut input) {
        if sender.send(incoming).is_err() {
            return;
        }
    }
}

/// Reads a message; `None` at the end of the input.
fn read(input: &mut impl BufRead) -> io::Result<Option<Incoming>> {
    let length = match header(input)? {
        None => return Ok(None),
        Some(Err(why)) => return Ok(Some(Incoming::Malformed(why))),
        Some(Ok(length)) => length,
    };
    if length > MAX_LENGTH {
        let skipped = io::copy(&mut input.take(length), &mut io::sink())?;
        let why = format!("a message has at most {} MiB", MAX_LENGTH >> 20);
        return Ok((skipped == length).then_some(Incoming::Malformed(why)));
    }
    let mut body = Vec::new();
    input.take(length).read_to_end(&mut body)?;
    if body.len() as u64 != length {
        return Ok(None);
    }
    Ok(Some(match Request::read(&body) {
        Ok(request) => Incoming::Request(request),
        Err(why) => Incoming::Malformed(why),
    }))
}

/// Reads a header: the length of the message, or what is wrong; `None` at the end of the input.
fn header(input: &mut impl BufRead) -> io::Result<Option<Result<u64, String>>> {
    let mut length = None;
    let mut is_empty = true;
    loop {
        let mut line = Vec::new();
        input.take(MAX_HEADER).read_until(b'\n', &mut line)?;
        if line.is_empty() {
            return Ok(None);
        }
        let text = String::from_utf8_lossy(&line);
        let text = text.trim();
        if text.is_empty() {
            match (is_empty, length) {
                // Blank lines between messages.
                (true, _) => continue,
                (_, Some(length)) => return Ok(Some(Ok(length))),
                (_, None) => {
                    let why = "the header of a message has no valid `Content-Length`";
                    return Ok(Some(Err(why.to_owned())));
                }
            }
        }
        is_empty = false;
        if let Some((name, value)) = text.split_once(':')
            && name.trim().eq_ignore_ascii_case("content-length")
        {
            length = value.trim().parse().ok();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(mut input: &[u8]) -> Vec<String> {
        let mut found = Vec::new();
        while let Ok(Some(incoming)) = read(&mut input) {
            found.push(match incoming {
                Incoming::Request(request) => format!("{} {}", request.seq, request.command),
                Incoming::Malformed(why) => why,
            });
        }
        found
    }

    #[test]
    fn messages_are_read_after_what_is_none() {
        let threads = r#"{"seq":7,"type":"request","command":"threads"}"#;
        let good = format!("Content-Length: {}\r\n\r\n{threads}", threads.len());
        let no_length = format!("Content-Type: x\r\n\r\n{good}");
        let expected = "the header of a message has no valid `Content-Length`";
        assert_eq!(all(no_length.as_bytes()), [expected, "7 threads"]);
        let not_json = format!("content-length:3\n\n{{]]{good}");
        assert_eq!(all(not_json.as_bytes()).len(), 2);
        let long = format!("Content-Length: {}\r\n\r\n{good}", u64::MAX);
        assert!(all(long.as_bytes()).is_empty());
        assert!(all(&good.as_bytes()[..good.len() - 1]).is_empty());
    }
}
