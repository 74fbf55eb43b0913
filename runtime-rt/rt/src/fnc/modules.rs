//! Terminals and modules: FNC 50, 51, 78, 79, 176, 177, 278 and 279, h1u-h2u-programming §4.3.6 and §4.3.8.

use crate::comm::can::{D_TIME_OUT, M_LATE};
use crate::cx::Cx;
use crate::fault::{Done, Fault};
use crate::plc::Class;
use crate::registry::RtFn;
use crate::special::{
    D_ANALOG_INPUTS, D_ANALOG_OUTPUTS, D_INPUT_FILTER, D_OUTPUT_USE, D_TRANSFER_COUNT, M_COMPLETE,
    M_TRANSFER_COUNT,
};

/// Direction of a transfer between devices and the buffer memory of a module.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Transfer {
    /// From the module to devices.
    FromModule,
    /// From devices to the module.
    ToModule,
}

impl RtFn {
    /// Direction in which the function transfers words of the module that its first operand names, from the address in
    /// its second one on: FROM, TO, RBFM and WBFM of all models.
    pub fn transfer(self) -> Option<Transfer> {
        match self {
            RtFn::From | RtFn::FromStated | RtFn::FromHost | RtFn::FromRemote | RtFn::Rbfm => {
                Some(Transfer::FromModule)
            }
            RtFn::To | RtFn::ToStated | RtFn::ToHost | RtFn::ToRemote | RtFn::Wbfm => {
                Some(Transfer::ToModule)
            }
            _ => None,
        }
    }
}

/// The run of terminals that operand 0 and the count in operand 1, a multiple of 8, name.
fn terminals(cx: &Cx) -> Result<(Class, core::ops::Range<u16>), Fault> {
    let count = cx.count(1, 8..=256)?;
    if count % 8 != 0 {
        return Err(Fault::VALUE);
    }
    let op = cx.ops.first().ok_or(Fault::DEVICE)?;
    let end = op
        .value
        .checked_add(count)
        .and_then(|n| u16::try_from(n).ok());
    match (op.class, u16::try_from(op.value), end) {
        (class @ (Class::X | Class::Y), Ok(first), Some(end)) => Ok((class, first..end)),
        _ => Err(Fault::DEVICE),
    }
}

/// Refreshes terminals now, leaving out outputs that are not `ours`.
fn refresh(cx: &mut Cx, ours: fn(&Cx, u16) -> bool) -> Done {
    let (class, run) = terminals(cx)?;
    for number in run {
        if class == Class::Y {
            let on = cx.plc.bit(class, number.into()).unwrap_or(false);
            if ours(cx, number) {
                cx.hal().set_output(number, on);
            }
        } else if let Some(on) = cx.hal().input(number) {
            // Inputs that the program does not look at are not kept.
            let _ = cx.plc.set_bit(class, number.into(), on);
        }
    }
    Ok(())
}

/// REF D n (FNC 50): reads n inputs, or sends n outputs, from D on now.
pub fn refresh_terminals(cx: &mut Cx) -> Done {
    refresh(cx, |_, _| true)
}

/// REF of HM: outputs that an axis uses (D8180 … not 0) are left out.
pub fn refresh_terminals_hm(cx: &mut Cx) -> Done {
    refresh(cx, |cx, number| {
        number >= 16 || cx.special_word(D_OUTPUT_USE.after(number.into())) == 0
    })
}

/// REFF n (FNC 51): sets the filter of X0–X7 to n milliseconds, and reads them now.
pub fn reff(cx: &mut Cx) -> Done {
    let n = cx.count(0, 0..=60)?;
    cx.set_special_word(D_INPUT_FILTER, n as i16);
    for number in 0..8 {
        if let Some(on) = cx.hal().input(number) {
            let _ = cx.plc.set_bit(Class::X, number.into(), on);
        }
    }
    Ok(())
}

