use std::collections::HashSet;
use std::ops::ControlFlow;
use std::sync::Arc;

use glam::Vec3;

use super::shared_mesh::SharedMesh;
use super::{PlainSurfaces, SurfaceInteraction};
use crate::bsdf::Bsdf;
use crate::color::Rgb;
use crate::geometry::{Aggregate, Instance, InstanceStats, Shapes};
use crate::guide::Guide;
use crate::light::{Light, LightHit, LightSampleContext, LightSampler};
use crate::math::Normalization;

/// Index of the flat triangles in [`Tables::smooth`].
pub(super) const FLAT: u32 = u32::MAX;
/// Light index of surfaces that do not emit.
pub(super) const DARK: u32 = u32::MAX;

/// What a primitive belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Owner {
    pub(super) material: u32,
    pub(super) light: u32,
    pub(super) instance: u32,
}

/// A material at run time.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PreparedMaterial {
    pub(super) name: String,
    pub(super) bsdf: Bsdf,
}

/// A scene made ready for tracing: immutable, shared by `Arc`. All positions are in tracing space,
/// see [`Normalization`].
#[derive(Debug)]
pub struct PreparedScene {
    pub(super) aggregate: Aggregate,
    /// Depends on surfaces, materials and lights, not on the hierarchy.
    pub(super) guide: Option<Arc<Guide>>,
    /// Shared with the same scene under another hierarchy.
    pub(super) tables: Arc<Tables>,
}

/// Everything about a scene but where rays meet it.
#[derive(Debug)]
pub(super) struct Tables {
    pub(super) normalization: Normalization,
    /// One owner for each material slot of each instance.
    pub(super) owners: Vec<Owner>,
    /// For each primitive that is not shared.
    pub(super) owner_of: Vec<u32>,
    /// For each owner the reflectance of plain surfaces, see [`PlainSurfaces`].
    pub(super) plain: Vec<Rgb>,
    /// For each triangle its place in `corner_normals`, or [`FLAT`]; empty when all are flat.
    pub(super) smooth: Vec<u32>,
    pub(super) corner_normals: Vec<[Vec3; 3]>,
    /// In the order of the instances of the aggregate.
    pub(super) shared: Vec<SharedMesh>,
    pub(super) materials: Vec<PreparedMaterial>,
    pub(super) instance_names: Vec<String>,
    pub(super) lights: Vec<Light>,
    /// Lights that are sampled; others are only met.
    pub(super) sampled: Vec<u32>,
    pub(super) sampler: LightSampler,
    pub(super) environment: Option<u32>,
    pub(super) course_compatible: bool,
    pub(super) notes: Vec<String>,
}

impl PreparedScene {
    /// The map between file coordinates and tracing space.
    pub fn normalization(&self) -> &Normalization {
        &self.tables.normalization
    }

    /// What rays are traced against.
    pub fn aggregate(&self) -> &Aggregate {
        &self.aggregate
    }

    /// Where lights are seen through mirrors and glass; `None` where there is nothing of the kind.
    pub fn guide(&self) -> Option<&Guide> {
        self.guide.as_deref()
    }

    /// The same scene under a hierarchy that costs rays less, see [`Aggregate::refined`]. Shapes and
    /// tables are shared, and every ray has the same hits.
    pub fn refined(&self, progress: &(dyn Fn(f32) -> ControlFlow<()> + Sync)) -> Option<Self> {
        Some(Self {
            aggregate: self.aggregate.refined(progress)?,
            guide: self.guide.clone(),
            tables: Arc::clone(&self.tables),
        })
    }

    /// The shapes that are not shared; lights are among them.
    pub fn shapes(&self) -> &Shapes {
        self.aggregate.shapes()
    }

    /// Sentences on what the step from description to runtime decided, for the import report.
    pub fn notes(&self) -> &[String] {
        &self.tables.notes
    }

    /// True when the course program's picture is reproduced with its errors.
    pub fn is_course_compatible(&self) -> bool {
        self.tables.course_compatible
    }

    fn owner(&self, primitive: u32) -> &Owner {
        let owner = match self.tables.owner_of.get(primitive as usize) {
            Some(&owner) => owner as usize,
            None => {
                let (_, shared, triangle) = self.shared(primitive);
                shared.owner(triangle)
            }
        };
        &self.tables.owners[owner]
    }

