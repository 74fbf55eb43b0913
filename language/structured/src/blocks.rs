//! Calls of function blocks. A block is expanded at each call: its inputs and outputs are the operands of the call, its
//! other labels have separate devices for each instance.

use crate::ast::{Arg, Expr, Name, Section};
use crate::emit::{Compiler, Errors, Made, fail};
use crate::fold;
use crate::labels::{Instance, Label, Stored, value_in};
use crate::types::{Fit, Ty};
use rungc_syntax::{Diagnostic, codes};
use std::cell::Cell;
use std::mem;
use std::rc::Rc;

/// Number of instances, and of calls of blocks, in a program.
pub(crate) const MOST: usize = 2_000;

/// Purpose of an argument of a block.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Use {
    Input,
    Output,
}

fn use_of(section: &Section) -> Option<Use> {
    match section.keyword.text.as_str() {
        "VAR_INPUT" => Some(Use::Input),
        "VAR_OUTPUT" | "VAR_IN_OUT" => Some(Use::Output),
        _ => None,
    }
}

impl Compiler<'_> {
    /// Compiles the body of a block in place of its call.
    pub(crate) fn expand(&mut self, instance: &Instance, args: &[Arg], call: &Expr) -> Made<()> {
        self.expansions += 1;
        if self.expansions > MOST {
            let what = format!("the program calls blocks more than {MOST} times");
            return fail(codes::ST_UNSUPPORTED.at(call.span, what));
        }
        let block = &self.units[instance.unit];
        let mut labels = instance.own.clone();
        labels.global = Some(self.globals());
        let mut errors = Errors::new();
        let mut left: Vec<&Arg> = args.iter().collect();
        for section in &block.sections {
            let Some(role) = use_of(section) else {
                continue;
            };
            for variable in &section.variables {
                let of = self.labels.type_of(&variable.of, &mut errors);
                for name in &variable.names {
                    let Some((ty, None)) = of else { continue };
                    let position = left.iter().position(|arg| is_for(arg, name));
                    let Some(position) = position else {
                        errors.push(absent(name, call, block.name.text.as_str()));
                        continue;
                    };
                    let arg = left.remove(position);
                    match self.bound(&arg.value, ty, role) {
                        Ok(stored) => labels.insert(Label {
                            name: name.text.to_string(),
                            span: name.span,
                            ty,
                            bounds: None,
                            stored,
                            is_hex: fold::is_hexadecimal(&self.labels, &arg.value),
                            is_chosen: false,
                            is_used: Cell::new(true),
                        }),
                        Err(more) => errors.extend(more),
                    }
                }
            }
        }
        for arg in left {
            let name = arg.name.as_ref();
            let span = name.map_or(arg.value.span, |name| name.span);
            let what = match name {
                Some(name) => format!(
                    "`{}` has no input or output `{}`",
                    block.name.text, name.text
                ),
                None => "arguments of a function block have names".to_owned(),
            };
            let error = codes::ST_ARGUMENTS.at(span, what);
            errors.push(error.help("write `Instance(Input := value, Output => label)`"));
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
    fn globals(&self) -> Rc<crate::labels::Labels> {
        match &self.labels.global {
            Some(global) => Rc::clone(global),
            None => Rc::clone(&self.labels),
        }
    }

    /// Storage of an input or output in the body.
    fn bound(&mut self, arg: &Expr, ty: Ty, role: Use) -> Made<Stored> {
        if let (Some(literal), Use::Input) = (self.constant(arg)?, role) {
            let value = value_in(literal, ty, arg.span);
            return value.map(Stored::Constant).map_err(|error| vec![*error]);
        }
        let place = self.place(arg)?;
        let Some(place) = place else {
            let what = match role {
                Use::Input => "an input that has to be computed is not compiled yet",
                Use::Output => "an output is a label or device",
            };
            let error = codes::ST_UNSUPPORTED.at(arg.span, what);
            return fail(error.help("assign the value to a label, and give that"));
        };
        self.expect(arg, ty)?;
        if role == Use::Output && ty.fit(place.ty) != Fit::Fits {
            let what = format!("this is {}, and the output is {ty}", place.ty);
            return fail(codes::ST_TYPE.at(arg.span, what));
        }
        Ok(Stored::Device(place.operand))
    }
}

fn is_for(arg: &Arg, name: &Name) -> bool {
    let given = arg.name.as_ref();
    given.is_some_and(|given| given.text.eq_ignore_ascii_case(&name.text))
}

fn absent(name: &Name, call: &Expr, block: &str) -> Diagnostic {
    let what = format!("`{}` of `{block}` is not given", name.text);
    let error = codes::ST_ARGUMENTS.at(call.span, what);
    error.other(name.span, "declared here")
}
