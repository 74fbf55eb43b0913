//! Beginnings and ends of structures, and their nesting: master control, loops, step ladders, subroutines and interrupt
//! routines.

mod table;

use super::Code;
use super::pointers::Pointers;
use rungc_catalogue::Basic;
use rungc_syntax::{Device, DeviceClass, Diagnostic, Diagnostics, codes, phrase};
use table::{Kind, Verdict, crossing, inside};

/// No instruction.
pub(super) const NONE: u32 = u32::MAX;

/// Structures that enclose an instruction. Structures are named by the instruction that begins them, [`NONE`] for none.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Enclosing {
    /// Routine that runs it.
    pub(super) routine: Routine,
    /// The innermost loop around it.
    pub(super) inner_loop: u32,
    /// The STL of the state it belongs to.
    pub(super) state: u32,
}

/// Routine of an instruction.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash, PartialOrd, Ord)]
pub(super) enum Routine {
    /// The main program.
    Main,
    /// The subroutine that begins at this label.
    Sub(u32),
    /// The interrupt routine that begins at this pointer.
    Interrupt(u32),
    /// Nothing: it follows FEND, SRET or IRET without a label.
    Nothing,
}

/// Structures that enclose each instruction.
pub(super) struct Nesting {
    enclosing: Vec<Enclosing>,
    /// For each FOR the loop around it.
    outer: Vec<(u32, u32)>,
}

impl Nesting {
    /// Structures that enclose an instruction.
    pub(super) fn of(&self, i: usize) -> Enclosing {
        self.enclosing[i]
    }

    /// The loop around the loop that this FOR begins.
    pub(super) fn outer_loop(&self, at: u32) -> u32 {
        let found = self.outer.binary_search_by_key(&at, |&(inner, _)| inner);
        found.map_or(NONE, |at| self.outer[at].1)
    }
}

/// A structure that has begun.
struct Open {
    kind: Kind,
    /// The instruction that began it.
    at: usize,
    /// Level of a master control zone, if it could be read.
    level: Option<u32>,
    /// True if an error in it is known, so that no other is reported.
    reported: bool,
}

impl Open {
    /// Returns true if an MCR of this level ends it, as far as both levels could be read.
    fn may_end_with(&self, level: Option<u32>) -> bool {
        self.level.is_none() || level.is_none() || self.level == level
    }
}

struct Walk<'a, 'p> {
    code: &'a Code<'p>,
    pointers: &'a Pointers,
    out: &'a mut Diagnostics,
    /// The instruction at hand.
    at: usize,
    open: Vec<Open>,
    routine: Routine,
    /// True if the main program has ended.
    after_fend: bool,
    /// A label after FEND that nothing names, since the last end of a routine.
    unused_label: bool,
    /// The routine that FEND has cut off from its end, which is still to come.
    cut: Option<Kind>,
    /// STL in a row so far.
    stl_row: u32,
    state: u32,
    /// Open loops, innermost last.
    loops: Vec<u32>,
    outer: Vec<(u32, u32)>,
    /// Structures that enclose the instructions before this one.
    enclosing: Vec<Enclosing>,
}

/// Checks the structure of a program and finds where its instructions are.
pub(super) fn check(code: &Code, pointers: &Pointers, out: &mut Diagnostics) -> Nesting {
    let mut found = Diagnostics::new();
    let mut walk = Walk {
        code,
        pointers,
        out: &mut found,
        at: 0,
        open: Vec::new(),
        routine: Routine::Main,
        after_fend: false,
        unused_label: false,
        cut: None,
        stl_row: 0,
        state: NONE,
        loops: Vec::new(),
        outer: Vec::new(),
        enclosing: Vec::with_capacity(code.len),
    };
    for i in 0..code.len {
        walk.begin(i);
        walk.enclosing.push(walk.around());
        walk.end(i);
    }
    walk.finish();
    let (enclosing, outer) = (walk.enclosing, walk.outer);
    if !code.may_lack_structure() {
        out.extend(found.iter().cloned());
    }
    Nesting { enclosing, outer }
}

impl Walk<'_, '_> {
    fn around(&self) -> Enclosing {
        Enclosing {
            routine: self.routine,
            inner_loop: self.loops.last().copied().unwrap_or(NONE),
            state: self.state,
        }
    }

    /// Adds a finding, unless it is about an instruction of which it is only guessed what was meant.
    fn report(&mut self, diagnostic: Diagnostic) {
        if !self.code.is_meant(self.at) {
            self.out.push(diagnostic);
        }
    }

