//! A program that runs with servers and serial lines open.

use super::{HANG, soon};
use std::cell::RefCell;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{self, Receiver};
use std::thread;

/// A run, which ends with the test.
pub struct Run {
    child: Child,
    /// Reports, line by line.
    messages: Receiver<String>,
    /// Reports so far.
    received: RefCell<Vec<String>>,
    /// Rows of its table, of which there is one every 50 ms.
    rows: Receiver<String>,
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
            let line = self.next_line();
            let report = line.strip_prefix("rungc: ");
            if let Some((what, place)) = report.and_then(|report| report.split_once(" at ")) {
                self.open.push((what.to_owned(), place.to_owned()));
            }
        }
        // The first scans set up the lines.
        self.goes_on();
    }

    /// Waits for scans.
    pub fn goes_on(&self) {
        while self.rows.try_recv().is_ok() {}
        for _ in 0..2 {
            self.rows.recv_timeout(HANG).expect("the run continues");
        }
    }

    /// The next line that it reports.
    fn next_line(&self) -> String {
        let line = self.messages.recv_timeout(HANG);
        let line = line.unwrap_or_else(|_| panic!("no more is reported: {:?}", self.received));
        self.received.borrow_mut().push(line.clone());
        line
    }

    /// Waits until it reports something that contains this text.
    pub fn says(&self, text: &str) {
        while !self.next_line().contains(text) {}
    }

    /// Runs `p.il` of this folder with more options, and waits for nothing. HM has no clock relays: a program for it
    /// inverts M50 in each scan.
    pub fn start(folder: &Path, model: &str, args: &[&str]) -> Run {
        let beat = if model == "hm" { "M50" } else { "M8012" };
        let mut child = Command::new(env!("CARGO_BIN_EXE_rungc"))
            .args(["run", "p.il", "--model", model, "--watch", beat])
            .args(args)
            .current_dir(folder)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let messages = lines(child.stderr.take().unwrap());
        let rows = lines(child.stdout.take().unwrap());
        Run {
            child,
            messages,
            received: RefCell::default(),
            rows,
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

    /// Reports so far.
    pub fn messages(&self) -> Vec<String> {
        self.received.borrow_mut().extend(self.messages.try_iter());
        self.received.borrow().clone()
    }
}

/// The clock of a server of MC protocol, set by its client with a weekday that is not the date's: the weekday is taken
/// as it is, and the next day has the next one.
pub fn keeps_the_weekday_of_a_client(address: &str) {
    // Each request comes by a separate connection, and so after another scan.
    let ask = |request: &str, length: usize| {
        let mut stream = TcpStream::connect(address).unwrap();
        stream.set_read_timeout(Some(HANG)).unwrap();
        stream.write_all(request.as_bytes()).unwrap();
        let mut answer = vec![0; length];
        stream.read_exact(&mut answer).unwrap();
        String::from_utf8(answer).unwrap()
    };
    // M8015 holds D8013 to D8019: 23:59:58 on Wednesday, 28 February 2024, said to be a Sunday.
    assert_eq!(ask("04FF000A01004D2000001F4F01", 4), "8400");
    let moment = "003A003B0017001C000207E80000";
    assert_eq!(ask(&format!("03FF000A442000001F4D0700{moment}"), 4), "8300");
    assert_eq!(ask("04FF000A01004D2000001F4F00", 4), "8400");
    let day_and_weekday = || {
        let answer = ask("01FF000A442000001F4D0700", 32);
        (answer[16..20].to_owned(), answer[28..].to_owned())
    };
    let mut last = day_and_weekday();
    let is = |day: &str, weekday: &str| (day.to_owned(), weekday.to_owned());
    soon("midnight comes", || {
        assert!(
            last == is("001C", "0000") || last == is("001D", "0001"),
            "{last:?}"
        );
        last = day_and_weekday();
        last == is("001D", "0001")
    });
}

/// Lines as they come, whether or not anybody listens.
fn lines(pipe: impl Read + Send + 'static) -> Receiver<String> {
    let (sender, receiver) = mpsc::channel();
    thread::spawn(move || {
        for line in BufReader::new(pipe).lines().map_while(Result::ok) {
            let _ = sender.send(line);
        }
    });
    receiver
}

impl Drop for Run {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
