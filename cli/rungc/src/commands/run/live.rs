//! `rungc serve --page`: what the page shows of a run, and what it asks the run to do.

use crate::commands::{Failure, eprint_line};
use rungc::Names;
use rungc::names::fits;
use rungc_analysis::resolve::resolve;
use rungc_host::servers::after;
use rungc_ladder::build;
use rungc_live::{Command, Frame, Log, Order, Scene, Server, token};
use rungc_models::Model;
use rungc_rt::{Class, Plc};
use rungc_runtime_sources::cache;
use rungc_sim::record::{Reading, Seen};
use rungc_sim::{Session, Target};
use rungc_syntax::Program;
use serde_json::{Value, json};
use std::net::SocketAddr;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

/// Interval of updates of the page.
const EVERY: Duration = Duration::from_millis(100);
/// The slowest pace.
const SLOWEST: u32 = 1000;
/// Maximum numbers of watched devices and of breakpoints.
const MAX_WATCHED: usize = 256;
const MAX_BREAKS: usize = 64;

/// Settings of a page, and its address.
pub struct Page<'a> {
    /// Its title.
    pub title: &'a str,
    /// Address at which it is served.
    pub address: SocketAddr,
    /// Place of the address in messages.
    pub place: &'a str,
    /// True if it accepts no commands.
    pub read_only: bool,
    /// Initial contents of the watch list.
    pub watched: Vec<Target>,
}

/// A run between two scans.
pub struct Running<'a, 'm> {
    /// The PLC with what is around it.
    pub session: &'a mut Session<'m>,
    /// By how many scans it can go back.
    pub back: u64,
}

/// Progress of a run, and the state of the page.
#[derive(Clone)]
pub struct Control {
    /// Number of scans executed.
    pub scans: u64,
    was_running: bool,
    /// States of edges in the ladder.
    edges: Vec<[bool; 2]>,
}

/// Decision about the next scan.
pub enum Due {
    /// It is.
    Now,
    /// Time stands still.
    NotYet,
    /// The page asks the run to go back by this number of scans.
    Back(u32, Order),
}

impl Running<'_, '_> {
    /// The device of this name or comment, which exists.
    fn device(&self, name: &str, names: &Names) -> Result<Target, String> {
        let target = names.target(name)?;
        match self.session.reading(target) {
            Some(_) => Ok(target),
            None => Err(format!(
                "`{target}` does not exist on {}",
                self.session.machine().module().model.title
            )),
        }
    }

    /// Checks that a device can be set to a value, which it keeps.
    fn takes(&self, target: Target, value: f64) -> Result<(), String> {
        fits(target, value)?;
        let machine = self.session.machine();
        rungc_sim::check_lasts(machine.module().model, target, |relay| {
            machine.bit(Class::M, relay.number()) == Some(true)
        })
    }
}

/// Condition that pauses the run.
enum Break {
    /// A device has changed, or has come to a value. With what it was after the scan before.
    Device(Target, Option<f64>, Option<Reading>),
    /// Power has reached an output of a network, from 0. With whether it was there after the scan before.
    Network(usize, bool),
}

impl Break {
    fn text(&self) -> String {
        match self {
            Break::Device(target, None, _) => format!("{} changes", super::name(*target)),
            Break::Device(target, Some(value), _) => format!("{} = {value}", super::name(*target)),
            Break::Network(network, _) => {
                format!("power reaches an output of network {}", network + 1)
            }
        }
    }
}

/// The page of a run.
pub struct Live {
    server: Server,
    scene: Scene,
    names: Names,
    watched: Vec<Target>,
    breaks: Vec<Break>,
    log: Log,
    /// Reason for the pause.
    paused: Option<String>,
    /// The network at whose breakpoint it does.
    stopped_at: Option<usize>,
    /// After how many scans it stands still again.
    scans_left: Option<u32>,
    slower: u32,
    control: Control,
    /// True if the run repeats scans that the page has seen.
    again: bool,
    /// True if a command has changed the PLC.
    disturbed: bool,
    /// True if the run is late by its clock because of a pause or a slower pace.
    shifted: bool,
    /// Time of the last update of the page.
    shown: Option<Instant>,
    /// Time of the start, which distinguishes the run from others.
    began: String,
}

