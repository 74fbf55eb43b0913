//! The real-time clock and times of day: FNC 160–169, h1u-h2u-programming §4.3.12 and §8.9.
//!
//! A time of day is three words: hour, minute, second.

use super::float::{one_of_three, zone};
use crate::cx::Cx;
use crate::fault::{Done, Fault};
use crate::hal::Clock;
use crate::special::{
    D_SECOND, D_WEEKDAY, M_BORROW, M_CARRY, M_CLOCK_ADJUST, M_CLOCK_ERROR, M_CLOCK_FITTED,
    M_CLOCK_HOLD, M_CLOCK_STOP, M_ZERO, Register,
};

/// Seconds of a day.
const DAY: i32 = 86_400;

/// Years of the clock where it shows four digits.
const YEARS: core::ops::RangeInclusive<i16> = 2000..=2099;

/// Value of D8018 with which a program chooses four digits where the year has two (FX1S/FX1N/FX2N programming manual II
/// §5.13).
const FOUR_DIGITS: i16 = 2000;

/// D8018, the year.
const D_YEAR: Register = D_SECOND.after(5);

/// D8018…D8013 and D8019, in TRD's order.
const REGISTERS: [Register; 7] = [
    D_YEAR,
    D_SECOND.after(4),
    D_SECOND.after(3),
    D_SECOND.after(2),
    D_SECOND.after(1),
    D_SECOND,
    D_WEEKDAY,
];

/// The three words from operand `i` on.
fn triple(cx: &Cx, i: usize) -> Result<(i16, i16, i16), Fault> {
    Ok((cx.word(i, 0)?, cx.word(i, 1)?, cx.word(i, 2)?))
}

/// Seconds of the time of day at operand `i`.
fn seconds(cx: &Cx, i: usize) -> Result<i32, Fault> {
    match triple(cx, i)? {
        (h @ 0..=23, m @ 0..=59, s @ 0..=59) => {
            Ok((i32::from(h) * 60 + i32::from(m)) * 60 + i32::from(s))
        }
        _ => Err(Fault::VALUE),
    }
}

/// Writes hours, minutes and seconds to operand `i`.
fn set_triple(cx: &mut Cx, i: usize, seconds: i32) -> Done {
    cx.check_words(i, 3)?;
    cx.set_word(i, 0, (seconds / 3600) as i16)?;
    cx.set_word(i, 1, (seconds / 60 % 60) as i16)?;
    cx.set_word(i, 2, (seconds % 60) as i16)
}

/// TCMP S1 S2 S3 S D (FNC 160): D, D+1 or D+2 is on as the time S1:S2:S3 is after, equal to or before the time S.
pub fn tcmp(cx: &mut Cx) -> Done {
    let set = (cx.word(0, 0)?, cx.word(1, 0)?, cx.word(2, 0)?);
    let time = triple(cx, 3)?;
    one_of_three(cx, 4, zone(time, set, set))
}

/// TZCP S1 S2 S D (FNC 161): D, D+1 or D+2 is on as the time S is before, inside or after the zone from S1 to S2.
pub fn tzcp(cx: &mut Cx) -> Done {
    let (low, high, time) = (triple(cx, 0)?, triple(cx, 1)?, triple(cx, 2)?);
    one_of_three(cx, 3, zone(time, low, high))
}

/// TADD S1 S2 D (FNC 162): sum of times; from 24 hours on M8022 is on and a day is taken off. M8020 signals 0:00:00.
pub fn tadd(cx: &mut Cx) -> Done {
    let sum = seconds(cx, 0)? + seconds(cx, 1)?;
    set_triple(cx, 2, sum % DAY)?;
    cx.set_special(M_ZERO, sum % DAY == 0);
    cx.set_special(M_CARRY, sum >= DAY);
    Ok(())
}

/// TSUB S1 S2 D (FNC 163): difference of times; below 0 M8021 is on and a day is added. M8020 signals 0:00:00.
pub fn tsub(cx: &mut Cx) -> Done {
    let difference = seconds(cx, 0)? - seconds(cx, 1)?;
    set_triple(cx, 2, difference.rem_euclid(DAY))?;
    cx.set_special(M_ZERO, difference == 0);
    cx.set_special(M_BORROW, difference < 0);
    Ok(())
}

