use serde::{Deserialize, Serialize};

/// How much work goes into the tree; the hits are the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum BvhQuality {
    /// Built with the surface-area heuristic from the top.
    #[default]
    Standard,
    /// Rebuilt piece by piece until rays are expected to gain no more; built longest.
    High,
}
