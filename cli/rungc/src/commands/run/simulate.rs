//! The run itself: scans in virtual time, what happens between them, and what is shown and recorded.

mod passing;

use super::connecting::Connecting;
use super::errors::Errors;
use super::history::{History, Moment};
use super::lines::Lines;
use super::live::{Due, Live, Running};
use super::mode::Mode;
use super::pace::{self, Pace};
use super::plotting::Plotting;
use super::recorder::Recorder;
use super::recording::Recording;
use super::retaining::{RetainStorage, Retaining};
use super::scope::Scope;
use super::serving::{NetworkRequests, Servers};
use super::table::Table;
use super::view::{Column, Kind, View};
use super::watch::Watch;
use super::{Setting, setting};
use crate::args::RunArgs;
use crate::commands::{Failure, Outcome, Result, eprint_line, interruption, print_text};
use rungc_host::io::Connection;
use rungc_host::wall::WallClock;
use rungc_interp::MOST_RESTARTS;
use rungc_ir::Module;
use rungc_rt::{Program, VirtualHal};
use rungc_sim::plant::Plant;
use rungc_sim::record::{Reading, Seen};
use rungc_sim::session::{USUAL_SCAN_MS, hardware};
use rungc_sim::{Session, Target};
use rungc_syntax::{DeviceClass, FittedModule};
use std::iter::Peekable;
use std::slice::Iter;
use std::time::{Duration, Instant};

/// A program that runs.
struct Simulation<'a> {
    session: Session<'a>,
    /// Time source of the real-time clock in a run that keeps step with it.
    wall: Option<WallClock>,
    pending: Peekable<Iter<'a, Setting>>,
    shown: &'a [Target],
    view: View,
    out: Table,
    recording: Option<Recording>,
    recorder: Option<Recorder>,
    plotting: Option<Plotting>,
    scope: Option<Scope>,
    retaining: Option<Retaining>,
    errors: Errors<'a>,
    servers: Servers,
    requests: NetworkRequests,
    lines: Lines,
    connecting: Connecting,
    pace: Pace,
    mode: Mode,
    watch: Watch,
    live: Option<Live>,
    history: History<'a>,
    /// True if the run writes nothing that would have to be undone.
    can_go_back: bool,
    /// True if there may be input from outside before each scan, other than by clients of servers.
    has_external_input: bool,
    /// A scan has taken longer than the constant scan time.
    overrun: bool,
}

/// Options of a run.
pub struct Run<'a> {
    /// The command line.
    pub args: &'a RunArgs,
    /// Storage of latched devices from run to run.
    pub retain: Option<RetainStorage>,
    /// The program.
    pub module: &'a Module,
    /// True if operation errors are reported as they occur.
    pub errors_at_once: bool,
    /// Settings in the order of their times.
    pub settings: &'a [Setting],
    /// Targets in the table.
    pub shown: &'a [Target],
    /// Targets of `--watch`.
    pub watched: &'a [Target],
    /// Quantity on the diagram's horizontal axis, if not time.
    pub over: Option<Target>,
    /// True if there is a table.
    pub table: bool,
    /// The special modules that are fitted.
    pub modules: &'a [FittedModule],
    /// Program memory for the programming port.
    pub program_memory: Option<&'a [u8]>,
    /// Connections of terminals and registers.
    pub connections: Vec<Connection>,
}