/// HTOS S D (FNC 164): seconds of the hours, minutes and seconds at S; an error if D cannot hold them.
pub fn htos(cx: &mut Cx) -> Done {
    let seconds = match triple(cx, 0)? {
        (h @ 0.., m @ 0..=59, s @ 0..=59) => i32::from(h) * 3600 + i32::from(m) * 60 + i32::from(s),
        _ => return Err(Fault::VALUE),
    };
    if !cx.wide() && seconds > i16::MAX.into() {
        return Err(Fault::VALUE);
    }
    cx.write(1, seconds)
}

/// STOH S D (FNC 165): hours, minutes and seconds of S seconds; S at most 32767 hours.
pub fn stoh(cx: &mut Cx) -> Done {
    let seconds = cx.count(0, 0..=32_767 * 3600 + 3599)?;
    set_triple(cx, 1, seconds)
}

/// Values of the registers while M8015 stops the clock.
fn stopped(cx: &Cx) -> Option<[i16; 7]> {
    cx.special(M_CLOCK_STOP)
        .then(|| shown(cx))
        .filter(|words| *words != [0; 7])
}

/// Writes year, month, day, hour, minute, second, weekday.
fn read_clock(cx: &mut Cx, year: fn(u16) -> u16) -> Done {
    if let Some(held) = stopped(cx) {
        cx.check_words(0, 7)?;
        return (0..)
            .zip(held)
            .try_for_each(|(offset, word)| cx.set_word(0, offset, word));
    }
    let clock = cx.hal().clock().ok_or(Fault::DEVICE)?;
    cx.check_words(0, 7)?;
    cx.set_word(0, 0, year(clock.year) as i16)?;
    let fields = [
        clock.month,
        clock.day,
        clock.hour,
        clock.minute,
        clock.second,
        clock.weekday,
    ];
    (1..)
        .zip(fields)
        .try_for_each(|(offset, field)| cx.set_word(0, offset, field.into()))
}

/// A year as it is.
fn long_year(year: u16) -> u16 {
    year
}

/// The last two digits of a year.
fn short_year(year: u16) -> u16 {
    year % 100
}

/// TRD D (FNC 166): the clock goes to seven words: year, month, day, hour, minute, second, weekday from Sunday = 0.
pub fn trd(cx: &mut Cx) -> Done {
    read_clock(cx, long_year)
}

/// TRD where the year has two digits (L01S, FX), unless D8018 shows four.
pub fn trd_short(cx: &mut Cx) -> Done {
    let shows_four = cx.special_word(D_YEAR) > 99;
    read_clock(cx, if shows_four { long_year } else { short_year })
}

/// The moment given by words; `None` if it does not exist. Two digits mean 1980 to 2079 if `short`.
fn moment(words: [i16; 7], short: bool) -> Option<Clock> {
    let [year, month, day, hour, minute, second, weekday] = words;
    let year = match year {
        0..=79 if short => year + 2000,
        80..=99 if short => year + 1900,
        _ if short || YEARS.contains(&year) => year,
        _ => return None,
    };
    let field = |value: i16| u8::try_from(value).ok();
    let clock = Clock {
        year: u16::try_from(year).ok()?,
        month: field(month)?,
        day: field(day)?,
        hour: field(hour)?,
        minute: field(minute)?,
        second: field(second)?,
        weekday: field(weekday)?,
    };
    clock.is_valid().then_some(clock)
}

/// Sets the clock from the seven words at S; M8019 signals that they are not a valid moment, and the clock is
/// unchanged.
fn write_clock(cx: &mut Cx, short: bool) -> Done {
    let mut words = [0; 7];
    for (offset, word) in (0..).zip(&mut words) {
        *word = cx.word(0, offset)?;
    }
    let clock = moment(words, short);
    cx.set_special(M_CLOCK_ERROR, clock.is_none());
    let Some(clock) = clock else {
        return Ok(());
    };
    if cx.special(M_CLOCK_STOP) {
        // They set the clock when it turns on.
        for (register, word) in REGISTERS.into_iter().zip(words) {
            cx.set_special_word(register, word);
        }
    }
    cx.hal().set_clock(clock).ok_or(Fault::DEVICE)
}

