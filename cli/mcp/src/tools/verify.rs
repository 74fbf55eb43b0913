//! `verify`: what a program never does.

use super::{Answer, Call, PROGRAM, Tool, list, object, string};
use crate::arguments::{Kind, Parameter};
use rungc::Project;
use rungc_host::duration;
use rungc_ir::Module;
use rungc_lower::compile::CompileOptions;
use rungc_project::Project as Settings;
use rungc_sim::property::{Condition, ParseError, Property};
use rungc_verify::model::World;
use rungc_verify::prove::{Decision, EFFORT, Options, Verdict, decide};
use rungc_verify::request::{self, ExternalWrites, Reader, stated};
use rungc_verify::words;
use serde_json::{Value, json};
use std::time::Duration;

const PARAMETERS: &[Parameter] = &[
    Parameter::optional(
        "never",
        Kind::Texts,
        "conditions that must never hold after a scan, such as [\"Y000 & Y001\", \"Y000 & !X003\", \"D0 > \
        100\"]; comments of devices are written in quotes",
    ),
    Parameter::optional(
        "always",
        Kind::Texts,
        "conditions that must hold after every scan, such as [\"Y000 -> X003\"]",
    ),
    Parameter::optional(
        "reachable",
        Kind::Texts,
        "conditions that some run must reach, such as [\"Y000\"]",
    ),
    Parameter::optional(
        "assume",
        Kind::Texts,
        "conditions that hold after every scan, such as [\"!(X001 & X002)\"]",
    ),
    Parameter::optional(
        "free",
        Kind::Texts,
        "devices that something outside writes although the program does, such as a panel: [\"M500\", \
        \"D100..D109\"]",
    ),
    Parameter::optional(
        "scan_ms",
        Kind::Whole(1, 32_767),
        "the longest time from one scan to the next; default: 200",
    ),
    Parameter::optional(
        "cleared",
        Kind::Flag,
        "latched devices start at 0, as on a new PLC, instead of at any value",
    ),
    Parameter::optional(
        "timeout_ms",
        Kind::Whole(1, 600_000),
        "time limit for each property; default: 60000",
    ),
];

pub(super) const TOOL: Tool = Tool {
    name: "verify",
    title: "Prove properties",
    text: "Decides whether a program can ever do something, in any run from power-on with any inputs: proved, \
    violated (with the shortest run found), or not decided. Without properties, those of rungc.toml. A proof \
    is about the program under the listed assumptions: repeat them to the user. rungc://book/prove describes \
    conditions.",
    parameters: &[PROGRAM, PARAMETERS],
    output,
    writes: false,
    call,
};

fn output() -> Value {
    object(&[
        ("file", string()),
        (
            "results",
            list(object(&[
                ("property", string()),
                ("verdict", string()),
                ("details", string()),
            ])),
        ),
        ("assumptions", list(string())),
        ("warnings", list(string())),
    ])
}

/// A property as requested.
struct Requested {
    text: String,
    property: Property,
}

fn call(call: &mut Call) -> Result<Answer, String> {
    let project = call.whole()?;
    super::compiled(&project)?;
    let options =
        rungc::settings::compiling(project.settings(), project.file(), Some(project.plc()), &[]);
    let reader = Reader {
        program: project.source(),
        options: &options,
    };
    let settings = project
        .settings()
        .filter(|settings| settings.is_about(project.file()));
    let requested = requested(call, reader, settings)?;
    let assumed = assumed(call, reader, settings)?;
    let names = project.names();
    let free = call.arguments.texts("free");
    let free: Result<Vec<_>, String> = free.iter().map(|text| names.range(text.trim())).collect();
    let external = ExternalWrites::of(
        Some(&free.map_err(|why| format!("`free`: {why}"))?),
        settings,
    );
    let proving = proving(call, settings, &assumed, &external)?;
    let module = module(&project, options.clone(), &requested, &proving, &external)?;
    let mut decided = Vec::new();
    for one in &requested {
        if call.is_cancelled() {
            return Err("the call was cancelled".to_owned());
        }
        decided.push(decide(&module, &one.property, &proving));
    }
    let assumed: Vec<String> = assumed.into_iter().map(|(text, _)| text).collect();
    if decided
        .iter()
        .any(|decision| decision.verdict == Verdict::Proved)
        && let Some(why) = words::vacuous([&module], &proving, &assumed)
    {
        for decision in decided
            .iter_mut()
            .filter(|decision| decision.verdict == Verdict::Proved)
        {
            decision.proof = None;
            decision.verdict = Verdict::Undecided(why.clone());
        }
    }
    let texts = requested
        .iter()
        .map(|one| (one.text.as_str(), &one.property));
    let undriven = request::undriven(texts, project.source(), &options, &external);
    let undriven: Vec<String> = undriven
        .iter()
        .map(|found| found.message.to_string())
        .collect();
    let supposed = words::assumptions(&proving.world, &assumed, &external);
    let file = call.name(&project);
    Ok(answer(
        &file,
        (&requested, &decided),
        (&module, &external),
        (supposed, undriven),
    ))
}

