//! Instructions because of which emitted C links the runtime library, which is built of Rust.

use rungc_codegen_c::runtime_calls;
use rungc_ir::Module;

/// Number of instructions that a note names.
const NAMED: usize = 3;

/// The note about them; `None` if a C compiler is all that it takes to build the program.
pub fn note(module: &Module) -> Option<String> {
    let reasons = reasons(module)?;
    Some(format!(
        "{} links the runtime library, which takes cargo to build (https://rustup.rs), because of {reasons}; \
         `rungc book embedding`",
        module.name
    ))
}

/// The instructions, or what else the library is needed for; `None` if it is not.
pub fn reasons(module: &Module) -> Option<String> {
    let calls = runtime_calls(module).into_iter();
    let calls: Vec<_> = calls.filter(|call| !call.in_c).collect();
    if calls.is_empty() {
        return None;
    }
    let mut steps: Vec<u32> = calls.iter().flat_map(|call| call.steps.clone()).collect();
    steps.sort_unstable();
    steps.dedup();
    let named = steps.iter().take(NAMED).filter_map(|step| {
        let text = &module.origin(*step)?.text;
        Some(format!("{text} (step {step})"))
    });
    let mut needs: Vec<String> = named.collect();
    let more = steps.len().saturating_sub(NAMED);
    if more > 0 {
        needs.push(format!("{more} more"));
    }
    // What the scan itself does comes from no instruction.
    if calls.iter().any(|call| call.name == "advance_ports") {
        needs.push("its serial ports".to_string());
    }
    if needs.is_empty() {
        needs.push("its special registers".to_string());
    }
    Some(needs.join(", "))
}
