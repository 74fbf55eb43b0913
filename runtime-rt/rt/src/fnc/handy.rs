//! Handy instructions: FNC 61–69 and 149, h1u-h2u-programming §4.3.7. What its lost figures showed is as in the FX
//! family.

use crate::cx::Cx;
use crate::fault::{Done, Fault};
use crate::plc::Class;
use crate::special::{
    M_COMPLETE, M_DESCENDING, M_NO_OUTPUT_RESET, M_RAMP_HOLD, M_START_PULSE, M_STL_MONITOR,
    M_TRANSFER_OFF, M_TRANSFER_START,
};

/// SER S1 S2 D n (FNC 61): searches n elements from S1 on for S2; D… take how many are equal, the first and the last of
/// them, the smallest and the largest element, by their places from 0; of equal ones the last.
pub fn ser(cx: &mut Cx) -> Done {
    let n = cx.count(3, 1..=if cx.wide() { 128 } else { 256 })?;
    let wanted = cx.read(1)?;
    let (mut found, mut first, mut last) = (0, 0, 0);
    let (mut smallest, mut largest) = ((i32::MAX, 0), (i32::MIN, 0));
    for place in 0..n {
        let value = cx.elem(0, place)?;
        if value == wanted {
            first = if found == 0 { place } else { first };
            last = place;
            found += 1;
        }
        if value <= smallest.0 {
            smallest = (value, place);
        }
        if value >= largest.0 {
            largest = (value, place);
        }
    }
    cx.check_elems(2, 5)?;
    (0..)
        .zip([found, first, last, smallest.1, largest.1])
        .try_for_each(|(k, value)| cx.set_elem(2, k, value))
}

/// ABSD S1 S2 D n (FNC 62): bit i of the n from D on is on while counter S2 lies from element 2i of the table S1 up to,
/// but without, element 2i+1; a first one above the second spans the counter's turn.
pub fn absd(cx: &mut Cx) -> Done {
    let n = cx.count(3, 1..=64)?;
    let value = cx.read(1)?;
    cx.check_elems(0, 2 * n)?;
    cx.check_bits(2, n)?;
    for bit in 0..n {
        let (on, off) = (cx.elem(0, 2 * bit)?, cx.elem(0, 2 * bit + 1)?);
        let inside = if on <= off {
            on <= value && value < off
        } else {
            value >= on || value < off
        };
        cx.set_bit(2, bit, inside)?;
    }
    Ok(())
}

/// INCD S1 S2 D n (FNC 63): one of the n bits from D on is on, in turn: when counter S2 reaches the step's element of
/// S1 it is reset and S2+1, the step, advances; M8029 signals that the last step is over. Without drive the counters
/// and bits are cleared. Memory: whether the last scan drove it.
pub fn incd(cx: &mut Cx) -> Done {
    let driven = cx.was_driven(0);
    if !cx.drive() && !driven {
        return Ok(());
    }
    let n = cx.count(3, 1..=64)?;
    cx.check_words(1, 2)?;
    cx.check_bits(2, n)?;
    if !cx.drive() {
        cx.reset(1, 0)?;
        cx.reset(1, 1)?;
        return (0..n).try_for_each(|bit| cx.set_bit(2, bit, false));
    }
    cx.check_words(0, n)?;
    let step = i32::from(cx.word(1, 1)?);
    let step = if (0..n).contains(&step) { step } else { 0 };
    let reached = cx.word(1, 0)? >= cx.word(0, step)?;
    let step = match reached {
        true => (step + 1) % n,
        false => step,
    };
    if reached {
        cx.reset(1, 0)?;
    }
    cx.set_word(1, 1, step as i16)?;
    cx.set_special(M_COMPLETE, reached && step == 0);
    (0..n).try_for_each(|bit| cx.set_bit(2, bit, bit == step))
}

