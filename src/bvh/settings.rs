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

/// How much work goes into a [`BvhKind::Sah`] hierarchy. Never changes the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum BvhQuality {
    /// For edits and very large scenes: built in about half the time, for some 15 % more work per
    /// ray. Leaves hold at most one block of four.
    Fast,
    /// The full search.
    Standard,
    /// [`Self::Standard`] first; a session then makes the tree better while its picture renders.
    #[default]
    High,
}

/// Choices of the BVH build. Missing fields of stored settings take their defaults.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(default)]
pub struct BvhSettings {
    /// The split rule.
    pub kind: BvhKind,
    /// Most primitives in one leaf, 1 to 255. Two triangles that share an edge may be one.
    pub leaf_size: u32,
    /// The effort.
    pub quality: BvhQuality,
}

impl Default for BvhSettings {
    fn default() -> Self {
        Self {
            kind: BvhKind::Sah,
            leaf_size: 4,
            quality: BvhQuality::High,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_stored_before_there_was_a_quality_are_read() {
        let old: BvhSettings = serde_json::from_str(r#"{"kind":"median","leaf_size":7}"#).unwrap();
        let expected = BvhSettings {
            kind: BvhKind::Median,
            leaf_size: 7,
            quality: BvhQuality::High,
        };
        assert_eq!(old, expected);
        let text = serde_json::to_string(&expected).unwrap();
        assert!(text.contains(r#""quality":"high""#), "{text}");
    }
}