impl Live {
    /// Serves the page of a program, and prints its address.
    ///
    /// # Errors
    /// An address that cannot be had, or that others can reach.
    pub fn open(page: Page, program: &Program, model: &'static Model) -> Result<Self, Failure> {
        let (resolved, _) = resolve(program, model);
        let ladder = build::ladder(&resolved);
        let (html, scene) = rungc_live::page(page.title, &resolved, &ladder, page.read_only);
        let (address, place) = (page.address, page.place);
        let folder = cache::folder().ok();
        let server = token(folder.as_deref())
            .and_then(|token| Server::open(address, token, html, page.read_only))
            .map_err(|error| {
                let next = after(&error);
                Failure::Because(format!("{place} {address}: {error}{next}"))
            })?;
        eprint_line(&format!("rungc: page at {}", server.url()));
        let began = SystemTime::now().duration_since(UNIX_EPOCH);
        Ok(Live {
            server,
            scene,
            names: Names::of(program),
            watched: page.watched,
            breaks: Vec::new(),
            log: Log::default(),
            paused: None,
            stopped_at: None,
            scans_left: None,
            slower: 1,
            control: Control {
                scans: 0,
                was_running: true,
                edges: Vec::new(),
            },
            again: false,
            disturbed: false,
            shifted: false,
            shown: None,
            began: began.map_or(0, |since| since.as_micros()).to_string(),
        })
    }

    /// Takes notice of a scan.
    pub fn scanned(&mut self, running: Running) {
        let session = &*running.session;
        self.control.scans += 1;
        let is_running = session.machine().sys().running;
        let changed = std::mem::replace(&mut self.control.was_running, is_running) != is_running;
        self.scene.scanned(session.seen());
        if self.again {
            return;
        }
        if changed {
            let mode = if is_running { "RUN" } else { "STOP" };
            self.note(session.now_ms(), "event", mode);
        }
        if let Some(left) = &mut self.scans_left {
            *left -= 1;
            if *left == 0 {
                self.pause("after single scans".to_string());
            }
        }
        if let Some((why, network)) = self.broken(session.seen()) {
            self.log
                .write(session.now_ms(), "event", &format!("breakpoint: {why}"));
            self.pause(why);
            self.stopped_at = network;
        }
        self.show(&running);
    }

    /// Writes into the page's log; `kind` is `error`, `frame` or `event`.
    pub fn note(&mut self, now_ms: u64, kind: &str, text: &str) {
        self.log.write(now_ms, kind, text);
    }

    fn pause(&mut self, why: String) {
        self.paused = Some(why);
        self.scans_left = None;
    }

    /// The breakpoint that this scan has come to, and its network.
    fn broken(&mut self, seen: Seen) -> Option<(String, Option<usize>)> {
        let mut broken = None;
        for point in &mut self.breaks {
            let (is_met, network) = match point {
                Break::Device(target, value, last) => {
                    let now = Reading::of(seen, *target);
                    let has_changed = now != *last;
                    let is_there =
                        value.is_none_or(|value| now.as_ref().and_then(number) == Some(value));
                    *last = now;
                    (has_changed && is_there, None)
                }
                Break::Network(network, was) => {
                    let is = self.scene.reaches(*network, seen);
                    let came = is && !*was;
                    *was = is;
                    (came, Some(*network))
                }
            };
            if is_met && broken.is_none() {
                broken = Some((point.text(), network));
            }
        }
        broken
    }

    /// Carries out what the page asks for until the next scan is due; whether it is. It is not while time stands still,
    /// though commands are waited for only a moment.
    pub fn obey(&mut self, mut running: Running, due: Instant, scan_ms: u64) -> Due {
        let slower = u64::from(self.slower);
        let due = match slower {
            1 => due,
            _ => Instant::now() + Duration::from_millis(scan_ms.saturating_mul(slower)),
        };
        self.shifted |= slower > 1;
        loop {
            let left = due.saturating_duration_since(Instant::now());
            let left = if self.paused.is_some() {
                EVERY
            } else {
                left.min(EVERY)
            };
            if let Some(order) = self.server.order(left) {
                match self.carry_out(&order.command, &mut running) {
                    Ok(Some(count)) => return Due::Back(count, order),
                    Ok(None) => {
                        self.disturbed |= order.command.changes_plc();
                        self.shown = None;
                        order.answer(Ok(()));
                    }
                    Err(why) => order.answer(Err(why)),
                }
            }
            self.show(&running);
            if self.paused.is_some() {
                self.shifted = true;
                return Due::NotYet;
            }
            if Instant::now() >= due {
                return Due::Now;
            }
        }
    }

