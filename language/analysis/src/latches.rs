//! Devices that retain their values over power-off: by the model, and for some devices by the project's parameters.

use rungc_models::runs::is_border;
use rungc_models::{Model, Range};
use rungc_syntax::DeviceClass::{C, D, M, S};
use rungc_syntax::{
    Device, DeviceClass, DeviceRun, Diagnostics, Phrase, Program, Span, codes, phrase,
};
use std::borrow::Cow;

/// The latched ranges that the editors write for every CPU type, also for those that do not take them.
const USUAL: [(DeviceClass, u32, u32); 5] = [
    (M, 500, 524),
    (S, 500, 500),
    (C, 100, 100),
    (C, 220, 36),
    (D, 200, 312),
];

/// The devices of the model, with the latched ones that the program's project has chosen among those for which that can
/// be done.
pub fn ranges(program: &Program, model: &Model) -> Cow<'static, [Range]> {
    let latched = program
        .parameters
        .as_ref()
        .and_then(|p| p.latched.as_deref());
    let Some(latched) = latched.filter(|_| !model.latch_choices.is_empty()) else {
        return Cow::Borrowed(model.ranges);
    };
    let pieces = model.ranges.iter().flat_map(|&range| {
        let starts = borders(range, model, latched);
        let next = starts.clone().into_iter().skip(1).map(|start| start - 1);
        let ends: Vec<_> = next.chain([range.last]).collect();
        starts
            .into_iter()
            .zip(ends)
            .map(move |(first, last)| Range {
                first,
                last,
                latched: is_latched(range, first, model, latched),
                ..range
            })
    });
    let mut ranges: Vec<Range> = pieces.collect();
    ranges.dedup_by(|next, last| {
        let joined = (last.class, last.latched, last.last + 1)
            == (next.class, next.latched, next.first)
            && !is_border(next.class, next.first)
            && (model.can_choose_latch(next.class, last.last)
                || model.can_choose_latch(next.class, next.first));
        if joined {
            last.last = next.last;
        }
        joined
    });
    match ranges == model.ranges {
        true => Cow::Borrowed(model.ranges),
        false => Cow::Owned(ranges),
    }
}

/// Numbers in a range at which something may change, its beginning included, in order.
fn borders(range: Range, model: &Model, latched: &[DeviceRun]) -> Vec<u32> {
    let can = |number| model.can_choose_latch(range.class, number);
    let chosen = |&number: &u32| can(number) || number.checked_sub(1).is_some_and(can);
    let choices = model.latch_choices.iter().filter(|c| c.0 == range.class);
    let runs = latched.iter().filter(|run| run.class == range.class);
    let mut borders: Vec<u32> = choices
        .flat_map(|&(_, first, last)| [first, last + 1])
        .chain(runs.flat_map(|run| [run.first, end(run)]).filter(chosen))
        .filter(|number| (range.first + 1..=range.last).contains(number))
        .chain([range.first])
        .collect();
    borders.sort();
    borders.dedup();
    borders
}

/// The number after the last of a run.
fn end(run: &DeviceRun) -> u32 {
    run.first.saturating_add(run.count)
}

fn is_latched(range: Range, number: u32, model: &Model, latched: &[DeviceRun]) -> bool {
    match model.can_choose_latch(range.class, number) {
        true => latched
            .iter()
            .any(|run| run.class == range.class && (run.first..end(run)).contains(&number)),
        false => range.latched,
    }
}

/// Warns of variables that are to keep their values, but whose devices are not latched.
fn retained(program: &Program, model: &Model, out: &mut Diagnostics) {
    let ranges = ranges(program, model);
    let is_latched = |device: &Device| {
        let of_class = ranges.iter().filter(|range| range.class == device.class);
        let mut around =
            of_class.filter(|range| (range.first..=range.last).contains(&device.number));
        // A device that the model does not have is an error elsewhere.
        around.next().is_none_or(|range| range.latched)
    };
    for run in &program.retained {
        let devices = (run.first..end(run)).map(|number| Device {
            class: run.class,
            number,
        });
        let Some(lost) = devices.into_iter().find(|device| !is_latched(device)) else {
            continue;
        };
        let comment = program.comments.get(&lost);
        let named = comment.map_or_else(|| "".into(), |text| format!(" ({text})"));
        let what = phrase!(
            "`{lost}`{named} is to keep its value over power-off, but is not latched on {model}",
            lost,
            named,
            model = model.name
        );
        let warning = codes::RETAINED.at(Span::default(), what);
        out.push(warning.label("the project says RETAIN").help(
            "name a latched device in `[plcopen]` of rungc.toml, or add this one to `[latched]`",
        ));
    }
}

