//! Emitted C that runs PLCs in child processes: 64 at once, or one after the other.

use crate::build::{CHUNK, Form, build};
use crate::engine::{At, Engine, Failed, FleetError};
use rungc_codegen_c::Members;
use rungc_codegen_c::lanes::LANES;
use rungc_ir::Module;
use rungc_models::runs::name_class;
use rungc_rt::Class;
use rungc_sim::engines::Piped;
use rungc_sim::threads::Threads;
use rustc_hash::FxHashMap;
use std::io::{self, Read, Write};
use std::path::Path;

/// Maximum number of readings in flight. Their answers have to fit into a pipe, since this end writes while the child
/// waits for it to read: 32 · 64 · 8 bytes.
const ON_THEIR_WAY: usize = 32;

/// Stands for whether a PLC is in RUN, as device 0 of a class.
const RUNNING: u8 = Class::ER as u8 + 3;

/// Bytes of a record of what has gone wrong.
const RECORD: usize = 24;

/// A request for a reading: PLC, class as in C, number of the first device.
type Chunk = (u32, u8, u32);

/// PLCs in children.
pub struct Children<'m> {
    form: Form,
    members: Members<'m>,
    children: Vec<Running>,
    /// Number of PLCs in each child but the last, which may have fewer.
    each: u32,
    /// Values read since the last scan.
    known: FxHashMap<Chunk, Vec<Option<i32>>>,
    /// Bytes that a PLC takes.
    size: u64,
    /// The last error.
    failed: Option<FleetError>,
}

struct Running {
    child: Piped,
    name: String,
}

impl<'m> Children<'m> {
    /// Builds and starts `count` PLCs, in at most as many processes as this machine runs at once.
    ///
    /// # Errors
    /// A file that cannot be written, a C compiler (`cc`) that is not there or rejects what was emitted, or a process
    /// that cannot be started.
    pub fn start(
        module: &'m Module,
        count: u32,
        folder: &Path,
        form: Form,
    ) -> Result<Self, FleetError> {
        let executable = build(module, folder, &form)?;
        let together = match form {
            Form::Lanes => LANES,
            Form::Singles { .. } => 1,
        };
        let blocks = count.div_ceil(together).max(1);
        let jobs = Threads::usual().count() as u32;
        let each = blocks.div_ceil(jobs.min(blocks)) * together;
        let mut children = Vec::new();
        for first in (0..count.max(1)).step_by(each as usize) {
            let part = each.min(count.max(1) - first);
            children.push(Running::start(&executable, &module.name, part)?);
        }
        let mut started = Children {
            form,
            members: Members::new(module),
            children,
            each,
            known: FxHashMap::default(),
            size: 0,
            failed: None,
        };
        let mut size = [0; 8];
        let first = &mut started.children[0];
        let received = first
            .request(b'M', (0, 0, 0), 0, 0)
            .and_then(|()| first.child.requests.flush())
            .and_then(|()| first.child.answers.read_exact(&mut size));
        match received {
            Ok(()) => started.size = u64::from_ne_bytes(size),
            Err(error) => return Err(first.ended(&error)),
        }
        Ok(started)
    }

    /// The child that has a PLC, and its number there.
    fn place(&self, plc: u32) -> (usize, u32) {
        ((plc / self.each) as usize, plc % self.each)
    }

    /// Does something with a child; what goes wrong is known from then on.
    fn with<T>(
        &mut self,
        child: usize,
        act: impl FnOnce(&mut Running) -> io::Result<T>,
    ) -> Option<T> {
        if self.failed.is_some() {
            return None;
        }
        let running = self.children.get_mut(child)?;
        match act(running) {
            Ok(done) => Some(done),
            Err(error) => {
                self.failed = Some(running.ended(&error));
                None
            }
        }
    }

    /// A value of a chunk, which is read if it is not known.
    fn value(&mut self, chunk: Chunk, place: u32) -> Option<i32> {
        if !self.known.contains_key(&chunk) {
            self.load(&[chunk]);
        }
        let values = self.known.get(&chunk)?;
        *values.get(place as usize)?
    }

    /// Reads chunks, some of each child at a time.
    fn load(&mut self, chunks: &[Chunk]) {
        for some in chunks.chunks(ON_THEIR_WAY) {
            for &(plc, device, first) in some {
                let (child, plc) = self.place(plc);
                self.with(child, |child| {
                    child.request(b'R', (plc, device, first), CHUNK as u16, 0)
                });
            }
            for child in 0..self.children.len() {
                if some.iter().any(|chunk| self.place(chunk.0).0 == child) {
                    self.with(child, |child| {
                        child.request(b'F', (0, 0, 0), 0, 0)?;
                        child.child.requests.flush()
                    });
                }
            }
            for &chunk in some {
                let (child, _) = self.place(chunk.0);
                let values = self.with(child, Running::values);
                self.known.insert(chunk, values.unwrap_or_default());
            }
        }
    }
}

impl Running {
    fn start(executable: &Path, name: &str, count: u32) -> Result<Self, FleetError> {
        let count = count.to_string();
        let started = Piped::start(executable, &[count.as_ref()]);
        let child = started.map_err(|error| FleetError::Io {
            what: executable.display().to_string(),
            error,
        })?;
        Ok(Running {
            child,
            name: name.to_string(),
        })
    }

    fn request(
        &mut self,
        code: u8,
        (plc, device, number): Chunk,
        count: u16,
        value: i32,
    ) -> io::Result<()> {
        let mut request = [0; 16];
        request[0] = code;
        request[1] = device;
        request[2..4].copy_from_slice(&count.to_ne_bytes());
        request[4..8].copy_from_slice(&plc.to_ne_bytes());
        request[8..12].copy_from_slice(&number.to_ne_bytes());
        request[12..].copy_from_slice(&value.to_ne_bytes());
        self.child.requests.write_all(&request)
    }

