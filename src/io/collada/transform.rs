use glam::{DMat4, DQuat, DVec3, DVec4};
use roxmltree::Node;

use super::matrix::{ReadMatrix, read_matrix};
use super::numbers;
use super::xml::Xml;
use crate::io::report::{Notes, Severity};
use crate::scene::UpAxis;

/// Coordinates and matrix entries beyond this are taken for faults: their squares and products
/// would leave the range of numbers.
pub(super) const LARGEST: f64 = 1e30;

/// The rotation that takes a file's axes to a Y-up world, as the course has it:
/// Z up maps (x, y, z) to (−x, z, y), X up to (y, x, −z).
pub(super) fn world_from_file(up: UpAxis) -> DMat4 {
    let (x, y, z) = match up {
        UpAxis::X => (DVec4::Y, DVec4::X, DVec4::NEG_Z),
        UpAxis::Y => return DMat4::IDENTITY,
        UpAxis::Z => (DVec4::NEG_X, DVec4::Z, DVec4::Y),
    };
    DMat4::from_cols(x, y, z, DVec4::W)
}

/// parent_from_node: the product of a node's transforms in the order of the file. Transforms with
/// unreadable numbers are left out with a warning.
pub(super) fn parent_from_node(xml: &Xml<'_, '_>, notes: &mut Notes, node: Node<'_, '_>) -> DMat4 {
    let mut product = DMat4::IDENTITY;
    for element in node.children().filter(Node::is_element) {
        let name = element.tag_name().name();
        let matrix = match name {
            "matrix" => matrix(xml, notes, element),
            "translate" => numbers::vector(element).map(DMat4::from_translation),
            "rotate" => rotate(element),
            "scale" => numbers::vector(element).map(DMat4::from_scale),
            "lookat" => look_at(element),
            "skew" => skew(element),
            _ => continue,
        };
        match matrix {
            Some(matrix) => product *= matrix,
            None => xml.note(
                notes,
                Severity::Warning,
                element,
                format!("<{name}> has too few, unreadable or impossible numbers; this transform was left out"),
            ),
        }
    }
    product
}

/// True when all entries are finite and of a size that can be worked with.
pub(super) fn is_usable(matrix: &DMat4) -> bool {
    matrix
        .to_cols_array()
        .iter()
        .all(|entry| entry.abs() <= LARGEST)
        && matrix.row(3) == DVec4::W
}

/// True when the matrix flattens space, so that nothing can be undone by its inverse.
pub(super) fn is_singular(matrix: &DMat4) -> bool {
    let [x, y, z] = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(DVec4::truncate);
    let volume = x.length() * y.length() * z.length();
    let determinant = x.dot(y.cross(z));
    // 1e-14 of the box with the same edges is rounding.
    determinant == 0.0 || determinant.abs() <= 1e-14 * volume
}

fn matrix(xml: &Xml<'_, '_>, notes: &mut Notes, element: Node<'_, '_>) -> Option<DMat4> {
    match read_matrix(element) {
        ReadMatrix::Whole(matrix) => Some(matrix),
        ReadMatrix::Completed(matrix) => {
            let message = "<matrix> has 15 numbers; the lost one was put back where the axes become perpendicular";
            xml.note(notes, Severity::Warning, element, message);
            Some(matrix)
        }
        ReadMatrix::Unreadable => None,
    }
}

/// Axis and angle in degrees.
fn rotate(element: Node<'_, '_>) -> Option<DMat4> {
    let [x, y, z, degrees] = numbers::array(element)?;
    let angle = degrees.to_radians();
    if angle == 0.0 {
        return Some(DMat4::IDENTITY);
    }
    let axis = DVec3::new(x, y, z).try_normalize()?;
    Some(DMat4::from_quat(DQuat::from_axis_angle(axis, angle)))
}

/// Eye, point of interest and up: the node's −z looks from the eye to the point.
fn look_at(element: Node<'_, '_>) -> Option<DMat4> {
    let numbers: [f64; 9] = numbers::array(element)?;
    let [eye, target, up] = [0, 3, 6].map(|i| DVec3::from_slice(&numbers[i..]));
    let back = (eye - target).try_normalize()?;
    let right = up.cross(back).try_normalize()?;
    Some(DMat4::from_cols(
        right.extend(0.0),
        back.cross(right).extend(0.0),
        back.extend(0.0),
        eye.extend(1.0),
    ))
}