/// TWR S (FNC 167): sets the clock from seven words in TRD's order; words that are not a valid moment are ignored.
pub fn twr(cx: &mut Cx) -> Done {
    write_clock(cx, false)
}

/// TWR where the year may have two digits (L01S, FX).
pub fn twr_short(cx: &mut Cx) -> Done {
    write_clock(cx, true)
}

/// Keeps D8013–D8019 up to date at the start of each scan, shows in M8018 whether there is a clock, and obeys the
/// clock's relays: M8015 stops it, and its fall sets it from the registers, whose year may have two digits; M8016
/// holds the registers; the rise of M8017 rounds to a minute.
///
/// Where the year is `short`, [`FOUR_DIGITS`] in D8018 makes it long until power-off.
///
/// Memory: M8015 and M8017 of the last scan; the moment at which the clock was stopped; whether a program chose four
/// digits.
fn refresh(cx: &mut Cx, short: bool) -> Done {
    let now = cx.hal().clock();
    cx.set_special(M_CLOCK_FITTED, now.is_some());
    let Some(mut now) = now else {
        return Ok(());
    };
    let (stop, adjust) = (cx.special(M_CLOCK_STOP), cx.special(M_CLOCK_ADJUST));
    let [stopped, adjusted, date, time, mut chosen, ..] = cx.state().0;
    if short && !stop && stopped == 0 && cx.special_word(D_YEAR) == FOUR_DIGITS {
        chosen = 1;
    }
    if stop && stopped == 0 {
        let state = cx.state();
        state.0[2] = i32::from(now.year) << 16 | i32::from(now.month) << 8 | i32::from(now.day);
        state.0[3] = i32::from(now.weekday) << 24
            | i32::from(now.hour) << 16
            | i32::from(now.minute) << 8
            | i32::from(now.second);
    }
    if !stop && stopped != 0 {
        let [year, month, day] = [date >> 16, date >> 8 & 255, date & 255];
        let [weekday, hour, minute, second] = (time as u32).to_be_bytes().map(i16::from);
        let held = [
            year as i16,
            month as i16,
            day as i16,
            hour,
            minute,
            second,
            weekday,
        ];
        let shown = shown(cx);
        // A program that never names the registers has none: it only stops the clock.
        let mut set = if shown == [0; 7] { held } else { shown };
        // Where years have four digits, two are also taken here, but not by TWR (h1u-h2u-programming §8.9, §4.3.12).
        if !short && (0..=99).contains(&set[0]) {
            set[0] += *YEARS.start();
        }
        let clock = moment(set, short);
        cx.set_special(M_CLOCK_ERROR, clock.is_none());
        if let Some(clock) = clock.or(moment(held, true)) {
            let _ = cx.hal().set_clock(clock);
            now = clock;
        }
    }
    if adjust && adjusted == 0 {
        let minute = Clock { second: 0, ..now };
        now = if now.second < 30 {
            minute
        } else {
            minute.after(60_000)
        };
        let _ = cx.hal().set_clock(now);
    }
    let state = cx.state();
    state.0[0] = stop.into();
    state.0[1] = adjust.into();
    state.0[4] = chosen;
    if !stop && !cx.special(M_CLOCK_HOLD) {
        let year = if short && chosen == 0 {
            short_year(now.year)
        } else {
            now.year
        };
        let [second, minute, hour, day, month] =
            [now.second, now.minute, now.hour, now.day, now.month].map(i16::from);
        let fields = [second, minute, hour, day, month, year as i16];
        for (register, value) in D_SECOND.run::<6>().into_iter().zip(fields) {
            cx.set_special_word(register, value);
        }
        cx.set_special_word(D_WEEKDAY, now.weekday.into());
    }
    Ok(())
}

/// Values of the clock's registers, in TRD's order.
fn shown(cx: &Cx) -> [i16; 7] {
    REGISTERS.map(|register| cx.special_word(register))
}

