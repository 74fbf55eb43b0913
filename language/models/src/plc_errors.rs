//! The error codes of PLCs that our models can show: in D8067 and D8061 of a running program, in the registers of
//! serial ports, and those that an editor shows for a program that it rejects.
//!
//! From the tables h1u-h2u-programming §8.1 and §5.7 (PID); those of FX from JY992D88101 and JY997D16601, which L01S
//! follows: its manual prints none.

mod codes;

use crate::model::ErrorNumbers;
use crate::{Model, ModelId, ModelSet};

/// An error code and its meaning on some models.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct PlcError {
    /// The code: 6706.
    pub code: u16,
    /// Models on which it means this.
    pub models: ModelSet,
    /// Title, in a few words.
    pub title: &'static str,
    /// Meaning, and the PLC's reaction; empty where the title says all.
    pub meaning: &'static str,
    /// Remedy; empty where the title says all.
    pub remedy: &'static str,
}

const fn row(
    code: u16,
    models: ModelSet,
    title: &'static str,
    meaning: &'static str,
    remedy: &'static str,
) -> PlcError {
    PlcError {
        code,
        models,
        title,
        meaning,
        remedy,
    }
}

/// The code of the watchdog.
pub const WATCHDOG: u16 = rungc_rt::special::WATCHDOG_CODE;

const H: ModelSet = ModelSet::INOVANCE;
const FX: ModelSet = ModelSet::FX.or(ModelSet::L01S);
const FX3: ModelSet = ModelSet::FX3;
const ALL: ModelSet = ModelSet::ALL;

/// Effect of most operation errors.
const SKIPPED: &str = "The instruction is skipped and the scan continues.";
/// Remedies for errors of devices and values.
const DEVICES_AND_DIVISORS: &str = "Check the index register and the count before the instruction; compare a divisor with 0 first.";
const VALUES: &str =
    "`rungc explain` with the name of the instruction lists the accepted values; check them first.";
/// Title and remedy of 6708.
const FROM_OR_TO: &str = "FROM or TO failed";
const MODULES: &str = "Check the module number and what is fitted: `[[module]]` in rungc.toml, or what the host answers.";
/// Effect of an error in PID's parameters.
const PID_STOPS: &str = "PID stops until its contact turns off and on again.";
/// Effect of an overflow in PID.
const PID_GOES_ON: &str = "PID continues with the limit of the range.";
/// Remedy for an overflow in PID.
const PID_RANGE: &str =
    "Scale the measured value and the set value down, or choose a smaller gain.";

