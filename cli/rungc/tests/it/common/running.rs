//! A program that runs with servers and serial lines open.

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{self, Receiver};
use std::thread;
use std::time::Duration;

/// Time-out for a run to open its ports.
const PATIENCE: Duration = Duration::from_secs(30);

/// Time-out of the first scans, which set up the lines.
const FIRST_SCANS: Duration = Duration::from_millis(500);

/// A run, which ends with the test.
pub struct Run {
    child: Child,
    /// Reports, line by line.
    said: Receiver<String>,
    /// Open ends, such as `COM1` or `Modbus TCP`, and their addresses.
    open: Vec<(String, String)>,
}

impl Run {
    /// Runs `p.il` of this folder. Servers are named by their options, such as `--modbus-tcp`, each at a free port;
    /// lines as `COM1`, each at a pseudo-terminal, and `CAN` at one that speaks SLCAN.
    pub fn new(folder: &Path, model: &str, servers: &[&str], lines: &[&str]) -> Run {
        let (buses, ports): (Vec<&str>, Vec<&str>) = lines.iter().partition(|line| **line == "CAN");
        let terminals: Vec<_> = ports.iter().map(|line| format!("{line}=pty")).collect();
        let mut args = Vec::new();
        for server in servers {
            args.extend([server, "0"]);
        }
        for terminal in &terminals {
            args.extend(["--serial", terminal]);
        }
        args.extend(buses.iter().flat_map(|_| ["--can", "slcan:pty"]));
        let mut run = Run::start(folder, model, &args);
        run.opens(servers.len() + lines.len());
        run
    }

    /// Waits until it has opened this many servers and lines.
    pub fn opens(&mut self, count: usize) {
        while self.open.len() < count {
            let line = self.said.recv_timeout(PATIENCE);
            let line = line.expect("the run opens everything");
            let told = line.strip_prefix("rungc: ");
            if let Some((what, place)) = told.and_then(|told| told.split_once(" at ")) {
                self.open.push((what.to_owned(), place.to_owned()));
            }
        }
        if self.open.iter().any(|(what, _)| what.starts_with("COM")) {
            thread::sleep(FIRST_SCANS);
        }
    }

    /// Runs `p.il` of this folder with more options, and waits for nothing.
    pub fn start(folder: &Path, model: &str, args: &[&str]) -> Run {
        let mut child = Command::new(env!("CARGO_BIN_EXE_rungc"))
            .args(["run", "p.il", "--model", model])
            .args(args)
            .current_dir(folder)
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let errors = child.stderr.take().unwrap();
        let (sender, said) = mpsc::channel();
        thread::spawn(move || {
            // Continues even without a listener, so that the run can keep writing.
            for line in BufReader::new(errors).lines().map_while(Result::ok) {
                let _ = sender.send(line);
            }
        });
        Run {
            child,
            said,
            open: Vec::new(),
        }
    }

    fn place(&self, what: &str) -> &str {
        let found = self.open.iter().find(|(name, _)| name == what);
        &found.expect("it is open").1
    }

    /// The TCP port of a server: `Modbus TCP`, `MC protocol` or `programming port`.
    pub fn port(&self, server: &str) -> u16 {
        let place = self.place(server);
        place.rsplit_once(':').unwrap().1.parse().unwrap()
    }

    /// The path of the terminal that is this port.
    pub fn line(&self, port: &str) -> &str {
        self.place(port)
    }

    /// Reports since the last call.
    pub fn said(&self) -> Vec<String> {
        self.said.try_iter().collect()
    }
}

impl Drop for Run {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
