//! Standard blocks: timers, counters, edges and flip-flops, in structured text. As in GX Works2, each instance has
//! its own subroutine.

use crate::ast::{Text, Unit};
use crate::parse;
use crate::token::{self, Lexeme, Token};

/// The timers are those of GX Works2: a timer of 100 ms, whose value is the time that has passed.
const BLOCKS: &str = include_str!("library.st");

const NAMES: [&str; 10] = [
    "TON", "TOF", "TP", "CTU", "CTD", "CTUD", "R_TRIG", "F_TRIG", "SR", "RS",
];

/// Adds the blocks that a text names and does not declare.
pub(crate) fn add(text: &mut Text, tokens: &[Lexeme]) {
    let is_named = |name: &str| {
        let mut words = tokens.iter().map(|lexeme| lexeme.token);
        words.any(|token| matches!(token, Token::Word(_)) && token.is(name))
    };
    let wanted: Vec<_> = NAMES.into_iter().filter(|name| is_named(name)).collect();
    if wanted.is_empty() {
        return;
    }
    let tokens = token::tokens(BLOCKS);
    for mut unit in parse::parse(&tokens, &mut Vec::new()).units {
        let is = |other: &str| unit.name.text.eq_ignore_ascii_case(other);
        let units = text.units.iter().map(|own: &Unit| &own.name);
        let structures = text.structures.iter().map(|own| &own.name);
        let is_declared = units.chain(structures).any(|own| is(&own.text));
        if wanted.iter().any(|name| is(name)) && !is_declared {
            unit.is_library = true;
            text.units.push(unit);
        }
    }
}
