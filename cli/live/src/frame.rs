//! Contents of the page at one moment, and their difference for a client.

use std::collections::VecDeque;
use std::fmt::Write as _;
use std::sync::Arc;

/// Number of log entries that are stored.
const ENTRIES: usize = 200;

/// Contents of the page at one moment. Texts are JSON.
#[derive(Clone, Default, Debug)]
pub struct Frame {
    /// The state of each network, as [`Scene::look`](crate::Scene::look) gives it.
    pub networks: Vec<Arc<str>>,
    /// The other parts of the page by their names: time and mode, the watch list, forces, axes.
    pub parts: Vec<(&'static str, Arc<str>)>,
    /// The log.
    pub log: Log,
}

impl Frame {
    /// Changes from an earlier frame to this one, as a JSON object; all of it without an earlier one.
    pub(crate) fn since(&self, earlier: Option<&Frame>) -> String {
        let mut out = String::from("{\"networks\":{");
        let mut separator = "";
        for (i, state) in self.networks.iter().enumerate() {
            let old = earlier.and_then(|frame| frame.networks.get(i));
            if old != Some(state) {
                let _ = write!(out, "{separator}\"{}\":{state}", i + 1);
                separator = ",";
            }
        }
        out.push('}');
        for (name, state) in &self.parts {
            let old = earlier.and_then(|frame| frame.part(name));
            if old != Some(state) {
                let _ = write!(out, ",\"{name}\":{state}");
            }
        }
        let seen = earlier.map_or(0, |frame| frame.log.written);
        let entries: Vec<&str> = self.log.since(seen).collect();
        if !entries.is_empty() {
            let _ = write!(out, ",\"log\":[{}]", entries.join(","));
        }
        out.push('}');
        out
    }

    fn part(&self, name: &str) -> Option<&Arc<str>> {
        let mut parts = self.parts.iter();
        parts.find(|part| part.0 == name).map(|part| &part.1)
    }
}

/// The last entries of a log, as JSON texts.
#[derive(Clone, Default, Debug)]
pub struct Log {
    entries: VecDeque<Arc<str>>,
    /// Number of entries ever written.
    written: u64,
}

impl Log {
    /// Writes an entry; `kind` is `error`, `frame` or `event`.
    pub fn write(&mut self, at_ms: u64, kind: &str, text: &str) {
        if self.entries.len() == ENTRIES {
            self.entries.pop_front();
        }
        let entry = serde_json::json!({ "ms": at_ms, "kind": kind, "text": text });
        self.entries.push_back(entry.to_string().into());
        self.written += 1;
    }

    /// The entries that are kept of those after the first `seen`.
    fn since(&self, seen: u64) -> impl Iterator<Item = &str> {
        let new = self.written.saturating_sub(seen);
        let new = usize::try_from(new).unwrap_or(usize::MAX);
        let old = self.entries.len().saturating_sub(new);
        self.entries.iter().skip(old).map(|entry| &**entry)
    }
}

#[cfg(test)]
mod tests {
    use super::{ENTRIES, Frame};

    #[test]
    fn only_what_is_new_is_sent() {
        let mut old = Frame {
            networks: vec!["1".into(), "2".into()],
            parts: vec![("state", "{}".into()), ("watch", "[]".into())],
            ..Frame::default()
        };
        old.log.write(5, "event", "RUN");
        let all = r#"{"networks":{"1":1,"2":2},"state":{},"watch":[],"log":[{"kind":"event","ms":5,"text":"RUN"}]}"#;
        assert_eq!(old.since(None), all);
        assert_eq!(old.since(Some(&old)), r#"{"networks":{}}"#);
        let mut new = old.clone();
        new.networks[1] = "3".into();
        new.log.write(6, "event", "STOP");
        let news = r#"{"networks":{"2":3},"log":[{"kind":"event","ms":6,"text":"STOP"}]}"#;
        assert_eq!(new.since(Some(&old)), news);
        for _ in 0..2 * ENTRIES {
            new.log.write(7, "event", "RUN");
        }
        assert_eq!(new.since(Some(&old)).matches("RUN").count(), ENTRIES);
    }
}
