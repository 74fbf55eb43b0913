//! Arguments of tools: described once, for the schema that a client shows its assistant and for the check of a call.

use rungc_syntax::diag::did_you_mean;
use serde_json::{Map, Value, json};

/// A parameter of a tool.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Parameter {
    pub(crate) name: &'static str,
    pub(crate) kind: Kind,
    pub(crate) required: bool,
    /// Meaning, with an example.
    pub(crate) text: &'static str,
}

impl Parameter {
    pub(crate) const fn optional(name: &'static str, kind: Kind, text: &'static str) -> Self {
        Parameter {
            name,
            kind,
            required: false,
            text,
        }
    }

    pub(crate) const fn required(name: &'static str, kind: Kind, text: &'static str) -> Self {
        Parameter {
            name,
            kind,
            required: true,
            text,
        }
    }
}

/// Kinds of values.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Kind {
    Text,
    Flag,
    /// An integer, at least and at most.
    Whole(u64, u64),
    /// A list of texts.
    Texts,
    Choice(&'static [&'static str]),
    /// What is set when: `[{"at_ms": 0, "set": {"X000": true}}]`.
    Inputs,
}

/// Length of the longest list in an argument.
const MOST_ITEMS: usize = 1_000;

/// The schema of an object with these parameters.
pub(crate) fn schema(parameters: &[&[Parameter]]) -> Value {
    let all = || parameters.iter().copied().flatten();
    let properties: Map<String, Value> = all()
        .map(|parameter| {
            let mut schema = kind_schema(parameter.kind);
            schema["description"] = json!(parameter.text);
            (parameter.name.to_owned(), schema)
        })
        .collect();
    let required: Vec<&str> = all()
        .filter(|one| one.required)
        .map(|one| one.name)
        .collect();
    let mut schema = json!({
        "type": "object",
        "properties": properties,
        "additionalProperties": false,
    });
    if !required.is_empty() {
        schema["required"] = json!(required);
    }
    schema
}

fn kind_schema(kind: Kind) -> Value {
    match kind {
        Kind::Text => json!({ "type": "string" }),
        Kind::Flag => json!({ "type": "boolean" }),
        Kind::Whole(least, most) => json!({ "type": "integer", "minimum": least, "maximum": most }),
        Kind::Texts => {
            json!({ "type": "array", "items": { "type": "string" }, "maxItems": MOST_ITEMS })
        }
        Kind::Choice(choices) => json!({ "type": "string", "enum": choices }),
        Kind::Inputs => json!({
            "type": "array",
            "maxItems": MOST_ITEMS,
            "items": {
                "type": "object",
                "properties": {
                    "at_ms": { "type": "integer", "minimum": 0 },
                    "set": {
                        "type": "object",
                        "additionalProperties": { "type": ["boolean", "number"] },
                    },
                },
                "required": ["set"],
                "additionalProperties": false,
            },
        }),
    }
}

/// Arguments of a call, which fit the parameters.
#[derive(Debug)]
pub(crate) struct Arguments(Map<String, Value>);

impl Arguments {
    /// Checks arguments.
    ///
    /// # Errors
    /// What is wrong with one of them, and what to write.
    pub(crate) fn new(
        given: Map<String, Value>,
        parameters: &[&[Parameter]],
    ) -> Result<Self, String> {
        let all = || parameters.iter().copied().flatten();
        let is_given = |name: &str| given.get(name).is_some_and(|value| !value.is_null());
        if let Some(missing) = all().find(|one| one.required && !is_given(one.name)) {
            let (name, text) = (missing.name, missing.text);
            return Err(format!("`{name}` is missing: {text}"));
        }
        for (name, value) in &given {
            match all().find(|one| one.name == name) {
                None => return Err(unknown(name, all().map(|one| one.name))),
                Some(one) if !value.is_null() => fits(one, value)?,
                Some(_) => {}
            }
        }
        Ok(Arguments(given))
    }

    pub(crate) fn text(&self, name: &str) -> Option<&str> {
        self.0.get(name)?.as_str()
    }

    pub(crate) fn flag(&self, name: &str) -> bool {
        self.0.get(name).and_then(Value::as_bool).unwrap_or(false)
    }

    pub(crate) fn whole(&self, name: &str) -> Option<u64> {
        self.0.get(name)?.as_u64()
    }

    pub(crate) fn texts(&self, name: &str) -> Vec<String> {
        let list = self.0.get(name).and_then(Value::as_array);
        let texts = list.into_iter().flatten().filter_map(Value::as_str);
        texts.map(str::to_owned).collect()
    }

    /// What is set when, in the order of the times.
    pub(crate) fn inputs(&self, name: &str) -> Vec<Input> {
        let list = self.0.get(name).and_then(Value::as_array);
        let mut inputs: Vec<Input> = list.into_iter().flatten().filter_map(Input::new).collect();
        inputs.sort_by_key(|input| input.at_ms);
        inputs
    }
}

