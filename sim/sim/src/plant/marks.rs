//! Positions at which an axis switches an input.

use super::Moment;

/// Sections of the way where an input is on. They alternate with sections where it is off; all are numbered in order,
/// so an axis that moves from one number to another passes those between.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Marks {
    /// From here to there, both included.
    Range { from: f64, to: f64 },
    /// `width` long, beginning at `offset` and again after each `every`.
    Periodic { offset: f64, width: f64, every: f64 },
}

impl Marks {
    /// Number of the section that holds this position. It never goes down when the position goes up.
    fn index(self, at: f64) -> i64 {
        match self {
            Marks::Range { from, to } => i64::from(at >= from) + i64::from(at > to),
            Marks::Periodic {
                offset,
                width,
                every,
            } => {
                let period = ((at - offset) / every).floor();
                let within = at - offset - period * every;
                2 * period as i64 + i64::from(within >= width)
            }
        }
    }

    /// Numbers of the first and the last section.
    fn sections(self) -> (i64, i64) {
        match self {
            Marks::Range { .. } => (0, 2),
            Marks::Periodic { .. } => (i64::MIN, i64::MAX),
        }
    }

    /// Returns true if the input is on there.
    fn is_on(self, index: i64) -> bool {
        match self {
            Marks::Range { .. } => index == 1,
            Marks::Periodic { .. } => index % 2 == 0,
        }
    }

    /// Start of a section.
    fn begin(self, index: i64) -> f64 {
        match self {
            Marks::Range { from, to } => {
                if index == 1 {
                    from
                } else {
                    to
                }
            }
            Marks::Periodic {
                offset,
                width,
                every,
            } => {
                let inside = if index % 2 == 0 { 0.0 } else { width };
                offset + index.div_euclid(2) as f64 * every + inside
            }
        }
    }
}

/// A switch or a line of an encoder.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Switch {
    pub(super) input: u32,
    pub(super) marks: Marks,
}

impl Switch {
    /// Returns true if it is on at this position.
    pub(super) fn is_on(&self, at: f64) -> bool {
        self.marks.is_on(self.marks.index(at))
    }

    /// Distance that an axis can go from this position, either way, before it changes, or less.
    pub(super) fn room(&self, at: f64) -> f64 {
        let index = self.marks.index(at);
        let (first, last) = self.marks.sections();
        let below = (index > first).then(|| at - self.marks.begin(index));
        let above = (index < last).then(|| self.marks.begin(index + 1) - at);
        let borders = [below, above].into_iter().flatten();
        borders.fold(f64::INFINITY, f64::min)
    }

    /// Adds its changes on the way from one position to another; the axis goes `speed` in the millisecond.
    pub(super) fn pass(&self, from: f64, to: f64, speed: f64, moments: &mut Vec<Moment>) {
        let (begin, end) = (self.marks.index(from), self.marks.index(to));
        let mut enter = |index: i64, border: f64| {
            let part = ((border - from) / speed).clamp(0.0, 1.0);
            moments.push((part, self.input, self.marks.is_on(index)));
        };
        for index in begin + 1..=end {
            enter(index, self.marks.begin(index));
        }
        for index in (end..begin).rev() {
            enter(index, self.marks.begin(index + 1));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn passed(marks: Marks, from: f64, to: f64) -> Vec<Moment> {
        let mut moments = Vec::new();
        Switch { input: 0, marks }.pass(from, to, to - from, &mut moments);
        moments
    }

    #[test]
    fn a_switch_that_is_passed_within_a_millisecond_is_seen() {
        let marks = Marks::Range {
            from: 10.0,
            to: 20.0,
        };
        let there = [(0.25, 0, true), (0.5, 0, false)];
        assert_eq!(passed(marks, 0.0, 40.0), there);
        let back = [(0.5, 0, true), (0.75, 0, false)];
        assert_eq!(passed(marks, 40.0, 0.0), back);
        assert_eq!(passed(marks, 10.0, 20.0), []);
        assert_eq!(passed(marks, 21.0, 20.0).len(), 1);
    }

    #[test]
    fn nothing_changes_within_the_room() {
        let range = Marks::Range {
            from: 10.0,
            to: 20.0,
        };
        let periodic = Marks::Periodic {
            offset: 0.25,
            width: 0.5,
            every: 1.0,
        };
        for (marks, at, room) in [
            (range, 3.0, 7.0),
            (range, 12.5, 2.5),
            (range, 26.0, 6.0),
            (periodic, 0.5, 0.25),
            (periodic, -7.0, 0.25),
        ] {
            let switch = Switch { input: 0, marks };
            assert_eq!(switch.room(at), room, "{marks:?} {at}");
            for to in [at - 0.99 * room, at + 0.99 * room] {
                assert_eq!(passed(marks, at, to), [], "{marks:?} {at}");
            }
        }
    }

    #[test]
    fn an_encoder_line_has_an_edge_each_half_cycle_both_ways() {
        let marks = Marks::Periodic {
            offset: 0.25,
            width: 0.5,
            every: 1.0,
        };
        for (from, to) in [(0.0, 3.0), (-3.0, 0.0), (-1.0, 2.0)] {
            let there = passed(marks, from, to);
            let back = passed(marks, to, from);
            assert_eq!((there.len(), back.len()), (6, 6), "{from} {to}");
            assert!(there[0].2 && back[0].2, "{from} {to}");
            assert!(there.is_sorted_by(|a, b| a.0 < b.0 && a.2 != b.2));
        }
    }
}
