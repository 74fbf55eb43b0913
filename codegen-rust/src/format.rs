//! From tokens to text: prettyplease lays the code out, then marker statements become comments.
//!
//! Tokens carry no comments, so the generator writes `line_comment!(3);` before a statement or `end_comment!(3);` behind it; 3 is
//! the number of a text in [`Comments`]. Each marker ends up on a line of its own, which [`format`] replaces.

use proc_macro2::{Literal, TokenStream};
use quote::quote;
use rungc_syntax::text::one_line;

/// Columns that a comment line fills before it is wrapped.
const WIDTH: usize = 100;

/// A user's text within documentation: on one line, and shown by rustdoc as it is instead of read as links, code or HTML.
pub fn documented(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in one_line(text).chars() {
        if matches!(c, '[' | ']' | '<' | '>' | '`' | '\\') {
            out.push('\\');
        }
        out.push(c);
    }
    out
}

/// Texts of the comments of one file.
#[derive(Debug, Default)]
pub struct Comments {
    texts: Vec<String>,
}

impl Comments {
    fn add(&mut self, text: &str) -> Literal {
        // A comment must stay on its line whatever the user wrote.
        self.texts.push(one_line(text).trim().to_string());
        Literal::usize_unsuffixed(self.texts.len() - 1)
    }

    /// A comment on lines of its own, after an empty line.
    pub fn line(&mut self, text: &str) -> TokenStream {
        let n = self.add(text);
        quote!(line_comment!(#n);)
    }

    /// A comment behind the statement before it.
    pub fn end(&mut self, text: &str) -> TokenStream {
        let n = self.add(text);
        quote!(end_comment!(#n);)
    }

    fn marked(&self, line: &str, marker: &str) -> Option<&str> {
        let n = line.strip_prefix(marker)?.strip_prefix("!(")?;
        let n = n.strip_suffix(");")?.parse::<usize>().ok()?;
        self.texts.get(n).map(String::as_str)
    }
}

/// The text of a file.
pub fn format(tokens: TokenStream, comments: &Comments) -> String {
    let file = match syn::parse2::<syn::File>(tokens.clone()) {
        Ok(file) => file,
        // Unformatted text lets rustc name the fault, which beats a panic here.
        Err(_) => return tokens.to_string(),
    };
    place_comments(&prettyplease::unparse(&file), comments)
}

fn place_comments(text: &str, comments: &Comments) -> String {
    let mut out = String::with_capacity(text.len());
    for line in text.lines() {
        let code = line.trim_start();
        let indent = &line[..line.len() - code.len()];
        if let Some(comment) = comments.marked(code, "end_comment") {
            out.truncate(out.trim_end().len());
            out.push_str(" // ");
            out.push_str(comment);
            out.push('\n');
        } else if let Some(comment) = comments.marked(code, "line_comment") {
            let begins_block = out.ends_with("{\n");
            if !out.is_empty() && !begins_block && !out.ends_with("\n\n") {
                out.push('\n');
            }
            wrap(&mut out, indent, comment);
        } else {
            if indent.len() <= 4 && begins_item(code) && ends_item(&out) && !same_kind(code, &out) {
                out.push('\n');
            }
            out.push_str(line);
            out.push('\n');
        }
    }
    out
}

/// Whether a line of code begins an item or what belongs in front of one.
fn begins_item(code: &str) -> bool {
    const STARTS: [&str; 9] = [
        "///", "#[", "fn ", "pub ", "impl ", "const ", "static ", "use ", "mod ",
    ];
    STARTS.iter().any(|start| code.starts_with(start))
}

/// Whether both lines are `use`, or both `mod`, and so stay together.
fn same_kind(code: &str, out: &str) -> bool {
    let last = out.lines().next_back().unwrap_or_default();
    ["use ", "mod ", "#!["]
        .iter()
        .any(|start| code.starts_with(start) && last.starts_with(start))
}

/// Whether what was written last ends an item that is set off from the next one by an empty line.
fn ends_item(out: &str) -> bool {
    let Some(last) = out.lines().next_back() else {
        return false;
    };
    let code = last.trim_start();
    let is_block = code == "}" || code == "};" || code == "]);";
    let is_head = last.starts_with("#![") || last.starts_with("use ") || last.starts_with("mod ");
    let is_value = last.starts_with("const ") || last.starts_with("static ");
    is_block || is_head || is_value || last.starts_with("//!")
}

fn wrap(out: &mut String, indent: &str, comment: &str) {
    let mut column = 0;
    for word in comment.split_whitespace() {
        let length = word.chars().count() + 1;
        if column == 0 || column + length > WIDTH {
            if column > 0 {
                out.push('\n');
            }
            out.push_str(indent);
            out.push_str("//");
            column = indent.len() + 2;
        }
        out.push(' ');
        out.push_str(word);
        column += length;
    }
    out.push('\n');
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markers_become_comments() {
        let mut comments = Comments::default();
        let line = comments.line("step 0: start\nand stop");
        let end = comments.end("motor latch");
        let tokens = quote!(fn f(plc: &mut Plc) { #line plc.a = true; plc.m0 = plc.x0; #end #line if plc.m0 { #line plc.y0 = true; } });
        let lines = [
            "fn f(plc: &mut Plc) {",
            "    // step 0: start and stop",
            "    plc.a = true;",
            "    plc.m0 = plc.x0; // motor latch",
            "",
            "    // step 0: start and stop",
            "    if plc.m0 {",
            "        // step 0: start and stop",
            "        plc.y0 = true;",
            "    }",
            "}",
            "",
        ];
        assert_eq!(format(tokens, &comments), lines.join("\n"));
    }
}