/// The properties of the arguments, else those of the settings.
fn requested(
    call: &Call,
    reader: Reader,
    settings: Option<&Settings>,
) -> Result<Vec<Requested>, String> {
    type Form = fn(Condition) -> Property;
    let forms: [(&str, Form); 3] = [
        ("never", Property::Never),
        ("always", Property::Always),
        ("reachable", Property::Reachable),
    ];
    let mut requested = Vec::new();
    for (name, form) in forms {
        for text in call.arguments.texts(name) {
            let condition = reader.condition(&text);
            let property = form(condition.map_err(|error| pointed(name, &text, &error))?);
            if let Some((_, why)) = reader.senseless(&property) {
                return Err(format!("`{name}`: `{text}`: {why}"));
            }
            requested.push(Requested {
                text: format!("{name} {text}"),
                property,
            });
        }
    }
    let settings = settings.filter(|settings| requested.is_empty() && settings.has_properties());
    if let Some(settings) = settings {
        let rows = rungc_functions::properties(settings);
        let rows = rows.map_err(|wrong| {
            let wrong: Vec<_> = wrong.iter().map(|one| one.message.to_string()).collect();
            format!("{}: {}", call.files.shown(&settings.path), wrong.join("; "))
        })?;
        for expanded in rows {
            let row = &expanded.row;
            let property = reader.property(&row.kind);
            let property =
                property.map_err(|(named, why)| format!("rungc.toml: `{}`: {why}", named.text))?;
            requested.push(Requested {
                text: stated(row),
                property,
            });
        }
    }
    match requested.is_empty() {
        true => Err(
            "no property: pass `never`, `always` or `reachable`, such as \"never\": [\"Y000 & Y001\"]"
                .to_owned(),
        ),
        false => Ok(requested),
    }
}

/// A mistake in a condition, with its place.
fn pointed(name: &str, text: &str, error: &ParseError) -> String {
    let before = text[..error.at.min(text.len())].chars().count();
    format!(
        "`{name}`: {}\n  {text}\n  {}^",
        error.why,
        " ".repeat(before)
    )
}

/// The assumptions of the settings and of the arguments.
fn assumed(
    call: &Call,
    reader: Reader,
    settings: Option<&Settings>,
) -> Result<Vec<(String, Condition)>, String> {
    let own = settings
        .into_iter()
        .flat_map(|settings| &settings.verify.assume);
    let texts = own
        .map(|named| named.text.clone())
        .chain(call.arguments.texts("assume"));
    let read = texts.map(|text| {
        let condition = reader
            .assumption(&text)
            .map_err(|error| pointed("assume", &text, &error))?;
        Ok((text, condition))
    });
    read.collect()
}

/// Assumptions about the environment of the program, and the limits.
fn proving(
    call: &Call,
    settings: Option<&Settings>,
    assumed: &[(String, Condition)],
    external: &ExternalWrites,
) -> Result<Options, String> {
    const USUAL_MS: u64 = 60_000;
    let verify = settings.map(|settings| &settings.verify);
    let named = verify.and_then(|verify| verify.scan.as_ref());
    let named = named
        .map(|named| duration::parse(&named.text))
        .transpose()?;
    let usual = World::default();
    let scan_ms = call.arguments.whole("scan_ms").or(named);
    Ok(Options {
        world: World {
            scan_ms: scan_ms
                .and_then(|ms| u32::try_from(ms).ok())
                .unwrap_or(usual.scan_ms),
            fresh: call.arguments.flag("cleared"),
            free: external.devices.keys().copied().collect(),
            ..usual
        },
        assumed: assumed
            .iter()
            .map(|(_, condition)| condition.clone())
            .collect(),
        effort: verify
            .and_then(|verify| verify.effort)
            .map_or(EFFORT, u64::from),
        time: Some(Duration::from_millis(
            call.arguments.whole("timeout_ms").unwrap_or(USUAL_MS),
        )),
    })
}

fn module(
    project: &Project,
    options: CompileOptions,
    requested: &[Requested],
    proving: &Options,
    external: &ExternalWrites,
) -> Result<Module, String> {
    let conditions = requested.iter().flat_map(|one| one.property.conditions());
    let conditions = conditions.chain(&proving.assumed);
    let module = request::module(project.source(), options, conditions, external);
    module.ok_or_else(|| "the program has errors; `check` lists them".to_owned())
}

fn answer(
    file: &str,
    (requested, decided): (&[Requested], &[Decision]),
    (module, external): (&Module, &ExternalWrites),
    (supposed, undriven): (Vec<String>, Vec<String>),
) -> Answer {
    let mut text = String::new();
    let mut results = Vec::new();
    for (one, decision) in requested.iter().zip(decided) {
        let verdict = words::word(decision, &one.property);
        let mut details = String::new();
        if let Verdict::Undecided(why) = &decision.verdict {
            details.push_str(&format!("            {}\n", words::reason(why)));
        }
        words::describe(&mut details, module, (&one.property, decision), external);
        text.push_str(&format!("{verdict:<11} {}\n{details}", one.text));
        results.push(json!({ "property": one.text, "verdict": verdict, "details": details }));
    }
    for warning in &undriven {
        text.push_str(&format!("warning: {warning}\n"));
    }
    text.push_str("Decided for this model under these assumptions:\n");
    for line in &supposed {
        text.push_str(&format!("  - {line}\n"));
    }
    let data =
        json!({ "file": file, "results": results, "assumptions": supposed, "warnings": undriven });
    Answer { text, data }
}
