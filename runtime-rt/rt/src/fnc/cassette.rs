//! Extension file registers: FNC 290–292, 294 and 295 of the FX3 programming manual. ER keeps a second value for each
//! R, in a memory cassette on the PLC. The compiler passes the ER devices with the numbers of S after the operands that
//! the program names.

use crate::cx::Cx;
use crate::fault::{Done, Fault};
use crate::special::M_COMPLETE;

/// Registers of a sector.
const SECTOR: i32 = 2048;
/// Value of an erased register.
const ERASED: i16 = -1;

/// Copies `count` words from offset `first` on.
fn copy(cx: &mut Cx, from: usize, to: usize, first: i32, count: i32) -> Done {
    for n in first..first + count {
        let value = cx.word(from, n)?;
        cx.set_word(to, n, value)?;
    }
    Ok(())
}

/// LOADR S n (FNC 290): R takes n values of ER over, from number S on.
pub fn loadr(cx: &mut Cx) -> Done {
    let n = cx.count(1, 1..=i32::from(i16::MAX))?;
    cx.check_words(0, n)?;
    copy(cx, 2, 0, 0, n)
}

/// RWER S n (FNC 294): ER takes n values of R over, from number S on.
pub fn rwer(cx: &mut Cx) -> Done {
    let n = cx.count(1, 1..=i32::from(i16::MAX))?;
    cx.check_words(2, n)?;
    copy(cx, 0, 2, 0, n)
}

/// SAVER S n D (FNC 291): writes the sector that begins at S to ER, n words in each scan; D counts them. M8029 is on
/// when it is whole.
pub fn saver(cx: &mut Cx) -> Done {
    let begins = cx.drive() && !cx.was_driven(0);
    if !cx.drive() {
        // The next drive begins anew.
        cx.was_driven(0);
        return Ok(());
    }
    sector_head(cx)?;
    let n = cx.count(1, 1..=SECTOR)?;
    let done = if begins {
        0
    } else {
        i32::from(cx.word(2, 0)?).clamp(0, SECTOR)
    };
    let portion = n.min(SECTOR - done);
    cx.check_words(3, SECTOR)?;
    copy(cx, 0, 3, done, portion)?;
    cx.set_word(2, 0, (done + portion) as i16)?;
    if portion > 0 && done + portion == SECTOR {
        cx.set_special(M_COMPLETE, true);
    }
    Ok(())
}

/// Faults unless S begins a sector.
fn sector_head(cx: &Cx) -> Done {
    match cx.ops.first() {
        Some(op) if op.value % SECTOR == 0 => Ok(()),
        _ => Err(Fault::DEVICE),
    }
}

/// Erases n sectors of the operands in `which`.
fn erase(cx: &mut Cx, which: &[usize]) -> Done {
    sector_head(cx)?;
    let words = cx.count(1, 1..=16)? * SECTOR;
    which.iter().try_for_each(|&i| cx.check_words(i, words))?;
    for &i in which {
        (0..words).try_for_each(|n| cx.set_word(i, n, ERASED))?;
    }
    Ok(())
}

/// INITR S n (FNC 292): erases n sectors of R and ER.
pub fn initr(cx: &mut Cx) -> Done {
    erase(cx, &[0, 2])
}

/// INITER S n (FNC 295): erases n sectors of ER.
pub fn initer(cx: &mut Cx) -> Done {
    erase(cx, &[2])
}

#[cfg(test)]
mod tests {
    use crate::double::Double;
    use crate::{Class, Fault, Operand, Plc, RtFn, d, k};

    fn r(n: i32) -> Operand {
        d(Class::R, n)
    }

    fn er(n: i32) -> Operand {
        d(Class::ER, n)
    }

    #[test]
    fn registers_are_loaded_and_rewritten() {
        let mut plc = Double::new();
        plc.set_word(Class::R, 5, 7).unwrap();
        plc.call(RtFn::Rwer, &[r(4), k(2), er(4)]).unwrap();
        assert_eq!(plc.word(Class::ER, 5), Some(7));
        plc.set_word(Class::R, 5, 0).unwrap();
        plc.call(RtFn::Loadr, &[r(5), k(1), er(5)]).unwrap();
        assert_eq!(plc.word(Class::R, 5), Some(7));
        assert_eq!(
            plc.call(RtFn::Loadr, &[r(32767), k(2), er(32767)]),
            Err(Fault::DEVICE)
        );
    }

    #[test]
    fn a_sector_is_saved_in_portions() {
        let ops = [r(2048), k(2000), d(Class::D, 0), er(2048)];
        let mut plc = Double::new();
        plc.set_word(Class::R, 4095, 9).unwrap();
        plc.scan(10, true, RtFn::Saver, &ops).unwrap();
        assert_eq!(
            (plc.d(0, 1), plc.word(Class::ER, 4095)),
            ([2000].to_vec(), Some(0))
        );
        plc.scan(10, true, RtFn::Saver, &ops).unwrap();
        assert_eq!(
            (plc.d(0, 1), plc.word(Class::ER, 4095)),
            ([2048].to_vec(), Some(9))
        );
        assert_eq!(plc.bit(Class::M, 8029), Some(true));
        plc.scan(10, false, RtFn::Saver, &ops).unwrap();
        plc.scan(10, true, RtFn::Saver, &ops).unwrap();
        assert_eq!(plc.d(0, 1), [2000]);
    }

    #[test]
    fn sectors_are_erased_from_their_heads() {
        let mut plc = Double::new();
        plc.call(RtFn::Initr, &[r(0), k(1), er(0)]).unwrap();
        assert_eq!(
            (plc.word(Class::R, 2047), plc.word(Class::ER, 0)),
            (Some(-1), Some(-1))
        );
        plc.call(RtFn::Initer, &[r(2048), k(1), er(2048)]).unwrap();
        assert_eq!(
            (plc.word(Class::R, 2048), plc.word(Class::ER, 2048)),
            (Some(0), Some(-1))
        );
        assert_eq!(
            plc.call(RtFn::Initr, &[r(1), k(1), er(1)]),
            Err(Fault::DEVICE)
        );
    }
}
