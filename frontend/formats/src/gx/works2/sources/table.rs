//! Label tables as GX Works2 imports them from CSV: UTF-16 with tabs, the project's name first, then a heading.

use super::text::{Files, SourceFile};
use super::{Class, Label, Pou, PouKind, Sources};

/// The columns of all tables but those of structures: class first.
const GLOBAL: &[&str] = &[
    "Class",
    "Label Name",
    "Data Type",
    "Constant",
    "Device",
    "Address",
    "Comment",
    "Remark",
    "Relation with System Label",
    "System Label Name",
    "Attribute",
];
/// Columns of a program's table.
const PROGRAM: &[&str] = &[
    "Class",
    "Label Name",
    "Data Type",
    "Constant",
    "Device",
    "Address",
    "Comment",
];
/// Columns of a block's or function's table.
const BLOCK: &[&str] = &["Class", "Label Name", "Data Type", "Constant", "Comment"];
/// Columns of a structure's table.
const STRUCTURE: &[&str] = &["Label Name", "Data Type", "Constant", "Comment"];

impl Sources {
    /// Label tables and structures, a file each, of a project of this name.
    pub fn to_label_tables(&self, project: &str) -> Vec<SourceFile> {
        let mut files = Files::default();
        for table in self.globals.iter().filter(|table| !table.labels.is_empty()) {
            let rows = table.labels.iter().map(|label| row(label, GLOBAL));
            let place = (&table.library, "labels/", table.name.as_str());
            files.add(place, "csv", tabulated(project, GLOBAL, rows));
        }
        for pou in self.pous.iter().filter(|pou| !pou.labels.is_empty()) {
            let columns = columns(pou);
            let rows = pou.labels.iter().map(|label| row(label, columns));
            let place = (&pou.library, "", pou.name.as_str());
            files.add(place, "csv", tabulated(project, columns, rows));
        }
        for structure in &self.structures {
            let rows = structure
                .members
                .iter()
                .map(|member| vec![member.name.as_str(), &member.data_type, "", &member.comment]);
            let place = (&structure.library, "structures/", structure.name.as_str());
            files.add(place, "csv", tabulated(project, STRUCTURE, rows));
        }
        files.sorted()
    }
}

fn tabulated<'l>(
    project: &str,
    columns: &[&'l str],
    rows: impl Iterator<Item = Vec<&'l str>>,
) -> Vec<u8> {
    let mut text = format!("\u{FEFF}{}\n", quoted(project));
    for row in std::iter::once(columns.to_vec()).chain(rows) {
        let fields: Vec<_> = row.iter().map(|field| quoted(field)).collect();
        text.push_str(&fields.join("\t"));
        text.push('\n');
    }
    text.encode_utf16().flat_map(u16::to_le_bytes).collect()
}

fn columns(pou: &Pou) -> &'static [&'static str] {
    match pou.kind {
        PouKind::Program => PROGRAM,
        PouKind::Block { .. } | PouKind::Function => BLOCK,
    }
}

/// The fields of a label for these columns.
fn row<'l>(label: &'l Label, columns: &[&str]) -> Vec<&'l str> {
    let field = |column: &&str| match *column {
        "Class" => label.class.name(),
        "Label Name" => &label.name,
        "Data Type" => &label.data_type,
        // The column is that of constants; others have no value there.
        "Constant" if matches!(label.class, Class::Constant | Class::GlobalConstant) => {
            &label.initial
        }
        "Device" => &label.device,
        "Address" => &label.address,
        "Comment" => &label.comment,
        _ => "",
    };
    columns.iter().map(field).collect()
}

/// A field in quotes, which are doubled inside; a line break becomes a space.
fn quoted(field: &str) -> String {
    let field: String = field
        .chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect();
    format!("\"{}\"", field.replace('"', "\"\""))
}