/// Number of a module, or address in its buffer memory, at operand `i`.
fn place(cx: &Cx, i: usize) -> Result<u16, Fault> {
    u16::try_from(cx.count(i, 0..=32_767)?).map_err(|_| Fault::VALUE)
}

/// Number of elements that FROM and TO move: operand 3, or with M8164 D8164.
fn transfer_count(cx: &Cx) -> Result<i32, Fault> {
    let n = match cx.special(M_TRANSFER_COUNT) {
        true => cx.special_word(D_TRANSFER_COUNT).into(),
        false => cx.read(3)?,
    };
    if (1..=32_767).contains(&n) {
        Ok(n)
    } else {
        Err(Fault::VALUE)
    }
}

/// Address of word `n` after `address`.
fn address_of(address: u16, n: i32) -> Result<u16, Fault> {
    u16::try_from(i32::from(address) + n).map_err(|_| Fault::MODULE)
}

/// A word of buffer memory.
fn read(cx: &mut Cx, unit: u16, address: u16) -> Result<i16, Fault> {
    cx.hal().read_bfm(unit, address).ok_or(Fault::MODULE)
}

/// Writes a word of buffer memory.
fn write(cx: &mut Cx, unit: u16, address: u16, value: i16) -> Done {
    cx.hal()
        .write_bfm(unit, address, value)
        .ok_or(Fault::MODULE)
}

/// FROM m1 m2 D n (FNC 78): n words, or pairs, of module m1 from address m2 on go to D; with M8164 the count is D8164.
pub fn from(cx: &mut Cx) -> Done {
    let n = transfer_count(cx)?;
    read_elements(cx, n)
}

/// FROM of FX1N and FX3, which have no M8164.
pub fn from_stated(cx: &mut Cx) -> Done {
    let n = cx.count(3, 1..=32_767)?;
    read_elements(cx, n)
}

fn read_elements(cx: &mut Cx, n: i32) -> Done {
    let (unit, address) = (place(cx, 0)?, place(cx, 1)?);
    cx.check_elems(2, n)?;
    for k in 0..n {
        let value = if cx.wide() {
            let low = read(cx, unit, address_of(address, 2 * k)?)?;
            let high = read(cx, unit, address_of(address, 2 * k + 1)?)?;
            crate::word::pair(low, high)
        } else {
            read(cx, unit, address_of(address, k)?)?.into()
        };
        cx.set_elem(2, k, value)?;
    }
    Ok(())
}

/// FROM of L01S: where there is no module 0, that number means the host, whose first words are its analog inputs
/// (l01s-programming §5.1.2). One that is not wired is as its register shows it, D8030 and so on.
pub fn from_host(cx: &mut Cx) -> Done {
    let (unit, address) = (place(cx, 0)?, place(cx, 1)?);
    if unit != 0 || cx.hal().read_bfm(unit, address).is_some() {
        return from(cx);
    }
    let n = transfer_count(cx)?;
    cx.check_words(2, n)?;
    if i32::from(address) + n > ANALOG_CHANNELS {
        return Err(Fault::MODULE);
    }
    for k in 0..n {
        let channel = address as u8 + k as u8;
        let value = match cx.hal().analog(channel) {
            Some(value) => value,
            None => cx.special_word(D_ANALOG_INPUTS.after(channel.into())),
        };
        cx.set_word(2, k, value)?;
    }
    Ok(())
}

/// TO m1 m2 S n (FNC 79): n words, or pairs, from S on go to module m1 from address m2 on; with M8164 the count is
/// D8164.
pub fn to(cx: &mut Cx) -> Done {
    let n = transfer_count(cx)?;
    write_elements(cx, n)
}

/// TO of FX1N and FX3, which have no M8164.
pub fn to_stated(cx: &mut Cx) -> Done {
    let n = cx.count(3, 1..=32_767)?;
    write_elements(cx, n)
}

