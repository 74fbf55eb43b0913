//! Conditions as texts.

use super::{Condition, parse};
use crate::Target;
use rungc_syntax::DeviceClass;

fn read(text: &str) -> Result<Condition, String> {
    let names = |name: &str| match name {
        "Guard open" | "guard" => vec![Target::Bit(DeviceClass::X, 3)],
        "Motor" => vec![
            Target::Bit(DeviceClass::Y, 0),
            Target::Bit(DeviceClass::Y, 1),
        ],
        "Speed" => vec![Target::Word(DeviceClass::D, 10)],
        "a+b" => vec![Target::Bit(DeviceClass::M, 7)],
        "K1" | "12" => vec![Target::Bit(DeviceClass::Y, 5)],
        _ => Vec::new(),
    };
    parse(text, &names).map_err(|mistake| format!("{}: {}", mistake.at, mistake.why))
}

#[test]
fn operators_bind_as_in_logic() {
    let is = |a, b| assert_eq!(read(a), read(b), "{a}");
    is("X0 | X1 & X2", "X0 | (X1 & X2)");
    is("!X0 & X1", "(not x0) AND x1");
    is("Y000 = 1 & Y1 == 0", "Y0 & !Y1");
    is("D0 >= K100", "D0>=100");
    is("\"Guard open\" & guard", "X3 & X003");
    is("1 = Y0 & Y0 != Y1", "Y0 & !(Y0 = Y1)");
    assert!(read("T0 & T0.value > 5 & C200.value < -3 & K1X0 = H0F").is_ok());
}

#[test]
fn constants_are_bits_of_signed_values() {
    let is = |a, b| assert_eq!(read(a), read(b), "{a}");
    is("D0 = HFFFF", "D0 = -1");
    is("D0 != 65535", "D0 <> -1");
    is("D0 > H8000", "D0 > -32768");
    is("K4Y000 = 0x9C40", "K4Y000 = -25536");
    is("D0.i32 = HFFFFFFFF", "D0.i32 = -1");
    is("D0.i32 > HFFFF", "D0.i32 > 65535");
    is("K5X0 < HFFFFF", "K5X0 < 1048575");
    is("C200.value = 4294967295", "C200.value = -1");
}

/// A contactor has the name of a constant: which of both is meant has to be said.
#[test]
fn constants_that_are_names_are_not_guessed() {
    let is = |a, b| assert_eq!(read(a), read(b), "{a}");
    is("\"K1\" & X0", "Y5 & X0");
    is("D0 > 1 & Y0 = 1", "D0 > H1 & Y0");
    is("D0 > 12", "D0 > HC");
    for text in ["K1 & X0", "D0 > K1", "Y0 = K1"] {
        let why = read(text).unwrap_err();
        assert!(
            why.contains("`K1` is a number, and the name of a device: write `\"K1\"`"),
            "{why}"
        );
    }
}