    /// The answer to a reading.
    fn values(&mut self) -> io::Result<Vec<Option<i32>>> {
        let mut bytes = [0; 8 * CHUNK as usize];
        self.child.answers.read_exact(&mut bytes)?;
        let (pairs, _) = bytes.as_chunks::<4>();
        let pairs = pairs.iter().map(|&number| i32::from_ne_bytes(number));
        let pairs: Vec<i32> = pairs.collect();
        let value = |pair: &[i32]| (pair[0] != 0).then_some(pair[1]);
        Ok(pairs.chunks(2).map(value).collect())
    }

    /// Errors in its PLCs, the first of which has this number.
    fn failures(&mut self, first: u32) -> io::Result<Vec<Failed>> {
        self.request(b'E', (0, 0, 0), 0, 0)?;
        self.child.requests.flush()?;
        let mut count = [0; 4];
        self.child.answers.read_exact(&mut count)?;
        let records = (0..u32::from_ne_bytes(count)).map(|_| {
            let mut bytes = [0; RECORD];
            self.child.answers.read_exact(&mut bytes)?;
            let (words, _) = bytes.as_chunks::<4>();
            let word = |n: usize| u32::from_ne_bytes(words[n]);
            let (halves, _) = bytes.as_chunks::<2>();
            let half = |n: usize| u16::from_ne_bytes(halves[n]);
            let (eights, _) = bytes.as_chunks::<8>();
            Ok(Failed {
                plc: first + word(2),
                code: half(8),
                step: half(9).into(),
                times: u64::from_ne_bytes(eights[0]),
                first_ms: (word(5) == 0).then(|| word(3)),
            })
        });
        records.collect()
    }

    /// That it has ended.
    fn ended(&mut self, error: &io::Error) -> FleetError {
        FleetError::Ended(self.name.clone(), self.child.ended(error))
    }
}

/// A device's class as emitted C numbers it.
fn device(at: At) -> u8 {
    match (at.class, at.contact) {
        (Class::T, true) => Class::ER as u8 + 1,
        (Class::C, true) => Class::ER as u8 + 2,
        (class, _) => class as u8,
    }
}

fn chunk(plc: u32, at: At) -> Chunk {
    (plc, device(at), at.number / CHUNK * CHUNK)
}

impl Engine for Children<'_> {
    fn begin_scan(&mut self, now_ms: u32, scan_us: u32) {
        self.known.clear();
        for child in 0..self.children.len() {
            self.with(child, |child| {
                child.request(b'S', (0, 0, now_ms), 0, scan_us as i32)?;
                child.child.requests.flush()
            });
        }
    }

    fn end_scan(&mut self) -> Result<(), FleetError> {
        for child in 0..self.children.len() {
            self.with(child, |child| child.child.answers.read_exact(&mut [0]));
        }
        self.failed.take().map_or(Ok(()), Err)
    }

    fn fetch(&mut self, wanted: &mut dyn Iterator<Item = (u32, At)>) {
        let mut chunks: Vec<Chunk> = wanted.map(|(plc, at)| chunk(plc, at)).collect();
        chunks.retain(|chunk| !self.known.contains_key(chunk));
        chunks.dedup();
        self.load(&chunks);
    }

    fn read(&mut self, plc: u32, at: At) -> Option<i32> {
        let chunk = chunk(plc, at);
        self.value(chunk, at.number - chunk.2)
    }

    fn write(&mut self, plc: u32, at: At, value: i32) -> Option<()> {
        self.members.of(name_class(at.class), at.number)?;
        self.known.remove(&chunk(plc, at));
        let (child, plc) = self.place(plc);
        self.with(child, |child| {
            child.request(b'W', (plc, device(at), at.number), 0, value)
        })
    }

    fn is_running(&mut self, plc: u32) -> bool {
        self.form == Form::Lanes || self.value((plc, RUNNING, 0), 0) == Some(1)
    }

    fn stopped(&mut self, count: u32) -> u32 {
        if self.form == Form::Lanes {
            return 0;
        }
        let chunks: Vec<Chunk> = (0..count).map(|plc| (plc, RUNNING, 0)).collect();
        self.load(&chunks);
        (0..count).filter(|&plc| !self.is_running(plc)).count() as u32
    }

    fn set_running(&mut self, plc: u32, running: bool) -> bool {
        if self.form == Form::Lanes {
            return running;
        }
        self.known.remove(&(plc, RUNNING, 0));
        let (child, plc) = self.place(plc);
        let received = self.with(child, |child| {
            child.request(b'T', (plc, 0, 0), 0, running.into())
        });
        received.is_some()
    }

    fn failures(&mut self) -> Vec<Failed> {
        let mut failures = Vec::new();
        for child in 0..self.children.len() {
            let first = self.each * child as u32;
            let of = self.with(child, |child| child.failures(first));
            failures.extend(of.unwrap_or_default());
        }
        failures
    }

    fn what(&self) -> String {
        let processes = match self.children.len() {
            1 => "a process".to_string(),
            count => format!("{count} processes"),
        };
        let size = self.size;
        match self.form {
            Form::Lanes => format!("{LANES} at once in {processes}, {size} bytes each"),
            Form::Singles { .. } => format!("in C in {processes}, {size} bytes each"),
        }
    }

    fn children(&self) -> Vec<u32> {
        self.children.iter().map(|child| child.child.id()).collect()
    }
}
