//! Additional contents of the projects of vendors' editors, and the part that was read.

super::codes! {
    NOT_COMPILED = "E0021" "not-compiled" Error None,
    "the project has no compiled program, but one is needed",
    "Structured text, structured ladder, function block diagrams, SFC and ladders with labels are read in the form that GX Works2 compiled them to. Nothing was compiled yet. Open the project in GX Works2, choose Compile > Rebuild All, and save it.",
    wrong: "",
    right: "";

    STALE_PROGRAM = "E0022" "stale-program" Error None,
    "the compiled program is older than its source",
    "The source names devices that the compiled program in the project does not have: it was changed after the last compilation. Open the project in GX Works2, choose Compile > Rebuild All, and save it. `--compiled` reads the old program anyway.",
    wrong: "",
    right: "";

    SOURCE_DIFFERS = "W0520" "source-differs" Warning None,
    "the ladder and the compiled program of a project differ",
    "GX Works2 stores the ladder as drawn and the program as last compiled. They differ, so the ladder was changed since. rungc reads the ladder; `--compiled` reads the compiled program, which the PLC may still run.",
    wrong: "",
    right: "";

    RECOVERED = "W0522" "recovered" Warning None,
    "the project's parts were found by their content",
    "The directory of a GX Works2 project, or a part that it lists, cannot be read. The program was found by its bytes instead: the longest undamaged one is used, which may be an older version.",
    wrong: "",
    right: "";

    PROGRAM_NOT_RUN = "W0523" "program-not-run" Warning None,
    "a program file that is ignored",
    "An FX-family PLC runs one program file. The others in the project are ignored.",
    wrong: "",
    right: "";

    PARAMETER_RANGE = "W0524" "parameter-range" Warning None,
    "a PLC parameter that the model does not allow",
    "The parameters of the project set something that the PLC model does not support. The message says what is used instead.",
    wrong: "",
    right: "";

    DAMAGED_PART = "W0525" "damaged-part" Warning None,
    "a part of the project other than its program is damaged",
    "Device comments, parameters, tasks, labels or structures cannot be read past some point. Everything before it is used; the program itself is not affected.",
    wrong: "",
    right: "";

    RETAINED = "W0526" "not-latched" Warning None,
    "a variable that is to keep its value has a device that is not latched",
    "The project declares the variable as RETAIN, but its device loses its value when the power fails: latched devices are those of the model and of `[latched]` in rungc.toml. Name a latched device in `[plcopen.names]`, list latched ones in `[plcopen] free`, or add the device to `[latched]`.",
    wrong: "",
    right: "";

    READ_AS_COMPILED = "N0010" "read-as-compiled" Note None,
    "a structured program is shown as compiled",
    "Structured text, structured ladder, function block diagrams, SFC and ladders with labels are read in the form that GX Works2 compiled them to, so instructions, steps and automatically assigned devices are those of the compiled program.",
    wrong: "",
    right: "";

    POU_NOT_RUN = "N0011" "pou-not-run" Note None,
    "program parts that no task runs",
    "Neither a task nor another POU names these POUs of the project, so they are not part of the program.",
    wrong: "",
    right: "";

    AGE_UNKNOWN = "N0012" "compiled-age-unknown" Note None,
    "the compiled program may be older than its source",
    "Structured text, structured ladder, function block diagrams, SFC and ladders with labels are read in the form that GX Works2 compiled them to. Nothing in the project contradicts that this happened after the last change, but nothing proves it either: the stored times are those of the program file's creation. If the source was changed since, choose Compile > Rebuild All in GX Works2 and save. The file looks the same afterwards, so say in rungc.toml that this state of it is compiled: `[project] compiled = \"…\"`, with the number that the note shows. After the next change of the source, or of the compiled program, the number is another one, and the note comes back. A compiled program that contradicts its source is rejected (E0022) in any case.",
    wrong: "",
    right: "";

    SOURCES = "N0013" "project-sources" Note None,
    "what a project holds beside its compiled program",
    "The numbers of programs, function blocks, functions, structures and labels of a GX Works2 project, and the languages of its sources. rungc runs the compiled program; `rungc convert --to st` writes the sources as text, for reading and for version control, and `--to labels` the labels. Devices without a comment have the names of their labels: `Start`, `Axis1.Ready`, `Main.Step` of a label of a POU.",
    wrong: "",
    right: "";

    COMPARED = "N0014" "compared-with-source" Note None,
    "the structured text of a project, compared with its compiled program",
    "rungc compiles the structured text of a GX Works2 project as the editor does, and looks for the same instructions in the compiled program; the numbers of automatic devices and of jumps do not matter. If the compiled program consists of these instructions, it is what its source says, and note N0012 does not appear. Other instructions are a sign that a statement was changed after the last compilation: choose Compile > Rebuild All in GX Works2 and save. They may also come from a construct that GX Works2 compiles in a way that rungc does not know. Ladders with labels, structured ladder and SFC are not compared.",
    wrong: "",
    right: "";
}
