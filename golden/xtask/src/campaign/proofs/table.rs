//! Results of a campaign: counts, as tables in Markdown.

use super::draw::FORMS;
use super::planted::KINDS;

/// Results for questions of one form.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Counts {
    /// Decided questions.
    pub asked: u64,
    /// Proved, or the same.
    pub proved: u64,
    /// Scans that searched for a run against a proof.
    pub scans: u64,
    /// Proofs against which there is a run.
    pub refuted: u64,
    /// Violated, reached, or different.
    pub violated: u64,
    /// Of these, runs that were confirmed.
    pub replayed: u64,
    /// Proofs that are taken back, since the program contradicts an assumption.
    pub vacuous: u64,
    /// Assumptions that no run keeps.
    pub contradictory: u64,
    /// Undecided because something is not modelled.
    pub unmodelled: u64,
    /// Undecided in the time given.
    pub late: u64,
    /// Logic that is too large to be asked.
    pub large: u64,
}

/// Results of a campaign, or of one of its programs.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Results {
    /// Programs.
    pub programs: u64,
    /// Programs that do not compile, or are too large.
    pub rejected: u64,
    /// By [`FORMS`].
    pub counts: [Counts; FORMS.len()],
    /// Exported questions, and scans over which their files were evaluated.
    pub files: (u64, u64),
    /// Questions that another model checker answered, and those that it did not answer in time.
    pub others: (u64, u64),
    /// Planted violations by [`KINDS`], and those that were found.
    pub planted: [(u64, u64); KINDS.len()],
    /// What is wrong, each with the program.
    pub wrong: Vec<String>,
}

impl Results {
    /// Adds others.
    pub fn add(&mut self, other: &Results) {
        self.programs += other.programs;
        self.rejected += other.rejected;
        for (all, more) in self.counts.iter_mut().zip(&other.counts) {
            all.add(more);
        }
        self.files.0 += other.files.0;
        self.files.1 += other.files.1;
        self.others.0 += other.others.0;
        self.others.1 += other.others.1;
        for (all, more) in self.planted.iter_mut().zip(&other.planted) {
            all.0 += more.0;
            all.1 += more.1;
        }
        self.wrong.extend(other.wrong.iter().cloned());
    }

    /// All planted violations, and those found.
    pub fn calibration(&self) -> (u64, u64) {
        let all = self.planted.iter();
        all.fold((0, 0), |sum, of| (sum.0 + of.0, sum.1 + of.1))
    }

    /// The tables.
    pub fn text(&self) -> String {
        let mut lines = vec![
            "| question | asked | proved | scans against them | refuted | violated | replayed | vacuous | contradictory \
             | not modelled | time | too large |"
                .to_string(),
            "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|".to_string(),
        ];
        let mut all = Counts::default();
        for (form, counts) in FORMS.iter().zip(&self.counts) {
            lines.push(counts.row(form));
            all.add(counts);
        }
        lines.push(all.row("all"));
        lines.push(String::new());
        lines.push("| planted violation | programs | found |".to_string());
        lines.push("|---|--:|--:|".to_string());
        for (kind, (programs, found)) in KINDS.iter().zip(&self.planted) {
            lines.push(format!("| {kind} | {programs} | {found} |"));
        }
        let (programs, found) = self.calibration();
        lines.push(format!("| all | {programs} | {found} |"));
        lines.push(String::new());
        lines.push(format!(
            "{} programs, {} drawn lists left out; {} exported questions evaluated over {} scans; another model \
             checker answers {} and not {} in time; {} wrong",
            self.programs,
            self.rejected,
            self.files.0,
            self.files.1,
            self.others.0,
            self.others.1,
            self.wrong.len()
        ));
        lines.join("\n")
    }
}

impl Counts {
    /// Adds others.
    pub fn add(&mut self, other: &Counts) {
        let pairs = self.fields_mut().into_iter().zip(other.fields());
        pairs.for_each(|(all, more)| *all += more);
    }

    fn fields(&self) -> [u64; 11] {
        let mut copy = *self;
        copy.fields_mut().map(|field| *field)
    }

    fn fields_mut(&mut self) -> [&mut u64; 11] {
        [
            &mut self.asked,
            &mut self.proved,
            &mut self.scans,
            &mut self.refuted,
            &mut self.violated,
            &mut self.replayed,
            &mut self.vacuous,
            &mut self.contradictory,
            &mut self.unmodelled,
            &mut self.late,
            &mut self.large,
        ]
    }

    fn row(&self, form: &str) -> String {
        let fields = self.fields().map(|count| count.to_string());
        format!("| {form} | {} |", fields.join(" | "))
    }
}
