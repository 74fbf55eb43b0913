//! What can be written at a position.

use crate::view::View;
use gen_lsp_types::{
    ActiveParameter, CompletionItem, CompletionItemKind, CompletionItemLabelDetails,
    CompletionItemTextEdit, CompletionList, CompletionParams, CompletionResponse, Documentation,
    ParameterInformation, ParameterInformationLabel, Position, Range, SignatureHelp,
    SignatureHelpParams, SignatureInformation, TextEdit,
};
use rungc::index::{Proposed, ProposedKind};

/// Mnemonics, or devices that the instruction accepts.
pub(crate) fn completion(view: &View, params: &CompletionParams) -> Option<CompletionResponse> {
    let index = view.text_index()?;
    let position = params.text_document_position_params.position;
    let line = view.line_before(position);
    let proposals = index.proposals(line);
    let replaced = &line[line.len() - proposals.replaced..];
    let length = view.document.now.lines.length(replaced);
    let range = Range {
        start: Position {
            character: position.character.saturating_sub(length),
            ..position
        },
        end: position,
    };
    let items = proposals.list.into_iter().map(|one| item(one, range));
    Some(CompletionResponse::CompletionList(CompletionList {
        is_incomplete: proposals.is_cut,
        items: items.collect(),
        ..CompletionList::default()
    }))
}

fn item(proposed: Proposed, range: Range) -> CompletionItem {
    let Proposed {
        kind,
        text,
        detail,
        title,
    } = proposed;
    let edit = TextEdit {
        range,
        new_text: text.clone(),
    };
    let (kind, filter) = match kind {
        ProposedKind::Mnemonic => (CompletionItemKind::Keyword, None),
        ProposedKind::Device(_) => (
            CompletionItemKind::Variable,
            Some(format!("{text} {detail}")),
        ),
    };
    CompletionItem {
        label: text,
        label_details: (!detail.is_empty()).then(|| CompletionItemLabelDetails {
            detail: Some(format!(" {detail}")),
            description: None,
        }),
        kind: Some(kind),
        detail: (!title.is_empty()).then_some(title),
        filter_text: filter,
        text_edit: Some(CompletionItemTextEdit::TextEdit(edit)),
        ..CompletionItem::default()
    }
}

/// Operands of the instruction at a position.
pub(crate) fn signature(view: &View, params: &SignatureHelpParams) -> Option<SignatureHelp> {
    let index = view.text_index()?;
    let position = params.text_document_position_params.position;
    let signature = index.signature(view.line_before(position))?;
    let parameters = signature.params.into_iter();
    let parameters = parameters.map(|(name, text)| ParameterInformation {
        label: ParameterInformationLabel::String(name),
        documentation: Some(Documentation::String(text)),
    });
    let active = Some(ActiveParameter::Int(signature.active as u32));
    Some(SignatureHelp {
        signatures: vec![SignatureInformation {
            label: signature.label,
            documentation: Some(Documentation::String(signature.title)),
            parameters: Some(parameters.collect()),
            active_parameter: active,
        }],
        active_signature: Some(0),
        active_parameter: active,
    })
}
