//! Pulse outputs do not get slower on a microcontroller. Without the tools the test reports what is missing and that it
//! did not run; with `RUNGC_REQUIRE_EMBEDDED` set, as in CI, that is a failure.

use rungc_benches::problem::Problem;
use rungc_benches::pulse_counts;

/// Instructions that a tick and a call of the timer may take at most, with four outputs.
const MOST: [f64; 2] = [6600.0, 3000.0];

#[test]
fn a_tick_and_an_edge_take_few_instructions() {
    match pulse_counts::measure() {
        Ok(counts) => {
            for (count, most) in counts.into_iter().zip(MOST) {
                assert!(count.most <= most, "{counts:?}");
            }
        }
        Err(problem @ Problem::Missing(_)) => {
            let required = std::env::var_os("RUNGC_REQUIRE_EMBEDDED").is_some();
            assert!(!required, "{problem}");
            eprintln!("not run: {problem}");
        }
        Err(problem) => panic!("{problem}"),
    }
}
