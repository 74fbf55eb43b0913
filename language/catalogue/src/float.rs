//! Floating point, FNC 110–137 and 438–440. All but INT have only the 32-bit form, written with D: `DEADD`.

use super::row::*;
use super::{Classes, Inst, Lower, Param, Repeat, Rule};
use rungc_models::ModelSet;
use rungc_rt::RtFn;

/// Floats, and integers that become floats.
const NUMBERS: Classes = CONSTANTS.or(Classes::E).or(REAL_RESULTS);
/// Only floats. The manual of H1U and H2U also marks V and Z for the functions that came last.
const REALS: Classes = Classes::E.or(REAL_RESULTS).or(INDEX);
/// Targets of floats.
const REAL_RESULTS: Classes = DATA_PLACES;

const TWO: &[Param] = &[
    real("S1", NUMBERS),
    real("S2", NUMBERS),
    real_out("D", REAL_RESULTS),
];
const ONE: &[Param] = &one(&[]);
/// The trigonometric functions that came first take no V and Z (h1u-h2u-programming §4.3.10).
const ONE_PLACE: &[Param] = &[real("S", REALS.without(INDEX)), real_out("D", REAL_RESULTS)];
/// Logarithms, of numbers greater than 0, and the arcs of a sine or cosine.
const LOGARITHM: &[Param] = &one(&[Rule::WorksAbove(0)]);
const ARC: &[Param] = &one(&[Rule::WorksWith(-1, 1)]);
const fn one(rules: &'static [Rule]) -> [Param; 2] {
    [
        real("S", REALS).rules(rules),
        real_out("D", REAL_RESULTS.or(INDEX)),
    ]
}
/// L01S lists K and H for EMOV too (l01s-programming §4.2).
const ONE_L01S: &[Param] = &[
    real("S", REALS.or(CONSTANTS)),
    real_out("D", REAL_RESULTS.or(INDEX)),
];
/// HM takes integer constants everywhere.
const ONE_HM: &[Param] = &[real("S", CONSTANTS.or(DATA)), real_out("D", DATA)];
/// A float as a decimal mantissa and a decimal exponent.
const DECIMAL: Param = dst("D", DATA_PLACES).word().len(2);

const fn float(name: &'static str, fnc: u16, title: &'static str, function: RtFn) -> Inst {
    row(name, title, "h1u-h2u-programming §4.3.10")
        .fnc(fnc)
        .on(NOT_FX1)
        .forms(W32_P)
        .steps(9, 9)
        .errors(&[6706])
        .call(function)
}

const fn operator(name: &'static str, fnc: u16, title: &'static str, function: RtFn) -> Inst {
    float(name, fnc, title, function)
        .steps(13, 13)
        .takes(TWO)
        .flags(&["M8020", "M8021", "M8022"])
}

const fn function(name: &'static str, fnc: u16, title: &'static str, function: RtFn) -> Inst {
    const VARIANTS: &[super::Variant] = &[on(HM).takes(ONE_HM)];
    float(name, fnc, title, function)
        .takes(ONE)
        .variants(VARIANTS)
}

/// Models without the instructions that FX2N lacks too.
const WITHOUT_SMALL_FX: ModelSet = NOT_SMALL_FX.without(ModelSet::FX2N);
/// The same and HM.
const WITHOUT_SMALL_FX_HM: ModelSet = WITHOUT_SMALL_FX.without(HM);

