//! Functions that stop a machine and keep it stopped.

use super::{never, optional, reachable, required, stays};
use crate::Function;
use crate::Kind::{Condition, Device, Devices, Time};

pub(super) static EMERGENCY_STOP: Function = Function {
    name: "emergency-stop",
    title: "Emergency stop with reset",
    standard: "ISO 13850 and IEC 60204-1, stop category 0: it has priority, and its reset starts nothing",
    text: "The stop switches the outputs off at once. They stay off after the device is released, until someone resets the \
           stop on purpose: a reset that was held before does not count. With `start`, the reset starts nothing by itself.",
    parameters: &[
        required(
            "stop",
            Condition,
            "emergency stop, while it is actuated: `!X000` for a contact that opens",
        ),
        required("reset", Condition, "reset button, while it is pressed"),
        required("output", Devices, "outputs that the stop switches off"),
        optional(
            "start",
            Condition,
            "start command, without which nothing starts after a stop",
        ),
    ],
    demands: &[
        never("output during the stop", "{output} & {stop}"),
        stays(
            "output after the stop without a reset",
            "{stop}",
            "!{output}",
            "rises({reset}) & !{stop}",
        ),
        stays(
            "output after power-on without a reset",
            "M8002",
            "!{output}",
            "rises({reset}) & !{stop}",
        ),
        stays(
            "output after the stop without a start",
            "{stop}",
            "!{output}",
            "rises({start}) & !{stop}",
        ),
        reachable("output is possible", "{output}"),
    ],
    limits: "Everything outside of the program: the device and its wiring, welded contactors, the power of drives. A PLC of \
             this family is not a safety PLC: ISO 13849-1 asks for a safety relay, and the program for its signal. Stop \
             category 1, with a controlled stop first, is not covered. A reset and a start may come in any order.",
    example: "stop = \"!X000\"\nreset = \"X001\"\nstart = \"X002\"\noutput = \"Y000\"",
    wrong: "LD X002
OR Y000
AND X000     ; released again: a start is enough
OUT Y000
END",
    violates: "output after the stop without a reset",
    right: "LDP X001     ; reset
OR M0
AND X000     ; the emergency stop is not actuated
OUT M0       ; enabled
LDP X002     ; start
OR Y000
AND M0
OUT Y000
END",
};

pub(super) static GUARD: Function = Function {
    name: "guard",
    title: "Guard with locking",
    standard: "ISO 14119, interlocking guard with guard locking: no hazard before it is closed and locked, locked until \
               the hazard has gone",
    text: "A movement runs only while the guard is closed and locked. The guard is unlocked only while the movement is \
           off, and after it has come to rest. Closing the guard starts nothing.",
    parameters: &[
        required("closed", Condition, "guard, while it is closed"),
        required("output", Devices, "outputs of the movement"),
        required("start", Condition, "start command"),
        optional("locked", Condition, "lock, while it is closed"),
        optional("unlock", Device, "output that opens the lock"),
        optional(
            "standstill",
            Condition,
            "monitor of standstill, while nothing moves",
        ),
        optional(
            "run-down",
            Time,
            "time for which the movement has to be off before the lock opens",
        ),
    ],
    demands: &[
        never("output with the guard open", "{output} & !{closed}"),
        never("output with the guard unlocked", "{output} & !{locked}"),
        never("output while the lock opens", "{output} & {unlock}"),
        never("lock opens before standstill", "{unlock} & !{standstill}"),
        never(
            "lock opens before the run-down time is over",
            "{unlock} & !(!{output} for {run-down})",
        ),
        stays(
            "output starts when the guard closes",
            "!{closed}",
            "!{output}",
            "rises({start}) & {closed}",
        ),
        stays(
            "output after power-on without a start",
            "M8002",
            "!{output}",
            "rises({start})",
        ),
        reachable("output is possible", "{output}"),
        reachable("opening of the lock is possible", "{unlock}"),
    ],
    limits: "Switches that are defeated or broken, a lock that opens without power, and people inside the guard. The time \
             for run-down counts from power-on, too.",
    example: "closed = \"X000\"\nlocked = \"X001\"\nstart = \"X003\"\noutput = \"Y000\"\nunlock = \"Y001\"\n\
              standstill = \"X004\"\nrun-down = \"1s\"",
    wrong: "LD X003
OR Y000
AND X000
AND X001
ANI X002
OUT Y000
LD X002      ; unlocks while the movement runs down
AND X004
OUT Y001
END",
    violates: "lock opens before the run-down time is over",
    right: "LDP X003     ; start
OR Y000
AND X000     ; closed
AND X001     ; locked
ANI X002     ; request to open
OUT Y000
LDI Y000
OUT T0 K10   ; run-down
LD X002
AND T0
AND X004     ; standstill
OUT Y001     ; unlock
END",
};

