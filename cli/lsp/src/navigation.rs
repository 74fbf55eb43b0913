//! Ways through a program: its parts, and the places of a device.

use crate::view::View;
use gen_lsp_types::{
    Definition, DefinitionParams, DefinitionResponse, DocumentHighlight, DocumentHighlightKind,
    DocumentHighlightParams, DocumentSymbol, DocumentSymbolParams, DocumentSymbolResponse,
    FoldingRange, FoldingRangeParams, Location, ReferenceParams, SymbolKind,
};
use rungc::index::{Outline, OutlineKind};

/// Parts of the program, as a tree.
pub(crate) fn symbols(view: &View, _: &DocumentSymbolParams) -> Option<DocumentSymbolResponse> {
    let parts = view.index?.outline();
    let symbols = parts.iter().map(|part| symbol(view, part)).collect();
    Some(DocumentSymbolResponse::DocumentSymbolList(symbols))
}

fn symbol(view: &View, part: &Outline) -> DocumentSymbol {
    let kind = match part.kind {
        OutlineKind::Label => SymbolKind::Function,
        OutlineKind::State => SymbolKind::EnumMember,
        OutlineKind::Network => SymbolKind::Event,
    };
    let parts: Vec<_> = part.parts.iter().map(|part| symbol(view, part)).collect();
    let (range, head) = (view.range(part.span), view.range(part.head));
    DocumentSymbol {
        name: part.name.clone(),
        detail: (!part.detail.is_empty()).then(|| part.detail.clone()),
        kind,
        tags: None,
        #[allow(deprecated, reason = "a field of the protocol, which `tags` replaces")]
        deprecated: None,
        range: gen_lsp_types::Range {
            start: range.start.min(head.start),
            end: range.end.max(head.end),
        },
        selection_range: head,
        children: (!parts.is_empty()).then_some(parts),
    }
}

/// The places where a device gets its value, or where a label stands.
pub(crate) fn definition(view: &View, params: &DefinitionParams) -> Option<DefinitionResponse> {
    let (index, device) = view.device(params.text_document_position_params.position)?;
    let spans = index.definitions(device).into_iter();
    let locations = spans.map(|span| view.location(span)).collect();
    Some(DefinitionResponse::Definition(Definition::LocationList(
        locations,
    )))
}

/// The places that name a device, or devices that include it.
pub(crate) fn references(view: &View, params: &ReferenceParams) -> Option<Vec<Location>> {
    let (index, device) = view.device(params.text_document_position_params.position)?;
    let places = index.occurrences(device).into_iter();
    let is_wanted = params.context.include_declaration;
    let places = places.filter(|one| is_wanted || !one.is_definition());
    Some(places.map(|one| view.location(one.span)).collect())
}

/// The same in the text, as reads and writes.
pub(crate) fn highlights(
    view: &View,
    params: &DocumentHighlightParams,
) -> Option<Vec<DocumentHighlight>> {
    let (index, device) = view.device(params.text_document_position_params.position)?;
    let places = index.occurrences(device).into_iter();
    let highlights = places.map(|one| DocumentHighlight {
        range: view.range(one.span),
        kind: Some(match (one.kind, one.is_write()) {
            (None, _) => DocumentHighlightKind::Text,
            (Some(_), true) => DocumentHighlightKind::Write,
            (Some(_), false) => DocumentHighlightKind::Read,
        }),
    });
    Some(highlights.collect())
}

/// Networks of several lines, and routines and states.
pub(crate) fn folds(view: &View, _: &FoldingRangeParams) -> Option<Vec<FoldingRange>> {
    let mut folds = Vec::new();
    let mut left = view.index?.outline();
    while let Some(part) = left.pop() {
        let range = view.range(part.span);
        if range.start.line < range.end.line {
            folds.push(FoldingRange {
                start_line: range.start.line,
                end_line: range.end.line,
                ..FoldingRange::default()
            });
        }
        left.extend(part.parts);
    }
    folds.sort_by_key(|fold| (fold.start_line, u32::MAX - fold.end_line));
    folds.dedup();
    Some(folds)
}