/// TTMR D n (FNC 64): D takes how long the drive is on, in seconds times 10ⁿ, and keeps it; D+1 shows it in 100 ms
/// meanwhile. Memory: milliseconds; whether the last scan drove it.
pub fn ttmr(cx: &mut Cx) -> Done {
    let dt = cx.elapsed_ms();
    let driven = cx.was_driven(1);
    if !cx.drive() {
        return if driven { cx.set_word(0, 1, 0) } else { Ok(()) };
    }
    let unit = match cx.count(1, 0..=2)? {
        0 => 1000,
        1 => 100,
        _ => 10,
    };
    cx.check_words(0, 2)?;
    let ms = &mut cx.state().0[0];
    *ms = if driven { ms.saturating_add(dt) } else { 0 };
    let ms = *ms;
    let shown = |unit: i32| (ms / unit).min(i16::MAX.into()) as i16;
    cx.set_word(0, 0, shown(unit))?;
    cx.set_word(0, 1, shown(100))
}

/// STMR S m D (FNC 65): four bits follow the drive with delays of m times 100 ms, which timer S shows: D goes off
/// later; D+1 is on for the time after the drive goes off; D+2 is on for the time after it comes on; D+3 comes on later
/// and goes off later.
///
/// Memory: milliseconds since the drive changed; 1 after it came on, 2 after it went off, 0 long after; D+3 when it
/// went off.
pub fn stmr(cx: &mut Cx) -> Done {
    let dt = cx.elapsed_ms();
    let [ms, phase, late, ..] = cx.state().0;
    if !cx.drive() && phase == 0 {
        return Ok(());
    }
    let limit = cx.count(1, 1..=32_767)?;
    cx.word(0, 0)?;
    cx.check_bits(2, 4)?;
    let now = if cx.drive() { 1 } else { 2 };
    let ms = if phase == now {
        ms.saturating_add(dt)
    } else {
        0
    };
    let late = if phase == 1 && now == 2 {
        i32::from(cx.bit(2, 3)?)
    } else {
        late
    };
    let over = ms / 100 >= limit;
    let bits = match now {
        1 => [true, false, !over, over],
        _ => [!over, !over, false, late != 0 && !over],
    };
    let state = cx.state();
    state.0[0] = ms;
    state.0[1] = if now == 2 && over { 0 } else { now };
    state.0[2] = late;
    for (bit, on) in (0..).zip(bits) {
        cx.set_bit(2, bit, on)?;
    }
    if now == 2 && over {
        return cx.reset(0, 0);
    }
    cx.set_word(0, 0, (ms / 100).min(limit) as i16)?;
    cx.set_bit(0, 0, over)
}

/// RAMP S1 S2 D n (FNC 67): D goes from S1 to S2 in n scans, D+1 counts them, M8029 signals the end; then it restarts,
/// or with M8026 D stays. Memory: whether the last scan drove it.
pub fn ramp(cx: &mut Cx) -> Done {
    let driven = cx.was_driven(0);
    if !cx.drive() {
        if driven {
            cx.set_special(M_COMPLETE, false);
        }
        return Ok(());
    }
    let n = cx.count(3, 1..=32_767)?;
    let (from, to) = (i64::from(cx.word(0, 0)?), i64::from(cx.word(1, 0)?));
    cx.check_words(2, 2)?;
    let past = i32::from(cx.word(2, 1)?);
    let step = match past {
        _ if !driven => 0,
        past if !(0..n).contains(&past) => {
            if cx.special(M_RAMP_HOLD) {
                n
            } else {
                0
            }
        }
        past => past + 1,
    };
    let value = from + (to - from) * i64::from(step) / i64::from(n);
    cx.set_word(2, 0, value as i16)?;
    cx.set_word(2, 1, step as i16)?;
    cx.set_special(M_COMPLETE, step == n);
    Ok(())
}

