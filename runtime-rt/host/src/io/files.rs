//! Files, standard input and output: for scripts, and for the files by which Linux shows LEDs and converters.

use super::cycle::{Driver, ExchangeError, each_row};
use super::left_out::{LeftOut, shown};
use super::settings::{Connection, End, Row, devices};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufRead, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, TryRecvError, sync_channel};
use std::sync::{Mutex, PoisonError};
use std::thread;

/// A larger file, in bytes, is rejected.
const LARGEST: u64 = 1 << 20;

/// Lines of standard input that wait for a cycle.
const LINES: usize = 64;

/// The longest line of standard input, in bytes.
const LONGEST_LINE: u64 = 1024;

/// Files of a folder.
struct Folder {
    path: PathBuf,
    /// Values last written.
    written: BTreeMap<PathBuf, Vec<i16>>,
    left_out: LeftOut,
}

/// Files by the names of the rows, in the folder that a connection names.
pub(super) fn open_folder(connection: &Connection) -> Result<Box<dyn Driver>, String> {
    let path = PathBuf::from(&connection.end);
    match path.is_dir() {
        true => Ok(Box::new(Folder {
            path,
            written: BTreeMap::new(),
            left_out: LeftOut::default(),
        })),
        false => Err("there is no such folder".to_string()),
    }
}

impl Folder {
    /// Reads the values of a row; what follows them is left out.
    fn read(&mut self, row: &Row, name: &str, path: &Path, values: &mut [i16]) -> io::Result<()> {
        if let Some(word) = read(path, values)? {
            let (word, count) = (shown(&word), row.count);
            let report = format!("{name}: `{word}` after {count} numbers is left out");
            self.left_out.add(report);
        }
        Ok(())
    }

    /// Writes the values of a row that have changed.
    fn write(&mut self, path: PathBuf, values: &[i16]) -> io::Result<()> {
        if self
            .written
            .get(&path)
            .is_some_and(|written| written == values)
        {
            return Ok(());
        }
        // Values that a full disk has not accepted are written in the next cycle.
        self.written.remove(&path);
        write(&path, values)?;
        self.written.insert(path, values.to_vec());
        Ok(())
    }
}

impl Driver for Folder {
    fn exchange(
        &mut self,
        connection: &Connection,
        inputs: &mut [i16],
        outputs: &[i16],
    ) -> Result<(), ExchangeError> {
        each_row(connection, |row| {
            let End::Name(name) = &row.end else {
                return Ok(());
            };
            let refused = |error: io::Error| ExchangeError::Refused(format!("{name}: {error}"));
            let path = self.path.join(name);
            match row.reads {
                true => self.read(row, name, &path, &mut inputs[row.place.clone()]),
                false => self.write(path, &outputs[row.place.clone()]),
            }
            .map_err(refused)
        })
    }

    fn reports(&mut self) -> Vec<String> {
        self.left_out.reports()
    }
}

/// Reads numbers, one for each value, with white space between them. A number beyond 16 bits is one of 65535 at most,
/// as registers show it. Returns the word after them, if there is one.
fn read(path: &Path, values: &mut [i16]) -> io::Result<Option<String>> {
    let wrong = |what: String| io::Error::new(io::ErrorKind::InvalidData, what);
    let mut text = String::new();
    File::open(path)?.take(LARGEST).read_to_string(&mut text)?;
    let mut words = text.split_whitespace();
    let mut read = Vec::with_capacity(values.len());
    for _ in 0..values.len() {
        let word = words
            .next()
            .ok_or_else(|| wrong(format!("{} numbers are too few", read.len())))?;
        read.push(
            number(word).ok_or_else(|| wrong(format!("`{word}` is not a number of 16 bits")))?,
        );
    }
    values.copy_from_slice(&read);
    Ok(words.next().map(str::to_string))
}

/// Returns true if a file holds numbers alone, as rows write them, or is not a regular file.
///
/// # Errors
/// The file cannot be read, or is not there.
pub fn holds_numbers(path: &Path) -> io::Result<bool> {
    let file = File::open(path)?;
    if !file.metadata()?.is_file() {
        return Ok(true);
    }
    let mut text = Vec::new();
    file.take(LARGEST).read_to_end(&mut text)?;
    let text = String::from_utf8_lossy(&text);
    Ok(text.split_whitespace().all(|word| number(word).is_some()))
}

/// Reads -32768 to 65535.
fn number(text: &str) -> Option<i16> {
    let number: i32 = text.parse().ok()?;
    (-0x8000..=0xffff)
        .contains(&number)
        .then_some(number as i16)
}

