//! The layout of instruction lists.

use crate::server::Refusal;
use crate::view::View;
use gen_lsp_types::{DocumentFormattingParams, TextEdit};
use lsp_server::ErrorCode;
use rungc_syntax::{SourceKind, Span};

/// One edit that lays a list out as `rungc fmt` does.
pub(crate) fn format(
    view: &View,
    _: &DocumentFormattingParams,
) -> Result<Option<Vec<TextEdit>>, Refusal> {
    let Some(index) = view.index else {
        return Ok(None);
    };
    if index.project().source().kind != SourceKind::Il {
        return Ok(None);
    }
    let laid_out = index.laid_out().map_err(|line| {
        let why = format!("line {line} cannot be read, so the list is not laid out");
        (ErrorCode::RequestFailed, why)
    })?;
    let before = view.document.now.content();
    Ok(Some(edit(view, before, &laid_out).into_iter().collect()))
}

/// The edit from the first line that differs to the last.
fn edit(view: &View, before: &str, after: &str) -> Option<TextEdit> {
    if before == after {
        return None;
    }
    let lines = |text| -> Vec<&str> { str::split_inclusive(text, '\n').collect() };
    let (old, new) = (lines(before), lines(after));
    let same = |a: &mut dyn Iterator<Item = (&&str, &&str)>| a.take_while(|(a, b)| a == b).count();
    let head = same(&mut old.iter().zip(&new));
    let rest = old.len().min(new.len()) - head;
    let tail = same(&mut old.iter().rev().zip(new.iter().rev()).take(rest));
    let length = |lines: &[&str]| lines.iter().map(|line| line.len()).sum::<usize>() as u32;
    let start = length(&old[..head]);
    let end = start + length(&old[head..old.len() - tail]);
    let range = view.document.now.range(Span::new(start, end));
    Some(TextEdit {
        range,
        new_text: new[head..new.len() - tail].concat(),
    })
}