fn write_elements(cx: &mut Cx, n: i32) -> Done {
    let (unit, address) = (place(cx, 0)?, place(cx, 1)?);
    cx.check_elems(2, n)?;
    for k in 0..n {
        let value = cx.elem(2, k)?;
        if cx.wide() {
            let [low, high] = crate::word::words(value);
            write(cx, unit, address_of(address, 2 * k)?, low)?;
            write(cx, unit, address_of(address, 2 * k + 1)?, high)?;
        } else {
            write(cx, unit, address_of(address, k)?, value as i16)?;
        }
    }
    Ok(())
}

/// Numbers of remote modules of H1U and H2U: 100 and the station on CAN.
const REMOTE: core::ops::RangeInclusive<u16> = 101..=163;

/// Time-out of FROM and TO for a remote module (h1u-h2u-programming §5.9.5), in milliseconds.
const PATIENCE_MS: core::ops::RangeInclusive<i16> = 5..=1000;

/// Reads or writes a module of H1U or H2U. A remote one that has not answered within D8299 ms switches M8299 on, which
/// the program switches off.
fn exchange_remotely(cx: &mut Cx, exchange: fn(&mut Cx) -> Done) -> Done {
    let unit = place(cx, 0)?;
    if !REMOTE.contains(&unit) {
        return exchange(cx);
    }
    let ms = cx.special_word(D_TIME_OUT);
    let ms = ms.clamp(*PATIENCE_MS.start(), *PATIENCE_MS.end()) as u16;
    if cx.hal().module_answers(unit, ms) {
        let done = exchange(cx);
        // A module that has a first word, but not this one, has answered.
        if done != Err(Fault::MODULE) || cx.hal().read_bfm(unit, 0).is_some() {
            return done;
        }
    }
    cx.set_special(M_LATE, true);
    Err(Fault::NO_ANSWER)
}

/// FROM of H1U and H2U, whose modules may be remote.
pub fn from_remote(cx: &mut Cx) -> Done {
    exchange_remotely(cx, from)
}

/// TO of H1U and H2U, whose modules may be remote.
pub fn to_remote(cx: &mut Cx) -> Done {
    exchange_remotely(cx, to)
}

/// Number of built-in analog inputs of L01S, and of its outputs.
const ANALOG_CHANNELS: i32 = 8;

/// TO of L01S: where there is no module 0, that number means the host, whose first words are its analog outputs (D8050
/// …).
pub fn to_host(cx: &mut Cx) -> Done {
    let (unit, address) = (place(cx, 0)?, place(cx, 1)?);
    if unit != 0 || cx.hal().read_bfm(unit, address).is_some() {
        return to(cx);
    }
    let n = transfer_count(cx)?;
    cx.check_words(2, n)?;
    if i32::from(address) + n > ANALOG_CHANNELS {
        return Err(Fault::MODULE);
    }
    for k in 0..n {
        let value = cx.word(2, k)?;
        let channel = u32::from(address) + k as u32;
        cx.set_special_word(D_ANALOG_OUTPUTS.after(channel), value);
    }
    Ok(())
}

/// Buffer memory of FX0N-3A, FX2N-2AD and FX2N-2DA: converted value, the four high bits of the one of FX2N-2AD, value
/// to convert, control.
const INPUT_VALUE: u16 = 0;
const INPUT_HIGH: u16 = 1;
const OUTPUT_VALUE: u16 = 16;
const CONTROL: u16 = 17;
/// Channel 1 of the modules of twelve bits.
const TWELVE_BITS: i32 = 21;

/// RD3A m1 m2 D (FNC 176): an analog input of the module at position m1 goes to D: m2 is 1 or 2 of an FX0N-3A, 21 or 22
/// of an FX2N-2AD.
pub fn rd3a(cx: &mut Cx) -> Done {
    let unit = place(cx, 0)?;
    let (first, twelve_bits) = match cx.count(1, 1..=TWELVE_BITS + 1)? {
        channel @ 1..=2 => (channel - 1, false),
        channel @ TWELVE_BITS.. => (channel - TWELVE_BITS, true),
        _ => return Err(Fault::VALUE),
    };
    let channel = first as i16;
    cx.word(2, 0)?;
    // The rise of control bit 1 starts a conversion of the channel in bit 0.
    write(cx, unit, CONTROL, channel)?;
    write(cx, unit, CONTROL, channel | 2)?;
    let mut value = read(cx, unit, INPUT_VALUE)?;
    if twelve_bits {
        value = value & 0xff | (read(cx, unit, INPUT_HIGH)? & 0x0f) << 8;
    }
    cx.set_word(2, 0, value)
}

