//! Arguments of `flash`.

use super::forms::serial_end;
use crate::output::OutputPath;
use clap::{ArgGroup, Args};
use rungc_project::serve::LineEnd;
use std::path::PathBuf;
use std::time::Duration;

/// Arguments of `flash`.
#[derive(Args, Debug)]
#[command(group(ArgGroup::new("way").required(true).args(["port", "probe", "volume"])))]
pub struct FlashArgs {
    /// Image to write: an ELF file of `rungc build --emit elf`, UF2 for `--volume`, or a raw binary.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// Serial port connected to the boot loader's UART (`/dev/ttyUSB0`, `COM3`), or a serial device server
    /// (`tcp:HOST:PORT`). The line has 8 data bits and even parity.
    #[arg(long, value_parser = serial_end, value_name = "PORT")]
    pub port: Option<LineEnd>,
    /// Use a debug probe for this part, through probe-rs, which must be installed: `STM32F103VC`.
    #[arg(long, value_name = "CHIP")]
    pub probe: Option<String>,
    /// Folder of the USB volume of an RP2040's boot ROM (Raspberry Pi Pico); `auto` searches for it.
    #[arg(long, value_name = "FOLDER")]
    pub volume: Option<PathBuf>,
    /// Bit rate; the boot loader measures it.
    #[arg(long, default_value_t = 115_200, value_parser = bit_rate, value_name = "BITS_PER_SECOND")]
    pub baud: u32,
    /// Time to wait for the boot loader while you set BOOT0 and reset the board, or for a volume to disappear.
    #[arg(long, default_value = "30s", value_parser = crate::time::parse_wait, value_name = "TIME")]
    timeout: u64,
    /// The same in seconds: its name in earlier versions.
    #[arg(long, hide = true, conflicts_with = "timeout", value_parser = clap::value_parser!(u64).range(1..=3600))]
    wait: Option<u64>,
    /// Address of the first byte, for files that are not ELF.
    #[arg(long, default_value = "0x08000000", value_parser = address, value_name = "ADDRESS")]
    pub at: u32,
    /// Save all of flash to a file before erasing. Not possible for a read-protected part.
    #[arg(long, value_name = "FILE", conflicts_with = "probe")]
    pub backup: Option<OutputPath>,
    /// Overwrite an existing backup.
    #[arg(long, requires = "backup")]
    pub force: bool,
    /// Remove read and write protection. Removing read protection erases all of flash permanently.
    #[arg(long)]
    pub unprotect: bool,
    /// Do not ask before erasing.
    #[arg(long)]
    pub yes: bool,
    /// Start the program afterwards. Its outputs switch immediately.
    #[arg(long)]
    pub start: bool,
}

impl FlashArgs {
    /// Time to wait for the boot loader, or for a volume to disappear.
    pub fn wait(&self) -> Duration {
        let given = self.wait.map(Duration::from_secs);
        given.unwrap_or(Duration::from_millis(self.timeout))
    }
}

/// A bit rate that boot loaders can measure.
fn bit_rate(text: &str) -> Result<u32, String> {
    let rate = text
        .parse()
        .ok()
        .filter(|rate| (1200..=230_400).contains(rate));
    rate.ok_or_else(|| "a bit rate is from 1200 to 230400".to_string())
}

/// A number as the maps of memory write it.
fn address(text: &str) -> Result<u32, String> {
    let digits = text.strip_prefix("0x").unwrap_or(text);
    let number = u32::from_str_radix(&digits.replace('_', ""), 16);
    number.map_err(|_| "an address is written in hexadecimal: 0x08000000".to_string())
}
