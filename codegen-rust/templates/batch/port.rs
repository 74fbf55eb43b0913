//! Source of requests and destination of answers.

use core::fmt::{self, Display, Write};

/// Bytes that are read and written at a time.
const SIZE: usize = 4096;

/// Requests and answers, both line by line. Answers wait until there are no more requests to read, since whoever waits for an
/// answer has sent nothing more.
pub struct Port<'a> {
    read: &'a mut dyn FnMut(&mut [u8]) -> usize,
    write: &'a mut dyn FnMut(&[u8]),
    input: [u8; SIZE],
    /// Start of the next line.
    begin: usize,
    /// End of the input read so far.
    end: usize,
    output: [u8; SIZE],
    /// Bytes of output that wait.
    waiting: usize,
}

impl<'a> Port<'a> {
    /// A port that reads and writes this way.
    pub fn new(
        read: &'a mut dyn FnMut(&mut [u8]) -> usize,
        write: &'a mut dyn FnMut(&[u8]),
    ) -> Self {
        Port {
            read,
            write,
            input: [0; SIZE],
            begin: 0,
            end: 0,
            output: [0; SIZE],
            waiting: 0,
        }
    }

    /// The next line; `None` at the end of the input, or if there is a line longer than any request.
    pub fn line(&mut self) -> Option<&str> {
        let length = loop {
            let unread = &self.input[self.begin..self.end];
            if let Some(length) = unread.iter().position(|&byte| byte == b'\n') {
                break length;
            }
            self.flush();
            self.input.copy_within(self.begin..self.end, 0);
            self.end -= self.begin;
            self.begin = 0;
            match (self.read)(&mut self.input[self.end..]) {
                0 => return None,
                more => self.end += more,
            }
        };
        let line = &self.input[self.begin..self.begin + length];
        self.begin += length + 1;
        // Invalid text is not a request, either.
        Some(core::str::from_utf8(line).unwrap_or_default())
    }

    /// Writes an answer.
    pub fn answer(&mut self, answer: &dyn Display) {
        // Writing never fails.
        let _ = writeln!(self, "{answer}");
    }

    /// Writes all answers that wait.
    pub fn flush(&mut self) {
        if self.waiting > 0 {
            (self.write)(&self.output[..self.waiting]);
            self.waiting = 0;
        }
    }
}

impl Write for Port<'_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for &byte in text.as_bytes() {
            if self.waiting == SIZE {
                self.flush();
            }
            self.output[self.waiting] = byte;
            self.waiting += 1;
        }
        Ok(())
    }
}