impl Run<'_> {
    /// Runs the program, wired to a machine, shown on a page, and written down as a test.
    pub fn simulate(
        &self,
        plant: Option<Plant>,
        live: Option<Live>,
        recorder: Option<Recorder>,
    ) -> Result {
        let Run { args, module, .. } = *self;
        let (hal, wall) = self.hardware();
        let mut session = Session::new(module, hal);
        session
            .machine_mut()
            .set_program_memory(self.program_memory);
        // Missing devices are reported before anything is shown or written.
        let set = self.settings.iter().map(|s| s.target);
        let named = set.chain(self.shown.iter().copied()).chain(self.over);
        look_for_all(named, session.seen(), module)?;
        let retaining = self.retain.as_ref();
        let retaining = retaining.map(|kept| Retaining::begin(kept, session.machine_mut()));
        let retaining = retaining.transpose()?;
        let seen = Seen {
            plant: plant.as_ref(),
            ..session.seen()
        };
        let recording = match &args.vcd {
            Some(path) => Some(Recording::begin((path, args.force), seen, self.shown)?),
            None => None,
        };
        let scope = match &args.scope {
            Some(path) => Some(Scope::begin(path, args.force, session.machine())?),
            None => None,
        };
        let plotting = self.plotting(seen)?;
        let mut watch = Watch::new(
            module.model,
            (args.serve.trace_frames.as_deref(), args.force),
        )?;
        if live.is_some() {
            watch.record();
        }
        let mut simulation = Simulation {
            session,
            wall,
            pending: self.settings.iter().peekable(),
            shown: self.shown,
            view: self.view(),
            out: Table::new(!self.table, self.has_other_results(), args.serve.any()),
            recording,
            recorder,
            plotting,
            scope,
            retaining,
            errors: Errors::new(module, self.errors_at_once),
            servers: Servers::open(&args.serve, module.model, &mut watch)?,
            requests: NetworkRequests::new(module, args.in_real_time(), &mut watch),
            lines: Lines::open(&args.serve, module.model, &mut watch)?,
            connecting: Connecting::start(self.connections.clone())?,
            pace: Pace::new(),
            mode: Mode::listen(args.in_real_time()),
            watch,
            live,
            history: History::default(),
            can_go_back: args.vcd.is_none() && args.plot.is_none() && args.scope.is_none(),
            has_external_input: self.has_external_input(),
            overrun: false,
        };
        interruption::note();
        if let Some(priority) = args.serve.priority {
            pace::raise(priority)?;
        }
        match simulation.run(args, plant) {
            // What the run has found so far.
            Err(Failure::BrokenPipe) => Ok(simulation.outcome(args)),
            outcome => simulation.end(args, outcome?),
        }
    }

    /// Returns true if the run has results beside its table: files, and faults that it may find.
    fn has_other_results(&self) -> bool {
        let args = self.args;
        let files = [&args.vcd, &args.plot, &args.scope, &args.record];
        files.iter().any(|file| file.is_some()) || args.machine.is_some() || args.deny_errors
    }

    /// The view of the table.
    fn view(&self) -> View {
        let columns = self.shown.iter().map(|&target| column(target));
        View::new(columns.collect(), self.args.end_ms().is_some())
    }

    /// The hardware, and what its real-time clock follows in a run that keeps step with it.
    fn hardware(&self) -> (VirtualHal, Option<WallClock>) {
        let mut hal = hardware(self.modules);
        let in_real_time = self.args.in_real_time();
        let wall = in_real_time.then(|| WallClock::begin(&mut hal));
        (hal, wall)
    }

    /// The diagram that is drawn of the run.
    fn plotting(&self, seen: Seen<'_>) -> std::result::Result<Option<Plotting>, Failure> {
        let Some(path) = &self.args.plot else {
            return Ok(None);
        };
        let duration = self.args.end_ms().ok_or_else(|| {
            let message = "--plot: state with --for how long the run takes";
            Failure::Because(message.to_string())
        })?;
        let what = (self.watched, self.over);
        Plotting::begin((path, self.args.force), seen, what, duration).map(Some)
    }

    /// Returns true if there may be input from outside before each scan, other than by clients of servers.
    fn has_external_input(&self) -> bool {
        let lines = self.args.serve.lines(self.module.model);
        !(self.connections.is_empty() && self.module.requests.is_empty() && lines.is_empty())
    }
}

