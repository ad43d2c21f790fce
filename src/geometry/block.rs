use glam::Vec3;

use super::Shapes;
use super::quads::LeafPrimitive;
use crate::bvh::BLOCK;
use crate::math::{Aabb, LANES, Lanes};

/// Triangles of a block: the first of each of its primitives, then the second ones.
pub(super) const TRIANGLES: usize = 2 * BLOCK;

const _: () = assert!(TRIANGLES == LANES, "a triangle for each lane");

/// Four primitives of a leaf side by side: quads, triangles and spheres.
///
/// The triangles of a quad are `a b c` and `a c d`. Coordinates that nothing stands for are NaN,
/// which nothing can hit.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct Block {
    axes: [Coordinates; 3],
    /// Ids by triangle, [`NOTHING`] where there is none; a sphere has the place of a first triangle.
    /// The first with [`MORE`] and [`SPHERES`].
    ids: [u32; TRIANGLES],
}

/// The vertices along one axis.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct Coordinates {
    /// Of both triangles of a primitive: `a` by primitive, then `c`.
    shared: [[f32; BLOCK]; 2],
    /// `b`, then `d`: by triangle.
    own: [f32; TRIANGLES],
}

/// One of the vertices of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Corner {
    /// The first of both triangles of a quad.
    A,
    /// The other one that they share.
    C,
    /// The one that they do not share.
    Own,
}

/// Bit of a block's first id: the leaf goes on in the next block.
const MORE: u32 = 1 << 31;
/// Bit of a block's first id: some primitives are spheres.
const SPHERES: u32 = 1 << 30;

/// Ids must be smaller than this.
pub(super) const ID_LIMIT: u32 = SPHERES - 1;

/// What is in the place of an id where there is none, without the bits.
const NOTHING: u32 = ID_LIMIT;

impl Block {
    /// `primitives` of `shapes`, as many as there are; `more` if the leaf goes on.
    pub(super) fn new(
        shapes: &Shapes,
        primitives: [Option<LeafPrimitive>; BLOCK],
        more: bool,
    ) -> Self {
        let nothing = Coordinates {
            shared: [[f32::NAN; BLOCK]; 2],
            own: [f32::NAN; TRIANGLES],
        };
        let mut block = Self {
            axes: [nothing; 3],
            ids: [NOTHING; TRIANGLES],
        };
        let mut flags = if more { MORE } else { 0 };
        for (place, primitive) in primitives.into_iter().enumerate() {
            let Some(primitive) = primitive else { continue };
            let id = primitive.first();
            block.ids[place] = id;
            if id as usize >= shapes.triangles.len() {
                flags |= SPHERES;
                continue;
            }
            let [a, b, c] = shapes.vertices(id as usize);
            let d = primitive.second().map(|second| {
                block.ids[BLOCK + place] = second;
                shapes.vertices(second as usize)[2]
            });
            for (axis, to) in block.axes.iter_mut().enumerate() {
                to.shared[0][place] = a[axis];
                to.shared[1][place] = c[axis];
                to.own[place] = b[axis];
                to.own[BLOCK + place] = d.map_or(f32::NAN, |d| d[axis]);
            }
        }
        block.ids[0] |= flags;
        block
    }

    /// Makes the same block of shapes that have moved; returns the boxes of its primitives, empty of
    /// those that nothing can hit.
    pub(super) fn renew(
        &mut self,
        shapes: &Shapes,
        bounds: &impl Fn(u32) -> Aabb,
    ) -> [Aabb; BLOCK] {
        let id = |triangle| Some(self.id(triangle)).filter(|&id| id != NOTHING);
        let primitives = [0, 1, 2, 3]
            .map(|place| id(place).map(|first| LeafPrimitive::new(first, id(BLOCK + place))));
        *self = Self::new(shapes, primitives, self.has_more());
        let mut all = [Aabb::EMPTY; BLOCK];
        for triangle in 0..TRIANGLES {
            let id = self.id(triangle);
            if id == NOTHING {
                continue;
            }
            let own = bounds(id);
            if own.is_empty() {
                self.axes
                    .iter_mut()
                    .for_each(|axis| axis.own[triangle] = f32::NAN);
            }
            let all = &mut all[triangle % BLOCK];
            *all = all.union(own);
        }
        all
    }

