use glam::DVec3;
use roxmltree::Node;

use super::numbers;
use super::xml::{Xml, at_path, child, children};
use crate::io::report::{Notes, Severity};

/// The three-component elements of a `<source>`.
pub(super) struct Source {
    pub(super) vectors: Vec<DVec3>,
}

/// How elements lie in the array.
struct Layout {
    offset: usize,
    stride: usize,
    /// Places of x, y and z within an element.
    components: Vec<usize>,
    declared_count: Option<usize>,
}

/// Reads a source of positions or normals. Numbers that cannot be read become NaN; lengths come
/// from the numbers that are there, never from a count that the file claims.
pub(super) fn read_source(
    xml: &Xml<'_, '_>,
    notes: &mut Notes,
    source: Node<'_, '_>,
) -> Option<Source> {
    let accessor = at_path(source, &["technique_common", "accessor"]);
    let own_array = || {
        child(source, "float_array")
            .or_else(|| child(source, "int_array"))
            .or_else(|| child(source, "double_array"))
    };
    let array = accessor
        .and_then(|accessor| accessor.attribute("source"))
        .and_then(|id| {
            xml.find("float_array", id)
                .or_else(|| xml.find("int_array", id))
        })
        .or_else(own_array);
    let Some(array) = array else {
        xml.note(
            notes,
            Severity::Warning,
            source,
            "the source has no array of numbers; what uses it was left out",
        );
        return None;
    };
    if !xml.may_read(array) {
        let message =
            "the arrays of the file are shared too often; what uses this source was left out";
        xml.note(notes, Severity::Warning, source, message);
        return None;
    }
    let values = numbers::floats(array);
    check_array(xml, notes, array, &values);
    let layout = layout(xml, notes, source, accessor)?;
    let vectors = elements(&values, &layout);
    if let Some(declared) = layout.declared_count
        && declared > vectors.len()
    {
        let message = format!(
            "the accessor claims {declared} elements, the array holds {}; what is there was read",
            vectors.len()
        );
        xml.note(notes, Severity::Warning, source, message);
    }
    Some(Source { vectors })
}

fn check_array(xml: &Xml<'_, '_>, notes: &mut Notes, array: Node<'_, '_>, values: &[f64]) {
    let declared = array.attribute("count");
    if declared.is_some_and(|count| count.trim().parse() != Ok(values.len())) {
        let message = format!(
            "count says {}, there are {} numbers; all were read",
            declared.unwrap_or_default(),
            values.len()
        );
        xml.note(notes, Severity::Warning, array, message);
    }
    let bad = values.iter().filter(|value| !value.is_finite()).count();
    if bad > 0 {
        let message = format!(
            "{bad} numbers are not finite or not readable; faces that use them are dropped"
        );
        xml.note(notes, Severity::Warning, array, message);
    }
}

fn layout(
    xml: &Xml<'_, '_>,
    notes: &mut Notes,
    source: Node<'_, '_>,
    accessor: Option<Node<'_, '_>>,
) -> Option<Layout> {
    let Some(accessor) = accessor else {
        xml.note(
            notes,
            Severity::Guessed,
            source,
            "the source has no accessor; its numbers were read as x y z",
        );
        return Some(Layout {
            offset: 0,
            stride: 3,
            components: vec![0, 1, 2],
            declared_count: None,
        });
    };
    let number = |key| {
        accessor
            .attribute(key)
            .map(|text| text.trim().parse::<usize>())
    };
    let (offset, stride) = (number("offset"), number("stride"));
    let (Ok(offset), Ok(stride @ 1..)) = (offset.unwrap_or(Ok(0)), stride.unwrap_or(Ok(1))) else {
        xml.note(
            notes,
            Severity::Warning,
            accessor,
            "offset or stride is not a count; what uses this source was left out",
        );
        return None;
    };
    let components = components(accessor, stride);
    if components.len() < 3 {
        let message = format!(
            "elements have {} of the three coordinates; the others are 0",
            components.len()
        );
        xml.note(notes, Severity::Warning, accessor, message);
    }
    Some(Layout {
        offset,
        stride,
        components,
        declared_count: number("count").and_then(Result::ok),
    })
}

/// A `<param>` without a name is skipped (COLLADA 1.4.1 specification, `accessor`); without any
/// named parameter the first three numbers count.
fn components(accessor: Node<'_, '_>, stride: usize) -> Vec<usize> {
    let named: Vec<(usize, &str)> = children(accessor, "param")
        .enumerate()
        .filter_map(|(place, param)| Some((place, param.attribute("name")?)))
        .filter(|(place, name)| *place < stride && !name.is_empty())
        .collect();
    let place_of = |axis: &str| {
        let found = named
            .iter()
            .find(|(_, name)| name.eq_ignore_ascii_case(axis));
        found.map(|(place, _)| *place)
    };
    if let (Some(x), Some(y), Some(z)) = (place_of("X"), place_of("Y"), place_of("Z")) {
        return vec![x, y, z];
    }
    if named.is_empty() {
        return (0..stride.min(3)).collect();
    }
    named.iter().map(|(place, _)| *place).take(3).collect()
}

fn elements(values: &[f64], layout: &Layout) -> Vec<DVec3> {
    let values = values.get(layout.offset..).unwrap_or(&[]);
    let needed = 1 + layout.components.iter().max().copied().unwrap_or(0);
    values
        .chunks(layout.stride)
        .filter(|element| element.len() >= needed)
        .map(|element| {
            let mut vector = [0.0; 3];
            for (coordinate, &place) in vector.iter_mut().zip(&layout.components) {
                *coordinate = element[place];
            }
            DVec3::from_array(vector)
        })
        .collect()
}