/// Errors that a running program can report, in the order of their codes.
static OF_PROGRAMS: &[PlcError] = &[
    row(
        WATCHDOG,
        ALL,
        "a scan does not end (watchdog)",
        "The scan took longer than the watchdog time in D8000, 200 ms unless the program changes it. The PLC goes to STOP with all outputs off and \
         shows M8061 and D8061. Compiled programs and `rungc run` count instead of measuring: a scan may repeat 10,000 steps for each millisecond \
         of D8000 in its loops and backward jumps.",
        "Check the named loop or jump: does its condition ever end it, is its count what you expect? Spread long work over several \
         scans, or write a longer time to D8000.",
    ),
    row(
        6381,
        H,
        "a remote module does not answer",
        "FROM or TO names a module on the CAN bus (100 and its station) that has not answered within D8299 ms. M8299 is on until the program \
         switches it off; the instruction is skipped.",
        "Check the module's supply, its station and the bit rate of the bus, or write a longer time to D8299 (5 to 1000).",
    ),
    row(
        6701,
        ALL,
        "a jump or call to a missing label",
        "An index register directs CJ or CALL to a pointer P that the program does not have. The scan continues after the instruction.",
        "Limit the index register to labels that exist.",
    ),
    row(
        6702,
        ALL,
        "calls are nested too deep",
        "A subroutine calls itself, directly or through others, or CALL is nested deeper than the PLC allows. The call is skipped.",
        "Replace the recursion with a loop, or call the subroutines one after the other.",
    ),
    row(
        6706,
        H,
        "a device does not exist, or a value has no result",
        "An index register or a count goes past the last device of a class, DIV divides by 0, a function of floats has no result for its value, or a window of SPD \
         is below 1. Other values that an instruction does not accept are error 6707. The instruction is skipped and the scan continues.",
        DEVICES_AND_DIVISORS,
    ),
    row(
        6706,
        ModelSet::HM,
        "a device does not exist, or a value has no result",
        "An index register or a count goes past the last device of a class, or a function of floats has no result for its value, such as ESQR of a \
         negative number. The instruction is skipped and the scan continues.",
        "Check the index register, the count and the value before the instruction.",
    ),
    row(
        6706,
        FX.without(FX3),
        "a device does not exist, or a value does not fit the instruction",
        "An index register or a count goes past the last device of a class, a divisor is 0, or an operand has a value that the instruction does not accept. \
         The instruction is skipped and the scan continues.",
        DEVICES_AND_DIVISORS,
    ),
    row(
        6706,
        FX3,
        "a device does not exist, or a value does not fit the instruction",
        "An index register or a count goes past the last device of a class, a divisor is 0, the quotient of DIV is too large, or an operand has a value that the \
         instruction does not accept. The instruction is skipped and the scan continues.",
        DEVICES_AND_DIVISORS,
    ),
    row(
        6707,
        H,
        "a value does not fit the instruction",
        "An operand has a value that the instruction does not accept, for example an invalid BCD number or a negative count. The instruction \
         is skipped and the scan continues.",
        VALUES,
    ),
    row(
        6707,
        ModelSet::HM,
        "a value does not fit the instruction",
        "An operand has a value that the instruction does not accept, for example a negative count. The instruction is skipped and the scan continues.",
        VALUES,
    ),
    row(
        6708,
        ModelSet::FX3U,
        FROM_OR_TO,
        "FROM, TO, RBFM, WBFM or an operand U\\G names a module that is not fitted, or buffer memory that it does not have. The instruction is skipped.",
        MODULES,
    ),
    row(
        6708,
        FX.without(ModelSet::FX3U)
            .without(ModelSet::FX1S)
            .without(ModelSet::FX3S),
        FROM_OR_TO,
        "FROM or TO names a module that is not fitted, or buffer memory that it does not have. The instruction is skipped.",
        MODULES,
    ),
    row(
        6708,
        ModelSet::FX1S.or(ModelSet::FX3S),
        "VRRD or VRSC failed",
        "VRRD or VRSC reads a potentiometer that is not there. The instruction is skipped.",
        "Check the number of the potentiometer, and whether the board that has it is fitted.",
    ),
    row(
        6730,
        ALL,
        "PID: the sampling time is not 1 to 32767 ms",
        PID_STOPS,
        "Write a sampling time of at least 1 ms to the first register of the parameters.",
    ),
    row(
        6732,
        ALL,
        "PID: the input filter constant is not 0 to 99 %",
        PID_STOPS,
        "Write 0 to 99 to the parameter.",
    ),
    row(
        6733,
        ALL,
        "PID: the proportional gain is negative",
        PID_STOPS,
        "Write 0 to 32767 % to the parameter.",
    ),
    row(
        6734,
        ALL,
        "PID: the integral time is negative",
        PID_STOPS,
        "Write 0 (no integral action) to 32767 units of 100 ms to the parameter.",
    ),
    row(
        6735,
        ALL,
        "PID: the derivative gain is not 0 to 200 %",
        PID_STOPS,
        "Write 0 to 200 to the parameter.",
    ),
    row(
        6736,
        ALL,
        "PID: the derivative time is negative",
        PID_STOPS,
        "Write 0 (no derivative action) to 32767 units of 10 ms to the parameter.",
    ),
    row(
        6740,
        ALL,
        "PID: the sampling time is not longer than a scan, or than the period of its interrupt",
        "PID continues with that time as its sampling time.",
        "Choose a longer sampling time, make the scan shorter, or move PID to the routine of a timer interrupt.",
    ),
    row(
        6742,
        ALL,
        "PID: the measured value changes too much",
        PID_GOES_ON,
        PID_RANGE,
    ),
    row(
        6743,
        ALL,
        "PID: the deviation does not fit 16 bits",
        PID_GOES_ON,
        PID_RANGE,
    ),
    row(
        6744,
        ALL,
        "PID: the integral does not fit 16 bits",
        PID_GOES_ON,
        PID_RANGE,
    ),
    row(
        6745,
        ALL,
        "PID: the derivative gain makes the derivative too large",
        PID_GOES_ON,
        "Choose a smaller derivative gain.",
    ),
    row(
        6746,
        ALL,
        "PID: the derivative does not fit 16 bits",
        PID_GOES_ON,
        PID_RANGE,
    ),
    row(
        6747,
        ALL,
        "PID: the result does not fit 16 bits",
        PID_GOES_ON,
        PID_RANGE,
    ),
    row(
        6748,
        FX3,
        "PID: the upper limit of the output is below the lower one",
        "PID exchanges the limits and continues.",
        "Write the upper limit to S3+22 and the lower one to S3+23.",
    ),
    row(
        6749,
        FX3,
        "PID: a value of an alarm is negative",
        "PID gives no alarm and continues.",
        "Write 0 to 32767 to S3+20 to S3+23.",
    ),
    row(
        6750,
        H,
        "a module is missing",
        "FROM or TO names a module that is not fitted, or an address that it does not have; the instruction is skipped.",
        "Check the module number and what is fitted.",
    ),
    row(
        6750,
        FX,
        "PID: auto tuning failed",
        "The measured and the set value differ too little at the start of auto tuning, or too much at its end; auto tuning ends. Tuning by limit cycle, which compiled programs do not have, reports it, too.",
        "Start with a difference of more than 150.",
    ),
    row(
        6751,
        ALL,
        "PID: the measured value moves the wrong way in auto tuning",
        "Auto tuning continues.",
        "Check the direction of action, bit 0 of the second parameter.",
    ),
    row(
        6760,
        H.or(ModelSet::L01S),
        "too many high-speed comparisons at once",
        "More high-speed comparison instructions are driven at the same time than the PLC has units for. Those beyond the limit have no effect.",
        "Drive them one after the other.",
    ),
    row(
        6760,
        ModelSet::FX,
        "ABS: the sum of the servo amplifier's data is wrong",
        "The PLC's table gives the code to ABS alone. Compiled programs also report it where more high-speed comparisons are driven at the same time than the PLC has units for; those beyond the limit have no effect.",
        "Check the wires to the servo amplifier. Drive high-speed comparisons one after the other.",
    ),
    row(
        6763,
        FX,
        "an input has no interrupt for the instruction",
        SKIPPED,
        "Use an input that the instruction can monitor.",
    ),
    row(
        6764,
        FX,
        "a pulse output is already in use",
        "Two instructions send pulses at one output at the same time. The later one is skipped and the scan continues.",
        "Drive them one after the other: wait for M8029 or for the output to be free.",
    ),
    row(
        6770,
        H,
        "a pulse output is already in use",
        "Two instructions send pulses at one output at the same time. The later one is skipped and the scan continues.",
        "Drive them one after the other: wait for M8029 or for the output to be free.",
    ),
];