    /// Coordinate `axis` of a vertex of all triangles.
    #[inline(always)]
    pub(super) fn coordinate<V: Lanes>(&self, corner: Corner, axis: u8) -> V {
        let axis = &self.axes[usize::from(axis)];
        match corner {
            Corner::A => V::repeat(&axis.shared[0]),
            Corner::C => V::repeat(&axis.shared[1]),
            Corner::Own => V::load(&axis.own),
        }
    }

    /// Coordinate `axis` of the vertices that triangles share: `a` of the four primitives, then `c`.
    #[inline(always)]
    pub(super) fn both_corners<V: Lanes>(&self, axis: u8) -> V {
        let shared = self.axes[usize::from(axis)].shared.as_flattened();
        V::load(shared.first_chunk().expect("eight numbers"))
    }

    /// Normals of all triangles, not of unit length, in the order of `axes`, an even permutation.
    #[inline(always)]
    pub(super) fn normals<V: Lanes>(&self, axes: [u8; 3]) -> [V; 3] {
        let edges = |axis: u8| {
            let a = self.coordinate::<V>(Corner::A, axis);
            let c = self.coordinate::<V>(Corner::C, axis) - a;
            let own = self.coordinate::<V>(Corner::Own, axis) - a;
            (V::alternate(own, c), V::alternate(c, own))
        };
        let [x, y, z] = axes;
        let ((ax, bx), (ay, by), (az, bz)) = (edges(x), edges(y), edges(z));
        [ay * bz - by * az, az * bx - bz * ax, ax * by - bx * ay]
    }

    /// Minimum and maximum per axis of all triangles.
    #[inline(always)]
    pub(super) fn bounds<V: Lanes>(&self) -> [[V; 2]; 3] {
        let axis = |axis: u8| {
            let a = self.coordinate::<V>(Corner::A, axis);
            let c = self.coordinate::<V>(Corner::C, axis);
            let own = self.coordinate::<V>(Corner::Own, axis);
            [own.min(a).min(c), own.max(a).max(c)]
        };
        [axis(0), axis(1), axis(2)]
    }

    /// The vertices of a triangle.
    pub(super) fn vertices(&self, triangle: usize) -> [Vec3; 3] {
        let place = triangle % BLOCK;
        let of =
            |pick: &dyn Fn(&Coordinates) -> f32| Vec3::from_array(self.axes.each_ref().map(pick));
        let (a, c) = (
            of(&|axis| axis.shared[0][place]),
            of(&|axis| axis.shared[1][place]),
        );
        let own = of(&|axis| axis.own[triangle]);
        if triangle < BLOCK {
            [a, own, c]
        } else {
            [a, c, own]
        }
    }

    /// The shape that is `triangle`, or the sphere in its place.
    #[inline(always)]
    pub(super) fn id(&self, triangle: usize) -> u32 {
        self.ids[triangle] & NOTHING
    }

    /// Whether the primitive in `place` has a second triangle.
    #[inline(always)]
    pub(super) fn is_quad(&self, place: usize) -> bool {
        self.ids[BLOCK + place] != NOTHING
    }

    /// Primitives; the places behind them are empty.
    #[inline(always)]
    pub(super) fn len(&self) -> usize {
        let mut len = BLOCK;
        while len > 0 && self.id(len - 1) == NOTHING {
            len -= 1;
        }
        len
    }

    /// The shapes.
    pub(super) fn ids(&self) -> impl Iterator<Item = u32> + '_ {
        (0..BLOCK).flat_map(|place| self.ids_of(place))
    }

    /// The shapes that the primitive in `place` consists of.
    pub(super) fn ids_of(&self, place: usize) -> impl Iterator<Item = u32> + '_ {
        let ids = [self.id(place), self.id(BLOCK + place)];
        ids.into_iter().filter(|&id| id != NOTHING)
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

    /// True if some primitives are spheres.
    pub(super) fn has_spheres(&self) -> bool {
        self.ids[0] & SPHERES != 0
    }
}
