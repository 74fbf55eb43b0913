//! POUs: the head of their label table (`*.lh`, in a library `*.lnl`) says what they are, `*.pou` (in a library
//! `*.lnb`) holds their source.

use super::{Class, Label, LadderLine, Network};
use crate::gx::fields::Fields;

/// A program, function block or function.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Pou {
    /// Name.
    pub name: String,
    /// Library that it comes from; `None` for one of the project itself.
    pub library: Option<String>,
    /// Kind.
    pub kind: PouKind,
    /// Type of a function's result; empty for others.
    pub return_type: String,
    /// Labels, in the order of their table.
    pub labels: Vec<Label>,
    /// Source.
    pub body: Body,
}

/// Kind of a POU.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum PouKind {
    /// Program, which tasks run.
    Program,
    /// Function block.
    Block {
        /// True if each call is replaced by the block's code ("macro code"); else the block is a subroutine of each
        /// instance.
        is_expanded: bool,
        /// True if it has EN and ENO.
        has_enable: bool,
    },
    /// Function, a subroutine.
    Function,
}

impl PouKind {
    /// Keyword of a declaration in the notation of IEC 61131-3.
    pub const fn keyword(self) -> &'static str {
        match self {
            PouKind::Program => "PROGRAM",
            PouKind::Block { .. } => "FUNCTION_BLOCK",
            PouKind::Function => "FUNCTION",
        }
    }
}

/// Source of a POU.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Body {
    /// Structured text, with line feeds.
    Text(String),
    /// Ladder, whose operands may be labels.
    Ladder(Vec<LadderLine>),
    /// Structured ladder or function block diagram.
    Networks(Vec<Network>),
    /// Sequential function chart, which is not decoded.
    Chart,
    /// A language with another number.
    Other(u8),
    /// Damaged or missing.
    Unread,
}

impl Body {
    /// Name of its language.
    pub const fn language(&self) -> &'static str {
        match self {
            Body::Text(_) => "structured text",
            Body::Ladder(_) => "ladder",
            Body::Networks(_) => "structured ladder or FBD",
            Body::Chart => "SFC",
            Body::Other(_) => "in an unknown language",
            Body::Unread => "unreadable",
        }
    }
}

impl Pou {
    /// Its labels of a class, in the order of their table.
    pub fn labels_of(&self, class: Class) -> impl Iterator<Item = &Label> {
        self.labels.iter().filter(move |label| label.class == class)
    }
}

/// Head of a POU's label table: what the POU is.
pub(super) struct Head {
    pub kind: PouKind,
    pub return_type: String,
}

impl Head {
    pub(super) fn read(fields: &mut Fields) -> Option<Self> {
        // Name of the POU.
        fields.whole_text()?;
        let kind = fields.checked(Fields::u8, |kind| [0, 2, 3].contains(kind))?;
        fields.take(3)?;
        let flags = fields.u32()?;
        fields.whole_text()?;
        Some(Head {
            kind: match kind {
                0 => PouKind::Program,
                2 => PouKind::Block {
                    is_expanded: flags & 1 != 0,
                    has_enable: flags & 4 != 0,
                },
                3 => PouKind::Function,
                _ => return None,
            },
            return_type: fields.whole_text()?,
        })
    }
}

/// The head that the editor puts into a box of structured text in a ladder: the block returns while EN is off.
const INLINE_END: &str = "IST HEADER END";

/// Bytes of the number of units before structured text.
pub(super) const COUNT: usize = 4;

/// Structured text with line feeds, without the generated head of a box in a ladder; and the first byte of what is not
/// text, if there is such. The content is a number of units of UTF-16, the last of which is 0, and the units.
pub(super) fn text(content: &[u8]) -> (String, Option<usize>) {
    let Some((&count, content)) = content.split_first_chunk::<COUNT>() else {
        return (String::new(), Some(0));
    };
    let units = (u32::from_le_bytes(count) as usize).saturating_sub(1);
    let end = units.saturating_mul(2);
    let cut = (end > content.len()).then_some(content.len());
    let content = content.get(..end).unwrap_or(content);
    let (text, _) = encoding_rs::UTF_16LE.decode_without_bom_handling(content);
    let is_damaged =
        |c: char| c == char::REPLACEMENT_CHARACTER || c.is_control() && !"\t\r\n".contains(c);
    let damaged = text.find(is_damaged);
    let damaged = damaged.map(|at| 2 * text[..at].encode_utf16().count());
    let damaged = damaged.or(cut).map(|at| COUNT + at);
    let text = text.replace("\r\n", "\n");
    let text = match text.find(INLINE_END) {
        Some(at) => {
            let rest = &text[at..];
            let rest = rest.split_once('\n').map_or("", |(_, rest)| rest);
            rest.to_owned()
        }
        None => text,
    };
    (text, damaged)
}
