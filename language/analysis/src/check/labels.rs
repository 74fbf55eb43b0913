//! Jumps and calls: their labels exist once, and lead where they may.

use super::pointers::{Pointer, Pointers};
use super::structure::{NONE, Nesting, Routine};
use super::{Basic, Code};
use rungc_syntax::{
    Device, DeviceClass, Diagnostics, Fix, Operand, OperandKind, Span, codes, phrase,
};
use rustc_hash::FxHashMap;

/// Checks all pointers of a program.
pub(super) fn check(code: &Code, pointers: &Pointers, nesting: &Nesting, out: &mut Diagnostics) {
    // That the model does not have a pointer is reported where it is named.
    let has = |device: &Device| code.model().has(device.class, device.number);
    for (device, pointer) in pointers.iter().filter(|(device, _)| has(device)) {
        defined_once(code, device, pointer, out);
        if device.class != DeviceClass::P {
            if pointer.labels.is_empty() {
                no_routine(code, device, pointer, out);
            }
            continue;
        }
        if code.model().end_pointer == Some(device.number) {
            end_pointer(code, pointer, out);
            continue;
        }
        used_one_way(code, device, pointer, out);
        match pointer.labels.first() {
            None => missing(code, device, pointer, out),
            // The target of such a label is checked once it is clear which of the two it is.
            Some(_) if pointer.is_ambiguous() => {}
            Some(&label) => {
                for &jump in &pointer.jumps {
                    destination(code, nesting, jump, label, out);
                }
                if !pointers.any_may_be_meant() {
                    unused(code, device, pointer, label, out);
                }
            }
        }
    }
    Calls::new(pointers, nesting).check(code, out);
}

fn defined_once(code: &Code, device: Device, pointer: &Pointer, out: &mut Diagnostics) {
    let Some((&first, again)) = pointer.labels.split_first() else {
        return;
    };
    for &second in again {
        let diagnostic = codes::LABEL_TWICE
            .at(
                code.span(second),
                phrase!("`{device}` is defined twice", device),
            )
            .label("defined again here")
            .other(code.span(first), "first defined here")
            .help("delete one of the two, or give it another number");
        out.push(diagnostic);
    }
}

fn end_pointer(code: &Code, pointer: &Pointer, out: &mut Diagnostics) {
    for &label in &pointer.labels {
        let diagnostic = codes::P63
            .at(code.span(label), "`P63` must not be defined")
            .label("P63 is the end of the program");
        // Right before END it leads where P63 leads anyway.
        let ends = label + 1 < code.len && code.basic(label + 1) == Some(Basic::End);
        out.push(match ends {
            true => diagnostic
                .help("delete this label: jumps to P63 end the scan without it")
                .fix(Fix::certain("delete the label").replace(code.span(label), "")),
            false => diagnostic.help("use another number for this label"),
        });
    }
    for &call in &pointer.calls {
        let diagnostic = codes::P63
            .at(code.span(call), "`P63` cannot be called")
            .label("P63 is the end of the program");
        out.push(diagnostic);
    }
}

fn used_one_way(code: &Code, device: Device, pointer: &Pointer, out: &mut Diagnostics) {
    if let (Some(&jump), Some(&call)) = (pointer.jumps.first(), pointer.calls.first()) {
        let diagnostic = codes::JUMPED_AND_CALLED
            .at(
                code.span(jump.max(call)),
                phrase!("`{device}` is both jumped to and called", device),
            )
            .label(if jump > call {
                "jumped to here"
            } else {
                "called here"
            })
            .other(
                code.span(jump.min(call)),
                if jump > call {
                    "called here"
                } else {
                    "jumped to here"
                },
            )
            .help("give the subroutine its own label");
        out.push(diagnostic);
    }
}

fn missing(code: &Code, device: Device, pointer: &Pointer, out: &mut Diagnostics) {
    for &i in pointer
        .jumps
        .iter()
        .chain(&pointer.calls)
        .chain(&pointer.others)
        .filter(|&&i| !code.is_meant(i) && !code.instr(i).is_broken())
    {
        let diagnostic = codes::NO_LABEL
            .at(
                named_at(code, i, device),
                phrase!("label `{device}` does not exist", device),
            )
            .label("leads nowhere")
            .help(phrase!(
                "put the line `{device}` where the jump or call should go",
                device
            ));
        out.push(diagnostic);
    }
}