/// Checks a project's parameters against the model.
pub fn check(program: &Program, model: &Model) -> Diagnostics {
    let mut out = Diagnostics::new();
    retained(program, model, &mut out);
    let Some(parameters) = &program.parameters else {
        return out;
    };
    let mut warn = |message: Phrase, taken: Phrase| {
        let warning = codes::PARAMETER_RANGE.at(Span::default(), message);
        out.push(warning.label(taken).help(
            "change the PLC parameters in the editor, or choose another model with `--model`",
        ));
    };
    for run in parameters.latched.iter().flatten() {
        let usual = (run.class, run.first, run.count);
        let fits = |number| {
            model.can_choose_latch(run.class, number)
                || model
                    .range(run.class, number)
                    .is_some_and(|range| range.latched)
        };
        let fixed = model.latch_choices.is_empty();
        if fixed && USUAL.contains(&usual) {
            continue;
        }
        let Some(wrong) = (run.first..end(run)).find(|&number| !fits(number)) else {
            continue;
        };
        let device = |number| Device {
            class: run.class,
            number,
        };
        let range = phrase!(
            "`{first}` to `{run}`",
            first = device(run.first),
            run = device(end(run) - 1)
        );
        let name = model.name;
        match fixed {
            true => warn(
                phrase!(
                    "the parameters latch {range}, but the latched devices of {name} are fixed",
                    range,
                    name
                ),
                phrase!("the model's own are used"),
            ),
            false => warn(
                phrase!(
                    "the parameters latch {range}, but {name} cannot latch all of them",
                    range,
                    name
                ),
                phrase!(
                    "the others are latched; `{wrong}` is the first that is not",
                    wrong = device(wrong)
                ),
            ),
        }
    }
    let capacity = parameters
        .capacity
        .filter(|&steps| steps > model.memory_steps);
    if let Some(steps) = capacity {
        let message = phrase!(
            "the parameters set a memory of {steps} steps, but {model} has {memory_steps}",
            steps,
            model = model.name,
            memory_steps = model.memory_steps
        );
        warn(
            message,
            phrase!(
                "{memory_steps} steps are used",
                memory_steps = model.memory_steps
            ),
        );
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use rungc_models::ModelId;
    use rungc_syntax::Parameters;

    #[test]
    fn retained_variables_need_latched_devices() {
        let run = |first| DeviceRun {
            class: D,
            first,
            count: 2,
        };
        let mut program = Program {
            retained: vec![run(100), run(199), run(200)],
            ..Program::default()
        };
        let device = |number| Device { class: D, number };
        program.comments.insert(device(100), "pieces".to_owned());
        let found = check(&program, Model::get(ModelId::Fx3u));
        let found: Vec<_> = found
            .iter()
            .map(|found| found.message.to_string())
            .collect();
        assert_eq!(
            found,
            [
                "`D100` (pieces) is to keep its value over power-off, but is not latched on fx3u",
                "`D199` is to keep its value over power-off, but is not latched on fx3u",
            ]
        );
    }

    fn program(latched: &[(DeviceClass, u32, u32)]) -> Program {
        let run = |&(class, first, count)| DeviceRun {
            class,
            first,
            count,
        };
        let latched = Some(latched.iter().map(run).collect());
        Program {
            parameters: Some(Parameters {
                latched,
                ..Parameters::default()
            }),
            ..Program::default()
        }
    }

    fn latched_of(program: &Program, id: ModelId, class: DeviceClass) -> Vec<(u32, u32)> {
        let ranges = ranges(program, Model::get(id));
        let latched = ranges.iter().filter(|r| r.class == class && r.latched);
        latched.map(|r| (r.first, r.last)).collect()
    }

    #[test]
    fn the_usual_choice_is_that_of_the_models() {
        for id in ModelId::ALL {
            let model = Model::get(id);
            let program = program(&USUAL);
            assert!(
                matches!(ranges(&program, model), Cow::Borrowed(_)),
                "{}",
                model.name
            );
            assert_eq!(check(&program, model).iter().count(), 0, "{}", model.name);
        }
    }

    #[test]
    fn choices_replace_latched_devices_where_the_model_lets_them() {
        let chosen = program(&[(M, 0, 10), (D, 100, 10), (C, 190, 20)]);
        let fx2n = |class| latched_of(&chosen, ModelId::Fx2n, class);
        assert_eq!(fx2n(M), [(0, 9), (1024, 3071)]);
        assert_eq!(fx2n(S), []);
        assert_eq!(fx2n(C), [(190, 199), (200, 209)]);
        assert_eq!(fx2n(D), [(100, 109), (512, 7999)]);
        let wide = program(&[(M, 400, 2000)]);
        assert_eq!(latched_of(&wide, ModelId::Fx2n, M), [(400, 3071)]);
        assert_eq!(latched_of(&chosen, ModelId::Fx1n, M), [(384, 1535)]);
    }

    #[test]
    fn memory_may_be_larger_than_a_program() {
        for model in ModelId::ALL.map(Model::get) {
            assert!(model.memory_steps >= model.max_steps, "{}", model.name);
            for (capacity, expected) in [(model.memory_steps, 0), (model.memory_steps + 500, 1)] {
                let program = Program {
                    parameters: Some(Parameters {
                        capacity: Some(capacity),
                        ..Parameters::default()
                    }),
                    ..Program::default()
                };
                let found = check(&program, model).iter().count();
                assert_eq!(found, expected, "{} {capacity}", model.name);
            }
        }
        // 16,000 steps, of which 4,000 are for the program.
        let fx3s = Model::get(ModelId::Fx3s);
        assert_eq!((fx3s.memory_steps, fx3s.max_steps), (16000, 4000));
    }
}