#[test]
fn mistakes_have_a_place() {
    let why = |text| read(text).unwrap_err();
    insta::assert_snapshot!(why("Y000 & "), @"7: expected a device, a name or a number here");
    insta::assert_snapshot!(why("(Y000 & X1"), @"0: this `(` is not closed");
    insta::assert_snapshot!(why("Y000) & X1"), @"4: this `)` closes nothing");
    insta::assert_snapshot!(why("Y000 X1"), @"5: expected `&`, `|`, a comparison or the end here");
    insta::assert_snapshot!(why("D0"), @"0: compare a number with something: `D0 > 100`");
    insta::assert_snapshot!(why("Y000 > 3"), @"0: this is a contact, which is on or off; the value of a timer or counter is `T0.value`");
    insta::assert_snapshot!(why("D0 > 40000"), @"5: `D0` is signed, -32768 to 32767: the bits of 40000 are -25536 there, so write H9C40 if that is meant");
    insta::assert_snapshot!(why("K4Y000 < 65536"), @"9: `K4Y000` is never 65536: its values are -32768 to 32767");
    insta::assert_snapshot!(why("16 = K1X0"), @"0: `K1X000` is never 16: its values are 0 to 15");
    insta::assert_snapshot!(why("D0.i32 >= 2147483648"), @"10: `D0.i32` is signed, -2147483648 to 2147483647: the bits of 2147483648 are -2147483648 there, so write H80000000 if that is meant");
    insta::assert_snapshot!(why("Y0 < Y1"), @"0: this is a contact, which is on or off; the value of a timer or counter is `T0.value`");
    insta::assert_snapshot!(why("D0 > 99999999999"), @"5: `99999999999` does not fit in 32 bits");
    insta::assert_snapshot!(why("Pump & X0"), @"0: `Pump` is neither a device nor the comment of one; write a name with blanks in quotes");
    insta::assert_snapshot!(why("Motor"), @"0: `Motor` is the comment of several devices, such as Y000 and Y001");
    insta::assert_snapshot!(why("\"Guard"), @"0: this quote is not closed");
    insta::assert_snapshot!(why("D0.str = 1"), @"0: `D0.str` is neither a bit nor a number");
    insta::assert_snapshot!(why("D0 > 1.5"), @"0: `D0` is an integer, compared or calculated with a float; a float is `D0.f32`");
    insta::assert_snapshot!(why("D0.f32 > H1"), @"9: write a float as `1.5`");
    insta::assert_snapshot!(why("D0.f32 % 2 > 1"), @"9: `%` is the remainder of integers");
    insta::assert_snapshot!(why("D0.f32 > 1e99"), @"9: `1e99` does not fit in 32 bits");
    insta::assert_snapshot!(why("D0.10"), @"0: `D0.10` is neither a device nor the comment of one; write a name with blanks in quotes");
    insta::assert_snapshot!(why("D0 + D1"), @"0: compare a number with something: `D0 > 100`");
    insta::assert_snapshot!(why("D0 + 40000 > 1"), @"5: `D0` is signed, -32768 to 32767: the bits of 40000 are -25536 there, so write H9C40 if that is meant");
    insta::assert_snapshot!(why("T0 + 1 > 1"), @"0: this is a contact, which is on or off; the value of a timer or counter is `T0.value`");
    insta::assert_snapshot!(why("D0 + (X0 & X1) > 1"), @"6: this is a condition, not a number");
    insta::assert_snapshot!(why("1 / (2 - 2) < D0"), @"5: this divides by 0");
    insta::assert_snapshot!(why("X0 & X1 for 2s"), @"8: put what lasts in parentheses: `(X000 & X001) for 2s` or `X000 & (X001 for 2s)`");
    insta::assert_snapshot!(why("X0 for 2s | X1"), @"3: put what lasts in parentheses: `(X000 | X001) for 2s` or `X000 | (X001 for 2s)`");
    insta::assert_snapshot!(why("X0 for"), @"6: expected a time here: `for 2s`");
    insta::assert_snapshot!(why("X0 for ever"), @"7: `ever` is not a time: write for example 200ms or 5s");
    insta::assert_snapshot!(why("X0 for 60d"), @"7: `d` is not a unit of time: use ms, s, min or h");
    insta::assert_snapshot!(why("X0 before X1 before X2"), @"13: put one `before` in parentheses: `(X000 before X001) before X002`");
    insta::assert_snapshot!(why("rises(D0)"), @"6: compare a number with something: `D0 > 100`");
    insta::assert_snapshot!(why("was(D0)"), @"0: compare a number with something: `D0 > 100`");
    insta::assert_snapshot!(why("was(X0"), @"3: this `(` is not closed");
    insta::assert_snapshot!(why("exactly one of X0"), @"15: expected a list here: `(Y000, Y001)`");
    insta::assert_snapshot!(why("exactly 3 of (X0, X1)"), @"0: there are 2, never 3");
    insta::assert_snapshot!(why("at most one of (X0 X1)"), @"15: this `(` is not closed");
    insta::assert_snapshot!(why("\"Guard shut\""), @"0: no device has the comment `Guard shut`");
    insta::assert_snapshot!(why("Guard.f32 > 1"), @"0: `Guard.f32` is neither a device nor the comment of one; write a name with blanks in quotes");
    let deep = |n: usize| format!("{}X0{}", "(".repeat(n), ")".repeat(n));
    let (too_deep, too_long) = (deep(102), "X0 & ".repeat(1001));
    insta::assert_snapshot!(why(&too_deep), @"101: more than 100 parentheses and inversions");
    assert!(read(&deep(100)).is_ok());
    insta::assert_snapshot!(why(&too_long), @"4999: a condition of more than 2000 words");
    assert!(read(&format!("{}X0", "X0 & ".repeat(999))).is_ok());
}

