use std::ops::ControlFlow;
use std::path::Path;

use roxmltree::Document;

use super::repair::repair;
use super::scene::build_scene;
use super::text::{read_text, xml_error};
use super::xml::Xml;
use crate::io::progress::{LoadStage, Reporter};
use crate::io::report::{Notes, ReadCounts, Severity};
use crate::io::{ImportError, LoadProgress, Loaded};

/// Reads a COLLADA file, whatever its extension. `progress` is called often, in the order of
/// [`LoadStage`]; when it breaks, reading stops.
///
/// Faults that leave something to show become notes in the report.
///
/// # Errors
/// [`ImportError`] when there is nothing to show or the file cannot be trusted.
pub fn read_collada(
    path: &Path,
    progress: &mut dyn FnMut(LoadProgress) -> ControlFlow<()>,
) -> Result<Loaded, ImportError> {
    let mut reporter = Reporter {
        path,
        callback: progress,
    };
    let mut notes = Notes::default();
    let (decoded, bytes) = read_text(path, &mut reporter)?;
    if let Some(oddity) = decoded.oddity {
        notes.add(Severity::Warning, None, "text", oddity);
    }
    reporter.at(LoadStage::Parsing, 0.0)?;
    let text = decoded.text;
    let repaired;
    let document = match Document::parse(&text) {
        Ok(document) => document,
        Err(error) => {
            let (fixed, repairs) = repair(&text);
            if repairs.ampersands + repairs.forbidden == 0 {
                return Err(xml_error(path, &text, &error));
            }
            let messages = [
                (repairs.ampersands, "bare & were read as &amp;"),
                (repairs.forbidden, "control characters were read as blanks"),
            ];
            for (count, message) in messages.into_iter().filter(|(count, _)| *count > 0) {
                let line = (error.pos().row > 1).then_some(error.pos().row);
                let message = format!("{count} {message}");
                notes.add(Severity::Warning, line, "text", message);
            }
            repaired = fixed;
            Document::parse(&repaired).map_err(|error| xml_error(path, &repaired, &error))?
        }
    };
    let root = document.root_element();
    let xml = Xml::new(&document, &mut notes);
    if root.tag_name().name() != "COLLADA" {
        return Err(ImportError::NotCollada {
            path: path.to_owned(),
            line: xml.line(root),
            found: root.tag_name().name().to_owned(),
        });
    }
    reporter.at(LoadStage::Parsing, 1.0)?;
    let counts = ReadCounts {
        bytes,
        lines: text.lines().count() as u64,
        encoding: decoded.encoding.to_owned(),
        ..ReadCounts::default()
    };
    build_scene(&xml, notes, &mut reporter, counts)
}
