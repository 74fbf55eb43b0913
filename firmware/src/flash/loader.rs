//! The asking end of the boot loader's protocol on a serial line: AN3155, "USART protocol used in the STM32
//! bootloader".

use std::io;
use std::time::{Duration, Instant};

const ACK: u8 = 0x79;
const NACK: u8 = 0x1F;

/// Byte with which a boot loader measures the bit rate.
const SYNC: u8 = 0x7F;

/// A byte that is not part of any valid command, address or list of pages, however often it is sent.
const FILLER: u8 = 0xFF;

/// Bytes that one command reads or writes.
pub const BLOCK: usize = 256;

/// Time-out of the boot loader's answer; the line takes a block in 0.3 s at 9600 bit/s.
const ANSWER: Duration = Duration::from_millis(1500);

/// Time-out of erasing a sector, or the whole part (the data sheets have up to 4 s for 128 KiB, 32 s for a whole
/// STM32F4).
const ERASING: Duration = Duration::from_secs(40);

/// Time-out of a reset.
const RESET: Duration = Duration::from_secs(5);

/// Time without characters after which the line is silent.
const SILENCE: Duration = Duration::from_millis(200);

/// Number of attempts for a command that was not understood, or whose answer is missing.
const ATTEMPTS: usize = 4;

/// A line to a boot loader.
pub trait Line {
    /// Called before each command: where the work can end.
    ///
    /// # Errors
    /// The user wants to end.
    fn may_continue(&mut self) -> io::Result<()>;

    /// Sends all of the bytes.
    ///
    /// # Errors
    /// What the system says of the line.
    fn send(&mut self, bytes: &[u8]) -> io::Result<()>;

    /// Receives what has come, at most what fits, waiting a fraction of a second; 0 if nothing has.
    ///
    /// # Errors
    /// As [`Line::send`].
    fn receive(&mut self, buffer: &mut [u8]) -> io::Result<usize>;

    /// The time on the clock that limits how long answers are waited for.
    fn now(&self) -> Instant {
        Instant::now()
    }

    /// Time-out of an answer that usually comes within this time.
    fn patience(&self, usual: Duration) -> Duration {
        usual
    }
}

/// The commands, by their codes (AN3155, table "USART bootloader commands").
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// The version and the commands that this boot loader knows.
    Get = 0x00,
    /// The product number.
    GetId = 0x02,
    /// Reads memory.
    ReadMemory = 0x11,
    /// Starts a program.
    Go = 0x21,
    /// Writes memory.
    WriteMemory = 0x31,
    /// Erases pages, by numbers of one byte.
    Erase = 0x43,
    /// Erases pages, by numbers of two bytes.
    ExtendedErase = 0x44,
    /// Lifts the write protection of all pages, and resets.
    WriteUnprotect = 0x73,
    /// Lifts the read protection, which erases all of flash, and resets.
    ReadoutUnprotect = 0x92,
}

impl std::fmt::Display for Command {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.write_str(match self {
            Command::Get => "Get",
            Command::GetId => "Get ID",
            Command::ReadMemory => "Read Memory",
            Command::Go => "Go",
            Command::WriteMemory => "Write Memory",
            Command::Erase => "Erase Memory",
            Command::ExtendedErase => "Extended Erase Memory",
            Command::WriteUnprotect => "Write Unprotect",
            Command::ReadoutUnprotect => "Readout Unprotect",
        })
    }
}

/// Error in the communication with a boot loader.
#[derive(Debug, thiserror::Error)]
pub enum LoaderError {
    /// The line has failed, or the user has interrupted.
    #[error("{0}")]
    Line(#[from] io::Error),
    /// Nothing answers at all.
    #[error("no boot loader answers")]
    Silent,
    /// A command is not answered.
    #[error("no answer to {0}")]
    Unanswered(Command),
    /// A command is not carried out.
    #[error("the boot loader rejects {0}")]
    Rejected(Command),
    /// An answer that the protocol does not have.
    #[error("an answer to {0} that is not one: what is there is not the boot loader of an STM32")]
    Odd(Command),
    /// A block was damaged on its way, and flash holds neither it nor nothing.
    #[error("flash at 0x{0:08X} holds something else after a disturbance on the line")]
    Spoilt(u32),
}

type Answer<T> = Result<T, LoaderError>;

/// A boot loader that has answered.
pub struct Loader<L> {
    line: L,
    /// Its version, as two digits: 0x22 is 2.2.
    pub version: u8,
    commands: Vec<u8>,
}

impl<L: Line> Loader<L> {
    /// Makes the boot loader measure the bit rate, for at most `patience`, and asks what it can do.
    ///
    /// # Errors
    /// Nothing answers, or something that is not a boot loader.
    pub fn connect(line: L, patience: Duration) -> Answer<Self> {
        let mut loader = Loader {
            line,
            version: 0,
            commands: Vec::new(),
        };
        loader.synchronise(patience)?;
        let get = Command::Get;
        let answer = loader.again(|loader| loader.query(get))?;
        let Some((version, commands)) = answer.split_first() else {
            return Err(LoaderError::Odd(get));
        };
        loader.version = *version;
        loader.commands = commands.to_vec();
        Ok(loader)
    }

