//! Special modules: what FROM and TO find in those that the settings fit.

super::codes! {
    NO_MODULE = "W0663" "no-module" Warning None,
    "module that the settings do not fit",
    "`[[module]]` in rungc.toml lists the special modules of the PLC, and none of them has the number that the instruction names. On the PLC, FROM and TO to a number without a module are an operation error (M8067, D8067) each time they run.",
    wrong: "",
    right: "";

    NO_BUFFER_WORD = "W0664" "no-buffer-word" Warning None,
    "buffer memory that the module does not have",
    "The instruction reads or writes words after the last one of the module's buffer memory, or reserved words among them. `docs/src/module-tables` lists the words of each module that rungc knows.",
    wrong: "",
    right: "";

    READ_ONLY_WORD = "W0665" "read-only-word" Warning None,
    "buffer memory that can only be read",
    "The instruction writes a word that the module itself maintains, such as a measured value or an identification code. The module ignores it.",
    wrong: "",
    right: "";
}
