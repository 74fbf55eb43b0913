//! From rows of rungc.toml to the properties that they stand for.

use crate::template::{Values, fill, placeholders};
use crate::{Demand, Form, Function, Kind, Over, Parameter, Presence, find, library, matrix};
use rungc_host::duration;
use rungc_project::property::{self, PropertyKind, Row, Use, UseSource};
use rungc_project::{Named, Project, device};
use rungc_syntax::{DeviceClass, Diagnostic, Diagnostics, Phrase, Span, codes, diag};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// A property of a project.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Expanded {
    /// The property, as if it were written out.
    pub row: Row,
    /// Conditions that its own are made of, and that a mistake can be in; none if it is written out.
    pub parts: Vec<Part>,
}

/// A condition that a user has written into a function or a matrix.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Part {
    /// The condition, with a place in rungc.toml.
    pub named: Named,
    /// Its place in another file, to begin a message with: `c.csv, row 4, column B: `; else empty.
    pub place: String,
}

impl From<Row> for Expanded {
    fn from(row: Row) -> Self {
        let parts = Vec::new();
        Expanded { row, parts }
    }
}

/// All properties of a project, in the order of its file.
///
/// # Errors
///
/// Unknown functions and parameters, values that do not fit, and mistakes in matrices.
pub fn properties(project: &Project) -> Result<Vec<Expanded>, Diagnostics> {
    let mut found: Vec<Expanded> = project.properties.iter().cloned().map(Into::into).collect();
    let mut wrong = Diagnostics::new();
    for row in &project.uses {
        match of_use(project, row) {
            Ok(properties) => found.extend(properties),
            Err(mistakes) => wrong.extend(mistakes),
        }
    }
    if wrong.has_errors() {
        return Err(wrong);
    }
    found.sort_by_key(|expanded| expanded.row.span.start);
    Ok(found)
}

fn of_use(project: &Project, row: &Use) -> Result<Vec<Expanded>, Vec<Diagnostic>> {
    match &row.source {
        UseSource::Matrix(path) => matrix::properties(project, row, path),
        UseSource::Function {
            function,
            parameters,
        } => {
            let found = find(&function.text).ok_or_else(|| vec![unknown(function)])?;
            let given = Given::read(found, function, parameters)?;
            Ok(given.properties(row))
        }
    }
}

/// Names of all functions, or the one that a misspelt name may mean.
pub(crate) fn hint(name: &str) -> String {
    let names = library::all().map(|function| function.name);
    match diag::did_you_mean(&name.to_lowercase(), names) {
        Some(near) => format!("did you mean `{near}`?"),
        None => "`rungc explain functions` lists them".to_string(),
    }
}

fn unknown(function: &Named) -> Diagnostic {
    let message = format!("unknown safety function `{}`", function.text);
    codes::PROJECT_VALUE
        .at(function.span, message)
        .help(hint(&function.text))
}

/// A function with the values of its parameters.
struct Given {
    function: &'static Function,
    /// Values by the names of parameters, as conditions name them.
    values: BTreeMap<&'static str, Vec<Named>>,
    /// Place of its name.
    at: Span,
}

impl Given {
    fn read(
        function: &'static Function,
        name: &Named,
        parameters: &[property::Parameter],
    ) -> Result<Given, Vec<Diagnostic>> {
        let mut values = BTreeMap::new();
        let mut wrong = Vec::new();
        for given in parameters {
            let mut known = function.parameters.iter();
            let Some(parameter) = known.find(|known| known.name == given.key.text) else {
                wrong.push(unknown_parameter(function, &given.key));
                continue;
            };
            match read_values(parameter, given) {
                Ok(read) => {
                    values.insert(parameter.name, read);
                }
                Err(mistake) => wrong.push(*mistake),
            }
        }
        for parameter in function.parameters {
            let is_given = parameters
                .iter()
                .any(|given| given.key.text == parameter.name);
            match parameter.presence {
                _ if is_given => {}
                Presence::Required => wrong.push(missing(function, name, parameter)),
                Presence::Optional => {}
                Presence::Default(text) => {
                    let (text, span) = (text.to_string(), name.span);
                    values.insert(parameter.name, vec![Named { text, span }]);
                }
            }
        }
        let given = Given {
            function,
            values,
            at: name.span,
        };
        wrong.extend(given.repeated());
        match wrong.is_empty() {
            true => Ok(given),
            false => Err(wrong),
        }
    }