/// The clock's registers and relays, once a scan before the program.
pub fn clock_refresh(cx: &mut Cx) -> Done {
    refresh(cx, false)
}

/// The same where the year has two digits (L01S, FX), unless a program chooses four.
pub fn clock_refresh_short(cx: &mut Cx) -> Done {
    refresh(cx, true)
}

/// HOUR S D1 D2 (FNC 169): counts the time driven in D1 (hours; a pair in the 32-bit form) and the word after it
/// (seconds of the hour); D2 is on from S hours on. Stops at the most that D1 holds. Memory: milliseconds of the
/// second; whether the last scan drove it.
pub fn hour(cx: &mut Cx) -> Done {
    let dt = cx.elapsed_ms();
    if !cx.drive() {
        cx.state().0[1] = 0;
        return Ok(());
    }
    let set = cx.read(0)?;
    let (next, most) = if cx.wide() {
        (2, i32::MAX)
    } else {
        (1, i16::MAX.into())
    };
    let (hours, seconds) = (cx.read(1)?, i32::from(cx.word(1, next)?));
    cx.bit(2, 0)?;
    let state = cx.state();
    let ms = state.0[0].saturating_add(if state.0[1] != 0 { dt } else { 0 });
    state.0[1] = 1;
    state.0[0] = ms % 1000;
    let seconds = seconds.saturating_add(ms / 1000);
    let (hours, seconds) = match hours.checked_add(seconds / 3600) {
        Some(hours) if hours <= most => (hours, seconds % 3600),
        _ => (most, 3599),
    };
    cx.write(1, hours)?;
    cx.set_word(1, next, seconds as i16)?;
    cx.set_bit(2, 0, hours >= set)
}

#[cfg(test)]
mod tests {
    use crate::double::{Double, reg};
    use crate::hal::{Clock, Hal, NoHal};
    use crate::{Class, Cx, Fault, Plc, RtFn, VirtualHal, d, k};
    use proptest::prelude::*;

    #[test]
    fn comparisons_of_times() {
        for (time, bits) in [
            ([9, 59, 59], "100"),
            ([10, 30, 0], "010"),
            ([11, 0, 0], "001"),
        ] {
            let mut plc = Double::new()
                .with_d(0, &time)
                .with_d(10, &[10, 0, 0, 10, 59, 59]);
            plc.call(RtFn::Tcmp, &[k(10), k(30), k(0), reg(0), d(Class::M, 0)])
                .unwrap();
            plc.call(RtFn::Tzcp, &[reg(10), reg(13), reg(0), d(Class::M, 3)])
                .unwrap();
            assert_eq!(plc.m(0, 6), [bits, bits].concat());
        }
    }

    #[test]
    fn sums_and_differences_of_times() {
        let mut plc = Double::new().with_d(0, &[18, 10, 30, 10, 20, 5]);
        plc.call(RtFn::Tadd, &[reg(0), reg(3), reg(10)]).unwrap();
        assert_eq!(
            (plc.d(10, 3), plc.m(8020, 3)),
            ([4, 30, 35].to_vec(), "001".into())
        );
        plc.call(RtFn::Tsub, &[reg(3), reg(0), reg(10)]).unwrap();
        assert_eq!(
            (plc.d(10, 3), plc.m(8020, 3)),
            ([16, 9, 35].to_vec(), "011".into())
        );
        plc.call(RtFn::Tsub, &[reg(0), reg(0), reg(10)]).unwrap();
        assert_eq!(
            (plc.d(10, 3), plc.m(8020, 2)),
            ([0; 3].to_vec(), "10".into())
        );
        plc.set_d(1, &[60]);
        assert_eq!(
            plc.call(RtFn::Tadd, &[reg(0), reg(3), reg(10)]),
            Err(Fault::VALUE)
        );
    }

