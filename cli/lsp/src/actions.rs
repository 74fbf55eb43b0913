//! Fixes of findings.

use crate::publish::Places;
use gen_lsp_types::{
    CodeAction, CodeActionKind, CodeActionParams, CodeActionResponse, Range, TextEdit,
    WorkspaceEdit,
};
use rungc::{Diagnostic, Proposal};
use std::collections::HashMap;

/// The fixes of the findings at a range, and one that applies all that are safe. They are those of instruction lists,
/// in which all places are bytes of the text.
pub(crate) fn actions(
    places: &Places,
    findings: &[Diagnostic],
    params: &CodeActionParams,
) -> Vec<CodeActionResponse> {
    let is_wanted = |kind: CodeActionKind| match &params.context.only {
        Some(kinds) => kinds.iter().any(|wanted| includes(wanted, kind.clone())),
        None => true,
    };
    let mut actions = Vec::new();
    if is_wanted(CodeActionKind::QuickFix) {
        let fixes = findings.iter().filter_map(|finding| {
            let shown = places.diagnostic(finding);
            let fix = finding.fix.as_ref()?;
            meets(shown.range, params.range).then(|| CodeAction {
                diagnostics: Some(vec![shown]),
                is_preferred: Some(fix.certain),
                ..action(
                    places,
                    &fix.title,
                    CodeActionKind::QuickFix,
                    edits(places, fix),
                )
            })
        });
        actions.extend(fixes);
    }
    if is_wanted(CodeActionKind::SourceFixAll) {
        let edits = all_safe(places, findings);
        if !edits.is_empty() {
            let kind = CodeActionKind::SourceFixAll;
            actions.push(action(places, "apply all safe fixes", kind, edits));
        }
    }
    actions.into_iter().map(CodeActionResponse::from).collect()
}

/// Returns true if a kind is another one or a part of it, as `source.fixAll` is of `source`.
fn includes(whole: &CodeActionKind, kind: CodeActionKind) -> bool {
    let (whole, kind) = (String::from(whole.clone()), String::from(kind));
    let rest = kind.strip_prefix(&whole);
    rest.is_some_and(|rest| whole.is_empty() || rest.is_empty() || rest.starts_with('.'))
}

/// Edits of a fix.
fn edits(places: &Places, fix: &Proposal) -> Vec<TextEdit> {
    let edit = |edit: &rungc::Replacement| TextEdit {
        range: places.range(edit.location.as_ref()),
        new_text: edit.text.clone(),
    };
    fix.edits.iter().map(edit).collect()
}

/// Edits of the fixes that may be applied unseen; one that touches what another changes is left out.
fn all_safe(places: &Places, findings: &[Diagnostic]) -> Vec<TextEdit> {
    let fixes = findings.iter().filter_map(|finding| finding.fix.as_ref());
    let fixes = fixes
        .filter(|fix| fix.certain)
        .map(|fix| edits(places, fix));
    let reach = |edits: &[TextEdit]| {
        let ranges = edits.iter().map(|edit| (edit.range.start, edit.range.end));
        ranges.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
    };
    let mut fixes: Vec<_> = fixes.filter_map(|fix| Some((reach(&fix)?, fix))).collect();
    fixes.sort_by_key(|(reach, _)| *reach);
    let mut all = Vec::new();
    let mut taken = None;
    for ((start, end), edits) in fixes {
        if taken.is_none_or(|taken| taken < start) {
            taken = Some(end);
            all.extend(edits);
        }
    }
    all
}

/// Returns true if two ranges overlap or touch.
fn meets(a: Range, b: Range) -> bool {
    a.start <= b.end && b.start <= a.end
}

fn action(places: &Places, title: &str, kind: CodeActionKind, edits: Vec<TextEdit>) -> CodeAction {
    let changes = HashMap::from([(places.uri.clone(), edits)]);
    CodeAction {
        title: title.to_owned(),
        kind: Some(kind),
        edit: Some(WorkspaceEdit {
            changes: Some(changes),
            ..WorkspaceEdit::default()
        }),
        ..CodeAction::default()
    }
}