    /// Returns true if the run has become late by its clock since the last call.
    pub fn has_shifted(&mut self) -> bool {
        std::mem::take(&mut self.shifted)
    }

    /// Returns true if a command has changed the PLC since the last call.
    pub fn has_disturbed(&mut self) -> bool {
        std::mem::take(&mut self.disturbed)
    }

    /// Number of scans executed.
    pub fn scans(&self) -> u64 {
        self.control.scans
    }

    /// Progress of the run.
    pub fn control(&self) -> Control {
        Control {
            edges: self.scene.edges(),
            ..self.control.clone()
        }
    }

    /// The run goes back to an earlier moment, and comes from there to the requested scan.
    pub fn begin_again(&mut self, control: Control) {
        self.scene.set_edges(&control.edges);
        self.control = control;
        self.again = true;
    }

    /// It has come there, where time stands still.
    pub fn is_back(&mut self, running: &Running) {
        self.again = false;
        // Breakpoints compare with how things are now.
        self.broken(running.session.seen());
        let scan = format!("back at scan {}", self.scans());
        self.note(running.session.now_ms(), "event", &scan);
        self.pause(scan);
        self.stopped_at = None;
        self.shown = None;
    }

    /// Carries out a command. By how many scans it asks the run to go back, if it does; an error describes the problem.
    fn carry_out(
        &mut self,
        command: &Command,
        running: &mut Running,
    ) -> Result<Option<u32>, String> {
        let now_ms = running.session.now_ms();
        match command {
            Command::Run {} => turn_switch(running.session, true),
            Command::Stop {} => turn_switch(running.session, false),
            Command::Pause {} => self.pause("by hand".to_string()),
            Command::Continue {} => self.resume(None),
            Command::Back { count: 0 } => return Err("go back by at least one scan".to_string()),
            Command::Back { count } => return Ok(Some(*count)),
            Command::Scan { count: 0 } => return Err("execute at least one scan".to_string()),
            Command::Scan { count } => self.resume(Some(*count)),
            Command::Pace { slower } if (1..=SLOWEST).contains(slower) => self.slower = *slower,
            Command::Pace { .. } => return Err(format!("the pace is from 1 to {SLOWEST}")),
            Command::Set { device, value } => {
                let target = running.device(device, &self.names)?;
                running.takes(target, *value)?;
                // It exists: that was looked at when it was named.
                let _ = running.session.set(target, *value);
                running.session.take_interrupts();
                self.log
                    .write(now_ms, "event", &format!("{target} set to {value}"));
            }
            Command::Force { device, value } => self.begin_force(device, *value, running)?,
            Command::Release { device } => {
                let target = running.device(device, &self.names)?;
                running.session.release(target)?;
                self.log
                    .write(now_ms, "event", &format!("{target} released"));
            }
            Command::ReleaseAll {} => {
                running.session.release_all();
                self.note(now_ms, "event", "all devices released");
            }
            Command::Watch { device } => {
                let target = running.device(device, &self.names)?;
                if !self.watched.contains(&target) {
                    check_count(self.watched.len(), MAX_WATCHED, "watched devices")?;
                    self.watched.push(target);
                }
            }
            Command::Unwatch { device } => {
                let target = running.device(device, &self.names)?;
                let index = self.watched.iter().position(|other| *other == target);
                let index = index.ok_or_else(|| format!("{target} is not watched"))?;
                self.watched.remove(index);
            }
            Command::BreakOnDevice { device, value } => {
                let target = running.device(device, &self.names)?;
                if let Some(value) = value {
                    fits(target, *value)?;
                }
                check_count(self.breaks.len(), MAX_BREAKS, "breakpoints")?;
                let now = running.session.reading(target);
                self.breaks.push(Break::Device(target, *value, now));
            }
            Command::BreakOnNetwork { network } => {
                let count = self.scene.networks();
                let index = network.checked_sub(1).filter(|index| *index < count);
                let index =
                    index.ok_or_else(|| format!("networks are numbered from 1 to {count}"))?;
                check_count(self.breaks.len(), MAX_BREAKS, "breakpoints")?;
                let is = self.scene.reaches(index, running.session.seen());
                self.breaks.push(Break::Network(index, is));
            }
            Command::Unbreak { index } if *index < self.breaks.len() => {
                self.breaks.remove(*index);
            }
            Command::Unbreak { .. } => return Err("there is no such breakpoint".to_string()),
        }
        Ok(None)
    }

