//! Blocks of words, tables, bytes and nibbles: FNC 140–149 and 184–211 of the FX3 programming manual, l01s-programming
//! §4.2.

use crate::cx::Cx;
use crate::fault::{Done, Fault};
use crate::plc::Class;
use crate::special::{D_RANDOM, M_BLOCK_COMPARE};
use core::cmp::Ordering;

/// D[i] = S1[i] op S2[i] for n elements; S2 may be a constant. Wraps, touches no flag.
fn elementwise(cx: &mut Cx, op: fn(i32, i32) -> i32) -> Done {
    let n = cx.count(3, 1..=i32::from(i16::MAX))?;
    cx.check_elems(0, n)?;
    cx.check_elems(1, n)?;
    cx.check_elems(2, n)?;
    for i in 0..n {
        let value = op(cx.elem(0, i)?, cx.elem(1, i)?);
        cx.set_elem(2, i, value)?;
    }
    Ok(())
}

/// BK+ S1 S2 D n (FNC 192): sums of two blocks.
pub fn bk_add(cx: &mut Cx) -> Done {
    elementwise(cx, i32::wrapping_add)
}

/// BK- S1 S2 D n (FNC 193): differences of two blocks.
pub fn bk_sub(cx: &mut Cx) -> Done {
    elementwise(cx, i32::wrapping_sub)
}

/// D[i] = S1[i] holds against S2[i] for n elements; S1 may be a constant. M8090 shows whether all held.
fn compare(cx: &mut Cx, holds: fn(Ordering) -> bool) -> Done {
    let n = cx.count(3, 1..=i32::from(i16::MAX))?;
    cx.check_elems(0, n)?;
    cx.check_elems(1, n)?;
    cx.check_bits(2, n)?;
    let mut all = true;
    for i in 0..n {
        let on = holds(cx.elem(0, i)?.cmp(&cx.elem(1, i)?));
        cx.set_bit(2, i, on)?;
        all &= on;
    }
    cx.set_special(M_BLOCK_COMPARE, all);
    Ok(())
}

/// BKCMP= S1 S2 D n (FNC 194).
pub fn bkcmp_eq(cx: &mut Cx) -> Done {
    compare(cx, Ordering::is_eq)
}

/// BKCMP> S1 S2 D n (FNC 195).
pub fn bkcmp_gt(cx: &mut Cx) -> Done {
    compare(cx, Ordering::is_gt)
}

/// BKCMP< S1 S2 D n (FNC 196).
pub fn bkcmp_lt(cx: &mut Cx) -> Done {
    compare(cx, Ordering::is_lt)
}

/// BKCMP<> S1 S2 D n (FNC 197).
pub fn bkcmp_ne(cx: &mut Cx) -> Done {
    compare(cx, Ordering::is_ne)
}

/// BKCMP<= S1 S2 D n (FNC 198).
pub fn bkcmp_le(cx: &mut Cx) -> Done {
    compare(cx, Ordering::is_le)
}

/// BKCMP>= S1 S2 D n (FNC 199).
pub fn bkcmp_ge(cx: &mut Cx) -> Done {
    compare(cx, Ordering::is_ge)
}

/// WSUM S D n (FNC 140): sum of n words as 32 bits, of n pairs as 64 bits.
pub fn wsum(cx: &mut Cx) -> Done {
    let n = cx.count(2, 1..=i32::from(i16::MAX))?;
    let mut sum = 0i64;
    for i in 0..n {
        sum = sum.wrapping_add(i64::from(cx.elem(0, i)?));
    }
    if cx.wide() {
        cx.check_words(1, 4)?;
        cx.set_dword(1, 0, sum as i32)?;
        cx.set_dword(1, 2, (sum >> 32) as i32)
    } else {
        cx.set_dword(1, 0, sum as i32)
    }
}

/// Runs `step` for 0..n in the order that keeps an overlapping destination after the source from overwriting what is
/// still to be read.
fn in_order(
    cx: &mut Cx,
    n: i32,
    backwards: bool,
    mut step: impl FnMut(&mut Cx, i32) -> Done,
) -> Done {
    if backwards {
        (0..n).rev().try_for_each(|i| step(cx, i))
    } else {
        (0..n).try_for_each(|i| step(cx, i))
    }
}