    /// Opens the structure that instruction `i` begins.
    fn begin(&mut self, i: usize) {
        self.at = i;
        let basic = self.code.basic(i);
        if basic != Some(Basic::Stl) {
            self.stl_row = 0;
        }
        match basic {
            Some(Basic::Mc) => self.begin_mc(i),
            Some(Basic::For) => self.begin_for(i),
            Some(Basic::Stl) => self.begin_state(i),
            Some(Basic::Label) => self.label(i),
            _ => {}
        }
    }

    /// Closes the structure that instruction `i` ends.
    fn end(&mut self, i: usize) {
        match self.code.basic(i) {
            Some(Basic::Mcr) => self.end_mc(i),
            Some(Basic::Next) => self.end_for(i),
            Some(Basic::Ret) => self.end_states(i),
            Some(Basic::Sret) => self.end_routine(i, Kind::Sub),
            Some(Basic::Iret) => self.end_routine(i, Kind::Interrupt),
            Some(Basic::Pret) => {
                self.in_advanced_interrupt(i);
                self.end_routine(i, Kind::Interrupt);
            }
            Some(Basic::Proc | Basic::Pend) => {
                self.in_advanced_interrupt(i);
                self.in_no_loop(i);
            }
            Some(Basic::Fend) => self.fend(i),
            _ => {}
        }
    }

    /// PROC, PEND and PRET belong in advanced interrupts; a PRET in no routine at all is reported as such.
    fn in_advanced_interrupt(&mut self, i: usize) {
        let interrupts = &self.code.model().interrupts;
        let advanced = match self.routine {
            Routine::Interrupt(begin) => {
                let pointer = self.code.label(begin as usize);
                pointer.is_some_and(|i| interrupts.find_advanced(i.number).is_some())
            }
            Routine::Main | Routine::Sub(_) => false,
            Routine::Nothing => true,
        };
        if !advanced {
            let name = &self.code.instr(i).mnemonic;
            let message = phrase!("`{name}` outside an advanced interrupt", name);
            let diagnostic = codes::LONE_RETURN
                .at(self.code.span(i), message)
                .label("routines of other interrupts end with IRET")
                .help("the advanced interrupts are I900 to I907");
            self.report(diagnostic);
        }
    }

    /// The next entry of an advanced interrupt continues after PROC or PEND, and PEND leaves the routine: in a loop,
    /// one would run without its FOR and the other without its NEXT, which belong together (hm-motion-controller
    /// §5.4.3, §5.4.4).
    fn in_no_loop(&mut self, i: usize) {
        let Some(&around) = self.loops.last() else {
            return;
        };
        let name = &self.code.instr(i).mnemonic;
        let message = phrase!("`{name}` goes into a loop", name);
        let diagnostic = codes::INTO_LOOP
            .at(self.code.span(i), message)
            .label("the routine is left or entered here …")
            .other(self.code.span(around as usize), "… inside this loop")
            .help("put the whole loop between PROC and PEND");
        self.report(diagnostic);
    }

    fn push(&mut self, kind: Kind, at: usize) {
        self.push_open(Open {
            kind,
            at,
            level: None,
            reported: false,
        });
    }

    /// Begins a structure. No good program comes near the limit, which keeps the time linear for bad ones.
    fn push_open(&mut self, mut open: Open) {
        const MAX_OPEN: usize = 256;
        open.reported |= self.code.is_meant(open.at);
        if self.open.len() < MAX_OPEN {
            self.open.push(open);
        }
    }

    fn level(&self, i: usize) -> Option<u32> {
        let level = self.code.device(i, 0);
        let level = level.filter(|device| device.class == DeviceClass::N)?;
        Some(level.number)
    }

    fn begin_mc(&mut self, i: usize) {
        let level = self.level(i);
        let around = self.open.iter().rev().find(|open| open.kind == Kind::Mc);
        let wrong = around
            .filter(|open| level.is_some() && open.level >= level)
            .map(|open| open.at);
        let reported = wrong.is_some();
        if let (Some(around), Some(level)) = (wrong, level) {
            let message = phrase!("N{level} is not deeper than the zone around it", level);
            let diagnostic = codes::MC_ORDER
                .at(self.code.span(i), message)
                .label("this zone is inside …")
                .other(self.code.span(around), "… this one")
                .help("number nested zones N0, N1, N2 … from outside to inside, and close each with MCR");
            self.report(diagnostic);
        }
        self.push_open(Open {
            kind: Kind::Mc,
            at: i,
            level,
            reported,
        });
    }

