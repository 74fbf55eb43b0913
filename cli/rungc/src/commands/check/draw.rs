//! `--draw`: the networks that diagnostics are about.

use rungc_analysis::resolve::resolve;
use rungc_ladder::build;
use rungc_ladder::text::{Style, draw_marked};
use rungc_models::Model;
use rungc_syntax::{Diagnostic, Program};
use terminal_size::{Width, terminal_size};

/// Characters on a line where nothing says how many there are.
const USUAL_WIDTH: u16 = 100;

/// For each diagnostic the network that holds its place, drawn; an empty text if none does.
pub fn networks(
    program: &Program,
    model: &'static Model,
    diagnostics: &[Diagnostic],
) -> Vec<String> {
    let (resolved, _) = resolve(program, model);
    let ladder = build::ladder(&resolved);
    let terminal = terminal_size().map(|(Width(width), _)| width);
    let style = Style {
        width: terminal.unwrap_or(USUAL_WIDTH).into(),
        comments: false,
    };
    let drawn = diagnostics.iter().map(|diagnostic| {
        let place = diagnostic.span.start;
        let after = program
            .instrs
            .partition_point(|instr| instr.span.start <= place);
        let at = after.checked_sub(1)?;
        // A place between instructions, as of a line that cannot be read, is in no network.
        if program.instrs[at].span.end < place || diagnostic.span.range().is_empty() {
            return None;
        }
        let number = ladder.position(at);
        let network = ladder.networks.get(number)?;
        Some(draw_marked(&resolved, (number + 1, network), style, at))
    });
    drawn.map(Option::unwrap_or_default).collect()
}
