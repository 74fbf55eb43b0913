//! Structured ladder and function block diagrams: networks of nodes and wires with their coordinates.

use crate::gx::fields::Fields;

/// A network of a diagram.
#[derive(Clone, PartialEq, Eq, Default, Debug)]
pub struct Network {
    /// Label that jumps name; usually empty.
    pub label: String,
    /// Title; usually empty.
    pub title: String,
    /// Nodes, in the order of the file.
    pub nodes: Vec<Node>,
    /// Wires.
    pub wires: Vec<Wire>,
}

/// A node: contact, coil, function, block, constant or label.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Node {
    /// Kind.
    pub kind: NodeKind,
    /// Text in or above the node: label, constant, name of the function, or instance of the block.
    pub symbol: String,
    /// Type of a block; empty for other nodes.
    pub block: String,
    /// Left edge.
    pub left: i64,
    /// Upper edge.
    pub top: i64,
    /// Ports, in the order of the file.
    pub ports: Vec<Port>,
}

/// Kind of a node.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum NodeKind {
    /// Function, such as `MOV` or `EQ_E`: `_E` has EN and ENO, `-3` three inputs.
    Function,
    /// Instance of a block.
    Block,
    /// Open contact.
    Open,
    /// Closed contact.
    Closed,
    /// Contact that conducts for one scan after a rising edge.
    Rising,
    /// Coil.
    Coil,
    /// Constant or label that is read.
    Input,
    /// Label that is written.
    Output,
    /// Comment.
    Comment,
    /// A kind with another number.
    Other(u32),
}

/// Point of a node that wires join.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Port {
    /// Role.
    pub role: PortRole,
    /// Position from left to right.
    pub x: i64,
    /// Position from top to bottom.
    pub y: i64,
}

/// Role of a port.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum PortRole {
    /// Data or power enter here.
    In,
    /// Data or power leave here.
    Out,
}

/// A wire, horizontal or vertical; a junction has both ends at one point.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Wire {
    /// One end: x, y.
    pub from: (i64, i64),
    /// The other end.
    pub to: (i64, i64),
}

/// The networks of a diagram, and the offset of the first field that could not be read: a damaged network is left out.
pub(super) fn networks(fields: &mut Fields) -> (Vec<Network>, Option<usize>) {
    let mut networks = Vec::new();
    let mut damaged = None;
    let mut read = || {
        fields.u32()?;
        for _ in 0..fields.u32()? {
            let mut inside = part(fields)?;
            match network(&mut inside) {
                Some(network) => networks.push(network),
                None => _ = damaged.get_or_insert(inside.at()),
            }
        }
        Some(())
    };
    if read().is_none() || !fields.rest().is_empty() {
        damaged = damaged.or(Some(fields.at()));
    }
    (networks, damaged)
}

/// The fields of a part, which begins with its size in bytes.
fn part<'b>(fields: &mut Fields<'b>) -> Option<Fields<'b>> {
    let size = fields.u32()? as usize;
    fields.inside(size.checked_sub(4)?)
}

fn network(fields: &mut Fields) -> Option<Network> {
    let mut network = Network {
        label: fields.whole_text()?,
        title: fields.whole_text()?,
        ..Network::default()
    };
    // Height.
    fields.u32()?;
    for _ in 0..fields.u32()? {
        let mut record = part(fields)?;
        match record.u32()? {
            1 => network.nodes.push(node(&mut record)?),
            2 | 3 => network.wires.push(wire(&mut record)?),
            _ => return None,
        }
    }
    Some(network)
}

fn node(fields: &mut Fields) -> Option<Node> {
    let kind = match fields.u32()? {
        0x01 => NodeKind::Function,
        0x02 => NodeKind::Block,
        0x03 => NodeKind::Open,
        0x04 => NodeKind::Closed,
        0x05 => NodeKind::Coil,
        0x0D => NodeKind::Input,
        0x0E => NodeKind::Output,
        0x10 => NodeKind::Comment,
        0x11 => NodeKind::Rising,
        other => NodeKind::Other(other),
    };
    let (symbol, block) = (fields.whole_text()?, fields.whole_text()?);
    let (left, top) = (i64::from(fields.u32()?), i64::from(fields.u32()?));
    // Right and bottom.
    fields.take(8)?;
    let count = fields.u32()?;
    let ports = (0..count).map(|_| {
        let mut port = part(fields)?;
        Some(Port {
            role: match port.u32()? {
                0 | 2 => PortRole::Out,
                1 | 3 | 7 | 11 => PortRole::In,
                _ => return None,
            },
            x: left + i64::from(port.u32()?),
            y: top + i64::from(port.u32()?),
        })
    });
    Some(Node {
        kind,
        symbol,
        block,
        left,
        top,
        ports: ports.collect::<Option<_>>()?,
    })
}

fn wire(fields: &mut Fields) -> Option<Wire> {
    fields.take(16)?;
    let mut point = || Some((i64::from(fields.u32()?), i64::from(fields.u32()?)));
    Some(Wire {
        from: point()?,
        to: point()?,
    })
}
