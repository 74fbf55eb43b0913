//! Contact logic: contacts, blocks, branches, coils.

super::codes! {
    NO_CONTACT = "E0401" "no-contact" Error Some(6602),
    "coil or instruction without a contact before it",
    "Contacts drive coils and most instructions. Only on the sub-bus of a state (after STL) may they be connected directly. To drive something always, use M8000.",
    wrong: "OUT Y0\nEND\n",
    right: "LD M8000\nOUT Y0\nEND\n";

    NO_START = "E0402" "no-start" Error Some(6602),
    "contact with nothing to continue",
    "AND, OR, INV and related instructions continue a chain of contacts; a chain starts with LD or one of its forms.",
    wrong: "AND X0\nOUT Y0\nEND\n",
    right: "LD X0\nOUT Y0\nEND\n";

    NO_COIL = "E0403" "no-coil" Error Some(6602),
    "contacts that drive nothing",
    "A chain of contacts must end in a coil or an instruction; here its result is lost.",
    wrong: "LD X0\nAND X1\nEND\n",
    right: "LD X0\nAND X1\nOUT Y0\nEND\n";

    STANDS_ALONE = "E0404" "stands-alone" Error Some(6617),
    "contacts before an instruction that must not have any",
    "Labels, FOR, NEXT, MCR, STL, RET, SRET, IRET, EI, DI, FEND and END are connected directly to the bus, without a contact before them.",
    wrong: "LD X0\nFOR K2\nLD X1\nOUT Y0\nNEXT\nEND\n",
    right: "FOR K2\nLD X1\nOUT Y0\nNEXT\nEND\n";

    NO_BLOCK = "E0405" "no-block" Error Some(6611),
    "ANB or ORB without two blocks to join",
    "ANB and ORB join the block that starts at the last LD to the one before it. There is no second block.",
    wrong: "LD X0\nANB\nOUT Y0\nEND\n",
    right: "LD X0\nLD X1\nOR X2\nANB\nOUT Y0\nEND\n";

    NOT_JOINED = "E0406" "not-joined" Error Some(6612),
    "block that is never joined",
    "A second LD in a rung starts a new block, which ANB or ORB must join to the one before; otherwise its result is lost.",
    wrong: "LD X0\nLD X1\nOUT Y0\nEND\n",
    right: "LD X0\nLD X1\nORB\nOUT Y0\nEND\n";

    TOO_MANY_BLOCKS = "E0407" "too-many-blocks" Error Some(6610),
    "more than eight blocks waiting to be joined",
    "At most eight blocks started with LD may wait for their ANB or ORB. Join each block as soon as it is complete instead of all at the end.",
    wrong: "LD X0\nLD X1\nLD X2\nLD X3\nLD X4\nLD X5\nLD X6\nLD X7\nLD X10\nORB\nORB\nORB\nORB\nORB\nORB\nORB\nORB\nOUT Y0\nEND\n",
    right: "LD X0\nLD X1\nORB\nLD X2\nORB\nLD X3\nORB\nLD X4\nORB\nLD X5\nORB\nLD X6\nORB\nLD X7\nORB\nLD X10\nORB\nOUT Y0\nEND\n";

    NO_BRANCH = "E0408" "no-branch" Error Some(6614),
    "MRD or MPP without MPS",
    "MRD and MPP use the result that MPS stored at the start of a branch. No result is stored here.",
    wrong: "LD X0\nMPP\nOUT Y0\nEND\n",
    right: "LD X0\nMPS\nOUT Y0\nMPP\nOUT Y1\nEND\n";

    OPEN_BRANCH = "E0409" "open-branch" Error Some(6615),
    "MPS without MPP",
    "Every branch that MPS starts must end with MPP, in the same rung.",
    wrong: "LD X0\nMPS\nAND X1\nOUT Y0\nEND\n",
    right: "LD X0\nMPS\nAND X1\nOUT Y0\nMPP\nOUT Y1\nEND\n";

    TOO_MANY_BRANCHES = "E0410" "too-many-branches" Error Some(6613),
    "more than eleven branches open",
    "The stack of MPS holds eleven results.",
    wrong: "LD X0\nMPS\nMPS\nMPS\nMPS\nMPS\nMPS\nMPS\nMPS\nMPS\nMPS\nMPS\nMPS\nOUT Y0\nMPP\nMPP\nMPP\nMPP\nMPP\nMPP\nMPP\nMPP\nMPP\nMPP\nMPP\nMPP\nOUT Y1\nEND\n",
    right: "LD X0\nMPS\nAND X1\nOUT Y0\nMPP\nOUT Y1\nEND\n";

    CROSSED_BRANCH = "E0411" "crossed-branch" Error Some(6616),
    "MRD or MPP in the middle of a block",
    "A block that starts with LD after MPS must be joined before MRD or MPP returns to the branch.",
    wrong: "LD X0\nMPS\nLD X1\nMPP\nOUT Y0\nEND\n",
    right: "LD X0\nMPS\nLD X1\nOR X2\nANB\nOUT Y0\nMPP\nOUT Y1\nEND\n";
}
