//! Serial instructions, FNC 80–93, inverters, FNC 270–276, and the memory cassette, FNC 290–305.

use super::row::*;
use super::{Classes, Inst, Lower, Param, Repeat, Rule, When};
use rungc_models::ModelSet;
use rungc_rt::RtFn;
use rungc_rt::comm::modbus::Limits;
use rungc_syntax::{DeviceClass, Operand, OperandKind};

/// Reason for the missing inverter instructions: when a request is repeated, and which codes its errors have.
const INVERTER: &str = "the exchange with Mitsubishi inverters is in no manual at hand; RS2 can send its frames, and ADPRW reaches \
                        inverters by Modbus";
const CASSETTE: &str = "it works on a memory cassette, which a compiled program does not have";

/// A number of bytes or words: a constant or a register.
const fn number(name: &'static str, max: i64) -> Param {
    src(name, CONSTANTS.or(DATA)).limits(0, max)
}

/// Bit 13 of S1 chooses 29-bit identifiers; else they have 11 bits.
const CAN_IDENTIFIER: Rule = Rule::Holds(
    |operands| {
        let constant = |i: usize| match operands.get(i).map(|operand| &operand.kind) {
            Some(&OperandKind::Hex(value, None)) => Some(value),
            Some(&OperandKind::Decimal(value, None)) => u64::try_from(value).ok(),
            _ => None,
        };
        match (constant(0), constant(1)) {
            (Some(mode), Some(identifier)) => mode & 1 << 13 != 0 || identifier <= 0x7ff,
            _ => true,
        }
    },
    "at most H7FF unless bit 13 of S1 is on",
);

const fn any(name: &'static str) -> Param {
    src(name, CONSTANTS.or(DATA))
}

/// Words for n hexadecimal digits, operand 2.
fn words_of_digits(constants: &[Option<i64>]) -> Option<u32> {
    Some(constant(constants, 2)?.div_ceil(4))
}

/// Last function of Modbus that reads.
const LAST_READ: i64 = 0x04;

/// Returns true if a Modbus request with these constants can be made; of what is not a constant, it may.
fn request_holds(
    limits: &Limits,
    station: Option<i64>,
    function: Option<i64>,
    count: Option<i64>,
) -> bool {
    let fits = match (function, count) {
        (Some(function), Some(count)) => {
            let most = u8::try_from(function).ok().and_then(|f| limits.most(f));
            most.is_none_or(|most| (1..=i64::from(most)).contains(&count))
        }
        _ => true,
    };
    let reads = function.is_some_and(|function| function <= LAST_READ);
    fits && !(station == Some(0) && reads)
}

fn operand(operands: &[Operand], i: usize) -> Option<i64> {
    operands.get(i)?.kind.constant()
}

/// Station and function in the bytes of the first operand (h1u-h2u-programming §5.7.1).
const STATION_AND_FUNCTION: Rule = Rule::Suits(
    |word| {
        let (station, function) = (word >> 8 & 0xff, word & 0xff);
        let known = matches!(function, 0x01..=0x06 | 0x0f | 0x10);
        known && station <= 247 && (station > 0 || function > LAST_READ)
    },
    "high byte: a station from 1 to 247, or 0 to write to all; low byte: a function 01 to 06, 0F or 10",
);
const H1U_COUNT: Rule = Rule::Holds(
    |operands| count_holds(&Limits::H1U, operands),
    "1 to 800 coils or 1 to 50 registers",
);
const H2U_COUNT: Rule = Rule::Holds(
    |operands| count_holds(&Limits::H2U, operands),
    "1 to 2000 coils or 1 to 125 registers, for writing 1 to 1968 coils or 1 to 120 registers",
);
/// A rule for operand 2, with the function in the low byte of operand 0.
fn count_holds(limits: &Limits, operands: &[Operand]) -> bool {
    let function = operand(operands, 0).map(|word| word & 0xff);
    request_holds(limits, None, function, operand(operands, 2))
}