/// WR3A m1 m2 S (FNC 177): S goes to an analog output of the module at position m1: with m2 = 1 S, 0 to 255, to that of
/// an FX0N-3A, with 21 or 22 S, 0 to 4095, to one of an FX2N-2DA.
pub fn wr3a(cx: &mut Cx) -> Done {
    let unit = place(cx, 0)?;
    // The fall of a control bit starts the conversion.
    let start = match cx.count(1, 1..=TWELVE_BITS + 1)? {
        1 => {
            let value = cx.count(2, 0..=255)?;
            write(cx, unit, OUTPUT_VALUE, value as i16)?;
            4
        }
        channel @ TWELVE_BITS.. => {
            let value = cx.count(2, 0..=4095)? as i16;
            // The fall of bit 2 takes the eight low bits over, before the four high ones come.
            write(cx, unit, OUTPUT_VALUE, value & 0xff)?;
            write(cx, unit, CONTROL, 4)?;
            write(cx, unit, CONTROL, 0)?;
            write(cx, unit, OUTPUT_VALUE, value >> 8)?;
            if channel == TWELVE_BITS { 2 } else { 1 }
        }
        _ => return Err(Fault::VALUE),
    };
    write(cx, unit, CONTROL, start)?;
    write(cx, unit, CONTROL, 0)
}

/// The channel of the board itself that m1 and m2 name on a compatible board; `None`: m1 is a module.
fn board_channel(cx: &Cx) -> Result<Option<u8>, Fault> {
    if place(cx, 0)? != 0 {
        return Ok(None);
    }
    Ok(Some(cx.count(1, 0..=7)? as u8))
}

/// RD3A m1 m2 D of compatible boards: module 0 is the board, whose analog input m2, counted from 0, goes to D.
pub fn rd3a_board(cx: &mut Cx) -> Done {
    let Some(channel) = board_channel(cx)? else {
        return rd3a(cx);
    };
    let value = cx.hal().analog(channel).ok_or(Fault::MODULE)?;
    cx.set_word(2, 0, value)
}

/// WR3A m1 m2 S of compatible boards: module 0 is the board, whose analog output m2, counted from 0, takes S.
pub fn wr3a_board(cx: &mut Cx) -> Done {
    let Some(channel) = board_channel(cx)? else {
        return wr3a(cx);
    };
    let value = cx.word(2, 0)?;
    write(cx, 0, channel.into(), value)
}

/// Position of potentiometer S, 0 to 255; it is the analog input of that number.
fn potentiometer(cx: &mut Cx) -> Result<i16, Fault> {
    let number = cx.count(0, 0..=7)? as u8;
    let value = cx.hal().analog(number).ok_or(Fault::MODULE)?;
    Ok(value.clamp(0, 255))
}

/// VRRD S D (FNC 85): D takes the position of potentiometer S, 0 to 255.
pub fn vrrd(cx: &mut Cx) -> Done {
    let position = potentiometer(cx)?;
    cx.set_word(1, 0, position)
}

/// VRSC S D (FNC 86): D takes the position of potentiometer S as one of 0 to 10, the nearest.
pub fn vrsc(cx: &mut Cx) -> Done {
    let position = potentiometer(cx)?;
    cx.set_word(1, 0, (position * 10 + 127) / 255)
}

