//! `rungc view`.

use super::setting;
use super::subject::{self, OutputPaths, Subject, option_of};
use super::{Context, Failure, Outcome, Result, found_reading, print_text, read_with_names, stem};
use crate::args::ViewArgs;
use crate::output::write_file;
use crate::report::Reporter;
use rungc::Names;
use rungc_analysis::resolve::{Resolved, resolve};
use rungc_frontend::Read;
use rungc_ladder::sfc::Chart;
use rungc_ladder::svg::Painter;
use rungc_ladder::text::{Style, draw_parts};
use rungc_ladder::{Ladder, Network, build, html, pdf};
use rungc_lower::compile;
use rungc_syntax::{DeviceClass, OperandKind, Span};
use std::path::Path;
use terminal_size::{Width, terminal_size};

/// Characters on a line where nothing says how many there are.
const USUAL_WIDTH: u16 = 120;

/// Characters on a line of a picture or a page, unless `--width` sets another number.
pub(super) const PICTURE_WIDTH: usize = 104;

/// Draws programs.
pub fn run(args: &ViewArgs, cx: Context) -> Result {
    let terminal = terminal_size().map(|(Width(width), _)| width);
    let style = Style {
        width: args.width.or(terminal).unwrap_or(USUAL_WIDTH).into(),
        comments: !args.no_comments,
    };
    let mut outputs = OutputPaths::default();
    subject::each(&args.inputs, cx, |subject, reporter| {
        view(args, subject, reporter, style, &mut outputs)
    })
}

fn view(
    args: &ViewArgs,
    subject: &Subject,
    reporter: &mut Reporter,
    style: Style,
    outputs: &mut OutputPaths,
) -> Result {
    // As its author drew it: without what the settings add.
    let read = read_with_names(subject, reporter)?;
    let findings = found_reading(subject, &read);
    reporter.add(&findings)?;
    let options = subject.options();
    let model = compile::model(&read.program, &options);
    let (resolved, _) = resolve(&read.program, model);
    let ladder = build::ladder(&resolved);
    let devices = devices(args, subject, &read)?;
    let places = reported(args, subject, &read);
    let networks = chosen(args, (&devices, &places), (&resolved, &ladder));
    if networks.is_empty() && !ladder.networks.is_empty() {
        let count = ladder.networks.len();
        return Err(Failure::Because(format!(
            "{}: none of the {count} networks matches",
            subject.file.display()
        )));
    }
    let chart = match args.sfc {
        true => Some(chart(&resolved, &ladder, subject)?),
        false => None,
    };
    match &args.output {
        Some(path) => {
            let path = match reporter.many() {
                true => {
                    outputs.claim(path.join(format!("{}.html", stem(subject, &read))), subject)?
                }
                false => path.to_path_buf(),
            };
            let sheet = Sheet {
                title: title(subject, &read),
                resolved: &resolved,
                ladder: &ladder,
                networks: &networks,
                chart: chart.as_ref(),
                width: args.width.map_or(PICTURE_WIDTH, usize::from),
            };
            write_file(&path, &sheet.file(&path)?, args.force)?;
        }
        None => {
            if reporter.many() {
                print_text(&format!("; {}\n", findings.name(true)))?;
            }
            match &chart {
                Some(chart) => print_text(&chart.text(style.width))?,
                None => draw_parts(&resolved, &networks, style, print_text)?,
            }
        }
    }
    Ok(Outcome::of(&findings))
}

/// A class, and the first and last number of a range.
type Range = (DeviceClass, u32, u32);

/// The devices of `--device`.
fn devices(
    args: &ViewArgs,
    subject: &Subject,
    read: &Read,
) -> std::result::Result<Vec<Range>, Failure> {
    setting::ranges(
        &option_of("--device", subject),
        &args.device,
        &Names::of(&read.program),
    )
}

/// The networks that the arguments choose, with their numbers.
fn chosen<'a>(
    args: &ViewArgs,
    (devices, places): (&[Range], &[Span]),
    (resolved, ladder): (&Resolved, &'a Ladder),
) -> Vec<(usize, &'a Network)> {
    let wanted = |number: usize, network: &Network| {
        let numbered =
            args.network.is_empty() || args.network.iter().any(|range| range.contains(&number));
        let named = devices.is_empty() || names(resolved, network, devices);
        let around = args.around.is_empty() || holds(resolved, network, places);
        numbered && named && around
    };
    let networks = (1..).zip(&ladder.networks);
    networks
        .filter(|(number, network)| wanted(*number, network))
        .collect()
}

