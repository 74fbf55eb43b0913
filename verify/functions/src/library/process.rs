//! Functions of processes.

use super::{never, optional, reachable, required, stays, with_default};
use crate::Kind::{Condition, Device, Several, Time};
use crate::{Demand, Form, Function, Over};

pub(super) static LEVEL: Function = Function {
    name: "level",
    title: "Level with hysteresis",
    standard: "good practice of two-point control; overfill prevention as in IEC 61511 needs a separate limit switch",
    text: "A pump fills a tank between two levels: it comes on below the lower one, stays on up to the upper one, and is \
           off above. To empty a tank, exchange `low` and `high`.",
    parameters: &[
        required(
            "low",
            Condition,
            "level below the lower limit: `!X000`, or `D0 < 100`",
        ),
        required("high", Condition, "level at the upper limit or above"),
        required("output", Device, "output of the pump or valve"),
        with_default(
            "within",
            Time,
            "1s",
            "time in which the pump comes on, at most",
        ),
        optional("stop", Condition, "stop command, which keeps the pump off"),
    ],
    demands: &[
        never("on above the upper limit", "{output} & {high}"),
        never("on during the stop", "{output} & {stop}"),
        never("comes on above the lower limit", "rises({output}) & !{low}"),
        never(
            "goes off below the upper limit",
            "falls({output}) & !{high}[ & !{stop}]",
        ),
        Demand {
            name: "stays off below the lower limit",
            over: Over::Once,
            form: Form::Whenever {
                when: "{low} & !{high}[ & !{stop}]",
                then: "{output} | !{low} | {high}[ | {stop}]",
                within: "within",
            },
        },
        reachable("output is possible", "{output}"),
    ],
    limits: "Sensors that fail: if one reports a level that is not there, the pump does what it says.",
    example: "low = \"!X000\"\nhigh = \"X001\"\noutput = \"Y000\"\nstop = \"X002\"",
    wrong: "LDI X001     ; on and off at the upper limit alone
ANI X002
OUT Y000
END",
    violates: "comes on above the lower limit",
    right: "LDI X000     ; below the lower limit
OR Y000
ANI X001     ; at the upper limit
ANI X002
OUT Y000
END",
};

pub(super) static SEQUENCE: Function = Function {
    name: "sequence",
    title: "Sequence of steps",
    standard: "IEC 60848 (GRAFCET), a single sequence: one step at a time, in order",
    text: "Steps follow one another in their order: one at a time, each only after the one before it, the first only \
           with the start, and none ends before the next begins.",
    parameters: &[
        required(
            "steps",
            Several,
            "devices of the steps, in order, two or more",
        ),
        required(
            "start",
            Condition,
            "start command, which leads to the first step",
        ),
        optional("stop", Condition, "stop command, which ends any step"),
    ],
    demands: &[
        never("two steps at once, {a} and {b}", "{a} & {b}").over(Over::Pairs("steps")),
        stays("{b} without {a} before", "", "!{b}", "{a}").over(Over::Next("steps")),
        never("{a} without the start", "rises({a}) & !{start}").over(Over::First("steps")),
        never("{a} ends without {b}", "falls({a}) & !{b}[ & !{stop}]").over(Over::Next("steps")),
        never("step during the stop", "{steps} & {stop}"),
        reachable("{a} is possible", "{a}").over(Over::Each("steps")),
    ],
    limits: "The conditions of transitions, what the steps switch on, and sequences that branch. In a step ladder, a step \
             and its successor are on together for one scan, unless the successor is written above it.",
    example: "steps = [\"M0\", \"M1\", \"M2\"]\nstart = \"X000\"\nstop = \"X004\"",
    wrong: "LD X000
SET M0
LD M0
AND X001
SET M1
RST M0
LD M1        ; passes M1 in one scan if X002 is on
AND X002
SET M2
RST M1
LD M2
AND X003
RST M2
LD X004
ZRST M0 M2
END",
    violates: "M2 without M1 before",
    right: "LD M2        ; the last step first: one transition a scan
AND X003
RST M2
LD M1
AND X002
SET M2
RST M1
LD M0
AND X001
SET M1
RST M0
LD X000
ANI M1
ANI M2
SET M0
LD X004
ZRST M0 M2
END",
};
