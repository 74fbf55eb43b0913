//! Cells of matrices: `X`, `N`, `S` and `R`, perhaps with a time.

use crate::template::{Values, fill};
use rungc_host::duration;
use std::borrow::Cow;

/// Action of a cause on an effect.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Action {
    /// `X`, `N`: the effect acts as long as the cause is present.
    Follows,
    /// `S`: from the cause on, until it is reset.
    Stored,
    /// `R`: the cause resets the effect.
    Resets,
}

/// A cell that is not empty.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Cell {
    pub action: Action,
    /// Time in which the effect follows, as conditions write it; none: in the same scan.
    pub within: Option<String>,
}

/// A property, with conditions as text.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum Demand {
    Never(String),
    Whenever {
        when: String,
        then: String,
        within: String,
    },
    Stays {
        after: String,
        holds: String,
        until: String,
    },
}

/// Advice about a cell.
pub(super) const HELP: &str = "X or N: as long as the cause; S: stored until reset; R: resets; X, N and S perhaps with a time: `S 500ms`";

impl Cell {
    /// Reads a cell; `None` if it is empty.
    ///
    /// # Errors
    ///
    /// It holds something else.
    pub fn parse(text: &str) -> Result<Option<Cell>, String> {
        let wrong = || format!("`{text}` is not a cell of a matrix");
        let mut rest = text.trim().chars();
        let action = match rest.next() {
            None => return Ok(None),
            Some('-' | '–' | '—') if rest.as_str().is_empty() => return Ok(None),
            Some('x' | 'X' | '×' | 'n' | 'N') => Action::Follows,
            Some('s' | 'S') => Action::Stored,
            Some('r' | 'R') => Action::Resets,
            Some(_) => return Err(wrong()),
        };
        let rest = rest.as_str();
        let time = rest.trim_matches(|c: char| c.is_whitespace() || "/,;:()[]<=≤".contains(c));
        let is_glued = rest.starts_with(char::is_alphabetic);
        let cell = Cell {
            action,
            within: None,
        };
        match time {
            _ if is_glued => Err(wrong()),
            "" if rest.trim().is_empty() => Ok(Some(cell)),
            "" => Err(wrong()),
            _ if action == Action::Resets => Err("R takes no time".to_string()),
            _ => cell.with(Some(time)).map(Some),
        }
    }

    /// The cell with this time.
    ///
    /// # Errors
    ///
    /// The text is not a time.
    pub fn with(self, time: Option<&str>) -> Result<Cell, String> {
        let Some(time) = time else { return Ok(self) };
        // Decimal comma; `2 s`.
        let time: String = time.split_whitespace().collect();
        let time = time.replace(',', ".");
        duration::parse(&time)?;
        Ok(Cell {
            within: Some(time),
            ..self
        })
    }

    /// Its demands, each with the name of its violation.
    pub fn demands(&self, conditions: &Conditions) -> Vec<(&'static str, Demand)> {
        let text = |template| fill(template, conditions).unwrap_or_default();
        let until = match self.action {
            Action::Resets => return Vec::new(),
            Action::Follows => text("!{cause}"),
            Action::Stored => text("{reset} & !{cause}"),
        };
        let is_stored = self.action == Action::Stored;
        let ends = match is_stored {
            true => "effect not stored",
            false => "effect ends before its cause",
        };
        let Some(within) = &self.within else {
            let missing = Demand::Never(text("{cause} & !{effect}"));
            let mut demands = vec![("effect missing", missing)];
            if is_stored {
                let (after, holds) = (text("{cause}"), text("{effect}"));
                demands.push((
                    ends,
                    Demand::Stays {
                        after,
                        holds,
                        until,
                    },
                ));
            }
            return demands;
        };
        // A cause that goes away before its time is over needs no effect, unless that is stored.
        let then = match is_stored {
            true => text("{effect}"),
            false => text("{effect} | !{cause}"),
        };
        let late = Demand::Whenever {
            when: text("{cause}"),
            then,
            within: within.clone(),
        };
        let stays = Demand::Stays {
            after: text("{cause} & {effect}"),
            holds: text("{effect}"),
            until,
        };
        vec![("effect late", late), (ends, stays)]
    }
}

/// Conditions of a cell.
pub(super) struct Conditions<'c> {
    pub cause: &'c str,
    pub effect: &'c str,
    /// Any of those that reset the effect; empty if it has none.
    pub reset: String,
}

impl Values for Conditions<'_> {
    fn value(&self, name: &str) -> Option<Cow<'_, str>> {
        match name {
            "cause" => Some(self.cause.into()),
            "effect" => Some(self.effect.into()),
            "reset" => Some(self.reset.as_str().into()),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Action, Cell};

    #[test]
    fn cells_are_read() {
        let is = |text: &str, action, within: Option<&str>| {
            let within = within.map(str::to_string);
            assert_eq!(
                Cell::parse(text),
                Ok(Some(Cell { action, within })),
                "{text}"
            );
        };
        for text in ["X", "x", " N ", "×"] {
            is(text, Action::Follows, None);
        }
        for text in [
            "S 2s",
            "S2s",
            "S/2 s",
            "s (2s)",
            "S, 2s",
            "S <= 2s",
            "S ≤ 2 s",
        ] {
            is(text, Action::Stored, Some("2s"));
        }
        is("X 0,5s", Action::Follows, Some("0.5s"));
        is("N 500", Action::Follows, Some("500"));
        is("R", Action::Resets, None);
        for text in ["", " ", "-", "–"] {
            assert_eq!(Cell::parse(text), Ok(None), "{text}");
        }
        for text in [
            "T", "XS", "X soon", "R 2s", "X 2s 3", "X /", "1", "S 2h2", "Xx",
        ] {
            assert!(Cell::parse(text).is_err(), "{text}");
        }
    }
}
