//! The serial ports of a board: `[[serial]]`.

use super::pins::{Mode, Output};
use super::{BoardError, OutputPin, Reader};
use serde::Deserialize;

/// Characters that a queue holds by default.
const DEFAULT_RECEIVE: u16 = 64;

/// Characters that wait to be sent by default: no frame of Modbus RTU is longer.
const DEFAULT_SEND: u16 = 256;

/// Maximum number of interrupts that a core has.
const INTERRUPTS: u32 = 480;

/// A serial port of the PLC, and the UART that it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Serial {
    /// Its number in the manual of the PLC: 1 is COM1.
    pub port: u8,
    /// The UART's registers.
    pub uart: Uart,
    /// The address of the first of them.
    pub at: u32,
    /// The numbers of its interrupts.
    pub interrupts: Vec<u32>,
    /// The clock that its bit rate is divided from, in Hz.
    pub clock_hz: u32,
    /// The pin that switches the driver of an RS-485 line on.
    pub driver: Option<OutputPin>,
    /// It works even if the program neither uses it nor sets it up: a programming port.
    pub always: bool,
    /// A slave by Modbus RTU also answers QLink (H1U, H2U), which takes memory.
    pub qlink: bool,
    /// Size of the receive queue, in characters.
    pub receive: u16,
    /// Size of the send queue, in characters.
    pub send: u16,
}

/// Kinds of UARTs, by their registers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Uart {
    /// USART of STM32F1, F2, F4 and L1: status and data registers.
    Stm32,
    /// USART of STM32F0, F3, F7, G0, G4, H7, L0, L4 and later: separate registers for what is received and sent.
    Stm32f7,
    /// Arm's PL011, which RP2040 has.
    Pl011,
    /// Arm's CMSDK APB UART (MPS2 boards): 8 data bits, no parity, 1 stop bit.
    Cmsdk,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Format {
    port: toml::Spanned<String>,
    uart: toml::Spanned<Uart>,
    at: u32,
    interrupts: toml::Spanned<Vec<u32>>,
    hz: Option<u32>,
    de: Option<toml::Spanned<Output>>,
    tx: Option<toml::Spanned<String>>,
    rx: Option<toml::Spanned<String>>,
    #[serde(default)]
    function: u32,
    uncertain: Option<String>,
    #[serde(default)]
    always: bool,
    #[serde(default)]
    qlink: bool,
    #[serde(default = "default_receive")]
    receive: toml::Spanned<u16>,
    #[serde(default = "default_send")]
    send: toml::Spanned<u16>,
}

fn default_receive() -> toml::Spanned<u16> {
    toml::Spanned::new(0..0, DEFAULT_RECEIVE)
}

fn default_send() -> toml::Spanned<u16> {
    toml::Spanned::new(0..0, DEFAULT_SEND)
}

impl Reader<'_> {
    /// Serial ports, each of which occurs once, on UARTs of one kind. `clock_hz` is the core's clock.
    pub(super) fn serial(
        &self,
        formats: Vec<Format>,
        clock_hz: u32,
    ) -> Result<Vec<Serial>, BoardError> {
        let mut known: Vec<Serial> = Vec::new();
        for format in formats {
            let place = format.port.clone();
            let uart = format.uart.clone();
            let interrupts = format.interrupts.clone();
            let serial = self.serial_port(format, clock_hz)?;
            if known.iter().any(|other| other.port == serial.port) {
                return Err(self.at(&place, format!("COM{} is listed twice", serial.port)));
            }
            if known.iter().any(|other| other.uart != serial.uart) {
                let what = "the UARTs of a board are of one kind".to_string();
                return Err(self.at(&uart, what));
            }
            let taken = |number: &&u32| known.iter().any(|other| other.interrupts.contains(number));
            if let Some(number) = serial.interrupts.iter().find(taken) {
                let what = format!("interrupt {number} belongs to another port");
                return Err(self.at(&interrupts, what));
            }
            known.push(serial);
        }
        Ok(known)
    }

    fn serial_port(&self, format: Format, clock_hz: u32) -> Result<Serial, BoardError> {
        let name = format.port.get_ref();
        let number = name.strip_prefix("COM").and_then(|n| n.parse().ok());
        let port = number.ok_or_else(|| {
            let what = format!("`{name}` is not a serial port: write for example COM1");
            self.at(&format.port, what)
        })?;
        let interrupts = format.interrupts.get_ref();
        if interrupts.is_empty() || interrupts.iter().any(|number| *number >= INTERRUPTS) {
            let what = "name at least one interrupt of the UART, from 0 to 479".to_string();
            return Err(self.at(&format.interrupts, what));
        }
        for count in [&format.receive, &format.send] {
            if !(2..=4096).contains(count.get_ref()) {
                let what = "a queue has room for 2 to 4096 characters".to_string();
                return Err(self.at(count, what));
            }
        }
        let uart = *format.uart.get_ref();
        let pins = [
            (&format.tx, "TX", Mode::Sends(format.function)),
            (&format.rx, "RX", Mode::Receives(format.function)),
        ];
        for (pin, what, mode) in pins {
            if let Some(pin) = pin {
                let (place, uncertain) = (pin.span().start, format.uncertain.clone());
                self.connect(
                    place,
                    &format!("{name} {what}"),
                    pin.get_ref(),
                    mode,
                    uncertain,
                )?;
            }
        }
        let driver = match format.de {
            Some(pin) if uart == Uart::Cmsdk => {
                let what = "a CMSDK UART does not say when the last bit is out, so nothing can switch the driver off";
                return Err(self.at(&pin, what.to_string()));
            }
            Some(pin) => {
                let what = format!("{name} DE");
                Some(self.output(pin.span().start, &what, pin.get_ref())?)
            }
            None => None,
        };
        Ok(Serial {
            port,
            uart,
            at: format.at,
            interrupts: format.interrupts.into_inner(),
            clock_hz: format.hz.unwrap_or(clock_hz),
            driver,
            always: format.always,
            qlink: format.qlink,
            receive: format.receive.into_inner(),
            send: format.send.into_inner(),
        })
    }
}
