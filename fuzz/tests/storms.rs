//! A short storm on each kind of line; `cargo run --release -p rungc-fuzz --bin storm 1000000` runs long ones.

use rungc_fuzz::storm::tcp::{self, SERVERS};
use rungc_fuzz::{partner, storm};

#[test]
fn no_good_frame_is_lost_among_bad_ones() {
    for partner in partner::all() {
        let outcome = storm::run(partner, 1000, 7);
        assert!(outcome.bad > 50, "{}: {outcome}", partner.name);
    }
}

#[test]
fn bad_connections_do_not_disturb_a_good_one() {
    for server in &SERVERS {
        let outcome = tcp::run(server, 5000, 7);
        assert!(outcome.bad > 250, "{}: {outcome}", server.name);
    }
}
