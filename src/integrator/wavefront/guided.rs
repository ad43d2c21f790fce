use glam::Vec2;

use super::shade::Group;
use crate::guide::{Guide, Lobes};
use crate::math::{Lanes, ROW, Vec3Array, Vec3Lanes, set_bits};

/// Where the paths of a group aim some of their rays.
#[derive(Debug)]
pub(super) struct GuidedLanes<'s> {
    lobes: [Option<&'s Lobes>; ROW],
    /// A bit for each path that does.
    lanes: u32,
    /// The share of rays that is aimed, 0 in other lanes.
    share: [f32; ROW],
    points: Vec3Array,
}

impl<'s> GuidedLanes<'s> {
    /// What `guide` has for the surfaces of `group`; `None` when it has nothing.
    #[inline(always)]
    pub(super) fn look_up<L: Lanes>(guide: &'s Guide, group: &Group<'_, L>) -> Option<Self> {
        let normals = group.lit_normal().store();
        let mut found = Self {
            lobes: [None; ROW],
            lanes: 0,
            share: [0.0; ROW],
            points: group.surface.point.store(),
        };
        for lane in set_bits(group.lanes) {
            let lobes = guide.at(found.points.get(lane), normals.get(lane));
            found.lobes[lane] = lobes;
            if let Some(lobes) = lobes {
                found.lanes |= 1 << lane;
                found.share[lane] = lobes.share();
            }
        }
        (found.lanes != 0).then_some(found)
    }

    /// The lanes that have lobes, with them.
    #[inline(always)]
    fn each(&self) -> impl Iterator<Item = (usize, &'s Lobes)> + '_ {
        set_bits(self.lanes).filter_map(|lane| Some((lane, self.lobes[lane]?)))
    }

    /// Cosines to the shading normals and directions of the scattered rays: those `scattered` by the
    /// material, and the aimed ones in the lanes that `u_lobe` picks for that.
    #[inline(always)]
    pub(super) fn aim<L: Lanes>(
        &self,
        group: &Group<'_, L>,
        u_lobe: L,
        u: [L; 2],
        scattered: (L, Vec3Lanes<L>),
    ) -> (L, Vec3Lanes<L>) {
        let aimed = L::bits(u_lobe.lt(L::load_row(&self.share))) & self.lanes;
        if aimed == 0 {
            return scattered;
        }
        let (u_lobe, [x, y]) = (u_lobe.to_array(), u.map(L::to_array));
        let mut towards = scattered.1.store();
        for (lane, lobes) in self.each().filter(|(lane, _)| aimed >> lane & 1 == 1) {
            let u = (u_lobe[lane] / lobes.share(), Vec2::new(x[lane], y[lane]));
            towards.set(lane, lobes.sample(self.points.get(lane), u.0, u.1));
        }
        let towards = Vec3Lanes::load(&towards);
        let z = group.surface.shading_normal.dot(towards);
        (L::select(L::mask_of_bits(aimed), z, scattered.0), towards)
    }
}

impl<L: Lanes> Group<'_, L> {
    /// The densities with which the vertices scatter into `wi`, the unguided ones with `cosine`.
    #[inline(always)]
    pub(super) fn scatter_pdf(&self, cosine: L, wi: &Vec3Array) -> L {
        let Some(guided) = &self.guided else {
            return cosine;
        };
        let mut aimed = [0.0; ROW];
        for (lane, lobes) in guided.each() {
            aimed[lane] = lobes.pdf(guided.points.get(lane), wi.get(lane));
        }
        let share = L::load_row(&guided.share);
        (L::splat(1.0) - share) * cosine + share * L::load_row(&aimed)
    }
}