fn no_routine(code: &Code, device: Device, pointer: &Pointer, out: &mut Diagnostics) {
    for &i in &pointer.others {
        let diagnostic = codes::NO_ROUTINE
            .at(
                named_at(code, i, device),
                phrase!("interrupt routine `{device}` does not exist", device),
            )
            .label("nothing to run")
            .help(phrase!(
                "put the routine `{device}` after FEND, with IRET at its end",
                device
            ));
        out.push(diagnostic);
    }
}

/// Position at which an instruction names a pointer.
fn named_at(code: &Code, i: usize, device: Device) -> Span {
    let names = |operand: &&Operand| matches!(operand.kind, OperandKind::Device(named, _) if named == device);
    let operand = code.instr(i).operands.iter().find(names);
    operand.map_or(code.span(i), |operand| operand.span)
}

fn unused(code: &Code, device: Device, pointer: &Pointer, label: usize, out: &mut Diagnostics) {
    if !pointer.is_named() {
        let diagnostic = codes::UNUSED_LABEL
            .at(
                code.span(label),
                phrase!("nothing jumps to `{device}` or calls it", device),
            )
            .label("not used")
            .help("delete the label, or name it in the CJ or CALL that should lead here");
        out.push(diagnostic);
    }
}

/// Checks that a jump stays in its routine and does not enter a loop.
fn destination(code: &Code, nesting: &Nesting, jump: usize, label: usize, out: &mut Diagnostics) {
    let (from, to) = (nesting.of(jump), nesting.of(label));
    if from.routine != to.routine {
        let diagnostic = codes::BETWEEN_ROUTINES
            .at(code.span(jump), "this jump goes into another routine")
            .label("jumps from here …")
            .other(code.span(label), "… to here")
            .help("use CALL to run a subroutine, SRET to leave one");
        out.push(diagnostic);
        return;
    }
    let mut around = from.inner_loop;
    while around != to.inner_loop && around != NONE {
        around = nesting.outer_loop(around);
    }
    if around != to.inner_loop {
        let diagnostic = codes::INTO_LOOP
            .at(code.span(jump), "this jump goes into a loop")
            .label("jumps from here …")
            .other(code.span(label), "… to here …")
            .other(code.span(to.inner_loop as usize), "… inside this loop")
            .help("jump to the FOR or past the NEXT");
        out.push(diagnostic);
    }
    if from.state != to.state {
        let diagnostic = codes::JUMP_IN_STL
            .at(
                code.span(jump),
                "this jump leaves or enters a state of a step ladder",
            )
            .label("jumps from here …")
            .other(code.span(label), "… to here")
            .help("go to another state with SET and its STL");
        out.push(diagnostic);
    }
}

/// Calls between routines.
struct Calls {
    /// By routine: the call and the routine called.
    calls: FxHashMap<Routine, Vec<(usize, Routine)>>,
    /// The deepest chain of calls that begins in a routine, once known.
    depths: FxHashMap<Routine, u32>,
}

impl Calls {
    fn new(pointers: &Pointers, nesting: &Nesting) -> Self {
        let mut calls: FxHashMap<Routine, Vec<_>> = FxHashMap::default();
        for (_, pointer) in pointers
            .iter()
            .filter(|(_, pointer)| !pointer.is_ambiguous())
        {
            let Some(&label) = pointer.labels.first() else {
                continue;
            };
            for &call in &pointer.calls {
                let (from, to) = (nesting.of(call).routine, nesting.of(label).routine);
                calls.entry(from).or_default().push((call, to));
            }
        }
        for made in calls.values_mut() {
            made.sort();
        }
        let depths = FxHashMap::default();
        Calls { calls, depths }
    }

