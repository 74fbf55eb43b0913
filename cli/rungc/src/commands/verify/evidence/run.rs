//! A run as evidence: what is set when, its timing diagram, and the power in the networks that it is about.

use super::Basis;
use rungc_analysis::resolve::{Resolved, resolve};
use rungc_analysis::xref::CrossReference;
use rungc_evidence::{Change, Network, Number, Run, Value};
use rungc_ir::Module;
use rungc_ladder::drawing::Drawing;
use rungc_ladder::{Ladder, build};
use rungc_live::Scene;
use rungc_sim::Target;
use rungc_sim::property::{self, Condition, Property};
use rungc_sim::record::plot::{CurveId, Diagram, Plot, Shape};
use rungc_sim::record::{Reading, Seen};
use rungc_syntax::{Device, DeviceClass};
use rungc_verify::replay::{self, Setting, story};
use rungc_verify::search::Trace;

/// Time that the last scan is shown, in milliseconds.
const LAST_MS: u64 = 10;

/// A run of the program; with pictures if it is for a report.
pub fn run(basis: &Basis, property: &Property, trace: &Trace) -> Run {
    let module = basis.module;
    let story = story(module, property, trace);
    let values = |settings: &[Setting]| settings.iter().map(|set| value(module, set)).collect();
    let mut changes = Vec::new();
    for change in &story {
        let mut set: Vec<Value> = values(&change.set);
        let buffers = change.buffers.iter();
        set.extend(buffers.map(|(unit, address, value)| Value {
            device: format!("U{unit}\\G{address}"),
            value: Number::Integer(*value),
            comment: None,
        }));
        changes.push(Change {
            scan: change.first + 1,
            scans: change.scans,
            at_ms: change.at_ms,
            restart: change.restart,
            scan_ms: change.scan_ms,
            set,
        });
    }
    let start = story.first().map_or(&[][..], |first| &first.start);
    let end = story.last().map_or(&[][..], |last| &last.after);
    let mut run = Run {
        scans: trace.scans.len(),
        ms: duration(trace),
        engines: basis.engines.to_vec(),
        start: values(start),
        changes,
        end: values(end),
        diagram: None,
        networks: Vec::new(),
    };
    if basis.args.report.is_some() {
        let (resolved, _) = resolve(&basis.read.program, module.model);
        let ladder = build::ladder(&resolved);
        let set = story.iter().flat_map(|change| &change.set);
        let named = start.iter().chain(set).map(|(name, ..)| name.as_str());
        let targets = targets(property, named);
        (run.diagram, run.networks) =
            pictures(module, trace, (property, &targets), (&resolved, &ladder));
    }
    run
}

/// Time from power-on to the last scan, in milliseconds.
fn duration(trace: &Trace) -> u64 {
    trace.scans.iter().map(|scan| u64::from(scan.ms)).sum()
}

fn value(module: &Module, (name, device, value): &Setting) -> Value {
    Value {
        device: name.clone(),
        value: match *value {
            property::Reading::Integer(value) => Number::Integer(value),
            property::Reading::Float(value) => Number::Float(value),
        },
        comment: comment(module, *device),
    }
}

fn comment(module: &Module, device: (DeviceClass, u32)) -> Option<String> {
    let mut comments = module.comments.iter();
    let found = comments.find(|(class, number, _)| (*class, *number) == device);
    found.map(|(_, _, comment)| comment.trim().to_string())
}

/// Devices to show: those that are set, then those that the property looks at; each once.
fn targets<'a>(property: &Property, set: impl Iterator<Item = &'a str>) -> Vec<Target> {
    let mut found: Vec<Target> = Vec::new();
    let mut add = |target: Target| {
        if !found.contains(&target) {
            found.push(target);
        }
    };
    for name in set {
        if let Ok(target) = Target::parse(name) {
            add(target);
        }
    }
    for condition in property.conditions() {
        condition.targets(&mut add);
    }
    found
}

