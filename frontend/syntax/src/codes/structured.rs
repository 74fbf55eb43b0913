//! Structured text.

super::codes! {
    ST_SYNTAX = "E0200" "st-syntax" Error None,
    "this cannot be read as structured text",
    "A file of structured text holds `PROGRAM Name`, declarations between `VAR` and `END_VAR`, statements that end in `;`, and `END_PROGRAM`. The place is where reading stopped; what follows the next `;` is read again.",
    wrong: "PROGRAM Main\nY0 := X0 AND ;\nY1 := X1;\nEND_PROGRAM\n",
    right: "PROGRAM Main\nY0 := X0 AND X2;\nY1 := X1;\nEND_PROGRAM\n";

    ST_UNKNOWN_NAME = "E0201" "st-unknown-name" Error None,
    "name that nothing declares",
    "A name in a statement is a label that `VAR` declares, a device (`X0`, `D10`, `D10.3`, `K4M0`), a constant (`K10`, `H1F`) or an instruction that is called.",
    wrong: "PROGRAM Main\nVAR\n    Start : BOOL;\nEND_VAR\nY0 := Strat;\nY1 := Start;\nEND_PROGRAM\n",
    right: "PROGRAM Main\nVAR\n    Start : BOOL;\nEND_VAR\nY0 := Start;\nEND_PROGRAM\n";

    ST_TYPE = "E0202" "st-type" Error None,
    "types that do not fit",
    "GX Works2 converts no types by itself. A condition is a BOOL; both sides of an operator and of `:=` have one type. A device D holds an INT or a WORD; for 32 bits declare a label: `Total AT D20 : DINT;`. Functions convert types: `INT_TO_DINT(x)`.",
    wrong: "PROGRAM Main\nIF D0 THEN\n    Y0 := TRUE;\nEND_IF;\nEND_PROGRAM\n",
    right: "PROGRAM Main\nIF D0 <> 0 THEN\n    Y0 := TRUE;\nEND_IF;\nEND_PROGRAM\n";

    ST_LOSES = "E0203" "st-loses" Error None,
    "assignment that may lose a part of the value",
    "A value of 32 bits does not fit in 16, and a REAL has a fraction. A conversion function says that the loss is meant: `DINT_TO_INT(x)`.",
    wrong: "PROGRAM Main\nVAR\n    Total AT D20 : DINT;\nEND_VAR\nD0 := Total;\nEND_PROGRAM\n",
    right: "PROGRAM Main\nVAR\n    Total AT D20 : DINT;\nEND_VAR\nD0 := DINT_TO_INT(Total);\nEND_PROGRAM\n";

    ST_ARGUMENTS = "E0204" "st-arguments" Error None,
    "arguments that do not fit",
    "An instruction is called with EN, its sources, and its destinations: `MOV(EN, S, D)`. Where the manual has a number n after the destination, n stands before it: `BMOV(EN, S, n, D)`.",
    wrong: "PROGRAM Main\nMOV(X0, D0);\nEND_PROGRAM\n",
    right: "PROGRAM Main\nMOV(X0, D0, D1);\nEND_PROGRAM\n";

    ST_CASE_TWICE = "E0205" "st-case-twice" Error None,
    "value that CASE lists twice",
    "Only the first branch with a value is ever run for it.",
    wrong: "PROGRAM Main\nCASE D0 OF\n    1: D1 := 10;\n    1: D1 := 20;\nEND_CASE;\nEND_PROGRAM\n",
    right: "PROGRAM Main\nCASE D0 OF\n    1: D1 := 10;\n    2: D1 := 20;\nEND_CASE;\nEND_PROGRAM\n";

    ST_ZERO = "E0206" "st-division-by-zero" Error None,
    "division by the constant 0",
    "The PLC reports error 6706 each time such a division runs.",
    wrong: "PROGRAM Main\nD0 := D1 / 0;\nEND_PROGRAM\n",
    right: "PROGRAM Main\nD0 := D1 / 10;\nEND_PROGRAM\n";

    ST_UNSUPPORTED = "E0207" "st-unsupported" Error None,
    "structured text that rungc does not compile",
    "rungc compiles a part of the language; the page on structured text lists it. Compile the program in GX Works2 and open its project (`.gxw`): its compiled list is read whatever the language of the source.",
    wrong: "PROGRAM Main\nD0 := D1 ** 2;\nEND_PROGRAM\n",
    right: "PROGRAM Main\nD0 := D1 * D1;\nEND_PROGRAM\n";

    ST_DECLARED_TWICE = "E0208" "st-declared-twice" Error None,
    "label that is declared twice, or named like a device or keyword",
    "Names that differ in case alone are equal. A label cannot have the name of a device, of a constant or of an instruction.",
    wrong: "PROGRAM Main\nVAR\n    Count : INT;\n    COUNT : INT;\nEND_VAR\nCount := 1;\nEND_PROGRAM\n",
    right: "PROGRAM Main\nVAR\n    Count : INT;\nEND_VAR\nCount := 1;\nEND_PROGRAM\n";

    ST_NO_DEVICE = "E0209" "st-no-device" Error None,
    "label for which no device is left, or whose device cannot hold it",
    "A label without `AT` gets a device of the range that GX Works2 reserves for labels of the model, from the top down. With `AT`, the device must suit the type: X, Y, M and S hold a BOOL, D and R a number.",
    wrong: "PROGRAM Main\nVAR\n    Level AT M0 : INT;\nEND_VAR\nLevel := 1;\nEND_PROGRAM\n",
    right: "PROGRAM Main\nVAR\n    Level AT D0 : INT;\nEND_VAR\nLevel := 1;\nEND_PROGRAM\n";

    ST_NOT_WRITABLE = "E0210" "st-not-writable" Error None,
    "assignment to something that has no storage",
    "A value is assigned to a label or a device. Constants, inputs X and expressions cannot be written.",
    wrong: "PROGRAM Main\nX0 := TRUE;\nEND_PROGRAM\n",
    right: "PROGRAM Main\nY0 := TRUE;\nEND_PROGRAM\n";

    ST_NO_LOOP = "E0211" "st-no-loop" Error None,
    "EXIT outside of a loop",
    "EXIT leaves the loop around it: FOR, WHILE or REPEAT.",
    wrong: "PROGRAM Main\nEXIT;\nY0 := X0;\nEND_PROGRAM\n",
    right: "PROGRAM Main\nWHILE D0 > 0 DO\n    D0 := D0 - 1;\n    EXIT;\nEND_WHILE;\nEND_PROGRAM\n";

    ST_LITERAL = "E0212" "st-literal" Error None,
    "value that does not exist or does not fit in its type",
    "An INT is -32768 to 32767, a WORD 0 to 65535, a DINT -2147483648 to 2147483647. Other bases are written `16#1F`, `2#101`, durations `T#1m30s500ms`.",
    wrong: "PROGRAM Main\nD0 := 70000;\nEND_PROGRAM\n",
    right: "PROGRAM Main\nD0 := 7000;\nEND_PROGRAM\n";

    ST_UNUSED = "W0240" "st-unused" Warning None,
    "label that nothing uses",
    "It takes a device and has no effect. Labels with `AT` are not reported: something outside may use the device.",
    wrong: "PROGRAM Main\nVAR\n    Old : INT;\nEND_VAR\nY0 := X0;\nEND_PROGRAM\n",
    right: "PROGRAM Main\nY0 := X0;\nEND_PROGRAM\n";

    ST_UNREACHABLE = "W0241" "st-unreachable" Warning None,
    "statements that are never run",
    "A condition is constant, or EXIT or RETURN stands before them.",
    wrong: "PROGRAM Main\nIF FALSE THEN\n    Y0 := X0;\nEND_IF;\nEND_PROGRAM\n",
    right: "PROGRAM Main\nIF X1 THEN\n    Y0 := X0;\nEND_IF;\nEND_PROGRAM\n";

    ST_INDEX_REGISTER = "W0242" "st-index-register" Warning None,
    "index register that variable indexes change",
    "An index of an array that is not constant is computed in Z0, and in V0 if it has 32 bits. A value that the program keeps there is lost.",
    wrong: "PROGRAM Main\nVAR\n    Values AT D100 : ARRAY [0..9] OF INT;\nEND_VAR\nZ0 := D0;\nD1 := Values[D2];\nD3 := D200Z0;\nEND_PROGRAM\n",
    right: "PROGRAM Main\nVAR\n    Values AT D100 : ARRAY [0..9] OF INT;\nEND_VAR\nZ1 := D0;\nD1 := Values[D2];\nD3 := D200Z1;\nEND_PROGRAM\n";

    ST_FILES = "N0240" "files-of-a-program" Note None,
    "files that are compiled as one program",
    "A file with a PROGRAM that uses functions, function blocks, data types or global labels of other files in its folder is compiled with these files, and with the CONFIGURATION that runs it. A file without a PROGRAM is compiled as a part of the first program that needs it. Other files of the folder are left out, and so are files with another PROGRAM, unless the CONFIGURATION names it. `[project] program` in rungc.toml lists the files of a program in place of this.",
    wrong: "",
    right: "";

    ST_LEFT_OUT = "N0241" "file-left-out" Note None,
    "file with another program that defines a missing name",
    "Programs of one folder are not mixed by accident: a file with a PROGRAM is compiled with others only if a CONFIGURATION names the program, or if rungc.toml lists both files.",
    wrong: "",
    right: "";
}
