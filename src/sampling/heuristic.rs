/// The weight of a sample drawn with density `pdf_a` that strategy b could have drawn with density
/// `pdf_b`: `pdf_a² / (pdf_a² + pdf_b²)`.
///
/// Both densities are in the same measure, not negative, and may be infinite; the result is in
/// 0..=1, and 0 when `pdf_a` is 0. Veach and Guibas 1995, "Optimally Combining Sampling Techniques
/// for Monte Carlo Rendering", equation 16 with β = 2.
pub fn power_heuristic(pdf_a: f32, pdf_b: f32) -> f32 {
    if pdf_a.is_nan() || pdf_a <= 0.0 {
        return 0.0;
    }
    if pdf_a.is_infinite() {
        return if pdf_b.is_infinite() { 0.5 } else { 1.0 };
    }
    // The ratio first: the squares alone would overflow or vanish.
    let ratio = pdf_b / pdf_a;
    1.0 / (1.0 + ratio * ratio)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_of_both_strategies_add_to_one_over_the_whole_range() {
        let values = [0.0, 1e-38, 1e-20, 0.1, 1.0, 7.0, 1e20, 1e38, f32::INFINITY];
        for a in values {
            for b in values {
                let (wa, wb) = (power_heuristic(a, b), power_heuristic(b, a));
                assert!((0.0..=1.0).contains(&wa), "{a} {b}: {wa}");
                if a > 0.0 || b > 0.0 {
                    assert!((wa + wb - 1.0).abs() < 1e-6, "{a} {b}: {wa} + {wb}");
                }
            }
        }
        assert_eq!(power_heuristic(3.0, 1.0), 0.9);
        assert_eq!(power_heuristic(f32::NAN, 1.0), 0.0);
    }
}