/// The next words of a divided transfer: where it is and how many there are. Memory: words moved; whether it is over.
fn portion(cx: &mut Cx) -> Result<Option<(i32, i32, i32)>, Fault> {
    if !cx.drive() {
        cx.state().0 = [0; 8];
        return Ok(None);
    }
    let (n, most) = (cx.count(3, 1..=32_767)?, cx.count(4, 1..=32_767)?);
    cx.check_words(2, n)?;
    let done = cx.state().0[0];
    Ok((done < n).then_some((done, (done + most).min(n), n)))
}

/// Returns whether a divided transfer is over.
fn finish_portion(cx: &mut Cx, end: i32, n: i32) {
    cx.state().0[0] = end;
    cx.set_special(M_COMPLETE, end >= n);
}

/// RBFM m1 m2 D n1 n2 (FNC 278): FROM of n1 words, n2 a scan; M8029 signals the end.
pub fn rbfm(cx: &mut Cx) -> Done {
    let Some((start, end, n)) = portion(cx)? else {
        return Ok(());
    };
    let (unit, address) = (place(cx, 0)?, place(cx, 1)?);
    for k in start..end {
        let value = read(cx, unit, address_of(address, k)?)?;
        cx.set_word(2, k, value)?;
    }
    finish_portion(cx, end, n);
    Ok(())
}

