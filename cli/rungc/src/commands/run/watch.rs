//! Observation of a run's frames: the table of connections at its end, and `--trace-frames`.

use super::capture::Capture;
use crate::commands::{Failure, eprint_line, parent_dir};
use crate::output::{Kind, make_folder, permit};
use crate::report::visible;
use rungc_models::Model;
use rungc_rt::Class;
use rungc_sim::serve::{Decoder, Direction, LinkProtocol, Place, Seen, Traffic};
use rungc_syntax::DeviceClass;
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs::File;
use std::io::Write as _;
use std::net::SocketAddr;
use std::path::Path;

/// Name of the frames' log that is not a file.
pub const STANDARD_ERROR: &str = "-";

/// Frames and their connections.
pub struct Watch {
    model: &'static Model,
    traffic: Traffic,
    /// Devices whose writing by others had no effect, which was reported.
    without_effect: BTreeSet<(DeviceClass, u32)>,
    log: Log,
    /// The last frames, until they are retrieved.
    recorded: Option<Vec<String>>,
}

/// Number of frames stored until they are retrieved.
const HEARD: usize = 200;

/// Log of frames.
enum Log {
    Nowhere,
    StandardError,
    Text(File),
    Capture(Capture),
    /// Writing has failed, which was reported.
    Failed,
}

/// Transport of a frame.
#[derive(Clone, Copy)]
pub enum Way {
    /// A serial port.
    Serial,
    /// A connection from a client to a server.
    Tcp {
        /// The client.
        client: SocketAddr,
        /// The server.
        server: SocketAddr,
    },
}

impl Watch {
    /// Nothing seen yet. `trace` is where frames are logged.
    ///
    /// # Errors
    /// A file that cannot be created.
    pub fn new(
        model: &'static Model,
        (trace, force): (Option<&Path>, bool),
    ) -> Result<Self, Failure> {
        let log = match trace {
            None => Log::Nowhere,
            Some(path) if path == Path::new(STANDARD_ERROR) => Log::StandardError,
            Some(path) => {
                let because =
                    |error| Failure::Because(format!("--trace-frames {}: {error}", path.display()));
                let extension = path.extension().and_then(|extension| extension.to_str());
                let captures = matches!(extension, Some("pcap" | "pcapng"));
                let kind = if captures {
                    Kind::Capture
                } else {
                    Kind::Frames
                };
                permit(path, kind, force)?;
                make_folder(parent_dir(path))?;
                let file = File::create(path).map_err(because)?;
                match captures {
                    true => Log::Capture(Capture::begin(file).map_err(because)?),
                    false => Log::Text(file),
                }
            }
        };
        let decoder = Decoder::new(model.ports, model.type_code());
        let traffic = Traffic::new(decoder);
        Ok(Watch {
            model,
            traffic,
            without_effect: BTreeSet::new(),
            log,
            recorded: None,
        })
    }

    /// Stores frames from now on until they are [retrieved](Self::take_recorded).
    pub fn record(&mut self) {
        self.recorded = Some(Vec::new());
    }

    /// The frames since the last call, decoded and as bytes.
    pub fn take_recorded(&mut self) -> Vec<String> {
        self.recorded
            .as_mut()
            .map(std::mem::take)
            .unwrap_or_default()
    }

    /// A server or port is open.
    pub fn open(&mut self, place: &Place, link: LinkProtocol) {
        self.traffic.open(place, link);
    }

    /// A frame was seen `at_us` microseconds after the run began.
    pub fn frame(&mut self, at_us: u64, way: Way, seen: Seen) {
        let decoded = self.traffic.frame(seen);
        self.report_without_effect(seen);
        let line = || {
            let Place { port, peer } = seen.place;
            let arrow = match seen.direction {
                Direction::In => "<-",
                Direction::Out => "->",
            };
            let mut line = format!("{port} {arrow} {peer}  {}", decoded.text);
            if let Some(error) = decoded
                .error
                .as_ref()
                .filter(|error| !decoded.text.contains(*error))
            {
                let _ = write!(line, " ({error})");
            }
            line.push_str("  [");
            for (n, byte) in seen.bytes.iter().enumerate() {
                let _ = write!(line, "{}{byte:02X}", if n > 0 { " " } else { "" });
            }
            line.push(']');
            line
        };
        if let Some(recorded) = self
            .recorded
            .as_mut()
            .filter(|recorded| recorded.len() < HEARD)
        {
            recorded.push(line());
        }
        let timed = || format!("{:12.6} {}", at_us as f64 / 1e6, line());
        let logged = match &mut self.log {
            Log::Nowhere | Log::Failed => Ok(()),
            Log::StandardError => {
                eprint_line(&timed());
                Ok(())
            }
            Log::Text(file) => writeln!(file, "{}", visible(&timed())),
            Log::Capture(capture) => capture.frame(at_us, way, seen),
        };
        if let Err(error) = logged {
            eprint_line(&format!(
                "rungc: --trace-frames: {error}; no more frames are logged"
            ));
            self.log = Log::Failed;
        }
    }

    /// Reports, once for each, the devices that a request has written and that each scan sets.
    fn report_without_effect(&mut self, seen: Seen) {
        for (class, number) in self.traffic.take_written() {
            let class = match class {
                Class::M => DeviceClass::M,
                Class::D => DeviceClass::D,
                _ => continue,
            };
            if !self.model.is_set_by_scan(class, number)
                || !self.without_effect.insert((class, number))
            {
                continue;
            }
            let device = class.number(number);
            let row = self.model.special(class, number);
            let meaning = row.map(|row| row.meaning(number)).unwrap_or_default();
            let Place { port, peer } = seen.place;
            eprint_line(&format!(
                "rungc: {port}: {peer} writes {device}, without effect: each scan sets it ({meaning})"
            ));
        }
    }

    /// The table of connections.
    pub fn table(&self) -> Vec<String> {
        self.traffic.table()
    }
}
