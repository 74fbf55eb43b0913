//! A language server for programs of FX-family PLCs: what an editor shows of instruction lists, drawn ladder, list
//! exports, test files and `rungc.toml` while they are written.
//!
//! It is a front: what a program means is the business of the library `rungc`, whose [`rungc::index`] answers for
//! places of a text. Here are the protocol (LSP 3.18, types of `gen-lsp-types`), open documents, and positions in the
//! units that the editor counts in. Start reading at [`serve`], then `server.rs`; each feature is a file.
#![deny(missing_docs)]

mod actions;
mod capabilities;
mod checks;
mod completion;
mod decoration;
mod document;
mod format;
mod hover;
mod lines;
mod navigation;
mod publish;
mod rename;
mod server;
mod stdio;
mod uri;
mod view;

pub use server::{Ended, serve};

use std::io;

/// Serves one editor on standard input and output, until it ends the connection.
///
/// # Errors
/// Input in which no messages can be found.
pub fn serve_stdio() -> io::Result<Ended> {
    let (connection, threads) = stdio::connect();
    let ended = serve(&connection);
    // The writing thread ends with the connection.
    drop(connection);
    match ended {
        // An editor need not close standard input.
        Ended::Exit => threads.finish(),
        Ended::Abandoned => threads.join()?,
    }
    Ok(ended)
}
