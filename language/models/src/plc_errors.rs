//! The error codes of PLCs that a running program can meet here: what D8067 and D8061 show, and what to do about it.
//!
//! From the tables h1u-h2u-programming §8.1 and §5.7 (PID), and, where these are silent, what the family does.

/// An error code and its page.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct PlcError {
    /// The code: 6706.
    pub code: u16,
    /// Title, in a few words.
    pub title: &'static str,
    /// Meaning, and the PLC's reaction.
    pub meaning: &'static str,
    /// Remedy.
    pub remedy: &'static str,
}

const fn row(
    code: u16,
    title: &'static str,
    meaning: &'static str,
    remedy: &'static str,
) -> PlcError {
    PlcError {
        code,
        title,
        meaning,
        remedy,
    }
}

/// The code of the watchdog.
pub const WATCHDOG: u16 = rungc_rt::special::WATCHDOG_CODE as u16;

/// Effect of most operation errors.
const SKIPPED: &str = "The instruction is skipped and the scan continues.";
/// Effect of an error in PID's parameters.
const PID_STOPS: &str = "PID stops until its contact turns off and on again.";
/// Effect of an overflow in PID.
const PID_GOES_ON: &str = "PID continues with the limit of the range.";
/// Remedy for an overflow in PID.
const PID_RANGE: &str =
    "Scale the measured value and the set value down, or choose a smaller gain.";

/// All of them, in the order of their codes.
pub static PLC_ERRORS: &[PlcError] = &[
    row(
        WATCHDOG,
        "a scan does not end (watchdog)",
        "The scan took longer than the watchdog time in D8000, 200 ms unless the program changes it. The PLC goes to STOP with all outputs off and \
         shows M8061 and D8061. Compiled programs and `rungc run` count instead of measuring: a scan may repeat 10,000 steps for each millisecond \
         of D8000 in its loops and backward jumps.",
        "Check the named loop or jump: does its condition ever end it, is its count what you expect? Spread long work over several \
         scans, or write a longer time to D8000.",
    ),
    row(
        6381,
        "a remote module does not answer",
        "FROM or TO names a module on the CAN bus (100 and its station) that has not answered within D8299 ms. M8299 is on until the program \
         switches it off; the instruction is skipped.",
        "Check the module's supply, its station and the bit rate of the bus, or write a longer time to D8299 (5 to 1000).",
    ),
    row(
        6701,
        "a jump or call to a missing label",
        "An index register directs CJ or CALL to a pointer P that the program does not have. The scan continues after the instruction.",
        "Limit the index register to labels that exist.",
    ),
    row(
        6702,
        "calls are nested too deep",
        "A subroutine calls itself, directly or through others, or CALL is nested deeper than the PLC allows. The call is skipped.",
        "Replace the recursion with a loop, or call the subroutines one after the other.",
    ),
    row(
        6706,
        "a device does not exist, or a value does not fit the instruction",
        "An index register or a count goes past the last device of a class, a divisor is 0, or, on FX and L01S, an operand has a value that the \
         instruction does not accept. The instruction is skipped and the scan continues.",
        "Check the index register and the count before the instruction; compare a divisor with 0 first.",
    ),
    row(
        6707,
        "a value does not fit the instruction",
        "On H1U and H2U: an operand has a value that the instruction does not accept, for example an invalid BCD number or a negative count. The instruction \
         is skipped and the scan continues.",
        "`rungc explain` with the name of the instruction lists the accepted values; check them first.",
    ),
    row(
        6730,
        "PID: the sampling time is negative",
        PID_STOPS,
        "Write a sampling time of at least 1 ms to the first register of the parameters.",
    ),
    row(
        6732,
        "PID: the input filter constant is not 0 to 99 %",
        PID_STOPS,
        "Write 0 to 99 to the parameter.",
    ),
    row(
        6733,
        "PID: the proportional gain is negative",
        PID_STOPS,
        "Write 0 to 32767 % to the parameter.",
    ),
    row(
        6734,
        "PID: the integral time is negative",
        PID_STOPS,
        "Write 0 (no integral action) to 32767 units of 100 ms to the parameter.",
    ),
    row(
        6735,
        "PID: the derivative gain is not 0 to 200 %",
        PID_STOPS,
        "Write 0 to 200 to the parameter.",
    ),
    row(
        6736,
        "PID: the derivative time is negative",
        PID_STOPS,
        "Write 0 (no derivative action) to 32767 units of 10 ms to the parameter.",
    ),
    row(
        6740,
        "PID: the sampling time is not longer than a scan",
        "PID continues with the scan time as its sampling time.",
        "Choose a longer sampling time, or make the scan shorter.",
    ),
    row(
        6742,
        "PID: the measured value changes too much",
        PID_GOES_ON,
        PID_RANGE,
    ),
    row(
        6743,
        "PID: the deviation does not fit 16 bits",
        PID_GOES_ON,
        PID_RANGE,
    ),
    row(
        6744,
        "PID: the integral does not fit 16 bits",
        PID_GOES_ON,
        PID_RANGE,
    ),
    row(
        6745,
        "PID: the derivative gain makes the derivative too large",
        PID_GOES_ON,
        "Choose a smaller derivative gain.",
    ),
    row(
        6746,
        "PID: the derivative does not fit 16 bits",
        PID_GOES_ON,
        PID_RANGE,
    ),
    row(
        6747,
        "PID: the result does not fit 16 bits",
        PID_GOES_ON,
        PID_RANGE,
    ),
    row(
        6750,
        "a module is missing, or auto tuning failed",
        "FROM, TO or a buffer memory operand names a module that is not fitted, or an address that it does not have; the instruction is skipped. \
         PID: the measured and the set value differ too little at the start of auto tuning, or too much at its end; auto tuning ends.",
        "Check the module number and what is fitted. For auto tuning, start with a difference of more than 150.",
    ),
    row(
        6751,
        "PID: the measured value moves the wrong way in auto tuning",
        "Auto tuning continues.",
        "Check the direction of action, bit 0 of the second parameter.",
    ),
    row(
        6760,
        "too many high-speed comparisons at once",
        "More high-speed comparison instructions are driven at the same time than the PLC has units for. Those beyond the limit have no effect.",
        "Drive them one after the other.",
    ),
    row(
        6763,
        "an input has no interrupt for the instruction",
        SKIPPED,
        "Use an input that the instruction can monitor.",
    ),
    row(
        6764,
        "a pulse output is already in use",
        "On FX: two instructions send pulses at one output at the same time. The later one is skipped and the scan continues.",
        "Drive them one after the other: wait for M8029 or for the output to be free.",
    ),
    row(
        6770,
        "a pulse output is already in use",
        "On H1U and H2U: two instructions send pulses at one output at the same time. The later one is skipped and the scan continues.",
        "Drive them one after the other: wait for M8029 or for the output to be free.",
    ),
];

/// The page of a code.
pub fn find(code: u16) -> Option<&'static PlcError> {
    let at = PLC_ERRORS.binary_search_by_key(&code, |error| error.code);
    at.ok().map(|i| &PLC_ERRORS[i])
}

/// Title of a code, in a few words.
pub fn title(code: u16) -> &'static str {
    find(code).map_or("operation error", |error| error.title)
}

#[cfg(test)]
mod tests {
    use super::{PLC_ERRORS, find};
    use std::path::Path;

    #[test]
    fn codes_are_in_order() {
        assert!(PLC_ERRORS.is_sorted_by(|a, b| a.code < b.code));
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
            .filter(|&code| find(code).is_none())
            .collect();
        assert_eq!(without, [0u16; 0]);
    }
}
