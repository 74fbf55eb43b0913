//! Another device in place of one.

use crate::server::Refusal;
use crate::view::View;
use gen_lsp_types::{
    PrepareRenameParams, PrepareRenamePlaceholder, PrepareRenameResult, RenameParams, TextEdit,
    WorkspaceEdit,
};
use lsp_server::ErrorCode;
use std::collections::HashMap;

fn refused(why: String) -> Refusal {
    (ErrorCode::RequestFailed, why)
}

/// The place of the device to be renamed.
pub(crate) fn prepare(
    view: &View,
    params: &PrepareRenameParams,
) -> Result<Option<PrepareRenameResult>, Refusal> {
    let Some(index) = view.index else {
        return Ok(None);
    };
    let position = params.text_document_position_params.position;
    let offset = view.document.now.offset(position);
    let (span, device) = index.renamable(offset).map_err(refused)?;
    Ok(Some(PrepareRenameResult::PrepareRenamePlaceholder(
        PrepareRenamePlaceholder {
            range: view.range(span),
            placeholder: device.to_string(),
        },
    )))
}

/// The edits that rename a device, and what the user has to know of them.
pub(crate) fn rename(
    view: &View,
    params: &RenameParams,
) -> Result<(Option<WorkspaceEdit>, Vec<String>), Refusal> {
    let Some(index) = view.index else {
        return Ok((None, Vec::new()));
    };
    let position = params.text_document_position_params.position;
    let offset = view.document.now.offset(position);
    let (_, device) = index.renamable(offset).map_err(refused)?;
    let renaming = index.rename(device, &params.new_name).map_err(refused)?;
    let edits = renaming.edits.into_iter().map(|(span, new_text)| TextEdit {
        range: view.range(span),
        new_text,
    });
    let changes = HashMap::from([(view.document.uri.clone(), edits.collect())]);
    let edit = WorkspaceEdit {
        changes: Some(changes),
        ..WorkspaceEdit::default()
    };
    Ok((Some(edit), renaming.notes))
}
