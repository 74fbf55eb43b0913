//! Serial ports of an image in Rust.

use super::{Image, switch};
use crate::board::{Serial, Uart};
use crate::template;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Offsets of the registers of a USART with status and data registers, and the bit that switches it on.
const STM32_REGISTERS: &str = "\
const STATE: usize = 0x00;
const IN: usize = 0x04;
const OUT: usize = 0x04;
const RATE: usize = 0x08;
const CONTROL_1: usize = 0x0C;
const CONTROL_2: usize = 0x10;
const ENABLE: u32 = 13;
";

/// The same of a newer one.
const STM32F7_REGISTERS: &str = "\
const CONTROL_1: usize = 0x00;
const CONTROL_2: usize = 0x04;
const RATE: usize = 0x0C;
const STATE: usize = 0x1C;
const CLEAR: usize = 0x20;
const IN: usize = 0x24;
const OUT: usize = 0x28;
const ENABLE: u32 = 0;
";

/// Code that clears faults where reading the data does not.
const CLEAR: &str = "        write(self.at + CLEAR, 0xF); // PE, FE, NF, ORE\n";

/// The type of what waits in both directions: one memory where the ports take turns.
fn queue(image: &Image) -> &'static str {
    match image.takes_turns() {
        true => "TurnQueue",
        false => "BothQueues",
    }
}

/// Additional imports of the main file.
pub(super) fn uses(image: &Image) -> String {
    format!(
        "use core::sync::atomic::AtomicU8;
use rungc_rt::SerialPort;
use rungc_rt::board::{};
use rungc_rt::comm::{{CharFault, LineFormat, Received}};
",
        queue(image)
    )
}

/// Method by which instructions and partners access the ports.
pub(super) const SERIAL_PORT: &str = "
    fn serial_port(&mut self, number: u8) -> Option<&mut dyn SerialPort> {
        self.line = UARTS.iter().find(|uart| uart.port == number);
        self.line.as_mut().map(|line| line as &mut dyn SerialPort)
    }
";

/// Offset of the handler of interrupt 0 among the vectors.
const DEVICE_VECTORS: u32 = 16;

/// The name of the handler of a port's interrupts.
fn handler(serial: &Serial) -> String {
    format!("com{}_handler", serial.port)
}

/// The vectors of the devices' interrupts.
pub(super) fn vectors(image: &Image) -> String {
    let ports = image.serial().into_iter();
    let handlers: BTreeMap<_, _> = ports
        .flat_map(|serial| {
            let numbers = serial.interrupts.iter();
            numbers.map(move |number| (*number, handler(serial)))
        })
        .collect();
    let mut text = String::new();
    let mut next = 0;
    for (number, handler) in handlers {
        if number > next {
            let _ = writeln!(text, ".rept {}\n    .word spin\n.endr", number - next);
        }
        let _ = writeln!(text, "    .word {handler:<20}@ {}", DEVICE_VECTORS + number);
        next = number + 1;
    }
    text
}

/// Drivers of the UARTs; empty if the program has no port that the board has.
pub(super) fn drivers(image: &Image) -> String {
    let ports = image.serial();
    let Some(first) = ports.first() else {
        return String::new();
    };
    let stm32 = |kind: &str, registers: &str, clear: &str| {
        template!("uart_stm32.rs")
            .replace("/* KIND */", kind)
            .replace("/* REGISTERS */", registers)
            .replace("/* CLEAR */", clear)
    };
    let uart = match first.uart {
        Uart::Stm32 => stm32("STM32F1, F2, F4 and L1", STM32_REGISTERS, ""),
        Uart::Stm32f7 => stm32("STM32F7 and similar", STM32F7_REGISTERS, CLEAR),
        Uart::Pl011 => template!("uart_pl011.rs").to_string(),
        Uart::Cmsdk => template!("uart_cmsdk.rs").to_string(),
    };
    let most = |room: fn(&Serial) -> u16| ports.iter().map(|serial| room(serial)).max();
    let [receive, send] = [most(|serial| serial.receive), most(|serial| serial.send)];
    let [receive, send] = [receive, send].map(Option::unwrap_or_default);
    let (how, room) = match image.takes_turns() {
        // A word holds one character that has come, or four to be sent.
        true => (
            ", in one memory: no protocol of these ports listens while it sends",
            receive.max(send.div_ceil(4)).to_string(),
        ),
        false => ("", format!("{receive}, {send}")),
    };
    template!("serial.rs")
        .replace("/* HOW */", how)
        .replace("/* QUEUE */", &format!("{}<{room}>", queue(image)))
        .replace("/* UART */", &uart)
        .replace("/* TABLE */", &table(&ports))
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
                    "fn drive_com{port}(on: bool) {{\n    {}\n}}\n\n",
                    switch(pin)
                );
                format!("drive_com{port}")
            }
            None => "|_| {}".to_string(),
        };
        let _ = writeln!(
            rows,
            "    Uart {{ port: {port}, at: 0x{:08X}, clock_hz: {}, drive: {drive}, line: &LINES[{i}] }},",
            serial.at, serial.clock_hz
        );
        let _ = write!(
            handlers,
            "#[unsafe(no_mangle)]\nextern \"C\" fn {}() {{\n    UARTS[{i}].serve();\n}}\n\n",
            handler(serial)
        );
    }
    format!(
        "{text}static LINES: [Line; {count}] = [Line::EMPTY; {count}];\n\nstatic UARTS: [Uart; {count}] = [\n{rows}];\n\n{handlers}",
        count = ports.len()
    )
}

/// Code in the tick where no interrupt signals that the last bit is out.
pub(super) fn in_tick(image: &Image) -> &'static str {
    let mut ports = image.serial().into_iter();
    match ports.any(|serial| serial.uart == Uart::Pl011) {
        true => "    UARTS.iter().for_each(Uart::pump);\n",
        false => "",
    }
}

/// Code that enables the interrupts of the UARTs.
pub(super) fn enable(image: &Image) -> String {
    let mut text = String::new();
    for serial in image.serial() {
        for number in &serial.interrupts {
            let _ = writeln!(
                text,
                "    write(0x{:08X}, 1 << {}); // NVIC_ISER: {}",
                0xE000_E100 + number / 32 * 4,
                number % 32,
                handler(serial)
            );
        }
    }
    text
}
