//! Subroutines: functions, and the blocks of the library of each instance. A call stores the inputs in the devices of
//! the subroutine, and reads its results from them; the bodies follow the program after FEND.

use crate::ast::{Arg, Expr, ExprKind, Unit, UnitKind};
use crate::emit::{Compiler, Made, fail};
use crate::labels::{Instance, Label, Labels, Role, Stored};
use crate::types::{Fit, Ty};
use crate::values::changes_index;
use rungc_syntax::{Device, Diagnostic, Operand, OperandKind, Remarks, Span, codes, phrase};
use smol_str::SmolStr;
use std::rc::Rc;

/// Levels of subroutines that the PLC can call from within each other.
const DEEPEST: usize = 5;

/// A subroutine that is called.
#[derive(Debug)]
pub(crate) struct Routine {
    instance: Rc<Instance>,
    pointer: Device,
    /// Place of its name, or of the call of a block of the library.
    span: Span,
    /// Heading of the first rung of a block of the library.
    heading: Option<SmolStr>,
    /// Positions of the routines that it calls.
    calls: Vec<usize>,
}

impl Compiler<'_> {
    /// The type of the result of a function.
    pub(crate) fn type_of_result(&self, function: &Instance, expr: &Expr) -> Made<Ty> {
        let name = &self.units[function.unit].name.text;
        let result = function.own.own(name);
        match result.map(|label| (&label.stored, label.of.plain())) {
            Some((Stored::Device(_), Some(ty))) => Ok(ty),
            _ => {
                let what = phrase!("the result of `{name}` is not a value", name);
                fail(codes::ST_TYPE.at(expr.span, what))
            }
        }
    }

    /// Calls a function; gives the device that holds a copy of its result.
    pub(crate) fn result(
        &mut self,
        function: &Rc<Instance>,
        args: &[Arg],
        expr: &Expr,
        target: Option<&Operand>,
    ) -> Made<OperandKind> {
        let ty = self.type_of_result(function, expr)?;
        self.call_routine(function, args, expr)?;
        let name = &self.units[function.unit].name.text;
        let stored = function.own.own(name).map(|label| label.stored.clone());
        let Some(Stored::Device(result)) = stored else {
            return Err(Vec::new());
        };
        if target.is_some() || ty == Ty::Bool {
            return self.moved(result, ty, target);
        }
        // The next call changes the result.
        let copy = self.temporary(ty.words())?;
        let copy = self.here(OperandKind::Device(copy, None));
        self.moved(result, ty, Some(&copy))
    }

    /// Calls a subroutine: inputs first, then CALL, and the outputs that the call names.
    pub(crate) fn call_routine(
        &mut self,
        instance: &Rc<Instance>,
        args: &[Arg],
        call: &Expr,
    ) -> Made<()> {
        let unit = &self.units[instance.unit];
        let bound = bind(unit, instance, args, call)?;
        let mut errors = Vec::new();
        let is_input = |(label, _): &&(&Label, &Arg)| label.role != Role::Output;
        let inputs: Vec<_> = bound.iter().filter(is_input).collect();
        // A call among the arguments may be one of the same subroutine.
        let is_later = inputs.len() > 1 && inputs.iter().any(|(_, arg)| changes_index(&arg.value));
        let mut stored = Vec::new();
        for (label, arg) in inputs {
            if label.role == Role::InOut {
                self.check_given_back(label, &arg.value)?;
            }
            match self.input(label, &arg.value, is_later) {
                Ok(later) => stored.extend(later),
                Err(more) => errors.extend(more),
            }
        }
        if !errors.is_empty() {
            return Err(errors);
        }
        for (ty, from, to) in stored {
            self.store(ty, from, to);
        }
        let pointer = self.routine(instance, call)?;
        let pointer = self.here(OperandKind::Device(pointer, None));
        self.always("CALL", [pointer]);
        for (label, arg) in bound.iter().filter(|(label, _)| label.role != Role::Input) {
            self.output(label, &arg.value)?;
        }
        Ok(())
    }

    /// Reports an argument that is given back and cannot be: a constant, a computed value, or an element that the call
    /// may change to another.
    fn check_given_back(&self, label: &Label, value: &Expr) -> Made<()> {
        let place = self.target(value)?;
        if place.is_variable() {
            let what = phrase!(
                "`{name}` takes no element with a variable index",
                name = label.name
            );
            let error = codes::ST_UNSUPPORTED.at(value.span, what);
            return fail(error.help("copy it to a label, and back after the call"));
        }
        Ok(())
    }

    /// Stores an input in the device of the subroutine, or, if other inputs come first, in a temporary; gives what is
    /// left to be stored.
    fn input(
        &mut self,
        label: &Label,
        value: &Expr,
        is_later: bool,
    ) -> Made<Option<(Ty, OperandKind, Operand)>> {
        let (Stored::Device(device), Some(ty)) = (&label.stored, label.of.plain()) else {
            let what = phrase!("an input that is an array or structure is not compiled yet");
            return fail(codes::ST_UNSUPPORTED.at(value.span, what));
        };
        let device = self.here(device.clone());
        if ty == Ty::Bool {
            let cond = self.condition(value)?;
            self.load(&cond);
            if !is_later {
                self.push("OUT", [device]);
                return Ok(None);
            }
            let bit = self.temporary(0)?;
            let coil = self.here(OperandKind::Device(bit, None));
            self.push("OUT", [coil.clone()]);
            return Ok(Some((ty, coil.kind, device)));
        }
        self.expect(value, ty)?;
        if is_later {
            let temporary = self.temporary(ty.words())?;
            let copy = self.here(OperandKind::Device(temporary, None));
            let kind = self.compute(value, ty, Some(&copy))?;
            return Ok(Some((ty, kind, device)));
        }
        self.compute(value, ty, Some(&device))?;
        Ok(None)
    }

    /// Copies a bit or number.
    fn store(&mut self, ty: Ty, from: OperandKind, to: Operand) {
        let from = self.here(from);
        if ty == Ty::Bool {
            self.is_powered = false;
            self.push("LD", [from]);
            self.push("OUT", [to]);
        } else {
            self.always(&Self::sized("MOV", ty), [from, to]);
        }
    }

    /// Copies an output of the subroutine to where the call wants it.
    fn output(&mut self, label: &Label, target: &Expr) -> Made<()> {
        let place = self.target(target)?;
        let (Stored::Device(device), Some(ty)) = (&label.stored, label.of.plain()) else {
            let what = phrase!("an output that is an array or structure is not compiled yet");
            return fail(codes::ST_UNSUPPORTED.at(target.span, what));
        };
        if ty.fit(place.ty) != Fit::Fits {
            let what = phrase!(
                "this is {given}, and the output is {ty}",
                given = place.ty,
                ty
            );
            return fail(codes::ST_TYPE.at(target.span, what));
        }
        if place.is_variable() && ty == Ty::Bool {
            let what = phrase!("an output to an element with a variable index is not compiled yet");
            return fail(codes::ST_UNSUPPORTED.at(target.span, what));
        }
        let to = self.reached(&place, target.span)?;
        self.store(ty, device.clone(), to);
        Ok(())
    }

    /// Pointer of a subroutine, which is compiled later.
    fn routine(&mut self, instance: &Rc<Instance>, call: &Expr) -> Made<Device> {
        let routines = self.routines.iter();
        let known = routines
            .clone()
            .position(|one| Rc::ptr_eq(&one.instance, instance));
        let at = match known {
            Some(at) => at,
            None => {
                let pointer = self.pointer()?;
                let unit = &self.units[instance.unit];
                let (span, heading) = match (&call.kind, unit.is_library) {
                    (ExprKind::Call(of, _), true) => {
                        let name = self.text.get(of.span.range()).unwrap_or_default();
                        let heading = format!("{name} : {}", unit.name.text);
                        (call.span, Some(heading.into()))
                    }
                    _ => (unit.name.span, None),
                };
                self.routines.push(Routine {
                    instance: Rc::clone(instance),
                    pointer,
                    span,
                    heading,
                    calls: Vec::new(),
                });
                self.routines.len() - 1
            }
        };
        if let Some(caller) = self.routine {
            self.routines[caller].calls.push(at);
        }
        Ok(self.routines[at].pointer)
    }

    /// Compiles the subroutines that are called, and those that they call.
    pub(crate) fn routines(&mut self) {
        let mut at = 0;
        while at < self.routines.len() {
            self.routine = Some(at);
            // The caller still needs its temporaries.
            self.supply.settle();
            self.body_of(at);
            at += 1;
        }
        self.routine = None;
        if let Some(span) = self.too_deep() {
            let what = phrase!("this calls itself, or nests more calls than the PLC can");
            let error = codes::ST_UNSUPPORTED.at(span, what);
            let help = phrase!(
                "subroutines call each other in {most} levels at most",
                most = DEEPEST
            );
            self.found.push(error.help(help));
        }
    }

    fn body_of(&mut self, at: usize) {
        let routine = &self.routines[at];
        let (instance, pointer, span) =
            (Rc::clone(&routine.instance), routine.pointer, routine.span);
        let mut heading = routine.heading.clone();
        let unit = &self.units[instance.unit];
        let mut labels: Labels = instance.own.clone();
        labels.global = Some(self.globals());
        let outer = std::mem::replace(&mut self.labels, Rc::new(labels));
        let (first, statements) = (self.instrs.len(), self.statements.len());
        let found = self.found.len();
        self.span = span;
        self.label(pointer);
        self.end = None;
        self.body(&unit.body);
        self.span = span;
        if let Some(end) = self.end.take() {
            self.label(end);
        }
        self.push("SRET", []);
        self.is_powered = false;
        if unit.is_library {
            // The text of the library is not that of the program.
            self.statements.truncate(statements);
            for instr in &mut self.instrs[first..] {
                (instr.span, instr.mnemonic_span) = (span, span);
                let begins = instr.mnemonic.starts_with("LD");
                let heading = if begins { heading.take() } else { None };
                instr.remarks = Remarks::new(heading, None);
                for operand in &mut instr.operands {
                    operand.span = span;
                }
            }
        }
        if unit.is_library {
            self.found[found..]
                .iter_mut()
                .for_each(|one| one.span = span);
        }
        self.labels = outer;
    }

    /// Examines the functions that nothing calls.
    pub(crate) fn uncalled(&mut self, found: &[Diagnostic]) {
        // A statement with a mistake may be meant to call it.
        let is_certain = !crate::has_errors(found) && !crate::has_errors(&self.found);
        for function in self.functions.values().cloned().collect::<Vec<_>>() {
            let mut routines = self.routines.iter();
            if routines.any(|one| Rc::ptr_eq(&one.instance, &function)) {
                continue;
            }
            let name = &self.units[function.unit].name;
            if is_certain {
                let what = phrase!("nothing calls `{name}`", name = name.text);
                self.found.push(codes::ST_UNUSED.at(name.span, what));
            }
            let (instrs, routines) = (self.instrs.len(), self.routines.len());
            let Some(pointer) = self.supply.pointer() else {
                return;
            };
            self.routines.push(Routine {
                instance: function,
                pointer,
                span: name.span,
                heading: None,
                calls: Vec::new(),
            });
            self.body_of(routines);
            self.instrs.truncate(instrs);
            self.routines.truncate(routines);
        }
    }

    /// A subroutine below which there are too many levels of calls.
    fn too_deep(&self) -> Option<Span> {
        let mut levels = vec![1; self.routines.len()];
        // Around a circle of calls, levels grow without end.
        for _ in 0..=DEEPEST {
            for (at, routine) in self.routines.iter().enumerate() {
                let below = routine.calls.iter().map(|call| levels[*call] + 1);
                levels[at] = below.max().unwrap_or(1).max(levels[at]);
            }
        }
        let at = levels.iter().position(|levels| *levels > DEEPEST)?;
        Some(self.routines[at].span)
    }
}

