//! Properties of programs: `rungc verify`.

super::codes! {
    PROPERTY_VIOLATED = "E0800" "property-violated" Error None,
    "the program can violate a property",
    "`rungc verify` or `rungc explore` has found a run of the program, from power-on with the inputs that it lists, after which the property does not hold. The run has been replayed on the interpreter and happened there. `--write-test` writes it as a test file. Inputs that the machine cannot give, such as both end positions at once, are excluded with `--assume`.",
    wrong: "",
    right: "";

    PROPERTY_UNDECIDED = "W0801" "property-undecided" Warning None,
    "whether the program has a property is not known",
    "`rungc verify` has neither found a run that violates the property nor a proof that there is none: the effort was not enough (`--effort` allows more), the time was up (`--timeout`), or something that the property depends on is not modelled, so that a run of the model is not one of the program. The report names what is not modelled.",
    wrong: "",
    right: "";

    PROPERTY_OF_UNDRIVEN = "W0802" "property-of-undriven" Warning None,
    "a property is about a device that nothing drives",
    "The property names a device that no instruction writes, that is not an input, and that nothing outside the program writes as far as rungc knows: an output without a coil, or a relay or register that the program does not use. Such an output is always off, so that a property of it is proved of any program; any other such device may have any value, so that a property of it is easily violated. Is the number right? What a panel or another PLC writes is named in rungc.toml, `[hmi] writes = \"M500\"`, or with `--free`. Special devices, which the PLC itself drives, are not reported.",
    wrong: "",
    right: "";

    OUTPUTS_DIFFER = "E0821" "outputs-differ" Error None,
    "an output of the program can differ from that of the older one",
    "`rungc verify --same-as` has found a run in which the output differs, with the same inputs at the same times in both programs. The run has been replayed on both and happened there.",
    wrong: "",
    right: "";

    SAMENESS_UNDECIDED = "W0821" "sameness-undecided" Warning None,
    "whether an output is the same in both programs is not known",
    "`rungc verify --same-as` has neither found a run in which the output differs nor a proof that there is none: the effort was not enough (`--effort` allows more), the time was up (`--timeout`), or something that is not modelled is used differently in both.",
    wrong: "",
    right: "";

    NEVER_ON = "W0901" "never-on" Warning None,
    "a coil that can never be on",
    "No run of the program switches this relay or output on, whatever its inputs are: the contacts before it contradict each other, or depend on something that never happens. `rungc check --deep` has proved it, if only the program writes the devices that it writes: name what a panel writes in rungc.toml, `[hmi] writes = \"D70-D79\"`. Networks that name M8000 or M8001 are left out, since they are meant so, and so are those that depend on a relay that such a network keeps off or on. What follows from a finding is shown with it. RST and ZRST alone make no coil.",
    wrong: "",
    right: "";

    RUNG_NEVER_ACTS = "W0902" "rung-never-acts" Warning None,
    "a rung that can never do anything",
    "The scan comes to this rung, but its contacts never conduct, so nothing in it is ever executed; coils beside it may be on, if they have other contacts. SET, RST and CALL count as any other instruction. `rungc check --deep` has proved it, if only the program writes the devices that it writes: name what a panel writes in rungc.toml, `[hmi] writes = \"D70-D79\"`.",
    wrong: "",
    right: "";

    STATE_UNREACHABLE = "W0903" "state-unreachable" Warning None,
    "a step that can never be reached",
    "No run of the program switches this step on: the transition to it never takes place. A step that nothing in the program sets counts as off, unless rungc.toml names it or a server whose clients could set it. `rungc check --deep` has proved it, if only the program writes the devices that it writes: name what a panel writes in rungc.toml, `[hmi] writes = \"D70-D79\"`.",
    wrong: "",
    right: "";

    STATE_ENDLESS = "W0904" "state-endless" Warning None,
    "a step that can never be left",
    "Once this step is on, nothing switches it off: no transition leads out of it that can take place. `rungc check --deep` has proved it, if only the program writes the devices that it writes: name what a panel writes in rungc.toml, `[hmi] writes = \"D70-D79\"`.",
    wrong: "",
    right: "";

    COMPARISON_CONSTANT = "W0905" "comparison-constant" Warning None,
    "a comparison that always has the same result",
    "In every run of the program, this comparison has the same result whenever the scan comes to it. If it keeps a whole rung open, it is shown with that rung (W0901 to W0903). `rungc check --deep` has proved it, if only the program writes the devices that it writes: name what a panel writes in rungc.toml, `[hmi] writes = \"D70-D79\"`.",
    wrong: "",
    right: "";

    TIMER_NEVER_EXPIRES = "W0906" "timer-never-expires" Warning None,
    "a timer that can never expire",
    "The timer's coil can be on, but never long enough, or never in two scans in a row. `rungc check --deep` has proved it, if only the program writes the devices that it writes: name what a panel writes in rungc.toml, `[hmi] writes = \"D70-D79\"`.",
    wrong: "",
    right: "";

    OUTPUT_OSCILLATES = "W0907" "output-oscillates" Warning None,
    "an output that can change in every scan",
    "In the run shown, the output is switched on and off in turn, scan by scan, while no input changes. Contactors and relays do not last long that way. `rungc check --deep` has seen it on the interpreter.",
    wrong: "",
    right: "";
}
