//! Expressions and commands of an editor's console.

use crate::breakpoints::{holds, momentary};
use crate::run::Run;
use crate::variables::{described, value};

/// Commands of the console, as `help` prints them.
const HELP: &str = "\
D0, T0, K4M0, D0.f32, a comment: the value of a device
X000 & D0 > 100: whether a condition holds
X000 = on, D0 = 12: set a device
force X000 on: set a device, and keep its value whatever the program does
release X000, release all: end that
why Y000: why a device is on or off at the beginning of this scan
how Y000: what would change it
run, stop: turn the RUN/STOP switch";

/// The answer to an expression.
#[derive(Debug)]
pub struct Answer {
    /// As text.
    pub text: String,
    /// Its type.
    pub kind: Option<&'static str>,
    /// True if devices have changed.
    pub has_changed: bool,
}

impl Answer {
    fn text(text: impl Into<String>) -> Answer {
        Answer {
            text: text.into(),
            kind: None,
            has_changed: false,
        }
    }
}

/// Evaluates what a user hovers over or watches: a device or a condition. Nothing changes.
///
/// # Errors
/// It is neither.
pub fn look(run: &mut Run, expression: &str) -> Result<Answer, String> {
    let expression = expression.trim();
    let wrong = match described(run.plc_mut(), expression) {
        Ok((text, kind)) => {
            return Ok(Answer {
                kind: Some(kind),
                ..Answer::text(text)
            });
        }
        Err(wrong) => wrong,
    };
    let is_word = |c: char| c.is_alphanumeric() || c == '_' || c == '.';
    if expression.chars().all(is_word) {
        return Err(wrong);
    }
    let condition = momentary(expression, run.program())?;
    let holds = holds(&condition, run.plc_mut().session().machine());
    Ok(Answer {
        kind: Some("condition"),
        ..Answer::text(holds.to_string())
    })
}

/// Carries out a line of the console.
///
/// # Errors
/// What is wrong with it.
pub fn command(run: &mut Run, line: &str) -> Result<Answer, String> {
    let line = line.trim();
    let (word, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
    let rest = rest.trim();
    let changed = |text: String| Answer {
        has_changed: true,
        ..Answer::text(text)
    };
    match (word.to_lowercase().as_str(), rest) {
        ("help" | "?", "") => return Ok(Answer::text(HELP)),
        ("run", "") => run.switch(true),
        ("stop", "") => run.switch(false),
        ("release", "all") => run.release_all(),
        ("release", name) if !name.is_empty() => {
            let target = run.release(name)?;
            return Ok(changed(format!("{target} is released{}", from_when(run))));
        }
        ("force", rest) if !rest.is_empty() => return force(run, rest).map(changed),
        ("why", name) if !name.is_empty() => {
            let why = run
                .before_scan()
                .why(name)
                .map_err(|error| error.to_string())?;
            return Ok(Answer::text(why.text().trim_end()));
        }
        ("how", name) if !name.is_empty() => {
            let plc = run.before_scan();
            let mut why = plc.why(name).map_err(|error| error.to_string())?;
            why.how = Some(plc.how(name).map_err(|error| error.to_string())?);
            return Ok(Answer::text(why.text().trim_end()));
        }
        _ => {
            let assignment = line
                .split_once('=')
                .filter(|(name, _)| run.plc().get(name.trim()).is_ok());
            let Some((name, text)) = assignment.filter(|(_, text)| !text.starts_with('=')) else {
                return look(run, line);
            };
            run.set(name.trim(), value(text)?)?;
            let (text, _) = described(run.plc_mut(), name.trim())?;
            return Ok(changed(text));
        }
    }
    Ok(changed(format!("done{}", from_when(run))))
}

/// Forces `X000 on` or `X000 = on`.
fn force(run: &mut Run, text: &str) -> Result<String, String> {
    let split = text
        .rsplit_once('=')
        .or_else(|| text.rsplit_once(char::is_whitespace));
    let (name, text) = split.ok_or("write a device and its value: `force X000 on`")?;
    let target = run.force(name.trim(), value(text)?)?;
    Ok(format!("{target} is forced{}", from_when(run)))
}

/// When something takes effect that cannot begin within a scan.
fn from_when(run: &Run) -> &'static str {
    match run.is_inside() {
        true => " from the next scan on",
        false => "",
    }
}
