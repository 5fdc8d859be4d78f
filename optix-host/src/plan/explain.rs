//! What a pipeline was specialised to, what was left out, and why.

use core::fmt;

/// One decision.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Note {
    /// What it is about, in OptiX's terms.
    pub what: &'static str,
    /// What was chosen.
    pub choice: String,
    /// Why.
    pub reason: String,
}

/// Collects decisions as they are made.
#[derive(Clone, Debug, Default)]
pub(crate) struct Notes(Vec<Note>);

impl Notes {
    pub fn add(&mut self, what: &'static str, choice: impl Into<String>, reason: impl Into<String>) {
        self.0.push(Note { what, choice: choice.into(), reason: reason.into() });
    }

    pub fn explanation(&self, pipeline: &'static str) -> Explanation {
        Explanation { pipeline, notes: self.0.clone(), device: Vec::new() }
    }
}

/// All decisions. `Display` prints them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Explanation {
    /// The pipeline's name.
    pub pipeline: &'static str,
    /// The decisions.
    pub notes: Vec<Note>,
    /// What the device says: code sizes, stack sizes, compiler feedback.
    pub device: Vec<String>,
}

impl fmt::Display for Explanation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "pipeline {}", self.pipeline)?;
        let width = self.notes.iter().map(|n| n.what.len()).max().unwrap_or(0);
        for note in &self.notes {
            writeln!(f, "  {:width$}  {}: {}", note.what, note.choice, note.reason)?;
        }
        for line in &self.device {
            writeln!(f, "  {line}")?;
        }
        Ok(())
    }
}