/// What a condition is in canonical notation.
fn canonical(text: &str) -> String {
    read(text).unwrap().to_string()
}

#[test]
fn conditions_are_shown_as_they_are_written() {
    for (text, shown) in [
        ("D0.3 & D1.a | !D2.F", "D0.3 & D1.A | !D2.F"),
        ("(X0|X1)&X2", "(X000 | X001) & X002"),
        ("X0 = (X1 & X2)", "X000 = (X001 & X002)"),
        ("D0+D1*2-1 > 100", "(D0 + (D1 * 2)) - 1 > 100"),
        ("-D0 < 10 * 60", "0 - D0 < 600"),
        ("D0-5 > -5", "D0 - 5 > -5"),
        ("D0 - -5 > K-5", "D0 - -5 > -5"),
        ("(D0 + D1) % 7 = 3", "(D0 + D1) % 7 = 3"),
        (
            "D0.f32 > 1.5 & D2.f32 < 1e-5",
            "D0.f32 > 1.5 & D2.f32 < 1e-5",
        ),
        ("D0.f32 * 2 >= 1", "D0.f32 * 2.0 >= 1.0"),
        (
            "Speed.f32 > 1 & \"Speed.i32\" > 1",
            "D10.f32 > 1.0 & D10.i32 > 1",
        ),
        ("\"Speed\".f32 > 1 & Speed > 3", "D10.f32 > 1.0 & D10 > 3"),
        ("a+b & Speed-1 > 3", "M7 & D10 - 1 > 3"),
        ("rises(X0) & falls( guard )", "rises(X000) & falls(X003)"),
        ("D0 - was(D0) > 10", "D0 - was(D0) > 10"),
        (
            "was(X0 & X1) | was(D0 > 5)",
            "was(X000 & X001) | was(D0 > 5)",
        ),
        ("X0 for 2s", "X000 for 2000ms"),
        ("!X0 for 500", "(!X000) for 500ms"),
        (
            "D0 > 5 for 1.5s before Y0 | Y1",
            "((D0 > 5) for 1500ms) before Y000 | Y001",
        ),
        ("X0 & (X1 for 2min)", "X000 & (X001 for 120000ms)"),
        (
            "exactly one of (Y0, Y1 & X1, D0>3)",
            "exactly 1 of (Y000, Y001 & X001, D0 > 3)",
        ),
        (
            "at most one of (Y0,Y1) & at least 2 of (X0,X1,X2)",
            "at most 1 of (Y000, Y001) & at least 2 of (X000, X001, X002)",
        ),
        ("at least 2 of (X0, X1)", "exactly 2 of (X000, X001)"),
    ] {
        assert_eq!(canonical(text), shown, "{text}");
        assert_eq!(read(shown), read(text), "{text}");
    }
}

#[test]
fn signs_and_words_of_the_language_may_be_names() {
    let names = |name: &str| match name {
        "for" | "was" | "exactly" | "Pump-1" | "a,b" => vec![Target::Bit(DeviceClass::M, 1)],
        _ => Vec::new(),
    };
    for text in [
        "for & was",
        "for for 2s",
        "was(for)",
        "exactly | Pump-1",
        "at most one of (a,b, X0)",
    ] {
        assert!(parse(text, &names).is_ok(), "{text}");
    }
}