/// WTOB S D n (FNC 141): n bytes of S, low byte first, one to a word of D.
pub fn wtob(cx: &mut Cx) -> Done {
    let n = cx.count(2, 0..=i32::from(i16::MAX))?;
    cx.check_words(0, (n + 1) / 2)?;
    cx.check_words(1, n)?;
    // The destination is longer than the source, so an overlap is safe from the end on.
    in_order(cx, n, true, |cx, i| {
        let word = cx.word(0, i / 2)? as u16;
        cx.set_word(1, i, (word >> (8 * (i % 2)) & 0xff) as i16)
    })
}

/// BTOW S D n (FNC 142): the low bytes of n words of S, low byte first, two to a word of D; a missing last byte is 0.
pub fn btow(cx: &mut Cx) -> Done {
    let n = cx.count(2, 0..=i32::from(i16::MAX))?;
    cx.check_words(0, n)?;
    cx.check_words(1, (n + 1) / 2)?;
    in_order(cx, (n + 1) / 2, false, |cx, i| {
        let low = cx.word(0, 2 * i)? & 0xff;
        let high = if 2 * i + 1 < n {
            cx.word(0, 2 * i + 1)? << 8
        } else {
            0
        };
        cx.set_word(1, i, low | high)
    })
}

/// UNI S D n (FNC 143): the low nibbles of n words of S, lowest first, in D; the others of D are 0. n = 0 does nothing.
pub fn uni(cx: &mut Cx) -> Done {
    let n = cx.count(2, 0..=4)?;
    if n == 0 {
        return Ok(());
    }
    let mut value = 0;
    for i in 0..n {
        value |= (cx.word(0, i)? & 0xf) << (4 * i);
    }
    cx.set_word(1, 0, value)
}

/// DIS S D n (FNC 144): the n lowest nibbles of S, one to a word of D. n = 0 does nothing.
pub fn dis(cx: &mut Cx) -> Done {
    let n = cx.count(2, 0..=4)?;
    let value = cx.word(0, 0)?;
    cx.check_words(1, n)?;
    (0..n).try_for_each(|i| cx.set_word(1, i, value >> (4 * i) & 0xf))
}

/// RND D (FNC 184): a pseudo-random number 0 to 32767. The seed is in D8310/D8311, so that a program can set it.
pub fn rnd(cx: &mut Cx) -> Done {
    let low = cx.special_word(D_RANDOM) as u16;
    let high = cx.special_word(D_RANDOM.after(1)) as u16;
    let seed = u32::from(high) << 16 | u32::from(low);
    let seed = seed.wrapping_mul(1_103_515_245).wrapping_add(12345);
    cx.set_word(0, 0, (seed >> 16 & 0x7fff) as i16)?;
    cx.set_special_word(D_RANDOM, seed as i16);
    cx.set_special_word(D_RANDOM.after(1), (seed >> 16) as i16);
    Ok(())
}

/// Number of entries of the table whose head is operand 1, and position n (from 1) from operand 2, at most `limit` past
/// the count.
fn table_position(cx: &Cx, past: i32) -> Result<(i32, i32), Fault> {
    let count = i32::from(cx.word(1, 0)?);
    let n = i32::from(cx.word(2, 0)?);
    if count >= 0 && (1..=count.saturating_add(past)).contains(&n) {
        Ok((count, n))
    } else {
        Err(Fault::DEVICE)
    }
}

/// FDEL S D n (FNC 210): takes entry n out of the table at D (its first word counts the entries) into S; the later ones
/// close up.
pub fn fdel(cx: &mut Cx) -> Done {
    let (count, n) = table_position(cx, 0)?;
    cx.check_words(1, count + 1)?;
    let taken = cx.word(1, n)?;
    cx.set_word(0, 0, taken)?;
    for i in n..count {
        let next = cx.word(1, i + 1)?;
        cx.set_word(1, i, next)?;
    }
    cx.set_word(1, count, 0)?;
    cx.set_word(1, 0, (count - 1) as i16)
}

