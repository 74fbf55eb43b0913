//! A short storm on each kind of line; `RUNGC_STORM_FRAMES=1000000` makes it as long as that, and so does
//! `cargo run --release -p rungc-fuzz --bin storm 1000000` for one kind or all.

use rungc_fuzz::storm::tcp::{self, SERVERS};
use rungc_fuzz::{partner, storm};

/// Number of frames of a storm that usually has this many.
fn frames(usual: usize) -> usize {
    let wanted = std::env::var("RUNGC_STORM_FRAMES").ok();
    wanted.map_or(usual, |text| {
        text.parse().expect("RUNGC_STORM_FRAMES is a number")
    })
}

#[test]
fn no_good_frame_is_lost_among_bad_ones() {
    for partner in partner::all() {
        let outcome = storm::run(partner, frames(1000), 7);
        assert!(
            outcome.bad > outcome.frames / 20,
            "{}: {outcome}",
            partner.name
        );
        println!("{}: {outcome}", partner.name);
    }
}

#[test]
fn bad_connections_do_not_disturb_a_good_one() {
    for server in &SERVERS {
        let outcome = tcp::run(server, frames(5000), 7);
        assert!(
            outcome.bad > outcome.frames / 20,
            "{}: {outcome}",
            server.name
        );
        println!("{}: {outcome}", server.name);
    }
}
