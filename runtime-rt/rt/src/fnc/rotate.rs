//! Rotation, shifts and queues: FNC 30–39, h1u-h2u-programming §4.3.5, hm-motion-controller §5.4.

use crate::cx::Cx;
use crate::fault::{Done, Fault};
use crate::special::{M_CARRY, M_ZERO};

/// Rotates the low `width` bits of `ring` right by `n` places (at most `width`).
fn rotate_right(ring: u64, width: u32, n: u32) -> u64 {
    let mask = (1u64 << width) - 1;
    let n = n % width;
    (ring >> n | ring << (width - n)) & mask
}

/// Rotates the ring of D and, above it, the carry flag by n places.
fn rotate_through_carry(cx: &mut Cx, right: bool) -> Done {
    let width = cx.width();
    let n = cx.count(1, 0..=width as i32)? as u32;
    let ring = u64::from(cx.special(M_CARRY)) << width | u64::from(cx.read_unsigned(0)?);
    let ring = rotate_right(ring, width + 1, if right { n } else { width + 1 - n });
    cx.write(0, ring as i32)?;
    cx.set_special(M_CARRY, ring >> width & 1 == 1);
    Ok(())
}

/// RCR D n (FNC 32): rotates D and the carry flag right.
pub fn rcr(cx: &mut Cx) -> Done {
    rotate_through_carry(cx, true)
}

/// RCL D n (FNC 33): rotates D and the carry flag left.
pub fn rcl(cx: &mut Cx) -> Done {
    rotate_through_carry(cx, false)
}

/// SFR D n (FNC 213): shifts D right, zeros entering; the last bit out goes to the carry flag. n counts modulo 16; a
/// negative one is an error.
pub fn sfr(cx: &mut Cx) -> Done {
    let n = cx.count(1, 0..=i16::MAX.into())? % 16;
    let value = u64::from(cx.word(0, 0)? as u16) << 1;
    let shifted = value >> n;
    cx.set_word(0, 0, (shifted >> 1) as i16)?;
    cx.set_special(M_CARRY, n > 0 && shifted & 1 == 1);
    Ok(())
}

/// SFL D n (FNC 214): shifts D left, zeros entering; the last bit out goes to the carry flag. n counts modulo 16; a
/// negative one is an error.
pub fn sfl(cx: &mut Cx) -> Done {
    let n = cx.count(1, 0..=i16::MAX.into())? % 16;
    let shifted = u32::from(cx.word(0, 0)? as u16) << n;
    cx.set_word(0, 0, shifted as i16)?;
    cx.set_special(M_CARRY, shifted >> 16 & 1 == 1);
    Ok(())
}

/// Items that a shift moves: bits or words.
trait Item: Sized {
    fn check(cx: &Cx, i: usize, count: i32) -> Done;
    fn copy(cx: &mut Cx, from: (usize, i32), to: (usize, i32)) -> Done;
}

/// Bits, for SFTR and SFTL.
struct Bit;

impl Item for Bit {
    fn check(cx: &Cx, i: usize, count: i32) -> Done {
        cx.check_bits(i, count)
    }

    fn copy(cx: &mut Cx, from: (usize, i32), to: (usize, i32)) -> Done {
        let value = cx.bit(from.0, from.1)?;
        cx.set_bit(to.0, to.1, value)
    }
}

/// Words or groups of bits, for WSFR and WSFL.
struct Word;

impl Item for Word {
    fn check(cx: &Cx, i: usize, count: i32) -> Done {
        cx.check_words(i, count)
    }

    fn copy(cx: &mut Cx, from: (usize, i32), to: (usize, i32)) -> Done {
        let value = cx.word(from.0, from.1)?;
        cx.set_word(to.0, to.1, value)
    }
}

