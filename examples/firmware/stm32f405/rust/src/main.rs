//! The traffic light of `examples/programs` on an STM32F405.

#![no_std]
#![no_main]

mod board;

use board::LAMPS;
use cortex_m_rt::entry;
use cortex_m_semihosting::{debug, hprintln};
use panic_halt as _;
use rungc_rt::{NoHal, Program};
use traffic_light::TrafficLight;

const SCAN_MS: u32 = 10;

/// Under QEMU, the button is pressed automatically: it is on from 2.0 to 2.1 s. What the lamps do is printed, for 30 s.
const DEMO: bool = cfg!(feature = "demo");

fn button(now_ms: u32) -> bool {
    if DEMO {
        (2000..2100).contains(&now_ms)
    } else {
        board::button()
    }
}

fn set_lamp(lamp: usize, on: bool, now_ms: u32) {
    board::set_lamp(lamp, on);
    if DEMO {
        let state = if on { "on " } else { "off" };
        let (seconds, hundredths) = (now_ms / 1000, now_ms / 10 % 100);
        hprintln!("{:02}.{:02} s  Y{} {}", seconds, hundredths, lamp, state);
    }
}

#[entry]
fn main() -> ! {
    let mut plc = TrafficLight::new();
    let mut lamps = [false; LAMPS];
    let mut next: u32 = 0;

    if let Some(mut core) = cortex_m::Peripherals::take() {
        board::set_up(&mut core.SYST);
    }
    loop {
        let now = board::millis();
        if now.wrapping_sub(next) as i32 >= 0 {
            plc.x0 = button(now);
            plc.scan(&mut NoHal, now, 0);
            for (lamp, shown) in lamps.iter_mut().enumerate() {
                let on = plc.output(lamp as u32);
                if on != *shown {
                    *shown = on;
                    set_lamp(lamp, on, now);
                }
            }
            next = now.wrapping_add(SCAN_MS);
        }
        if DEMO && now >= 30_000 {
            debug::exit(debug::EXIT_SUCCESS);
        }
        cortex_m::asm::wfi();
    }
}