/// Operands of ADPRW: station, function, address, number.
const ADPRW_STATION: Rule = Rule::Holds(
    |operands| {
        let [station, function] = [0, 1].map(|i| operand(operands, i));
        request_holds(&Limits::STANDARD, station, function, None)
    },
    "1 to 247 for a function that reads",
);
const ADPRW_COUNT: Rule = Rule::Holds(
    |operands| {
        let [function, count] = [1, 3].map(|i| operand(operands, i));
        request_holds(&Limits::STANDARD, None, function, count)
    },
    "1 to 2000 coils or 1 to 125 registers, for writing 1 to 1968 coils or 1 to 123 registers",
);

const BOARDS: ModelSet = ModelSet::COMPATIBLE;
/// Number of coils or registers in a Modbus request: at most 2000 and 125 (Modbus application protocol §6).
const COUNT: Param = number("n", 2000);

/// Words of a Modbus request's data: coils are packed sixteen to a word. The low byte of operand 0 is the function,
/// operand 3 the count.
fn answer_words(constants: &[Option<i64>]) -> Option<u32> {
    let count = constant(constants, 3)?;
    match constant(constants, 0)? & 0xff {
        0x01 | 0x02 | 0x0f => Some(count.div_ceil(16).max(1)),
        0x03 | 0x04 | 0x10 => Some(count.max(1)),
        _ => Some(1),
    }
}

/// Devices of ADPRW's data on FX3 (FX3U MODBUS manual §8.3): operand 1 is the function, operand 3 the count, of coils
/// also where they are packed.
fn adprw_devices(constants: &[Option<i64>]) -> Option<u32> {
    match constant(constants, 1)? {
        0x05..=0x08 | 0x16 => Some(1),
        0x0b => Some(2),
        0x0c => Some(36),
        0x11 => Some(128),
        _ => constant(constants, 3),
    }
}

