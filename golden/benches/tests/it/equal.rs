//! The programs are the ones that figures are known for, and all implementations of them do the same.

use rungc_benches::host::{self, Effort};
use rungc_benches::interp;
use rungc_benches::ladder::{Kind, Ladder};
use rungc_benches::tools;

/// FNV-1a.
fn hash(text: &str) -> u32 {
    let step = |hash: u32, byte: u8| (hash ^ u32::from(byte)).wrapping_mul(16_777_619);
    text.bytes().fold(2_166_136_261, step)
}

#[test]
fn programs_are_always_the_same() {
    // A change here makes all figures that were ever measured worthless.
    let seen = Kind::ALL.map(|kind| {
        let ladder = Ladder::new(kind, 5000);
        (ladder.steps, hash(&ladder.list()))
    });
    let known = [
        (5008, 515_626_344),
        (4962, 54_186_890),
        (5000, 1_592_193_184),
        (5002, 2_187_793_533),
        (5001, 3_622_877_931),
        (6153, 3_835_680_218),
        (5003, 2_546_029_299),
        (5000, 792_394_208),
        (5005, 3_660_959_614),
        (5004, 2_732_297_089),
        (5007, 3_118_640_370),
    ];
    assert_eq!(seen, known);
}

#[test]
fn implementations_do_the_same() {
    if !tools::is_there("gcc") {
        eprintln!("not run: there is no gcc");
        return;
    }
    let mut programs = Vec::from(Kind::ALL.map(|kind| (kind, 1000)));
    // Uses all timers.
    programs.push((Kind::Mixed, 20_000));
    if let Ok(only) = std::env::var("RUNGC_BENCH_KIND") {
        programs.retain(|(kind, _)| kind.name() == only);
        assert!(!programs.is_empty(), "no kind is called {only}");
    }
    for (kind, steps) in programs {
        let ladder = Ladder::new(kind, steps);
        // Checked only: not timed.
        let effort = Effort {
            rounds: 0,
            turn_us: 0,
            // What lanes of other kinds add to these does not warrant the time that compilers take for them.
            lanes: kind <= Kind::Control,
            rust: false,
        };
        let all = match host::time(&ladder, &["gcc"], effort) {
            Ok(all) => all,
            Err(problem) => panic!("{}: {problem}", kind.name()),
        };
        let interpreter = interp::checksum(&ladder, host::CHECKED_SCANS).unwrap();
        for timed in all {
            let sum = timed.result.unwrap().sum;
            assert_eq!(sum, interpreter, "{:?} of {}", timed.code, kind.name());
        }
    }
}
