//! The contact that MC puts into the left rail, as editors draw it: `N0═╪═ M100`.

use super::grid::is_device;

/// The contact of a master control.
pub(super) struct Master {
    pub nesting: String,
    pub device: String,
    /// Start and end in its line.
    pub at: usize,
    pub end: usize,
}

/// The contact of a master control that a line shows.
pub(super) fn find(line: &str) -> Option<Master> {
    let (before, after) = line.split_once(['╪', '╫', '┼', '+', '│', '|'])?;
    let is_bar = |c: char| "═=".contains(c);
    let nesting = before.trim_end().strip_suffix(is_bar)?;
    let nesting = nesting.trim_end_matches(is_bar).trim();
    let number = nesting.strip_prefix(['N', 'n'])?;
    let rest = after.trim_start().strip_prefix(is_bar)?;
    let rest = rest.trim_start_matches(is_bar);
    let device = rest.split_whitespace().next()?;
    let digits = !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit());
    (digits && is_device(device)).then(|| Master {
        nesting: nesting.to_uppercase(),
        device: device.to_uppercase(),
        at: line.len() - line.trim_start().len(),
        end: line.len() - rest.trim_start().len() + device.len(),
    })
}