/// The timing diagram, and the networks that write what a property looks at.
fn pictures(
    module: &Module,
    trace: &Trace,
    (property, targets): (&Property, &[Target]),
    (resolved, ladder): (&Resolved, &Ladder),
) -> (Option<Diagram>, Vec<Network>) {
    let (mut scene, _) = Scene::new(resolved, ladder);
    let mut run = replay::Run::new(module, trace);
    let mut timing = Timing::begin(module, targets, duration(trace) + LAST_MS, run.seen());
    let mut now_ms = 0;
    for scan in &trace.scans {
        now_ms += u64::from(scan.ms);
        // A run that was replayed does not stop.
        let _ = run.scan(scan);
        scene.scanned(run.seen());
        timing.sample(now_ms, run.seen());
    }
    timing.sample(now_ms + LAST_MS, run.seen());
    let conditions = property.conditions().into_iter();
    let devices: Vec<_> = conditions.flat_map(Condition::devices).collect();
    let networks = writing(resolved, ladder, &devices)
        .into_iter()
        .map(|index| {
            let network = &ladder.networks[index];
            let power = scene.power(index, run.seen());
            let instrs = &resolved.program.instrs[network.instrs.clone()];
            let list: Vec<String> = instrs.iter().map(ToString::to_string).collect();
            Network {
                number: index + 1,
                list: list.join("; "),
                drawing: Drawing::powered(
                    resolved,
                    (index + 1, network),
                    power,
                    crate::commands::view::PICTURE_WIDTH,
                ),
            }
        });
    let networks = networks.collect();
    (timing.diagram(), networks)
}

/// The networks that write one of these devices, or may, by their index.
fn writing(resolved: &Resolved, ladder: &Ladder, devices: &[(DeviceClass, u32)]) -> Vec<usize> {
    let uses = CrossReference::new(resolved).uses;
    let writes: Vec<usize> = uses
        .iter()
        .filter(|used| {
            let mut devices = devices.iter();
            devices.any(|&(class, number)| used.may_write(Device { class, number }))
        })
        .map(|used| used.instr)
        .collect();
    let networks = ladder.networks.iter().enumerate();
    let written = networks.filter(|(_, n)| writes.iter().any(|at| n.instrs.contains(at)));
    written.map(|(index, _)| index).collect()
}

/// A timing diagram in the making.
struct Timing {
    plot: Plot,
    curves: Vec<(CurveId, Target)>,
}

impl Timing {
    fn begin(module: &Module, targets: &[Target], duration_ms: u64, seen: Seen) -> Timing {
        let mut plot = Plot::new("", duration_ms);
        let mut curves = Vec::new();
        for &target in targets {
            let (class, number, _) = target.devices(0);
            let device = class.number(number).to_string();
            let name = match comment(module, (class, number)) {
                Some(comment) => format!("{device} {comment}"),
                None => device,
            };
            let curve = match Reading::of(seen, target) {
                Some(Reading::Bit(_)) => plot.lane(&name),
                Some(Reading::Integer(..) | Reading::Float(_)) => {
                    plot.curve(&name, &name, Shape::Step)
                }
                Some(Reading::Text(_)) | None => continue,
            };
            curves.push((curve, target));
        }
        Timing { plot, curves }
    }

    fn sample(&mut self, at_ms: u64, seen: Seen) {
        for &(curve, target) in &self.curves {
            let value = match Reading::of(seen, target) {
                Some(Reading::Bit(on)) => f64::from(u8::from(on)),
                Some(Reading::Integer(value, _)) => value as f64,
                Some(Reading::Float(value)) => value,
                Some(Reading::Text(_)) | None => continue,
            };
            self.plot.point(curve, at_ms, value);
        }
    }

    fn diagram(self) -> Option<Diagram> {
        (!self.plot.is_empty()).then(|| self.plot.diagram())
    }
}
