//! Benchmarks of rungc: what it emits, beside the C that an engineer would write by hand, in the same run and with the
//! same compilers; how long compiling takes; how fast the interpreter is. `docs/src/benchmarks.md` describes the
//! method.
//!
//! No decision of the compiler may depend on this crate. Start reading at [`host`] and [`ladder`].

pub mod checks;
pub mod clock;
pub mod compile;
pub mod embedded;
pub mod figures;
pub mod host;
pub mod interp;
pub mod ladder;
pub mod page;
pub mod problem;
pub mod pulse_counts;
pub mod pulses;
pub mod random;
pub mod real;
pub mod subject;
pub mod suites;
pub mod table;
pub mod tools;
