//! Images are written over a disturbed line. Its time is not that of the machine: it passes when the part has taken all
//! that was sent and answers nothing.

mod part;

use part::{BootLoader, Fault, Over, Part, Wire};
use rungc_firmware::flash::loader::{Line, Loader, LoaderError};
use rungc_firmware::flash::{FlashError, Payload, Writer, chips};
use std::collections::VecDeque;
use std::io::{self, ErrorKind};
use std::sync::{Arc, Condvar, Mutex};
use std::thread;
use std::time::{Duration, Instant};

/// Bytes on the line.
#[derive(Default)]
struct State {
    to_part: VecDeque<u8>,
    to_host: VecDeque<u8>,
    /// The part waits for a byte.
    is_idle: bool,
    is_over: bool,
}

/// A line between two threads.
#[derive(Default)]
struct Cable {
    state: Mutex<State>,
    changed: Condvar,
}

impl Cable {
    /// Changes what is on the line.
    fn change(&self, change: impl FnOnce(&mut State)) {
        change(&mut self.state.lock().unwrap());
        self.changed.notify_all();
    }
}

/// The host's end.
struct Host {
    cable: Arc<Cable>,
    now: Instant,
}

impl Line for &mut Host {
    fn may_continue(&mut self) -> io::Result<()> {
        Ok(())
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.cable.change(|state| {
            state.to_part.extend(bytes);
            state.is_idle = false;
        });
        Ok(())
    }

    fn receive(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let state = self.cable.state.lock().unwrap();
        let waits =
            |state: &mut State| state.to_host.is_empty() && !state.is_idle && !state.is_over;
        let mut state = self.cable.changed.wait_while(state, waits).unwrap();
        let count = state.to_host.len().min(buffer.len());
        for (place, byte) in buffer.iter_mut().zip(state.to_host.drain(..count)) {
            *place = byte;
        }
        if count == 0 && state.is_over {
            return Err(ErrorKind::BrokenPipe.into());
        }
        if count == 0 {
            self.now += Duration::from_millis(100);
        }
        Ok(count)
    }

    fn now(&self) -> Instant {
        self.now
    }
}

impl Drop for Host {
    fn drop(&mut self) {
        self.cable.change(|state| state.is_over = true);
    }
}

/// The part's end.
struct End(Arc<Cable>);

impl Wire for End {
    fn byte(&mut self) -> Result<u8, Over> {
        let mut state = self.0.state.lock().unwrap();
        loop {
            if let Some(byte) = state.to_part.pop_front() {
                return Ok(byte);
            }
            if state.is_over {
                return Err(Over);
            }
            state.is_idle = true;
            self.0.changed.notify_all();
            state = self.0.changed.wait(state).unwrap();
        }
    }

    fn answer(&mut self, bytes: &[u8]) -> Result<(), Over> {
        self.0.change(|state| state.to_host.extend(bytes));
        Ok(())
    }
}

impl Drop for End {
    fn drop(&mut self) {
        self.0.change(|state| state.is_over = true);
    }
}

/// An image that takes more than two pages and ends within a block.
fn image() -> Payload {
    let bytes: Vec<u8> = (0..5002).map(|at| (at * 7 % 253) as u8).collect();
    Payload::read(&bytes, chips::FLASH).unwrap()
}

/// Writes the image; how that ends, the part after it, and how long it takes on the line.
fn flashed(part: Part) -> (Result<(), FlashError>, Part, Duration) {
    let cable = Arc::new(Cable::default());
    let part = Arc::new(Mutex::new(part));
    let loader = BootLoader {
        wire: End(Arc::clone(&cable)),
        part: Arc::clone(&part),
    };
    let ended = thread::spawn(move || loader.run());
    let begin = Instant::now();
    let mut host = Host { cable, now: begin };
    let result = write(&mut host);
    let taken = host.now - begin;
    drop(host);
    ended.join().unwrap();
    let part = part.lock().unwrap().clone();
    (result, part, taken)
}

fn write(host: &mut Host) -> Result<(), FlashError> {
    let mut loader = Loader::connect(host, Duration::from_secs(5))?;
    let chip = chips::find(loader.id()?).unwrap();
    let payload = image();
    let mut plan = Writer::<&mut Host>::fit(chip, chip.flash, &payload)?;
    let mut writer = Writer {
        loader: &mut loader,
        chip,
        flash: chip.flash,
        progress: Box::new(|_, _, _| {}),
    };
    writer.compare(&mut plan, &payload)?;
    writer.write(&plan, &payload)
}

/// A part with this fault.
fn faulty(fault: Fault) -> Part {
    Part {
        faults: vec![fault],
        ..Part::f103vc()
    }
}

#[test]
fn disturbances_are_overcome() {
    for fault in [
        Fault::RejectWrite(3),
        Fault::LoseByte(2),
        Fault::LoseAnswer(4),
        Fault::RejectErase(1),
    ] {
        let (result, part, taken) = flashed(faulty(fault));
        assert!(result.is_ok(), "{fault:?}: {result:?}");
        assert_eq!(part.flash[..5002], image().bytes, "{fault:?}");
        // An answer is waited for 1.5 s; after that, and after what is rejected, the line is silent for a while.
        let waits = matches!(fault, Fault::LoseByte(_) | Fault::LoseAnswer(_));
        let least = if waits { 1500 } else { 400 };
        let expected = Duration::from_millis(least)..Duration::from_millis(least + 1500);
        assert!(expected.contains(&taken), "{fault:?}: {taken:?}");
    }
}

/// Only a command that is rejected twice was understood: not one that is lost first.
#[test]
fn a_lost_write_that_is_then_rejected_is_written() {
    let (result, part, _) = flashed(Part {
        faults: vec![Fault::LoseByte(2), Fault::RejectWrite(3)],
        ..Part::f103vc()
    });
    assert!(result.is_ok(), "{result:?}");
    assert_eq!(part.flash[..5002], image().bytes);
}

#[test]
fn what_fails_for_good_leaves_no_program() {
    for (fault, why) in [
        (
            Fault::RejectWrites(5),
            "the boot loader rejects Write Memory",
        ),
        (
            Fault::BadBit(2),
            "flash at 0x08000307 holds 0x60 instead of 0x70 after writing",
        ),
        (Fault::LoseBytes(6), "no answer to Write Memory"),
        (Fault::Cut(6), "broken pipe"),
    ] {
        let (result, part, _) = flashed(faulty(fault));
        let error = result.unwrap_err();
        assert_eq!(error.to_string(), why, "{fault:?}");
        assert!(
            part.flash[..256].iter().all(|byte| *byte == 0xFF),
            "{fault:?}"
        );
    }
}

#[test]
fn a_part_that_is_silent_is_waited_for() {
    let (result, _, taken) = flashed(faulty(Fault::Silent));
    let error = FlashError::Loader(LoaderError::Silent);
    assert_eq!(result.unwrap_err().to_string(), error.to_string());
    assert!((5..6).contains(&taken.as_secs()), "{taken:?}");
}
