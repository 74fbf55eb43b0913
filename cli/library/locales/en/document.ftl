doc-about = { $plc }, { $steps ->
        [one] { $steps } step
       *[other] { $steps } steps
    } in { $networks ->
        [one] { $networks } network
       *[other] { $networks } networks
    }

doc-contents = Contents

doc-terminals = Terminals

doc-outputs = What drives each output

doc-chart = Sequence

doc-timers = Timers and counters

doc-specials = Special devices

doc-instructions = Instructions

doc-properties = Properties

doc-open = Open questions

doc-devices = Devices

doc-ladder = Ladder

doc-terminal = Terminal

doc-device = Device

doc-comment = Comment

doc-use = Use

doc-in-networks = Networks

doc-preset = Preset

doc-time = Time

doc-meaning = Meaning

doc-instruction = Instruction

doc-driven-if = driven if

doc-executed-if = executed if

doc-rejected = The program has errors, so conditions are not known: see the open questions.

doc-no-outputs = The program drives no output.

doc-no-open = A check finds nothing, and all used terminals have a comment.

doc-nameless = { $count ->
        [one] A terminal has no comment: { $names }
       *[other] { $count } terminals have no comment: { $names }
    }
