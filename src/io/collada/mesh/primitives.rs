use roxmltree::Node;

use super::builder::MeshBuilder;
use super::faults::Fault;
use super::inputs::{Inputs, read_inputs};
use crate::io::collada::numbers::{BAD_INDEX, indices};
use crate::io::collada::xml::{child, children};
use crate::io::report::Severity;

/// Reads all primitives of a mesh, in the order of the file.
pub(super) fn read_all(builder: &mut MeshBuilder<'_, '_, '_>, mesh: Node<'_, '_>) {
    for primitive in mesh.children().filter(Node::is_element) {
        let name = primitive.tag_name().name();
        match name {
            "triangles" | "polylist" | "polygons" | "tristrips" | "trifans" => {
                read_primitive(builder, mesh, primitive);
            }
            "lines" | "linestrips" => {
                let message = format!("<{name}> have no surface; they were skipped");
                builder.note(Severity::Dropped, primitive, message);
            }
            _ => {}
        }
    }
}

fn read_primitive(
    builder: &mut MeshBuilder<'_, '_, '_>,
    mesh: Node<'_, '_>,
    primitive: Node<'_, '_>,
) {
    if child(primitive, "p").is_none() && child(primitive, "ph").is_none() {
        let is_meant_empty = primitive.attribute("count").is_none_or(|n| n.trim() == "0");
        if !is_meant_empty {
            let message = "the primitive has no <p>, so it has no faces";
            builder.note(Severity::Warning, primitive, message);
        }
        return;
    }
    let Some(inputs) = read_inputs(builder, mesh, primitive) else {
        return;
    };
    if !builder.use_material(primitive.attribute("material")) {
        let message = "the mesh has more than 65,536 material symbols; this primitive was left out";
        builder.note(Severity::Warning, primitive, message);
        return;
    }
    let count = match primitive.tag_name().name() {
        "triangles" => triangles(builder, &inputs, primitive),
        "polylist" => polylist(builder, &inputs, primitive),
        "polygons" => polygons(builder, &inputs, primitive),
        "tristrips" => strips(builder, &inputs, primitive, strip_corners),
        _ => strips(builder, &inputs, primitive, fan_corners),
    };
    builder.end_primitive(primitive);
    let declared = primitive.attribute("count");
    if declared.is_some_and(|declared| declared.trim().parse() != Ok(count)) {
        let declared = declared.unwrap_or_default();
        let message = format!("count says {declared}, the lists give {count}; count was ignored");
        builder.note(Severity::Warning, primitive, message);
    }
}

/// Independent triangles; returns how many there are.
fn triangles(
    builder: &mut MeshBuilder<'_, '_, '_>,
    inputs: &Inputs,
    primitive: Node<'_, '_>,
) -> usize {
    let stride = inputs.stride;
    let mut count = 0;
    for p in children(primitive, "p") {
        let indices = indices(p);
        let faces = indices.chunks_exact(3 * stride);
        if !faces.remainder().is_empty() {
            builder.fault(Fault::CutOff, 1);
        }
        count += faces.len();
        for face in faces {
            let corners = [0, 1, 2].map(|corner| &face[corner * stride..][..stride]);
            builder.add_triangle(inputs, corners);
        }
    }
    count
}

/// Polygons whose sizes `<vcount>` lists; returns how many it lists.
fn polylist(
    builder: &mut MeshBuilder<'_, '_, '_>,
    inputs: &Inputs,
    primitive: Node<'_, '_>,
) -> usize {
    let Some(vcount) = child(primitive, "vcount") else {
        let message = "the <polylist> has no <vcount>; it was read as triangles";
        builder.note(Severity::Guessed, primitive, message);
        return triangles(builder, inputs, primitive);
    };
    let sizes = indices(vcount);
    let indices: Vec<u32> = children(primitive, "p").flat_map(indices).collect();
    let mut rest = indices.as_slice();
    for (done, &size) in sizes.iter().enumerate() {
        let length = (size != BAD_INDEX)
            .then(|| (size as usize).checked_mul(inputs.stride))
            .flatten()
            .filter(|length| *length <= rest.len());
        let Some(length) = length else {
            builder.fault(Fault::CutOff, sizes.len() - done);
            return sizes.len();
        };
        let (face, after) = rest.split_at(length);
        rest = after;
        if size < 3 {
            builder.fault(Fault::TooFewCorners, 1);
        } else {
            builder.add_polygon(inputs, &[face]);
        }
    }
    if !rest.is_empty() {
        let message = format!("{} indices after the last face were ignored", rest.len());
        builder.note(Severity::Warning, primitive, message);
    }
    sizes.len()
}

/// One polygon in each `<p>`, or with holes in each `<ph>`; returns how many there are.
fn polygons(
    builder: &mut MeshBuilder<'_, '_, '_>,
    inputs: &Inputs,
    primitive: Node<'_, '_>,
) -> usize {
    let mut count = 0;
    for element in primitive.children().filter(Node::is_element) {
        let rings: Vec<Vec<u32>> = match element.tag_name().name() {
            "p" => vec![indices(element)],
            "ph" => {
                let outline = child(element, "p").map(indices).unwrap_or_default();
                let holes = children(element, "h").map(indices);
                std::iter::once(outline).chain(holes).collect()
            }
            _ => continue,
        };
        count += 1;
        if rings
            .iter()
            .any(|ring| !ring.len().is_multiple_of(inputs.stride))
        {
            builder.fault(Fault::CutOff, 1);
        } else if rings[0].len() < 3 * inputs.stride {
            builder.fault(Fault::TooFewCorners, 1);
        } else {
            let rings: Vec<&[u32]> = rings.iter().map(Vec::as_slice).collect();
            builder.add_polygon(inputs, &rings);
        }
    }
    count
}

/// Strips or fans, one in each `<p>`; returns how many there are.
fn strips(
    builder: &mut MeshBuilder<'_, '_, '_>,
    inputs: &Inputs,
    primitive: Node<'_, '_>,
    corners_of: fn(usize) -> [usize; 3],
) -> usize {
    let stride = inputs.stride;
    let mut count = 0;
    for p in children(primitive, "p") {
        count += 1;
        let indices = indices(p);
        let corners = indices.len() / stride;
        if corners < 3 {
            builder.fault(Fault::TooFewCorners, 1);
        }
        if !indices.len().is_multiple_of(stride) {
            builder.fault(Fault::CutOff, 1);
        }
        for triangle in 0..corners.saturating_sub(2) {
            let [a, b, c] = corners_of(triangle).map(|at| &indices[at * stride..][..stride]);
            let position = inputs.position.offset;
            // Repeated corners join one strip to the next, they are no fault.
            let is_joint = a[position] == b[position]
                || b[position] == c[position]
                || c[position] == a[position];
            if !is_joint || a[position] == BAD_INDEX {
                builder.add_triangle(inputs, [a, b, c]);
            }
        }
    }
    count
}

/// Corners of a strip's triangle: every second one is turned back.
fn strip_corners(triangle: usize) -> [usize; 3] {
    if triangle.is_multiple_of(2) {
        [triangle, triangle + 1, triangle + 2]
    } else {
        [triangle + 1, triangle, triangle + 2]
    }
}

/// Corners of a fan's triangle: all share the first.
fn fan_corners(triangle: usize) -> [usize; 3] {
    [0, triangle + 1, triangle + 2]
}