/// ROTC S m1 m2 D (FNC 68): turns a table with m1 places so that piece S+2 comes to window S+1 the shorter way, slowly
/// over the last m2 places. D and D+1 are the two phases of its encoder (one place each cycle), D+2 signals place 0; S
/// is its position. D+3 to D+7: fast forward, slow forward, stop, slow reverse, fast reverse. Memory: phase A of the
/// last scan; whether that scan drove it.
pub fn rotc(cx: &mut Cx) -> Done {
    cx.check_bits(3, 8)?;
    let last_a = cx.state().0[0];
    let driven = cx.was_driven(1);
    if !cx.drive() {
        return (3..8).try_for_each(|bit| cx.set_bit(3, bit, false));
    }
    let places = cx.count(1, 2..=32_767)?;
    let slow = cx.count(2, 0..=places)?;
    cx.check_words(0, 3)?;
    let (a, b) = (cx.bit(3, 0)?, cx.bit(3, 1)?);
    cx.state().0[0] = a.into();
    let mut position = i32::from(cx.word(0, 0)?);
    if driven && a && last_a == 0 {
        position += if b { -1 } else { 1 };
    }
    if cx.bit(3, 2)? {
        position = 0;
    }
    let position = position.rem_euclid(places);
    cx.set_word(0, 0, position as i16)?;
    let (window, piece) = (i32::from(cx.word(0, 1)?), i32::from(cx.word(0, 2)?));
    let forward = (window - piece - position).rem_euclid(places);
    let reverse = (places - forward) % places;
    let way = match (forward, reverse) {
        (0, _) => 5,
        (f, r) if f <= r => {
            if f > slow {
                3
            } else {
                4
            }
        }
        (_, r) => {
            if r > slow {
                7
            } else {
                6
            }
        }
    };
    (3..8).try_for_each(|bit| cx.set_bit(3, bit, bit == way))
}

/// The position of a cell in a table.
type Place = fn(row: i32, column: i32, rows: i32, columns: i32) -> i32;

/// SORT S m1 m2 D n (FNC 69): sorts the m1 rows of m2 columns, kept column by column, by column n, smallest first.
pub fn sort(cx: &mut Cx) -> Done {
    sort_table(cx, |row, column, rows, _| column * rows + row, false)
}

/// SORT2 S m1 m2 D n (FNC 149): sorts the m1 rows of m2 columns, kept row by row, by column n; M8165 turns the order.
pub fn sort2(cx: &mut Cx) -> Done {
    let descending = cx.special(M_DESCENDING);
    sort_table(
        cx,
        |row, column, _, columns| row * columns + column,
        descending,
    )
}

/// Copies a table from S to D and sorts it there, one row a scan; equal rows keep their order; M8029 signals the end.
/// Memory: how many rows are sorted, plus one; the drive must go off before it sorts again.
fn sort_table(cx: &mut Cx, place: Place, descending: bool) -> Done {
    if !cx.drive() {
        if cx.state().0[0] != 0 {
            cx.state().0[0] = 0;
            cx.set_special(M_COMPLETE, false);
        }
        return Ok(());
    }
    let (rows, columns) = (cx.count(1, 1..=32)?, cx.count(2, 1..=6)?);
    let key = cx.count(4, 1..=columns)? - 1;
    let cells = rows * columns;
    cx.check_elems(0, cells)?;
    cx.check_elems(3, cells)?;
    let sorted = cx.state().0[0] - 1;
    if sorted < 0 {
        for k in 0..cells {
            let value = cx.elem(0, k)?;
            cx.set_elem(3, k, value)?;
        }
    }
    let mut row = sorted.max(0);
    let next = row + 1;
    while (1..rows).contains(&row) {
        let keys = [row - 1, row].map(|row| cx.elem(3, place(row, key, rows, columns)));
        let (above, this) = (keys[0]?, keys[1]?);
        let in_order = if descending {
            above >= this
        } else {
            above <= this
        };
        if in_order {
            break;
        }
        for column in 0..columns {
            let cells = [row - 1, row].map(|row| place(row, column, rows, columns));
            let (above, value) = (cx.elem(3, cells[0])?, cx.elem(3, cells[1])?);
            cx.set_elem(3, cells[0], value)?;
            cx.set_elem(3, cells[1], above)?;
        }
        row -= 1;
    }
    cx.state().0[0] = next.min(rows) + 1;
    cx.set_special(M_COMPLETE, next >= rows);
    Ok(())
}