/// The chart that `--sfc` asks for.
fn chart(
    resolved: &Resolved,
    ladder: &Ladder,
    subject: &Subject,
) -> std::result::Result<Chart, Failure> {
    Chart::of(resolved, ladder).ok_or_else(|| {
        let file = subject.file.display();
        Failure::Because(format!("{file}: --sfc: the program has no step ladder"))
    })
}

/// Contents of a file.
struct Sheet<'a> {
    title: String,
    resolved: &'a Resolved<'a>,
    ladder: &'a Ladder,
    /// The networks that are chosen.
    networks: &'a [(usize, &'a Network)],
    /// The chart, if requested.
    chart: Option<&'a Chart>,
    /// Characters on a line.
    width: usize,
}

impl Sheet<'_> {
    /// Contents of a file by its extension: a page or document of all networks, or a picture of those that are
    /// selected.
    fn file(&self, path: &Path) -> std::result::Result<Vec<u8>, Failure> {
        let ending = path.extension().and_then(|ending| ending.to_str());
        let text = match (ending, self.chart) {
            (Some("html"), _) => html::page(&self.title, self.resolved, self.ladder, self.width),
            (Some("pdf"), _) => return Ok(pdf::document(&self.title, self.resolved, self.ladder)),
            (Some("svg"), Some(chart)) => chart.sheet().to_string(),
            (Some("svg"), None) => {
                let painter = Painter::new(self.resolved, self.networks, self.width);
                painter.sheet(self.networks).to_string()
            }
            _ => {
                let why = "-o: name a file that ends in .html, .pdf or .svg";
                return Err(Failure::Because(why.to_string()));
            }
        };
        Ok(text.into_bytes())
    }
}

/// Heading of a page: the project's title, or the name of its file.
pub(super) fn title(subject: &Subject, read: &Read) -> String {
    let title = read
        .program
        .title
        .clone()
        .filter(|title| !title.trim().is_empty());
    title.unwrap_or_else(|| {
        let name = subject.file.file_name();
        name.map_or_else(
            || "program".to_string(),
            |name| name.to_string_lossy().into_owned(),
        )
    })
}

/// The places of what a check reports under the requested codes.
fn reported(args: &ViewArgs, subject: &Subject, read: &Read) -> Vec<Span> {
    if args.around.is_empty() {
        return Vec::new();
    }
    let checked = compile::check(&read.program, &subject.options());
    let diagnostics = read.diagnostics.iter().chain(checked.diagnostics.iter());
    let requested = diagnostics.filter(|diagnostic| args.around.contains(&diagnostic.code));
    requested
        .flat_map(|diagnostic| {
            let others = diagnostic.others.iter().map(|label| label.span);
            std::iter::once(diagnostic.span).chain(others)
        })
        .collect()
}

/// Returns true if a network contains one of these places.
fn holds(resolved: &Resolved, network: &Network, places: &[Span]) -> bool {
    let instrs = &resolved.program.instrs[network.instrs.clone()];
    let (Some(first), Some(last)) = (instrs.first(), instrs.last()) else {
        return false;
    };
    let extent = first.span.start..last.span.end;
    places.iter().any(|place| extent.contains(&place.start))
}

/// Returns true if an operand of a network names one of these devices.
fn names(resolved: &Resolved, network: &Network, devices: &[Range]) -> bool {
    let is_named = |class, first: u32, count| {
        let end = first.saturating_add(count);
        let mut ranges = devices.iter();
        ranges.any(|range| range.0 == class && range.1 < end && first <= range.2)
    };
    let instrs = &resolved.program.instrs[network.instrs.clone()];
    let mut operands = instrs.iter().flat_map(|instr| &instr.operands);
    operands.any(|operand| match operand.kind {
        OperandKind::Device(device, _) | OperandKind::WordBit(device, ..) => {
            is_named(device.class, device.number, 1)
        }
        OperandKind::Nibbles(digits, first, _) => {
            is_named(first.class, first.number, 4 * u32::from(digits))
        }
        OperandKind::Decimal(..)
        | OperandKind::Hex(..)
        | OperandKind::Float(_)
        | OperandKind::Text(_)
        | OperandKind::Buffer { .. }
        | OperandKind::Unreadable(_) => false,
    })
}
