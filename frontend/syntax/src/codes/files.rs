//! Files beside a program: tests, machines and boards.

super::codes! {
    TEST_FILE = "E0880" "test-file" Error None,
    "a test file with a mistake",
    "A file `*.plctest.toml` lists cases: a program, what is set in each step, and what is expected then. It has a mistake at this place: TOML that cannot be read, a key that does not exist there, or a value that does not fit. An unknown key is rejected, because a misspelt one would otherwise be ignored. No case of the run is executed before all files are right. `rungc book test-files` explains the keys.",
    wrong: "",
    right: "";

    MACHINE_FILE = "E0881" "machine-file" Error None,
    "the description of a machine has a mistake",
    "A file `*.machine.toml` describes axes, cylinders, delays and processes that follow the outputs of the PLC and drive its inputs. It has a mistake at this place, or names a terminal that the model does not have. `rungc book machines` explains the keys.",
    wrong: "",
    right: "";

    BOARD_FILE = "E0882" "board-file" Error None,
    "the description of a board has a mistake",
    "The file that `--board` names describes a microcontroller and what is at its pins. It has a mistake at this place: a key that does not exist, a pin that is used twice, or memory that does not fit. `rungc book boards` explains the keys, and `rungc boards BOARD --toml` writes the description of a known board to begin with.",
    wrong: "",
    right: "";
}