/// FINS S D n (FNC 211): puts S before entry n of the table at D; the later ones move up.
pub fn fins(cx: &mut Cx) -> Done {
    let (count, n) = table_position(cx, 1)?;
    cx.check_words(1, count + 2)?;
    let value = cx.word(0, 0)?;
    for i in (n..=count).rev() {
        let entry = cx.word(1, i)?;
        cx.set_word(1, i + 1, entry)?;
    }
    cx.set_word(1, n, value)?;
    cx.set_word(1, 0, (count + 1) as i16)
}

/// Index registers that ZPUSH saves: V0–V7 and Z0–Z7.
const INDEX_PAIRS: u32 = 8;

/// ZPUSH D (FNC 102): saves Z0, V0, Z1, V1, … Z7, V7 after the batches that D counts.
pub fn zpush(cx: &mut Cx) -> Done {
    let count = i32::from(cx.word(0, 0)?);
    let first = batch(count)?;
    cx.check_words(0, first + 2 * INDEX_PAIRS as i32)?;
    for i in 0..INDEX_PAIRS {
        for (k, class) in [crate::Class::Z, crate::Class::V].into_iter().enumerate() {
            let value = cx.plc.word(class, i).ok_or(Fault::DEVICE)?;
            cx.set_word(0, first + 2 * i as i32 + k as i32, value)?;
        }
    }
    cx.set_word(0, 0, (count + 1) as i16)
}

/// ZPOP D (FNC 103): restores the newest batch that ZPUSH saved; a fault if there is none.
pub fn zpop(cx: &mut Cx) -> Done {
    let count = i32::from(cx.word(0, 0)?) - 1;
    let first = batch(count)?;
    cx.check_words(0, first + 2 * INDEX_PAIRS as i32)?;
    for i in 0..INDEX_PAIRS {
        for (k, class) in [crate::Class::Z, crate::Class::V].into_iter().enumerate() {
            let value = cx.word(0, first + 2 * i as i32 + k as i32)?;
            cx.plc.set_word(class, i, value).ok_or(Fault::DEVICE)?;
        }
    }
    cx.set_word(0, 0, count as i16)
}

/// Offset of batch number `count` (from 0).
fn batch(count: i32) -> Result<i32, Fault> {
    if (0..i32::from(i16::MAX)).contains(&count) {
        Ok(1 + count * 2 * INDEX_PAIRS as i32)
    } else {
        Err(Fault::VALUE)
    }
}

