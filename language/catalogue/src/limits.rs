//! Constants allowed for an operand.

/// The values of a constant.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Limits {
    /// Any that fits.
    None,
    /// From the first to the last.
    Between((i64, i64)),
    /// Those of one of these ranges, each from its first to its last, in ascending order.
    Among(&'static [(i64, i64)]),
}

impl Limits {
    /// The ranges, in ascending order; none where any value will do.
    pub fn ranges(&self) -> &[(i64, i64)] {
        match self {
            Limits::None => &[],
            Limits::Between(range) => std::slice::from_ref(range),
            Limits::Among(ranges) => ranges,
        }
    }

    /// Returns true if a value is allowed.
    pub fn allow(&self, value: i64) -> bool {
        let ranges = self.ranges();
        let in_one = |&(min, max): &(i64, i64)| (min..=max).contains(&value);
        ranges.is_empty() || ranges.iter().any(in_one)
    }

    /// The allowed value nearest to one.
    pub fn nearest(&self, value: i64) -> i64 {
        let within = |&(min, max): &(i64, i64)| value.clamp(min, max);
        let ranges = self.ranges().iter().map(within);
        ranges
            .min_by_key(|found| found.abs_diff(value))
            .unwrap_or(value)
    }

    /// In words, constants beginning with `prefix`: `K1 to K2, K21 to K22`.
    pub fn in_words(&self, prefix: &str) -> String {
        let range = |&(min, max): &(i64, i64)| match min == max {
            true => format!("{prefix}{min}"),
            false => format!("{prefix}{min} to {prefix}{max}"),
        };
        let ranges: Vec<_> = self.ranges().iter().map(range).collect();
        ranges.join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::Limits;

    #[test]
    fn a_set_of_ranges_allows_what_one_of_them_holds() {
        let channels = Limits::Among(&[(1, 2), (21, 22)]);
        let allowed: Vec<_> = (0..30).filter(|&value| channels.allow(value)).collect();
        assert_eq!(allowed, [1, 2, 21, 22]);
        assert_eq!(channels.in_words("K"), "K1 to K2, K21 to K22");
        assert_eq!(
            [0, 4, 15, 99].map(|value| channels.nearest(value)),
            [1, 2, 21, 22]
        );
        assert!(Limits::None.allow(7) && !Limits::Between((1, 1)).allow(0));
        assert_eq!(Limits::Between((1, 1)).in_words("K"), "K1");
    }
}
