use super::plane::{Plane, kernel, normalize};

/// Section 4.2: width of the feature detectors in degrees.
const FEATURE_WIDTH: f32 = 0.082;
/// Section 4.2: exponent of the feature difference.
const EXPONENT: f32 = 0.5;

/// Section 4.2: the difference of edges and points in each pixel, 0..1, from the achromatic planes
/// of YCxCz.
pub(super) fn feature_difference(test: &Plane, reference: &Plane, pixels_per_degree: f32) -> Plane {
    let detectors = Detectors::new(pixels_per_degree);
    let [test_edges, test_points] = detectors.detect(test);
    let [edges, points] = detectors.detect(reference);
    let edge_difference = test_edges.combine(&edges, |a, b| (a - b).abs());
    let point_difference = test_points.combine(&points, |a, b| (a - b).abs());
    edge_difference.combine(&point_difference, |edge, point| {
        (edge.max(point) * std::f32::consts::FRAC_1_SQRT_2).powf(EXPONENT)
    })
}

/// A Gaussian and its first and second derivative.
struct Detectors {
    smooth: Vec<f32>,
    edge: Vec<f32>,
    point: Vec<f32>,
}

impl Detectors {
    fn new(pixels_per_degree: f32) -> Self {
        let deviation = 0.5 * FEATURE_WIDTH * pixels_per_degree;
        let variance = deviation * deviation;
        let radius = (3.0 * deviation).ceil() as usize;
        let gaussian = |x: f32| (-x * x / (2.0 * variance)).exp();
        Self {
            smooth: normalize(kernel(radius, gaussian)),
            edge: normalize(kernel(radius, |x| -x * gaussian(x))),
            point: normalize(kernel(radius, |x| (x * x / variance - 1.0) * gaussian(x))),
        }
    }

    /// The strength of edges and of points.
    fn detect(&self, achromatic: &Plane) -> [Plane; 2] {
        let lightness = achromatic.with_values(
            achromatic
                .values()
                .iter()
                .map(|y| (y + 16.0) / 116.0)
                .collect(),
        );
        [&self.edge, &self.point].map(|detector| {
            let across = lightness.filter(detector, &self.smooth);
            let down = lightness.filter(&self.smooth, detector);
            across.combine(&down, f32::hypot)
        })
    }
}
