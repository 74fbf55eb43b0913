//! The rungc command line.
fn main() {}