/// Meanings of a code, one for each group of models that agrees.
pub fn all_of(code: u16) -> impl Iterator<Item = &'static PlcError> {
    let all = OF_PROGRAMS.iter().chain(codes::CODES);
    all.filter(move |error| error.code == code)
}

/// Meaning of a code on a model.
pub fn find(code: u16, model: ModelId) -> Option<&'static PlcError> {
    all_of(code).find(|error| error.models.has(model))
}

/// Title of a code on a model, in a few words.
pub fn title(code: u16, model: ModelId) -> &'static str {
    find(code, model).map_or("operation error", |error| error.title)
}

/// Number under which a model reports what a check with this identifier finds. The checks state numbers of H1U and H2U,
/// whose table has one for all faults of operands (h1u-h2u-programming §8.2); FX has one for each. `None`: the model
/// does not number it.
pub fn of_check(id: &str, number: u16, model: &Model) -> Option<u16> {
    match model.error_numbers {
        ErrorNumbers::No => None,
        ErrorNumbers::AllButLogic => {
            let is_logic = matches!(number, 6601..=6604 | 6609..=6617);
            (!is_logic).then_some(number)
        }
        ErrorNumbers::All if number != OPERANDS => Some(number),
        ErrorNumbers::All => Some(match id {
            "E0106" | "E0108" | "E0110" => 6505,
            "E0301" => OPERANDS,
            _ => 6501,
        }),
    }
}

/// [`of_check`] for a reader of any model: `6503 on H1U and H2U, 6501 on FX`.
pub fn check_in_words(id: &str, number: u16) -> String {
    let on = |model| of_check(id, number, Model::get(model));
    match (on(ModelId::H2u), on(ModelId::Fx3u)) {
        (Some(here), Some(there)) if here != there => {
            format!("{here} on H1U and H2U, {there} on FX")
        }
        (None, Some(there)) => format!("{there} on FX"),
        (Some(_), _) | (None, None) => number.to_string(),
    }
}

/// Faults of operands.
const OPERANDS: u16 = 6503;

/// Errors that a program for a model can report while it runs, in the order of their codes.
pub fn of_programs(model: ModelId) -> impl Iterator<Item = &'static PlcError> {
    let errors = OF_PROGRAMS.iter();
    errors.filter(move |error| error.models.has(model))
}

