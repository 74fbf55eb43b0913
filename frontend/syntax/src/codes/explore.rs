//! Findings of a search of runs: `rungc explore`.

super::codes! {
    REACHES_ERROR = "E0830" "reaches-operation-error" Error None,
    "an instruction can meet an operation error",
    "`rungc explore` has found inputs with which this instruction fails when the program runs: the PLC sets M8067, skips the instruction and continues. The run is in the report; `--write-test` writes it as a test file. Typical causes are an index register that leads beyond the devices, a division by 0, and a BCD number with digits above 9. `rungc explain` with the PLC's code, such as `rungc explain 6706`, says more.",
    wrong: "",
    right: "";

    REACHES_WATCHDOG = "E0831" "reaches-watchdog" Error None,
    "a scan can take so long that the watchdog stops the PLC",
    "`rungc explore` has found inputs with which a loop or a jump backward does not end in time: the PLC goes to STOP with M8061 set and all outputs off. Limit how often the loop runs.",
    wrong: "",
    right: "";

    DRIVEN_DIFFERENTLY = "E0832" "driven-differently" Error None,
    "two coils drive an output differently in one scan",
    "`rungc explore` has found a scan in which one coil of the output is on and a later one is off: the last coil executed decides, so the output stays off although a rung asks for it. Join the conditions in one rung.",
    wrong: "",
    right: "";

    NEVER_RESTS = "E0833" "never-rests" Error None,
    "an output can change in every scan while no input does",
    "`rungc explore` has found a state from which an output turns on and off in each scan, however long scans last: the rungs that drive it undo each other. A relay or a contactor is worn out in minutes by this.",
    wrong: "",
    right: "";

    BREAKS_MACHINE = "E0834" "breaks-machine" Error None,
    "an axis of the simulated machine can run into an end of its travel",
    "`rungc explore --machine` has found inputs with which the program drives an axis against its end stop. The run is in the report.",
    wrong: "",
    right: "";

    RUNS_DIFFER = "E0835" "runs-differ" Error None,
    "a run that was found is not the same on all engines",
    "A run on the interpreter showed this, but emitted code did otherwise with the same inputs. That is an error of rungc: please report it with the program and the test file that `--write-test` writes.",
    wrong: "",
    right: "";
}
