//! Functions of operating devices.

use super::{never, optional, reachable, required, stays, with_default};
use crate::Kind::{Condition, Devices, Several, Time};
use crate::{Function, Over};

pub(super) static TWO_HAND: Function = Function {
    name: "two-hand",
    title: "Two-hand control",
    standard: "ISO 13851, type III C: synchronous actuation, new actuation only after both actuators are released",
    text: "A dangerous movement runs only while both buttons are pressed. They have to be pressed at nearly the same \
           time, so that neither can be tied down, and both have to be released before the next start.",
    parameters: &[
        required("left", Condition, "left button, while it is pressed"),
        required("right", Condition, "right button, while it is pressed"),
        required("output", Devices, "output of the movement"),
        with_default(
            "within",
            Time,
            "500ms",
            "time between the two buttons, at most",
        ),
    ],
    demands: &[
        never("output without the left button", "{output} & !{left}"),
        never("output without the right button", "{output} & !{right}"),
        never(
            "output although the buttons were not pressed together",
            "rises({output}) & (({left} | {right}) for {within})",
        ),
        stays(
            "output again before both buttons were released",
            "falls({output})",
            "!{output}",
            "!{left} & !{right}",
        ),
        stays(
            "output after power-on before both buttons were released",
            "M8002",
            "!{output}",
            "!{left} & !{right}",
        ),
        reachable("output is possible", "{output}"),
    ],
    limits: "The buttons themselves: their distance and shrouds, and contacts that fail to open. Type III C demands two \
             contacts of each button and monitoring in hardware.",
    example: "left = \"X000\"\nright = \"X001\"\noutput = \"Y000\"\nwithin = \"500ms\"",
    wrong: "LD X000
AND X001
OUT Y000     ; a button may be tied down
END",
    violates: "output although the buttons were not pressed together",
    right: "LD X000
OR X001
OUT T0 K5    ; time since the first button
LD M0
ANI T0
OR Y000
AND X000
AND X001
OUT Y000
LDI X000
ANI X001
LD M0
ANI Y000
ORB
OUT M0       ; both have been released
END",
};

pub(super) static MODE_SELECTION: Function = Function {
    name: "mode-selection",
    title: "Mode selection",
    standard: "ISO 12100 and IEC 60204-1, operating modes: one mode at a time, and its selection starts nothing",
    text: "A machine has one mode at a time, runs in none without, stops when the mode changes, and does not start \
           because a mode is selected.",
    parameters: &[
        required(
            "modes",
            Several,
            "devices that are on while a mode is selected, two or more",
        ),
        required("output", Devices, "outputs that run only in a mode"),
        required("start", Condition, "start command"),
    ],
    demands: &[
        never("two modes at once, {a} and {b}", "{a} & {b}").over(Over::Pairs("modes")),
        never("output without a mode", "{output} & !{modes}"),
        stays(
            "output continues although {a} ends",
            "{output} & {a}",
            "{a}",
            "!{output}",
        )
        .over(Over::Each("modes")),
        stays(
            "output starts with the selection of {a}",
            "rises({a})",
            "!{output}",
            "rises({start})",
        )
        .over(Over::Each("modes")),
        reachable("output in {a} is possible", "{output} & {a}").over(Over::Each("modes")),
    ],
    limits: "Who may select a mode (key or password), and what each mode permits: give those demands as separate \
             properties, such as `never = \"M1 & D0 > 100\"` for a reduced speed.",
    example: "modes = [\"M0\", \"M1\"]\noutput = \"Y000\"\nstart = \"X002\"",
    wrong: "LD X000
OUT M0       ; automatic
LD X001
OUT M1       ; manual: both at once are possible
LDP X002
OR Y000
LD M0
OR M1
ANB
OUT Y000
END",
    violates: "two modes at once, M0 and M1",
    right: "LD X000
ANI X001
OUT M0       ; automatic
LD X001
ANI X000
OUT M1       ; manual
LDP M0
ORP M1
OUT M2       ; the mode has just changed
LDP X002
OR Y000
LD M0
OR M1
ANB
ANI M2
OUT Y000
END",
};

pub(super) static HOLD_TO_RUN: Function = Function {
    name: "hold-to-run",
    title: "Hold-to-run control",
    standard: "IEC 60204-1 and ISO 12100, hold-to-run control and enabling device",
    text: "A movement runs only while a button is pressed, and after every stop the button has to be released and pressed \
           anew. With an enabling device, pressing that alone starts nothing.",
    parameters: &[
        required("button", Condition, "button, while it is pressed"),
        required("output", Devices, "output of the movement"),
        optional(
            "enabling",
            Condition,
            "enabling device, while it permits the movement",
        ),
        optional(
            "end",
            Condition,
            "end of the movement, such as a limit switch",
        ),
    ],
    demands: &[
        never("output without the button", "{output} & !{button}"),
        never(
            "output without the enabling device",
            "{output} & !{enabling}",
        ),
        never("output past the end", "{output} & {end}"),
        stays(
            "output again before the button was released",
            "falls({output})",
            "!{output}",
            "!{button}",
        ),
        stays(
            "output after power-on before the button was released",
            "M8002",
            "!{output}",
            "!{button}",
        ),
        stays(
            "output starts with the enabling device",
            "!{enabling} & {button}",
            "!{output}",
            "!{button}",
        ),
        reachable("output is possible", "{output}"),
    ],
    limits: "The speed of the movement, and a button that sticks: an enabling device with three positions is for that.",
    example: "button = \"X000\"\nenabling = \"X001\"\nend = \"X002\"\noutput = \"Y000\"",
    wrong: "LD X000
AND X001     ; starts with whichever comes last
ANI X002
OUT Y000
END",
    violates: "output again before the button was released",
    right: "LD M0
OR Y000
AND X000
AND X001
ANI X002
OUT Y000
LDI X000
OUT M0       ; the button was released after the scan before
END",
};
