//! Encodings of text: by byte-order mark, by the shape of the bytes, and by what language the bytes make in each code
//! page.

use crate::il;
use chardetng::{EncodingDetector, Iso2022JpDetection, Utf8Detection};
use encoding_rs::{
    EUC_JP, EUC_KR, Encoding, GBK, SHIFT_JIS, UTF_8, UTF_16BE, UTF_16LE, WINDOWS_1251, WINDOWS_1255,
};

/// End of a text in the way of DOS, Ctrl-Z.
pub(crate) const DOS_END: u8 = 0x1A;

/// Sample size of the detector, in bytes: of lines that are not ASCII.
const SAMPLE: usize = 256 << 10;

/// Decodes a text file in this encoding, or in the one that it seems to have; `None` if it is not text. The flag is set
/// if some bytes had to be replaced. Where lines end with a carriage return alone, they end with a line feed
/// afterwards.
pub(crate) fn decode(bytes: &[u8], chosen: Option<&'static Encoding>) -> Option<(String, bool)> {
    let bytes = without_padding(bytes);
    let end = dos_end(bytes).map_or(bytes.len(), |end| end.at);
    let bytes = &bytes[..end];
    let marked = || Encoding::for_bom(bytes).map(|(encoding, _)| encoding);
    let encoding = chosen
        .or_else(marked)
        .or_else(|| wide(bytes))
        .unwrap_or_else(|| code_page(bytes));
    let (text, replaced) = encoding.decode_with_bom_removal(bytes);
    let controls = text
        .chars()
        .filter(|c| {
            let is_replaced = *c == char::REPLACEMENT_CHARACTER;
            let counts = chosen.is_none() && encoding != UTF_8;
            c.is_control() && !c.is_whitespace() || is_replaced && counts
        })
        .count();
    // Text holds a stray control character at most; a binary file is full of them.
    if controls * 16 > text.chars().count() {
        return None;
    }
    let text = match text.contains('\r') && !text.contains('\n') {
        true => text.replace('\r', "\n"),
        false => text.into_owned(),
    };
    // A code page of single bytes reads everything: bytes that make no text in any of them are marked.
    match chosen.is_none() && encoding.is_single_byte() {
        true => {
            let padding = encoding.decode_without_bom_handling(&[0xFF; 2]).0;
            let marked = text.replace(&*padding, "\u{FFFD}\u{FFFD}");
            let marked = marked.replace(|c| ('\u{80}'..'\u{A0}').contains(&c), "\u{FFFD}");
            let replaced = replaced || marked != text;
            Some((marked, replaced))
        }
        false => Some((text, replaced)),
    }
}

/// A text without the zeros that fill the rest of its last block.
fn without_padding(bytes: &[u8]) -> &[u8] {
    let end = bytes.iter().rposition(|&b| b != 0).map_or(0, |at| at + 1);
    // The last character of UTF-16 may end with a zero.
    match bytes.len() - end {
        0 | 1 => bytes,
        _ if wide(&bytes[..end]).is_some() || bytes.starts_with(b"\xFF\xFE") => {
            &bytes[..end.next_multiple_of(2)]
        }
        _ => &bytes[..end],
    }
}

/// End of a text in the way of DOS, Ctrl-Z, with what an editor did not clear below it.
pub(crate) struct DosEnd {
    /// Its place.
    pub at: usize,
    /// True if there are instructions below it.
    pub hides_instructions: bool,
}

/// Finds the end of a list in the way of DOS. Where text with instructions follows, readers report the place.
pub(crate) fn dos_end(bytes: &[u8]) -> Option<DosEnd> {
    let at = memchr::memchr(DOS_END, bytes)?;
    let (list, rest) = (&bytes[..at], &bytes[at..]);
    let is_wide = Encoding::for_bom(bytes).is_some_and(|(found, _)| found != UTF_8);
    if is_wide || list.contains(&0) || !has_instructions(list) {
        return None;
    }
    let hides_instructions = has_instructions(rest);
    let is_text = |b: &u8| *b == DOS_END || !b.is_ascii_control() || b.is_ascii_whitespace();
    (!hides_instructions || !rest.iter().all(is_text)).then_some(DosEnd {
        at,
        hides_instructions,
    })
}

