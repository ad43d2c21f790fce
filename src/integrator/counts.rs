use crate::geometry::TraceCounts;

/// Work done by an integrator, summed over paths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PathCounts {
    /// Paths started, one camera ray each; also those that only lend their light to pixels of their
    /// cluster.
    pub camera_rays: u64,
    /// Rays traced for their closest hit, camera rays included.
    pub closest_rays: u64,
    /// Rays traced for any hit.
    pub shadow_rays: u64,
    /// Shadow rays that were not traced because the surface or the light faces away or the
    /// material reflects nothing there.
    pub culled_shadow_rays: u64,
    /// Paths whose radiance was NaN, infinite or negative; they count as black samples.
    pub invalid_samples: u64,
    /// Boxes and primitives tested.
    pub trace: TraceCounts,
}

impl std::ops::AddAssign for PathCounts {
    fn add_assign(&mut self, other: Self) {
        self.camera_rays += other.camera_rays;
        self.closest_rays += other.closest_rays;
        self.shadow_rays += other.shadow_rays;
        self.culled_shadow_rays += other.culled_shadow_rays;
        self.invalid_samples += other.invalid_samples;
        self.trace.rays += other.trace.rays;
        self.trace.box_tests += other.trace.box_tests;
        self.trace.primitive_tests += other.trace.primitive_tests;
    }
}