    fn check(mut self, code: &Code, out: &mut Diagnostics) {
        let mut roots: Vec<_> = self.calls.keys().copied().collect();
        roots.sort();
        for root in roots {
            self.walk(code, root, out);
        }
        let max = code.model().max_call;
        let begins = |routine: &Routine| matches!(routine, Routine::Main | Routine::Interrupt(_));
        let mut deep: Vec<_> = self
            .depths
            .iter()
            .filter(|&(routine, &depth)| begins(routine) && depth > max)
            .collect();
        deep.sort();
        for (&routine, &depth) in deep {
            let chain = self.deepest(routine);
            let (Some(&first), Some(&beyond)) = (chain.first(), chain.get(max as usize)) else {
                continue;
            };
            let name = code.model().name;
            let always = chain.iter().all(|&call| is_always_made(code, call));
            let diagnostic = match always {
                true => codes::DEEP_CALL.at(
                    code.span(beyond),
                    phrase!(
                        "calls nest {depth} deep, but {name} allows {max}",
                        depth,
                        name,
                        max
                    ),
                ),
                false => codes::MAY_CALL_DEEP
                    .at(
                        code.span(beyond),
                        phrase!(
                            "calls may nest {depth} deep, but {name} allows {max}",
                            depth,
                            name,
                            max
                        ),
                    )
                    .help("a call that is too deep is skipped with error 6702 when it is reached"),
            };
            let diagnostic = diagnostic
                .label("one call too many")
                .other(code.span(first), "the chain starts here");
            out.push(diagnostic);
        }
    }

    /// Finds the depth of a routine and of all that it calls, depth first without recursion, and reports circles.
    fn walk(&mut self, code: &Code, root: Routine, out: &mut Diagnostics) {
        if self.depths.contains_key(&root) {
            return;
        }
        // Routines that are being looked at: the routine, its next call, the deepest chain found so far.
        let mut path = vec![(root, 0, 0)];
        while let Some(&mut (routine, ref mut next, ref mut depth)) = path.last_mut() {
            let made = self.calls.get(&routine).map_or(&[][..], Vec::as_slice);
            let Some(&(call, called)) = made.get(*next) else {
                let depth = *depth;
                self.depths.insert(routine, depth);
                path.pop();
                continue;
            };
            if let Some(&known) = self.depths.get(&called) {
                *depth = (*depth).max(known + 1);
                *next += 1;
            } else if path.iter().any(|&(open, ..)| open == called) {
                out.push(recursion(code, call, called));
                if let Some((_, next, _)) = path.last_mut() {
                    *next += 1;
                }
            } else {
                path.push((called, 0, 0));
            }
        }
    }

    /// The calls of the deepest chain that begins in a routine.
    fn deepest(&self, mut routine: Routine) -> Vec<usize> {
        let mut chain = Vec::new();
        let depth = |routine: &Routine| self.depths.get(routine).copied().unwrap_or(0);
        let mut left = depth(&routine);
        while left > 0 {
            left -= 1;
            let made = self.calls.get(&routine).map_or(&[][..], Vec::as_slice);
            let Some(&(call, called)) = made.iter().find(|(_, called)| depth(called) == left)
            else {
                break;
            };
            chain.push(call);
            routine = called;
        }
        chain
    }
}

/// Returns true if each run of its routine makes a call: M8000 alone drives it, and nothing jumps.
fn is_always_made(code: &Code, call: usize) -> bool {
    let jumps = (0..code.len).any(|i| code.basic(i) == Some(Basic::Cj));
    let drive = call.checked_sub(1).filter(|&i| {
        let always = code.device(i, 0).map(|device| device.to_string());
        code.basic(i) == Some(Basic::Ld) && always.as_deref() == Some("M8000")
    });
    !jumps && drive.is_some() && !code.resolved.instrs[call].form.pulse
}

fn recursion(code: &Code, call: usize, called: Routine) -> rungc_syntax::Diagnostic {
    let diagnostic = codes::RECURSION
        .at(code.span(call), "this call re-enters its own subroutine")
        .label("calls itself through this")
        .help("this call is skipped with error 6702 when it is reached");
    match called {
        Routine::Sub(label) | Routine::Interrupt(label) => {
            diagnostic.other(code.span(label as usize), "the subroutine starts here")
        }
        Routine::Main | Routine::Nothing => diagnostic,
    }
}
