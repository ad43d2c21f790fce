use roxmltree::Node;

use super::effect::Effect;
use super::numbers;
use super::values::{light_color, share};
use super::xml::{Xml, child, children};
use crate::color::Rgb;
use crate::io::report::{Notes, Severity};
use crate::scene::Surface;

/// The reflectance of a surface that does not say, as in the course.
const GREY: Rgb = Rgb::splat(0.5);

/// The diffuse and emitted light of `<profile_COMMON>`.
pub(super) fn read_common(xml: &Xml<'_, '_>, notes: &mut Notes, effect: Node<'_, '_>) -> Effect {
    let Some(profile) = child(effect, "profile_COMMON") else {
        let message = "the effect has no <profile_COMMON>; grey 0.5 was taken";
        xml.note(notes, Severity::Guessed, effect, message);
        return diffuse(GREY, Rgb::ZERO);
    };
    let shader = children(profile, "technique").find_map(|technique| {
        technique.children().find(|shader| {
            matches!(
                shader.tag_name().name(),
                "phong" | "lambert" | "blinn" | "constant"
            )
        })
    });
    let Some(shader) = shader else {
        let message =
            "the effect has no phong, lambert, blinn or constant shader; grey 0.5 was taken";
        xml.note(notes, Severity::Guessed, effect, message);
        return diffuse(GREY, Rgb::ZERO);
    };
    let emission = match color_of(xml, notes, profile, shader, "emission") {
        Color::Value(value) => light_color(xml, notes, value, Rgb::ZERO),
        Color::Texture | Color::Missing => Rgb::ZERO,
    };
    let reflectance = match color_of(xml, notes, profile, shader, "diffuse") {
        Color::Value(value) => share(xml, notes, value, GREY),
        Color::Texture => GREY,
        Color::Missing if emission != Rgb::ZERO => Rgb::ZERO,
        Color::Missing => {
            let message = "the effect has no diffuse colour; grey 0.5 was taken";
            xml.note(notes, Severity::Guessed, effect, message);
            GREY
        }
    };
    note_ignored(xml, notes, shader);
    diffuse(reflectance, emission)
}

fn diffuse(reflectance: Rgb, emission: Rgb) -> Effect {
    Effect {
        surface: Surface::Diffuse { reflectance },
        emission,
    }
}

/// Where a colour stands.
enum Color<'a, 'input> {
    /// The element with the numbers.
    Value(Node<'a, 'input>),
    /// A picture, which is not read.
    Texture,
    Missing,
}

/// Finds `<color>`, a `<param>`'s value or a `<texture>` in the child `name` of a shader; notes
/// textures.
fn color_of<'a, 'input>(
    xml: &Xml<'_, '_>,
    notes: &mut Notes,
    profile: Node<'a, 'input>,
    shader: Node<'a, 'input>,
    name: &str,
) -> Color<'a, 'input> {
    let Some(holder) = child(shader, name) else {
        return Color::Missing;
    };
    if let Some(color) = child(holder, "color") {
        return Color::Value(color);
    }
    if let Some(texture) = child(holder, "texture") {
        let message = format!("textures are not read; {name} is taken without it");
        xml.note(notes, Severity::Dropped, texture, message);
        return Color::Texture;
    }
    let sid = child(holder, "param").and_then(|param| param.attribute("ref"));
    let value = sid.and_then(|sid| {
        let parameter = profile
            .descendants()
            .filter(|node| node.tag_name().name() == "newparam")
            .find(|node| node.attribute("sid") == Some(sid))?;
        parameter.children().find(|value| {
            matches!(
                value.tag_name().name(),
                "float3" | "float4" | "color" | "float"
            )
        })
    });
    value.map_or(Color::Missing, Color::Value)
}

/// Notes what a shader asks for and does not get.
fn note_ignored(xml: &Xml<'_, '_>, notes: &mut Notes, shader: Node<'_, '_>) {
    let color = |name| {
        child(shader, name)
            .and_then(|holder| child(holder, "color"))
            .and_then(numbers::rgb)
    };
    let float = |name| {
        child(shader, name)
            .and_then(|holder| child(holder, "float"))
            .and_then(numbers::scalar)
    };
    let is_textured =
        |name| child(shader, name).is_some_and(|holder| child(holder, "texture").is_some());
    if color("specular").is_some_and(|color| color != Rgb::ZERO) {
        let message =
            "specular highlights of the common profile are not rendered; the surface is diffuse";
        xml.note(notes, Severity::Read, shader, message);
    }
    let reflects = color("reflective").is_some_and(|color| color != Rgb::ZERO)
        && float("reflectivity").is_none_or(|share| share > 0.0);
    if reflects || is_textured("reflective") {
        let message = "reflections of the common profile are not rendered; the surface is diffuse";
        xml.note(notes, Severity::Dropped, shader, message);
    }
    if is_textured("transparent") || lets_light_through(shader) {
        let message = "transparency of the common profile is not rendered; the surface is opaque";
        xml.note(notes, Severity::Dropped, shader, message);
    }
}

/// Evaluates `<transparent>` and `<transparency>` (COLLADA 1.4.1 specification, "Determining
/// Transparency"): mode A_ONE is opaque at alpha · transparency = 1, RGB_ZERO at 0.
fn lets_light_through(shader: Node<'_, '_>) -> bool {
    let transparency = child(shader, "transparency")
        .and_then(|holder| child(holder, "float"))
        .and_then(numbers::scalar)
        .unwrap_or(1.0);
    let Some(transparent) = child(shader, "transparent") else {
        return false;
    };
    let Some([r, g, b, a]) = child(transparent, "color").and_then(numbers::array::<4>) else {
        return false;
    };
    match transparent.attribute("opaque") {
        Some("RGB_ZERO") => (r + g + b) * transparency > 0.0,
        Some("RGB_ONE") => (r + g + b) * transparency < 3.0,
        Some("A_ZERO") => a * transparency > 0.0,
        _ => a * transparency < 1.0,
    }
}
