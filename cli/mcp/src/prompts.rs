//! Prompts: how an assistant goes about a task.

use serde_json::{Map, Value, json};

/// A prompt.
struct Prompt {
    name: &'static str,
    title: &'static str,
    text: &'static str,
    /// Name, meaning, and whether it has to be given.
    arguments: &'static [(&'static str, &'static str, bool)],
    /// What is asked; `{name}` stands for an argument.
    body: &'static str,
}

const ALL: [Prompt; 5] = [
    Prompt {
        name: "write-program",
        title: "Write a program",
        text: "Write a program from a description of a machine",
        arguments: &[
            (
                "description",
                "what the machine does, with its buttons, sensors and actuators",
                true,
            ),
            ("model", "the PLC, such as fx3u", false),
        ],
        body: "Write a PLC program as an instruction list for this machine (PLC: {model}):\n\n{description}\n\n\
               1. Read rungc://guide. List the inputs and outputs with their numbers (octal), and ask about \
               what the description leaves open: what happens at power-on, at a stop, when a sensor fails.\n\
               2. Write the list with a comment for every device (`;! X000 = start button`). Use `explain` \
               for every instruction that you are not certain of.\n\
               3. `check` it until there are no errors, and no warning that you cannot justify.\n\
               4. `run` it with inputs that show each function, then write test cases and `test` them.\n\
               5. `verify` what must never happen, such as two directions at once. Say under which \
               assumptions it is proved.\n\
               6. Show the program, the tests, and what is not tested.",
    },
    Prompt {
        name: "find-standstill",
        title: "Find out why a machine stands still",
        text: "Find out why an output stays off, from the program and the state of the inputs",
        arguments: &[
            ("path", "the program", true),
            (
                "device",
                "the output or relay that should be on, or its comment",
                true,
            ),
            ("state", "what is known of the inputs", false),
        ],
        body: "The machine stands still: `{device}` of `{path}` should be on and is not. What is known: {state}\n\n\
               1. `open` the program, and `why` with that device: what writes it, under which conditions.\n\
               2. `why` again with the known inputs and `how: true`: what is missing, and what a person can do.\n\
               3. `view` the networks that it names, follow timers, counters and states back to inputs.\n\
               4. Answer in the words of the comments: which sensor or button, where to look on the machine, \
               how to check it. Do not propose to bridge a guard, an emergency stop or another safeguard.",
    },
    Prompt {
        name: "review-change",
        title: "Review a change",
        text: "Review the change from one version of a program to another",
        arguments: &[
            ("old", "the program before", true),
            ("new", "the program after", true),
        ],
        body: "Review the change from `{old}` to `{new}`.\n\n\
               1. `diff` with `semantic: true`: which networks, which devices can behave differently.\n\
               2. `check` both: which findings are new.\n\
               3. For each output that can differ: `view` its networks, `xref` the devices, and `run` both \
               with the same inputs where a difference would show.\n\
               4. Say what the change does, what it may break, and which test or property would catch that.",
    },
    Prompt {
        name: "write-tests",
        title: "Write tests",
        text: "Write a test file for a program",
        arguments: &[
            ("path", "the program", true),
            ("functions", "what to test; else all functions", false),
        ],
        body: "Write a test file (`.plctest.toml`) for `{path}`. To be tested: {functions}\n\n\
               1. `open` and `view` the program; read rungc://book/test-files.\n\
               2. List its functions, and for each the case that it works and the case that a sensor, a time \
               or an operator is in its way.\n\
               3. Write the cases, `test` them with `text`, and look at each failure: is the test wrong, or \
               the program? Do not change an expectation to what the program does without a reason.\n\
               4. Show the file, and what it does not test.",
    },
    Prompt {
        name: "prove-interlock",
        title: "Prove an interlock",
        text: "Prove that a program never does something, such as two contactors at once",
        arguments: &[
            ("path", "the program", true),
            ("interlock", "what must never happen", true),
        ],
        body: "Prove for `{path}`: {interlock}\n\n\
               1. `open` the program and find the devices by their comments; read rungc://book/prove.\n\
               2. Write the property as a condition, such as `never` `Y000 & Y001`, and say it back in words.\n\
               3. `verify` it. If it is violated: explain the run that is shown, and which network allows it.\n\
               4. If it is proved: repeat all assumptions, and ask whether they hold for this machine (panels \
               that write devices, scan time). If it is not decided: say so, and why.\n\
               5. A proof is about the program alone: it does not replace an interlock in hardware or a \
               safety assessment.",
    },
];

