//! Every target on its corpus, and for a short random campaign. `RUNGC_FUZZ_SECONDS` makes the campaign of each target
//! that long.

use rungc_fuzz::random::Random;
use rungc_fuzz::targets::{Target, all};
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::time::{Duration, Instant};

/// The campaign of each target without the variable.
const SHORT: Duration = Duration::from_millis(200);

/// Runs a target; if it panics, the input is shown.
fn run(target: &Target, input: &[u8]) {
    let outcome = catch_unwind(AssertUnwindSafe(|| (target.run)(input)));
    assert!(
        outcome.is_ok(),
        "{} fails on b\"{}\"",
        target.name,
        input.escape_ascii()
    );
}

/// Its corpus and its seeds.
fn inputs(target: &Target) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("corpus")
        .join(target.name);
    let entries = fs::read_dir(folder).into_iter().flatten();
    let mut paths: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let corpus = paths.into_iter().map(|path| fs::read(path).unwrap());
    corpus.chain(target.seeds.iter().cloned()).collect()
}

#[test]
fn every_target_survives_its_corpus_and_random_damage() {
    let seconds = std::env::var("RUNGC_FUZZ_SECONDS")
        .ok()
        .and_then(|text| text.parse().ok());
    let time = seconds.map_or(SHORT, Duration::from_secs);
    let mut random = Random::new(seconds.unwrap_or_default());
    for target in &all() {
        let inputs = inputs(target);
        assert!(
            !inputs.is_empty(),
            "{} has neither corpus nor seeds",
            target.name
        );
        inputs.iter().for_each(|input| run(target, input));
        let begin = Instant::now();
        let mut runs = 0;
        // At least some, however slow the machine is.
        while begin.elapsed() < time || runs < 20 {
            let chosen = random.below(inputs.len());
            let mut input = random.damage(&inputs[chosen]);
            if random.below(4) == 0 {
                input.extend_from_slice(&inputs[random.below(inputs.len())]);
            }
            run(target, &input);
            runs += 1;
        }
        println!("{}: {runs} random inputs", target.name);
    }
}

#[test]
fn every_corpus_belongs_to_a_target() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus");
    let targets = all();
    for entry in fs::read_dir(folder).unwrap() {
        let name = entry.unwrap().file_name();
        assert!(
            targets.iter().any(|target| *target.name == *name),
            "{name:?}"
        );
    }
}