    /// Forces a device from now on.
    fn begin_force(
        &mut self,
        device: &str,
        value: f64,
        running: &mut Running,
    ) -> Result<(), String> {
        let target = running.device(device, &self.names)?;
        running.takes(target, value)?;
        running.session.force(target, value)?;
        running.session.take_interrupts();
        self.log.write(
            running.session.now_ms(),
            "event",
            &format!("{target} forced to {value}"),
        );
        Ok(())
    }

    fn resume(&mut self, scans: Option<u32>) {
        self.paused = None;
        self.stopped_at = None;
        self.scans_left = scans;
    }

    /// Shows how things are, if someone watches and it is time.
    fn show(&mut self, running: &Running) {
        let is_fresh = self.shown.is_some_and(|shown| shown.elapsed() < EVERY);
        if is_fresh || !self.server.is_watched() {
            return;
        }
        self.shown = Some(Instant::now());
        let session = &*running.session;
        let seen = session.seen();
        let state = json!({
            "run": self.began,
            "ms": session.now_ms(),
            "scans": self.scans(),
            "back": running.back,
            "running": seen.machine.sys().running,
            "paused": self.paused,
            "network": self.stopped_at.map(|network| network + 1),
            "slower": self.slower,
        });
        let watched = self.watched.iter().map(|&target| {
            let reading = Reading::of(seen, target);
            let value = reading
                .as_ref()
                .map_or_else(String::new, ToString::to_string);
            let number = reading.as_ref().and_then(number);
            json!({ "device": super::name(target), "value": value, "number": number })
        });
        let forced = session.forced().iter();
        let forced =
            forced.map(|(target, value)| json!({ "device": super::name(target), "value": value }));
        let breaks = self.breaks.iter().map(|point| {
            let network = match point {
                Break::Network(network, _) => Some(network + 1),
                Break::Device(..) => None,
            };
            json!({ "text": point.text(), "network": network })
        });
        let parts = [
            ("state", state),
            ("watch", watched.collect()),
            ("forces", forced.collect()),
            ("breaks", breaks.collect()),
            ("axes", axes(seen)),
        ];
        let frame = Frame {
            networks: self.scene.look(seen),
            parts: parts
                .map(|(name, part)| (name, part.to_string().into()))
                .into(),
            log: self.log.clone(),
        };
        self.server.show(frame);
    }
}

/// Turns the switch to RUN or STOP, and reports it as a switch by a client is.
fn turn_switch(session: &mut Session, running: bool) {
    session.set_running(running);
    let state = if running { "RUN" } else { "STOP" };
    eprint_line(&format!("rungc: the page switches to {state}"));
}

/// The axes and processes of the machine that the PLC is wired to.
fn axes(seen: Seen) -> Value {
    let row = |name: &str, number: f64, unit: &str| {
        let value = format!("{number:.2} {unit}");
        json!({ "name": name, "value": value.trim_end(), "number": number })
    };
    let axes = seen.axes().iter();
    let axes = axes.map(|axis| row(axis.name(), axis.position(), axis.unit()));
    let processes = seen.processes().iter();
    let processes = processes.map(|process| row(process.name(), process.value(), process.unit()));
    axes.chain(processes).collect()
}

/// Value of a reading as a number.
fn number(reading: &Reading) -> Option<f64> {
    match reading {
        Reading::Bit(on) => Some(f64::from(u8::from(*on))),
        Reading::Integer(value, _) => Some(*value as f64),
        Reading::Float(value) => Some(*value),
        Reading::Text(_) => None,
    }
}

/// Checks that there is room for one more.
fn check_count(count: usize, most: usize, what: &str) -> Result<(), String> {
    match count < most {
        true => Ok(()),
        false => Err(format!("there are {most} {what} already")),
    }
}