/// Shifts the n1 items from D (operand 1) on by n2 places, the n2 from S (operand 0) on entering. Nothing happens if n2
/// is 0.
fn shift<I: Item>(cx: &mut Cx, right: bool, most: i32) -> Done {
    let length = cx.count(2, 1..=most)?;
    let by = cx.count(3, 0..=length)?;
    I::check(cx, 0, by)?;
    I::check(cx, 1, length)?;
    if by == 0 {
        return Ok(());
    }
    for n in 0..length - by {
        if right {
            I::copy(cx, (1, n + by), (1, n))?;
        } else {
            I::copy(cx, (1, length - 1 - by - n), (1, length - 1 - n))?;
        }
    }
    let first = if right { length - by } else { 0 };
    (0..by).try_for_each(|n| I::copy(cx, (0, n), (1, first + n)))
}

/// SFTR S D n1 n2 (FNC 34): shifts bits towards lower numbers.
pub fn sftr(cx: &mut Cx) -> Done {
    shift::<Bit>(cx, true, 1024)
}

/// SFTL S D n1 n2 (FNC 35): shifts bits towards higher numbers.
pub fn sftl(cx: &mut Cx) -> Done {
    shift::<Bit>(cx, false, 1024)
}

/// WSFR S D n1 n2 (FNC 36): shifts words towards lower numbers.
pub fn wsfr(cx: &mut Cx) -> Done {
    shift::<Word>(cx, true, 2048)
}

/// WSFL S D n1 n2 (FNC 37): shifts words towards higher numbers.
pub fn wsfl(cx: &mut Cx) -> Done {
    shift::<Word>(cx, false, 2048)
}

/// The number of entries that the queue at operand `i` holds, its `words` words checked.
fn entries(cx: &Cx, i: usize, words: i32) -> Result<i32, Fault> {
    cx.check_words(i, words)?;
    match cx.word(i, 0)?.into() {
        n if n < 0 => Err(Fault::VALUE),
        n => Ok(n),
    }
}

/// SFWR S D n (FNC 38): appends S to the queue D+1…D+n-1, whose length is D. A full queue stays, and the carry flag is
/// on.
pub fn sfwr(cx: &mut Cx) -> Done {
    let n = cx.count(2, 2..=2048)?;
    let held = entries(cx, 1, n)?;
    let value = cx.word(0, 0)?;
    let full = held >= n - 1;
    cx.set_special(M_CARRY, full);
    if full {
        return Ok(());
    }
    cx.set_word(1, 0, held as i16 + 1)?;
    cx.set_word(1, held + 1, value)
}

/// SFRD S D n (FNC 39): takes the oldest entry S+1 to D; S+2…S+n-1 move down, the last word stays. An empty queue gives
/// nothing, and the zero flag is on.
pub fn sfrd(cx: &mut Cx) -> Done {
    let n = cx.count(2, 2..=2048)?;
    let held = entries(cx, 0, n)?;
    cx.word(1, 0)?;
    cx.set_special(M_ZERO, held == 0);
    if held == 0 {
        return Ok(());
    }
    take_first(cx, held, n - 1)
}

/// Moves S+1 to D and the other of the `places` places down by one.
fn take_first(cx: &mut Cx, held: i32, places: i32) -> Done {
    let value = cx.word(0, 1)?;
    for place in 1..places {
        let next = cx.word(0, place + 1)?;
        cx.set_word(0, place, next)?;
    }
    cx.set_word(0, 0, held as i16 - 1)?;
    cx.set_word(1, 0, value)
}

/// SFWR of HM: S enters at D+1, the older entries move up; the queue holds n.
pub fn sfwr_hm(cx: &mut Cx) -> Done {
    let n = cx.count(2, 2..=512)?;
    let held = entries(cx, 1, n + 1)?;
    let value = cx.word(0, 0)?;
    let full = held >= n;
    cx.set_special(M_CARRY, full);
    if full {
        return Ok(());
    }
    for place in (1..=held).rev() {
        let entry = cx.word(1, place)?;
        cx.set_word(1, place + 1, entry)?;
    }
    cx.set_word(1, 0, held as i16 + 1)?;
    cx.set_word(1, 1, value)
}

