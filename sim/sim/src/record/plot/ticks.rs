//! Scales that are divided as people divide them: by 1, 2 or 5 times a power of ten.

/// A scale and its ticks.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Ticks {
    /// Number of the first tick, counted from the one at 0.
    first: i64,
    /// Number of the last tick.
    last: i64,
    /// A step is `factor` times ten to the power of `exponent`.
    factor: i64,
    exponent: i32,
}

impl Ticks {
    /// About `count` ticks over a range, which they enclose but for a fiftieth of it at each end.
    pub(super) fn around(least: f64, greatest: f64, count: f64) -> Ticks {
        let (least, greatest) = match greatest - least > 0.0 {
            true => (least, greatest),
            // A value that does not change is in the middle.
            false => {
                let margin = if least == 0.0 {
                    1.0
                } else {
                    least.abs() / 10.0
                };
                (least - margin, greatest + margin)
            }
        };
        let rough = (greatest - least) / count;
        let mut exponent = rough.log10().floor() as i32;
        let factor = match rough / 10_f64.powi(exponent) {
            part if part <= 1.0 => 1,
            part if part <= 2.0 => 2,
            part if part <= 5.0 => 5,
            _ => {
                exponent += 1;
                1
            }
        };
        let step = factor as f64 * 10_f64.powi(exponent);
        let slack = (greatest - least) / 50.0;
        Ticks {
            first: ((least + slack) / step).floor() as i64,
            last: ((greatest - slack) / step).ceil() as i64,
            factor,
            exponent,
        }
    }

    fn value(&self, number: i64) -> f64 {
        let steps = (number * self.factor) as f64;
        // Divided rather than multiplied, so that 0.3 is 0.3.
        match self.exponent {
            0.. => steps * 10_f64.powi(self.exponent),
            _ => steps / 10_f64.powi(-self.exponent),
        }
    }

    /// The least value of the scale.
    pub(super) fn least(&self) -> f64 {
        self.value(self.first)
    }

    /// The greatest value of the scale.
    pub(super) fn greatest(&self) -> f64 {
        self.value(self.last)
    }

    /// Each tick and its label.
    pub(super) fn labels(self) -> impl Iterator<Item = (f64, String)> {
        let decimals = usize::try_from(-self.exponent).unwrap_or(0);
        (self.first..=self.last).map(move |number| {
            let value = self.value(number);
            (value, label(value, decimals))
        })
    }
}

/// A number with a true minus, its thousands set apart.
fn label(value: f64, decimals: usize) -> String {
    let plain = format!("{:.decimals$}", value.abs());
    let (whole, rest) = plain.split_at(plain.find('.').unwrap_or(plain.len()));
    let mut text = String::new();
    if value < 0.0 {
        text.push('\u{2212}');
    }
    for (i, digit) in whole.chars().enumerate() {
        if i > 0 && whole.len() > 4 && (whole.len() - i).is_multiple_of(3) {
            text.push('\u{2009}');
        }
        text.push(digit);
    }
    text + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(least: f64, greatest: f64) -> String {
        let ticks = Ticks::around(least, greatest, 5.0);
        let labels: Vec<_> = ticks.labels().map(|(_, label)| label).collect();
        labels
            .join(" ")
            .replace('\u{2009}', "'")
            .replace('\u{2212}', "-")
    }

    #[test]
    fn scales_have_round_numbers() {
        assert_eq!(labels(0.0, 100.0), "0 20 40 60 80 100");
        assert_eq!(labels(-3.0, 11.0), "-5 0 5 10 15");
        assert_eq!(labels(0.0, 1.3), "0.0 0.5 1.0 1.5");
        assert_eq!(
            labels(0.0, 48_000.0),
            "0 10'000 20'000 30'000 40'000 50'000"
        );
        assert_eq!(labels(7.0, 7.0), "6.0 6.5 7.0 7.5 8.0");
        assert_eq!(labels(-0.1, 140.9), "0 50 100 150");
        assert_eq!(labels(0.0, 0.0), "-1.0 -0.5 0.0 0.5 1.0");
        assert_eq!(labels(-32768.0, 32767.0), "-40'000 -20'000 0 20'000 40'000");
    }
}