/// Modes of IST, selected by the operator's switches.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Mode {
    Manual,
    Origin,
    Step,
    Cycle,
    Continuous,
}

/// Modes in the order of the switches.
const MODES: [Mode; 5] = [
    Mode::Manual,
    Mode::Origin,
    Mode::Step,
    Mode::Cycle,
    Mode::Continuous,
];

/// IST S D1 D2 (FNC 60), as in the FX family: S to S+4 select manual, origin return, step, one cycle, continuous; S+5
/// starts origin return, S+6 automatic running, S+7 stops it. Choosing a mode activates S0, S1 or S2 and (unless M8045)
/// ends the states D1 to D2 and what they switched on. M8040 forbids transfers, M8041 allows the first, M8042 signals a
/// start, M8047 turns the monitor of states on.
///
/// Memory: the mode plus one; the start and stop buttons of the last scan.
pub fn ist(cx: &mut Cx) -> Done {
    let switches = cx.bits(0, 0, 8)?;
    let (Some(first), Some(last)) = (cx.ops.get(1), cx.ops.get(2)) else {
        return Err(Fault::VALUE);
    };
    let states = first.value..=last.value;
    let [chosen, buttons, ..] = cx.state().0;
    let pressed = |bit: u32| switches >> bit & 1 == 1;
    let rises = |bit: u32| pressed(bit) && buttons as u32 >> bit & 1 == 0;
    cx.set_special(M_STL_MONITOR, true);
    cx.state().0[1] = switches as i32;
    let mode = switches.trailing_zeros() as usize;
    let Some(&selected) = MODES.get(mode) else {
        cx.state().0[0] = 0;
        return Ok(());
    };
    let group = |mode: usize| mode.min(2);
    if chosen == 0 || group(chosen as usize - 1) != group(mode) {
        if chosen != 0 && !cx.special(M_NO_OUTPUT_RESET) {
            end_states(cx, states);
        }
        for (state, number) in (0..3).enumerate() {
            let _ = cx.plc.set_bit(Class::S, number, state == group(mode));
        }
    }
    cx.state().0[0] = mode as i32 + 1;
    let (origin_start, start, stop) = (5, 6, 7);
    let hold = match selected {
        Mode::Manual => true,
        Mode::Step => !rises(start),
        Mode::Origin => (cx.special(M_TRANSFER_OFF) || rises(stop)) && !rises(origin_start),
        Mode::Cycle => (cx.special(M_TRANSFER_OFF) || rises(stop)) && !rises(start),
        Mode::Continuous => false,
    };
    let go = match selected {
        Mode::Manual | Mode::Origin => false,
        Mode::Step | Mode::Cycle => pressed(start),
        Mode::Continuous => (cx.special(M_TRANSFER_START) || pressed(start)) && !pressed(stop),
    };
    cx.set_special(M_TRANSFER_OFF, hold);
    cx.set_special(M_TRANSFER_START, go);
    cx.set_special(M_START_PULSE, rises(start) || rises(origin_start));
    Ok(())
}

/// Last output of any model (Y377).
const LAST_OUTPUT: u32 = 0o377;

/// Switches the states of a run and all outputs off. What the program does not have stays out.
fn end_states(cx: &mut Cx, states: core::ops::RangeInclusive<i32>) {
    for state in states.filter_map(|state| u32::try_from(state).ok()) {
        let _ = cx.plc.set_bit(Class::S, state, false);
    }
    for output in 0..=LAST_OUTPUT {
        let _ = cx.plc.set_bit(Class::Y, output, false);
    }
}

#[cfg(test)]
mod tests {
    use crate::double::{Double, reg, relay};
    use crate::{Class, Fault, Plc, RtFn, d, k};
    use proptest::prelude::*;

    fn complete(plc: &Double) -> bool {
        plc.bit(Class::M, 8029).unwrap()
    }