/// Angle in degrees, the axis of rotation and the axis along which points move: a point moves by
/// tan(angle) times its component along the rotated axis made perpendicular to the translation.
///
/// Source: COLLADA 1.4.1 specification (2008), `skew`, which takes it from the RenderMan
/// interface: the plane spanned by both axes is sheared so that the first axis turns by the angle
/// towards the second.
fn skew(element: Node<'_, '_>) -> Option<DMat4> {
    let numbers: [f64; 7] = numbers::array(element)?;
    let angle = numbers[0].to_radians();
    let rotated = DVec3::from_slice(&numbers[1..]).try_normalize()?;
    let along = DVec3::from_slice(&numbers[4..]).try_normalize()?;
    let across = (rotated - along * rotated.dot(along)).try_normalize()?;
    let before = rotated.dot(along).atan2(rotated.dot(across));
    let after = before + angle;
    if after.cos() <= 1e-6 {
        return None;
    }
    let shear = along * (after.tan() - before.tan());
    Some(DMat4::from_cols(
        (DVec3::X + shear * across.x).extend(0.0),
        (DVec3::Y + shear * across.y).extend(0.0),
        (DVec3::Z + shear * across.z).extend(0.0),
        DVec4::W,
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use roxmltree::Document;

    fn product(body: &str) -> (DMat4, usize) {
        let text = format!("<node>{body}</node>");
        let document = Document::parse(&text).unwrap();
        let mut notes = Notes::default();
        let xml = Xml::new(&document, &mut notes);
        let matrix = parent_from_node(&xml, &mut notes, xml.root);
        (matrix, notes.finish().len())
    }

    #[test]
    fn up_axes_are_proper_rotations() {
        for up in [UpAxis::X, UpAxis::Y, UpAxis::Z] {
            let matrix = world_from_file(up);
            assert_eq!(matrix.determinant(), 1.0);
            assert_eq!(matrix * matrix.transpose(), DMat4::IDENTITY);
        }
        let p = DVec3::new(1.0, 2.0, 3.0);
        assert_eq!(
            world_from_file(UpAxis::Z).transform_point3(p),
            DVec3::new(-1.0, 3.0, 2.0)
        );
        assert_eq!(
            world_from_file(UpAxis::X).transform_point3(p),
            DVec3::new(2.0, 1.0, -3.0)
        );
    }

    #[test]
    fn transforms_apply_in_document_order() {
        let (matrix, notes) = product(
            "<translate>1 2 3</translate><rotate>0 0 1 90</rotate><scale>2 3 4</scale>\
             <matrix>1 0 0 5  0 1 0 0  0 0 1 0  0 0 0 1</matrix>",
        );
        assert_eq!(notes, 0);
        // x: (0 + 5)·2 along x, turned to y; then moved.
        let p = matrix.transform_point3(DVec3::ZERO);
        assert!((p - DVec3::new(1.0, 12.0, 3.0)).length() < 1e-12, "{p}");
    }

    #[test]
    fn lookat_looks_along_minus_z() {
        let (matrix, _) = product("<lookat>1 2 3  1 2 -5  0 1 0</lookat>");
        let expected = DMat4::from_translation(DVec3::new(1.0, 2.0, 3.0));
        assert!(matrix.abs_diff_eq(expected, 1e-12));
        assert_eq!(product("<lookat>1 2 3  1 2 3  0 1 0</lookat>").1, 1);
        assert_eq!(product("<lookat>0 5 0  0 0 0  0 1 0</lookat>").1, 1);
    }

    #[test]
    fn skew_turns_one_axis_towards_the_other() {
        let (matrix, _) = product("<skew>45  0 1 0  1 0 0</skew>");
        let p = matrix.transform_point3(DVec3::new(0.0, 2.0, 7.0));
        assert!((p - DVec3::new(2.0, 2.0, 7.0)).length() < 1e-12, "{p}");
        let (matrix, _) = product("<skew>30  1 1 0  1 0 0</skew>");
        let turned = matrix.transform_vector3(DVec3::new(1.0, 1.0, 0.0));
        let angle = turned.angle_between(DVec3::new(1.0, 1.0, 0.0));
        assert!((angle - 30_f64.to_radians()).abs() < 1e-12);
        assert_eq!(product("<skew>90  0 1 0  1 0 0</skew>").1, 1);
    }

    #[test]
    fn bad_transforms_are_left_out_and_singular_ones_are_known() {
        assert_eq!(
            product("<matrix>1 2 3</matrix><scale>nan 1 1</scale>"),
            (DMat4::IDENTITY, 2)
        );
        assert!(is_singular(&DMat4::from_scale(DVec3::new(1.0, 0.0, 1.0))));
        assert!(is_singular(&DMat4::ZERO));
        assert!(!is_singular(&DMat4::from_scale(DVec3::new(
            1e-9, 1.0, -1e9
        ))));
        assert!(!is_usable(&DMat4::from_scale(DVec3::splat(1e31))));
    }
}
