use roxmltree::Node;

use super::numbers;
use super::xml::{Xml, at_path, child};
use crate::io::report::{Notes, Severity};
use crate::scene::FieldOfView;

/// The full horizontal angle of a camera that gives none, in degrees, as in the course.
const XFOV: f64 = 50.0;

/// The opening angles of a `<camera>`. What is missing or impossible is guessed with a note.
pub(super) fn read_camera(
    xml: &Xml<'_, '_>,
    notes: &mut Notes,
    camera: Node<'_, '_>,
) -> FieldOfView {
    let common = at_path(camera, &["optics", "technique_common"]);
    let Some(lens) = common.and_then(|common| child(common, "perspective")) else {
        let is_orthographic = common.is_some_and(|c| child(c, "orthographic").is_some());
        let what = if is_orthographic {
            "the camera is orthographic"
        } else {
            "the camera has no <perspective>"
        };
        let message = format!("{what}; a perspective of {XFOV} degrees was taken");
        xml.note(notes, Severity::Guessed, camera, message);
        return FieldOfView {
            x: Some(XFOV.to_radians()),
            ..FieldOfView::default()
        };
    };
    let mut within = |name: &str, low: f64, high: f64| {
        let element = child(lens, name)?;
        let value = numbers::scalar(element).filter(|value| *value > low && *value < high);
        if value.is_none() {
            let message = format!("<{name}> must be between {low} and {high}; it was left out");
            xml.note(notes, Severity::Warning, element, message);
        }
        value
    };
    let mut x = within("xfov", 0.0, 180.0);
    let y = within("yfov", 0.0, 180.0);
    let aspect = within("aspect_ratio", 0.0, 1e6);
    if x.is_none() && y.is_none() {
        let message = format!("the camera has no opening angle; {XFOV} degrees were taken");
        xml.note(notes, Severity::Guessed, camera, message);
        x = Some(XFOV);
    }
    FieldOfView {
        x: x.map(f64::to_radians),
        y: y.map(f64::to_radians),
        aspect,
    }
}