/// Returns true if a line begins with a basic instruction after its step number, in a list or a table.
fn has_instructions(bytes: &[u8]) -> bool {
    let mut lines = bytes.split(|b| matches!(b, b'\n' | b'\r'));
    lines.any(|line| {
        let words = line.split(|b| !b.is_ascii_alphanumeric());
        let mut words = words.filter(|word| !word.iter().all(u8::is_ascii_digit));
        let first = words.next().map(str::from_utf8);
        first.is_some_and(|word| word.is_ok_and(il::is_basic))
    })
}

/// The encoding of short texts that share a code page: the one that `stated` names, if it reads them all, else the one
/// that they seem to have together.
pub(crate) fn of_texts(texts: &[&[u8]], stated: Option<&'static Encoding>) -> &'static Encoding {
    let reads = |encoding: &&'static Encoding| texts.iter().all(|text| reads(encoding, text));
    stated
        .filter(reads)
        .unwrap_or_else(|| code_page(&texts.join(&b'\n')))
}

/// The code page that files of one program share, if none of them is Unicode.
pub(crate) fn of_files(files: &[&[u8]]) -> Option<&'static Encoding> {
    let is_unicode = |file: &&[u8]| Encoding::for_bom(file).is_some() || wide(file).is_some();
    if files.iter().any(is_unicode) {
        return None;
    }
    let found = code_page(&files.join(&b'\n'));
    (found != UTF_8).then_some(found)
}

/// Decodes one of these texts.
pub(crate) fn decode_text(text: &[u8], encoding: &'static Encoding) -> String {
    encoding.decode_without_bom_handling(text).0.into_owned()
}

/// The encoding of a Windows code page.
pub(crate) fn of_number(page: u32) -> Option<&'static Encoding> {
    match page {
        932 => Some(SHIFT_JIS),
        936 => Some(GBK),
        949 => Some(EUC_KR),
        950 => Some(encoding_rs::BIG5),
        65001 => Some(UTF_8),
        _ => Encoding::for_label(format!("windows-{page}").as_bytes()),
    }
}

fn reads(encoding: &'static Encoding, bytes: &[u8]) -> bool {
    encoding
        .decode_without_bom_handling_and_without_replacement(bytes)
        .is_some()
}

/// The code page that these bytes seem to be in.
fn code_page(bytes: &[u8]) -> &'static Encoding {
    let utf8 = std::str::from_utf8(bytes).ok();
    if utf8.is_some_and(is_plausible) || is_damaged_utf8(bytes) {
        return UTF_8;
    }
    let sample = sample(bytes);
    let guess = |sample: &[u8]| {
        let mut detector = EncodingDetector::new(Iso2022JpDetection::Deny);
        detector.feed(sample, true);
        detector.guess(None, Utf8Detection::Deny)
    };
    let found = guess(&sample);
    // A text that is cut off in a character of two bytes seems to have single ones.
    if let [whole @ .., last] = bytes
        && !last.is_ascii()
        && found.is_single_byte()
    {
        let encoding = guess(&self::sample(whole));
        if !encoding.is_single_byte() && reads(encoding, whole) {
            return encoding;
        }
    }
    match found {
        // Editors run on Windows, which knows no EUC-JP: short Chinese words look like it.
        _ if found == EUC_JP && reads(GBK, bytes) => GBK,
        _ if found == EUC_JP => SHIFT_JIS,
        _ if !found.is_single_byte() || has_latin_neighbours(&sample) => found,
        // Words of few letters, all above 7Fh.
        _ if is_half_width(&sample) && reads(SHIFT_JIS, bytes) => SHIFT_JIS,
        _ if found == WINDOWS_1255 && is_hebrew(&sample) => found,
        _ if is_cyrillic(&sample) => WINDOWS_1251,
        _ if found != WINDOWS_1251 && is_paired(&sample) && reads(GBK, bytes) => GBK,
        _ => found,
    }
}