impl<'a> Simulation<'a> {
    /// Reports what has happened, and completes the files; a run that is denied errors fails by them.
    fn end(mut self, args: &RunArgs, outcome: Outcome) -> Result {
        let now_ms = self.session.now_ms();
        self.lines.end(now_ms, &mut self.watch);
        let connected = std::mem::take(&mut self.connecting);
        if connected.any() || args.serve.priority.is_some() {
            let summary = self.pace.summary();
            summary
                .iter()
                .for_each(|text| eprint_line(&format!("rungc: {text}")));
        }
        connected.end();
        let retaining = self.retaining.take();
        let is_kept = retaining.is_none_or(|retaining| retaining.end(self.session.machine()));
        let table = self.watch.table();
        let printed = match table.is_empty() {
            true => Ok(()),
            false => print_text(&format!("\n{}\n", table.join("\n"))),
        };
        let denied = self.is_denied(args);
        let machine = self.session.machine();
        self.errors.summarise(machine.errors());
        let cut_short = machine.watchdog_tripped() || interruption::is_requested();
        let end_ms = match args.end_ms() {
            Some(end_ms) if !cut_short => end_ms,
            _ => now_ms,
        };
        if let Some(recording) = self.recording {
            recording.keep(1000 * end_ms)?;
        }
        if let Some(recorder) = self.recorder {
            recorder.keep(args.scan.unwrap_or(USUAL_SCAN_MS), args.force)?;
        }
        if let Some(plotting) = self.plotting {
            plotting.keep()?;
        }
        if let Some(scope) = self.scope {
            scope.keep(self.session.machine())?;
        }
        if denied || !is_kept {
            return Ok(Outcome::Failed);
        }
        printed?;
        Ok(outcome)
    }

    fn run(&mut self, args: &RunArgs, plant: Option<Plant>) -> Result {
        self.out.line(&self.view.heading())?;
        let mut begin = Instant::now();
        self.apply_settings()?;
        if let Some(plant) = plant {
            self.session.connect(plant)?;
        }
        let end_ms = args.end_ms().unwrap_or(u64::MAX);
        loop {
            self.answer_clients();
            let (machine, hal) = self.session.parts();
            self.connecting.take(machine, hal);
            self.turn_switch();
            let now_ms = self.session.now_ms();
            self.requests
                .poll(self.session.machine_mut(), &mut self.watch, 1000 * now_ms);
            self.remember();
            let mut scan_ms = self.scan(args.scan)?;
            self.connecting.give(self.session.machine_mut());
            self.note_events();
            let machine = self.session.machine();
            if machine.watchdog_tripped() {
                let message = self.errors.watchdog(now_ms, machine.last_error());
                let endless = match machine.is_endless() {
                    true => {
                        format!(" (WDT restarted the watchdog {MOST_RESTARTS} times in this scan)")
                    }
                    false => String::new(),
                };
                eprint_line(&format!("rungc: {message}{endless}"));
                self.pass_last(scan_ms)?;
                return Ok(Outcome::Failed);
            }
            if interruption::is_requested() {
                eprint_line(&format!("rungc: interrupted at {now_ms} ms"));
                self.pass_last(scan_ms)?;
                return Ok(Outcome::Interrupted);
            }
            if now_ms.saturating_add(scan_ms) > end_ms {
                self.pass_last(scan_ms)?;
                break;
            }
            if args.in_real_time() {
                if let Some(retaining) = &mut self.retaining {
                    retaining.poll(self.session.machine_mut(), now_ms);
                }
                (begin, scan_ms) = self.rest(begin, scan_ms, args.scan)?;
                let now_ms = self.session.now_ms();
                let (_, hal) = self.session.parts();
                self.lines.receive(hal, begin, now_ms, &mut self.watch);
            }
            self.pass(scan_ms)?;
            let now_ms = self.session.now_ms();
            let (machine, hal) = self.session.parts();
            if let Some(wall) = &mut self.wall {
                wall.follow(hal, now_ms);
            }
            self.lines.send(hal, machine, now_ms, &mut self.watch);
        }
        self.out
            .line(format!("\n{}", self.view.diagram(end_ms)).trim_end_matches('\n'))?;
        setting::report_late(self.pending.by_ref());
        Ok(self.outcome(args))
    }

    /// Goes to RUN or STOP if a signal has requested it.
    fn turn_switch(&mut self) {
        if let Some(running) = self.mode.requested() {
            self.session.set_running(running);
            self.history.disturb();
            let mode = if running { "RUN" } else { "STOP" };
            eprint_line(&format!("rungc: {mode} at {} ms", self.session.now_ms()));
        }
    }

