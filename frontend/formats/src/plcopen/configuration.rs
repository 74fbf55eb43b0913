//! The configuration of a project: the programs that run, and their order.

use super::{Fault, Reader, called, children, variables};
use roxmltree::Node;
use rungc_syntax::{Diagnostic, Span, codes};
use std::collections::HashSet;

/// An instance of a program.
#[derive(Clone, Copy)]
struct Instance<'a, 'i> {
    node: Node<'a, 'i>,
    task: Option<Node<'a, 'i>>,
}

impl<'a, 'i> Instance<'a, 'i> {
    /// Name of its program. CODESYS leaves the type empty and calls the instance like the program.
    fn program(&self) -> &'a str {
        let named = ["typeName", "name"].into_iter();
        let mut named = named.filter_map(|key| self.node.attribute(key).map(str::trim));
        named.find(|name| !name.is_empty()).unwrap_or_default()
    }

    /// The PLC that it is for.
    fn resource(&self) -> Option<Node<'a, 'i>> {
        let mut above = self.node.ancestors();
        above.find(|node| node.tag_name().name() == "resource")
    }

    /// Its place in the order of execution: small numbers first, instances without a task last.
    fn priority(&self) -> u32 {
        let written = self.task.and_then(|task| task.attribute("priority"));
        let number = written.and_then(|number| number.trim().parse().ok());
        number.unwrap_or(u32::MAX)
    }
}

/// The instances of all programs, in the order of the document.
fn instances<'a, 'i>(root: Node<'a, 'i>) -> Vec<Instance<'a, 'i>> {
    let configured = children(root, "instances").flat_map(|instances| instances.descendants());
    let found = configured.filter(|node| node.tag_name().name() == "pouInstance");
    let instance = |node: Node<'a, 'i>| Instance {
        node,
        task: node
            .parent_element()
            .filter(|parent| parent.tag_name().name() == "task"),
    };
    found.map(instance).collect()
}

/// Name of a program.
fn name<'a>(program: Node<'a, '_>) -> &'a str {
    program.attribute("name").unwrap_or_default().trim()
}

impl Reader {
    /// The programs that run, in the order of execution. A project without instances, such as a library, is taken to
    /// run all of its programs as they are listed.
    pub(super) fn running<'a, 'i>(
        &mut self,
        root: Node<'a, 'i>,
        programs: Vec<Node<'a, 'i>>,
    ) -> Vec<Node<'a, 'i>> {
        let mut instances = instances(root);
        if instances.is_empty() {
            return programs;
        }
        if let Err(fault) = one_scan(&instances) {
            self.report(fault);
        }
        instances.sort_by_key(Instance::priority);
        let mut seen = HashSet::new();
        let mut running = Vec::new();
        for instance in instances {
            let named = instance.program();
            let mut named_so = programs.iter();
            match named_so.find(|program| name(**program).eq_ignore_ascii_case(named)) {
                None => self.report(Fault::at(
                    instance.node,
                    format!("the project has no program `{named}`, which is to run"),
                    "export the project again, with all programs of its tasks",
                )),
                Some(program) if seen.insert(program.id()) => running.push(*program),
                Some(_) => self.report(Fault::at(
                    instance.node,
                    format!("the program `{named}` runs twice"),
                    "a PLC of the family runs a program once in each scan: copy the program",
                )),
            }
        }
        let others = programs.iter().filter(|node| !seen.contains(&node.id()));
        self.not_run = others.map(|program| name(*program).to_owned()).collect();
        running
    }

    /// A note that names the programs that do not run.
    pub(super) fn without_instance(&self) -> Option<Diagnostic> {
        let names: Vec<_> = self.not_run.iter().map(|n| format!("`{n}`")).collect();
        let what = format!("no task runs {}", names.join(", "));
        let note = codes::POU_NOT_RUN.at(Span::default(), what);
        let note = note.label("the program that the tasks run starts here");
        let help = "give them an instance in the configuration if they are part of the program";
        (!names.is_empty()).then(|| note.help(help))
    }
}

/// Checks that one scan can execute all instances: one PLC, and tasks of one interval.
fn one_scan(instances: &[Instance]) -> Result<(), Fault> {
    let mut resources = instances.iter().filter_map(Instance::resource);
    let first = resources.next();
    if let Some(second) = resources.find(|node| Some(*node) != first) {
        let what = format!("{} is another PLC", called(second));
        let help = "export a project for each PLC";
        return Err(Fault::at(second, what, help));
    }
    let tasks = || instances.iter().filter_map(|instance| instance.task);
    let event = |task: &Node| {
        task.attribute("single")
            .unwrap_or_default()
            .trim()
            .to_owned()
    };
    if let Some(task) = tasks().find(|task| !event(task).is_empty()) {
        let what = format!("{} waits for the event `{}`", called(task), event(&task));
        let help = "a PLC of the family executes all programs in each scan: \
                    give the task an interval, and let a contact of this variable begin the networks";
        return Err(Fault::at(task, what, help));
    }
    let interval = |task: &Node| {
        let written = task.attribute("interval").unwrap_or_default().trim();
        let time = variables::milliseconds(written).map(|time| time.to_string());
        time.unwrap_or_else(|| written.to_owned())
    };
    let Some(first) = tasks().next() else {
        return Ok(());
    };
    match tasks().find(|task| interval(task) != interval(&first)) {
        Some(other) => {
            let what = format!(
                "{} has another interval than {}",
                called(other),
                called(first)
            );
            let help = "a PLC of the family executes all programs in each scan: give all tasks one interval";
            Err(Fault::at(other, what, help))
        }
        None => Ok(()),
    }
}