    #[test]
    fn ser_finds_places() {
        let mut plc = Double::new().with_d(0, &[5, 9, 5, -3, 9, -3]);
        plc.call(RtFn::Ser, &[reg(0), k(5), reg(10), k(6)]).unwrap();
        assert_eq!(plc.d(10, 5), [2, 0, 2, 5, 4]);
        plc.call(RtFn::Ser, &[reg(0), k(6), reg(10), k(6)]).unwrap();
        assert_eq!(plc.d(10, 5), [0, 0, 0, 5, 4]);
        assert_eq!(
            plc.call(RtFn::Ser, &[reg(0), k(6), reg(10), k(257)]),
            Err(Fault::VALUE)
        );
    }

    #[test]
    fn absd_wraps_through_zero() {
        let ops = [reg(0), d(Class::C, 0), relay(0), k(2)];
        let mut plc = Double::new().with_d(0, &[10, 20, 300, 5]);
        for (value, bits) in [
            (9, "00"),
            (10, "10"),
            (19, "10"),
            (20, "00"),
            (300, "01"),
            (4, "01"),
            (5, "00"),
        ] {
            plc.set_word(Class::C, 0, value);
            plc.call(RtFn::Absd, &ops).unwrap();
            assert_eq!(plc.m(0, 2), bits, "{value}");
        }
    }

    #[test]
    fn incd_goes_round() {
        let ops = [reg(0), d(Class::C, 0), relay(0), k(3)];
        let mut plc = Double::new().with_d(0, &[2, 1, 3]);
        for (count, bits, done) in [
            (0, "100", false),
            (2, "010", false),
            (1, "001", false),
            (2, "001", false),
            (3, "100", true),
            (0, "100", false),
        ] {
            plc.set_word(Class::C, 0, count);
            plc.scan(10, true, RtFn::Incd, &ops).unwrap();
            assert_eq!((plc.m(0, 3).as_str(), complete(&plc)), (bits, done));
        }
        plc.scan(10, false, RtFn::Incd, &ops).unwrap();
        assert_eq!(plc.m(0, 3), "000");
    }

    #[test]
    fn ttmr_measures_the_drive() {
        let mut plc = Double::new();
        for dt in [10, 500, 34] {
            plc.scan(dt, true, RtFn::Ttmr, &[reg(0), k(2)]).unwrap();
        }
        assert_eq!(plc.d(0, 2), [53, 5]);
        plc.scan(10, false, RtFn::Ttmr, &[reg(0), k(2)]).unwrap();
        assert_eq!(plc.d(0, 2), [53, 0]);
        plc.scan(10, true, RtFn::Ttmr, &[reg(0), k(2)]).unwrap();
        assert_eq!(plc.d(0, 2), [0, 0]);
    }

    #[test]
    fn stmr_delays() {
        let ops = [d(Class::T, 0), k(2), relay(0)];
        let mut plc = Double::new();
        for (drive, bits) in [
            (true, "1010"),
            (true, "1010"),
            (true, "1001"),
            (true, "1001"),
            (false, "1101"),
            (false, "1101"),
            (false, "0000"),
            (false, "0000"),
            (true, "1010"),
            (false, "1100"),
            (false, "1100"),
            (true, "1010"),
        ] {
            plc.scan(100, drive, RtFn::Stmr, &ops).unwrap();
            assert_eq!(plc.m(0, 4), bits);
        }
    }

    #[test]
    fn ramps_repeat_or_hold() {
        let ops = [reg(0), reg(1), reg(2), k(4)];
        let mut plc = Double::new().with_d(0, &[10, -10]);
        let next = |plc: &mut Double| {
            plc.scan(10, true, RtFn::Ramp, &ops).unwrap();
            (plc.d(2, 1)[0], complete(plc))
        };
        let course = [
            (10, false),
            (5, false),
            (0, false),
            (-5, false),
            (-10, true),
        ];
        for expected in course.iter().chain(&course[..2]) {
            assert_eq!(next(&mut plc), *expected);
        }
        plc.set_m(8026, "1");
        for _ in 0..5 {
            next(&mut plc);
        }
        assert_eq!(next(&mut plc), (-10, true));
        plc.scan(10, false, RtFn::Ramp, &ops).unwrap();
        assert!(!complete(&plc));
        assert_eq!(next(&mut plc), (10, false));
    }

