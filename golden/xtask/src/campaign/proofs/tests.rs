use super::attack::search;
use super::draw::Written;
use super::run::{Goal, replay};
use super::table::{Counts, Results};
use super::{Extent, QUESTION, all, files, judge, minimise, outside, planted};
use rungc_golden::rng::Rng;
use rungc_models::ModelId;
use rungc_sim::property::{Property, parse};
use rungc_verify::model::Encoder;
use rungc_verify::prove::{Options, system};
use rungc_verify::steered::Run;

fn written(text: &str) -> Written {
    Written {
        model: ModelId::Fx3u,
        text: text.to_string(),
        latched: Vec::new(),
    }
}

fn options() -> Options {
    Options {
        effort: QUESTION,
        ..Options::default()
    }
}

fn never(condition: &str) -> Property {
    Property::Never(parse(condition, &|_| Vec::new()).unwrap())
}

/// A run that the attack finds against a property.
fn found(text: &str, property: &Property) -> Option<Run> {
    let options = options();
    let module = written(text).module(&options, &[property]).unwrap();
    let encoder = Encoder::scan(&module, options.world.clone());
    let outside = outside(&[&module], &[&encoder], &options, &[0, 1, 2]);
    let goal = Goal::Event(property);
    let run = search(&[&module], goal, &[], &outside, (1, 2000)).run?;
    let run = minimise::shorter(&[&module], goal, &[], run);
    assert_eq!(replay(&[&module], goal, &[], &run), Some(run.steps.len()));
    Some(run)
}

/// A latched timer begins near the end of its range: what it shows is not the time since its last whole unit.
#[test]
fn files_agree_where_a_latched_timer_begins_late() {
    let extent = Extent {
        seed: 3_003_687,
        programs: 1,
        jobs: 1,
        time: None,
        others: false,
    };
    let results = all(extent);
    assert!(results.wrong.is_empty(), "{}", results.wrong.join("\n\n"));
    let asked: u64 = results.counts.iter().map(|counts| counts.asked).sum();
    assert!(asked > 0, "{}", results.text());
}

/// A slice of a campaign.
#[test]
fn answers_about_random_programs_withstand_attacks() {
    let extent = Extent {
        seed: 1,
        programs: 5,
        jobs: 1,
        time: None,
        others: false,
    };
    let results = all(extent);
    assert!(results.wrong.is_empty(), "{}", results.wrong.join("\n\n"));
    assert_eq!(results.programs + results.rejected, extent.programs);
    let sum = |of: fn(&Counts) -> u64| results.counts.iter().map(of).sum::<u64>();
    assert!(sum(|counts| counts.asked) > 5, "{}", results.text());
}

#[test]
fn planted_violations_are_found() {
    let mut rng = Rng::new(7);
    let options = options();
    let (mut programs, mut hits) = (0, 0);
    for seed in 0..18 {
        let planted = planted::plant(&written("END\n"), &mut rng).unwrap();
        let module = planted.written.module(&options, &[&planted.property]);
        let module = module.unwrap_or_else(|| panic!("{}", planted.written.text));
        assert!(planted.is_reachable(&module), "{}", planted.written.text);
        let encoder = Encoder::scan(&module, options.world.clone());
        let outside = outside(&[&module], &[&encoder], &options, &[0, 1]);
        let goal = Goal::Event(&planted.property);
        programs += 1;
        let found = search(&[&module], goal, &[], &outside, (seed, 2000));
        hits += u32::from(found.run.is_some());
    }
    assert!(hits * 10 >= programs * 8, "{hits} of {programs}");
}

#[test]
fn attacks_find_what_happens_and_nothing_else() {
    let count = "LDP X000\nINC D0\nLD> D0 K6\nMOV K0 D0\nLD= D0 K6\nAND X001\nOUT Y000\nEND\n";
    let run = found(count, &never("Y000")).unwrap();
    assert!(run.steps.len() <= 13, "{run}");
    let timer = "LD X000\nOUT T0 K40\nLD T0\nANI X001\nOUT Y001\nEND\n";
    assert!(found(timer, &never("Y001 & !X001")).is_some());
    assert!(found(timer, &never("Y001 & X001")).is_none());
}

#[test]
fn files_that_say_something_else_are_noticed() {
    let property = never("Y000 & Y001");
    let text = "LD X000\nOUT T0 K3\nLD T0\nOUT Y000\nLD X001\nOUT C0 K2\nLD C0\nOUT Y001\nEND\n";
    let options = options();
    let module = written(text).module(&options, &[&property]).unwrap();
    let (_, system) = system(&module, &property, &options);
    let run = found(text, &property).unwrap();
    let goal = Goal::Event(&property);
    let scans = run.steps.len() as u64;
    assert!(files::is_exact(&system));
    assert_eq!(
        files::evaluate(&system, &module, goal, &[], &run),
        Ok(scans)
    );
    let is_noticed = |number: usize| {
        let mut other = system.clone();
        other.latches[number].next = !other.latches[number].next;
        files::evaluate(&other, &module, goal, &[], &run).is_err()
    };
    assert!((0..system.latches.len()).any(is_noticed));
}

#[test]
fn a_wrong_answer_and_a_blind_attack_are_errors() {
    let mut results = Results::default();
    assert!(judge(&results).is_ok());
    results.planted[0] = (10, 7);
    assert!(judge(&results).is_err());
    results.planted[0] = (10, 8);
    assert!(judge(&results).is_ok());
    results.wrong.push("this".to_string());
    assert!(judge(&results).is_err());
    assert_eq!(results.text().lines().count(), 22);
}
