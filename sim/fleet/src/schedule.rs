//! Selection of the PLCs that a setting reaches in a span of time.

use crate::At;

/// A setting of all PLCs of a group, each at its own time.
#[derive(Clone, PartialEq, Debug)]
pub struct Setting {
    /// Time at which the first PLC is set, in milliseconds since power-on.
    pub at_ms: u64,
    /// Devices to set, and their values.
    pub parts: Vec<(At, i32)>,
}

/// The settings of a group.
#[derive(Clone, PartialEq, Default, Debug)]
pub struct Schedule {
    /// The settings.
    pub settings: Vec<Setting>,
    /// Delay from a PLC to the next one, in milliseconds.
    pub spread_ms: u64,
    /// After how many milliseconds all begins again.
    pub repeat_ms: Option<u64>,
}

impl Schedule {
    /// Calls `set` with each PLC of `count` and each setting whose time is after `after_ms`, if that is given, and not
    /// after `now_ms`; of one PLC in the order of the times.
    pub fn due(
        &self,
        count: u32,
        after_ms: Option<u64>,
        now_ms: u64,
        set: &mut dyn FnMut(u32, &Setting),
    ) {
        let mut found: Vec<(u64, u32, &Setting)> = Vec::new();
        for setting in &self.settings {
            self.due_of(setting, count, after_ms, now_ms, &mut found);
        }
        found.sort_by_key(|&(at_ms, plc, _)| (at_ms, plc));
        for (_, plc, setting) in found {
            set(plc, setting);
        }
    }

    fn due_of<'s>(
        &self,
        setting: &'s Setting,
        count: u32,
        after_ms: Option<u64>,
        now_ms: u64,
        found: &mut Vec<(u64, u32, &'s Setting)>,
    ) {
        let Some(last) = u64::from(count).checked_sub(1) else {
            return;
        };
        // The rounds in which a PLC may be due: the last one first comes to its turn, then the first one.
        let from_ms = after_ms.map_or(0, |after_ms| after_ms + 1);
        let rounds = match self.repeat_ms.filter(|&every| every > 0) {
            None => 0..=0,
            Some(every) => {
                let slowest = setting.at_ms + last * self.spread_ms;
                let Some(past) = now_ms.checked_sub(setting.at_ms) else {
                    return;
                };
                from_ms.saturating_sub(slowest) / every..=past / every
            }
        };
        for round in rounds {
            let begin = setting.at_ms + round * self.repeat_ms.unwrap_or(0);
            let Some(past) = now_ms.checked_sub(begin) else {
                break;
            };
            let (first, end) = match self.spread_ms {
                0 if begin >= from_ms => (0, last),
                0 => continue,
                spread => (
                    from_ms.saturating_sub(begin).div_ceil(spread),
                    (past / spread).min(last),
                ),
            };
            found.extend((first..=end).map(|n| (begin + n * self.spread_ms, n as u32, setting)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rungc_rt::Class;

    /// PLCs and values that are set after each millisecond, all spans compared with each time alone.
    fn all(schedule: &Schedule, count: u32, step: u64, until: u64) -> Vec<(u32, i32)> {
        let mut seen = Vec::new();
        let mut after = None;
        for now in (0..=until).step_by(step as usize) {
            schedule.due(count, after, now, &mut |plc, setting| {
                seen.push((plc, setting.parts[0].1));
            });
            after = Some(now);
        }
        seen
    }

    #[test]
    fn every_setting_is_due_once_a_round() {
        let at = |at_ms, value| Setting {
            at_ms,
            parts: vec![(At::bit(Class::X, 0), value)],
        };
        for (spread_ms, repeat_ms) in [
            (0, None),
            (3, None),
            (0, Some(20)),
            (3, Some(20)),
            (7, Some(10)),
        ] {
            let schedule = Schedule {
                settings: vec![at(0, 1), at(5, 0), at(30, 2)],
                spread_ms,
                repeat_ms,
            };
            let mut expected = Vec::new();
            for ms in 0..=120 {
                for plc in 0..4 {
                    for setting in &schedule.settings {
                        let begin = setting.at_ms + u64::from(plc) * spread_ms;
                        let past = ms >= begin
                            && repeat_ms.map_or(ms == begin, |every| (ms - begin) % every == 0);
                        if past {
                            expected.push((plc, setting.parts[0].1));
                        }
                    }
                }
            }
            for step in [1, 4, 10, 40] {
                let mut seen = all(&schedule, 4, step, 120);
                let mut expected = expected.clone();
                seen.sort_unstable();
                expected.sort_unstable();
                assert_eq!(seen, expected, "{spread_ms} {repeat_ms:?} {step}");
            }
        }
    }
}
