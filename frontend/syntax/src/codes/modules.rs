//! The PLC that a program is for: its special modules, its variant, its terminals.

super::codes! {
    NO_MODULE = "W0663" "no-module" Warning None,
    "module that the settings do not fit",
    "`[[module]]` in rungc.toml lists the special modules of the PLC, and none of them has the number that the instruction names. On the PLC, FROM and TO to a number without a module are an operation error (M8067, D8067) each time they run.",
    wrong: "",
    right: "";

    NO_BUFFER_WORD = "W0664" "no-buffer-word" Warning None,
    "buffer memory that the module does not have",
    "The instruction reads or writes words after the last one of the module's buffer memory, or reserved words among them. `rungc book module-tables/index` lists the words of each module that rungc knows.",
    wrong: "",
    right: "";

    READ_ONLY_WORD = "W0665" "read-only-word" Warning None,
    "buffer memory that can only be read",
    "The instruction writes a word that the module itself maintains, such as a measured value or an identification code. The module ignores it.",
    wrong: "",
    right: "";

    NOT_ON_VARIANT = "E0670" "not-on-variant" Error None,
    "instruction that this variant of the PLC does not have",
    "`--model` or rungc.toml names a variant of a model, such as `h2u-mtq`, and the program uses an instruction that other PLCs of the family have and this one does not. `rungc explain h2u-mtq` lists what it lacks. Compiled programs have the instruction: name the family, `h2u`, if the program is not to run on that PLC.",
    wrong: "",
    right: "";

    NO_DEVICE_ON_VARIANT = "E0671" "no-device-on-variant" Error None,
    "device or pulse output that this variant of the PLC does not have",
    "The variant of the PLC that `--model` or rungc.toml names has fewer outputs that send pulses or give their direction, or lacks interrupts, counters or special devices that others of its family have. `rungc explain h2u-mtp` lists what it lacks.",
    wrong: "",
    right: "";

    BEYOND_BASE_UNIT = "W0672" "beyond-base-unit" Warning None,
    "terminal that the base unit does not have",
    "The program uses inputs or outputs beyond those of the base unit that `--model` or rungc.toml names. They need an extension module.",
    wrong: "",
    right: "";
}