/// WBFM m1 m2 S n1 n2 (FNC 279): TO of n1 words, n2 a scan; M8029 signals the end.
pub fn wbfm(cx: &mut Cx) -> Done {
    let Some((start, end, n)) = portion(cx)? else {
        return Ok(());
    };
    let (unit, address) = (place(cx, 0)?, place(cx, 1)?);
    for k in start..end {
        let value = cx.word(2, k)?;
        write(cx, unit, address_of(address, k)?, value)?;
    }
    finish_portion(cx, end, n);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::Transfer;
    use crate::double::{Double, reg};
    use crate::modules::Kind;
    use crate::{Class, Cx, Fault, Hal, Operand, Plc, RtFn, Site, d, k, kn};

    #[test]
    fn all_functions_named_after_from_and_to_transfer() {
        for function in RtFn::ALL {
            let direction = match function.name().split('_').next() {
                Some("from" | "rbfm") => Some(Transfer::FromModule),
                Some("to" | "wbfm") => Some(Transfer::ToModule),
                _ => None,
            };
            let direction = direction.filter(|_| function.module() == "modules");
            assert_eq!(function.transfer(), direction, "{}", function.name());
        }
    }

    #[test]
    fn words_and_pairs_from_and_to_a_module() {
        let mut plc = Double::new().with_d(0, &[5, -6]);
        plc.hal.set_bfm(1, 20, 0).unwrap();
        plc.call(RtFn::To, &[k(1), k(20), reg(0), k(2)]).unwrap();
        assert_eq!(
            (plc.hal.bfm(1, 20), plc.hal.bfm(1, 21)),
            (Some(5), Some(-6))
        );
        plc.site = plc.site.wide();
        plc.call(RtFn::From, &[k(1), k(20), reg(10), k(1)]).unwrap();
        assert_eq!(plc.d(10, 2), [5, -6]);
        plc.call(RtFn::To, &[k(1), k(30), k(-70_000), k(1)])
            .unwrap();
        assert_eq!(
            (plc.hal.bfm(1, 30), plc.hal.bfm(1, 31)),
            (Some(-4464), Some(-2))
        );
        plc.call(RtFn::From, &[k(1), k(20), kn(8, Class::M, 0), k(1)])
            .unwrap();
        assert_eq!(plc.m(0, 20), "10100000000000000101");
    }

    #[test]
    fn modules_that_are_not_there_fault() {
        let mut plc = Double::new().with_d(0, &[7]);
        assert_eq!(
            plc.call(RtFn::From, &[k(5), k(0), reg(0), k(1)]),
            Err(Fault::MODULE)
        );
        assert_eq!(
            plc.call(RtFn::To, &[k(5), k(0), reg(0), k(1)]),
            Err(Fault::MODULE)
        );
        assert_eq!(plc.d(0, 1), [7]);
        plc.hal.set_bfm(5, 0, 1).unwrap();
        plc.set_m(8164, "1");
        assert_eq!(
            plc.call(RtFn::From, &[k(5), k(0), reg(0), k(1)]),
            Err(Fault::VALUE)
        );
        plc.set_d(8164, &[3]);
        plc.call(RtFn::From, &[k(5), k(0), reg(0), k(1)]).unwrap();
        assert_eq!(plc.d(0, 1), [1]);
    }

    #[test]
    fn remote_modules_that_do_not_answer_in_time_show_it() {
        let mut plc = Double::new().with_d(8299, &[20]);
        let ask = |plc: &mut Double, unit| {
            plc.set_m(8299, "0");
            let done = plc.call(RtFn::FromRemote, &[k(unit), k(3), reg(0), k(1)]);
            (done, plc.m(8299, 1) == "1")
        };
        let late = (Err(Fault::NO_ANSWER), true);
        assert_eq!(ask(&mut plc, 101), late);
        assert_eq!(ask(&mut plc, 1), (Err(Fault::MODULE), false));
        plc.hal.fit(101, Kind::find("H2U-4AD").unwrap()).unwrap();
        assert_eq!(ask(&mut plc, 101), (Ok(()), false));
        plc.hal.delay_module(101, 21).unwrap();
        assert_eq!(ask(&mut plc, 101), late);
        plc.hal.delay_module(101, 20).unwrap();
        assert_eq!(ask(&mut plc, 101), (Ok(()), false));
        // Values below 5 count as 5, values above 1000 as 1000.
        for (setting, longest) in [(0, 5), (-1, 5), (1, 5), (5000, 1000)] {
            plc.set_d(8299, &[setting]);
            plc.hal.delay_module(101, longest).unwrap();
            assert_eq!(ask(&mut plc, 101), (Ok(()), false), "{setting}");
            plc.hal.delay_module(101, longest + 1).unwrap();
            assert_eq!(ask(&mut plc, 101), late, "{setting}");
        }
        plc.hal.delay_module(101, 0).unwrap();
        assert_eq!(
            plc.call(RtFn::ToRemote, &[k(101), k(900), k(1), k(1)]),
            Err(Fault::MODULE)
        );
    }

    #[test]
    fn module_0_may_be_the_host() {
        let mut plc = Double::new();
        plc.hal.set_analog(0, 1000).unwrap();
        plc.hal.set_analog(1, 3000).unwrap();
        plc.call(RtFn::FromHost, &[k(0), k(0), reg(0), k(2)])
            .unwrap();
        assert_eq!(plc.d(0, 2), [1000, 3000]);
        // The third one is not wired.
        plc.set_d(8032, &[55]);
        plc.call(RtFn::FromHost, &[k(0), k(1), reg(0), k(2)])
            .unwrap();
        assert_eq!(plc.d(0, 2), [3000, 55]);
        plc.call(RtFn::FromHost, &[k(0), k(0), reg(0), k(2)])
            .unwrap();
        assert_eq!(
            plc.call(RtFn::FromHost, &[k(0), k(0), reg(0), k(9)]),
            Err(Fault::MODULE)
        );
        plc.call(RtFn::ToHost, &[k(0), k(1), reg(0), k(2)]).unwrap();
        assert_eq!(plc.d(8050, 3), [0, 1000, 3000]);
        assert_eq!(
            plc.call(RtFn::ToHost, &[k(0), k(7), reg(0), k(2)]),
            Err(Fault::MODULE)
        );
        plc.hal.set_bfm(0, 1, 7).unwrap();
        plc.call(RtFn::FromHost, &[k(0), k(0), reg(0), k(2)])
            .unwrap();
        assert_eq!(plc.d(0, 2), [0, 7]);
    }

    #[test]
    fn analog_module() {
        let mut plc = Double::new().with_d(0, &[200]);
        plc.hal.set_bfm(0, 0, 128).unwrap();
        plc.call(RtFn::Rd3a, &[k(0), k(2), reg(1)]).unwrap();
        assert_eq!((plc.d(1, 1), plc.hal.bfm(0, 17)), ([128].to_vec(), Some(3)));
        plc.call(RtFn::Wr3a, &[k(0), k(1), reg(0)]).unwrap();
        assert_eq!(
            (plc.hal.bfm(0, 16), plc.hal.bfm(0, 17)),
            (Some(200), Some(0))
        );
        assert_eq!(
            plc.call(RtFn::Rd3a, &[k(0), k(3), reg(1)]),
            Err(Fault::VALUE)
        );
    }

    #[test]
    fn potentiometers() {
        let mut plc = Double::new();
        assert_eq!(plc.call(RtFn::Vrrd, &[k(3), reg(0)]), Err(Fault::MODULE));
        for (position, switch) in [
            (0, 0),
            (12, 0),
            (13, 1),
            (128, 5),
            (242, 9),
            (243, 10),
            (300, 10),
        ] {
            plc.hal.set_analog(3, position).unwrap();
            plc.call(RtFn::Vrrd, &[k(3), reg(0)]).unwrap();
            plc.call(RtFn::Vrsc, &[k(3), reg(1)]).unwrap();
            assert_eq!(plc.d(0, 2), [position.min(255), switch]);
        }
    }

    #[test]
    fn divided_transfers() {
        let mut plc = Double::new().with_d(0, &[1, 2, 3, 4, 5]);
        plc.hal.set_bfm(0, 9, 9).unwrap();
        let mut scans = 0;
        while plc.bit(Class::M, 8029) != Some(true) {
            plc.scan(10, true, RtFn::Wbfm, &[k(0), k(10), reg(0), k(5), k(2)])
                .unwrap();
            scans += 1;
        }
        assert_eq!(scans, 3);
        plc.scan(10, false, RtFn::Rbfm, &[k(0), k(10), reg(20), k(5), k(5)])
            .unwrap();
        plc.scan(10, true, RtFn::Rbfm, &[k(0), k(10), reg(20), k(5), k(5)])
            .unwrap();
        assert_eq!(plc.d(20, 6), [1, 2, 3, 4, 5, 0]);
    }

    /// Terminals of which every third is on; counts the outputs that are set.
    struct Terminals(std::vec::Vec<u16>);

    impl Hal for Terminals {
        fn input(&mut self, number: u16) -> Option<bool> {
            Some(number.is_multiple_of(3))
        }
        fn set_output(&mut self, number: u16, value: bool) {
            if value {
                self.0.push(number);
            }
        }
    }

    #[test]
    fn terminals_are_refreshed_at_once() {
        let mut plc = Double::new();
        let mut hal = Terminals(std::vec![]);
        for n in 0..16 {
            plc.set_bit(Class::Y, n, true);
        }
        plc.set_d(8181, &[1]);
        let mut call = |plc: &mut Double, function: RtFn, ops: &[Operand]| {
            function.call(&mut Cx::new(plc, &mut hal, ops, Site::at(0)))
        };
        call(&mut plc, RtFn::Ref, &[d(Class::X, 8), k(8)]).unwrap();
        call(&mut plc, RtFn::RefHm, &[d(Class::Y, 0), k(8)]).unwrap();
        call(&mut plc, RtFn::Ref, &[d(Class::Y, 8), k(8)]).unwrap();
        assert_eq!(
            call(&mut plc, RtFn::Ref, &[d(Class::M, 8), k(8)]),
            Err(Fault::DEVICE)
        );
        call(&mut plc, RtFn::Reff, &[k(20)]).unwrap();
        assert_eq!(plc.d(8020, 1), [20]);
        let on: std::vec::Vec<u32> = (0..32)
            .filter(|&n| plc.bit(Class::X, n) == Some(true))
            .collect();
        assert_eq!(on, [0, 3, 6, 9, 12, 15]);
        let sent: std::vec::Vec<u16> = (0..16).filter(|&n| n != 1).collect();
        assert_eq!(hal.0, sent);
    }
}