/// Writes numbers as one line, at once.
fn write(path: &Path, values: &[i16]) -> io::Result<()> {
    let words: Vec<_> = values.iter().map(ToString::to_string).collect();
    let line = words.join(" ") + "\n";
    // Not replaced by another file: it may be one that stands for hardware. Cut off afterwards, so that no
    // reader finds it empty.
    let mut file = File::options()
        .write(true)
        .create(true)
        .truncate(false)
        .open(path)?;
    file.write_all(line.as_bytes())?;
    let known = file.metadata()?;
    if known.is_file() && known.len() > line.len() as u64 {
        file.set_len(line.len() as u64)?;
    }
    Ok(())
}

/// Standard input and output: lines such as `X000=1` and `Y000=1`.
struct Console {
    /// Values last printed.
    printed: Vec<Option<i16>>,
    left_out: LeftOut,
}

/// The lines of standard input. There is one for the process, and one thread that reads it.
static STANDARD_INPUT: Mutex<Option<Receiver<String>>> = Mutex::new(None);

pub(super) fn open_console(connection: &Connection) -> Result<Box<dyn Driver>, String> {
    let mut input = STANDARD_INPUT
        .lock()
        .unwrap_or_else(PoisonError::into_inner);
    if connection.directed(true).next().is_some() && input.is_none() {
        let (sender, lines) = sync_channel(LINES);
        let listen = move || {
            let mut standard = io::stdin().lock();
            loop {
                let mut line = Vec::new();
                // A longer line is cut, so that it cannot fill the memory.
                match standard
                    .by_ref()
                    .take(LONGEST_LINE)
                    .read_until(b'\n', &mut line)
                {
                    Ok(0) | Err(_) => break,
                    Ok(_) => {}
                }
                if sender
                    .send(String::from_utf8_lossy(&line).into_owned())
                    .is_err()
                {
                    break;
                }
            }
        };
        let spawned = thread::Builder::new()
            .name("standard input".to_string())
            .spawn(listen);
        spawned.map_err(|error| error.to_string())?;
        *input = Some(lines);
    }
    Ok(Box::new(Console {
        printed: Vec::new(),
        left_out: LeftOut::default(),
    }))
}

impl Driver for Console {
    fn exchange(
        &mut self,
        connection: &Connection,
        inputs: &mut [i16],
        outputs: &[i16],
    ) -> Result<(), ExchangeError> {
        self.printed.resize(outputs.len(), None);
        let mut text = String::new();
        for row in connection.directed(false) {
            for (index, at) in (0..).zip(row.place.clone()) {
                if self.printed[at].replace(outputs[at]) != Some(outputs[at]) {
                    text.push_str(&format!("{}={}\n", row.name(index), outputs[at]));
                }
            }
        }
        let mut standard = io::stdout().lock();
        let printed = standard
            .write_all(text.as_bytes())
            .and_then(|()| standard.flush());
        printed.map_err(|error| {
            // All of it is printed when there is room again.
            self.printed.clear();
            ExchangeError::Refused(format!("standard output: {error}"))
        })?;
        drop(standard);
        let input = STANDARD_INPUT
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        let Some(lines) = &*input else { return Ok(()) };
        for _ in 0..LINES {
            match lines.try_recv() {
                Ok(line) => {
                    let taken = take(connection, line.trim(), inputs);
                    taken.unwrap_or_else(|why| self.left_out.add(why));
                }
                Err(TryRecvError::Empty) => break,
                Err(TryRecvError::Disconnected) => {
                    return Err(ExchangeError::Refused(
                        "standard input has ended".to_string(),
                    ));
                }
            }
        }
        Ok(())
    }

    fn reports(&mut self) -> Vec<String> {
        self.left_out.reports()
    }
}

/// Does what `X000=1` says.
///
/// # Errors
/// Why a line is left out: it names no device that the connection reads, or no value that fits.
pub(super) fn take(connection: &Connection, line: &str, inputs: &mut [i16]) -> Result<(), String> {
    if line.is_empty() {
        return Ok(());
    }
    let wrong = |why: String| format!("`{}` is left out: {why}", shown(line));
    let (name, text) = line
        .split_once('=')
        .ok_or_else(|| wrong("a line is written `X000=1`".to_string()))?;
    let (name, text) = (name.trim(), text.trim());
    let Some((class, number, 1)) = devices(&name.to_ascii_uppercase()) else {
        return Err(wrong(format!("`{}` is not a device", shown(name))));
    };
    let holds =
        |row: &&Row| row.class == class && (row.first..row.first + row.count).contains(&number);
    let Some(row) = connection.directed(true).find(holds) else {
        return Err(wrong(format!(
            "this connection does not read {}",
            shown(name)
        )));
    };
    let value = self::number(text).filter(|value| !row.is_bits() || matches!(value, 0 | 1));
    let Some(value) = value else {
        let range = if row.is_bits() {
            "0 or 1"
        } else {
            "-32768 to 65535"
        };
        return Err(wrong(format!("the value is {range}")));
    };
    inputs[row.place.start + (number - row.first) as usize] = value;
    Ok(())
}
