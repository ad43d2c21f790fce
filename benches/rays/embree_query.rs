//! The structures of Embree's ray queries, as its manual lays them out, and the way from our rays and
//! to our hits.

use std::ffi::c_void;
use std::ptr::null_mut;

use softbox::geometry::Hit;
use softbox::math::Ray;

/// `RTC_INVALID_GEOMETRY_ID`.
const INVALID: u32 = u32::MAX;
/// `RTC_RAY_QUERY_FLAG_COHERENT`.
pub(crate) const COHERENT: u32 = 1 << 16;

/// A device, scene or geometry.
pub(crate) type Handle = *mut c_void;

/// `RTCRayHit`.
#[repr(C, align(16))]
pub(crate) struct RayHit {
    origin: [f32; 3],
    t_near: f32,
    direction: [f32; 3],
    time: f32,
    t_far: f32,
    mask: u32,
    id: u32,
    flags: u32,
    normal: [f32; 3],
    u: f32,
    v: f32,
    primitive: u32,
    geometry: u32,
    instance: [u32; 2],
}

impl RayHit {
    /// A query for this ray.
    pub(crate) fn new(ray: &Ray) -> Self {
        Self {
            origin: ray.origin.to_array(),
            t_near: ray.t_min,
            direction: ray.direction.to_array(),
            time: 0.0,
            t_far: ray.t_max,
            mask: u32::MAX,
            id: 0,
            flags: 0,
            normal: [0.0; 3],
            u: 0.0,
            v: 0.0,
            primitive: INVALID,
            geometry: INVALID,
            instance: [INVALID; 2],
        }
    }

    /// The end of the ray; negative when any hit was asked for and found.
    pub(crate) fn t_far(&self) -> f32 {
        self.t_far
    }

    /// What the query found.
    pub(crate) fn hit(&self) -> Hit {
        match self.geometry {
            INVALID => Hit::MISS,
            _ => Hit {
                t: self.t_far,
                primitive: self.primitive,
                b1: self.u,
                b2: self.v,
            },
        }
    }
}

/// `RTCRayHit16`: the fields of [`RayHit`], sixteen numbers each.
#[repr(C, align(64))]
pub(crate) struct RayHit16([[f32; 16]; 21]);

/// `RTCIntersectArguments` and `RTCOccludedArguments`.
#[repr(C)]
pub(crate) struct Arguments {
    flags: u32,
    features: u32,
    context: Handle,
    filter: Handle,
    function: Handle,
    /// Fields that some builds of the library append.
    rest: [u64; 4],
}

impl Arguments {
    /// Nothing but `flags`.
    pub(crate) fn new(flags: u32) -> Self {
        Self {
            flags,
            features: u32::MAX,
            context: null_mut(),
            filter: null_mut(),
            function: null_mut(),
            rest: [0; 4],
        }
    }
}

/// -1 for the lanes that hold a ray, else 0.
#[repr(C, align(64))]
pub(crate) struct Lanes(pub(crate) [i32; 16]);

impl RayHit16 {
    /// A query for up to sixteen rays.
    pub(crate) fn new(rays: &[Ray]) -> (Lanes, Self) {
        let mut lanes = Lanes([0; 16]);
        let mut fields = [[0.0; 16]; 21];
        for (i, ray) in rays.iter().enumerate() {
            lanes.0[i] = -1;
            for axis in 0..3 {
                fields[axis][i] = ray.origin[axis];
                fields[4 + axis][i] = ray.direction[axis];
            }
            fields[3][i] = ray.t_min;
            fields[8][i] = ray.t_max;
            // The mask, and the ids of geometry and instance.
            for field in [9, 18, 19] {
                fields[field][i] = f32::from_bits(u32::MAX);
            }
        }
        (lanes, Self(fields))
    }

    /// What the query of lane `i` found.
    pub(crate) fn hit(&self, i: usize) -> Hit {
        let field = |field: usize| self.0[field][i];
        match field(18).to_bits() {
            INVALID => Hit::MISS,
            _ => Hit {
                t: field(8),
                primitive: field(17).to_bits(),
                b1: field(15),
                b2: field(16),
            },
        }
    }
}
