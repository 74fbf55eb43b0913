//! Tables of a user, as spreadsheets write them: CSV in any common encoding, with tabs, semicolons or commas.

use crate::csv::{table, unspaced};
use crate::encoding;
use encoding_rs::Encoding;

/// A larger table, in bytes, is rejected.
pub const MAX_TABLE: u64 = 4 << 20;

/// A row of a table.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct TableRow {
    /// Its number in a spreadsheet, from 1.
    pub number: usize,
    /// Its cells, without blanks around them.
    pub cells: Vec<String>,
}

/// Reason why a table cannot be read.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
pub enum TableError {
    /// It is not text, or not in the encoding.
    #[error("it is not text in an encoding that is recognised; save it as UTF-8")]
    Encoding,
    /// A quote is not closed.
    #[error("row {0}: a quote is not closed")]
    Quote(usize),
}

/// Reads a table in this encoding, if it is not Unicode, or in the one that it seems to have. Rows without contents are
/// left out.
///
/// # Errors
///
/// The bytes are not a text, or a quote takes in the rest of the table.
pub fn read_table(
    bytes: &[u8],
    encoding: Option<&'static Encoding>,
) -> Result<Vec<TableRow>, TableError> {
    let is_unicode = Encoding::for_bom(bytes).is_some() || str::from_utf8(bytes).is_ok();
    let chosen = encoding.filter(|_| !is_unicode);
    let (text, replaced) = encoding::decode(bytes, chosen).ok_or(TableError::Encoding)?;
    if replaced {
        return Err(TableError::Encoding);
    }
    let (stated, text) = stated(&text);
    let text = &*unspaced(text);
    let delimiter = stated.unwrap_or_else(|| usual(text));
    let mut rows = Vec::new();
    // Line ends in cells are not rows of a spreadsheet.
    let (mut line, mut counted, mut inside) = (1, 0, 0);
    let ends = |text: &str| text.matches('\n').count();
    for record in table(text, delimiter).into_records() {
        let record = record.map_err(|_| TableError::Encoding)?;
        let at = record.position().map_or(0, |at| at.byte() as usize);
        // A record begins at the end of the line before.
        let rest = text.get(at..).unwrap_or_default();
        let at = text.len() - rest.trim_start_matches(['\r', '\n']).len();
        line += text.get(counted..at).map_or(0, ends);
        counted = at;
        let number = line - inside;
        inside += record.iter().map(ends).sum::<usize>();
        let is_end = |cell: &str| cell.contains('\n') && text.trim_end().ends_with(cell.trim_end());
        if record.iter().any(is_end) {
            return Err(TableError::Quote(number));
        }
        let cells: Vec<_> = record.iter().map(|cell| cell.trim().to_string()).collect();
        if cells.iter().any(|cell| !cell.is_empty()) {
            rows.push(TableRow { number, cells });
        }
    }
    Ok(rows)
}

/// The separator that the line `sep=;` of Excel states, and the text below it.
pub(crate) fn stated(text: &str) -> (Option<u8>, &str) {
    let (first, rest) = text.split_once('\n').unwrap_or((text, ""));
    match first.trim_end().as_bytes() {
        [b's' | b'S', b'e' | b'E', b'p' | b'P', b'=', separator] => (Some(*separator), rest),
        _ => (None, text),
    }
}

/// The separator that is most frequent in the first row with contents.
fn usual(text: &str) -> u8 {
    let first = text.lines().find(|line| !line.trim().is_empty());
    let first = first.unwrap_or_default();
    let outside = first.split('"').step_by(2);
    let count = |separator: char| {
        outside
            .clone()
            .map(|part| part.matches(separator).count())
            .sum()
    };
    let counts = [(b'\t', count('\t')), (b';', count(';')), (b',', count(','))];
    let most = counts
        .into_iter()
        .rev()
        .max_by_key(|(_, n): &(u8, usize)| *n);
    most.map_or(b',', |(separator, _)| separator)
}

#[cfg(test)]
mod tests {
    use super::{TableError, read_table};
    use encoding_rs::{GBK, WINDOWS_1252};

    fn cells(bytes: &[u8]) -> Vec<(usize, String)> {
        let rows = read_table(bytes, None).unwrap();
        let rows = rows.into_iter();
        rows.map(|row| (row.number, row.cells.join("|"))).collect()
    }

    fn is(bytes: &[u8], expected: &[(usize, &str)]) {
        let expected: Vec<_> = expected
            .iter()
            .map(|(n, text)| (*n, text.to_string()))
            .collect();
        assert_eq!(cells(bytes), expected);
    }

    #[test]
    fn tables_of_spreadsheets_are_read() {
        let rows = [(1, "Ursache|Y0"), (3, "Not-Halt; Tür|X")];
        is(
            "Ursache;Y0\r\n;\r\n\"Not-Halt; Tür\";X\r\n".as_bytes(),
            &rows,
        );
        is(
            "\u{feff}Ursache,Y0\n,,\n\"Not-Halt; Tür\",X".as_bytes(),
            &rows,
        );
        is(
            "sep=;\nUrsache;Y0\n\n\"Not-Halt; Tür\";X\n".as_bytes(),
            &rows,
        );
        is(
            "\"Ursache\", \"Y0\"\n\n \"Not-Halt; Tür\" , X\n".as_bytes(),
            &rows,
        );
        let wide: Vec<u8> = "\u{feff}Ursache\tY0\r\n\r\nNot-Halt; Tür\tX\r\n"
            .encode_utf16()
            .flat_map(u16::to_le_bytes)
            .collect();
        is(&wide, &rows);
        let german = WINDOWS_1252
            .encode("Ursache;Y0\r\n\r\n\"Not-Halt; Tür\";X\r\n")
            .0;
        is(&german, &rows);
        let chinese = GBK.encode("原因,电机\r\n急停按钮,X\r\n").0;
        is(&chinese, &[(1, "原因|电机"), (2, "急停按钮|X")]);
        let stated = |bytes: &[u8]| read_table(bytes, Some(GBK)).unwrap()[1].cells.join("|");
        let short = GBK.encode("a,b\n急停,X\n").0;
        assert_eq!(stated(&short), "急停|X");
        assert_eq!(stated("a,b\n急停,X\n".as_bytes()), "急停|X");
        is(
            b"a,b\n\"two\nlines\",X\nc,S\n",
            &[(1, "a|b"), (2, "two\nlines|X"), (3, "c|S")],
        );
    }

    #[test]
    fn what_is_not_a_table_is_rejected() {
        assert_eq!(read_table(&[0; 40], None).unwrap(), []);
        assert_eq!(
            read_table(&[1, 2, 3, 0, 5, 6, 7], None),
            Err(TableError::Encoding)
        );
        assert_eq!(read_table(b"", None).unwrap(), []);
        assert_eq!(
            read_table(b"a,b\n\"c,X\nd,X\n", None),
            Err(TableError::Quote(2))
        );
    }
}
