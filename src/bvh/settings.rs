use serde::{Deserialize, Serialize};

/// How the BVH is built; the course compares these.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum BvhKind {
    /// No hierarchy: every ray meets every primitive.
    None,
    /// Split at the median centroid of the longest axis.
    Median,
    /// Binned surface-area heuristic on all three axes.
    #[default]
    Sah,
}

/// Choices of the BVH build.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct BvhSettings {
    /// The split rule.
    pub kind: BvhKind,
    /// Most primitives in one leaf, 1 to 255.
    pub leaf_size: u32,
}

impl Default for BvhSettings {
    fn default() -> Self {
        Self {
            kind: BvhKind::Sah,
            leaf_size: 4,
        }
    }
}
