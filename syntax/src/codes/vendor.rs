//! What the projects of vendors' editors hold besides a program, and which of it was read.

super::codes! {
    NOT_COMPILED = "E0021" "not-compiled" Error None,
    "the project holds no compiled program where one is needed",
    "Structured text, structured ladder, function block diagrams, SFC and ladders with labels are read as what GX Works2 compiled them to. Here nothing was compiled yet. Open the project in GX Works2, choose Compile > Rebuild All, and save it.",
    wrong: "",
    right: "";

    STALE_PROGRAM = "E0022" "stale-program" Error None,
    "the compiled program is older than its source",
    "The source names devices that the compiled program in the project does not have: it was changed after the last compilation. Open the project in GX Works2, choose Compile > Rebuild All, and save it. `--compiled` reads the old program on purpose.",
    wrong: "",
    right: "";

    SOURCE_DIFFERS = "W0520" "source-differs" Warning None,
    "the ladder and the compiled program of a project differ",
    "GX Works2 keeps the ladder as it was drawn and the program as it was last compiled. They differ, so the ladder was changed since. The ladder is what is read; `--compiled` reads the compiled program, which is what the PLC may still run.",
    wrong: "",
    right: "";

    AGE_UNKNOWN = "W0521" "compiled-age-unknown" Warning None,
    "the compiled program may be older than its source",
    "Structured text, structured ladder, function block diagrams, SFC and ladders with labels are read as what GX Works2 compiled them to. Nothing in the project contradicts that this was done after the last change, but nothing proves it either: the stored times are those of the program file's creation. If the source was changed since, choose Compile > Rebuild All in GX Works2 and save. The warning stays, since the file looks the same afterwards; `-A W0521` leaves it out and still refuses a compiled program that contradicts its source (E0022).",
    wrong: "",
    right: "";

    RECOVERED = "W0522" "recovered" Warning None,
    "the project's parts were found by their content",
    "The list that names the parts of a GX Works2 project, or a part that it names, cannot be read. The program was found by its bytes instead: the longest without damage is taken, which may be an older state.",
    wrong: "",
    right: "";

    PROGRAM_NOT_RUN = "W0523" "program-not-run" Warning None,
    "a program file that is left out",
    "An FX-family PLC runs one program file. The project has more, which are left out.",
    wrong: "",
    right: "";

    PARAMETER_RANGE = "W0524" "parameter-range" Warning None,
    "a PLC parameter that the model does not allow",
    "The parameters of the project set something that the PLC model cannot do. The message says what was taken instead.",
    wrong: "",
    right: "";

    DAMAGED_PART = "W0525" "damaged-part" Warning None,
    "a part of the project other than its program is damaged",
    "Device comments, parameters or tasks cannot be read on at some place. What stands before it is used; the program itself is not affected.",
    wrong: "",
    right: "";

    READ_AS_COMPILED = "N0010" "read-as-compiled" Note None,
    "a structured program is shown as compiled",
    "Structured text, structured ladder, function block diagrams, SFC and ladders with labels are read as what GX Works2 compiled them to, so instructions, steps and automatically assigned devices are those of the compiled program.",
    wrong: "",
    right: "";

    POU_NOT_RUN = "N0011" "pou-not-run" Note None,
    "program parts that no task runs",
    "Neither a task nor another POU names these POUs of the project, so they are not part of the program.",
    wrong: "",
    right: "";
}
