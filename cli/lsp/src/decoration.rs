//! Colours of words, and comments of devices beside instructions.

use crate::view::View;
use gen_lsp_types::{
    InlayHint, InlayHintParams, Label, Position, Range, SemanticToken, SemanticTokens,
    SemanticTokensLegend, SemanticTokensParams, SemanticTokensRangeParams,
};
use rungc::index::TokenKind;
use rungc_syntax::{DeviceClass, Span};

/// Kinds of words, as themes know them.
const TYPES: [&str; 9] = [
    "keyword",
    "label",
    "variable",
    "parameter",
    "property",
    "enumMember",
    "number",
    "string",
    "comment",
];

/// Names of the words' kinds.
pub(crate) fn legend() -> SemanticTokensLegend {
    let modifiers = DeviceClass::ALL.map(|class| format!("class{}", class.prefix()));
    SemanticTokensLegend {
        token_types: TYPES.map(str::to_owned).to_vec(),
        token_modifiers: modifiers.to_vec(),
    }
}

/// Position of a kind in the legend, and the modifier that names the class of a device.
fn kind(kind: TokenKind) -> (u32, u32) {
    let plain = |name: &str| TYPES.iter().position(|known| *known == name).unwrap_or(0) as u32;
    match kind {
        TokenKind::Mnemonic => (plain("keyword"), 0),
        TokenKind::Label => (plain("label"), 0),
        TokenKind::Number => (plain("number"), 0),
        TokenKind::Text => (plain("string"), 0),
        TokenKind::Comment => (plain("comment"), 0),
        TokenKind::Device(class) => {
            let name = match class {
                DeviceClass::X => "parameter",
                DeviceClass::Y => "property",
                DeviceClass::S => "enumMember",
                _ => "variable",
            };
            (plain(name), 1 << class as u32)
        }
    }
}

/// The words of a text.
pub(crate) fn tokens(view: &View, _: &SemanticTokensParams) -> Option<SemanticTokens> {
    words(view, Span::new(0, u32::MAX))
}

/// The words of a range.
pub(crate) fn tokens_in(view: &View, params: &SemanticTokensRangeParams) -> Option<SemanticTokens> {
    words(view, view.span(whole_lines(params.range)))
}

fn whole_lines(range: Range) -> Range {
    let character = 0;
    let start = Position {
        character,
        ..range.start
    };
    Range { start, ..range }
}

fn words(view: &View, span: Span) -> Option<SemanticTokens> {
    let index = view.text_index()?;
    let mut last = Position::default();
    let data = index.tokens(span).into_iter().filter_map(|token| {
        let range = view.range(token.span);
        let length = range.end.character.checked_sub(range.start.character)?;
        if range.start.line != range.end.line || range.start < last {
            return None;
        }
        let line = range.start.line - last.line;
        let before = if line == 0 { last.character } else { 0 };
        last = range.start;
        let (token_type, token_modifiers_bitset) = kind(token.kind);
        Some(SemanticToken {
            delta_line: line,
            delta_start: range.start.character - before,
            length,
            token_type,
            token_modifiers_bitset,
        })
    });
    Some(SemanticTokens {
        result_id: None,
        data: data.collect(),
    })
}

/// Comments of the devices of each instruction.
pub(crate) fn hints(view: &View, params: &InlayHintParams) -> Option<Vec<InlayHint>> {
    let index = view.text_index()?;
    let instrs = index.instrs_in(view.span(whole_lines(params.range)));
    let hints = instrs.filter_map(|(i, instr)| {
        let comments = index.comments_at(i);
        (!comments.is_empty()).then(|| InlayHint {
            position: view.range(instr.span).end,
            label: Label::String(comments.join(" · ")),
            kind: None,
            text_edits: None,
            tooltip: None,
            padding_left: Some(true),
            padding_right: None,
            data: None,
        })
    });
    Some(hints.collect())
}
