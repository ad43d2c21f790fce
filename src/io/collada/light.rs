use std::f64::consts::PI;

use roxmltree::Node;

use super::numbers;
use super::values::light_color;
use super::xml::{Xml, child, course_technique};
use crate::color::Rgb;
use crate::io::report::{Notes, Severity};
use crate::scene::LightKind;

/// What a `<light>` is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Light {
    /// Light at a place or from a direction.
    Placed(LightKind),
    /// The upper hemisphere shines.
    Ambient(Rgb),
}

/// Reads a `<light>`: the block of profile CGL or CMU462 before `technique_common`.
pub(super) fn read_light(
    xml: &Xml<'_, '_>,
    notes: &mut Notes,
    light: Node<'_, '_>,
) -> Option<Light> {
    let blocks = [course_technique(light), child(light, "technique_common")];
    let mut elements = blocks
        .into_iter()
        .flatten()
        .flat_map(|block| block.children().filter(Node::is_element));
    let read = elements.find_map(|element| read_kind(xml, notes, element));
    if read.is_none() {
        let message = "the light has no kind that is known; it was left out";
        xml.note(notes, Severity::Dropped, light, message);
    }
    read
}

fn read_kind(xml: &Xml<'_, '_>, notes: &mut Notes, element: Node<'_, '_>) -> Option<Light> {
    let name = element.tag_name().name();
    if !matches!(
        name,
        "area" | "point" | "spot" | "directional" | "ambient" | "hemisphere"
    ) {
        let message = format!("<{name}> lights are not known; a simpler description is looked for");
        xml.note(notes, Severity::Dropped, element, message);
        return None;
    }
    let color = match child(element, "color") {
        Some(color) => light_color(xml, notes, color, Rgb::ONE),
        None => {
            let message = "the light has no <color>; 1 1 1 was assumed";
            xml.note(notes, Severity::Guessed, element, message);
            Rgb::ONE
        }
    };
    Some(match name {
        "area" => Light::Placed(LightKind::Area { radiance: color }),
        "point" => Light::Placed(LightKind::Point {
            intensity: attenuated(xml, notes, element, color),
        }),
        "spot" => {
            let intensity = attenuated(xml, notes, element, color);
            Light::Placed(spot(xml, notes, element, intensity))
        }
        "directional" => Light::Placed(LightKind::Directional { irradiance: color }),
        _ => Light::Ambient(color),
    })
}

/// The intensity of a light that falls with 1/r² only. Attenuation is 1/(c + l·r + q·r²) in the
/// file: with q alone it is exact, everything else is noted and the colour is the intensity.
fn attenuated(xml: &Xml<'_, '_>, notes: &mut Notes, element: Node<'_, '_>, color: Rgb) -> Rgb {
    let factor = |name| child(element, name).and_then(numbers::scalar);
    let (constant, linear, quadratic) = (
        factor("constant_attenuation"),
        factor("linear_attenuation"),
        factor("quadratic_attenuation"),
    );
    if (constant, linear, quadratic) == (None, None, None) {
        return color;
    }
    let q = quadratic.unwrap_or(0.0) as f32;
    // The specification's default for `constant_attenuation` is 1.
    if constant.unwrap_or(1.0) == 0.0 && linear.unwrap_or(0.0) == 0.0 && q > 0.0 {
        return color / q;
    }
    let message =
        "the light's attenuation was ignored; it falls with 1/r² and its colour is its intensity";
    xml.note(notes, Severity::Guessed, element, message);
    color
}

/// A cone of `falloff_angle` degrees (full angle, 180 unless given) and cos^`falloff_exponent`.
fn spot(xml: &Xml<'_, '_>, notes: &mut Notes, element: Node<'_, '_>, intensity: Rgb) -> LightKind {
    let mut value = |name: &str, default: f64, low: f64, high: f64| {
        let Some(holder) = child(element, name) else {
            return default;
        };
        match numbers::scalar(holder) {
            Some(value) if value >= low && value <= high => value,
            _ => {
                let message = format!("<{name}> must be from {low} to {high}; {default} was taken");
                xml.note(notes, Severity::Warning, holder, message);
                default
            }
        }
    };
    let degrees = value("falloff_angle", 180.0, 1e-3, 180.0);
    LightKind::Spot {
        intensity,
        cone_angle: degrees.to_radians().min(PI),
        exponent: value("falloff_exponent", 0.0, 0.0, 1e6),
    }
}
