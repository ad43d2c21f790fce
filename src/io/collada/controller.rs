use glam::DMat4;
use roxmltree::Node;

use super::numbers;
use super::transform::is_usable;
use super::xml::{Xml, child};
use crate::io::report::{Notes, Severity};

/// How many controllers may stand one on the other.
const CHAIN_LIMIT: usize = 8;

/// The geometry behind a `<controller>` in its bind pose, with node_from_object: the product of the
/// bind shape matrices.
pub(super) fn resolve_controller<'a, 'input>(
    xml: &Xml<'a, 'input>,
    notes: &mut Notes,
    controller: Node<'a, 'input>,
) -> Option<(Node<'a, 'input>, DMat4)> {
    let mut node_from_object = DMat4::IDENTITY;
    let mut current = controller;
    for _ in 0..CHAIN_LIMIT {
        let Some(kind) = child(current, "skin").or_else(|| child(current, "morph")) else {
            let message = "the controller has neither <skin> nor <morph>; it was left out";
            xml.note(notes, Severity::Warning, current, message);
            return None;
        };
        let message = "skins and morphs are shown in their bind pose";
        xml.note(notes, Severity::Guessed, current, message);
        if let Some(matrix) = child(kind, "bind_shape_matrix") {
            match numbers::matrix(matrix).filter(is_usable) {
                Some(bind_shape) => node_from_object *= bind_shape,
                None => {
                    let message = "the matrix has too few or unreadable numbers; it was left out";
                    xml.note(notes, Severity::Warning, matrix, message);
                }
            }
        }
        let source = kind.attribute("source").unwrap_or_default();
        if let Some(geometry) = xml.find("geometry", source) {
            return Some((geometry, node_from_object));
        }
        match xml.find("controller", source) {
            Some(next) => current = next,
            None => {
                let message = format!("no <geometry> has the id \"{source}\"; this was left out");
                xml.note(notes, Severity::Warning, kind, message);
                return None;
            }
        }
    }
    let message = "controllers refer to each other in a circle or a long chain; this was left out";
    xml.note(notes, Severity::Warning, controller, message);
    None
}