    fn begin_for(&mut self, i: usize) {
        self.outer
            .push((i as u32, self.loops.last().copied().unwrap_or(NONE)));
        self.loops.push(i as u32);
        self.push(Kind::For, i);
        let max = self.code.model().max_for;
        if self.loops.len() as u32 == max + 1 {
            let message = phrase!(
                "loops nest {max} deep on {model}",
                max,
                model = self.code.model().name
            );
            let outermost = self.loops[0] as usize;
            let diagnostic = codes::DEEP_FOR
                .at(self.code.span(i), message)
                .label("one too many")
                .other(self.code.span(outermost), "the outermost loop")
                .help("do the work of the inner loops in one loop");
            self.report(diagnostic);
        }
    }

    fn begin_state(&mut self, i: usize) {
        /// At most this many STL may follow each other (h1u-h2u-programming §8.7, error 6625).
        const MAX_ROW: u32 = 8;
        self.state = i as u32;
        self.stl_row += 1;
        if self.stl_row == MAX_ROW + 1 {
            let diagnostic = codes::STL_ROW
                .at(self.code.span(i), "nine STL in a row")
                .label("at most eight parallel branches can be joined");
            self.report(diagnostic);
        }
        if !self.open.iter().any(|open| open.kind == Kind::Stl) {
            self.push(Kind::Stl, i);
        }
    }

    fn label(&mut self, i: usize) {
        let Some(label) = self.code.label(i) else {
            return;
        };
        match label.class {
            DeviceClass::I => self.begin_routine(i, Kind::Interrupt),
            _ if self.pointers.begins_routine(label, self.after_fend) => {
                self.begin_routine(i, Kind::Sub);
            }
            _ => self.jump_label(i, label),
        }
    }

    /// A label that is not called. After FEND, SRET or IRET it continues the routine that jumps to it.
    fn jump_label(&mut self, i: usize, label: Device) {
        if self.routine != Routine::Nothing {
            return;
        }
        let Some(pointer) = self
            .pointers
            .get(label)
            .filter(|pointer| pointer.is_named())
        else {
            self.unused_label = true;
            self.routine = Routine::Sub(i as u32);
            return;
        };
        let before = pointer
            .jumps
            .iter()
            .find_map(|&jump| self.enclosing.get(jump));
        self.routine = before.map_or(Routine::Main, |around| around.routine);
        match self.routine {
            Routine::Sub(_) => self.push(Kind::Sub, i),
            Routine::Interrupt(_) => self.push(Kind::Interrupt, i),
            Routine::Main | Routine::Nothing => {}
        }
    }

    fn begin_routine(&mut self, i: usize, kind: Kind) {
        let mut reported = false;
        if !self.after_fend {
            reported = true;
            let message = phrase!("this {kind} is in the main program", kind = kind.name());
            let diagnostic = codes::ROUTINE_IN_MAIN
                .at(self.code.span(i), message)
                .label("starts before FEND")
                .help("end the main program with FEND and put routines after it");
            let across = self.ends_behind_fend(i, kind);
            self.report(match kind {
                // The nesting table has a separate number for this (§8.8, row 0-FEND).
                Kind::Sub if across => diagnostic.plc_error(6709),
                _ => diagnostic,
            });
        }
        self.push_open(Open {
            kind,
            at: i,
            level: None,
            reported,
        });
        self.routine = match kind {
            Kind::Interrupt => Routine::Interrupt(i as u32),
            _ => Routine::Sub(i as u32),
        };
    }

    fn end_mc(&mut self, i: usize) {
        let level = self.level(i);
        let zone = self
            .open
            .iter()
            .rposition(|open| open.kind == Kind::Mc && open.may_end_with(level));
        let Some(zone) = zone else {
            let level = level.unwrap_or_default();
            let other = self.open.iter().rev().find(|open| open.kind == Kind::Mc);
            let other = other.and_then(|open| Some((open.at, open.level?)));
            let message = phrase!("no MC N{level} is open here", level);
            let diagnostic = codes::LONE_MCR.at(self.code.span(i), message);
            let diagnostic = match other {
                Some((at, open)) => diagnostic
                    .label(phrase!("ends N{level} …", level))
                    .other(self.code.span(at), phrase!("… but N{open} is open", open)),
                None => diagnostic.label("there is nothing to end"),
            };
            let diagnostic = diagnostic.help(match other {
                Some((_, open)) => phrase!("write `MCR N{open}`", open),
                None => phrase!("delete this MCR, or put MC where the zone starts"),
            });
            self.report(diagnostic);
            return;
        };
        self.close(zone, i);
        // MCR of a level ends the deeper ones too.
        let mut at = 0;
        self.open.retain(|open| {
            at += 1;
            at <= zone || open.kind != Kind::Mc
        });
    }

