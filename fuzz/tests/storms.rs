//! A short storm on each kind of line; `cargo run --release -p rungc-fuzz --bin storm 1000000` runs long ones.

use rungc_fuzz::{partner, storm};

#[test]
fn no_good_frame_is_lost_among_bad_ones() {
    for partner in partner::all() {
        let outcome = storm::run(partner, 1000, 7);
        assert!(outcome.bad > 50, "{}: {outcome}", partner.name);
    }
}
