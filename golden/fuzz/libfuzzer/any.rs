//! Runs the target that `RUNGC_FUZZ` names.
#![no_main]

use libfuzzer_sys::fuzz_target;
use rungc_fuzz::targets::{Target, find};

thread_local! {
    static TARGET: Target = {
        let name = std::env::var("RUNGC_FUZZ").expect("RUNGC_FUZZ names a target");
        find(&name).expect("RUNGC_FUZZ names a target")
    };
}

fuzz_target!(|input: &[u8]| TARGET.with(|target| (target.run)(input)));
