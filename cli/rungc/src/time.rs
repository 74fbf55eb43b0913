//! Times on the command line: `200ms`, `5s`, `2min`; a bare number is milliseconds.

use rungc_host::duration;
pub use rungc_host::duration::parse;

/// Parses a time to wait for an answer: 10 ms to an hour.
pub fn parse_wait(text: &str) -> Result<u64, String> {
    duration::parse_within(text, 10..=3_600_000)
}