/// SFRD of HM: only the entries below the pointer move down; a pointer beyond n turns the carry flag on.
pub fn sfrd_hm(cx: &mut Cx) -> Done {
    let n = cx.count(2, 2..=512)?;
    let held = entries(cx, 0, n + 1)?;
    cx.word(1, 0)?;
    cx.set_special(M_CARRY, held > n);
    if held == 0 || held > n {
        return Ok(());
    }
    take_first(cx, held, held)
}

/// POP S D n (FNC 212): takes the newest entry S+pointer to D. An empty stack gives nothing; the zero flag is on when
/// it is empty afterwards.
pub fn pop(cx: &mut Cx) -> Done {
    let n = cx.count(2, 2..=512)?;
    let held = entries(cx, 0, n)?;
    if held >= n {
        return Err(Fault::VALUE);
    }
    cx.word(1, 0)?;
    cx.set_special(M_ZERO, held <= 1);
    if held == 0 {
        return Ok(());
    }
    let value = cx.word(0, held)?;
    cx.set_word(0, 0, held as i16 - 1)?;
    cx.set_word(1, 0, value)
}

#[cfg(test)]
mod tests {
    use crate::double::{Double, reg};
    use crate::{Class, Fault, Plc, RtFn, d, k, kn};
    use proptest::prelude::*;

    fn carry(plc: &Double) -> bool {
        plc.bit(Class::M, 8022).unwrap()
    }

    /// The catalogue takes n from 0 where the manuals give the upper limit alone.
    #[test]
    fn by_0_places_nothing_moves() {
        let mut plc = Double::new().with_d(0, &[7, 0x1235, 9]);
        plc.set_m(0, "1011");
        plc.set_m(8022, "1");
        for function in [RtFn::Rcr, RtFn::Rcl] {
            plc.call(function, &[reg(1), k(0)]).unwrap();
        }
        for function in [RtFn::Sftr, RtFn::Sftl] {
            let (s, m) = (d(Class::M, 0), d(Class::M, 1));
            plc.call(function, &[s, m, k(3), k(0)]).unwrap();
        }
        for function in [RtFn::Wsfr, RtFn::Wsfl] {
            plc.call(function, &[reg(0), reg(1), k(2), k(0)]).unwrap();
        }
        assert_eq!(plc.d(0, 3), [7, 0x1235, 9]);
        assert_eq!((plc.m(0, 4).as_str(), carry(&plc)), ("1011", true));
    }

    #[test]
    fn shifts_out_of_a_word() {
        let mut plc = Double::new().with_d(0, &[0x1238]);
        plc.call(RtFn::Sfr, &[reg(0), k(4)]).unwrap();
        assert_eq!((plc.d(0, 1), carry(&plc)), ([0x0123].to_vec(), true));
        plc.call(RtFn::Sfl, &[reg(0), k(8)]).unwrap();
        assert_eq!((plc.d(0, 1), carry(&plc)), ([0x2300].to_vec(), true));
        plc.call(RtFn::Sfl, &[reg(0), k(16)]).unwrap();
        assert_eq!((plc.d(0, 1), carry(&plc)), ([0x2300].to_vec(), false));
    }

    #[test]
    fn bit_shifts() {
        let (s, m) = (d(Class::M, 0), d(Class::M, 10));
        let mut plc = Double::new();
        plc.set_m(0, "11");
        plc.set_m(9, "1010010001");
        plc.call(RtFn::Sftr, &[s, m, k(8), k(2)]).unwrap();
        assert_eq!(plc.m(9, 10), "1001000111");
        plc.call(RtFn::Sftl, &[s, m, k(8), k(3)]).unwrap();
        assert_eq!(plc.m(9, 10), "1110001001");
        assert_eq!(plc.call(RtFn::Sftl, &[s, m, k(2), k(3)]), Err(Fault::VALUE));
        assert_eq!(
            plc.call(RtFn::Sftl, &[s, d(Class::M, 8510), k(3), k(1)]),
            Err(Fault::DEVICE)
        );
    }

