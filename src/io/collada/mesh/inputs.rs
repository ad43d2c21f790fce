use roxmltree::Node;

use super::builder::MeshBuilder;
use crate::io::collada::xml::{child, children};
use crate::io::report::Severity;

/// Where a primitive's indices find a corner's position and normal.
#[derive(Clone, Debug)]
pub(super) struct Inputs {
    /// Indices per corner.
    pub(super) stride: usize,
    pub(super) position: Stream,
    pub(super) normal: Option<Stream>,
}

/// A source in the mesh's own lists.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stream {
    /// Place of its index among a corner's indices.
    pub(super) offset: usize,
    /// Where the source starts in the mesh's list.
    pub(super) base: u32,
    /// Elements of the source.
    pub(super) count: u32,
}

/// Resolves the inputs of a primitive through `<vertices>`; `None`, with a note, without positions.
pub(super) fn read_inputs(
    builder: &mut MeshBuilder<'_, '_, '_>,
    mesh: Node<'_, '_>,
    primitive: Node<'_, '_>,
) -> Option<Inputs> {
    let mut stride = 1;
    let (mut position, mut normal, mut vertex_normal) = (None, None, None);
    for input in children(primitive, "input") {
        let offset = input.attribute("offset").unwrap_or("0").trim().parse();
        let Ok(offset @ 0..=255) = offset else {
            let message = "an input's offset is no number below 256; the primitive was left out";
            builder.note(Severity::Warning, input, message);
            return None;
        };
        stride = stride.max(offset + 1);
        match input.attribute("semantic") {
            Some("VERTEX") => {
                let (of_position, of_normal) = read_vertices(builder, mesh, input, offset);
                position = of_position;
                vertex_normal = of_normal;
            }
            Some("POSITION") if position.is_none() => {
                position = builder.position_stream(input, offset);
            }
            Some("NORMAL") => normal = builder.normal_stream(input, offset),
            _ => {}
        }
    }
    let Some(position) = position else {
        let message = "the primitive has no positions; it was left out";
        builder.note(Severity::Warning, primitive, message);
        return None;
    };
    Some(Inputs {
        stride,
        position,
        normal: normal.or(vertex_normal),
    })
}

/// Positions and normals behind a VERTEX input. A dangling reference falls back to the mesh's only
/// `<vertices>`.
fn read_vertices(
    builder: &mut MeshBuilder<'_, '_, '_>,
    mesh: Node<'_, '_>,
    input: Node<'_, '_>,
    offset: usize,
) -> (Option<Stream>, Option<Stream>) {
    let xml = builder.xml;
    let named = input
        .attribute("source")
        .and_then(|reference| xml.find("vertices", reference));
    let Some(vertices) = named.or_else(|| child(mesh, "vertices")) else {
        let message = "VERTEX names no <vertices>; what it describes was left out";
        builder.note(Severity::Warning, input, message);
        return (None, None);
    };
    if named.is_none() {
        let message = "VERTEX names no <vertices>; those of the mesh were taken";
        builder.note(Severity::Guessed, input, message);
    }
    let (mut position, mut normal) = (None, None);
    for input in children(vertices, "input") {
        match input.attribute("semantic") {
            Some("POSITION") => position = builder.position_stream(input, offset),
            Some("NORMAL") => normal = builder.normal_stream(input, offset),
            _ => {}
        }
    }
    (position, normal)
}
