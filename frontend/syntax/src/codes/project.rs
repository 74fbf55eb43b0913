//! `rungc.toml`, the settings of a project.

super::codes! {
    PROJECT_SYNTAX = "E0040" "project-syntax" Error None,
    "this line of rungc.toml is not TOML",
    "rungc.toml holds the settings of a project as TOML: tables in brackets (`[check]`), each with one key and value per line (`allow = [\"W0203\"]`). Texts are quoted.",
    wrong: "",
    right: "";

    PROJECT_KEY = "E0041" "project-key" Error None,
    "rungc.toml has no such table or key",
    "An unknown table or key is rejected, because a misspelt setting would otherwise be ignored. The help lists the valid keys; `rungc book project` explains them.",
    wrong: "",
    right: "";

    PROJECT_VALUE = "E0042" "project-value" Error None,
    "a value in rungc.toml that does not fit its key",
    "The value has the wrong type for the key, names something that does not exist (a model, a warning, a target), or contradicts another key in the file.",
    wrong: "",
    right: "";

    IO_CONNECTION = "E0820" "io-connection" Error None,
    "a connection of `[io]` in rungc.toml cannot be made as it is described",
    "A table `[io.NAME]` connects devices of a running program to remote I/O, a broker, pins or files. It has one key that says to what (`modbus-tcp`, `modbus-rtu`, `mqtt`, `gpio`, `files` or `console`), options, and rows: ranges of devices with the direction and the place at the other end (`X000-X007 = \"read inputs 0\"`). No device takes its value from two places, and no two rows write the same place. `rungc book linux` explains the keys.",
    wrong: "",
    right: "";
}
