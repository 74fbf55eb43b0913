//! Structure: every block must be closed, and which blocks may contain which.

super::codes! {
    OPEN_FOR = "E0412" "open-for" Error Some(6622),
    "FOR without NEXT",
    "Every FOR needs a NEXT after it, before FEND, END and the end of the routine.",
    wrong: "FOR K2\nLD X0\nOUT Y0\nEND\n",
    right: "FOR K2\nLD X0\nOUT Y0\nNEXT\nEND\n";

    LONE_NEXT = "E0413" "lone-next" Error Some(6621),
    "NEXT without FOR",
    "NEXT closes the innermost open FOR; none is open here.",
    wrong: "LD X0\nOUT Y0\nNEXT\nEND\n",
    right: "FOR K2\nLD X0\nOUT Y0\nNEXT\nEND\n";

    DEEP_FOR = "E0414" "deep-for" Error Some(6620),
    "FOR nested too deep",
    "Loops nest five deep (six on H1U and H2U).",
    wrong: "FOR K2\nFOR K2\nFOR K2\nFOR K2\nFOR K2\nFOR K2\nFOR K2\nNEXT\nNEXT\nNEXT\nNEXT\nNEXT\nNEXT\nNEXT\nEND\n",
    right: "FOR K2\nFOR K2\nNEXT\nNEXT\nEND\n";

    OPEN_MC = "E0415" "open-mc" Error Some(6624),
    "MC without MCR",
    "A master control zone ends with MCR of the same level.",
    wrong: "LD X0\nMC N0 M100\nLD X1\nOUT Y0\nEND\n",
    right: "LD X0\nMC N0 M100\nLD X1\nOUT Y0\nMCR N0\nEND\n";

    LONE_MCR = "E0416" "lone-mcr" Error Some(6623),
    "MCR without MC",
    "No master control zone of this level is open here.",
    wrong: "LD X0\nOUT Y0\nMCR N0\nEND\n",
    right: "LD X0\nMC N0 M100\nLD X1\nOUT Y0\nMCR N0\nEND\n";

    MC_ORDER = "E0417" "mc-order" Error Some(6608),
    "levels of MC out of order",
    "Zones nest from N0 to N7: an inner zone has a higher level than the one around it.",
    wrong: "LD X0\nMC N0 M100\nLD X1\nMC N0 M101\nLD X2\nOUT Y0\nMCR N0\nMCR N0\nEND\n",
    right: "LD X0\nMC N0 M100\nLD X1\nMC N1 M101\nLD X2\nOUT Y0\nMCR N1\nMCR N0\nEND\n";

    OPEN_STL = "E0418" "open-stl" Error Some(6627),
    "step ladder without RET",
    "The last state of a step ladder is followed by RET.",
    wrong: "STL S0\nOUT Y0\nEND\n",
    right: "STL S0\nOUT Y0\nRET\nEND\n";

    LONE_RET = "E0419" "lone-ret" Error Some(6605),
    "RET outside a step ladder",
    "RET ends the states that STL starts; no state is open here.",
    wrong: "LD X0\nOUT Y0\nRET\nEND\n",
    right: "STL S0\nOUT Y0\nRET\nEND\n";

    STL_ROW = "E0420" "stl-row" Error Some(6625),
    "nine or more STL in a row",
    "Consecutive STL wait for parallel branches, of which there are at most eight.",
    wrong: "STL S20\nSTL S21\nSTL S22\nSTL S23\nSTL S24\nSTL S25\nSTL S26\nSTL S27\nSTL S28\nOUT Y0\nRET\nEND\n",
    right: "STL S20\nSTL S21\nOUT Y0\nRET\nEND\n";

    NOT_INSIDE = "E0421" "not-inside" Error Some(6606),
    "structure inside another that must not contain it",
    "Master control and step ladders belong in the main program, outside loops; routines belong after FEND, outside everything else. h1u-h2u-programming §8.8 lists what may contain what.",
    wrong: "FOR K2\nSTL S0\nOUT Y0\nRET\nNEXT\nEND\n",
    right: "STL S0\nFOR K2\nLD X0\nOUT Y0\nNEXT\nRET\nEND\n";

    CROSSED = "E0422" "crossed" Error Some(6606),
    "structures that cross",
    "Of two structures, one must be entirely inside or entirely outside the other.",
    wrong: "LD X0\nMC N0 M100\nFOR K2\nLD X1\nOUT Y0\nMCR N0\nNEXT\nEND\n",
    right: "LD X0\nMC N0 M100\nFOR K2\nLD X1\nOUT Y0\nNEXT\nMCR N0\nEND\n";

    FEND_INSIDE = "E0423" "fend-inside" Error Some(6632),
    "FEND inside another structure",
    "FEND ends the main program: loops, master control zones, step ladders and routines must be closed before it.",
    wrong: "FOR K2\nLD X0\nOUT Y0\nFEND\nNEXT\nEND\n",
    right: "FOR K2\nLD X0\nOUT Y0\nNEXT\nFEND\nEND\n";

    OPEN_ROUTINE = "E0424" "open-routine" Error Some(6630),
    "routine without SRET or IRET",
    "A subroutine ends with SRET, an interrupt routine with IRET.",
    wrong: "LD X0\nCALL P1\nFEND\nP1\nLD X1\nOUT Y0\nEND\n",
    right: "LD X0\nCALL P1\nFEND\nP1\nLD X1\nOUT Y0\nSRET\nEND\n";

    LONE_RETURN = "E0425" "lone-return" Error Some(6629),
    "SRET or IRET outside a routine",
    "SRET ends a subroutine that starts with its label P, IRET an interrupt routine that starts with its pointer I; both come after FEND.",
    wrong: "LD X0\nOUT Y0\nFEND\nLD X1\nOUT Y1\nIRET\nEND\n",
    right: "EI\nLD X0\nOUT Y0\nFEND\nI001\nLD X1\nOUT Y1\nIRET\nEND\n";

    ROUTINE_IN_MAIN = "E0426" "routine-in-main" Error Some(6606),
    "routine in the main program",
    "Subroutines and interrupt routines come after FEND, which ends the main program.",
    wrong: "EI\nI001\nLD X2\nOUT Y1\nIRET\nFEND\nEND\n",
    right: "EI\nFEND\nI001\nLD X2\nOUT Y1\nIRET\nEND\n";

    NO_END = "E0427" "no-end" Error None,
    "program without END",
    "The last instruction of a program is END.",
    wrong: "LD X0\nOUT Y0\n",
    right: "LD X0\nOUT Y0\nEND\n";

    TOO_OFTEN = "E0429" "too-often" Error None,
    "instruction used more often than the model allows",
    "Some instructions reserve a part of the hardware or of the system's memory, and a program may contain only one or two of them.",
    wrong: "LD X0\nROTC D200 K10 K2 M0\nROTC D210 K10 K2 M20\nEND\n",
    right: "LD X0\nROTC D200 K10 K2 M0\nEND\n";
}