    /// Outcome of the run so far.
    fn outcome(&self, args: &RunArgs) -> Outcome {
        match self.session.plant().and_then(Plant::collision) {
            None if !self.is_denied(args) => Outcome::Success,
            _ => Outcome::Failed,
        }
    }

    /// Returns true if there were operation errors, of which `--deny-errors` allows none.
    fn is_denied(&self, args: &RunArgs) -> bool {
        args.deny_errors && !self.session.machine().errors().is_empty()
    }

    /// Reports new operation errors, and shows them and frames on the page.
    fn note_events(&mut self) {
        let errors = self.errors.notice(self.session.machine().errors());
        let frames = self.watch.take_recorded();
        if let Some(live) = &mut self.live {
            let errors = errors.iter().map(|text| ("error", text));
            let frames = frames.iter().map(|text| ("frame", text));
            for (kind, text) in errors.chain(frames) {
                live.note(self.session.now_ms(), kind, text);
            }
        }
    }

    /// Carries out and answers the requests of clients of servers.
    fn answer_clients(&mut self) {
        let at_us = 1000 * self.session.now_ms();
        let machine = self.session.machine_mut();
        if self.servers.poll(machine, &mut self.watch, at_us) {
            self.history.disturb();
        }
    }

    /// The run as the page sees it.
    fn running(&mut self) -> Option<(&mut Live, Running<'_, 'a>)> {
        let live = self.live.as_mut()?;
        let back = match self.can_go_back {
            true => self.history.reach(live.scans()),
            false => 0,
        };
        let running = Running {
            session: &mut self.session,
            back,
        };
        Some((live, running))
    }

    /// Waits for the next scan in a run that began then, if one takes `given_ms`. When it began, and how long the last
    /// scan takes, which is another one if the run went back; if time stood still or passed slower, it began later.
    fn rest(
        &mut self,
        begin: Instant,
        mut scan_ms: u64,
        given_ms: Option<u64>,
    ) -> std::result::Result<(Instant, u64), Failure> {
        loop {
            let next = Duration::from_millis(self.session.now_ms() + scan_ms);
            let Some((live, running)) = self.running() else {
                return Ok((self.pace.wait(begin, next), scan_ms));
            };
            let due = live.obey(running, begin + next, scan_ms);
            if live.has_disturbed() {
                self.history.disturb();
            }
            match due {
                Due::Back(count, order) => match self.go_back(count, given_ms)? {
                    Ok(ms) => {
                        scan_ms = ms;
                        order.answer(Ok(()));
                    }
                    Err(why) => order.answer(Err(why)),
                },
                Due::NotYet if !interruption::is_requested() => {
                    self.answer_clients();
                    self.note_events();
                }
                Due::Now | Due::NotYet => {
                    let shifted = self.live.as_mut().is_some_and(Live::has_shifted);
                    let begin = match shifted {
                        true => {
                            let wall = self.wall.iter_mut();
                            wall.for_each(|wall| wall.stay(next.as_millis() as u64));
                            Instant::now().checked_sub(next).unwrap_or(begin)
                        }
                        false => begin,
                    };
                    return Ok((begin, scan_ms));
                }
            }
        }
    }

    /// Keeps the moment before a scan, if the run is to come back to it.
    fn remember(&mut self) {
        let Some(live) = self.live.as_ref().filter(|_| self.can_go_back) else {
            return;
        };
        if self.has_external_input || self.history.is_due(live.scans()) {
            let moment = Moment {
                session: self.session.save(),
                pending: self.pending.clone(),
                control: live.control(),
            };
            self.history.keep(live.scans(), moment);
        }
    }

