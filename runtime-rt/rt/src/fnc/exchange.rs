//! Modules that registers stand for: the extension modules of HM (hm-motion-controller §7), the analog boards of H1U
//! and H2U (h1u-h2u-programming §6.7), and the analog adapters and boards of FX.

use crate::cx::Cx;
use crate::fault::Done;
use crate::modules::{BOARD, EXCHANGE, REGISTERS};

/// Exchange with a board: numbers of words sent and of words answered. The last of the answer counts the errors.
const SENT: u16 = 9;
const ANSWERED: u16 = 9;

/// Words between the first one sent and the first one answered.
const ANSWER: u16 = 10;

/// The type of an analog board in D8199.
const ANALOG: i16 = 5;

/// A module of HM, once a scan after the program: when the period is over, the words of D after the first `reads` go to
/// the module and its first `reads` words go to D, n words altogether. `period` is the first of four registers: the
/// periods of digital and analog modules, and what they measured. Memory: milliseconds since the last exchange.
pub fn exchange_module(cx: &mut Cx) -> Done {
    const PERIOD: usize = 4;
    let dt = cx.dt_ms();
    let since = cx.state().0[0].saturating_add(dt);
    cx.set_word(PERIOD, 2, dt.min(i16::MAX.into()) as i16)?;
    if since < i32::from(cx.word(PERIOD, 1)?) {
        cx.state().0[0] = since;
        return Ok(());
    }
    cx.state().0[0] = 0;
    cx.set_word(PERIOD, 3, since.min(i16::MAX.into()) as i16)?;
    let unit = cx.word(0, 0)? as u16;
    let (reads, n) = (cx.word(2, 0)?, cx.word(3, 0)?);
    for word in reads..n {
        let value = cx.word(1, word.into())?;
        let _ = cx.hal().write_bfm(unit, word as u16, value);
    }
    for word in 0..reads {
        if let Some(value) = cx.hal().read_bfm(unit, word as u16) {
            cx.set_word(1, word.into(), value)?;
        }
    }
    Ok(())
}

/// The analog board, once a scan before the program, if S (D8199) is its type: D (D8220) and the following go to it,
/// and its answer goes to D8230 and the following. D8239 counts exchanges that fail in a row.
pub fn exchange_board(cx: &mut Cx) -> Done {
    if cx.word(0, 0)? != ANALOG {
        return Ok(());
    }
    let mut answers = true;
    for word in 0..SENT {
        let value = cx.word(1, word.into())?;
        answers &= cx.hal().write_bfm(BOARD, word, value).is_some();
    }
    for word in ANSWER..ANSWER + ANSWERED {
        match cx.hal().read_bfm(BOARD, word) {
            Some(value) => cx.set_word(1, word.into(), value)?,
            None => answers = false,
        }
    }
    let errors = i32::from(ANSWER + ANSWERED);
    let failed = match answers {
        true => 0,
        false => cx.word(1, errors)?.saturating_add(1),
    };
    cx.set_word(1, errors, failed)
}

