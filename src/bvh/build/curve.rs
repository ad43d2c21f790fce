use glam::{UVec3, Vec4, Vec4Swizzles};

use super::primitive::Bounds;

/// Bits of a cell's number on each axis.
const BITS: u32 = 21;

/// Numbers places along a curve that fills a box: what is near on the curve is near in space.
#[derive(Clone, Copy, Debug)]
pub(super) struct Curve {
    origin: Vec4,
    scale: f32,
}

impl Curve {
    /// A curve through a cube around `bounds`.
    pub(super) fn through(bounds: &Bounds) -> Self {
        let cells = (1_u32 << BITS) as f32;
        let scale = cells / (bounds.max - bounds.min).xyz().max_element();
        // Too small or too large an extent to divide: all in one cell.
        let is_usable = scale.is_finite() && scale > 0.0;
        Self {
            origin: bounds.min,
            scale: if is_usable { scale } else { 0.0 },
        }
    }

    /// The number of the cell of a place in the box, below 2⁶³.
    #[inline(always)]
    pub(super) fn number(&self, place: Vec4) -> u64 {
        let last = (1_u32 << BITS) as f32 - 1.0;
        let at = ((place - self.origin) * self.scale).xyz();
        interleaved(
            at.clamp(glam::Vec3::ZERO, glam::Vec3::splat(last))
                .as_uvec3(),
        )
    }
}

/// Bits of the three numbers by turns, x the highest: the Morton code.
fn interleaved(cell: UVec3) -> u64 {
    spread(cell.x) << 2 | spread(cell.y) << 1 | spread(cell.z)
}

/// Two zeros between each two of the lowest 21 bits.
fn spread(bits: u32) -> u64 {
    let mut x = u64::from(bits) & 0x1f_ffff;
    x = (x | x << 32) & 0x1f_0000_0000_ffff;
    x = (x | x << 16) & 0x1f_0000_ff00_00ff;
    x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
    x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
    (x | x << 2) & 0x1249_2492_4924_9249
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    fn curve(min: Vec3, max: Vec3) -> Curve {
        Curve::through(&Bounds {
            min: min.extend(0.0),
            max: max.extend(0.0),
        })
    }

    #[test]
    fn the_number_has_the_bits_of_the_cell_by_turns() {
        let cells = (1 << BITS) as f32;
        let curve = curve(Vec3::ZERO, Vec3::splat(cells));
        for bit in 0..BITS {
            let far = (1_u32 << bit) as f32 + 0.5;
            let number = |place: Vec3| curve.number(place.extend(9.0));
            assert_eq!(number(Vec3::new(0.5, 0.5, far)), 1 << (3 * bit));
            assert_eq!(number(Vec3::new(0.5, far, 0.5)), 2 << (3 * bit));
            assert_eq!(number(Vec3::new(far, 0.5, 0.5)), 4 << (3 * bit));
        }
        let all = curve.number(Vec4::splat(cells));
        assert_eq!(
            all,
            (1 << (3 * BITS)) - 1,
            "the far corner is in the last cell"
        );
    }

    #[test]
    fn boxes_too_small_or_too_large_to_divide_have_one_cell() {
        for (min, max) in [
            (Vec3::ONE, Vec3::ONE),
            (Vec3::ZERO, Vec3::splat(1e-40)),
            (Vec3::splat(-3e38), Vec3::splat(3e38)),
        ] {
            let curve = curve(min, max);
            assert_eq!(curve.number(max.extend(0.0)), 0);
        }
    }
}
