//! Storms on all kinds of lines: `storm FRAMES [NAME…]`.

use rungc_fuzz::storm::tcp::{self, SERVERS};
use rungc_fuzz::{partner, storm};
use std::process::ExitCode;
use std::time::Instant;

fn main() -> ExitCode {
    let mut args = std::env::args().skip(1);
    let frames = args.next().and_then(|frames| frames.parse().ok());
    let Some(frames) = frames else {
        eprintln!("storm FRAMES [NAME…]");
        return ExitCode::from(2);
    };
    let names: Vec<_> = args.collect();
    for partner in partner::all() {
        if names.is_empty() || names.iter().any(|name| name == partner.name) {
            let begin = Instant::now();
            let outcome = storm::run(partner, frames, 1);
            println!(
                "{}: {outcome} ({:.1} s)",
                partner.name,
                begin.elapsed().as_secs_f64()
            );
        }
    }
    for server in &SERVERS {
        if names.is_empty() || names.iter().any(|name| name == server.name) {
            println!("{}: {}", server.name, tcp::run(server, frames, 1));
        }
    }
    ExitCode::SUCCESS
}
