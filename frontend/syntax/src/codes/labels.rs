//! Labels, jumps, calls, interrupts.

super::codes! {
    NO_LABEL = "E0430" "no-label" Error Some(6701),
    "jump or call to a label that does not exist",
    "CJ and CALL name a label P that must exist somewhere in the program.",
    wrong: "LD X0\nCJ P5\nLD X1\nOUT Y0\nEND\n",
    right: "LD X0\nCJ P5\nLD X1\nOUT Y0\nP5\nEND\n";

    LABEL_TWICE = "E0431" "label-twice" Error Some(6504),
    "label defined twice",
    "A pointer P or I may be defined only once. Labels of jumps and of subroutines share their numbers.",
    wrong: "LD X0\nCJ P1\nP1\nLD X1\nOUT Y0\nP1\nEND\n",
    right: "LD X0\nCJ P1\nP1\nLD X1\nOUT Y0\nEND\n";

    JUMPED_AND_CALLED = "E0432" "jumped-and-called" Error None,
    "label that is both jumped to and called",
    "CJ continues at its label; CALL returns from it with SRET: they cannot share a label.",
    wrong: "LD X0\nCJ P1\nLD X1\nCALL P1\nFEND\nP1\nLD X3\nOUT Y1\nSRET\nEND\n",
    right: "LD X0\nCJ P2\nLD X1\nCALL P1\nP2\nFEND\nP1\nLD X3\nOUT Y1\nSRET\nEND\n";

    P63 = "E0433" "p63" Error Some(6507),
    "P63 as a label or a subroutine",
    "P63 is the end of the program: CJ P63 jumps to END. It must not be defined, and it cannot be called.",
    wrong: "LD X0\nCJ P63\nLD X1\nOUT Y0\nP63\nEND\n",
    right: "LD X0\nCJ P63\nLD X1\nOUT Y0\nEND\n";

    INTO_LOOP = "E0434" "into-loop" Error Some(6607),
    "jump into a loop",
    "A jump from outside to a label between FOR and NEXT would run a loop that was never started. The same applies to PROC and PEND \
     of HM's advanced interrupts, where a routine is left and re-entered.",
    wrong: "LD X0\nCJ P1\nFOR K2\nP1\nLD X1\nOUT Y0\nNEXT\nEND\n",
    right: "LD X0\nCJ P1\nFOR K2\nLD X1\nOUT Y0\nNEXT\nP1\nEND\n";

    BETWEEN_ROUTINES = "E0435" "between-routines" Error Some(6701),
    "jump into or out of a routine",
    "A jump stays within the main program, or within its subroutine or interrupt routine.",
    wrong: "LD X0\nCALL P1\nP2\nFEND\nP1\nLD X1\nCJ P2\nSRET\nEND\n",
    right: "LD X0\nCALL P1\nFEND\nP1\nLD X1\nCJ P2\nLD X2\nOUT Y0\nP2\nSRET\nEND\n";

    DEEP_CALL = "E0437" "deep-call" Error Some(6702),
    "calls nested too deep",
    "Calls nest five deep on most models (eight on HM). These calls are made in every scan, so the PLC reports the error in every scan.",
    wrong: "LD M8000\nCALL P1\nFEND\nP1\nLD M8000\nCALL P2\nSRET\nP2\nLD M8000\nCALL P3\nSRET\nP3\nLD M8000\nCALL P4\nSRET\nP4\nLD M8000\nCALL P5\nSRET\nP5\nLD M8000\nCALL P6\nSRET\nP6\nLD X0\nOUT Y0\nSRET\nEND\n",
    right: "LD X0\nCALL P1\nFEND\nP1\nLD X0\nCALL P2\nSRET\nP2\nLD X0\nOUT Y0\nSRET\nEND\n";

    MAY_CALL_DEEP = "W0510" "may-call-deep" Warning Some(6702),
    "calls that may nest too deep",
    "Calls nest five deep on most models (eight on HM). Whether these do depends on their conditions: if all of them are on at once, the call beyond the limit is skipped with error 6702.",
    wrong: "LD X0\nCALL P1\nFEND\nP1\nLD X0\nCALL P2\nSRET\nP2\nLD X0\nCALL P3\nSRET\nP3\nLD X0\nCALL P4\nSRET\nP4\nLD X0\nCALL P5\nSRET\nP5\nLD X0\nCALL P6\nSRET\nP6\nLD X0\nOUT Y0\nSRET\nEND\n",
    right: "LD X0\nCALL P1\nFEND\nP1\nLD X0\nCALL P2\nSRET\nP2\nLD X0\nOUT Y0\nSRET\nEND\n";

    BOTH_EDGES = "E0440" "both-edges" Error Some(6508),
    "two interrupts of one source",
    "An input triggers an interrupt on its rising or its falling edge, not on both; a timer interrupt has one period.",
    wrong: "EI\nFEND\nI000\nLD X1\nOUT Y0\nIRET\nI001\nLD X2\nOUT Y1\nIRET\nEND\n",
    right: "EI\nFEND\nI001\nLD X2\nOUT Y1\nIRET\nEND\n";

    INPUT_SHARED = "E0441" "input-shared" Error Some(6511),
    "fast input used by a counter and something else",
    "Each fast input serves one purpose: a high-speed counter, an input interrupt or pulse catch.",
    wrong: "EI\nLD M8000\nOUT C251 K100\nFEND\nI101\nLD X2\nOUT Y0\nIRET\nEND\n",
    right: "EI\nLD M8000\nOUT C251 K100\nFEND\nI201\nLD X3\nOUT Y0\nIRET\nEND\n";

    COUNTERS_SHARE = "E0442" "counters-share" Error None,
    "two high-speed counters on one input",
    "Each fast input serves one high-speed counter.",
    wrong: "LD M8000\nOUT C235 K100\nLD M8000\nOUT C251 K100\nEND\n",
    right: "LD M8000\nOUT C237 K100\nLD M8000\nOUT C251 K100\nEND\n";

    NO_ROUTINE = "E0443" "no-routine" Error Some(6712),
    "interrupt without a routine",
    "DHSCS may request an interrupt instead of setting a bit; its routine must follow FEND.",
    wrong: "EI\nLD M8000\nOUT C235 K100\nDHSCS K50 C235 I010\nFEND\nEND\n",
    right: "EI\nLD M8000\nOUT C235 K100\nDHSCS K50 C235 I010\nFEND\nI010\nLD M8000\nINC D0\nIRET\nEND\n";
}