const N: Param = count("n", 1, 256);
const N_OR_REGISTER: Param = N.also(DATA);
/// Models whose RS and RS2 take up to 4096 bytes (JY992D48301 §5.9.1; FX data communication manual, part F).
const UP_TO_4096: ModelSet = FX.without(ModelSet::FX1);
const SEND: Param = src("S", DATA).per(1);
const SEND_LENGTH: Param = number("m", 256);
const RECEIVE: Param = dst("D", DATA).per(3).changed();
const RECEIVE_LENGTH: Param = number("n", 256);
/// RS as Modbus master, D8126 = 20h or 30h (h1u-h2u-programming §5.7): what the other models take for lengths and
/// receive registers is the address, the number, and the data.
const RS_MODBUS: &[Param] = &[
    any("S").rules(&[STATION_AND_FUNCTION]),
    any("m"),
    any("D").rules(&[H2U_COUNT]),
    both("n", DATA).per(2),
];
/// MODBUS, and without the port MODBUS2: station and function, address, number, data.
const fn modbus(count: &'static [Rule]) -> [Param; 5] {
    [
        any("S1").rules(&[STATION_AND_FUNCTION]),
        any("S2"),
        any("n").rules(count),
        both("D", DATA).per(2),
        any("n1").limits(0, 3),
    ]
}
const MODBUS_H1U: &[Param; 5] = &modbus(&[H1U_COUNT]);
const MODBUS_H2U: &[Param; 5] = &modbus(&[H2U_COUNT]);
/// Either form, where a register comes first: the number as a constant shows that it is a Modbus request.
const RS_INOVANCE: &[Param] = &[
    src("S", DATA).len_of(|constants| match constant(constants, 2) {
        Some(_) => Some(1),
        None => constant(constants, 1),
    }),
    any("m").rules(&[SENDS_256_BYTES]),
    dst("D", DATA)
        .len_of(|constants| constant(constants, 3))
        .changed()
        .also(CONSTANTS),
    number("n", 256),
];
const SENDS_256_BYTES: Rule = Rule::Holds(
    |operands| match operands {
        [_, length, received, ..] if !CONSTANTS.meets(Classes::of(&received.kind)) => {
            match length.kind {
                OperandKind::Decimal(count, None) => (0..=256).contains(&count),
                OperandKind::Hex(count, None) => count <= 256,
                _ => true,
            }
        }
        _ => true,
    },
    "at most 256 bytes",
);
/// hm-motion-controller §6.4: 0 for all slaves, which only take writes.
const HM_STATION: Param = any("S1").limits(0, 247);
const HM_READ_STATION: Param = any("S1").limits(1, 247);
const HM_ADDRESS: Param = any("S2");
const fn hm_number(most: u16) -> Param {
    any("S3").limits(1, most as i64)
}
const HM_PORT: Param = any("D2").limits(0, 1);
const READ_BITS: &[Param] = &[
    HM_READ_STATION,
    HM_ADDRESS,
    hm_number(Limits::STANDARD.read_bits),
    coil("D1", COILS).per(2),
    HM_PORT,
];
const READ_WORDS: &[Param] = &[
    HM_READ_STATION,
    HM_ADDRESS,
    hm_number(Limits::STANDARD.read_words),
    dst("D1", DATA).per(2),
    HM_PORT,
];
const WRITE_BIT: &[Param] = &[HM_STATION, HM_ADDRESS, bit("D1", COILS).plain(), HM_PORT];
const WRITE_WORD: &[Param] = &[HM_STATION, HM_ADDRESS, src("D1", DATA).plain(), HM_PORT];
const WRITE_BITS: &[Param] = &[
    HM_STATION,
    HM_ADDRESS,
    hm_number(Limits::STANDARD.write_bits),
    bit("D1", COILS).per(2),
    HM_PORT,
];
const WRITE_WORDS: &[Param] = &[
    HM_STATION,
    HM_ADDRESS,
    hm_number(Limits::STANDARD.write_words),
    src("D1", DATA).per(2),
    HM_PORT,
];
/// The first operand is the number of a D register.
const FREE: &[Param] = &[any("S1"), any("S2").limits(1, 255), any("D").limits(0, 1)];

const PID: &[Param] = &[
    src("S1", DATA),
    src("S2", DATA),
    both("S3", DATA).len(25),
    both("D", DATA),
];
/// The parameters lie below the special registers (h1u-h2u-programming §4.3.9).
const PID_INOVANCE: &[Param] = &[
    src("S1", DATA),
    src("S2", DATA),
    both("S3", DATA)
        .len(25)
        .numbers(&[(DeviceClass::D, 0, 7975)]),
    both("D", DATA),
];
/// 25 words, as on the others; without alarms and limits of the output 20, for tuning by limit cycle 29 (FX3
/// programming manual 16.7).
const PID_FX3: &[Param] = &[
    src("S1", DATA_PLACES),
    src("S2", DATA_PLACES),
    both("S3", DATA).between(20, 29),
    both("D", DATA_PLACES),
];
const PID_L01S: &[Param] = &[
    src("S1", DATA),
    src("S2", DATA),
    both("S3", DATA).len(42),
    both("D", DATA),
];

const ASCI_HM: &[Param] = &[
    src("S", REGISTERS).len_of(words_of_digits),
    dst("D", REGISTERS).per(2),
    N,
];
const HEX_HM: &[Param] = &[
    src("S", REGISTERS).per(2),
    dst("D", REGISTERS).len_of(words_of_digits),
    N,
];

const fn serial(name: &'static str, fnc: u16, title: &'static str) -> Inst {
    row(name, title, "h1u-h2u-programming §4.3.9")
        .fnc(fnc)
        .steps(9, 9)
}

