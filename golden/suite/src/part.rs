//! The part of the long suites that a run takes.
//!
//! `RUNGC_TEST_PART` names a run, usually by the commit that is tested. A run with a name takes a part of the suites
//! that take longest, another one for most names; a run without a name takes all of them.

use crate::rng::Rng;
use std::fmt;

const VARIABLE: &str = "RUNGC_TEST_PART";

/// A number that follows from a text and looks random.
fn mixed(text: &str) -> u64 {
    // FNV-1a.
    let step = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3);
    Rng::new(text.bytes().fold(0xCBF2_9CE4_8422_2325, step)).bits()
}

/// A part of the cases of a suite.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// One case in this many.
    of: u64,
    /// Name of the run.
    run: String,
}

impl Part {
    /// All cases.
    pub const ALL: Part = Part {
        of: 1,
        run: String::new(),
    };

    /// One case in this many, or all where the environment does not name the run.
    pub fn one_in(of: u64) -> Self {
        match std::env::var(VARIABLE) {
            Ok(run) if !run.is_empty() => Part { of, run },
            _ => Part::ALL,
        }
    }

    /// Returns true for the whole suite.
    pub fn is_all(&self) -> bool {
        self.of == 1
    }

    /// Returns true for the cases of the part, by their names.
    pub fn contains(&self, case: &str) -> bool {
        mixed(case) % self.of == mixed(&self.run) % self.of
    }

    /// Seed of the run's random programs; 1 for the whole suite.
    pub fn seed(&self) -> u64 {
        match self.is_all() {
            true => 1,
            false => mixed(&self.run) >> 32,
        }
    }
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.is_all() {
            true => f.write_str("all cases"),
            false => write!(f, "1/{} of the cases, by {VARIABLE}={}", self.of, self.run),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Part;

    fn sizes(of: u64) -> Vec<usize> {
        let cases: Vec<String> = (0..4000).map(|n| format!("a file: case {n}")).collect();
        let parts = (0..20).map(|run| Part {
            of,
            run: format!("{run:08x}"),
        });
        let size = |part: Part| cases.iter().filter(|case| part.contains(case)).count();
        parts.map(size).collect()
    }

    #[test]
    fn parts_are_of_the_size_that_was_asked_for() {
        assert!(sizes(1).iter().all(|&size| size == 4000));
        assert!(sizes(8).iter().all(|size| (400..600).contains(size)));
    }

    #[test]
    fn every_case_is_in_one_part() {
        let parts: Vec<Part> = (0..200)
            .map(|run| Part {
                of: 4,
                run: run.to_string(),
            })
            .collect();
        for case in ["ADD", "a file: MOV with an index", ""] {
            let takes = parts.iter().filter(|part| part.contains(case)).count();
            assert!((20..90).contains(&takes), "{case}: {takes} of 200 runs");
        }
    }
}