    #[test]
    fn word_shifts() {
        let mut plc = Double::new()
            .with_d(0, &[7, 8])
            .with_d(10, &[1, 2, 3, 4, 5]);
        plc.call(RtFn::Wsfr, &[reg(0), reg(10), k(4), k(2)])
            .unwrap();
        assert_eq!(plc.d(10, 5), [3, 4, 7, 8, 5]);
        plc.call(RtFn::Wsfl, &[reg(0), reg(10), k(4), k(1)])
            .unwrap();
        assert_eq!(plc.d(10, 5), [7, 3, 4, 7, 5]);
        plc.set_m(0, "1010");
        plc.set_m(20, "111100001100");
        plc.call(
            RtFn::Wsfr,
            &[kn(1, Class::M, 0), kn(1, Class::M, 20), k(3), k(1)],
        )
        .unwrap();
        assert_eq!(plc.m(20, 13), "0000110010100");
    }

    #[test]
    fn a_queue_fills_and_empties_in_order() {
        let mut plc = Double::new();
        let (write, read) = ([reg(0), reg(1), k(4)], [reg(1), reg(20), k(4)]);
        for value in 1..=4 {
            plc.set_d(0, &[value]);
            plc.call(RtFn::Sfwr, &write).unwrap();
            assert_eq!(carry(&plc), value == 4);
        }
        assert_eq!(plc.d(1, 5), [3, 1, 2, 3, 0]);
        for value in 1..=3 {
            plc.call(RtFn::Sfrd, &read).unwrap();
            assert_eq!(
                (plc.d(20, 1), plc.bit(Class::M, 8020)),
                ([value].to_vec(), Some(false))
            );
        }
        plc.call(RtFn::Sfrd, &read).unwrap();
        assert_eq!(
            (plc.d(20, 1), plc.bit(Class::M, 8020)),
            ([3].to_vec(), Some(true))
        );
        plc.set_d(1, &[-1]);
        assert_eq!(plc.call(RtFn::Sfwr, &write), Err(Fault::VALUE));
    }

    #[test]
    fn the_hm_queue_is_a_stack() {
        let mut plc = Double::new();
        for value in 1..=4 {
            plc.set_d(0, &[value]);
            plc.call(RtFn::SfwrHm, &[reg(0), reg(1), k(3)]).unwrap();
            assert_eq!(carry(&plc), value == 4);
        }
        assert_eq!(plc.d(1, 5), [3, 3, 2, 1, 0]);
        for value in [3, 2, 1, 1] {
            plc.call(RtFn::SfrdHm, &[reg(1), reg(20), k(3)]).unwrap();
            assert_eq!(plc.d(20, 1), [value]);
        }
        assert_eq!(plc.d(1, 5), [0, 1, 1, 1, 0]);
    }

    #[test]
    fn pop_takes_the_newest() {
        let mut plc = Double::new().with_d(1, &[2, 11, 22, 33]);
        plc.call(RtFn::Pop, &[reg(1), reg(20), k(4)]).unwrap();
        assert_eq!((plc.d(20, 1), plc.d(1, 1)), ([22].to_vec(), [1].to_vec()));
        assert_eq!(plc.bit(Class::M, 8020), Some(false));
        plc.call(RtFn::Pop, &[reg(1), reg(20), k(4)]).unwrap();
        assert_eq!(
            (plc.d(20, 1), plc.bit(Class::M, 8020)),
            ([11].to_vec(), Some(true))
        );
        plc.set_d(1, &[4]);
        assert_eq!(
            plc.call(RtFn::Pop, &[reg(1), reg(20), k(4)]),
            Err(Fault::VALUE)
        );
    }

    proptest! {
        #[test]
        fn rcl_undoes_rcr(value: i16, on: bool, n in 1i32..=16) {
            let mut plc = Double::new().with_d(0, &[value.into()]);
            plc.set_bit(Class::M, 8022, on);
            plc.call(RtFn::Rcr, &[reg(0), k(n)]).unwrap();
            plc.call(RtFn::Rcl, &[reg(0), k(n)]).unwrap();
            prop_assert_eq!((plc.d(0, 1)[0], carry(&plc)), (value, on));
        }
    }
}
