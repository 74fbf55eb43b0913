//! The table of functions itself.

use super::{lines, read};
use rungc_functions::{Demand, Form, Function, Kind, Over, Presence, library, page};
use std::path::Path;

/// Names in `{…}` of a text.
fn placeholders(text: &str) -> Vec<&str> {
    let parts = text.split('{').skip(1);
    parts.filter_map(|part| part.split('}').next()).collect()
}

/// Placeholders of a demand, with the parameters that it is repeated over.
fn used(demand: &Demand) -> Vec<&str> {
    let mut names: Vec<&str> = demand
        .form
        .templates()
        .into_iter()
        .chain([demand.name])
        .flat_map(placeholders)
        .collect();
    if let Form::Whenever { within, .. } = demand.form {
        names.push(within);
    }
    match demand.over {
        Over::Once => {}
        Over::Each(name) | Over::First(name) => {
            names.retain(|name| *name != "a");
            names.push(name);
        }
        Over::Pairs(name) | Over::Next(name) => {
            names.retain(|name| !["a", "b"].contains(name));
            names.push(name);
        }
    }
    names
}

fn check(function: &Function) {
    let known = |name: &str| function.parameters.iter().any(|p| p.name == name);
    for demand in function.demands {
        for name in used(demand) {
            assert!(known(name), "{}: {}: {name}", function.name, demand.name);
        }
    }
    for parameter in function.parameters {
        let mut demands = function.demands.iter();
        let is_used = demands.any(|demand| used(demand).contains(&parameter.name));
        assert!(is_used, "{}: {}", function.name, parameter.name);
        let is_time = parameter.kind == Kind::Time;
        let has_default = matches!(parameter.presence, Presence::Default(_));
        assert!(is_time || !has_default, "{}", parameter.name);
    }
    let expanded = read(Path::new(""), &page::row(function)).unwrap();
    // Each demand becomes a property with all parameters.
    assert!(
        expanded.len() >= function.demands.len(),
        "{}",
        function.name
    );
    let violated = format!("{}: {}: ", function.name, function.violates);
    assert!(lines(&expanded).contains(&violated), "{violated}");
    assert!(function.right.ends_with("\nEND") && function.wrong.ends_with("\nEND"));
}

#[test]
fn functions_are_complete() {
    let mut names: Vec<_> = library::all().map(|function| function.name).collect();
    library::all().for_each(check);
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), library::all().count());
}

#[test]
fn pages_show_demands_and_programs() {
    let level = rungc_functions::find("level").unwrap();
    insta::assert_snapshot!(page::text(level));
    insta::assert_snapshot!(page::list());
    for function in library::all() {
        let page = page::markdown(function);
        assert!(page.contains(function.right) && page.contains(function.limits));
    }
}
