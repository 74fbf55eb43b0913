//! From instructions to networks.

use crate::network::{
    Branch, Contact, InstrIndex, Item, Join, Ladder, Network, NetworkBody, Node, Output, Part,
    Series, Shape,
};
use rungc_analysis::resolve::{Resolution, Resolved};
use rungc_catalogue::{self as catalogue, Basic, Drive, Lower};

/// The ladder of a program. What cannot be drawn becomes a network that is a list and says why.
pub fn ladder(resolved: &Resolved) -> Ladder {
    let instrs: Vec<Class> = resolved.instrs.iter().map(classify).collect();
    let starts_rung = resolved.starts_of_rungs();
    let mut networks = Vec::new();
    let mut at = 0;
    while at < instrs.len() {
        let network = network(&instrs, &starts_rung, at);
        at = network.instrs.end;
        networks.push(network);
    }
    Ladder { networks }
}

/// Effect of an instruction on the contact logic.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Class {
    /// A contact that starts a block, continues one, or lies parallel to one.
    Contact(catalogue::Join, Shape),
    Anb,
    Orb,
    Mps,
    Mrd,
    Mpp,
    /// INV, MEP, MEF.
    Result,
    /// A coil (`true`) or box that contacts drive.
    Output(bool),
    /// A box that is connected to the rail itself.
    Alone,
    Label,
    Nop,
    /// There is no such instruction.
    Unknown,
}

pub(crate) fn classify(resolution: &Resolution) -> Class {
    use catalogue::Join::{And, Ld, Or};
    let (Some(inst), Some(lower)) = (resolution.inst, resolution.lower) else {
        return Class::Unknown;
    };
    match lower {
        Lower::Compare(join, _) => return Class::Contact(join, Shape::Compare),
        Lower::Basic(basic) => match basic {
            Basic::Ld => return Class::Contact(Ld, Shape::Open),
            Basic::Ldi => return Class::Contact(Ld, Shape::Closed),
            Basic::Ldp => return Class::Contact(Ld, Shape::Rising),
            Basic::Ldf => return Class::Contact(Ld, Shape::Falling),
            Basic::And => return Class::Contact(And, Shape::Open),
            Basic::Ani => return Class::Contact(And, Shape::Closed),
            Basic::Andp => return Class::Contact(And, Shape::Rising),
            Basic::Andf => return Class::Contact(And, Shape::Falling),
            Basic::Or => return Class::Contact(Or, Shape::Open),
            Basic::Ori => return Class::Contact(Or, Shape::Closed),
            Basic::Orp => return Class::Contact(Or, Shape::Rising),
            Basic::Orf => return Class::Contact(Or, Shape::Falling),
            Basic::Anb => return Class::Anb,
            Basic::Orb => return Class::Orb,
            Basic::Mps => return Class::Mps,
            Basic::Mrd => return Class::Mrd,
            Basic::Mpp => return Class::Mpp,
            Basic::Inv | Basic::Mep | Basic::Mef => return Class::Result,
            Basic::Out => return Class::Output(true),
            Basic::Label => return Class::Label,
            Basic::Nop => return Class::Nop,
            _ => {}
        },
        _ => {}
    }
    match inst.drive {
        Drive::Alone => Class::Alone,
        Drive::Contact | Drive::Logic => Class::Output(false),
    }
}

/// The network that starts at `start`.
fn network(instrs: &[Class], starts_rung: &[bool], start: InstrIndex) -> Network {
    let mut at = start;
    while instrs.get(at) == Some(&Class::Label) {
        at += 1;
    }
    let labels = at - start;
    let mut reader = Reader {
        instrs,
        starts_rung,
        at,
        depth: 0,
        nops: Vec::new(),
    };
    match reader.network() {
        Ok(node) => Network {
            instrs: start..reader.at,
            labels,
            nops: reader.nops,
            body: match changes_a_block(&node) {
                true => NetworkBody::List { why: ONE_BLOCK },
                false => NetworkBody::Rung(node),
            },
        },
        Err(why) => Network {
            instrs: start..end_of_list(instrs, starts_rung, at),
            labels,
            nops: Vec::new(),
            body: NetworkBody::List { why },
        },
    }
}

const ONE_BLOCK: Undrawable =
    "INV, MEP or MEF changes the result of a block, not of all that is to its left";

