
/// After how long it is tried again to open a line that has vanished.
const RETRY: Duration = Duration::from_secs(1);

/// Maximum number of characters that wait for a port; more stay in the line of the program.
const UNSENT: usize = 4096;

/// A serial port of the program, and the one of this computer that it is.
struct Line {
    port: u8,
    path: String,
    /// `None`: it has vanished.
    serial: Option<SerialPort>,
    events: Receiver<Event>,
    /// Characters that the port has no room for yet.
    unsent: Vec<u8>,
    format: LineFormat,
    /// Time of the last received character.
    last_us: u32,
}

/// Event on a line.
enum Event {
    Came(Instant, Vec<u8>),
    Gone,
    Back(SerialPort),
}

/// Reads a line for as long as the program runs, and opens it again when it vanishes.
fn keep(path: &str, mut serial: SerialPort, sender: &Sender<Event>) -> Result<(), SendError<Event>> {
    loop {
        let mut bytes = [0; 1024];
        while let Ok(count @ 1..) = serial.receive(&mut bytes) {
            sender.send(Event::Came(Instant::now(), bytes[..count].to_vec()))?;
        }
        sender.send(Event::Gone)?;
        let (reading, writing) = loop {
            std::thread::sleep(RETRY);
            if let Ok(both) = ends(path) {
                break both;
            }
        };
        serial = reading;
        sender.send(Event::Back(writing))?;
    }
}

/// Opens a line, to be read and to be written.
fn ends(path: &str) -> io::Result<(SerialPort, SerialPort)> {
    let serial = SerialPort::open(path)?;
    Ok((serial.try_clone()?, serial))
}

/// Has the ports receive and answer characters, between two scans. Reports a partner that switches the PLC to RUN or
/// STOP, and returns which.
fn advance(
    plc: &mut TYPE,
    hal: &mut VirtualHal,
    lines: &mut [Line],
    start: Instant,
    now_ms: u32,
) -> Option<bool> {
    let ran = Ports::FAMILY.will_run(&Served::<TYPE>::new(plc, TYPE_CODE));
    lines.iter_mut().for_each(|line| line.exchange(hal, start, now_ms));
    plc.tick(hal, now_ms);
    let runs = Ports::FAMILY.will_run(&Served::<TYPE>::new(plc, TYPE_CODE));
    if ran == runs {
        return None;
    }
    let ports: Vec<_> = lines.iter().map(|line| line.port).collect();
    report(&switched_by_line(runs, plc, &ports));
    Some(runs)
}

impl Line {
    /// The line that an option names: `COM1=/dev/ttyUSB0`.
    fn connect(plc: &mut TYPE, value: &str) -> Result<Line, String> {
        let (port, path) = value
            .split_once('=')
            .and_then(|(port, path)| Some((port.strip_prefix("COM")?.parse().ok()?, path)))
            .ok_or("a line is written COM1=/dev/ttyUSB0")?;
        Line::of_port(plc, port, path)
    }

    /// A port's line to the device at a path.
    fn of_port(plc: &mut TYPE, port: u8, path: &str) -> Result<Line, String> {
        if plc.port(port).is_none() {
            return Err(format!("the program has no port COM{port}"));
        }
        let line = Line::open(port, path).map_err(|error| cannot_open(path, &error))?;
        report!("COM{port} at {path}");
        Ok(line)
    }

    fn open(port: u8, path: &str) -> io::Result<Line> {
        let (reading, writing) = ends(path)?;
        let (sender, events) = mpsc::channel();
        let (path, tried) = (path.to_string(), path.to_string());
        std::thread::spawn(move || keep(&tried, reading, &sender));
        let format = LineFormat::new();
        Ok(Line { port, path, serial: Some(writing), events, unsent: Vec::new(), format, last_us: 0 })
    }

    /// Passes received characters to the program's port at their time, and sends those of the program. The characters
    /// of a lump came one after the other.
    fn exchange(&mut self, hal: &mut VirtualHal, start: Instant, now_ms: u32) {
        let Some(line) = hal.line(self.port) else {
            return;
        };
        let format = line.format();
        if format != self.format && format.bits_per_second != 0 {
            self.format = format;
            if let Some(serial) = &self.serial
                && let Err(error) = serial.set_format(format)
            {
                report!("COM{}: the line cannot be set to {} bit/s: {error}", self.port, format.bits_per_second);
            }
        }
        let character_us = self.format.character_us();
        for event in self.events.try_iter() {
            let (came, bytes) = match event {
                Event::Came(at, bytes) => (at, bytes),
                Event::Gone => {
                    report!("COM{}: {} is gone; waiting for it", self.port, self.path);
                    self.serial = None;
                    continue;
                }
                Event::Back(serial) => {
                    report!("COM{}: {} is back", self.port, self.path);
                    self.serial = Some(serial);
                    self.format = LineFormat::new();
                    continue;
                }
            };
            let came_us = (came - start).as_micros() as u32;
            let lump_us = character_us * (bytes.len() as u32 - 1);
            let mut at_us = came_us.wrapping_sub(lump_us);
            for byte in bytes {
                let earliest_us = self.last_us.wrapping_add(character_us);
                if (at_us.wrapping_sub(earliest_us) as i32) < 0 {
                    at_us = earliest_us;
                }
                self.last_us = at_us;
                // Excess characters are lost, as in the receiver of a PLC that is not polled in time.
                let _ = line.feed(Received { at_us, byte, ..Received::new() });
                at_us = at_us.wrapping_add(character_us);
            }
        }
        let now_us = now_ms.wrapping_mul(1000);
        let Some(serial) = &mut self.serial else {
            self.unsent.clear();
            while line.take(now_us).is_some() {}
            return;
        };
        let room = UNSENT - self.unsent.len();
        self.unsent.extend(std::iter::from_fn(|| line.take(now_us)).map(|sent| sent.byte).take(room));
        // A failure is one of reading, too, which is reported.
        let sent = serial.send(&self.unsent).unwrap_or(0);
        self.unsent.drain(..sent);
    }
}
