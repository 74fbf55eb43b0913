//! A program as a PDF on A4: a cover with the devices used, the chart of a step ladder, and all networks, with outlines
//! to find them by.

use crate::face::fold;
use crate::html::uses;
use crate::network::Ladder;
use crate::picture::{Drafter, Picture};
use crate::sfc::Chart;
use fonts::Font;
use page::{EDGE, HEAD, PAPER, Page, Placement};
use pdf_writer::types::PageMode;
use pdf_writer::{Filter, Finish, Pdf, Rect, Ref, TextStr};
use rungc_analysis::resolve::Resolved;

mod fonts;
mod page;
mod parts;

pub use parts::Pen;

/// Characters of a line of a network.
const WIDTH: usize = 104;
/// The room of a page.
const ROOM: (f64, f64) = (PAPER.0 - 2.0 * EDGE, PAPER.1 - 2.0 * EDGE - 2.0 * HEAD);
/// Points for each pixel of a picture, unless it is too wide.
const SCALE: f64 = 0.64;
/// Size and height of a line of text.
const SIZE: f64 = 8.0;
const LINE: f64 = 11.0;
/// Quick enough, and nearly as small as any other (miniz_oxide).
const COMPRESSION: u8 = 6;

/// The document of a program.
pub fn document(title: &str, resolved: &Resolved, ladder: &Ladder) -> Vec<u8> {
    let mut sheets = Sheets::new(title);
    let chart = Chart::of(resolved, ladder);
    sheets.cover(resolved, ladder, chart.as_ref());
    if let Some(chart) = &chart {
        sheets.page();
        sheets.outline("Sequential function chart");
        sheets.picture(&chart.picture());
    }
    sheets.page();
    sheets.outline("Networks");
    let networks: Vec<_> = (1..).zip(&ladder.networks).collect();
    let drafter = Drafter::new(resolved, &networks, WIDTH);
    for (number, network) in &networks {
        let picture = drafter.network(*number, network);
        let instrs = &resolved.program.instrs[network.instrs.clone()];
        let statements: Vec<&str> = instrs
            .iter()
            .filter_map(|instr| instr.statement())
            .collect();
        sheets.statements(&statements, picture.size.1 * SCALE);
        let state = chart.iter().flat_map(|chart| &chart.states);
        if let Some(state) = state.clone().find(|state| state.network == *number) {
            let name = state.name.as_deref().unwrap_or("");
            sheets.outline(&format!("{} {name}", state.device));
        }
        sheets.picture(&picture);
    }
    sheets.finish()
}

/// Pages in work: what is added comes below what is there, on further pages as needed.
pub struct Sheets<'a> {
    title: &'a str,
    pages: Vec<Page>,
    /// Entries of the outline: text, page, place below the upper edge.
    outline: Vec<(String, usize, f64)>,
    /// Height of the page in use.
    y: f64,
}

impl<'a> Sheets<'a> {
    /// An empty page, with this title at the head of all pages.
    pub fn new(title: &'a str) -> Self {
        let mut sheets = Sheets {
            title,
            pages: Vec::new(),
            outline: Vec::new(),
            y: 0.0,
        };
        sheets.page();
        sheets
    }

    fn page(&mut self) {
        self.pages.push(Page::new());
        self.y = 0.0;
    }

    /// The page in work.
    fn last(&mut self) -> &mut Page {
        let at = self.pages.len() - 1;
        &mut self.pages[at]
    }

    /// Turns to the next page unless this one has that much room.
    fn need(&mut self, height: f64) {
        if self.y > 0.0 && self.y + height > ROOM.1 {
            self.page();
        }
    }

    /// Adds an entry to the outline, which leads to the next line.
    fn outline(&mut self, text: &str) {
        let place = EDGE + HEAD + self.y;
        self.outline
            .push((text.to_string(), self.pages.len() - 1, place));
    }

    /// Texts on one line, each at its column in points.
    fn line(&mut self, texts: &[(f64, &str)], gray: f32) {
        self.need(LINE);
        let y = EDGE + HEAD + self.y + SIZE;
        for (x, text) in texts {
            self.last().text(text, (EDGE + x, y), SIZE, 0.0, gray);
        }
        self.y += LINE;
    }

    /// Draws the cover: the properties of the program, and the devices that it uses.
    fn cover(&mut self, resolved: &Resolved, ladder: &Ladder, chart: Option<&Chart>) {
        self.outline("Devices");
        let title = self.title.to_string();
        let at = (EDGE, EDGE + HEAD + 20.0);
        self.last().text(&title, at, 18.0, 0.0, 0.0);
        self.y += 34.0;
        let model = resolved.model.name.to_uppercase();
        let (steps, networks) = (resolved.steps, ladder.networks.len());
        let mut about = format!("{model}, {steps} steps, {networks} networks");
        if let Some(chart) = chart {
            about += &format!(", {} states", chart.states.len());
        }
        self.line(&[(0.0, &about)], 0.0);
        self.y += LINE;
        let columns = [0.0, 70.0, 300.0];
        let heads = ["Device", "Comment", "Networks"];
        let heads: Vec<_> = columns.into_iter().zip(heads).collect();
        self.line(&heads, 0.35);
        let character = SIZE * fonts::NARROW;
        let room = |from: f64, to: f64| ((to - from) / character) as usize - 1;
        for (device, numbers) in uses(resolved, ladder) {
            let comment = resolved.program.comments.get(&device);
            let comment = comment.map_or("", String::as_str);
            let comment = fold(comment, room(columns[1], columns[2]), usize::MAX);
            let numbers: Vec<String> = numbers.iter().map(usize::to_string).collect();
            let numbers = fold(&numbers.join(" "), room(columns[2], ROOM.0), usize::MAX);
            let name = device.to_string();
            for i in 0..comment.len().max(numbers.len()).max(1) {
                let text = |lines: &[String]| lines.get(i).cloned().unwrap_or_default();
                let name = if i == 0 { name.as_str() } else { "" };
                let (comment, numbers) = (text(&comment), text(&numbers));
                self.line(
                    &[
                        (columns[0], name),
                        (columns[1], &comment),
                        (columns[2], &numbers),
                    ],
                    0.0,
                );
            }
        }
    }

