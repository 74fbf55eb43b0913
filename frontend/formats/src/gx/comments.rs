//! Device comments: `COMMENT.wcd` of GX Developer and `COMMENT.qcd` of GX Works2, which begin with the same table of
//! devices.

use super::fields::Fields;
use super::{HEADER, tokens};
use rungc_syntax::Device;

/// Length of one comment in `COMMENT.wcd`.
const SLOT: usize = 40;
/// Offset of the table in `COMMENT.qcd`: after a version, 18 bytes, the time of its last change and its length.
const WORKS2_TABLE: usize = 0x32;

/// The mark of the table in `COMMENT.wcd`.
const DEVELOPER: u8 = 0x08;
/// The mark of the table in `COMMENT.qcd`.
const WORKS2: u8 = 0x0A;

/// The head of a table of devices: its length and how many entries follow, with the fields that follow.
fn head(bytes: &[u8], start: usize, mark: u8) -> Option<(usize, u16, Fields<'_>)> {
    let mut fields = Fields::new(bytes.get(start..)?);
    let length = fields.u32()? as usize;
    // The second of these bytes is FFh where GX Works2 saved a Q project.
    let marked = matches!(fields.take(4)?, [0, 0 | 0xFF, 0x20, byte] if *byte == mark);
    marked.then_some((length, fields.u16()?, fields))
}

/// The devices of a table in order, and where the fields after it begin; an offset where it cannot be read on. More
/// than `most` devices cannot have comments in this file: a damaged table takes no memory.
fn devices(
    bytes: &[u8],
    start: usize,
    mark: u8,
    most: usize,
) -> Result<(Vec<Device>, usize), usize> {
    let (_, count, mut fields) = head(bytes, start, mark).ok_or(start)?;
    let mut devices = Vec::new();
    for _ in 0..count {
        let at = start + fields.at();
        let mut entry = || Some((fields.u16()?, fields.u32()?, fields.u32()?));
        let (code, first, many) = entry().ok_or(at)?;
        let class = u8::try_from(code)
            .ok()
            .and_then(tokens::commented)
            .ok_or(at)?;
        let last = first.checked_add(many).ok_or(at)?;
        if many as usize > most - devices.len() {
            return Err(at);
        }
        devices.extend((first..last).map(|number| Device { class, number }));
    }
    Ok((devices, start + fields.at()))
}

/// Contents of a file of comments.
pub(super) struct Comments<T> {
    /// Each comment with its device, as far as they can be read.
    pub read: Vec<(Device, T)>,
    /// The offset where they cannot be read on.
    pub damaged: Option<usize>,
}

impl<T> Comments<T> {
    fn damaged(at: usize) -> Self {
        Comments {
            read: Vec::new(),
            damaged: Some(at),
        }
    }
}

impl<T: Copy> Comments<T> {
    /// The texts alone.
    pub fn texts(&self) -> impl Iterator<Item = T> {
        self.read.iter().map(|(_, text)| *text)
    }
}

/// Returns true for a `COMMENT.wcd`.
pub(super) fn is_developer(bytes: &[u8]) -> bool {
    head(bytes, HEADER, DEVELOPER).is_some()
}

/// The comments of a `COMMENT.wcd`, in the local code page.
pub(super) fn of_developer(bytes: &[u8]) -> Comments<&[u8]> {
    let Some((length, ..)) = head(bytes, HEADER, DEVELOPER) else {
        return Comments::damaged(HEADER);
    };
    let (devices, _) = match devices(bytes, HEADER, DEVELOPER, bytes.len() / SLOT + 1) {
        Ok(table) => table,
        Err(at) => return Comments::damaged(at),
    };
    let end = HEADER.saturating_add(length);
    let slots = bytes.get(end..).unwrap_or_default().chunks_exact(SLOT);
    let whole = slots.len() >= devices.len();
    let read: Vec<_> = devices.into_iter().zip(slots).collect();
    Comments {
        damaged: (!whole).then_some(end.saturating_add(SLOT * read.len()).min(bytes.len())),
        read,
    }
}

/// The comments of a `COMMENT.qcd`.
pub(super) fn of_works2(bytes: &[u8]) -> Comments<String> {
    // Each comment has at least a number and the length of its text.
    let most = bytes.len() / 8;
    let (devices, end) = match devices(bytes, WORKS2_TABLE, WORKS2, most) {
        Ok(table) => table,
        Err(at) => return Comments::damaged(at),
    };
    let mut fields = Fields::new(bytes.get(end..).unwrap_or_default());
    let mut comments = Comments {
        read: Vec::new(),
        damaged: None,
    };
    for device in devices {
        let at = end + fields.at();
        match fields.u32().and_then(|_| fields.text()) {
            Some(text) => comments.read.push((device, text)),
            None => {
                comments.damaged = Some(at);
                break;
            }
        }
    }
    comments
}