    /// The product number.
    ///
    /// # Errors
    /// As all commands.
    pub fn id(&mut self) -> Answer<u16> {
        let answer = self.again(|loader| loader.query(Command::GetId))?;
        match answer.as_slice() {
            [high, low] => Ok(u16::from_be_bytes([*high, *low])),
            _ => Err(LoaderError::Odd(Command::GetId)),
        }
    }

    /// Returns true if memory can be read; a part that is read protected rejects it.
    ///
    /// # Errors
    ///
    /// The line has failed.
    pub fn is_readable(&mut self) -> Answer<bool> {
        match self.read(super::chips::FLASH, 4) {
            Ok(_) => Ok(true),
            Err(LoaderError::Rejected(_)) => Ok(false),
            Err(error) => Err(error),
        }
    }

    /// Reads up to [`BLOCK`] bytes.
    ///
    /// # Errors
    /// The part is read protected, or has nothing at the address.
    pub fn read(&mut self, at: u32, count: usize) -> Answer<Vec<u8>> {
        const COMMAND: Command = Command::ReadMemory;
        let last = count.clamp(1, BLOCK) - 1;
        self.again(|loader| {
            loader.command(COMMAND, ANSWER)?;
            loader.address(COMMAND, at)?;
            loader.line.send(&[last as u8, !(last as u8)])?;
            loader.acknowledged(COMMAND, ANSWER)?;
            let mut bytes = vec![0; last + 1];
            loader.exactly(COMMAND, &mut bytes, ANSWER)?;
            Ok(bytes)
        })
    }

    /// Writes up to [`BLOCK`] bytes of erased flash. If the answer is missing, reads back whether they are there.
    ///
    /// # Errors
    /// The boot loader rejects it, or the block was damaged on its way.
    pub fn write(&mut self, at: u32, bytes: &[u8]) -> Answer<()> {
        let mut block = bytes.to_vec();
        block.resize(bytes.len().next_multiple_of(4), super::ERASED);
        for attempt in 1.. {
            let Err(error) = self.write_once(at, &block) else {
                break;
            };
            if matches!(error, LoaderError::Line(_)) || attempt == ATTEMPTS {
                return Err(error);
            }
            self.resynchronise()?;
            let found = self.read(at, block.len())?;
            if found == block {
                break;
            }
            if found.iter().any(|byte| *byte != super::ERASED) {
                return Err(LoaderError::Spoilt(at));
            }
        }
        Ok(())
    }

    fn write_once(&mut self, at: u32, block: &[u8]) -> Answer<()> {
        const COMMAND: Command = Command::WriteMemory;
        self.command(COMMAND, ANSWER)?;
        self.address(COMMAND, at)?;
        self.list(COMMAND, &[(block.len() - 1) as u8], block, ANSWER)
    }

    /// Erases a page.
    ///
    /// # Errors
    /// The page is write protected.
    pub fn erase(&mut self, page: u32) -> Answer<()> {
        match u8::try_from(page) {
            Ok(page) if self.commands.contains(&(Command::Erase as u8)) => self.again(|loader| {
                loader.command(Command::Erase, ANSWER)?;
                loader.list(Command::Erase, &[0], &[page], ERASING)
            }),
            _ => self.again(|loader| {
                loader.command(Command::ExtendedErase, ANSWER)?;
                let [_, _, page @ ..] = page.to_be_bytes();
                loader.list(Command::ExtendedErase, &[0, 0], &page, ERASING)
            }),
        }
    }

    /// Lifts the read protection, which erases all of flash; the part resets.
    ///
    /// # Errors
    /// As all commands.
    pub fn unprotect(&mut self) -> Answer<()> {
        self.lift(Command::ReadoutUnprotect)
    }

    /// Lifts the write protection of all pages; the part resets.
    ///
    /// # Errors
    /// As all commands.
    pub fn unprotect_pages(&mut self) -> Answer<()> {
        self.lift(Command::WriteUnprotect)
    }

    fn lift(&mut self, command: Command) -> Answer<()> {
        self.again(|loader| loader.command(command, ANSWER))?;
        self.acknowledged(command, ERASING)?;
        self.synchronise(RESET)
    }

    /// Starts the program whose vectors are at an address.
    ///
    /// # Errors
    /// As all commands.
    pub fn start(&mut self, at: u32) -> Answer<()> {
        self.again(|loader| {
            loader.command(Command::Go, ANSWER)?;
            loader.address(Command::Go, at)
        })
    }