/// An instruction that `[canlink]` of a project becomes.
const fn canlink(name: &'static str, title: &'static str) -> Inst {
    row(name, title, "h1u-h2u-programming §5.9")
        .on(INOVANCE)
        .errors(&[6706, 6707])
}

const fn modbus_hm(name: &'static str, title: &'static str, function: RtFn) -> Inst {
    row(name, title, "hm-motion-controller §7")
        .forms(W16_P)
        .on(HM)
        .repeat(Repeat::Same)
        .call(function)
        .text("Sends one Modbus request to station S1 on port D2, 0 RS232 or 1 RS485. S2 is the address, S3 how many.")
}

const fn inverter(name: &'static str, fnc: u16, title: &'static str, text: &'static str) -> Inst {
    row(name, title, "public knowledge of FX3U")
        .fnc(fnc)
        .steps(9, 9)
        .on(FX3)
        .flags(&["M8029", "M8151", "M8152", "M8153"])
        .todo(INVERTER)
        .text(text)
}

const fn cassette(name: &'static str, fnc: u16, title: &'static str, text: &'static str) -> Inst {
    row(name, title, "public knowledge of FX3U")
        .fnc(fnc)
        .forms(W16_P)
        .steps(5, 5)
        .on(FX3U)
        .errors(&[6706])
        .todo(CASSETTE)
        .text(text)
}

