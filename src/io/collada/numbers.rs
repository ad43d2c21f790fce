use glam::{DMat4, DVec3};
use roxmltree::Node;

use crate::color::Rgb;

/// The words of an element's own text, comments between them skipped.
pub(super) fn words<'a>(node: Node<'a, '_>) -> impl Iterator<Item = &'a str> {
    node.children()
        .filter(Node::is_text)
        .filter_map(|text| text.text())
        .flat_map(str::split_ascii_whitespace)
}

/// All numbers of an element; a word that is no number becomes NaN, so that later ones keep their
/// places.
pub(super) fn floats(node: Node<'_, '_>) -> Vec<f64> {
    words(node)
        .map(|word| word.parse().unwrap_or(f64::NAN))
        .collect()
}

/// The index that no vertex can have: stands for negative, huge and unreadable indices.
pub(super) const BAD_INDEX: u32 = u32::MAX;

/// All indices of an element; what is no index becomes [`BAD_INDEX`].
pub(super) fn indices(node: Node<'_, '_>) -> Vec<u32> {
    words(node)
        .map(|word| word.parse().unwrap_or(BAD_INDEX))
        .collect()
}

/// The first number of an element, when there is one and it is finite.
pub(super) fn scalar(node: Node<'_, '_>) -> Option<f64> {
    words(node)
        .next()
        .and_then(|word| word.parse().ok())
        .filter(|value: &f64| value.is_finite())
}

/// The first `N` numbers of an element; `None` when there are fewer or one is not finite.
pub(super) fn array<const N: usize>(node: Node<'_, '_>) -> Option<[f64; N]> {
    let mut found = [0.0_f64; N];
    let mut words = words(node);
    for value in &mut found {
        *value = words.next()?.parse().ok()?;
    }
    found.iter().all(|value| value.is_finite()).then_some(found)
}

/// Three numbers as a vector.
pub(super) fn vector(node: Node<'_, '_>) -> Option<DVec3> {
    array::<3>(node).map(DVec3::from_array)
}

/// Three numbers, or one for all channels, as a colour; alpha is ignored.
pub(super) fn rgb(node: Node<'_, '_>) -> Option<Rgb> {
    if words(node).nth(1).is_none() {
        return scalar(node).map(|grey| Rgb::splat(grey as f32));
    }
    array::<3>(node)
        .map(|[r, g, b]| Rgb::new(r as f32, g as f32, b as f32))
        .filter(|color| color.is_finite())
}

/// Sixteen numbers, row by row, as a matrix for column vectors.
pub(super) fn matrix(node: Node<'_, '_>) -> Option<DMat4> {
    array::<16>(node).map(|rows| DMat4::from_cols_array(&rows).transpose())
}
