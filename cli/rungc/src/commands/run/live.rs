//! `rungc serve --page`: what the page shows of a run, and what it asks the run to do.

use crate::commands::names::Names;
use crate::commands::setting::fits;
use crate::commands::{Failure, eprint_line};
use rungc_analysis::resolve::resolve;
use rungc_host::servers::after;
use rungc_interp::Machine;
use rungc_ladder::build;
use rungc_live::{Command, Frame, Log, Order, Scene, Server, token};
use rungc_models::Model;
use rungc_rt::{Class, Plc, Program as _, VirtualHal};
use rungc_runtime_sources::cache;
use rungc_sim::Target;
use rungc_sim::plant::Plant;
use rungc_sim::record::{Reading, Seen};
use rungc_syntax::{DeviceClass, Program};
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
    /// The PLC.
    pub machine: &'a mut Machine<'m>,
    /// Its hardware.
    pub hal: &'a mut VirtualHal,
    /// The machine that it is wired to.
    pub plant: Option<&'a Plant>,
    /// The time.
    pub now_ms: u64,
    /// By how many scans it can go back.
    pub back: u64,
}

/// Progress of a run, and the state of the page.
#[derive(Clone)]
pub struct Control {
    /// Number of scans executed.
    pub scans: u64,
    forced: Vec<(Target, f64)>,
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
    fn seen(&self) -> Seen<'_> {
        Seen {
            machine: self.machine,
            hal: self.hal,
            plant: self.plant,
        }
    }

    /// The device of this name or comment, which exists.
    fn device(&self, name: &str, names: &Names) -> Result<Target, String> {
        let target = names.target(name)?;
        match Reading::of(self.seen(), target) {
            Some(_) => Ok(target),
            None => Err(format!(
                "`{target}` does not exist on {}",
                self.machine.module().model.title
            )),
        }
    }

    /// Checks that a device can be set to a value, which it keeps.
    fn takes(&self, target: Target, value: f64) -> Result<(), String> {
        fits(target, value)?;
        rungc_sim::check_lasts(self.machine.module().model, target, |relay| {
            self.machine.bit(Class::M, relay.number()) == Some(true)
        })
    }

    /// Sets a device; an input has an edge.
    fn set(&mut self, target: Target, value: f64) {
        let before = Reading::of(self.seen(), target);
        // It exists: that was looked at when it was named.
        let _ = rungc_sim::set(self.machine, self.hal, target, value);
        if let Target::Bit(DeviceClass::X, number) = target
            && before != Some(Reading::Bit(value != 0.0))
        {
            self.machine.input_edge(self.hal, number, value != 0.0);
            self.machine.take_interrupts(self.hal);
        }
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
                forced: Vec::new(),
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

    /// Gives forced devices their values, as before and after each scan.
    pub fn force(&self, machine: &mut Machine, hal: &mut VirtualHal) {
        for &(target, value) in &self.control.forced {
            // It exists: that was looked at when it was forced.
            let _ = rungc_sim::set(machine, hal, target, value);
        }
    }

    /// Takes notice of a scan.
    pub fn scanned(&mut self, running: Running) {
        self.force(running.machine, running.hal);
        self.control.scans += 1;
        let is_running = running.machine.sys().running;
        let changed = std::mem::replace(&mut self.control.was_running, is_running) != is_running;
        self.scene.scanned(running.seen());
        if self.again {
            return;
        }
        if changed {
            let mode = if is_running { "RUN" } else { "STOP" };
            self.note(running.now_ms, "event", mode);
        }
        if let Some(left) = &mut self.scans_left {
            *left -= 1;
            if *left == 0 {
                self.pause("after single scans".to_string());
            }
        }
        if let Some((why, network)) = self.broken(running.seen()) {
            self.log
                .write(running.now_ms, "event", &format!("breakpoint: {why}"));
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

    /// Progress of the run, and the forced values.
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
        self.broken(running.seen());
        let scan = format!("back at scan {}", self.scans());
        self.note(running.now_ms, "event", &scan);
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
        let now_ms = running.now_ms;
        match command {
            Command::Run {} => turn_switch(running.machine, true),
            Command::Stop {} => turn_switch(running.machine, false),
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
                running.set(target, *value);
                self.log
                    .write(now_ms, "event", &format!("{target} set to {value}"));
            }
            Command::Force { device, value } => self.begin_force(device, *value, running)?,
            Command::Release { device } => {
                let target = running.device(device, &self.names)?;
                let forced = &mut self.control.forced;
                let index = forced.iter().position(|(other, _)| *other == target);
                forced.remove(index.ok_or_else(|| format!("{target} is not forced"))?);
                self.log
                    .write(now_ms, "event", &format!("{target} released"));
            }
            Command::ReleaseAll {} => {
                self.control.forced.clear();
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
                let now = Reading::of(running.seen(), target);
                self.breaks.push(Break::Device(target, *value, now));
            }
            Command::BreakOnNetwork { network } => {
                let count = self.scene.networks();
                let index = network.checked_sub(1).filter(|index| *index < count);
                let index =
                    index.ok_or_else(|| format!("networks are numbered from 1 to {count}"))?;
                check_count(self.breaks.len(), MAX_BREAKS, "breakpoints")?;
                let is = self.scene.reaches(index, running.seen());
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
        let mut forced = self.control.forced.iter().map(|(other, _)| *other);
        if let Some(other) = forced.find(|other| overlap(*other, target)) {
            return Err(format!("release {other} first, which is forced"));
        }
        running.set(target, value);
        self.control.forced.retain(|(other, _)| *other != target);
        self.control.forced.push((target, value));
        self.log.write(
            running.now_ms,
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
        let seen = running.seen();
        let state = json!({
            "run": self.began,
            "ms": running.now_ms,
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
        let forced = self.control.forced.iter();
        let forced =
            forced.map(|(target, value)| json!({ "device": super::name(*target), "value": value }));
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
fn turn_switch(machine: &mut Machine, running: bool) {
    machine.set_running(running);
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

/// Returns true if two names, which are not the same, have a device in common.
fn overlap(one: Target, other: Target) -> bool {
    let [
        (class, first, count),
        (other_class, other_first, other_count),
    ] = [one, other].map(|target| target.devices(0));
    one != other
        && class == other_class
        && first < other_first + other_count
        && other_first < first + count
}

/// Checks that there is room for one more.
fn check_count(count: usize, most: usize, what: &str) -> Result<(), String> {
    match count < most {
        true => Ok(()),
        false => Err(format!("there are {most} {what} already")),
    }
}
