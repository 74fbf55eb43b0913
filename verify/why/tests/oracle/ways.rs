//! What a person is advised to do brings the device where it was to be, and none of it can be left out: the advice is
//! followed by its text alone.

use crate::subjects::{Subject, conformance, devices, examples, state, target};
use rungc_rt::VirtualHal;
use rungc_sim::record::Reading;
use rungc_sim::{Session, Target};
use rungc_syntax::{Device, DeviceClass};
use rungc_why::{Action, Explainer, How, HowOptions};

/// Effort of each search.
const EFFORT: usize = 2_000_000;
/// Duration of a scan.
const SCAN_MS: u64 = 10;
/// Scans for which an input that is switched on and off stays so.
const PULSE: u64 = 3;

/// Returns true if a device is on, or an output sends pulses.
fn is_active(session: &Session, device: Device) -> bool {
    let frequency = Target::Frequency(device.number);
    let sends = matches!(session.reading(frequency), Some(Reading::Float(hertz)) if hertz > 0.0);
    sends && device.class == DeviceClass::Y || state(session, device)
}

/// Executes scans until the device is in a state. Returns true if it was within this time.
fn scans(session: &mut Session, ms: u64, (device, on): (Device, bool)) -> bool {
    (0..ms.div_ceil(SCAN_MS)).any(|_| {
        session.scan(SCAN_MS);
        let after = is_active(session, device) == on;
        session.pass(SCAN_MS);
        after || is_active(session, device) == on
    })
}

fn set(session: &mut Session, name: &str, value: f64) {
    let name = Target::parse(name).unwrap();
    session.set(name, value).unwrap();
    session.take_interrupts();
}

/// Does what an action says. Returns true if the device is where it was to be.
fn act(session: &mut Session, action: &Action, wanted: (Device, bool)) -> bool {
    let Some(name) = &action.device else {
        return scans(session, action.takes_ms, wanted);
    };
    if let Some(times) = action.times {
        return (0..times).any(|_| {
            [1.0, 0.0].into_iter().any(|value| {
                set(session, name, value);
                scans(session, PULSE * SCAN_MS, wanted)
            })
        });
    }
    let value = match action.value.as_deref().unwrap() {
        "on" => 1.0,
        "off" => 0.0,
        number => number.parse().unwrap(),
    };
    set(session, name, value);
    scans(session, action.takes_ms, wanted)
}

/// Counts of what was tried.
#[derive(Default, Debug)]
struct Tried {
    searches: usize,
    found: usize,
    actions: usize,
    whole: usize,
}

fn follow(session: &mut Session, (how, device): (&How, Device), at: &str, wrong: &mut Vec<String>) {
    let moment = session.save();
    let mut follow = |left_out: Option<usize>| {
        let actions = how.actions.iter().enumerate();
        let mut actions = actions.filter(|(n, _)| Some(*n) != left_out);
        let reached = actions.any(|(_, action)| act(session, action, (device, how.on)));
        session.restore(&moment);
        reached
    };
    if !follow(None) {
        wrong.push(format!("{at}: this does not do it: {:?}", how.actions));
    }
    for n in 0..how.actions.len() {
        if follow(Some(n)) {
            wrong.push(format!(
                "{at}: action {} is not needed: {:?}",
                n + 1,
                how.actions
            ));
        }
    }
}

fn try_program(subject: &Subject, seed: u64, tried: &mut Tried, wrong: &mut Vec<String>) {
    let (inputs, explained) = devices(subject);
    if explained.is_empty() {
        return;
    }
    let mut rng = fastrand::Rng::with_seed(seed);
    let explainer = Explainer::new(&subject.program, &subject.module, &subject.marks);
    let mut session = Session::new(&subject.module, VirtualHal::new());
    for _ in 0..rng.usize(1..5) {
        if !inputs.is_empty() {
            let input = inputs[rng.usize(..inputs.len())];
            let _ = session.set(target(input), f64::from(u8::from(rng.bool())));
        }
        session.scan(SCAN_MS);
        session.pass(SCAN_MS * rng.u64(1..20));
    }
    let device = explained[rng.usize(..explained.len())];
    let options = HowOptions {
        scan_ms: Some(SCAN_MS),
        effort: EFFORT,
        ..HowOptions::default()
    };
    let how = explainer.how(&mut session, device, &options);
    let at = format!("{} {device} at {} ms", subject.name, session.now_ms());
    tried.searches += 1;
    tried.found += usize::from(how.found);
    tried.actions += how.actions.len();
    tried.whole += usize::from(how.is_whole);
    if how.found {
        follow(&mut session, (&how, device), &at, wrong);
    }
}

fn try_all(subjects: &[Subject], runs: u64) -> Tried {
    let mut tried = Tried::default();
    let mut wrong = Vec::new();
    for (number, subject) in (0..).zip(subjects) {
        for run in 0..runs {
            try_program(subject, 1000 + number * runs + run, &mut tried, &mut wrong);
        }
    }
    println!("{tried:?}");
    let count = wrong.len();
    wrong.truncate(20);
    assert!(wrong.is_empty(), "{count} wrong:\n{}", wrong.join("\n"));
    tried
}

#[test]
fn advice_for_the_examples_is_right() {
    let tried = try_all(&examples(), 3);
    assert!(tried.found >= 30 && tried.actions >= 40, "{tried:?}");
}

#[test]
fn advice_for_the_conformance_cases_is_right() {
    let tried = try_all(&conformance(), 1);
    assert!(tried.found >= 40 && tried.actions >= 50, "{tried:?}");
}
