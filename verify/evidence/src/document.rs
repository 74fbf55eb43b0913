//! Evidence as a document (PDF) on A4.

use crate::matrix::{HEADS, row};
use crate::{Evidence, Requirement, Run, Verified, words};
use rungc_ladder::pdf::{Pen, Sheets};
use rungc_sim::record::plot::{Anchor, Diagram, Mark, Stroke};

/// Sizes of headings, in points.
const SIZES: [f64; 3] = [16.0, 12.0, 9.5];
/// Left edges of the columns of the matrix, in points.
const MATRIX: [f64; 6] = [0.0, 66.0, 222.0, 310.0, 378.0, 456.0];
/// Left edge of a column of values, in points.
const VALUES: f64 = 150.0;
/// Indentation of lists, in points.
const INDENT: f64 = 12.0;

/// The document.
pub fn document(evidence: &Evidence) -> Vec<u8> {
    let title = format!("Verification report: {}", evidence.subject.title);
    let mut sheets = Sheets::new(&title);
    sheets.heading(&title, SIZES[0]);
    let mut about = format!("{}, by rungc {}", evidence.subject.plc, evidence.rungc);
    if let Some(date) = &evidence.date {
        about += &format!(", {date}");
    }
    sheets.paragraph(&about, 0.0);
    matrix(&mut sheets, evidence);
    if !evidence.missing.is_empty() {
        sheets.heading("What is missing", SIZES[1]);
        list(&mut sheets, &evidence.missing);
    }
    grounds(&mut sheets, evidence);
    for requirement in &evidence.requirements {
        of_requirement(&mut sheets, evidence, requirement);
    }
    let mut others = evidence
        .properties
        .iter()
        .filter(|p| p.requirement.is_none());
    if let Some(first) = others.next() {
        sheets.heading("Properties without a requirement", SIZES[1]);
        std::iter::once(first)
            .chain(others)
            .for_each(|property| of_property(&mut sheets, property));
    }
    tests(&mut sheets, evidence);
    sheets.finish()
}

fn list(sheets: &mut Sheets, lines: impl IntoIterator<Item = impl AsRef<str>>) {
    for line in lines {
        sheets.row(&[(0.0, "-"), (INDENT, line.as_ref())], false);
    }
}

fn matrix(sheets: &mut Sheets, evidence: &Evidence) {
    sheets.heading("Requirements", SIZES[1]);
    if evidence.requirements.is_empty() {
        let nothing = "The settings name no requirements: give properties in rungc.toml an `id`.";
        return sheets.paragraph(nothing, 0.0);
    }
    let heads = [&["Requirement", "Text"][..], &HEADS].concat();
    let heads: Vec<_> = MATRIX.into_iter().zip(heads).collect();
    sheets.row(&heads, true);
    for requirement in &evidence.requirements {
        let cells = row(evidence, requirement).map(|cell| cell.text);
        let texts = [&requirement.id, &requirement.text]
            .into_iter()
            .chain(&cells);
        let texts: Vec<_> = MATRIX.into_iter().zip(texts.map(String::as_str)).collect();
        sheets.row(&texts, false);
        sheets.gap();
    }
    let short = "\"Proved\" is short for: proved for this model under these assumptions.";
    sheets.row(&[(0.0, short)], true);
}

fn grounds(sheets: &mut Sheets, evidence: &Evidence) {
    sheets.heading("Assumptions", SIZES[1]);
    sheets.paragraph(words::SCOPE, 0.0);
    sheets.gap();
    list(sheets, &evidence.assumptions);
    sheets.heading("Program and settings", SIZES[1]);
    let subject = &evidence.subject;
    let plc = format!("{} ({})", subject.plc, subject.model);
    let named = [
        ("Program", &subject.file),
        ("SHA-256 of the program", &subject.sha256),
        ("PLC", &plc),
        ("rungc", &evidence.rungc),
    ];
    let settings = evidence.settings.iter();
    let settings = settings.map(|setting| (setting.name, &setting.value));
    for (name, value) in named.into_iter().chain(settings) {
        sheets.row(&[(0.0, name), (VALUES, value)], false);
    }
    sheets.gap();
    for file in &subject.files {
        sheets.row(&[(0.0, &file.file), (VALUES, file.role)], false);
        sheets.row(&[(INDENT, &file.sha256)], true);
    }
}

fn of_requirement(sheets: &mut Sheets, evidence: &Evidence, requirement: &Requirement) {
    sheets.heading(&requirement.id, SIZES[1]);
    sheets.paragraph(&requirement.text, 0.0);
    if !requirement.source.is_empty() {
        let source = format!("Source: {}", requirement.source);
        sheets.row(&[(0.0, &source)], true);
    }
    for line in words::lacks(evidence, requirement) {
        sheets.paragraph(line, 0.0);
    }
    let is_own = |p: &&Verified| p.requirement.as_deref() == Some(&requirement.id);
    for property in evidence.properties.iter().filter(is_own) {
        of_property(sheets, property);
    }
    if let Some(tests) = &evidence.tests {
        let cases = tests.cases.iter();
        let mut own = cases
            .filter(|case| case.requirements.contains(&requirement.id))
            .peekable();
        if own.peek().is_some() {
            sheets.heading("Tests", SIZES[2]);
            list(sheets, own.map(ToString::to_string));
        }
    }
}

