//! Reading a servo amplifier: FNC 155 (h1u-h2u-programming §4.3.11; its lost figures are those of the amplifiers'
//! makers).

use crate::cx::Cx;
use crate::fault::Done;
use crate::special::M_COMPLETE;

/// The amplifier's signals, from S on: two bits of data, and that it is ready.
const READY: i32 = 2;
/// The PLC's, from D1 on.
const SERVO_ON: i32 = 0;
const TRANSFER: i32 = 1;
const REQUEST: i32 = 2;

/// Pairs of bits: of the position, and of the sum of those.
const OF_POSITION: i32 = 16;
const OF_SUM: i32 = 3;

/// Word of the memory with how far it is.
const STAGE: usize = 1;
/// It waits for the amplifier to be ready.
const WAITS: i32 = 0;
/// It has requested two bits.
const ASKS: i32 = 1;
/// It has read all.
const DONE: i32 = 2;
/// Words with the number of pairs read, the position, the sum of its pairs, and the sum received.
const PAIRS: usize = 2;
const POSITION: usize = 3;
const SUM: usize = 4;
const RECEIVED: usize = 5;

/// ABS S D1 D2 (FNC 155): reads the absolute position of a servo into the pair D2, two bits at a time, the lowest
/// first. With its drive it switches the servo on and asks for the transfer; for each pair of bits it makes a request,
/// which the amplifier answers by going unready. M8029 is on once all is read; if the sum is wrong it reads anew. It
/// breaks off with its drive.
pub fn abs(cx: &mut Cx) -> Done {
    let driven = cx.was_driven(0);
    if !cx.drive() {
        if driven {
            cx.state().0 = [0; 8];
            cx.set_bits(1, 0, 3, 0)?;
            cx.set_special(M_COMPLETE, false);
        }
        return Ok(());
    }
    cx.dword(2, 0)?;
    let data = cx.bits(0, 0, 2)? as i32;
    let ready = cx.bit(0, READY)?;
    let stage = cx.state().0[STAGE];
    match (stage, ready) {
        (WAITS, true) => cx.state().0[STAGE] = ASKS,
        (ASKS, false) => take(cx, data)?,
        _ => {}
    }
    let stage = cx.state().0[STAGE];
    cx.set_bit(1, SERVO_ON, true)?;
    cx.set_bit(1, TRANSFER, stage != DONE)?;
    cx.set_bit(1, REQUEST, stage == ASKS)?;
    cx.set_special(M_COMPLETE, stage == DONE);
    Ok(())
}

/// Takes a pair of bits.
fn take(cx: &mut Cx, data: i32) -> Done {
    let state = cx.state();
    let pairs = state.0[PAIRS];
    state.0[STAGE] = WAITS;
    state.0[PAIRS] = pairs + 1;
    if pairs < OF_POSITION {
        state.0[POSITION] |= data << (2 * pairs);
        state.0[SUM] += data;
    } else {
        state.0[RECEIVED] |= data << (2 * (pairs - OF_POSITION));
    }
    if pairs + 1 < OF_POSITION + OF_SUM {
        return Ok(());
    }
    let [.., position, sum, received, _, _] = state.0;
    state.0[PAIRS..=RECEIVED].fill(0);
    if sum == received {
        state.0[STAGE] = DONE;
        cx.set_dword(2, 0, position)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::RtFn;
    use crate::double::{Double, reg, relay};
    use std::vec::Vec;

    /// An amplifier at M0…M2 and M10…M12; returns how many scans it took.
    fn read(plc: &mut Double, position: i32, wrong: usize) -> usize {
        let pairs: Vec<i32> = (0..16).map(|i| position >> (2 * i) & 3).collect();
        let sum: i32 = pairs.iter().sum();
        let sums = (0..3).map(|i| sum >> (2 * i) & 3);
        let mut sent = pairs.iter().copied().chain(sums).cycle();
        let mut asked = false;
        for scan in 0..200 {
            plc.scan(10, true, RtFn::Abs, &[relay(0), relay(10), reg(100)])
                .unwrap();
            if plc.m(8029, 1) == "1" {
                return scan;
            }
            assert_eq!(plc.m(10, 2), "11");
            let asks = plc.m(12, 1) == "1";
            if asks && !asked {
                let mut pair = sent.next().unwrap();
                if scan < wrong {
                    pair ^= 1;
                }
                plc.set_m(0, ["000", "100", "010", "110"][pair as usize]);
            } else if !asks {
                plc.set_m(2, "1");
            }
            asked = asks;
        }
        panic!("it does not end");
    }

    #[test]
    fn positions_are_read_in_pairs_of_bits() {
        for position in [-10, 0, 123_456_789, i32::MIN] {
            let mut plc = Double::wide();
            read(&mut plc, position, 0);
            assert_eq!((plc.dd(100), plc.m(10, 3)), (position, "100".into()));
            let ops = [relay(0), relay(10), reg(100)];
            plc.scan(10, false, RtFn::Abs, &ops).unwrap();
            assert_eq!((plc.m(10, 3), plc.m(8029, 1)), ("000".into(), "0".into()));
        }
    }

    #[test]
    fn a_wrong_sum_makes_it_read_anew() {
        let mut plc = Double::wide();
        let once = read(&mut plc, 1000, 0);
        let mut plc = Double::wide();
        assert!(read(&mut plc, 1000, 3) > once);
        assert_eq!(plc.dd(100), 1000);
    }
}
