//! A part at the other end of a pseudo-terminal.

use super::part::{BootLoader, Over, Part, Wire};
use serial2::SerialPort;
use std::io::ErrorKind;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard};
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// The part at the end of a line.
pub struct Bench {
    /// The path by which its line is opened.
    pub port: String,
    part: Arc<Mutex<Part>>,
    is_over: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
    _clients: SerialPort,
}

impl Bench {
    pub fn new(part: Part) -> Self {
        let (ours, mut clients) = SerialPort::pair().unwrap();
        let mut settings = clients.get_configuration().unwrap();
        settings.set_raw();
        clients.set_configuration(&settings).unwrap();
        let path = rustix::termios::ttyname(&clients, Vec::new()).unwrap();
        let part = Arc::new(Mutex::new(part));
        let is_over = Arc::new(AtomicBool::new(false));
        let mut wire = End {
            port: ours,
            is_over: Arc::clone(&is_over),
        };
        // How often it looks whether the test is over.
        let patience = Duration::from_millis(50);
        wire.port.set_read_timeout(patience).unwrap();
        let loader = BootLoader {
            wire,
            part: Arc::clone(&part),
        };
        Bench {
            port: path.to_string_lossy().into_owned(),
            part,
            is_over,
            thread: Some(thread::spawn(move || loader.run())),
            _clients: clients,
        }
    }

    pub fn part(&self) -> MutexGuard<'_, Part> {
        self.part.lock().unwrap()
    }
}

impl Drop for Bench {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::Relaxed);
        let ended = self.thread.take().map(JoinHandle::join);
        assert!(
            !matches!(ended, Some(Err(_))),
            "the boot loader has panicked"
        );
    }
}

struct End {
    port: SerialPort,
    is_over: Arc<AtomicBool>,
}

impl Wire for End {
    fn byte(&mut self) -> Result<u8, Over> {
        let mut byte = [0];
        loop {
            if self.is_over.load(Ordering::Relaxed) {
                return Err(Over);
            }
            match self.port.read(&mut byte) {
                Ok(1) => return Ok(byte[0]),
                Err(error) if error.kind() == ErrorKind::TimedOut => {}
                _ => return Err(Over),
            }
        }
    }

    fn answer(&mut self, bytes: &[u8]) -> Result<(), Over> {
        self.port.write_all(bytes).map_err(|_| Over)
    }
}
