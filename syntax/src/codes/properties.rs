//! Properties of programs: `rungc verify`.

super::codes! {
    PROPERTY_VIOLATED = "E0800" "property-violated" Error None,
    "the program can violate a property",
    "`rungc verify` has found a run of the program, from power-on with the inputs that it lists, after which the property does not hold. The run has been replayed on the interpreter and happened there. `--write-test` writes it as a test file. Inputs that the machine cannot give, such as both end positions at once, are excluded with `--assume`.",
    wrong: "",
    right: "";

    PROPERTY_UNDECIDED = "W0801" "property-undecided" Warning None,
    "whether the program has a property is not known",
    "`rungc verify` has neither found a run that violates the property nor a proof that there is none: the time was up (`--timeout`), or something that the property depends on is not modelled, so that a run of the model is not one of the program. The report names what is not modelled.",
    wrong: "",
    right: "";

    OUTPUTS_DIFFER = "E0821" "outputs-differ" Error None,
    "an output of the program can differ from that of the older one",
    "`rungc verify --same-as` has found a run in which the output differs, with the same inputs at the same times in both programs. The run has been replayed on both and happened there.",
    wrong: "",
    right: "";

    SAMENESS_UNDECIDED = "W0821" "sameness-undecided" Warning None,
    "whether an output is the same in both programs is not known",
    "`rungc verify --same-as` has neither found a run in which the output differs nor a proof that there is none: the time was up (`--timeout`), or something that is not modelled is used differently in both.",
    wrong: "",
    right: "";
}
