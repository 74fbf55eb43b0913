//! XML as text, an element to a line.

use quick_xml::escape::escape;
use std::fmt::Write as _;

/// A document while it is written.
#[derive(Default)]
pub(super) struct Xml {
    pub text: String,
    open: Vec<&'static str>,
}

/// Attributes of an element.
pub(super) type Attributes<'a> = &'a [(&'static str, &'a str)];

impl Xml {
    fn begin(&mut self, name: &str, attributes: Attributes) {
        self.text.extend(std::iter::repeat_n("  ", self.open.len()));
        let _ = write!(self.text, "<{name}");
        for (key, value) in attributes {
            let _ = write!(self.text, " {key}=\"{}\"", escape(clean(value)));
        }
    }

    /// An element without content.
    pub fn leaf(&mut self, name: &str, attributes: Attributes) {
        self.begin(name, attributes);
        self.text.push_str("/>\n");
    }

    /// An element with text.
    pub fn text(&mut self, name: &str, text: &str) {
        self.begin(name, &[]);
        let _ = writeln!(self.text, ">{}</{name}>", escape(clean(text)));
    }

    /// An element with others in it.
    pub fn node(
        &mut self,
        name: &'static str,
        attributes: Attributes,
        inside: impl FnOnce(&mut Xml),
    ) {
        self.begin(name, attributes);
        self.text.push_str(">\n");
        self.open.push(name);
        inside(self);
        self.open.pop();
        self.text.extend(std::iter::repeat_n("  ", self.open.len()));
        let _ = writeln!(self.text, "</{name}>");
    }

    /// A human-readable text.
    pub fn prose(&mut self, name: &'static str, text: &str) {
        self.node(name, &[], |xml| xml.text("xhtml:p", text));
    }

    /// Appends what another document holds.
    pub fn append(&mut self, other: Xml) {
        let lines = other.text.lines();
        self.text
            .reserve(other.text.len() + lines.clone().count() * self.open.len() * 2);
        for line in lines {
            self.text.extend(std::iter::repeat_n("  ", self.open.len()));
            self.text.push_str(line);
            self.text.push('\n');
        }
    }
}

/// A text without the characters that XML 1.0 cannot represent.
fn clean(text: &str) -> String {
    let fits = |c: &char| !c.is_control() || matches!(c, '\n' | '\t');
    text.chars().filter(fits).collect()
}

/// Writes the position of an element.
pub(super) fn position(xml: &mut Xml, x: i64, y: i64) {
    let (x, y) = (x.to_string(), y.to_string());
    xml.leaf("position", &[("x", &x), ("y", &y)]);
}

/// Writes the position of a pin in its element.
pub(super) fn relative(xml: &mut Xml, x: i64, y: i64) {
    let (x, y) = (x.to_string(), y.to_string());
    xml.leaf("relPosition", &[("x", &x), ("y", &y)]);
}
