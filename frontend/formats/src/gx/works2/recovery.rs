//! Finding a program by its bytes, where the project does not say which stream holds it.

use crate::gx::program::{self, Chain, Code};
use crate::gx::{MAX_DATA, tokens};
use crate::{Read, ReadOptions};

/// Reads the longest program of these streams, if there is one. The editor keeps a copy of the program: the longest is
/// the one without damage. Of equals, the first.
pub(super) fn read(name: &str, streams: &[Vec<u8>], options: &ReadOptions) -> Option<Read> {
    let programs = streams.iter().filter_map(|stream| {
        let stream = stream.get(..MAX_DATA).unwrap_or(stream);
        let chains = program::chains(stream);
        let start = chains.iter().position(|chain| chain.is_program())?;
        let start = stated_start(stream, start, &chains).unwrap_or(start);
        Some((chains[start], stream, start, chains))
    });
    let longest = programs.fold(None, |best: Option<(Chain, _, _, _)>, next| match best {
        Some(best) if best.0 >= next.0 => Some(best),
        _ => Some(next),
    });
    let (_, stream, start, chains) = longest?;
    let code = Code::new(stream, start, &chains);
    let encoding = options.encoding_of(&code.texts(), None);
    Some(code.read(name, encoding, options))
}

/// The program's beginning before `start`, if damage hides it: its length is stored there, 32 bits that count the bytes
/// through `END`.
fn stated_start(stream: &[u8], start: usize, chains: &[Chain]) -> Option<usize> {
    let end = (start..stream.len())
        .rev()
        .find(|&at| program::body(stream, at) == Some(tokens::END) && chains[at].complete)?;
    let end = end + tokens::END.len() + 2;
    (4..start).find(|&at| stream[at - 4..at] == u32::try_from(end - at).unwrap_or(0).to_le_bytes())
}
