
/// A serial port of the program, and the one of this computer that it is.
struct Line {
    port: u8,
    path: String,
    file: File,
    incoming: Receiver<(Instant, Vec<u8>)>,
    format: LineFormat,
    /// When the last character was in.
    last_us: u32,
}

/// The lines that the options name: `--serial COM1=/dev/ttyUSB0`.
fn lines(plc: &mut TYPE) -> Result<Vec<Line>, String> {
    let mut lines = Vec::new();
    let mut options = std::env::args().skip(1);
    while let Some(option) = options.next() {
        let value = options.next().filter(|_| option == "--serial");
        let value = value.ok_or("usage: [--serial COM1=/dev/ttyUSB0]...")?;
        let (port, path) = value
            .split_once('=')
            .and_then(|(port, path)| Some((port.strip_prefix("COM")?.parse().ok()?, path)))
            .ok_or_else(|| format!("--serial {value}: a line is written COM1=/dev/ttyUSB0"))?;
        if plc.port(port).is_none() {
            return Err(format!("--serial {value}: the program has no port COM{port}"));
        }
        let line = Line::open(port, path).map_err(|error| format!("--serial {value}: {error}"))?;
        eprintln!("COM{port} at {path}");
        lines.push(line);
    }
    Ok(lines)
}

impl Line {
    fn open(port: u8, path: &str) -> io::Result<Line> {
        stty(path, &["raw", "-echo", "clocal"])?;
        let file = File::options().read(true).write(true).open(path)?;
        let mut from = file.try_clone()?;
        let (sender, incoming) = mpsc::channel();
        std::thread::spawn(move || {
            let mut bytes = [0; 1024];
            while let Ok(count @ 1..) = from.read(&mut bytes) {
                if sender.send((Instant::now(), bytes[..count].to_vec())).is_err() {
                    break;
                }
            }
        });
        let (path, format) = (path.to_string(), LineFormat::new());
        Ok(Line { port, path, file, incoming, format, last_us: 0 })
    }

    /// What has come in reaches the program's port at its time, and what the program sends goes out. The characters of a lump came one
    /// after the other.
    fn exchange(&mut self, hal: &mut VirtualHal, start: Instant, now_ms: u32) {
        let Some(line) = hal.line(self.port) else {
            return;
        };
        let format = line.format();
        if format != self.format && format.bits_per_second != 0 {
            self.format = format;
            if let Err(error) = stty(&self.path, &settings(format)) {
                eprintln!("COM{}: the line cannot be set to {} bit/s: {error}", self.port, format.bits_per_second);
            }
        }
        let character_us = self.format.character_us();
        for (came, bytes) in self.incoming.try_iter() {
            let came_us = (came - start).as_micros() as u32;
            let lump_us = character_us * (bytes.len() as u32 - 1);
            let mut at_us = came_us.wrapping_sub(lump_us);
            for byte in bytes {
                let earliest_us = self.last_us.wrapping_add(character_us);
                if (at_us.wrapping_sub(earliest_us) as i32) < 0 {
                    at_us = earliest_us;
                }
                self.last_us = at_us;
                // What does not fit is lost, as in the receiver of a PLC that is not asked in time.
                let _ = line.feed(Received { at_us, byte, ..Received::new() });
                at_us = at_us.wrapping_add(character_us);
            }
        }
        let now_us = now_ms.wrapping_mul(1000);
        let sent: Vec<u8> = std::iter::from_fn(|| line.take(now_us)).map(|sent| sent.byte).collect();
        if !sent.is_empty()
            && let Err(error) = self.file.write_all(&sent)
        {
            eprintln!("COM{}: {error}", self.port);
        }
    }
}

/// The format of characters as arguments of the command `stty`.
fn settings(format: LineFormat) -> Vec<String> {
    let on = |on: bool, name: &str| if on { name.to_string() } else { format!("-{name}") };
    vec![
        format.bits_per_second.to_string(),
        format!("cs{}", format.data_bits),
        on(format.parity != Parity::None, "parenb"),
        on(format.parity == Parity::Odd, "parodd"),
        on(format.stop_bits == 2, "cstopb"),
    ]
}

/// Sets up a line with the command `stty`: the standard library has no other way.
fn stty(path: &str, settings: &[impl AsRef<std::ffi::OsStr>]) -> io::Result<()> {
    let mut command = std::process::Command::new("stty");
    let output = command.arg("-F").arg(path).args(settings).output()?;
    match output.status.success() {
        true => Ok(()),
        false => Err(io::Error::other(String::from_utf8_lossy(&output.stderr).trim().to_string())),
    }
}