    #[test]
    fn rotc_takes_the_shorter_way() {
        let ops = [reg(0), k(10), k(2), relay(0)];
        let mut plc = Double::new().with_d(0, &[5, 0, 7]);
        plc.set_m(0, "001");
        plc.scan(10, true, RtFn::Rotc, &ops).unwrap();
        assert_eq!((plc.d(0, 1), plc.m(3, 5)), ([0].to_vec(), "10000".into()));
        for (phases, position, outputs) in [
            ("100", 1, "01000"),
            ("000", 1, "01000"),
            ("100", 2, "01000"),
            ("010", 2, "01000"),
            ("110", 1, "01000"),
            ("000", 1, "01000"),
            ("100", 2, "01000"),
            ("000", 2, "01000"),
            ("100", 3, "00100"),
        ] {
            plc.set_m(0, phases);
            plc.scan(10, true, RtFn::Rotc, &ops).unwrap();
            assert_eq!(
                (plc.d(0, 1), plc.m(3, 5).as_str()),
                ([position].to_vec(), outputs)
            );
        }
        plc.scan(10, false, RtFn::Rotc, &ops).unwrap();
        assert_eq!(plc.m(3, 5), "00000");
    }

    #[test]
    fn ist_activates_the_mode_s_state() {
        let ops = [d(Class::X, 0), d(Class::S, 20), d(Class::S, 22)];
        let states = |plc: &Double| [0, 1, 2, 21].map(|n| plc.bit(Class::S, n).unwrap());
        let mut plc = Double::new();
        plc.set_bit(Class::X, 0, true);
        plc.scan(10, true, RtFn::Ist, &ops).unwrap();
        assert_eq!(
            (states(&plc), plc.m(8040, 1), plc.m(8047, 1)),
            ([true, false, false, false], "1".into(), "1".into())
        );
        plc.set_bit(Class::X, 0, false);
        plc.set_bit(Class::X, 4, true);
        plc.set_bit(Class::S, 21, true);
        plc.set_bit(Class::Y, 3, true);
        plc.scan(10, true, RtFn::Ist, &ops).unwrap();
        assert_eq!(
            (states(&plc), plc.bit(Class::Y, 3)),
            ([false, false, true, false], Some(false))
        );
        plc.set_bit(Class::X, 6, true);
        plc.scan(10, true, RtFn::Ist, &ops).unwrap();
        assert_eq!(plc.m(8040, 3), "011");
        plc.set_bit(Class::X, 6, false);
        plc.scan(10, true, RtFn::Ist, &ops).unwrap();
        assert_eq!(plc.m(8040, 3), "010");
        plc.set_bit(Class::X, 7, true);
        plc.scan(10, true, RtFn::Ist, &ops).unwrap();
        assert_eq!(plc.m(8040, 3), "000");
    }

    proptest! {
        #[test]
        fn tables_are_sorted(keys in prop::collection::vec(-3i32..3, 2..8)) {
            let rows = keys.len();
            let table: std::vec::Vec<i32> = keys.iter().copied().chain(0..rows as i32).collect();
            let mut plc = Double::new().with_d(0, &table);
            let mut expected: std::vec::Vec<(i16, i16)> = (0..rows).map(|r| (keys[r] as i16, r as i16)).collect();
            expected.sort_by_key(|row| row.0);
            let ops = |s, t| [reg(s), k(rows as i32), k(2), reg(t), k(1)];
            for scan in 0..rows {
                plc.scan(10, true, RtFn::Sort, &ops(0, 50)).unwrap();
                prop_assert_eq!(complete(&plc), scan + 1 == rows);
            }
            let n = rows as u32;
            let sorted: std::vec::Vec<_> = plc.d(50, n).into_iter().zip(plc.d(50 + n, n)).collect();
            prop_assert_eq!(&sorted, &expected);
        }
    }
}
