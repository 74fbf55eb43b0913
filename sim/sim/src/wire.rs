//! Signals at input terminals during a step: pulses and encoders, as edges in virtual time.

/// A change of an input terminal.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub struct Change {
    /// Microseconds after the first scan of the step.
    pub at_us: u64,
    /// Terminal X, a plain number.
    pub input: u32,
    /// True if it turns on.
    pub on: bool,
}

/// Something that gives edges.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Signal {
    /// `count` pulses at one terminal.
    Pulses {
        /// Terminal.
        input: u32,
        /// Number of devices.
        count: u32,
        /// Frequency in hertz.
        hz: f64,
    },
    /// A quadrature encoder.
    Encoder {
        /// Terminal that leads when it turns forward.
        a: u32,
        /// The other terminal.
        b: u32,
        /// Cycles; negative: backward.
        count: i32,
        /// Cycles a second.
        hz: f64,
    },
}

impl Signal {
    /// Its changes, in order. The first one comes an eighth of a period after the step's first scan, so that none falls
    /// together with a scan of a slower signal.
    fn changes(self) -> Vec<Change> {
        let at = |hz: f64, cycle: u32, part: f64| {
            let periods = f64::from(cycle) + part + 0.125;
            (periods * 1_000_000.0 / hz) as u64
        };
        let mut changes = Vec::new();
        let mut push = |at_us, input, on| changes.push(Change { at_us, input, on });
        match self {
            Signal::Pulses { input, count, hz } => {
                for cycle in 0..count {
                    push(at(hz, cycle, 0.0), input, true);
                    push(at(hz, cycle, 0.5), input, false);
                }
            }
            Signal::Encoder { a, b, count, hz } => {
                let (leads, follows) = if count < 0 { (b, a) } else { (a, b) };
                for cycle in 0..count.unsigned_abs() {
                    push(at(hz, cycle, 0.0), leads, true);
                    push(at(hz, cycle, 0.25), follows, true);
                    push(at(hz, cycle, 0.5), leads, false);
                    push(at(hz, cycle, 0.75), follows, false);
                }
            }
        }
        changes
    }

    /// Duration in microseconds.
    pub(crate) fn duration_us(self) -> u64 {
        let (count, hz) = match self {
            Signal::Pulses { count, hz, .. } => (count, hz),
            Signal::Encoder { count, hz, .. } => (count.unsigned_abs(), hz),
        };
        (f64::from(count) * 1_000_000.0 / hz) as u64
    }
}

/// The changes of all signals, in order.
pub fn changes(signals: &[Signal]) -> Vec<Change> {
    let mut changes: Vec<Change> = signals.iter().flat_map(|signal| signal.changes()).collect();
    changes.sort();
    changes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_encoder_turning_back_begins_with_b() {
        let signal = Signal::Encoder {
            a: 0,
            b: 1,
            count: -2,
            hz: 1000.0,
        };
        let edges: Vec<_> = changes(&[signal])
            .iter()
            .map(|c| (c.at_us, c.input, c.on))
            .collect();
        assert_eq!(
            edges[..5],
            [
                (125, 1, true),
                (375, 0, true),
                (625, 1, false),
                (875, 0, false),
                (1125, 1, true)
            ]
        );
        assert_eq!((edges.len(), signal.duration_us()), (8, 2000));
    }
}
