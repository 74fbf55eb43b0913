//! GX Works2: an OLE compound file whose stream `_hdb` is an OLE compound file in turn. Its streams are known by numbers only, so
//! the program is found by its tokens.

use super::{Chain, add_comments, cpu, is_comments, no_program, program};
use crate::Read;
use cfb::CompoundFile;
use rungc_syntax::SourceKind;
use std::io::{Cursor, Read as _};

/// The stream that holds the project's data.
const DATA: &str = "_hdb";
/// Streams over this size hold no program; bytes.
const MAX_STREAM: u64 = 32 << 20;

/// Reads a `.gxw` file.
pub(crate) fn read(name: &str, bytes: &[u8]) -> Read {
    let streams = streams(bytes, |stream| stream == DATA)
        .into_iter()
        .flat_map(|data| streams(&data, |_| true))
        .collect::<Vec<_>>();
    let programs = streams.iter().filter_map(|stream| {
        let chains = program::chains(stream);
        let start = chains.iter().position(|chain| chain.is_program())?;
        Some((unbroken(&chains, start), stream, start, chains))
    });
    // The editor keeps a copy of the program: the longest is the one without damage. Of equals, the first.
    let longest = programs.fold(None, |best: Option<(Chain, _, _, _)>, next| match best {
        Some(best) if best.0 >= next.0 => Some(best),
        _ => Some(next),
    });
    let mut read = match longest {
        Some((_, stream, start, chains)) => program::read(name, stream, start, &chains),
        None => no_program(name, bytes),
    };
    read.program.kind = SourceKind::GxWorks2;
    read.program.cpu = streams
        .iter()
        .find_map(|stream| cpu(stream))
        .map(str::to_owned);
    if let Some(comments) = streams.iter().find(|stream| is_comments(stream)) {
        add_comments(&mut read, comments);
    }
    read
}

/// The chain at the program's beginning.
fn unbroken(chains: &[Chain], start: usize) -> Chain {
    chains.get(start).copied().unwrap_or_default()
}

/// The streams of a compound file whose names are wanted, in the order of their names; those that cannot be read are left out.
fn streams(bytes: &[u8], wanted: impl Fn(&str) -> bool) -> Vec<Vec<u8>> {
    let Ok(mut file) = CompoundFile::open(Cursor::new(bytes)) else {
        return Vec::new();
    };
    let mut paths: Vec<_> = file
        .walk()
        .filter(|entry| entry.is_stream() && entry.len() <= MAX_STREAM && wanted(entry.name()))
        .map(|entry| (entry.name().len(), entry.path().to_owned()))
        .collect();
    paths.sort();
    let mut streams = Vec::new();
    for (_, path) in paths {
        let mut content = Vec::new();
        if let Ok(stream) = file.open_stream(&path) {
            // What can be read before a damaged sector is kept.
            let _ = stream.take(MAX_STREAM).read_to_end(&mut content);
            streams.push(content);
        }
    }
    streams
}
