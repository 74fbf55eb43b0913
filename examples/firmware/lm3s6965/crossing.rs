//! The traffic light between the pins: what RTIC's task and Embassy's do every 10 ms.

use crate::board::{self, LAMPS};
use cortex_m_semihosting::{debug, hprintln};
use rungc_rt::{LastError, NoHal, Program};
use traffic_light::TrafficLight;

/// Milliseconds from one scan to the next.
pub const SCAN_MS: u32 = 10;

/// Under QEMU, the button is pressed automatically: it is on from 2.0 to 2.1 s. What the lamps do is printed, for 30 s.
const DEMO: bool = cfg!(feature = "demo");

/// The program, and what has been shown of it.
pub struct Crossing {
    plc: TrafficLight,
    lamps: [bool; LAMPS],
    error: LastError,
}

impl Crossing {
    /// Switches the PLC on.
    pub fn new() -> Self {
        let plc = TrafficLight::new();
        defmt::info!("{}", plc);
        Self {
            plc,
            lamps: [false; LAMPS],
            error: LastError::NONE,
        }
    }

    /// Reads the inputs, scans, writes the outputs that have changed, and reports a new error.
    pub fn scan(&mut self, now_ms: u32) {
        self.plc.x0 = if DEMO {
            (2000..2100).contains(&now_ms)
        } else {
            board::button()
        };
        self.plc.scan(&mut NoHal, now_ms, 0);
        for (lamp, shown) in self.lamps.iter_mut().enumerate() {
            let on = self.plc.output(lamp as u32);
            if on != *shown {
                *shown = on;
                board::set_lamp(lamp, on);
                if DEMO {
                    print(lamp, on, now_ms);
                }
            }
        }
        let error = self.plc.last_error();
        if error != self.error {
            self.error = error;
            defmt::error!("{}", self.plc);
        }
        if DEMO && now_ms >= 30_000 {
            debug::exit(debug::EXIT_SUCCESS);
        }
    }
}

fn print(lamp: usize, on: bool, now_ms: u32) {
    let state = if on { "on " } else { "off" };
    let (seconds, hundredths) = (now_ms / 1000, now_ms / 10 % 100);
    hprintln!("{:02}.{:02} s  Y{} {}", seconds, hundredths, lamp, state);
}