    /// A mistake for the second of two parameters with the same value.
    fn repeated(&self) -> Option<Diagnostic> {
        let parameters = self.function.parameters.iter();
        let parameters = parameters.filter(|parameter| parameter.kind != Kind::Time);
        let mut seen: Vec<(&str, &Named)> = Vec::new();
        for parameter in parameters {
            for named in self.values.get(parameter.name).into_iter().flatten() {
                let earlier = seen
                    .iter()
                    .find(|(_, other)| plain(&other.text) == plain(&named.text));
                if let Some((other, _)) = earlier {
                    let (value, name) = (&named.text, parameter.name);
                    return Some(wrong(
                        named,
                        match *other == name {
                            true => format!("`{value}` is in `{name}` twice"),
                            false => format!("`{value}` is `{other}` and `{name}`"),
                        },
                    ));
                }
                seen.push((parameter.name, named));
            }
        }
        None
    }

    fn properties(&self, row: &Use) -> Vec<Expanded> {
        let demands = self.function.demands.iter();
        demands
            .flat_map(|demand| self.demanded(demand, row))
            .collect()
    }

    /// The properties that a demand becomes: none if a parameter that it needs is not given.
    fn demanded(&self, demand: &Demand, row: &Use) -> Vec<Expanded> {
        let list = |name| self.values.get(name).map_or(&[][..], Vec::as_slice);
        let pairs: Vec<[&str; 2]> = match demand.over {
            Over::Once => vec![["", ""]],
            Over::Each(name) => list(name).iter().map(|a| [&*a.text, ""]).collect(),
            Over::First(name) => list(name).iter().take(1).map(|a| [&*a.text, ""]).collect(),
            Over::Next(name) => list(name)
                .windows(2)
                .map(|pair| [&*pair[0].text, &*pair[1].text])
                .collect(),
            Over::Pairs(name) => {
                let list = list(name);
                let after = |at: usize| list[at + 1..].iter();
                let pairs = list.iter().enumerate();
                pairs
                    .flat_map(|(at, a)| after(at).map(|b| [&*a.text, &*b.text]))
                    .collect()
            }
        };
        let pairs = pairs.into_iter();
        pairs
            .filter_map(|pair| self.property(demand, pair, row))
            .collect()
    }

    fn property(&self, demand: &Demand, pair: [&str; 2], row: &Use) -> Option<Expanded> {
        let filling = Filling { given: self, pair };
        let condition = |template: &str| {
            let text = fill(template, &filling)?;
            let span = self.at;
            Some(Named { text, span })
        };
        let kind = match demand.form {
            Form::Never(only) => PropertyKind::Never(condition(only)?),
            Form::Reachable(only) => PropertyKind::Reachable(condition(only)?),
            Form::Whenever { when, then, within } => PropertyKind::Whenever {
                when: condition(when)?,
                then: condition(then)?,
                within: Some(self.values.get(within)?.first()?.clone()),
            },
            Form::Stays {
                after,
                holds,
                until,
            } => PropertyKind::Stays {
                after: match after {
                    "" => None,
                    after => Some(condition(after)?),
                },
                holds: condition(holds)?,
                until: Some(condition(until)?),
            },
        };
        let name = fill(demand.name, &filling)?;
        let name = format!("{}: {name}", self.function.name);
        let name = match &row.name {
            Some(own) => format!("{own}, {name}"),
            None => name,
        };
        Some(Expanded {
            row: Row {
                name: Some(name),
                requirement: row.requirement.clone(),
                kind,
                span: row.span,
            },
            parts: self.parts(&demand.form),
        })
    }

    /// The conditions that a user has written and a form uses.
    fn parts(&self, form: &Form) -> Vec<Part> {
        let templates = form.templates();
        let names = templates.iter().flat_map(|template| placeholders(template));
        let mut parts: Vec<Part> = Vec::new();
        for name in names {
            let mut known = self.function.parameters.iter();
            let is_condition = known.any(|known| known.name == name && known.kind != Kind::Time);
            for named in self.values.get(name).into_iter().flatten() {
                let (named, place) = (named.clone(), String::new());
                let part = Part { named, place };
                if is_condition && !parts.contains(&part) {
                    parts.push(part);
                }
            }
        }
        parts
    }
}

/// Values for the templates of a demand.
struct Filling<'g> {
    given: &'g Given,
    /// The devices of [`Over`].
    pair: [&'g str; 2],
}

impl Values for Filling<'_> {
    fn value(&self, name: &str) -> Option<Cow<'_, str>> {
        match (name, self.pair) {
            ("a", [a, _]) if !a.is_empty() => return Some(a.into()),
            ("b", [_, b]) if !b.is_empty() => return Some(b.into()),
            _ => {}
        }
        match &self.given.values.get(name)?[..] {
            [only] => Some((&*only.text).into()),
            several => {
                let texts: Vec<_> = several.iter().map(|named| &*named.text).collect();
                Some(texts.join(" | ").into())
            }
        }
    }
}