/// Devices that are set at a time.
#[derive(Debug)]
pub(crate) struct Input {
    pub(crate) at_ms: u64,
    /// Names and values.
    pub(crate) set: Vec<(String, Value)>,
}

impl Input {
    fn new(value: &Value) -> Option<Self> {
        let set = value.get("set")?.as_object()?;
        Some(Input {
            at_ms: value.get("at_ms").and_then(Value::as_u64).unwrap_or(0),
            set: set
                .iter()
                .map(|(name, value)| (name.clone(), value.clone()))
                .collect(),
        })
    }
}

fn unknown<'n>(name: &str, known: impl Iterator<Item = &'n str> + Clone) -> String {
    let name = crate::protocol::clipped(name);
    match did_you_mean(&name, known.clone()) {
        Some(near) => format!("there is no argument `{name}`; did you mean `{near}`?"),
        None => {
            let known: Vec<_> = known.map(|name| format!("`{name}`")).collect();
            format!(
                "there is no argument `{name}`; there are {}",
                known.join(", ")
            )
        }
    }
}

/// Checks that a value is of the kind of its parameter.
fn fits(parameter: &Parameter, value: &Value) -> Result<(), String> {
    let Parameter { name, text, .. } = parameter;
    let wanted = match parameter.kind {
        Kind::Text if value.is_string() => return Ok(()),
        Kind::Text => "a text".to_owned(),
        Kind::Flag if value.is_boolean() => return Ok(()),
        Kind::Flag => "true or false".to_owned(),
        Kind::Whole(least, most) => match value.as_u64() {
            Some(number) if (least..=most).contains(&number) => return Ok(()),
            _ => format!("an integer from {least} to {most}"),
        },
        Kind::Texts => match value.as_array() {
            Some(list) if list.len() <= MOST_ITEMS && list.iter().all(Value::is_string) => {
                return Ok(());
            }
            _ => format!("a list of at most {MOST_ITEMS} texts, such as [\"X000\", \"M0\"]"),
        },
        Kind::Choice(choices) => match value.as_str() {
            Some(choice) if choices.contains(&choice) => return Ok(()),
            _ => format!("one of {}", choices.join(", ")),
        },
        Kind::Inputs => match value.as_array() {
            Some(list) if list.len() <= MOST_ITEMS && list.iter().all(is_input) => return Ok(()),
            _ => "a list such as [{\"at_ms\": 0, \"set\": {\"X000\": true, \"D0\": 5}}]".to_owned(),
        },
    };
    Err(format!("`{name}` has to be {wanted}: {text}"))
}

fn is_input(value: &Value) -> bool {
    let is_value = |value: &Value| value.is_boolean() || value.is_number();
    let Some(input) = value.as_object() else {
        return false;
    };
    input.iter().all(|(name, value)| match name.as_str() {
        "at_ms" => value.is_u64(),
        "set" => value
            .as_object()
            .is_some_and(|set| set.values().all(is_value)),
        _ => false,
    }) && input.contains_key("set")
}

#[cfg(test)]
mod tests {
    use super::{Arguments, Kind, Parameter};
    use serde_json::{Value, json};

    const PARAMETERS: &[Parameter] = &[
        Parameter::required("path", Kind::Text, "a program"),
        Parameter::optional("offset", Kind::Whole(0, 9), "where to begin"),
        Parameter::optional("watch", Kind::Texts, "devices"),
        Parameter::optional("inputs", Kind::Inputs, "what is set"),
        Parameter::optional("to", Kind::Choice(&["il", "csv"]), "form"),
        Parameter::optional("how", Kind::Flag, "whether"),
    ];

    fn why(value: Value) -> String {
        let Value::Object(given) = value else {
            panic!("{value}")
        };
        match Arguments::new(given, &[PARAMETERS]) {
            Ok(_) => "fits".to_owned(),
            Err(why) => why,
        }
    }

    #[test]
    fn wrong_arguments_say_what_to_write() {
        let all = [
            json!({}),
            json!({ "path": 5 }),
            json!({ "path": "a", "ofset": 1 }),
            json!({ "path": "a", "x": 1 }),
            json!({ "path": "a", "offset": -1 }),
            json!({ "path": "a", "offset": 10 }),
            json!({ "path": "a", "watch": "X0" }),
            json!({ "path": "a", "watch": ["X0", 1] }),
            json!({ "path": "a", "inputs": [{ "at_ms": 0 }] }),
            json!({ "path": "a", "inputs": [{ "set": { "X0": "on" } }] }),
            json!({ "path": "a", "to": "xml" }),
            json!({ "path": "a", "how": 1 }),
            json!({ "path": "a", "how": null, "offset": 9, "inputs": [{ "set": { "X0": true } }] }),
        ];
        insta::assert_snapshot!(all.map(why).join("\n"));
    }
}
