//! Encodings of text: found by byte-order mark, by the shape of the bytes, and by which code page reads without a fault.

use encoding_rs::{Encoding, GBK, SHIFT_JIS, UTF_8, UTF_16BE, UTF_16LE, WINDOWS_1252};

/// Decodes a text file; nothing if it is no text. The flag tells whether some bytes had to be replaced. Where lines end with
/// a carriage return alone, they end with a line feed afterwards.
pub(crate) fn decode(bytes: &[u8]) -> Option<(String, bool)> {
    let encoding = Encoding::for_bom(bytes).map_or_else(|| guess(bytes), |(encoding, _)| encoding);
    let (text, replaced) = encoding.decode_with_bom_removal(bytes);
    let controls = text
        .chars()
        .filter(|c| c.is_control() && !c.is_whitespace() || *c == char::REPLACEMENT_CHARACTER)
        .count();
    // Text holds a stray control character at most; a binary file is full of them.
    let text = match text.contains('\r') && !text.contains('\n') {
        true => text.replace('\r', "\n"),
        false => text.into_owned(),
    };
    (controls * 16 <= text.chars().count()).then_some((text, replaced))
}

/// Decodes short texts of one project, which share a code page, all at once.
pub(crate) fn decode_local(texts: &[&[u8]]) -> Vec<String> {
    let encoding = code_page(&texts.join(&b'\n')).unwrap_or(WINDOWS_1252);
    let decode = |text: &&[u8]| encoding.decode_without_bom_handling(text).0.into_owned();
    texts.iter().map(decode).collect()
}

fn guess(bytes: &[u8]) -> &'static Encoding {
    wide(bytes).or_else(|| code_page(bytes)).unwrap_or(GBK)
}

/// The encoding that reads these bytes without a fault.
fn code_page(bytes: &[u8]) -> Option<&'static Encoding> {
    if std::str::from_utf8(bytes).is_ok() {
        return Some(UTF_8);
    }
    let reads = |encoding: &'static Encoding| {
        encoding.decode_without_bom_handling_and_without_replacement(bytes)
    };
    match (reads(SHIFT_JIS), reads(GBK)) {
        (Some(japanese), chinese) if chinese.is_none() || is_japanese(&japanese) => Some(SHIFT_JIS),
        (_, Some(_)) => Some(GBK),
        _ => None,
    }
}

/// UTF-16 without a mark: lists are mostly ASCII, so every other byte is zero.
fn wide(bytes: &[u8]) -> Option<&'static Encoding> {
    let head = bytes.get(..4096).unwrap_or(bytes);
    let zeros = |odd: usize| {
        head.iter()
            .skip(odd)
            .step_by(2)
            .filter(|&&b| b == 0)
            .count()
    };
    let (even, odd) = (zeros(0), zeros(1));
    match head.len() / 8 {
        few if odd > few && even * 4 < odd => Some(UTF_16LE),
        few if even > few && odd * 4 < even => Some(UTF_16BE),
        _ => None,
    }
}

/// Whether a text that was read as Shift-JIS was meant so. Chinese text read as Shift-JIS is full of half-width katakana, which
/// Japanese text hardly uses beside the full-width kana that it always has.
fn is_japanese(text: &str) -> bool {
    let count =
        |range: std::ops::RangeInclusive<char>| text.chars().filter(|c| range.contains(c)).count();
    count('\u{3041}'..='\u{30FF}') > 2 * count('\u{FF61}'..='\u{FF9F}')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn guessed(text: &str, encoding: &'static Encoding) -> Option<(String, bool)> {
        decode(&encoding.encode(text).0)
    }

    #[test]
    fn code_pages_are_told_apart() {
        let japanese =
            "ステップ番号\t行間ステートメント\t命令\tノート\r\n0\tLD\tX000\t起動ボタン\r\n";
        let chinese = "步号\t行间声明\t指令\t注解\r\n0\tLD\tX000\t启动按钮\r\n";
        for (text, encoding) in [
            (japanese, SHIFT_JIS),
            (chinese, GBK),
            (japanese, UTF_8),
            (chinese, UTF_8),
        ] {
            assert_eq!(
                guessed(text, encoding),
                Some((text.to_owned(), false)),
                "{}",
                encoding.name()
            );
        }
    }

    #[test]
    fn wide_text_needs_no_mark() {
        let text = "\"0\"\t\"\"\t\"LD\"\t\"X000\"\t\"电机\"\r\n";
        let little: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
        let big: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
        assert_eq!(decode(&little), Some((text.to_owned(), false)));
        assert_eq!(decode(&big), Some((text.to_owned(), false)));
    }

    #[test]
    fn a_carriage_return_alone_ends_lines() {
        let read = |text: &str| decode(text.as_bytes()).unwrap().0;
        assert_eq!(read("LD X0\rEND\r"), "LD X0\nEND\n");
        assert_eq!(read("LD X0\r\nEND\r\n"), "LD X0\r\nEND\r\n");
    }

    #[test]
    fn binary_is_no_text() {
        assert_eq!(decode(&[0, 1, 2, 3, 0xFF, 0xFE, 5, 6, 7, 8]), None);
    }
}
