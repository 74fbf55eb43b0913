//! Serial ports of an image in C.

use super::{Image, switch};
use crate::board::{Serial, Uart};
use crate::template;
use std::fmt::Write;

/// Offsets of the registers of a USART with status and data registers, and the bit that switches it on.
const STM32_REGISTERS: &str = "STATE = 0x00, IN = 0x04, OUT = 0x04, RATE = 0x08, CONTROL_1 = 0x0C, CONTROL_2 = 0x10, ENABLE = 13";

/// The same of a newer one.
const STM32F7_REGISTERS: &str = "CONTROL_1 = 0x00, CONTROL_2 = 0x04, RATE = 0x0C, STATE = 0x1C, CLEAR = 0x20, IN = 0x24, OUT = 0x28, ENABLE = 0";

/// Code that clears faults where reading the data does not.
const CLEAR: &str = "    REGISTER(u->at + CLEAR) = 0xFu; /* PE, FE, NF, ORE */\n";

/// The memory of both directions is one, and what has come is to be noted again.
const LISTEN: &str = "        q->received.first = 0;
        q->received.end = 0;
        q->received.lost = false;
";

/// Code in the tick where no interrupt signals that the last bit is out.
const TICKS: &str = "\
static void tick_lines(void)
{
    for (size_t i = 0; i < sizeof uarts / sizeof uarts[0]; i++) {
        if (uarts[i].waiting->sends) {
            pump(&uarts[i]);
        }
    }
}

";

/// Returns true if the tick has to check whether the last bit is out.
fn waits_in_tick(image: &Image) -> bool {
    let mut ports = image.serial().into_iter();
    ports.any(|serial| serial.uart == Uart::Pl011)
}

/// The call in the tick that does, and what declares it.
pub(super) fn in_tick(image: &Image) -> (&'static str, &'static str) {
    match waits_in_tick(image) {
        true => ("    tick_lines();\n", "static void tick_lines(void);\n\n"),
        false => ("", ""),
    }
}

/// Fields of `rungc_hal` that serial ports fill.
pub(super) const FIELDS: [&str; 4] = ["set_line", "receive", "send", "unsent"];

/// The name of the handler of a port's interrupts.
fn handler(serial: &Serial) -> String {
    format!("com{}_handler", serial.port)
}

/// Interrupts and their handlers.
pub(super) fn handlers(image: &Image) -> Vec<(u32, String)> {
    let ports = image.serial().into_iter();
    ports
        .flat_map(|serial| {
            let numbers = serial.interrupts.iter();
            numbers.map(move |number| (*number, handler(serial)))
        })
        .collect()
}

/// The size of queues of received characters, which the board's header takes.
pub(super) fn sizes(image: &Image) -> String {
    let ports = image.serial();
    match ports.iter().map(|serial| serial.receive).max() {
        Some(room) => format!("#define RUNGC_CHARACTERS {room}u\n"),
        None => String::new(),
    }
}

/// Drivers of the UARTs; empty if the program has no port that the board has.
pub(super) fn drivers(image: &Image) -> String {
    let ports = image.serial();
    let Some(first) = ports.first() else {
        return String::new();
    };
    let stm32 = |kind: &str, registers: &str, clear: &str| {
        template!("uart_stm32.c")
            .replace("/* KIND */", kind)
            .replace("/* REGISTERS */", registers)
            .replace("/* CLEAR */", clear)
    };
    let uart = match first.uart {
        Uart::Stm32 => stm32("STM32F1, F2, F4 and L1", STM32_REGISTERS, ""),
        Uart::Stm32f7 => stm32("STM32F7 and similar", STM32F7_REGISTERS, CLEAR),
        Uart::Pl011 => template!("uart_pl011.c").to_string(),
        Uart::Cmsdk => template!("uart_cmsdk.c").to_string(),
    };
    // A function of the board's own has the finest resolution.
    let time = match image.board.functions.get("now_us") {
        Some(own) => format!("static uint32_t fine_us(void)\n{{\n    return {own}(NULL);\n}}\n\n"),
        None => template!("fine_us.c").to_string(),
    };
    let room = ports.iter().map(|serial| serial.send).max();
    let text = template!("serial.c")
        .replace("/* TIME */", &time)
        .replace("/* UART */", &uart)
        .replace("/* TABLE */", &table(&ports));
    let text = match image.takes_turns() {
        true => text
            .replace(
                "/* HOW */",
                ", in one memory: no protocol of these ports listens while it sends",
            )
            .replace("/* SHARE */", "union")
            .replace("/* LISTEN */", LISTEN)
            .replace("/* LISTENS */", "return !q->sends;"),
        false => text
            .replace("/* HOW */", "")
            .replace("/* SHARE */", "struct")
            .replace("/* LISTEN */", "")
            .replace("/* LISTENS */", "(void)q;\n    return true;"),
    };
    let ticks = if waits_in_tick(image) { TICKS } else { "" };
    format!(
        "/* Capacity of the send queue, plus one. */\n#define SEND {}u\n\n{text}{ticks}",
        room.unwrap_or(first.send)
    )
}

/// The ports, what switches their drivers, and their interrupts.
fn table(ports: &[&Serial]) -> String {
    let mut text = String::new();
    let mut rows = String::new();
    let mut handlers = String::new();
    for (i, serial) in ports.iter().enumerate() {
        let port = serial.port;
        let drive = match &serial.driver {
            Some(pin) => {
                let _ = write!(
                    text,
                    "static void drive_com{port}(bool on)\n{{\n{}}}\n\n",
                    switch(pin, "    ")
                );
                format!("drive_com{port}")
            }
            None => "NULL".to_string(),
        };
        let _ = writeln!(
            rows,
            "    {{.port = {port}, .at = 0x{:08X}u, .clock_hz = {}u, .drive = {drive}, .waiting = &waiting[{i}]}},",
            serial.at, serial.clock_hz
        );
        let handler = handler(serial);
        let _ = write!(
            handlers,
            "void {handler}(void);\n\nvoid {handler}(void)\n{{\n    serve(&uarts[{i}]);\n}}\n\n"
        );
    }
    let count = ports.len();
    format!(
        "{text}static queues waiting[{count}];\n\nstatic const uart uarts[{count}] = {{\n{rows}}};\n\n{handlers}"
    )
}

/// Code that enables the interrupts of the UARTs.
pub(super) fn enable(image: &Image) -> String {
    let mut text = String::new();
    for (number, handler) in handlers(image) {
        let _ = writeln!(
            text,
            "    REGISTER(0x{:08X}u) = 1u << {}; /* NVIC_ISER: {handler} */",
            0xE000_E100 + number / 32 * 4,
            number % 32
        );
    }
    text
}
