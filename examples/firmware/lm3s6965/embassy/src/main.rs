//! The traffic light of `examples/programs` as a task of Embassy.

#![no_std]
#![no_main]

#[path = "../../board.rs"]
mod board;
mod clock;
#[path = "../../crossing.rs"]
mod crossing;

use cortex_m::Peripherals;
use crossing::{Crossing, SCAN_MS};
use defmt_rtt as _;
use embassy_executor::Spawner;
use embassy_time::{Duration, Instant, Ticker};
use lm3s6965 as _;
use panic_halt as _;

#[embassy_executor::main]
async fn main(_spawner: Spawner) {
    board::set_up();
    if let Some(mut core) = Peripherals::take() {
        clock::start(&mut core.SYST);
    }
    let mut crossing = Crossing::new();
    let mut ticks = Ticker::every(Duration::from_millis(SCAN_MS.into()));
    loop {
        crossing.scan(Instant::now().as_millis() as u32);
        ticks.next().await;
    }
}