fn wrong(at: &Named, message: impl Into<Phrase>) -> Diagnostic {
    codes::PROJECT_VALUE.at(at.span, message)
}

/// Spelling of a condition that is compared with others.
fn plain(text: &str) -> String {
    let letters = text.chars().filter(|c| !c.is_whitespace() && *c != '"');
    let text: String = letters.collect();
    let upper = text.to_uppercase();
    device::device(&upper).map_or(upper, |device| device.to_string())
}

fn unknown_parameter(function: &Function, key: &Named) -> Diagnostic {
    let names = function.parameters.iter().map(|parameter| parameter.name);
    let near = diag::did_you_mean(&key.text, names.clone());
    let help = match near.filter(|near| near.len() > 1) {
        Some(near) => format!("did you mean `{near}`?"),
        None => {
            let names: Vec<_> = names.map(|name| format!("`{name}`")).collect();
            format!("its parameters are {}", names.join(", "))
        }
    };
    let message = format!("`{}` has no parameter `{}`", function.name, key.text);
    codes::PROJECT_KEY.at(key.span, message).help(help)
}

fn missing(function: &Function, name: &Named, parameter: &Parameter) -> Diagnostic {
    let (key, text) = (parameter.name, parameter.text);
    let example = example(parameter.kind);
    let message = format!("`{}` requires `{key}`: {text}", function.name);
    wrong(name, message).help(format!("add `{key} = {example}`"))
}

/// A value of a kind, as in rungc.toml.
fn example(kind: Kind) -> &'static str {
    match kind {
        Kind::Condition => "\"X000\"",
        Kind::Device | Kind::Devices => "\"Y000\"",
        Kind::Several => "[\"M0\", \"M1\"]",
        Kind::Time => "\"500ms\"",
    }
}

/// The values of a parameter, checked and in the spelling of conditions.
fn read_values(
    parameter: &Parameter,
    given: &property::Parameter,
) -> Result<Vec<Named>, Box<Diagnostic>> {
    let (name, kind) = (parameter.name, parameter.kind);
    match (kind, &given.values[..]) {
        (_, []) => {
            let message = format!("`{name}` has no value: {}", parameter.text);
            Err(Box::new(wrong(&given.key, message)))
        }
        (Kind::Several, [only]) => {
            let message = format!("`{name}` is a list of at least two devices");
            let help = format!("write `{name} = {}`", example(kind));
            Err(Box::new(wrong(only, message).help(help)))
        }
        (Kind::Condition | Kind::Device | Kind::Time, [_, second, ..]) => {
            let message = format!("`{name}` is one {}, not a list", kind.describe());
            Err(Box::new(wrong(second, message)))
        }
        (Kind::Time, values) => match duration::parse(&values[0].text) {
            Ok(_) => Ok(values.to_vec()),
            Err(why) => Err(Box::new(wrong(&values[0], why))),
        },
        (Kind::Condition, values) => Ok(values.iter().map(trimmed).collect()),
        (_, values) => values.iter().map(|value| switched(name, value)).collect(),
    }
}

fn trimmed(value: &Named) -> Named {
    Named {
        text: value.text.trim().to_string(),
        span: value.span,
    }
}

/// A device that programs switch, or a name of one.
fn switched(parameter: &str, value: &Named) -> Result<Named, Box<Diagnostic>> {
    let text = value.text.trim();
    let with = |text: String| Named {
        text,
        span: value.span,
    };
    if let Some(device) = device::device(&text.to_uppercase()) {
        let why = match device.class {
            DeviceClass::Y | DeviceClass::M | DeviceClass::S => {
                return Ok(with(device.to_string()));
            }
            DeviceClass::X => "an input, which no program switches",
            _ => "not a bit that a program switches",
        };
        let message = format!("`{text}` is {why}");
        return Err(Box::new(
            wrong(value, message).help(format!("`{parameter}` is a device Y, M or S")),
        ));
    }
    let inner = text.strip_prefix('"').and_then(|t| t.strip_suffix('"'));
    if let Some(inner) = inner.filter(|inner| !inner.is_empty() && !inner.contains('"')) {
        return Ok(with(format!("\"{inner}\"")));
    }
    if text.is_empty() || text.contains(|c: char| "&|!()=<>\"".contains(c)) {
        let message = format!("`{parameter}` is a device, not a condition: `{text}`");
        return Err(Box::new(wrong(value, message)));
    }
    Ok(with(format!("\"{text}\"")))
}