    fn end_for(&mut self, i: usize) {
        let Some(begin) = self.open.iter().rposition(|open| open.kind == Kind::For) else {
            let diagnostic = codes::LONE_NEXT
                .at(self.code.span(i), "no FOR is open here")
                .label("there is nothing to repeat")
                .help("delete this NEXT, or put FOR where the loop starts");
            self.report(diagnostic);
            return;
        };
        self.loops.pop();
        self.close(begin, i);
    }

    fn end_states(&mut self, i: usize) {
        self.state = NONE;
        let Some(begin) = self.open.iter().rposition(|open| open.kind == Kind::Stl) else {
            let diagnostic = codes::LONE_RET
                .at(self.code.span(i), "no step ladder is open here")
                .label("there is no STL before it")
                .help("a subroutine ends with SRET, an interrupt routine with IRET");
            self.report(diagnostic);
            return;
        };
        self.close(begin, i);
    }

    fn end_routine(&mut self, i: usize, kind: Kind) {
        let begin = self.open.iter().rposition(|open| open.kind == kind);
        match begin {
            Some(begin) => self.close(begin, i),
            None if kind == Kind::Sub && self.unused_label => {}
            None if self.cut == Some(kind) => {}
            None => self.lone_return(i, kind),
        }
        self.unused_label = false;
        self.cut = None;
        self.routine = match self.after_fend {
            true => Routine::Nothing,
            false => Routine::Main,
        };
    }

    fn lone_return(&mut self, i: usize, kind: Kind) {
        let name = kind.end();
        let diagnostic = codes::LONE_RETURN
            .at(
                self.code.span(i),
                phrase!("`{name}` ends no {kind}", name, kind = kind.name()),
            )
            .label("no routine has started")
            .help(phrase!(
                "delete this {name}, or put the label of the {kind} before it",
                name,
                kind = kind.name()
            ));
        let diagnostic = match kind {
            Kind::Sub if !self.after_fend => diagnostic.plc_error(6631),
            _ => diagnostic,
        };
        self.report(diagnostic);
    }

    fn fend(&mut self, i: usize) {
        self.cut = None;
        for open in std::mem::take(&mut self.open) {
            let routine = matches!(open.kind, Kind::Sub | Kind::Interrupt);
            let cut = routine && self.returns_next(i, open.kind);
            if cut {
                self.cut = Some(open.kind);
            }
            if !open.reported {
                self.report(match routine && !cut {
                    true => self.open_routine(&open),
                    false => self.fend_inside(&open, i),
                });
            }
            // Its end may still follow, and is not to be reported again.
            if !routine {
                let reported = true;
                self.open.push(Open { reported, ..open });
            }
        }
        self.after_fend = true;
        self.unused_label = false;
        self.routine = Routine::Nothing;
        self.state = NONE;
    }

    /// Returns true if the next end of a routine after instruction `i`, before any other begins, is one of this kind.
    fn returns_next(&self, i: usize, kind: Kind) -> bool {
        let ends = |at: usize| match self.code.basic(at) {
            Some(Basic::Sret) => Some(kind == Kind::Sub),
            Some(Basic::Iret | Basic::Pret) => Some(kind == Kind::Interrupt),
            Some(Basic::Label | Basic::Fend) => Some(false),
            _ => None,
        };
        (i + 1..self.code.len).find_map(ends).unwrap_or(false)
    }

    /// Returns true if a routine that begins at `i`, in the main program, has FEND between it and its end.
    fn ends_behind_fend(&self, i: usize, kind: Kind) -> bool {
        let fend = (i + 1..self.code.len).find_map(|at| match self.code.basic(at) {
            Some(Basic::Fend) => Some(Some(at)),
            Some(Basic::Label | Basic::Sret | Basic::Iret | Basic::Pret) => Some(None),
            _ => None,
        });
        fend.flatten()
            .is_some_and(|fend| self.returns_next(fend, kind))
    }

