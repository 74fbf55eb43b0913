//! A server of the Model Context Protocol: what an assistant can ask about programs of FX-family PLCs, and what it can
//! have done to them.
//!
//! It is a front, as the language server is: what a program means is the business of the library `rungc` and of the
//! crates below it. Here are the protocol, the folders that an assistant may read, and answers in pages that fit its
//! memory.
//!
//! The protocol is JSON-RPC on standard input and output, a message a line. The official SDK for Rust (`rmcp`) is not
//! used: it brings an asynchronous runtime, schemas derived from types, identifiers and macros into the build of the
//! command line, for a server that answers one request after another and opens no connection. What remains without it
//! is `protocol.rs` (messages), `stdio.rs` (lines, cancellation) and `server.rs` (methods), on `serde_json`. Tests hold
//! them to the official clients for Python and TypeScript.
//!
//! Two forms of the protocol are spoken: with a handshake (2024-11-05 to 2025-11-25), and with a version in each
//! request (2026-07-28). Start reading at [`serve`], then `server.rs`; each tool is a file in `tools/`.
#![deny(missing_docs)]

mod arguments;
mod files;
mod page;
mod prompts;
mod protocol;
mod resources;
mod server;
mod stdio;
mod tools;

pub use stdio::serve;

use files::Files;
use std::io;
use std::path::PathBuf;

/// What a server may touch, and the texts that it offers.
#[derive(Clone, Debug)]
pub struct Options {
    /// Folders whose files may be read. Paths begin at the first.
    pub roots: Vec<PathBuf>,
    /// Folder in which files may be written.
    pub write: Option<PathBuf>,
    /// What an assistant must know of the language.
    pub guide: &'static str,
    /// Pages of the book.
    pub pages: Vec<Text>,
    /// Example programs and test files.
    pub examples: Vec<Text>,
}

/// A text that is offered as a resource.
#[derive(Clone, Copy, Debug)]
pub struct Text {
    /// Name in its address: `test-files`.
    pub name: &'static str,
    /// Title.
    pub title: &'static str,
    /// The text.
    pub text: &'static str,
}

/// Serves one client on standard input and output, until it closes the input. From then on, this process reads no files
/// outside of the folders.
///
/// # Errors
/// A folder that does not exist; output that cannot be written.
pub fn serve_stdio(options: &Options) -> io::Result<()> {
    // Names a folder that does not exist.
    Files::new(&options.roots, options.write.as_deref())?;
    let folders: Vec<PathBuf> = options
        .roots
        .iter()
        .chain(&options.write)
        .cloned()
        .collect();
    rungc_syntax::inputs::confine(&folders)?;
    serve(io::stdin(), io::stdout(), options)
}
