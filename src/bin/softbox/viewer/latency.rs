//! How long it takes from a change of the camera to the first picture of it on the screen.

use std::collections::VecDeque;
use std::fmt;
use std::time::{Duration, Instant};

use softbox::camera::Camera;

/// The most measurements, and the most cameras without a picture, that are kept.
const KEPT: usize = 256;

/// The last measurements.
#[derive(Debug, Default)]
pub(super) struct Latency {
    last: Option<Camera>,
    waiting: VecDeque<(Camera, Instant)>,
    measured: VecDeque<Duration>,
}

/// Median and 95th percentile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LatencySummary {
    /// Half of the pictures came within this time.
    median: Duration,
    /// Nineteen of twenty came within this time.
    high: Duration,
}

impl fmt::Display for LatencySummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let milliseconds = |duration: Duration| duration.as_secs_f64() * 1e3;
        let (median, high) = (milliseconds(self.median), milliseconds(self.high));
        write!(f, "{median:.0} ms (95 %: {high:.0} ms)")
    }
}

impl Latency {
    /// Notes which camera is asked for, at the time `now`.
    pub(super) fn ask(&mut self, camera: &Camera, now: Instant) {
        // The first camera waits for its scene too.
        let is_first = self.last.is_none();
        if self.last.replace(*camera) != Some(*camera) && !is_first {
            self.waiting.push_back((*camera, now));
            self.waiting.truncate(KEPT);
        }
    }

    /// Notes that a picture of `camera` is on the screen, at the time `now`. Cameras before it
    /// were passed over and never get one.
    pub(super) fn arrive(&mut self, camera: &Camera, now: Instant) {
        let Some(index) = self.waiting.iter().position(|(asked, _)| asked == camera) else {
            return;
        };
        let since = self.waiting[index].1;
        self.waiting.drain(..=index);
        if self.measured.len() == KEPT {
            self.measured.pop_front();
        }
        self.measured.push_back(now.duration_since(since));
    }

    /// The distribution so far, once there is one.
    pub(super) fn summary(&self) -> Option<LatencySummary> {
        let mut sorted: Vec<Duration> = self.measured.iter().copied().collect();
        sorted.sort_unstable();
        let at = |percent: usize| {
            sorted
                .get((sorted.len().max(1) - 1) * percent / 100)
                .copied()
        };
        Some(LatencySummary {
            median: at(50)?,
            high: at(95)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_first_picture_of_a_camera_counts_and_skipped_ones_never() {
        let start = Instant::now();
        let at = |ms: u64| start + Duration::from_millis(ms);
        let camera = |x: f64| {
            let mut camera = Camera::default();
            camera.eye.x = x;
            camera
        };
        let mut latency = Latency::default();
        latency.ask(&camera(0.0), at(0));
        latency.arrive(&camera(0.0), at(500));
        assert_eq!(latency.summary(), None);
        for (x, ms) in [(1.0, 1000), (2.0, 1010), (2.0, 1015), (3.0, 1020)] {
            latency.ask(&camera(x), at(ms));
        }
        latency.arrive(&camera(2.0), at(1030));
        latency.arrive(&camera(2.0), at(1900));
        latency.arrive(&camera(1.0), at(1900));
        latency.arrive(&camera(3.0), at(1060));
        let summary = latency.summary().unwrap();
        assert_eq!(summary.to_string(), "20 ms (95 %: 20 ms)");
        assert_eq!(latency.measured, [20, 40].map(Duration::from_millis));
    }
}
