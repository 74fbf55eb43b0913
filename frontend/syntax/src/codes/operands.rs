//! Devices and operands.

super::codes! {
    OPERAND_CLASS = "E0101" "operand-class" Error Some(6503),
    "operand of the wrong kind",
    "Each operand of an instruction accepts only certain kinds of devices and constants: a contact needs a bit; a destination cannot be a constant or an input. The help lists what is accepted.",
    wrong: "LD X0\nMOV K5 K4X0\nEND\n",
    right: "LD X0\nMOV K5 K4Y0\nEND\n";

    DIGITS = "E0102" "digits" Error Some(6503),
    "digit count that does not fit the width",
    "The digit count of a group of bits (`K4M0`: four digits, 16 bits) is 1 to 4 in a 16-bit instruction and 1 to 8 in a 32-bit one; a few instructions require the full count.",
    wrong: "LD X0\nMOV K5M0 D0\nEND\n",
    right: "LD X0\nMOV K4M0 D0\nEND\n";

    NOT_INDEXABLE = "E0103" "not-indexable" Error Some(6503),
    "index register where it is not allowed",
    "Contacts, coils and other basic instructions accept an index register only on FX3U, and there not with states, special relays, 32-bit counters, words and their bits. Counts, pointers and devices that the hardware binds to an instruction do not accept one either.",
    model: "h2u",
    wrong: "LD M0Z0\nOUT Y0\nEND\n",
    right: "LD M8000\nMOV K1M0Z0 K1M10\nLD M10\nOUT Y0\nEND\n";

    INDEX_WIDTH = "E0104" "index-width" Error Some(6503),
    "V in a 32-bit instruction",
    "In a 32-bit instruction, V (upper word) and Z (lower word) form a pair, which is named by Z, both as an index and as an operand.",
    model: "h2u",
    wrong: "LD X0\nDMOV D0V0 D20\nEND\n",
    right: "LD X0\nDMOV D0Z0 D20\nEND\n";

    LIMITS = "E0105" "limits" Error Some(6503),
    "constant outside its limits",
    "The operand accepts only constants from a certain range.",
    wrong: "LD X0\nFMOV K0 D0 K513\nEND\n",
    right: "LD X0\nFMOV K0 D0 K512\nEND\n";

    NO_DEVICE = "E0106" "no-device" Error Some(6503),
    "the model does not have this device",
    "The number is outside the ranges that the model has for this class. The message lists the ranges.",
    model: "h2u",
    wrong: "LD M3072\nOUT Y0\nEND\n",
    right: "LD M3071\nOUT Y0\nEND\n";

    COUNTER_WIDTH = "E0107" "counter-width" Error Some(6503),
    "32-bit counter in a 16-bit instruction",
    "C200 to C255 have 32 bits. A 16-bit instruction cannot use them; its 32-bit form can.",
    wrong: "LD X0\nMOV C200 D0\nEND\n",
    right: "LD X0\nDMOV C200 D0\nEND\n";

    PAST_THE_END = "E0108" "past-the-end" Error Some(6503),
    "operand that extends past the end of its range",
    "The instruction uses several devices, starting with the named one (two for a 32-bit value, many for a table), and the model does not have all of them.",
    model: "h2u",
    wrong: "LD X0\nDMOV K1 D7999\nEND\n",
    right: "LD X0\nDMOV K1 D7998\nEND\n";

    CONSTANT_WIDTH = "E0109" "constant-width" Error Some(6503),
    "constant that does not fit the width",
    "A 16-bit constant is K-32768 to K32767 or H0 to HFFFF, a 32-bit one K-2147483648 to K2147483647 or H0 to HFFFFFFFF.",
    wrong: "LD X0\nMOV K40000 D0\nEND\n",
    right: "LD X0\nDMOV K40000 D0\nEND\n";

    NOT_THIS_NUMBER = "E0110" "not-this-number" Error Some(6503),
    "device whose number is not allowed here",
    "Some operands accept only certain numbers of a class: pulse outputs, interrupt inputs, groups that start at a number ending in 0.",
    wrong: "LD X0\nREF X1 K8\nEND\n",
    right: "LD X0\nREF X0 K8\nEND\n";

    OPERANDS_DISAGREE = "E0111" "operands-disagree" Error Some(6503),
    "operands that contradict each other",
    "One operand limits another: a shift count must not exceed the length, both ends of a range must be of one class, two groups must have the same number of digits.",
    wrong: "LD X0\nSFTLP X0 M0 K4 K5\nEND\n",
    right: "LD X0\nSFTLP X0 M0 K4 K4\nEND\n";

    BOUND_OUTSIDE = "E0120" "bound-outside" Error None,
    "bound of an indexed operand outside the model's devices",
    "`[index]` in rungc.toml says which devices an operand with an index register can reach: `D100Z0 = \"D100-D163\"`. These must be devices of the operand's class that the model has, all general or all special ones.",
    wrong: "",
    right: "";

    TOO_FEW_OPERANDS = "E0301" "too-few-operands" Error Some(6503),
    "operand missing",
    "The instruction has fewer operands than it needs. The help shows its signature.",
    wrong: "LD X0\nADD D0 K5\nEND\n",
    right: "LD X0\nADD D0 K5 D0\nEND\n";

    TOO_MANY_OPERANDS = "E0302" "too-many-operands" Error Some(6503),
    "more operands than the instruction has",
    "The instruction takes fewer operands. The help shows its signature.",
    wrong: "LD X0\nMPS M0\nOUT Y0\nMPP\nOUT Y1\nEND\n",
    right: "LD X0\nMPS\nOUT Y0\nMPP\nOUT Y1\nEND\n";
}
