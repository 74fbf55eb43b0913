//! Messages on standard input and output. Input that is not a message is answered with an error, and reading continues
//! after it.

use crossbeam_channel::{Receiver, Sender, bounded, unbounded};
use lsp_server::{Connection, ErrorCode, Message};
use serde_json::{Value, json};
use std::io::{self, BufRead, Read, Write};
use std::thread::{self, JoinHandle};

/// Longest header, in bytes.
const MAX_HEADER: u64 = 4_096;

/// Longest message, in bytes: twice the largest text that is read.
const MAX_MESSAGE: u64 = 2 * rungc_frontend::MAX_SIZE;

/// Threads that read and write.
pub(crate) struct Threads {
    reader: JoinHandle<io::Result<()>>,
    writer: JoinHandle<()>,
}

impl Threads {
    /// Waits until all is written.
    pub(crate) fn finish(self) {
        // A thread that has panicked has nothing to write.
        let _ = self.writer.join();
    }

    /// Waits until all is read and written.
    ///
    /// # Errors
    /// Reason why reading has ended early.
    pub(crate) fn join(self) -> io::Result<()> {
        let read = self.reader.join();
        let _ = self.writer.join();
        read.unwrap_or_else(|_| Err(io::Error::other("reading has failed")))
    }
}

/// Connects standard input and output.
pub(crate) fn connect() -> (Connection, Threads) {
    let (to_server, receiver) = bounded(0);
    let (sender, from_server) = unbounded();
    let threads = Threads {
        reader: thread::spawn(move || receive(io::stdin().lock(), &to_server, &mut io::stdout())),
        writer: thread::spawn(move || send(&from_server)),
    };
    (Connection { sender, receiver }, threads)
}

/// Writes messages until there are no more, or the editor reads no more.
fn send(messages: &Receiver<Message>) {
    for message in messages {
        if message.write(&mut io::stdout().lock()).is_err() {
            return;
        }
    }
}

/// Reads messages until the input ends, or the editor says so.
fn receive(
    mut input: impl BufRead,
    server: &Sender<Message>,
    output: &mut impl Write,
) -> io::Result<()> {
    while let Some(content) = frame(&mut input)? {
        match serde_json::from_slice::<Message>(&content) {
            Ok(message) => {
                let is_exit =
                    matches!(&message, Message::Notification(note) if note.method == "exit");
                if server.send(message).is_err() || is_exit {
                    return Ok(());
                }
            }
            Err(error) => reject(&content, &error, output)?,
        }
    }
    Ok(())
}

/// The content of the next message; `None` at the end of the input.
fn frame(input: &mut impl BufRead) -> io::Result<Option<Vec<u8>>> {
    let wrong = |why: String| io::Error::new(io::ErrorKind::InvalidData, why);
    let mut length = None;
    loop {
        let mut line = Vec::new();
        input.take(MAX_HEADER).read_until(b'\n', &mut line)?;
        let line = String::from_utf8_lossy(&line);
        if line.is_empty() {
            return Ok(None);
        }
        let Some((name, value)) = line.trim_end().split_once(':') else {
            if line.trim_end().is_empty() && line.ends_with('\n') {
                break;
            }
            return Err(wrong("this is not the header of a message".to_owned()));
        };
        if name.eq_ignore_ascii_case("content-length") {
            let number = value.trim().parse::<u64>();
            let number = number.ok().filter(|number| *number <= MAX_MESSAGE);
            let why = || {
                wrong(format!(
                    "a message cannot have a length of {}",
                    value.trim()
                ))
            };
            length = Some(number.ok_or_else(why)?);
        }
    }
    let length = length.ok_or_else(|| wrong("the header does not state a length".to_owned()))?;
    let mut content = Vec::new();
    input.take(length).read_to_end(&mut content)?;
    match content.len() as u64 == length {
        true => Ok(Some(content)),
        false => Err(wrong("the input ends within a message".to_owned())),
    }
}

/// Answers what is not a message.
fn reject(content: &[u8], error: &serde_json::Error, output: &mut impl Write) -> io::Result<()> {
    let parsed = serde_json::from_slice::<Value>(content);
    let code = match parsed {
        Ok(_) => ErrorCode::InvalidRequest,
        Err(_) => ErrorCode::ParseError,
    };
    let id = parsed.ok().and_then(|value| value.get("id").cloned());
    let id = id.filter(|id| id.is_string() || id.is_i64());
    let answer = json!({
        "jsonrpc": "2.0",
        "id": id,
        "error": { "code": code as i32, "message": error.to_string() },
    });
    let answer = answer.to_string();
    // At once, so that nothing comes between.
    let frame = format!("Content-Length: {}\r\n\r\n{answer}", answer.len());
    output.write_all(frame.as_bytes())?;
    output.flush()
}

#[cfg(test)]
mod tests {
    use super::receive;
    use crossbeam_channel::unbounded;

    fn framed(content: &str) -> String {
        format!(
            "Content-Length: {}\r\nContent-Type: x\r\n\r\n{content}",
            content.len()
        )
    }

    #[test]
    fn input_that_is_no_message_is_answered_and_left_out() {
        let good = r#"{"jsonrpc":"2.0","id":1,"method":"a"}"#;
        let input = [
            r#"{"a":"#,
            "\u{1}",
            "7",
            r#"{"id":"x"}"#,
            r#"{"id":2,"method":5}"#,
            good,
        ];
        let input: String = input.map(framed).concat();
        let (sender, messages) = unbounded();
        let mut output = Vec::new();
        receive(input.as_bytes(), &sender, &mut output).unwrap();
        assert_eq!(messages.try_iter().count(), 1);
        insta::assert_snapshot!(String::from_utf8(output).unwrap().replace("\r\n", "\n"));
    }

    #[test]
    fn input_without_frames_ends_the_connection() {
        let of = |input: &str| {
            let (sender, _messages) = unbounded();
            let read = receive(input.as_bytes(), &sender, &mut Vec::new());
            read.err()
                .map(|error| error.to_string())
                .unwrap_or_default()
        };
        let ends = [
            "",
            "garbage\r\n\r\n",
            "Content-Length: 99999999999\r\n\r\n{}",
            "Content-Length: 9\r\n\r\n{}",
            "A: 1\r\n\r\n",
            "Content-Length: 1",
        ];
        insta::assert_snapshot!(ends.map(of).join("\n"));
    }
}
