//! Functions of motors and movements.

use super::{never, optional, reachable, required, stays};
use crate::Function;
use crate::Kind::{Condition, Device, Time};

pub(super) static REVERSING: Function = Function {
    name: "reversing",
    title: "Reversing contactors with dead time",
    standard: "IEC 60204-1, interlocks for contrary motions: contactors that short-circuit the supply when both are closed",
    text: "Two contactors drive a motor in opposite directions. They are never on together, and one comes on only after \
           the other has been off for a time in which its contacts open and the arc goes out.",
    parameters: &[
        required("forward", Device, "output of one contactor"),
        required("backward", Device, "output of the other contactor"),
        required("pause", Time, "dead time between them, at least"),
        optional(
            "forward-closed",
            Condition,
            "auxiliary contact of the first, while it is closed",
        ),
        optional(
            "backward-closed",
            Condition,
            "auxiliary contact of the second, while it is closed",
        ),
    ],
    demands: &[
        never("both contactors on", "{forward} & {backward}"),
        stays(
            "backward before the pause was over",
            "{forward}",
            "!{backward}",
            "!{forward} for {pause}",
        ),
        stays(
            "forward before the pause was over",
            "{backward}",
            "!{forward}",
            "!{backward} for {pause}",
        ),
        never(
            "backward while the forward contactor is closed",
            "{backward} & {forward-closed}",
        ),
        never(
            "forward while the backward contactor is closed",
            "{forward} & {backward-closed}",
        ),
        reachable("forward is possible", "{forward}"),
        reachable("backward is possible", "{backward}"),
    ],
    limits: "Welded contacts, unless auxiliary contacts are given, and the interlock in the wiring, which IEC 60204-1 asks \
             for in addition. The time is that of outputs at the ends of scans.",
    example: "forward = \"Y000\"\nbackward = \"Y001\"\npause = \"500ms\"\nforward-closed = \"X004\"\n\
              backward-closed = \"X005\"",
    wrong: "LD X000
OR Y000
ANI X001
ANI X005
OUT Y000
LD X001      ; changes over at once
OR Y001
ANI X000
ANI Y000
ANI X004
OUT Y001
END",
    violates: "forward before the pause was over",
    right: "LD X000
OR Y000
ANI X001
AND T1
ANI X005     ; the backward contactor is open
OUT Y000
LDI Y000
OUT T0 K5    ; forward has been off
LD X001
OR Y001
ANI X000
AND T0
ANI X004     ; the forward contactor is open
OUT Y001
LDI Y001
OUT T1 K5    ; backward has been off
END",
};

pub(super) static STAR_DELTA: Function = Function {
    name: "star-delta",
    title: "Star-delta starter",
    standard: "IEC 60947-4-1, star-delta starters; IEC 60204-1, interlocks between contactors",
    text: "A motor starts in star and changes to delta. Star and delta are never on together, a pause separates them, \
           every start begins in star, and star ends in time.",
    parameters: &[
        required("main", Device, "output of the main contactor"),
        required("star", Device, "output of the star contactor"),
        required("delta", Device, "output of the delta contactor"),
        required("pause", Time, "time between star and delta, at least"),
        required("longest", Time, "time in star, at most"),
    ],
    demands: &[
        never("star and delta on", "{star} & {delta}"),
        never("delta without main", "{delta} & !{main}"),
        stays(
            "delta before the pause was over",
            "{star}",
            "!{delta}",
            "!{star} for {pause}",
        ),
        stays(
            "star before the pause was over",
            "{delta}",
            "!{star}",
            "!{delta} for {pause}",
        ),
        stays(
            "delta without star before",
            "!{main}",
            "!{delta}",
            "{main} & {star}",
        ),
        stays("star again after delta", "{delta}", "!{star}", "!{main}"),
        never("star for too long", "{star} for {longest}"),
        reachable("delta is possible", "{delta}"),
    ],
    limits: "Welded contactors, the interlock in the wiring, and whether the motor has come up to speed when star ends.",
    example: "main = \"Y000\"\nstar = \"Y001\"\ndelta = \"Y002\"\npause = \"200ms\"\nlongest = \"2200ms\"",
    wrong: "LD X000
OR Y000
ANI X001
OUT Y000
OUT T0 K20
LD Y000
ANI T0
OUT Y001
LD T0        ; delta in the scan in which star ends
OUT Y002
END",
    violates: "delta before the pause was over",
    right: "LD X000
OR Y000
ANI X001
OUT Y000
LD Y000
ANI M0
AND T2
OUT Y001
OUT T0 K20   ; time in star
LD T0
OR M0
AND Y000
OUT M0       ; star is over
LDI Y001
OUT T1 K2    ; star has been off
LD M0
AND T1
OUT Y002
LDI Y002
OUT T2 K2    ; delta has been off
END",
};

pub(super) static MOVEMENT_TIME_OUT: Function = Function {
    name: "movement-time-out",
    title: "Time-out of a movement",
    standard: "IEC 60204-1, operating limits: a movement that does not arrive is stopped and reported",
    text: "A movement that does not reach its end in time is stopped. The fault is reported, keeps the movement off, and \
           stays until it is reset.",
    parameters: &[
        required("output", Device, "output of the movement"),
        required(
            "done",
            Condition,
            "end of the movement, while it is reached",
        ),
        required("within", Time, "duration of the movement, at most"),
        optional("fault", Device, "device that reports the fault"),
        optional("reset", Condition, "reset of the fault"),
        optional(
            "stop",
            Condition,
            "stop command, which ends a movement without a fault",
        ),
    ],
    demands: &[
        never("movement past its end", "{output} & {done}"),
        never("movement longer than the time", "{output} for {within}"),
        never("movement in spite of the fault", "{output} & {fault}"),
        never("movement during the stop", "{output} & {stop}"),
        never(
            "movement stops early without a fault",
            "falls({output}) & !{done} & !{fault}[ & !{stop}]",
        ),
        stays(
            "fault ends without a reset",
            "",
            "{fault}",
            "rises({reset})",
        ),
        reachable("movement is possible", "{output}"),
        reachable("fault is possible", "{fault}"),
    ],
    limits: "Sensors that report an end that is not reached, and drives that move although their output is off.",
    example: "output = \"Y000\"\ndone = \"X001\"\nwithin = \"2200ms\"\nfault = \"M0\"\nreset = \"X002\"\nstop = \"X003\"",
    wrong: "LD X000
OR Y000
ANI X001     ; waits for the end without a limit
ANI X003
ANI M0
OUT Y000
END",
    violates: "movement longer than the time",
    right: "LD Y000
OUT T0 K20
LDP X002     ; reset
INV
AND M0
OR T0
OUT M0       ; fault
LD X000
OR Y000
ANI X001
ANI X003
ANI M0
OUT Y000
END",
};
