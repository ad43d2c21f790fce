use roxmltree::Node;

use crate::io::collada::xml::Xml;
use crate::io::report::{Notes, Severity};

/// What can be wrong with a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fault {
    BadIndex,
    BadNumber,
    TooFewCorners,
    CutOff,
    NoArea,
    SelfCrossing,
    TooComplex,
    BadNormal,
}

impl Fault {
    const ALL: [Self; 8] = [
        Self::BadIndex,
        Self::BadNumber,
        Self::TooFewCorners,
        Self::CutOff,
        Self::NoArea,
        Self::SelfCrossing,
        Self::TooComplex,
        Self::BadNormal,
    ];

    fn message(self) -> &'static str {
        match self {
            Self::BadIndex => "faces with an index that no vertex has were dropped",
            Self::BadNumber => {
                "faces with a coordinate that is not finite, unreadable or beyond 1e30 were dropped"
            }
            Self::TooFewCorners => "faces with fewer than three corners were dropped",
            Self::CutOff => "faces were dropped because the list of indices ends before them",
            Self::NoArea => "faces without area were dropped",
            Self::SelfCrossing => {
                "polygons cross themselves or have a hole outside; their triangles are a guess"
            }
            Self::TooComplex => "polygons have too many corners to be cut well; they became fans",
            Self::BadNormal => "corners have no usable normal; the surface's own is taken there",
        }
    }

    fn severity(self) -> Severity {
        match self {
            Self::NoArea | Self::TooFewCorners => Severity::Dropped,
            _ => Severity::Warning,
        }
    }
}

/// How often each fault was met in one primitive.
#[derive(Debug, Default)]
pub(super) struct Faults([usize; Fault::ALL.len()]);

impl Faults {
    pub(super) fn add(&mut self, fault: Fault, count: usize) {
        self.0[fault as usize] += count;
    }

    /// One note for each fault that was met.
    pub(super) fn report(self, xml: &Xml<'_, '_>, notes: &mut Notes, primitive: Node<'_, '_>) {
        for fault in Fault::ALL {
            let count = self.0[fault as usize];
            if count > 0 {
                let message = format!("{count} {}", fault.message());
                xml.note(notes, fault.severity(), primitive, message);
            }
        }
    }
}
