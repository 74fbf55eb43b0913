//! A case whose PLC is wired to a machine.

use super::runner::Running;
use super::{Failure, Setting, Signal, Step, Value};
use crate::engines::EngineError;
use crate::plant::{Axis, Description, Look, Process, Terminals};
use crate::protocol::{Answer, Request};
use crate::target::Channel;
use crate::wire::Change;
use rungc_models::{Model, ModelId};
use rungc_rt::Class;
use rungc_syntax::DeviceClass;

/// Checks that a case and its machine fit each other.
pub(super) fn check(
    machine: Option<&Description>,
    model: ModelId,
    init: &[Setting],
    steps: &[Step],
) -> Result<(), Failure> {
    let wrong = |step, message| Err(Failure::Machine { step, message });
    let Some(machine) = machine else {
        let uses = |step: &Step| !step.expect_position.is_empty();
        return match steps.iter().position(uses) {
            Some(i) => wrong(i + 1, "the case has no `machine`".to_string()),
            None => Ok(()),
        };
    };
    if let Err(error) = machine.check(Model::get(model)) {
        return wrong(0, error.to_string());
    }
    let plant = machine.plant();
    let begin = (0, inputs_of(init, &[]));
    let of_steps = steps.iter().enumerate();
    let of_steps = of_steps.map(|(i, step)| (i + 1, inputs_of(&step.set, &step.signals)));
    for (step, inputs) in [begin].into_iter().chain(of_steps) {
        if let Some(input) = inputs
            .into_iter()
            .find(|&n| machine.drives(DeviceClass::X, n))
        {
            let name = DeviceClass::X.number(input);
            return wrong(step, format!("`{name}` is driven by {}", machine.name()));
        }
    }
    for (i, step) in steps.iter().enumerate() {
        for (name, _) in &step.expect_position {
            let names = plant.axes().iter().map(Axis::name);
            let names: Vec<_> = names
                .chain(plant.processes().iter().map(Process::name))
                .collect();
            if !names.contains(&name.as_str()) {
                let message = format!("unknown axis `{name}`; available: {}", names.join(", "));
                return wrong(i + 1, message);
            }
        }
    }
    Ok(())
}

/// The input terminals that a step sets or gives signals to.
fn inputs_of(set: &[Setting], signals: &[Signal]) -> Vec<u32> {
    let set = set.iter().map(|setting| setting.target.devices(0));
    let of_x = set.filter(|&(class, ..)| class == DeviceClass::X);
    let mut inputs: Vec<u32> = of_x.flat_map(|(_, n, count)| n..n + count).collect();
    for signal in signals {
        match *signal {
            Signal::Pulses { input, .. } => inputs.push(input),
            Signal::Encoder { a, b, .. } => inputs.extend([a, b]),
        }
    }
    inputs
}

impl Running<'_> {
    /// The inputs are as the machine has them when it is switched on.
    pub(super) fn wire_up(&mut self) -> Result<(), Failure> {
        let inputs = self.plant.as_ref().map_or(Vec::new(), |p| p.inputs());
        for (number, on) in inputs {
            self.input(number, on)?;
            self.execute(Request::SetBit(Class::X, number, on))?;
        }
        let Some(mut plant) = self.plant.take() else {
            return Ok(());
        };
        plant.measure(self)?;
        self.plant = Some(plant);
        Ok(())
    }

    /// A millisecond passes, in which these inputs change, too; their times are since power-on.
    pub(super) fn move_machine(&mut self, now_ms: u32, others: &[Change]) -> Result<(), Failure> {
        if self.plant.is_none() && others.is_empty() {
            return Ok(());
        }
        // Without a machine, there are only these inputs.
        let mut plant = self.plant.take().unwrap_or_default();
        plant.step(now_ms.into(), others, self)?;
        let collision = plant.collision().map(ToString::to_string);
        self.plant = Some(plant);
        match collision {
            Some(message) => Err(Failure::Machine {
                step: self.step,
                message,
            }),
            None => Ok(()),
        }
    }

    /// Axes that are not where they are expected: name, expected and actual position of each.
    pub(super) fn wrong_positions(
        &self,
        expected: &[(String, f64)],
    ) -> Vec<(String, Value, Value)> {
        let Some(plant) = &self.plant else {
            return Vec::new();
        };
        let axes = expected
            .iter()
            .filter_map(|(name, at)| Some((plant.axis(name)?, *at)));
        let axes = axes
            .filter(|(axis, at)| !axis.is_at(*at))
            .map(|(axis, at)| {
                let name = format!("the position of {}", axis.name());
                (name, Value::Float(at), Value::Float(axis.position()))
            });
        let processes = plant.processes().iter().flat_map(|process| {
            let expected = expected.iter().filter(|(name, _)| name == process.name());
            expected.map(move |(_, at)| (process, *at))
        });
        let processes =
            processes
                .filter(|(process, at)| !process.is_at(*at))
                .map(|(process, at)| {
                    let name = format!("the value of {}", process.name());
                    (name, Value::Float(at), Value::Float(process.value()))
                });
        axes.chain(processes).collect()
    }
}

impl Running<'_> {
    /// Requests for these queries.
    fn requests(&self, at: &[Look]) -> Vec<Request> {
        let now_ms = self.now_ms();
        let request = |look: &Look| match *look {
            Look::Output(output) => Request::Output(output),
            Look::Pulses(output) => Request::Pulses(output),
            Look::Channel(channel) => Request::Signal { now_ms, channel },
        };
        at.iter().map(request).collect()
    }

    /// The requested values.
    fn values(&mut self, requests: &[Request]) -> Result<Vec<i32>, Failure> {
        let answers = self.engine.execute_all(requests);
        let answers = answers.map_err(|error| self.failed(&error))?;
        let values = answers
            .iter()
            .zip(requests)
            .map(|(answer, &request)| match answer {
                Answer::Value(value) => Ok(*value as i32),
                _ => Err(self.failed(&EngineError::Missing(request))),
            });
        values.collect()
    }
}

impl Terminals for Running<'_> {
    type Error = Failure;

    fn look(&mut self, at: &[Look]) -> Result<Vec<i32>, Failure> {
        self.values(&self.requests(at))
    }

    fn pass(
        &mut self,
        [from_us, until_us]: [u32; 2],
        most: u32,
        at: &[Look],
    ) -> Result<(u32, Vec<i32>), Failure> {
        if !self.sends_pulses() {
            return Ok((until_us, self.look(at)?));
        }
        let pass = Request::Pass {
            from_us,
            until_us,
            most,
        };
        let mut requests = vec![pass];
        requests.extend(self.requests(at));
        let mut values = self.values(&requests)?;
        Ok((values.remove(0) as u32, values))
    }

    fn change(&mut self, change: Change) -> Result<(), Failure> {
        self.execute(Request::SetBit(Class::X, change.input, change.on))?;
        self.input(change.input, change.on)?;
        self.interrupts()
    }

    fn connect(&mut self, channel: Channel, millionths: i32) -> Result<(), Failure> {
        match self.connect_channel(channel, millionths)? {
            true => Ok(()),
            false => Err(Failure::Machine {
                step: self.step,
                message: channel.missing(),
            }),
        }
    }
}
