/// The signal, in millionths of its unit, that a count stands for.
#[allow(dead_code, reason = "boards have inputs, outputs or both")]
fn signal_of(count: u32, [low, high]: [i32; 2], full: i64) -> i32 {
    low + (i64::from(high - low) * i64::from(count) / full) as i32
}

/// The count of a converter for a signal.
#[allow(dead_code, reason = "boards have inputs, outputs or both")]
fn count_of(signal: i32, [low, high]: [i32; 2], full: i64) -> u32 {
    let above = i64::from(signal.clamp(low, high) - low);
    let range = i64::from(high - low);
    ((above * full + range / 2) / range) as u32
}

impl Pins {
    /// Between scans: what the pins measure goes to the modules, what the modules put out to the pins.
    fn exchange(&mut self) {
        let now_us = MICROSECONDS.load(Ordering::Relaxed);
/* TAKE */
        for module in &mut self.modules {
            module.pass(now_us.wrapping_sub(self.exchanged_us));
        }
        self.exchanged_us = now_us;
/* GIVE */
    }

    fn module(&mut self, unit: u16) -> Option<&mut Module> {
        let place = match unit {
/* UNITS */
            _ => None,
        }?;
        self.modules.get_mut(place)
    }
}

