use std::collections::HashMap;
use std::fmt;

use serde::Serialize;

/// What reading a file found, for `softbox info` and the viewer's import panel.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ImportReport {
    /// What was read.
    pub read: ReadCounts,
    /// What deserves a word, in the order it was met.
    pub notes: Vec<ReportNote>,
}

/// The amounts that were read.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ReadCounts {
    /// Size of the file in bytes.
    pub bytes: u64,
    /// Lines of text.
    pub lines: u64,
    /// The character encoding, as found.
    pub encoding: String,
    /// `X_UP`, `Y_UP` or `Z_UP`, as declared or assumed.
    pub up_axis: String,
    /// Metres per unit as declared; reported, never applied.
    pub metres_per_unit: f64,
    /// True for files of the course's dialect (profile CGL or CMU462).
    pub is_course_dialect: bool,
    /// Nodes visited, counting each instance of a node.
    pub nodes: usize,
    /// Meshes in use.
    pub meshes: usize,
    /// Analytic spheres in use.
    pub spheres: usize,
    /// Triangles of all meshes in use, each mesh counted once.
    pub triangles: usize,
    /// Triangles of all instances.
    pub instanced_triangles: usize,
    /// Placed geometry.
    pub instances: usize,
    /// Materials in use.
    pub materials: usize,
    /// Placed lights, without ambient light and sky.
    pub lights: usize,
    /// Cameras.
    pub cameras: usize,
}

/// One thing the reader wants known.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct ReportNote {
    /// How serious it is.
    pub severity: Severity,
    /// Line in the file, from 1, of the first case.
    pub line: Option<u32>,
    /// The element it is about, such as `geometry "Cube"`.
    pub element: String,
    /// What was found and what was done about it.
    pub message: String,
    /// How many elements had the same; `element` and `line` name the first.
    pub count: usize,
}

/// How serious a note is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
pub enum Severity {
    /// For information.
    Read,
    /// The file left something open and softbox chose.
    Guessed,
    /// Something in the file has no effect on the picture.
    Dropped,
    /// Something in the file is wrong.
    Warning,
}

impl fmt::Display for Severity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Read => "read",
            Self::Guessed => "guessed",
            Self::Dropped => "dropped",
            Self::Warning => "warning",
        })
    }
}

impl fmt::Display for ReportNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:<7} ", self.severity)?;
        if let Some(line) = self.line {
            write!(f, "line {line}: ")?;
        }
        if !self.element.is_empty() {
            write!(f, "{}: ", self.element)?;
        }
        f.write_str(&self.message)?;
        if self.count > 1 {
            write!(f, " ({} times in all)", self.count)?;
        }
        Ok(())
    }
}

impl fmt::Display for ImportReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let read = &self.read;
        writeln!(
            f,
            "file: {} bytes, {} lines, {}, {}, {} metres per unit{}",
            read.bytes,
            read.lines,
            read.encoding,
            read.up_axis,
            read.metres_per_unit,
            if read.is_course_dialect {
                ", course dialect"
            } else {
                ""
            }
        )?;
        writeln!(
            f,
            "geometry: {} triangles in {} meshes, {} spheres; {} instances with {} triangles",
            read.triangles, read.meshes, read.spheres, read.instances, read.instanced_triangles
        )?;
        writeln!(
            f,
            "scene: {} nodes, {} materials, {} lights, {} cameras",
            read.nodes, read.materials, read.lights, read.cameras
        )?;
        for note in &self.notes {
            writeln!(f, "{note}")?;
        }
        Ok(())
    }
}

/// Collects notes and folds those that say the same, so that a file with a hundred thousand faults
/// makes a short report.
#[derive(Debug, Default)]
pub(super) struct Notes {
    notes: Vec<ReportNote>,
    by_text: HashMap<(Severity, String), usize>,
    left_out: usize,
}

impl Notes {
    /// The most notes a report holds; further ones are counted.
    const LIMIT: usize = 1000;

    /// Adds a note, or counts it with an earlier one that says the same.
    pub(super) fn add(
        &mut self,
        severity: Severity,
        line: Option<u32>,
        element: impl Into<String>,
        message: impl Into<String>,
    ) {
        let message = message.into();
        let key = (severity, message);
        if let Some(&index) = self.by_text.get(&key) {
            self.notes[index].count += 1;
        } else if self.notes.len() >= Self::LIMIT {
            self.left_out += 1;
        } else {
            self.notes.push(ReportNote {
                severity,
                line,
                element: element.into(),
                message: key.1.clone(),
                count: 1,
            });
            self.by_text.insert(key, self.notes.len() - 1);
        }
    }

    /// The folded notes.
    pub(super) fn finish(mut self) -> Vec<ReportNote> {
        if self.left_out > 0 {
            self.notes.push(ReportNote {
                severity: Severity::Warning,
                line: None,
                element: String::new(),
                message: "further notes were left out of this report".to_owned(),
                count: self.left_out,
            });
        }
        self.notes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn notes_that_say_the_same_fold_and_the_report_stays_short() {
        let mut notes = Notes::default();
        for i in 0..100_000 {
            notes.add(
                Severity::Warning,
                Some(i),
                format!("geometry {i}"),
                "bad face",
            );
        }
        for i in 0..5000 {
            notes.add(Severity::Dropped, None, "x", format!("message {i}"));
        }
        let notes = notes.finish();
        assert_eq!(notes.len(), Notes::LIMIT + 1);
        assert_eq!((notes[0].count, notes[0].line), (100_000, Some(0)));
        assert_eq!(notes[Notes::LIMIT].count, 5001 - Notes::LIMIT);
        assert_eq!(
            notes[0].to_string(),
            "warning line 0: geometry 0: bad face (100000 times in all)"
        );
    }
}