/// DUTY n1 n2 D (FNC 186): D (M8330–M8334) is on for n1 scans and off for n2 in turn, from the drive's off-to-on change
/// on, even after the drive goes off. The scan count is in D8330–D8334.
pub fn duty(cx: &mut Cx) -> Done {
    let (on, off) = (i32::from(cx.word(0, 0)?), i32::from(cx.word(1, 0)?));
    let drive = cx.drive();
    let [was_driven, active, scans, ..] = cx.state().0;
    let (mut active, mut scans) = (active, scans);
    if drive && was_driven == 0 {
        if on < 0 || off < 0 {
            return Err(Fault::VALUE);
        }
        (active, scans) = (1, 0);
    }
    if active != 0 {
        let period = on.max(0).saturating_add(off.max(0)).max(1);
        scans %= period;
        cx.set_bit(2, 0, scans < on)?;
        scans += 1;
        let register = cx.ops.get(2).map_or(0, |op| op.value as u32);
        let _ = cx.plc.set_word(Class::D, register, scans as i16);
    }
    let state = cx.state();
    state.0[0] = i32::from(drive);
    state.0[1] = active;
    state.0[2] = scans;
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::double::{Double, reg};
    use crate::{Class, Fault, Plc, RtFn, d, k};

    #[test]
    fn blocks_add_wrap_and_take_constants() {
        let mut plc = Double::new()
            .with_d(0, &[1, 32767, -3])
            .with_d(10, &[10, 1, 3]);
        plc.call(RtFn::BkAdd, &[reg(0), reg(10), reg(20), k(3)])
            .unwrap();
        assert_eq!(plc.d(20, 3), [11, i16::MIN, 0]);
        plc.call(RtFn::BkSub, &[reg(0), k(1), reg(20), k(3)])
            .unwrap();
        assert_eq!(plc.d(20, 3), [0, i16::MAX - 1, -4]);
        assert_eq!(
            plc.call(RtFn::BkAdd, &[reg(0), reg(10), reg(20), k(0)]),
            Err(Fault::VALUE)
        );
    }

    #[test]
    fn block_comparison_tells_whether_all_held() {
        let mut plc = Double::new().with_d(10, &[5, 6, 7]);
        plc.call(RtFn::BkcmpLe, &[k(6), reg(10), d(Class::M, 0), k(3)])
            .unwrap();
        let bits = |plc: &Double| {
            (0..3)
                .map(|n| plc.bit(Class::M, n).unwrap())
                .collect::<std::vec::Vec<_>>()
        };
        assert_eq!(bits(&plc), [false, true, true]);
        assert_eq!(plc.bit(Class::M, 8090), Some(false));
        plc.call(RtFn::BkcmpLt, &[k(4), reg(10), d(Class::M, 0), k(3)])
            .unwrap();
        assert_eq!(plc.bit(Class::M, 8090), Some(true));
    }

    #[test]
    fn bytes_and_nibbles_part_and_join() {
        let mut plc = Double::new().with_d(0, &[0x3412, 0x7856]);
        plc.call(RtFn::Wtob, &[reg(0), reg(10), k(3)]).unwrap();
        assert_eq!(plc.d(10, 3), [0x12, 0x34, 0x56]);
        plc.call(RtFn::Btow, &[reg(10), reg(20), k(3)]).unwrap();
        assert_eq!(plc.d(20, 2), [0x3412, 0x56]);
        plc.call(RtFn::Dis, &[reg(0), reg(30), k(3)]).unwrap();
        assert_eq!(plc.d(30, 3), [2, 1, 4]);
        plc.call(RtFn::Uni, &[reg(30), reg(40), k(3)]).unwrap();
        assert_eq!(plc.d(40, 1), [0x412]);
        assert_eq!(
            plc.call(RtFn::Uni, &[reg(30), reg(40), k(5)]),
            Err(Fault::VALUE)
        );
    }

    #[test]
    fn tables_lose_and_gain_entries() {
        let mut plc = Double::new().with_d(0, &[3, 10, 20, 30]);
        plc.call(RtFn::Fdel, &[reg(100), reg(0), k(2)]).unwrap();
        assert_eq!(
            (plc.d(100, 1), plc.d(0, 4)),
            ([20].to_vec(), [2, 10, 30, 0].to_vec())
        );
        plc.call(RtFn::Fins, &[k(5), reg(0), k(1)]).unwrap();
        assert_eq!(plc.d(0, 4), [3, 5, 10, 30]);
        assert_eq!(
            plc.call(RtFn::Fdel, &[reg(100), reg(0), k(4)]),
            Err(Fault::DEVICE)
        );
        assert_eq!(
            plc.call(RtFn::Fins, &[k(5), reg(0), k(5)]),
            Err(Fault::DEVICE)
        );
    }

    #[test]
    fn index_registers_are_pushed_and_popped() {
        let mut plc = Double::new();
        plc.set_word(Class::Z, 3, 7).unwrap();
        plc.call(RtFn::Zpush, &[reg(0)]).unwrap();
        assert_eq!((plc.d(0, 1), plc.d(7, 1)), ([1].to_vec(), [7].to_vec()));
        plc.set_word(Class::Z, 3, 0).unwrap();
        plc.call(RtFn::Zpop, &[reg(0)]).unwrap();
        assert_eq!(plc.word(Class::Z, 3), Some(7));
        assert_eq!(plc.call(RtFn::Zpop, &[reg(0)]), Err(Fault::VALUE));
    }

    #[test]
    fn random_numbers_follow_the_seed() {
        let mut plc = Double::new();
        plc.set_word(Class::D, 8310, 1).unwrap();
        plc.call(RtFn::Rnd, &[reg(0)]).unwrap();
        assert_eq!(plc.d(0, 1), [16838]);
    }
}