#[cfg(test)]
mod tests {
    use super::codes::CODES;
    use super::{OF_PROGRAMS, all_of, find};
    use crate::{Model, ModelId};
    use std::path::Path;

    #[test]
    fn codes_are_in_order() {
        for table in [OF_PROGRAMS, CODES] {
            assert!(table.is_sorted_by(|a, b| a.code <= b.code));
        }
        for model in ModelId::ALL {
            for error in OF_PROGRAMS.iter().chain(CODES) {
                let meanings = all_of(error.code).filter(|error| error.models.has(model));
                assert!(meanings.count() <= 1, "{model:?} {}", error.code);
            }
        }
    }

    /// The numbers 6700 to 6799 in the sources of folders of this workspace.
    fn codes_in(folder: &Path, found: &mut Vec<u16>) {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                codes_in(&path, found);
                continue;
            }
            let text = std::fs::read_to_string(&path).unwrap();
            let code = text.split("mod tests").next().unwrap_or_default();
            let words = code.split(|c: char| !c.is_ascii_alphanumeric());
            found.extend(words.filter_map(|word| {
                let number: u16 = word.parse().ok()?;
                (6700..6800).contains(&number).then_some(number)
            }));
        }
    }

    #[test]
    fn every_code_that_is_raised_has_a_page() {
        let root = Path::new(env!("RUNGC_ROOT"));
        let mut raised = Vec::new();
        for folder in ["runtime-rt/rt/src", "ir/lower/src"] {
            codes_in(&root.join(folder), &mut raised);
        }
        assert!(raised.len() > 10, "no codes are found: {raised:?}");
        let without: Vec<u16> = raised
            .into_iter()
            .filter(|&code| all_of(code).next().is_none())
            .collect();
        assert_eq!(without, [0u16; 0]);
    }

    #[test]
    fn meanings_are_those_of_one_model() {
        for model in ModelId::ALL.map(Model::get) {
            let errors = OF_PROGRAMS.iter().chain(CODES);
            for error in errors.filter(|error| error.models.has(model.id)) {
                let text = format!("{}\n{}\n{}", error.title, error.meaning, error.remedy);
                for (class, number) in crate::special::devices_in(&text) {
                    assert!(
                        model.has(class, number),
                        "{} {}: {text}",
                        model.name,
                        error.code
                    );
                }
                let mut words = text.split(|c: char| !c.is_ascii_alphanumeric());
                let family = |word: &str| {
                    word.starts_with("FX") || ["H1U", "H2U", "L01S", "HM"].contains(&word)
                };
                assert!(!words.any(family), "{} {}: {text}", model.name, error.code);
            }
        }
    }

    #[test]
    fn checks_have_the_numbers_of_the_model() {
        let of = |id, number, model| super::of_check(id, number, Model::get(model));
        assert_eq!(of("E0106", 6503, ModelId::H2u), Some(6503));
        assert_eq!(of("E0106", 6503, ModelId::Fx2n), Some(6505));
        assert_eq!(of("E0101", 6503, ModelId::Fx3u), Some(6501));
        assert_eq!(of("E0301", 6503, ModelId::Fx1s), Some(6503));
        assert_eq!(of("E0301", 6503, ModelId::Hm), None);
        assert_eq!(of("E0401", 6610, ModelId::H1u), None);
    }

    /// Codes that a runtime function or a port of a model shows.
    fn shown(model: &Model) -> Vec<u16> {
        let mut codes = vec![6105, 6701, 6702, 6706, model.value_error];
        codes.extend([6730, 6732, 6733, 6734, 6735, 6736, 6740, 6742, 6747, 6751]);
        // HM has no modules and no potentiometers.
        if model.id != ModelId::Hm {
            let separate = model.value_error == 6707;
            codes.push(if separate { 6750 } else { 6708 });
        }
        for port in model.ports.all() {
            let Some(error) = port.error else { continue };
            assert!(model.special_works(error.0), "{} {error:?}", model.name);
            // No programming port waits for the end of a frame.
            let kinds = if port.codes == 6200 { 5 } else { 6 };
            codes.extend((1..=kinds).map(|kind| port.codes + kind));
            if port.modbus_errors != 0 {
                codes.extend((0..10).map(|kind| port.modbus_errors + kind));
            }
            if port.modbus.is_some() {
                codes.push(port.codes + 21);
            }
        }
        codes
    }

    #[test]
    fn every_code_that_a_model_shows_has_a_meaning_there() {
        for model in ModelId::ALL.map(Model::get) {
            for code in shown(model) {
                assert!(find(code, model.id).is_some(), "{} {code}", model.name);
            }
        }
    }
}
