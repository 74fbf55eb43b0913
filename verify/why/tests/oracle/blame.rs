//! What is blamed decides, and nothing else does: at random moments of random runs of the examples and of the
//! conformance cases, one scan with other devices than it began with.

use crate::subjects::{Subject, can_be_forced, conformance, devices, examples, state, target};
use rungc_ir::node::FunctionKind;
use rungc_rt::VirtualHal;
use rungc_sim::Session;
use rungc_syntax::Device;
use rungc_why::Explainer;

/// Number of scans of a run.
const SCANS: usize = 10;
/// Sets that are tried of each device.
const MOST_SETS: usize = 4;

/// Counts of what was tried.
#[derive(Default, Debug)]
struct Tried {
    programs: usize,
    moments: usize,
    sets: usize,
    others: usize,
}

/// State of a device after one scan that begins with other devices the opposite of what they are.
fn after(session: &mut Session, flipped: &[Device], device: Device) -> bool {
    let moment = session.save();
    for &other in flipped {
        let on = !state(session, other);
        session
            .force(target(other), f64::from(u8::from(on)))
            .unwrap();
    }
    let scan_ms = session.scan_ms(None);
    session.scan(scan_ms);
    let on = state(session, device);
    session.restore(&moment);
    on
}

fn try_program(subject: &Subject, seed: u64, tried: &mut Tried, wrong: &mut Vec<String>) {
    let interrupted = subject.module.functions.iter().any(|function| {
        matches!(
            function.kind,
            FunctionKind::InputEdge { .. } | FunctionKind::Interrupt(_)
        )
    });
    let (inputs, explained) = devices(subject);
    if interrupted || explained.is_empty() {
        return;
    }
    tried.programs += 1;
    let mut rng = fastrand::Rng::with_seed(seed);
    let explainer = Explainer::new(&subject.program, &subject.module, &subject.marks);
    let mut session = Session::new(&subject.module, VirtualHal::new());
    for _ in 0..SCANS {
        if !inputs.is_empty() {
            let input = inputs[rng.usize(..inputs.len())];
            let _ = session.set(target(input), f64::from(u8::from(rng.bool())));
        }
        let device = explained[rng.usize(..explained.len())];
        try_device((subject, &explainer), &mut session, device, (tried, wrong));
        session.scan(10);
        session.pass(10 * rng.u64(1..20));
    }
}

fn try_device(
    (subject, explainer): (&Subject, &Explainer),
    session: &mut Session,
    device: Device,
    (tried, wrong): (&mut Tried, &mut Vec<String>),
) {
    let roots = explainer.roots(session, None, device);
    let usual = after(session, &[], device);
    let at = format!("{} {device} at {} ms", subject.name, session.now_ms());
    tried.moments += 1;
    let has_cause = !roots.sets.is_empty() || !roots.others.is_empty();
    if has_cause && roots.on != usual {
        wrong.push(format!(
            "{at}: the scan leaves it {usual}, not {}",
            roots.on
        ));
        return;
    }
    let sets = roots.sets.iter();
    let sets = sets.filter(|set| set.iter().all(|device| can_be_forced(*device)));
    for set in sets.take(MOST_SETS) {
        tried.sets += 1;
        if after(session, set, device) == usual {
            wrong.push(format!("{at}: {set:?} is blamed and changes nothing"));
        }
    }
    let others = roots.others.iter().copied();
    let others: Vec<Device> = others.filter(|device| can_be_forced(*device)).collect();
    if roots.is_whole && !others.is_empty() {
        tried.others += 1;
        if after(session, &others, device) != usual {
            wrong.push(format!("{at}: {others:?} are not blamed and change it"));
        }
    }
}

fn try_all(subjects: &[Subject], runs: u64) -> Tried {
    let began = std::time::Instant::now();
    let mut tried = Tried::default();
    let mut wrong = Vec::new();
    for (number, subject) in (0..).zip(subjects) {
        for run in 0..runs {
            try_program(subject, number * runs + run, &mut tried, &mut wrong);
        }
    }
    println!("{tried:?} in {:?}", began.elapsed());
    let count = wrong.len();
    wrong.truncate(20);
    assert!(wrong.is_empty(), "{count} wrong:\n{}", wrong.join("\n"));
    tried
}

#[test]
fn what_is_blamed_decides_in_the_examples() {
    let tried = try_all(&examples(), 3);
    assert!(tried.sets >= 200 && tried.others >= 300, "{tried:?}");
}

#[test]
fn what_is_blamed_decides_in_the_conformance_cases() {
    let tried = try_all(&conformance(), 1);
    assert!(tried.sets >= 80 && tried.others >= 60, "{tried:?}");
}