    fn fend_inside(&self, open: &Open, i: usize) -> Diagnostic {
        let plc_error = match open.kind {
            Kind::Mc => 6608,
            Kind::For => 6607,
            Kind::Stl => 6605,
            Kind::Sub => 6709,
            Kind::Interrupt => 6606,
        };
        let end = open.kind.end();
        codes::FEND_INSIDE
            .at(
                self.code.span(i),
                phrase!("FEND inside {one}", one = open.kind.one()),
            )
            .label("the main program ends here …")
            .other(
                self.code.span(open.at),
                phrase!("… but no {end} has closed this", end),
            )
            .help(phrase!("put {end} before FEND", end))
            .plc_error(plc_error)
    }

    fn open_routine(&self, open: &Open) -> Diagnostic {
        let (name, end) = (open.kind.name(), open.kind.end());
        codes::OPEN_ROUTINE
            .at(
                self.code.span(open.at),
                phrase!("this {name} has no {end}", name, end),
            )
            .label("starts here and never ends")
            .help(phrase!("end it with {end}", end))
    }

    /// Ends the structure at this place of the stack with instruction `i`, and judges those that it crosses or lies in.
    fn close(&mut self, at: usize, i: usize) {
        let closed = self.open.remove(at);
        let (outer, inner) = self.open.split_at_mut(at);
        let mut found = Vec::new();
        for inner in inner.iter_mut().filter(|inner| !inner.reported) {
            // Deeper zones of master control end with the outer one.
            if (closed.kind, inner.kind) == (Kind::Mc, Kind::Mc) {
                continue;
            }
            if !closed.reported {
                inner.reported = true;
                found.push(crossed(self.code, &closed, inner, i));
            }
        }
        if found.is_empty() && !closed.reported {
            let around = outer.iter().rev().filter(|outer| !outer.reported);
            let wrong = around.filter_map(|outer| match inside(outer.kind, closed.kind) {
                Verdict::Error(plc_error) => Some((outer, plc_error)),
                Verdict::Fine => None,
            });
            found.extend(
                wrong
                    .map(|(outer, code)| not_inside(self.code, outer, &closed, code))
                    .next(),
            );
        }
        for diagnostic in found {
            self.report(diagnostic);
        }
    }

    /// Reports what is still open at the end.
    fn finish(&mut self) {
        for open in std::mem::take(&mut self.open) {
            if open.reported {
                continue;
            }
            self.at = open.at;
            let span = self.code.span(open.at);
            let diagnostic = match open.kind {
                Kind::Sub | Kind::Interrupt => self.open_routine(&open),
                Kind::Mc => {
                    let level = open
                        .level
                        .map_or_else(|| "".into(), |level| format!(" N{level}"));
                    codes::OPEN_MC
                        .at(span, phrase!("no MCR closes MC{level}", level))
                        .label("starts here and never ends")
                        .help(phrase!("end the zone with `MCR{level}`", level))
                }
                Kind::For => codes::OPEN_FOR
                    .at(span, "no NEXT closes this FOR")
                    .label("starts here and never ends")
                    .help("end the loop with NEXT"),
                Kind::Stl => codes::OPEN_STL
                    .at(span, "no RET closes this step ladder")
                    .label("starts here and never ends")
                    .help("put RET after the last state"),
            };
            self.report(diagnostic);
        }
    }
}

fn crossed(code: &Code, outer: &Open, inner: &Open, i: usize) -> Diagnostic {
    let (outside, within) = (outer.kind.name(), inner.kind.name());
    codes::CROSSED
        .at(
            code.span(i),
            phrase!("the {outside} ends inside the {within}", outside, within),
        )
        .label(phrase!("ends the {outside} …", outside))
        .other(code.span(outer.at), "… that starts here")
        .other(
            code.span(inner.at),
            phrase!("but this {within} is still open", within),
        )
        .help(phrase!("put the {end} before this", end = inner.kind.end()))
        .plc_error(crossing(outer.kind, inner.kind))
}

fn not_inside(code: &Code, outer: &Open, inner: &Open, plc_error: u16) -> Diagnostic {
    let (outside, within) = (outer.kind.name(), inner.kind.name());
    codes::NOT_INSIDE
        .at(
            code.span(inner.at),
            phrase!(
                "{inner} is not allowed inside {outer}",
                inner = inner.kind.one(),
                outer = outer.kind.one()
            ),
        )
        .label(phrase!("this {within}", within))
        .other(
            code.span(outer.at),
            phrase!("is inside this {outside}", outside),
        )
        .help(phrase!(
            "end the {outside} with {end} before it, or move the {within} out",
            outside,
            end = outer.kind.end(),
            within
        ))
        .plc_error(plc_error)
}
