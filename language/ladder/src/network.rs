//! A ladder as a structure. It refers to the instructions of its program by their position.

/// Position of an instruction in [`rungc_syntax::Program::instrs`].
pub type InstrIndex = usize;

/// The ladder of a program.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Ladder {
    /// Its networks, from top to bottom. Together they hold each instruction once.
    pub networks: Vec<Network>,
}

impl Ladder {
    /// Position of the network that holds an instruction.
    pub fn position(&self, instr: InstrIndex) -> usize {
        self.networks
            .partition_point(|network| network.instrs.end <= instr)
    }
}

/// A circuit connected to the left rail at one place, with the labels before it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Network {
    /// Its instructions.
    pub instrs: std::ops::Range<InstrIndex>,
    /// Number of labels (`P0`, `I001`) among them, which come first.
    pub labels: usize,
    /// The NOPs among them that stand within a rung, in order: they have no picture.
    pub nops: Vec<InstrIndex>,
    /// Contents after the labels.
    pub body: NetworkBody,
}

/// Contents of a network.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NetworkBody {
    /// Contacts and outputs.
    Rung(Node),
    /// Instructions that have no picture, as a list.
    List {
        /// Reason, as the end of "cannot be drawn: …".
        why: &'static str,
    },
}

/// Contacts, and what they feed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Node {
    /// Parts between the rail, or the node before, and this node; empty if its items are connected there directly.
    pub series: Series,
    /// Items connected to the node, from top to bottom.
    pub items: Vec<Item>,
}

/// Item connected to a node.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Item {
    /// A coil or an applied instruction.
    Output(Output),
    /// Branches, which MPS, MRD and MPP start; at least two. The last item.
    Stack(Vec<Node>),
    /// More contacts after an output, without MPS. The last item.
    Continue(Node),
}

/// A coil or an applied instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Output {
    /// Its instruction.
    pub instr: InstrIndex,
    /// True if it is drawn as a coil (`OUT`), not as a box.
    pub coil: bool,
}

/// Parts one after another, from left to right.
pub type Series = Vec<Part>;

/// Part of a series.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Part {
    /// A contact of a device, or a comparison.
    Contact(Contact),
    /// INV, MEP, MEF.
    Result(InstrIndex),
    /// At least two branches side by side.
    Parallel(Vec<Branch>),
    /// Parts that the list joins as one block, by ANB; they are drawn like any others.
    Group(Series),
}

/// A contact of a device, or a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Contact {
    /// Its instruction.
    pub instr: InstrIndex,
    /// Symbol.
    pub shape: Shape,
}

/// Symbol of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Normally open.
    Open,
    /// Normally closed.
    Closed,
    /// Closed in the scan after its device came on.
    Rising,
    /// Closed in the scan after its device went off.
    Falling,
    /// A comparison of two values.
    Compare,
}

/// A branch of a parallel connection.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Branch {
    /// Its parts; at least one.
    pub series: Series,
    /// Operation that joins it to the branches above.
    pub join: Join,
}

/// Operation by which the list joins a branch to those above.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Join {
    /// It is the first.
    First,
    /// Its only part is a contact, which the list writes as OR.
    Or,
    /// It starts with LD, and ORB joins it.
    Block,
}