/// Returns true if the result of a block to the right of other contacts is changed. In a drawing everything to the left
/// would be changed, back to the rail.
fn changes_a_block(node: &Node) -> bool {
    fn changes(series: &[Part]) -> bool {
        series.iter().any(|part| match part {
            Part::Contact(_) => false,
            Part::Result(_) => true,
            Part::Group(parts) => changes(parts),
            Part::Parallel(branches) => branches.iter().any(|branch| changes(&branch.series)),
        })
    }
    fn in_series(series: &[Part], mut at_rail: bool) -> bool {
        series.iter().any(|part| {
            let at_rail = std::mem::take(&mut at_rail);
            match part {
                Part::Contact(_) | Part::Result(_) => false,
                Part::Group(parts) => changes(parts),
                Part::Parallel(branches) => {
                    let mut all = branches.iter().map(|branch| &branch.series);
                    all.any(|series| match at_rail {
                        true => in_series(series, true),
                        false => changes(series),
                    })
                }
            }
        })
    }
    fn in_node(node: &Node, at_rail: bool) -> bool {
        in_series(&node.series, at_rail)
            || node.items.iter().any(|item| match item {
                Item::Output(_) => false,
                Item::Stack(branches) => branches.iter().any(|branch| in_node(branch, false)),
                Item::Continue(next) => in_node(next, false),
            })
    }
    in_node(node, true)
}

/// Position at which the network after an undrawable one may start: at the next contact, label or box on the rail after
/// an output.
fn end_of_list(instrs: &[Class], starts_rung: &[bool], start: InstrIndex) -> InstrIndex {
    let mut after_output = instrs[start] == Class::Unknown;
    let mut at = start + 1;
    while at < instrs.len() {
        match instrs[at] {
            Class::Label | Class::Alone => break,
            Class::Contact(catalogue::Join::Ld, _) if after_output && starts_rung[at] => break,
            Class::Nop if after_output => break,
            Class::Output(_) | Class::Unknown => after_output = true,
            _ => {}
        }
        at += 1;
    }
    at
}

/// Maximum nesting of branches in a picture. The deepest real programs need about ten.
const DEEPEST: usize = 100;
const TOO_DEEP: Undrawable = "its branches are nested more than 100 deep";

/// Reads the instructions of a network.
struct Reader<'a> {
    instrs: &'a [Class],
    /// True for each LD that begins a rung.
    starts_rung: &'a [bool],
    at: InstrIndex,
    /// Of the node that is being read.
    depth: usize,
    /// NOPs that were passed over.
    nops: Vec<InstrIndex>,
}

/// Parts that a LD has started.
struct Block {
    series: Series,
    /// Depth of its nested parallel branches.
    depth: usize,
}

/// A reason why a network has no picture.
type Undrawable = &'static str;