/// Returns true for UTF-8 of which some bytes are lost, or lines are in another encoding. Bytes of a code page make few
/// characters of UTF-8 by chance, and hardly ever three of three bytes with nothing else beside them.
pub(crate) fn is_damaged_utf8(bytes: &[u8]) -> bool {
    #[derive(Default)]
    struct Count {
        /// Number of characters of two bytes that comments hold.
        two: usize,
        /// Number of those of more bytes.
        three: usize,
        /// Number of places that are not UTF-8, and of other characters.
        others: usize,
    }
    let count = |line: &[u8]| {
        let mut count = Count::default();
        for chunk in line.utf8_chunks() {
            for c in chunk.valid().chars().filter(|c| !c.is_ascii()) {
                match c.len_utf8() {
                    2 if is_readable(c) || is_hebrew_letter(c) => count.two += 1,
                    3 | 4 if is_readable(c) => count.three += 1,
                    _ => count.others += 1,
                }
            }
            count.others += usize::from(!chunk.invalid().is_empty());
        }
        count
    };
    let lines = bytes.split(|&b| b == b'\n').filter(|line| !line.is_ascii());
    let counts: Vec<Count> = lines.map(count).collect();
    let sum = |of: fn(&Count) -> usize| counts.iter().map(of).sum::<usize>();
    let others = sum(|count| count.others);
    let most = sum(|count| count.two + 2 * count.three) >= 3 * others;
    let whole = counts.iter().filter(|count| count.others == 0);
    let is_certain = counts
        .iter()
        .any(|count| count.others == 0 && count.three > 2);
    others > 0 && (most || is_certain && 2 * whole.count() >= counts.len())
}

/// The lines that are not ASCII, up to the size of a sample.
fn sample(bytes: &[u8]) -> Vec<u8> {
    let mut sample = Vec::new();
    let lines = bytes.split_inclusive(|&b| b == b'\n');
    for line in lines.filter(|line| !line.is_ascii()) {
        let room = SAMPLE - sample.len();
        if room == 0 {
            break;
        }
        sample.extend_from_slice(&line[..line.len().min(room)]);
    }
    sample
}

/// Returns true if text that is valid UTF-8 is plausible as such. Two Chinese characters in GBK can be one of UTF-8 by
/// chance, which is then one that comments do not hold: a combining mark, a letter of Syriac or of a phonetic alphabet.
fn is_plausible(text: &str) -> bool {
    let odd = |c: char| matches!(c, '\u{250}'..='\u{36F}' | '\u{591}'..='\u{5C7}' | '\u{700}'..='\u{7FF}');
    let letters = text.chars().zip(text.chars().skip(1));
    let mut odd_ones = letters.filter(|&(_, c)| odd(c));
    text.contains(|c| c >= '\u{800}')
        || !text.starts_with(odd) && odd_ones.all(|(base, mark)| is_accented(base, mark))
}

/// Returns true for a mark and the Latin letter or mark before it: accents apart from their letters, as macOS writes
/// names and editors there paste them.
fn is_accented(base: char, mark: char) -> bool {
    let above = |mark| matches!(mark, '\u{300}'..='\u{30C}' | '\u{31B}' | '\u{323}');
    let is_letter = base.is_ascii_alphabetic() || matches!(base, '\u{C0}'..='\u{24F}');
    match mark {
        '\u{327}' => "cCsStTgGkKlLnNrReE".contains(base),
        '\u{328}' => "aAeEiIoOuU".contains(base),
        _ => above(mark) && (is_letter || above(base)),
    }
}

/// The runs of bytes above 7Fh, each with whether an ASCII letter is at one of its ends.
fn runs(bytes: &[u8]) -> impl Iterator<Item = (&[u8], bool)> {
    let letter = |at: Option<usize>| {
        at.and_then(|at| bytes.get(at))
            .is_some_and(u8::is_ascii_alphabetic)
    };
    bytes
        .chunk_by(|a, b| a.is_ascii() == b.is_ascii())
        .scan(0, |at, run| {
            let start = *at;
            *at += run.len();
            Some((start, run))
        })
        .filter(|(_, run)| !run[0].is_ascii())
        .map(move |(start, run)| {
            let beside = letter(start.checked_sub(1)) || letter(Some(start + run.len()));
            (run, beside)
        })
}

/// Returns true if most letters above 7Fh are between Latin letters, as in Western and Central European words.
fn has_latin_neighbours(bytes: &[u8]) -> bool {
    let (beside, all) = runs(bytes).fold((0, 0), |(beside, all), (run, latin)| {
        (beside + usize::from(latin && run.len() < 3), all + 1)
    });
    2 * beside > all
}

