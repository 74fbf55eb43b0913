//! From tokens to text: prettyplease lays code out, and comments are printed between it.

use proc_macro2::{Literal, TokenStream};
use quote::quote;
use rungc_syntax::text::one_line;

/// Columns that a comment line fills before it is wrapped.
const WIDTH: usize = 100;

/// A user's text within documentation: on one line, and shown by rustdoc as it is instead of read as links, code or
/// HTML.
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

/// The statements of a block, and the comments between them.
#[derive(Default)]
pub struct Body {
    pieces: Vec<Piece>,
}

enum Piece {
    Code(TokenStream),
    Comment(String),
    Trailing(String),
    Block {
        head: TokenStream,
        body: Body,
    },
    Branches {
        cond: TokenStream,
        bodies: [Body; 2],
    },
    Arms {
        head: TokenStream,
        arms: Vec<Arm>,
    },
}

/// The statements for a number.
pub struct Arm {
    /// The number.
    pub number: Literal,
    /// Comment beside it.
    pub beside: String,
    /// The statements.
    pub body: Body,
}

impl Body {
    /// Adds statements.
    pub fn code(&mut self, tokens: TokenStream) {
        match self.pieces.last_mut() {
            _ if tokens.is_empty() => {}
            Some(Piece::Code(code)) => code.extend(tokens),
            _ => self.pieces.push(Piece::Code(tokens)),
        }
    }

    /// Adds what is in another one.
    pub fn append(&mut self, other: Body) {
        for piece in other.pieces {
            match piece {
                Piece::Code(code) => self.code(code),
                piece @ (Piece::Comment(_)
                | Piece::Trailing(_)
                | Piece::Block { .. }
                | Piece::Branches { .. }
                | Piece::Arms { .. }) => self.pieces.push(piece),
            }
        }
    }

    /// Adds a comment on separate lines, after an empty line.
    pub fn comment(&mut self, text: &str) {
        self.pieces.push(Piece::Comment(clean(text)));
    }

    /// Adds a comment after the statement before it, on its line.
    pub fn trailing_comment(&mut self, text: &str) {
        self.pieces.push(Piece::Trailing(clean(text)));
    }

    /// Adds a block with this head: `for i in 0..3`.
    pub fn block(&mut self, head: TokenStream, body: Body) {
        self.pieces.push(Piece::Block { head, body });
    }

    /// Adds an `if`, with an `else` if that has statements.
    pub fn branches(&mut self, cond: TokenStream, then: Body, otherwise: Body) {
        let bodies = [then, otherwise];
        self.pieces.push(Piece::Branches { cond, bodies });
    }

    /// Adds a choice between numbers with this head, `match at`, which does nothing for others.
    pub fn arms(&mut self, head: TokenStream, arms: Vec<Arm>) {
        self.pieces.push(Piece::Arms { head, arms });
    }

    /// Returns true if it is empty.
    pub fn is_empty(&self) -> bool {
        self.pieces.is_empty()
    }

