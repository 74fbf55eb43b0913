//! GX Works2: an OLE compound file whose stream `_hdb` is an OLE compound file in turn. Its streams are known by numbers only, so
//! the program is found by its tokens.

use super::{
    Chain, MAX_DATA, add_comments, cpu, cpu_code, is_comments, no_program, program, tokens,
};
use crate::{Read, ReadOptions};
use cfb::CompoundFile;
use rungc_syntax::SourceKind;
use std::io::{Cursor, Read as _};

/// The stream that holds the project's data.
const DATA: &str = "_hdb";

/// Reads a `.gxw` file.
pub(crate) fn read(name: &str, bytes: &[u8], options: &ReadOptions) -> Read {
    let streams = streams(bytes, |stream| stream == DATA)
        .into_iter()
        .flat_map(|data| streams(&data, |_| true))
        .collect::<Vec<_>>();
    let cpu = streams.iter().find_map(|s| cpu_code(s)).map(cpu::name);
    let refused = |cpu: &String| cpu::refused(name, SourceKind::GxWorks2, cpu);
    if let Some(refused) = cpu.as_ref().and_then(refused) {
        return refused;
    }
    let programs = streams.iter().filter_map(|stream| {
        let chains = program::chains(stream);
        let start = chains.iter().position(|chain| chain.is_program())?;
        let start = stated_start(stream, start, &chains).unwrap_or(start);
        Some((chains[start], stream, start, chains))
    });
    // The editor keeps a copy of the program: the longest is the one without damage. Of equals, the first.
    let longest = programs.fold(None, |best: Option<(Chain, _, _, _)>, next| match best {
        Some(best) if best.0 >= next.0 => Some(best),
        _ => Some(next),
    });
    let mut read = match longest {
        Some((_, stream, start, chains)) => program::read(name, stream, start, &chains, options),
        None => no_program(name, bytes),
    };
    read.program.kind = SourceKind::GxWorks2;
    read.program.cpu = cpu;
    if let Some(comments) = streams.iter().find(|stream| is_comments(stream)) {
        add_comments(&mut read, comments);
    }
    read
}

/// The program's beginning before `start`, if damage hides it: its length stands there, 32 bits that count up to behind `END`.
fn stated_start(stream: &[u8], start: usize, chains: &[Chain]) -> Option<usize> {
    let end = (start..stream.len())
        .rev()
        .find(|&at| program::body(stream, at) == Some(tokens::END) && chains[at].complete)?;
    let end = end + tokens::END.len() + 2;
    (4..start).find(|&at| stream[at - 4..at] == u32::try_from(end - at).unwrap_or(0).to_le_bytes())
}

/// The streams of a compound file whose names are wanted, in the order of their names; those that cannot be read are left out.
fn streams(bytes: &[u8], wanted: impl Fn(&str) -> bool) -> Vec<Vec<u8>> {
    let Ok(mut file) = CompoundFile::open(Cursor::new(bytes)) else {
        return Vec::new();
    };
    let mut paths: Vec<_> = file
        .walk()
        .filter(|entry| entry.is_stream() && entry.len() <= MAX_DATA as u64 && wanted(entry.name()))
        .map(|entry| (entry.name().len(), entry.path().to_owned()))
        .collect();
    paths.sort();
    let mut streams = Vec::new();
    for (_, path) in paths {
        let mut content = Vec::new();
        if let Ok(stream) = file.open_stream(&path) {
            // What can be read before a damaged sector is kept.
            let _ = stream.take(MAX_DATA as u64).read_to_end(&mut content);
            streams.push(content);
        }
    }
    streams
}
