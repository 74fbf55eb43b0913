//! `rungc.toml`, the settings of a project.

super::codes! {
    PROJECT_SYNTAX = "E0040" "project-syntax" Error None,
    "this line of rungc.toml is not TOML",
    "rungc.toml holds the settings of a project as TOML: tables in brackets (`[check]`), and in them a key and its value on a line (`allow = [\"W0203\"]`). Texts stand in quotes.",
    wrong: "",
    right: "";

    PROJECT_KEY = "E0041" "project-key" Error None,
    "rungc.toml has no such table or key",
    "A table or key that rungc does not know is refused, since a misspelt setting would otherwise be ignored. The help names the keys there are; docs/src/project.md explains them.",
    wrong: "",
    right: "";

    PROJECT_VALUE = "E0042" "project-value" Error None,
    "a value in rungc.toml that does not fit its key",
    "The value is of another type than the key takes, names something that does not exist (a model, a warning, a target), or contradicts another key of the file.",
    wrong: "",
    right: "";
}