    #[test]
    fn the_clock_is_read_and_set() {
        let mut plc = Double::new().with_d(0, &[2027, 2, 28, 23, 59, 58, 0]);
        plc.call(RtFn::Twr, &[reg(0)]).unwrap();
        plc.scan(3000, true, RtFn::Trd, &[reg(10)]).unwrap();
        assert_eq!(plc.d(10, 7), [2027, 3, 1, 0, 0, 1, 1]);
        plc.call(RtFn::TrdShort, &[reg(10)]).unwrap();
        assert_eq!(plc.d(10, 1), [27]);
        plc.set_d(0, &[99]);
        plc.call(RtFn::Twr, &[reg(0)]).unwrap();
        assert_eq!(
            (plc.hal.clock().unwrap().year, plc.m(8019, 1)),
            (2027, "1".into())
        );
        plc.call(RtFn::TwrShort, &[reg(0)]).unwrap();
        assert_eq!(
            (plc.hal.clock().unwrap().year, plc.m(8019, 1)),
            (1999, "0".into())
        );
    }

    #[test]
    fn m8018_says_whether_there_is_a_clock() {
        let mut plc = Double::new();
        for (hal, expected) in [
            (&mut VirtualHal::new() as &mut dyn Hal, true),
            (&mut NoHal, false),
        ] {
            let site = plc.site;
            super::clock_refresh(&mut Cx::new(&mut plc, hal, &[], site)).unwrap();
            assert_eq!(plc.bit(Class::M, 8018), Some(expected));
        }
    }

    /// D8013…D8019 after a refresh.
    fn refreshed(plc: &mut Double, dt: u32) -> std::vec::Vec<i16> {
        plc.scan(dt, true, RtFn::ClockRefresh, &[]).unwrap();
        plc.d(8013, 7)
    }

    #[test]
    fn the_clock_s_relays() {
        let mut plc = Double::new();
        plc.hal
            .set_clock(Clock::new(2026, 1, 2, 3, 4, 29).unwrap())
            .unwrap();
        assert_eq!(refreshed(&mut plc, 1000), [30, 4, 3, 2, 1, 2026, 5]);
        plc.set_m(8017, "1");
        assert_eq!(refreshed(&mut plc, 10)[..2], [0, 5]);
        assert_eq!(refreshed(&mut plc, 40_000)[..2], [40, 5]);
        plc.set_m(8015, "11");
        refreshed(&mut plc, 10);
        plc.set_m(8015, "01");
        assert_eq!(refreshed(&mut plc, 5000)[..2], [40, 5]);
        assert_eq!(plc.hal.clock().unwrap().second, 40);
        plc.set_m(8015, "10");
        refreshed(&mut plc, 10);
        plc.set_d(8013, &[1, 75]);
        plc.set_m(8015, "00");
        refreshed(&mut plc, 10);
        assert_eq!(
            (plc.m(8019, 1), plc.hal.clock().unwrap().minute),
            ("1".into(), 5)
        );
    }

    #[test]
    fn hour_meters_count_only_while_driven() {
        let ops = [k(6), reg(0), d(Class::M, 0)];
        let mut plc = Double::new().with_d(0, &[5, 3598]);
        plc.scan(700, true, RtFn::Hour, &ops).unwrap();
        plc.scan(700, true, RtFn::Hour, &ops).unwrap();
        plc.scan(700, false, RtFn::Hour, &ops).unwrap();
        plc.scan(700, true, RtFn::Hour, &ops).unwrap();
        assert_eq!((plc.d(0, 2), plc.m(0, 1)), ([5, 3598].to_vec(), "0".into()));
        plc.scan(1400, true, RtFn::Hour, &ops).unwrap();
        assert_eq!((plc.d(0, 2), plc.m(0, 1)), ([6, 0].to_vec(), "1".into()));
        plc.set_d(0, &[32767, 3599]);
        plc.scan(1400, true, RtFn::Hour, &ops).unwrap();
        assert_eq!(plc.d(0, 2), [32767, 3599]);
    }

    proptest! {
        #[test]
        fn htos_undoes_stoh(seconds in 0i32..=32_767) {
            let mut plc = Double::new().with_d(0, &[seconds]);
            plc.call(RtFn::Stoh, &[reg(0), reg(1)]).unwrap();
            plc.call(RtFn::Htos, &[reg(1), reg(4)]).unwrap();
            prop_assert_eq!(i32::from(plc.d(4, 1)[0]), seconds);
        }
    }
}