fn of_property(sheets: &mut Sheets, property: &Verified) {
    sheets.heading(&property.property, SIZES[2]);
    sheets.paragraph(&words::verdict(property), 0.0);
    if let Some(method) = property.method() {
        sheets.paragraph(&format!("Method: {method}."), 0.0);
    }
    if !property.gaps.is_empty() {
        sheets.row(&[(0.0, "Not modelled, any result possible:")], true);
        list(sheets, property.gaps.iter().map(ToString::to_string));
    }
    if !property.inputs.is_empty() {
        sheets.row(&[(0.0, "Devices that count as inputs:")], true);
        list(sheets, property.inputs.iter().map(ToString::to_string));
    }
    if !property.certificate.is_empty() {
        let heading = "Certificate: each formula must be unsatisfiable.";
        sheets.row(&[(0.0, heading)], true);
        for file in &property.certificate {
            sheets.row(&[(INDENT, &file.check)], false);
            sheets.row(&[(2.0 * INDENT, &file.sha256)], true);
        }
    }
    if let Some(run) = &property.run {
        of_run(sheets, run);
    }
}

fn of_run(sheets: &mut Sheets, run: &Run) {
    let columns = [0.0, 70.0, 130.0];
    let heads: Vec<_> = columns
        .into_iter()
        .zip(["Scans", "Begins", "Set"])
        .collect();
    sheets.row(&heads, true);
    for cells in words::steps(run) {
        let texts = cells.iter().map(String::as_str);
        let texts: Vec<_> = columns.into_iter().zip(texts).collect();
        sheets.row(&texts, false);
    }
    if let Some(diagram) = &run.diagram {
        sheets.figure(diagram.size, |pen| draw(diagram, pen));
    }
    for network in &run.networks {
        let caption = format!(
            "Network {} after the last scan; thick: power",
            network.number
        );
        sheets.row(&[(0.0, &caption)], true);
        sheets.drawing(&network.drawing);
    }
}

fn draw(diagram: &Diagram, pen: &mut Pen) {
    for mark in &diagram.marks {
        match mark {
            Mark::Line { from, to, stroke } => curve(pen, &[*from, *to], *stroke),
            Mark::Curve { points, stroke, .. } => curve(pen, points, *stroke),
            Mark::Area { points, colour } => pen.area(points, rgb(colour)),
            Mark::Frame { at, size, stroke } => {
                let ([left, top], [width, height]) = (*at, *size);
                let (right, bottom) = (left + width, top + height);
                let corners = [
                    [left, top],
                    [right, top],
                    [right, bottom],
                    [left, bottom],
                    [left, top],
                ];
                curve(pen, &corners, *stroke);
            }
            Mark::Text {
                at,
                anchor,
                size,
                text,
                ..
            } => {
                let anchor = match anchor {
                    Anchor::Start => 0.0,
                    Anchor::Middle => 0.5,
                    Anchor::End => 1.0,
                };
                pen.text(text, *at, f64::from(size.unwrap_or(12)), anchor);
            }
        }
    }
}

fn curve(pen: &mut Pen, points: &[[f64; 2]], stroke: Stroke) {
    pen.curve(points, stroke.width, rgb(stroke.colour));
}

/// A colour `#rrggbb` as red, green and blue from 0 to 1; black for anything else.
fn rgb(colour: &str) -> [f32; 3] {
    let part = |from: usize| {
        let digits = colour.get(from..from + 2);
        let value = digits.and_then(|digits| u8::from_str_radix(digits, 16).ok());
        f32::from(value.unwrap_or(0)) / 255.0
    };
    [part(1), part(3), part(5)]
}

fn tests(sheets: &mut Sheets, evidence: &Evidence) {
    sheets.heading("Tests", SIZES[1]);
    let Some(tests) = &evidence.tests else {
        return sheets.paragraph("Tests: not run.", 0.0);
    };
    if let Some(coverage) = tests.coverage {
        let share = words::share(coverage);
        sheets.paragraph(
            &format!("Coverage of the program by all cases: {share}."),
            0.0,
        );
    }
    let mutants = match tests.mutants {
        Some(mutants) => format!(
            "Mutants of the program that a case notices: {}.",
            words::share(mutants)
        ),
        None => "Mutants: not run.".to_string(),
    };
    sheets.paragraph(&mutants, 0.0);
    sheets.gap();
    list(sheets, tests.cases.iter().map(ToString::to_string));
}