/// All prompts.
pub(crate) fn list() -> Vec<Value> {
    let prompts = ALL.iter().map(|prompt| {
        let arguments = prompt.arguments.iter();
        let arguments: Vec<Value> = arguments
            .map(|(name, text, required)| json!({ "name": name, "description": text, "required": required }))
            .collect();
        json!({
            "name": prompt.name,
            "title": prompt.title,
            "description": prompt.text,
            "arguments": arguments,
        })
    });
    prompts.collect()
}

/// A prompt with its arguments.
///
/// # Errors
/// An unknown prompt, an argument that is missing or not a text.
pub(crate) fn get(name: &str, given: Option<&Map<String, Value>>) -> Result<Value, String> {
    let prompt = ALL
        .iter()
        .find(|prompt| prompt.name == name)
        .ok_or_else(|| {
            let names: Vec<_> = ALL.iter().map(|prompt| prompt.name).collect();
            let name = crate::protocol::clipped(name);
            format!(
                "there is no prompt `{name}`; there are {}",
                names.join(", ")
            )
        })?;
    let mut values = Vec::new();
    for (name, text, required) in prompt.arguments {
        let value = given.and_then(|given| given.get(*name));
        match (value, required) {
            (Some(Value::String(value)), _) => values.push((format!("{{{name}}}"), value.as_str())),
            (None | Some(Value::Null), false) => values.push((format!("{{{name}}}"), "not stated")),
            (None | Some(Value::Null), true) => {
                return Err(format!("the argument `{name}` is missing: {text}"));
            }
            (Some(_), _) => return Err(format!("the argument `{name}` is a text: {text}")),
        }
    }
    let text = filled(prompt.body, &values);
    Ok(json!({
        "description": prompt.text,
        "messages": [{ "role": "user", "content": { "type": "text", "text": text } }],
    }))
}

/// A text with values in place of their names; values are not filled in again.
fn filled(mut body: &str, values: &[(String, &str)]) -> String {
    let mut out = String::new();
    loop {
        let places = values
            .iter()
            .filter_map(|(name, value)| Some((body.find(name.as_str())?, name, value)));
        let Some((at, name, value)) = places.min_by_key(|(at, ..)| *at) else {
            out.push_str(body);
            return out;
        };
        out.push_str(&body[..at]);
        out.push_str(value);
        body = &body[at + name.len()..];
    }
}

#[cfg(test)]
mod tests {
    use super::{ALL, get};
    use serde_json::json;

    #[test]
    fn every_argument_is_in_its_prompt_and_values_stay_as_they_are() {
        for prompt in &ALL {
            for (name, ..) in prompt.arguments {
                assert!(
                    prompt.body.contains(&format!("{{{name}}}")),
                    "{}: {name}",
                    prompt.name
                );
            }
        }
        let given = json!({ "old": "{new}", "new": "b.il" });
        let text = get("review-change", given.as_object()).unwrap().to_string();
        assert!(text.contains("from `{new}` to `b.il`"), "{text}");
        assert!(
            get("write-tests", None)
                .unwrap_err()
                .contains("`path` is missing")
        );
        assert!(
            get("nothing", None)
                .unwrap_err()
                .contains("prove-interlock")
        );
    }
}
