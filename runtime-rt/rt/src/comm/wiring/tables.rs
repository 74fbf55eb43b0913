//! The special devices of the ports of each family of models.

use super::{
    Choice, Envelope, ErrorPlace, ModbusWiring, PROGRAMMING_PORT_CODES, PROGRAMMING_PORT_ERROR,
    PortWiring, Rules, SERIAL_CODES, SERIAL_ERROR,
};
use crate::comm::can::CAN_PORT;
use crate::special::{Register, Relay};

/// A port without registers.
const fn bare(number: u8, choice: Choice) -> PortWiring {
    PortWiring {
        number,
        choice,
        rules: Rules::of(choice),
        format: None,
        station: None,
        protocol: None,
        left: None,
        received: None,
        start: None,
        end: None,
        time_out: None,
        time_out_unit_us: 10_000,
        uinit: None,
        waits: None,
        sends: None,
        done: None,
        receives: None,
        late: None,
        answered: None,
        gap: None,
        envelope: None,
        modbus: None,
        error: Some(SERIAL_ERROR),
        codes: SERIAL_CODES,
        modbus_errors: 0,
        one_pair: false,
        instead: None,
    }
}

/// A port with ten registers and relays from `base` on (h1u-h2u-programming §5.1, tables of D8110 to D8279).
const fn block(number: u8, choice: Choice, base: u16) -> PortWiring {
    PortWiring {
        format: Some(Register(base)),
        station: Some(Register(base + 1)),
        protocol: Some(Register(base + 6)),
        left: Some(Register(base + 2)),
        received: Some(Register(base + 3)),
        start: Some(Register(base + 4)),
        end: Some(Register(base + 5)),
        time_out: Some(Register(base + 9)),
        waits: Some(Relay(base + 1)),
        sends: Some(Relay(base + 2)),
        done: Some(Relay(base + 3)),
        receives: Some(Relay(base + 4)),
        late: Some(Relay(base + 9)),
        modbus_errors: 6330 + 10 * number as u16,
        ..bare(number, choice)
    }
}

pub(super) const INOVANCE: [PortWiring; 5] = [
    block(0, Choice::Com0, 8110),
    block(1, Choice::Com1, 8120),
    block(2, Choice::Number, 8260),
    block(3, Choice::Number, 8270),
    PortWiring {
        error: None,
        ..bare(CAN_PORT, Choice::Can)
    },
];

/// l01s-programming §9: port 1 is the programming port, ports 2 and 3 are RS-485.
pub(super) const L01S: [PortWiring; 3] = [
    bare(1, Choice::ProgrammingPort),
    PortWiring {
        protocol: None,
        time_out_unit_us: 1000,
        modbus_errors: 0,
        one_pair: true,
        answered: Some(Relay(8128)),
        gap: Some(Register(8126)),
        ..block(2, Choice::L01sPort2, 8120)
    },
    PortWiring {
        format: Some(Register(8400)),
        protocol: Some(Register(8401)),
        left: Some(Register(8402)),
        received: Some(Register(8403)),
        station: Some(Register(8414)),
        time_out: Some(Register(8409)),
        time_out_unit_us: 1000,
        waits: Some(Relay(8401)),
        sends: Some(Relay(8402)),
        done: Some(Relay(8403)),
        receives: Some(Relay(8404)),
        late: Some(Relay(8409)),
        answered: Some(Relay(8408)),
        gap: Some(Register(8406)),
        // D8414 is the station number.
        envelope: Some(Envelope {
            received_sum: None,
            ..envelope(8400)
        }),
        one_pair: true,
        ..bare(3, Choice::L01sPort3)
    },
];

/// hm-motion-controller §6.2: COM0 is RS-232, COM1 RS-485.
pub(super) const HM: [PortWiring; 2] = [
    PortWiring {
        error: None,
        uinit: Some(Register(8120)),
        ..bare(0, Choice::Uinit)
    },
    PortWiring {
        error: None,
        uinit: Some(Register(8123)),
        one_pair: true,
        ..bare(1, Choice::Uinit)
    },
];

const fn fx(choice: Choice) -> [PortWiring; 2] {
    [
        bare(0, Choice::ProgrammingPort),
        PortWiring {
            protocol: None,
            modbus_errors: 0,
            ..block(1, choice, 8120)
        },
    ]
}

/// Registers of what RS2 puts around data, of a port with this format word (FX data communication manual, part F,
/// §8.2.5).
const fn envelope(format: u16) -> Envelope {
    Envelope {
        headers: Register(format + 10),
        terminators: Register(format + 12),
        received_sum: Some(Register(format + 14)),
        computed_sum: Register(format + 15),
        sent_sum: Register(format + 16),
    }
}

/// A channel of FX3 with the registers and relays of RS2 from `base` on (FX data communication manual, part F, §12.1).
const fn channel(number: u8, choice: Choice, base: u16) -> PortWiring {
    PortWiring {
        format: Some(Register(base)),
        left: Some(Register(base + 2)),
        received: Some(Register(base + 3)),
        time_out: Some(Register(base + 9)),
        waits: Some(Relay(base + 1)),
        sends: Some(Relay(base + 2)),
        done: Some(Relay(base + 3)),
        receives: Some(Relay(base + 4)),
        late: Some(Relay(base + 9)),
        envelope: Some(envelope(base)),
        ..bare(number, choice)
    }
}

/// A channel of FX3 that speaks Modbus, too (FX3U MODBUS manual §6).
const fn modbus_channel(number: u8, base: u16) -> PortWiring {
    PortWiring {
        protocol: Some(Register(base + 1)),
        station: Some(Register(base + 14)),
        modbus: Some(ModbusWiring(base)),
        ..channel(number, Choice::Channel, base)
    }
}

/// Channel 1 of FX3: the registers of RS2 and ADPRW instead of those of RS.
const CHANNEL_1: PortWiring = modbus_channel(1, 8400);
/// Channel 2, whose errors are in M8438 and D8438.
const CHANNEL_2: PortWiring = PortWiring {
    error: Some(ErrorPlace(Relay(8438))),
    codes: 3800,
    ..modbus_channel(2, 8420)
};

const fn fx3(programming_port: PortWiring, choice: Choice) -> [PortWiring; 3] {
    let [_, board] = fx(choice);
    [
        programming_port,
        PortWiring {
            instead: Some(&CHANNEL_1),
            ..board
        },
        CHANNEL_2,
    ]
}

pub(super) const FX: [PortWiring; 2] = fx(Choice::Format);
pub(super) const FX3: [PortWiring; 3] = fx3(bare(0, Choice::ProgrammingPort), Choice::Format);
/// RS2 takes the programming port over where D8370 has a format.
pub(super) const FX3G: [PortWiring; 3] = fx3(
    PortWiring {
        error: Some(PROGRAMMING_PORT_ERROR),
        codes: PROGRAMMING_PORT_CODES,
        ..channel(0, Choice::Channel0, 8370)
    },
    Choice::Format,
);
pub(super) const BOARD_2N: [PortWiring; 2] = fx(Choice::Board);
pub(super) const BOARD_3U: [PortWiring; 3] = fx3(bare(0, Choice::ProgrammingPort), Choice::Board);
