use glam::Vec3;

/// Shadow rays span the whole segment to the light; they stop this fraction of the way along it.
///
/// One minus 2⁻¹⁶: far enough to miss the emitter itself when both ends are offset, near enough
/// that a blocker at a ten-thousandth of the distance in front of the light is still seen.
pub const SHADOW_T_MAX: f32 = 1.0 - 1.0 / 65_536.0;

/// The bound γₙ = nε/(1−nε) of the relative error of `n` rounded f32 operations.
///
/// Higham 2002, "Accuracy and Stability of Numerical Algorithms", section 3.1.
pub const fn gamma(n: u32) -> f32 {
    let ne = n as f32 * (f32::EPSILON * 0.5);
    ne / (1.0 - ne)
}

/// Moves `point` off its surface, to the side of `direction`, so that a ray from there cannot meet
/// the surface again.
///
/// `error` bounds the absolute rounding error of each coordinate of `point`; `normal` is the unit
/// geometric normal. The result lies beyond the error box, one ulp further outward.
/// Pharr, Jakob, Humphreys 2016, "Physically Based Rendering", section 3.9.5.
pub fn offset_origin(point: Vec3, error: Vec3, normal: Vec3, direction: Vec3) -> Vec3 {
    let distance = normal.abs().dot(error);
    let side = if direction.dot(normal) < 0.0 {
        -1.0
    } else {
        1.0
    };
    let offset = normal * (distance * side);
    let moved = point + offset;
    Vec3::new(
        outward(moved.x, offset.x),
        outward(moved.y, offset.y),
        outward(moved.z, offset.z),
    )
}

/// The finite `value`'s neighbour in the direction of `offset`, without a branch.
#[inline(always)]
fn outward(value: f32, offset: f32) -> f32 {
    let step = i32::from(offset > 0.0) - i32::from(offset < 0.0);
    let bits = value.to_bits().cast_signed();
    // The bits of negative numbers grow downwards.
    let sign = 1 | (bits >> 31);
    let moved = f32::from_bits(bits.wrapping_add(step * sign).cast_unsigned());
    let from_zero = f32::from_bits(1).copysign(offset);
    match (value == 0.0, step == 0) {
        (_, true) => value,
        (true, _) => from_zero,
        _ => moved,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outward_is_the_next_number() {
        for value in [
            0.0,
            -0.0,
            1.0,
            -1.0,
            f32::MIN_POSITIVE,
            -1e-40,
            1e-45,
            3e38,
            -1e-45,
        ] {
            assert_eq!(outward(value, 0.0).to_bits(), value.to_bits());
            assert_eq!(outward(value, 0.5), value.next_up());
            assert_eq!(outward(value, -0.5), value.next_down());
        }
    }

    #[test]
    fn the_origin_leaves_the_error_box_on_the_side_of_the_direction() {
        let p = Vec3::new(1.0, 2.0, 3.0);
        let e = Vec3::splat(gamma(7) * 3.0);
        let n = Vec3::new(0.6, 0.0, 0.8);
        assert!((offset_origin(p, e, n, n) - p).dot(n) > 0.0);
        assert!((offset_origin(p, e, n, -n) - p).dot(n) < 0.0);
    }
}
