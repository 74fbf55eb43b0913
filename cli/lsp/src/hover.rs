//! Explanations.

use crate::publish::Places;
use crate::view::View;
use gen_lsp_types::{Contents, Hover, HoverParams, MarkupContent, MarkupKind, Position, Range};
use rungc::index::What;
use rungc_syntax::codes;

/// What is known of the instruction or device at a position, and the explanations of the findings there.
pub(crate) fn hover(view: &View, params: &HoverParams) -> Option<Hover> {
    let position = params.text_document_position_params.position;
    let place = view.place(position);
    let of_place = place.and_then(
        |(index, place)| match (place.what, index.device(place.what)) {
            (_, Some(device)) => Some(index.facts(device)),
            (What::Mnemonic(i), None) => index.instruction(i),
            _ => None,
        },
    );
    let of_findings = findings(view, position);
    let texts: Vec<String> = of_place.into_iter().chain(of_findings).collect();
    (!texts.is_empty()).then(|| Hover {
        contents: Contents::MarkupContent(MarkupContent {
            kind: MarkupKind::Markdown,
            value: texts.join("\n\n---\n\n"),
        }),
        range: place.map(|(_, place)| view.range(place.span)),
    })
}

/// Explanations of the codes at a position, each once, as `rungc explain` begins them.
fn findings(view: &View, position: Position) -> Vec<String> {
    let places = Places {
        uri: &view.document.uri,
        text: &view.document.now,
        project: view.index.map(|index| index.project()),
    };
    let found = view.document.findings();
    let is_here = |range: Range| (range.start..=range.end).contains(&position);
    let mut here: Vec<&str> = found
        .iter()
        .flat_map(|found| found.iter())
        .filter(|finding| finding.location.is_some())
        .filter(|finding| is_here(places.range(finding.location.as_ref())))
        .map(|finding| finding.code)
        .collect();
    here.sort_unstable();
    here.dedup();
    let codes = here.into_iter().filter_map(codes::find);
    codes
        .map(|code| {
            format!(
                "**{}** ({}): {}\n\n{}",
                code.id, code.name, code.title, code.text
            )
        })
        .collect()
}