/// An analog adapter or board of FX: relays from M on and registers from D on, whose words have a bit in `sent`, go
/// to the module; it converts its inputs, and its words with a bit in `received` go to registers, if there is one.
/// Registers of a module that does not answer stay as they are.
pub fn exchange_adapter(cx: &mut Cx) -> Done {
    let unit = cx.word(0, 0)? as u16;
    let (sent, received) = (cx.dword(3, 0)?, cx.dword(4, 0)?);
    let words = |bits: i32| (0..EXCHANGE).filter(move |word| bits >> word & 1 != 0);
    for word in words(sent) {
        let value = match word.checked_sub(REGISTERS) {
            Some(register) => cx.word(2, register.into())?,
            None => cx.bit(1, word.into())?.into(),
        };
        let _ = cx.hal().write_bfm(unit, word, value);
    }
    if received != 0 {
        let _ = cx.hal().write_bfm(unit, EXCHANGE, 1);
    }
    for word in words(received) {
        if let Some(value) = cx.hal().read_bfm(unit, word) {
            cx.set_word(2, i32::from(word) - i32::from(REGISTERS), value)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::double::Double;
    use crate::modules::{BOARD, Kind, Quantity, Signal};
    use crate::{Class, Operand, RtFn, d, k};

    #[test]
    fn a_module_is_exchanged_when_its_period_is_over() {
        let mut plc = Double::new().with_d(7143, &[60, 60, 0, 0]);
        plc.hal.fit(2, Kind::find("EX1-2AD/2DA").unwrap()).unwrap();
        let signal = Signal {
            quantity: Quantity::Volts,
            millionths: 5_000_000,
        };
        plc.hal.set_signal(2, 1, signal).unwrap();
        plc.set_d(7200, &[0, 0, 5, 0, 0, 6, 0, 2000]);
        let ops: [Operand; 5] = [k(2), d(Class::D, 7200), k(2), k(8), d(Class::D, 7143)];
        let scans = |plc: &mut Double, scans: u32| {
            for _ in 0..scans {
                plc.scan(10, true, RtFn::ExchangeModule, &ops).unwrap();
            }
        };
        scans(&mut plc, 5);
        assert_eq!(plc.hal.signal(2, 4, Quantity::Milliamperes), Some(0));
        scans(&mut plc, 1);
        assert_eq!(plc.d(7145, 2), [10, 60]);
        assert_eq!(
            plc.hal.signal(2, 4, Quantity::Milliamperes),
            Some(10_000_000)
        );
        plc.hal.advance_to(1000);
        scans(&mut plc, 6);
        assert_eq!(plc.d(7200, 8), [10_000, 0, 5, 0, 0, 6, 0, 2000]);
    }

    #[test]
    fn a_board_answers_or_is_missed() {
        let mut plc = Double::new().with_d(8239, &[1]);
        let ops: [Operand; 2] = [k(5), d(Class::D, 8220)];
        plc.call(RtFn::ExchangeBoard, &ops).unwrap();
        assert_eq!(plc.d(8239, 1), [2]);
        plc.hal
            .fit(BOARD, Kind::find("H2U-6A-BD").unwrap())
            .unwrap();
        plc.set_d(8221, &[10_000]);
        plc.call(RtFn::ExchangeBoard, &ops).unwrap();
        assert_eq!(plc.d(8230, 10), [0x6a42, 0, 0, 0, 0, 10_000, 0, 0, 0, 0]);
        plc.call(RtFn::ExchangeBoard, &[k(1), ops[1]]).unwrap();
    }

    #[test]
    fn an_adapter_takes_and_gives_the_words_it_has() {
        let mut plc = Double::new();
        let ops: [Operand; 5] = [
            k(202),
            d(Class::M, 8260),
            d(Class::D, 8260),
            k(0b1111_0000_0000_1111),
            k(0b1111 << 10 | 0b11 << 18),
        ];
        plc.set_d(8260, &[7, 7, 7, 7, 1, 1, 1, 1, 7, 7]);
        plc.set_m(8260, "0100000000");
        // Without the module, its registers stay as they are.
        plc.call(RtFn::ExchangeAdapter, &ops).unwrap();
        assert_eq!(plc.d(8260, 10), [7, 7, 7, 7, 1, 1, 1, 1, 7, 7]);
        let kind = Kind::find("FX3U-4AD-ADP").unwrap();
        plc.hal.fit(202, kind).unwrap();
        for (channel, quantity, millionths) in [
            (1, Quantity::Volts, 5_000_000),
            (2, Quantity::Milliamperes, 20_000_000),
        ] {
            let signal = Signal {
                quantity,
                millionths,
            };
            plc.hal.set_signal(202, channel, signal).unwrap();
        }
        plc.call(RtFn::ExchangeAdapter, &ops).unwrap();
        assert_eq!(plc.d(8260, 10), [2000, 1600, 0, 0, 1, 1, 1, 1, 0, 1]);
    }
}