    /// Does something again when it was not understood, or the answer is missing.
    fn again<T>(&mut self, mut ask: impl FnMut(&mut Self) -> Answer<T>) -> Answer<T> {
        let mut attempt = 1;
        let mut is_rejected = false;
        loop {
            match ask(self) {
                Err(LoaderError::Line(error)) => return Err(error.into()),
                // A command that is rejected twice was understood.
                Err(LoaderError::Rejected(command)) if is_rejected => {
                    return Err(LoaderError::Rejected(command));
                }
                Err(error) if attempt < ATTEMPTS => {
                    is_rejected |= matches!(error, LoaderError::Rejected(_));
                    self.resynchronise()?;
                    attempt += 1;
                }
                answer => return answer,
            }
        }
    }

    /// Sends a command; AN3155 §3: its code and the complement.
    fn command(&mut self, command: Command, patience: Duration) -> Answer<()> {
        let code = command as u8;
        self.line.may_continue()?;
        self.line.send(&[code, !code])?;
        self.acknowledged(command, patience)
    }

    /// Sends an address with its checksum.
    fn address(&mut self, command: Command, at: u32) -> Answer<()> {
        self.list(command, &[], &at.to_be_bytes(), ANSWER)
    }

    /// Sends bytes with the exclusive or of all of them.
    fn list(
        &mut self,
        command: Command,
        count: &[u8],
        bytes: &[u8],
        patience: Duration,
    ) -> Answer<()> {
        let mut message = [count, bytes].concat();
        message.push(message.iter().fold(0, |sum, byte| sum ^ byte));
        self.line.send(&message)?;
        self.acknowledged(command, patience)
    }

    /// A command whose answer says how long it is.
    fn query(&mut self, command: Command) -> Answer<Vec<u8>> {
        self.command(command, ANSWER)?;
        let mut last = [0];
        self.exactly(command, &mut last, ANSWER)?;
        let mut bytes = vec![0; usize::from(last[0]) + 1];
        self.exactly(command, &mut bytes, ANSWER)?;
        self.acknowledged(command, ANSWER)?;
        Ok(bytes)
    }

    fn acknowledged(&mut self, command: Command, patience: Duration) -> Answer<()> {
        let mut answer = [0];
        self.exactly(command, &mut answer, patience)?;
        match answer[0] {
            ACK => Ok(()),
            NACK => Err(LoaderError::Rejected(command)),
            _ => Err(LoaderError::Odd(command)),
        }
    }

    fn exactly(&mut self, command: Command, bytes: &mut [u8], patience: Duration) -> Answer<()> {
        let mut filled = 0;
        let deadline = self.line.now() + self.line.patience(patience);
        while filled < bytes.len() {
            filled += self.line.receive(&mut bytes[filled..])?;
            if filled < bytes.len() && self.line.now() > deadline {
                return Err(LoaderError::Unanswered(command));
            }
        }
        Ok(())
    }

    /// Lets the boot loader measure the bit rate after a reset; one that has measured it answers NACK.
    fn synchronise(&mut self, patience: Duration) -> Answer<()> {
        let deadline = self.line.now() + patience;
        while self.line.now() < deadline {
            self.line.may_continue()?;
            self.line.send(&[SYNC])?;
            let wait = self.line.now() + ANSWER / 3;
            while self.line.now() < wait {
                let mut byte = [0];
                if self.line.receive(&mut byte)? == 1 && matches!(byte[0], ACK | NACK) {
                    return self.silence();
                }
            }
        }
        Err(LoaderError::Silent)
    }

    /// Brings the boot loader back to where it waits for a command, whatever it was waiting for. It answers NACK when
    /// it has taken all of what is not a command.
    fn resynchronise(&mut self) -> Answer<()> {
        self.silence()?;
        self.line.send(&[FILLER; BLOCK + 2])?;
        self.silence()?;
        for _ in 0..4 {
            self.line.send(&[FILLER])?;
            let wait = self.line.now() + SILENCE;
            while self.line.now() < wait {
                let mut byte = [0];
                if self.line.receive(&mut byte)? == 1 && byte[0] == NACK {
                    return Ok(());
                }
            }
        }
        Err(LoaderError::Silent)
    }

    /// Reads away what comes until nothing does.
    fn silence(&mut self) -> Answer<()> {
        let mut quiet_since = self.line.now();
        let deadline = quiet_since + RESET;
        while self.line.now() < (quiet_since + SILENCE).min(deadline) {
            let mut bytes = [0; BLOCK];
            if self.line.receive(&mut bytes)? > 0 {
                quiet_since = self.line.now();
            }
        }
        Ok(())
    }
}