/// Returns true if text reads as half-width katakana of Shift-JIS, which the editors' users in Japan write: bytes A6h
/// to DFh with a long vowel, a voiced consonant or an odd number of letters, or beside kanji, whose first bytes other
/// code pages hardly use.
fn is_half_width(bytes: &[u8]) -> bool {
    let kana = |b: &u8| matches!(b, 0xA6..=0xDF);
    let voiced = |pair: &[u8]| matches!(pair, [0xB6..=0xC4 | 0xCA..=0xCE, 0xDE | 0xDF] | [_, 0xB0]);
    let odd = |run: &[u8]| run.len() % 2 == 1 && run.iter().any(|b| matches!(b, 0xB0..=0xBF));
    let kanji = bytes
        .iter()
        .any(|b| matches!(b, 0x88..=0x91 | 0x93 | 0x95 | 0x98..=0x9F));
    let mut words = runs(bytes).map(|(run, _)| run).peekable();
    words.peek().is_some()
        && (kanji && words.any(|run| run.iter().any(kana))
            || runs(bytes).all(|(run, _)| run.iter().all(kana))
                && runs(bytes).any(|(run, _)| run.windows(2).any(voiced) || odd(run)))
}

/// Returns true if bytes above 7Fh come in pairs.
fn is_paired(bytes: &[u8]) -> bool {
    runs(bytes).all(|(run, _)| run.len() % 2 == 0)
}

/// Returns true if words read as Cyrillic in Windows-1251: made of its letters alone, with a capital at the beginning
/// or nowhere else.
fn is_cyrillic(bytes: &[u8]) -> bool {
    let letter = |b: &u8| {
        matches!(
            b,
            0xC0..|0xA8| 0xB8 | 0xB2 | 0xB3 | 0xAF | 0xBF | 0xAA | 0xBA
        )
    };
    let word = |run: &[u8]| {
        let small = |b: &u8| *b >= 0xE0;
        run.iter().all(letter) && (run.iter().skip(1).all(small) || !run.iter().any(small))
    };
    let mut words = runs(bytes).filter(|(run, _)| run.len() > 1).peekable();
    words.peek().is_some() && words.all(|(run, _)| word(run))
}

/// Returns true if words read as Hebrew in Windows-1255, where those of Cyrillic have the same bytes: made of its
/// letters alone, with final forms at ends of words, and with letters that are rare in Cyrillic.
fn is_hebrew(bytes: &[u8]) -> bool {
    let is_final = |b: &u8| matches!(b, 0xEA | 0xED | 0xEF | 0xF3 | 0xF5);
    let (mut letters, mut misplaced, mut signs) = (0, 0, 0);
    for (run, _) in runs(bytes) {
        let [inside @ .., last] = run else { continue };
        if !run.iter().all(|b| matches!(b, 0xE0..=0xFA)) {
            return false;
        }
        letters += run.len();
        misplaced += inside.iter().filter(|b| is_final(b)).count();
        // Yod inside of words, he at their ends, shin and tav: a quarter of Hebrew, a fiftieth of Russian.
        signs += inside.iter().filter(|b| **b == 0xE9).count() + usize::from(*last == 0xE4);
        signs += run.iter().filter(|b| matches!(b, 0xF9 | 0xFA)).count();
    }
    letters > 3 && 10 * signs >= letters && 16 * misplaced <= letters
}

/// Letters of Hebrew, without points.
fn is_hebrew_letter(c: char) -> bool {
    matches!(c, '\u{5D0}'..='\u{5EA}')
}

/// UTF-16 without a mark. A text of bytes holds no zero, and wide characters read the wrong way round make no text.
fn wide(bytes: &[u8]) -> Option<&'static Encoding> {
    let head = bytes.get(..4096).unwrap_or(&bytes[..bytes.len() & !1]);
    if !head.contains(&0) {
        return None;
    }
    let readable = |encoding: &'static Encoding| {
        let (text, _) = encoding.decode_without_bom_handling(head);
        let readable =
            |c| is_readable(c) || matches!(c, '\u{300}'..='\u{36F}' | '\u{5D0}'..='\u{6FF}');
        let readable = text.chars().filter(|&c| readable(c)).count();
        let is_list = text.contains(|c: char| c.is_ascii_alphanumeric() || c == '\n');
        (is_list && readable * 16 >= text.chars().count() * 15).then_some((readable, encoding))
    };
    let candidates = [UTF_16LE, UTF_16BE].into_iter().filter_map(readable);
    candidates
        .max_by_key(|(count, _)| *count)
        .map(|(_, encoding)| encoding)
}

