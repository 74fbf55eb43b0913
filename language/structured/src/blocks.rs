//! Calls of function blocks. A block is expanded at each call: its inputs and outputs are the operands of the call, its
//! other labels have separate devices for each instance.

use crate::ast::{Arg, Expr, Name};
use crate::emit::{Compiler, Errors, Made, fail};
use crate::fold;
use crate::labels::{Instance, Label, Role, Stored, value_in};
use crate::types::{Fit, Ty};
use rungc_syntax::{Diagnostic, OperandKind, codes, phrase};
use std::cell::Cell;
use std::mem;
use std::rc::Rc;

/// Number of instances, and of calls of blocks, in a program.
pub(crate) const MOST: usize = 2_000;

impl Compiler<'_> {
    /// Calls an instance: those of the library are subroutines, others are expanded.
    pub(crate) fn called_block(
        &mut self,
        instance: &Rc<Instance>,
        args: &[Arg],
        call: &Expr,
    ) -> Made<()> {
        match self.units[instance.unit].is_library {
            true => self.call_routine(instance, args, call),
            false => self.expand(instance, args, call),
        }
    }

    /// Compiles the body of a block in place of its call.
    fn expand(&mut self, instance: &Rc<Instance>, args: &[Arg], call: &Expr) -> Made<()> {
        self.expansions += 1;
        if self.expansions > MOST {
            let what = phrase!(
                "the program calls blocks more than {most} times",
                most = MOST
            );
            return fail(codes::ST_UNSUPPORTED.at(call.span, what));
        }
        let block = &self.units[instance.unit];
        let mut labels = instance.own.clone();
        labels.global = Some(self.globals());
        let mut errors = Errors::new();
        let mut left: Vec<&Arg> = args.iter().collect();
        let names = block.sections.iter().flat_map(|section| &section.variables);
        for name in names.flat_map(|variable| &variable.names) {
            let own = instance.own.own(&name.text);
            let Some(label) = own.filter(|label| label.role != Role::Own) else {
                continue;
            };
            let Some(position) = left.iter().position(|arg| is_for(arg, name)) else {
                match label.role {
                    Role::InOut => errors.push(absent(name, call, block.name.text.as_str())),
                    Role::Input => self.note_own(instance, &label.name, call.span),
                    _ => {}
                }
                continue;
            };
            let arg = left.remove(position);
            label.given.set(label.given.get().or(Some(arg.value.span)));
            match self.bound(&arg.value, label) {
                Ok(stored) => labels.insert(Label {
                    stored,
                    is_hex: fold::is_hexadecimal(&self.labels, &arg.value),
                    is_used: Cell::new(true),
                    ..label.clone()
                }),
                Err(more) => errors.extend(more),
            }
        }
        for arg in left {
            errors.push(foreign(arg, block.name.text.as_str()));
        }
        if !errors.is_empty() {
            return Err(errors);
        }
        let (span, heading) = (self.span, self.heading.take());
        let outer = mem::replace(&mut self.labels, Rc::new(labels));
        let (loops, end) = (mem::take(&mut self.loops), self.end.take());
        self.body(&block.body);
        self.labels = outer;
        self.loops = loops;
        self.span = span;
        self.heading = heading;
        if let Some(end) = mem::replace(&mut self.end, end) {
            self.label(end);
        }
        Ok(())
    }

    /// The labels that all units see.
    pub(crate) fn globals(&self) -> Rc<crate::labels::Labels> {
        match &self.labels.global {
            Some(global) => Rc::clone(global),
            None => Rc::clone(&self.labels),
        }
    }

    /// Storage of an input or output in the body.
    fn bound(&mut self, arg: &Expr, label: &Label) -> Made<Stored> {
        let is_input = label.role == Role::Input;
        let Some(ty) = label.of.plain() else {
            return self.bound_whole(arg, label);
        };
        if let (Some(literal), true) = (self.constant(arg)?, is_input) {
            let value = value_in(literal, ty, arg.span);
            return value.map(Stored::Constant).map_err(|error| vec![*error]);
        }
        match self.place(arg)? {
            Some(place) if !place.is_variable() => {
                self.expect(arg, ty)?;
                if !is_input && ty.fit(place.ty) != Fit::Fits {
                    let what = phrase!(
                        "this is {given}, and the output is {ty}",
                        given = place.ty,
                        ty
                    );
                    return fail(codes::ST_TYPE.at(arg.span, what));
                }
                Ok(Stored::Device(place.operand))
            }
            _ if !is_input => {
                let what = phrase!("an output is a label or device without a variable index");
                fail(codes::ST_UNSUPPORTED.at(arg.span, what))
            }
            _ if ty == Ty::Bool => {
                let cond = self.condition(arg)?;
                self.load(&cond);
                let bit = self.temporary(0)?;
                let kind = OperandKind::Device(bit, None);
                let coil = self.here(kind.clone());
                self.push("OUT", [coil]);
                Ok(Stored::Device(kind))
            }
            _ => {
                self.expect(arg, ty)?;
                let temporary = self.temporary(ty.words())?;
                let kind = OperandKind::Device(temporary, None);
                let copy = self.here(kind.clone());
                self.compute(arg, ty, Some(&copy))?;
                Ok(Stored::Device(kind))
            }
        }
    }

    /// Storage of an array or structure that a call gives.
    fn bound_whole(&self, arg: &Expr, label: &Label) -> Made<Stored> {
        let spot = self.spot(arg)?.filter(|spot| spot.of.is_same(&label.of));
        match spot.as_ref().and_then(|spot| spot.area()) {
            Some(area) => Ok(Stored::Area(area.clone())),
            None => {
                let what = phrase!("`{name}` takes a label of its type", name = label.name);
                fail(codes::ST_TYPE.at(arg.span, what))
            }
        }
    }

    /// Reports values of instances that do not exist, since a call gives the input or output another place.
    pub(crate) fn check_instances(&mut self) {
        for (instance, name, span) in self.own_used.take() {
            let Some(given) = instance.own.own(&name).and_then(|label| label.given.get()) else {
                continue;
            };
            let block = &self.units[instance.unit].name.text;
            let what = phrase!(
                "the instance of `{block}` does not hold `{name}`",
                block,
                name
            );
            let error = codes::ST_UNSUPPORTED.at(span, what);
            let error = error.other(given, "a call gives this in its place");
            let error = error.help("give it in each call, and name what the call gives");
            if !self.found.contains(&error) {
                self.found.push(error);
            }
        }
    }
}

/// An argument that a block has no label for.
fn foreign(arg: &Arg, block: &str) -> Diagnostic {
    let name = arg.name.as_ref();
    let span = name.map_or(arg.value.span, |name| name.span);
    let what = match name {
        Some(name) => phrase!(
            "`{block}` has no input or output `{name}`",
            block,
            name = name.text
        ),
        None => phrase!("arguments of a function block have names"),
    };
    let error = codes::ST_ARGUMENTS.at(span, what);
    error.help("write `Instance(Input := value, Output => label)`")
}

fn is_for(arg: &Arg, name: &Name) -> bool {
    let given = arg.name.as_ref();
    given.is_some_and(|given| given.text.eq_ignore_ascii_case(&name.text))
}

fn absent(name: &Name, call: &Expr, block: &str) -> Diagnostic {
    let what = phrase!(
        "`{name}` of `{block}` is not given",
        block,
        name = name.text
    );
    let error = codes::ST_ARGUMENTS.at(call.span, what);
    error.other(name.span, "declared here")
}