    /// Goes back by some scans: how many milliseconds the scan that was last then takes, or why that cannot be.
    fn go_back(
        &mut self,
        count: u32,
        given_ms: Option<u64>,
    ) -> std::result::Result<std::result::Result<u64, String>, Failure> {
        let scans = self.live.as_ref().map_or(0, Live::scans);
        if !self.can_go_back {
            let why = "a run with --vcd, --plot or --scope does not go back";
            return Ok(Err(why.to_string()));
        }
        let reach = self.history.reach(scans);
        if u64::from(count) > reach {
            return Ok(Err(format!("the run can go back by {reach} scans")));
        }
        let scan = scans - u64::from(count);
        let Some((scans, moment)) = self.history.before(scan) else {
            return Ok(Err("the run cannot go back".to_string()));
        };
        self.session.restore(&moment.session);
        self.pending = moment.pending;
        let Some(live) = &mut self.live else {
            return Ok(Err("the run has no page".to_string()));
        };
        let mut left = scan - scans;
        live.begin_again(moment.control);
        let muted = std::mem::replace(&mut self.out.muted, true);
        let scan_ms = loop {
            let scan_ms = self.scan(given_ms)?;
            left -= 1;
            if left == 0 {
                break scan_ms;
            }
            self.pass(scan_ms)?;
        };
        self.out.muted = muted;
        if let Some((live, running)) = self.running() {
            live.is_back(&running);
        }
        Ok(Ok(scan_ms))
    }

    /// A scan; how many milliseconds it lasts, if one takes `given_ms`.
    fn scan(&mut self, given_ms: Option<u64>) -> std::result::Result<u64, Failure> {
        if let Some(recorder) = &mut self.recorder {
            recorder.scan_begins();
        }
        self.session.scan(self.session.scan_ms(given_ms));
        if let Some((live, running)) = self.running() {
            live.scanned(running);
        }
        let values = self
            .shown
            .iter()
            .map(|&target| self.read(target))
            .collect::<std::result::Result<Vec<_>, _>>()?;
        let now_ms = self.session.now_ms();
        if let Some(row) = self.view.scan(now_ms, &values) {
            self.out.line(&row)?;
        }
        self.record()?;
        let scan_ms = self.session.scan_ms(given_ms);
        match self.session.machine().constant_scan_ms() {
            Some(constant_ms) if u64::from(constant_ms) < scan_ms && !self.overrun => {
                self.overrun = true;
                eprint_line(&format!(
                    "rungc: at {now_ms} ms: a scan takes {scan_ms} ms, longer than the constant scan time of {constant_ms} ms"
                ));
            }
            _ => {}
        }
        Ok(scan_ms)
    }

    fn read(&self, target: Target) -> std::result::Result<String, Failure> {
        let reading = self.session.reading(target);
        reading
            .map(|reading| reading.to_string())
            .ok_or_else(|| missing(target, self.session.machine().module()))
    }

    fn record(&mut self) -> std::result::Result<(), Failure> {
        let (seen, now_ms) = (self.session.seen(), self.session.now_ms());
        if let Some(scope) = &mut self.scope {
            scope.sample(seen.machine);
        }
        if let Some(plotting) = &mut self.plotting {
            plotting.sample(now_ms, seen);
        }
        match &mut self.recording {
            Some(recording) => recording.sample(1000 * now_ms, seen),
            None => Ok(()),
        }
    }
}

fn column(target: Target) -> Column {
    let kind = match target {
        Target::Bit(..) => Kind::Bit,
        Target::Current(DeviceClass::T, _) => Kind::Running,
        _ => Kind::Number,
    };
    Column {
        name: super::name(target),
        kind,
    }
}

/// Reports the first device that the model or its hardware does not have.
pub fn look_for_all(
    targets: impl IntoIterator<Item = Target>,
    seen: Seen<'_>,
    module: &Module,
) -> std::result::Result<(), Failure> {
    for target in targets {
        Reading::of(seen, target).ok_or_else(|| missing(target, module))?;
    }
    Ok(())
}

fn missing(target: Target, module: &Module) -> Failure {
    let model = module.model.title;
    if let Target::Channel(channel) = target {
        return Failure::Because(format!(
            "`{channel}` does not exist: list the module with this channel as `[[module]]` in rungc.toml"
        ));
    }
    Failure::Because(format!("`{target}` does not exist on {model}"))
}