    /// Its code, without comments.
    pub fn tokens(&self) -> TokenStream {
        let tokens = self.pieces.iter().map(|piece| match piece {
            Piece::Code(code) => code.clone(),
            Piece::Comment(_) | Piece::Trailing(_) => TokenStream::new(),
            Piece::Block { head, body } => {
                let body = body.tokens();
                quote!(#head { #body })
            }
            Piece::Branches { cond, bodies } => {
                let [then, otherwise] = [&bodies[0], &bodies[1]].map(Body::tokens);
                let otherwise = (!otherwise.is_empty()).then(|| quote!(else { #otherwise }));
                quote!(if #cond { #then } #otherwise)
            }
            Piece::Arms { head, arms } => {
                let arms = arms.iter().map(|arm| {
                    let (number, body) = (&arm.number, arm.body.tokens());
                    quote!(#number => { #body })
                });
                quote!(#head { #(#arms)* _ => {} })
            }
        });
        tokens.collect()
    }
}

/// A comment must stay on its line whatever the user wrote.
fn clean(text: &str) -> String {
    one_line(text).trim().to_string()
}

/// A function with comments in its body. `head` is all of it but the body.
pub fn function(head: &TokenStream, body: &Body) -> String {
    let mut printer = Printer::default();
    printer.open(quote!(#head { loop {} }), 0);
    printer.body(body, 1);
    printer.close(0);
    printer.out
}

/// Items, with an empty line between them and between the members of an implementation.
pub fn items(tokens: TokenStream) -> String {
    let mut file = match syn::parse2::<syn::File>(tokens.clone()) {
        Ok(file) => file,
        // Unformatted text lets rustc name the fault, which beats a panic here.
        Err(_) => return tokens.to_string(),
    };
    let mut out = String::new();
    for item in std::mem::take(&mut file.items) {
        if !out.is_empty() {
            out.push('\n');
        }
        file.items = vec![item];
        match members(&mut file) {
            members if members.len() > 1 => implementation(&mut out, &mut file, members),
            members => {
                set_members(&mut file, members);
                out.push_str(&prettyplease::unparse(&file));
            }
        }
    }
    out
}

/// Takes the members out of the one item of a file, if that is an implementation.
fn members(file: &mut syn::File) -> Vec<syn::ImplItem> {
    match file.items.first_mut() {
        Some(syn::Item::Impl(implementation)) => std::mem::take(&mut implementation.items),
        _ => Vec::new(),
    }
}

fn set_members(file: &mut syn::File, members: Vec<syn::ImplItem>) {
    if let Some(syn::Item::Impl(implementation)) = file.items.first_mut() {
        implementation.items = members;
    }
}

/// Prints the members of an implementation one by one.
fn implementation(out: &mut String, file: &mut syn::File, members: Vec<syn::ImplItem>) {
    let head = lines(&prettyplease::unparse(file)).len();
    for (i, member) in members.into_iter().enumerate() {
        set_members(file, vec![member]);
        let text = prettyplease::unparse(file);
        let lines = lines(&text);
        // Head and brace surround the first and the last one.
        let from = if i == 0 { 0 } else { head };
        if i > 0 {
            out.push('\n');
        }
        out.extend(lines[from..lines.len() - 1].iter().copied());
    }
    out.push_str("}\n");
}

fn lines(text: &str) -> Vec<&str> {
    text.split_inclusive('\n').collect()
}

/// Prints a function.
#[derive(Default)]
struct Printer {
    out: String,
    /// True at the start of a block: a comment needs no empty line before it.
    fresh: bool,
}

impl Printer {
    fn body(&mut self, body: &Body, depth: usize) {
        for piece in &body.pieces {
            match piece {
                Piece::Code(code) => self.code(code.clone(), depth, 0),
                Piece::Comment(text) => {
                    if !self.fresh {
                        self.out.push('\n');
                    }
                    self.wrapped(text, depth);
                }
                Piece::Trailing(text) => {
                    self.out.truncate(self.out.trim_end().len());
                    self.out.push_str(" // ");
                    self.out.push_str(text);
                    self.out.push('\n');
                }
                Piece::Block { head, body } => {
                    self.open(quote!(#head { loop {} }), depth);
                    self.body(body, depth + 1);
                    self.close(depth);
                }
                Piece::Branches { cond, bodies } => {
                    self.open(quote!(if #cond { loop {} }), depth);
                    self.body(&bodies[0], depth + 1);
                    if !bodies[1].is_empty() {
                        self.line("} else {", depth);
                        self.fresh = true;
                        self.body(&bodies[1], depth + 1);
                    }
                    self.close(depth);
                }
                Piece::Arms { head, arms } => {
                    self.line(&format!("{head} {{"), depth);
                    for arm in arms {
                        let beside = clean(&arm.beside);
                        self.line(&format!("{} => {{ // {beside}", arm.number), depth + 1);
                        self.fresh = true;
                        self.body(&arm.body, depth + 2);
                        self.close(depth + 1);
                    }
                    self.line("_ => {}", depth + 1);
                    self.close(depth);
                }
            }
        }
    }

    /// Prints the head of something whose body is one statement of one line, which the body takes the place of.
    fn open(&mut self, tokens: TokenStream, depth: usize) {
        self.code(tokens, depth, 2);
        self.fresh = true;
    }

    fn close(&mut self, depth: usize) {
        self.line("}", depth);
    }

    fn line(&mut self, text: &str, depth: usize) {
        self.indent(depth);
        self.out.push_str(text);
        self.out.push('\n');
        self.fresh = false;
    }

    fn indent(&mut self, depth: usize) {
        self.out.extend(std::iter::repeat_n("    ", depth));
    }

    /// Prints statements, laid out as in this many blocks, or at depth 0 an item, without this many lines at the end.
    fn code(&mut self, tokens: TokenStream, depth: usize, without: usize) {
        let mut enclosed = tokens.clone();
        for _ in 1..depth {
            enclosed = quote!({ #enclosed });
        }
        if depth > 0 {
            enclosed = quote!(fn f() { #enclosed });
        }
        match syn::parse2::<syn::File>(enclosed) {
            Ok(file) => {
                let text = prettyplease::unparse(&file);
                let lines = lines(&text);
                let end = lines.len().saturating_sub(depth + without);
                self.out
                    .extend(lines.get(depth..end).unwrap_or_default().iter().copied());
            }
            // Unformatted text lets rustc name the fault, which beats a panic here.
            Err(_) => self.line(&tokens.to_string(), depth),
        }
        self.fresh = false;
    }

    fn wrapped(&mut self, comment: &str, depth: usize) {
        let mut column = 0;
        for word in comment.split_whitespace() {
            let length = word.chars().count() + 1;
            if column == 0 || column + length > WIDTH {
                if column > 0 {
                    self.out.push('\n');
                }
                self.indent(depth);
                self.out.push_str("//");
                column = 4 * depth + 2;
            }
            self.out.push(' ');
            self.out.push_str(word);
            column += length;
        }
        self.out.push('\n');
        self.fresh = false;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_stand_between_statements() {
        let mut then = Body::default();
        then.comment("step 0: start\nand stop");
        then.code(quote!(plc.y0 = true;));
        let mut body = Body::default();
        body.comment("step 0: start\nand stop");
        body.code(quote!(plc.a = true;));
        body.code(quote!(plc.m0 = plc.x0;));
        body.trailing_comment("motor latch");
        body.comment("step 0: start\nand stop");
        body.branches(quote!(plc.m0), then, Body::default());
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
        let head = quote!(fn f(plc: &mut Plc));
        assert_eq!(function(&head, &body), lines.join("\n"));
    }

    #[test]
    fn items_and_members_are_set_apart() {
        let text =
            items(quote!(struct A; impl A { fn a() {} #[doc = " b"] fn b() {} } impl B for A {}));
        let lines = [
            "struct A;",
            "",
            "impl A {",
            "    fn a() {}",
            "",
            "    /// b",
            "    fn b() {}",
            "}",
            "",
            "impl B for A {}",
            "",
        ];
        assert_eq!(text, lines.join("\n"));
    }
}
