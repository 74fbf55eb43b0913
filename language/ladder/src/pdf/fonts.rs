//! Selection of fonts by character.
//!
//! Nothing is embedded. Every reader has the standard fonts (ISO 32000-1 §9.6.2.2); for Chinese, Japanese and Korean
//! texts it takes a font of its system for the character collection that is named (§9.7.5.2). So a file is small, the
//! same on every machine, and its texts can be searched.

use deunicode::deunicode_char;
use pdf_writer::types::{CidFontType, FontFlags, SystemInfo};
use pdf_writer::{Name, Pdf, Rect, Ref, Str};
use unicode_width::UnicodeWidthChar;

/// A font of a page.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Font {
    /// Courier, in WinAnsiEncoding.
    Latin,
    /// Symbol, in its own encoding.
    Symbol,
    Chinese,
    Japanese,
    Korean,
}

/// A font for the characters of a language.
struct Collection {
    font: &'static str,
    ordering: &'static str,
    supplement: i32,
    encoding: &'static str,
}

impl Font {
    pub(super) const ALL: [Font; 5] = [
        Font::Latin,
        Font::Symbol,
        Font::Chinese,
        Font::Japanese,
        Font::Korean,
    ];

    /// Name in page contents.
    pub(super) fn name(self) -> Name<'static> {
        Name(match self {
            Font::Latin => b"L",
            Font::Symbol => b"S",
            Font::Chinese => b"C",
            Font::Japanese => b"J",
            Font::Korean => b"K",
        })
    }

    fn collection(self) -> Option<Collection> {
        let (font, ordering, supplement, encoding) = match self {
            Font::Latin | Font::Symbol => return None,
            Font::Chinese => ("STSong-Light", "GB1", 4, "UniGB-UTF16-H"),
            Font::Japanese => ("HeiseiKakuGo-W5", "Japan1", 5, "UniJIS-UTF16-H"),
            Font::Korean => ("HYGoThic-Medium", "Korea1", 2, "UniKS-UTF16-H"),
        };
        Some(Collection {
            font,
            ordering,
            supplement,
            encoding,
        })
    }

    /// Writes it into a file; `next` gives numbers of objects.
    pub(super) fn write(self, pdf: &mut Pdf, id: Ref, next: &mut impl FnMut() -> Ref) {
        let Some(collection) = self.collection() else {
            let mut font = pdf.type1_font(id);
            if self == Font::Symbol {
                font.base_font(Name(b"Symbol"));
            } else {
                font.base_font(Name(b"Courier"));
                font.encoding_predefined(Name(b"WinAnsiEncoding"));
            }
            return;
        };
        let (descendant, descriptor) = (next(), next());
        let base = Name(collection.font.as_bytes());
        pdf.type0_font(id)
            .base_font(base)
            .encoding_predefined(Name(collection.encoding.as_bytes()))
            .descendant_font(descendant);
        pdf.cid_font(descendant)
            .subtype(CidFontType::Type0)
            .base_font(base)
            .system_info(SystemInfo {
                registry: Str(b"Adobe"),
                ordering: Str(collection.ordering.as_bytes()),
                supplement: collection.supplement,
            })
            .font_descriptor(descriptor)
            .default_width(1000.0);
        pdf.font_descriptor(descriptor)
            .name(base)
            .flags(FontFlags::SYMBOLIC)
            .bbox(Rect::new(-25.0, -254.0, 1000.0, 880.0))
            .italic_angle(0.0)
            .ascent(880.0)
            .descent(-120.0)
            .cap_height(880.0)
            .stem_v(93.0);
    }
}

/// Characters of one font, encoded.
#[derive(Debug, PartialEq)]
pub(super) struct Run {
    pub font: Font,
    pub bytes: Vec<u8>,
    /// Width in sizes of the font.
    pub width: f64,
    /// True if its characters are as wide as high; they are made narrower where they replace narrow ones.
    pub narrowed: bool,
}