    /// The instance that shares triangle `primitive`, and the triangle of its mesh.
    fn shared(&self, primitive: u32) -> (&Instance, &SharedMesh, usize) {
        let instances = self.aggregate.instances();
        let (instances, (number, triangle)) = instances
            .and_then(|instances| Some((instances, instances.find(primitive)?)))
            .expect("a primitive is one of the shapes or of an instance");
        let (instance, shared) = (&instances.list()[number], &self.tables.shared[number]);
        (instance, shared, triangle)
    }

    /// Unit normals at the corners of triangle `primitive`; `None` when it is flat.
    pub fn corner_normals(&self, primitive: u32) -> Option<[Vec3; 3]> {
        if primitive as usize >= self.tables.owner_of.len() {
            let (instance, shared, triangle) = self.shared(primitive);
            let normals = shared.tables.corner_normals(triangle)?;
            return Some(normals_in_world(instance, triangle, normals));
        }
        let index = *self.tables.smooth.get(primitive as usize)?;
        (index != FLAT).then(|| self.tables.corner_normals[index as usize])
    }

    /// What the instances share and what that takes, tables included; all zero without instances.
    pub fn instance_stats(&self) -> InstanceStats {
        let mut stats = self.aggregate.instance_stats();
        let mut seen = HashSet::new();
        for shared in &self.tables.shared {
            if seen.insert(Arc::as_ptr(&shared.tables)) {
                stats.bytes += shared.tables.bytes();
            }
        }
        stats.bytes += size_of_val(self.tables.shared.as_slice());
        stats
    }

    /// The material of `primitive`.
    pub fn bsdf(&self, primitive: u32) -> &Bsdf {
        &self.tables.materials[self.owner(primitive).material as usize].bsdf
    }

    /// True when no surface scatters light in another way than a diffuse one.
    pub fn is_diffuse(&self) -> bool {
        let owners = &self.tables.owners;
        owners.iter().all(|owner| {
            let bsdf = &self.tables.materials[owner.material as usize].bsdf;
            matches!(bsdf, Bsdf::Diffuse(_)) || bsdf.is_black()
        })
    }

    /// Reflectance or tint of `primitive`, the colour of an emitter's emission scaled to at most 1.
    pub fn albedo(&self, primitive: u32) -> Rgb {
        let albedo = self.bsdf(primitive).albedo();
        match self.light_of(primitive) {
            Some(light) if albedo == Rgb::ZERO => {
                let hit = LightHit {
                    point: Vec3::ZERO,
                    normal: Vec3::Z,
                    distance: 1.0,
                    primitive,
                };
                let emitted = self.light(light).radiance_at(hit, Vec3::NEG_Z);
                emitted / emitted.max_element().max(1.0)
            }
            _ => albedo,
        }
    }

