//! The traffic light of `examples/programs` as a task of RTIC.

#![no_std]
#![no_main]

#[path = "../../board.rs"]
mod board;
#[path = "../../crossing.rs"]
mod crossing;

use defmt_rtt as _;
use panic_halt as _;
use rtic_monotonics::systick::prelude::*;

systick_monotonic!(Clock, 1_000);

#[rtic::app(device = lm3s6965, dispatchers = [GPIOA])]
mod app {
    use super::*;
    use crossing::{Crossing, SCAN_MS};

    #[shared]
    struct Shared {}

    #[local]
    struct Local {
        crossing: Crossing,
    }

    #[init]
    fn init(cx: init::Context) -> (Shared, Local) {
        board::set_up();
        Clock::start(cx.core.SYST, board::CPU_HZ);
        if scan::spawn().is_err() {
            defmt::panic!("the task runs already");
        }
        let crossing = Crossing::new();
        (Shared {}, Local { crossing })
    }

    #[task(local = [crossing], priority = 1)]
    async fn scan(cx: scan::Context) {
        let mut next = Clock::now();
        loop {
            cx.local.crossing.scan(Clock::now().ticks());
            next += SCAN_MS.millis();
            Clock::delay_until(next).await;
        }
    }
}
