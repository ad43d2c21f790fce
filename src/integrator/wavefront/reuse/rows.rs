use super::super::super::reuse::{Receiver, SharedVertex};
use super::NONE;
use crate::math::{IntLanes, Lanes, ROW, Vec3Array, Vec3Lanes};

/// [`Receiver`]s of one member of the clusters of a row.
#[derive(Clone, Debug)]
pub(super) struct ReceiverRow {
    point: Vec3Array,
    departure: Vec3Array,
    error: Vec3Array,
    geometric_normal: Vec3Array,
    shading_normal: Vec3Array,
    factor: Vec3Array,
    /// [`NONE`] where there is none.
    bounce: [u32; ROW],
}

/// The same in registers.
#[derive(Clone, Copy, Debug)]
pub(super) struct ReceiverLanes<L: Lanes> {
    pub(super) point: Vec3Lanes<L>,
    pub(super) departure: Vec3Lanes<L>,
    pub(super) error: Vec3Lanes<L>,
    pub(super) geometric_normal: Vec3Lanes<L>,
    pub(super) shading_normal: Vec3Lanes<L>,
    pub(super) bounce: L::Ints,
}

/// [`SharedVertex`]es of one member of the clusters of a row.
#[derive(Clone, Debug)]
pub(super) struct SharedRow {
    place: Vec3Array,
    error: Vec3Array,
    geometric_normal: Vec3Array,
    shading_normal: Vec3Array,
    /// Bounces before the receiver that it was met from.
    bounce: [u32; ROW],
    /// A bit for each lane that has one.
    pub(super) lanes: u32,
    /// Those of the sky.
    pub(super) infinite: u32,
}

/// The same in registers.
#[derive(Clone, Copy, Debug)]
pub(super) struct SharedLanes<L: Lanes> {
    pub(super) place: Vec3Lanes<L>,
    pub(super) error: Vec3Lanes<L>,
    pub(super) geometric_normal: Vec3Lanes<L>,
    pub(super) shading_normal: Vec3Lanes<L>,
    pub(super) bounce: L::Ints,
    pub(super) infinite: u32,
}

impl ReceiverRow {
    pub(super) const NONE: Self = Self {
        point: Vec3Array::ZERO,
        departure: Vec3Array::ZERO,
        error: Vec3Array::ZERO,
        geometric_normal: Vec3Array::ZERO,
        shading_normal: Vec3Array::ZERO,
        factor: Vec3Array::ZERO,
        bounce: [NONE; ROW],
    };

    pub(super) fn clear(&mut self) {
        self.bounce = [NONE; ROW];
    }

    #[inline(always)]
    pub(super) fn set(&mut self, lane: usize, receiver: &Receiver) {
        self.point.set(lane, receiver.point);
        self.departure.set(lane, receiver.departure);
        self.error.set(lane, receiver.error);
        self.geometric_normal.set(lane, receiver.geometric_normal);
        self.shading_normal.set(lane, receiver.shading_normal);
        self.factor.set(lane, receiver.factor);
        self.bounce[lane] = receiver.bounce;
    }

    pub(super) fn get(&self, lane: usize) -> Receiver {
        Receiver {
            point: self.point.get(lane),
            departure: self.departure.get(lane),
            error: self.error.get(lane),
            geometric_normal: self.geometric_normal.get(lane),
            shading_normal: self.shading_normal.get(lane),
            factor: self.factor.get(lane),
            bounce: self.bounce[lane],
        }
    }

    #[inline(always)]
    pub(super) fn load<L: Lanes>(&self) -> ReceiverLanes<L> {
        ReceiverLanes {
            point: Vec3Lanes::load(&self.point),
            departure: Vec3Lanes::load(&self.departure),
            error: Vec3Lanes::load(&self.error),
            geometric_normal: Vec3Lanes::load(&self.geometric_normal),
            shading_normal: Vec3Lanes::load(&self.shading_normal),
            bounce: L::Ints::load(&self.bounce),
        }
    }

    /// A bit for each of the lanes that has one.
    #[inline(always)]
    pub(super) fn lanes<L: Lanes>(&self) -> u32 {
        let none = L::ints_eq(L::Ints::load(&self.bounce), L::Ints::splat(NONE));
        L::ALL & !L::bits(none)
    }

    #[inline(always)]
    pub(super) fn factor<L: Lanes>(&self) -> Vec3Lanes<L> {
        Vec3Lanes::load(&self.factor)
    }
}

impl SharedRow {
    pub(super) const NONE: Self = Self {
        place: Vec3Array::ZERO,
        error: Vec3Array::ZERO,
        geometric_normal: Vec3Array::ZERO,
        shading_normal: Vec3Array::ZERO,
        bounce: [NONE; ROW],
        lanes: 0,
        infinite: 0,
    };

    pub(super) fn clear(&mut self) {
        (self.lanes, self.infinite) = (0, 0);
    }

    #[inline(always)]
    pub(super) fn set(&mut self, lane: usize, vertex: &SharedVertex, bounce: u32) {
        self.place.set(lane, vertex.place);
        self.error.set(lane, vertex.error);
        self.geometric_normal.set(lane, vertex.geometric_normal);
        self.shading_normal.set(lane, vertex.shading_normal);
        self.bounce[lane] = bounce;
        self.lanes |= 1 << lane;
        self.infinite |= u32::from(vertex.is_infinite) << lane;
    }

    #[inline(always)]
    pub(super) fn load<L: Lanes>(&self) -> SharedLanes<L> {
        SharedLanes {
            place: Vec3Lanes::load(&self.place),
            error: Vec3Lanes::load(&self.error),
            geometric_normal: Vec3Lanes::load(&self.geometric_normal),
            shading_normal: Vec3Lanes::load(&self.shading_normal),
            bounce: L::Ints::load(&self.bounce),
            infinite: self.infinite,
        }
    }
}