pub(super) const ROWS: &[Inst] = &[
    serial("RS", 80, "Serial transfer")
        .on(NOT_HM)
        .takes(&[SEND, SEND_LENGTH, RECEIVE, RECEIVE_LENGTH])
        .variants(&[
            on(UP_TO_4096).takes(&[SEND, number("m", 4096), RECEIVE, number("n", 4096)]),
            variant(INOVANCE, When::First(CONSTANTS, 0, u32::MAX)).takes(RS_MODBUS),
            on(INOVANCE).takes(RS_INOVANCE),
        ])
        .flags(&["M8121", "M8122", "M8123", "M8124", "M8129", "M8161", "D8120"])
        .errors(&[6706, 6707])
        .call(RtFn::Rs)
        .text(
            "Sends m bytes from S on when the program sets M8122, and receives n bytes to D; M8123 is on when they are there. On H1U and \
             H2U, with 20h or 30h in D8126, it is a Modbus request: S is station × 256 + function, m the address, D how many, n the first \
             data register.",
        ),
    serial("ASCI", 82, "Hexadecimal digits to text")
        .repeat(Repeat::Replacing)
        .aliases(&["ASCII"])
        .forms(W16_P)
        .steps(7, 7)
        .takes(&[src("S", VALUES).len_of(words_of_digits), dst("D", RESULT_GROUPS.or(PLACES)).per(2), N])
        .variants(&[
            on(HM).takes(ASCI_HM),
            // JY997D16601 §16.3.
            on(LIKE_FX).takes(&[
                src("S", VALUES).len_of(words_of_digits),
                dst("D", RESULT_GROUPS.or(PLACES)).per(2),
                N_OR_REGISTER,
            ]),
        ])
        .flags(&["M8161"])
        .errors(&[6706])
        .call(RtFn::Asci)
        .lower_on(&[(HM, Lower::Call(RtFn::AsciBytes))])
        .text(
            "Writes the lowest n hexadecimal digits of the number at S as characters to D, the highest first, two to a word, low byte \
             first. With M8161 on, and on HM, one to a word.",
        ),
    serial("HEX", 83, "Text to hexadecimal digits")
        .repeat(Repeat::Same)
        .forms(W16_P)
        .steps(7, 7)
        .takes(&[src("S", VALUES).per(2), dst("D", RESULTS).len_of(words_of_digits), N])
        .variants(&[
            on(HM).takes(HEX_HM),
            // JY997D16601 §16.4.
            on(LIKE_FX).takes(&[
                src("S", VALUES).per(2),
                dst("D", RESULTS).len_of(words_of_digits),
                N_OR_REGISTER,
            ]),
        ])
        .flags(&["M8161"])
        .errors(&[6706, 6707])
        .call(RtFn::Hex)
        .lower_on(&[(HM, Lower::Call(RtFn::HexBytes))])
        .text(
            "Reads n characters at S as hexadecimal digits, four to a word of D, the last the lowest. They stand two to a word; with \
             M8161 on, and on HM, one to a word.",
        ),
    serial("CCD", 84, "Check code")
        .repeat(Repeat::Replacing)
        .forms(W16_P)
        .steps(7, 7)
        .on(NOT_HM)
        .takes(&[
            src("S", GROUPS.or(PLACES)).per(2),
            dst("D", RESULT_GROUPS.or(PLACES)).len(2),
            N,
        ])
        // JY992D88101 §5.9.5: n is K, H or D; JY997D16601 §16.5: D, R, K or H.
        .variants(&[on(LIKE_FX).takes(&[
            src("S", GROUPS.or(PLACES)).per(2),
            dst("D", RESULT_GROUPS.or(PLACES)).len(2),
            N_OR_REGISTER,
        ])])
        .flags(&["M8161"])
        .errors(&[6706])
        .call(RtFn::Ccd)
        .text("D = the sum, D+1 = the exclusive or of n bytes from S on, two to a word; with M8161 on one to a word."),
    serial("RS2", 87, "Serial transfer on a port")
        .steps(11, 11)
        .on(LIKE_FX3.or(INOVANCE))
        .takes(&[SEND, SEND_LENGTH, RECEIVE, RECEIVE_LENGTH, any("n1").limits(0, 3)])
        .variants(&[on(UP_TO_4096).takes(&[
            SEND,
            number("m", 4096),
            RECEIVE,
            number("n", 4096),
            any("n1").limits(0, 3),
        ])])
        .flags(&["M8122", "M8123", "M8262", "M8263", "M8272", "M8273"])
        .errors(&[6376, 6377, 6706, 6707])
        .call(RtFn::Rs2)
        .text("As RS, on port n1. On FX3 and L01S a header, a terminator and a sum may stand around the data."),
    serial("PID", 88, "PID control")
        .takes(PID)
        .variants(&[on(INOVANCE).takes(PID_INOVANCE), on(FX3).takes(PID_FX3), on(L01S).takes(PID_L01S)])
        .errors(&[
            6706, 6730, 6732, 6733, 6734, 6735, 6736, 6740, 6742, 6743, 6744, 6745, 6746, 6747, 6748, 6749, 6750, 6751,
        ])
        .call(RtFn::Pid)
        .lower_on(&[
            (FX3, Lower::Call(RtFn::PidChecked)),
            (FX, Lower::Call(RtFn::PidTuning)),
            (HM, Lower::Call(RtFn::PidHm)),
            (L01S, Lower::Call(RtFn::PidThermal)),
        ])
        .text(
            "Controls the value S2 to the target S1 by output D. S3 and the words after it contain the sampling time, direction, gain, \
             integral and derivative times, limits and alarms, and the controller's memory.",
        ),
    serial("MODBUS", 89, "Modbus master")
        .on(INOVANCE)
        .takes(MODBUS_H2U.split_at(4).0)
        .variants(&[on(ModelSet::H1U).takes(MODBUS_H1U.split_at(4).0)])
        .flags(&["M8122", "M8123"])
        .call(RtFn::Modbus)
        .text("Sends a Modbus request: S1 the station and the function, S2 the address, n how many, D the data."),
    serial("CANTX", 90, "Send by CAN")
        .steps(13, 13)
        .on(INOVANCE)
        .takes(&[any("S1"), any("S2").rules(&[CAN_IDENTIFIER]), src("D", DATA).len(4), number("n", 8)])
        .errors(&[6706, 6707])
        .call(RtFn::Cantx)
        .text("Sends n bytes from D on, high byte first, with the identifier in S1 and S2."),
    serial("CANRX", 91, "Receive by CAN")
        .steps(13, 13)
        .on(INOVANCE)
        .takes(&[any("S1"), any("S2"), dst("D", DATA).len(4), number("n", 8)])
        .errors(&[6706, 6707])
        .call(RtFn::Canrx)
        .text("Receives n bytes with the identifier in S1 and S2 to D, high byte first."),
    canlink("CANNET", "CANlink: this station")
        .takes(&[any("S1").limits(1, 63), any("S2").limits(1, 63), any("S3").limits(0, 20_000)])
        .call(RtFn::Cannet)
        .text("This PLC is station S1 of a CANlink network whose master is station S2; S3 ms between heartbeats, 0: none."),
    canlink("CANNODE", "CANlink: another station")
        .takes(&[any("S1").limits(1, 63), any("S2").limits(0, 3)])
        .call(RtFn::Cannode)
        .text("What station S1 is: bit 0 of S2, a slave that the master watches; bit 1, one whose frames to all are taken."),
    canlink("CANPUT", "CANlink: send registers")
        .takes(&[any("S1").limits(0, 30_000), src("D", Classes::D).per(4), any("S2"), any("S3"), number("n", 64)])
        .call(RtFn::Canput)
        .text("Sends n registers from D on to register S3 of station S2 (0: all that listen), each S1 ms, or in each scan."),
    serial("MODBUS2", 93, "Modbus master on a port")
        .steps(11, 11)
        .on(INOVANCE)
        .takes(MODBUS_H2U)
        .variants(&[on(ModelSet::H1U).takes(MODBUS_H1U)])
        .flags(&["M8122", "M8123", "M8262", "M8263", "M8272", "M8273"])
        .call(RtFn::Modbus2)
        .text("As MODBUS, on port n1."),
    row("UINIT", "Set up a port", "hm-motion-controller §7")
        .on(HM)
        .takes(&[
            src("S1", CONSTANTS.or(Classes::D)),
            src("S2", CONSTANTS.or(Classes::D)),
            src("D1", CONSTANTS.or(Classes::D)),
            src("D2", CONSTANTS.or(Classes::D)).limits(0, 1),
        ])
        .call(RtFn::Uinit)
        .text("Starts port D2 with protocol S1 and format S2; D1 is the number of the first register of its work area."),
    modbus_hm("MRDC", "Modbus: read coils", RtFn::Mrdc).takes(READ_BITS),
    modbus_hm("MRDI", "Modbus: read inputs", RtFn::Mrdi).takes(READ_BITS),
    modbus_hm("MRDD", "Modbus: read registers", RtFn::Mrdd).takes(READ_WORDS),
    modbus_hm("MRDAI", "Modbus: read input registers", RtFn::Mrdai).takes(READ_WORDS),
    modbus_hm("MWRC", "Modbus: write a coil", RtFn::Mwrc).takes(WRITE_BIT),
    modbus_hm("MWRD", "Modbus: write a register", RtFn::Mwrd).takes(WRITE_WORD),
    modbus_hm("MWRCS", "Modbus: write coils", RtFn::Mwrcs).takes(WRITE_BITS),
    modbus_hm("MWRDS", "Modbus: write registers", RtFn::Mwrds).takes(WRITE_WORDS),
    row("USEND", "Send bytes", "hm-motion-controller §7")
        .on(HM)
        .forms(W16_W32)
        .takes(FREE)
        .call(RtFn::Usend)
        .text("Sends the low bytes of S2 registers from register number S1 on by port D."),
    row("URCV", "Receive bytes", "hm-motion-controller §7")
        .on(HM)
        .forms(W16_W32)
        .takes(FREE)
        .call(RtFn::Urcv)
        .text("Waits for S2 bytes on port D, one to each register from number S1 on."),
    inverter(
        "EXTR",
        180,
        "Inverter communication by the extension ROM",
        "K10 to K13 as S: monitors, controls, reads or writes the parameters of an inverter by the FX2N-ROM-E1.",
    )
        .forms(ALL_FORMS)
        .steps(9, 17)
        .on(ModelSet::FX2N)
        .flags(&["M8029", "M8104", "M8154", "M8155", "M8156"])
        .takes(&[
            src("S", CONSTANTS).limits(10, 13),
            any("S1"),
            any("S2"),
            mixed_out("D", RESULT_GROUPS.or(DATA).or(CONSTANTS)).changed(),
        ]),
    inverter("IVCK", 270, "Monitor an inverter", "Reads monitor value S2 of inverter S1 on port n to D.")
        .takes(&[any("S1"), any("S2"), dst("D", RESULT_GROUPS.or(DATA)), number("n", 2)]),
    inverter("IVDR", 271, "Control an inverter", "Sends command S2 with value S3 to inverter S1 on port n.")
        .takes(&[any("S1"), any("S2"), src("S3", VALUES), number("n", 2)]),
    inverter(
        "IVRD",
        272,
        "Read an inverter's parameter",
        "Reads parameter S2 of inverter S1 on port n to D. On FX3U-compatible boards it is a Modbus request: S1 is station × 256 + function, \
         S2 the first address, n how many coils or registers go to D and on.",
    )
        .takes(&[any("S1"), any("S2"), dst("D", DATA), number("n", 2)])
        .variants(&[on(BOARDS).takes(&[
            any("S1").rules(&[STATION_AND_FUNCTION]),
            any("S2"),
            dst("D", DATA).len_of(answer_words),
            COUNT,
        ])])
        .lower_on(&[(BOARDS, Lower::Call(RtFn::Ivrd))]),
    inverter(
        "IVWR",
        273,
        "Write an inverter's parameter",
        "Writes S3 to parameter S2 of inverter S1 on port n. On FX3U-compatible boards it is a Modbus request: S1 is station × 256 + \
         function, S2 the first address, n how many coils or registers are written from S3 on.",
    )
        .takes(&[any("S1"), any("S2"), any("S3"), number("n", 2)])
        .variants(&[on(BOARDS).takes(&[
            any("S1").rules(&[STATION_AND_FUNCTION]),
            any("S2"),
            any("S3").len_of(answer_words),
            COUNT,
        ])])
        .lower_on(&[(BOARDS, Lower::Call(RtFn::Ivwr))]),
    inverter("IVBWR", 274, "Write parameters", "Writes the S2 parameters of the table at S3 to inverter S1 on port n.")
        .on(FX3U)
        .takes(&[any("S1"), any("S2"), src("S3", DATA).open_ended(), number("n", 2)]),
    inverter("IVMC", 275, "Several inverter commands", "Sends the two commands at S3 to inverter S1 and reads two values to D.")
        .steps(11, 11)
        .takes(&[any("S1"), any("S2"), src("S3", DATA).len(2), dst("D", DATA).len(2), number("n", 2)]),
    inverter(
        "ADPRW",
        276,
        "Modbus master access",
        "Sends a Modbus request to station S: function S1, address S2, S3 how many, with the data at D.",
    )
        .steps(11, 11)
        .on(LIKE_FX3)
        .takes(&[
            // l01s-programming §8.1.2.
            any("S").limits(1, 247),
            any("S1").among(&[(0x01, 0x06), (0x0f, 0x10)]),
            any("S2"),
            any("S3").rules(&[ADPRW_COUNT]),
            mixed_out("D", BITS.or(DATA)).per(3).changed(),
        ])
        // FX3U MODBUS manual §8.3: 05, 06, 0F, 10 and 16 write constants, too.
        .variants(&[on(FX3).takes(&[
            any("S").limits(0, 247).rules(&[ADPRW_STATION]),
            any("S1").among(&[(0x01, 0x08), (0x0b, 0x0c), (0x0f, 0x11), (0x16, 0x16)]),
            any("S2"),
            any("S3").rules(&[ADPRW_COUNT]),
            mixed_out("D", BITS.or(DATA).or(CONSTANTS)).len_of(adprw_devices).changed(),
        ])])
        .flags(&["M8029"])
        .call(RtFn::AdprwFx3)
        .lower_on(&[(L01S, Lower::Call(RtFn::Adprw))]),
    cassette("LOADR", 290, "Load from extension file registers", "Copies n words from ER to R, from number S on.")
        .takes(&[dst("S", Classes::R).per(1), number("n", 32767)])
        .twin(DeviceClass::ER)
        .call(RtFn::Loadr),
    cassette("SAVER", 291, "Save to extension file registers", "Writes 2048 words from S on to ER, n words in each scan; D counts.")
        .forms(W16)
        .steps(7, 7)
        .takes(&[src("S", Classes::R).len(2048), number("n", 2048), dst("D", Classes::D)])
        .flags(&["M8029"])
        .twin(DeviceClass::ER)
        .call(RtFn::Saver),
    cassette("INITR", 292, "Clear extension registers", "Sets n sectors of 2048 words of R and ER from S on to -1.")
        .takes(&[dst("S", Classes::R).open_ended(), number("n", 16)])
        .twin(DeviceClass::ER)
        .call(RtFn::Initr),
    cassette("LOGR", 293, "Log values", "Appends the m values from S on to the log of n sectors at D1; D2 is the next place in it.")
        .steps(11, 11)
        .takes(&[
            src("S", REGISTERS).per(1),
            number("m", 8000),
            both("D1", Classes::R).open_ended(),
            number("n", 16),
            both("D2", DATA),
        ]),
    cassette("RWER", 294, "Rewrite extension file registers", "Writes n words of R from S on to ER.")
        .on(FX3GU)
        .takes(&[src("S", Classes::R).per(1), number("n", 32767)])
        .twin(DeviceClass::ER)
        .call(RtFn::Rwer),
    cassette("INITER", 295, "Clear extension file registers", "Sets n sectors of ER from S on to -1.")
        .takes(&[dst("S", Classes::R).open_ended(), number("n", 16)])
        .twin(DeviceClass::ER)
        .call(RtFn::Initer),
    cassette("FLCRT", 300, "Create a file", "Creates or checks a file of the data logger: name S1, settings S2, S3.")
        .forms(W16)
        .steps(7, 7)
        .takes(&[text("S1", DATA.or(CONSTANTS)), src("S2", DATA).open_ended(), any("S3")]),
    cassette("FLDEL", 301, "Delete a file", "Deletes files of the data logger: name S1, what S2, result in n.")
        .forms(W16)
        .steps(7, 7)
        .takes(&[text("S1", DATA.or(CONSTANTS)), any("S2"), any("n")]),
    cassette("FLWR", 302, "Write to a file", "Writes the values at S2 to file S1 of the data logger from place S3 on.")
        .forms(W16)
        .steps(11, 11)
        .takes(&[any("S1"), src("S2", DATA).open_ended(), any("S3"), dst("D1", DATA).len(2), any("D2")]),
    cassette("FLRD", 303, "Read from a file", "Reads n values from place S2 of file S1 of the data logger to D1.")
        .forms(W16)
        .steps(11, 11)
        .takes(&[any("S1"), src("S2", DATA).open_ended(), dst("D1", DATA).open_ended(), dst("D2", DATA), any("n")]),
    cassette("FLCMD", 304, "Command a data logger", "Sends command S to the data logger.")
        .forms(W16)
        .takes(&[any("S"), any("n")]),
    cassette("FLSTRD", 305, "Read a data logger's state", "Reads state S of the data logger to D.")
        .forms(W16)
        .takes(&[any("S"), dst("D", DATA).open_ended(), any("n")]),
];
