use roxmltree::Node;

use super::common_effect::read_common;
use super::numbers;
use super::values::{light_color, positive, positive_rgb, share_of};
use super::xml::{Xml, child, course_technique, name_of};
use crate::color::Rgb;
use crate::io::report::{Notes, Severity};
use crate::scene::{Material, Surface};

/// Refractive index of copper at 617, 549 and 471 nm, real and imaginary part, for a microfacet
/// block without its own. Source: P. B. Johnson and R. W. Christy, "Optical Constants of the Noble
/// Metals" (1972).
const COPPER_ETA: Rgb = Rgb::new(0.30, 1.02, 1.25);
const COPPER_K: Rgb = Rgb::new(3.205, 2.577, 2.483);
/// Index of refraction of a glass that does not say: that of the course's scenes.
const GLASS_IOR: f32 = 1.45;
/// Beckmann width of a microfacet block that does not say.
const ALPHA: f32 = 0.1;

/// What an effect describes.
pub(super) struct Effect {
    pub(super) surface: Surface,
    pub(super) emission: Rgb,
}

/// Reads a `<material>` through its `<instance_effect>`.
pub(super) fn read_material(
    xml: &Xml<'_, '_>,
    notes: &mut Notes,
    material: Node<'_, '_>,
) -> Material {
    let name = name_of(material);
    let effect = match child(material, "instance_effect") {
        Some(instance) => xml.follow(notes, instance, "url", "effect"),
        None => {
            let message = "the material has no <instance_effect>; grey 0.5 was taken";
            xml.note(notes, Severity::Warning, material, message);
            None
        }
    };
    let Some(effect) = effect else {
        return Material {
            name,
            ..Material::default()
        };
    };
    let double_sided = is_double_sided(material) || is_double_sided(effect);
    let read = course_effect(xml, notes, effect)
        .or_else(|| course_effect(xml, notes, material))
        .unwrap_or_else(|| read_common(xml, notes, effect));
    Material {
        name,
        surface: read.surface,
        emission: read.emission,
        double_sided,
    }
}

/// The flag of the profiles GOOGLEEARTH and MAX3D.
fn is_double_sided(node: Node<'_, '_>) -> bool {
    node.descendants()
        .filter(|inner| inner.tag_name().name() == "double_sided")
        .any(|flag| {
            numbers::words(flag)
                .next()
                .is_some_and(|word| matches!(word, "1" | "true"))
        })
}

/// The block of profile CGL or CMU462; `None` when there is none or nothing in it is known.
fn course_effect(xml: &Xml<'_, '_>, notes: &mut Notes, holder: Node<'_, '_>) -> Option<Effect> {
    let block = course_technique(holder)?;
    let (mut surface, mut emission) = (None, None);
    for element in block.children().filter(Node::is_element) {
        let name = element.tag_name().name();
        match name {
            "emission" => {
                if let Some(radiance) = child(element, "radiance") {
                    emission = Some(light_color(xml, notes, radiance, Rgb::ZERO));
                }
            }
            "mirror" | "glass" | "refraction" | "microfacet" if surface.is_some() => {
                let message = format!("<{name}> follows another surface; the first one counts");
                xml.note(notes, Severity::Dropped, element, message);
            }
            _ => match course_surface(xml, notes, element) {
                Some(read) => surface = Some(read),
                None => {
                    let message = format!("<{name}> is no known surface; it was left out");
                    xml.note(notes, Severity::Dropped, element, message);
                }
            },
        }
    }
    if surface.is_none() && emission.is_none() {
        return None;
    }
    // A course emitter reflects nothing.
    let black = Surface::Diffuse {
        reflectance: Rgb::ZERO,
    };
    Some(Effect {
        surface: surface.unwrap_or(black),
        emission: emission.unwrap_or(Rgb::ZERO),
    })
}

fn course_surface(xml: &Xml<'_, '_>, notes: &mut Notes, element: Node<'_, '_>) -> Option<Surface> {
    Some(match element.tag_name().name() {
        "mirror" => Surface::Mirror {
            reflectance: share_of(xml, notes, element, "reflectance"),
        },
        "glass" => {
            note_roughness(xml, notes, element);
            Surface::Glass {
                reflectance: share_of(xml, notes, element, "reflectance"),
                transmittance: share_of(xml, notes, element, "transmittance"),
                ior: positive(xml, notes, element, "ior", GLASS_IOR),
            }
        }
        "refraction" => {
            note_roughness(xml, notes, element);
            Surface::Refraction {
                transmittance: share_of(xml, notes, element, "transmittance"),
                ior: positive(xml, notes, element, "ior", GLASS_IOR),
            }
        }
        "microfacet" => Surface::Microfacet {
            alpha: positive(xml, notes, element, "alpha", ALPHA),
            eta: positive_rgb(xml, notes, element, "eta", COPPER_ETA),
            k: positive_rgb(xml, notes, element, "k", COPPER_K),
        },
        _ => return None,
    })
}

fn note_roughness(xml: &Xml<'_, '_>, notes: &mut Notes, element: Node<'_, '_>) {
    let roughness = child(element, "roughness").and_then(numbers::scalar);
    if let Some(roughness) = roughness.filter(|roughness| *roughness != 0.0) {
        let message = format!("roughness {roughness} was ignored; the surface is smooth");
        xml.note(notes, Severity::Dropped, element, message);
    }
}