/// Characters that lists and comments are written with.
fn is_readable(c: char) -> bool {
    matches!(
        c,
        '\t' | '\r' | '\n' | ' '..='~' | '\u{A0}'..='\u{24F}' | '\u{370}'..='\u{52F}'
            // Devanagari to Burmese, with Thai; the gaps are control characters the wrong way round.
            | '\u{901}'..='\u{9FF}' | '\u{A01}'..='\u{CFF}' | '\u{D01}'..='\u{109F}'
            | '\u{1F000}'..='\u{1FAFF}'
            | '\u{1E00}'..='\u{22FF}' | '\u{2460}'..='\u{27BF}' | '\u{3000}'..='\u{30FF}' | '\u{4E00}'..='\u{9FFF}' | '\u{AC00}'..='\u{D7A3}' | '\u{FF00}'..='\u{FFEF}'
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use encoding_rs::{BIG5, WINDOWS_1250, WINDOWS_1252};

    fn guessed(text: &str, encoding: &'static Encoding) -> Option<(String, bool)> {
        decode(&encoding.encode(text).0, None)
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
    fn short_comments_are_read_in_the_language_that_they_are_in() {
        for (text, encoding) in [
            ("Bóia :: Nível Baixo - Fechado", WINDOWS_1252),
            ("Bóia", WINDOWS_1252),
            ("Nível", WINDOWS_1252),
            ("Störung Förderband", WINDOWS_1252),
            ("Überwachung", WINDOWS_1252),
            ("25°C", WINDOWS_1252),
            ("Zawór główny\nPrzycisk załącz", WINDOWS_1250),
            ("Tlačítko start\nčerpadlo běží", WINDOWS_1250),
            ("Пуск двигателя", WINDOWS_1251),
            ("Стоп", WINDOWS_1251),
            ("ПУСК", WINDOWS_1251),
            ("насос\nклапан", WINDOWS_1251),
            ("стоп", WINDOWS_1251),
            ("датчик\nсвет", WINDOWS_1251),
            ("автомат\nтаймер", WINDOWS_1251),
            ("аварийный стоп\nщит", WINDOWS_1251),
            ("התחלה", WINDOWS_1255),
            ("עצירה", WINDOWS_1255),
            ("לחצן חירום\nמנוע ראשי", WINDOWS_1255),
            ("מסוע קדימה", WINDOWS_1255),
            ("טיימר", WINDOWS_1255),
            ("启动按钮", GBK),
            ("停止", GBK),
            ("电机", GBK),
            ("温度", GBK),
            ("X0启动", GBK),
            ("起動ボタン", SHIFT_JIS),
            ("ﾎﾞﾀﾝ", SHIFT_JIS),
            ("ﾓｰﾀ起動", SHIFT_JIS),
            ("非常停止\n原点復帰", SHIFT_JIS),
            ("정지 버튼", EUC_KR),
            ("시작", EUC_KR),
            ("啟動按鈕", BIG5),
        ] {
            let bytes = encoding.encode(text).0;
            let found = of_texts(&[&bytes], None);
            assert_eq!(decode_text(&bytes, found), text, "{}", found.name());
        }
    }

    /// A byte is lost, a line is in another code page, or the end is missing: what is left is read, the damage marked.
    #[test]
    fn damaged_text_stays_in_its_encoding() {
        let damaged = |bytes: &[u8]| decode(bytes, None).unwrap_or_default();
        let chinese = "LD X0 ; 启动按钮\nOUT Y0 ; 电机正转\nEND ; 结束";
        for (text, missing) in [
            (chinese, "转"),
            (
                "LD X0 ; Überwachung\nOUT Y0 ; Förderband\nAND X1 ; Störung\nEND ; Weiß",
                "ß",
            ),
            ("LD X0 ; Пуск\nOUT Y0 ; Насос\nEND ; Конец", "ц"),
            ("LD X0 ; 起動ボタン\nOUT Y0 ; モータ\nEND ; 終わり", "り"),
            ("LD X0 ; לחצן התחלה\nOUT Y0 ; מנוע\nEND ; סוף", "ע"),
        ] {
            let at = text.find(missing).unwrap();
            for cut in [at, at + missing.len() - 1] {
                let mut bytes = text.as_bytes().to_vec();
                bytes.remove(cut);
                let (read, is_damaged) = damaged(&bytes);
                assert!(is_damaged && read.starts_with(&text[..at]), "{read}");
            }
            let (read, is_damaged) = damaged(&text.as_bytes()[..text.len() - 1]);
            assert!(is_damaged && read.starts_with(&text[..at]), "{read}");
        }
        let lines: Vec<&str> = chinese.split('\n').collect();
        let mut mixed = lines[0].as_bytes().to_vec();
        mixed.push(b'\n');
        mixed.extend_from_slice(&GBK.encode(lines[1]).0);
        let (read, is_damaged) = damaged(&mixed);
        assert!(is_damaged && read.starts_with(lines[0]), "{read}");
        for (text, encoding) in [
            (chinese, GBK),
            (
                "LD X0 ; 起動ボタン\nOUT Y0 ; モータ\nEND ; 終わり",
                SHIFT_JIS,
            ),
            ("LD X0 ; 시작 버튼\nOUT Y0 ; 모터\nEND ; 정지", EUC_KR),
        ] {
            let bytes = encoding.encode(text).0;
            let (read, is_damaged) = damaged(&bytes[..bytes.len() - 1]);
            let end = text.char_indices().last().unwrap().0;
            assert!(is_damaged && read.starts_with(&text[..end]), "{read}");
        }
    }

    #[test]
    fn texts_of_a_project_are_judged_together() {
        let texts = ["Bóia", "Nível Baixo", "Pressão"].map(|text| WINDOWS_1252.encode(text).0);
        let texts: Vec<&[u8]> = texts.iter().map(AsRef::as_ref).collect();
        assert_eq!(of_texts(&texts, None), WINDOWS_1252);
        assert_eq!(of_texts(&texts, of_number(1250)), WINDOWS_1250, "stated");
        assert_eq!(
            of_texts(&texts, Some(UTF_8)),
            WINDOWS_1252,
            "stated wrongly"
        );
    }

    #[test]
    fn wide_text_needs_no_mark() {
        let chinese = "电机正转启动按钮\r\n一号气缸伸出到位信号\r\n".repeat(40);
        for text in ["\"0\"\t\"\"\t\"LD\"\t\"X000\"\t\"电机\"\r\n", &chinese] {
            let little: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
            let big: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
            assert_eq!(decode(&little, None), Some((text.to_owned(), false)));
            assert_eq!(decode(&big, None), Some((text.to_owned(), false)));
        }
    }

    /// Languages of the editors' users beside those of code pages of two bytes.
    #[test]
    fn other_scripts_are_read_in_every_form_of_unicode() {
        for text in [
            "LD X0 ; ปุ่มเริ่ม\nEND ; จบ\n",
            "LD X0 ; nút khởi động\nEND ; kết thúc\n",
            "LD X0 ; प्रारंभ\nEND\n",
            "LD X0 ; زر البدء\nEND\n",
            "LD X0 ; התחלה\nEND\n",
            // Accents apart from their letters.
            "LD X0 ; Tu\u{308}r\nEND\n",
            "LD X0 ; nu\u{301}t kho\u{31b}\u{309}i\nEND ; nhie\u{302}\u{323}t\n",
            "LD X0 ; botao\u{303} c\u{327}\nEND ; za\u{328}b\n",
        ] {
            let little: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
            let big: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
            for bytes in [text.as_bytes(), &little, &big] {
                assert_eq!(decode(bytes, None), Some((text.to_owned(), false)));
            }
        }
        let lines = "LD X0 ; ปุ่มเริ่ม\nOUT Y0 ; มอเตอร์เดินหน้า\nEND ; จบ";
        let (read, is_damaged) = decode(&lines.as_bytes()[..lines.len() - 1], None).unwrap();
        assert!(is_damaged && read.starts_with("LD X0 ; ปุ่มเริ่ม\n"), "{read}");
        // Texts of ASCII alone, in both orders.
        for text in ["NOP\nOUT Y0\n", "OUT\tY000\r\n", "0 NOP\n"] {
            let little: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
            assert_eq!(decode(&little, None), Some((text.to_owned(), false)));
        }
    }

    #[test]
    fn a_chosen_encoding_is_not_guessed() {
        let bytes = WINDOWS_1252.encode("Nível").0;
        let read = decode(&bytes, Some(WINDOWS_1251)).unwrap();
        assert_eq!(read, ("Nнvel".to_owned(), false));
        let wrong = decode(&bytes, Some(UTF_8)).unwrap();
        assert!(wrong.1, "some bytes do not exist in this encoding");
    }

    #[test]
    fn a_carriage_return_alone_ends_lines() {
        let read = |text: &str| decode(text.as_bytes(), None).unwrap().0;
        assert_eq!(read("LD X0\rEND\r"), "LD X0\nEND\n");
        assert_eq!(read("LD X0\r\nEND\r\n"), "LD X0\r\nEND\r\n");
    }

    #[test]
    fn binary_is_no_text() {
        assert_eq!(decode(&[0, 1, 2, 3, 0xFF, 0xFE, 5, 6, 7, 8], None), None);
    }
}
