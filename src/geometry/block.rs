use glam::{Vec3, Vec4};

use super::Shapes;
use crate::bvh::{BLOCK, NO_PRIMITIVE};
use crate::math::Aabb;

/// Four primitives of a leaf side by side.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct Block {
    /// Per vertex and axis, one lane per triangle; NaN in lanes without a triangle, which nothing
    /// can hit.
    corners: [[[f32; BLOCK]; 3]; 3],
    /// Ids, [`NO_PRIMITIVE`] in empty lanes; the first with [`MORE`] and [`SPHERES`].
    ids: [u32; BLOCK],
}

/// Bit of a block's first id: the leaf goes on in the next block.
const MORE: u32 = 1 << 31;
/// Bit of a block's first id: some lanes hold spheres.
const SPHERES: u32 = 1 << 30;

/// Ids must be smaller than this.
pub(super) const ID_LIMIT: u32 = SPHERES - 1;

/// What is in an empty lane, without the bits.
const NOTHING: u32 = NO_PRIMITIVE & !(MORE | SPHERES);

impl Block {
    /// The primitives `ids` of `shapes`; `more` if the leaf goes on.
    pub(super) fn new(shapes: &Shapes, ids: &[u32; BLOCK], more: bool) -> Self {
        let mut corners = [[[f32::NAN; BLOCK]; 3]; 3];
        let mut flags = if more { MORE } else { 0 };
        for (lane, &id) in ids.iter().enumerate() {
            if id == NO_PRIMITIVE {
                continue;
            }
            if id as usize >= shapes.triangles.len() {
                flags |= SPHERES;
                continue;
            }
            let vertices = shapes.vertices(id as usize);
            for (corner, vertex) in corners.iter_mut().zip(vertices) {
                for (axis, value) in corner.iter_mut().zip(vertex.to_array()) {
                    axis[lane] = value;
                }
            }
        }
        let mut ids = ids.map(|id| id & NOTHING);
        ids[0] |= flags;
        Self { corners, ids }
    }

    /// Makes the same block of shapes that have moved; returns their boxes, empty of those that
    /// nothing can hit.
    pub(super) fn renew(
        &mut self,
        shapes: &Shapes,
        bounds: &impl Fn(u32) -> Aabb,
    ) -> [Aabb; BLOCK] {
        let ids = [0, 1, 2, 3].map(|lane| match self.id(lane) {
            NOTHING => NO_PRIMITIVE,
            id => id,
        });
        *self = Self::new(shapes, &ids, self.has_more());
        let mut all = [Aabb::EMPTY; BLOCK];
        for (lane, id) in ids
            .into_iter()
            .enumerate()
            .filter(|(_, id)| *id != NO_PRIMITIVE)
        {
            let own = bounds(id);
            if own.is_empty() {
                let axes = self.corners.iter_mut().flatten();
                axes.for_each(|axis| axis[lane] = f32::NAN);
            }
            all[lane] = own;
        }
        all
    }

    /// Coordinate `axis` of vertex `corner` of all triangles.
    #[inline(always)]
    pub(super) fn coordinate(&self, corner: usize, axis: usize) -> Vec4 {
        Vec4::from_array(self.corners[corner][axis])
    }

    /// Normals of all triangles, not of unit length, in the order of `axes`, an even permutation.
    #[inline(always)]
    pub(super) fn normals(&self, axes: [u8; 3]) -> [Vec4; 3] {
        let edge = |corner: usize, axis: u8| {
            let axis = usize::from(axis);
            self.coordinate(corner, axis) - self.coordinate(0, axis)
        };
        let [x, y, z] = axes;
        let (ax, ay, az) = (edge(1, x), edge(1, y), edge(1, z));
        let (bx, by, bz) = (edge(2, x), edge(2, y), edge(2, z));
        [ay * bz - by * az, az * bx - bz * ax, ax * by - bx * ay]
    }

    /// Minimum and maximum per axis of all triangles.
    #[inline(always)]
    pub(super) fn bounds(&self) -> [[Vec4; 2]; 3] {
        let axis = |axis: usize| {
            let a = self.coordinate(0, axis);
            let b = self.coordinate(1, axis);
            let c = self.coordinate(2, axis);
            [a.min(b).min(c), a.max(b).max(c)]
        };
        [axis(0), axis(1), axis(2)]
    }

    /// The vertices of the triangle in `lane`.
    pub(super) fn vertices(&self, lane: usize) -> [Vec3; 3] {
        self.corners
            .map(|corner| Vec3::from_array(corner.map(|axis| axis[lane])))
    }

    /// The primitive in `lane`.
    #[inline(always)]
    pub(super) fn id(&self, lane: usize) -> u32 {
        self.ids[lane] & NOTHING
    }

    /// Lanes in use; the others lie behind them.
    #[inline(always)]
    pub(super) fn len(&self) -> usize {
        let mut len = BLOCK;
        while len > 0 && self.id(len - 1) == NOTHING {
            len -= 1;
        }
        len
    }

    /// The primitives.
    pub(super) fn ids(&self) -> impl Iterator<Item = u32> + '_ {
        (0..BLOCK)
            .map(|lane| self.id(lane))
            .filter(|&id| id != NOTHING)
    }

    /// True for most blocks: no spheres, and the last of its leaf.
    #[inline(always)]
    pub(super) fn is_plain(&self) -> bool {
        self.ids[0] < SPHERES
    }

    /// True if the leaf goes on in the next block.
    pub(super) fn has_more(&self) -> bool {
        self.ids[0] & MORE != 0
    }

    /// True if some lanes hold spheres.
    pub(super) fn has_spheres(&self) -> bool {
        self.ids[0] & SPHERES != 0
    }
}
