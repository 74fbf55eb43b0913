//! Legal, but causes trouble in practice; and contradictions within the source.

super::codes! {
    NEVER_READ = "W0201" "never-read" Warning None,
    "relays that are driven and never read",
    "Nothing in the program reads these relays, states, timers or counters. That is fine if an operator panel does; otherwise they are leftovers or misspelt.",
    wrong: "LD X0\nOUT M10\nLD X1\nOUT Y0\nEND\n",
    right: "LD X0\nOUT M10\nLD M10\nOUT Y0\nEND\n";

    NEVER_WRITTEN = "W0202" "never-written" Warning None,
    "contacts of relays, or values of registers, that nothing writes",
    "Nothing in the program drives these relays, states, timers or counters, so their contacts never change; nothing writes these registers, so what compares them or takes them as a preset finds 0. RST, ZRST and writing 0 switch nothing on, so they do not count. An operator panel may write them: name what it writes in rungc.toml, `[hmi] writes = [\"M100-M115\", \"D0-D9\"]`. Latched registers, which keep what was once written, are not reported, nor are registers of a program whose ports let others write.",
    wrong: "LD M10\nOUT Y0\nEND\n",
    right: "LD X0\nOUT M10\nLD M10\nOUT Y0\nEND\n";

    DOUBLE_COIL = "W0203" "double-coil" Warning None,
    "coil driven in two places",
    "Whenever the first rung writes the coil, a later one of the same scan writes it again, so the last one decides its state; the result of the first is lost. The later one may also be an instruction that writes the coil as part of a word. Pulses and a coil disturb each other on one output. Join the conditions with OR, or use SET and RST. In different states of a step ladder, or in subroutines that are not both called, a coil may be driven again.",
    wrong: "LD X0\nOUT Y0\nLD X1\nOUT Y0\nEND\n",
    right: "LD X0\nOR X1\nOUT Y0\nEND\n";

    TIMER_TWICE = "W0204" "timer-twice" Warning None,
    "timer or counter driven in two places",
    "A timer driven in two places starts and clears according to whichever runs; a counter counts the changes of both. Use a separate one in each place.",
    wrong: "LD X0\nOUT T0 K10\nLD X1\nOUT T0 K20\nLD T0\nOUT Y0\nEND\n",
    right: "LD X0\nOUT T0 K10\nLD X1\nOUT T1 K20\nLD T0\nOR T1\nOUT Y0\nEND\n";

    TIMER_IN_NEXT_STATE = "W0205" "timer-in-next-state" Warning None,
    "timer used in a state and in the one that follows it",
    "At the transition both states are on for one scan, so the coil of the timer does not turn off and the timer is not cleared.",
    wrong: "LD M8002\nSET S0\nSTL S0\nOUT T0 K10\nLD T0\nSET S20\nSTL S20\nOUT T0 K10\nLD T0\nOUT S0\nRET\nEND\n",
    right: "LD M8002\nSET S0\nSTL S0\nOUT T0 K10\nLD T0\nSET S20\nSTL S20\nOUT T1 K10\nLD T1\nOUT S0\nRET\nEND\n";

    PAIRS_OVERLAP = "W0206" "pairs-overlap" Warning None,
    "32-bit values that share a word",
    "A 32-bit value occupies the named register and the next one. Two values that start at adjacent registers overwrite each other.",
    wrong: "LD X0\nDMOV K1 D0\nDMOV K2 D1\nEND\n",
    right: "LD X0\nDMOV K1 D0\nDMOV K2 D2\nEND\n";

    WRITES_READ_ONLY = "W0208" "writes-read-only" Warning None,
    "write to a special device that the system maintains",
    "The system writes this special relay or register itself; what the program writes has no lasting effect. Some devices of serial ports are the program's in one role of the port, such as D8415 of a Modbus slave on FX3; elsewhere they are the system's.",
    wrong: "LD X0\nOUT M8000\nEND\n",
    right: "LD X0\nOUT M0\nLD M0\nOUT Y0\nEND\n";

    UNUSED_LABEL = "W0209" "unused-label" Warning None,
    "label that nothing jumps to or calls",
    "The label can be removed, or a jump or call is missing.",
    wrong: "LD X0\nOUT Y0\nP1\nLD X1\nOUT Y1\nEND\n",
    right: "LD X0\nCJ P1\nLD X0\nOUT Y0\nP1\nLD X1\nOUT Y1\nEND\n";

    UNREACHABLE = "W0210" "unreachable" Warning None,
    "instructions that never run",
    "After FEND, SRET or IRET, only a label can be reached; these instructions precede the next one.",
    wrong: "LD X0\nOUT Y0\nFEND\nLD X1\nOUT Y1\nEND\n",
    right: "LD X0\nOUT Y0\nLD X1\nOUT Y1\nFEND\nEND\n";

    AFTER_END = "W0211" "after-end" Warning None,
    "instructions after END",
    "The scan ends at the first END; instructions after it never run.",
    wrong: "LD X0\nOUT Y0\nEND\nLD X1\nOUT Y1\nEND\n",
    right: "LD X0\nOUT Y0\nLD X1\nOUT Y1\nEND\n";

    NEVER_ENABLED = "W0212" "never-enabled" Warning None,
    "interrupt routines or pulse catch without EI",
    "Interrupts are disabled at the start of RUN; without EI these routines never run, and the relays of pulse catch (from M8170) stay off.",
    wrong: "LD X0\nOUT Y0\nFEND\nI001\nLD M8000\nINC D0\nIRET\nEND\n",
    right: "EI\nLD X0\nOUT Y0\nFEND\nI001\nLD M8000\nINC D0\nIRET\nEND\n";

    TIMER_IN_ROUTINE = "W0213" "timer-in-routine" Warning None,
    "ordinary timer in a subroutine or interrupt routine",
    "An ordinary timer is updated where its coil is executed; in a routine that does not run in every scan, it measures incorrectly. A subroutine that is called in every scan while the timer is needed is fine. T192 to T199 (100 ms) and T246 to T249 (1 ms, until RST) are intended for routines: they continue in scans that do not execute their coils. FX1S, FX3S and HM have none of them.",
    wrong: "LD X0\nCALL P1\nLD T0\nOUT Y0\nFEND\nP1\nLD X1\nOUT T0 K10\nSRET\nEND\n",
    right: "LD X0\nCALL P1\nLD T192\nOUT Y0\nFEND\nP1\nLD X1\nOUT T192 K10\nSRET\nEND\n";

    JUMP_IN_STL = "W0214" "jump-in-stl" Warning None,
    "jump into, out of or between states",
    "A jump that leaves its state skips the handling of transitions. The manual discourages it: use a transition.",
    wrong: "LD M8002\nSET S0\nSTL S0\nLD X0\nCJ P1\nLD X1\nOUT Y0\nRET\nP1\nEND\n",
    right: "LD M8002\nSET S0\nSTL S0\nLD X1\nOUT Y0\nRET\nEND\n";

    RECURSION = "W0215" "recursion" Warning Some(6702),
    "subroutine that calls itself",
    "A subroutine must not call itself, directly or through others. The PLC accepts the program, but skips the recursive call with error 6702 when it is reached.",
    wrong: "LD X0\nCALL P1\nFEND\nP1\nLD X1\nCALL P1\nSRET\nEND\n",
    right: "LD X0\nCALL P1\nFEND\nP1\nLD X1\nOUT Y0\nSRET\nEND\n";

    MEASURED_INPUT = "W0216" "measured-input" Warning None,
    "fast input with two purposes",
    "Use each fast input for one purpose only: SPD, the signals of ZRN, DSZR and DVIT, a high-speed counter, an input interrupt or pulse catch.",
    wrong: "LD M8000\nOUT C235 K100\nLD X7\nSPD X0 K100 D0\nEND\n",
    right: "LD M8000\nOUT C235 K100\nLD X7\nSPD X1 K100 D0\nEND\n";

    FAST_UNITS = "W0217" "fast-units" Warning None,
    "more fast inputs and outputs than the hardware supports",
    "Fast inputs and outputs of H1U and H2U share 56 units of hardware: a pulse output takes 7, a counter with one input 6, with two inputs 13, for an encoder 17, SPD 4, an input interrupt or pulse catch 1.",
    model: "h2u",
    wrong: "LD M8000\nOUT C235 K1\nOUT C236 K1\nOUT C237 K1\nOUT C238 K1\nOUT C239 K1\nOUT C240 K1\nPLSY K500 K9 Y0\nPLSY K500 K9 Y1\nPLSY K500 K9 Y2\nEND\n",
    right: "LD M8000\nOUT C235 K1\nOUT C236 K1\nOUT C237 K1\nOUT C238 K1\nOUT C239 K1\nPLSY K500 K9 Y0\nPLSY K500 K9 Y1\nPLSY K500 K9 Y2\nEND\n";

    PARTS_OVERLAP = "W0220" "parts-overlap" Warning None,
    "part of a result that is also written separately",
    "The result of a 32-bit instruction takes two registers, as does the product of MUL; DIV stores the remainder after the quotient; the 32-bit forms of both take four. An instruction that writes one of the later registers overwrites a part of the result. Registers that are only cleared are not reported, nor are values whose low word is also written separately, since they are assembled from words.",
    wrong: "LD X0\nMUL D0 D1 D10\nLD X1\nMOV K3 D11\nEND\n",
    right: "LD X0\nMUL D0 D1 D10\nLD X1\nMOV K3 D12\nEND\n";

    OUT_AND_SET = "W0221" "out-and-set" Warning None,
    "coil that both OUT and SET or RST write",
    "OUT writes its coil in every scan, whether its contacts are closed or not, so it undoes a SET at once, and a RST before it too. A RST after the OUT, which forces the coil off for the rest of the scan, is not reported; neither are a SET and an OUT in different states. An instruction that writes the coil in every scan as part of a word, as `MOV D0 K2Y0` under M8000, undoes a SET or RST before it likewise.",
    wrong: "LD X0\nSET Y0\nLD X1\nRST Y0\nLD X2\nOUT Y0\nEND\n",
    right: "LD X0\nOR X2\nSET Y0\nLD X1\nRST Y0\nEND\n";

    STATE_TWICE = "W0222" "state-twice" Warning None,
    "state that occurs twice",
    "Each state of a step ladder has one section, which starts with its STL. A second section with the same number is usually a copy whose number was not changed: while the state is on, both run. Consecutive STL that join parallel branches repeat their states and are not reported.",
    wrong: "LD M8002\nSET S0\nSTL S0\nLD X0\nSET S20\nSTL S20\nOUT Y0\nLD X1\nSET S21\nSTL S20\nOUT Y1\nLD X2\nOUT S0\nRET\nEND\n",
    right: "LD M8002\nSET S0\nSTL S0\nLD X0\nSET S20\nSTL S20\nOUT Y0\nLD X1\nSET S21\nSTL S21\nOUT Y1\nLD X2\nOUT S0\nRET\nEND\n";

    REVERSED_RANGE = "W0223" "reversed-range" Warning None,
    "ZRST whose first device comes after its last",
    "ZRST resets from its first device up to its second. If the first has the higher number, only that one is reset. On H1U, H2U and HM this is an error.",
    wrong: "LD X0\nZRST D10 D0\nEND\n",
    right: "LD X0\nZRST D0 D10\nEND\n";

    DIVISION_BY_ZERO = "W0224" "division-by-zero" Warning Some(6706),
    "division by the constant 0",
    "Each time the instruction runs, the PLC reports an operation error in M8067 and D8067 and leaves the result unchanged. On HM, DIV gives the limit of the range instead.",
    wrong: "LD X0\nDIV D0 K0 D2\nEND\n",
    right: "LD X0\nDIV D0 K10 D2\nEND\n";

    EVERY_SCAN = "W0225" "every-scan" Warning None,
    "instruction that changes its own operand in every scan",
    "An instruction without the suffix P runs in each scan in which its contacts are closed: INC counts scans, ALT flickers, a shift empties its register, and a result that replaces one of its sources (ADD D0 K5 D0) is computed again. An input or a one-second clock stays on for many scans. Use the pulse form or LDP. Only instructions driven by inputs and clocks alone are reported, outside loops, routines, states and code that jumps skip.",
    wrong: "LD X0\nINC D0\nEND\n",
    right: "LD X0\nINCP D0\nEND\n";

    NEVER_RESET = "W0226" "never-reset" Warning None,
    "counter or accumulating timer that nothing resets",
    "A 16-bit counter that has reached its preset stops counting, and its contact stays closed until RST clears it. An accumulating (retentive) timer (T246 to T255 on most models, T128 to T137 on FX3S) keeps its value when its coil turns off, so its contact stays closed likewise. Nothing in the program resets them.",
    wrong: "LD X0\nOUT C0 K10\nLD C0\nOUT Y0\nEND\n",
    right: "LD X1\nRST C0\nLD X0\nOUT C0 K10\nLD C0\nOUT Y0\nEND\n";

    NEVER_SWITCHED_OFF = "W0227" "never-switched-off" Warning None,
    "output that is set and never reset",
    "SET turns an output on until something resets it. Nothing in the program does, so it stays on until STOP.",
    wrong: "LD X0\nSET Y0\nEND\n",
    right: "LD X0\nSET Y0\nLD X1\nRST Y0\nEND\n";

    JUMPED_OVER = "W0228" "jumped-over" Warning None,
    "instructions that an unconditional jump skips",
    "M8000 is on in every scan, so the jump is always taken and the instructions before its label never run.",
    wrong: "LD M8000\nCJ P1\nLD X0\nOUT Y0\nP1\nLD X1\nOUT Y1\nEND\n",
    right: "LD X2\nCJ P1\nLD X0\nOUT Y0\nP1\nLD X1\nOUT Y1\nEND\n";

    ONE_OUTPUT = "W0229" "one-output" Warning None,
    "output of pulses with two purposes at the same time",
    "An output gives pulses or their direction, not both. It sends the pulses of one instruction at a time. Two instructions that are driven by the same contacts, or one of which is always driven, interfere with each other: the second does not start, or not before the first has ended. On HM, the same holds for two motions of one axis, to which only IPL adds pulses, and for PTAB, PCTAB and PBTAB, of which one runs at a time.",
    wrong: "LD X0\nPLSY K1000 K500 Y0\nPLSY K200 K100 Y0\nEND\n",
    right: "LD X0\nPLSY K1000 K500 Y0\nLDI X0\nPLSY K200 K100 Y0\nEND\n";

    STATE_BRANCHES = "W0230" "state-branches" Warning None,
    "more branches of a step ladder than the PLC supports",
    "A state branches into at most 8 others, selective or parallel, and at most 16 circuits branch off in the flow of one initial state. The editors do not show such a flow, and the manuals do not say how the PLC runs it. Compiled programs have no such limit.",
    wrong: "LD M8002\nSET S0\nSTL S0\nLD X0\nSET S20\nSET S21\nSET S22\nSET S23\nSET S24\nSET S25\nSET S26\nSET S27\nSET S28\nRET\nEND\n",
    right: "LD M8002\nSET S0\nSTL S0\nLD X0\nSET S20\nSET S21\nSET S22\nSET S23\nSET S24\nSET S25\nSET S26\nSET S27\nRET\nEND\n";

    ENDLESS_JUMP = "W0231" "endless-jump" Warning Some(6105),
    "backward jump that is always taken",
    "The jump has no condition that could be off, and nothing between the label and the jump leaves the loop: the scan does not end, and the watchdog stops the PLC.",
    wrong: "P0\nLD X0\nOUT Y0\nLD M8000\nCJ P0\nEND\n",
    right: "LD X0\nOUT Y0\nEND\n";

    UNALIGNED_GROUP = "W0232" "unaligned-group" Warning None,
    "table of ABSD in bits that do not start at a multiple of 8",
    "The manual of H1U and H2U demands that the bits of ABSD's table start at a multiple of 8 (h1u-h2u-programming §4.3.7); whether that holds for the 16-bit form, too, its wording leaves open. DABSD rejects such a table.",
    model: "h2u",
    wrong: "LD X0\nABSD K4M12 C0 M100 K1\nEND\n",
    right: "LD X0\nABSD K4M16 C0 M100 K1\nEND\n";

    COUNTS_NOTHING = "W0233" "counts-nothing" Warning None,
    "high-speed counter without inputs",
    "The table of high-speed counters in the manual gives this counter no inputs. It never counts.",
    model: "l01s",
    wrong: "LD M8000\nOUT C243 K10\nEND\n",
    right: "LD M8000\nOUT C242 K10\nEND\n";

    CONSTANT_FAILS = "W0234" "constant-fails" Warning Some(6706),
    "constant with which the instruction always fails",
    "The instruction does not accept this constant. Each time it runs, the PLC reports an operation error in M8067 and D8067, on HM in M8006 and D8006, and leaves the result unchanged. Motions of HM do not start: they end with an error (64) in the state of their axis, or of their table. JOG without inputs never moves.",
    wrong: "LD X0\nMEAN D0 D100 K65\nEND\n",
    right: "LD X0\nMEAN D0 D100 K64\nEND\n";

    INDEXED_COUNTER = "W0235" "indexed-counter" Warning None,
    "32-bit counter with an index on HM",
    "On HM, an index counts 16-bit words. With the index 1, `C200V0` is therefore not C201 but the high word of C200 and the low word of C201, and the index 2 leads to C201. The manual advises against such operands (hm-motion-controller §5.1.8). Copy the counters to data registers and index these: `DMOV C200 D1000`, `DMOV C201 D1002`, then D1000 with an index of 0 or 2.",
    model: "hm",
    wrong: "LD X0\nDMOV C200V0 D1100\nEND\n",
    right: "LD X0\nDMOV C200 D1000\nDMOV C201 D1002\nDMOV D1000V0 D1100\nEND\n";

    SHORT_DRIVE = "W0236" "short-drive" Warning None,
    "motion that is driven for one scan",
    "Pulse outputs and motions run while their contacts are closed, and stop when they open. An edge (LDP, PLS, MEP) and M8002 close them for one scan: the motion starts, and stops in the next scan. Let the edge SET a relay that drives the motion, and RST it at the end: M8029, or on HM 32 in the state of the axis (D320, D370, …) or of the table. Only IPL of HM is meant for edges, too. Routines, loops and code that jumps skip are not reported.",
    wrong: "LDP X0\nPLSY K1000 K5000 Y0\nEND\n",
    right: "LDP X0\nSET M0\nLD M0\nPLSY K1000 K5000 Y0\nLD M8029\nRST M0\nEND\n";

    NEVER_COUNTS = "W0237" "never-counts" Warning None,
    "value of a high-speed counter that nothing drives",
    "A high-speed counter counts its inputs while its coil is driven. Without `OUT` its value never changes, and comparisons such as HSCS never act. A counter into which the program writes values is a register, and is not reported.",
    wrong: "LDD>= C235 K100\nOUT Y0\nEND\n",
    right: "LD M8000\nOUT C235 K100000\nLDD>= C235 K100\nOUT Y0\nEND\n";

    RESERVED_REGISTER = "W0238" "reserved-register" Warning None,
    "write to a register that the system of HM uses",
    "The manual of HM keeps D0 to D79, D98 to D199 and D600 to D999 for the system, and some registers of each output axis between D300 and D599 (hm-motion-controller §5.1, §8.2.3). On the PLC, the program and the system overwrite each other's values there. Registers from D1000 on are free. Runs of more than 32 registers are not reported.",
    model: "hm",
    wrong: "LD X0\nMOV K5 D100\nEND\n",
    right: "LD X0\nMOV K5 D1100\nEND\n";

    ZONE_SHARED = "W0239" "zone-shared" Warning None,
    "two comparisons of high-speed counters in one compare zone",
    "DHSCS, DHSCR and DHSZ of HM share the compare zones 0 to 5, and a zone executes one instruction at a time (hm-motion-controller §8.3.14). Two that are driven by the same contacts, or one of which is always driven, need a zone each. Compiled code runs both.",
    model: "hm",
    wrong: "LD M8000\nOUT C255 K1000\nDHSCS K100 C255 Y10 K0\nDHSCS K150 C255 Y11 K0\nEND\n",
    right: "LD M8000\nOUT C255 K1000\nDHSCS K100 C255 Y10 K0\nDHSCS K150 C255 Y11 K1\nEND\n";

    NEVER_REQUESTED = "W0250" "never-requested" Warning None,
    "interrupt routine that can never run",
    "Nothing requests the routine, or nothing allows it. On HM, D211 selects the edges of X004 and X005 that interrupt, D261 those of X006 and X007; both are H00 at power-on, with which X005 and X007 do not interrupt (hm-motion-controller §5.5.6). The masks of HM's timer interrupts, M8056 to M8058, are on at power-on; I001, I201, I020 to I050 and I900 to I907 are requested by relays that the program sets. I010 to I060 of other models need a comparison such as DHSCS that names them, the ends of pulses (I502 to I506) and the rows of a table of counts of H1U and H2U a relay that allows them. A routine that the program requests by its relay is not reported, nor is one whose relay or register something outside the program writes (`[hmi] writes`).",
    model: "hm",
    wrong: "EI\nLD X0\nOUT Y0\nFEND\nI101\nLD M8000\nINC D1000\nIRET\nEND\n",
    right: "EI\nLD M8002\nMOV H20 D211\nLD X0\nOUT Y0\nFEND\nI101\nLD M8000\nINC D1000\nIRET\nEND\n";

    INERT_DEVICE = "W0301" "inert-device" Warning None,
    "special device that has no effect in a compiled program",
    "On the PLC, this special relay or register configures or reports something: a CAN network, a special module that rungc.toml does not list, the delay of an interrupt. Compiled programs do not have that function, so it is an ordinary relay or register there. The help page of each model (`rungc book special-devices/index`) and `rungc explain D8393` show which devices work. Devices that only report faults that cannot happen here (a low battery, a failed supply) are not reported.",
    wrong: "LD M8002\nMOV K50 D8393\nEND\n",
    right: "LD M8002\nMOV K500 D8000\nEND\n";

    UNDEFINED_SPECIAL = "W0302" "undefined-special" Warning None,
    "special device without a meaning on the model",
    "The manual of the model gives this special relay or register no meaning, so nothing sets, clears or reads it but the program: a contact of it never changes. It may belong to another model, or be misspelt. Of a run of devices or a group of bits, which a program clears or copies as a whole, only the first is looked at; runs of more than 32 are not reported.",
    wrong: "LD M8010\nOUT Y0\nEND\n",
    right: "LD M8013\nOUT Y0\nEND\n";

    STEPS_DIFFER = "W0501" "steps-differ" Warning None,
    "step number that does not fit the instructions before it",
    "The source numbers its steps, and the number differs from the steps that the instructions before it take on this model: the program may be for another model, or a row may be missing.",
    wrong: "0 LD X0\n1 OUT Y0\n9 END\n",
    right: "0 LD X0\n1 OUT Y0\n2 END\n";

    UNKNOWN_CPU = "W0502" "unknown-cpu" Warning None,
    "unknown CPU type",
    "The source names a CPU type that belongs to no supported model, and none resembles it. It is compiled for FX3U; `--model` selects another model.",
    wrong: "",
    right: "";

    NEAREST_MODEL = "N0020" "nearest-model" Note None,
    "CPU type compiled as a similar model",
    "The source names a CPU type that is not a supported model. It is compiled for the most similar one; the help describes the differences. `--model` selects another model.",
    wrong: "",
    right: "";

    OTHER_CPU = "N0021" "other-cpu" Note None,
    "errors under another model than the source names",
    "The source names a CPU type, but `--model` or `model` in rungc.toml selects another model, and under this one the program has errors. If these are instructions or devices that the model lacks, remove the setting, or set the model that the source names.",
    wrong: "",
    right: "";

    TOO_LONG = "W0503" "too-long" Warning None,
    "program longer than the model's memory",
    "The program has more steps than the PLC can hold. Compiled code has no such limit, but the program cannot go back to the PLC.",
    wrong: "",
    right: "";

    BOUND_UNUSED = "W0540" "bound-unused" Warning None,
    "bound of an operand that the program does not have",
    "`[index]` in rungc.toml names an operand with an index register that no instruction has, so the bound has no effect. A bound applies to the operand exactly as the program writes it: a bound for `D100Z0` does not cover `D101Z0`.",
    wrong: "",
    right: "";

    DOUBTFUL_DEVICE = "N0022" "doubtful-device" Note None,
    "device that some PLCs of the model do not have",
    "The model stands for PLCs of several makers, and published tests of some of them report that a program with this device stops them. Compiled code has the device. Use a lower number, or try the program on the PLC that it is for.",
    wrong: "",
    right: "";

    INDEX_REACHES_MUCH = "N0030" "index-reaches-much" Note None,
    "indexed operand that makes the program store many devices",
    "A compiled program stores the devices that its operands can reach. The range of an index register is derived from constants, sums, masks (`WAND`), comparisons on the way, loop iterations and the values that all scans leave in it; a value from a data register or from communication can be anything (a host may write data registers, but not index registers), and then the operand reaches every device of its class. Compare or mask the index before use, or bound the operand in rungc.toml: `[index]`, `D100Z0 = \"D100-D163\"`. An access outside the bound is then PLC error 6706, as is an access outside the model's devices.",
    wrong: "",
    right: "";
}
