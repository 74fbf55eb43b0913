//! The parts of a GX Works2 project that define its program.

use crate::gx::fields::Fields;
use rungc_syntax::{DeviceClass, DeviceRun};

/// A moment: year, month, day, hour, minute, second, millisecond, in the order in which moments compare.
pub(super) type Time = [u16; 7];

/// Reads the head of `.pou`, `.res`, `.tsk` and `.gh`: title, comment, 22 bytes, a time, 4 bytes.
pub(super) fn head(fields: &mut Fields) -> Option<Time> {
    fields.text()?;
    fields.text()?;
    fields.take(22)?;
    let [year, month, _, day, hour, minute, second, ms] = {
        let mut time = [0; 8];
        for part in &mut time {
            *part = fields.u16()?;
        }
        time
    };
    fields.take(4)?;
    Some([year, month, day, hour, minute, second, ms])
}

/// The project itself: `*.prj`.
pub(super) struct Project {
    pub title: String,
    /// CPU type: `FX3U/FX3UC`.
    pub cpu: String,
    /// Code page of statements, notes and texts in tokens.
    pub code_page: u32,
    /// Devices reserved for labels without one.
    pub reserved: Vec<DeviceRun>,
}

/// The classes whose reserved devices a project states, in their order; `None` where it states nothing for an FX CPU.
const RESERVED: [Option<DeviceClass>; 11] = [
    Some(DeviceClass::D),
    None,
    None,
    // Timers of 100 ms.
    Some(DeviceClass::T),
    None,
    Some(DeviceClass::C),
    Some(DeviceClass::M),
    None,
    Some(DeviceClass::P),
    Some(DeviceClass::S),
    // Timers of 10 ms.
    Some(DeviceClass::T),
];

/// The devices reserved for labels: pairs of the first and the last number, FFFFFFFF for none.
fn reserved(fields: &mut Fields) -> Vec<DeviceRun> {
    let run = |class: &Option<DeviceClass>| {
        let (first, last) = (fields.u32()?, fields.u32()?);
        let count = last.checked_sub(first)?.checked_add(1)?;
        let class = class.filter(|_| first != u32::MAX)?;
        Some(DeviceRun {
            class,
            first,
            count,
        })
    };
    RESERVED.iter().filter_map(run).collect()
}

impl Project {
    pub fn read(bytes: &[u8]) -> Option<Self> {
        let mut fields = Fields::new(bytes);
        let (title, cpu) = (fields.text()?, fields.text()?);
        fields.text()?;
        fields.take(22 + 16 + 4)?;
        let code_page = fields.u32()?;
        Some(Project {
            title,
            cpu,
            code_page,
            reserved: reserved(&mut fields),
        })
    }
}

/// The language of a source.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Language {
    Ladder,
    StructuredText,
    /// Structured ladder or function block diagram.
    Picture,
    /// Sequential function chart.
    Chart,
    Other(u8),
}

impl Language {
    /// Display name.
    pub fn name(self) -> &'static str {
        match self {
            Language::Ladder => "ladder",
            Language::StructuredText => "structured text",
            Language::Picture => "structured ladder or FBD",
            Language::Chart => "SFC",
            Language::Other(_) => "in an unknown language",
        }
    }
}

/// A source: `NAME.Program.pou`.
pub(super) struct Pou {
    pub saved: Time,
    pub language: Language,
    /// Start of its content: tokens of a ladder, UTF-16 of structured text.
    pub start: usize,
    /// End of its content.
    pub end: usize,
}

impl Pou {
    pub fn read(bytes: &[u8]) -> Option<Self> {
        let mut fields = Fields::new(bytes);
        let saved = head(&mut fields)?;
        let language = match fields.u8()? {
            0x01 => Language::Ladder,
            0xC1 => Language::StructuredText,
            0xD0 => Language::Picture,
            0xF0 => Language::Chart,
            other => Language::Other(other),
        };
        fields.u32()?;
        let counted = fields.at();
        let length = fields.u32()? as usize;
        let end = counted.checked_add(length)?;
        let head = match language {
            Language::Ladder => 16,
            Language::StructuredText => 8,
            _ => 0,
        };
        let start = fields.at() + head;
        (start <= end && end <= bytes.len()).then_some(Pou {
            saved,
            language,
            start,
            end,
        })
    }
}

/// A compiled program: the first region of `NAME.res`. The second is empty or an older state.
pub(super) struct Compiled {
    pub created: Time,
    /// Start of its tokens.
    pub start: usize,
    /// End of its tokens.
    pub end: usize,
}

impl Compiled {
    pub fn read(bytes: &[u8]) -> Option<Self> {
        let mut fields = Fields::new(bytes);
        let created = head(&mut fields)?;
        let length = fields.u32()? as usize;
        let start = fields.at();
        fields.take(length)?;
        Some(Compiled {
            created,
            start,
            end: fields.at(),
        })
    }
}

/// A task: `NAME.tsk`.
pub(super) struct Task {
    /// The POUs that it runs, in order.
    pub pous: Vec<String>,
    pub event: String,
    pub interval: String,
    pub priority: u32,
}

impl Task {
    pub fn read(bytes: &[u8]) -> Option<Self> {
        let mut fields = Fields::new(bytes);
        head(&mut fields)?;
        let (event, interval) = (fields.text()?, fields.text()?);
        let priority = fields.u32()?;
        fields.u32()?;
        let count = fields.u32()?;
        let pous = (0..count).map(|_| fields.text()).collect::<Option<_>>()?;
        Some(Task {
            pous,
            event,
            interval,
            priority,
        })
    }
}