pub(super) static MUTING: Function = Function {
    name: "muting",
    title: "Muting of a light curtain",
    standard: "IEC 62046, muting: automatic, temporary, by two sensors, with a lamp and a time limit",
    text: "A light curtain is bypassed while material passes: by two sensors that are covered at the same time, for a \
           limited time, and only if the field was free before. Without muting, an interruption switches the outputs off.",
    parameters: &[
        required(
            "interrupted",
            Condition,
            "light curtain, while its field is interrupted",
        ),
        required("first", Condition, "one muting sensor, while it is covered"),
        required(
            "second",
            Condition,
            "the other muting sensor, while it is covered",
        ),
        required(
            "muted",
            Device,
            "device that is on while the curtain is bypassed",
        ),
        required("output", Devices, "outputs that the curtain switches off"),
        required("limit", Time, "longest muting"),
        optional("apart", Time, "time between the two sensors, at most"),
        optional("lamp", Device, "muting lamp"),
        optional(
            "reset",
            Condition,
            "reset after an interruption without muting",
        ),
    ],
    demands: &[
        never(
            "output with the field interrupted and not muted",
            "{output} & {interrupted} & !{muted}",
        ),
        never("muted without the first sensor", "{muted} & !{first}"),
        never("muted without the second sensor", "{muted} & !{second}"),
        never("muted longer than the limit", "{muted} for {limit}"),
        never(
            "muted after the field was interrupted",
            "rises({muted}) & {interrupted}",
        ),
        never(
            "muted although the sensors were not covered together",
            "rises({muted}) & (({first} | {second}) for {apart})",
        ),
        stays(
            "muted again before a sensor was free",
            "falls({muted})",
            "!{muted}",
            "!{first} | !{second}",
        ),
        never("muted without the lamp", "{muted} & !{lamp}"),
        stays(
            "output after an interruption without a reset",
            "{interrupted} & !{muted}",
            "!{output}",
            "rises({reset})",
        ),
        reachable(
            "output with the field interrupted is possible",
            "{output} & {interrupted} & {muted}",
        ),
    ],
    limits: "The place of the sensors, by which a person cannot cover both, the direction of the material, muting by more \
             than two sensors, a lamp that is broken, and overriding.",
    example: "interrupted = \"!X000\"\nfirst = \"X001\"\nsecond = \"X002\"\nmuted = \"M0\"\nlamp = \"Y001\"\n\
              output = \"Y000\"\nreset = \"X003\"\nlimit = \"2s\"\napart = \"1s\"",
    wrong: "LD X001
AND X002
OUT M0       ; muted for as long as something covers both sensors
OUT Y001
LD X000
OR M0
LDP X003
OR Y000
ANB
OUT Y000
END",
    violates: "muted longer than the limit",
    right: "LD X001
OR X002
OUT T0 K10   ; time since the first sensor
LDI T0
AND X000     ; the field is free
OR M1
AND X001
AND X002
OUT M1       ; muting has begun, until a sensor is free
OUT T1 K20
ANI T1
OUT M0       ; muted
OUT Y001     ; lamp
LD X000
OR M0
LDP X003     ; reset
OR Y000
ANB
OUT Y000
END",
};
