//! Meanings of special devices. A row of a table describes one device or several; its text has in braces what differs
//! between them:
//!
//! | in the text | means on the first, second, third, fourth device |
//! |---|---|
//! | `{X6+}` | X006, X007, X010, X011 |
//! | `{Y0+/2}` | Y000, Y000, Y001, Y001 |
//! | `{8+}` | 8, 9, 10, 11 |
//! | `{low\|high} word` | low word, high word, low word, high word |

use super::Special;
use rungc_syntax::DeviceClass;

impl Special {
    /// Meaning of one device of the row.
    pub fn meaning(&self, number: u32) -> String {
        let offset = number.saturating_sub(self.first);
        self.rendered(|part| match part {
            Part::Run(run) => run.at(offset),
            Part::List(list) => {
                let mut list = list.split('|').cycle();
                list.nth(offset as usize).unwrap_or_default().to_owned()
            }
        })
    }

    /// Meaning of the row: runs as `X000–X005`, lists with commas, or semicolons if they have commas already.
    pub fn meanings(&self) -> String {
        if self.first == self.last {
            return self.text.to_owned();
        }
        let last = self.last - self.first;
        self.rendered(|part| match part {
            Part::Run(run) => match (run.at(0), run.at(last)) {
                (first, end) if first == end => first,
                (first, end) => format!("{first}–{end}"),
            },
            Part::List(list) if list.contains(", ") => list.replace('|', "; "),
            Part::List(list) => list.replace('|', ", "),
        })
    }

    /// The text with what stands in braces replaced.
    fn rendered(&self, written: impl Fn(Part<'static>) -> String) -> String {
        let mut pieces = self.text.split('{');
        let mut text = pieces.next().unwrap_or_default().to_owned();
        for piece in pieces {
            let (inner, rest) = piece.split_once('}').unwrap_or((piece, ""));
            text += &written(Part::of(inner));
            text += rest;
        }
        text
    }
}

/// Contents of braces.
#[derive(Clone, Copy)]
enum Part<'a> {
    Run(Run<'a>),
    List(&'a str),
}

/// Numbers that go up from device to device.
#[derive(Clone, Copy)]
struct Run<'a> {
    prefix: &'a str,
    first: &'a str,
    /// Devices that share a number.
    each: u32,
}

impl<'a> Part<'a> {
    fn of(inner: &'a str) -> Self {
        let run = || {
            let (name, each) = inner.split_once('+')?;
            let each = match each.strip_prefix('/') {
                Some(each) => each.parse().ok().filter(|&each| each > 0)?,
                None => each.is_empty().then_some(1)?,
            };
            let (prefix, first) = name.split_at(name.find(|c: char| c.is_ascii_digit())?);
            let run = Run {
                prefix,
                first,
                each,
            };
            first.parse::<u32>().ok().map(|_| Part::Run(run))
        };
        run().unwrap_or(Part::List(inner))
    }
}

impl Run<'_> {
    fn at(self, offset: u32) -> String {
        let class = DeviceClass::from_prefix(self.prefix);
        let radix = if class.is_some_and(DeviceClass::is_octal) {
            8
        } else {
            10
        };
        let first = u32::from_str_radix(self.first, radix).unwrap_or_default();
        let number = first + offset / self.each;
        match class {
            Some(class) => class.number(number).to_string(),
            None => format!("{}{number}", self.prefix),
        }
    }
}

/// Devices that a text names, of a run those at its ends.
#[cfg(test)]
pub(crate) fn devices_in(text: &str) -> impl Iterator<Item = (DeviceClass, u32)> {
    let words = text.split(|c: char| !c.is_ascii_alphanumeric());
    words.filter_map(|word| {
        let (prefix, digits) = word.split_at(word.find(|c: char| c.is_ascii_digit())?);
        let class = DeviceClass::from_prefix(prefix)?;
        let radix = if class.is_octal() { 8 } else { 10 };
        Some((class, u32::from_str_radix(digits, radix).ok()?))
    })
}

#[cfg(test)]
mod tests {
    use super::{Part, devices_in};
    use crate::special::Special;
    use crate::{Model, ModelId};
    use rungc_syntax::DeviceClass::{self, D, M};

    fn find(id: ModelId, class: DeviceClass, number: u32) -> &'static Special {
        Model::get(id).special(class, number).unwrap()
    }

    #[test]
    fn one_device_of_a_row_is_described() {
        let of = |id, class, number| find(id, class, number).meaning(number);
        let fx3u = ModelId::Fx3u;
        assert_eq!(of(fx3u, M, 8052), "forbids the interrupts of X002");
        assert_eq!(of(fx3u, M, 8177), "a pulse came at X007");
        assert_eq!(of(fx3u, D, 8014), "clock: minute");
        assert_eq!(of(fx3u, D, 8142), "pulses sent at Y001, low word");
        assert_eq!(of(fx3u, D, 8143), "pulses sent at Y001, high word");
        assert_eq!(of(fx3u, M, 8213), "C213 counts down");
        let rows = find(fx3u, D, 8140).meanings();
        assert_eq!(rows, "pulses sent at Y000–Y001, low, high word");
        let four_fold = find(fx3u, M, 8198).meanings();
        assert!(
            four_fold.ends_with("C251, C252 and C254; C253 and C255"),
            "{four_fold}"
        );
        let motion = of(ModelId::Hm, M, 8111);
        assert!(motion.contains("in place of X017 ("), "{motion}");
        assert_eq!(of(fx3u, M, 8000), find(fx3u, M, 8000).meanings());
    }

    #[test]
    fn braces_describe_as_many_devices_as_the_row_has() {
        for id in ModelId::ALL {
            for row in Model::get(id).specials() {
                let count = row.last - row.first + 1;
                for piece in row.text.split('{').skip(1) {
                    let Some((inner, _)) = piece.split_once('}') else {
                        panic!("{id:?} {row:?}");
                    };
                    let fits = match Part::of(inner) {
                        Part::Run(run) => count.is_multiple_of(run.each),
                        Part::List(list) => {
                            (count as usize).is_multiple_of(list.split('|').count())
                        }
                    };
                    assert!(count > 1 && fits, "{id:?} {row:?}");
                }
                assert_eq!(row.text.matches('{').count(), row.text.matches('}').count());
            }
        }
    }

    #[test]
    fn meanings_name_devices_of_their_model() {
        let mut wrong = Vec::new();
        for model in ModelId::ALL.map(Model::get) {
            let rows = model.specials();
            for (row, number) in rows.flat_map(|row| (row.first..=row.last).map(move |n| (row, n)))
            {
                let text = row.meaning(number);
                for (class, named) in devices_in(&text) {
                    let special = crate::runs::is_special(class, named);
                    let known = match special {
                        true => model.special(class, named).is_some(),
                        false => model.has(class, named),
                    };
                    if !known {
                        let device = row.class.number(number);
                        wrong.push(format!("{} {device}: {text}", model.name));
                    }
                }
            }
        }
        assert!(wrong.is_empty(), "{wrong:#?}");
    }
}