impl Reader<'_> {
    fn peek(&self) -> Option<Class> {
        self.instrs.get(self.at).copied()
    }

    /// Passes over NOP within a rung: where what follows belongs to what precedes. Between rungs, NOP is a network.
    fn skip_nops(&mut self) {
        let rest = &self.instrs[self.at..];
        let nops = rest
            .iter()
            .take_while(|class| **class == Class::Nop)
            .count();
        let next = self.at + nops;
        let continues = match self.instrs.get(next) {
            None | Some(Class::Label | Class::Alone | Class::Unknown) => false,
            Some(Class::Contact(catalogue::Join::Ld, _)) => !self.starts_rung[next],
            Some(_) => true,
        };
        if continues {
            self.nops.extend(self.at..next);
            self.at = next;
        }
    }

    /// Reads the network after its labels.
    fn network(&mut self) -> Result<Node, Undrawable> {
        match self.peek() {
            None => return Ok(Node::default()),
            Some(Class::Unknown) => return Err("this instruction is unknown"),
            Some(Class::Alone | Class::Nop) => {
                let output = Output {
                    instr: self.at,
                    coil: false,
                };
                self.at += 1;
                return Ok(Node {
                    series: Vec::new(),
                    items: vec![Item::Output(output)],
                });
            }
            Some(_) => {}
        }
        let node = self.node(true)?;
        let mut rest = self.instrs[self.at..].iter();
        match rest.find(|class| **class != Class::Nop) {
            None
            | Some(
                Class::Contact(catalogue::Join::Ld, _)
                | Class::Label
                | Class::Alone
                | Class::Unknown
                | Class::Nop,
            ) => Ok(node),
            Some(Class::Mrd | Class::Mpp) => Err("no MPS opens a branch"),
            Some(_) => Err("another instruction interrupts it"),
        }
    }

    /// A node: at the rail (where it starts with LD or has no contacts), or within a network (where contacts continue
    /// it).
    fn node(&mut self, at_rail: bool) -> Result<Node, Undrawable> {
        if self.depth == DEEPEST {
            return Err(TOO_DEEP);
        }
        self.depth += 1;
        let series = self.series(at_rail)?;
        let mut items = Vec::new();
        loop {
            self.skip_nops();
            let Some(class) = self.peek() else {
                break;
            };
            match class {
                Class::Output(coil) => {
                    items.push(Item::Output(Output {
                        instr: self.at,
                        coil,
                    }));
                    self.at += 1;
                }
                Class::Mps => {
                    items.push(Item::Stack(self.stack()?));
                    break;
                }
                Class::Contact(catalogue::Join::And, _) | Class::Result if !items.is_empty() => {
                    items.push(Item::Continue(self.node(false)?));
                    break;
                }
                Class::Contact(catalogue::Join::Ld, _)
                    if !items.is_empty() && !self.starts_rung[self.at] =>
                {
                    items.push(Item::Continue(self.node(false)?));
                    break;
                }
                Class::Contact(catalogue::Join::Or, _) => {
                    return Err("a contact is parallel to an output");
                }
                Class::Anb | Class::Orb => return Err("a block is joined after an output"),
                _ => break,
            }
        }
        if items.is_empty() {
            return Err("contacts without an output");
        }
        self.depth -= 1;
        Ok(Node { series, items })
    }

    /// MPS, MRD and MPP with what follows each.
    fn stack(&mut self) -> Result<Vec<Node>, Undrawable> {
        let mut branches = Vec::new();
        loop {
            let last = self.peek() == Some(Class::Mpp);
            self.at += 1;
            branches.push(self.node(false)?);
            if last {
                return Ok(branches);
            }
            self.skip_nops();
            if !matches!(self.peek(), Some(Class::Mrd | Class::Mpp)) {
                return Err("no MPP closes a branch");
            }
        }
    }

    /// The contacts before a node.
    fn series(&mut self, at_rail: bool) -> Result<Series, Undrawable> {
        let mut blocks: Vec<Block> = Vec::new();
        if !at_rail {
            blocks.push(Block::of(Series::new()));
        }
        let underflow = "a block is joined that is not there";
        loop {
            self.skip_nops();
            let Some(class) = self.peek() else {
                break;
            };
            match class {
                Class::Contact(join, shape) => {
                    let contact = Contact {
                        instr: self.at,
                        shape,
                    };
                    contact_joins(&mut blocks, join, Part::Contact(contact), at_rail)?;
                }
                Class::Result => {
                    let block = blocks
                        .last_mut()
                        .ok_or("a result is changed before there is one")?;
                    block.series.push(Part::Result(self.at));
                }
                Class::Anb => {
                    let block = blocks.pop().ok_or(underflow)?;
                    blocks.last_mut().ok_or(underflow)?.follow(block);
                }
                Class::Orb => {
                    let block = blocks.pop().ok_or(underflow)?;
                    if !at_rail && blocks.len() == 1 {
                        return Err("a block is parallel to an output");
                    }
                    blocks
                        .last_mut()
                        .ok_or(underflow)?
                        .parallel(block, Join::Block);
                }
                _ => break,
            }
            if blocks.len() > DEEPEST || blocks.last().is_some_and(|block| block.depth > DEEPEST) {
                return Err(TOO_DEEP);
            }
            self.at += 1;
        }
        match (blocks.pop(), blocks.is_empty()) {
            (None, _) => Ok(Series::new()),
            (Some(block), true) => Ok(block.series),
            (Some(_), false) => Err("a block is not joined to the others"),
        }
    }
}

fn contact_joins(
    blocks: &mut Vec<Block>,
    join: catalogue::Join,
    contact: Part,
    at_rail: bool,
) -> Result<(), Undrawable> {
    let at_node = !at_rail && blocks.len() == 1;
    match join {
        catalogue::Join::Ld => blocks.push(Block::of(vec![contact])),
        catalogue::Join::And => {
            let block = blocks
                .last_mut()
                .ok_or("a contact continues a network that has not started")?;
            block.series.push(contact);
        }
        catalogue::Join::Or if at_node => return Err("a contact is parallel to an output"),
        catalogue::Join::Or => {
            let above = blocks
                .last_mut()
                .ok_or("a contact is parallel to nothing")?;
            above.parallel(Block::of(vec![contact]), Join::Or);
        }
    }
    Ok(())
}

impl Block {
    fn of(series: Series) -> Self {
        Block { series, depth: 0 }
    }

    /// Puts a block to its right.
    fn follow(&mut self, block: Block) {
        let parallel = matches!(block.series[..], [Part::Parallel(_)]);
        self.depth = self.depth.max(block.depth + 1);
        if parallel {
            self.series.extend(block.series);
        } else {
            self.series.push(Part::Group(block.series));
        }
    }

    /// Puts a block below it. Parallel branches take one more.
    fn parallel(&mut self, block: Block, join: Join) {
        let branch = Branch {
            series: block.series,
            join,
        };
        if let [Part::Parallel(branches)] = &mut self.series[..] {
            self.depth = self.depth.max(block.depth + 1);
            branches.push(branch);
            return;
        }
        let first = Branch {
            series: std::mem::take(&mut self.series),
            join: Join::First,
        };
        self.depth = self.depth.max(block.depth) + 1;
        self.series.push(Part::Parallel(vec![first, branch]));
    }
}
