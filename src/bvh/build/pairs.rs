use rayon::prelude::*;

use super::primitive::PrimitiveRef;

/// Primitives that one thread looks at at a time; no pair reaches over the ends.
const STRETCH: usize = 4096;

/// Primitives of a pair.
pub(super) const PAIR: usize = 2;

/// Two primitives are a pair if the area of their box is at most this fraction of the sum of their
/// own: 0.5 where both boxes are the same, as of the halves of many quadrilaterals.
///
/// Measured on triangles, before quads were primitives: with 0.75 the bumpy balls of `benches/rays` are
/// not paired; with 0.95 they are built in 0.73 of the time, and the expected cost of a ray grows by 0.1
/// to 2.7 %.
const CLOSE: f32 = 0.95;

/// Pairs are made if there are so many that at most this fraction of the references is left.
const WORTH: f32 = 0.6;

/// Makes one reference of every two primitives with ids in a row that lie close together: triangles
/// of a mesh mostly follow each other as the halves of quadrilaterals. Where they have their vertices
/// in common they are quads before they come here, and few of these are paired again; this is for
/// meshes in which every triangle has vertices of its own. False, and nothing is changed, if there are
/// few.
pub(super) fn pair(refs: &mut Vec<PrimitiveRef>) -> bool {
    let some = refs.chunks(STRETCH).step_by(8);
    let all: usize = some.clone().map(<[_]>::len).sum();
    let left: usize = some.map(|part| pair_up(&mut part.to_vec())).sum();
    if left as f32 > WORTH * all as f32 {
        return false;
    }
    let left: Vec<_> = refs.par_chunks_mut(STRETCH).map(pair_up).collect();
    let mut end = 0;
    for (stretch, left) in left.into_iter().enumerate() {
        let first = stretch * STRETCH;
        refs.copy_within(first..first + left, end);
        end += left;
    }
    refs.truncate(end);
    true
}

/// Moves the pairs and single primitives of a row to its start; returns their number.
fn pair_up(row: &mut [PrimitiveRef]) -> usize {
    let (mut from, mut to) = (0, 0);
    while from < row.len() {
        let mut one = row[from];
        from += 1;
        if let Some(next) = row.get(from)
            && let Some(both) = one.joined(next, CLOSE)
        {
            one = both;
            from += 1;
        }
        row[to] = one;
        to += 1;
    }
    to
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::math::Aabb;

    fn unit(id: u32, x: f32) -> PrimitiveRef {
        let corner = Vec3::X * x;
        PrimitiveRef::new(id, &Aabb::from_points([corner, corner + Vec3::ONE]))
    }

    #[test]
    fn neighbours_in_the_list_and_in_space_are_paired_and_no_others() {
        let places = [(0, 0.0), (1, 0.1), (2, 9.0), (4, 9.0), (5, 9.2), (6, 9.0)];
        let mut refs: Vec<_> = places.iter().map(|&(id, x)| unit(id, x)).collect();
        assert!(!pair(&mut refs) && refs.len() == 6);
        refs.extend((7..100).map(|id| unit(id, (id / 2 * 3 + 50) as f32)));
        let last = 3 * STRETCH as u32 + 1;
        refs.extend((100..last).map(|id| unit(id, (id / 2 * 3 + 50) as f32)));
        assert!(pair(&mut refs));
        let ids: Vec<_> = refs.iter().map(PrimitiveRef::ids).collect();
        assert_eq!(ids[..5], [0..2, 2..3, 4..6, 6..7, 7..8]);
        assert_eq!(ids[5], 8..10);
        let inside = ids.into_iter().flatten();
        assert!(inside.eq((0..last).filter(|id| *id != 3)));
    }
}