    /// The statements above a network, on the same page as its beginning.
    fn statements(&mut self, statements: &[&str], below: f64) {
        let room = (ROOM.0 / (SIZE * fonts::NARROW)) as usize - 10;
        let lines = statements.iter().flat_map(|statement| statement.lines());
        let lines: Vec<String> = lines
            .flat_map(|line| fold(line, room, usize::MAX))
            .collect();
        let Some(first) = lines.first().cloned() else {
            return;
        };
        let height = lines.len() as f64 * LINE + LINE;
        self.need((height + below).min(ROOM.1));
        self.y += LINE / 2.0;
        self.outline(&first);
        for line in &lines {
            self.line(&[(40.0, line)], 0.35);
        }
    }

    /// A picture; one that is higher than the page continues on others, between its rows.
    fn picture(&mut self, picture: &Picture) {
        let scale = SCALE.min(ROOM.0 / picture.size.0);
        self.need((picture.size.1 * scale).min(ROOM.1));
        let mut top = 0.0;
        while top < picture.size.1 {
            let room = top + (ROOM.1 - self.y) / scale;
            let breaks = picture.breaks.iter().chain([&picture.size.1]);
            let fitting = breaks.filter(|at| **at > top && **at <= room + 0.1);
            let end = fitting.fold(f64::NAN, |last, at| last.max(*at));
            // A row that is higher than a page is cut.
            let end = if end.is_nan() { room } else { end };
            let on = Placement {
                at: (EDGE, EDGE + HEAD + self.y),
                scale,
            };
            self.last().slice(&picture.marks, on, (top, end));
            self.y += (end - top) * scale;
            top = end;
            if top < picture.size.1 {
                self.page();
            }
        }
    }

    /// The file.
    pub fn finish(mut self) -> Vec<u8> {
        let count = self.pages.len();
        let title = self.title.to_string();
        for (i, page) in self.pages.iter_mut().enumerate() {
            page.text(&title, (EDGE, EDGE + 4.0), SIZE, 0.0, 0.35);
            let foot = PAPER.1 - EDGE;
            let number = format!("{} / {count}", i + 1);
            page.text(&number, (PAPER.0 - EDGE, foot), SIZE, 1.0, 0.35);
        }
        let mut last = 0;
        let mut next = || {
            last += 1;
            Ref::new(last)
        };
        let mut pdf = Pdf::new();
        pdf.set_version(1, 5);
        let (catalog, tree, info) = (next(), next(), next());
        let fonts = Font::ALL.map(|font| (font, next()));
        for (font, id) in fonts {
            font.write(&mut pdf, id, &mut next);
        }
        let ids: Vec<(Ref, Ref)> = self.pages.iter().map(|_| (next(), next())).collect();
        for (page, &(id, content)) in self.pages.into_iter().zip(&ids) {
            let mut written = pdf.page(id);
            let paper = Rect::new(0.0, 0.0, PAPER.0 as f32, PAPER.1 as f32);
            written.media_box(paper).parent(tree).contents(content);
            let mut resources = written.resources();
            let mut named = resources.fonts();
            for (font, id) in fonts {
                named.pair(font.name(), id);
            }
            named.finish();
            resources.finish();
            written.finish();
            let operators = page.content.finish();
            let packed = miniz_oxide::deflate::compress_to_vec_zlib(&operators, COMPRESSION);
            pdf.stream(content, &packed).filter(Filter::FlateDecode);
        }
        let kids = ids.iter().map(|id| id.0);
        pdf.pages(tree).kids(kids).count(count as i32);
        let root = outline(&mut pdf, &self.outline, &ids, &mut next);
        pdf.catalog(catalog)
            .pages(tree)
            .outlines(root)
            .page_mode(PageMode::UseOutlines);
        let mut about = pdf.document_info(info);
        about.title(TextStr(&title)).creator(TextStr("rungc"));
        about.finish();
        pdf.finish()
    }
}

/// The outline: its texts lead to their places.
fn outline(
    pdf: &mut Pdf,
    entries: &[(String, usize, f64)],
    pages: &[(Ref, Ref)],
    next: &mut impl FnMut() -> Ref,
) -> Ref {
    let root = next();
    let ids: Vec<Ref> = entries.iter().map(|_| next()).collect();
    let mut written = pdf.outline(root);
    if let (Some(&first), Some(&last)) = (ids.first(), ids.last()) {
        written.first(first).last(last).count(ids.len() as i32);
    }
    written.finish();
    for (i, (text, page, y)) in entries.iter().enumerate() {
        let mut item = pdf.outline_item(ids[i]);
        item.title(TextStr(text)).parent(root);
        if let Some(before) = i.checked_sub(1) {
            item.prev(ids[before]);
        }
        if let Some(&after) = ids.get(i + 1) {
            item.next(after);
        }
        let top = (PAPER.1 - y) as f32;
        item.dest().page(pages[*page].0).xyz(0.0, top, None);
    }
    root
}