/// The labels of a subroutine that get the arguments of a call.
fn bind<'c>(
    unit: &Unit,
    instance: &'c Instance,
    args: &'c [Arg],
    call: &Expr,
) -> Made<Vec<(&'c Label, &'c Arg)>> {
    let sections = unit.sections.iter();
    let is_input = |keyword: &str| matches!(keyword, "VAR_INPUT" | "VAR_IN_OUT");
    let inputs = sections.filter(|section| is_input(&section.keyword.text));
    let names = inputs
        .flat_map(|section| &section.variables)
        .flat_map(|variable| &variable.names);
    let mut positions = names.map(|name| name.text.as_str());
    let mut bound: Vec<(&Label, &Arg)> = Vec::new();
    for arg in args {
        let label = match &arg.name {
            Some(name) => instance
                .own
                .all()
                .find(|label| is_named(label, &name.text, unit)),
            None if unit.kind == UnitKind::Function => {
                positions.next().and_then(|name| instance.own.own(name))
            }
            None => {
                let what = phrase!("arguments of a function block have names");
                let error = codes::ST_ARGUMENTS.at(arg.value.span, what);
                return fail(error.help("write `Instance(Input := value, Output => label)`"));
            }
        };
        let span = arg.name.as_ref().map_or(arg.value.span, |name| name.span);
        let Some(label) = label.filter(|label| label.role != Role::Own) else {
            let what = match &arg.name {
                Some(name) => phrase!(
                    "`{block}` has no input or output `{name}`",
                    block = unit.name.text,
                    name = name.text
                ),
                None => phrase!("`{block}` has fewer inputs", block = unit.name.text),
            };
            return fail(codes::ST_ARGUMENTS.at(span, what));
        };
        if bound.iter().any(|(before, _)| before.name == label.name) {
            let what = phrase!("`{name}` is given twice", name = label.name);
            return fail(codes::ST_ARGUMENTS.at(span, what));
        }
        bound.push((label, arg));
    }
    if unit.kind == UnitKind::Function {
        let missing = instance.own.all().find(|label| {
            matches!(label.role, Role::Input | Role::InOut)
                && !bound.iter().any(|(given, _)| given.name == label.name)
        });
        if let Some(missing) = missing {
            let what = phrase!(
                "`{name}` of `{block}` is not given",
                name = missing.name,
                block = unit.name.text
            );
            let error = codes::ST_ARGUMENTS.at(call.span, what);
            return fail(error.other(missing.span, "declared here"));
        }
    }
    Ok(bound)
}

/// Returns true for the name of a label in a call. Blocks of the library have some names of IEC 61131-3 in the form of
/// GX Works2, where `S1` and `R1` are devices.
fn is_named(label: &Label, name: &str, unit: &Unit) -> bool {
    let own = label.name.as_str();
    let alias = match own {
        "RESET" => "R",
        "LOAD" => "LD",
        own => own.trim_start_matches('_'),
    };
    own.eq_ignore_ascii_case(name) || unit.is_library && alias.eq_ignore_ascii_case(name)
}
