//! The page that keeps tables.

use crate::table::Table;
use crate::tools;

/// Marks before and after the tables.
const BEGIN: &str = "<!-- tables -->\n";
const END: &str = "<!-- end of the tables -->\n";

/// Prefix of a table's title.
const TITLE: &str = "### ";

/// A page with new tables: in place of all that it has, or, if not `whole`, of those with the same titles; others stay,
/// and a table that is new to the page comes last.
///
/// # Errors
/// The page has no place for tables, or the tables that stay were measured with other tools.
pub fn updated(page: &str, tables: &[Table], whole: bool) -> Result<String, &'static str> {
    let parts = page.split_once(BEGIN).and_then(|(before, rest)| {
        let (old, after) = rest.split_once(END)?;
        Some((before, old, after))
    });
    let Some((before, old, after)) = parts else {
        return Err("there is no place for tables");
    };
    let mut all: Vec<String> = match whole {
        true => Vec::new(),
        false => sections(old),
    };
    for table in tables {
        let new = table.to_string();
        let same = all.iter_mut().find(|old| title(old) == title(&new));
        match same {
            Some(old) if table.title == tools::TABLE && *old != new => {
                return Err("the tables that stay were measured with other tools: update them all");
            }
            Some(old) => *old = new,
            None => all.push(new),
        }
    }
    Ok(format!("{before}{BEGIN}\n{}\n{END}{after}", all.join("\n")))
}

/// The tables of a page, each with its title, without the blank line between them.
fn sections(text: &str) -> Vec<String> {
    let mut sections: Vec<String> = Vec::new();
    for line in text.lines() {
        if line.starts_with(TITLE) {
            sections.push(String::new());
        }
        if let Some(section) = sections.last_mut() {
            section.push_str(line);
            section.push('\n');
        }
    }
    for section in &mut sections {
        section.truncate(section.trim_end().len());
        section.push('\n');
    }
    sections
}

fn title(section: &str) -> Option<&str> {
    section.lines().next()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::Cell;

    fn table(title: &str, value: u64) -> Table {
        let mut table = Table::new(title, &["value"]);
        table.row([Cell::count(value)]);
        table
    }

    fn page(tables: &[Table]) -> String {
        let empty = format!("# Page\n\n{BEGIN}{END}\nEnd\n");
        updated(&empty, tables, true).unwrap()
    }

    #[test]
    fn other_tables_stay() {
        let old = page(&[table(tools::TABLE, 1), table("Speed", 2), table("Size", 3)]);
        let new = [table(tools::TABLE, 1), table("Size", 4), table("Calls", 5)];
        let expected = page(&[
            table(tools::TABLE, 1),
            table("Speed", 2),
            table("Size", 4),
            table("Calls", 5),
        ]);
        assert_eq!(updated(&old, &new, false).as_deref(), Ok(&*expected));
        assert_eq!(updated(&old, &new, true), Ok(page(&new)));
    }

    #[test]
    fn tables_of_other_tools_are_not_mixed() {
        let old = page(&[table(tools::TABLE, 1), table("Speed", 2)]);
        let new = [table(tools::TABLE, 9), table("Speed", 3)];
        assert!(updated(&old, &new, false).is_err());
        assert_eq!(updated(&old, &new, true), Ok(page(&new)));
        assert!(updated("nothing", &new, true).is_err());
    }
}
