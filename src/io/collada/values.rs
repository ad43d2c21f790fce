//! Numbers of materials and lights, checked.

use glam::Vec3;
use roxmltree::Node;

use super::numbers;
use super::xml::{Xml, child};
use crate::color::Rgb;
use crate::io::report::{Notes, Severity};

/// The colour in `element`; black channels for negative ones, `default` when it cannot be read,
/// each with a warning.
pub(super) fn light_color(
    xml: &Xml<'_, '_>,
    notes: &mut Notes,
    element: Node<'_, '_>,
    default: Rgb,
) -> Rgb {
    let color = readable(xml, notes, element, default);
    if color.min_element() < 0.0 {
        let message = "light cannot be negative; negative channels are 0";
        xml.note(notes, Severity::Warning, element, message);
    }
    color.max(Vec3::ZERO)
}

/// The colour in `element` as a share of light, held to 0..1 with a note.
pub(super) fn share(
    xml: &Xml<'_, '_>,
    notes: &mut Notes,
    element: Node<'_, '_>,
    default: Rgb,
) -> Rgb {
    let color = readable(xml, notes, element, default);
    let held = color.clamp(Vec3::ZERO, Vec3::ONE);
    if held != color {
        let message =
            "a surface cannot return less than nothing or more than all light; held to 0..1";
        xml.note(notes, Severity::Warning, element, message);
    }
    held
}

/// The share in the child `name` of `parent`; white, noted, when there is none.
pub(super) fn share_of(
    xml: &Xml<'_, '_>,
    notes: &mut Notes,
    parent: Node<'_, '_>,
    name: &str,
) -> Rgb {
    match child(parent, name) {
        Some(element) => share(xml, notes, element, Rgb::ONE),
        None => {
            let message = format!("there is no <{name}>; 1 1 1 was assumed");
            xml.note(notes, Severity::Guessed, parent, message);
            Rgb::ONE
        }
    }
}

/// The positive number in the child `name` of `parent`; `default`, noted, when there is none.
pub(super) fn positive(
    xml: &Xml<'_, '_>,
    notes: &mut Notes,
    parent: Node<'_, '_>,
    name: &str,
    default: f32,
) -> f32 {
    let Some(element) = child(parent, name) else {
        let message = format!("there is no <{name}>; {default} was assumed");
        xml.note(notes, Severity::Guessed, parent, message);
        return default;
    };
    let value = numbers::scalar(element).map(|value| value as f32);
    value
        .filter(|value| *value > 0.0 && value.is_finite())
        .unwrap_or_else(|| {
            let message = format!("<{name}> is not a positive number; {default} was taken");
            xml.note(notes, Severity::Warning, element, message);
            default
        })
}

/// Three positive numbers in the child `name` of `parent`; `default`, noted, when there are none.
pub(super) fn positive_rgb(
    xml: &Xml<'_, '_>,
    notes: &mut Notes,
    parent: Node<'_, '_>,
    name: &str,
    default: Rgb,
) -> Rgb {
    let Some(element) = child(parent, name) else {
        let message = format!("there is no <{name}>; that of copper was assumed");
        xml.note(notes, Severity::Guessed, parent, message);
        return default;
    };
    numbers::rgb(element)
        .filter(|value| value.min_element() > 0.0)
        .unwrap_or_else(|| {
            let message =
                format!("<{name}> is not three positive numbers; that of copper was taken");
            xml.note(notes, Severity::Warning, element, message);
            default
        })
}

fn readable(xml: &Xml<'_, '_>, notes: &mut Notes, element: Node<'_, '_>, default: Rgb) -> Rgb {
    numbers::rgb(element).unwrap_or_else(|| {
        let message = format!(
            "the colour has too few, unreadable or infinite numbers; {} {} {} was taken",
            default.x, default.y, default.z
        );
        xml.note(notes, Severity::Warning, element, message);
        default
    })
}
