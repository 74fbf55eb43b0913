//! Reading files and text; instructions that are not known.

super::codes! {
    BAD_INSTRUCTION = "E0001" "bad-instruction" Error None,
    "this line cannot be read as an instruction",
    "A line of an instruction list has an optional step number, a mnemonic and its operands, separated by spaces. Comments start with `;` or `//`.",
    wrong: "LD X0\n= Y0\nEND\n",
    right: "LD X0\nOUT Y0\nEND\n";

    BAD_OPERAND = "E0002" "bad-operand" Error None,
    "this cannot be read as an operand",
    "An operand is a device (`X000`, `D10`), a device with an index register (`D0Z3`), a group of bits (`K4M0`), a bit of a word (`D0.F`), a constant (`K100`, `H1F`, `E1.5`), a text (`\"ABC\"`), buffer memory (`U0\\G5`) or a pointer (`P4`, `I001`, `N0`).",
    wrong: "LD X0\nMOV Q5 D0\nEND\n",
    right: "LD X0\nMOV K5 D0\nEND\n";

    BAD_OCTAL = "E0003" "bad-octal" Error None,
    "number of an X or Y with a digit 8 or 9",
    "Inputs and outputs are numbered in octal: X007 is followed by X010.",
    wrong: "LD X008\nOUT Y0\nEND\n",
    right: "LD X010\nOUT Y0\nEND\n";

    BIG_NUMBER = "E0004" "big-number" Error None,
    "number that is too large",
    "No device number or constant of the PLC is this large. Floating constants also end near 0, at about 1.18E-38.",
    wrong: "LD X0\nMOV K99999999999999999999 D0\nEND\n",
    right: "LD X0\nMOV K99 D0\nEND\n";

    OPEN_TEXT = "E0005" "open-text" Error None,
    "text without its closing quotation mark",
    "A text operand starts and ends with `\"` on the same line.",
    wrong: "LD X0\n$MOV \"ABC D0\nEND\n",
    right: "LD X0\n$MOV \"ABC\" D0\nEND\n";

    FOREIGN_LANGUAGE = "E0006" "foreign-language" Error None,
    "the text is not an FX instruction list",
    "Programs are read as instruction lists of the FX family, as structured text, as the editors' list export, or as projects of GX Developer and GX Works2. Instruction list of IEC 61131-3 is another language: its addresses (`%IX0.0`) and operators have no counterpart here. Structured text is read from files that end in `.st`, and where a text begins with `PROGRAM`.",
    wrong: "LD %IX0.0\nAND %IX0.1\nST %QX0.0\n",
    right: "LD X0\nAND X1\nOUT Y0\nEND\n";

    LOOK_ALIKE = "E0007" "look-alike" Error None,
    "letter of another alphabet that looks Latin",
    "Mnemonics and devices are written with the letters A to Z. Some Cyrillic and Greek letters look the same on screen but are different characters. The line is read as it looks, so this causes no further errors.",
    wrong: "LD \u{0425}0\nOUT Y0\nEND\n",
    right: "LD X0\nOUT Y0\nEND\n";

    ONE_PER_LINE = "E0008" "one-per-line" Error None,
    "two instructions on one line",
    "Each instruction of a list needs its own line; only a label may be followed by an instruction on the same line.",
    wrong: "LD X0 OUT Y0\nEND\n",
    right: "LD X0\nOUT Y0\nEND\n";

    TEXT_BREAK = "E0009" "text-break" Error None,
    "text with a line break",
    "In an instruction list, a text ends on the line where it starts, so a text with a line break cannot be written as a list. A list export can contain it.",
    wrong: "",
    right: "";

    UNKNOWN_FORMAT = "E0010" "unknown-format" Error None,
    "unknown file format",
    "rungc reads instruction lists as text, the editors' list export (CSV), GX Developer projects (a folder or its MAIN.wpg), GX Works2 projects (.gxw), PLCopen XML and images of a PLC's program memory. It recognises the format by content, not by the file's name.",
    wrong: "",
    right: "";

    TRUNCATED = "E0011" "truncated" Error None,
    "the file ends too early",
    "The file announces more data than it has. Everything before the end was read.",
    wrong: "",
    right: "";

    DAMAGED = "E0012" "damaged" Error None,
    "the file contradicts itself",
    "A length, an offset or a marker in the file contradicts the rest. The message gives the offset and the bytes.",
    wrong: "",
    right: "";

    UNKNOWN_BYTES = "E0013" "unknown-bytes" Error None,
    "unknown instruction code",
    "The project contains the code of an instruction or operand that no published table lists and no known project has shown, or whose meaning is only a guess. The message gives the bytes, the operands and the step; the help lists the instructions that would fit. The rest of the program is read. `rungc learn PROJECT EXPORT` learns instruction codes from a list that the editor exports.",
    wrong: "",
    right: "";

    BAD_ROW = "E0014" "bad-row" Error None,
    "row of a list export that does not fit its columns",
    "A row of the export lacks a column, has an operand that belongs to no instruction, or begins a text with a quote that it does not close.",
    wrong: "",
    right: "";

    UNREADABLE_TEXT = "E0015" "unreadable-text" Error None,
    "bytes in an unknown encoding",
    "Text is read as UTF-8, as UTF-16, or in the most likely code page: GBK, Big5, Shift-JIS, EUC-KR, Windows-1252 and similar. None of them fits every byte here: the file is in another encoding, or damaged. Save it as UTF-8, or name its encoding with `--encoding`.",
    wrong: "",
    right: "";

    UNREADABLE_FILE = "E0016" "unreadable-file" Error None,
    "the file cannot be read",
    "The file or folder does not exist, access is denied, or it is larger than any program. The message quotes the system.",
    wrong: "",
    right: "";

    LABEL_OPERAND = "E0017" "label-operand" Error None,
    "operand that is a label, not a device",
    "A source in GX Works2 may name labels, and so may a list exported from it. The editor assigns devices to them when it converts the program, and only the compiled program contains these: convert the program in the editor and save the project, or export the list of the compiled program.",
    wrong: "LD X0\nMOV wSpeed D0\nEND\n",
    right: "LD X0\nMOV D10 D0\nEND\n";

    OTHER_FAMILY = "E0018" "other-family" Error None,
    "the program is for a CPU of another family",
    "rungc compiles programs of the FX family. CPUs of MELSEC-Q, L, R, A and QnA and of iQ-F (FX5) have different instructions, devices and memory, even where the names are the same.",
    wrong: "",
    right: "";

    CODE_MISFIT = "E0019" "code-misfit" Error None,
    "the length of an instruction in the project does not fit the instruction",
    "The code of an instruction in a project states its length in steps. Here it differs from the length that the instruction has with these operands, so the code may mean another instruction. Compare the step with the editor.",
    wrong: "",
    right: "";

    DERIVED_CODES = "N0001" "derived-codes" Note None,
    "instructions read by codes that no project has shown yet",
    "The meaning of these codes follows from the codes around them, but no published table or known project confirms it. The message lists all of them. Compare these instructions with the editor, or let `rungc learn PROJECT EXPORT` confirm them from a list that it exports.",
    wrong: "",
    right: "";

    UNKNOWN_INSTRUCTION = "E0033" "unknown-instruction" Error Some(6506),
    "no model has this instruction",
    "The catalogue does not contain this mnemonic in any spelling. If a similar one exists, the help names it.",
    wrong: "LD X0\nMOVE K1 D0\nEND\n",
    right: "LD X0\nMOV K1 D0\nEND\n";

    NOT_ON_MODEL = "E0034" "not-on-model" Error Some(6506),
    "the model does not have this instruction",
    "The instruction exists, but not on the model that the program is compiled for. The help lists the models that have it; `--model` selects another model.",
    model: "l01s",
    wrong: "LD X0\nDHCMOV C235 D0 K1\nEND\n",
    right: "LD X0\nDMOV C235 D0\nEND\n";

    NO_SUCH_FORM = "E0035" "no-such-form" Error Some(6506),
    "the instruction does not have this form",
    "A mnemonic may have a 16-bit form, a 32-bit form (prefix D) and pulse forms (suffix P). Not every instruction has all of them.",
    wrong: "DFOR K2\nLD X0\nOUT Y0\nNEXT\nEND\n",
    right: "FOR K2\nLD X0\nOUT Y0\nNEXT\nEND\n";

    NOT_IMPLEMENTED = "E0036" "not-implemented" Error None,
    "this instruction cannot be compiled",
    "The instruction is known, checked and counted in steps, but nothing stands for it in a compiled program. The message says why.",
    wrong: "",
    right: "";

    LADDER_WIRE = "E0050" "ladder-wire" Error None,
    "wire of a drawn ladder that leads nowhere",
    "In ladder that is drawn in characters, every contact lies between the left rail and an output. A wire that ends in nothing, or a contact with nothing to its left, is most often a missing `-` or `+`, or a `|` in another column than the `+` above it. The network is left out.",
    wrong: "",
    right: "";

    LADDER_SYMBOL = "E0051" "ladder-symbol" Error None,
    "symbol of a drawn ladder that means nothing",
    "Contacts are `--[ X000 ]--`, `--[/ X000]--`, `--|X000|--`, or `--| |--`, `--|/|--` and `--] [--` with the device above them; comparisons `--[>= D0 K10]--`; coils `--( Y000 )--` and `--(T0 K50)--`; other instructions `--[MOV K1 D0]--` and `--(SET M0)--`.",
    wrong: "",
    right: "";

    LADDER_SHAPE = "E0052" "ladder-shape" Error None,
    "network of a drawn ladder that no list can express",
    "A list has contacts in series and parallel, and branches to outputs. A wire that bridges a contact, a contact that two branches share like a bridge, or contacts without an output have no list. Draw the contact twice, or use a relay M in between.",
    wrong: "",
    right: "";

    UNKNOWN_MACHINE_CODE = "E0060" "unknown-machine-code" Error None,
    "unknown machine code",
    "The program memory of a PLC contains words whose meaning no recorded transfer or published image shows. The message gives the step and the bytes, low byte first; the rest of the program is read. Extension registers R, bits of words, M3584 and above, S1024 and above, interrupt pointers, floating-point constants and texts are not known yet. Read the PLC with its editor instead, and give rungc the project.",
    wrong: "",
    right: "";

    NO_MACHINE_CODE = "E0061" "no-machine-code" Error None,
    "instruction without known machine code",
    "`rungc convert --to image` writes only machine code that `rungc` reads: what recorded transfers and published images have shown, and applied instructions by their numbers. This instruction, or one of its operands, is not known; `rungc explain E0060` lists what is missing. A program must also end with END.",
    wrong: "",
    right: "";

    NOT_AN_IMAGE = "E0062" "not-an-image" Error None,
    "the file is not the program memory of a PLC",
    "With `--from image`, the file is read as the program memory of an FX PLC: 92 bytes of parameters with the latched ranges from byte 30h on, then the program; a `.PMW` file of FXGP/WIN has a header of 256 bytes before them. The file does not have this form.",
    wrong: "",
    right: "";

    PLCOPEN_ELEMENT = "E0063" "plcopen-element" Error None,
    "element of a PLCopen project without a counterpart",
    "Of PLCopen XML, rungc reads programs as LD, FBD, IL and SFC, with contacts, coils and those functions and blocks of IEC 61131-3 that instructions of the PLC compute exactly. The message names the element, its line and what is different: structured text, blocks of the project's own, types such as REAL, actions that do not end with their step, a comparison with EN, a timer whose preset is not a constant. So are tasks that one scan cannot replace: those that wait for an event, or have different intervals.",
    wrong: "",
    right: "";

    PLCOPEN_VARIABLE = "E0064" "plcopen-variable" Error None,
    "variable of a PLCopen project without a device",
    "A PLC of the FX family knows devices, not variables. A variable of a PLCopen project becomes the device that `[plcopen.names]` of `rungc.toml` or a table for `--names` names, or the device at its address: `%IX0.3` is X003, `%QX1.0` is Y010, `%MX0.5` is M5, `%MW7` is D7 (bits are counted through, eight to a byte). A variable with neither must have the name of a device, such as `M100`, or `[plcopen]` must list free devices. No two variables of a program have the same name; upper and lower case are the same.",
    wrong: "",
    right: "";

    PLCOPEN_SYNTAX = "E0065" "plcopen-syntax" Error None,
    "PLCopen project that is not well-formed XML",
    "The file begins like a PLCopen project, but its XML is damaged. The message gives the place. Export the project again.",
    wrong: "",
    right: "";

    UNKNOWN_WINDOW = "E0066" "unknown-window" Error None,
    "call of a subroutine that no window is called",
    "In a list of AutoShop, `CALL` names a subroutine, whose list follows the heading `SBR` with the same name. Without the heading, nothing says where the subroutine is.",
    wrong: "MAIN\nLD X0\nCALL 加料\nSBR 卸料\nLD X1\nOUT Y0\n",
    right: "MAIN\nLD X0\nCALL 加料\nSBR 加料\nLD X1\nOUT Y0\n";

    WINDOW_HEADING = "E0067" "window-heading" Error None,
    "heading of a window that names none",
    "A list of AutoShop consists of windows: the main program after the heading `MAIN`, which may be left out, then each subroutine after `SBR` and its name, and each interrupt routine after `INT`, its name and its interrupt pointer. Names are single words, and no two windows have the same one. A subroutine's heading may state its pointer: `SBR 加料 P1`.",
    wrong: "LD X0\nOUT Y0\nINT 急停\nRST Y0\n",
    right: "LD X0\nOUT Y0\nINT 急停 I001\nLD M8000\nRST Y0\n";

    NO_WINDOWS = "E0068" "no-windows" Error None,
    "program that AutoShop's windows cannot hold",
    "`rungc convert --to autoshop` divides a program into the windows of AutoShop: the main program up to FEND, subroutines from their label to SRET, interrupt routines from their pointer to IRET. A second FEND, labels between routines, a subroutine with several labels and calls of `P0Z0`, whose target the program computes, do not fit: names take the place of pointers there.",
    wrong: "",
    right: "";

    PLCOPEN_UNDRAWN = "E0740" "plcopen-undrawn" Error None,
    "network that cannot be drawn as PLCopen XML",
    "`rungc convert --to plcopen` writes a program as its networks of contacts and outputs. This network is a list without such a structure, for example because a block is joined that was never started, more contacts lead to one output than rungc reads back, 2,000, or one of its instructions would read back as another one, so nothing is written. `--to il` and `--to csv` write such programs.",
    wrong: "",
    right: "";

    PLCOPEN_INSTRUCTIONS = "N0740" "plcopen-instructions" Note None,
    "instructions without a counterpart in IEC 61131-3",
    "In the project that `rungc convert --to plcopen` writes, these instructions are blocks whose types begin with `FX_`, with the operands `p1`, `p2` and so on, and in a list functions that are called so. rungc reads them back; other editors show them but do not know what they do.",
    wrong: "",
    right: "";

    PLCOPEN_FORM = "N0741" "plcopen-form" Note None,
    "PLCopen project that reads back as another list",
    "Several lists have the same drawing: contacts may be joined by ANB without need, a stack may hold what no branch needs, and INV after a single contact makes it the opposite one (`LD X0`, `INV` is `LDI X0`). The project that `rungc convert --to plcopen` writes reads back as another list that does the same; the message says what becomes of the instructions here.",
    wrong: "",
    right: "";

    PLCOPEN_CHART = "E0741" "plcopen-chart" Error None,
    "step ladder that no chart can express",
    "`rungc convert --to plcopen --body sfc` writes states as the steps of a sequential function chart. A step begins by a transition after other steps or, if it is initial, in the first scan (M8002); it ends by a transition. States that other instructions set or reset (SET, RST and ZRST outside of the states, RST in a state), states that networks outside read, and jumps, calls and loops in a state cannot be said so. `--body ld` and `--body il` write such programs.",
    wrong: "",
    right: "";

    PLCOPEN_EVOLUTION = "N0742" "plcopen-evolution" Note None,
    "chart that switches by the rules of IEC 61131-3",
    "The steps of a chart do not switch exactly as states do. In a chart, all transitions are evaluated first, then steps end, then others begin, and the actions of the active steps are executed last. STL executes a state before it leaves it, begins the next one at once, and lets both overlap for a scan. Of several transitions after a step, a chart takes the first whose condition holds; STL takes all of them. Outputs can therefore differ by a scan, and what a state stores (SET, MOV) under the condition by which it ends, a chart does not store.",
    wrong: "",
    right: "";

    PROTECTED_PROJECT = "E0650" "protected-project" Error None,
    "the project is protected",
    "The PLC parameters of the project hold a keyword, with which its author keeps others from reading the program. rungc respects that. The author can delete the keyword in the editor and save the project again.",
    wrong: "",
    right: "";
}