/// A text as runs, from left to right.
pub(super) fn runs(text: &str) -> Vec<Run> {
    let asian = language(text);
    let mut runs: Vec<Run> = Vec::new();
    for character in text.chars() {
        for (font, bytes, width, narrowed) in encoded(character, asian) {
            match runs.last_mut() {
                Some(run) if run.font == font && run.narrowed == narrowed => {
                    run.bytes.extend(bytes);
                    run.width += width;
                }
                _ => runs.push(Run {
                    font,
                    bytes,
                    width,
                    narrowed,
                }),
            }
        }
    }
    runs
}

/// Width of a text, in sizes of the font.
pub(super) fn width(text: &str) -> f64 {
    runs(text).iter().map(|run| run.width).sum()
}

/// The font for the wide characters of a text: kana are Japanese, hangul Korean; characters that all three languages
/// share are Chinese otherwise.
fn language(text: &str) -> Font {
    let has = |ranges: &[std::ops::RangeInclusive<char>]| {
        text.chars()
            .any(|c| ranges.iter().any(|range| range.contains(&c)))
    };
    if has(&['\u{3041}'..='\u{30FF}', '\u{FF66}'..='\u{FF9D}']) {
        Font::Japanese
    } else if has(&['\u{1100}'..='\u{11FF}', '\u{AC00}'..='\u{D7A3}']) {
        Font::Korean
    } else {
        Font::Chinese
    }
}

/// Width of a narrow character, in sizes of the font.
pub(super) const NARROW: f64 = 0.6;

type Encoded = (Font, Vec<u8>, f64, bool);

fn encoded(character: char, asian: Font) -> Vec<Encoded> {
    if let Some(byte) = win_ansi(character) {
        return vec![(Font::Latin, vec![byte], NARROW, false)];
    }
    if let Some((byte, width)) = symbol(character) {
        return vec![(Font::Symbol, vec![byte], width, false)];
    }
    let wide = character.width() == Some(2);
    if wide || is_cyrillic_or_greek(character) {
        let mut units = [0; 2];
        let units = character.encode_utf16(&mut units);
        let bytes = units.iter().flat_map(|unit| unit.to_be_bytes()).collect();
        let width = if wide { 1.0 } else { NARROW };
        return vec![(asian, bytes, width, !wide)];
    }
    // Letters that no standard font has: those that they come from. A control character has no shape.
    let plain = match character.is_ascii() {
        true => "",
        false => deunicode_char(character).unwrap_or("?"),
    };
    let plain = plain.bytes().filter(|byte| (b' '..=b'~').contains(byte));
    plain
        .map(|byte| (Font::Latin, vec![byte], NARROW, false))
        .collect()
}

/// The characters of Windows-1252.
fn win_ansi(character: char) -> Option<u8> {
    match character {
        ' '..='~' | '\u{A0}'..='\u{FF}' => u8::try_from(u32::from(character)).ok(),
        '€' => Some(0x80),
        '…' => Some(0x85),
        'Š' => Some(0x8A),
        'Œ' => Some(0x8C),
        'Ž' => Some(0x8E),
        '‘' => Some(0x91),
        '’' => Some(0x92),
        '“' => Some(0x93),
        '”' => Some(0x94),
        '•' => Some(0x95),
        '–' => Some(0x96),
        '—' => Some(0x97),
        'š' => Some(0x9A),
        'œ' => Some(0x9C),
        'ž' => Some(0x9E),
        'Ÿ' => Some(0x9F),
        _ => None,
    }
}

/// Arrows and signs of the font Symbol, with their widths.
fn symbol(character: char) -> Option<(u8, f64)> {
    Some(match character {
        '←' => (0xAC, 0.987),
        '↑' => (0xAD, 0.603),
        '→' => (0xAE, 0.987),
        '↓' => (0xAF, 0.603),
        '≥' => (0xB3, 0.549),
        '≤' => (0xA3, 0.549),
        '≠' => (0xB9, 0.549),
        'Ω' => (0x57, 0.768),
        _ => return None,
    })
}

/// Letters that the collections have as wide ones.
fn is_cyrillic_or_greek(character: char) -> bool {
    matches!(character, 'А'..='я' | 'Ё' | 'ё' | 'Α'..='Ω' | 'α'..='ω')
}