    /// The plain surfaces of the scene.
    pub fn plain_surfaces(&self) -> PlainSurfaces<'_> {
        let tables = &*self.tables;
        PlainSurfaces {
            shapes: self.shapes(),
            owner_of: &tables.owner_of,
            plain: &tables.plain,
            smooth: &tables.smooth,
            corner_normals: &tables.corner_normals,
        }
    }

    /// Name of the material of `primitive`.
    pub fn material_name(&self, primitive: u32) -> &str {
        &self.tables.materials[self.owner(primitive).material as usize].name
    }

    /// Name of the object that `primitive` belongs to.
    pub fn object_name(&self, primitive: u32) -> &str {
        &self.tables.instance_names[self.owner(primitive).instance as usize]
    }

    /// The light that `primitive` is part of; `None` when it does not emit.
    pub fn light_of(&self, primitive: u32) -> Option<u32> {
        let light = self.owner(primitive).light;
        (light != DARK).then_some(light)
    }

    /// Radiance that the surface sends along `wo`.
    pub fn emitted(&self, surface: &SurfaceInteraction, wo: Vec3) -> Rgb {
        let Some(light) = self.light_of(surface.primitive) else {
            return Rgb::ZERO;
        };
        self.light(light).radiance_at(light_hit(surface, 0.0), -wo)
    }

    /// Radiance from infinity along a ray in `direction` that met nothing. Camera rays do not see
    /// the ambient part.
    pub fn environment_radiance(&self, direction: Vec3, is_camera_ray: bool) -> Rgb {
        self.tables.environment.map_or(Rgb::ZERO, |light| {
            self.light(light)
                .radiance_from_infinity(direction, is_camera_ray)
        })
    }

    /// Solid-angle density with which the sampler of [`Self::light_sampler`] and sampling the part
    /// that it chooses make the unit `direction` in which `surface` lies at `distance`, for a
    /// surface at `from` lit on the side of the unit `normal`.
    pub fn light_pdf(
        &self,
        (from, normal): (Vec3, Vec3),
        direction: Vec3,
        surface: &SurfaceInteraction,
        distance: f32,
    ) -> f32 {
        let Some(index) = self.light_of(surface.primitive) else {
            return 0.0;
        };
        let light = self.light(index);
        let Some(part) = light.part_of(surface.primitive) else {
            return 0.0;
        };
        let pmf = self.light_sampler().pmf(from, normal, index, part as u32);
        if pmf == 0.0 {
            return 0.0;
        }
        let hit = light_hit(surface, distance);
        let from = LightSampleContext {
            point: from,
            normal,
        };
        pmf * light.pdf_part(self.shapes(), part, &from, (direction, hit))
    }

    /// The same for the environment.
    pub fn environment_pdf(&self, from: Vec3, direction: Vec3) -> f32 {
        let Some(index) = self.tables.environment else {
            return 0.0;
        };
        let pmf = self.light_sampler().group_pmf(index);
        if pmf == 0.0 {
            return 0.0;
        }
        let light = self.light(index);
        pmf * light.pdf(
            self.shapes(),
            &LightSampleContext::all_around(from),
            direction,
            LightHit::INFINITE,
        )
    }

    /// Light number `light`.
    pub fn light(&self, light: u32) -> &Light {
        &self.tables.lights[light as usize]
    }

    /// The light from infinity that fills the sphere, if there is any.
    pub fn environment_light(&self) -> Option<u32> {
        self.tables.environment
    }

    /// The number of lights.
    pub fn light_count(&self) -> usize {
        self.tables.lights.len()
    }

    /// The lights that are sampled.
    pub fn sampled_lights(&self) -> &[u32] {
        &self.tables.sampled
    }

    /// Chooses among the parts of all lights; nothing in course-compatible scenes.
    pub fn light_sampler(&self) -> &LightSampler {
        &self.tables.sampler
    }

    /// True when a diffuse surface needs light samples only: there is no sky, and no light can be met
    /// by rays, or only one of one part of which a sample counts for something bounded.
    pub fn light_samples_suffice(&self) -> bool {
        let only = self.light_sampler().only_light();
        self.tables.environment.is_none()
            && (self.tables.lights.iter().all(Light::is_delta)
                || only.is_some_and(|light| self.light(light).is_bounded()))
    }

    /// The number of lights that uniform hemisphere directions stand in for, at least 1.
    pub fn hemisphere_light_count(&self) -> u32 {
        let counts =
            |light: &&u32| self.tables.course_compatible || !self.light(**light).is_delta();
        (self.tables.sampled.iter().filter(counts).count() as u32).max(1)
    }
}

/// Corner normals of a triangle of a mesh, in the order and the directions that they have in the
/// world: on the side of the triangle's front, as they were in the space of the mesh.
fn normals_in_world(instance: &Instance, triangle: usize, normals: &[Vec3; 3]) -> [Vec3; 3] {
    let placement = instance.placement();
    let to_world = placement.object_from_world().matrix3.transpose();
    let [a, b, c] = instance.vertices(triangle);
    let front = (b - a).cross(c - a);
    let [na, nb, nc] = normals.map(|normal| {
        let world = (to_world * normal.as_dvec3()).normalize_or_zero();
        // A stretch may carry a normal that is nearly in the plane to the other side.
        let side = if world.dot(front) < 0.0 { -1.0 } else { 1.0 };
        (world * side).as_vec3()
    });
    if placement.is_mirrored() {
        [na, nc, nb]
    } else {
        [na, nb, nc]
    }
}

fn light_hit(surface: &SurfaceInteraction, distance: f32) -> LightHit {
    LightHit {
        point: surface.point,
        normal: surface.geometric_normal,
        distance,
        primitive: surface.primitive,
    }
}