pub(super) const ROWS: &[Inst] = &[
    float("ECMP", 110, "Compare floats", RtFn::Ecmp)
        .steps(13, 13)
        .takes(&[real("S1", NUMBERS), real("S2", NUMBERS), coil("D", RESULT_BITS).len(3)])
        // h1u-h2u-programming §4.3.10 marks Z and not V.
        .variants(&[on(INOVANCE).takes(&[
            real("S1", NUMBERS.or(Classes::Z)),
            real("S2", NUMBERS.or(Classes::Z)),
            coil("D", RESULT_BITS).len(3),
        ])])
        .text("Compares floats: D is on if S1 > S2, D+1 if they are equal, D+2 if S1 < S2. Integer constants become floats."),
    float("EZCP", 111, "Zone compare of floats", RtFn::Ezcp)
        .steps(17, 17)
        .on(NOT_SMALL_FX)
        .takes(&[real("S1", NUMBERS), real("S2", NUMBERS), real("S", NUMBERS), coil("D", RESULT_BITS).len(3)])
        .text("Compares the float S with the zone S1 to S2: D is on below S1, D+1 from S1 to S2, D+2 above S2."),
    float("EMOV", 112, "Move a float", RtFn::Emov)
        .repeat(Repeat::Shifting)
        .on(NOT_HM_FX1.without(ModelSet::FX2N))
        .takes(ONE)
        .variants(&[on(L01S).takes(ONE_L01S)])
        .text("Copies the float S to D. On L01S S may be an integer constant, which becomes a float."),
    float("ESTR", 116, "Float to text", RtFn::Estr)
        .source(FX3_MANUAL)
        .steps(13, 13)
        .on(FX3U)
        .takes(&[
            real("S1", NUMBERS),
            src("S2", GROUPS.or(PLACES)).word().len(3),
            text_out("D", GROUPS.or(PLACES)).len(13),
        ])
        .errors(&[6706])
        .text(
            "Writes the float S1 as text to D. S2 says how: 0 with a decimal point, 1 with an exponent; S2+1 is the number of \
             characters, S2+2 that of decimals.",
        ),
    float("EVAL", 117, "Text to float", RtFn::Eval)
        .source(FX3_MANUAL)
        .repeat(Repeat::Same)
        .on(FX3U_L01S)
        .takes(&[text("S", GROUPS.or(PLACES)).len(13), real_out("D", REAL_RESULTS)])
        .flags(&["M8020", "M8021", "M8022"])
        .errors(&[6706])
        .text("Reads the text at S, with a decimal point or an exponent, as a float. Flags as EADD."),
    float("EBCD", 118, "Float to decimal", RtFn::Ebcd)
        .takes(&[real("S", REAL_RESULTS), DECIMAL])
        .on(NOT_SMALL_FX)
        .text("Writes S as a decimal mantissa D of four digits, without those that follow, and a power of ten D+1."),
    float("EBIN", 119, "Decimal to float", RtFn::Ebin)
        .takes(&[src("S", DATA_PLACES).word().len(2), real_out("D", REAL_RESULTS)])
        .on(NOT_SMALL_FX)
        .text("D = S × 10^(S+1): the mantissa S and the power of ten S+1 as a float."),
    operator("EADD", 120, "Add floats", RtFn::Eadd)
        .neutral(0)
        .lower_on(&[(HM, Lower::Call(RtFn::EaddPlain))])
        .text("D = S1 + S2. M8020 is on if the result is 0, M8022 if it is too large, M8021 if too small for a float. HM has no flags for it."),
    operator("ESUB", 121, "Subtract floats", RtFn::Esub)
        .neutral_second(0)
        .lower_on(&[(HM, Lower::Call(RtFn::EsubPlain))])
        .text("D = S1 - S2. Flags as EADD."),
    operator("EMUL", 122, "Multiply floats", RtFn::Emul)
        .neutral(1)
        .lower_on(&[(HM, Lower::Call(RtFn::EmulPlain))])
        .text("D = S1 × S2. Flags as EADD."),
    operator("EDIV", 123, "Divide floats", RtFn::Ediv)
        .neutral_second(1)
        .lower_on(&[(HM, Lower::Call(RtFn::EdivClamped))])
        .text("D = S1 / S2. Flags as EADD. A divisor of 0 is an error; on HM it gives the largest float with the sign of S1."),
    function("EXP", 124, "Power of e", RtFn::Exp)
        .on(WITHOUT_SMALL_FX_HM)
        .text("D = e^S. A result outside the float range is an error."),
    function("LOGE", 125, "Natural logarithm", RtFn::Loge)
        .takes(LOGARITHM)
        .on(WITHOUT_SMALL_FX_HM)
        .text("D = ln S. S of 0 or below is an error."),
    function("LOG10", 126, "Common logarithm", RtFn::Log10)
        .aliases(&["LOG"])
        .takes(LOGARITHM)
        .on(WITHOUT_SMALL_FX_HM)
        .text("D = log10 S. S of 0 or below is an error. H1U and H2U also write DLOG."),
    float("ESQR", 127, "Square root of a float", RtFn::Esqr)
        .takes(&[real("S", NUMBERS).rules(NOT_NEGATIVE), real_out("D", REAL_RESULTS)])
        .flags(&["M8020"])
        .lower_on(&[(HM, Lower::Call(RtFn::EsqrClamped))])
        .text("D = the square root of S. M8020 is on if it is 0 (not on HM). A negative S is an error; on HM, a value that is not a finite number gives 0."),
    float("ENEG", 128, "Negate a float", RtFn::Eneg)
        .source(FX3_MANUAL)
        .repeat(Repeat::Changes(0))
        .steps(5, 5)
        .on(FX3U_L01S)
        .takes(&[real_out("D", REAL_RESULTS).changed()])
        .text("D = -D at each execution."),
    float("INT", 129, "Float to integer", RtFn::Int)
        .repeat(Repeat::OverlappingWide)
        .forms(ALL_FORMS)
        .steps(5, 9)
        .takes(&[real("S", REAL_RESULTS), dst("D", DATA_PLACES)])
        .flags(&["M8020", "M8021", "M8022"])
        .lower_on(&[(HM, Lower::Call(RtFn::IntClamped))])
        .text(
            "D = the float S without its fraction, as a word or a pair. M8020 is on if it is 0, M8021 if there was a fraction, M8022 \
             if it does not fit; on HM it stays at the end of the range.",
        ),
    function("SIN", 130, "Sine", RtFn::Sin)
        .on(NOT_SMALL_FX)
        .takes(ONE_PLACE)
        .text("D = sin S, S in radians."),
    function("COS", 131, "Cosine", RtFn::Cos)
        .on(NOT_SMALL_FX)
        .takes(ONE_PLACE)
        .text("D = cos S, S in radians."),
    function("TAN", 132, "Tangent", RtFn::Tan)
        .on(NOT_SMALL_FX)
        .takes(ONE_PLACE)
        .text("D = tan S, S in radians."),
    function("ASIN", 133, "Arc sine", RtFn::Asin)
        .takes(ARC)
        .on(WITHOUT_SMALL_FX)
        .text("D = the angle in radians, from -π/2 to π/2, whose sine is S. S outside -1 to 1 is an error."),
    function("ACOS", 134, "Arc cosine", RtFn::Acos)
        .takes(ARC)
        .on(WITHOUT_SMALL_FX)
        .text("D = the angle in radians, from 0 to π, whose cosine is S. S outside -1 to 1 is an error."),
    function("ATAN", 135, "Arc tangent", RtFn::Atan)
        .on(WITHOUT_SMALL_FX)
        .text("D = the angle in radians, from -π/2 to π/2, whose tangent is S."),
    function("RAD", 136, "Degrees to radians", RtFn::Rad)
        .on(WITHOUT_SMALL_FX)
        .text("D = S × π/180."),
    function("DEG", 137, "Radians to degrees", RtFn::Deg)
        .on(WITHOUT_SMALL_FX)
        .text("D = S × 180/π."),
    function("SINH", 438, "Hyperbolic sine", RtFn::Sinh)
        .on(INOVANCE)
        .text("D = (e^S - e^-S) / 2."),
    function("COSH", 439, "Hyperbolic cosine", RtFn::Cosh)
        .on(INOVANCE)
        .text("D = (e^S + e^-S) / 2."),
    function("TANH", 440, "Hyperbolic tangent", RtFn::Tanh)
        .on(INOVANCE)
        .text("D = (e^S - e^-S) / (e^S + e^-S)."),
];
